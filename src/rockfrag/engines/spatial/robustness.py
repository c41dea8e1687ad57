"""How robust an outcome in space is: the same case with a base and a direction that differ by next to nothing.

Two vertices that land at once and two that land one after the other go on differently, however close in time: an
ideal box has outcomes that no real one has.  The flip rate says how often.
"""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from rockfrag.engines.spatial.body import kernel_body, later_peaks
from rockfrag.engines.spatial.outcome import run_case
from rockfrag.errors import InputError
from rockfrag.records.ground_motion import GroundMotion
from rockfrag.system.body import Circle, Polygon
from rockfrag.system.system import System
from rockfrag.units import GRAVITY

PERTURBATION = 1e-6
"""Size of the perturbation: of vertices over the width of the base, of the direction in radians [-]."""


def spread_vertices(system: System, spread: float, rng: np.random.Generator) -> System:
    """Return a body whose vertices lie a little beside where they are drawn.

    Parameters
    ----------
    system
        One body in space.
    spread
        Largest displacement of each vertex along x and y, over the largest extent of the base [-]; of a circle
        that of its centre.
    rng
        Source of the random numbers.

    Returns
    -------
    The system with displacements uniform in ± spread.
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
    return replace(system, bodies=(replace(body, base=base),))


def perturbed(system: System, spread: float, rng: np.random.Generator) -> tuple[System, float]:
    """Return a body with its vertices spread, and an angle within ± spread by which it is turned [rad]."""
    return spread_vertices(system, spread, rng), float(rng.uniform(-spread, spread))


def flip_rate(
    system: System,
    motion: GroundMotion,
    scale: float = 1.0,
    *,
    perturbation: float = PERTURBATION,
    repeats: int = 20,
    seed: int = 0,
    g: float = GRAVITY,
) -> tuple[bool, float]:
    """Return an outcome and the fraction of next to equal cases that end otherwise.

    Parameters
    ----------
    system
        One body in space.
    motion
        Motion of the ground.
    scale
        Factor on the motion.
    perturbation
        Size of the perturbation of vertices and direction [-].
    repeats
        Number of perturbed cases.
    seed
        Seed of the random numbers.
    g
        Acceleration of gravity [m/s²].

    Returns
    -------
    Whether the body overturned, and the fraction of the perturbed cases with the other outcome.

    Raises
    ------
    InputError
        If the system is no single body in space.
    """
    if system.planar or system.count != 1:
        raise InputError("flip rate: expected one body in space; give its depth, or a mesh.")
    ground = motion.accelerations
    later = later_peaks(ground)
    first = _falls(system, ground, later, motion.dt, scale, 0.0, g)
    rng = np.random.default_rng(seed)
    flips = 0
    for _ in range(repeats):
        other, turned = perturbed(system, perturbation, rng)
        flips += _falls(other, ground, later, motion.dt, scale, turned, g) != first
    return first, flips / repeats


def _falls(
    system: System,
    ground: NDArray[np.float64],
    later: NDArray[np.float64],
    dt: float,
    scale: float,
    turned: float,
    g: float,
) -> bool:
    body = kernel_body(system, g)
    outcome, _ = run_case(body, ground, dt, scale, g=g, turned=turned, peaks=later)
    return outcome.overturned
