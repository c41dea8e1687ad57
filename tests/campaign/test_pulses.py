"""Campaigns of commanded pulses: the motion follows from PGA and PGV/PGA, and repeats tell the ceiling."""

import numpy as np
import pandas as pd
import pytest

from rockfrag.campaign.comparison import REPEATS, majority_of_repeats
from rockfrag.campaign.laboratory import read_campaign
from rockfrag.errors import InputError
from rockfrag.motions.pulses import commanded_cosine
from rockfrag.report.campaign_page import _findings
from rockfrag.study.loading import load_any

STUDY = """
study: pulses
title: A small rock under single cosines
seed: 1
campaign:
  tests: tests.csv
  columns: {test: time, overturned: toppled}
  motions: {pulse: cosine}
  measures:
    pga_g: [pga_g]
    pgv_over_pga_s: [pgv_over_pga_s]
object: {left_m: 0.03, right_m: 0.035, cg_height_m: 0.1, height_m: 0.2, mass_kg: 2.0, inertia_kg_m2: 0.008}
unknowns: {edge_retreat_mm: [0, 5], restitution: [0.7, 1.0]}
trials: 32
folds: 3
repeats: 2
"""


@pytest.fixture
def study(tmp_path):
    rng = np.random.default_rng(4)
    pga = rng.choice([0.2, 0.35, 0.5, 0.8], 60)
    ratio = rng.choice([0.05, 0.1, 0.2], 60)
    fell = (np.log(pga) + 0.7 * np.log(ratio) + rng.normal(0, 0.2, 60) > -2.6).astype(int)
    table = pd.DataFrame(
        {
            "time": [f"t{i}" for i in range(60)],
            "pga_g": pga,
            "pgv_over_pga_s": ratio,
            "toppled": fell,
        }
    )
    table.to_csv(tmp_path / "tests.csv", index=False)
    path = tmp_path / "study.yaml"
    path.write_text(STUDY)
    return path


def test_the_commanded_motion_has_its_pga_and_pgv_and_comes_to_rest():
    motion = commanded_cosine(3.0, 0.1)
    a = motion.acceleration
    velocity = np.cumsum((a[1:] + a[:-1]) / 2) * motion.dt
    assert motion.pga == pytest.approx(3.0, rel=1e-4)
    assert np.abs(velocity).max() == pytest.approx(0.3, rel=1e-3)
    assert abs(velocity[-1]) < 1e-9
    assert motion.acceleration.size * motion.dt == pytest.approx(2 * np.pi * 0.1, rel=0.01)
    assert commanded_cosine(3.0, 0.1, 3).acceleration.size == pytest.approx(3 * a.size, rel=0.01)


def test_tests_of_one_setting_share_motion_and_group(study):
    table = read_campaign(
        study.parent / "tests.csv",
        {"test": "time", "overturned": "toppled"},
        {"pga_g": ["pga_g"], "pgv_over_pga_s": ["pgv_over_pga_s"]},
    ).tests
    assert table["motion"].nunique() == 12
    assert (table["group"] == table["motion"]).all()


def test_the_majority_of_repeats_is_the_ceiling_of_any_model_of_the_setting():
    settings = np.array(["a", "a", "a", "b", "c", "c"])
    measured = np.array([True, True, False, False, False, True])
    majority = majority_of_repeats(settings, measured)
    assert (majority == measured).sum() == 4
    for guess in range(8):
        by_setting = {name: bool(guess >> k & 1) for k, name in enumerate("abc")}
        model = np.array([by_setting[name] for name in settings])
        assert (model == measured).sum() <= 4
    assert majority_of_repeats(np.array(["a", "b"]), np.array([True, False])) is None


def test_a_table_of_pulses_is_a_campaign_by_itself(study):
    loaded = load_any(study)
    assert loaded.pulse_cycles == 1 and loaded.motions == ""


@pytest.mark.parametrize(
    ("old", "new", "sentence"),
    [
        ("    pgv_over_pga_s: [pgv_over_pga_s]\n", "", "pgv_over_pga_s is missing"),
        ("  motions: {pulse: cosine}", "  motions: {pulse: square}", "cosine"),
        ("  motions: {pulse: cosine}", "  motions: {pulse: cosine}\n  unit: g", "measured motions"),
        ("  motions: {pulse: cosine}", "  motions: m.npz", "motion is missing"),
    ],
)
def test_what_a_pulse_does_not_follow_from_is_said(study, old, new, sentence):
    study.write_text(STUDY.replace(old, new))
    with pytest.raises(InputError, match=sentence):
        load_any(study)


def test_the_ceiling_is_no_rival():
    row = {"right": 0.9, "better": 0.1, "better_lower": 0.02, "better_upper": 0.2, "p": 0.001}
    row |= {"lower": 0.8, "upper": 0.95, "tests": 60, "false_alarms": 3.0, "missed": 3.0}
    rivals = [row | {"who": "threshold on PGV"}, row | {"who": REPEATS, "right": 1.0}]
    tables = {
        "fragility": pd.DataFrame(
            {"who": ["measured"], "measure": "pga_g", "beta": 0.4, "theta_ratio": np.nan}
        ),
        "tests": pd.DataFrame({"near_critical": [False], "right": [True]}),
    }
    for others, said in ((rivals, "threshold on PGV, the best of 1 alternative"), (rivals[1:], "")):
        agreement = pd.DataFrame([row | {"who": "rockfrag"}, *others])
        found = _findings(tables | {"agreement": agreement})[1:]
        assert len(found) == bool(said)
        assert all(said in finding.headline for finding in found)
