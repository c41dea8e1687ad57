"""Reports of studies that are not of a simulated kind: a table of tests, a campaign on a shake table."""

from rockfrag.stages.campaign import TABLES
from rockfrag.stages.stage import Job, Results, Stage
from rockfrag.study.campaign import CampaignStudy
from rockfrag.study.measured_table import MeasuredTable

MEASURED_TABLES = ("tests", "fragility", "recommendation", "bins", "goodness")


def _measured_table(job: Job[MeasuredTable]) -> Results:
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


MEASURED_TABLE = Stage(
    name="measured_table",
    run=_measured_table,
    files=lambda study: [str(study.table)],
    outputs=(*MEASURED_TABLES, "figures/", "report.html"),
    settings=("title", "seed", "table", "columns", "measures", "confidence", "replicates"),
)


def _campaign_report(job: Job[CampaignStudy]) -> Results:
    """Draw the figures of a campaign and write its page."""
    from rockfrag.report.campaign_page import write_campaign_report

    write_campaign_report(job.study, job.folder)
    job.log.info("%s", job.folder / "report.html")
    yield from ()


CAMPAIGN_REPORT: Stage[CampaignStudy] = Stage(
    name="campaign_report",
    run=_campaign_report,
    inputs=TABLES,
    outputs=("figures/", "report.html"),
    settings=("title", "conditioning", "confidence"),
)
