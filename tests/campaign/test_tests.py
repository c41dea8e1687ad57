"""Tests of a campaign and motions of its table: read and conditioned, or refused in one sentence."""

from pathlib import Path

import numpy as np
import pytest

from rockfrag.campaign.laboratory import read_campaign, table_motions
from rockfrag.errors import InputError
from rockfrag.motions.processing import process
from rockfrag.units import GRAVITY

COLUMNS = {"test": "test", "motion": "motion", "group": "input", "overturned": "fell"}
BRACKETED = {"test": "test", "motion": "motion", "lower_g": "low", "upper_g": "high"}
GOOD = "test,motion,input,fell,pga_g\nA,1,x,yes,0.2\nB,2,x,0,0.1\nC,3,y,1,0.3\n"


def table(folder, text, name="tests.csv") -> Path:
    path = folder / name
    path.write_text(text)
    return path


def test_a_table_of_outcomes_is_read(tmp_path):
    campaign = read_campaign(table(tmp_path, GOOD), COLUMNS, {"pga_m_s2": ["pga_g", 9.81]})
    assert list(campaign.tests["overturned"]) == [True, False, True]
    assert list(campaign.tests["group"]) == ["x", "x", "y"]
    assert campaign.tests["pga_m_s2"].iloc[0] == pytest.approx(1.962)
    assert campaign.tests["amplitude_g"].isna().all()


def test_an_amplitude_of_overturning_makes_one_test_survived_and_one_overturned(tmp_path):
    text = "test,motion,low,high\nA,1,0.3,0.33\nB,2,0.5,0.6\n"
    tests = read_campaign(table(tmp_path, text), BRACKETED, {}).tests
    assert list(tests["overturned"]) == [False, False, True, True]
    assert list(tests["amplitude_g"]) == [0.3, 0.5, 0.33, 0.6]
    assert list(tests["group"]) == ["1", "2", "1", "2"]
    assert tests["test"].iloc[2] == "A at 0.33 g"


@pytest.mark.parametrize(
    ("wrong", "right", "sentence"),
    [
        ("B,2,x,0,0.1", "A,2,x,0,0.1", "test A stands twice"),
        ("B,2,x,0,0.1", "B,2,x,perhaps,0.1", "no outcome"),
        ("B,2,x,0,0.1", "B,2,x,0,-1", "above zero"),
        ("B,2,x,0,0.1", "B,,x,0,0.1", "label is missing"),
        ("fell", "outcome", "there is no column 'fell'"),
    ],
)
def test_a_bad_table_ends_in_one_sentence(tmp_path, wrong, right, sentence):
    path = table(tmp_path, GOOD.replace(wrong, right))
    with pytest.raises(InputError, match=sentence):
        read_campaign(path, COLUMNS, {"pga_g": ["pga_g"]})


def test_an_object_that_fell_below_what_it_survived_is_refused(tmp_path):
    with pytest.raises(InputError, match="row 2: lower_g is not below upper_g"):
        read_campaign(table(tmp_path, "test,motion,low,high\nA,1,0.3,0.2\n"), BRACKETED, {})


def test_outcomes_of_other_programs_follow_the_tests_as_far_as_they_are_given(tmp_path):
    codes = table(tmp_path, "test,dem,fem\nC,1,0\nA,0,1\n", "codes.csv")
    found = read_campaign(table(tmp_path, GOOD), COLUMNS, {}, codes).codes
    assert found["dem"].isna().tolist() == [False, True, False]
    assert found.dropna().to_dict("list") == {"dem": [0, 1], "fem": [1, 0]}


def test_a_table_of_other_tests_is_refused(tmp_path):
    codes = table(tmp_path, "test,dem\nX,1\nY,0\n", "codes.csv")
    with pytest.raises(InputError, match="has none of the 3 tests"):
        read_campaign(table(tmp_path, GOOD), COLUMNS, {}, codes)


def test_the_template_has_the_columns_of_a_campaign(tmp_path):
    template = Path(__file__).parents[2] / "config" / "experiment" / "campaign-template.csv"
    text = template.read_text() + "A,run1,wave,yes\n"
    columns = {name: name for name in ("test", "motion", "group", "overturned")}
    tests = read_campaign(table(tmp_path, text), columns, {}).tests
    assert tests[["test", "motion", "group"]].to_numpy().tolist() == [["A", "run1", "wave"]]
    assert tests["overturned"].all()


TIME = np.arange(0, 4, 0.005)
SHAKING = 0.3 * np.sin(2 * np.pi * 2 * TIME) * np.hanning(len(TIME))


def motions_of(path, names=("a",), unit="g", dt=0.005):
    return table_motions(str(path), names, unit, dt, None)


def archive(folder, **motions: np.ndarray) -> Path:
    path = folder / "motions.npz"
    np.savez(path, **motions)
    return path


def test_an_archive_is_read_in_its_unit(tmp_path):
    (motion,) = motions_of(archive(tmp_path, a=SHAKING))
    assert motion.dt == 0.005
    np.testing.assert_allclose(motion.acceleration, SHAKING * GRAVITY)


def test_files_are_named_by_their_motion(tmp_path):
    for name, factor in (("a", 1.0), ("b", 2.0)):
        np.savetxt(tmp_path / f"Run_{name}.txt", np.column_stack([TIME, factor * SHAKING]))
    a, b = motions_of(tmp_path / "Run_{motion}.txt", ["a", "b"], dt=None)
    np.testing.assert_allclose(b.acceleration, 2 * a.acceleration, atol=1e-6)
    assert (a.name, b.name) == ("a", "b")


def test_conditioning_takes_away_offset_and_spikes(tmp_path):
    rng = np.random.default_rng(0)
    noisy = SHAKING + 0.001 * rng.standard_normal(len(TIME)) + 0.015
    noisy[300] = 4.0
    steps = [{"step": "remove_median"}, {"step": "despike"}]
    (read,) = motions_of(archive(tmp_path, a=noisy))
    motion = process(read, steps)
    # where the spike was stands a neighbour, which the slope of the motion sets apart
    slope = np.abs(np.diff(SHAKING)).max()
    np.testing.assert_allclose(motion.acceleration / GRAVITY, SHAKING, atol=slope)
    assert motion.provenance[-1]["replaced"] == 1


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        ({"names": ["a", "b"]}, "no motion for 1 of 2 tests, b first"),
        ({"unit": None}, "states neither unit nor interval"),
        ({"unit": "V"}, "not a unit of acceleration"),
        ({"unit": "volt"}, "not a unit of acceleration"),
    ],
)
def test_what_is_missing_is_asked_for(tmp_path, options, sentence):
    path = archive(tmp_path, a=SHAKING)
    with pytest.raises(InputError, match=sentence):
        motions_of(path, **options)


def test_a_motion_in_volts_is_too_large_for_any_table(tmp_path):
    with pytest.raises(InputError, match=r"peaks at 19.* g, which no shake table reaches"):
        motions_of(archive(tmp_path, a=65 * SHAKING))


@pytest.mark.parametrize("content", [None, b"", b"PK\x03\x04 cut", b"no archive"])
def test_a_damaged_archive_or_one_with_python_objects_is_refused(tmp_path, content):
    path = archive(tmp_path, a=np.array([{"run": "code"}], dtype=object))
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(InputError, match="cannot be read"):
        motions_of(path)
