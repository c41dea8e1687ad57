"""How far a study scales its motions: what is too weak is left out by name, drift and factors are said."""

import shutil

import numpy as np
import pandas as pd
import pytest

from rockfrag.report.findings import scaled_far
from rockfrag.report.sections.tested import drift_words, scaling_words
from rockfrag.stages import motions as motions_stage
from rockfrag.study.loading import check_records, load_any

from ..stages_in_process import run_stages
from ..workflow.conftest import make_study, study_content, write_study


@pytest.fixture
def folder(tmp_path):
    """A study of which one record peaks at 0.0012 g, and one ends with a drift."""
    folder = make_study(tmp_path / "study")
    time = np.arange(800) * 0.01
    small = 0.0012 * np.sin(2 * np.pi * time) * (time < 4)
    drifting = 0.25 * np.sin(2 * np.pi * time) * (time < 4) + 0.02 * (time < 6)
    for name, values in (("record1", small), ("record2", drifting)):
        rows = [f"{t:.2f} {a:.7f}" for t, a in zip(time, values, strict=True)]
        (folder / f"{name}.txt").write_text("\n".join(rows) + "\n")
    shutil.copy(folder / "motions.csv", folder / "all.csv")
    return folder


def _measured(study, folder):
    return run_stages(study, folder / "results", [motions_stage.run])


def test_a_motion_too_weak_at_the_lowest_amplitude_is_left_out_with_its_factor(folder):
    path = write_study(folder, study_content())
    study = load_any(path)
    said = check_records(study)
    (weak,) = [line for line in said if "will be left out" in line]
    # 0.2 g over 0.0012 g
    assert "motion 1" in weak and "167 times" in weak and "largest_factor" in weak
    results = _measured(study, folder)
    left_out = pd.read_csv(results / "left_out.csv")
    assert list(left_out["motion"]) == ["motion 1"]
    assert "167 times the motion, more than 10" in left_out["reason"][0]
    scaling = pd.read_csv(results / "scaling.csv", keep_default_na=False)
    assert len(scaling) == 5 and "motion 1_ground" not in set(scaling["motion"])
    assert np.allclose(scaling["factor_lowest"] * scaling["pga_g"], 0.2)
    flags = scaling.set_index("motion")["quality_flags"]
    assert "a drift" in flags["motion 2_ground"] and "drift" not in flags.iloc[0]


def test_the_limit_of_the_factor_can_be_lifted(folder):
    content = study_content()
    content["motions"]["largest_factor"] = None
    study = load_any(write_study(folder, content))
    assert not [line for line in check_records(study) if "left out" in line]
    results = _measured(study, folder)
    assert pd.read_csv(results / "left_out.csv").empty
    scaling = pd.read_csv(results / "scaling.csv")
    highest = study.amplitudes.values_g[-1]
    assert scaling["factor_highest"].max() == pytest.approx(highest / 0.0012, rel=1e-2)


def test_a_second_component_without_a_row_is_said_to_shake_nothing(folder):
    rows = (folder / "all.csv").read_text().splitlines()
    rows = [f"{rows[0]},second", *(f"{row}," for row in rows[1:])]
    # the second of motion 0 has a row (record1), that of motion 3 has none
    rows[1] += "record1.txt"
    rows[4] += "record9.txt"
    shutil.copy(folder / "record5.txt", folder / "record9.txt")
    (folder / "motions.csv").write_text("\n".join(rows) + "\n")
    said = check_records(load_any(write_study(folder, study_content())))
    (line,) = [line for line in said if "second component" in line]
    assert "of motion 3 has no row" in line


def test_words_say_how_many_tests_needed_large_factors_and_what_drifts():
    scaling = pd.DataFrame(
        {
            "motion": ["a", "b"],
            "pga_g": [0.4, 0.02],
            "factor_lowest": [0.5, 10.0],
            "factor_highest": [5.0, 100.0],
            "quality_flags": ["", "a drift: 97 % of the peak velocity is left"],
        }
    )
    tests = pd.DataFrame({"motion": ["a", "b", "b"], "upper_g": [0.9, 0.3, np.nan]})
    assert "1 of 2 tests" in (words := scaled_far(scaling, tests))
    assert "15 times: b" in words
    assert scaled_far(scaling, tests[tests["motion"] == "a"]) == ""
    assert "from 0.5 to 100" in (words := scaling_words(scaling))
    assert "1 of 2 motions is scaled by more than 10" in words
    assert "1 of 2 motions (b) ends with a drift" in drift_words(scaling)
    assert drift_words(scaling[:1]) == ""
