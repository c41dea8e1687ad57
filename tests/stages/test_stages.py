"""Stages: IDA curves, curves by floor, and forces of a sample of tests that each has by itself."""

import itertools
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest

from rockfrag.engines.pure_rocking import ensembles
from rockfrag.engines.pure_rocking.ensembles import run_blocks
from rockfrag.fragility.empirical import TableIda
from rockfrag.fragility.ida_curves import with_measures
from rockfrag.records.motion import GroundMotion, Motion
from rockfrag.report.sections import tested
from rockfrag.shaketable.tests_table import read_measured
from rockfrag.simulation import overturns
from rockfrag.simulation.options import system_of
from rockfrag.stages import tests as tests_stage
from rockfrag.stages.fragility import export_curves, floor_curves
from rockfrag.stages.ida import as_recorded, ida_table
from rockfrag.stages.pedestal import measured_tables, pedestal_tables
from rockfrag.study.holding import held_as_stated
from rockfrag.study.study import Amplitudes
from rockfrag.system.blocks import Block, Stack

STATUE = Block(0.2, 0.8, 50.0)
FLOORS = {"hall": 0, "loft": 2}


MEASURES = ("pga_g", "pgv_cm_s", "sa_0_3s_g", "sa_1_0s_g", "avgsa_g")


@pytest.fixture
def fragility():
    """Eight motions on two floors; the loft shakes twice as long, so bodies fall at lower peaks."""
    rng = np.random.default_rng(3)
    amplitude, rows, measures = np.geomspace(0.1, 2.0, 60), [], []
    for k, floor in itertools.product(range(8), FLOORS):
        name = f"m{k}_{floor}"
        peak, velocity, capacity = np.exp(0.2 * rng.normal(size=3)) * [0.3, 60, 0.4]
        measures.append((name, peak, peak * velocity, 2 * peak, peak, peak))
        capacity *= 1.5 if floor == "hall" else 1
        about = {
            "configuration": "statue",
            "motion": name,
            "earthquake": f"e{k}",
            "floor": floor,
        }
        swept = {"amplitude_g": amplitude, "overturned": amplitude > capacity}
        rows.append(pd.DataFrame(swept | about))
    measures = pd.DataFrame(measures, columns=["name", *MEASURES])
    ida_curves = {
        ("statue", str(floor)): TableIda(with_measures(part, measures, list(MEASURES)))
        for floor, part in pd.concat(rows).groupby("floor", sort=False)
    }
    study = SimpleNamespace(
        floors=FLOORS,
        configurations=[replace(STATUE.system(), name="statue")],
        fragility=SimpleNamespace(confidence=0.90),
        **{"slides": False, "vertical": False},
    )
    return floor_curves({"overturns": ida_curves}, measures, study, "abc")


def test_floors_never_share_a_curve_and_measures_are_named_after_them(
    fragility, tmp_path
):
    curves, fractions = fragility
    names = curves.groupby("floor")["im"].unique()
    assert set(names["hall"]) == {"PGA", "PGV", "SA(0.3s)", "SA(1s)", "AvgSA"}
    assert set(names["loft"]) == {"PFA", "PFV"}
    assert (curves.loc[curves.state == "overturns", "n_motions"] == 8).all()
    found = curves.set_index(["state", "floor", "measure"]).sort_index()
    fallen, rocks = found.loc["overturns", "theta"], found.loc[("rocks", "hall")]
    assert fallen["hall", "pga_g"] == pytest.approx(0.6, rel=0.2)
    assert fallen["loft", "pga_g"] == pytest.approx(0.4, rel=0.2)
    # rocking starts at b/h, and varies in other measures
    assert rocks.loc["pga_g", "theta"] == pytest.approx(0.2 / 0.8)
    assert rocks.loc["pgv_cm_s", "theta"] == pytest.approx(60 * 0.25, rel=0.2)
    assert 0.05 < rocks.loc["pgv_cm_s", "beta"] < 0.5
    # files are one per floor and measure
    written = export_curves(curves, tmp_path, fractions)
    assert {
        "fragility_pga.xml",
        "fragility_avgsa.xml",
        "fragility_pfa_loft.csv",
    } <= set(written)
    assert not [name for name in written if name.endswith(".xml") and "loft" in name]
    assert all((tmp_path / name).exists() for name in written)
    assert (
        "Peak Floor Acceleration" in (tmp_path / "fragility_pfa_loft.csv").read_text()
    )


