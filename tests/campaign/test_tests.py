"""Tests of a campaign and motions of its table: read, commanded and conditioned, or refused in one sentence."""

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest

from rockfrag.base.errors import InputError
from rockfrag.base.units import GRAVITY
from rockfrag.campaign.comparison import REPEATS, majority_of_repeats
from rockfrag.campaign.laboratory import read_campaign, table_motions
from rockfrag.motions.processing import process
from rockfrag.motions.pulses import commanded_cosine
from rockfrag.report.campaign_findings import campaign_findings
from rockfrag.stages.campaign import trials_of
from rockfrag.study.loading import load_any
from rockfrag.system import mounts
from rockfrag.system.blocks import Block
from rockfrag.system.constraints import Wall
from rockfrag.system.mesh import Shape

COLUMNS = {"test": "test", "motion": "motion", "group": "input", "overturned": "fell"}
BRACKETED = {"test": "test", "motion": "motion", "lower_g": "low", "upper_g": "high"}
GOOD = "test,motion,input,fell,pga_g\nA,1,x,yes,0.2\nB,2,x,0,0.1\nC,3,y,1,0.3\n"


def table(folder, text, name="tests.csv") -> Path:
    path = folder / name
    path.write_text(text)
    return path


def test_a_table_of_outcomes_is_read(tmp_path):
    campaign = read_campaign(
        table(tmp_path, GOOD), COLUMNS, {"pga_m_s2": ["pga_g", 9.81]}
    )
    assert list(campaign.tests["overturned"]) == [True, False, True]
    assert list(campaign.tests["group"]) == ["x", "x", "y"]
    assert campaign.tests["pga_m_s2"].iloc[0] == pytest.approx(1.962)
    assert campaign.tests["amplitude_g"].isna().all()


def test_an_amplitude_of_overturning_makes_one_test_survived_and_one_overturned(
    tmp_path,
):
    text = "test,motion,low,high\nA,1,0.3,0.33\nB,2,0.5,0.6\n"
    tests = read_campaign(table(tmp_path, text), BRACKETED, {}).tests
    assert list(tests["overturned"]) == [False, False, True, True]
    assert list(tests["amplitude_g"]) == [0.3, 0.5, 0.33, 0.6]
    assert list(tests["group"]) == ["1", "2", "1", "2"]
    assert tests["test"].iloc[2] == "A at 0.33 g"


@pytest.mark.parametrize(
    ("text", "columns", "sentence"),
    [
        (GOOD.replace("B,2,x,0,0.1", "A,2,x,0,0.1"), COLUMNS, "test A stands twice"),
        (
            "test,motion,low,high\nA,1,0.3,0.2\n",
            BRACKETED,
            "row 2: lower_g is not below upper_g",
        ),
    ],
)
def test_a_bad_table_ends_in_one_sentence(tmp_path, text, columns, sentence):
    with pytest.raises(InputError, match=sentence):
        read_campaign(table(tmp_path, text), columns, {})


def test_outcomes_of_other_programs_follow_the_tests_as_far_as_they_are_given(tmp_path):
    codes = table(tmp_path, "test,dem,fem\nC,1,0\nA,0,1\n", "codes.csv")
    found = read_campaign(table(tmp_path, GOOD), COLUMNS, {}, codes).codes
    assert found["dem"].isna().tolist() == [False, True, False]
    assert found.dropna().to_dict("list") == {"dem": [0, 1], "fem": [1, 0]}
    others = table(tmp_path, "test,dem\nX,1\nY,0\n", "codes.csv")
    with pytest.raises(InputError, match="has none of the 3 tests"):
        read_campaign(table(tmp_path, GOOD), COLUMNS, {}, others)


def test_the_template_has_the_columns_of_a_campaign(tmp_path):
    template = (
        Path(__file__).parents[2] / "config" / "experiment" / "campaign-template.csv"
    )
    text = template.read_text() + "A,run1,wave,yes\n"
    columns = {name: name for name in ("test", "motion", "group", "overturned")}
    tests = read_campaign(table(tmp_path, text), columns, {}).tests
    assert tests[["test", "motion", "group"]].to_numpy().tolist() == [
        ["A", "run1", "wave"]
    ]
    assert tests["overturned"].all()


TIME = np.arange(0, 4, 0.005)
SHAKING = 0.3 * np.sin(2 * np.pi * 2 * TIME) * np.hanning(len(TIME))


def motions_of(path, names=("a",), unit="g", dt=0.005):
    return table_motions(str(path), names, unit, dt, None)


def archive(folder, motion: np.ndarray) -> Path:
    path = folder / "motions.npz"
    np.savez(path, a=motion)
    return path


