"""Trials chosen by some motions and judged by others; rivals; intervals that know that tests share a motion."""

import numpy as np
import pandas as pd
import pytest

from rockfrag.base.errors import InputError
from rockfrag.campaign.comparison import (
    MeasuredTests,
    best_threshold,
    by_region,
    clustered_error,
    plausible_trials,
)
from rockfrag.campaign.laboratory import check_peaks, measured_peaks
from rockfrag.campaign.standing import preferred_edges
from rockfrag.records.motion import Motion

RNG = np.random.default_rng(11)


def test_the_clustered_error_is_that_of_one_value_a_motion():
    values = RNG.standard_normal(50)
    plain = values.std(ddof=1) / np.sqrt(50)
    # copies of a test tell nothing new
    for copies in (1, 5):
        groups = np.repeat(np.arange(50), copies)
        assert clustered_error(np.repeat(values, copies), groups) == pytest.approx(
            plain
        )
    assert np.isnan(clustered_error(values, np.zeros(50, dtype=int)))


def test_folds_never_split_a_motion():
    groups = RNG.integers(0, 17, 200)
    outside = np.array(
        [part for _, part in MeasuredTests(groups > 8, groups, 1, 5, 1).divisions()]
    )
    assert (outside.sum(axis=0) == 4).all() and not outside.all(axis=1).any()
    for group in range(17):
        assert len(np.unique(outside[:, groups == group], axis=1).T) == 1


def test_the_true_trial_is_found_and_noise_is_not_rewarded_by_the_choice():
    truth, groups = RNG.random(300) < 0.5, np.arange(300) % 40
    trials = RNG.random((2000, 300)) < 0.5
    tests = MeasuredTests(truth, groups, 1, 5, 5)
    # outcomes that know nothing: the best of many looks good on the tests that chose it, and only there
    assert (trials == truth).mean(axis=1).max() > 0.58
    votes = tests.cross_validate(trials)
    assert ((votes >= 0.5) == truth).mean() == pytest.approx(0.5, abs=0.06)
    trials[17] = truth ^ (RNG.random(300) < 0.05)
    votes = tests.cross_validate(trials)
    assert ((votes >= 0.5) == truth).mean() == pytest.approx(0.95, abs=0.03)


def test_plausible_trials_are_within_two_standard_errors_of_the_best():
    truth = np.zeros(400, dtype=bool)
    trials = np.zeros((3, 400), dtype=bool)
    trials[0, :40], trials[1, :50], trials[2, :120] = True, True, True
    # the best has 10 % wrong, a standard error of 1.5 %
    assert list(plausible_trials(~trials ^ truth, np.arange(400))) == [
        True,
        True,
        False,
    ]


def test_the_best_threshold_separates_what_can_be_separated():
    measure = np.array([3.0, 1.0, 2.0, 4.0])
    assert best_threshold(measure, measure > 2.5) == pytest.approx(np.sqrt(6))
    assert best_threshold(measure, np.ones(4, dtype=bool)) == 1.0
    assert best_threshold(measure, np.zeros(4, dtype=bool)) == np.inf


def test_thresholds_are_judged_by_other_motions_too_and_two_measures_find_a_border():
    pga, ratio = np.exp(RNG.standard_normal((2, 600)))
    groups = RNG.integers(0, 50, 600)
    for fell, of_one, of_two in (
        (RNG.random(600) < 0.5, 0.5, 0.5),
        (pga * ratio > 1, 0.75, 0.97),
    ):
        tests = MeasuredTests(fell, groups, 2, 5, 4)
        for measures, right in ((pga, of_one), (np.column_stack([pga, ratio]), of_two)):
            found = (tests.by_threshold(measures) == fell).mean()
            assert found == pytest.approx(right, abs=0.06)


def test_both_kinds_of_error_are_counted():
    measured = np.array([True, True, False, False])
    outcomes, tests = (
        np.array([1, 0, 1, 1]) == 1,
        MeasuredTests(measured, np.arange(4), 1),
    )
    row = tests.agreement("x", outcomes)
    assert (row["false_alarms"], row["missed"], row["right"]) == (2, 1, 0.25)
    assert row["lower"] < 0.25 < row["upper"]
    # a rival with the same outcomes is as good
    row = tests.lead(outcomes, outcomes)
    assert (row["better"], row["p"]) == (0, 1)


def test_the_paired_test_keeps_its_level_when_tests_share_a_motion():
    # both are right by the chance of the motion: a test that took tests for independent would reject often
    rejected = 0
    for seed in range(120):
        rng = np.random.default_rng(seed)
        groups = np.repeat(np.arange(15), 10)
        ours, theirs = (rng.random(15)[groups] < 0.5 for _ in range(2))
        row = MeasuredTests(np.ones(150, dtype=bool), groups, seed).lead(ours, theirs)
        rejected += row["p"] < 0.1
    assert rejected / 120 < 0.18


def test_the_same_outcomes_have_the_same_fragility():
    measure = np.exp(RNG.normal(0, 0.7, 400))
    fell = measure * np.exp(RNG.normal(0, 0.3, 400)) > 1
    tests = MeasuredTests(fell, np.arange(400) % 50, 1)
    table = tests.fragility(measure, {"copy": fell}).set_index("who")
    assert table.loc["measured", "theta"] == pytest.approx(1, rel=0.1)
    assert table.loc["measured", "beta"] == pytest.approx(0.3, rel=0.3)
    assert table.loc["copy", ["theta_ratio", "beta_ratio"]].tolist() == pytest.approx(
        [1, 1]
    )


def test_regions_hold_every_test_once():
    tests = pd.DataFrame(np.exp(RNG.standard_normal((90, 2))), columns=["a", "b"])
    fell = tests["a"] > 1
    regions = by_region(
        tests.assign(overturned=fell, simulated=fell, right=True), "a", "b"
    )
    assert regions["tests"].sum() == 90
    assert (regions["right"] == 1).all()


def test_listed_peaks_show_a_time_step_that_is_four_times_too_long():
    time = np.arange(0, 6, 0.01)
    waves = [
        a * np.sin(2 * np.pi * time) * np.hanning(len(time)) for a in (1.0, 2.0, 3.0)
    ]
    motions, slow = (
        [Motion(wave, dt, "synthetic") for wave in waves] for dt in (0.01, 0.04)
    )
    listed = measured_peaks(motions)
    ratio = listed["pgv_cm_s"] / listed["pga_g"] / 981
    for tests in (listed, listed[["pga_g"]].assign(pgv_over_pga_s=ratio)):
        check_peaks(tests, motions, "synthetic.npz")
        with pytest.raises(
            InputError, match=r"are 4(\.0\d)? times the pgv_cm_s .* time step"
        ):
            check_peaks(tests, slow, "synthetic.npz")


def test_an_end_of_a_range_that_tests_prefer_is_said_and_one_with_nothing_beyond_is_not():
    ranges = {
        "contact_tolerance_mm": (0.5, 20.0),
        "edge_retreat_mm": (0.0, 40.0),
        "restitution": (0.6, 1.0),
    }
    random = np.random.default_rng(1)
    trials = pd.DataFrame(
        {name: random.uniform(*ends, 1000) for name, ends in ranges.items()}
    )
    low = trials.index[
        (trials.contact_tolerance_mm < 2) & (trials.edge_retreat_mm < 20)
    ]
    assert preferred_edges(trials, low, ranges) == {"contact_tolerance_mm": "low end"}
    near_zero = trials.index[trials.edge_retreat_mm < 4]
    assert preferred_edges(trials, near_zero, ranges) == {}
    assert preferred_edges(trials, trials.index, ranges) == {}
