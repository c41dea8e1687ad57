"""A study's stages, one after the other in this process, as the rules of the workflow would run them."""

import logging
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from rockfrag.report import campaign_page, measured_page, space_page, study_report
from rockfrag.stages import (
    campaign,
    fragility,
    ida,
    motions,
    pedestal,
    space,
    tests,
)
from rockfrag.stages.job import Job, Results
from rockfrag.study.campaign import CampaignStudy
from rockfrag.study.loading import AnyStudy
from rockfrag.study.space import SpaceStudy
from rockfrag.study.study import Study
from rockfrag_thesis import building_sensitivity
from rockfrag_thesis.settings import settings_of
from rockfrag_thesis.stages import hypotheses, sensitivity_analysis

Stage = Callable[[Job], Results]


def stages_of(study: AnyStudy) -> list[Stage]:
    """Stages of a study in the order in which data flow."""
    if isinstance(study, CampaignStudy):
        return [campaign.run, campaign_page.run]
    if isinstance(study, SpaceStudy):
        return [space.run, space_page.run]
    if not isinstance(study, Study):
        return [measured_page.run]
    optional = (
        (pedestal.run, study.has_pairs),
        (sensitivity_analysis.run, settings_of(study).sensitivity_analysis),
        (building_sensitivity.run, settings_of(study).sensitivity),
        (pedestal.run_measured, study.measured_tests),
        (hypotheses.run, settings_of(study).compares),
        (study_report.run, True),
    )
    asked = [stage for stage, wanted in optional if wanted]
    return [motions.run, _swept, tests.run, fragility.run, *asked]


def _swept(job: Job[Study]) -> Results:
    for part in range(job.study.ida_jobs):
        yield from ida.run_part(replace(job, part=part))
    yield from ida.run_as_recorded(job)


def run_stages(study: AnyStudy, folder: Path, stages: list[Stage] | None = None) -> Path:
    """Run stages of a study, all if none are named, and return the folder of the results."""
    for stage in stages_of(study) if stages is None else stages:
        job = Job(study, folder, 1, logging.getLogger("stages in process"))
        for name, value in stage(job):
            job.write(name, value)
    return folder
