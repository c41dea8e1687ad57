"""What is shaken: bodies that stand on each other, the contacts between them, and how they begin."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np

from rockfrag.base.elementary import sin_cos
from rockfrag.base.errors import InputError
from rockfrag.base.input_checks import shown
from rockfrag.system import geometry
from rockfrag.system.body import (
    Circle,
    Interval,
    Outline,
    Polygon,
    RigidBody,
    Vector3,
    interval_of,
)
from rockfrag.system.bond import Bond
from rockfrag.system.constraints import Constraint, Tie, Wall
from rockfrag.system.contact import Contact, Friction
from rockfrag.system.support import Support

MOST_BODIES = 12  # bodies of a column


@dataclass(frozen=True)
class Start:
    """How the bodies begin, relative to the moving ground.

    Attributes
    ----------
    rotation : of each body from below, from how it stands: clockwise [rad] of planar bodies, a rotation vector
        (x, y, z) [rad] of bodies in space
    velocity : angular velocity of each body, likewise [rad/s]
    position : of each centre of gravity of planar bodies (x, z) [m], as an earlier response left it; None: they
        stand as they were set
    plate : displacement of the plate of an isolator [m]
    """

    rotation: tuple[Any, ...]
    velocity: tuple[Any, ...]
    position: tuple[tuple[float, float], ...] | None = None
    plate: float = 0.0


@dataclass(frozen=True)
class System:
    """Rigid bodies that stand on each other.

    Attributes
    ----------
    bodies : from below
    contacts : contact k lies under body k; the first is the ground's
    start : rotations and velocities at the start; None: at rest
    name : for tables and messages
    constraints : walls and ties between one body and the ground
    support : isolator under the lowest body; None: it stands on the ground
    """

    bodies: tuple[RigidBody, ...]
    contacts: tuple[Contact, ...]
    start: Start | None = None
    name: str = ""
    constraints: tuple[Constraint, ...] = ()
    support: Support | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "bodies", tuple(self.bodies))
        object.__setattr__(self, "contacts", tuple(self.contacts))
        count = len(self.bodies)
        if not 1 <= count <= MOST_BODIES or len(self.contacts) != count:
            raise InputError(
                f"System: expected 1 to {MOST_BODIES} bodies and a contact under each, got {count} and "
                f"{len(self.contacts)}."
            )
        for k, body in enumerate(self.bodies[:-1]):
            if body.face is None:
                raise InputError(
                    f"System: body {k + 1} from below has no face for the next to stand on."
                )
        if len({body.planar for body in self.bodies}) > 1:
            raise InputError(
                "System: planar bodies and bodies in space cannot stand on each other."
            )
        start = self.start
        if (
            start is not None
            and not len(start.rotation) == len(start.velocity) == count
        ):
            raise InputError(
                f"System: expected {count} rotation(s) and velocities at the start, got {shown(start)}."
            )
        object.__setattr__(self, "constraints", tuple(self.constraints))
        for constraint in self.constraints:
            _check_constraint(constraint, self)
        for k, bond in self.bonds:
            _check_bond(bond, self, k)
        if not (self.support is None or isinstance(self.support, Support)):
            raise InputError(
                f"System: support: expected an isolator, got {shown(self.support)}."
            )

    @property
    def count(self) -> int:
        """Number of bodies."""
        return len(self.bodies)

    @property
    def planar(self) -> bool:
        """Whether the bodies are known in one plane only."""
        return self.bodies[0].planar

    @property
    def loose(self) -> bool:
        """Whether a contact may slide and open as a whole: one has friction."""
        return any(contact.friction is not None for contact in self.contacts)

    @property
    def mass(self) -> float:
        """Total mass [kg]."""
        return sum(body.mass for body in self.bodies)

    @property
    def height(self) -> float:
        """Height of all bodies on each other [m]."""
        return sum(body.height for body in self.bodies)

    @property
    def names(self) -> tuple[str, ...]:
        """Name of each body from below: its own, or its number."""
        return tuple(body.name or f"body {k + 1}" for k, body in enumerate(self.bodies))

    @property
    def bonds(self) -> tuple[tuple[int, Bond], ...]:
        """Bonds of contacts, each with the number of its contact from below, from 0."""
        found = enumerate(contact.bond for contact in self.contacts)
        return tuple((k, bond) for k, bond in found if bond is not None)

    @property
    def holding(self) -> tuple[str, ...]:
        """Names of all that holds the bodies: constraints in their order, bonds from below, the support."""
        walls_and_ties = [
            f"{type(constraint).__name__.lower()} {number}"
            for number, constraint in enumerate(self.constraints, 1)
        ]
        bonds = [f"bond {k + 1}" for k, _ in self.bonds]
        support = [] if self.support is None else ["support"]
        return (*walls_and_ties, *bonds, *support)

    def free(self) -> "System":
        """Return the system with nothing that holds its bodies but the ground and each other."""
        return replace(
            self,
            contacts=tuple(replace(contact, bond=None) for contact in self.contacts),
            constraints=(),
            support=None,
        )

    def held(self) -> "System":
        """Return the system with contacts that never slide."""
        return replace(
            self,
            contacts=tuple(
                replace(contact, friction=None) for contact in self.contacts
            ),
        )

    def with_friction(self, friction: Friction, at: int = 0) -> "System":
        """Return the system with another friction at one contact: 0 is the lowest body's, -1 the uppermost's."""
        contacts = list(self.contacts)
        contacts[at] = replace(contacts[at], friction=friction)
        return replace(self, contacts=tuple(contacts))

    def in_plane(self) -> "System":
        """Return the planar system that moves in the vertical plane of x."""
        if self.planar:
            return self
        return replace(self, bodies=tuple(body.seen_along() for body in self.bodies))

    @cached_property
    def shapes(self) -> tuple[geometry.Shape, ...]:
        """Each body of a planar system as it stands by itself, from below, as the kernels know it."""
        found = []
        for body, contact in zip(self.in_plane().bodies, self.contacts, strict=True):
            base, inertia = body.ends[0], body.inertia
            assert isinstance(inertia, float | int)
            x, y = geometry.turned(
                body.centre[0] - base.middle, body.centre[2], contact.tilt
            )
            half = (base.right - base.left) / 2
            found.append(geometry.Shape(half, body.mass, inertia, x, y))
        return tuple(found)

    @cached_property
    def faces(self) -> tuple[geometry.Face, ...]:
        """What each body of a planar system but the highest carries the next one on, from below."""
        found = []
        bodies = self.in_plane().bodies
        for k, (below, above) in enumerate(pairwise(bodies)):
            stand, face = below.ends
            # of the base above, its middle from the origin of the base below
            middle = self.contacts[k + 1].offset[0] + above.ends[0].middle
            found.append(
                geometry.Face(
                    half=(face.right - face.left) / 2,
                    height=below.height,
                    # the body below leans as its own uneven base does
                    lean=self.contacts[k].tilt,
                    right=face.middle - stand.middle,
                    offset=middle - face.middle,
                )
            )
        return tuple(found)

    @cached_property
    def pile(self) -> geometry.Pile:
        """The two bodies of a planar system as the kernels know them."""
        lower, upper = self.shapes
        return geometry.pile_of(lower, upper, self.faces[0])

    @cached_property
    def carried(self) -> tuple[geometry.Shape, ...]:
        """Each body of a planar system as it rocks: with a base as wide as what of it lies on the face below."""
        pairs = zip(pairwise(self.shapes), self.faces, strict=True)
        above = (geometry.pile_of(*pair, face).upper for pair, face in pairs)
        return self.shapes[0], *above


def _check_constraint(constraint: object, system: System) -> None:
    """Refuse what is no constraint, one in the way of a body as it stands, or of a body that is not there."""
    if not isinstance(constraint, (Wall, Tie)):
        raise InputError(
            f"System: constraints: expected walls and ties, got {shown(constraint)}."
        )
    if isinstance(constraint, Tie):
        if not -system.count <= constraint.body < system.count:
            raise InputError(
                f"Tie: body {constraint.body} is none of {system.count} from below; count from 0."
            )
        return
    if not system.planar:
        return
    if constraint.side == 0:
        raise InputError(
            "Wall: a wall beside planar bodies stands to the right or the left; give the direction 0 or π."
        )
    reach = reach_at(system, constraint)
    if constraint.distance < reach - 1e-9:
        raise InputError(
            f"Wall: at {constraint.distance:g} m it stands where the bodies are; they reach to {reach:.6g} m."
        )


def _check_bond(bond: Bond, system: System, k: int) -> None:
    """Refuse a bond whose pads lie outside what of body k's base lies on what is under it."""
    room, (x, y) = bond.room_under(bearing(system, k)), bond.pads
    if room >= 1 - 1e-9:
        return
    if system.planar:
        said = f"{x:g} m to both sides of its middle; give {room * x:.6g} m at most"
    else:
        said = f"at ± ({x:g}, {y:g}) m; ({room * x:.6g}, {room * y:.6g}) m would be at its edge"
    raise InputError(
        f"Bond: spread: the pads lie outside the base that stands on them, {said}."
    )


