"""A lock between processes that is free as soon as its owner is dead, and that nobody waits for without end."""

import errno
import os
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

try:
    import fcntl
except ImportError:
    # Windows has no flock
    fcntl = None  # type: ignore[assignment]

_LOOK_S = 0.05


@contextmanager
def locked(path: Path, patience_s: float = 0.0) -> Iterator[bool]:
    """Hold the lock of a file, which is made if it is not there, while the block lasts.

    The kernel frees it when its process ends, however it ends. Tells whether no other process holds the lock; also
    true where the system or the folder knows no locks (on some network drives).
    """
    file = None
    free = True
    try:
        if fcntl is not None:
            path.parent.mkdir(parents=True, exist_ok=True)
            file = os.open(path, os.O_RDWR | os.O_CREAT, 0o666)
            free = _taken(file, patience_s)
    except OSError:
        # a folder that may not be written, or ENOSYS, ENOLCK, EOPNOTSUPP
        pass
    try:
        yield free
    finally:
        if file is not None:
            os.close(file)


def _taken(file: int, patience_s: float) -> bool:
    deadline = time.monotonic() + patience_s
    while True:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            return True
        except OSError as error:
            if error.errno not in (errno.EWOULDBLOCK, errno.EACCES):
                raise
        if time.monotonic() >= deadline:
            return False
        time.sleep(_LOOK_S)
