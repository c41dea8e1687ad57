"""Confidence limits by resampling whole motions."""

import inspect
import math

import numpy as np
import pandas as pd
import pytest

from rockfrag.base.errors import InputError
from rockfrag.fragility import censored, estimators, intervals
from rockfrag.fragility.censored import Brackets, _fit_weighted, bracket_interval
from rockfrag.fragility.check_notes import TAILS
from rockfrag.fragility.empirical import TableIda
from rockfrag.fragility.estimators import fit_cloud, fragility_of
from rockfrag.fragility.ida_curves import (
    fragility_table,
    levels_drawn,
    tables_of_ida_curves,
)
from rockfrag.fragility.intervals import (
    Interval,
    interval_over_motions,
    outcome_fitter,
    step_limits,
)
from rockfrag.fragility.lognormal import fit_lognormal
from rockfrag.fragility.observations import observations_from_table

from .made import ida_of, reading

STEPS = np.geomspace(0.1, 1.0, 12)
LEVELS = np.exp(np.arange(np.log(0.1), np.log(1.2), 0.1))


def swept_motions(n, seed=0, each=1):
    """Outcomes of n motions at common levels, each with one lognormal capacity, so many an earthquake."""
    capacity = np.exp(np.random.default_rng(seed).normal(np.log(0.35), 0.4, n))
    return ida_of(capacity, LEVELS, each=each)


def test_leaving_a_motion_out_by_its_weight_equals_leaving_its_rows_out():
    table = swept_motions(5)
    fit, _ = outcome_fitter(observations_from_table(table, "amplitude_g"), "motion")
    rest = observations_from_table(table[table["motion"] != "m2"], "amplitude_g")
    weights = np.array([[1.0, 1.0, 0.0, 1.0, 1.0]])
    assert fit(weights)[0] == pytest.approx(fit_lognormal(rest).coefficients, abs=1e-6)


def test_intervals_follow_motions_and_not_the_number_of_amplitudes():
    # every test of every motion ten times over tells nothing new about other motions
    table = swept_motions(8, seed=5)
    once, often = (
        observations_from_table(pd.concat([table] * times), "amplitude_g")
        for times in (1, 10)
    )
    limits = [interval_over_motions(data).theta for data in (once, often)]
    assert limits[1] == pytest.approx(limits[0], rel=1e-6)
    assert fit_lognormal(often).se_log_theta < 0.4 * fit_lognormal(once).se_log_theta


@pytest.mark.parametrize(
    ("capacities", "theta_known", "limits_known"),
    [
        ([0.3], True, False),  # one motion
        ([9.0, 9.0], False, False),  # all survive
        ([0.01, 0.02], False, False),  # all overturn at once
        ([0.01, 9.0], False, False),  # nothing between never and at once
        ([0.3, 0.9], True, True),  # two motions
        ([0.3, 0.32, 0.5, 9.0], True, True),
    ],
)
def test_the_poorest_ida_curves_give_a_stated_result(
    capacities, theta_known, limits_known
):
    table = fragility_table(ida_of(capacities, STEPS))
    assert (table["theta"].notna() == theta_known).all()
    assert (table["theta_lower"].notna() == limits_known).all()
    assert (table["warnings"].str.len() > 20).all() or len(capacities) >= 4
    known = table[table["theta_lower"].notna()]
    assert (known["theta_lower"] < known["theta"]).all()
    assert (known["theta"] < known["theta_upper"]).all()
    if len(capacities) == 2 and limits_known:
        # two motions say nothing about the scatter of others
        assert (table["beta_lower"] == 0).all() and np.isposinf(
            table["beta_upper"]
        ).all()


def test_limits_over_motions_of_shared_earthquakes_warn():
    table = swept_motions(8, each=2)
    data = observations_from_table(table, "amplitude_g")
    shared = observations_from_table(table, "amplitude_g", earthquake="earthquake")
    for tests, over in ((data, "motion"), (shared, "earthquake")):
        limits = interval_over_motions(tests)
        assert (limits.over, limits.warnings) == (over, ())
    assert (
        "come from 4 earthquakes"
        in interval_over_motions(shared, over="motion").warnings[0]
    )


@pytest.mark.parametrize("level", [0.0, 1.0, math.nan])
def test_a_level_that_nothing_or_all_lies_within_is_refused(level):
    data = observations_from_table(swept_motions(8), "amplitude_g")
    with pytest.raises(InputError, match="lies between 0 and 1"):
        interval_over_motions(data, level=level)


