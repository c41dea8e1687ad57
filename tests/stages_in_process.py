"""A study's stages, one after the other in this process, as the rules of the workflow would run them."""

import logging
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

from rockfrag.report import campaign_page, measured_page, space_page, study_report
from rockfrag.runtime.processes import in_processes
from rockfrag.stages import campaign, fragility, ida, motions, pedestal, tests
from rockfrag.stages import space_study as space
from rockfrag.stages.job import Job, Results
from rockfrag.study.campaign import CampaignStudy
from rockfrag.study.loading import AnyStudy, load_any
from rockfrag.study.space import SpaceStudy
from rockfrag.study.study import Study

Stage = Callable[[Job], Results]


def stages_of(study: AnyStudy) -> list[Stage]:
    """Stages of a study in the order in which data flow."""
    if isinstance(study, CampaignStudy):
        return [campaign.run, campaign_page.run]
    if isinstance(study, SpaceStudy):
        return [space.run, space_page.run]
    if not isinstance(study, Study):
        return [measured_page.run]
    asked = [motions.run, _swept, tests.run, fragility.run]
    asked += [pedestal.run] if study.has_pairs else []
    asked += [pedestal.run_measured] if study.measured_tests else []
    asked += _of_the_thesis(study) if study.added else []
    return [*asked, study_report.run]


def _of_the_thesis(study: Study) -> list[Stage]:
    """Stages of a plugin that only the studies with its keys need installed."""
    from rockfrag_thesis import building_sensitivity
    from rockfrag_thesis.settings import settings_of
    from rockfrag_thesis.stages import hypotheses, sensitivity_analysis

    settings = settings_of(study)
    optional = (
        (sensitivity_analysis.run, settings.sensitivity_analysis),
        (building_sensitivity.run, settings.sensitivity),
        (hypotheses.run, settings.compares),
    )
    return [stage for stage, wanted in optional if wanted]


def _swept(job: Job[Study]) -> Results:
    for part in range(job.study.ida_jobs):
        yield from ida.run_part(replace(job, part=part))
    yield from ida.run_as_recorded(job)


def files_read(path: Path, stages: list[Stage] | None = None) -> set[Path]:
    """Files beside a configuration that a study reads while stages of it run, all if none are named."""
    # in a process of its own: Python never lets go of who listens
    return in_processes(lambda one: _read(one, stages), [path], 2)[0]


def _read(path: Path, stages: list[Stage] | None) -> set[Path]:
    """Run stages of a study, and return the user's files that were opened."""
    opened: set[str] = set()

    def listen(event: str, about: tuple[Any, ...]) -> None:
        if event == "open" and isinstance(about[0], str):
            opened.add(about[0])

    sys.addaudithook(listen)
    folder = path.parent / "results"
    run_stages(load_any(path), folder, stages)
    return {
        file
        for file in map(Path, opened)
        if file.is_relative_to(path.parent) and not file.is_relative_to(folder)
    }


def run_stages(
    study: AnyStudy, folder: Path, stages: list[Stage] | None = None
) -> Path:
    """Run stages of a study, all if none are named, and return the folder of the results."""
    for stage in stages_of(study) if stages is None else stages:
        job = Job(study, folder, 1, logging.getLogger("stages in process"))
        for name, value in stage(job):
            job.write(name, value)
    return folder
