"""The reference integrator against closed forms, conservation, symmetry and the fast kernel."""

import itertools
import math

import numpy as np
import pytest

from rockfrag.rocking import Block, Stack, simulate

from ..oracle.closed_forms import next_amplitude, quarter_period
from ..oracle.rocking_integrator import ReferenceResponse, simulate_reference
from ..oracle.rocking_model import Model
from .reference_bodies import T2, TOWERS, P, random_motion, random_stack, uniform

STILL = np.zeros(2)


def peaks(response: ReferenceResponse) -> list[float]:
    """Largest |θ| between impacts, from the energy just after each."""
    times = [0.0, *(e.time for e in response.contact_events)]
    found = []
    for begin, end in itertools.pairwise(times):
        inside = (response.time >= begin) & (response.time <= end)
        if inside.sum() > 3:
            found.append(np.abs(response.theta[inside, 0]).max())
    return found


@pytest.mark.parametrize("upper", TOWERS)
def test_a_released_block_comes_down_after_the_exact_quarter_period(upper: Block) -> None:
    theta0 = 0.5 * upper.alpha
    response = simulate_reference(upper, STILL, 0.01, theta0=theta0, duration=0.5)
    expected = quarter_period(theta0, upper.alpha, upper.frequency())
    assert response.contact_events[0].time == pytest.approx(expected, rel=1e-10)


@pytest.mark.parametrize("block", [*TOWERS, P])
def test_an_impact_of_a_lone_block_conserves_momentum_about_the_new_pivot(block: Block) -> None:
    response = simulate_reference(block, STILL, 0.01, theta0=-0.3 * block.alpha, duration=0.5)
    first = response.contact_events[0]
    ratio = first.omega_after[0] / first.omega_before[0]
    assert ratio == pytest.approx(1 - 1.5 * math.sin(block.alpha) ** 2, rel=1e-12)


def test_linear_amplitudes_decay_as_housner_says() -> None:
    phi = 0.5
    response = simulate_reference(T2, STILL, 1e-3, theta0=phi * T2.alpha, linear=True, duration=1.5)
    for peak in peaks(response)[1:4]:
        phi = next_amplitude(phi, T2.momentum_restitution())
        assert peak / T2.alpha == pytest.approx(phi, abs=2e-5)  # sampled every 1e-3 s


def test_free_rocking_comes_to_rest() -> None:
    response = simulate_reference(T2, STILL, 0.01, theta0=0.1 * T2.alpha)
    assert response.at_rest
    assert not response.overturned
    assert response.contact_events[-1].kind == "closing"
    assert response.theta[-1, 0] == 0.0


@pytest.mark.parametrize("measured", [0.0, 0.5, 0.8, 0.95, 1.0])
def test_a_measured_restitution_is_the_ratio_of_velocities_of_the_lone_block(
    measured: float,
) -> None:
    response = simulate_reference(
        T2, STILL, 0.01, theta0=0.3 * T2.alpha, restitution=measured, duration=0.5
    )
    contact_event = response.contact_events[0]
    assert contact_event.omega_after[0] == pytest.approx(
        measured * contact_event.omega_before[0], abs=1e-12
    )


def test_a_measured_restitution_holds_for_a_crooked_block_on_either_pivot() -> None:
    crooked = Block(0.4, 1.2, 300.0, inertia=45.0, cg_offset=0.04, lean=0.01)
    for side in (1, -1):
        response = simulate_reference(
            crooked, STILL, 0.01, theta0=side * 0.05, restitution=0.8, duration=0.8
        )
        contact_event = response.contact_events[0]
        assert contact_event.omega_after[0] == pytest.approx(
            0.8 * contact_event.omega_before[0], rel=1e-12
        )


def test_rocking_starts_exactly_where_the_criterion_is_met() -> None:
    ramp = np.linspace(0.0, -4.0, 3)
    response = simulate_reference(T2, ramp, 1.0, duration=1.3)
    threshold = 9.81 * T2.b / T2.h
    assert response.contact_events[0].time == pytest.approx(threshold / 2.0, rel=1e-9)
    assert response.contact_events[0].after == (1,)


def test_similar_blocks_respond_alike() -> None:
    alpha, ratio, x = 0.25, 5.0, 5.5
    responses = []
    for p in (2.14, 4.0):
        t = np.linspace(0.0, 2 * math.pi / (ratio * p), 101)
        motion = x * alpha * 9.81 * np.sin(ratio * p * t)
        responses.append(simulate_reference(uniform(p, alpha), motion, t[1], duration=150 * t[1]))
    first, other = responses
    n = min(len(first.time), len(other.time))
    np.testing.assert_allclose(first.theta[:n], other.theta[:n], atol=1e-8)


# --------------------------------------------------------------------------- stacks


def energies(model: Model, response: ReferenceResponse) -> np.ndarray:
    return np.array(
        [
            model.kinetic_energy(tuple(s), tuple(th), tuple(w))
            + model.potential_energy(tuple(s), tuple(th))
            for s, th, w in zip(response.state, response.theta, response.omega, strict=True)
        ]
    )


