"""Scores of what was said blind: proper, clustered, and a page that says who is better."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from rockfrag import Block
from rockfrag.campaign.scores import (
    brier,
    log_score,
    mean_limits,
    said_of_arrangements,
    scores_table,
)
from rockfrag.motions import one_sine
from rockfrag.motions.intensity import pgv
from rockfrag.records.motion import GroundMotion, Motion
from rockfrag.records.velocity_steps import bump_and_stop
from rockfrag.simulation.rules_of_thumb import kaneko, peak_velocity, static
from rockfrag.stages.scores import (
    HEAD,
    OURS,
    as_accelerations,
    bare_tests,
    main,
    nodes,
    page_of,
    who_is_better,
)
from rockfrag.study.loading import load_any

from .conftest import configured


def test_the_truth_scores_best_of_all_that_could_be_said():
    random = np.random.default_rng(5)
    truth = random.uniform(0.05, 0.95, 4000)
    happened = random.random(4000) < truth
    for score in (brier, log_score):
        best = score(truth, happened).mean()
        for other in (np.full(4000, 0.5), truth**2, 1 - truth, np.sqrt(truth)):
            assert score(other, happened).mean() > best


def test_a_coin_scores_what_the_page_says():
    coin, happened = np.full(10, 0.5), np.arange(10) % 2 == 0
    assert log_score(coin, happened).mean() == pytest.approx(0.693, abs=5e-4)
    assert brier(coin, happened).mean() == 0.25


def test_nobody_is_taken_to_be_sure_and_no_arrangement_makes_it_so():
    assert np.isfinite(log_score(np.zeros(2), np.array([True, False]))).all()
    said = said_of_arrangements(np.array([[True, False]] * 9))
    assert said.tolist() == [0.95, 0.05]


def test_tests_of_one_motion_count_together():
    """Limits of a mean of copies are those of the originals, not narrower."""
    values = np.random.default_rng(2).standard_normal(30)
    alone = mean_limits(values, np.arange(30))
    copied = mean_limits(np.repeat(values, 7), np.repeat(np.arange(30), 7))
    assert copied == pytest.approx(alone, rel=1e-9)


def table_of(better: float) -> pd.DataFrame:
    random = np.random.default_rng(7)
    truth = random.uniform(0.02, 0.98, 600)
    happened = random.random(600) < truth
    blurred = 0.5 + better * (truth - 0.5)
    return scores_table(
        {OURS: np.full(600, 0.5), "rule": blurred}, happened, np.arange(600)
    )


def test_the_page_says_that_a_rule_is_better_where_it_is():
    assert "**Better than the simulation: rule.**" in who_is_better(table_of(1.0))
    assert "Worse: rule." in who_is_better(table_of(-1.0))
    assert "Not told apart" in who_is_better(table_of(0.0))
    page = page_of({"made": table_of(1.0)})
    assert "## made: 600 tests" in page
    assert "**Better than the simulation: rule.**" in page


@pytest.mark.parametrize("count", [3, 5])
def test_errors_of_the_model_are_spread_as_a_normal_one(count):
    assert nodes(count).mean() == pytest.approx(0, abs=1e-12)
    assert nodes(count).std() == pytest.approx(1)


def test_tests_without_an_object_are_said_by_the_curves_of_others_alone(
    tmp_path, laboratory, capsys
):
    file = tmp_path / "bare.csv"
    rows = [f"{peak},{ratio},{'yes' if peak * ratio > 0.02 else 'no'}"
            for peak in (0.05, 0.2, 0.5) for ratio in (0.03, 0.1, 0.3)]  # fmt: skip
    file.write_text("\n".join(["pga_g,pgv_over_pga_s,toppled", *rows]))
    assert bare_tests(str(file)).peaks.max() == pytest.approx(0.15 * 9.81)
    study, page = str(configured(tmp_path, laboratory)), tmp_path / "scores.md"
    given = [study, "--tests", str(file), "--page", str(page), "--arrangements", "4"]
    assert main(given) == 0
    name = load_any(study).name
    own, bare = page.read_text().split("## ")[1:]
    assert "measured curve of bare" in own
    assert f"measured curve of {name}" in bare
    assert "a coin | 0.693 | 0.250" in bare
    assert "Nobody wrote down shape or size" in bare


def test_the_page_in_the_docs_is_of_all_campaigns_and_of_the_errors_that_stand():
    page = (Path(__file__).parents[2] / "docs" / "scores.md").read_text()
    for name in ("granite: 490 tests", "oxford: 45 tests", "shakebot: 83 tests"):
        assert f"## {name}" in page
    assert page.startswith(HEAD)
    assert "rockfrag, in space |" in page


def test_rules_see_a_jump_as_a_velocity():
    motion = as_accelerations(
        GroundMotion(Motion(np.zeros(2), 0.005), steps=bump_and_stop(0.3, 0.02))
    )
    assert pgv(motion) == pytest.approx(0.3, rel=1e-6)
    block = Block(0.2, 0.9, 50.0)
    assert peak_velocity(block, motion) == pytest.approx(
        peak_velocity(block, one_sine(1.0, 0.6)) * pgv(one_sine(1.0, 0.6)) / 0.3
    )
    assert static(block, motion) < 0.01
    assert kaneko(block, motion) > 1


def test_the_command_scores_a_synthetic_laboratory(tmp_path, laboratory, capsys):
    page = tmp_path / "scores.md"
    study = str(configured(tmp_path, laboratory))
    assert main([study, "--page", str(page), "--arrangements", "4"]) == 0
    said = capsys.readouterr().out
    for who in (OURS, "ASCE 43-05", "Kaneko", "peak velocity", "static b/h"):
        assert who in said
        assert who in page.read_text()
    assert main([str(tmp_path / "absent.yaml")]) == 2
