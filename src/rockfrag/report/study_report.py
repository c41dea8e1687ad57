"""Report of a study: its parts in order, every figure drawn once, one page, and its provenance.

In: a :class:`rockfrag.stages.job.Job` whose folder has the tables of all stages. Out: ``report.html`` and the
folder ``figures``; the same tables give the same bytes. Docs: ``docs/report.md``.
"""

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
from rockfrag.report.part import Answer, Part, Section
from rockfrag.report.part import Results as StudyResults
from rockfrag.report.sections import PARTS
from rockfrag.stages.job import Job, Results, package_digest
from rockfrag.study.study import Study
from rockfrag.words.sentences import counted

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
    live, systems = Markup(), {each.name: each for each in study.configurations}
    # nothing where it could not give the outcomes of the study
    if study.simulated_in_page:
        live = live_kernel(systems, results.floors, results.outcomes)
    write_page(
        job,
        answer(results),
        sections,
        about=_settings(results),
        lead=_lead(results),
        libraries=_LIBRARIES,
        live=live,
    )
    yield from ()


def _lead(results: StudyResults) -> str:
    """Sentence below the title: how many configurations, records and earthquakes."""
    study, records = results.study, results.records
    earthquakes = len({record.get("earthquake") for record in records})
    floors = ", on the floors of a building" if study.building_file else ""
    return (
        f"Rocking and overturning of {counted(len(study.configurations), 'configuration')} under "
        f"{counted(len(records), 'record')} of {counted(earthquakes, 'earthquake')}{floors}."
    )


def _settings(results: StudyResults) -> dict[str, str]:
    """Settings and inputs on which the numbers of a simulated study depend."""
    study = results.study
    shown = study.catalogue.head(MOST_TABLE_ROWS)
    digests = shown["sha256"].map(
        lambda sha: f", SHA-256 {sha[:12]} checked" if sha else ""
    )
    records = ", ".join(shown["name"] + " (" + shown["source"] + digests + ")")
    if rest := len(study.catalogue) - len(shown):
        records += f" and {rest} more of {study.catalogue_file.name}"
    digest = ", ".join(sorted(set(results.table("fragility")["record_set_sha256"])))
    amplitudes = study.amplitudes
    lowest, step = f"{amplitudes.lowest_g:g}", f"{amplitudes.step_percent:g}"
    protocol = f"{study.protocol_step_percent:g}"
    return {
        "Amplitudes": f"{lowest} to {amplitudes.highest_g:g} g in steps of {step} %",
        "Step protocol": f"from {lowest} g in steps of {protocol} %, read before overturning",
        "Records": records,
        "Motions, SHA-256": digest,
    }


def write_page(
    job: Job[Any],
    answer: Answer,
    sections: Sequence[Section],
    *,
    about: Mapping[str, str],
    lead: str,
    libraries: Sequence[str] = (),
    **page: Any,
) -> None:
    """Draw the figures of a page as SVG and PNG into the folder ``figures``, and write it, ``report.html``.

    Parameters
    ----------
    job : the study, and the folder of its results
    answer, sections, lead : what stands on the page
    about, libraries
        What a reader needs beside the study to get the same results again, and names of distributions whose
        versions matter; no dates, no names of machines.
    page : further fields of :class:`rockfrag.report.page.Page`
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
