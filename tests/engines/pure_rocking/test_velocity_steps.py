"""Jumps of the base's velocity: momentum about the pivot, closed forms, and the limit of short accelerations."""

import math

import numpy as np
import pytest

from rockfrag import Block, GroundMotion, InputError, Motion, overturns, simulate
from rockfrag.motions import one_sine
from rockfrag.records.velocity_steps import VelocitySteps, bump_and_stop, landing
from rockfrag.simulation.closed_forms import (
    critical_double_impulse,
    critical_jump,
    housner_velocity,
)

BLOCK = Block(0.02, 0.09, 1.0)


def first_impact(block: Block, steps: VelocitySteps) -> float:
    events = simulate(block, steps).contact_events
    return float(events[events["kind"] == "impact"]["time"].iloc[0])


@pytest.mark.parametrize(("width", "height"), [(0.02, 0.09), (0.3, 1.2), (0.8, 1.0)])
def test_one_jump_overturns_from_the_velocity_on_that_energy_says(width, height):
    critical = critical_jump(width, height)
    steps = VelocitySteps([0.0], [critical])
    found = overturns([Block(width, height, 1.0)], steps, scales=[0.9999, 1.0001])
    assert found.overturned.ravel().tolist() == [False, True]


def test_the_critical_jump_of_a_slender_block_is_that_of_housner():
    block = Block(0.01, 0.5, 1.0)
    assert critical_jump(0.01, 0.5) == pytest.approx(
        housner_velocity(block.alpha, block.frequency()), rel=1e-3
    )


@pytest.mark.parametrize(("width", "height"), [(0.02, 0.09), (0.3, 1.2)])
def test_the_critical_double_impulse_overturns_at_the_worst_instant_alone(
    width, height
):
    """Nabeshima et al. (2016): the second jump as the block has just come down."""
    block, critical = Block(width, height, 1.0), critical_double_impulse(width, height)

    def overturned(velocity: float, late: float) -> bool:
        when = first_impact(block, VelocitySteps([0.0], [velocity]))
        steps = VelocitySteps([0.0, when * late + 1e-9], [velocity, -velocity])
        return bool(overturns([block], steps).overturned.item())

    assert not overturned(0.999 * critical, 1.0)
    assert overturned(1.001 * critical, 1.0)
    assert not overturned(1.02 * critical, 0.7)
    assert not overturned(1.02 * critical, 1.3)


def test_the_critical_double_impulse_grows_with_the_root_of_the_size():
    ratio = critical_double_impulse(0.6, 2.4) / critical_double_impulse(0.15, 0.6)
    assert ratio == pytest.approx(2.0, rel=1e-12)


@pytest.mark.filterwarnings("ignore:the peak acceleration")
@pytest.mark.parametrize("theta", [0.0, 0.08])
def test_a_jump_is_the_limit_of_a_short_strong_acceleration(theta):
    """A triangle of 0.2 ms with the area of the jump, by the kernel that knows no jumps."""
    # away from the pivot that carries, which pushes
    dt, jump = 1e-4, -0.05
    triangle = Motion(np.array([0.0, jump / dt, 0.0, 0.0]), dt)
    short = simulate(BLOCK, triangle, theta0=theta)
    at_once = simulate(BLOCK, VelocitySteps([0.0], [jump]), theta0=theta)
    assert at_once.omega[1, 0] == pytest.approx(short.omega[2, 0], rel=0.01)


def test_jumps_of_nothing_change_nothing_wherever_they_stand():
    motion = one_sine(3.0, period=0.8)
    block = Block(0.3, 1.2, 100.0)
    plain = simulate(block, motion)
    steps = VelocitySteps([0.1, 0.3037, 0.777], [0.0, 0.0, 0.0])
    jumped = simulate(block, GroundMotion(motion, steps=steps))
    at = np.interp(plain.time, jumped.time, jumped.theta[:, 0])
    assert np.abs(at - plain.theta[:, 0]).max() < 1e-6
    assert jumped.overturned == plain.overturned


def test_a_record_and_jumps_act_together_and_scale_together():
    motion, block = one_sine(1.5, period=0.5), Block(0.3, 1.2, 100.0)
    needed = critical_jump(0.3, 1.2)
    steps = GroundMotion(motion, steps=VelocitySteps([0.11], [0.7 * needed]))
    found = overturns([block], [steps], scales=[0.5, 2.0])
    assert found.overturned.ravel().tolist() == [False, True]
    assert found.engines == ("jumps of the velocity",)


def test_a_landing_leaves_a_block_at_rest_alone_and_pushes_a_tilted_one_back():
    fallen = landing(0.05)
    assert not simulate(BLOCK, fallen).theta.any()
    theta = 0.1
    found = simulate(BLOCK, fallen, theta0=theta)
    b, h = 0.01, 0.045
    x = -b * math.cos(theta) + h * math.sin(theta)
    expected = x * math.sqrt(2 * 9.81 * 0.05) / (4 / 3 * (b**2 + h**2))
    assert found.omega[1, 0] == pytest.approx(expected, rel=1e-9)


@pytest.mark.filterwarnings("ignore::rockfrag.simulation.ensemble.LightBodies")
def test_energy_that_a_jump_brings_is_work_of_the_base():
    steps = bump_and_stop(0.2, 0.02)
    balance = simulate(BLOCK, steps).energy
    largest = balance["kinetic"].max()
    assert balance["residual"].abs().max() < 1e-6 * largest


def test_a_jump_asks_more_friction_than_any_slow_motion_of_a_slender_block():
    """Sticking needs a friction of (4 b² + h²) / 3 b h (docs/velocity-steps.md)."""
    b, h = 0.01, 0.045
    found = simulate(BLOCK, VelocitySteps([0.0], [0.01]))
    asked = (4 * b**2 + h**2) / (3 * b * h)
    assert found.friction_demand[0] == pytest.approx(asked, rel=1e-6)


def test_a_stop_before_the_block_has_come_back_needs_a_pivot_that_pulls():
    with pytest.warns(UserWarning, match="left the ground"):
        found = simulate(BLOCK, bump_and_stop(0.3, 0.005))
    assert found.lost_contact == pytest.approx(0.005 / 0.3)


def test_a_second_horizontal_component_is_refused():
    still = Motion(np.zeros(5), 0.01)
    both = GroundMotion(still, y=still, steps=VelocitySteps([0.0], [0.2]))
    with pytest.raises(InputError, match="second horizontal component"):
        simulate(Block(0.02, 0.09, 1.0, depth=0.02), both)


@pytest.mark.parametrize(
    ("given", "words"),
    [
        (([1.0, 0.5], [1, 1]), "times must rise"),
        (([0.0], [1, 1]), "differ in number"),
        (([0.0], [float("nan")]), "finite numbers"),
        (([0.0], [900.0]), "check the unit"),
    ],
)
def test_jumps_that_cannot_be_are_refused(given, words):
    with pytest.raises(InputError, match=words):
        VelocitySteps(*given)