def test_of_many_tests_some_evenly_among_them_are_looked_at(monkeypatch, noise):
    monkeypatch.setattr(tests_stage, "MOST_TESTED", 4)
    known = {
        f"m{k}": GroundMotion(noise(k, 300, 0.02, tapered=True)) for k in range(10)
    }
    about = {
        "configuration": "T",
        "object": "T",
        "pedestal": "NP",
        "earthquake": "e",
        "floor": "g",
    }
    tests = pd.DataFrame(
        {"motion": [*known], "test": [*known], **about, "amplitude_g": 0.4}
    )
    table = tests_stage.validity_table(
        tests, [replace(STATUE.system(), name="T")], known
    )
    assert list(table["motion"]) == ["m0", "m2", "m5", "m7"]


def test_amplitudes_grow_by_the_step_up_to_the_highest():
    assert Amplitudes(0.5, 2.0, 100).values_g == pytest.approx([0.5, 1.0, 2.0])


def test_a_statue_that_its_pedestal_carries_along_rocks_and_does_not_stay():
    time, about = np.arange(300) * 0.01, {"earthquake": "E", "floor": "ground"}
    waves = [
        GroundMotion(
            Motion(
                6 * np.sin(2 * np.pi * f * time) * (time < 1.5), 0.01, f"{f} Hz", about
            )
        )
        for f in (1.0, 2.0)
    ]
    stack = Stack(Block(0.2725, 0.9899, 62.6), Block(0.6, 1.2, 372.0))
    table = as_recorded(stack.system(), waves)
    assert set(table["overturned_body"]) == {"pedestal"}
    assert (table["peak_rotation"] == 0).all()
    assert table["rocked"].all()


def pairs(earthquakes: str, step: float = 0.01) -> pd.DataFrame:
    rows = []
    for number, earthquake in enumerate(earthquakes):
        for side, amplitude in (("NP", 0.5), ("P", 0.5 + step * number)):
            rows.append((side, earthquake, f"motion {number}", *[amplitude] * 3))
    names = ["pedestal", "earthquake", "motion", "amplitude_g", "lower_g", "upper_g"]
    about = {
        "object": "T1",
        "floor": "GF",
        "definition": "step_protocol",
        "censored": "none",
    }
    return pd.DataFrame(rows, columns=names).assign(**about)


def test_the_pedestal_effect_of_a_study_with_one_floor_is_estimated():
    # variances of earthquakes and of motions cannot be told apart there
    found = pedestal_tables(pairs("AABBCD"), seed=1, slenderness={"T1": 3.0})
    whole = found["effects"].set_index("scope").loc["whole"]
    assert whole["ratio"] == pytest.approx(1.05, abs=0.01)
    assert len(found["pairs"]) == 6


def test_a_reading_without_any_pair_leaves_the_numbers_of_the_others_numbers():
    # one motion: neither limits nor p values; a table that follows no motion: no effect at all
    known, other = (
        pairs("A", 0.0),
        pairs("A", 0.0).assign(definition="step_protocol_shaker"),
    )
    other = other.assign(censored="right", upper_g=np.inf)
    found = pedestal_tables(pd.concat([known, other]), seed=1, slenderness={"T1": 3.0})
    assert found["effects"]["lower"].dtype == float


def measured(folder, rows):
    """What the statistics of a laboratory's table say, set beside itself."""
    header = "test,object,pedestal,earthquake,floor,lower_g,upper_g,censored,overturned_body,repetition,remark"
    (folder / "synthetic.csv").write_text("\n".join([header, *rows]) + "\n")
    tests = read_measured(folder / "synthetic.csv")
    slenderness = {"T1": 3.0, "T2": 4.0, "T3": 5.0}
    level = SimpleNamespace(confidence=0.9)
    study = SimpleNamespace(slenderness=slenderness, seed=1, fragility=level)
    return measured_tables(tests, tests, study)


