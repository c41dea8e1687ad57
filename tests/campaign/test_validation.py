"""Trials chosen by some motions and judged by others; rivals; intervals that know that tests share a motion."""

import numpy as np
import pandas as pd
import pytest

from rockfrag.campaign.comparison import (
    MeasuredTests,
    best_threshold,
    by_region,
    clustered_error,
    plausible_trials,
)
from rockfrag.campaign.laboratory import check_peaks, measured_peaks
from rockfrag.campaign.standing import preferred_edges
from rockfrag.errors import InputError
from rockfrag.records.motion import Motion

RNG = np.random.default_rng(11)


def test_the_clustered_error_is_the_plain_one_where_every_test_has_its_own_motion():
    values = RNG.standard_normal(50)
    plain = values.std(ddof=1) / np.sqrt(50)
    assert clustered_error(values, np.arange(50)) == pytest.approx(plain)


def test_copies_of_a_test_tell_nothing_new():
    values = RNG.standard_normal(20)
    once = clustered_error(values, np.arange(20))
    five = clustered_error(np.repeat(values, 5), np.repeat(np.arange(20), 5))
    assert five == pytest.approx(once)
    assert np.isnan(clustered_error(values, np.zeros(20, dtype=int)))


def test_folds_never_split_a_motion():
    groups = RNG.integers(0, 17, 200)
    outside = np.array([part for _, part in MeasuredTests(groups > 8, groups, 1, 5, 1).divisions()])
    assert (outside.sum(axis=0) == 4).all() and not outside.all(axis=1).any()
    for group in range(17):
        assert len(np.unique(outside[:, groups == group], axis=1).T) == 1


def test_the_true_trial_is_found_and_votes_well():
    truth = RNG.random(300) < 0.4
    groups = RNG.integers(0, 30, 300)
    trials = RNG.random((200, 300)) < 0.4
    trials[17] = truth ^ (RNG.random(300) < 0.05)
    votes = MeasuredTests(truth, groups, 1, 5, 3).cross_validate(trials)
    assert ((votes >= 0.5) == truth).mean() == pytest.approx(0.95, abs=0.03)


def test_noise_is_not_rewarded_by_the_choice():
    # outcomes that know nothing: the best of many looks good on the tests that chose it, and only there
    truth = RNG.random(200) < 0.5
    groups = np.arange(200) % 40
    trials = RNG.random((2000, 200)) < 0.5
    in_sample = (trials == truth).mean(axis=1).max()
    votes = MeasuredTests(truth, groups, 1, 5, 5).cross_validate(trials)
    assert in_sample > 0.6
    assert ((votes >= 0.5) == truth).mean() == pytest.approx(0.5, abs=0.06)


def test_plausible_trials_are_within_two_standard_errors_of_the_best():
    truth = np.zeros(400, dtype=bool)
    trials = np.zeros((3, 400), dtype=bool)
    trials[0, :40], trials[1, :50], trials[2, :120] = True, True, True
    # the best has 10 % wrong, a standard error of 1.5 %
    assert list(plausible_trials(~trials ^ truth, np.arange(400))) == [True, True, False]


def test_the_best_threshold_separates_what_can_be_separated():
    measure = np.array([3.0, 1.0, 2.0, 4.0])
    assert best_threshold(measure, measure > 2.5) == pytest.approx(np.sqrt(6))
    assert best_threshold(measure, np.ones(4, dtype=bool)) == 1.0
    assert best_threshold(measure, np.zeros(4, dtype=bool)) == np.inf


def test_thresholds_are_judged_by_other_motions_too():
    measure = np.exp(RNG.standard_normal(300))
    groups = RNG.integers(0, 30, 300)
    fell = RNG.random(300) < 0.5
    outcomes = MeasuredTests(fell, groups, 2, 5, 4).by_threshold(measure)
    assert (outcomes == fell).mean() == pytest.approx(0.5, abs=0.08)


def test_two_measures_find_a_border_that_neither_has_alone():
    pga, ratio = np.exp(RNG.standard_normal((2, 600)))
    fell = pga * ratio > 1
    groups = RNG.integers(0, 50, 600)
    tests = MeasuredTests(fell, groups, 2, 5, 2)
    both = tests.by_threshold(np.column_stack([pga, ratio]))
    alone = tests.by_threshold(pga)
    assert (both == fell).mean() > 0.95
    assert (alone == fell).mean() < 0.85


def test_both_kinds_of_error_are_counted():
    measured = np.array([True, True, False, False])
    row = MeasuredTests(measured, np.arange(4), 1).agreement("x", np.array([1, 0, 1, 1]) == 1)
    assert (row["false_alarms"], row["missed"], row["right"]) == (2, 1, 0.25)
    assert row["lower"] < 0.25 < row["upper"]


def test_a_rival_with_the_same_outcomes_is_as_good():
    measured = RNG.random(100) < 0.5
    outcomes = RNG.random(100) < 0.5
    row = MeasuredTests(measured, np.arange(100) % 20, 1).lead(outcomes, outcomes)
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
    assert table.loc["copy", ["theta_ratio", "beta_ratio"]].tolist() == pytest.approx([1, 1])


def test_regions_hold_every_test_once():
    tests = pd.DataFrame(
        {"a": np.exp(RNG.standard_normal(90)), "b": np.exp(RNG.standard_normal(90))}
    )
    fell = tests["a"].to_numpy() > 1
    judged = tests.assign(overturned=fell, simulated=fell, right=True)
    regions = by_region(judged, "a", "b")
    assert regions["tests"].sum() == 90
    assert (regions["right"] == 1).all()


def test_listed_peaks_show_a_time_step_that_is_four_times_too_long():
    time = np.arange(0, 6, 0.01)
    waves = [a * np.sin(2 * np.pi * time) * np.hanning(len(time)) for a in (1.0, 2.0, 3.0)]
    motions = [Motion(wave, 0.01, "synthetic") for wave in waves]
    tests = measured_peaks(motions)
    check_peaks(tests, motions, "synthetic.npz")
    tests = tests.assign(pgv_over_pga_s=tests["pgv_cm_s"] / tests["pga_g"] / 981).drop(
        columns="pgv_cm_s"
    )
    check_peaks(tests, motions, "synthetic.npz")
    slow = [Motion(wave, 0.04, "synthetic") for wave in waves]
    with pytest.raises(InputError, match=r"are 4(\.0\d)? times the pgv_cm_s .* time step"):
        check_peaks(tests, slow, "synthetic.npz")


def test_an_end_of_a_range_that_tests_prefer_is_said_and_one_with_nothing_beyond_is_not():
    random = np.random.default_rng(1)
    trials = pd.DataFrame(
        {
            "contact_tolerance_mm": random.uniform(0.5, 20, 1000),
            "edge_retreat_mm": random.uniform(0, 40, 1000),
            "restitution": random.uniform(0.6, 1, 1000),
        }
    )
    ranges = {
        "contact_tolerance_mm": (0.5, 20.0),
        "edge_retreat_mm": (0.0, 40.0),
        "restitution": (0.6, 1.0),
    }
    low = trials.index[(trials.contact_tolerance_mm < 2) & (trials.edge_retreat_mm < 20)]
    assert preferred_edges(trials, low, ranges) == {"contact_tolerance_mm": "low end"}
    near_zero = trials.index[trials.edge_retreat_mm < 4]
    assert preferred_edges(trials, near_zero, ranges) == {}
    assert preferred_edges(trials, trials.index, ranges) == {}
