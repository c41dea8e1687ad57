"""Logs of the workflow's jobs: what each found, how long it took, one sentence if it failed.

In: what happens in a job. Out: a log file, one sentence on the screen. Docs: ``docs/reliability.md``.
"""

import errno
import logging
import math
import os
import re
import sys
import time
from collections.abc import Iterator
from concurrent.futures import BrokenExecutor
from contextlib import contextmanager, suppress
from pathlib import Path

from rockfrag.base.errors import InputError

_LINE = re.compile(r"\S+ \S+ INFO (.*)")
_TOOK = re.compile(r"took ([0-9.]+) s, ([0-9.]+) s of processors, (\d+|nan) MiB")


@contextmanager
def logged(path: str, name: str) -> Iterator[logging.Logger]:
    """Log what happens inside the block; an error ends the process with one sentence.

    The screen gets that sentence and the path of the log, the log a traceback as well where the error is not one
    of the user's input.
    """
    log = logging.getLogger("rockfrag")
    start = time.monotonic()
    try:
        _log_to(path, log)
        yield log
        took = time.monotonic() - start
        log.info("took %.1f s, %.1f s of processors, %.0f MiB", took, *_used())
    except InputError as error:
        log.error("%s", error)
        _fail(name, str(error), path)
    except KeyboardInterrupt:
        log.error("stopped")
        _fail(name, "it was stopped; the same command takes it up again", path)
    except Exception as error:
        log.exception("failed")
        _fail(name, in_words(error), path)
    finally:
        for handler in log.handlers:
            # what a full disk has not taken is flushed once more, in vain
            with suppress(OSError):
                handler.close()


def _used() -> tuple[float, float]:
    """Processor time of this process and its children [s], and the largest memory of any of them [MiB]."""
    if sys.platform == "win32":
        return time.process_time(), math.nan
    import resource

    both = [
        resource.getrusage(who)
        for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)
    ]
    unit = 2**20 if sys.platform == "darwin" else 2**10
    seconds = sum(usage.ru_utime + usage.ru_stime for usage in both)
    return seconds, max(usage.ru_maxrss for usage in both) / unit


def _log_to(path: str, log: logging.Logger) -> None:
    """Let a log go to a file, without a traceback for each line that a full disk does not take."""
    Path(path).parent.mkdir(parents=True, exist_ok=True)
    to_file = logging.FileHandler(path, mode="w", encoding="utf-8")
    to_file.setFormatter(logging.Formatter("%(asctime)s %(levelname)s %(message)s"))
    log.setLevel(logging.INFO)
    log.propagate = False
    log.handlers = [to_file]
    logging.raiseExceptions = False
    logging.captureWarnings(True)
    logging.getLogger("py.warnings").handlers = [to_file]


_FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)
_FORBIDDEN = (errno.EACCES, errno.EPERM, errno.EROFS)


KILLED = "was killed or ran out of memory; run the study again, with fewer cores if it was memory"


def in_words(error: Exception) -> str:
    """Say an error in a sentence; what a machine lacks is said so that its owner can mend it."""
    # PyArrow and others put the number of the system's error into their message
    number = getattr(error, "errno", None)
    text = " ".join(str(error).split())
    if number in _FULL or any(os.strerror(code) in text for code in _FULL):
        full = "the disk is full or a limit of it is reached"
        return f"{full}; free space, and run it again ({text})."
    if number in _FORBIDDEN:
        name = getattr(error, "filename", None) or "a file"
        return f"{name} may not be written or read; allow it, and run it again."
    if isinstance(error, MemoryError):
        return "there is not enough memory; close other programs or use fewer cores, and run it again."
    if isinstance(error, BrokenExecutor):
        return f"one of its processes {KILLED}"
    return f"{type(error).__name__}: {text}"


def _fail(name: str, sentence: str, path: str) -> None:
    """Say in one line which job failed and why, and end with the exit code 1."""
    line = " ".join(sentence.split())
    print(f"{name} failed: {line:.500} (log: {path})", file=sys.stderr, flush=True)
    sys.exit(1)


def last_finding(path: Path) -> str:
    """What the job of a log found: its last line but that of the time."""
    lines = [found[1] for line in _lines(path) if (found := _LINE.fullmatch(line))]
    return next((line for line in reversed(lines) if not _TOOK.fullmatch(line)), "done")


def says_why(path: Path, since: float) -> bool:
    """Whether a job that began at ``since`` has said in its log why it failed."""
    try:
        return path.stat().st_mtime >= since and any(
            " ERROR " in line for line in _lines(path)
        )
    except OSError:
        return False


def last_seconds(path: Path) -> float | None:
    """How long the job of a log took [s], or None if it did not end."""
    found = [_TOOK.search(line) for line in _lines(path)[-1:]]
    return float(found[0][1]) if found and found[0] else None


def _lines(path: Path) -> list[str]:
    """Lines of a log; none where it is not there."""
    try:
        return path.read_text(encoding="utf-8").splitlines()
    except FileNotFoundError:
        # Snakemake takes away the log of a job whose shell was killed, at any instant
        return []


def check_folders(*folders: Path) -> None:
    """See that all can be written where there is something already; the folders need not be there."""
    for top in folders:
        for folder in [top, *(path for path in top.rglob("*") if path.is_dir())]:
            if folder.is_dir() and not os.access(folder, os.W_OK | os.X_OK):
                raise PermissionError(
                    errno.EACCES, os.strerror(errno.EACCES), str(folder)
                )
