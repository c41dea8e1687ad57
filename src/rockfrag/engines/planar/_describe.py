"""From numbers of bodies and of what holds them to the record that the contact kernels read.

Plain Python that kernels may call too, so that a body has the same bits in a page. Records are ``BODY`` with their
fields as attributes; x is counted from the middle of the lowest base, or of the plate under it.

In: shapes, lengths, forces, SI units. Out: the fields of a record ``BODY``.
Theory: ``docs/contact.md``, equations 1 and 2; ``docs/holding.md``.
"""

import math
from typing import Any, NamedTuple

from rockfrag.base.elementary import atan2, hypot, sin_cos
from rockfrag.system import geometry
from rockfrag.system.geometry import Face, Shape


class Foot(NamedTuple):
    """Where a body stands."""

    # middle of its base, from that of the lowest one [m]
    x: float
    y: float
    tilt: float  # of what it stands on, clockwise [rad]


def place_lowest(p: Any, shape: Shape) -> Foot:
    """Place the body that stands on the ground.

    Parameters
    ----------
    p : record
    shape : of the body as it stands

    Returns
    -------
    Where it stands.
    """
    p.half[0] = math.inf
    _place(p, 0, shape, (shape.x, shape.y), 0.0)
    return Foot(0.0, 0.0, 0.0)


def place_above(
    p: Any, k: int, shapes: tuple[Shape, Shape], face: Face, below: Foot
) -> Foot:
    """Place a body on the one under it.

    Parameters
    ----------
    p, k : record ``BODY``, and number of the body from below
    shapes : of the body under it and of itself, each as it stands by itself
    face, below : what it stands on, and where the body under it stands

    Returns
    -------
    Where it stands.
    """
    lower, own = shapes
    pile = geometry.pile_of(lower, own, face)
    # right end and middle of the base above, and middle of the face, from the middle of the base below
    foot = geometry.turned(pile.right[0], pile.right[1], below.tilt)
    over = geometry.turned(face.right + face.offset, face.height, face.lean)
    base = geometry.turned(over[0], over[1], below.tilt)
    top = geometry.turned(face.right, face.height, face.lean)
    # the face from the centre of gravity of the body below
    middle = geometry.turned(top[0] - lower.x, top[1] - lower.y, below.tilt)
    p.face[k, 0], p.face[k, 1], p.half[k] = middle[0], middle[1], face.half
    tilt = below.tilt + face.lean
    p.tilt_sin[k], p.tilt_cos[k] = sin_cos(tilt)
    right = geometry.arm(pile.upper, 1)
    x, y = geometry.turned(right[0], right[1], tilt)
    stands = below.x + foot[0] + x, below.y + foot[1] + y
    _place(p, k, pile.upper, stands, tilt)
    return Foot(below.x + base[0], below.y + base[1], tilt)


def _place(
    p: Any, k: int, shape: Shape, stands: tuple[float, float], tilt: float
) -> None:
    """Fill masses, corners and critical angles of body k, and where its centre of gravity stands.

    ``stands``: x and y [m] from the middle of the lowest base; ``tilt``: of what it stands on, clockwise [rad].
    """
    p.mass[k], p.inertia[k] = shape.mass, shape.inertia
    p.inverse[3 * k], p.inverse[3 * k + 1] = 1 / shape.mass, 1 / shape.mass
    p.inverse[3 * k + 2] = 1 / shape.inertia
    for end in range(2):
        pivot = 2 * end - 1
        arm = geometry.arm(shape, pivot)
        x, y = geometry.turned(arm[0], arm[1], tilt)
        p.corner[k, end, 0], p.corner[k, end, 1] = -x, -y
        p.critical[k, end] = atan2(-pivot * x, y)
    p.standing[3 * k], p.standing[3 * k + 1] = stands
    # units: of the uppermost body, which comes last
    p.size, p.speed = shape.b, math.sqrt(p.g * shape.b)


def fill_start(p: Any, theta: Any, omega: Any, start: Any) -> None:
    """Place bodies that are turned about the corners that this leaves them.

    Parameters
    ----------
    p : record
    theta, omega : rotation [rad] and rate [rad/s] of each body, clockwise
    start : coordinates and velocities, shape (2, 3 MOST)
    """
    for k in range(p.count):
        below, rate = (theta[k - 1], omega[k - 1]) if k > 0 else (0.0, 0.0)
        # the corner that stays on what is below: the right one where it turns clockwise from that
        end = 1 if ((theta[k] - below) or (omega[k] - rate)) >= 0 else 0
        corner = p.corner[k, end, 0], p.corner[k, end, 1]
        x, y = p.standing[3 * k] + corner[0], p.standing[3 * k + 1] + corner[1]
        # velocity of the corner
        along, up = 0.0, 0.0
        if k > 0:
            at = 3 * k - 3
            arm = geometry.turned(x - p.standing[at], y - p.standing[at + 1], below)
            x, y = start[0, at] + arm[0], start[0, at + 1] + arm[1]
            along = start[1, at] + rate * arm[1]
            up = start[1, at + 1] - rate * arm[0]
        to_corner = geometry.turned(corner[0], corner[1], theta[k])
        start[0, 3 * k], start[0, 3 * k + 1] = x - to_corner[0], y - to_corner[1]
        start[1, 3 * k] = along - omega[k] * to_corner[1]
        start[1, 3 * k + 1] = up + omega[k] * to_corner[0]
        start[0, 3 * k + 2], start[1, 3 * k + 2] = theta[k], omega[k]


def fill_contacts(p: Any) -> None:
    """Number the contacts of bodies with each other, before walls and stops follow them.

    Parameters
    ----------
    p : record
    """
    p.contacts = p.count
    for k in range(p.count):
        p.upper[k], p.lower[k] = k, k - 1


class Side(NamedTuple):
    """What of a body may meet a wall."""

    way: int  # towards the wall: +1 right, -1 left
    # corners from its centre of gravity [m]
    low: tuple[float, float]
    high: tuple[float, float]


def fill_wall(p: Any, k: int, x: float, side: Side) -> None:
    """Fill where the wall of a contact stands, and what of the body may meet it.

    Parameters
    ----------
    p, k : record, and number of the contact
    x : of the wall [m]
    side : of the body
    """
    p.side[k], p.wall_x[k] = side.way, x
    # in the order in which the wall's tangent meets them: upwards on the right, downwards on the left
    first, last = side.low, side.high
    if side.way < 0:
        first, last = side.high, side.low
    across, up = last[0] - first[0], last[1] - first[1]
    length = hypot(across, up)
    p.edge[k, 0, 0], p.edge[k, 0, 1] = first
    p.edge[k, 1, 0], p.edge[k, 1, 1] = last
    p.flank[k, 0], p.flank[k, 1] = across / length, up / length
