"""A response obeys mechanics: momentum at impacts, energy between, forces from accelerations.

Was the model allowed? What a response asked of friction, and whether its contacts pushed, says so.
"""

import math

import numpy as np
import pytest

from rockfrag import Block, Response, Stack, overturns, simulate
from rockfrag.simulation.ensemble import LightBodies
from rockfrag.simulation.restitution import quarter_period
from rockfrag.system import geometry

from ..conftest import shaking
from .reference_bodies import T2, T3, P, polyline

G = 9.81
DT = 0.005


def shaken(body: Block | Stack, seed: int, peak_g: float) -> Response:
    motion = shaking(seed, 0.5, 5, peak_g)
    return simulate(body, motion.acceleration, motion.dt)


def test_linear_periods_are_housner_s_and_the_quarter_period_that_of_the_integral() -> (
    None
):
    def first_impact(start: float, linear: bool) -> float:
        found = simulate(T2, np.zeros(400), DT, theta0=start * T2.alpha, linear=linear)
        return found.contact_events.query("kind == 'impact'")["time"].iloc[0]

    for start, period in ((0.2, 0.51681), (0.5, 0.98192), (0.9, 2.23173)):
        assert 4 * first_impact(start, True) == pytest.approx(period, abs=1e-5)
    quarter = first_impact(0.5, False)
    assert quarter == pytest.approx(0.245912, abs=1e-6)
    assert quarter == pytest.approx(quarter_period(T2, 0.5 * T2.alpha), rel=1e-9)


def test_forces_of_a_resting_stack_are_its_weights() -> None:
    stack = Stack(P, T2)
    a = np.full(50, 1.5)
    response = simulate(stack, a, DT)
    masses = np.tile([stack.mass, T2.mass], (50, 1))
    assert response.normal_force[:50] == pytest.approx(masses * G, rel=1e-12)
    assert response.friction_force[:50] == pytest.approx(masses * 1.5, rel=1e-12)
    assert response.friction_demand == pytest.approx([1.5 / G] * 2, rel=1e-12)


def test_forces_of_a_rocking_block_follow_from_newton() -> None:
    response = shaken(T2, 3, 0.3)
    rows = np.flatnonzero(
        (response.state[:, 0] != 0) & (np.abs(response.theta[:, 0]) < 0.2)
    )
    pivot = response.state[rows, 0]
    theta, omega, alpha = (
        x[rows, 0] for x in (response.theta, response.omega, response.alpha)
    )
    radius, angle = T2.radius(), T2.alpha - np.abs(theta)
    # rising of the centre of gravity, y = R cos(θc - |θ|) (thesis eq. 2.2 and below)
    rise = radius * (np.sin(angle) * pivot * alpha - np.cos(angle) * omega**2)
    assert response.normal_force[rows, 0] == pytest.approx(
        T2.mass * (G + rise), rel=1e-9
    )


def test_overturning_has_a_time_and_a_body() -> None:
    stack = Stack(P, T3)
    response = shaken(stack, 2, 0.6)
    assert response.overturned and response.overturned_body == "upper body"
    assert 0 < response.overturning_time <= response.time[-1]
    calm = shaken(stack, 2, 0.15)
    assert (
        not calm.overturned
        and calm.overturned_body == ""
        and math.isnan(calm.overturning_time)
    )
    assert calm.contact_events.empty
    # a pedestal that is tall and thin falls with its statue
    column = Stack(Block(0.3, 1.5, 50.0), Block(0.3, 0.3, 10.0))
    response = simulate(column, np.r_[np.full(80, 4.0), np.zeros(50)], 0.01)
    assert response.overturned and response.overturned_body == "lower body"


def test_unstable_distance_tells_how_near_the_outcome_was() -> None:
    pulse = np.sin(np.linspace(0, np.pi, 101))
    dt = math.pi / (3 * T2.frequency()) / 100
    low, high = 1.5, 4.0
    for _ in range(30):
        middle = (low + high) / 2
        fell = simulate(T2, middle * T2.alpha * G * pulse, dt).overturned
        low, high = (low, middle) if fell else (middle, high)
    near = simulate(T2, low * T2.alpha * G * pulse, dt)
    far = simulate(T2, 0.7 * low * T2.alpha * G * pulse, dt)
    assert (
        not near.overturned
        and near.unstable_distance < 1e-3 < 0.1 < far.unstable_distance
    )


SHAKING = polyline(0, 3000)


@pytest.mark.parametrize("body", [T2, Stack(P, T2)])
@pytest.mark.parametrize("peak", [2.0, 3.0])
def test_what_is_asked_does_not_hang_on_the_samples(body, peak):
    coarse = simulate(body, peak * SHAKING, 0.01)
    # the same straight lines, looked at twenty times as often
    fine_motion = np.interp(
        np.arange(60_000) * 0.0005, np.arange(3000) * 0.01, peak * SHAKING
    )
    fine = simulate(body, fine_motion, 0.0005)
    assert coarse.impacts > 0 and coarse.overturned
    assert coarse.friction_demand == pytest.approx(fine.friction_demand, rel=2e-3)
    assert coarse.least_normal_force == pytest.approx(fine.least_normal_force, rel=2e-3)