def test_files_are_named_by_their_motion_and_tell_what_an_archive_of_them_does(
    tmp_path,
):
    for name, factor in (("a", 1.0), ("b", 2.0)):
        np.savetxt(
            tmp_path / f"Run_{name}.txt", np.column_stack([TIME, factor * SHAKING])
        )
    a, b = motions_of(tmp_path / "Run_{motion}.txt", ["a", "b"], dt=None)
    (of_archive,) = motions_of(archive(tmp_path, SHAKING))
    for motion, factor in ((of_archive, GRAVITY), (a, GRAVITY), (b, 2 * GRAVITY)):
        np.testing.assert_allclose(motion.acceleration, factor * SHAKING, atol=1e-6)
        assert motion.dt == pytest.approx(0.005)
    assert (a.name, b.name, of_archive.name) == ("a", "b", "a")


def test_the_laboratory_s_own_files_are_read_as_the_archive_holds_them(shared):
    folder = shared / "measured" / "granite"
    pattern, arrays = (
        f"{folder}/Test{{motion}}.txt",
        f"{folder}/table_accelerations.npz",
    )
    (text,) = table_motions(pattern, ["100"], "g", None, "Amplitude - Plot 0")
    (array,) = table_motions(arrays, ["100"], "g", 0.00125, None)
    assert text.dt == pytest.approx(array.dt)
    assert text.acceleration == pytest.approx(array.acceleration, abs=1e-5)


def test_conditioning_takes_away_offset_and_spikes(tmp_path):
    rng = np.random.default_rng(0)
    noisy = SHAKING + 0.001 * rng.standard_normal(len(TIME)) + 0.015
    noisy[300] = 4.0
    (read,) = motions_of(archive(tmp_path, noisy))
    motion = process(read, [{"step": "remove_median"}, {"step": "despike"}])
    # where the spike was stands a neighbour, which the slope of the motion sets apart
    slope = np.abs(np.diff(SHAKING)).max()
    np.testing.assert_allclose(motion.acceleration / GRAVITY, SHAKING, atol=slope)
    assert motion.provenance[-1]["replaced"] == 1


@pytest.mark.parametrize(
    ("factor", "options", "sentence"),
    [
        (65, {}, r"peaks at 19.* g, which no shake table reaches"),
        (1, {"names": ["a", "b"]}, "no motion for 1 of 2 tests, b first"),
        (1, {"unit": None}, "states neither unit nor interval"),
        (1, {"unit": "volt"}, "not a unit of acceleration"),
    ],
)
def test_what_is_missing_or_of_another_unit_is_said(
    tmp_path, factor, options, sentence
):
    with pytest.raises(InputError, match=sentence):
        motions_of(archive(tmp_path, factor * SHAKING), **options)


@pytest.mark.parametrize("content", [None, b"", b"PK\x03\x04 cut", b"no archive"])
def test_a_damaged_archive_or_one_with_python_objects_is_refused(tmp_path, content):
    path = archive(tmp_path, np.array([{"run": "code"}], dtype=object))
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(InputError, match="cannot be read"):
        motions_of(path)


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
"""Commanded pulses, whose motion follows from PGA and PGV/PGA."""

PULSES = "time,pga_g,pgv_over_pga_s,toppled\na,0.2,0.1,0\nb,0.2,0.1,1\nc,0.2,0.05,1\nd,0.5,0.1,1\n"


def test_the_commanded_motion_has_its_pga_and_pgv_and_comes_to_rest():
    motion = commanded_cosine(3.0, 0.1)
    a = motion.acceleration
    velocity = np.cumsum((a[1:] + a[:-1]) / 2) * motion.dt
    assert motion.pga == pytest.approx(3.0, rel=1e-4)
    assert np.abs(velocity).max() == pytest.approx(0.3, rel=1e-3)
    assert abs(velocity[-1]) < 1e-9
    assert motion.acceleration.size * motion.dt == pytest.approx(
        2 * np.pi * 0.1, rel=0.01
    )
    assert commanded_cosine(3.0, 0.1, 3).acceleration.size == pytest.approx(
        3 * a.size, rel=0.01
    )


def test_a_table_of_pulses_is_a_campaign_whose_tests_of_one_setting_share_a_motion(
    tmp_path,
):
    table(tmp_path, PULSES)
    study = load_any(table(tmp_path, STUDY, "study.yaml"))
    assert study.pulse_cycles == 1 and study.motions == ""
    tests = read_campaign(study.tests, study.columns, study.measures).tests
    assert pd.factorize(tests["motion"])[0].tolist() == [0, 0, 1, 2]
    assert (tests["group"] == tests["motion"]).all()


