"""Rigid blocks and stacks of two: what every integrator, fast or plain, starts from.

Conventions (thesis chapter 2, ``docs/derivation.md``): a rotation θ > 0 is clockwise and its pole is the
right corner, s = +1; an acceleration a > 0 of the ground pushes blocks towards θ < 0.  Lengths are read
in the standing block's frame, x to the right and y up, and
R(θ)(x, y) = (x cos θ + y sin θ, -x sin θ + y cos θ) turns a vector clockwise.
"""

import math
import os
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

from rockfrag.errors import InputError
from rockfrag.rocking.checks import positive_number, real_number, shown
from rockfrag.rocking.kernels.elementary import atan2, hypot, sin_cos
from rockfrag.units import STANDARD_GRAVITY


class Vector(NamedTuple):
    """A vector in the plane [m]: x to the right, y up."""

    x: float
    y: float

    def turned(self, angle: float) -> "Vector":
        """Turn clockwise by ``angle`` [rad]: R(angle)(x, y)."""
        s, c = sin_cos(angle)
        return Vector(self.x * c + self.y * s, -self.x * s + self.y * c)

    def minus(self, other: "Vector") -> "Vector":
        """Return the vector from ``other``'s tip to this one's."""
        return Vector(self.x - other.x, self.y - other.y)


@dataclass(frozen=True)
class Block:
    """A rigid body that stands on two edges.

    Parameters
    ----------
    width
        Distance between the two edges it stands and rocks on, 2b [m].
    height
        Height of the block, 2h [m]; a statue on a pedestal stands at the pedestal's height.
    mass
        Mass [kg].
    inertia
        Moment of inertia about the centre of gravity [kg m²]; that of a uniform rectangle,
        m (b² + h²) / 3, if not given.
    cg_height
        Height of the centre of gravity above the base [m]; half the height if not given.
    cg_offset
        Distance of the centre of gravity to the right of the middle of the base [m].
    lean
        Angle by which an uneven base makes the block lean clockwise as it stands [rad].

    Raises
    ------
    InputError
        If a length, mass or inertia is not positive, or if the block cannot stand because its centre
        of gravity is not above its base.
    """

    width: float
    height: float
    mass: float
    inertia: float | None = None
    cg_height: float | None = None
    cg_offset: float = 0.0
    lean: float = 0.0

    def __post_init__(self) -> None:
        positive_number("Block: width", self.width, "metres")
        positive_number("Block: height", self.height, "metres")
        positive_number("Block: mass", self.mass, "kilograms")
        if self.inertia is not None:
            positive_number("Block: inertia", self.inertia, "kg m²")
        if self.cg_height is not None:
            positive_number("Block: cg_height", self.cg_height, "metres")
        real_number("Block: cg_offset", self.cg_offset, "metres")
        real_number("Block: lean", self.lean, "radians")
        if not min(self.critical_angle(+1), self.critical_angle(-1)) > 0:
            raise InputError(
                f"Block: with cg_offset {self.cg_offset} m and lean {self.lean} rad its centre of "
                f"gravity is not above its base of {self.width} m, so it cannot stand."
            )

    @classmethod
    def from_edges(
        cls,
        left: float,
        right: float,
        *,
        cg_height: float,
        height: float,
        mass: float,
        inertia: float,
    ) -> "Block":
        """Make a block of the distances at which its edges were measured.

        Parameters
        ----------
        left, right
            Horizontal distances of the edges from the centre of gravity [m].
        cg_height, height
            Height of the centre of gravity above the base, and of the whole body [m].
        mass
            Mass [kg].
        inertia
            Moment of inertia about the centre of gravity [kg m²].

        Raises
        ------
        InputError
            As :class:`Block`.
        """
        return cls(
            width=left + right,
            height=height,
            mass=mass,
            inertia=inertia,
            cg_height=cg_height,
            cg_offset=(left - right) / 2,
        )

    @classmethod
    def from_mesh(
        cls,
        path: str | os.PathLike[str],
        *,
        direction_deg: float,
        contact_tolerance: float,
        edge_retreat: float = 0.0,
        mass: float | None = None,
        density: float | None = None,
        metres_per_unit: float = 1.0,
    ) -> "Block":
        """Make the planar block that a body of any shape is in one direction of shaking.

        Parameters
        ----------
        path
            Closed mesh as OBJ, PLY or STL with z up, see :func:`rockfrag.rocking.shapes.read_shape`.
        direction_deg
            Direction of shaking, from the mesh's x axis towards its y axis [degrees].
        contact_tolerance
            Height above the lowest point up to which points carry [m].
        edge_retreat
            Distance by which the edges carry further in than those points [m].
        mass, density
            Mass [kg] or density [kg/m³]; one of them.
        metres_per_unit
            Length of the mesh's unit [m].

        Raises
        ------
        InputError
            If the mesh cannot be used, or the body could not stand so.
        """
        from rockfrag.rocking.shapes import read_shape

        shape = read_shape(path, mass=mass, density=density, metres_per_unit=metres_per_unit)
        return shape.block(direction_deg, contact_tolerance, edge_retreat)

    @property
    def b(self) -> float:
        """Half the width [m]."""
        return self.width / 2

    @property
    def h(self) -> float:
        """Height of the centre of gravity above the base, before any lean [m]."""
        return self.height / 2 if self.cg_height is None else self.cg_height

    @property
    def centroidal_inertia(self) -> float:
        """Moment of inertia about the centre of gravity [kg m²]."""
        if self.inertia is not None:
            return self.inertia
        return self.mass * (self.width * self.width + self.height * self.height) / 12

    @property
    def slenderness(self) -> float:
        """Height over width, H/B [-]."""
        return self.height / self.width

    @cached_property
    def centre(self) -> Vector:
        """Centre of gravity of the standing block, from the middle of its base [m]."""
        return Vector(self.cg_offset, self.h).turned(self.lean)

    def arm(self, pole: int) -> Vector:
        """Vector from the pole (+1 right, -1 left) to the centre of gravity as it stands [m]."""
        return self.centre.minus(Vector(pole * self.b, 0.0))

    def critical_angle(self, pole: int) -> float:
        """Rotation about ``pole`` at which the block balances on it, a positive angle [rad]."""
        arm = self.arm(pole)
        return atan2(-pole * arm.x, arm.y)

    @property
    def alpha(self) -> float:
        """The smaller of the two critical angles, θc = atan(b/h) of a symmetric block [rad]."""
        return min(self.critical_angle(+1), self.critical_angle(-1))

    def radius(self, pole: int = 1) -> float:
        """Distance R from the pole to the centre of gravity [m]."""
        return hypot(*self.arm(pole))

    def pole_inertia(self, pole: int = 1) -> float:
        """Moment of inertia about the pole, I_O = I_C + m R² [kg m²]."""
        arm = self.arm(pole)
        return self.centroidal_inertia + self.mass * (arm.x * arm.x + arm.y * arm.y)

    def frequency(self, pole: int = 1, g: float = STANDARD_GRAVITY) -> float:
        """Frequency parameter p = √(m g R / I_O) [1/s]; thesis eq. 2.16 with its square mended."""
        return math.sqrt(self.mass * g * self.radius(pole) / self.pole_inertia(pole))

    def momentum_restitution(self, pole_before: int = 1) -> float:
        """Ratio of angular velocities after and before an impact that conserves momentum [-].

        The block turns about ``pole_before`` and comes down on the other pole (Housner 1963; thesis
        eq. 2.12, 2.14: 1 - 1.5 sin²α for a uniform block).
        """
        before, after = self.arm(pole_before), self.arm(-pole_before)
        product = before.x * after.x + before.y * after.y
        return (self.centroidal_inertia + self.mass * product) / self.pole_inertia(-pole_before)


