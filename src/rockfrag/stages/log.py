"""Logs of the workflow's jobs: what each found and how long it took, and one sentence if it failed."""

import logging
import re
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from rockfrag.errors import InputError

_LINE = re.compile(r"\S+ \S+ INFO (.*)")
_TOOK = re.compile(r"took ([0-9.]+) s, ([0-9.]+) s of processors")


@contextmanager
def logged(path: str, name: str) -> Iterator[logging.Logger]:
    """Log what happens inside the block; an error ends the process with one sentence.

    The screen gets that sentence and the path of the log, the log a traceback as well where the error
    is not one of the user's input.

    Parameters
    ----------
    path
        The log file, overwritten.
    name
        Name of the job.
    """
    Path(path).parent.mkdir(parents=True, exist_ok=True)
    log = logging.getLogger("rockfrag")
    log.setLevel(logging.INFO)
    log.propagate = False
    to_file = logging.FileHandler(path, mode="w", encoding="utf-8")
    to_file.setFormatter(logging.Formatter("%(asctime)s %(levelname)s %(message)s"))
    log.handlers = [to_file]
    logging.captureWarnings(True)
    logging.getLogger("py.warnings").handlers = [to_file]
    start = time.monotonic()
    try:
        yield log
        took = time.monotonic() - start
        log.info("took %.1f s, %.1f s of processors", took, time.process_time())
    except InputError as error:
        log.error("%s", error)
        _fail(name, str(error), path)
    except Exception as error:
        log.exception("failed")
        _fail(name, f"{type(error).__name__}: {error}", path)
    finally:
        to_file.close()


def _fail(name: str, sentence: str, path: str) -> None:
    line = " ".join(sentence.split())
    print(f"{name} failed: {line:.500} (log: {path})", file=sys.stderr, flush=True)
    sys.exit(1)


def last_finding(path: Path) -> str:
    """What the job of a log found: its last line but that of the time."""
    lines = [found[1] for line in _lines(path) if (found := _LINE.fullmatch(line))]
    return next((line for line in reversed(lines) if not _TOOK.fullmatch(line)), "done")


def last_seconds(path: Path) -> float | None:
    """How long the job of a log took [s], or None if it did not end."""
    found = [_TOOK.search(line) for line in _lines(path)[-1:]]
    return float(found[0][1]) if found and found[0] else None


def _lines(path: Path) -> list[str]:
    return path.read_text(encoding="utf-8").splitlines() if path.is_file() else []
