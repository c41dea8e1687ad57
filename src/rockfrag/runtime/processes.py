"""The same function on many things, in several processes, with results in order; none outlives its parent."""

import multiprocessing
import os
import select
import sys
import threading
import time
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import ProcessPoolExecutor
from typing import Any, TypeVar

T = TypeVar("T")
R = TypeVar("R")

# how often a process looks whether those it belongs to are still there [s]
LOOK_S = 0.2

_waiting: tuple[Callable[[Any], Any], Sequence[Any]] = (str, ())
"""What the processes of :func:`in_processes` have to do."""


def in_processes(
    function: Callable[[T], R], things: Iterable[T], processes: int
) -> list[R]:
    """Call a function for each of several things and return the results in their order, whatever the processes.

    The function may be a local one. Results should be small: a process that was killed while it handed over more
    than a pipe takes at once would leave this one waiting; one killed otherwise raises ``BrokenProcessPool``.

    Parameters
    ----------
    function, things : what is called, and with what, one thing each
    processes : number of processes; 1 calls in this one

    Returns
    -------
    The results, in the order of the things.
    """
    if processes == 1 or "fork" not in multiprocessing.get_all_start_methods():
        return [function(thing) for thing in things]
    global _waiting
    _waiting = (function, [*things])
    fork = multiprocessing.get_context("fork")
    # a worker reads from a pipe that it holds open itself, so it would not see that this process was killed
    parent = (os.getpid(),)
    with ProcessPoolExecutor(
        processes, mp_context=fork, initializer=end_with, initargs=parent
    ) as pool:
        # a fork has everything that is loaded already, and needs to pickle no argument
        return list(pool.map(_call, range(len(_waiting[1])), chunksize=1))


def _call(number: int) -> Any:
    function, things = _waiting
    return function(things[number])


def speak_utf8() -> None:
    """Begin anew where Python takes names of files for ASCII, as with LC_ALL=C; what it starts inherits that."""
    if sys.getfilesystemencoding() != "utf-8":
        os.environ["PYTHONUTF8"] = "1"
        os.execv(sys.executable, [sys.executable, *sys.orig_argv[1:]])


def end_with(process: int) -> None:
    """End this process as soon as its parent, or another process of that number on the same machine, has ended.

    Parameters
    ----------
    process : number of the process whose end is this one's
    """
    threading.Thread(target=_watch, args=(process, os.getppid()), daemon=True).start()


def _watch(process: int, parent: int) -> None:
    """End this process once its parent or another has ended."""
    has_ended = _watcher(process)
    while os.getppid() == parent and not has_ended():
        pass
    os._exit(1)


def _watcher(process: int) -> Callable[[], bool]:
    """Return what waits a moment for the end of a process, and says whether it has ended."""
    try:
        end = os.pidfd_open(process)
    except ProcessLookupError:
        return lambda: True
    except (AttributeError, OSError):
        # no Linux, or an old one
        return lambda: _has_ended(process)
    return lambda: bool(select.select([end], [], [], LOOK_S)[0])


def _has_ended(process: int) -> bool:
    """Whether a process has ended, looked at after a while."""
    time.sleep(LOOK_S)
    if os.name != "posix":
        # there signal 0 would end the process
        return False
    try:
        os.kill(process, 0)
    except OSError:
        return True
    return False
