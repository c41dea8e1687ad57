"""The laws of impacts (``rockfrag.laws``) as the kernels call them: chosen by number, and inlined."""

from collections.abc import Sequence
from typing import Any

from rockfrag.engines.kernels.jit import inlined_kernel
from rockfrag.laws import Law, laws


def _chosen(of: Sequence[Law]) -> Any:
    """Return the function that asks the law of a number for its rate; the last law answers for all others."""
    law = of[0]
    number, own = law.number, inlined_kernel(law.rate)  # type: ignore[arg-type]
    if not of[1:]:
        return own_rate(own)
    others = _chosen(of[1:])

    @inlined_kernel
    def chosen(law, value, by_momentum, before, moved):  # type: ignore[no-untyped-def]
        if law == number:
            return own(value, by_momentum, before, moved)
        return others(law, value, by_momentum, before, moved)

    return chosen


def own_rate(own: Any) -> Any:
    """Return the function of a law's number that is the rate of one law."""

    @inlined_kernel
    def chosen(law, value, by_momentum, before, moved):  # type: ignore[no-untyped-def]
        return own(value, by_momentum, before, moved)

    return chosen


def _any_of(of: Sequence[Law]) -> Any:
    """Return the function that says whether a number is that of one of some laws, at least one."""
    number = of[0].number
    others = _any_of(of[1:]) if of[1:] else None

    # a membership test would call what numba brings along, which the module of a page cannot hold
    if others is None:

        @inlined_kernel
        def known(law):  # type: ignore[no-untyped-def]
            return law == number
    else:

        @inlined_kernel
        def known(law):  # type: ignore[no-untyped-def]
            return law == number or others(law)

    return known


_DECLARED = [law for law in laws() if law.rate is not None]

rate = _chosen(_DECLARED)
"""Rate at which a law lets a contact come off: of the law's number and its value, the rate by momentum,
the rate before, and the one that moved impulses leave."""

moves_impulse = _any_of([law for law in _DECLARED if law.moves_impulse])
scales_momentum = _any_of([law for law in _DECLARED if law.scales_momentum])
