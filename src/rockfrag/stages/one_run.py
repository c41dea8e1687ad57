"""One run of a study at a time: who runs it, and what a run that died has left behind."""

import json
import os
import time
import uuid
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

import psutil
from filelock import FileLock, Timeout

from rockfrag.errors import InputError
from rockfrag.files import write_text

RUNS = Path(".snakemake") / "rockfrag"
"""Folder of a lock and of its owner for each study that was run, from the folder in which the workflow runs."""

TOKEN = "ROCKFRAG_RUN"
"""Variable of the environment by which the processes of a run are known, its jobs too."""

_PATIENCE = 10.0
"""Seconds that a process has to end by itself."""


@contextmanager
def only_run(study: str, results: Path) -> Iterator[None]:
    """Be the only run of a study while the block lasts, and end what a dead run has left running.

    The system frees the lock when its process dies, however it dies, so that no lock outlives its owner.
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
    # who holds the lock is said in another file, because a locked one cannot be read everywhere, and that
    # one is always whole
    file = RUNS / f"{study}.json"
    try:
        held = FileLock(RUNS / f"{study}.lock").acquire(timeout=0)
    except Timeout:
        owner = _owner(file)
        since = time.strftime("%H:%M:%S on %Y-%m-%d", time.localtime(owner.get("started", 0)))
        raise InputError(
            f"the study {study} is running in process {owner.get('process', '?')} since {since}; wait "
            f"for it, or end it with 'kill {owner.get('process', '?')}'."
        ) from None
    with held:
        owner = _owner(file)
        if owner.get("token"):
            _end_all(str(owner["token"]))
        # a job that was killed alone leaves some too, though its run has ended as it should
        _remove_parts(results)
        token = uuid.uuid4().hex
        write_text(
            json.dumps({"process": os.getpid(), "started": time.time(), "token": token}), file
        )
        os.environ[TOKEN] = token
        try:
            yield
        finally:
            del os.environ[TOKEN]
            _end_all(token)
            write_text("{}", file)


def _owner(file: Path) -> dict[str, Any]:
    try:
        owner = json.loads(file.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}
    return owner if isinstance(owner, dict) else {}


def _end_all(token: str) -> None:
    """End the other processes of a run, gently first, and those that they started meanwhile."""
    while left := _processes_of(token):
        for end in (psutil.Process.terminate, psutil.Process.kill):
            for process in left:
                with suppress(psutil.NoSuchProcess):
                    end(process)
            deadline = time.monotonic() + _PATIENCE
            while (left := [one for one in left if _works(one)]) and time.monotonic() < deadline:
                time.sleep(0.01)
        if left:
            # the kernel holds them, and ends them when it lets go
            return


def _works(process: psutil.Process) -> bool:
    # one that has ended and whose parent does not ask how does nothing more
    with suppress(psutil.NoSuchProcess):
        return bool(process.is_running() and process.status() != psutil.STATUS_ZOMBIE)
    return False


def _processes_of(token: str) -> list[psutil.Process]:
    """Other processes with this token; those just being started are looked at until they show theirs."""
    found, unknown = [], list(psutil.process_iter())
    deadline = time.monotonic() + _PATIENCE
    while unknown:
        seen = [(process, _token(process)) for process in unknown]
        found += [process for process, its in seen if its == token and process.pid != os.getpid()]
        unknown = [process for process, its in seen if its is None]
        if time.monotonic() > deadline:
            break
        if unknown:
            time.sleep(0.01)
    return found


def _token(process: psutil.Process) -> str | None:
    """Token in the environment of a process, empty if it has none, None if that cannot be told yet."""
    try:
        environment = process.environ()
        # the kernel gives a program its memory before its arguments and environment; a process that has
        # ended, and a thread of the kernel, has no memory
        if not environment and not process.cmdline() and process.memory_info().vms:
            return None
        return str(environment.get(TOKEN, ""))
    except (psutil.Error, OSError):
        # gone meanwhile, or somebody else's
        return ""


def _remove_parts(folder: Path) -> None:
    for part in folder.rglob(".*.part"):
        part.unlink(missing_ok=True)
