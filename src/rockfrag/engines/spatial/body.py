"""Bodies as the kernels know them, made of a system of one body in space."""

import math

import numpy as np
from numpy.typing import NDArray

from rockfrag.engines.spatial._body import BODY, MOST_VERTICES, SIZE
from rockfrag.engines.spatial._describe import fill_body
from rockfrag.errors import InputError
from rockfrag.system.body import Circle, Polygon
from rockfrag.system.system import System
from rockfrag.units import GRAVITY

Array = NDArray[np.float64]

NEVER_SLIDES = 20.0
"""Coefficient of friction of a contact without any: a body in space that only sticks is no closed model [-]."""


def kernel_body(system: System, g: float = GRAVITY) -> np.void:
    """Return the one body in space of a system, and its contact with the ground, as the kernels know it."""
    body, contact = system.bodies[0], system.contacts[0]
    static, kinetic = NEVER_SLIDES, NEVER_SLIDES
    if contact.friction is not None:
        static, kinetic = (min(value, NEVER_SLIDES) for value in contact.friction)
    x, y, height = body.centre
    inertia = body.tensor / body.mass
    if isinstance(body.base, Circle):
        centre = np.array(body.base.centre) - (x, y)
        return round_body(body.base.radius, centre, inertia, height, (static, kinetic), g)
    assert isinstance(body.base, Polygon)
    vertices = np.array(body.base.vertices) - (x, y)
    return polygon_body(vertices, inertia, height, (static, kinetic), g)


def polygon_body(
    vertices: Array,
    inertia: Array,
    height: float,
    friction: tuple[float, float],
    g: float = GRAVITY,
) -> np.void:
    """Return a body on a convex polygon, whose corners come anticlockwise from below the centre of mass [m]."""
    count = len(vertices)
    if count > MOST_VERTICES:
        raise InputError(
            f"base: {count} vertices are more than the {MOST_VERTICES} that a body in space may have; "
            "leave out those that hardly turn the outline, or give a circle."
        )
    body = np.zeros(1, BODY)
    body["count"], body["points"][0, :count, :2] = count, vertices
    return _filled(body, inertia, height, friction, g)


def round_body(
    radius: float,
    centre: Array,
    inertia: Array,
    height: float,
    friction: tuple[float, float],
    g: float = GRAVITY,
) -> np.void:
    """Return a body on a round base, whose centre counts from below the centre of mass [m]."""
    body = np.zeros(1, BODY)
    body["rim"], body["centre"] = radius, centre
    return _filled(body, inertia, height, friction, g)


def _filled(
    body: NDArray[np.void], inertia: Array, height: float, friction: tuple[float, float], g: float
) -> np.void:
    """Complete the record of a body whose base is in it."""
    body["height"], body["inertia"] = height, inertia
    body["static"], body["kinetic"] = friction
    if not fill_body(body.view(np.recarray)[0], g):
        raise InputError(
            "base: the centre of mass is not above the base, so the body cannot stand."
        )
    made: np.void = body[0]
    return made


def standing(body: np.void, turned: float = 0.0) -> Array:
    """Return the state of a body that stands at rest over the origin, turned about the vertical [rad]."""
    y = np.zeros(SIZE)
    y[2] = body["height"]
    y[3], y[6] = math.cos(turned / 2), math.sin(turned / 2)
    return y


def later_peaks(acceleration: Array) -> Array:
    """Return the largest horizontal and vertical acceleration from each sample on, shape (n, 2) [m/s²]."""
    x, y = acceleration[:, 0], acceleration[:, 1]
    level = np.sqrt(x * x + y * y)
    both = np.stack([level, np.abs(acceleration[:, 2])], axis=1)
    return np.ascontiguousarray(np.maximum.accumulate(both[::-1], axis=0)[::-1])
