"""Outcomes beside walls and kerbs and in cords, beside MuJoCo, another program in steps of 1 ms."""

import numpy as np
import pytest

from rockfrag import overturns

from .cases import DT
from .held_cases import DRAWN, LEVELS, drawn_case


@pytest.mark.slow
@pytest.mark.parametrize("kind", DRAWN)
def test_outcomes_are_those_of_mujoco_in_nine_of_ten_cases(kind: str) -> None:
    pytest.importorskip("mujoco", reason="MuJoCo is not installed (extra peers)")
    rng = np.random.default_rng(21)
    ours, theirs = np.zeros((2, len(LEVELS), 20), bool)
    for i, level in enumerate(LEVELS):
        for j in range(20):
            case = drawn_case(kind, level, rng)
            found = overturns(case.system, case.motion, DT, friction=case.mu)
            ours[i, j] = found.overturned
            theirs[i, j] = case.falls_in_mujoco()
    fell = ours.sum(axis=1), theirs.sum(axis=1)
    print(kind, "topple of 20 by level", *fell, "equal", (ours == theirs).mean())
    assert 0.1 < ours.mean() < 0.9
    assert (ours == theirs).mean() >= 0.9
    assert np.abs(fell[0] - fell[1]).max() <= 3
