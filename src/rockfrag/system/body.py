"""One rigid body: its mass properties, and the outlines on which it stands and carries.

Lengths are read in the body's own frame: the origin lies in the plane of its base, z points from the base to the
face, x and y lie in the base.  A planar body moves in the plane of x and z.
"""

import math
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rockfrag.base.errors import InputError
from rockfrag.base.input_checks import positive_number, real_array, real_number, shown

Vector3 = tuple[float, float, float]
Tensor = tuple[Vector3, Vector3, Vector3]


class Interval(NamedTuple):
    """Base or face of a planar body.

    Attributes
    ----------
    left, right : its two ends, left < right [m]
    """

    left: float
    right: float

    @property
    def middle(self) -> float:
        """What lies halfway between its ends [m]."""
        return (self.left + self.right) / 2


class Polygon(NamedTuple):
    """Base or face of a body in space: a convex polygon.

    Attributes
    ----------
    vertices : (x, y) of each, anticlockwise seen from above [m]
    """

    vertices: tuple[tuple[float, float], ...]


class Circle(NamedTuple):
    """Round base or face of a body in space.

    Attributes
    ----------
    radius, centre : the latter as (x, y) [m]
    """

    radius: float
    centre: tuple[float, float] = (0.0, 0.0)


Outline = Interval | Polygon | Circle


@dataclass(frozen=True)
class RigidBody:
    """One rigid body of a system.

    Attributes
    ----------
    mass : [kg]
    inertia : about the centre of gravity [kg m²]
        Of a planar body a number, that about the axis across its plane; of one in space a symmetric tensor (3, 3).
    centre : of gravity (x, y, z) in the body's frame [m]
    base : what the body stands on
    height : of the face above the base [m]
    face : what it carries the next body with; None where nothing stands on it
    name : for tables and messages
    """

    mass: float
    inertia: float | Tensor
    centre: Vector3
    base: Outline
    height: float
    face: Outline | None = None
    name: str = ""

    def __post_init__(self) -> None:
        positive_number("RigidBody: mass", self.mass, "kilograms")
        positive_number("RigidBody: height", self.height, "metres")
        for value in self.centre:
            real_number("RigidBody: centre", value, "metres")
        if isinstance(self.inertia, (int, float, np.floating)):
            positive_number("RigidBody: inertia", self.inertia, "kg m²")
        else:
            object.__setattr__(self, "inertia", checked_tensor(self.inertia))
        outlines = self.base, self.face or self.base
        if any(
            isinstance(outline, Interval) is not self.planar for outline in outlines
        ):
            raise InputError(
                "RigidBody: a planar body has a number as inertia and intervals as base and face, a body in "
                "space a tensor and polygons or circles."
            )

    @property
    def planar(self) -> bool:
        """Whether the body is known in one plane only."""
        return not isinstance(self.inertia, tuple)

    @property
    def width(self) -> float:
        """Width of the base in the plane of x and z [m]."""
        left, right = interval_of(self.base, (1.0, 0.0))
        return right - left

    @property
    def ends(self) -> tuple[Interval, Interval]:
        """Base and face of a planar body; without a face the base again."""
        base, face = self.base, self.face or self.base
        assert isinstance(base, Interval)
        assert isinstance(face, Interval)
        return base, face

    @property
    def tensor(self) -> NDArray[np.float64]:
        """Tensor of inertia of a body in space about its centre of gravity [kg m²], shape (3, 3)."""
        return np.array(self.inertia)

    def seen_along(self, direction_deg: float = 0.0) -> "RigidBody":
        """Return the planar body that moves in the vertical plane of a direction, from x towards y [degrees]."""
        if self.planar:
            if direction_deg % 360:
                raise InputError(
                    "direction: a planar body is known in its own plane only; give its depth."
                )
            return self
        angle = math.radians(direction_deg)
        # the body's x axis is met exactly
        along = math.cos(angle), math.sin(angle)
        x, y, z = self.centre
        (xx, xy, _), (_, yy, _), _ = self.inertia  # type: ignore[misc]
        return replace(
            self,
            inertia=along[1] ** 2 * xx
            - 2 * along[0] * along[1] * xy
            + along[0] ** 2 * yy,
            centre=(x * along[0] + y * along[1], 0.0, z),
            base=interval_of(self.base, along),
            face=None if self.face is None else interval_of(self.face, along),
        )


def interval_of(outline: Outline, along: tuple[float, float]) -> Interval:
    """Return the ends of an outline along a horizontal direction, a unit vector."""
    if isinstance(outline, Interval):
        return outline
    if isinstance(outline, Circle):
        middle = outline.centre[0] * along[0] + outline.centre[1] * along[1]
        return Interval(middle - outline.radius, middle + outline.radius)
    at = [x * along[0] + y * along[1] for x, y in outline.vertices]
    return Interval(min(at), max(at))


def checked_tensor(given: object) -> Tensor:
    """Return a tensor of inertia as three rows; it must be symmetric and that of a body.

    Parameters
    ----------
    given : a tensor about the centre of mass, shape (3, 3) [kg m²]

    Returns
    -------
    Its rows [kg m²].
    """
    values = real_array("RigidBody: inertia", given, "kg m²")
    if values.shape != (3, 3) or not np.isfinite(values).all():
        raise InputError(
            f"RigidBody: inertia is a number of kg m² or a tensor of shape (3, 3), got {shown(given)}."
        )
    if not np.allclose(
        values, values.T, rtol=1e-9, atol=1e-12 * float(np.abs(values).max())
    ):
        raise InputError("RigidBody: the tensor of inertia must be symmetric.")
    moments = np.linalg.eigvalsh(values)
    if not moments[0] > 0 or moments[2] > (moments[0] + moments[1]) * (1 + 1e-9):
        raise InputError(
            f"RigidBody: no body has the principal moments of inertia {shown(moments.round(6).tolist())}; each is "
            "positive and at most the sum of the other two."
        )
    rows = values.tolist()
    return (tuple(rows[0]), tuple(rows[1]), tuple(rows[2]))