def bearing(system: System, k: int) -> Outline:
    """What of a body's base lies on what is under it.

    Parameters
    ----------
    system, k : the bodies, and the number of one from below, from 0

    Returns
    -------
    That part of the base of a planar body, in its own axes; the whole base of one in space.
    """
    body = system.bodies[k]
    if not k or not system.planar:
        return body.base
    (low, high), (left, right) = body.ends[0], system.bodies[k - 1].ends[1]
    aside = system.contacts[k].offset[0]
    return Interval(max(low, left - aside), min(high, right - aside))


def reach_at(system: System, wall: Wall, turned: float = 0.0) -> float:
    """How far bodies as they stand reach towards a wall, below its upper edge [m].

    Parameters
    ----------
    system, wall : the bodies, and a wall beside them
    turned : of one body in space, about the vertical through its centre of mass, from x towards y [rad]

    Returns
    -------
    The distance from the origin of the lowest base, along the direction of the wall [m].
    """
    if system.planar:
        return max(wall.side * x for x, z in corners(system) if z < wall.height)
    body = system.bodies[0]
    # the body turned one way is the wall turned the other way
    sine, cosine = sin_cos(wall.direction - turned)
    along = body.centre[0] * cosine + body.centre[1] * sine
    outlines = (body.base, body.face or body.base)
    furthest = max(interval_of(each, (cosine, sine)).right for each in outlines)
    sine, cosine = sin_cos(wall.direction)
    return furthest - along + body.centre[0] * cosine + body.centre[1] * sine


