"""What a stage asks of the machine, and which stage goes first."""

from collections.abc import Sequence
from pathlib import Path

import pytest

from rockfrag.guests import study_stages
from rockfrag.stages.stage import Stage, priorities
from rockfrag.study.loading import load_any

from ..workflow.test_run import ROOT


def stage(
    name: str, inputs: Sequence[str], outputs: Sequence[str], parallel: bool = False
) -> Stage:
    return Stage(
        name=name, run=lambda job: iter(()), inputs=inputs, outputs=outputs, parallel=parallel
    )


def test_what_others_wait_for_goes_first_then_what_takes_long():
    stages = [
        stage("first", [], ["a"]),
        stage("short", ["a"], ["b"]),
        stage("long", ["a"], ["c"], parallel=True),
        stage("last", ["b", "c"], ["d"]),
    ]
    found = priorities(stages, None)
    assert sorted(found, key=lambda name: -found[name]) == ["first", "long", "short", "last"]
    assert found["first"] == 2 * 3


def test_the_sweep_does_not_wait_for_the_explanation():
    study = load_any(ROOT / "config" / "thesis.yaml")
    found = priorities(study_stages(study), study)
    assert found["sweep"] > found["tests"] > found["explanation"] > found["report"]


def test_a_stage_that_leaves_half_lets_another_run_beside_it():
    study = load_any(ROOT / "config" / "thesis.yaml")
    by_name = {one.name: one for one in study_stages(study)}
    assert [by_name["explanation"].threads(cores) for cores in (1, 2, 5, 16)] == [1, 1, 2, 8]
    assert [by_name["sweep"].threads(cores) for cores in (1, 2, 16)] == [1, 2, 16]
    assert by_name["tests"].threads(16) == 1


def test_what_the_report_sets_beside_is_declared_where_it_is_there(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    study = load_any(ROOT / "config" / "thesis.yaml")
    report = study_stages(study)[-1]
    monkeypatch.chdir(tmp_path)
    wide = Path("results") / "wide" / "pedestal" / "effects.parquet"
    without = report.user_files(study)
    wide.parent.mkdir(parents=True)
    wide.write_bytes(b"")
    assert report.user_files(study) == [*without, str(wide)]
    own = load_any(ROOT / "config" / "wide.yaml")
    assert str(wide) not in study_stages(own)[-1].user_files(own)
