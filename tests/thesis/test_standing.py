from dataclasses import replace

import numpy as np

from rockfrag import Block, Stack
from rockfrag.records.motion import Motion
from rockfrag.shaketable.protocols import GeometricSteps, Protocol
from rockfrag_thesis.standing import SIZES, standing_definitions

TOWER = Block(0.124, 0.372, 2.172)
STACK = Stack(Block(0.184, 0.208, 2.3), TOWER)
INTENSITY_LEVELS = 0.2 * 1.01 ** np.arange(180)
PROTOCOL = Protocol(GeometricSteps(0.2, 0.05), 1.1)


def shaking(seed):
    coarse = np.random.default_rng(seed).normal(size=201)
    values = np.interp(np.arange(1600) / 8, np.arange(201), coarse)
    return Motion(values, 0.01, f"M{seed}")


def test_readings_of_a_ida_stand_or_fall_with_small_differences():
    chosen = [replace(TOWER.system(), name="T1"), replace(STACK.system(), name="P&T1")]
    motions = [shaking(seed) for seed in range(4)]
    table = standing_definitions(chosen, motions, INTENSITY_LEVELS, PROTOCOL, seed=1)
    assert len(table) == 2 * 4 * 3
    columns = [f"stands_{size:.0e}" for size in SIZES]
    stands = table[columns].mean()
    # the smaller the difference the more stand
    assert stands.is_monotonic_decreasing and stands.iloc[0] >= 0.9
    again = standing_definitions(chosen, motions, INTENSITY_LEVELS, PROTOCOL, seed=1, threads=2)
    assert again.equals(table)
