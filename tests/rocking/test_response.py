"""A response obeys mechanics: momentum at impacts, energy between, forces from accelerations."""

import math

import numpy as np
import pytest

from rockfrag import Block, Response, Stack, simulate
from rockfrag.rocking.restitution import quarter_period

from .reference_bodies import T1, T2, T3, P

G = 9.81
OFF_CENTRE = Stack(
    Block(0.30, 0.25, 20.0, cg_offset=0.01, lean=0.004),
    Block(0.20, 0.80, 15.0, inertia=1.1, cg_height=0.34, cg_offset=-0.012),
    offset=0.02,
)
DT = 0.005


def shaking(seed: int, peak_g: float, seconds: float = 6.0) -> np.ndarray:
    """Sum of sines under an envelope, scaled to a peak [m/s²]."""
    rng = np.random.default_rng(seed)
    t = np.arange(int(seconds / DT)) * DT
    waves = sum(
        rng.normal() * np.sin(2 * np.pi * f * t + rng.uniform(0, 2 * np.pi))
        for f in rng.uniform(0.5, 5, 8)
    )
    shape = waves * np.sin(np.pi * t / t[-1])
    return peak_g * G * shape / np.abs(shape).max()


BODIES = [T2, Stack(P, T1), Stack(P, T3), OFF_CENTRE]
CASES = [
    pytest.param((body, seed, peak), id=f"{name}-{seed}")
    for name, body in zip(("T2", "P&T1", "P&T3", "off-centre"), BODIES, strict=True)
    for seed, peak in ((1, 0.35), (2, 0.6))
]


@pytest.fixture(params=CASES)
def response(request: pytest.FixtureRequest) -> Response:
    body, seed, peak = request.param
    found = simulate(body, shaking(seed, peak), DT)
    assert found.impacts > 3
    return found


def test_positions_agree_with_the_contact_states(response: Response) -> None:
    theta, state = response.theta, response.state
    relative = np.diff(theta, axis=1, prepend=0.0)
    standing = np.abs(theta).max(axis=1) < 1.0
    assert (relative * state >= -1e-9)[standing].all()
    assert (np.abs(relative[state == 0]) < 1e-9).all()


@pytest.mark.parametrize(
    ("block", "fractions"),
    [
        (T1, (0.45260, 0.85993, 1.95447)),
        (T2, (0.51681, 0.98192, 2.23173)),
        (T3, (0.57472, 1.09196, 2.48184)),
    ],
    ids=["T1", "T2", "T3"],
)
def test_linear_period_is_housner_s(block: Block, fractions: tuple[float, ...]) -> None:
    for start, period in zip((0.2, 0.5, 0.9), fractions, strict=True):
        response = simulate(block, np.zeros(400), DT, theta0=start * block.alpha, linear=True)
        first = response.contact_events.query("kind == 'impact'")["time"].iloc[0]
        assert 4 * first == pytest.approx(period, abs=1e-5)


@pytest.mark.parametrize(
    ("block", "quarter"), [(T1, 0.215637), (T2, 0.245912), (T3, 0.273302)], ids=["T1", "T2", "T3"]
)
def test_nonlinear_quarter_period(block: Block, quarter: float) -> None:
    response = simulate(block, np.zeros(400), DT, theta0=0.5 * block.alpha)
    first = response.contact_events.query("kind == 'impact'")["time"].iloc[0]
    assert first == pytest.approx(quarter, abs=1e-6)
    assert first == pytest.approx(quarter_period(block, 0.5 * block.alpha), rel=1e-9)


def test_forces_of_a_resting_stack_are_its_weights() -> None:
    stack = Stack(P, T2)
    a = np.full(50, 1.5)
    response = simulate(stack, a, DT)
    masses = np.tile([stack.mass, T2.mass], (50, 1))
    assert response.normal_force[:50] == pytest.approx(masses * G, rel=1e-12)
    assert response.friction_force[:50] == pytest.approx(masses * 1.5, rel=1e-12)
    assert response.friction_demand == pytest.approx([1.5 / G] * 2, rel=1e-12)


def test_friction_at_the_threshold_is_b_over_h() -> None:
    # just below rocking the friction that a rigid block needs is a/g = b/h
    a = 0.9999 * T2.b / T2.h * G
    response = simulate(T2, np.full(20, a), DT)
    assert response.friction_demand[0] == pytest.approx(0.9999 * T2.b / T2.h, rel=1e-9)
    assert response.least_normal_force[0] == pytest.approx(T2.mass * G, rel=1e-12)


def test_forces_of_a_rocking_block_follow_from_newton() -> None:
    response = simulate(T2, shaking(3, 0.3), DT)
    rows = np.flatnonzero((response.state[:, 0] != 0) & (np.abs(response.theta[:, 0]) < 0.2))
    pivot = response.state[rows, 0]
    theta, omega, alpha = (x[rows, 0] for x in (response.theta, response.omega, response.alpha))
    radius, angle = T2.radius(), T2.alpha - np.abs(theta)
    # rising of the centre of gravity, y = R cos(θc - |θ|) (thesis eq. 2.2 and below)
    rise = radius * (np.sin(angle) * pivot * alpha - np.cos(angle) * omega**2)
    assert response.normal_force[rows, 0] == pytest.approx(T2.mass * (G + rise), rel=1e-9)


@pytest.mark.filterwarnings("ignore::rockfrag.rocking.ensemble.LightBodies")
def test_a_heavy_blow_is_reported_as_a_jump() -> None:
    # thrown off the ground: a rotation this fast needs a pull at the pivot
    response = simulate(T2, np.zeros(10), 0.001, theta0=0.0, omega0=12.0)
    assert response.least_normal_force[0] < 0
    assert math.isinf(response.friction_demand[0])


def test_overturning_has_a_time_and_a_body() -> None:
    stack = Stack(P, T3)
    response = simulate(stack, shaking(2, 0.6), DT)
    assert response.overturned and response.overturned_body == "upper body"
    assert 0 < response.overturning_time <= response.time[-1]
    calm = simulate(stack, shaking(2, 0.15), DT)
    assert not calm.overturned and calm.overturned_body == "" and math.isnan(calm.overturning_time)
    assert calm.contact_events.empty


def test_a_pedestal_that_is_tall_and_thin_falls_with_its_statue() -> None:
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
    assert not near.overturned and near.unstable_distance < 1e-3
    assert far.unstable_distance > 0.1


def test_rocking_modes_have_the_thesis_s_names() -> None:
    response = simulate(Stack(P, T2), np.zeros(5), DT, theta0=(0.0, 0.05))
    assert response.rocking_mode[0] == "4a"
    assert simulate(T2, np.zeros(5), DT, theta0=-0.05).rocking_mode[0] == "4b"