def test_capacities_in_one_step_give_limits_of_the_step_and_a_beta_from_zero():
    table = fragility_table(ida_of([0.3, 0.3, 0.3, 0.3], STEPS))
    step = STEPS[STEPS <= 0.3].max(), STEPS[STEPS > 0.3].min()
    row = reading(table)
    assert (row["theta_lower"], row["theta_upper"]) == pytest.approx(step)
    assert row["beta_lower"] == 0 < row["beta"] <= row["beta_upper"] < 0.3
    assert row["interval_method"] == "common step"
    assert "in one step of the amplitude" in row["warnings"]


def test_limits_of_tests_that_fall_in_one_step_are_the_ends_of_the_step():
    data = observations_from_table(ida_of([0.3, 0.3, 0.3, 0.3], STEPS), "amplitude_g")
    step = STEPS[STEPS <= 0.3].max(), STEPS[STEPS > 0.3].min()
    assert interval_over_motions(data).theta == pytest.approx(step)


def without_limits(groups, slope, said=("There are no limits.",)):
    """Interval of groups that agree within a step, of a curve with a slope."""
    return Interval(
        theta=(math.nan, math.nan),
        beta=(math.nan, math.nan),
        level=0.9,
        method="none",
        groups=groups,
        over="motion",
        estimate=(0.0, slope),
        replicates=np.zeros((0, 2)),
        warnings=said,
    )


@pytest.mark.parametrize("groups", [4, 7, 20])
def test_all_capacities_fall_in_one_step_as_rarely_as_the_level_allows(groups):
    """By simulated capacities of the dispersion that the limit names, and of medians beside the step."""
    found = step_limits(without_limits(groups, slope=50.0), 1.0, 1.5)
    rng = np.random.default_rng(groups)
    capacities = rng.normal(0.0, found.beta[1], (200_000, groups))
    within = (np.abs(capacities) < 0.5 * np.log(1.5)).all(axis=1)
    assert within.mean() == pytest.approx(0.1, abs=0.004)
    # the step holds the median unless all capacities are on one side of it
    held = (capacities.min(axis=1) < 0) & (capacities.max(axis=1) > 0)
    assert f"with {100 * held.mean():.0f} % confidence" in found.warnings[-1]


def test_no_dispersion_is_left_out_that_the_curve_itself_has():
    found = step_limits(without_limits(4, slope=0.5), 1.0, 1.5)
    assert found.beta == (0.0, pytest.approx(2.0))


def test_of_groups_that_all_fall_or_all_stand_there_is_no_curve():
    table = swept_motions(5)
    data = observations_from_table(
        table.assign(overturned=table["motion"].isin(["m0", "m1"]).astype(int)),
        "amplitude_g",
    )
    fit, groups = outcome_fitter(data, "motion")
    weights = np.eye(groups)
    found = fit(weights)[:, 0]
    fell = np.arange(groups) < 2
    assert (found[fell] == np.inf).all()
    assert (found[~fell] == -np.inf).all()


def test_limits_of_beta_lie_about_the_true_one_and_not_about_the_small_one_of_few():
    """Eight capacities make β a tenth too small; its limits are those of what is not."""
    true, alone, middle = 0.4, [], []
    for seed in range(60):
        data = observations_from_table(swept_motions(8, seed=seed), "amplitude_g")
        found = interval_over_motions(data)
        alone.append(1.0 / found.estimate[1])
        middle.append(math.sqrt(found.beta[0] * found.beta[1]))
    assert np.mean(alone) < 0.93 * true
    assert np.median(middle) == pytest.approx(true, rel=0.07)


def test_limits_of_a_step_replace_the_reason_for_none_and_keep_all_else_that_was_said():
    said = (
        "Motions come from 4 earthquakes.",
        "Two are alike.",
        "There are no limits.",
    )
    found = step_limits(without_limits(4, slope=5.0, said=said), 0.2, 0.3)
    assert found.warnings[:2] == said[:2]
    assert len(found.warnings) == 3
    assert "in one step of the amplitude" in found.warnings[2]


def test_beta_lies_within_its_limits_under_separation_too():
    """One value parts survived from overturned: the data allow any small β."""
    rng = np.random.default_rng(3)
    for _ in range(20):
        peaks = np.exp(rng.normal(np.log(0.4), 0.4, 8))
        table = pd.DataFrame(
            {
                "pga_g": peaks,
                "overturned": peaks > np.median(peaks),
                "motion": np.arange(8) // 2,
            }
        )
        found = fit_cloud(table, "pga_g")
        assert "penalised" in found.fit.method
        assert found.interval.beta[0] == 0 or np.isnan(found.interval.beta[0])
        assert not found.fit.beta > found.interval.beta[1]


