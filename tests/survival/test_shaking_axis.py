"""The axis of shaking by falls: motions of one axis, synthetic cemeteries, and errors that all stones share."""

import math

import numpy as np
import pytest

from rockfrag.assess.motions import MotionSet
from rockfrag.records.motion import Motion
from rockfrag.survival.shaking_axis import (
    ANGLES,
    PredictedFalls,
    fall_density,
    predicted_falls,
    shaking_axis,
)
from rockfrag.system.blocks import Block

LEVELS = np.geomspace(5, 200, 12)


def made_falls(rng, motions: int) -> PredictedFalls:
    """Falls about the axis, to either side, that each motion throws further off; none at low levels."""
    side = np.pi * rng.integers(0, 2, (motions, LEVELS.size))
    angles = side + rng.normal(0, 0.35, (motions, 1)) + rng.normal(0, 0.1, side.shape)
    return PredictedFalls(LEVELS, np.where(LEVELS > 30, angles, np.nan))


def world(rng, stones: int) -> tuple[float, float]:
    """Error of the axis and half of its interval in one world [degrees]; its motion is none of the set."""
    own = made_falls(rng, 1)
    truth, level = rng.uniform(0, 360), rng.integers(7, 12)
    angles = own.angles[0, rng.integers(level - 1, min(level + 2, 12), stones)]
    azimuths = truth + np.degrees(angles) + rng.normal(0, 10, stones)
    about = made_falls(rng, 60)
    weights = np.zeros(about.angles.shape)
    weights[:, 6:] = 1 / weights[:, 6:].size
    found = shaking_axis([(azimuths % 360, fall_density(about, 0.2))], weights)
    return (found.azimuth - truth + 90) % 180 - 90, found.within


@pytest.mark.parametrize("stones", [5, 40])
def test_the_interval_of_the_axis_holds_it_in_nine_of_ten_worlds(stones):
    rng = np.random.default_rng(stones)
    worlds = np.array([world(rng, stones) for _ in range(120)])
    inside = np.mean(np.abs(worlds[:, 0]) <= worlds[:, 1] + 2)
    assert 0.83 <= inside <= 0.97
    # what the motion does to all stones does not average out: 0.35 rad, times 1.64
    assert np.median(worlds[:, 1]) > 0.6 * math.degrees(1.64 * 0.35)


def test_stones_fall_along_the_only_component_and_the_axis_turns_with_the_azimuths(
    made_motions,
):
    first = made_motions(2)
    still = [
        Motion(1e-3 * motion.acceleration, motion.dt, f"{motion.name} across")
        for motion in first
    ]
    motions = tuple(part for pair in zip(first, still, strict=True) for part in pair)
    about = MotionSet(motions, motions, ((0, 1), (2, 3)), "")
    predicted = predicted_falls(Block(0.2, 1.2, 100.0), about)
    facing, other = np.split(predicted.angles, 2)
    assert np.isfinite(facing).any()
    # to one side or the other of the motion's axis
    assert np.nanmax(np.abs(np.sin(facing))) < 0.1
    assert other.shape == facing.shape
    density = fall_density(PredictedFalls(predicted.levels, facing), 0.2)
    felled = density.sum(axis=0) > 0
    assert density.sum(axis=0)[felled] * (ANGLES[1] - ANGLES[0]) == pytest.approx(1)
    for turn in (0.0, 70.0):
        weights = felled / felled.sum()
        found = shaking_axis([([turn, turn + 5, turn - 5], density)], weights)
        assert abs((found.azimuth - turn + 90) % 180 - 90) < 6
        assert found.within < 25


def test_turned_components_of_scaled_records_are_no_doubt_of_their_unit(
    made_motions, recwarn
):
    (motion,) = made_motions(1)
    samples = motion.acceleration.copy()
    samples[np.abs(samples).argmax()] *= 8
    pair = tuple(
        Motion(factor * samples, motion.dt, name)
        for factor, name in ((1.0, "first"), (0.95, "second"))
    )
    predicted_falls(Block(0.2, 1.2, 100.0), MotionSet(pair, pair, ((0, 1),), ""))
    assert not recwarn.list
