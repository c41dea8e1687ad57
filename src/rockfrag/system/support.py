"""Isolators: a plate under the lowest body that moves horizontally up to a stop (``docs/holding.md``)."""

import math
from dataclasses import dataclass

from rockfrag.base.input_checks import (
    number_from_zero,
    positive_number,
    positive_or_infinite,
    ratio_to_one,
)
from rockfrag.system.contact import Friction, checked_friction

YIELDS_AT = (
    0.001  # displacement of a bilinear isolator at yield, where none is stated [m]
)


@dataclass(frozen=True, kw_only=True)
class Support:
    """What is common to isolators: a plate under the lowest body that moves horizontally, up to a stop.

    Attributes
    ----------
    mass : of the plate [kg]
    stroke : displacement at which it meets its stop, to both sides [m]
    restitution : ratio of the velocities after and before the plate meets the stop [-]
    """

    mass: float
    stroke: float = math.inf
    restitution: float = 0.0

    def __post_init__(self) -> None:
        name = type(self).__name__
        positive_number(f"{name}: mass", self.mass, "kilograms")
        positive_or_infinite(f"{name}: stroke", self.stroke, "metres")
        ratio_to_one(f"{name}: restitution", self.restitution)


@dataclass(frozen=True, kw_only=True)
class SlidingPendulum(Support):
    """A plate that slides in a dish: T = N u/R + µ N sgn u', N the normal force of all above.

    Attributes
    ----------
    radius : of the dish R [m]; infinite: a flat surface
    friction : coefficient of the plate on it, or both of them [-]
    """

    radius: float = math.inf
    friction: float | Friction | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        positive_or_infinite("SlidingPendulum: radius", self.radius, "metres")
        mu = checked_friction("SlidingPendulum: friction", self.friction)
        object.__setattr__(self, "friction", mu)

    @property
    def sliding(self) -> Friction | None:
        """Friction of the plate in the dish; None without any."""
        assert not isinstance(self.friction, float)
        return self.friction


@dataclass(frozen=True, kw_only=True)
class BilinearIsolator(Support):
    """A plate on a bilinear spring: k u and a hysteretic part that yields at Q.

    Attributes
    ----------
    stiffness : k, after yielding [N/m]
    strength : Q [N]
    yield_displacement : at which the hysteretic part reaches Q [m]
    """

    stiffness: float
    strength: float = 0.0
    yield_displacement: float = YIELDS_AT

    def __post_init__(self) -> None:
        super().__post_init__()
        number_from_zero("BilinearIsolator: stiffness", self.stiffness, "N/m")
        number_from_zero("BilinearIsolator: strength", self.strength, "newtons")
        positive_number(
            "BilinearIsolator: yield_displacement", self.yield_displacement, "metres"
        )
