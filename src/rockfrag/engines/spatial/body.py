"""Bodies as the kernels know them, made of a system of one body in space."""

import math
from dataclasses import replace

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from rockfrag.base.arrays import Floats
from rockfrag.base.errors import InputError
from rockfrag.base.units import GRAVITY
from rockfrag.engines.spatial._body import BODY, MOST_VERTICES, SIZE
from rockfrag.engines.spatial._describe import fill_body
from rockfrag.engines.spatial._integrate import WINDOW
from rockfrag.system.body import Circle, Polygon
from rockfrag.system.system import System

# size of the perturbation that tells how robust an outcome is: of vertices over the width of the base, of the
# direction in radians [-].  Two vertices that land at once and two that land one after the other go on
# differently, however close in time: an ideal box has outcomes that no real one has
PERTURBATION = 1e-6
# coefficient of friction of a contact without any: a body in space that only sticks is no closed model [-]
NEVER_SLIDES = 20.0


def kernel_body(system: System, g: float = GRAVITY) -> np.void:
    """Return the one body in space of a system, and its contact with the ground, as the kernels know it."""
    given, contact = system.bodies[0], system.contacts[0]
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
    return body


def standing(body: np.void, turned: float = 0.0) -> Floats:
    """Return the state of a body that stands at rest over the origin, turned about the vertical [rad]."""
    y = np.zeros(SIZE)
    y[2] = body["height"]
    y[3], y[6] = math.cos(turned / 2), math.sin(turned / 2)
    return y


def later_peaks(acceleration: Floats) -> Floats:
    """Return the largest horizontal and vertical acceleration from each sample on, shape (n, 4) [m/s²].

    The last two columns are those of the next WINDOW intervals alone.
    """
    x, y = acceleration[:, 0], acceleration[:, 1]
    level = np.sqrt(x * x + y * y)
    both = np.stack([level, np.abs(acceleration[:, 2])], axis=1)
    later = np.maximum.accumulate(both[::-1], axis=0)[::-1]
    padded = np.pad(both, ((0, WINDOW), (0, 0)))
    soon = sliding_window_view(padded, WINDOW + 1, axis=0).max(axis=-1)
    return np.ascontiguousarray(np.hstack([later, soon]))


def perturbed(
    system: System, spread: float, rng: np.random.Generator
) -> tuple[System, float]:
    """Return a body with its base moved by up to ``spread`` of its extent, and a turn within that angle [rad]."""
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
    return replace(system, bodies=(replace(body, base=base),)), turned
