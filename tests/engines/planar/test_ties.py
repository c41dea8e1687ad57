"""Ties: closed forms of their force, their frequency and their energy, and ties that are never taut."""

import math

import numpy as np
import pytest
from scipy.optimize import brentq

from rockfrag import Block, Stack
from rockfrag.system import Tie, as_system, hold

from ...simulation.reference_bodies import random_motion
from .cases import DT, G, run

B, H, M = 0.15, 0.6, 100.0  # half width, half height [m], mass [kg]
BLOCK = Block(2 * B, 2 * H, M)
TOP = 2 * H
INERTIA = BLOCK.pivot_inertia()
FAR = 500.0  # distance of an anchor at which a cord stays level [m]


def cord(side: int, stiffness: float, **more) -> Tie:
    """Level cord from the middle of the block's top to a far anchor on its left (-1) or right."""
    return Tie((0.0, 0.0, TOP), (side * FAR, 0.0, TOP), stiffness, **more)


def turning(omega: float, ties, samples=200, dt=0.001, **more):
    """Response of a block that starts to turn at a rate over its right edge, tied."""
    held = hold(as_system(BLOCK), *ties)
    return run(held, np.zeros(samples), dt, friction=math.inf, omega0=omega, **more)


@pytest.mark.parametrize("body", [BLOCK, Stack(Block(0.6, 0.3, 200.0), BLOCK)])
@pytest.mark.parametrize("slack", [math.inf, 20.0])
def test_ties_that_stay_slack_leave_every_bit(body, slack: float) -> None:
    motion = 2 * random_motion(np.random.default_rng(3))
    point = (0.0, 0.0, body.blocks[-1].height)
    ties = [Tie(point, (side, 0.0, 1.0), 1e5, slack=slack) for side in (-1.0, 1.0)]
    free = run(body, motion, friction=0.6)
    tied = run(hold(as_system(body), *ties), motion, friction=0.6)
    assert len(free.contact_events) > 10
    assert np.array_equal(free.theta, tied.theta)
    assert tied.constraints["hits"].tolist() == [0, 0]


@pytest.mark.parametrize("omega", [0.02, 0.1])
@pytest.mark.parametrize("acceleration", [0.0, -1.0])
def test_the_largest_force_of_a_cord_follows_from_the_rate_at_which_it_gets_taut(
    omega: float, acceleration: float
) -> None:
    """F_max = F_s + √(F_s² + k I_O ω²), F_s = m (a h - g b)/z, a as it pushes away from the anchor."""
    stiffness = 1e7
    held = hold(as_system(BLOCK), cord(-1, stiffness))
    motion = np.full(150, acceleration)
    found = run(held, motion, 0.0001, friction=math.inf, omega0=omega)
    static = M * (-acceleration * H - G * B) / TOP
    expected = static + math.sqrt(static**2 + stiffness * INERTIA * omega**2)
    assert found.constraints["largest_force_n"][0] == pytest.approx(expected, rel=2e-3)


def test_a_dashpot_bears_most_as_the_cord_gets_taut() -> None:
    """By the work up to there under a constant acceleration: ω² = 2 ∫ M dθ/I_O, and F = c times the rate."""
    b, h, top, slack, damping, pushed = 0.2, 0.6, 1.2, 0.01, 5000.0, 4.5
    block = Block(2 * b, 2 * h, 100.0)

    def longer(theta):
        return top * math.sin(theta) + b * (1 - math.cos(theta))

    taut = brentq(lambda theta: longer(theta) - slack, 0.0, 0.1, xtol=1e-14)
    rise = b * math.sin(taut) - h * (1 - math.cos(taut))
    across = h * math.sin(taut) + b * (1 - math.cos(taut))
    work = block.mass * (pushed * across - G * rise)
    omega = math.sqrt(2 * work / block.pivot_inertia())
    rate = omega * (top * math.cos(taut) + b * math.sin(taut))
    cord = Tie((0, 0, top), (-5000.0, 0, top), 4e4, slack=slack, damping=damping)
    found = run(hold(as_system(block), cord), np.full(60, -pushed), friction=math.inf)
    told = found.constraints["largest_force_n"].iloc[0]
    assert told == pytest.approx(damping * rate, rel=1e-5)


