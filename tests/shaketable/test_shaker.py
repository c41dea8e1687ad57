from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from rockfrag.base.errors import InputError
from rockfrag.records.motion import Motion, integrate
from rockfrag.shaketable.definitions import tests_from_ida as read_ida
from rockfrag.shaketable.protocols import GeometricSteps, Protocol
from rockfrag.shaketable.shaker import (
    Shaker,
    produced_motion,
    read_shaker,
    required_corner,
    shaker_table,
)
from rockfrag.simulation import overturns
from rockfrag.system.blocks import Block

from .conftest import ida_table

SHAKER = Path(__file__).resolve().parents[2] / "config" / "experiment" / "shaker.yaml"


def versine(frequency, cycles=40, dt=0.001):
    """Harmonic acceleration whose displacement (1 - cos) swings from rest to one side."""
    t = np.arange(round(cycles / frequency / dt) + 1) * dt
    return Motion(np.cos(2 * np.pi * frequency * t), dt, f"{frequency} Hz")


@pytest.mark.parametrize("frequency", [0.5, 1.0])
def test_the_stroke_limits_harmonic_motions(frequency):
    # acceleration a gives the travel 2 a / ω²
    limit = pytest.approx(0.145 * (2 * np.pi * frequency) ** 2 / 9.81, rel=1e-4)
    assert Shaker().limit(versine(frequency)) == (limit, "stroke")


def test_the_strokes_of_the_records_are_reproduced_and_the_force_never_governs(records):
    heaviest = 3.456 + 2.300
    table = shaker_table(Shaker(), list(records.values()), heaviest)
    assert table["motion"].tolist() == ["Friuli", "Kobe", "Loma_Prieta", "Northridge"]
    assert set(table["limited_by"]) == {"stroke"}
    printed = {
        "travel_cm_per_g": [19.61, 52.11, 72.30, 25.96],
        "excursion_cm_per_g": [11.58, 28.12, 53.39, 15.90],
    }
    assert table[[*printed]].round(2).to_dict("list") == printed


def test_loma_prieta_fits_up_to_the_published_amplitudes(records):
    motion = records["Loma_Prieta"]
    assert f"{Shaker().limit(motion)[0]:.3f}" == "0.401"
    assert f"{Shaker(start='centred').limit(motion)[0]:.3f}" == "0.272"
    assert Shaker().demand(motion, 0.400).fits
    assert not Shaker().demand(motion, 0.402).fits


def test_the_full_stroke_censors_loma_prieta_with_t1_and_nothing_else(records):
    towers = {"T1": (0.372, 2.172), "T2": (0.496, 2.790), "T3": (0.620, 3.456)}
    motions, steps = list(records.values()), GeometricSteps(0.2, 0.01)
    table = shaker_table(Shaker(), motions).set_index("motion")
    amplitudes = steps.amplitudes(0.7)
    result = overturns(
        [Block(0.124, *tower) for tower in towers.values()],
        [motion.acceleration for motion in motions],
        [motion.dt for motion in motions],
        [amplitudes * 9.81 / motion.pga for motion in motions],
    )
    curves = [
        ida_table(result.overturned[i, j], amplitudes, name, earthquake=motion.name)
        for i, name in enumerate(towers)
        for j, motion in enumerate(motions)
    ]
    tests = read_ida(
        pd.concat(curves),
        Protocol(steps),
        definitions=["step_protocol"],
        limits_g={f"{name}_ground": limit for name, limit in table["limit_g"].items()},
    )
    censored = tests[tests["censored"] == "right"]
    assert censored[["object", "motion"]].to_numpy().tolist() == [
        ["T1", "Loma_Prieta_ground"]
    ]
    assert censored["lower_g"].iloc[0] == pytest.approx(0.40, abs=0.005)


