"""Intensity measures against closed forms, and the way they scale."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rockfrag import motions as m
from rockfrag.errors import InputError
from rockfrag.motions import intensity, scaling
from rockfrag.motions.intensity import housner_and_average
from rockfrag.records.motion import Motion
from rockfrag.units import GRAVITY as G


@pytest.fixture(scope="module")
def harmonic() -> Motion:
    """Ten cycles of 2 m/s² and half a second."""
    return m.sine(2.0, 0.5, 10, dt=0.001)


def test_sine_has_its_closed_forms(harmonic):
    amplitude, period, length = 2.0, 0.5, 5.0
    omega = 2 * math.pi / period
    assert m.pga(harmonic) == pytest.approx(amplitude, rel=1e-9)
    # from rest the velocity is a/ω (1 - cos ωt) and the displacement grows by a/ω in each second
    assert m.pgv(harmonic) == pytest.approx(2 * amplitude / omega, rel=1e-4)
    assert intensity.pgd(harmonic) == pytest.approx(amplitude / omega * length, rel=1e-4)
    assert intensity.arias(harmonic) == pytest.approx(math.pi / (2 * G) * amplitude**2 * length / 2)
    assert intensity.cav(harmonic) == pytest.approx(2 / math.pi * amplitude * length, rel=1e-4)
    assert intensity.predominant_period(harmonic) == pytest.approx(period, rel=0.012)
    assert intensity.pgv_over_pga(harmonic) == pytest.approx(2 / omega, rel=1e-4)


def test_steady_shaking_has_the_fractions_of_its_length_as_durations():
    steady = Motion(np.full(1001, -3.0), 0.01)
    assert intensity.significant_duration(steady) == pytest.approx(9.0)
    assert intensity.significant_duration(steady, 0.05, 0.75) == pytest.approx(7.0)
    assert intensity.arias_times(steady, 0.25, 0.5) == pytest.approx((2.5, 5.0))


def test_bracketed_duration_is_from_the_first_to_the_last_strong_sample():
    motion = Motion([0.0, 0.4, 0.6, -0.1, -0.5, 0.3], 0.1)
    assert intensity.bracketed_times(motion, 0.5) == pytest.approx((0.2, 0.4))
    assert all(math.isnan(t) for t in intensity.bracketed_times(motion, 0.7))


def test_mean_period_leaves_out_what_lies_outside_its_band():
    time = np.arange(4000) * 0.01
    slow, fast = np.sin(2 * np.pi * 2.0 * time), np.sin(2 * np.pi * 30.0 * time)
    assert intensity.mean_period(Motion(slow + 5 * fast, 0.01)) == pytest.approx(0.5, rel=1e-6)


def test_mean_period_weighs_periods_with_squared_amplitudes():
    time = np.arange(4000) * 0.01
    two = np.sin(2 * np.pi * 2.0 * time) + 2 * np.sin(2 * np.pi * 10.0 * time)
    assert intensity.mean_period(Motion(two, 0.01)) == pytest.approx((0.5 + 4 * 0.1) / 5, rel=1e-6)


def test_housner_intensity_of_a_short_pulse_is_its_impulse_times_the_range_of_periods():
    # an undamped oscillator keeps the pseudo-velocity that the impulse gave it
    pulse = m.rectangular(100.0, 0.002, dt=0.001)
    assert housner_and_average(pulse, damping=0.0)[0] == pytest.approx(0.2 * 2.4, rel=1e-3)


def test_block_starts_to_rock_at_an_uplift_ratio_of_one():
    b, h = 0.05, 0.2
    motion = m.sine(b / h * G, 0.5, 1)
    assert intensity.uplift_ratio(motion, math.atan2(b, h)) == pytest.approx(1.0)


def test_rocking_measures_have_no_dimension(harmonic):
    alpha, p = 0.2, 2.5
    # a block four times as large under a motion that lasts twice as long: the same measures
    measures = m.measure_rocking([harmonic], {"block": (alpha, p)}).iloc[0]
    faster = m.measure_rocking([scaling.compress_time(harmonic, 0.5)], {"block": (alpha, p / 2)})
    assert faster.iloc[0, 2:].tolist() == pytest.approx(measures[2:].tolist(), rel=2e-3)
    assert measures["velocity_ratio"] == pytest.approx(p * m.pgv(harmonic) / (G * math.tan(alpha)))
    pulse = m.strongest_pulse(harmonic)
    assert measures["frequency_ratio"] == pytest.approx(2 * math.pi / pulse.period / p)


@settings(max_examples=20, deadline=None)
@given(st.integers(0, 10_000), st.floats(0.01, 100.0))
def test_measures_grow_with_amplitude_as_they_should(noise, seed, factor):
    motion = noise(seed, tapered=True)
    scaled = m.scale(motion, factor)
    for measure in (m.pga, m.pgv, intensity.pgd, intensity.cav):
        assert measure(scaled) == pytest.approx(factor * measure(motion), rel=1e-9)
    assert intensity.arias(scaled) == pytest.approx(factor**2 * intensity.arias(motion), rel=1e-9)
    sa = intensity.spectral_acceleration(motion, 0.5)
    assert intensity.spectral_acceleration(scaled, 0.5) == pytest.approx(factor * sa, rel=1e-9)
    for measure in (intensity.significant_duration, intensity.mean_period, intensity.pgv_over_pga):
        assert measure(scaled) == pytest.approx(measure(motion), rel=1e-9)


@settings(max_examples=20, deadline=None)
@given(st.integers(0, 10_000), st.floats(0.2, 5.0))
def test_compressed_time_follows_similitude(noise, seed, factor):
    motion = noise(seed, tapered=True)
    model = scaling.compress_time(motion, factor)
    assert m.pga(model) == m.pga(motion)
    assert m.pgv(model) == pytest.approx(m.pgv(motion) / factor, rel=1e-9)
    assert intensity.pgd(model) == pytest.approx(intensity.pgd(motion) / factor**2, rel=1e-9)
    assert intensity.cav(model) == pytest.approx(intensity.cav(motion) / factor, rel=1e-9)
    duration = intensity.significant_duration(motion)
    assert intensity.significant_duration(model) == pytest.approx(duration / factor, rel=1e-9)
    sa = intensity.spectral_acceleration(motion, 0.5)
    assert intensity.spectral_acceleration(model, 0.5 / factor) == pytest.approx(sa, rel=1e-9)


@pytest.mark.parametrize("alpha", [0.0, -0.1, math.nan])
def test_block_without_a_critical_angle_is_refused(harmonic, alpha):
    with pytest.raises(InputError, match="alpha"):
        intensity.uplift_ratio(harmonic, alpha)
    with pytest.raises(InputError, match="alpha"):
        intensity.velocity_ratio(harmonic, alpha, 2.0)


def test_block_without_a_frequency_parameter_is_refused():
    with pytest.raises(InputError, match="p: expected a positive number"):
        intensity.frequency_ratio(0.5, 0.0)
