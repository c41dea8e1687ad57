"""Simulated blocks against closed forms; restitution is recovered from free rocking: peaks, times or history."""

import math

import numpy as np
import pytest
from scipy.optimize import brentq

from rockfrag import Block, Response, simulate
from rockfrag.simulation import closed_forms as cf
from rockfrag.simulation.restitution import (
    peak_after,
    restitution_from_history,
    restitution_from_impacts,
    restitution_from_peaks,
)

from .reference_bodies import T2, uniform

G = 9.81
BLOCK = uniform(2.14, 0.25)


@pytest.mark.parametrize("seed", range(4))
def test_any_motion_overturns_without_impact_where_the_integral_exceeds_one(
    seed: int,
) -> None:
    # -s p ∫ exp(-p (t - t0)) a/(αg) dt > 1 from the start of rocking t0, linear equation
    rng = np.random.default_rng(seed)
    p, n = T2.frequency(), 600
    t = np.linspace(0, 1.5 / p, n)
    bumps = 1 + 0.4 * sum(
        rng.normal() / k * np.sin(math.pi * k * t / t[-1] + rng.uniform(0, 6))
        for k in (2, 3, 5)
    )
    shape = np.sin(math.pi * t / t[-1]) * np.clip(bumps, 0.1, None)
    fine = np.linspace(0, t[-1], 200_001)
    curve = np.interp(fine, t, shape)

    def excess(x: float) -> float:
        start = int(np.argmax(x * curve >= 1.0))
        at, a = fine[start:], x * curve[start:]
        return float(p * np.trapezoid(np.exp(-p * (at - at[0])) * a, at)) - 1.0

    limit = brentq(excess, 1.05 / curve.max(), 20.0)
    for x, falls in (((1 - 1e-4) * limit, False), ((1 + 1e-4) * limit, True)):
        assert (
            simulate(T2, x * T2.alpha * G * shape, t[1], linear=True).overturned
            is falls
        )


def test_one_sine_overturns_after_an_impact_then_not_then_without():
    # the linear block under one sine of ωp = 5 p and amplitude x α g, measured restitution 0.9
    pulse = BLOCK.alpha * G * np.sin(np.linspace(0, 2 * math.pi, 201))
    dt = 2 * math.pi / (5 * BLOCK.frequency()) / 200

    def shaken(x: float):
        return simulate(BLOCK, x * pulse, dt, restitution=0.9, linear=True)

    for limit, above in ((3.0186, True), (6.3181, False), (7.1681, True)):
        assert shaken(0.998 * limit).overturned is not above
        assert shaken(1.002 * limit).overturned is above
    assert shaken(5.0).impacts == 1
    assert shaken(8.0).impacts == 0
    assert cf.one_sine_pulse(5.0, 1.0) == pytest.approx(7.1681, abs=5e-5)


def test_housners_velocity_is_of_the_order_of_fema_s_vertical_files() -> None:
    inch = 0.0254
    for depth, median in ((15, 0.498), (24, 1.229)):
        file = Block(depth * inch, 52 * inch, 100.0)
        found = cf.housner_velocity(file.alpha, file.frequency())
        assert median / 2 < found < 2 * median


STATUE = Block(0.40, 1.20, 300.0, inertia=45.0, cg_height=0.50, cg_offset=0.04)


def free_rocking(block, e, start=0.6, seconds=4.0, dt=0.002):
    """Release from ``start`` critical angles."""
    theta0 = start * block.critical_angle(1)
    return simulate(
        block, np.zeros(int(seconds / dt)), dt, theta0=theta0, restitution=e
    )


def times_and_peaks(
    block: Block, response: Response, count: int
) -> tuple[np.ndarray, np.ndarray]:
    """Times of impacts, and the release, then what energy gives after each impact's speed."""
    impacts = response.contact_events.query("kind == 'impact'").head(count)
    after, peaks = [row[0] for row in impacts["omega_after"]], [response.theta[0, 0]]
    peaks += [
        math.copysign(peak_after(block, abs(w), 1 if w > 0 else -1), w) for w in after
    ]
    return impacts["time"].to_numpy(), np.array(peaks[:count])


@pytest.mark.parametrize("block", [T2, STATUE], ids=["uniform", "off-centre"])
@pytest.mark.parametrize("e", [0.7, 0.87, 0.95])
def test_exact_times_and_peaks_give_the_restitution_back(
    block: Block, e: float
) -> None:
    times, peaks = times_and_peaks(block, free_rocking(block, e), 7)
    by_times = restitution_from_impacts(block, times, first_pivot=-1)
    by_peaks = restitution_from_peaks(block, peaks)
    assert by_times.restitution == pytest.approx(e, abs=1e-6)
    assert by_peaks.restitution == pytest.approx(e, abs=1e-8)
    assert by_times.impacts == 5 and by_peaks.impacts == 6


def test_peaks_of_simulated_history_are_those_of_energy() -> None:
    response = free_rocking(T2, 0.9, dt=0.0005)
    times, peaks = times_and_peaks(T2, response, 2)
    between = (response.time > times[0]) & (response.time < times[1])
    assert np.abs(response.theta[between, 0]).max() == pytest.approx(
        abs(peaks[1]), rel=1e-5
    )


def test_noisy_peaks_and_times_cover_the_truth_as_often_as_promised() -> None:
    e, rng = 0.9, np.random.default_rng(3)
    times, peaks = times_and_peaks(T2, free_rocking(T2, e), 9)
    covered = np.zeros(2)
    for _ in range(50):
        fits = (
            restitution_from_peaks(
                T2, peaks + rng.normal(0, 0.001, peaks.size), confidence=0.9
            ),
            restitution_from_impacts(
                T2, times + rng.normal(0, 0.001, times.size), confidence=0.9
            ),
        )
        covered += [fit.lower <= e <= fit.upper for fit in fits]
    # 90 % of 50 within three standard deviations of a binomial
    assert (covered >= 45 - 6.4).all()


@pytest.mark.parametrize("e", [0.8, 0.92])
@pytest.mark.parametrize("noise", [0.0, 0.002])
def test_sampled_history_gives_the_restitution_back(e: float, noise: float) -> None:
    response = free_rocking(T2, e, seconds=2.0, dt=0.005)
    n = 400
    theta = response.theta[:n, 0] + np.random.default_rng(11).normal(0, noise, n)
    fit = restitution_from_history(T2, response.time[:n], theta)
    assert fit.restitution == pytest.approx(e, abs=1e-6 + noise)
    if noise:
        assert fit.lower < e < fit.upper
        assert fit.scatter == pytest.approx(noise, rel=0.15)


def test_without_spare_data_there_is_no_interval() -> None:
    fit = restitution_from_peaks(T2, [0.10, 0.07])
    assert 0 < fit.restitution < 1
    assert fit.computed == pytest.approx(0.911765, abs=1e-6)
    assert math.isnan(fit.lower) and math.isnan(fit.upper)
