"""Logs of the workflow's jobs: to the rule's file, and in short to the terminal."""

import logging
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from rockfrag.errors import InputError


@contextmanager
def logged(path: str, name: str) -> Iterator[logging.Logger]:
    """Log what happens inside the block; an InputError ends the process with its one sentence.

    Parameters
    ----------
    path
        The log file, overwritten.
    name
        Name of the job, which starts each line on the terminal.
    """
    Path(path).parent.mkdir(parents=True, exist_ok=True)
    log = logging.getLogger("rockfrag")
    log.setLevel(logging.INFO)
    log.propagate = False
    to_file = logging.FileHandler(path, mode="w", encoding="utf-8")
    to_file.setFormatter(logging.Formatter("%(asctime)s %(levelname)s %(message)s"))
    to_terminal = logging.StreamHandler(sys.stderr)
    to_terminal.setFormatter(logging.Formatter(f"  {name}: %(message)s"))
    log.handlers = [to_file, to_terminal]
    logging.captureWarnings(True)
    logging.getLogger("py.warnings").handlers = [to_file]
    try:
        yield log
    except InputError as error:
        log.error("%s", error)
        sys.exit(1)
    except Exception:
        # the terminal gets the traceback from Python itself; the file would not
        log.removeHandler(to_terminal)
        log.exception("failed")
        raise
    finally:
        to_file.close()
