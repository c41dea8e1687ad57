"""Statics: the factor on each motion from which it lifts an object, by its own components.

Of an object that something holds, or that may slide, only simulation says: the factor is infinite.

In: a system and motions [m/s²]. Out: factors, (motions,) [-]. Theory: ``docs/assess.md``, "What is computed".
"""

from collections.abc import Sequence

import numpy as np

from rockfrag.assess.core import scales
from rockfrag.base.arrays import Floats
from rockfrag.records.motion import GroundMotion, Motion
from rockfrag.system.body import Circle, Polygon
from rockfrag.system.system import System, uplift_ratios


def lifting_in_plane(system: System, shaking: Sequence[Motion]) -> Floats:
    """Factor on each motion from which it opens a contact of a planar system at rest, shape (motions,)."""
    if system.holding or system.loose:
        return np.full(len(shaking), np.inf)
    least = min(uplift_ratios(system))
    return np.array([scales.lifting_in_plane(least, each.pga) for each in shaking])


def lifting_in_space(system: System, shaking: Sequence[GroundMotion]) -> Floats:
    """Factor on each record from which both components lift a body in space, shape (records,)."""
    if system.holding or system.loose:
        return np.full(len(shaking), np.inf)
    (body,) = system.bodies
    below, height = np.array(body.centre[:2]), float(body.centre[2])
    each = [_samples(motion) for motion in shaking]
    if isinstance(body.base, Circle):
        radius = float(body.base.radius)
        x, y = (np.array(body.base.centre) - below).tolist()
        return np.array(
            [scales.lifting_over_rim(radius, x, y, height, *xy) for xy in each]
        )
    assert isinstance(body.base, Polygon)
    corners = np.ascontiguousarray(np.array(body.base.vertices) - below)
    return np.array([scales.lifting_over_edges(corners, height, *xy) for xy in each])


def _samples(motion: GroundMotion) -> tuple[Floats, Floats]:
    """Both horizontal components; zeros where there is no second one [m/s²]."""
    x = motion.x.acceleration
    y = np.zeros_like(x) if motion.y is None else motion.y.acceleration
    return np.ascontiguousarray(x), np.ascontiguousarray(y)
