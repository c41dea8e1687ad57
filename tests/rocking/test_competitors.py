"""The programs that ``make bench`` compares with: written for speed's sake, they have to say the same.

MuJoCo's contacts, stiff and without bounce, are springs and dampers solved for at each small step: it knows no
pivots, contact states or impact maps.
"""

import math

import numpy as np
import pytest

from rockfrag import Block, Stack, simulate
from rockfrag.rocking.ensemble import overturns

from ..oracle.competitors import mujoco_outcome, numpy_lone, scipy_lone, scipy_stack

DT = 0.01  # sampling interval of the motions [s]
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


STEP = 2e-4  # [s]
QUIET = 3.0  # time after the motion for what is falling to fall [s]


def mujoco_overturns(stack: Stack, motion: np.ndarray) -> bool:
    """Whether a block falls in MuJoCo."""
    return mujoco_outcome(stack, np.append(motion, np.zeros(round(QUIET / DT))), DT, timestep=STEP)


def random_case(rng: np.random.Generator) -> tuple[Stack, np.ndarray]:
    """Draw a statue on a squat pedestal, and a burst of three sines that may overturn it."""
    lower = Block(rng.uniform(0.5, 0.8), rng.uniform(0.5, 1.0), rng.uniform(100, 400))
    width = rng.uniform(0.4, 0.9) * lower.width
    upper = Block(width, width * rng.uniform(2.5, 4.5), rng.uniform(30, 150))
    t = np.arange(301) * DT
    waves = sum(
        np.sin(2 * math.pi * f * t + phase)
        for f, phase in zip(rng.uniform(0.5, 2.5, 3), rng.uniform(0, 2 * math.pi, 3), strict=True)
    )
    motion = waves * np.sin(math.pi * t / t[-1])
    peak = rng.uniform(1.0, 3.0) * 9.81 * upper.b / upper.h
    return Stack(lower, upper), peak * motion / np.abs(motion).max()


def near_critical(stack: Stack, motion: np.ndarray) -> bool:
    """Whether two per cent more or less of the motion changes the outcome."""
    factors = 1 + np.array([-0.02, -0.015, -0.01, -0.005, 0.0, 0.005, 0.01, 0.015, 0.02])
    return len({simulate(stack, f * motion, DT).overturned for f in factors}) == 2


@pytest.mark.peers
# random bodies may lose contact, and pure rocking is what this test is about
@pytest.mark.filterwarnings("ignore::rockfrag.rocking.ensemble.LightBodies")
@pytest.mark.parametrize(
    ("cases", "seed", "most", "falls"),
    [(12, 100, 1, (2, 10)), pytest.param(100, 101, 5, (20, 80), marks=pytest.mark.slow)],
)
def test_mujoco_gives_the_same_outcome(cases, seed, most, falls):
    pytest.importorskip("mujoco")
    rng = np.random.default_rng(seed)
    differing = fallen = 0
    for _ in range(cases):
        stack, motion = random_case(rng)
        ours = simulate(stack, motion, DT).overturned
        fallen += ours
        if mujoco_overturns(stack, motion) != ours:
            differing += 1
            assert near_critical(stack, motion)
    assert differing <= most
    assert falls[0] <= fallen <= falls[1]
