"""A campaign on a shake table: every test simulated with the table's own motion, and compared."""

from rockfrag.stages.stage import Job, Results, Stage
from rockfrag.study.campaign import CampaignStudy

OURS = "rockfrag"
"""Who gave the simulated verdicts, in the tables."""

TABLES = (
    "tests",
    "trials",
    "agreement",
    "rocking",
    "fragility",
    "regions",
    "conditioning",
    "contact",
    "footprint",
)


def _run(job: Job[CampaignStudy]) -> Results:
    from rockfrag.stages.campaign_results import campaign_tables

    yield from campaign_tables(job)


STAGE: Stage[CampaignStudy] = Stage(
    name="campaign",
    run=_run,
    files=lambda study: study.files,
    outputs=TABLES,
    settings=(
        "seed",
        "fetch",
        "campaign",
        "object",
        "conditioning",
        "varied_conditioning",
        "unknowns",
        "trials",
        "folds",
        "repeats",
        "confidence",
    ),
    parallel=True,
)
