"""Two horizontal components seen from all directions."""

import math
from dataclasses import replace

import numpy as np
import pytest
from obspy.signal.rotate import rotate_ne_rt

from rockfrag.base.errors import InputError
from rockfrag.motions import pga, pgv, rotate, rotd
from rockfrag.motions.directions import turned
from rockfrag.motions.intensity import spectral_acceleration
from rockfrag.motions.rotation import common_time, rotate_to_azimuth, stronger_direction
from rockfrag.records.motion import Motion


def pair(seed: int) -> tuple[Motion, Motion]:
    samples = np.random.default_rng(seed).standard_normal((2, 300))
    return Motion(samples[0], 0.01, "first"), Motion(samples[1], 0.01, "second")


def test_linear_motion_is_seen_by_its_projection():
    shape = np.sin(np.linspace(0, 20, 400))
    east, north = Motion(3 * shape, 0.01), Motion(4 * shape, 0.01)
    peak = 5 * np.abs(shape).max()
    assert rotd(east, north, pga, 100) == pytest.approx(peak, rel=2e-4)
    assert rotd(east, north, pga, 50) == pytest.approx(
        peak * math.cos(math.pi / 4), rel=0.01
    )
    assert rotd(east, north, pga, 0) == pytest.approx(0.0, abs=0.01 * peak)


@pytest.mark.parametrize("angle", [30.0, 200.0])
def test_component_is_that_of_obspy(angle):
    first, second = pair(1)
    # ObsPy's radial points away from the back-azimuth; first is north, second is east
    radial, _ = rotate_ne_rt(
        first.acceleration, second.acceleration, (angle + 180.0) % 360.0
    )
    found = rotate(first, second, angle)
    np.testing.assert_allclose(found.acceleration, radial, atol=1e-12)
    assert found.provenance == (
        {"step": "rotate", "second": "second", "angle_deg": angle},
    )


def test_measures_do_not_depend_on_how_the_sensor_stood():
    first, second = pair(2)
    item, other = rotate(first, second, 37.0), rotate(first, second, 127.0)
    for measure in (pga, pgv, lambda motion: spectral_acceleration(motion, 0.2)):
        for percentile in (50, 100):
            expected = rotd(first, second, measure, percentile)
            assert rotd(item, other, measure, percentile) == pytest.approx(
                expected, rel=1e-9
            )


def components(azimuths=(30.0, 120.0), starts=(None, None)):
    """A straight motion of azimuth 75° seen by two sensors."""
    shape = np.sin(np.linspace(0, 20, 400))
    return [
        Motion(
            shape * math.cos(math.radians(75 - azimuth)),
            0.01,
            f"c{azimuth:g}",
            {"component": f"{azimuth:g}", "start_time": start},
        )
        for azimuth, start in zip(azimuths, starts, strict=True)
    ]


@pytest.mark.parametrize("azimuths", [(30, 120), (120, 30), (210, 300)])
def test_an_azimuth_is_reached_from_components_of_any_order_and_sense(azimuths):
    first, second = components(azimuths)
    along, across = (rotate_to_azimuth(first, second, a) for a in (75, 165))
    assert along.pga == pytest.approx(1.0, rel=1e-3)
    assert across.pga == pytest.approx(0.0, abs=1e-12)
    assert along.metadata["component"] == "75"
    np.testing.assert_allclose(
        rotate_to_azimuth(first, second, azimuths[1]).acceleration,
        second.acceleration,
        atol=1e-14,
    )


def test_fault_normal_and_radial_are_directions_by_their_definitions():
    pair = components()
    expected = rotate_to_azimuth(*pair, 75).acceleration
    for direction in (
        "fault-normal -15",
        "fault-parallel 75",
        "radial 255",
        "transverse 165",
    ):
        found = turned(*pair, direction).acceleration
        np.testing.assert_allclose(found, expected, atol=1e-14)


def test_the_stronger_direction_has_the_largest_peak_of_all():
    first, second = pair(2)
    strongest = stronger_direction(first, second)
    assert strongest.pga == pytest.approx(
        np.hypot(first.acceleration, second.acceleration).max(), rel=1e-12
    )
    assert strongest.pga >= rotd(first, second, pga, 100)


