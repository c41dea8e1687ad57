"""Running a study's stages as the workflow does: what comes before the first job, and one job."""

import os
from collections.abc import Iterable, Mapping
from importlib import import_module
from pathlib import Path
from typing import Any

from rockfrag.errors import InputError
from rockfrag.files import write_text
from rockfrag.processes import end_with
from rockfrag.stages.job import Job
from rockfrag.stages.log import logged
from rockfrag.study.loading import AnyStudy, any_study, check_records
from rockfrag.study.study import Study

RESULTS = Path("results")
"""Folder of all studies' results, from the folder in which the workflow runs."""

OWNER = "configuration.txt"
"""File in a study's folder that names the configuration whose results these are."""

RUN = "ROCKFRAG_RUN"
"""Variable of the environment: the process of the run, with which its jobs end."""


def prepared(content: Mapping[str, Any], path: str | os.PathLike[str]) -> tuple[AnyStudy, Path]:
    """Make all checks that come before the first job; return the study, and the folder of its results."""
    study = any_study(content, path)
    folder = results_folder(study)
    if isinstance(study, Study) and not (folder / "motions" / "records.parquet").exists():
        check_records(study)
    return study, folder


def results_folder(study: AnyStudy) -> Path:
    """Folder of a study's results; refuse one that holds those of another configuration."""
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


def run_job(
    stage: str,
    config: Mapping[str, Any],
    study_file: str,
    *,
    inputs: Iterable[str],
    outputs: Iterable[str],
    part: int,
    threads: int,
    log_file: str,
) -> None:
    """Run a stage of a study (``module:function``), as a job of the workflow does, and write what it yields.

    Inputs and outputs are the paths that the rule declares; the stem of the log names the job. For ``part`` see
    :class:`rockfrag.stages.job.Job`.
    """
    end_with_run()
    module, _, function = stage.partition(":")
    with logged(log_file, Path(log_file).stem) as log:
        study = any_study(config, study_file)
        folder = RESULTS / study.name
        write_text(f"{_named(study)}\n", folder / OWNER)
        declared = [frozenset(Path(path) for path in paths) for paths in (inputs, outputs)]
        job = Job(study, folder, threads, log, part, *declared)
        for name, value in getattr(import_module(module), function)(job):
            job.write(name, value)


def end_with_run() -> None:
    """Let this job end as soon as its run does, or the shell in which the run started it."""
    if RUN in os.environ:
        end_with(int(os.environ[RUN]))


def _named(study: AnyStudy) -> str:
    return Path(os.path.relpath(study.source)).as_posix()