def with_bodies(
    system: System, bodies: Sequence[RigidBody], turned: float = 0.0
) -> System:
    """Return the system with bodies of slightly other sizes, and what holds them where they are.

    Walls keep their distance from the bodies, and pads of bonds stay under the bases.

    Parameters
    ----------
    system, bodies : the system, and a body for each of its own
    turned : by which one body in space is turned about the vertical [rad]; its walls keep their distance or more

    Returns
    -------
    The system.
    """
    free = replace(system.free(), bodies=tuple(bodies))
    contacts = tuple(
        replace(
            contact, bond=contact.bond and contact.bond.kept_under(bearing(free, k))
        )
        for k, contact in enumerate(system.contacts)
    )

    def beside(constraint: Constraint) -> Constraint:
        if isinstance(constraint, Tie) or constraint.distance == math.inf:
            return constraint
        gap = max(0.0, constraint.distance - reach_at(system, constraint))
        reach = max(reach_at(free, constraint, turn) for turn in (0.0, turned))
        return replace(constraint, distance=reach + gap)

    return replace(
        free,
        contacts=contacts,
        constraints=tuple(map(beside, system.constraints)),
        support=system.support,
    )


def hold(
    system: System,
    *constraints: Constraint,
    bonds: Sequence[Bond | None] | Bond | None = None,
    support: Support | None = None,
) -> System:
    """Add walls, ties, bonds and an isolator to a system.

    Parameters
    ----------
    system : to which they are added
    *constraints : walls and ties
    bonds : one for each contact from below, None where there is none; one Bond: of the uppermost contact
    support : isolator under the lowest body

    Returns
    -------
    The system with them.
    """
    contacts = list(system.contacts)
    if isinstance(bonds, Bond):
        bonds = [*[contact.bond for contact in contacts[:-1]], bonds]
    if bonds is not None:
        if len(bonds) != len(contacts):
            raise InputError(
                f"bonds: expected one entry for each of {len(contacts)} contacts, got {len(bonds)}."
            )
        contacts = [
            replace(contact, bond=bond)
            for contact, bond in zip(contacts, bonds, strict=True)
        ]
    return replace(
        system,
        contacts=tuple(contacts),
        constraints=(*system.constraints, *constraints),
        support=system.support if support is None else support,
    )