def test_the_force_is_the_moved_mass_times_the_acceleration():
    shaker = Shaker(armature_mass=3.0, table_mass=4.0, stroke=100.0)
    motion = versine(10.0)
    assert shaker.demand(motion, 2.0, payload=5.0).force == pytest.approx(12 * 2 * 9.81)
    assert shaker.limit(motion, payload=5.0) == (
        pytest.approx(500 / 12 / 9.81),
        "force",
    )


def test_a_velocity_limit_counts_where_there_is_one():
    motion = versine(1.0)
    speed = Shaker().demand(motion, 1.0).velocity
    assert speed == pytest.approx(9.81 / (2 * np.pi), rel=1e-4)
    assert Shaker(velocity=0.1).limit(motion) == (
        pytest.approx(0.1 / speed),
        "velocity",
    )


def test_no_filter_is_needed_below_the_limit_and_a_milder_one_just_above(records):
    motion, shaker = records["Loma_Prieta"], Shaker()
    assert required_corner(shaker, motion, 0.40) == 0.0
    corners = [
        required_corner(shaker, motion, amplitude) for amplitude in (0.41, 0.5, 0.8)
    ]
    assert 0 < corners[0] <= corners[1] <= corners[2] < 1.0


@pytest.mark.parametrize("name", ["Friuli", "Kobe", "Loma_Prieta", "Northridge"])
def test_the_produced_motion_fits_and_returns_to_where_it_started(records, name):
    """A fifth of the peak may be missing: the filter takes out what the stroke cannot hold."""
    shaker = Shaker()
    produced = produced_motion(shaker, records[name], 0.5)
    velocity, displacement = integrate(produced.acceleration, produced.dt)
    assert np.ptp(displacement) <= shaker.stroke
    assert abs(velocity[-1]) < 1e-3 * np.abs(velocity).max()
    assert abs(displacement[-1]) < 0.01 * np.abs(displacement).max()
    step = produced.provenance[-1]
    assert step["corner_hz"] == 0.5
    assert step["peak_before_m_s2"] == pytest.approx(0.5 * 9.81)
    assert step["peak_after_m_s2"] == produced.pga


def test_what_the_band_cannot_hold_is_not_produced():
    slow, fast = versine(0.1), versine(5.0)
    ratio = [
        produced_motion(Shaker(), m, 0.05).pga / (0.05 * 9.81) for m in (slow, fast)
    ]
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
        ({"start": "left"}, "off-centre or centred"),
        (
            {"table_mass": -1.0},
            "table_mass: expected a number of kg that is not negative",
        ),
        ({"armature_mass": 0.0, "table_mass": 0.0}, "nothing moves"),
        ({"payload": -1.0}, "payload: expected a number of kg that is not negative"),
    ],
)
def test_shakers_that_make_no_sense_are_refused(change, message):
    payload = change.pop("payload", 0.0)
    with pytest.raises(InputError, match=message):
        Shaker(**change).moved_mass(payload)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("strokes: 0.29", "key strokes is not known; did you mean stroke_m"),
        ("force_n: 500 N", "key force_n: expected a number of newtons"),
        ("stroke: 0.29", "key stroke: .* without a unit"),
        ("stroke_m: -1", "shaker.yaml: key stroke_m: expected a length above 0 m"),
        (
            "lowest_hz: 300",
            "shaker.yaml: shaker: the band from 300 to 200.0 Hz is empty",
        ),
    ],
)
def test_files_that_describe_no_shaker_are_refused(tmp_path, text, message):
    path = tmp_path / "shaker.yaml"
    path.write_text(text)
    with pytest.raises(InputError, match=message):
        read_shaker(path)


def test_lengths_and_masses_may_be_given_in_any_unit(tmp_path):
    path = tmp_path / "shaker.yaml"
    path.write_text("stroke: 29 cm\ntable_mass_g: 2500")
    assert read_shaker(path) == Shaker(stroke=0.29, table_mass=2.5)
    # that of the thesis
    assert read_shaker(SHAKER) == Shaker()
