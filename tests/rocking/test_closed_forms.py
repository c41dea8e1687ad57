"""Simulated blocks against closed forms and figures computed independently."""

import math

import numpy as np
import pytest
from scipy.optimize import brentq

from rockfrag import Block, simulate
from rockfrag.rocking import closed_forms as cf

from .reference_bodies import T2, uniform

G = 9.81
BLOCK = uniform(2.14, 0.25)


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
    for x, falls in (((1 - 1e-4) * limit, False), ((1 + 1e-4) * limit, True)):
        assert simulate(T2, x * T2.alpha * G * shape, t[1], linear=True).overturned is falls


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
