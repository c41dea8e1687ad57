"""A block whose centre of gravity is off the middle comes down on two unlike corners.

Held against the impulse of an impact from a linear system written out here, and the plain integrator.
"""

import numpy as np
import pytest

from rockfrag import Block, overturns, simulate
from rockfrag.units import GRAVITY as G

from ..oracle.rocking_integrator import simulate_reference

BLOCKS = [Block(0.35, 1.2, 367.5, cg_offset=x) for x in (0.03, -0.08, 0.12)]


def impulse_ratio(block, pivot):
    """Rate after over rate before an impact on a corner (+1 right): its impulse stops the new corner at once."""
    to_old, to_new = (
        np.array([side * block.width / 2 - block.cg_offset, -block.height / 2])
        for side in (-pivot, pivot)
    )
    across = np.array([[0.0, 1.0], [-1.0, 0.0]])  # clockwise turn: v = ω (y, -x)
    # unknown: rate after, velocity of the centre after, impulse
    system = np.zeros((5, 5))
    system[:2, 0], system[:2, 1:3] = across @ to_new, np.eye(2)
    system[2:4, 1:3], system[2:4, 3:] = block.mass * np.eye(2), -np.eye(2)
    system[4] = [block.centroidal_inertia, 0, 0, *-(np.array([to_new[1], -to_new[0]]))]
    before = -across @ to_old  # of the centre at rate 1: the old corner rests
    known = [0, 0, *(block.mass * before), block.centroidal_inertia]
    return np.linalg.solve(system, known)[0]


def integrated(block, acceleration, dt):
    """Peak rotation over the critical angle of its side, and whether the block fell."""
    found = simulate_reference(block, acceleration, dt)
    critical = [
        np.arctan2(block.width / 2 - s * block.cg_offset, block.height / 2) for s in (1, -1)
    ]
    return max(found.theta.max() / critical[0], -found.theta.min() / critical[1]), found.overturned


def pulses(block, seed, dt=0.005):
    """Motion of 4 s that topples a block from some amplitude on [m/s²]."""
    rng = np.random.default_rng(seed)
    time, opening = np.arange(0, 4, dt), (block.width - 2 * abs(block.cg_offset)) / block.height * G
    waves = sum(
        np.sin(2 * np.pi * f * time + p) for f, p in rng.uniform((0.4, 0), (2.5, 6), (4, 2))
    )
    return waves * np.sin(np.pi * time / 4) * opening * (1.5 + 0.25 * seed) / np.abs(waves).max()


@pytest.mark.parametrize("block", BLOCKS, ids=lambda block: f"{block.cg_offset} m")
def test_an_impact_conserves_momentum_about_the_corner_that_it_ends_on(block):
    for pivot in (1, -1):
        assert block.momentum_restitution(-pivot) == pytest.approx(impulse_ratio(block, pivot))
    assert block.momentum_restitution(1) != pytest.approx(block.momentum_restitution(-1), rel=0.01)


@pytest.mark.parametrize("block", BLOCKS, ids=lambda block: f"{block.cg_offset} m")
def test_every_way_of_asking_gives_what_these_equations_give(block):
    motions = [pulses(block, seed) for seed in range(8)]
    expected = [integrated(block, motion, 0.005) for motion in motions]
    # as measured, what momentum gives is the same motion
    both = tuple(impulse_ratio(block, pivot) for pivot in (1, -1))
    ways = {
        "lanes": overturns(block, motions, 0.005),
        "measured": overturns(block, motions, 0.005, restitution=[both]),
        "loose": overturns(block, motions, 0.005, friction=50.0),
    }
    fell = [item[1] for item in expected]
    assert 0 < sum(fell) < 8
    for way, found in ways.items():
        assert found.overturned.ravel().tolist() == fell, way
        stood = [(i, peak) for i, (peak, fallen) in enumerate(expected) if not fallen]
        for i, peak in stood:
            assert found.peak_rotation.reshape(8)[i] == pytest.approx(peak, rel=2e-3), (way, i)
    assert [simulate(block, motion, 0.005).overturned for motion in motions] == fell
