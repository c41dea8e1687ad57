"""What a user says about friction, checked: static and kinetic coefficients of each interface."""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from rockfrag.errors import InputError
from rockfrag.rocking.bodies import Block, Body


class Friction(NamedTuple):
    """Coefficients of friction of one interface [-], at most ``ROUGHEST``."""

    static: float
    kinetic: float


ROUGHEST = 1e6
"""Larger coefficients, infinite ones too, are taken as this one: a contact that is about to lift off while it
carries a shear then slides off, as in the limit, and no case of its own is needed."""

FrictionInput = float | Sequence[float | tuple[float, float]]
"""A number for a lone block; (ground, interface) for a stack; a pair (static, kinetic) in place of a number."""


def interface_frictions(body: Body, friction: FrictionInput) -> tuple[Friction, ...]:
    """Return the friction of each interface of a body, the ground first.

    Parameters
    ----------
    body
        A block (one interface) or a stack (two).
    friction
        A lone block takes a coefficient, or a pair (static, kinetic).  A stack takes (ground, interface),
        each a coefficient or a pair; one number alone holds at both.

    Raises
    ------
    InputError
        If the numbers do not fit the body, one is negative or not a number, or a static coefficient is
        less than the kinetic one.
    """
    if isinstance(friction, (int, float, np.number)):
        given: list[object] = [friction] * (1 if isinstance(body, Block) else 2)
    elif isinstance(body, Block):
        given = [friction]
    else:
        if not isinstance(friction, (list, tuple)) or len(friction) != 2:
            raise InputError(
                f"friction: a stack takes (ground, interface), each a coefficient or a pair (static, "
                f"kinetic), got {friction!r}."
            )
        given = list(friction)
    names = ("ground", "interface")
    return tuple(_one(name, value) for name, value in zip(names, given, strict=False))


def _one(name: str, value: object) -> Friction:
    pair = (value, value) if isinstance(value, (int, float, np.number)) else value
    if not isinstance(pair, (list, tuple)) or len(pair) != 2:
        raise InputError(
            f"friction of the {name}: expected a coefficient or a pair, got {value!r}."
        )
    for number in pair:
        known = isinstance(number, (int, float, np.number)) and not isinstance(number, bool)
        if not known or math.isnan(number) or number < 0:
            raise InputError(
                f"friction of the {name}: a coefficient is 0 or more, got {number!r} in {value!r}."
            )
    static, kinetic = (min(float(number), ROUGHEST) for number in pair)
    if kinetic > static:
        raise InputError(
            f"friction of the {name}: the static coefficient {static} is less than the kinetic one "
            f"{kinetic}; give (static, kinetic)."
        )
    return Friction(static, kinetic)
