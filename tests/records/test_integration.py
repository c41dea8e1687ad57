"""Velocity and displacement are exact, and their peaks are found between samples."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
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


@settings(max_examples=150)
@given(accelerations)
def test_integrals_and_their_peaks_are_those_of_scipys_piecewise_polynomials(acceleration):
    dt = 0.5
    spline = make_interp_spline(np.arange(acceleration.size) * dt, acceleration, k=1)
    velocity = PPoly.from_spline(spline).antiderivative()
    displacement = velocity.antiderivative()
    ends = np.arange(acceleration.size) * dt
    curves = zip(
        (velocity, displacement),
        integrate(acceleration, dt),
        (peak_velocity, peak_displacement),
        strict=True,
    )
    for curve, at_samples, ours in curves:
        np.testing.assert_allclose(at_samples, curve(ends), rtol=1e-12, atol=1e-13)
        # a stretch of zero slope has NaN among its roots; its ends are in the list already
        roots = curve.derivative().roots(extrapolate=False)
        instants = np.concatenate([ends, roots[np.isfinite(roots)]])
        peak = np.abs(curve(instants)).max()
        assert ours(acceleration, dt) == pytest.approx(peak, rel=1e-9, abs=1e-9)
