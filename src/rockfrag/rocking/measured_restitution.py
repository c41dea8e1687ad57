"""What a measured restitution is, and what kernels are told of it (``docs/restitution.md``)."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np

from rockfrag.errors import InputError
from rockfrag.input_checks import real_number, shown
from rockfrag.system import geometry
from rockfrag.system.blocks import Block, Body
from rockfrag.system.geometry import COUPLE, RATIO

Law = Literal["position", "couple", "ratio"]
"""How the restitution of a lone block is carried over to a stack."""

LAWS: tuple[Law, ...] = get_args(Law)

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
    value
        Of a lone block one ratio [-], or (right, left): of impacts that end on its right and on its left corner.
        Of a stack a pair (ground, interface), each of them likewise, or None where momentum is conserved.
    law
        ``"position"``: the impulse acts nearer the middle of the base where momentum would leave less, and a
        couple brakes where it would leave more; ``"couple"``: a couple brakes or drives the contact, so that its
        relative velocity is a fixed multiple of what momentum leaves; ``"ratio"``: the relative velocities after
        and before have the measured ratio.
    """

    value: float | Sequence[Measured]
    law: Law = "position"

    def __post_init__(self) -> None:
        """Refuse a law that does not exist.

        Raises
        ------
        InputError
            If ``law`` is none of the three.
        """
        if self.law not in LAWS:
            raise InputError(
                f"restitution: the law {shown(self.law)} is none of {', '.join(LAWS)}."
            )


Restitution = float | Sequence[Measured] | MeasuredRestitution | None
"""A measured restitution; numbers alone follow the law ``"position"``, and None conserves momentum."""

After = tuple[int, float]
"""Law and number of the impacts that end on one corner, as the kernels have them (``kernels.equations.AFTER``)."""

BY_MOMENTUM: After = (0, 1.0)


def largest_restitution(block: Block, pole: int | None = None) -> float:
    """Largest ratio of angular velocities with which no impact of the lone block gains energy [-].

    Parameters
    ----------
    pole
        The corner that comes down, +1 or -1; of both the lesser if it is None, which is 1 for a symmetric block.
    """
    if pole is None:
        return min(largest_restitution(block, +1), largest_restitution(block, -1))
    return geometry.largest_restitution(block.shape, pole)


def impulse_position(block: Block, restitution: float, pole: int) -> float:
    """Where the impulse of a closing base acts, if the lone block comes off with ``restitution``.

    The angular momentum about the point of the impulse is conserved; conserving it about the new pole
    (position 1) gives :meth:`Block.momentum_restitution`, about the middle of the base (position 0) of
    a symmetric block gives 1.

    Parameters
    ----------
    restitution
        ω⁺ / ω⁻ of the lone block on a rigid base [-].
    pole
        The corner that comes down, +1 or -1.

    Returns
    -------
    Position σ of the impulse in half widths from the middle towards the new pole [-].
    """
    return geometry.impulse_position(block.shape, restitution, pole)


def lone_restitution(block: Block, restitution: Restitution) -> tuple[float, float] | None:
    """Return the checked restitution of a lone block, of impacts that end on its right and on its left corner.

    None if momentum is conserved.

    Raises
    ------
    InputError
        If it does not fit the block or would add energy.
    """
    if isinstance(restitution, MeasuredRestitution):
        restitution = restitution.value
    return _checked("restitution of the block", restitution, block)


def stack_restitution(body: Body, restitution: Restitution) -> tuple[After, After, After, After]:
    """Return how ground and interface come off impacts that end on their right and left corners.

    Of a lone block, which the interface stands for, all laws are the same.

    Raises
    ------
    InputError
        If the restitution does not fit the body or would add energy.
    """
    if isinstance(body, Block):
        both = lone_restitution(body, restitution)
        if both is None:
            return (BY_MOMENTUM,) * 4
        return BY_MOMENTUM, BY_MOMENTUM, (RATIO, both[0]), (RATIO, both[1])
    law = restitution.law if isinstance(restitution, MeasuredRestitution) else "position"
    given = restitution.value if isinstance(restitution, MeasuredRestitution) else restitution
    if given is None:
        return (BY_MOMENTUM,) * 4
    if not (isinstance(given, (tuple, list, np.ndarray)) and len(given) == 2):
        raise InputError(
            "restitution: a stack takes a pair (ground, interface), each of which may be None, "
            f"got {shown(given)}."
        )
    blocks = body.pedestal, body.contact_statue
    names = "restitution of the ground", "restitution of the interface"
    afters = []
    for name, value, block in zip(names, given, blocks, strict=True):
        both = _checked(name, value, block)
        for at, pole in enumerate((+1, -1)):
            afters.append(BY_MOMENTUM if both is None else _after(name, block, both[at], pole, law))
    return afters[0], afters[1], afters[2], afters[3]


def _after(name: str, block: Block, value: float, pole: int, law: Law) -> After:
    """Law and number of the impacts of an interface that end on a corner of the block above it."""
    by_momentum = block.momentum_restitution(-pole)
    if law == "ratio":
        return RATIO, value
    if by_momentum <= 0 and not (law == "position" and value >= by_momentum):
        raise InputError(
            f"{name}: momentum leaves this block nothing to rock on with, so the law {law} has nothing to "
            "multiply; choose the law position or ratio."
        )
    if law == "position":
        return geometry.by_position(block.shape, value, pole)
    return COUPLE, value / by_momentum


def _checked(name: str, measured: object, block: Block) -> tuple[float, float] | None:
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
        bounds = largest_restitution(block, +1), largest_restitution(block, -1)
    else:
        right = left = real_number(name, measured)
        bounds = (largest_restitution(block),) * 2
    for value, largest in zip((right, left), bounds, strict=True):
        if not 0.0 <= value <= largest:
            raise InputError(
                f"{name}: {value:.6g} would gain energy or is no ratio; give a ratio of angular "
                f"velocities from 0 to at most {largest:.6g}, or None to conserve momentum."
            )
    return right, left
