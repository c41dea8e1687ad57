"""Fractions overturned in space are those of a plain time stepping that shares no code with the engine."""

import numpy as np
import pytest

from rockfrag.engines.spatial.outcome import run_case

from ...oracle.space_stepping import stepping
from .samples import DT, box, synthetic_motion

LEVELS = np.geomspace(0.6, 2.2, 10)
"""Peaks of the components over that which uplifts the box along its shorter side [-]."""


@pytest.mark.slow
def test_fractions_by_level_are_those_of_a_plain_time_stepping():
    rng = np.random.default_rng(1)
    shape = (40, 10, len(LEVELS))
    found, expected = np.zeros(shape, bool), np.zeros(shape, bool)
    for i in range(shape[0]):
        width = rng.uniform(0.2, 0.6)
        depth = width * rng.uniform(0.7, 1.5)
        height = min(width, depth) * rng.uniform(2.5, 5)
        body = box(width, depth, height)
        corners = np.ascontiguousarray(body["points"][:4])
        inertia = np.ascontiguousarray(body["inertia"])
        for j in range(shape[1]):
            motion = synthetic_motion(rng, 2, 15.0)
            for k, level in enumerate(LEVELS):
                ground = motion * (level * min(width, depth) / height)
                found[i, j, k] = run_case(body, ground, DT)[0].overturned
                expected[i, j, k], _ = stepping(corners, inertia, 20.0, ground, DT, 9.81, 5e-4, 0.0)
    difference = found.mean(axis=(0, 1)) - expected.mean(axis=(0, 1))
    assert np.abs(difference).max() <= 0.03
    assert (found == expected).mean() >= 0.88
