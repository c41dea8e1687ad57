"""The report of a study: its parts in order, every figure drawn once, one page, and what made it."""

import json
from collections.abc import Callable, Mapping, Sequence
from importlib.metadata import version
from typing import Any

from markupsafe import Markup

from rockfrag.base.files import write_text
from rockfrag.config.plugins import plugins_of
from rockfrag.report.answer import study_answer
from rockfrag.report.live import live_kernel
from rockfrag.report.page import MOST_TABLE_ROWS, Page
from rockfrag.report.part import Answer, Part, Section, says
from rockfrag.report.part import Results as StudyResults
from rockfrag.report.sections import PARTS
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
    lead = says.line("lead", study, len(results.records), earthquakes)
    live, systems = Markup(), {each.name: each for each in study.configurations}
    # nothing where it could not give the outcomes of the study
    if study.simulated_in_page:
        live = live_kernel(systems, results.floors, results.outcomes)
    first, about = answer(results), _settings(results)
    write_page(job, first, sections, about, lead, _LIBRARIES, live=live)
    yield from ()


def _settings(results: StudyResults) -> dict[str, str]:
    """What the numbers of a simulated study depend on."""
    study = results.study
    shown = study.catalogue.head(MOST_TABLE_ROWS)
    digests = shown["sha256"].map(
        lambda sha: f", SHA-256 {sha[:12]} checked" if sha else ""
    )
    records = ", ".join(shown["name"] + " (" + shown["source"] + digests + ")")
    if rest := len(study.catalogue) - len(shown):
        records += f" and {rest} more of {study.catalogue_file.name}"
    digest = ", ".join(sorted(set(results.table("fragility")["record_set_sha256"])))
    return says.pairs("settings", study) | {
        "Records": records,
        "Motions, SHA-256": digest,
    }


def write_page(
    job: Job[Any],
    answer: Answer,
    sections: Sequence[Section],
    about: Mapping[str, str],
    lead: str,
    libraries: Sequence[str] = (),
    **page: Any,
) -> None:
    """Draw the figures of a page as SVG and PNG into the folder ``figures``, and write it, ``report.html``.

    Its last section says what a reader needs to get the same results again, also what is in ``about`` and
    ``libraries``; no dates, no names of machines. What else it shows goes to :class:`rockfrag.report.page.Page`.
    """
    study, folder = job.study, job.folder / "figures"
    digest = package_digest(*(plugin.rules.parent for plugin in plugins_of(study)))
    provenance = {
        "Configuration": study.source.name,
        **about,
        "Seed": str(study.seed),
        "Source": f"rockfrag {version('rockfrag')}, digest {digest}",
    }
    if libraries:
        provenance["Libraries"] = ", ".join(
            f"{name} {version(name)}" for name in libraries
        )
    shown = Page(study.title, lead, answer, sections, provenance, **page)
    text = shown.html(folder, job.threads)
    # chapter and caption of each figure, for Snakemake's report
    each = shown.figures.items()
    captions = {
        name: {"chapter": at, "caption": spec.caption} for name, (spec, at) in each
    }
    write_text(
        json.dumps(captions, ensure_ascii=False, indent=1) + "\n",
        folder / "captions.json",
    )
    write_text(text, job.folder / "report.html")
    job.log.info("%s", job.folder / "report.html")
