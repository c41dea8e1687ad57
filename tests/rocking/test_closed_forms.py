"""Closed forms against independently computed figures, and simulated blocks against closed forms."""

import math

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq

from rockfrag import Block, Stack, simulate
from rockfrag.rocking import closed_forms as cf

from .reference_bodies import T1, T2, T3, P, random_motion, uniform

G = 9.81
BLOCK = uniform(2.14, 0.25)


# formulas that only tests use; but for the last, of the slender linearised equation (Housner, 1963),
# θ'' = p² (θ - s θc) - p² a/g


def housner_half_sine(omega: float, p: float) -> float:
    """Housner's (1963) amplitude x for half a sine, √(1 + ω²/p²) [-].

    He let the block start with the pulse; it starts at ω t0 = asin(1/x), and ``half_sine_pulse`` is right and
    lower.
    """
    return math.hypot(1, omega / p)


def half_sine_pulse(omega: float, p: float) -> float:
    """Least amplitude x of half a sine that overturns [-] (Shi et al. 1996).

    x p ∫ exp(-p (t - t0)) sin ωt dt = 1 from ω t0 = asin(1/x) to ω t = π.
    """

    def excess(x: float) -> float:
        start = math.asin(1 / x) / omega
        pulled = quad(
            lambda t: math.exp(-p * (t - start)) * math.sin(omega * t), start, math.pi / omega
        )
        return x * p * pulled[0] - 1

    return float(brentq(excess, 1.0, housner_half_sine(omega, p)))


def rectangular_pulse(duration: float, p: float) -> float:
    """Least amplitude x of a rectangular pulse that overturns [-]; p T = ln(x / (x - 1))."""
    return -1 / math.expm1(-p * duration)


def one_cosine_pulse(omega: float, p: float) -> float:
    """Least amplitude x of one full cosine that overturns without an impact [-].

    Zhang & Makris (2001): rocking starts at once, x (1 - exp(-2π p/ω)) = 1 + ω²/p².
    """
    return (1 + (omega / p) ** 2) / -math.expm1(-2 * math.pi * p / omega)


def ishiyama_bounds(block: Block, g: float = G) -> tuple[float, float]:
    """Least peak acceleration [m/s²] and velocity [m/s] of a motion that may overturn (Ishiyama 1982).

    a ≥ (B/H) g and v ≥ 10 B/√H with lengths in cm: with B and H in metres B/√H m/s, for the Earth's gravity.
    """
    return block.width / block.height * g, block.width / math.sqrt(block.height)


@pytest.mark.parametrize(
    ("block", "e", "p"),
    [
        (T1, 0.850000, 6.12589), (T2, 0.911765, 5.36484), (T3, 0.942308, 4.82421),
        (P, 0.341494, 7.27928),
    ],
)  # fmt: skip
def test_restitution_and_frequency_of_the_specimens(block: Block, e: float, p: float) -> None:
    assert block.momentum_restitution() == pytest.approx(e, abs=1e-6)
    assert block.frequency() == pytest.approx(p, abs=1e-5)


@pytest.mark.parametrize(
    ("upper", "e", "p"), [(T1, 0.8289, 5.092), (T2, 0.8809, 4.631), (T3, 0.9138, 4.2655)]
)
def test_restitution_and_frequency_of_the_stacks_as_one_body(upper, e, p):
    whole = Stack(P, upper).rigidly_joined()
    assert whole.momentum_restitution() == pytest.approx(e, abs=5e-4)
    assert whole.frequency() == pytest.approx(p, abs=5e-4)


def test_rectangular_pulse() -> None:
    assert rectangular_pulse(1.0, 1.0) == pytest.approx(1.58198, abs=1e-4)
    y = rectangular_pulse(0.7, 1.0)
    assert math.cosh(0.7) == pytest.approx(1 + 1 / (2 * y * (y - 1)), rel=1e-12)


@pytest.mark.parametrize(
    ("function", "ratio", "expected"),
    [
        (half_sine_pulse, 1.0, 1.3224),
        (half_sine_pulse, 3.0, 2.2939),
        (cf.one_sine_pulse, 2.0, 2.3499),
        (cf.one_sine_pulse, 5.0, 7.1681),
    ],
)
def test_sine_pulses(function: object, ratio: float, expected: float) -> None:
    assert function(2.14 * ratio, 2.14) == pytest.approx(expected, abs=1e-3)  # type: ignore[operator]


def test_housner_s_half_sine_is_too_high() -> None:
    assert housner_half_sine(3.0, 1.0) == pytest.approx(math.sqrt(10))
    assert housner_half_sine(3.0, 1.0) > half_sine_pulse(3.0, 1.0)


# --------------------------------------------------------------------------- simulated


def falls(shape: np.ndarray, dt: float, x: float, impacts: bool = False) -> bool:
    """Whether x α g times ``shape`` overturns the linear T2; falls after an impact count if asked for."""
    response = simulate(T2, x * T2.alpha * G * shape, dt, linear=True)
    return response.overturned and (impacts or response.impacts == 0)


