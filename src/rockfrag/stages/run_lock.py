"""One run of a study at a time."""

import os
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from rockfrag.errors import InputError
from rockfrag.lock import locked

LOCK = ".run"
"""File in a study's folder that its run holds locked, and that says which process it is."""


@contextmanager
def run_lock(results: Path) -> Iterator[None]:
    """Be the only run of a study while the block lasts; half-written files of a killed one are removed.

    A study that is running already is refused; the message says in which process and since when.
    """
    file = results / LOCK
    with locked(file) as free:
        if not free:
            raise InputError(
                f"{results}: the study is running already, in process {file.read_text()}; wait for it, or "
                "end that process."
            )
        for part in results.rglob(".*.part"):
            part.unlink(missing_ok=True)
        results.mkdir(parents=True, exist_ok=True)
        file.write_text(f"{os.getpid()} since {time.strftime('%H:%M:%S on %Y-%m-%d')}")
        yield