def test_measured_tests_say_what_they_can_carry(tmp_path):
    found = measured(tmp_path, [])
    assert found["measured/notes"]["note"].iloc[0].endswith("has no rows yet.")
    # one test is set beside the simulation and carries no statistics
    found = measured(tmp_path, ["s,T1,NP,A,GF,0.5,0.55,none,statue,1,synthetic"])
    assert found["measured/beside"]["ratio"].tolist() == [1.0]
    assert len(found["measured/notes"]) == 1
    # a full table has curves and an effect
    rng, rows = np.random.default_rng(2), []
    levels = {"T1": 0.5, "T2": 0.4, "T3": 0.3}
    for name, *where in itertools.product(
        levels, "ABCD", ("GF", "F3", "F5"), ("P", "NP")
    ):
        earthquake, floor, side = where
        a = levels[name] * np.exp(0.1 * rng.normal())
        about = f"synthetic {len(rows)},{name},{side},{earthquake},{floor}"
        rows.append(f"{about},{a:.4f},{1.05 * a:.4f},none,statue,1,")
    found = measured(tmp_path, rows)
    whole = found["measured/effects"].query("scope == 'whole'")["ratio"].iloc[0]
    assert 0.9 < whole < 1.1
    curves = found["measured/fragility"].set_index("configuration")["theta"]
    assert curves["T1"] > curves["T2"] > curves["T3"]


def test_with_friction_a_case_is_integrated_once_with_and_once_without_sliding(
    monkeypatch,
):
    runs = []

    def counted(cases):
        runs.append(cases.shape)
        return run_blocks(cases)

    monkeypatch.setattr(ensembles, "run_blocks", counted)
    shaking = 9.0 * np.sin(2 * np.pi * np.arange(100) / 100)
    motion = GroundMotion(Motion(shaking, 0.01, metadata={"floor": "hall"}))
    loose = system_of(STATUE, friction=0.2)
    table = ida_table(loose, [motion], np.array([0.1, 0.3, 0.6])).to_pandas()
    assert runs == [(1, 1, 3)]
    held = overturns(STATUE, motion, scales=np.array([0.1, 0.3, 0.6]) * 9.80665 / 9.0)
    rough = table["overturned_without_sliding"]
    assert rough.tolist() == held.overturned.ravel().tolist() == [False, True, True]
    assert not table["overturned"].any()


HELD = {
    # what is stated, what it is said to be held by, and whether statics of the free body say when it rocks
    "free": ({}, "", True),
    "wall": ({"wall_m": 0.03}, "wall 1", True),
    "touching": ({"wall_m": 0.0, "wall_left_m": 0.0}, "wall 1, wall 2", False),
    "slack": ({"cord_n_m": 1e5, "cord_slack_m": 0.01}, "tie 1, tie 2", True),
    # what stretches bears nothing before the body moves
    "taut": ({"cord_n_m": 1e5}, "tie 1, tie 2", True),
    "bracket": ({"bracket_n_m": 1e6, "bracket_n": 900.0}, "tie 1", True),
    "wax": ({"putty_n": 400.0}, "bond 1", False),
    "rolling": ({"casters": "free"}, "casters that roll", False),
    "isolated": ({"isolator": {"mass_kg": 9.0, "radius_m": 1.0}}, "", False),
}


@pytest.mark.parametrize("name", HELD)
def test_bodies_are_said_to_rock_from_where_a_pulse_lifts_them(name):
    """The table gave what is held the acceleration of the free block, and the floor under an isolator."""
    stated, held, like_free = HELD[name]
    system = held_as_stated(replace(STATUE.system(), name=name), stated)
    (row,) = tests_stage.bodies_table([system]).to_dict("records")
    assert row["held_by"] == held
    assert row["stands_on"] == ("isolator" if name == "isolated" else "")
    # a short constant acceleration of .97 and 1.03 times the width over the height, g/4
    rocks = []
    for part in (0.97, 1.03):
        pushed = Motion(np.r_[np.full(20, part * 9.81 / 4), np.zeros(5)], 0.01)
        found = overturns([system], [pushed])
        rocks.append(bool((found.peak_rotation > 1e-7).any()))
    assert np.isfinite(row["uplift_m_s2"]) == like_free == (rocks == [False, True])
    if like_free:
        assert row["uplift_m_s2"] == pytest.approx(9.81 / 4)
    results = SimpleNamespace(
        table=lambda _: tests_stage.bodies_table([system]),
        study=SimpleNamespace(slides=False, vertical=False),
    )
    section = tested.bodies(results)
    said = " ".join([section.message, *section.paragraphs, *section.parts])
    assert ("0.250" in said) == like_free and "nan" not in said
    assert ("simulation alone says" in said) != like_free
    assert ("Held by" in said) == bool(held) and f">{held}<" in said