@dataclass(frozen=True)
class Stack:
    """A statue standing on a pedestal, both free to rock.

    The two touch where the statue's base and the pedestal's top overlap.  A statue that reaches beyond its
    pedestal rocks on the pedestal's upper edge, a point of both bodies as long as neither slides; so the ends
    of the overlap are the poles, and all equations are those of a statue whose base is as wide as the overlap
    (``contact_statue``).

    Parameters
    ----------
    pedestal, statue
        The lower and the upper block (blocks 1 and 2 of the thesis).
    offset
        Distance of the middle of the statue's base to the right of the pedestal's middle [m].

    Raises
    ------
    InputError
        If the two together cannot stand, or if the statue reaches so far beyond the pedestal that its edge
        could touch the ground before anything has fallen.
    """

    pedestal: Block
    statue: Block
    offset: float = 0.0

    def __post_init__(self) -> None:
        for name, block in (("pedestal", self.pedestal), ("statue", self.statue)):
            if not isinstance(block, Block):
                raise InputError(f"Stack: {name} must be a Block, got {shown(block)}.")
        real_number("Stack: offset", self.offset, "metres")
        left, right = self._overlap
        if left >= right:
            raise InputError(
                f"Stack: the statue's base (width {self.statue.width} m, offset {self.offset} m) "
                f"does not lie on the pedestal (width {self.pedestal.width} m)."
            )
        if not left < self.offset + self.statue.centre.x < right:
            raise InputError(
                "Stack: the statue's centre of gravity is not above the part of its base that lies "
                "on the pedestal, so the stack cannot stand."
            )
        for pole in (+1, -1):
            # the statue must stand on its leaning pedestal, and both together on the ground
            statue, whole = self.statue_arm(pole), self.common_arm(pole)
            if pole * statue.x >= 0 or pole * whole.x >= 0:
                raise InputError(
                    "Stack: a centre of gravity is not above its base once the pedestal's lean "
                    "is counted, so the stack cannot stand."
                )
            self._check_overhang(pole)

    def _check_overhang(self, pole: int) -> None:
        """Refuse a statue whose edge beyond the pedestal could touch the ground before anything has fallen.

        The pedestal's upper edge is lowest where the pedestal, or both as one, balance on their pole; the
        statue may have turned by a right angle on it by then.
        """
        end = self._overlap[1 if pole > 0 else 0]
        overhang = pole * (self.offset - end) + self.statue.b
        if overhang <= 1e-12 * self.pedestal.b:
            return
        edge = self.reach(pole, pole)
        whole = self.common_arm(pole)
        furthest = max(self.pedestal.critical_angle(pole), atan2(-pole * whole.x, whole.y))
        lowest = min(edge.y, edge.turned(pole * furthest).y)
        if overhang >= lowest:
            raise InputError(
                f"Stack: the statue reaches {overhang:.4g} m beyond its pedestal, whose upper "
                f"edge can come as low as {lowest:.4g} m, so it could touch the ground; such contacts "
                "are not modelled."
            )

    @property
    def _overlap(self) -> tuple[float, float]:
        """Ends of the contact, to the right of the pedestal's middle [m]."""
        return (
            max(-self.pedestal.b, self.offset - self.statue.b),
            min(self.pedestal.b, self.offset + self.statue.b),
        )

    @property
    def _is_inside(self) -> bool:
        """Whether the statue's base lies on the pedestal with all its width."""
        return abs(self.offset) + self.statue.b <= self.pedestal.b * (1 + 1e-12)

    @property
    def contact_offset(self) -> float:
        """Distance of the middle of the contact to the right of the pedestal's middle [m]."""
        return self.offset if self._is_inside else sum(self._overlap) / 2

    @cached_property
    def contact_statue(self) -> Block:
        """The statue as it stands on the contact: itself, or one whose base is no wider than the overlap."""
        if self._is_inside:
            return self.statue
        left, right = self._overlap
        aside = Vector(self.contact_offset - self.offset, 0.0)
        centre = self.statue.centre.minus(aside).turned(-self.statue.lean)
        return Block(
            width=right - left,
            height=self.statue.height,
            mass=self.statue.mass,
            inertia=self.statue.centroidal_inertia,
            cg_height=centre.y,
            cg_offset=centre.x,
            lean=self.statue.lean,
        )

    def interface_pole(self, pole: int) -> Vector:
        """Statue's pole as it stands, from the middle of the pedestal's base [m]."""
        end = self.contact_offset + pole * self.contact_statue.b
        return Vector(end, self.pedestal.height).turned(self.pedestal.lean)

    def reach(self, ground_pole: int, statue_pole: int) -> Vector:
        """Vector d from the pedestal's pole to the statue's pole as they stand [m].

        Its length is l (poles on the same side) or l' (opposite sides) of thesis eq. 2.61, 2.63.
        """
        return self.interface_pole(statue_pole).minus(Vector(ground_pole * self.pedestal.b, 0.0))

    def statue_arm(self, statue_pole: int) -> Vector:
        """Vector r2 from the statue's pole to its centre of gravity as it stands [m]."""
        return self.contact_statue.arm(statue_pole).turned(self.pedestal.lean)

    def common_arm(self, ground_pole: int) -> Vector:
        """Vector from the pedestal's pole to the common centre of gravity [m]; thesis eq. 2.22."""
        m1, m2 = self.pedestal.mass, self.statue.mass
        one = self.pedestal.arm(ground_pole)
        reach, arm = self.reach(ground_pole, 1), self.statue_arm(1)
        return Vector(
            (m1 * one.x + m2 * (reach.x + arm.x)) / (m1 + m2),
            (m1 * one.y + m2 * (reach.y + arm.y)) / (m1 + m2),
        )

    @property
    def mass(self) -> float:
        """Total mass [kg]."""
        return self.pedestal.mass + self.statue.mass

    def rigidly_joined(self) -> Block:
        """Return the two as one rigid body, which is what rocks in pattern 3."""
        m1, m2 = self.pedestal.mass, self.statue.mass
        to_statue = self.reach(1, 1)
        arm2 = self.statue_arm(1)
        centre1 = self.pedestal.centre
        centre2 = Vector(
            self.pedestal.b + to_statue.x + arm2.x,
            to_statue.y + arm2.y,
        )
        x = (m1 * centre1.x + m2 * centre2.x) / (m1 + m2)
        y = (m1 * centre1.y + m2 * centre2.y) / (m1 + m2)
        apart = centre1.minus(centre2)
        spread = m1 * m2 / (m1 + m2) * (apart.x * apart.x + apart.y * apart.y)
        return Block(
            width=self.pedestal.width,
            height=self.pedestal.height + self.statue.height,
            mass=m1 + m2,
            inertia=self.pedestal.centroidal_inertia + self.statue.centroidal_inertia + spread,
            cg_height=y,
            cg_offset=x,
        )


Body = Block | Stack
