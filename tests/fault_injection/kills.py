"""Killing every kind of process of a run, at moments spread over the time that it is there."""

import random
import shutil
import signal
import subprocess
import tempfile
import time
from collections.abc import Callable, Mapping
from contextlib import suppress
from functools import partial
from pathlib import Path

import psutil

from .studies import PATIENCE_S, Study, Tally

FORGOTTEN = (
    ("report.html",),
    ("report.html", "measures.*"),
    ("report.html", "tests.*"),
)
"""Results that a trial makes anew, of which the first and the second are made by pools."""

# a run that was disturbed says why in so many lines, beside those of its stages
LONGEST_WORDS = 8


def shell(run: psutil.Process) -> list[psutil.Process]:
    """Shells in which Snakemake starts the jobs of a run."""
    return [
        item
        for item in _family(run)
        if Path((_words(item) or [""])[0]).name in ("bash", "sh")
    ]


def job(run: psutil.Process) -> list[psutil.Process]:
    """Jobs of a run, without the workers of their pools."""
    return [item for item in _family(run) if _is_job(item) and not _is_worker(item)]


def worker(run: psutil.Process) -> list[psutil.Process]:
    """Workers of the pools of a run's jobs."""
    return [item for item in _family(run) if _is_worker(item)]


def itself(run: psutil.Process) -> list[psutil.Process]:
    """The process that the user started."""
    return [run]


def everything(run: psutil.Process) -> list[psutil.Process]:
    """All processes of a run."""
    return [run, *_family(run)]


def _family(run: psutil.Process) -> list[psutil.Process]:
    with suppress(psutil.NoSuchProcess):
        return run.children(recursive=True)
    return []


def _words(process: psutil.Process) -> list[str]:
    """What a process was started with; nothing of one that has ended meanwhile."""
    with suppress(psutil.NoSuchProcess):
        return list(process.cmdline())
    return []


def _is_job(process: psutil.Process) -> bool:
    words = _words(process)
    return len(words) > 1 and "python" in words[0] and ".snakemake/scripts" in words[-1]


def _is_worker(process: psutil.Process) -> bool:
    with suppress(psutil.NoSuchProcess):
        parent = process.parent()
        return parent is not None and _is_job(process) and _is_job(parent)
    return False


Kind = Callable[[psutil.Process], list[psutil.Process]]


def killed(study: Study, tally: Tally, rng: random.Random, kind: Kind) -> None:
    """Kill processes of a kind in a user's study and in those that come with the project."""
    for user in [study] * USERS + study.beside * SHIPPED:
        user.forget(
            *(FORGOTTEN[rng.randrange(2)] if kind is worker else rng.choice(FORGOTTEN))
        )
        _disturbed(user, tally, rng, kind, 0.5)


def compiling(study: Study, tally: Tally, rng: random.Random) -> None:
    """Kill a job, or all processes, while machine code is made, of which there is none at first."""
    cache = Path(tempfile.mkdtemp(prefix="machine code "))
    study.more["NUMBA_CACHE_DIR"] = str(cache)
    for number in range(COMPILING):
        shutil.rmtree(cache, ignore_errors=True)
        study.forget("report.html", "ida/*")
        _disturbed(study, tally, rng, (job, everything)[number % 2], 15.0)
    shutil.rmtree(cache, ignore_errors=True)


def _disturbed(
    study: Study, tally: Tally, rng: random.Random, kind: Kind, moment_s: float
) -> None:
    """Kill the processes of a kind once, up to a moment after they have appeared, and run the study again."""
    process = study.start()
    run = psutil.Process(process.pid)
    while process.poll() is None and not (kind(run) and job(run)):
        time.sleep(0.02)
    time.sleep(rng.uniform(0.0, moment_s))
    with suppress(psutil.NoSuchProcess):
        family = everything(run)
        for victim in kind(run):
            with suppress(psutil.NoSuchProcess):
                victim.send_signal(rng.choice([signal.SIGKILL, signal.SIGTERM]))
    try:
        _, words = process.communicate(timeout=PATIENCE_S)
    except subprocess.TimeoutExpired:
        tally.noise.append(f"stood still after {kind.__name__} was killed")
        process.kill()
        return
    left = psutil.wait_procs(family, timeout=10)[1]
    tally.noise += [f"left running: {item.cmdline()}" for item in left]
    said = [line for line in words.splitlines() if not line.startswith("[")]
    if "Traceback" in words or len(said) > LONGEST_WORDS:
        tally.noise.append(f"says too much: {words[-300:]!r}")
    study.judge(tally, study.run())


USERS, SHIPPED, COMPILING = 6, 2, 10
"""Kills of each kind in a user's study and in each of two that come with the project, and while compiling."""

KINDS: Mapping[str, Callable[[Study, Tally, random.Random], None]] = {
    "run killed": partial(killed, kind=itself),
    "shell of a job killed": partial(killed, kind=shell),
    "job killed": partial(killed, kind=job),
    "worker of a pool killed": partial(killed, kind=worker),
    "all processes killed": partial(killed, kind=everything),
    "killed while compiling": compiling,
}
