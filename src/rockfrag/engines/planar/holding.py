"""From what holds a system to the numbers that the contact kernels read: walls, ties and bonds of a ``BODY``.

Places are those of ``docs/holding.md``: from the origin of the lowest base; kernels count from its middle.

In: a :class:`rockfrag.system.system.System` with constraints. Out: the fields of its record ``BODY``, SI units.
"""

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from rockfrag.base.arrays import with_attributes
from rockfrag.base.errors import InputError
from rockfrag.engines.planar import _describe
from rockfrag.system.body import Interval, RigidBody
from rockfrag.system.constraints import Tie, Wall
from rockfrag.system.contact import Contact, Friction
from rockfrag.system.geometry import turned
from rockfrag.system.support import BilinearIsolator, SlidingPendulum
from rockfrag.system.system import (
    MOST_BODIES,
    Start,
    System,
    corners,
    standing_centres,
    standing_points,
)

Place = tuple[float, float]
SMOOTH = Friction(0.0, 0.0)
ALL = 24  # contacts of a record, as in ``records``
MOST_CONSTRAINTS = 16
PLATE = 100.0  # width of the plate of an isolator, wide enough [m] ...
INSIDE = 1e-9  # by which a corner may be inside a wall for rounding [m]
THIN = 2.0**-20  # ... and its height, too small to matter [m]


def with_plate(system: System) -> System:
    """Return a planar system whose lowest body is the plate of its isolator, if it has one.

    The plate is wide, thin and cannot turn; the contact under it has the friction of a dish, or none.
    """
    support = system.support
    if support is None:
        return system
    if system.count == MOST_BODIES:
        raise InputError(
            f"System: an isolator carries at most {MOST_BODIES - 1} bodies, not {system.count}."
        )
    ends = Interval(-PLATE / 2, PLATE / 2)
    plate = RigidBody(support.mass, support.mass, (0.0, 0.0, 0.0), ends, THIN, ends)
    friction = support.sliding if isinstance(support, SlidingPendulum) else None
    first = replace(system.contacts[0], offset=(0.0, 0.0))
    start = system.start
    if start is not None:
        at = start.position
        if at is not None:
            raised = ((x, z + THIN) for x, z in at)
            at = ((start.plate, 0.0), *raised)
        start = Start((0.0, *start.rotation), (0.0, *start.velocity), at, start.plate)
    return System(
        (plate, *system.in_plane().bodies),
        (Contact(friction or SMOOTH), first, *system.contacts[1:]),
        start,
        system.name,
    )


def fill_holding(p: np.void, system: System) -> None:
    """Fill what holds a planar system into its record ``BODY``, whose bodies are there already.

    Walls become contacts, numbered after those of bodies with each other; ties and bonds have fields of their own.
    """
    _describe.fill_contacts(with_attributes(p))
    p["is_held"] = len(system.holding) > 0
    if not system.holding:
        return
    if len(system.holding) > MOST_CONSTRAINTS:
        raise InputError(
            f"System: more than {MOST_CONSTRAINTS} walls, ties and bonds are not computed."
        )
    shift = 0 if system.support is None else 1
    _fill_walls(p, system, shift)
    _fill_ties(p, system, shift)
    _fill_bonds(p, system, shift)
    _fill_support(p, system)


def _fill_walls(p: np.void, system: System, shift: int) -> None:
    """Append a contact for each body and wall of a system.

    ``shift``: by how much the record counts bodies higher, 1 where a plate is the lowest.
    """
    standing, centres = corners(system), standing_centres(system)
    middle = _origin(system)
    for number, wall in enumerate(system.constraints):
        if not isinstance(wall, Wall) or wall.distance == math.inf:
            continue
        for body in range(system.count):
            k = _new_contact(p, body + shift, number, wall.side)
            p["wall_top"][k], p["bounce"][k] = wall.height, wall.restitution
            p["static"][k], p["kinetic"][k] = wall.friction or SMOOTH
            # a body has four corners: left low, left high, right low, right high
            first = 4 * body + (2 if wall.side > 0 else 0)
            x, z = centres[body]
            (low_x, low_z), (high_x, high_z) = standing[first], standing[first + 1]
            low, high = (low_x - x, low_z - z), (high_x - x, high_z - z)
            side = _describe.Side(wall.side, low, high)
            at = wall.side * wall.distance - middle
            _describe.fill_wall(with_attributes(p), k, at, side)


def _origin(system: System) -> float:
    """Where kernels begin to count x, from the origin of the lowest base [m]: its middle, or that of a plate."""
    return 0.0 if system.support else system.in_plane().bodies[0].ends[0].middle


def _new_contact(p: np.void, body: int, number: int, side: int) -> int:
    """Append a contact of a body with a wall, and return its number.

    ``number``: of the wall among all that holds the bodies; ``side``: of the wall, -1 left or +1 right.
    """
    k = int(p["contacts"])
    if k == ALL:
        raise InputError(
            "Wall: more than 12 pairs of a body and a wall are not computed; join bodies."
        )
    p["contacts"] = k + 1
    p["upper"][k], p["lower"][k], p["wall"][k] = body, -1, number
    p["side"][k] = side
    return k


