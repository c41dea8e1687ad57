"""What lies between two bodies: friction, the law of impacts, and how the upper one was set on the lower."""

import math
import numbers
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from rockfrag.base.errors import InputError
from rockfrag.base.input_checks import real_number, shown
from rockfrag.system.bond import Bond

ROUGHEST = 1e6
"""Larger coefficients, infinite ones too, are taken as this one: a contact that is about to lift off while it
carries a shear then slides off, as in the limit, and no case of its own is needed."""


class Friction(NamedTuple):
    """Friction of one contact.

    Attributes
    ----------
    static, kinetic : its coefficients [-], at most ``ROUGHEST``
    """

    static: float
    kinetic: float


class ImpactLaw(NamedTuple):
    """How a contact comes off an impact.

    Attributes
    ----------
    name : of a law in ``rockfrag.laws``
    right, left : measured ratio of the angular velocities after and before an impact of the lone body on a rigid
        support [-], of impacts that end on its right and on its left end; NaN where the law has no number
    """

    name: str = "momentum"
    right: float = math.nan
    left: float = math.nan


BY_MOMENTUM = ImpactLaw()  # angular momentum about the new pivot is conserved


@dataclass(frozen=True)
class Contact:
    """What lies under one body of a system.

    Attributes
    ----------
    friction : its coefficients; None: the contact never slides and no body leaves it
    law : of its impacts
    tilt : angle by which an uneven base turns the body clockwise on the face below [rad]
    offset : of the origin of the body's base from that of the face below (x, y) [m]; of no effect on the ground
    bond : that keeps it shut until it breaks; None: none
    """

    friction: Friction | None = None
    law: ImpactLaw = BY_MOMENTUM
    tilt: float = 0.0
    offset: tuple[float, float] = (0.0, 0.0)
    bond: Bond | None = None

    def __post_init__(self) -> None:
        real_number("Contact: tilt", self.tilt, "radians")
        for value in self.offset:
            real_number("Contact: offset", value, "metres")
        if not (self.bond is None or isinstance(self.bond, Bond)):
            raise InputError(f"Contact: bond: expected a Bond, got {shown(self.bond)}.")


def checked_friction(name: str, value: object) -> Friction | None:
    """Return the friction of a contact of a coefficient, a pair (static, kinetic), a Friction or None.

    Parameters
    ----------
    name : of the argument, with which a message begins
    value : as said above; None: it never slides

    Returns
    -------
    The coefficients (static, kinetic) [-], or None.
    """
    if value is None:
        return None
    if isinstance(value, np.ndarray) and value.ndim == 0:
        value = value.item()
    pair = (value, value) if isinstance(value, numbers.Real) else value
    if not isinstance(pair, (list, tuple, np.ndarray)) or len(pair) != 2:
        raise InputError(
            f"{name}: expected a coefficient or a pair (static, kinetic), got {shown(value)}."
        )
    for number in pair:
        known = isinstance(number, numbers.Real) and not isinstance(
            number, (bool, np.bool_)
        )
        if not known or math.isnan(number) or number < 0:
            raise InputError(
                f"{name}: a coefficient is 0 or more, got {shown(number)}."
            )
    static, kinetic = min(float(pair[0]), ROUGHEST), min(float(pair[1]), ROUGHEST)
    if kinetic > static:
        raise InputError(
            f"{name}: the static coefficient {static:g} is less than the kinetic one {kinetic:g}; "
            "give (static, kinetic)."
        )
    return Friction(static, kinetic)
