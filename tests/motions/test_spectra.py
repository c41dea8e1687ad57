"""Response spectra against closed forms and other ways of solving the same oscillator."""

import math

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from scipy.signal import StateSpace, lsim

from rockfrag import motions as m
from rockfrag.base.errors import InputError
from rockfrag.motions import (
    half_sine,
    intensity,
    pga,
    processing,
    response_spectrum,
    sine,
)
from rockfrag.motions.intensity import (
    HOUSNER_PERIODS,
    PREDOMINANT_PERIODS,
    housner_and_average,
    pgd,
)
from rockfrag.motions.processing import interpolate
from rockfrag.motions.response_spectra import (
    fourier_amplitude,
    oscillator_response,
    peak_displacements,
)
from rockfrag.records.motion import Motion


@pytest.fixture(scope="module")
def ended(noise):
    """Maker of noise that ends with a sample of zero."""

    def make(seed: int, count: int = 400) -> Motion:
        samples = noise(seed, count).acceleration.copy()
        samples[-1] = 0.0
        return Motion(samples, 0.02)

    return make


@pytest.mark.parametrize("damping", [0.0, 0.05, 1.0, 2.5])
def test_history_is_that_of_scipys_linear_system(ended, damping):
    motion, omega = ended(1), 2 * math.pi / 0.7
    u, v, total = oscillator_response(motion, 0.7, damping)
    system = StateSpace(
        [[0, 1], [-(omega**2), -2 * damping * omega]],
        [[0], [-1]],
        np.eye(2),
        np.zeros((2, 1)),
    )
    _, states, _ = lsim(system, motion.acceleration, motion.time)
    np.testing.assert_allclose(u, states[:, 0], atol=1e-10)
    np.testing.assert_allclose(v, states[:, 1], atol=1e-9)
    # the total acceleration is that of the relative motion and of the ground together
    relative = -2 * damping * omega * v - omega**2 * u - motion.acceleration
    np.testing.assert_allclose(total, relative + motion.acceleration, atol=1e-9)


@pytest.mark.parametrize("ratio", [0.1, 0.25, 0.4, 0.75, 1.0, 1.3])
def test_half_sine_pulse_has_its_shock_spectrum(ratio):
    """Chopra, Dynamics of Structures, section 4.8: undamped response to a half-sine pulse."""
    period, duration = 1.0, ratio
    pulse = half_sine(1.0, duration, dt=2e-4)
    beta = period / (2 * duration)
    if beta == 1.0:
        largest = math.pi / 2
    elif beta > 1:
        largest = abs(2 * beta / (beta**2 - 1) * math.cos(math.pi / (2 * beta)))
    else:
        largest = max(
            math.sin(2 * math.pi * k * beta / (1 + beta)) / (1 - beta)
            for k in range(1, 1 + math.ceil((1 + 1 / beta) / 2))
        )
    ours = response_spectrum(pulse, [period], damping=0.0).pseudo_acceleration[0]
    assert ours == pytest.approx(largest, rel=2e-5)


@pytest.mark.parametrize("damping", [0.05, 0.2])
def test_resonance_reaches_the_steady_state(damping):
    spectrum = response_spectrum(sine(1.0, 0.5, 40, dt=0.001), [0.5], damping)
    assert spectrum.pseudo_acceleration[0] == pytest.approx(1 / (2 * damping), rel=1e-4)
    total = math.sqrt(1 + 4 * damping**2) / (2 * damping)
    assert spectrum.acceleration[0] == pytest.approx(total, rel=1e-4)


def test_stiff_oscillator_moves_with_the_ground_and_soft_one_stays_behind(ended):
    motion = processing.taper(ended(2), 1.0)
    stiff = response_spectrum(motion, [5e-5])
    assert stiff.pseudo_acceleration[0] == pytest.approx(pga(motion), rel=1e-3)
    during = np.abs(oscillator_response(motion, 1e4, 0.0)[0]).max()
    assert during == pytest.approx(pgd(motion), rel=1e-3)


@settings(max_examples=25)
@given(
    st.integers(0, 10_000),
    st.floats(0.02, 3.0),
    st.sampled_from([0.0, 0.05, 0.5, 1.0, 2.0]),
)
@example(579, 1.0234, 0.5)  # the displacement turns twice within one step
def test_peaks_do_not_depend_on_how_finely_the_lines_are_sampled(
    ended, seed, period, damping
):
    # a last sample of zero, so that the line behind the record is the same one
    motion = ended(seed, 60)
    coarse = response_spectrum(motion, [period], damping)
    fine = response_spectrum(interpolate(motion, motion.dt / 8), [period], damping)
    for name in ("displacement", "velocity", "acceleration"):
        assert getattr(coarse, name)[0] == pytest.approx(
            getattr(fine, name)[0], rel=1e-7
        )


def test_fourier_amplitude_keeps_the_energy(ended):
    motion = ended(4, 401)
    frequency, amplitude = fourier_amplitude(motion, 2001)
    # Parseval: the frequencies above zero count twice in a one-sided spectrum of odd length
    energy = (amplitude[0] ** 2 + 2 * (amplitude[1:] ** 2).sum()) * frequency[1]
    assert energy == pytest.approx((motion.acceleration**2).sum() * motion.dt)


@pytest.mark.parametrize("periods", [[], [0.0], [0.5, math.nan], [[0.1, 0.2]]])
def test_impossible_periods_are_refused(ended, periods):
    with pytest.raises(InputError, match=r"response spectrum: .*period"):
        response_spectrum(ended(5), periods)


def test_impossible_damping_is_refused(ended):
    with pytest.raises(InputError, match="damping"):
        response_spectrum(ended(5), [1.0], -0.01)


@pytest.fixture(
    params=[
        "tapered noise",
        "noise to the end",
        "0.5 s sine",
        "jump",
        "quiet end",
        "0.005 s",
    ]
)
def motion(request, noise) -> Motion:
    """Motions whose peaks come early, late, after the end, between samples and at them."""
    made = {
        "tapered noise": lambda: noise(1, tapered=True),
        "noise to the end": lambda: noise(2, 700),
        "0.5 s sine": lambda: m.sine(2.0, 0.5, 10, dt=0.01),
        "jump": lambda: m.rectangular(1.0, 0.3, dt=0.01),
        "quiet end": lambda: processing.pad(noise(3, 300), 5.0, 30.0),
        "0.005 s": lambda: noise(4, 900, 0.005, tapered=True),
    }
    return made[request.param]()


@pytest.mark.parametrize("damping", [0.0, 0.02, 0.05, 0.7, 1.0, 1.5])
def test_peaks_are_those_of_each_oscillator_alone(motion, damping):
    periods = np.concatenate([np.geomspace(0.02, 10.0, 37), HOUSNER_PERIODS[::20]])
    alone = m.response_spectrum(motion, periods, damping).displacement
    np.testing.assert_array_equal(peak_displacements(motion, periods, damping), alone)


def test_predominant_period_and_housner_intensity_are_those_of_the_whole_spectrum(
    motion,
):
    spectrum = m.response_spectrum(motion, PREDOMINANT_PERIODS).pseudo_acceleration
    assert (
        intensity.predominant_period(motion) == PREDOMINANT_PERIODS[np.argmax(spectrum)]
    )
    spectrum = m.response_spectrum(motion, HOUSNER_PERIODS, 0.05).pseudo_velocity
    assert housner_and_average(motion)[0] == np.trapezoid(spectrum, HOUSNER_PERIODS)
