"""The report of a study: its parts in order, every figure drawn once, one page, and what made it."""

import json
from collections.abc import Callable, Mapping, Sequence
from importlib.metadata import version
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from markupsafe import Markup

from rockfrag.figure_style import save_figure
from rockfrag.files import write_text
from rockfrag.plugins import plugins_of
from rockfrag.processes import in_processes
from rockfrag.report.answer import study_answer
from rockfrag.report.live import live_kernel
from rockfrag.report.page import MOST_TABLE_ROWS, Picture, render
from rockfrag.report.part import Answer, FigureSpec, Part, Section
from rockfrag.report.part import Results as StudyResults
from rockfrag.report.sections import PARTS
from rockfrag.sentences import counted
from rockfrag.stages.job import Job, Results, package_digest
from rockfrag.study.study import Study

_LIBRARIES = ("numpy", "scipy", "pandas", "numba", "statsmodels", "obspy", "matplotlib")


def run(job: Job[Study]) -> Results:
    """Draw the figures of a study and write its page, ``report.html``, into the folder of its results.

    Parts that the study did not ask for are left out; the tables, IDA curves and motions of the others are there.
    """
    study, results = job.study, StudyResults(job.study, job.folder)
    parts: Sequence[Part] = PARTS
    answer: Callable[[StudyResults], Answer] = study_answer
    for plugin in plugins_of(study):
        parts, answer = plugin.report(study, parts, answer)
    sections = [section for part in parts if (section := part(results)) is not None]
    earthquakes = len({record.get("earthquake") for record in results.records})
    lead = (
        f"Rocking and overturning of {counted(len(study.configurations), 'configuration')} under "
        f"{counted(len(results.records), 'record')} of {counted(earthquakes, 'earthquake')}"
        + (", on the floors of a building." if study.building else ".")
    )
    page = {"lead": lead, "live": _live(results), "libraries": _LIBRARIES}
    write_page(job, answer(results), sections, _settings(results), **page)
    yield from ()


def _settings(results: StudyResults) -> dict[str, str]:
    """What the numbers of a simulated study depend on."""
    study, amplitudes = results.study, results.study.amplitudes
    shown = study.catalogue.head(MOST_TABLE_ROWS)
    records = ", ".join(_record(row) for row in shown.to_dict("records"))
    if rest := len(study.catalogue) - len(shown):
        records += f" and {rest} more of {study.catalogue_file.name}"
    return {
        "Amplitudes": f"{amplitudes.lowest_g:g} to {amplitudes.highest_g:g} g in steps of "
        f"{amplitudes.step_percent:g} %",
        "Step protocol": f"from {amplitudes.lowest_g:g} g in steps of "
        f"{study.protocol_step_percent:g} %, read before overturning",
        "Records": records,
        "Motions, SHA-256": ", ".join(sorted(set(results.table("fragility")["record_set_sha256"]))),
    }


def _record(row: Mapping[Any, Any]) -> str:
    checked = f", SHA-256 {row['sha256'][:12]} checked" if row["sha256"] else ""
    return f"{row['name']} ({row['source']}{checked})"


def _live(results: StudyResults) -> Markup:
    """Return the simulation in the page; nothing where it could not give the outcomes of the study."""
    study = results.study
    if not study.simulated_in_page:
        return Markup()
    systems = {configuration.name: configuration for configuration in study.configurations}
    return live_kernel(systems, results.floors, results.outcomes)


def write_page(
    job: Job[Any],
    answer: Answer,
    sections: Sequence[Section],
    about: Mapping[str, str],
    libraries: Sequence[str] = (),
    **page: Any,
) -> None:
    """Draw the figures of a page as SVG and PNG into the folder ``figures``, and write it, ``report.html``.

    Its last section says what a reader needs to get the same results again, also what is in ``about`` and
    ``libraries``; no dates, no names of machines. What else it shows goes to :func:`rockfrag.report.page.render`.
    """
    study, folder = job.study, job.folder / "figures"
    figures = figures_of(answer, sections)
    pictures = draw_all([spec for spec, _ in figures], folder, job.threads)
    # chapter and caption of each figure, for Snakemake's report
    captions = {
        spec.name: {"chapter": chapter, "caption": spec.caption} for spec, chapter in figures
    }
    write_text(json.dumps(captions, ensure_ascii=False, indent=1) + "\n", folder / "captions.json")
    digest = package_digest(*(plugin.rules.parent for plugin in plugins_of(study)))
    provenance = {
        "Configuration": study.source.name,
        **about,
        "Seed": str(study.seed),
        "Source": f"rockfrag {version('rockfrag')}, digest {digest}",
    }
    if libraries:
        provenance["Libraries"] = ", ".join(f"{name} {version(name)}" for name in libraries)
    text = render(
        title=study.title,
        answer=answer,
        sections=sections,
        pictures=pictures,
        provenance=provenance,
        **page,
    )
    write_text(text, job.folder / "report.html")
    job.log.info("%s", job.folder / "report.html")


def page_text(answer: Answer, sections: Sequence[Section], **page: Any) -> str:
    """Return a page with its figures as HTML, which loads nothing from outside; see :func:`write_page`."""
    with TemporaryDirectory(prefix="rockfrag.") as scratch:
        pictures = draw_all([spec for spec, _ in figures_of(answer, sections)], Path(scratch))
        return render(answer=answer, sections=sections, pictures=pictures, **page)


def figures_of(answer: Answer, sections: Sequence[Section]) -> list[tuple[FigureSpec, str]]:
    """Return the figures of a page, each once, with the title of the chapter where it stands."""
    parts: list[tuple[Any, str]] = [(answer.figure, "The answer")]
    parts += [(part, section.title) for section in sections for part in section.parts]
    found: dict[str, tuple[FigureSpec, str]] = {}
    for part, chapter in parts:
        if isinstance(part, FigureSpec):
            found.setdefault(part.name, (part, chapter))
    return list(found.values())


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
