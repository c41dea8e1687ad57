"""Stochastic motions have the properties asked for and depend on their seed alone."""

import math

import numpy as np
import pytest

from rockfrag import motions as m
from rockfrag.base.errors import InputError
from rockfrag.base.units import GRAVITY as G
from rockfrag.motions import intensity
from rockfrag.records.motion import integrate

MODEL = {
    "arias_m_s": 1.2,
    "d5_95_s": 12.0,
    "mid_s": 6.0,
    "mid_hz": 5.0,
    "slope_hz_s": -0.2,
    "filter_damping": 0.3,
}
# a spectrum with a plateau and a branch of constant velocity
PERIODS = [0.1, 0.2, 0.5, 1.0, 2.0, 4.0]
TARGET_G = [0.6, 0.8, 0.8, 0.4, 0.2, 0.1]


@pytest.fixture(scope="module")
def ensemble():
    return [m.evolutionary(seed, **MODEL) for seed in range(20)]


@pytest.mark.parametrize(
    ("make", "given"),
    [
        (m.evolutionary, MODEL),
        (m.spectrum_compatible, {"periods": PERIODS, "target_g": TARGET_G, "dt": 0.02}),
    ],
)
def test_seed_decides_everything(make, given):
    first, other = (make(seed, **given) for seed in (7, 8))
    assert not np.array_equal(first.acceleration, other.acceleration)
    assert first.metadata["synthetic"] is True
    # what is recorded makes the same motion again
    recorded = {
        key.replace("periods_s", "periods"): x for key, x in first.provenance[0].items()
    }
    del recorded["step"]
    np.testing.assert_array_equal(first.acceleration, make(**recorded).acceleration)


def test_ensemble_has_the_intensity_and_the_durations_of_the_model(ensemble):
    intensities = [intensity.arias(motion) for motion in ensemble]
    spread = np.std(intensities) / math.sqrt(len(ensemble))
    assert np.mean(intensities) == pytest.approx(MODEL["arias_m_s"], abs=4 * spread)
    assert np.mean(
        [intensity.significant_duration(x) for x in ensemble]
    ) == pytest.approx(12.0, rel=0.05)
    assert np.mean(
        [intensity.arias_times(x, 0.45, 0.95)[0] for x in ensemble]
    ) == pytest.approx(6.0, rel=0.1)


def test_frequency_falls_as_the_model_says(ensemble):
    """The rate of zero crossings follows the filter; both are in proportion for one damping."""

    def rate(start: float, end: float) -> float:
        counts = [
            np.count_nonzero(
                np.diff(np.sign(x.acceleration[int(start * 100) : int(end * 100)]))
            )
            for x in ensemble
        ]
        return float(np.mean(counts)) / 2 / (end - start)

    # 5 Hz - 0.2 Hz/s (t - 6 s) is 5.6 Hz at 3 s and 3.6 Hz at 13 s
    assert rate(2, 4) / rate(12, 14) == pytest.approx(5.6 / 3.6, rel=0.1)


def test_evolutionary_motion_comes_to_rest(ensemble):
    for motion in ensemble[:5]:
        velocity, displacement = integrate(motion.acceleration, motion.dt)
        assert abs(velocity[-1]) < 1e-3 * m.pgv(motion)
        assert abs(displacement[-1]) < 1e-3 * intensity.pgd(motion)


@pytest.mark.parametrize("seed", [0, 1])
def test_spectrum_compatible_motion_meets_its_target_from_rest_to_rest(seed):
    motion = m.spectrum_compatible(seed, PERIODS, TARGET_G)
    between = np.geomspace(0.1, 4.0, 60)
    target = np.exp(np.interp(np.log(between), np.log(PERIODS), np.log(TARGET_G))) * G
    error = np.log(m.response_spectrum(motion, between).pseudo_acceleration / target)
    rms = float(np.sqrt(np.mean(error**2)))
    assert rms < 0.05
    # single ordinates may dip; the motion says by how much
    assert np.abs(error).max() < 0.2
    assert motion.metadata["misfit_rms"] == pytest.approx(rms, abs=0.01)
    assert motion.metadata["misfit_max"] == pytest.approx(np.abs(error).max(), rel=0.5)
    velocity, displacement = integrate(motion.acceleration, motion.dt)
    assert motion.acceleration[0] == pytest.approx(0.0, abs=1e-12)
    assert velocity[-1] == pytest.approx(0.0, abs=1e-9)
    assert displacement[-1] == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"seed": -1}, "seed must be a whole number"),
        ({"arias_m_s": 0.0}, "arias_m_s: expected a positive"),
        ({"d5_95_s": 60.0}, "times mid_s"),
        ({"mid_s": 0.0}, "mid_s: expected a positive"),
        ({"filter_damping": 1.0}, "filter_damping must lie"),
        ({"mid_hz": 30.0}, "give a smaller dt"),
        ({"dt": 0.0}, "dt: expected a positive"),
        ({"dt": 1e-9}, "number of samples"),
        (([1.0], [0.1]), "two or more"),
        (([1.0, 0.1], [0.1, 0.2]), "must increase"),
        (([0.01, 1.0], [0.1, 0.2]), "at least 4 dt"),
        (([0.1, 1.0], [0.1, 0.0]), "positive numbers"),
    ],
)
def test_impossible_models_and_targets_are_refused(change, message):
    make, given = (m.evolutionary, MODEL | change) if isinstance(change, dict) else (
        m.spectrum_compatible, dict(zip(("periods", "target_g"), change, strict=True))
    )  # fmt: skip
    with pytest.raises(InputError, match=message):
        make(**({"seed": 1} | given))
