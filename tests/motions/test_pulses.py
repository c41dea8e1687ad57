"""Idealised pulses against their closed forms."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import minimize_scalar
from scipy.signal import correlate

from rockfrag import motions as m
from rockfrag.base.errors import InputError
from rockfrag.motions import processing
from rockfrag.motions import pulse_extraction as searched
from rockfrag.motions import response_spectra as spectra
from rockfrag.records.motion import Motion, integrate

DT = 0.002


def at_the_end(motion: Motion) -> tuple[float, float]:
    velocity, displacement = integrate(motion.acceleration, motion.dt)
    return float(velocity[-1]), float(displacement[-1])


PULSES = {
    "sine": lambda a, t: m.sine(a, t, 3, DT),
    "one_sine": lambda a, t: m.one_sine(a, t, DT),
    "one_cosine": lambda a, t: m.one_cosine(a, t, DT),
    "half_sine": lambda a, t: m.half_sine(a, t, DT),
    "rectangular": lambda a, t: m.rectangular(a, t, DT),
    "ricker_symmetric": lambda a, t: m.ricker_symmetric(a, t, DT),
    "ricker_antisymmetric": lambda a, t: m.ricker_antisymmetric(a, t, DT),
    "mavroeidis_papageorgiou": lambda a, t: m.mavroeidis_papageorgiou(
        a, t, 2.0, 30.0, DT
    ),
}


@pytest.mark.parametrize("name", list(PULSES))
@settings(max_examples=15)
@given(amplitude=st.floats(-5, 5), period=st.floats(0.1, 3.0))
def test_every_pulse_starts_and_ends_at_zero_and_says_what_it_is(
    name, amplitude, period
):
    pulse = PULSES[name](amplitude, period)
    assert pulse.acceleration[0] == pulse.acceleration[-1] == 0.0
    assert pulse.dt <= DT * (1 + 1e-9)
    assert pulse.name == pulse.provenance[0]["step"] == pulse.metadata["kind"] == name
    assert pulse.metadata["synthetic"] is True
    if name != "mavroeidis_papageorgiou":
        assert m.pga(pulse) <= abs(amplitude) * (1 + 1e-12)
        # half an interval beside the peak, of which a Ricker wavelet has the sharpest
        lost = 3 * (math.pi * DT / 2 / period) ** 2
        assert m.pga(pulse) == pytest.approx(abs(amplitude), rel=lost + 1e-12)


@pytest.mark.parametrize(
    ("pulse", "velocity", "displacement"),
    [
        (m.one_sine(3.0, 0.8, DT), 0.0, 3.0 * 0.8**2 / (2 * math.pi)),
        (m.one_cosine(3.0, 0.8, DT), 0.0, 0.0),
        (m.half_sine(2.0, 0.5, DT), 2 * 2.0 * 0.5 / math.pi, None),
        *((m.rectangular(2.0, t, 0.01), 2.0 * t, None) for t in (0.1, 0.3331, 1.0)),
    ],
)
def test_pulses_leave_their_impulse_and_displacement(pulse, velocity, displacement):
    left = at_the_end(pulse)
    exact = 1e-12 if pulse.name == "rectangular" else 1e-4
    assert left[0] == pytest.approx(velocity, rel=exact, abs=1e-9)
    if displacement is not None:
        assert left[1] == pytest.approx(displacement, rel=1e-4, abs=1e-9)


@pytest.mark.parametrize(
    ("wavelet", "sign"), [(m.ricker_symmetric, 1), (m.ricker_antisymmetric, -1)]
)
def test_ricker_wavelets_come_to_rest_and_have_their_symmetry_and_period(wavelet, sign):
    pulse = wavelet(2.0, 0.7, DT)
    np.testing.assert_allclose(
        pulse.acceleration, sign * pulse.acceleration[::-1], atol=1e-12
    )
    assert at_the_end(pulse) == pytest.approx((0.0, 0.0), abs=1e-8)
    frequency, amplitude = spectra.fourier_amplitude(pulse, 200_000)
    assert 1 / frequency[np.argmax(amplitude)] == pytest.approx(0.7, rel=0.01)


@pytest.mark.parametrize("cycles", [1.0, 1.5, 2.7])
@pytest.mark.parametrize("phase_deg", [0.0, 45.0, 90.0, -120.0])
def test_velocity_pulse_integrates_to_its_definition(cycles, phase_deg):
    pulse = m.mavroeidis_papageorgiou(0.6, 1.2, cycles, phase_deg, 0.001)
    velocity, _ = integrate(pulse.acceleration, pulse.dt)
    t = pulse.time - cycles * 1.2 / 2
    envelope = 0.6 / 2 * (1 + np.cos(2 * np.pi * t / (cycles * 1.2)))
    expected = envelope * np.cos(2 * np.pi * t / 1.2 + math.radians(phase_deg))
    np.testing.assert_allclose(velocity, expected, atol=0.6 * 2e-5)


@pytest.mark.parametrize(("start", "end"), [(1.0, 16.0), (16.0, 1.0)])
def test_ida_passes_its_octaves_at_the_stated_rate(start, end):
    ida = m.sine_sweep(1.5, start, end, 8.0, 0.002)
    assert ida.time[-1] == pytest.approx(4 / 8 * 60)
    # zero crossings per second in the middle of the sweep, where the frequency is the geometric mean
    near = np.abs(ida.time - 15.0) < 1.0
    crossings = np.flatnonzero(np.diff(np.sign(ida.acceleration[near])) != 0).size
    assert crossings / 2 / 2.0 == pytest.approx(math.sqrt(start * end), rel=0.1)
    assert m.pga(ida) == pytest.approx(1.5, rel=1e-3)


@pytest.mark.parametrize(
    ("pulse", "message"),
    [
        (lambda: m.sine(1.0, 0.5, 0), "cycles must be a whole number"),
        (lambda: m.sine(math.nan, 0.5, 1), "amplitude: expected a finite number"),
        (
            lambda: m.one_sine(1.0, -0.5),
            "period: expected a positive number of seconds",
        ),
        (lambda: m.one_sine(1.0, 0.5, 0.6), "choose another dt"),
        (
            lambda: m.rectangular(1.0, 0.0),
            "duration: expected a positive number of seconds",
        ),
        (
            lambda: m.mavroeidis_papageorgiou(1.0, 1.0, 0.5),
            "cycles must be one or more",
        ),
        (lambda: m.sine_sweep(1.0, 5.0, 5.0, 1.0), "nothing is swept"),
        (
            lambda: m.sine_sweep(1.0, 0.0, 5.0, 1.0),
            "start_hz: expected a positive number",
        ),
        (lambda: m.sine_sweep(1.0, 1.0, 500.0, 1.0), "give a smaller dt"),
    ],
)
def test_impossible_pulses_are_refused(pulse, message):
    with pytest.raises(InputError, match=message):
        pulse()


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
    return (
        gain[best],
        best + half,
        along_even[best] / norms[0],
        along_odd[best] / norms[1],
    )


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
    return (
        period,
        math.hypot(even, odd),
        cycles,
        middle * motion.dt,
        gain / (velocity**2).sum(),
    )


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("kind", ["random walk", "high-passed", "short"])
def test_search_finds_what_trying_everything_finds(noise, kind, seed):
    motion = noise(
        seed, 40 if kind == "short" else 900, 0.01 if seed else 0.005, tapered=True
    )
    if kind == "high-passed":
        motion = processing.highpass(motion, 2.0, 4)
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


@pytest.mark.parametrize("samples", [np.zeros(500), np.ones(5)])
def test_nothing_holds_no_pulse(samples):
    assert math.isnan(m.strongest_pulse(Motion(samples, 0.01)).period)
