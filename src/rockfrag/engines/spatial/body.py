"""Bodies as the kernels know them, made of a system of one body in space.

In: a :class:`rockfrag.system.system.System` of one body. Out: its record ``BODY`` and the state in which it
stands. Theory: ``docs/space.md``, "Coordinates"; walls, ties and bonds: ``docs/holding.md``.

A system has its bodies in the frame of their base, with z up from it [m, kg, N]. A record has the origin at the
centre of mass, and all that has a mass is for a unit of it.
"""

import math
from dataclasses import replace

import numpy as np

from rockfrag.base.arrays import Floats, with_attributes
from rockfrag.base.errors import InputError
from rockfrag.base.units import GRAVITY
from rockfrag.engines.algebra.vectors import TINY
from rockfrag.engines.spatial._body import (
    ATTITUDE,
    BODY,
    HEIGHT,
    MOST_CONSTRAINTS,
    MOST_VERTICES,
    SIZE,
)
from rockfrag.engines.spatial._describe import fill_body, fill_wall
from rockfrag.system.body import Circle, Polygon, RigidBody
from rockfrag.system.bond import Bond
from rockfrag.system.constraints import Tie, Wall
from rockfrag.system.system import System, with_bodies

# size of the perturbation that tells how robust an outcome is: of vertices over the width of the base, of the
# direction in radians [-].  Two vertices that land at once and two that land one after the other go on
# differently, however close in time: an ideal box has outcomes that no real one has
PERTURBATION = 1e-6
# coefficient of friction of a contact without any: a body in space that only sticks is no closed model [-]
NEVER_SLIDES = 20.0


def kernel_body(system: System, g: float = GRAVITY) -> np.void:
    """Return the one body in space of a system, and its contact with the ground, as the kernels know it.

    Parameters
    ----------
    system : of one body, with its contact, walls, ties and bond
    g : acceleration of gravity [m/s²]

    Returns
    -------
    A record ``BODY``.

    Raises
    ------
    InputError
        for a base of too many vertices, a centre of mass that is not above it, too many walls and ties, or a wall
        where the body stands
    """
    given, contact = system.bodies[0], system.contacts[0]
    # where the centre of mass is in the plan of the base: the origin of the record
    base, below = given.base, np.array(given.centre[:2])
    made = np.zeros(1, BODY)
    body: np.void = made[0]
    if isinstance(base, Circle):
        body["rim"], body["centre"] = base.radius, np.array(base.centre) - below
    else:
        assert isinstance(base, Polygon)
        count = len(base.vertices)
        if count > MOST_VERTICES:
            raise InputError(
                f"base: {count} vertices are more than the {MOST_VERTICES} that a body in space may have; "
                "leave out those that hardly turn the outline, or give a circle."
            )
        body["count"], body["points"][:count, :2] = (
            count,
            np.array(base.vertices) - below,
        )
    body["height"], body["inertia"] = given.centre[2], given.tensor / given.mass
    static, kinetic = contact.friction or (NEVER_SLIDES, NEVER_SLIDES)
    body["static"], body["kinetic"] = (
        min(static, NEVER_SLIDES),
        min(kinetic, NEVER_SLIDES),
    )
    if not fill_body(made.view(np.recarray)[0], g):
        raise InputError(
            "base: the centre of mass is not above the base, so the body cannot stand."
        )
    if contact.bond is not None:
        _fill_bond(body, given, contact.bond)
    _fill_constraints(body, system)
    return body


def acting(system: System) -> list[int]:
    """Return which constraints of a system may ever act, walls and ties within reach, by their numbers.

    The record has them in this order.
    """
    reach = [
        each.distance if isinstance(each, Wall) else each.slack
        for each in system.constraints
    ]
    return [i for i, length in enumerate(reach) if length < math.inf]


def _fill_constraints(body: np.void, system: System) -> None:
    """Fill the fields of all walls and ties that may act."""
    given, known = system.bodies[0], acting(system)
    if len(known) > MOST_CONSTRAINTS:
        raise InputError(
            f"System: {len(known)} constraints are more than the {MOST_CONSTRAINTS} that a body in space may "
            "have; leave some out."
        )
    body["constraints"] = len(known)
    for i, number in enumerate(known):
        constraint = system.constraints[number]
        if isinstance(constraint, Tie):
            _fill_tie(body, i, given, constraint)
        else:
            _fill_wall(body, i, given, constraint)


