"""The kernels agree with the plain integrator, which shares nothing with them but the bodies."""

import numpy as np
import pytest

from rockfrag import Block, Stack, overturns, simulate

from ..oracle.rocking_integrator import simulate_reference

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


def agree(seed, lone, linear=False):
    body, motion, restitution = random_case(seed, lone)
    fast = simulate(body, motion, DT, restitution=restitution, linear=linear)
    plain = simulate_reference(body, motion, DT, restitution=restitution, linear=linear)
    outcome = overturns(body, motion, DT, [1.0], restitution=[restitution], linear=linear)
    if fast.unstable_distance > MARGIN:
        assert fast.overturned == plain.overturned == bool(outcome.overturned[0, 0, 0])
    grazing = first_grazing(fast)
    n = min(len(fast.time), len(plain.time), int(np.searchsorted(fast.time, grazing)))
    # a block that is falling leaves its unstable balance exponentially: compare while it can return
    upright = np.abs(fast.theta[:n]).max(axis=1) < 0.5
    difference = np.abs(fast.theta[:n] - plain.theta[:n]).max(axis=1)
    assert difference[upright].max(initial=0.0) < 1e-6


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


@pytest.mark.parametrize("lone", [True, False], ids=["block", "stack"])
@pytest.mark.parametrize("seed", range(10))
def test_bodies_rock_as_the_plain_integrator_says(seed, lone):
    agree(seed, lone)


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::rockfrag.rocking.ensemble.LightBodies")
@pytest.mark.parametrize(
    ("seed", "lone", "linear"),
    [
        *((seed, False, False) for seed in range(10, 225)),
        *((seed, True, False) for seed in range(10, 75)),
        *((seed, lone, True) for seed in range(20) for lone in (True, False)),
    ],
)
def test_hundreds_more(seed, lone, linear):
    agree(seed, lone, linear)


def test_the_outcome_does_not_depend_on_where_the_plain_integrator_calls_hops_chatter():
    body, motion, _ = random_case(1, lone=False)
    coarse, fine = (
        simulate_reference(body, motion, DT, duration=2.0, chatter=c) for c in (1e-4, 1e-7)
    )
    n = min(len(coarse.time), len(fine.time))
    assert coarse.overturned == fine.overturned
    assert np.abs(coarse.theta[:n] - fine.theta[:n]).max() < 1e-3
