"""The programs that ``make bench`` compares with: written for speed's sake, they have to say the same."""

import numpy as np
import pytest

from rockfrag.rocking.ensemble import overturns
from rockfrag.system.blocks import Block, Stack

from ..oracle.competitors import numpy_lone, scipy_lone, scipy_stack

DT = 0.01
STATUE = Block(0.3, 1.2, 200.0)
STACK = Stack(Block(0.4, 0.3, 100.0), STATUE)
PULSE = np.sin(2 * np.pi * np.arange(101) * DT)
"""One sine of a second, at 1 m/s²."""


@pytest.mark.parametrize("by_sample", [False, True])
@pytest.mark.parametrize("body", [STATUE, STACK], ids=["block", "stack"])
def test_solve_ivp_gives_the_same_outcomes(body: Block | Stack, by_sample: bool):
    outcome = scipy_lone if isinstance(body, Block) else scipy_stack
    amplitudes = (2.0, 4.0, 8.0)
    ours = overturns(body, PULSE, DT, amplitudes).overturned.ravel().tolist()
    assert [outcome(body, a * PULSE, DT, by_sample=by_sample) for a in amplitudes] == ours
    assert len(set(ours)) == 2


def test_numpy_gives_nearly_the_same_outcomes_with_small_steps():
    """It takes impacts at the ends of steps, and ends with the motion."""
    bodies = [Block(b, 4 * b, 500.0) for b in (0.2, 0.3, 0.4, 0.6)]
    scales = np.linspace(1.0, 12.0, 30)[np.newaxis]
    time = np.arange(0.0, 5.0, 0.001)
    pulse = np.where(time < 1.0, np.sin(2 * np.pi * time), 0.0)
    theirs = numpy_lone(bodies, [pulse], scales, 0.001)
    ours = overturns(bodies, pulse, 0.001, scales).overturned
    assert (theirs.reshape(ours.shape) != ours).mean() < 0.05