def uplift_ratios(system: System) -> tuple[float, ...]:
    """Least horizontal acceleration over g that opens each contact of a planar system at rest, from below.

    The pivot is the one whose overturning moment first exceeds the weight's (Kirkpatrick, 1927; Psycharis, 1990).

    Parameters
    ----------
    system : planar

    Returns
    -------
    The accelerations over g [-], one a contact from below.
    """
    if system.count == 1:
        arms = [tuple(geometry.arm(system.shapes[0], pivot) for pivot in (+1, -1))]
    elif system.count == 2:
        arms = [
            tuple(arm(system.pile, pivot) for pivot in (+1, -1))
            for arm in (geometry.common_arm, geometry.upper_arm)
        ]
    else:
        arms = [arms_above(system, k) for k in range(system.count)]
    # a body with its centre below its pivots never opens
    return tuple(
        min(abs(x) / y if y > 0 else math.inf for x, y in pair) for pair in arms
    )


def each_contact(
    name: str, given: Any, count: int, wanted: str = ""
) -> tuple[Any, ...]:
    """Return what is given for each contact of a system, from the ground up.

    It is a mapping with ``ground`` and ``interface``, the latter one value for all contacts above the ground or a
    list with one for each; or one value for all, or, of several where it is said what is ``wanted``, one for each.

    Parameters
    ----------
    name : of the argument, with which a message begins
    given : as said above
    count : of the contacts
    wanted : what a list of several would hold; empty where one value is meant for all

    Returns
    -------
    A value for each contact, from the ground up.
    """
    if not isinstance(given, dict):
        if count == 1 or not wanted:
            return (given,) * count
        if isinstance(given, (list, tuple, np.ndarray)) and len(given) == count:
            return tuple(given)
        raise InputError(f"{name}: {wanted}, got {shown(given)}.")
    known = ("ground", "interface")[:count]
    unknown = [key for key in given if key not in known]
    if unknown:
        raise InputError(
            f"{name}: {shown(unknown[0])} is no contact of a system of {count}; name them {' and '.join(known)}."
        )
    above = given.get("interface")
    each = list(above) if isinstance(above, list) else [above] * (count - 1)
    if len(each) != count - 1:
        raise InputError(
            f"{name}: expected {count - 1} value(s) for the interfaces from below, got {len(each)}."
        )
    return (given.get("ground"), *each)


