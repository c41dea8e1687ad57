"""Rocking spectra agree with single simulations and with the laws of similar blocks."""

import math

import numpy as np
import pytest

from rockfrag.errors import InputError
from rockfrag.motions.pulses import one_sine
from rockfrag.records.motion import Motion
from rockfrag.rocking import simulate
from rockfrag.rocking.spectra import rocking_spectrum, uniform_block

ALPHA = math.atan(1 / 4)
PERIODS = np.linspace(0.8, 4.0, 9)


@pytest.fixture(scope="module")
def motion() -> Motion:
    """A decaying chirp that rocks every block and overturns some of the small ones."""
    t = np.arange(800) * 0.01
    return Motion(4.5 * np.exp(-t / 4) * np.sin(2 * np.pi * (0.5 * t + 0.1 * t**2)), 0.01, "chirp")


def test_block_has_the_wanted_period_and_slenderness() -> None:
    block = uniform_block(ALPHA, 1.7)
    assert 2 * math.pi / block.frequency() == pytest.approx(1.7, rel=1e-12)
    assert block.alpha == pytest.approx(ALPHA, rel=1e-12)
    assert block.slenderness == pytest.approx(4, rel=1e-12)


def test_each_ordinate_is_the_peak_of_a_simulation(motion: Motion) -> None:
    spectrum = rocking_spectrum(motion, PERIODS, [ALPHA])
    assert 0 < spectrum.overturned.sum() < PERIODS.size
    for k, period in enumerate(PERIODS):
        block = uniform_block(ALPHA, period)
        response = simulate(block, motion.acceleration, motion.dt)
        assert response.overturned == spectrum.overturned[0, k]
        if response.overturned:
            assert math.isinf(spectrum.velocity[0, k])
            continue
        rotation = np.abs(response.theta).max() / ALPHA
        velocity = np.abs(response.omega).max() / block.frequency()
        # the ensemble finds peaks between samples, the history has samples only
        assert rotation <= spectrum.rotation[0, k] * (1 + 1e-9)
        assert spectrum.rotation[0, k] == pytest.approx(rotation, rel=1e-3)
        # the largest velocity is at an impact, just before which no sample need lie
        assert velocity <= spectrum.velocity[0, k] * (1 + 1e-9)
        assert spectrum.velocity[0, k] == pytest.approx(velocity, rel=0.05)


def test_a_block_below_its_threshold_has_no_ordinate() -> None:
    weak = Motion(0.99 * math.tan(ALPHA) * 9.81 * np.sin(np.linspace(0, 20, 500)), 0.01)
    spectrum = rocking_spectrum(weak, PERIODS, [ALPHA])
    assert not spectrum.rotation.any() and not spectrum.velocity.any()


def test_pulses_of_similar_blocks_share_one_curve() -> None:
    # same α, ωp/p and a/(αg): same max |θ|/α and max |θ'|/p at every size
    found = []
    for period in (1.0, 2.0, 5.0):
        pulse = one_sine(1.6 * ALPHA * 9.81, period / 3, dt=period / 3000)
        found.append(rocking_spectrum(pulse, [period], [ALPHA]))
    for other in found[1:]:
        assert other.rotation == pytest.approx(found[0].rotation, rel=1e-8)
        assert other.velocity == pytest.approx(found[0].velocity, rel=1e-8)


@pytest.mark.parametrize(
    ("periods", "alpha", "message"),
    [
        ([], [0.2], "at least one period"),
        ([1.0], [], "at least one period"),
        ([0.0], [0.2], "period: 2π/p"),
        ([math.nan], [0.2], "period: 2π/p"),
        ([1.0], [2.0], "critical angle lies between"),
        ([1.0], [math.nan], "critical angle lies between"),
    ],
)
def test_impossible_blocks_are_refused(motion, periods, alpha, message):
    with pytest.raises(InputError, match=message):
        rocking_spectrum(motion, periods, alpha)