def test_one_step_without_a_block_is_the_fit_without_it(monkeypatch):
    rng = np.random.default_rng(7)
    names = np.array([f"m{k}" for k in range(400)], dtype=object)
    low = np.exp(0.4 * rng.normal(size=400))
    brackets = Brackets(low, np.where(low < 2.0, 1.05 * low, np.inf), names, names)
    stepped = bracket_interval(brackets)
    monkeypatch.setattr(
        censored, "_without_a_block", lambda *all_of: _fit_weighted(*all_of)[0]
    )
    fitted = bracket_interval(brackets)
    assert stepped.groups == fitted.groups == 400
    assert stepped.theta == pytest.approx(fitted.theta, rel=1e-4)
    assert stepped.beta == pytest.approx(fitted.beta, rel=2e-3)
    # and it is a step, not the fit itself
    assert stepped.theta != fitted.theta


def tables_of(thresholds):
    """Curve of one body and its points."""
    ida = TableIda(ida_of(thresholds, np.geomspace(0.1, 1.6, 30)))
    return tables_of_ida_curves([({"configuration": "vase"}, ida)], ["amplitude_g"])


def test_the_points_pass_through_the_median_between_the_limits_of_the_band():
    found = tables_of([0.3, 0.4, 0.5, 0.7, 0.9])
    theta = reading(found.curves, "mean_probability")["theta"]
    points = found.bands
    assert np.interp(theta, points["x"], points["probability"]) == pytest.approx(
        0.5, abs=0.01
    )
    assert (points["lower"] <= points["probability"]).all()
    assert (points["probability"] <= points["upper"]).all()
    assert found.bins["tests"].sum() == 5 * 30


def test_without_a_curve_or_a_band_there_are_outcomes():
    survived, of_one_motion = tables_of([9.0, 9.0]), tables_of([0.5]).bands
    assert survived.bands["probability"].isna().all()
    assert (survived.bands["local"].dropna() == 0).all()
    assert (survived.bins["fraction"] == 0).all()
    assert (
        of_one_motion["lower"].isna().all()
        and of_one_motion["probability"].notna().all()
    )
    assert np.isfinite(of_one_motion["local"]).any()


def test_limits_are_those_of_ninety_percent_where_no_level_is_asked_for():
    asked = [
        parameter.default
        for module in (censored, estimators, intervals)
        for function in vars(module).values()
        if inspect.isfunction(function) and function.__module__ == module.__name__
        for name, parameter in inspect.signature(function).parameters.items()
        if name == "level" and parameter.default is not inspect.Parameter.empty
    ]
    assert len(asked) > 5
    assert set(asked) == {0.90}


@pytest.mark.parametrize(
    ("capacities", "method", "warned"),
    [
        ([0.2, 0.3, 0.4, 0.5, 0.7], "jackknife", True),
        # two motions leave beta without an upper limit
        ([0.3, 0.9], "jackknife", False),
        ([0.3, 0.3, 0.3, 0.3], "common step", False),
    ],
)
def test_heavy_tails_are_warned_of_beside_jackknifed_limits_of_beta_alone(
    capacities, method, warned
):
    row = reading(fragility_table(ida_of(capacities, STEPS)))
    assert row["interval_method"] == method
    assert (TAILS in row["warnings"]) == warned


def test_a_curve_is_drawn_from_half_a_percent_to_all_but_that_where_there_are_data():
    table = ida_of(
        0.35 * np.exp(0.4 * np.linspace(-1, 1, 9)), np.geomspace(0.01, 9, 90)
    )
    data = observations_from_table(table, "amplitude_g")
    curve = fragility_of(data)
    drawn = levels_drawn(curve, data, 50)
    ends = curve.fit.probability(drawn[[0, -1]])
    assert ends == pytest.approx([0.0047, 0.9953], abs=1e-4)
    assert np.diff(np.log(drawn)) == pytest.approx(np.log(drawn[-1] / drawn[0]) / 49)
    # and no further than a little beyond them
    narrow = table[table["amplitude_g"].between(0.3, 0.4)]
    few = observations_from_table(narrow, "amplitude_g")
    lowest, highest = few.im.min(), few.im.max()
    found = levels_drawn(curve, few, 50)[[0, -1]]
    assert found == pytest.approx([0.8 * lowest, 1.25 * highest])
