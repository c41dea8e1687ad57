"""How robust an outcome in space is: the same case with a base and a direction that differ by next to nothing.

Two vertices that land at once and two that land one after the other go on differently, however close in time: an
ideal box has outcomes that no real one has.
"""

from dataclasses import replace

import numpy as np

from rockfrag.system.body import Circle, Polygon
from rockfrag.system.system import System

PERTURBATION = 1e-6
"""Size of the perturbation: of vertices over the width of the base, of the direction in radians [-]."""


def perturbed(system: System, spread: float, rng: np.random.Generator) -> tuple[System, float]:
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
