"""What a study does and what its report holds: what every study has, and what its guest adds.

The one place that knows of the thesis. A new stage is added to the list here; a new part of the
report in :mod:`rockfrag.report.sections`.
"""

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from rockfrag.report.stages import CAMPAIGN_REPORT, MEASURED_TABLE
from rockfrag.stages import (
    campaign,
    explanation,
    fragility,
    measured_tests,
    motions,
    pedestal,
    sensitivity,
    sweep,
    tests,
)
from rockfrag.stages.running import RESULTS, run_stage
from rockfrag.stages.stage import Job, Results, Stage
from rockfrag.study.campaign import CampaignStudy
from rockfrag.study.loading import AnyStudy, any_study
from rockfrag.study.measured_table import MeasuredTable
from rockfrag.study.study import Study
from rockfrag.thesis import stages as thesis

if TYPE_CHECKING:
    from rockfrag.report.part import Answer, Part
    from rockfrag.report.part import Results as ReportedResults

_GENERAL: tuple[Stage[Study], ...] = (
    tests.STAGE,
    fragility.STAGE,
    pedestal.STAGE,
    explanation.STAGE,
    sensitivity.STAGE,
    measured_tests.STAGE,
)


def study_stages(study: AnyStudy) -> list[Stage[Any]]:
    """Stages of a study in the order in which data flow."""
    if isinstance(study, MeasuredTable):
        return [MEASURED_TABLE]
    if isinstance(study, CampaignStudy):
        return [campaign.STAGE, CAMPAIGN_REPORT]
    guests = [thesis.STAGE] if study.compare_with == "thesis" else []
    before = [motions.STAGE, *sweep.sweep_stages(study)]
    stages = [one for one in (*before, *_GENERAL, *guests) if one.wanted(study)]
    return [*stages, _report_stage(stages)]


def run_job(
    name: str, config: Mapping[str, Any], study_file: str, threads: int, log_file: str
) -> None:
    """Run a stage of a study, as a job of the workflow does.

    Parameters
    ----------
    name
        Name of the stage.
    config
        The configuration as read.
    study_file
        The file it was read from.
    threads
        Threads that the stage may use.
    log_file
        Path of its log.
    """
    study = any_study(config, study_file)
    run_stage(name, study_stages(study), study, threads, log_file)


def report_parts(study: Study) -> "Sequence[Part]":
    """Parts of the report of a study in their order."""
    from rockfrag.report.sections import PARTS

    if study.compare_with != "thesis":
        return PARTS
    from rockfrag.thesis.sections import with_thesis

    return with_thesis(PARTS)


def report_answer(study: Study) -> "Callable[[ReportedResults], Answer]":
    """Return what says what stands first in the report of a study."""
    if study.compare_with != "thesis":
        from rockfrag.report.answer import study_answer

        return study_answer
    from rockfrag.thesis.sections.first_page import thesis_answer

    return thesis_answer


def _report_stage(stages: Sequence[Stage[Study]]) -> Stage[Study]:
    """Return the last stage, which may read whatever the others write."""
    return Stage(
        name="report",
        run=_report,
        inputs=lambda study: [
            path for one in stages for path in one.output_files(study) if path.endswith(".parquet")
        ],
        # what lies beside is declared, so that the report is made again when it comes, goes or changes
        files=lambda study: [
            *study.body_files,
            *(path.as_posix() for path in thesis.wide_effects(study, RESULTS)),
        ],
        outputs=("figures/", "report.html"),
        settings=(
            "title",
            "bodies",
            "amplitudes",
            "protocol",
            "fragility",
            "seed",
            "compare_with",
            "friction",
            "vertical",
        ),
        parallel=True,
    )


def _report(job: Job[Study]) -> Results:
    """Draw the figures and write the page."""
    from rockfrag.report.study_report import write_report

    study = job.study
    write_report(study, report_parts(study), report_answer(study), job.folder, job.threads)
    job.log.info("%s", job.folder / "report.html")
    yield from ()
