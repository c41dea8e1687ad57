"""The same measures by other programs, where they define the same thing."""

import math
import warnings

import numpy as np
import pytest

from rockfrag import motions as m
from rockfrag.motions import intensity, processing, spectra
from rockfrag.records.motion import Motion, integrate


def peer(name: str):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return pytest.importorskip(name, reason=f"{name} is not installed")


@pytest.fixture(scope="module")
def motion(noise) -> Motion:
    return Motion(np.pad(noise(11, 2000, tapered=True).acceleration, (1, 1)), 0.01, "noise")


@pytest.mark.peers
def test_integrals_are_eqsigs(motion):
    peer("eqsig")
    from eqsig import AccSignal, im

    signal = AccSignal(motion.acceleration, motion.dt)
    assert intensity.arias(motion) == pytest.approx(im.calc_arias_intensity(signal)[-1], rel=1e-9)
    assert intensity.cav(motion) == pytest.approx(im.calc_cav(signal)[-1], rel=1e-9)
    velocity, displacement = integrate(motion.acceleration, motion.dt)
    np.testing.assert_allclose(velocity, signal.velocity, atol=1e-12)
    # eqsig applies the trapezoidal rule to the velocity again, an error of order dt²
    np.testing.assert_allclose(displacement, signal.displacement, atol=2e-4 * intensity.pgd(motion))


@pytest.mark.peers
def test_durations_are_eqsigs_but_for_reading_between_samples(motion):
    peer("eqsig")
    from eqsig import AccSignal, im

    signal = AccSignal(motion.acceleration, motion.dt)
    for upper in (0.75, 0.95):
        theirs = im.calc_sig_dur(signal, start=0.05, end=upper)
        assert intensity.significant_duration(motion, 0.05, upper) == pytest.approx(
            theirs, abs=2 * motion.dt
        )


@pytest.mark.peers
@pytest.mark.parametrize("period", [0.05, 0.3, 1.0, 4.0])
def test_oscillator_histories_are_eqsigs(motion, period):
    peer("eqsig")
    from eqsig import sdof

    theirs = sdof.response_series(motion.acceleration, motion.dt, np.array([period]), 0.05)
    # eqsig takes the load, not the ground acceleration, as positive
    for ours, other in zip(spectra.oscillator_response(motion, period), theirs, strict=True):
        np.testing.assert_allclose(ours, -other[0], atol=1e-6 * np.abs(ours).max())


@pytest.mark.peers
@pytest.mark.parametrize("period", [0.1, 0.5, 2.0])
def test_spectra_are_pyrotds_once_both_see_the_same_function_of_time(motion, period):
    pyrotd = peer("pyrotd")
    # pyrotd repeats the record for ever and joins samples by sines: give it a finely sampled one with
    # enough silence behind it
    fine = processing.interpolate(processing.pad(motion, 0.0, 60.0), 0.0005)
    theirs = pyrotd.calc_spec_accels(fine.dt, fine.acceleration, np.array([1 / period]), 0.05)
    ours = intensity.spectral_acceleration(motion, period)
    assert ours == pytest.approx(float(theirs["spec_accel"][0]), rel=1e-4)


@pytest.mark.peers
def test_rotated_spectra_are_pyrotds(motion):
    pyrotd = peer("pyrotd")
    other = Motion(np.roll(motion.acceleration, 37) * 0.8, motion.dt)
    fine = [
        processing.interpolate(processing.pad(x, 0.0, 60.0), 0.002).acceleration
        for x in (motion, other)
    ]
    theirs = pyrotd.calc_rotated_spec_accels(
        0.002, *fine, np.array([2.0]), 0.05, percentiles=[50, 100], angles=np.arange(180)
    )
    for percentile, value in zip((50, 100), theirs["spec_accel"], strict=True):
        ours = m.rotd(motion, other, lambda x: intensity.spectral_acceleration(x, 0.5), percentile)
        assert ours == pytest.approx(float(value), rel=2e-4)


def test_peaks_of_the_samples_fall_short_by_what_sampling_hides(motion):
    """Why PGV and spectra exceed those of programs that read them off the samples."""
    velocity, _ = integrate(motion.acceleration, motion.dt)
    assert np.abs(velocity).max() <= m.pgv(motion)
    period = 0.06
    sampled = np.abs(spectra.oscillator_response(motion, period)[0]).max()
    peak = m.response_spectrum(motion, [period]).displacement[0]
    assert sampled <= peak
    # at six samples a period up to 1 - cos(π/6) of the peak hides between them
    assert sampled >= peak * math.cos(math.pi * motion.dt / period) * 0.98
