"""A lock between processes that is free as soon as its owner is dead, and that nobody waits for without end."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

_LOOK_S = 0.05


@contextmanager
def locked(path: Path, patience_s: float = 0.0) -> Iterator[bool]:
    """Hold the lock of a file, which is made if it is not there, while the block lasts.

    The system frees it when its process ends, however it ends; what the file holds is nobody's. Tells whether no
    other process holds the lock; also true where the system or the folder knows no locks (on some network drives).

    Parameters
    ----------
    path : file of the lock
    patience_s : time for which another process is waited for [s]

    Returns
    -------
    A context that gives whether no other process holds the lock.
    """
    # imported here: it takes longer than what most locks are for
    from filelock import FileLock, Timeout

    lock = FileLock(path, timeout=patience_s)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        lock.acquire(poll_interval=_LOOK_S)
    except Timeout:
        yield False
        return
    except (OSError, NotImplementedError):
        # a folder that may not be written, or ENOSYS, ENOLCK, EOPNOTSUPP
        pass
    try:
        yield True
    finally:
        lock.release()