def _fill_wall(body: np.void, i: int, given: RigidBody, wall: Wall) -> None:
    """Fill the fields of wall i, and the corners of the body that may meet it."""
    corners = _corners(given)
    body["walls"] = 1
    body["corners"], body["corner"][: len(corners)] = len(corners), corners
    east, north, _ = given.centre
    gap = fill_wall(
        with_attributes(body), i, wall.direction, wall.distance, (east, north)
    )
    if gap < -1e-9:
        raise InputError(
            f"Wall: at {wall.distance:g} m it stands where the body is, which reaches to "
            f"{wall.distance - gap:.6g} m."
        )
    static, kinetic = wall.friction or (0.0, 0.0)
    body["wall_static"][i] = min(static, NEVER_SLIDES)
    body["wall_kinetic"][i] = min(kinetic, NEVER_SLIDES)
    body["ratio"][i] = wall.restitution


def _corners(given: RigidBody) -> Floats:
    """Corners of base and face from the centre of mass [m], shape (corners, 3)."""
    found = []
    for outline, height in ((given.base, 0.0), (given.face, given.height)):
        assert isinstance(outline, Polygon)
        found += [(x, y, height) for x, y in outline.vertices]
    return np.asarray(np.array(found) - np.array(given.centre))


def _fill_bond(body: np.void, given: RigidBody, bond: Bond) -> None:
    """Fill the fields of a bond under a body: capacities for a unit of mass [N/kg], and where its pads are [m]."""
    body["bonded"], body["pads"] = 1, bond.pads
    body["tension"], body["shear"] = bond.tension / given.mass, bond.shear / given.mass
    # the pads lie around the origin of the base
    body["aside"] = given.centre[:2]


def _fill_tie(body: np.void, i: int, given: RigidBody, tie: Tie) -> None:
    """Fill the fields of tie i, for a unit of mass.

    The body's centre of mass stands over the origin of the ground at first. A bracket pushes too; a cord does not,
    which a least length of 0 says.
    """
    x, y, _ = given.centre
    knot, anchor = np.array(tie.point), np.array(tie.anchor)
    length = float(np.linalg.norm(anchor - knot))
    if length == 0.0:
        raise InputError(
            "Tie: point and anchor are one place; give an anchor some way off, which says where it pulls."
        )
    body["ties"][i] = 1
    body["knot"][i], body["anchor"][i] = knot - given.centre, anchor - (x, y, 0.0)
    body["stiffness"][i] = tie.stiffness / given.mass
    body["damping"][i] = tie.damping / given.mass
    body["strength"][i] = tie.strength / given.mass
    body["natural"][i] = length + tie.slack
    if tie.bracket:
        # above 0, whatever its slack, as a bracket
        body["shortest"][i] = max(length - tie.slack, TINY)


def standing(body: np.void, turned: float = 0.0) -> Floats:
    """Return the state of a body that stands at rest over the origin.

    Parameters
    ----------
    body : record ``BODY``
    turned : about the vertical, anticlockwise as seen from above [rad]

    Returns
    -------
    State, shape (SIZE,): see ``_body``.
    """
    y = np.zeros(SIZE)
    y[HEIGHT] = body["height"]
    # quaternion of a turn about z
    y[ATTITUDE], y[ATTITUDE + 3] = math.cos(turned / 2), math.sin(turned / 2)
    return y


def perturbed(
    system: System, spread: float, rng: np.random.Generator
) -> tuple[System, float]:
    """Return a body with an imperfect base, and a turn about the vertical: both drawn evenly.

    Walls stay as far from it as they stood, or further where it turns towards them.

    Parameters
    ----------
    system : of one body
    spread : by which each vertex, or the centre of a circle, is moved at most along each axis, over the width of
        the base [-]; and by which the body is turned at most [rad]
    rng : that draws

    Returns
    -------
    The system with the moved base, and the turn [rad].
    """
    body = system.bodies[0]
    if isinstance(body.base, Circle):
        x, y = rng.uniform(-spread, spread, 2) * 2 * body.base.radius
        centre = (body.base.centre[0] + float(x), body.base.centre[1] + float(y))
        base: Circle | Polygon = Circle(body.base.radius, centre)
    else:
        assert isinstance(body.base, Polygon)
        vertices = np.array(body.base.vertices)
        width = float(np.ptp(vertices, axis=0).max())
        moved = vertices + width * rng.uniform(-spread, spread, vertices.shape)
        base = Polygon(tuple((float(x), float(y)) for x, y in moved))
    turned = float(rng.uniform(-spread, spread))
    return with_bodies(system, [replace(body, base=base)], turned), turned
