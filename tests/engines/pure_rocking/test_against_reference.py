"""The kernels agree with the plain integrator, which shares nothing with them but the bodies, and with MuJoCo."""

import math

import numpy as np
import pytest

from rockfrag import Block, Stack, overturns, simulate

from ...oracle.mujoco_model import mujoco_outcome
from ...oracle.rocking_integrator import simulate_reference

DT = 0.01
MARGIN = 0.02
"""Closest approach to balance, in critical angles, below which an outcome may hang on rounding."""


def random_motion(rng, peak):
    """Six sines under an envelope, 5 s, peak [m/s²]."""
    time = np.arange(500) * DT
    motion = sum(
        rng.normal() * np.sin(2 * np.pi * f * time + rng.uniform(0, 6))
        for f in rng.uniform(0.4, 4, 6)
    )
    motion = motion * np.minimum(1, time) * np.exp(-0.8 * np.maximum(0, time - 3))
    motion[-1] = 0.0
    return motion * peak / np.abs(motion).max()


def random_case(seed, lone):
    """A body (every third off-centre and leaning), a motion and a restitution (every fifth measured)."""
    rng = np.random.default_rng([20, seed])
    base, slenderness = rng.uniform(0.1, 0.5), rng.uniform(2, 6)
    below, squatness = base * rng.uniform(1, 1.6), rng.uniform(0.5, 2.5)
    odd = seed % 3 == 2
    height = base * slenderness
    centre = height * (0.45 if odd else 0.5), 0.05 * base * rng.normal() * odd
    upper = Block(base, height, 1000 * base**2 * slenderness, None, *centre)
    mass = 1000 * below**2 * squatness * rng.uniform(0.3, 3)
    lower = Block(
        below, below * squatness, mass,
        cg_offset=0.03 * below * rng.normal() * odd, lean=0.005 * rng.normal() * odd,
    )  # fmt: skip
    body = upper if lone else Stack(lower, upper)
    weakest = upper.alpha if lone else min(upper.alpha, body.rigidly_joined().alpha)
    motion = random_motion(rng, 9.81 * weakest * rng.uniform(1.1, 4))
    restitution = None if seed % 5 else (0.85 if lone else (0.6, 0.85))
    return body, motion, restitution


def first_grazing(response):
    """Time of the first impact with less than 1e-3 rad/s; infinite if there is none."""
    for _, contact_event in response.contact_events.iterrows():
        change = np.diff(contact_event["omega_before"], prepend=0.0)
        if (
            contact_event["kind"] != "opening"
            and np.abs(change[change != 0]).min(initial=1.0) < 1e-3
        ):
            return contact_event["time"]
    return np.inf


MANY = [
    *((seed, False, False) for seed in range(5, 225)),
    *((seed, True, False) for seed in range(5, 75)),
    *((seed, lone, True) for seed in range(20) for lone in (True, False)),
]


@pytest.mark.filterwarnings("ignore::rockfrag.simulation.ensemble.LightBodies")
@pytest.mark.parametrize(
    ("seed", "lone", "linear"),
    [
        *((seed, lone, False) for seed in range(5) for lone in (True, False)),
        *(pytest.param(*case, marks=pytest.mark.slow) for case in MANY),
    ],
)
def test_bodies_rock_as_the_plain_integrator_says(seed, lone, linear):
    body, motion, restitution = random_case(seed, lone)
    fast = simulate(body, motion, DT, restitution=restitution, linear=linear)
    plain = simulate_reference(body, motion, DT, restitution=restitution, linear=linear)
    outcome = overturns(
        body, motion, DT, [1.0], restitution=[restitution], linear=linear
    )
    if fast.unstable_distance > MARGIN:
        assert fast.overturned == plain.overturned == bool(outcome.overturned[0, 0, 0])
    grazing = first_grazing(fast)
    n = min(len(fast.time), len(plain.time), int(np.searchsorted(fast.time, grazing)))
    # a block that is falling leaves its unstable balance exponentially: compare while it can return
    upright = np.abs(fast.theta[:n]).max(axis=1) < 0.5
    difference = np.abs(fast.theta[:n] - plain.theta[:n]).max(axis=1)
    assert difference[upright].max(initial=0.0) < 1e-6


def test_the_outcome_does_not_depend_on_where_the_plain_integrator_calls_hops_chatter():
    body, motion, _ = random_case(1, lone=False)
    coarse, fine = (
        simulate_reference(body, motion, DT, duration=2.0, chatter=c)
        for c in (1e-4, 1e-7)
    )
    n = min(len(coarse.time), len(fine.time))
    assert coarse.overturned == fine.overturned
    assert np.abs(coarse.theta[:n] - fine.theta[:n]).max() < 1e-3


STEP = 2e-4  # [s]
QUIET = 3.0  # time after the motion for what is falling to fall [s]


def mujoco_overturns(stack: Stack, motion: np.ndarray) -> bool:
    """Whether a block falls in MuJoCo."""
    return mujoco_outcome(
        stack, np.append(motion, np.zeros(round(QUIET / DT))), DT, timestep=STEP
    )


def burst_case(rng: np.random.Generator) -> tuple[Stack, np.ndarray]:
    """Draw a statue on a squat pedestal, and a burst of three sines that may overturn it."""
    lower = Block(rng.uniform(0.5, 0.8), rng.uniform(0.5, 1.0), rng.uniform(100, 400))
    width = rng.uniform(0.4, 0.9) * lower.width
    upper = Block(width, width * rng.uniform(2.5, 4.5), rng.uniform(30, 150))
    t = np.arange(301) * DT
    waves = sum(
        np.sin(2 * math.pi * f * t + phase)
        for f, phase in zip(
            rng.uniform(0.5, 2.5, 3), rng.uniform(0, 2 * math.pi, 3), strict=True
        )
    )
    motion = waves * np.sin(math.pi * t / t[-1])
    peak = rng.uniform(1.0, 3.0) * 9.81 * upper.b / upper.h
    return Stack(lower, upper), peak * motion / np.abs(motion).max()


def near_critical(stack: Stack, motion: np.ndarray) -> bool:
    """Whether two per cent more or less of the motion changes the outcome."""
    factors = 1 + np.array(
        [-0.02, -0.015, -0.01, -0.005, 0.0, 0.005, 0.01, 0.015, 0.02]
    )
    return len({simulate(stack, f * motion, DT).overturned for f in factors}) == 2


@pytest.mark.peers
# random bodies may lose contact, and pure rocking is what this test is about
@pytest.mark.filterwarnings("ignore::rockfrag.simulation.ensemble.LightBodies")
@pytest.mark.parametrize(
    ("cases", "seed", "most", "falls"),
    [
        (12, 100, 1, (2, 10)),
        pytest.param(100, 101, 5, (20, 80), marks=pytest.mark.slow),
    ],
)
def test_mujoco_gives_the_same_outcome(cases, seed, most, falls):
    pytest.importorskip("mujoco")
    rng = np.random.default_rng(seed)
    differing = fallen = 0
    for _ in range(cases):
        stack, motion = burst_case(rng)
        ours = simulate(stack, motion, DT).overturned
        fallen += ours
        if mujoco_overturns(stack, motion) != ours:
            differing += 1
            assert near_critical(stack, motion)
    assert differing <= most
    assert falls[0] <= fallen <= falls[1]
