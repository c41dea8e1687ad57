"""The report of a study: its parts in order, every figure drawn once, and one page."""

import multiprocessing
from collections.abc import Callable, Sequence
from pathlib import Path

from rockfrag.figure_style import save_figure
from rockfrag.files import write_text
from rockfrag.report.live import live_kernel
from rockfrag.report.page import Picture, read_picture, render
from rockfrag.report.part import Answer, FigureSpec, Part, Results, Section
from rockfrag.report.provenance import provenance
from rockfrag.report.wording import counted
from rockfrag.study.study import Study

FIGURES = "figures"
"""Folder of the figures in that of the results, each as SVG and as PNG."""


def write_report(
    study: Study,
    parts: Sequence[Part],
    answer: Callable[[Results], Answer],
    folder: Path,
    processes: int = 1,
) -> None:
    """Draw the figures of a study and write its page, ``report.html``.

    Parameters
    ----------
    study
        The study.
    parts
        What its report may have; those that it did not ask for are left out.
    answer
        Says what stands first.
    folder
        Folder of its results, with the tables that its parts name, the sweeps, and the motions.
    processes
        How many may draw at once.
    """
    results = Results(study, folder)
    asked = [part for part in parts if part.asked(study)]
    sections = [section for part in asked if (section := part.section(results)) is not None]
    first = answer(results)
    specs = [one for section in sections for one in section.parts if isinstance(one, FigureSpec)]
    specs += [first.figure] if first.figure else []
    pictures = draw_all(specs, folder / FIGURES, processes)
    page = study_page(results, first, sections, pictures)
    write_text(page, folder / "report.html")


def draw_all(specs: Sequence[FigureSpec], folder: Path, processes: int) -> dict[str, Picture]:
    """Draw figures into a folder and return them by name; whoever draws, the bytes are the same."""
    if processes == 1 or "fork" not in multiprocessing.get_all_start_methods():
        return {spec.name: draw(spec, folder) for spec in specs}
    global _waiting
    _waiting = (specs, folder)
    # a fork has the tables and the libraries already, and needs to pickle no drawing
    with multiprocessing.get_context("fork").Pool(processes) as pool:
        pool.map(_draw_waiting, range(len(specs)), chunksize=1)
    return {spec.name: read_picture(spec, folder / f"{spec.name}.svg") for spec in specs}


_waiting: tuple[Sequence[FigureSpec], Path] = ((), Path())
"""What the processes of :func:`draw_all` draw."""


def _draw_waiting(number: int) -> None:
    specs, folder = _waiting
    draw(specs[number], folder)


def draw(spec: FigureSpec, folder: Path) -> Picture:
    """Draw a figure into a folder as SVG and PNG, and return it for the page."""
    folder.mkdir(parents=True, exist_ok=True)
    svg = folder / f"{spec.name}.svg"
    save_figure(spec.draw(), svg, folder / f"{spec.name}.png")
    return read_picture(spec, svg)


def study_page(
    results: Results,
    answer: Answer,
    sections: Sequence[Section],
    pictures: dict[str, Picture],
) -> str:
    """Return the page of a study as HTML."""
    study = results.study
    return render(
        title=study.title,
        lead=_lead(study),
        answer=answer,
        sections=sections,
        pictures=pictures,
        provenance=provenance(results),
        live=live_kernel(
            {one.name: one.body for one in study.configurations},
            results.floors,
            results.verdicts,
        ),
    )


def _lead(study: Study) -> str:
    motions, events = len(study.catalogue), study.catalogue["event"].nunique()
    return (
        f"Rocking and overturning of {counted(len(study.configurations), 'configuration')} under "
        f"{counted(motions, 'record')} of {counted(events, 'earthquake')}"
        + (", on the floors of a building" if study.building else "")
        + ", simulated event by event."
    )