def _fill_support(p: np.void, system: System) -> None:
    """Fill the isolator whose plate is the lowest body: dish or spring, and its stops."""
    support = system.support
    if support is None:
        return
    # the support is the last of all that holds the bodies
    row = len(system.holding) - 1
    p["is_supported"], p["support_number"] = 1, row
    p["dish_radius"] = math.inf
    if isinstance(support, SlidingPendulum):
        p["dish_radius"] = support.radius
    elif isinstance(support, BilinearIsolator):
        p["is_sprung"] = 1
        p["spring_stiffness"] = support.stiffness
        p["spring_strength"] = support.strength
        # stiffness of the hysteretic part before it yields [N/m]
        p["spring_rise"] = support.strength / support.yield_displacement
    if support.stroke == math.inf:
        return
    for side in (-1, 1):
        k = _new_contact(p, 0, row, side)
        p["is_stop"][k], p["wall_top"][k] = 1, math.inf
        p["bounce"][k] = support.restitution
        p["wall_x"][k] = float(p["standing"][0]) + side * support.stroke


def check_start(p: np.void, placed: NDArray[np.float64], system: System) -> None:
    """Refuse bodies that begin inside a wall, and a plate that begins beyond its stop.

    Parameters
    ----------
    p : record ``BODY`` of the system
    placed : coordinates and velocities that it begins with, shape (2, 3 MOST)
    system : planar
    """
    for k in range(int(p["count"]), int(p["contacts"])):
        body, side, at = int(p["upper"][k]), int(p["side"][k]), float(p["wall_x"][k])
        x, z, theta = placed[0, 3 * body : 3 * body + 3].tolist()
        ends = [_turned(x, z, theta, edge) for edge in p["edge"][k].tolist()]
        inside = _beyond(side * at, float(p["wall_top"][k]), side, ends)
        if inside <= INSIDE:
            continue
        if p["is_stop"][k]:
            assert system.support is not None
            raise InputError(
                f"Start: the plate begins {inside:.3g} m beyond the stop of its isolator; let it begin within the "
                f"stroke of {system.support.stroke:g} m."
            )
        # the lowest body of an isolated system is the plate
        name = system.names[body - (int(p["count"]) - system.count)]
        number = int(p["wall"][k]) + 1
        raise InputError(
            f"Start: the {name} begins {inside:.3g} m inside wall {number}; turn it less, or move the wall away."
        )


def _turned(
    x: float, z: float, theta: float, corner: Sequence[float]
) -> tuple[float, float]:
    """Where a corner of a body lies (x, z) [m] whose centre is there, turned clockwise [rad]."""
    across, up = turned(corner[0], corner[1], theta)
    return x + across, z + up


def _beyond(at: float, top: float, side: int, ends: Sequence[Place]) -> float:
    """How far the side of a body between two corners reaches into a wall [m].

    ``at``: of the wall to its ``side``; ``top``: of it, over which a corner may be.
    """
    (x0, z0), (x1, z1) = ends
    # a corner that lies on top of it is not inside
    below = [z < top - INSIDE for _, z in ends]
    reach = [side * x - at for (x, _), low in zip(ends, below, strict=True) if low]
    if any(below) and not all(below):
        # where the side passes the height of the edge of a low wall
        part = (top - z0) / (z1 - z0)
        reach.append(side * (x0 + part * (x1 - x0)) - at)
    return max(reach, default=-math.inf)


def _fill_ties(p: np.void, system: System, shift: int) -> None:
    """Fill points, lengths and strengths of ties, SI units; ``shift`` as of :func:`_fill_walls`."""
    middle = _origin(system)
    centres = standing_centres(system)
    for number, tie in enumerate(system.constraints):
        if not isinstance(tie, Tie) or tie.slack == math.inf:
            continue
        t = int(p["ties"])
        if t == p["tie_body"].shape[0]:
            raise InputError("Tie: more than 8 ties are not computed.")
        p["ties"] = t + 1
        body = tie.body % system.count
        x, z = standing_points(system, body, [(tie.point[0], tie.point[2])])[0]
        ax, az = tie.anchor[0], tie.anchor[2]
        p["tie_body"][t], p["tie_number"][t] = body + shift, number
        p["is_bracket"][t] = tie.bracket
        p["tie_point"][t] = x - centres[body][0], z - centres[body][1]
        p["tie_anchor"][t] = ax - middle, az
        length = math.hypot(ax - x, az - z)
        if length == 0.0:
            raise InputError(
                f"Tie: point and anchor of tie {number + 1} are one place."
            )
        p["tie_long"][t], p["tie_short"][t] = length + tie.slack, length - tie.slack
        p["tie_stiffness"][t], p["tie_damping"][t] = tie.stiffness, tie.damping
        p["tie_strength"][t] = tie.strength


def _fill_bonds(p: np.void, system: System, shift: int) -> None:
    """Fill what bonds bear, tension [N] of each of two pads and shear [N]; ``shift`` as of :func:`_fill_walls`."""
    for row, (contact, bond) in enumerate(system.bonds, len(system.constraints)):
        k = contact + shift
        p["is_bonded"][k], p["bond_number"][k] = 1, row
        p["bond_spread"][k] = bond.pads[0]
        p["bond_tension"][k], p["bond_shear"][k] = bond.tension / 2, bond.shear
