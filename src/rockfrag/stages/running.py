"""Running a study's stages as the workflow does: what comes before the first job, and one job."""

import os
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from rockfrag.errors import InputError
from rockfrag.files import write_text
from rockfrag.stages.log import logged
from rockfrag.stages.stage import Job, Stage
from rockfrag.study.loading import AnyStudy, any_study
from rockfrag.study.records import check_records
from rockfrag.study.study import Study

RESULTS = Path("results")
"""Folder of all studies' results, from the folder in which the workflow runs."""

OWNER = "configuration.txt"
"""File in a study's folder that names the configuration whose results these are."""


def prepared(content: Mapping[str, Any], path: str | os.PathLike[str]) -> tuple[AnyStudy, Path]:
    """Make all checks that come before the first job.

    Parameters
    ----------
    content
        The configuration as read.
    path
        The file it was read from.

    Returns
    -------
    The study, and the folder of its results.

    Raises
    ------
    InputError
        One sentence about the first thing that is wrong.
    """
    study = any_study(content, path)
    folder = results_folder(study)
    if isinstance(study, Study) and not (folder / "motions" / "records.parquet").exists():
        check_records(study)
    return study, folder


def results_folder(study: AnyStudy) -> Path:
    """Folder of a study's results.

    Raises
    ------
    InputError
        If the results of another configuration are there.
    """
    folder = RESULTS / study.name
    owner = folder / OWNER
    if owner.is_file():
        other = owner.read_text(encoding="utf-8").strip()
        if other != _named(study) and Path(other).is_file():
            raise InputError(
                f"{study.source}: key study: {folder} holds the results of {other}; give this study a "
                "name of its own, or remove that folder."
            )
    return folder


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
    folder = RESULTS / study.name
    with logged(log_file, name) as log:
        write_text(f"{_named(study)}\n", folder / OWNER)
        job = Job(study, stage, folder, threads, log)
        for result, value in stage.run(job):
            job.write(result, value)


def _named(study: AnyStudy) -> str:
    return Path(os.path.relpath(study.source)).as_posix()
