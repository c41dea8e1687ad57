"""Oscillators side by side give what each alone gives, to the last bit."""

import math

import numpy as np
import pytest

from rockfrag import motions as m
from rockfrag.errors import InputError
from rockfrag.motions import conditioning, intensity
from rockfrag.motions.intensity import HOUSNER_PERIODS, PREDOMINANT_PERIODS, housner_and_average
from rockfrag.motions.side_by_side import peak_displacements
from rockfrag.records.motion import Motion


@pytest.fixture(
    params=["tapered noise", "noise to the end", "0.5 s sine", "jump", "quiet end", "0.005 s"]
)
def motion(request, noise) -> Motion:
    """Motions whose peaks come early, late, after the end, between samples and at them."""
    made = {
        "tapered noise": lambda: noise(1, tapered=True),
        "noise to the end": lambda: noise(2, 700),
        "0.5 s sine": lambda: m.sine(2.0, 0.5, 10, dt=0.01),
        "jump": lambda: m.rectangular(1.0, 0.3, dt=0.01),
        "quiet end": lambda: conditioning.pad(noise(3, 300), 5.0, 30.0),
        "0.005 s": lambda: noise(4, 900, 0.005, tapered=True),
    }
    return made[request.param]()


@pytest.mark.parametrize("damping", [0.0, 0.02, 0.05, 0.7, 1.0, 1.5])
def test_peaks_are_those_of_each_oscillator_alone(motion, damping):
    periods = np.concatenate([np.geomspace(0.02, 10.0, 37), HOUSNER_PERIODS[::20]])
    alone = m.response_spectrum(motion, periods, damping).displacement
    np.testing.assert_array_equal(peak_displacements(motion, periods, damping), alone)


def test_predominant_period_is_that_of_the_whole_spectrum(motion):
    spectrum = m.response_spectrum(motion, PREDOMINANT_PERIODS).pseudo_acceleration
    assert intensity.predominant_period(motion) == PREDOMINANT_PERIODS[np.argmax(spectrum)]


def test_housner_intensity_is_the_area_below_the_spectrum(motion):
    spectrum = m.response_spectrum(motion, HOUSNER_PERIODS, 0.05).pseudo_velocity
    assert housner_and_average(motion)[0] == np.trapezoid(spectrum, HOUSNER_PERIODS)


def test_negative_damping_is_refused(motion):
    with pytest.raises(InputError, match="damping"):
        peak_displacements(motion, HOUSNER_PERIODS, -0.1)
    assert math.isfinite(housner_and_average(motion, 0.0)[0])
