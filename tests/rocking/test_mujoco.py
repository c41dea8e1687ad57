"""Another program's outcome: MuJoCo with stiff contacts, high friction and no bounce.

Its contacts are springs and dampers solved for at each small step, so it knows nothing of pivots, contact
states or impact maps.  Two boxes that move in the plane stand on the ground; the ground's acceleration
acts as a force on each of them.
"""

import math

import numpy as np
import pytest

from rockfrag import Block, Stack, simulate

from ..oracle.competitors import mujoco_outcome

pytest.importorskip("mujoco")

pytestmark = [
    pytest.mark.peers,
    # random bodies may lose contact, and pure rocking is what these tests are about
    pytest.mark.filterwarnings("ignore::rockfrag.rocking.ensemble.LightBodies"),
]

STEP = 2e-4  # [s]
DT = 0.01  # sampling interval of the motions [s]
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


@pytest.mark.parametrize(
    ("cases", "seed", "most", "falls"),
    [(12, 100, 1, (2, 10)), pytest.param(100, 101, 5, (20, 80), marks=pytest.mark.slow)],
)
def test_mujoco_gives_the_same_outcome(cases, seed, most, falls):
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
