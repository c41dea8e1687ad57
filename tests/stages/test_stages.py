"""Stages: IDA curves, curves by floor, and forces of a sample of tests that each has by itself."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest

from rockfrag.fragility.empirical import TableIda
from rockfrag.fragility.ida_curves import with_measures
from rockfrag.records.motion import Motion
from rockfrag.stages import tests as tests_stage
from rockfrag.stages.fragility import export_curves, floor_curves
from rockfrag.stages.ida import as_recorded
from rockfrag.stages.pedestal import pedestal_tables
from rockfrag.study.study import Amplitudes
from rockfrag.system.blocks import Block, Stack

STATUE = Block(0.2, 0.8, 50.0)
FLOORS = {"hall": 0, "loft": 2}


MEASURES = ("pga_g", "pgv_cm_s", "sa_0_3s_g", "sa_1_0s_g", "avgsa_g")


def ida_of(motion, earthquake, floor, **capacities):
    """The IDA curve of a statue that reaches each state above a capacity."""
    amplitude = np.geomspace(0.1, 2.0, 60)
    about = {"configuration": "statue", "motion": motion, "earthquake": earthquake, "floor": floor}
    reached = {state: amplitude > capacity for state, capacity in capacities.items()}
    return pd.DataFrame({"amplitude_g": amplitude} | about | reached)


@pytest.fixture
def curves():
    """Eight motions on two floors; the loft shakes twice as long, so bodies fall at lower peaks."""
    rng = np.random.default_rng(3)
    rows, measures = [], []
    for k in range(8):
        for floor in FLOORS:
            name = f"m{k}_{floor}"
            peak = 0.3 * np.exp(0.2 * rng.normal())
            velocity = 60 * peak * np.exp(0.2 * rng.normal())
            measures.append((name, peak, velocity, 2 * peak, peak, peak))
            capacity = (0.6 if floor == "hall" else 0.4) * np.exp(0.2 * rng.normal())
            rows.append(ida_of(name, f"e{k}", floor, overturned=capacity))
    ida, measures = pd.concat(rows), pd.DataFrame(measures, columns=["name", *MEASURES])
    columns = [name for name in measures if name not in ("name", "floor")]
    ida_curves = {
        ("statue", str(floor)): TableIda(with_measures(part, measures, columns))
        for floor, part in ida.groupby("floor", sort=False)
    }
    study = SimpleNamespace(
        floors=FLOORS,
        configurations=[replace(STATUE.system(), name="statue")],
        fragility=SimpleNamespace(confidence=0.90),
        **{"slides": False, "vertical": False},
    )
    return floor_curves({"overturns": ida_curves}, measures, study, "abc")[0]


def test_floors_never_share_a_curve_and_measures_are_named_after_them(curves):
    names = curves.groupby("floor")["im"].unique()
    assert set(names["hall"]) == {"PGA", "PGV", "SA(0.3s)", "SA(1s)", "AvgSA"}
    assert set(names["loft"]) == {"PFA", "PFV"}
    fallen = curves[curves.state == "overturns"].set_index(["floor", "measure"])
    assert (fallen.n_motions == 8).all()
    assert fallen.loc[("hall", "pga_g"), "theta"] == pytest.approx(0.6, rel=0.2)
    assert fallen.loc[("loft", "pga_g"), "theta"] == pytest.approx(0.4, rel=0.2)


def test_rocking_starts_at_b_over_h_and_varies_in_other_measures(curves):
    rocks = curves[(curves.state == "rocks") & (curves.floor == "hall")].set_index("measure")
    assert rocks.loc["pga_g", "theta"] == pytest.approx(0.2 / 0.8)
    assert rocks.loc["pgv_cm_s", "theta"] == pytest.approx(60 * 0.25, rel=0.2)
    assert 0.05 < rocks.loc["pgv_cm_s", "beta"] < 0.5


def test_files_are_one_per_floor_and_measure(curves, tmp_path):
    written = export_curves(curves, tmp_path)
    assert {"fragility_pga.xml", "fragility_avgsa.xml", "fragility_pfa_loft.csv"} <= set(written)
    assert not [name for name in written if name.endswith(".xml") and "loft" in name]
    assert all((tmp_path / name).exists() for name in written)
    assert "Peak Floor Acceleration" in (tmp_path / "fragility_pfa_loft.csv").read_text()


def test_of_many_tests_some_evenly_among_them_are_looked_at(monkeypatch, noise):
    monkeypatch.setattr(tests_stage, "MOST_TESTED", 4)
    known = {f"m{k}": noise(k, 300, 0.02, tapered=True) for k in range(10)}
    about = {"configuration": "T", "object": "T", "pedestal": "NP", "earthquake": "e", "floor": "g"}
    tests = pd.DataFrame({"motion": [*known], "test": [*known], **about, "amplitude_g": 0.4})
    table = tests_stage.validity_table(tests, [replace(STATUE.system(), name="T")], known)
    assert list(table["motion"]) == ["m0", "m2", "m5", "m7"]


def test_amplitudes_grow_by_the_step_up_to_the_highest():
    values = Amplitudes(0.5, 2.0, 100).values_g
    assert values == pytest.approx([0.5, 1.0, 2.0])
    values = Amplitudes(0.2, 1.0, 10).values_g
    assert values[1:] / values[:-1] == pytest.approx(1.1)


def test_a_statue_that_its_pedestal_carries_along_rocks_and_does_not_stay():
    time, about = np.arange(300) * 0.01, {"earthquake": "E", "floor": "ground"}
    waves = [
        Motion(6 * np.sin(2 * np.pi * f * time) * (time < 1.5), 0.01, f"{f} Hz", about)
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
    about = {"object": "T1", "floor": "GF", "definition": "step_protocol", "censored": "none"}
    return pd.DataFrame(rows, columns=names).assign(**about)


def test_the_pedestal_effect_of_a_study_with_one_floor_is_estimated():
    # variances of earthquakes and of motions cannot be told apart there
    found = pedestal_tables(pairs("AABBCD"), seed=1, slenderness={"T1": 3.0})
    whole = found["effects"].set_index("scope").loc["whole"]
    assert whole["ratio"] == pytest.approx(1.05, abs=0.01)
    assert len(found["pairs"]) == 6


def test_a_reading_without_any_pair_leaves_the_numbers_of_the_others_numbers():
    # one motion: neither limits nor p values; a table that follows no motion: no effect at all
    known, other = pairs("A", 0.0), pairs("A", 0.0).assign(definition="step_protocol_shaker")
    other = other.assign(censored="right", upper_g=np.inf)
    found = pedestal_tables(pd.concat([known, other]), seed=1, slenderness={"T1": 3.0})
    assert found["effects"]["lower"].dtype == float
