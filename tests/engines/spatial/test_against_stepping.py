"""Fractions overturned in space are those of a plain time stepping that shares no code with the engine."""

import numpy as np
import pytest

from rockfrag.engines.spatial.outcome import run_case

from ...oracle.space_stepping import stepping
from .samples import DT, box, synthetic_motion

LEVELS = np.geomspace(0.6, 2.2, 10)
"""Peaks of the components over that which uplifts the box along its shorter side [-]."""


def compare(boxes, pairs, seed):
    """Outcomes of the engine and of the stepping, shape (boxes, pairs, levels)."""
    rng = np.random.default_rng(seed)
    shape = (boxes, pairs, len(LEVELS))
    found, expected = np.zeros(shape, bool), np.zeros(shape, bool)
    for i in range(boxes):
        width = rng.uniform(0.2, 0.6)
        depth = width * rng.uniform(0.7, 1.5)
        height = min(width, depth) * rng.uniform(2.5, 5)
        body = box(width, depth, height)
        corners = np.ascontiguousarray(body["points"][:4])
        inertia = np.ascontiguousarray(body["inertia"])
        for j in range(pairs):
            motion = synthetic_motion(rng, 2, 15.0)
            for k, level in enumerate(LEVELS):
                ground = motion * (level * min(width, depth) / height)
                found[i, j, k] = run_case(body, ground, DT)[0].overturned
                expected[i, j, k], _ = stepping(corners, inertia, 20.0, ground, DT, 9.81, 5e-4, 0.0)
    return found, expected


@pytest.mark.slow
def test_a_few_outcomes_are_those_of_a_plain_time_stepping():
    found, expected = compare(2, 1, 3)
    assert (found == expected).mean() >= 18 / 20


@pytest.mark.slow
def test_fractions_by_level_are_those_of_a_plain_time_stepping():
    found, expected = compare(40, 10, 1)
    difference = found.mean(axis=(0, 1)) - expected.mean(axis=(0, 1))
    assert np.abs(difference).max() <= 0.03
    assert (found == expected).mean() >= 0.88
