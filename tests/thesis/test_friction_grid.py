"""P/NP over friction: what is shared between coefficients is what each would give by itself."""

import math
from dataclasses import replace

import numpy as np
import pytest

from rockfrag import Block, Stack, overturns
from rockfrag.motions.processing import factors_to_pga
from rockfrag.records.motion import Motion
from rockfrag.shaketable.protocols import GeometricSteps, Protocol
from rockfrag_thesis.sensitivity_analysis.friction_grid import (
    friction_effects,
    friction_ratios,
    survived_amplitudes,
)
from rockfrag_thesis.sensitivity_analysis.simulated import level_amplitudes
from rockfrag_thesis.standing import SIZES, standing_definitions

from ..rocking.reference_bodies import polyline
from .conftest import bursts

TOWER = Block(0.124, 0.372, 2.172)
STACK = Stack(Block(0.184, 0.208, 2.3), TOWER)
INTENSITY_LEVELS = 0.2 * 1.15 ** np.arange(14)
PAIRS = [(first, two) for first in (0.3, 0.4, math.inf) for two in (0.25, 0.36, math.inf)]


@pytest.fixture(scope="module")
def motions() -> list[Motion]:
    return bursts(3, "AB", "ground", 250, 1.2)


def test_amplitudes_are_those_of_each_pair_climbed_by_itself(motions: list[Motion]) -> None:
    found = survived_amplitudes(STACK, PAIRS, motions, INTENSITY_LEVELS)
    scales = np.array([factors_to_pga(motion, INTENSITY_LEVELS) for motion in motions])
    accelerations = [motion.acceleration for motion in motions]
    fell = overturns([STACK] * len(PAIRS), accelerations, 0.01, scales, friction=PAIRS).overturned
    first = fell.argmax(axis=2)
    known = fell.any(axis=2) & (first > 0)
    each = np.where(known, INTENSITY_LEVELS[np.maximum(first - 1, 0)], np.nan)
    np.testing.assert_array_equal(found, each)
    assert np.isfinite(found).sum() > 6 and len(np.unique(found[np.isfinite(found)])) > 2


def test_without_end_friction_gives_what_pure_rocking_gives(motions: list[Motion]) -> None:
    pure = level_amplitudes([TOWER.system(), STACK.system()], motions, INTENSITY_LEVELS)
    rough = [
        survived_amplitudes(body, [(math.inf,) * count], motions, INTENSITY_LEVELS)[0]
        for body, count in ((TOWER, 1), (STACK, 2))
    ]
    np.testing.assert_array_equal(pure, rough)


def test_below_its_slenderness_an_object_has_no_amplitude(motions: list[Motion]) -> None:
    stacks, friction = {"tower": STACK}, {"ground": [0.3], "interface": [0.5]}
    rows = friction_ratios(stacks, motions, INTENSITY_LEVELS, **friction)
    smooth = rows[rows["ground"] == 0.3]
    assert smooth["np_g"].isna().all() and smooth["ratio"].isna().all()
    effects = friction_effects(rows, {"ground": 0})
    row = effects.query("ground == 0.3 and interface == 0.5 and object == 'all'").iloc[0]
    assert (row["pairs"], row["left_out"], row["np_survives"]) == (0, 2, 2)
    rough = effects.query("ground == inf and interface == inf and object == 'all'").iloc[0]
    assert rough["pairs"] == 2 and 0.5 < rough["ratio"] < 2


FINE_LEVELS = 0.2 * 1.01 ** np.arange(180)
PROTOCOL = Protocol(GeometricSteps(0.2, 0.05), 1.1)


def test_readings_of_a_ida_stand_or_fall_with_small_differences():
    chosen = [replace(TOWER.system(), name="T1"), replace(STACK.system(), name="P&T1")]
    motions = [Motion(polyline(seed, 1600), 0.01, f"M{seed}") for seed in range(4)]
    table = standing_definitions(chosen, motions, FINE_LEVELS, PROTOCOL, seed=1)
    assert len(table) == 2 * 4 * 3
    columns = [f"stands_{size:.0e}" for size in SIZES]
    stands = table[columns].mean()
    # the smaller the difference the more stand
    assert stands.is_monotonic_decreasing and stands.iloc[0] >= 0.9
    again = standing_definitions(chosen, motions, FINE_LEVELS, PROTOCOL, seed=1, threads=2)
    assert again.equals(table)