@pytest.mark.parametrize(
    ("old", "new", "sentence"),
    [
        ("    pgv_over_pga_s: [pgv_over_pga_s]\n", "", "pgv_over_pga_s is missing"),
        ("  motions: {pulse: cosine}", "  motions: {pulse: square}", "motions.pulse"),
        (
            "  motions: {pulse: cosine}",
            "  motions: {pulse: cosine}\n  unit: g",
            "measured motions",
        ),
        ("  motions: {pulse: cosine}", "  motions: m.npz", "motion is missing"),
    ],
)
def test_what_a_pulse_does_not_follow_from_is_said(tmp_path, old, new, sentence):
    table(tmp_path, PULSES)
    with pytest.raises(InputError, match=sentence):
        load_any(table(tmp_path, STUDY.replace(old, new), "study.yaml"))


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


def test_the_ceiling_is_no_rival():
    row = {
        "right": 0.9,
        "better": 0.1,
        "better_lower": 0.02,
        "better_upper": 0.2,
        "p": 0.001,
    }
    row |= {
        "lower": 0.8,
        "upper": 0.95,
        "tests": 60,
        "false_alarms": 3.0,
        "missed": 3.0,
    }
    ceiling, rival = (
        row | {"who": REPEATS, "right": 1.0},
        row | {"who": "threshold on PGV"},
    )
    tables = {
        "fragility": pd.DataFrame(
            {
                "who": ["measured"],
                "measure": "pga_g",
                "beta": 0.4,
                "theta_ratio": np.nan,
            }
        ),
        "tests": pd.DataFrame({"near_critical": [False], "right": [True]}),
    }
    for others, said in (
        ([ceiling], []),
        ([rival, ceiling], ["threshold on PGV, the best of 1 alternative"]),
    ):
        agreement = pd.DataFrame([row | {"who": "rockfrag"}, *others])
        found = campaign_findings(tables | {"agreement": agreement})[1:]
        assert len(found) == len(said)
        assert all(
            words in finding.headline
            for words, finding in zip(said, found, strict=True)
        )


def test_the_trials_of_a_held_object_are_held():
    held = {"wall_m": 0.02, "putty_n": 50.0}
    study = SimpleNamespace(
        object={"held": held},
        unknowns={"edge_retreat_mm": (0.0, 5.0), "restitution": (0.8, 1.0)},
        seed=1,
    )
    found = trials_of(Block(0.3, 1.2, 100.0), study, 8)
    assert {each.holding for each in found.systems} == {("wall 1", "bond 1")}
    for each in found.systems:
        gap = each.constraints[0].distance - mounts.reach(each, 1)
        assert gap == pytest.approx(0.02)
    held["putty_spread_m"] = 0.15
    with pytest.raises(InputError, match=r"^object: held: Bond: spread: the pads lie"):
        trials_of(Block(0.3, 1.2, 100.0), study, 8)


def test_the_planar_rival_of_a_held_mesh_is_held_as_the_mesh_is():
    """The rival "in one plane" was the free object."""
    corners = np.array(
        [(x, y, z) for x in (-0.2, 0.2) for y in (-0.05, 0.05) for z in (-0.6, 0.6)]
    )
    stone = Shape(corners, 100.0, 9.0 * np.eye(3), 0.1, "stone.obj")
    study = SimpleNamespace(
        object={"held": {"wall_m": 0.02, "cord_n_m": 1e4, "putty_n": 50.0}},
        unknowns={
            **{"direction_deg": (0.0, 0.0), "contact_tolerance_mm": (0.1, 0.2)},
            **{"edge_retreat_mm": (0.0, 0.0), "friction": (0.4, 0.5)},
            "restitution": (0.8, 1.0),
        },
        seed=1,
    )
    found = trials_of(stone, study, 4)
    for solid, flat in zip(found.systems, found.planar, strict=True):
        names = ("wall 1", "tie 2", "tie 3", "bond 1")
        assert not solid.planar and flat.planar
        assert solid.holding == flat.holding == names
        for ours, theirs in zip(flat.constraints, solid.constraints, strict=True):
            places = ("distance",) if isinstance(ours, Wall) else ("point", "anchor")
            for name in places:
                assert getattr(ours, name) == pytest.approx(getattr(theirs, name))
        ((_, ours),), ((_, theirs),) = flat.bonds, solid.bonds
        assert ours.tension == theirs.tension == 50.0
        assert ours.pads[0] == pytest.approx(theirs.pads[0]) == pytest.approx(0.2)
        assert theirs.pads[1] == pytest.approx(0.05)
