"""The report of a study: its parts in order, every figure drawn once, and one page."""

import json
from collections.abc import Callable, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from markupsafe import Markup

from rockfrag.figure_style import save_figure
from rockfrag.files import write_text
from rockfrag.processes import in_processes
from rockfrag.report.live import live_kernel
from rockfrag.report.page import Picture, render
from rockfrag.report.part import Answer, FigureSpec, Part, Results, Section
from rockfrag.report.provenance import study_provenance
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
    """Draw the figures of a study and write its page, ``report.html``, into the folder of its results.

    Of the parts those that the study did not ask for are left out; their tables, the IDA curves and the motions
    are in the folder. ``answer`` says what stands first, and several processes may draw at once.
    """
    results = Results(study, folder)
    asked = [part for part in parts if part.asked(study)]
    sections = [section for part in asked if (section := part.section(results)) is not None]
    write_page(
        folder,
        answer(results),
        sections,
        processes,
        title=study.title,
        lead=_lead(results),
        provenance=study_provenance(results),
        live=_live(results),
    )


def write_page(
    folder: Path, answer: Answer, sections: Sequence[Section], processes: int = 1, **page: Any
) -> None:
    """Draw the figures of a page into a folder, and write the page there, ``report.html``.

    What else it shows goes to :func:`rockfrag.report.page.render`.
    """
    pictures = draw_all(figures_of(answer, sections), folder / FIGURES, processes)
    write_captions(answer, sections, folder / FIGURES)
    text = render(answer=answer, sections=sections, pictures=pictures, **page)
    write_text(text, folder / "report.html")


def page_text(answer: Answer, sections: Sequence[Section], **page: Any) -> str:
    """Return a page with its figures as HTML, which loads nothing from outside; see :func:`write_page`."""
    with TemporaryDirectory(prefix="rockfrag.") as scratch:
        pictures = draw_all(figures_of(answer, sections), Path(scratch))
        return render(answer=answer, sections=sections, pictures=pictures, **page)


def figures_of(answer: Answer, sections: Sequence[Section]) -> list[FigureSpec]:
    """Return the figures of a page, each once."""
    parts = [answer.figure, *(part for section in sections for part in section.parts)]
    return list({part.name: part for part in parts if isinstance(part, FigureSpec)}.values())


def write_captions(answer: Answer, sections: Sequence[Section], folder: Path) -> None:
    """Write what the page says of each figure into the folder of the figures, for Snakemake's report.

    ``captions.json`` has chapter and caption of each by name.
    """
    found = [(answer.figure, "The answer")] if answer.figure else []
    found += [
        (part, section.title)
        for section in sections
        for part in section.parts
        if isinstance(part, FigureSpec) and part is not answer.figure
    ]
    captions = {
        figure.name: {"chapter": chapter, "caption": figure.caption} for figure, chapter in found
    }
    write_text(json.dumps(captions, ensure_ascii=False, indent=1) + "\n", folder / "captions.json")


def draw_all(specs: Sequence[FigureSpec], folder: Path, processes: int = 1) -> dict[str, Picture]:
    """Draw figures into a folder and return them by name; whoever draws, the bytes are the same."""
    # what processes hand over should be small: the name of a file, and not what is in it
    files = in_processes(lambda spec: _drawn(spec, folder), specs, processes)
    return {
        spec.name: Picture(spec, file.read_text(encoding="utf-8"))
        for spec, file in zip(specs, files, strict=True)
    }


def _drawn(spec: FigureSpec, folder: Path) -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    svg = folder / f"{spec.name}.svg"
    save_figure(spec.draw(), svg, folder / f"{spec.name}.png")
    return svg


def _live(results: Results) -> Markup:
    """Return the simulation in the page; nothing where it could not give the outcomes of the study."""
    study = results.study
    if not study.simulated_in_page:
        return Markup()
    systems = {configuration.name: configuration for configuration in study.configurations}
    return live_kernel(systems, results.floors, results.outcomes)


def _lead(results: Results) -> str:
    study, motions = results.study, len(results.records)
    earthquakes = len({record.get("earthquake") for record in results.records})
    return (
        f"Rocking and overturning of {counted(len(study.configurations), 'configuration')} under "
        f"{counted(motions, 'record')} of {counted(earthquakes, 'earthquake')}"
        + (", on the floors of a building" if study.building else "")
        + "."
    )