def test_energy_is_conserved_between_contact_events_and_never_gained_at_one() -> None:
    rng = np.random.default_rng(31)
    for _ in range(4):
        stack = random_stack(rng)
        model = Model(stack, 9.81)
        response = simulate_reference(
            stack,
            STILL,
            0.005,
            theta0=(rng.uniform(-0.1, 0.1), rng.uniform(-0.15, 0.15)),
            duration=1.0,
        )
        total = energies(model, response)
        scale = model.g * (model.m1 + model.m2) * model.b1
        times = np.array([e.time for e in response.contact_events])
        for k in range(len(total) - 1):
            crossed = np.any((times >= response.time[k]) & (times <= response.time[k + 1]))
            change = (total[k + 1] - total[k]) / scale
            assert change <= 1e-10
            if not crossed:
                assert abs(change) < 1e-10
        for contact_event in response.contact_events:
            before, after = (
                model.kinetic_energy(state, contact_event.theta, omega)
                for state, omega in (
                    (contact_event.before, contact_event.omega_before),
                    (contact_event.after, contact_event.omega_after),
                )
            )
            assert after <= before * (1 + 1e-9) + 1e-25


def test_a_mirrored_motion_gives_the_mirrored_response() -> None:
    stack = Stack(P, T2)
    motion = random_motion(np.random.default_rng(5), 200)
    first = simulate_reference(stack, motion, 0.01, duration=2.0)
    other = simulate_reference(stack, -motion, 0.01, duration=2.0)
    np.testing.assert_array_equal(first.state, -other.state)
    np.testing.assert_allclose(first.theta, -other.theta, atol=1e-12)


def test_on_a_pedestal_that_cannot_move_the_statue_rocks_alone() -> None:
    heavy = Block(4.0, 0.5, 1e9)
    motion = random_motion(np.random.default_rng(6), 200)
    motion *= 0.4 * 9.81 / np.abs(motion).max()
    stack = simulate_reference(Stack(heavy, T2), motion, 0.01, duration=2.5)
    lone = simulate_reference(T2, motion, 0.01, duration=2.5)
    assert len(lone.contact_events) > 3
    np.testing.assert_allclose(stack.theta[:, 1], lone.theta[:, 0], atol=1e-9)
    assert np.all(stack.theta[:, 0] == 0)


def test_in_rocking_mode_three_the_stack_rocks_as_one_body() -> None:
    stack = Stack(Block(0.2, 0.6, 10.0), Block(0.19, 0.1, 2.0))
    glued = stack.rigidly_joined()
    theta0 = 0.2 * glued.alpha
    both = simulate_reference(stack, STILL, 0.005, theta0=(theta0, theta0), duration=0.8)
    item = simulate_reference(glued, STILL, 0.005, theta0=theta0, duration=0.8)
    first = item.contact_events[0]
    assert both.contact_events[0].time == pytest.approx(first.time, rel=1e-10)
    until = item.time < first.time
    np.testing.assert_allclose(both.theta[until][:, 1], item.theta[until][:, 0], atol=1e-11)
    assert both.theta[until][:, 0] == pytest.approx(both.theta[until][:, 1], abs=0.0)


@pytest.mark.parametrize("seed", range(3))
def test_the_fast_kernel_agrees_with_the_reference(seed: int) -> None:
    rng = np.random.default_rng([77, seed])
    stack, motion = random_stack(rng), random_motion(rng)
    restitution = (None, (0.8, 0.9), (None, 0.95))[seed]
    slow = simulate_reference(stack, motion, 0.01, restitution=restitution, duration=3.0)
    fast = simulate(stack, motion, 0.01, restitution=restitution)
    n = len(slow.time)
    assert np.abs(slow.theta - fast.theta[:n]).max() < 1e-6


@pytest.mark.slow
@pytest.mark.parametrize("linear", [False, True])
def test_two_hundred_random_stacks_end_alike_in_both_integrators(linear: bool) -> None:
    rng = np.random.default_rng(78)
    fragile = 0
    for _ in range(200 if not linear else 40):
        stack, motion = random_stack(rng), random_motion(rng, 400)
        slow = simulate_reference(stack, motion, 0.01, linear=linear)
        fast = simulate(stack, motion, 0.01, linear=linear)
        if slow.overturned != fast.overturned:
            assert fast.unstable_distance < 1e-3
            fragile += 1
    assert fragile <= 2


@pytest.mark.slow
def test_sixty_random_blocks_end_alike_and_follow_the_same_path() -> None:
    rng = np.random.default_rng(79)
    for _ in range(60):
        block, motion = uniform(rng.uniform(2, 6), rng.uniform(0.1, 0.4)), random_motion(rng, 400)
        slow, fast = simulate_reference(block, motion, 0.01), simulate(block, motion, 0.01)
        assert slow.overturned == fast.overturned
        n = min(len(slow.time), len(fast.time))
        assert np.abs(slow.theta[:n] - fast.theta[:n]).max() < 1e-6


def test_the_outcome_does_not_depend_on_the_chatter_threshold() -> None:
    rng = np.random.default_rng(80)
    stack, motion = random_stack(rng), random_motion(rng, 200)
    responses = [
        simulate_reference(stack, motion, 0.01, duration=2.0, chatter=c) for c in (1e-4, 1e-7)
    ]
    n = min(len(r.time) for r in responses)
    assert responses[0].overturned == responses[1].overturned
    assert np.abs(responses[0].theta[:n] - responses[1].theta[:n]).max() < 1e-3
