"""The strongest pulse of a record is found again where one was put."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import minimize_scalar
from scipy.signal import correlate

from rockfrag import motions as m
from rockfrag.motions import conditioning, filtering
from rockfrag.motions import pulse_extraction as searched
from rockfrag.records.motion import Motion, integrate


@settings(max_examples=8, deadline=None)
@given(
    period=st.floats(0.4, 4.0),
    phase=st.floats(-179, 179),
    cycles=st.sampled_from([1.0, 1.5, 2.0, 3.0]),
)
def test_pulse_alone_is_recovered(period, phase, cycles):
    motion = conditioning.pad(m.mavroeidis_papageorgiou(0.5, period, cycles, phase, 0.01), 2.0, 3.0)
    pulse = m.strongest_pulse(motion)
    assert pulse.explained > 0.999
    # near one cycle, period, cycles and phase can make up for one another
    assert pulse.period == pytest.approx(period, rel=0.02)
    assert pulse.velocity == pytest.approx(0.5, rel=0.03)
    assert pulse.time == pytest.approx(2.0 + cycles * period / 2, abs=0.1 * period)


def fit(velocity, dt, period, cycles):
    """The best place of a pulse by its definition: explained sum of squares, middle, even, odd part."""
    half = math.floor(cycles * period / 2 / dt)
    if 2 * half + 1 > velocity.size:
        return 0.0, 0, 0.0, 0.0
    phase = 2 * np.pi / period * dt * np.arange(-half, half + 1)
    envelope = (1 + np.cos(phase / cycles)) / 2
    even, odd = envelope * np.cos(phase), envelope * np.sin(phase)
    along_even = correlate(velocity, even, mode="valid")
    along_odd = correlate(velocity, odd, mode="valid")
    norms = (even**2).sum(), (odd**2).sum()
    gain = along_even**2 / norms[0] + along_odd**2 / norms[1]
    best = int(np.argmax(gain))
    return gain[best], best + half, along_even[best] / norms[0], along_odd[best] / norms[1]


def thinned_gain(velocity, dt, period, cycles):
    every = max(1, int(period / (searched.SAMPLES_PER_PERIOD * dt)))
    return every * fit(velocity[::every], every * dt, period, cycles)[0]


def plain_search(motion):
    """The strongest pulse with every period, number of cycles and place tried."""
    velocity, _ = integrate(motion.acceleration, motion.dt)
    shortest = max(searched.SHORTEST_PERIOD, 10 * motion.dt)
    longest = min(searched.LONGEST_PERIOD, motion.time[-1])
    step = math.log(searched.PERIOD_RATIO)
    count = math.ceil(math.log(longest / shortest) / step) + 1
    _, period, cycles = max(
        (thinned_gain(velocity, motion.dt, period, cycles), period, cycles)
        for cycles in searched.CYCLES
        for period in np.geomspace(shortest, longest, count)
    )
    end = min(math.log(period) + step, math.log(motion.time[-1] / cycles))
    refined = minimize_scalar(
        lambda x: -fit(velocity, motion.dt, math.exp(x), cycles)[0],
        bounds=(math.log(period) - step, end),
        method="bounded",
        options={"xatol": 1e-4},
    )
    period = math.exp(refined.x)
    gain, middle, even, odd = fit(velocity, motion.dt, period, cycles)
    return period, math.hypot(even, odd), cycles, middle * motion.dt, gain / (velocity**2).sum()


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("kind", ["random walk", "high-passed", "short", "with a pulse"])
def test_search_finds_what_trying_everything_finds(noise, kind, seed):
    shaking = noise(seed, 900, 0.01 if seed else 0.005, tapered=True)
    motion = {
        "random walk": lambda: shaking,
        "high-passed": lambda: filtering.highpass(shaking, 2.0, 4),
        "short": lambda: noise(seed, 40),
        "with a pulse": lambda: Motion(
            0.2 * shaking.acceleration
            + conditioning.pad(
                m.mavroeidis_papageorgiou(0.3, 1.0, 2.5, 30.0, shaking.dt), 0.0, 9.0
            ).acceleration[:900],
            shaking.dt,
        ),
    }[kind]()
    period, velocity, cycles, time, explained = plain_search(motion)
    pulse = m.strongest_pulse(motion)
    assert (pulse.cycles, pulse.time) == (cycles, time)
    # the search for the best period stops within 1e-4 of it; what rounding does to its steps is less
    assert pulse.period == pytest.approx(period, rel=1e-9)
    assert pulse.velocity == pytest.approx(velocity, rel=1e-9)
    assert pulse.explained == pytest.approx(explained, rel=1e-12)


def test_taking_the_pulse_away_takes_its_share_of_the_velocity(noise):
    motion = noise(3, 1500, tapered=True)
    velocity, _ = integrate(motion.acceleration, motion.dt)
    pulse = m.strongest_pulse(motion)
    half = pulse.cycles * pulse.period / 2
    t = motion.time - pulse.time
    envelope = np.where(np.abs(t) <= half, (1 + np.cos(np.pi * t / half)) / 2, 0.0)
    phase = 2 * np.pi * t / pulse.period + math.radians(pulse.phase_deg)
    rest = velocity - pulse.velocity * envelope * np.cos(phase)
    left = float((rest**2).sum() / (velocity**2).sum())
    assert left == pytest.approx(1 - pulse.explained, abs=1e-9)


@pytest.mark.parametrize("samples", [np.zeros(500), np.ones(1), np.ones(5)])
def test_nothing_holds_no_pulse(samples):
    pulse = m.strongest_pulse(Motion(samples, 0.01))
    assert math.isnan(pulse.period)
    assert math.isnan(pulse.velocity)
    assert math.isnan(pulse.explained)
