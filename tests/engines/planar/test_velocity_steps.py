"""Jumps of the base's velocity under bodies that slide, jam, rock on each other and fly."""

import numpy as np
import pytest

from rockfrag import Block, GroundMotion, InputError, Motion, Stack, overturns, simulate
from rockfrag.engines.contract import Case
from rockfrag.engines.planar.engine import ContactRun
from rockfrag.engines.planar.velocity_steps import JumpedRun
from rockfrag.motions import one_sine
from rockfrag.records.velocity_steps import VelocitySteps, bump_and_stop, landing
from rockfrag.simulation.closed_forms import critical_jump
from rockfrag.simulation.options import system_of
from rockfrag.system.constraints import Wall

from .cases import imbalance, random_block, random_stack

BLOCK = Block(0.02, 0.09, 1.0)
STACK = Stack(Block(0.4, 0.3, 50.0), Block(0.3, 1.2, 100.0))
JAMS = (4 * 0.01**2 + 0.045**2) / (3 * 0.01 * 0.045)
"""Friction from which a jump of the base takes the slender block with it (docs/velocity-steps.md)."""


def at(response, instant, values):
    return np.array([np.interp(instant, response.time, each) for each in values.T])


@pytest.mark.parametrize("seed", range(12))
def test_a_jump_is_the_limit_of_a_short_pulse_with_friction_and_for_two_bodies(seed):
    """A triangle of 0.4 ms by kernels that know no jumps: slides, jams, lands alike."""
    rng = np.random.default_rng(seed)
    body = random_stack(rng) if seed % 2 else random_block(rng)
    system = system_of(body, float(rng.choice([0.2, 0.6, 1.5, 3.0, 8.0])))
    jump, up = rng.uniform(-0.6, 0.6), rng.choice([0.0, rng.uniform(0, 0.3)])
    dt, pulse = 2e-4, np.zeros(151)
    pulse[1] = 1 / dt
    rests = Motion(np.zeros(151), dt)
    shaken = GroundMotion(Motion(jump * pulse, dt), z=Motion(up * pulse, dt))
    jumped = GroundMotion(rests, steps=VelocitySteps([dt], [jump], [up]))
    short = ContactRun(Case(system, shaken)).response()
    at_once = JumpedRun(Case(system, jumped)).response()
    turned = at(short, 0.03, short.theta)
    assert at(at_once, 0.03, at_once.theta) == pytest.approx(turned, rel=0.02, abs=2e-4)
    slipped = at(short, 0.03, short.slip)
    assert at(at_once, 0.03, at_once.slip) == pytest.approx(slipped, rel=0.02, abs=2e-4)
    assert imbalance(at_once) < 1e-9


def test_friction_beyond_that_which_a_jump_asks_makes_it_pure_rocking():
    steps = VelocitySteps([0.0], [0.1])
    rough = simulate(BLOCK, steps, friction=1.01 * JAMS)
    assert rough.omega[1] == pytest.approx(simulate(BLOCK, steps).omega[1], rel=1e-6)
    assert rough.paradoxes == 0


def test_with_less_friction_the_base_slips_away_and_the_block_gets_no_jump():
    slips = simulate(BLOCK, VelocitySteps([0.0], [0.1]), friction=0.99 * JAMS)
    assert slips.omega[1, 0] == 0
    # below b/h it slides to a stop
    low = 0.1
    slides = simulate(BLOCK, VelocitySteps([0.0], [0.1]), friction=low)
    assert not slides.theta.any()
    expected = -(0.1**2) / (2 * low * 9.81)
    assert slides.slip[-1, 0] == pytest.approx(expected, rel=1e-3)


def test_static_friction_decides_whether_a_jump_takes_what_stands():
    steps = VelocitySteps([0.0], [0.1])
    assert simulate(BLOCK, steps, friction=(2.0, 0.3)).omega[1, 0] < -1
    assert simulate(BLOCK, steps, friction=(1.7, 0.3)).omega[1, 0] == 0


def test_two_bodies_on_a_base_that_lands_stay_and_one_that_falls_away_leaves_them():
    assert not simulate(STACK, landing(0.05)).theta.any()
    dropped = simulate(STACK, VelocitySteps([0.0], [0.0], [-0.5]), friction=0.5)
    # both fly until they meet the base again
    lands = dropped.contact_events.query("kind == 'impact'")["time"].iloc[0]
    assert lands == pytest.approx(2 * 0.5 / 9.81, rel=1e-6)


def test_a_stack_that_cannot_part_is_as_easily_thrown_over_as_one_block():
    """A thin plate under a block is carried along; the jump that just throws the block over is hardly changed."""
    stack = Stack(Block(0.3, 0.002, 0.001), Block(0.3, 1.2, 100.0))
    steps = VelocitySteps([0.0], [critical_jump(0.3, 1.2)])
    found = overturns([stack], steps, scales=[0.98, 1.02])
    assert found.overturned.ravel().tolist() == [False, True]
    assert found.engines == ("planar contact between jumps",)


def test_jumps_of_nothing_change_nothing_with_friction():
    motion = one_sine(4.0, period=0.8)
    plain = simulate(STACK, motion, friction=0.4)
    steps = VelocitySteps([0.1, 0.3037, 0.777], [0.0, 0.0, 0.0])
    jumped = simulate(STACK, GroundMotion(motion, steps=steps), friction=0.4)
    at_samples = np.array([at(jumped, time, jumped.theta) for time in plain.time[:80]])
    assert np.abs(at_samples - plain.theta[:80]).max() < 1e-6
    assert jumped.overturned == plain.overturned


def test_outcomes_and_histories_are_one():
    steps = bump_and_stop(0.5, 0.03)
    found = overturns([STACK], steps, scales=[0.5, 1.0, 2.0], friction=0.7)
    for k, scale in enumerate((0.5, 1.0, 2.0)):
        case = GroundMotion(
            Motion(np.zeros(2), 0.005),
            steps=VelocitySteps(steps.times, scale * steps.horizontal),
        )
        response = simulate(STACK, case, friction=0.7)
        assert response.overturned == found.overturned[0, 0, k]
        assert response.slip[-1] == pytest.approx(found.slip[0, 0, k], abs=1e-9)


def test_jumps_beside_a_wall_are_refused_in_a_sentence():
    system = system_of(BLOCK, 0.5)
    held = type(system)(system.bodies, system.contacts, constraints=(Wall(1.0),))
    with pytest.raises(
        InputError, match="jumps of the velocity cannot be had together with a wall"
    ):
        simulate(held, VelocitySteps([0.0], [0.1]))
