"""Stages that write reports: of a study, of a table of tests, of a campaign, of bodies in space."""

from typing import TYPE_CHECKING

from rockfrag.plugins import plugins_of
from rockfrag.stages.job import Job, Results
from rockfrag.study.campaign import CampaignStudy
from rockfrag.study.measured_table import MeasuredTable
from rockfrag.study.space import SpaceStudy
from rockfrag.study.study import Study

if TYPE_CHECKING:
    from rockfrag.plugins import FirstPage, Parts


def report(job: Job[Study]) -> Results:
    """Draw the figures of a study and write its page."""
    from rockfrag.report.answer import study_answer
    from rockfrag.report.sections import PARTS
    from rockfrag.report.study_report import write_report

    found: tuple[Parts, FirstPage] = PARTS, study_answer
    for plugin in plugins_of(job.study):
        found = plugin.report(job.study, *found)
    write_report(job.study, *found, job.folder, job.threads)
    job.log.info("%s", job.folder / "report.html")
    yield from ()


def measured_table(job: Job[MeasuredTable]) -> Results:
    """Yield the fitted tables; draw the figures and write the report."""
    from rockfrag.fragility.user_table import fit_user_table
    from rockfrag.report.measured_page import result_tables, write_measured_report

    study = job.study
    found = fit_user_table(
        study.table,
        study.measures,
        overturned=study.overturned,
        motion=study.motion,
        earthquake=study.earthquake,
        given=study.given,
        level=study.confidence,
        replicates=study.replicates,
        seed=study.seed,
    )
    yield from result_tables(found).items()
    write_measured_report(study, found, job.folder)
    job.log.info("%s", found.choice.words)


def campaign_report(job: Job[CampaignStudy]) -> Results:
    """Draw the figures of a campaign and write its page."""
    from rockfrag.report.campaign_page import write_campaign_report

    write_campaign_report(job.study, job.folder)
    job.log.info("%s", job.folder / "report.html")
    yield from ()


def space_report(job: Job[SpaceStudy]) -> Results:
    """Draw the figures of a study of bodies in space and write its page."""
    from rockfrag.report.space_page import write_space_report

    tables = job.table("medians"), job.table("fractions")
    write_space_report(job.study, *tables, job.motions("motions/ground"), job.folder)
    job.log.info("%s", job.folder / "report.html")
    yield from ()
