"""Bodies as the kernels know them, made of what a user knows."""

import math

import numpy as np
from numpy.typing import NDArray

from rockfrag.engines.spatial._body import BODY, SIZE
from rockfrag.units import GRAVITY

Array = NDArray[np.float64]

NEVER_SLIDES = 20.0
"""Coefficient of friction of a base that holds: with none a body in space has no closed model [-]."""


def polygon_body(
    vertices: Array, inertia: Array, height: float, static: float, kinetic: float
) -> np.void:
    """Return a body on a convex polygon.

    Parameters
    ----------
    vertices
        Corners of the base from below the centre of mass, anticlockwise, shape (n, 2) [m], or (n, 3) with the height
        of each over the base's plane.
    inertia
        Tensor of inertia about the centre of mass over the mass, shape (3, 3) [m²].
    height
        Height of the centre of mass over the base [m].
    static, kinetic
        Coefficients of friction [-].
    """
    points = np.zeros((len(vertices), 3))
    points[:, : vertices.shape[1]] = vertices
    flat = bool(np.all(points[:, 2] == 0.0))
    points[:, 2] -= height
    following = np.roll(points, -1, axis=0)
    edges = following - points
    lengths = np.hypot(edges[:, 0], edges[:, 1])
    reach = (edges[:, 1] * points[:, 0] - edges[:, 0] * points[:, 1]) / lengths
    return _body(points, inertia, 0.0, np.zeros(2), height, static, kinetic, float(reach.min()), flat)


def round_body(
    radius: float, centre: Array, inertia: Array, height: float, static: float, kinetic: float
) -> np.void:
    """Return a body on a round base.

    Parameters
    ----------
    radius
        Radius of the base [m].
    centre
        Its centre, from below the centre of mass, shape (2,) [m].
    inertia, height, static, kinetic
        As of :func:`polygon_body`.
    """
    turns = math.pi / 4 + np.arange(4) * math.pi / 2
    feet = np.stack(
        [
            centre[0] + radius * np.cos(turns),
            centre[1] + radius * np.sin(turns),
            np.full(4, -height),
        ],
        axis=1,
    )
    least = radius - float(np.hypot(*centre))
    return _body(feet, inertia, radius, centre, height, static, kinetic, least, True)


def _body(
    points: Array,
    inertia: Array,
    radius: float,
    centre: Array,
    height: float,
    static: float,
    kinetic: float,
    reach: float,
    flat: bool,
) -> np.void:
    squares = np.einsum("ni,ni->n", points, points)
    outer = np.einsum("ni,nj->nij", points, points)
    about = inertia + squares[:, None, None] * np.eye(3) - outer
    across = (inertia[0, 0] + inertia[1, 1]) / 2
    count = len(points)
    body = np.zeros(1, BODY)
    body["count"], body["flat"], body["rim"], body["centre"] = count, flat, radius, centre
    body["height"], body["static"], body["kinetic"] = height, static, kinetic
    far = float(np.hypot(*centre)) + radius if radius else float(np.hypot(points[:, 0], points[:, 1]).max())
    body["furthest"] = math.atan2(far, height)
    body["barrier"] = GRAVITY * (math.hypot(reach, height) - height)
    body["pass_turn"] = math.pi * math.sqrt(1 + radius**2 / (across + height**2))
    body["inertia"], body["inverse"] = inertia, np.linalg.inv(inertia)
    body["points"][0, :count], body["about"][0, :count] = points, about
    body["about_inverse"][0, :count] = np.linalg.inv(about)
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
    level = np.hypot(acceleration[:, 0], acceleration[:, 1])
    both = np.stack([level, np.abs(acceleration[:, 2])], axis=1)
    return np.ascontiguousarray(np.maximum.accumulate(both[::-1], axis=0)[::-1])
