"""What a measured restitution is, and what kernels are told of it (``docs/restitution.md``)."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from rockfrag.errors import InputError
from rockfrag.input_checks import real_number, shown
from rockfrag.laws import law_named, law_names, ratio
from rockfrag.system import geometry
from rockfrag.system.blocks import Block
from rockfrag.system.contact import BY_MOMENTUM, ImpactLaw
from rockfrag.system.system import System, each_contact

Measured = float | Sequence[float] | None
"""Ratio of the rates after and before an impact of one interface, or the two ratios of impacts that end on the
right and on the left corner; None where momentum is conserved."""


@dataclass(frozen=True)
class MeasuredRestitution:
    """Restitution that was measured, and the law by which a stack follows it.

    The measured number is the ratio of the angular velocities after and before an impact of the lone block on a
    support that does not move; all laws give that.  In a stack, where the support gives way, they differ.

    Attributes
    ----------
    value : of a lone block one ratio [-], or (right, left)
        Of impacts that end on its right and on its left corner.  Of a stack a pair (ground, interface), each
        likewise, or None where momentum is conserved.
    law : name of a law in ``rockfrag.laws``
        ``"position"``: the impulse acts nearer the middle of the base where momentum would leave less, and a
        couple brakes where it would leave more; ``"couple"``: a couple brakes or drives the contact, so that its
        relative velocity is a fixed multiple of what momentum leaves; ``"ratio"``: the relative velocities after
        and before have the measured ratio.
    """

    value: float | Sequence[Measured] | dict[str, Any]
    law: str = "position"

    def __post_init__(self) -> None:
        """Refuse a law that does not exist."""
        if self.law not in law_names():
            raise InputError(
                f"restitution: the law {shown(self.law)} is none of {', '.join(law_names())}."
            )


Restitution = float | Sequence[Measured] | dict[str, Any] | MeasuredRestitution | None
"""A measured restitution; numbers alone follow the law ``"position"``, and None conserves momentum."""


def largest_restitution(block: Block, pivot: int | None = None) -> float:
    """Largest ratio with which no impact of the lone block (on a ``pivot``, or on either) gains energy [-]."""
    if pivot is None:
        return min(largest_restitution(block, +1), largest_restitution(block, -1))
    return geometry.largest_restitution(block.shape, pivot)


def impact_laws(
    system: System, restitution: Restitution, name: str = "restitution"
) -> tuple[ImpactLaw, ...]:
    """Return the law of the impacts of each contact of a system; messages call the restitution by ``name``."""
    law, given = "position", restitution
    if isinstance(restitution, MeasuredRestitution):
        law, given = restitution.law, restitution.value
    if given is None:
        return (BY_MOMENTUM,) * system.count
    wanted = (
        "a pair (ground, interface)" if system.count == 2 else f"{system.count} entries from below"
    )
    wanted = f"a stack takes {wanted}, each of which may be None"
    each = each_contact(name, given, system.count, wanted)
    places = ("block",) if system.count == 1 else ("ground", "interface")
    return tuple(
        _law_of(f"{name} of the {places[min(k, 1)]}", law, value, shape, system.count == 1)
        for k, (value, shape) in enumerate(zip(each, system.carried, strict=True))
    )


def _law_of(name: str, law: str, value: object, shape: geometry.Shape, lone: bool) -> ImpactLaw:
    both = _checked(name, value, shape)
    if both is None:
        return BY_MOMENTUM
    told = [law_named(law).tell(shape, *side) for side in zip(both, (+1, -1), strict=True)]
    if any(math.isnan(number) for _, number in told):
        raise InputError(
            f"{name}: momentum leaves this block nothing to rock on with, so the law {law} has nothing to "
            "multiply; choose the law position or ratio."
        )
    if lone:
        # what was measured is the ratio of the lone body, unless its law makes another one of it
        right, left = (
            number if kind == ratio.NUMBER else measured
            for (kind, number), measured in zip(told, both, strict=True)
        )
        return ImpactLaw("ratio", right, left)
    return ImpactLaw(law, *both)


def _checked(name: str, measured: object, shape: geometry.Shape) -> tuple[float, float] | None:
    """Return the ratios of impacts that end on the right and on the left corner."""
    if measured is None:
        return None
    if isinstance(measured, (tuple, list, np.ndarray)):
        if len(measured) != 2:
            raise InputError(
                f"{name}: expected one ratio, or two of impacts that end on the right and on the left "
                f"corner, got {shown(measured)}."
            )
        right, left = (real_number(name, value) for value in measured)
        bounds = tuple(geometry.largest_restitution(shape, pivot) for pivot in (+1, -1))
    else:
        right = left = real_number(name, measured)
        bounds = (min(geometry.largest_restitution(shape, pivot) for pivot in (+1, -1)),) * 2
    for value, largest in zip((right, left), bounds, strict=True):
        if not 0.0 <= value <= largest:
            raise InputError(
                f"{name}: {value:.6g} would gain energy or is no ratio; give a ratio of angular "
                f"velocities from 0 to at most {largest:.6g}, or None to conserve momentum."
            )
    return right, left
