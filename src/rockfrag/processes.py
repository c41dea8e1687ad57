"""The same function on many things, in several processes, with results in order."""

import multiprocessing
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import ProcessPoolExecutor
from typing import Any, TypeVar

T = TypeVar("T")
R = TypeVar("R")

_waiting: tuple[Callable[[Any], Any], Sequence[Any]] = (str, ())
"""What the processes of :func:`in_processes` have to do."""


def in_processes(function: Callable[[T], R], things: Iterable[T], processes: int) -> list[R]:
    """Call a function for each of several things and return the results in their order.

    Parameters
    ----------
    function
        What to call; it may be a local one, as the processes are copies of this one.
    things
        What to call it with; taken one at a time by one process, all at once by several.
    processes
        How many processes may work at once; the results do not depend on it.

    Raises
    ------
    concurrent.futures.process.BrokenProcessPool
        If one of them was killed.
    """
    if processes == 1 or "fork" not in multiprocessing.get_all_start_methods():
        return [function(thing) for thing in things]
    global _waiting
    _waiting = (function, [*things])
    fork = multiprocessing.get_context("fork")
    with ProcessPoolExecutor(processes, mp_context=fork) as pool:
        # a fork has everything that is loaded already, and needs to pickle no argument
        return list(pool.map(_call, range(len(_waiting[1])), chunksize=1))


def _call(number: int) -> Any:
    function, things = _waiting
    return function(things[number])
