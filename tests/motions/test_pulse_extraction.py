"""The strongest pulse of a record is found again where one was put."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rockfrag import motions as m
from rockfrag.records.motion import Motion


@settings(max_examples=8, deadline=None)
@given(
    period=st.floats(0.4, 4.0),
    phase=st.floats(-179, 179),
    cycles=st.sampled_from([1.0, 1.5, 2.0, 3.0]),
)
def test_pulse_alone_is_recovered(period, phase, cycles):
    motion = m.pad(m.mavroeidis_papageorgiou(0.5, period, cycles, phase, 0.01), 2.0, 3.0)
    pulse = m.strongest_pulse(motion)
    assert pulse.explained > 0.999
    # near one cycle, period, cycles and phase can make up for one another
    assert pulse.period == pytest.approx(period, rel=0.02)
    assert pulse.velocity == pytest.approx(0.5, rel=0.03)
    assert pulse.time == pytest.approx(2.0 + cycles * period / 2, abs=0.1 * period)


def test_pulse_in_noise_is_recovered():
    pulse = m.pad(m.mavroeidis_papageorgiou(0.5, 2.0, 1.5, 60.0, 0.01), 8.0, 9.0)
    rng = np.random.default_rng(5)
    shaking = m.highpass(Motion(rng.standard_normal(pulse.acceleration.size), 0.01), 1.0, 4)
    found = m.strongest_pulse(Motion(pulse.acceleration + shaking.acceleration, 0.01))
    assert found.period == pytest.approx(2.0, rel=0.1)
    assert found.velocity == pytest.approx(0.5, rel=0.15)
    assert found.time == pytest.approx(9.5, abs=0.2)
    assert 0.7 < found.explained < 1.0


def test_taking_the_pulse_away_takes_its_share_of_the_velocity():
    motion = Motion(np.random.default_rng(3).standard_normal(1500) * np.hanning(1500), 0.01)
    velocity, _ = m.integrate(motion.acceleration, motion.dt)
    pulse = m.strongest_pulse(motion)
    half = pulse.cycles * pulse.period / 2
    t = motion.time - pulse.time
    envelope = np.where(np.abs(t) <= half, (1 + np.cos(np.pi * t / half)) / 2, 0.0)
    phase = 2 * np.pi * t / pulse.period + math.radians(pulse.phase_deg)
    rest = velocity - pulse.velocity * envelope * np.cos(phase)
    left = float((rest**2).sum() / (velocity**2).sum())
    assert left == pytest.approx(1 - pulse.explained, abs=1e-9)


def test_amplitude_scales_and_period_stays():
    motion = Motion(np.random.default_rng(4).standard_normal(1500) * np.hanning(1500), 0.01)
    one, three = m.strongest_pulse(motion), m.strongest_pulse(m.scale(motion, 3.0))
    assert three.velocity == pytest.approx(3 * one.velocity)
    assert three.period == pytest.approx(one.period)
    assert three.explained == pytest.approx(one.explained)


def test_extracted_pulse_is_a_motion():
    pulse = m.strongest_pulse(m.mavroeidis_papageorgiou(0.5, 1.0, 2.0, 90.0, 0.005))
    again = m.pulse_motion(pulse, 0.005)
    assert again.metadata["synthetic"] is True
    # an antisymmetric pulse of this kind peaks below its amplitude
    assert 0.7 * 0.5 < m.pgv(again) < 0.5


@pytest.mark.parametrize("samples", [np.zeros(500), np.ones(1), np.ones(5)])
def test_nothing_holds_no_pulse(samples):
    pulse = m.strongest_pulse(Motion(samples, 0.01))
    assert math.isnan(pulse.period)
    assert math.isnan(pulse.velocity)
    assert math.isnan(pulse.explained)


def test_pulse_can_be_as_long_as_the_record_but_not_longer():
    drift = Motion(np.ones(400), 0.01)
    assert m.strongest_pulse(drift).period <= 4.0 * 1.05
