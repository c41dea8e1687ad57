"""The report of a study: its parts in order, every figure drawn once, and one page."""

from collections.abc import Sequence
from pathlib import Path

from rockfrag.files import write_text
from rockfrag.report.figures.style import save_figure
from rockfrag.report.page import Picture, read_picture, render
from rockfrag.report.part import FigureSpec, Finding, Part, Results, Section
from rockfrag.report.provenance import provenance
from rockfrag.report.wording import counted
from rockfrag.study.study import Study

FIGURES = "figures"
"""Folder of the figures in that of the results, each as SVG and as PNG."""


def report_tables(study: Study, parts: Sequence[Part]) -> list[str]:
    """Names of all tables that the report of a study reads, each once."""
    names = [name for part in parts if part.asked(study) for name in part.tables]
    return list(dict.fromkeys([*names, "tests", "measures", "fragility"]))


def write_report(study: Study, parts: Sequence[Part], folder: Path) -> None:
    """Draw the figures of a study and write its page, ``report.html``.

    Parameters
    ----------
    study
        The study.
    parts
        What its report may have; those that it did not ask for are left out.
    folder
        Folder of its results, with the tables of :func:`report_tables`, the sweeps, and the ground
        motions in ``motions``.
    """
    results = Results(study, folder)
    asked = [part for part in parts if part.asked(study)]
    sections = [section for part in asked if (section := part.section(results)) is not None]
    findings = [finding for part in asked for finding in part.findings(results)]
    pictures = {
        spec.name: draw(spec, folder / FIGURES)
        for section in sections
        for spec in section.parts
        if isinstance(spec, FigureSpec)
    }
    page = study_page(results, findings, sections, pictures)
    write_text(page, folder / "report.html")


def draw(spec: FigureSpec, folder: Path) -> Picture:
    """Draw a figure into a folder as SVG and PNG, and return it for the page."""
    folder.mkdir(parents=True, exist_ok=True)
    svg = folder / f"{spec.name}.svg"
    save_figure(spec.draw(), svg, folder / f"{spec.name}.png")
    return read_picture(spec, svg)


def study_page(
    results: Results,
    findings: Sequence[Finding],
    sections: Sequence[Section],
    pictures: dict[str, Picture],
) -> str:
    """Return the page of a study as HTML."""
    study = results.study
    return render(
        title=study.title,
        lead=_lead(study),
        findings=findings,
        sections=sections,
        pictures=pictures,
        provenance=provenance(results),
    )


def _lead(study: Study) -> str:
    motions, events = len(study.catalogue), study.catalogue["event"].nunique()
    return (
        f"Rocking and overturning of {counted(len(study.configurations), 'configuration')} under "
        f"{counted(motions, 'record')} of {counted(events, 'earthquake')}"
        + (", on the floors of a building" if study.building else "")
        + ", simulated event by event."
    )