def test_a_fall_itself_asks_nothing():
    response = simulate(T2, np.zeros(300), 0.01, theta0=1.02 * T2.alpha, omega0=0.05)
    standing = simulate(T2, np.zeros(50), 0.01, theta0=0.3 * T2.alpha)
    assert response.overturned and response.friction_force.size > 20
    lying = np.abs(response.friction_force[-1, 0]) / abs(response.normal_force[-1, 0])
    assert response.friction_demand[0] < 0.3 < lying
    assert math.isnan(response.lost_contact)
    assert 0.1 < standing.friction_demand[0] < 0.4


def test_a_block_that_comes_back_from_beyond_its_balance_had_not_fallen():
    # beyond balance at first, and pushed back: what was asked there counts
    back = simulate(T2, np.full(12, 6.0), 0.01, theta0=1.05 * T2.alpha)
    beyond = back.theta[:12, 0] > T2.alpha
    assert beyond[0] and not beyond[-1]
    asked = np.abs(back.friction_force[:12, 0]) / back.normal_force[:12, 0]
    assert back.friction_demand[0] >= asked[beyond].max() > 0.15


@pytest.mark.parametrize("block", [T2, Block(0.3, 0.5, 40.0)])
def test_an_impact_asks_what_housner_s_impulse_does(block):
    response = simulate(block, np.zeros(100), 0.01, theta0=0.02 * block.alpha)
    e = block.momentum_restitution()
    impulse = (1 - e) / (1 + e) * block.h / block.b
    # forces of so small a rotation ask less
    assert response.friction_demand[0] == pytest.approx(impulse, rel=1e-9)
    assert impulse > (np.abs(response.friction_force) / response.normal_force).max()


def test_friction_of_the_interface_is_along_the_face_that_carries():
    leaning = Stack(Block(0.6, 1.2, 50.0), Block(0.5, 0.3, 10.0))
    response = simulate(leaning, np.zeros(10), 0.001, theta0=(0.2, 0.2))
    asked = abs(response.friction_force[0, 1] / response.normal_force[0, 1])
    assert asked == pytest.approx(0.480, abs=1e-3)
    sloping = Stack(Block(0.6, 0.6, 50.0, lean=np.radians(2)), Block(0.3, 0.3, 10.0))
    at_rest = simulate(sloping, np.zeros(10), 0.01)
    assert at_rest.friction_demand[1] == pytest.approx(
        math.tan(np.radians(2)), rel=1e-9
    )
    assert at_rest.friction_demand[0] == pytest.approx(0, abs=1e-12)


def test_losing_contact_is_an_contact_event():
    # the ground falls away faster than the block
    up = np.interp(np.arange(100) * 0.01, [0.0, 0.2, 0.4, 0.6], [0.0, -2 * G, 0.0, 0.0])
    with pytest.warns(LightBodies, match="at 0.100 s the body would have left"):
        response = simulate(T2, np.zeros(100), 0.01, vertical=up)
    assert response.lost_contact == pytest.approx(0.1, abs=1e-9)
    lifted = response.contact_events.query("kind == 'lift-off'")
    assert lifted["time"].tolist() == [response.lost_contact]
    assert (
        math.isinf(response.friction_demand[0]) and response.least_normal_force[0] < 0
    )
    found = overturns(T2, np.zeros(100), 0.01, vertical=[up], forces=True)
    assert found.lost_contact.item() == pytest.approx(0.1, abs=1e-9)
    kept = simulate(T2, np.zeros(100), 0.01, vertical=0.45 * up)
    assert math.isnan(kept.lost_contact) and kept.least_normal_force[0] > 0


def test_an_ensemble_asks_what_its_histories_do():
    motion, bodies = 2.0 * SHAKING, [T2, Stack(P, T2)]
    found = overturns(bodies, motion, 0.01, [0.5, 1.0, 1.4], forces=True)
    for i, body in enumerate(bodies):
        for k, scale in enumerate(found.scales[0]):
            item = simulate(body, scale * motion, 0.01)
            n = item.friction_demand.size
            for name in ("friction_demand", "least_normal_force"):
                expected = pytest.approx(getattr(item, name), rel=1e-12)
                assert getattr(found, name)[i, 0, k, :n] == expected
    assert np.isnan(found.friction_demand[0, ..., 1]).all()
    contacts = found.table("contacts")
    assert contacts["friction_demand"].notna().all()
    assert overturns(T2, motion, 0.01).table("contacts")["friction_demand"].isna().all()


def test_a_statue_that_reaches_beyond_its_pedestal_is_drawn_over_the_angle_of_their_contact():
    wide = Stack(Block(0.5, 0.2, 300.0), Block(0.6, 1.2, 180.0))
    angle = geometry.critical_angle(wide.pile.upper, 1)
    response = simulate(wide, np.zeros(9), DT, theta0=(0.0, 0.05))
    assert response.rocking_mode[0] == "4a"
    assert response.plot().axes[1].lines[1].get_ydata()[0] == pytest.approx(
        0.05 / angle
    )