@pytest.mark.parametrize(
    ("form", "ratio", "end", "wave"),
    [
        (half_sine_pulse, 1.0, math.pi, np.sin),
        (half_sine_pulse, 3.0, math.pi, np.sin),
        (cf.one_sine_pulse, 2.0, 2 * math.pi, np.sin),
        (cf.one_sine_pulse, 5.0, 2 * math.pi, np.sin),
        (one_cosine_pulse, 1.0, 2 * math.pi, np.cos),
    ],
)
def test_the_linear_block_overturns_above_the_closed_form_and_not_below(form, ratio, end, wave):
    omega = ratio * T2.frequency()
    phase = np.linspace(0, end, 401)
    x = form(omega, T2.frequency())
    assert not falls(wave(phase), phase[1] / omega, 0.999 * x)
    assert falls(wave(phase), phase[1] / omega, 1.001 * x)


def test_a_rectangular_pulse_overturns_at_its_closed_form() -> None:
    # the last sample falls to zero over one interval, half of which counts
    n = 2000
    dt = 1.0 / T2.frequency() / (n - 0.5)
    x = rectangular_pulse(1.0, 1.0)
    assert not falls(np.ones(n), dt, x - 1e-4, impacts=True)
    assert falls(np.ones(n), dt, x + 1e-4, impacts=True)


@pytest.mark.parametrize("seed", range(4))
def test_any_motion_overturns_without_impact_where_the_integral_exceeds_one(seed: int) -> None:
    # -s p ∫ exp(-p (t - t0)) a/(αg) dt > 1 from the start of rocking t0, linear equation
    rng = np.random.default_rng(seed)
    p, n = T2.frequency(), 600
    t = np.linspace(0, 1.5 / p, n)
    bumps = 1 + 0.4 * sum(
        rng.normal() / k * np.sin(math.pi * k * t / t[-1] + rng.uniform(0, 6)) for k in (2, 3, 5)
    )
    shape = np.sin(math.pi * t / t[-1]) * np.clip(bumps, 0.1, None)
    fine = np.linspace(0, t[-1], 200_001)
    curve = np.interp(fine, t, shape)

    def excess(x: float) -> float:
        start = int(np.argmax(x * curve >= 1.0))
        at, a = fine[start:], x * curve[start:]
        return float(p * np.trapezoid(np.exp(-p * (at - at[0])) * a, at)) - 1.0

    limit = brentq(excess, 1.05 / curve.max(), 20.0)
    assert not falls(shape, t[1], (1 - 1e-4) * limit, impacts=True)
    assert falls(shape, t[1], (1 + 1e-4) * limit, impacts=True)


def test_linear_amplitudes_decay_by_the_closed_relation():
    e, phi = T2.momentum_restitution(), [0.5]
    for _ in range(3):
        phi.append(1 - math.sqrt(1 - e**2 * (1 - (1 - phi[-1]) ** 2)))
    assert phi == pytest.approx([0.5, 0.38639, 0.30596, 0.24560], abs=1e-5)
    response = simulate(T2, np.zeros(2000), 0.001, theta0=0.5 * T2.alpha, linear=True)
    times = response.contact_events.query("kind == 'impact'")["time"].to_numpy()
    for first, second, expected in zip(times, times[1:], phi[1:], strict=False):
        between = (response.time > first) & (response.time < second)
        peak = np.abs(response.theta[between, 0]).max() / T2.alpha
        assert peak == pytest.approx(expected, abs=1e-5)


@pytest.mark.parametrize(
    ("linear", "limits"),
    [(True, (3.0186, 6.3181, 7.1681)), (False, (3.032, 6.743, 7.493))],
    ids=["linear", "nonlinear"],
)
def test_one_sine_overturns_after_an_impact_then_not_then_without(linear, limits):
    # one sine of ωp = 5 p and amplitude x α g, measured restitution 0.9
    pulse = BLOCK.alpha * G * np.sin(np.linspace(0, 2 * math.pi, 201))
    dt = 2 * math.pi / (5 * BLOCK.frequency()) / 200

    def shaken(x: float):
        return simulate(BLOCK, x * pulse, dt, restitution=0.9, linear=linear)

    for limit, above in zip(limits, (True, False, True), strict=True):
        assert shaken(0.998 * limit).overturned is not above
        assert shaken(1.002 * limit).overturned is above
    assert shaken(5.0).impacts == 1
    assert shaken(8.0).impacts == 0


def test_rocking_starts_exactly_where_the_ground_reaches_b_over_h() -> None:
    response = simulate(T2, np.linspace(0.0, -4.0, 3), 1.0)
    start = response.contact_events["time"].iloc[0]
    assert start == pytest.approx(G * T2.b / T2.h / 2.0, rel=1e-9)


def test_no_simulated_block_overturns_below_ishiyamas_bounds() -> None:
    rng = np.random.default_rng(14)
    fallen = 0
    for _ in range(12):
        block = uniform(rng.uniform(2.5, 5), rng.uniform(0.12, 0.3))
        motion = random_motion(rng, 200, 0.01)
        velocity = np.concatenate([[0], np.cumsum((motion[1:] + motion[:-1]) / 2 * 0.01)])
        acceleration, bound = ishiyama_bounds(block)
        if simulate(block, motion, 0.01).overturned:
            fallen += 1
            assert np.abs(motion).max() >= acceleration
            # the bound is an envelope of simulations of earthquakes: it is met within a tenth
            assert np.abs(velocity).max() >= 0.9 * bound
    assert fallen >= 3


def test_housners_velocity_is_of_the_order_of_fema_s_vertical_files() -> None:
    inch = 0.0254
    for depth, median in ((15, 0.498), (24, 1.229)):
        file = Block(depth * inch, 52 * inch, 100.0)
        found = cf.housner_velocity(file.alpha, file.frequency())
        assert median / 2 < found < 2 * median
