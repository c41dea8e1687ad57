"""Pulses overturn the simulated block where closed forms say so (tables of the field, theory)."""

import math

import numpy as np
import pytest
from scipy.optimize import brentq

from rockfrag.rocking import Block, Response, simulate
from rockfrag.rocking.restitution import peak_after, speed_before

G = 9.81
T2 = Block(0.124, 0.496, 2.790)
SAMPLES = 400


def least_overturning(
    shape: np.ndarray, dt: float, low: float, high: float, impacts: bool = True
) -> float:
    """Least x for which x α g times ``shape`` overturns the linear T2, between two of which one does.

    Without ``impacts`` only falls before the first impact count.
    """

    def falls(x: float) -> bool:
        response = simulate(T2, x * T2.alpha * G * shape, dt, linear=True)
        return response.overturned and (impacts or response.impacts == 0)

    assert falls(high) and not falls(low)
    while high - low > 1e-6:
        middle = (low + high) / 2
        low, high = (low, middle) if falls(middle) else (middle, high)
    return high


@pytest.mark.parametrize(("ratio", "x"), [(1, 1.3224), (3, 2.2939)])
def test_half_sine(ratio: float, x: float) -> None:
    duration = math.pi / (ratio * T2.frequency())
    shape = np.sin(np.linspace(0, math.pi, SAMPLES + 1))
    assert least_overturning(shape, duration / SAMPLES, 1.0, 4.0) == pytest.approx(x, abs=1e-3)


@pytest.mark.parametrize(("ratio", "x"), [(2, 2.3499), (5, 7.1681)])
def test_one_sine_without_impact(ratio: float, x: float) -> None:
    duration = 2 * math.pi / (ratio * T2.frequency())
    shape = np.sin(np.linspace(0, 2 * math.pi, SAMPLES + 1))
    found = least_overturning(shape, duration / SAMPLES, 0.8 * x, 1.2 * x, impacts=False)
    assert found == pytest.approx(x, abs=1e-3)


def test_rectangular_pulse() -> None:
    # pT = ln(x / (x - 1)); the last sample falls to zero over one interval, half of which counts
    n = 2000
    dt = 1.0 / T2.frequency() / (n - 0.5)
    found = least_overturning(np.ones(n), dt, 1.2, 2.0)
    assert found == pytest.approx(1 / (1 - math.exp(-1)), abs=1e-4)
    assert found == pytest.approx(1.58198, abs=1e-4)


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
    found = least_overturning(shape, t[1], 0.8 * limit, 1.2 * limit)
    assert found == pytest.approx(limit, rel=1e-4)


def test_linear_amplitudes_decay_by_the_closed_relation() -> None:
    # φ' = 1 - √(1 - e² (1 - (1 - φ)²)): .5 .38639 .30596 .24560 for T2
    response = simulate(T2, np.zeros(2000), 0.001, theta0=0.5 * T2.alpha, linear=True)
    impacts = response.contact_events.query("kind == 'impact'")
    phi = [
        peak_after(T2, abs(after[0]), linear=True) / T2.alpha
        for after in impacts["omega_after"][:3]
    ]
    assert phi == pytest.approx([0.38639, 0.30596, 0.24560], abs=1e-5)
    assert abs(impacts["omega_before"].iloc[0][0]) == pytest.approx(
        speed_before(T2, 0.5 * T2.alpha, linear=True), rel=1e-9
    )
    times = impacts["time"].to_numpy()
    for first, second, expected in zip(times, times[1:], phi, strict=False):
        between = (response.time > first) & (response.time < second)
        peak = np.abs(response.theta[between, 0]).max() / T2.alpha
        assert peak == pytest.approx(expected, abs=1e-5)


def one_sine_case(x: float, linear: bool) -> Response:
    """One-sine pulse of ωp = 5 p and amplitude x α g on the block of p = 2.14, α = 0.25."""
    p, alpha = 2.14, 0.25
    radius = 3 * G / (4 * p**2)
    block = Block(2 * radius * math.sin(alpha), 2 * radius * math.cos(alpha), 100.0)
    duration = 2 * math.pi / (5 * p)
    pulse = x * alpha * G * np.sin(np.linspace(0, 2 * math.pi, 201))
    return simulate(block, pulse, duration / 200, restitution=0.9, linear=linear)


@pytest.mark.parametrize(
    ("linear", "limits"),
    [(True, (3.0186, 6.3181, 7.1681)), (False, (3.032, 6.743, 7.493))],
    ids=["linear", "nonlinear"],
)
def test_one_sine_overturns_after_an_impact_then_not_then_without(
    linear: bool, limits: tuple[float, float, float]
) -> None:
    for limit, (below, above) in zip(
        limits, ((False, True), (True, False), (False, True)), strict=True
    ):
        assert one_sine_case(0.998 * limit, linear).overturned is below
        assert one_sine_case(1.002 * limit, linear).overturned is above
    assert one_sine_case(5.0, linear).impacts == 1
    assert one_sine_case(8.0, linear).impacts == 0
