"""What friction and flight must and must not do, whatever the body and the motion."""

import math

import numpy as np
from hypothesis import example, given, settings
from hypothesis import strategies as st

from rockfrag import Block, Stack, overturns, read_motion

from ..rocking.reference_bodies import T1, P, random_motion
from .cases import (
    DT,
    as_friction,
    imbalance,
    random_block,
    random_frictions,
    random_stack,
    samples_until,
    simulate_with_friction,
)

seeds = st.integers(0, 10**6)


def random_case(seed: int) -> tuple[Block | Stack, np.ndarray, np.ndarray, object]:
    """Body, both motions, friction."""
    rng = np.random.default_rng(seed)
    body = random_block(rng) if rng.uniform() < 0.5 else random_stack(rng)
    motion, up = random_motion(rng), 0.5 * random_motion(rng)
    return body, motion, up, as_friction(random_frictions(rng, body))


@settings(max_examples=60)
@given(seeds)
# two contacts close within a tenth of a microsecond, soon after one has opened
@example(2037)
# sticks at the end of a step that leaves some slip speed
@example(7783)
# a corner that slides the whole face along falls off its far edge
@example(1358)
def test_energy_is_balanced_forces_push_and_friction_keeps_its_limit(seed: int) -> None:
    """Energy is what the ground gave less what impacts and friction took."""
    body, motion, up, friction = random_case(seed)
    response = simulate_with_friction(body, motion, DT, friction=friction, vertical=up)
    # the largest of 10 000 cases leaves 1.5e-8, the next one 9.6e-9
    assert imbalance(response) < 2e-8
    unit = 9.81 * body.mass * float(response.position[0, :, 1].max())
    assert np.diff(response.energy["lost_friction"]).min() > -1e-9 * unit
    hits = response.contact_events[response.contact_events["kind"] == "impact"]
    assert ((hits["energy_before"] - hits["energy_after"]) > -1e-9 * unit).all()
    limits = np.atleast_1d(friction)
    weight = 9.81 * body.mass
    assert response.normal_force.min() >= -1e-8 * weight
    assert (np.abs(response.friction_force) <= limits * response.normal_force + 1e-8 * weight).all()


@settings(max_examples=15)
@given(seeds)
def test_a_later_motion_is_followed_later(seed: int) -> None:
    body, motion, up, friction = random_case(seed)
    wait = np.zeros(37)
    first = simulate_with_friction(body, motion, DT, friction=friction, vertical=up)
    other = simulate_with_friction(
        body, np.append(wait, motion), DT, friction=friction, vertical=np.append(wait, up)
    )
    n = samples_until(first, 7)
    np.testing.assert_allclose(first.theta[:n], other.theta[37 : n + 37], atol=1e-9)


@settings(max_examples=40)
@given(seeds, st.booleans())
def test_on_a_ground_below_b_over_h_nothing_rocks(seed: int, stacked: bool) -> None:
    """What slides below carries less than what it carries needs to turn, alone and joined to its pedestal."""
    rng = np.random.default_rng(seed)
    body = Block(0.3, rng.uniform(0.2, 1.5), 10.0)
    slope = body.b / body.h
    if stacked:
        body = Stack(
            Block(0.5, rng.uniform(0.2, 0.8), 80.0), Block(0.3, rng.uniform(0.2, 1.0), 20.0)
        )
        slope = math.tan(min(body.upper.alpha, body.rigidly_joined().critical_angle(1)))
    ground = rng.uniform(0.1, 0.999) * slope
    mus = (ground, ground * rng.uniform(1.0, 2.0)) if stacked else ground
    response = simulate_with_friction(body, 30 * rng.standard_normal(200), DT, friction=mus)
    assert np.abs(response.slip).max() > 0
    assert (response.theta == 0).all()
    assert not response.overturned


def test_without_friction_nothing_rocks_and_nothing_falls() -> None:
    rng = np.random.default_rng(3)
    for _ in range(10):
        stack = Stack(Block(0.5, 0.4, 80.0), Block(0.2, 0.8, 9.0))
        motion = random_motion(rng)
        response = simulate_with_friction(stack, motion, DT, friction=(0.0, 0.0))
        assert np.abs(response.theta).max() < 1e-12
        assert not response.overturned
        # in a frame at rest nothing moves: neither on the other
        assert np.ptp(response.slip[:, 1]) < 1e-12
        assert np.ptp(response.slip[:, 0]) > 1e-3


def test_the_slenderest_motion_of_the_thesis_cannot_rock_t1_at_a_friction_of_three_tenths(shared):
    """Slenderness 3 needs µ > 1/3 to rise, at any amplitude."""
    records = sorted(shared.glob("records/*.dat"))  # type: ignore[attr-defined]
    assert len(records) == 4
    motions = [read_motion(path) for path in records]
    result = overturns(T1, motions, scales=np.linspace(0.5, 4.0, 8), friction=[0.3])
    assert result.peak_slip.max() > 0.01
    assert result.peak_rotation.max() == 0
    assert not result.overturned.any()


def test_outcomes_do_not_depend_on_the_number_of_threads() -> None:
    rng = np.random.default_rng(4)
    bodies = [random_block(rng), random_stack(rng), Stack(P, T1)]
    motions = [random_motion(rng) for _ in range(3)]
    kwargs = {"friction": [0.4, (0.4, 0.6), (0.5, 0.5)], "vertical": motions[::-1]}
    first, two = (
        overturns(bodies, motions, DT, [0.7, 1.0, 1.4], threads=threads, **kwargs)
        for threads in (1, 2)
    )
    np.testing.assert_array_equal(first.overturning_time, two.overturning_time)
    np.testing.assert_array_equal(first.slip, two.slip)
    assert first.overturned.any() and not first.overturned.all()


def test_outcomes_of_an_ensemble_are_those_of_the_histories() -> None:
    rng = np.random.default_rng(8)
    bodies = [random_block(rng) for _ in range(4)] + [random_stack(rng) for _ in range(4)]
    motions = [random_motion(rng) for _ in range(3)]
    frictions = [as_friction(random_frictions(rng, body)) for body in bodies]
    result = overturns(bodies, motions, DT, [1.0], friction=frictions)
    for i, body in enumerate(bodies):
        for j, motion in enumerate(motions):
            response = simulate_with_friction(body, motion, DT, friction=frictions[i])
            assert response.overturned == result.overturned[i, j, 0]