def box(
    sides: Vector3, mass: float, inertia: Any, centre: Vector3, name: str = ""
) -> RigidBody:
    """Return a box in space.

    Parameters
    ----------
    sides : width along x, depth along y, and height [m]
    mass : [kg]
    inertia : about the centre of mass, a number or a tensor [kg m²]; None for one of uniform mass
    centre : of mass, from the middle of the base [m]
    name : of the body
    """
    width, depth, height = sides
    x, y = width / 2, depth / 2
    outline = Polygon(((-x, -y), (x, -y), (x, y), (-x, y)))
    if inertia is None:
        w, d, h = width * width, depth * depth, height * height
        inertia = np.diag(
            (mass * (d + h) / 12, mass * (w + h) / 12, mass * (w + d) / 12)
        )
    return RigidBody(mass, inertia, centre, outline, height, outline, name)


def cylinder(
    diameter: float,
    height: float,
    mass: float,
    inertia: Any,
    centre: Vector3,
    *,
    name: str = "",
) -> RigidBody:
    """Return a body in space with a round base and face.

    Parameters
    ----------
    diameter, height : [m]
    mass : [kg]
    inertia : about the centre of mass, a number or a tensor [kg m²]; None for one of uniform mass
    centre : of mass, from the middle of the base [m]
    name : of the body
    """
    outline = Circle(diameter / 2)
    if inertia is None:
        across = round_inertia(diameter, height, mass)
        inertia = np.diag((across, across, mass * diameter * diameter / 8))
    return RigidBody(mass, inertia, centre, outline, height, outline, name)


def round_inertia(diameter: float, height: float, mass: float) -> float:
    """Moment of inertia of a uniform cylinder about an axis across it through its centre [kg m²].

    Parameters
    ----------
    diameter, height : of the cylinder [m]
    mass : [kg]

    Returns
    -------
    The moment of inertia [kg m²].
    """
    return mass * (0.75 * diameter * diameter + height * height) / 12


def turned_about_vertical(system: System, angle_deg: float) -> System:
    """Return one body in space on a polygon, turned about the vertical [degrees].

    Parameters
    ----------
    system : of one body on a polygon
    angle_deg : from x towards y [degrees]

    Returns
    -------
    The system, turned.
    """
    if not angle_deg % 360:
        return system
    (body,) = system.bodies
    sine, cosine = sin_cos(math.radians(angle_deg))
    (xx, xy, xz), (_, yy, yz), (*_, zz) = body.tensor.tolist()
    xx, xy, yy = geometry.turned_moments(xx, xy, yy, sine, cosine)
    xz, yz = geometry.turned_in_plan(xz, yz, sine, cosine)
    x, y, z = body.centre
    base, face = body.base, body.face
    assert isinstance(base, Polygon)
    assert face is None or isinstance(face, Polygon)
    turned = replace(
        body,
        inertia=((xx, xy, xz), (xy, yy, yz), (xz, yz, zz)),
        centre=(*geometry.turned_in_plan(x, y, sine, cosine), z),
        base=_turned_outline(base, sine, cosine),
        face=face and _turned_outline(face, sine, cosine),
    )
    return replace(system, bodies=(turned,))


def _turned_outline(outline: Polygon, sine: float, cosine: float) -> Polygon:
    """Outline turned in the plan by an angle of this sine and cosine."""
    return Polygon(
        tuple(
            geometry.turned_in_plan(east, north, sine, cosine)
            for east, north in outline.vertices
        )
    )


def stands(system: System) -> bool:
    """Whether the bodies above each contact of a planar system have their common centre between its ends."""
    return all(
        math.isfinite(x) and side * x < 0
        for k in range(system.count)
        for side, (x, _) in zip((-1, 1), arms_above(system, k), strict=True)
    )


def arms_above(system: System, k: int) -> tuple[tuple[float, float], ...]:
    """Vectors from both ends of contact k, left and right, to the common centre of all on it, (x, z) [m]."""
    x, z = common_centre(system, k)
    bases = _bases(system)
    angle, origin, _ = bases[k]
    base = bearing(system, k)
    assert isinstance(base, Interval)
    turns = [geometry.turned(end, 0.0, angle) for end in base]
    return tuple((x - (origin[0] + dx), z - (origin[1] + dy)) for dx, dy in turns)


