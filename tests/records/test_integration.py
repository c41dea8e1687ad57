"""Velocity and displacement are exact, and their peaks are found between samples."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import cumulative_trapezoid
from scipy.interpolate import PPoly, make_interp_spline

from rockfrag.records.motion import integrate, peak_displacement, peak_velocity
from rockfrag.units import GRAVITY

TABLE_3_3 = [
    ("Friuli", 3633, 0.35, 22.020, 4.067),
    ("Kobe", 4091, 0.34, 27.678, 9.694),
    ("Loma_Prieta", 3991, 0.37, 44.703, 19.615),
    ("Northridge", 3989, 0.57, 52.013, 9.035),
]

# a drawing of whole thousandths keeps zeros and repeated values likely and overflow impossible
accelerations = st.lists(st.integers(-5000, 5000), min_size=2, max_size=30).map(
    lambda values: np.array(values) / 1000
)


@pytest.mark.parametrize(("name", "npts", "pga_g", "pgv_cm_s", "pgd_cm"), TABLE_3_3)
def test_table_3_3_to_the_printed_digit(four_records, name, npts, pga_g, pgv_cm_s, pgd_cm):
    motion = four_records[name]
    assert motion.acceleration.size == npts
    assert round(motion.pga / GRAVITY, 2) == pga_g
    assert round(100 * peak_velocity(motion.acceleration, motion.dt), 3) == pgv_cm_s
    assert round(100 * peak_displacement(motion.acceleration, motion.dt), 3) == pgd_cm


def test_linear_acceleration_gives_the_cubic():
    time = np.arange(101) * 0.02
    velocity, displacement = integrate(2 * time, 0.02)
    np.testing.assert_allclose(velocity, time**2, rtol=1e-12, atol=1e-15)
    np.testing.assert_allclose(displacement, time**3 / 3, rtol=1e-12, atol=1e-15)


@settings(max_examples=100, deadline=None)
@given(accelerations)
def test_velocity_is_that_of_scipys_trapezoidal_rule(acceleration):
    velocity, _ = integrate(acceleration, 0.01)
    expected = cumulative_trapezoid(acceleration, dx=0.01, initial=0)
    np.testing.assert_allclose(velocity, expected, rtol=1e-12, atol=1e-13)


@settings(max_examples=150, deadline=None)
@given(accelerations)
def test_peaks_are_those_of_scipys_piecewise_polynomials(acceleration):
    dt = 0.5
    spline = make_interp_spline(np.arange(acceleration.size) * dt, acceleration, k=1)
    velocity = PPoly.from_spline(spline).antiderivative()
    displacement = velocity.antiderivative()
    ends = np.arange(acceleration.size) * dt
    for curve, ours in ((velocity, peak_velocity), (displacement, peak_displacement)):
        # a stretch of zero slope has NaN among its roots; its ends are in the list already
        roots = curve.derivative().roots(extrapolate=False)
        instants = np.concatenate([ends, roots[np.isfinite(roots)]])
        peak = np.abs(curve(instants)).max()
        assert ours(acceleration, dt) == pytest.approx(peak, rel=1e-9, abs=1e-9)
