"""Confidence limits by resampling whole motions."""

import numpy as np
import pandas as pd
import pytest

from rockfrag.fragility import censored
from rockfrag.fragility.censored import Brackets, _fit_weighted, bracket_interval
from rockfrag.fragility.checks import goodness_of_fit
from rockfrag.fragility.empirical import TableIda
from rockfrag.fragility.estimators import fit_cloud
from rockfrag.fragility.ida_curves import fragility_table, tables_of_ida_curves
from rockfrag.fragility.intervals import interval_over_motions, outcome_fitter
from rockfrag.fragility.lognormal import fit_lognormal
from rockfrag.fragility.observations import observations_from_table
from rockfrag.report.measured_page import calibration_figure, measures_figure

from .made import ida_of, reading

STEPS = np.geomspace(0.1, 1.0, 12)
LEVELS = np.exp(np.arange(np.log(0.1), np.log(1.2), 0.1))


def swept_motions(n, seed=0, theta=0.35, beta=0.4):
    """Outcomes of n motions at common levels, each with one lognormal capacity."""
    capacity = np.exp(np.random.default_rng(seed).normal(np.log(theta), beta, n))
    return observations_from_table(ida_of(capacity, LEVELS), "amplitude_g")


def table_of(data):
    return pd.DataFrame(
        {"amplitude_g": data.im, "overturned": data.overturned, "motion": data.motion}
    )


def test_leaving_a_motion_out_by_its_weight_equals_leaving_its_rows_out():
    data = swept_motions(5)
    fit, _ = outcome_fitter(data, "motion")
    rest = table_of(data)[data.motion != "m2"]
    alone = fit_lognormal(observations_from_table(rest, "amplitude_g"))
    weights = np.array([[1.0, 1.0, 0.0, 1.0, 1.0]])
    assert fit(weights)[0] == pytest.approx(alone.coefficients, abs=1e-6)


def test_intervals_follow_motions_and_not_the_number_of_amplitudes():
    # every test of every motion ten times over tells nothing new about other motions
    once = swept_motions(8, seed=5)
    tenfold = pd.concat([table_of(once)] * 10, ignore_index=True)
    often = observations_from_table(tenfold, "amplitude_g")
    first = interval_over_motions(once)
    second = interval_over_motions(often)
    assert second.theta == pytest.approx(first.theta, rel=1e-6)
    assert fit_lognormal(often).se_log_theta < 0.4 * fit_lognormal(once).se_log_theta


@pytest.mark.parametrize(
    ("capacities", "theta_known", "limits_known"),
    [
        ([0.3], True, False),  # one motion
        ([9.0, 9.0], False, False),  # all survive
        ([0.01, 0.02], False, False),  # all overturn at once
        ([0.3, 0.3, 0.3], True, True),  # all in one step
        ([0.01, 9.0], False, False),  # nothing between never and at once
        ([0.3, 0.9], True, True),  # two motions
        ([0.3, 0.32, 0.5, 9.0], True, True),
    ],
)
def test_the_poorest_ida_curves_give_a_stated_result(capacities, theta_known, limits_known):
    table = fragility_table(ida_of(capacities, STEPS))
    assert (table["theta"].notna() == theta_known).all()
    assert (table["theta_lower"].notna() == limits_known).all()
    assert (table["warnings"].str.len() > 20).all() or len(capacities) >= 4
    known = table[table["theta_lower"].notna()]
    assert (known["theta_lower"] < known["theta"]).all()
    assert (known["theta"] < known["theta_upper"]).all()
    if len(capacities) == 2 and limits_known:
        # two motions say nothing about the scatter of others
        assert (table["beta_lower"] == 0).all() and np.isposinf(table["beta_upper"]).all()