def common_centre(system: System, lowest: int = 0) -> tuple[float, float]:
    """Common centre of gravity of a planar body and all above it as they stand (x, z) [m]."""
    masses = [body.mass for body in system.bodies[lowest:]]
    centres = standing_centres(system)[lowest:]
    whole = sum(masses)
    x = sum(mass * at[0] for mass, at in zip(masses, centres, strict=True)) / whole
    z = sum(mass * at[1] for mass, at in zip(masses, centres, strict=True)) / whole
    return x, z


def rocking_shapes(system: System) -> list[geometry.Shape]:
    """Shapes that rock: those of the bodies, the lower of two joined with what it carries.

    Parameters
    ----------
    system : planar, of one body or more

    Returns
    -------
    The shapes, from below.
    """
    shapes = list(system.carried)
    if system.count == 2:
        # two may rock as one (pattern 3 of docs/derivation.md); of three and more, which pure rocking does not
        # take, each is taken for itself
        shapes[0] = geometry.joined(system.pile)
    return shapes


def standing_centres(system: System) -> list[tuple[float, float]]:
    """Centres of gravity of planar bodies as they stand on each other [m].

    Parameters
    ----------
    system : planar, of one body or more

    Returns
    -------
    Places (x, y) from the middle of the lowest base [m], from below.
    """
    found = []
    for (angle, (x, y), body), shape in zip(_bases(system), system.shapes, strict=True):
        dx, dy = geometry.turned(body.ends[0].middle + shape.x, shape.y, angle)
        found.append((x + dx, y + dy))
    return found


def standing_points(
    system: System, k: int, points: Sequence[tuple[float, float]]
) -> list[tuple[float, float]]:
    """Points of a planar body, from its frame, which an uneven base turns, to where they stand.

    Parameters
    ----------
    system, k : the system, and the number of the body from below, from 0
    points : (x, z) in the frame of the body [m]

    Returns
    -------
    (x, z) of each, from the origin of the lowest base [m].
    """
    angle, (x, y), body = _bases(system)[k]
    middle, found = body.ends[0].middle, []
    for across, up in points:
        dx, dy = geometry.turned(across - middle, up, system.contacts[k].tilt)
        dx, dy = geometry.turned(middle + dx, dy, angle)
        found.append((x + dx, y + dy))
    return found


def corners(system: System) -> list[tuple[float, float]]:
    """Corners of planar bodies as they stand.

    Parameters
    ----------
    system : the bodies

    Returns
    -------
    (x, z) [m] of four corners a body, from below: left low, left high, right low, right high.
    """
    found = []
    for k, (angle, (x, y), body) in enumerate(_bases(system)):
        base, face = body.ends
        tops = standing_points(system, k, [(end, body.height) for end in face])
        for end, top in zip(base, tops, strict=True):
            dx, dy = geometry.turned(end, 0.0, angle)
            found += [(x + dx, y + dy), top]
    return found


def _bases(system: System) -> list[tuple[float, tuple[float, float], RigidBody]]:
    """How each planar body stands, from below.

    Returned are the angle of the face below it [rad], clockwise, the origin of its base (x, z) from that of the
    lowest one [m], and the body.
    """
    bodies = system.in_plane().bodies
    angle, origin = 0.0, (0.0, 0.0)
    found = [(angle, origin, bodies[0])]
    for below, body, k in zip(bodies, bodies[1:], range(1, system.count), strict=False):
        # an uneven base turns its body about the middle of that base
        middle = below.ends[0].middle
        dx, dy = geometry.turned(middle, 0.0, angle)
        angle += system.contacts[k - 1].tilt
        across = system.contacts[k].offset[0] - middle
        aside, up = geometry.turned(across, below.height, angle)
        origin = (origin[0] + (dx + aside), origin[1] + (dy + up))
        found.append((angle, origin, body))
    return found
