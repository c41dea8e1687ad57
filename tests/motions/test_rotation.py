"""Two horizontal components seen from all directions."""

import math

import numpy as np
import pytest
from obspy.signal.rotate import rotate_ne_rt

from rockfrag.errors import InputError
from rockfrag.motions import pga, pgv, rotate, rotd, rotd50, rotd100, spectral_acceleration
from rockfrag.records.motion import Motion


def pair(seed: int) -> tuple[Motion, Motion]:
    samples = np.random.default_rng(seed).standard_normal((2, 300))
    return Motion(samples[0], 0.01, "first"), Motion(samples[1], 0.01, "second")


def test_linear_motion_is_seen_by_its_projection():
    shape = np.sin(np.linspace(0, 20, 400))
    east, north = Motion(3 * shape, 0.01), Motion(4 * shape, 0.01)
    peak = 5 * np.abs(shape).max()
    assert rotd100(east, north, pga) == pytest.approx(peak, rel=2e-4)
    assert rotd50(east, north, pga) == pytest.approx(peak * math.cos(math.pi / 4), rel=0.01)
    assert rotd(east, north, pga, 0) == pytest.approx(0.0, abs=0.01 * peak)


def test_circular_motion_is_the_same_from_everywhere():
    phase = np.linspace(0, 40, 8000)
    east, north = Motion(np.cos(phase), 0.01), Motion(np.sin(phase), 0.01)
    for percentile in (0, 50, 100):
        assert rotd(east, north, pga, percentile) == pytest.approx(1.0, rel=1e-4)


@pytest.mark.parametrize("angle", [0.0, 30.0, 90.0, 200.0])
def test_component_is_that_of_obspy(angle):
    first, second = pair(1)
    # ObsPy's radial points away from the back-azimuth; first is north, second is east
    radial, _ = rotate_ne_rt(first.acceleration, second.acceleration, (angle + 180.0) % 360.0)
    np.testing.assert_allclose(rotate(first, second, angle).acceleration, radial, atol=1e-12)


def test_measures_do_not_depend_on_how_the_sensor_stood():
    first, second = pair(2)
    one, other = rotate(first, second, 37.0), rotate(first, second, 127.0)
    for measure in (pga, pgv, lambda motion: spectral_acceleration(motion, 0.2)):
        for percentile in (50, 100):
            expected = rotd(first, second, measure, percentile)
            assert rotd(one, other, measure, percentile) == pytest.approx(expected, rel=1e-9)


def test_rotation_is_recorded():
    first, second = pair(3)
    assert rotate(first, second, 30).provenance == (
        {"step": "rotate", "second": "second", "angle_deg": 30.0},
    )


@pytest.mark.parametrize("other", [Motion(np.ones(299), 0.01), Motion(np.ones(300), 0.02)])
def test_components_that_do_not_fit_are_refused(other):
    with pytest.raises(InputError, match="one sampling and length"):
        rotd50(pair(4)[0], other, pga)


def test_percentile_beyond_the_hundredth_is_refused():
    with pytest.raises(InputError, match="between 0 and 100"):
        rotd(*pair(5), pga, 101)