FIRST, SECOND = components()
UPRIGHT = Motion(SECOND.acceleration, 0.01, "up", {"component": "UP"})
UNKNOWN = Motion(SECOND.acceleration, 0.01, "x")


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (
            lambda: rotd(pair(4)[0], Motion(np.ones(299), 0.01), pga, 50),
            "one sampling and length",
        ),
        (lambda: rotd(*pair(5), pga, 101), "between 0 and 100"),
        (lambda: rotd(FIRST, UPRIGHT, pga, 100), "vertical"),
        (lambda: rotd(FIRST, FIRST, pga, 100), "one and the same"),
        (
            lambda: rotate_to_azimuth(FIRST, components((30, 60))[1], 0),
            "not at a right angle",
        ),
        (lambda: rotate_to_azimuth(FIRST, UNKNOWN, 0), "azimuth is not known"),
    ],
)
def test_components_that_are_no_pair_are_refused(call, words):
    with pytest.raises(InputError, match=words):
        call()


def own_time(start: float, count: int, dt: float) -> Motion:
    """Samples that say their own time in seconds after 10:00:00."""
    stated = {"start_time": f"2014-08-24T10:00:{start:06.3f}"}
    return Motion(np.arange(count) * dt + start, dt, f"from {start:g} s", stated)


class TestCommonTime:
    @pytest.mark.parametrize(
        "late",
        [own_time(1.3, 80, 0.01), own_time(1.304, 40, 0.02)],
        ids=["whole", "parts"],
    )
    def test_stated_starts_shift_and_parts_of_samples_are_interpolated(self, late):
        first, other = common_time([own_time(1.0, 100, 0.01), late])
        assert first.dt == other.dt == 0.01
        np.testing.assert_allclose(first.acceleration, other.acceleration, atol=1e-12)
        if late.dt == 0.01:
            assert first.acceleration.size == 70
            assert first.provenance[-1]["left_out_at_beginning_s"] == pytest.approx(0.3)

    def test_components_without_times_begin_together_and_others_may_not_meet(self):
        first, second = components()
        assert common_time([first, second]) == [first, second]
        apart = components(starts=("2014-08-24T10:00:00", "2014-08-24T11:00:00"))
        with pytest.raises(InputError, match="no time in common"):
            common_time(apart)

    def test_horizontals_are_not_moved_for_a_verticals_time_step(self):
        """A vertical at 0.003 s, half a sample late, leaves horizontals of 0.005 s as they are."""
        random = np.random.default_rng(5)
        start = "2014-08-24T10:00:00"
        first, second = (
            Motion(
                random.standard_normal(400),
                0.005,
                name,
                {"start_time": start, "component": name},
            )
            for name in ("NS", "EW")
        )
        about = {"start_time": "2014-08-24T10:00:00.0015", "component": "UP"}
        vertical = Motion(random.standard_normal(900), 0.003, "v", about)
        item, other, upright = common_time([first, second, vertical])
        np.testing.assert_array_equal(item.acceleration, first.acceleration[1:])
        np.testing.assert_array_equal(other.acceleration, second.acceleration[1:])
        assert (item.dt, upright.dt, upright.acceleration.size) == (0.005, 0.005, 399)
        named = [
            replace(m, metadata={"start_time": m.metadata["start_time"]})
            for m in (first, vertical)
        ]
        assert common_time(named, verticals=(1,))[0].dt == 0.005
        assert common_time(named)[0].dt == 0.003

    def test_a_peak_that_goes_stands_in_the_provenance_with_what_is_left(self):
        """The peak of the longer component lies behind the end of the shorter."""
        samples = np.full(400, 0.17)
        samples[350] = 1.0
        long, short = Motion(samples, 0.01, "long"), Motion(np.ones(300), 0.01, "short")
        step = common_time([long, short])[0].provenance[-1]
        assert (step["peak_before_m_s2"], step["peak_after_m_s2"]) == (1.0, 0.17)
        assert step["left_out_at_end_s"] == pytest.approx(1.0)
        late = Motion(
            np.ones(300), 0.01, "late", {"start_time": "2014-08-24T10:00:00.005"}
        )
        spike = Motion(samples, 0.01, "spike", {"start_time": "2014-08-24T10:00:00"})
        step = common_time([late, spike])[1].provenance[-1]
        assert step["interpolated"]
        assert step["peak_after_m_s2"] < step["peak_before_m_s2"]
