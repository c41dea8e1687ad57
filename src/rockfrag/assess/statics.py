"""Statics: the factor on each motion from which it lifts an object, by its own components.

Of an object that something holds, or that may slide, only simulation says: the factor is infinite.

In: a system and motions [m/s²]. Out: factors, (motions,) [-]. Theory: ``docs/assess.md``, "What is computed".
"""

from collections.abc import Sequence

import numpy as np

from rockfrag.base.arrays import Floats
from rockfrag.base.units import GRAVITY
from rockfrag.records.motion import GroundMotion, Motion
from rockfrag.system.body import Circle, Polygon
from rockfrag.system.system import System, uplift_ratios


def lifting_in_plane(system: System, shaking: Sequence[Motion]) -> Floats:
    """Factor on each motion from which it opens a contact of a planar system at rest, shape (motions,)."""
    if system.holding or system.loose:
        return np.full(len(shaking), np.inf)
    least = min(uplift_ratios(system)) * GRAVITY
    return np.array([least / motion.pga for motion in shaking])


def lifting_in_space(system: System, shaking: Sequence[GroundMotion]) -> Floats:
    """Factor on each record from which both components lift a body in space over an edge, shape (records,).

    Over an edge at the distance d from below the centre of gravity at height h, an acceleration of the base away
    from it of g d/h; over a rim of radius r in any direction of g r/h. A centre that is not above the middle of a
    rim lifts it earlier towards the near side, by its distance.
    """
    if system.holding or system.loose:
        return np.full(len(shaking), np.inf)
    (body,) = system.bodies
    below, height = np.array(body.centre[:2]), body.centre[2]
    if isinstance(body.base, Circle):
        aside = float(_length(np.array(body.base.centre) - below))
        least = GRAVITY * (body.base.radius - aside) / height
        return np.array([least / _length(_samples(m)).max() for m in shaking])
    assert isinstance(body.base, Polygon)
    corners = np.array(body.base.vertices) - below
    x, y = corners.T
    across, along = (np.roll(corners, -1, axis=0) - corners).T
    side = _length(np.array([across, along]))
    outward = np.array([along / side, -across / side])
    distances = outward[0] * x + outward[1] * y
    directions = (outward / (GRAVITY * distances / height)).T
    return np.array([1 / _strongest(directions, _samples(m)) for m in shaking])


def _length(vectors: Floats) -> Floats:
    """Length of vectors of shape (2, …), of plain arithmetic: the same bits everywhere."""
    x, y = vectors
    return np.asarray(np.sqrt(x * x + y * y))


def _strongest(directions: Floats, samples: Floats) -> float:
    """Largest of the samples, shape (2, n), against any of the directions, shape (m, 2)."""
    return max(float(-(x * samples[0] + y * samples[1]).min()) for x, y in directions)


def _samples(motion: GroundMotion) -> Floats:
    """Both horizontal components, shape (2, samples); zeros where there is no second one [m/s²]."""
    x = motion.x.acceleration
    return np.stack(
        [x, np.zeros_like(x) if motion.y is None else motion.y.acceleration]
    )