def test_limits_over_motions_of_shared_earthquakes_warn():
    data = swept_motions(8)
    assert not interval_over_motions(data).warnings
    table = table_of(data)
    table["earthquake"] = table["motion"].map(lambda name: int(name[1:]) % 4)
    shared = observations_from_table(table, "amplitude_g", earthquake="earthquake")
    assert interval_over_motions(shared).over == "earthquake"
    assert not interval_over_motions(shared).warnings
    assert "come from 4 earthquakes" in interval_over_motions(shared, over="motion").warnings[0]


def test_capacities_in_one_step_give_limits_of_the_step_and_a_beta_from_zero():
    table = fragility_table(ida_of([0.3, 0.3, 0.3, 0.3], STEPS))
    step = STEPS[STEPS <= 0.3].max(), STEPS[STEPS > 0.3].min()
    row = reading(table)
    assert (row["theta_lower"], row["theta_upper"]) == pytest.approx(step)
    assert row["beta_lower"] == 0 < row["beta"] <= row["beta_upper"] < 0.3
    assert row["interval_method"] == "common step"
    assert "in one step of the amplitude" in row["warnings"]


def test_beta_lies_within_its_limits_under_separation_too():
    """One value parts survived from overturned: the data allow any small β."""
    rng = np.random.default_rng(3)
    for _ in range(20):
        peaks = np.exp(rng.normal(np.log(0.4), 0.4, 8))
        table = pd.DataFrame(
            {"pga_g": peaks, "overturned": peaks > np.median(peaks), "motion": np.arange(8) // 2}
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
    monkeypatch.setattr(censored, "_without_a_block", lambda *all_of: _fit_weighted(*all_of)[0])
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
    assert np.interp(theta, points["x"], points["probability"]) == pytest.approx(0.5, abs=0.01)
    assert (points["lower"] <= points["probability"]).all()
    assert (points["probability"] <= points["upper"]).all()
    assert found.bins["tests"].sum() == 5 * 30


def test_where_nothing_overturned_there_is_no_curve_but_there_are_outcomes():
    found = tables_of([9.0, 9.0])
    assert found.bands["probability"].isna().all()
    assert (found.bands["local"].dropna() == 0).all()
    assert (found.bins["fraction"] == 0).all()


def test_one_motion_has_a_curve_without_a_band():
    found = tables_of([0.5])
    assert found.bands["lower"].isna().all()
    assert np.isfinite(found.bands["local"]).any()


@pytest.fixture(scope="module")
def ida():
    """Synthetic IDA curves of eight motions, half of them with a structural resurrection."""
    levels = np.geomspace(0.1, 1.5, 40)
    capacity = 0.4 * np.exp(0.3 * np.random.default_rng(1).normal(size=8))
    table, ratio = ida_of(capacity, levels), np.divide.outer(levels, capacity).T.ravel()
    window = (ratio > 1.3) & (ratio < 1.6) & (np.arange(ratio.size) // 40 % 2 == 0)
    return table.assign(
        pgv_cm_s=80 * table["amplitude_g"] ** 1.2, overturned=table["overturned"] & ~window
    )


def test_each_measure_has_a_panel_with_its_curve(ida):
    pga, pgv = fit_cloud(ida, "amplitude_g"), fit_cloud(ida, "pgv_cm_s")
    data = {name: observations_from_table(ida, name) for name in ("amplitude_g", "pgv_cm_s")}
    figure = measures_figure({"amplitude_g": pga, "pgv_cm_s": pgv}, data)
    assert [axes.get_xlabel() for axes in figure.axes] == ["PGA [g]", "PGV [cm/s]"]
    assert f"AIC {pgv.fit.aic:.1f}" in figure.axes[1].get_title(loc="left")


def test_calibration_is_drawn_with_its_p_value(ida):
    outcomes = observations_from_table(ida, "amplitude_g")
    judged = goodness_of_fit(outcomes, fit_cloud(ida, "amplitude_g").fit, replicates=20)
    figure = calibration_figure({"T1": judged})
    assert figure.axes[0].get_legend().get_texts()[0].get_text().startswith("T1 (p = ")
