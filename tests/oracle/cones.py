"""Whether pushes that obey Coulomb's law explain a change of momentum: least squares whose parts may not pull.

It knows where bodies touch what is under or beside them, and the coefficients there; of how an impact was solved
it knows nothing.
"""

import math
from typing import NamedTuple

import numpy as np
from scipy.optimize import nnls

SIDES = 96
"""Rays of a cone in space; those of a pyramid around it, by which friction is taken as 5e-4 too large."""


class Touch(NamedTuple):
    """A place where a body is pushed: by the ground, a wall, or the body under it."""

    point: np.ndarray
    normal: np.ndarray  # towards the body
    mu: float
    body: int = 0
    under: int = -1  # the body that pushes, and is pushed; -1: ground or wall


def planar_rays(touch: Touch, q: np.ndarray) -> np.ndarray:
    """Impulses (x, y, clockwise) of each body along both edges of a cone, shape (2, bodies, 3)."""
    tangent = np.array([touch.normal[1], -touch.normal[0]])
    found = np.zeros((2, len(q), 3))
    for ray, side in zip(found, (1, -1), strict=True):
        push = touch.normal + side * touch.mu * tangent
        for body, sign in ((touch.body, 1), (touch.under, -1)):
            if body >= 0:
                x, y = touch.point - q[body, :2]
                ray[body] = sign * np.array([*push, push[0] * y - push[1] * x])
    return found


def spatial_rays(touch: Touch, centre: np.ndarray) -> np.ndarray:
    """Impulses (x, y, z, about x, y, z) of a body along the edges of a pyramid around a cone, shape (SIDES, 6)."""
    first = np.cross(touch.normal, [0.6, 0.0, 0.8])
    first /= np.linalg.norm(first)
    angles = 2 * math.pi * np.arange(SIDES) / SIDES
    around = np.outer(np.cos(angles), first)
    around += np.outer(np.sin(angles), np.cross(touch.normal, first))
    pushes = touch.normal + touch.mu / math.cos(math.pi / SIDES) * around
    return np.hstack([pushes, np.cross(touch.point - centre, pushes)])


def unexplained(rays: np.ndarray, change: np.ndarray) -> float:
    """Part of a change of momentum that no sum of rays with positive weights gives; both in units of momentum."""
    rays = rays[np.linalg.norm(rays, axis=1) > 0]
    if not rays.size:
        return float(np.linalg.norm(change))
    rays = rays / np.linalg.norm(rays, axis=1, keepdims=True)
    return float(nnls(rays.T, change)[1])
