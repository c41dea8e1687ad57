"""The report of a study: its parts in order, every figure drawn once, and one page."""

import json
from collections.abc import Callable, Sequence
from pathlib import Path

from markupsafe import Markup

from rockfrag.figure_style import save_figure
from rockfrag.files import write_text
from rockfrag.processes import in_processes
from rockfrag.report.live import live_kernel
from rockfrag.report.page import Picture, read_picture, render
from rockfrag.report.part import (
    Answer,
    FigureSpec,
    Part,
    Results,
    Section,
)
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
    """Draw the figures of a study and write its page, ``report.html``, into the folder of its results.

    Of the parts those that the study did not ask for are left out; their tables, the IDA curves and the motions
    are in the folder. ``answer`` says what stands first, and several processes may draw at once.
    """
    results = Results(study, folder)
    asked = [part for part in parts if part.asked(study)]
    sections = [section for part in asked if (section := part.section(results)) is not None]
    first = answer(results)
    specs = [part for section in sections for part in section.parts if isinstance(part, FigureSpec)]
    specs += [first.figure] if first.figure else []
    pictures = draw_all(specs, folder / FIGURES, processes)
    write_captions(first, sections, folder / FIGURES)
    page = study_page(results, first, sections, pictures)
    write_text(page, folder / "report.html")


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


def draw_all(specs: Sequence[FigureSpec], folder: Path, processes: int) -> dict[str, Picture]:
    """Draw figures into a folder and return them by name; whoever draws, the bytes are the same."""
    # what processes hand over should be small: the name of a file, and not what is in it
    files = in_processes(lambda spec: _drawn(spec, folder), specs, processes)
    return {spec.name: read_picture(spec, file) for spec, file in zip(specs, files, strict=True)}


def draw(spec: FigureSpec, folder: Path) -> Picture:
    """Draw a figure into a folder as SVG and PNG, and return it for the page."""
    return read_picture(spec, _drawn(spec, folder))


def _drawn(spec: FigureSpec, folder: Path) -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    svg = folder / f"{spec.name}.svg"
    save_figure(spec.draw(), svg, folder / f"{spec.name}.png")
    return svg


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
        lead=_lead(results),
        answer=answer,
        sections=sections,
        pictures=pictures,
        provenance=provenance(results),
        live=_live(results),
    )


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
