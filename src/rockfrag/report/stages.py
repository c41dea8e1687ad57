"""Stages that write reports: of a study, of a table of tests, of a campaign on a shake table."""

from rockfrag.stages.job import Job, Results
from rockfrag.study.campaign import CampaignStudy
from rockfrag.study.measured_table import MeasuredTable


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
        event=study.event,
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
