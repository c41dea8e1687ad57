"""Running one stage of one study, as a job of the workflow does."""

import time
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from rockfrag.stages.log import logged
from rockfrag.stages.stage import Job, Stage

RESULTS = Path("results")
"""Folder of all studies' results, from the folder in which the workflow runs."""


def run_stage(
    name: str, stages: Iterable[Stage[Any]], study: Any, threads: int, log_file: str
) -> None:
    """Run the stage called ``name`` and write what it yields.

    Parameters
    ----------
    name
        Name of the stage.
    stages
        Stages of the study.
    study
        The study.
    threads
        Threads that it may use.
    log_file
        Path of its log.
    """
    stage = next(one for one in stages if one.name == name)
    start = time.monotonic()
    with logged(log_file, name) as log:
        job = Job(study, stage, RESULTS / study.name, threads, log)
        for result, value in stage.run(job):
            job.write(result, value)
        log.debug("%.1f s", time.monotonic() - start)
