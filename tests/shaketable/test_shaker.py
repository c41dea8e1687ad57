import numpy as np
import pytest

from rockfrag.errors import InputError
from rockfrag.records.integration import integrate
from rockfrag.records.motion import Motion
from rockfrag.shaketable.shaker import Shaker, produced_motion, required_corner, shaker_table


def versine(frequency, cycles=40, dt=0.001):
    """Harmonic acceleration whose displacement (1 - cos) swings from rest to one side."""
    t = np.arange(round(cycles / frequency / dt) + 1) * dt
    return Motion(np.cos(2 * np.pi * frequency * t), dt, f"{frequency} Hz")


@pytest.mark.parametrize(("frequency", "limit"), [(0.5, 0.146), (0.75, 0.33), (1.0, 0.58)])
def test_the_stroke_limits_harmonic_motions(frequency, limit):
    # acceleration a gives the travel 2 a / ω²
    found, governing = Shaker().limit(versine(frequency))
    assert found == pytest.approx(limit, abs=0.006)
    assert found == pytest.approx(0.145 * (2 * np.pi * frequency) ** 2 / 9.81, rel=1e-4)
    assert governing == "stroke"


def test_the_strokes_of_the_records_are_reproduced(records):
    table = shaker_table(Shaker(), list(records.values())).set_index("motion")
    travel = {name: f"{value:.2f}" for name, value in table["travel_cm_per_g"].items()}
    assert travel == {
        "Friuli": "19.61",
        "Kobe": "52.11",
        "Loma_Prieta": "72.30",
        "Northridge": "25.96",
    }
    largest = {name: f"{value:.2f}" for name, value in table["excursion_cm_per_g"].items()}
    assert largest == {
        "Friuli": "11.58",
        "Kobe": "28.12",
        "Loma_Prieta": "53.39",
        "Northridge": "15.90",
    }


def test_loma_prieta_fits_up_to_the_published_amplitudes(records):
    motion = records["Loma_Prieta"]
    assert f"{Shaker().limit(motion)[0]:.3f}" == "0.401"
    assert f"{Shaker(start='centred').limit(motion)[0]:.3f}" == "0.272"
    assert Shaker().demand(motion, 0.400).fits
    assert not Shaker().demand(motion, 0.402).fits


def test_the_force_never_governs_the_thesis_tests(records):
    heaviest = 3.456 + 2.300
    assert set(shaker_table(Shaker(), list(records.values()), heaviest)["limited_by"]) == {"stroke"}


def test_the_force_is_the_moved_mass_times_the_acceleration():
    shaker = Shaker(armature_mass=3.0, table_mass=4.0, stroke=100.0)
    motion = versine(10.0)
    assert shaker.demand(motion, 2.0, payload=5.0).force == pytest.approx(12 * 2 * 9.81)
    assert shaker.limit(motion, payload=5.0) == (pytest.approx(500 / 12 / 9.81), "force")


def test_a_velocity_limit_counts_where_there_is_one():
    motion = versine(1.0)
    speed = Shaker().demand(motion, 1.0).velocity
    assert speed == pytest.approx(9.81 / (2 * np.pi), rel=1e-4)
    assert Shaker(velocity=0.1).limit(motion) == (pytest.approx(0.1 / speed), "velocity")


def test_no_filter_is_needed_below_the_limit_and_a_milder_one_just_above(records):
    motion, shaker = records["Loma_Prieta"], Shaker()
    assert required_corner(shaker, motion, 0.40) == 0.0
    corners = [required_corner(shaker, motion, amplitude) for amplitude in (0.41, 0.5, 0.8)]
    assert 0 < corners[0] <= corners[1] <= corners[2] < 1.0


def test_the_produced_motion_fits_and_returns_to_where_it_started(records):
    shaker = Shaker()
    produced = produced_motion(shaker, records["Loma_Prieta"], 0.5)
    velocity, displacement = integrate(produced.acceleration, produced.dt)
    assert np.ptp(displacement) <= shaker.stroke
    assert abs(velocity[-1]) < 1e-3 * np.abs(velocity).max()
    assert abs(displacement[-1]) < 0.01 * np.abs(displacement).max()
    assert produced.provenance[-1]["corner_hz"] == 0.5


def test_the_produced_motion_says_what_became_of_its_peak(records):
    """A fifth may be missing: the filter takes out what the stroke cannot hold."""
    for name, motion in records.items():
        step = produced_motion(Shaker(), motion, 0.5).provenance[-1]
        assert step["peak_before_m_s2"] == pytest.approx(0.5 * 9.81), name
        assert step["peak_after_m_s2"] == produced_motion(Shaker(), motion, 0.5).pga


def test_what_the_band_cannot_hold_is_not_produced():
    slow, fast = versine(0.1), versine(5.0)
    ratio = [produced_motion(Shaker(), m, 0.05).pga / (0.05 * 9.81) for m in (slow, fast)]
    assert ratio[0] < 0.6  # what is left is the jump at its ends
    assert ratio[1] == pytest.approx(1, abs=0.02)


def test_a_force_that_no_filter_helps_is_refused():
    with pytest.raises(InputError, match="no high-pass corner up to 5 Hz"):
        required_corner(Shaker(), versine(8.0), 20.0)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"stroke": 0.0}, "stroke: expected a positive"),
        ({"velocity": -1.0}, "velocity: expected a positive"),
        ({"lowest_hz": 300.0}, "is empty"),
        ({"start": "left"}, "off-centre or centred"),
        ({"table_mass": -1.0}, "table_mass must be zero or more"),
    ],
)
def test_shakers_that_make_no_sense_are_refused(change, message):
    with pytest.raises(InputError, match=message):
        Shaker(**change)


def test_a_negative_or_missing_mass_is_refused():
    with pytest.raises(InputError, match="payload must be zero or more"):
        Shaker().moved_mass(-1.0)
    with pytest.raises(InputError, match="nothing moves"):
        Shaker(armature_mass=0.0, table_mass=0.0).moved_mass(0.0)
