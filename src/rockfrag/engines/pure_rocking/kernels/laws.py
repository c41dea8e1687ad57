"""The laws of impacts (``rockfrag.laws``) as the kernels call them: chosen by number, and inlined.

In: the number of a law, its value, and rates before the impact. Out: the rate at which the contact comes off.
Theory: ``docs/restitution.md``, "The laws".
"""

from collections.abc import Iterable
from functools import reduce
from typing import Any

from rockfrag.engines.compile.jit import inlined_kernel
from rockfrag.laws import Law, laws


@inlined_kernel
def _by_momentum(law, value, by_momentum, before, moved):  # type: ignore[no-untyped-def]
    """Rate that momentum gives: the last resort of :func:`_chosen`."""
    return by_momentum


def _chosen(others: Any, declared: Law) -> Any:
    """Return the function that asks one law for its rate where its number is given, and others elsewhere."""
    number, own = declared.number, inlined_kernel(declared.rate)  # type: ignore[arg-type]

    @inlined_kernel
    def chosen(law, value, by_momentum, before, moved):  # type: ignore[no-untyped-def]
        """Rate by one law, if its number is given, or by the others."""
        if law == number:
            return own(value, by_momentum, before, moved)
        return others(law, value, by_momentum, before, moved)

    return chosen


def _asks(declared: Iterable[Law]) -> Any:
    """Return the function that says whether a number is that of one of some laws."""
    numbers = sum(1 << law.number for law in declared)

    # a membership test would call what numba brings along, which the module of a page cannot hold
    @inlined_kernel
    def known(law):  # type: ignore[no-untyped-def]
        return (numbers >> law) & 1 == 1

    return known


_DECLARED = [law for law in laws() if law.rate is not None]

rate = reduce(_chosen, reversed(_DECLARED), _by_momentum)
"""Rate at which a law lets a contact come off: of the law's number and its value, the rate by momentum,
the rate before, and the one that moved impulses leave."""

moves_impulse = _asks(law for law in _DECLARED if law.moves_impulse)
scales_momentum = _asks(law for law in _DECLARED if law.scales_momentum)
