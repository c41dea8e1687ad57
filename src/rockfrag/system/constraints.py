"""Walls and ties: what acts between one body and the moving ground (``docs/holding.md``).

Places are in metres from the origin of the base of the lowest body as it stands, x and y horizontal, z upwards; in
a planar system y is of no effect.
"""

import math
from dataclasses import dataclass

from rockfrag.base.errors import InputError
from rockfrag.base.input_checks import (
    number_from_zero,
    positive_number,
    positive_or_infinite,
    ratio_to_one,
    real_number,
)
from rockfrag.system.body import Vector3
from rockfrag.system.contact import Friction, checked_friction


@dataclass(frozen=True)
class Wall:
    """An upright rigid face that is fixed to the ground and that any body may hit; a low one is a kerb.

    Attributes
    ----------
    distance : of the face from the origin along ``direction`` [m]
    direction : towards which the wall stands, from x towards y [rad]; of a planar system 0 (right) or π (left)
    height : of its upper edge above the ground [m]; infinite: no body reaches above it
    friction : of body on wall; None: smooth
    restitution : ratio of the normal velocities after and before an impact [-], 0 to 1
    """

    distance: float
    direction: float = 0.0
    height: float = math.inf
    friction: Friction | None = None
    restitution: float = 0.0

    def __post_init__(self) -> None:
        if self.distance != math.inf:
            real_number("Wall: distance", self.distance, "metres")
        real_number("Wall: direction", self.direction, "radians")
        positive_or_infinite("Wall: height", self.height, "metres")
        mu = checked_friction("Wall: friction", self.friction)
        object.__setattr__(self, "friction", mu)
        ratio_to_one("Wall: restitution", self.restitution)

    @property
    def side(self) -> int:
        """Side of a planar system on which it stands: +1 right, -1 left, 0 neither."""
        along = math.cos(self.direction)
        return 0 if abs(along) < 1.0 - 1e-9 else (1 if along > 0.0 else -1)


@dataclass(frozen=True)
class Tie:
    """A cord, a strap or a bracket between a point of one body and a point that moves with the ground.

    Taut, it pulls with F = max(0, k δ + c δ'), δ its length less its natural one.  A bracket pushes likewise
    where it is shorter than its natural length by more than its slack.

    Attributes
    ----------
    point : where it is fastened, in the frame of its body (x, y, z) [m]
    anchor : where it ends (x, y, z) [m]
    stiffness, damping : k [N/m] and c [N s/m]
    slack : by which its natural length exceeds the distance of its ends as the bodies stand [m]
    strength : force at which it breaks, once and for ever [N]
    bracket : whether it pushes too
    body : that it holds, from 0 from below; -1 the uppermost
    """

    point: Vector3
    anchor: Vector3
    stiffness: float
    damping: float = 0.0
    slack: float = 0.0
    strength: float = math.inf
    bracket: bool = False
    body: int = -1

    def __post_init__(self) -> None:
        for name in ("point", "anchor"):
            place = getattr(self, name)
            if not isinstance(place, (tuple, list)) or len(place) != 3:
                raise InputError(
                    f"Tie: {name}: expected (x, y, z) in metres, got {place!r}."
                )
            values = tuple(real_number(f"Tie: {name}", v, "metres") for v in place)
            object.__setattr__(self, name, values)
        positive_number("Tie: stiffness", self.stiffness, "N/m")
        number_from_zero("Tie: damping", self.damping, "N s/m")
        if self.slack != math.inf:
            number_from_zero("Tie: slack", self.slack, "metres")
        positive_or_infinite("Tie: strength", self.strength, "newtons")


Constraint = Wall | Tie  # between one body and the ground