def test_a_tied_block_rocks_at_the_frequency_of_its_cord_less_its_own() -> None:
    """θ'' = -(k z² - m g h)/I_O θ - m g b/I_O about its foot: frequency² = k z²/I_O - p²."""
    stiffness, omega = 2e5, 0.05
    found = turning(omega, [cord(-1, stiffness)])
    frequency = math.sqrt((stiffness * TOP**2 - M * G * H) / INERTIA)
    middle = -M * G * B / INERTIA / frequency**2
    events = found.contact_events
    until = events["time"][events["kind"] == "impact"].iloc[0]
    time = found.time[found.time < until]
    expected = middle * (1 - np.cos(frequency * time))
    expected += omega / frequency * np.sin(frequency * time)
    assert time.size > 20
    assert found.theta[: time.size, 0] == pytest.approx(
        expected, abs=2e-3 * np.abs(expected).max()
    )


def test_cords_store_half_of_stiffness_times_stretch_squared() -> None:
    stiffness, dt = 5e4, 0.005
    motion = 3 * random_motion(np.random.default_rng(2))[:300]
    ties = [
        Tie((0.0, 0.0, TOP), (side * 0.8, 0.0, TOP), stiffness, slack=0.01)
        for side in (-1, 1)
    ]
    found = run(hold(as_system(BLOCK), *ties), motion, dt, friction=0.6)
    theta, centre = found.theta[:, 0], found.position[:, 0]
    top = centre + H * np.stack([np.sin(theta), np.cos(theta)], axis=1)
    stored = 0.0
    for side in (-1, 1):
        length = np.hypot(*(top - (side * 0.8, TOP)).T)
        stored += stiffness / 2 * np.maximum(0.0, length - 0.81) ** 2
    assert found.constraints["hits"].min() > 1
    assert stored.max() > 1.0
    assert found.energy["held"].to_numpy() == pytest.approx(
        stored, abs=1e-5 * stored.max()
    )
    assert found.energy["residual"].abs().max() < 1e-7 * M * G * H


def test_a_dashpot_and_a_break_only_take_energy() -> None:
    motion = 3 * random_motion(np.random.default_rng(2))[:300]
    ties = [
        Tie((0.0, 0.0, TOP), (-0.8, 0.0, TOP), 5e4, damping=300.0, slack=0.005),
        Tie((0.0, 0.0, TOP), (0.8, 0.0, TOP), 5e4, strength=200.0),
    ]
    found = run(hold(as_system(BLOCK), *ties), motion, friction=0.6)
    table = found.constraints
    assert table["largest_force_n"][1] == pytest.approx(200.0, rel=1e-6)
    broken = found.contact_events[found.contact_events["kind"] == "break"]
    assert broken["time"].tolist() == [table["breaking_time_s"][1]]
    assert math.isnan(table["breaking_time_s"][0])
    assert found.energy["held"].iloc[-1] > 0.0
    assert found.energy["residual"].abs().max() < 1e-7 * M * G * H


def test_stiff_ties_without_slack_hold_as_if_fixed() -> None:
    """Two cords that pull from both sides, k → ∞: the rotation goes with 1/k."""
    motion = 2.5 * random_motion(np.random.default_rng(4))[:300]
    largest = []
    for stiffness in (1e6, 1e7):
        ties = [cord(side, stiffness) for side in (-1, 1)]
        found = run(hold(as_system(BLOCK), *ties), motion, friction=math.inf)
        largest.append(np.abs(found.theta).max())
    assert run(BLOCK, motion, friction=math.inf).overturned
    assert largest[1] == pytest.approx(0.1 * largest[0], rel=0.4)
    assert largest[1] < 1e-3


def test_a_bracket_holds_both_ways_beyond_its_slack() -> None:
    motion = 6.0 * np.sin(2 * np.pi * np.arange(0, 2, DT))
    bracket = Tie((0.0, 0.0, TOP), (0.5, 0.0, TOP), 1e6, slack=0.01, bracket=True)
    found = run(hold(as_system(BLOCK), bracket), motion, friction=0.8)
    top = found.position[:, 0, 0] + H * np.sin(found.theta[:, 0])
    assert run(BLOCK, motion, friction=0.8).overturned
    assert not found.overturned
    assert 0.009 < top.max() < 0.014
    assert -0.014 < top.min() < -0.009


def test_the_mirror_image_of_a_tied_block_moves_as_its_mirror_image() -> None:
    motion = 2 * random_motion(np.random.default_rng(5))
    right, left = (
        run(
            hold(
                as_system(BLOCK),
                Tie((0.0, 0.0, 1.0), (side, 0.0, 1.4), 1e5, 50.0, 0.002),
            ),
            side * motion,
            DT,
            friction=0.5,
        )
        for side in (1, -1)
    )
    assert right.constraints["hits"][0] > 2
    assert right.theta == pytest.approx(-left.theta, abs=1e-9)
