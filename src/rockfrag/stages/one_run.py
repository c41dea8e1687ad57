"""One run of a study at a time: who runs it, and what a run that died has left behind."""

import fcntl
import json
import os
import time
import uuid
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import IO, Any

import psutil

from rockfrag.errors import InputError

RUNS = Path(".snakemake") / "rockfrag"
"""Folder of a file for each study that was run, from the folder in which the workflow runs."""

TOKEN = "ROCKFRAG_RUN"
"""Variable of the environment by which the processes of a run are known, its jobs too."""

_PATIENCE = 10.0
"""Seconds that a process has to end by itself."""


@contextmanager
def only_run(study: str, results: Path) -> Iterator[None]:
    """Be the only run of a study while the block lasts, and end what a dead run has left running.

    The kernel frees the lock when its process dies, however it dies, so that no lock outlives its owner.
    Jobs whose run was killed are found by a token in their environment and ended before anything starts;
    half-written files of theirs are removed.

    Parameters
    ----------
    study
        Name of the study.
    results
        Folder of its results.

    Raises
    ------
    InputError
        If the study is running already; says in which process and since when.
    """
    RUNS.mkdir(parents=True, exist_ok=True)
    with (RUNS / f"{study}.json").open("a+", encoding="utf-8") as file:
        owner = _owner(file)
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            since = time.strftime("%H:%M:%S on %Y-%m-%d", time.localtime(owner.get("started", 0)))
            raise InputError(
                f"the study {study} is running in process {owner.get('process', '?')} since {since}; wait "
                f"for it, or end it with 'kill {owner.get('process', '?')}'."
            ) from None
        if owner.get("token"):
            _end_all(str(owner["token"]))
        # a job that was killed alone leaves some too, though its run has ended as it should
        _remove_parts(results)
        token = uuid.uuid4().hex
        _write(file, {"process": os.getpid(), "started": time.time(), "token": token})
        os.environ[TOKEN] = token
        try:
            yield
        finally:
            del os.environ[TOKEN]
            _end_all(token)
            _write(file, {})


def _owner(file: IO[str]) -> dict[str, Any]:
    file.seek(0)
    try:
        owner = json.load(file)
    except ValueError:
        return {}
    return owner if isinstance(owner, dict) else {}


def _write(file: IO[str], owner: dict[str, object]) -> None:
    file.seek(0)
    file.truncate()
    json.dump(owner, file)
    file.flush()


def _end_all(token: str) -> None:
    """End the other processes of a run, gently first."""
    left = [process for process in psutil.process_iter() if _is_of(process, token)]
    for end in (psutil.Process.terminate, psutil.Process.kill):
        for process in left:
            with suppress(psutil.NoSuchProcess):
                end(process)
        left = psutil.wait_procs(left, timeout=_PATIENCE)[1]


def _is_of(process: psutil.Process, token: str) -> bool:
    try:
        return process.pid != os.getpid() and bool(process.environ().get(TOKEN) == token)
    except (psutil.Error, OSError):
        # gone meanwhile, or somebody else's
        return False


def _remove_parts(folder: Path) -> None:
    for part in folder.rglob(".*.part"):
        part.unlink(missing_ok=True)
