"""Whether a curve describes its data, who moves it, and which intensity measure tells most."""

import math
import re

import numpy as np
import pandas as pd
import pytest
from scipy import stats

from rockfrag.base.errors import InputError
from rockfrag.fragility.checks import goodness_of_fit
from rockfrag.fragility.curve_facts import compared_curves, curve_facts
from rockfrag.fragility.empirical import TableIda
from rockfrag.fragility.estimators import fragility_of
from rockfrag.fragility.held_out import outcome_scores
from rockfrag.fragility.ida_curves import fragility_table, with_measures
from rockfrag.fragility.lognormal import fit_lognormal
from rockfrag.fragility.measure_selection import (
    _select,
    area_under_curve,
    recommend_ida_measure,
    recommend_measure,
)
from rockfrag.fragility.observations import observations_from_table
from rockfrag.fragility.recommendation import CANNOT_COMPARE
from rockfrag.fragility.vector import fit_vector

from .made import ida_of, reading


def cloud(n, seed, probability):
    rng = np.random.default_rng(seed)
    im = np.exp(rng.normal(np.log(0.35), 0.8, n))
    table = pd.DataFrame({"pga_g": im, "overturned": rng.random(n) < probability(im)})
    return observations_from_table(table, "pga_g", motion=None)


def lognormal(im):
    return stats.norm.cdf(np.log(im / 0.35) / 0.4)


def test_a_measure_that_cannot_be_scored_is_never_the_best():
    """Its curve rises, but held out it gives no number: others are compared among themselves."""
    rows = [
        {
            "measure": name,
            "im": name,
            "unit": "g",
            "theta": 0.4,
            "beta": beta,
            "auc": 0.8,
        }
        for name, beta in (("unscored", 0.1), ("better", 0.3), ("worse", 0.3))
    ]
    scores = np.array([[np.nan] * 6, [-1.0] * 6, [-9.0, -8.0, -9.5, -8.5, -9.0, -8.8]])
    found = _select(rows, scores, tests=6, given=[], replicates=50, seed=1)
    assert found.recommended == "better"
    first, second, third = found.table.itertuples()
    assert (first.measure, second.measure, third.measure) == (
        "better",
        "worse",
        "unscored",
    )
    assert second.p_worse < 0.01
    assert np.isnan(third.score)
    assert third.chosen_fraction == 0
    assert found.words != CANNOT_COMPARE


def test_a_wrong_shape_fails():
    wrong = cloud(800, 1, lambda im: np.where(im > 1.0, 0.5, lognormal(im)))
    judged = goodness_of_fit(wrong, fit_lognormal(wrong), replicates=200)
    assert judged.p_value < 0.01
    assert "is rejected" in judged.words
    assert fragility_of(wrong).checks.rejected


def test_the_score_of_brier_is_the_mean_square_of_what_was_missed():
    outcomes = cloud(300, 4, lognormal)
    fit = fit_lognormal(outcomes)
    judged = goodness_of_fit(outcomes, fit, replicates=10)
    told = stats.norm.cdf(np.log(outcomes.im / fit.theta) / fit.beta)
    missed = np.mean((outcomes.overturned - told) ** 2)
    assert judged.brier == pytest.approx(missed, rel=1e-9)


def test_p_values_of_true_curves_are_uniform():
    values = []
    for seed in range(40):
        data = cloud(150, 100 + seed, lognormal)
        values.append(goodness_of_fit(data, fit_lognormal(data), replicates=60).p_value)
    assert stats.kstest(values, "uniform").pvalue > 0.01


def test_the_calibration_curve_lies_on_the_diagonal_for_a_true_curve():
    checks = fragility_of(cloud(5000, 2, lognormal)).checks
    assert checks.p_fit == checks.goodness.p_value > 0.05 and not checks.rejected
    table = checks.goodness.calibration
    apart = (table.observed - table.predicted).to_numpy()
    assert np.abs(apart).max() == abs(checks.largest_residual) < 0.06
    assert table.tests.sum() == 5000
    inside = table.predicted.between(table.observed_lower, table.observed_upper)
    assert inside.mean() >= 0.7


def test_ida_curves_are_judged_as_motions_with_one_capacity_each():
    rng = np.random.default_rng(3)
    table = ida_of(0.35 * np.exp(0.4 * rng.normal(size=30)), np.geomspace(0.1, 1.2, 20))
    data = observations_from_table(table, "amplitude_g")
    judged = goodness_of_fit(data, fit_lognormal(data), replicates=200)
    assert judged.dependence == "motions"
    assert judged.p_value > 0.05


def test_the_area_under_the_curve_is_the_share_of_ordered_pairs():
    table = pd.DataFrame({"pga_g": [1, 2, 3, 3, 4], "overturned": [0, 1, 0, 1, 1]})
    data = observations_from_table(table, "pga_g", motion=None)
    # pairs (overturned, survived): 2>1, 2<3, 3>1, 3=3, 4>1, 4>3
    assert area_under_curve(data) == pytest.approx((1 + 0 + 1 + 0.5 + 1 + 1) / 6)


def test_a_measure_that_leaves_out_duration_is_found_insufficient():
    rng = np.random.default_rng(4)
    pga = np.exp(rng.normal(np.log(0.35), 0.7, 600))
    duration = rng.uniform(5.0, 40.0, 600)
    effective = pga * (duration / 15.0) ** 0.4
    fell = effective > 0.35 * np.exp(0.3 * rng.normal(size=600))
    table = pd.DataFrame(
        {"pga_g": pga, "effective_g": effective, "duration_s": duration}
    )
    asked = {"given": ["duration_s"], "motion": None, "replicates": 20}
    both, alone = (
        recommend_measure(table.assign(overturned=fell), measures, **asked)
        for measures in (["pga_g", "effective_g"], ["pga_g"])
    )
    assert both.recommended == "effective_g"
    found = both.table.set_index("measure")["p_duration_s"]
    assert found["pga_g"] < 1e-3 and found["effective_g"] > 0.01
    assert "not sufficient" in alone.words


def test_proportional_measures_are_equals_and_make_no_surface():
    data = cloud(300, 5, lognormal)
    table = pd.DataFrame(
        {"a_g": data.im, "b_g": 2.0 * data.im, "overturned": data.overturned}
    )
    choice = recommend_measure(table, ["a_g", "b_g"], motion=None, replicates=20)
    assert "is not distinguishable from" in choice.words
    assert "Adding" not in choice.words


@pytest.mark.parametrize("decides", ["pga_g", "pgv_cm_s", "arias_m_s"])
def test_ida_curves_recommend_the_measure_that_decides(decides):
    rng = np.random.default_rng(11)
    motions = 40
    measures = pd.DataFrame({"name": [f"m{k}" for k in range(motions)]}).assign(
        pga_g=np.exp(rng.normal(-1.0, 0.5, motions)),
        pgv_cm_s=np.exp(rng.normal(3.0, 0.5, motions)),
        arias_m_s=np.exp(rng.normal(0.0, 1.0, motions)),
        magnitude=rng.uniform(5.0, 7.5, motions),
    )
    power = 2 if decides == "arias_m_s" else 1
    # the measure at overturning is 1 with a scatter of 0.2 in ln amplitude
    at_unit = measures[decides] / measures["pga_g"] ** power
    capacity = (np.exp(0.2 * power * rng.normal(size=motions)) / at_unit) ** (1 / power)
    ida = pd.DataFrame(
        [
            {
                "motion": name,
                "earthquake": name,
                "amplitude_g": a,
                "overturned": a > limit,
            }
            for name, limit in zip(measures["name"], capacity, strict=True)
            for a in limit * np.exp(np.arange(-1.0, 1.0, 0.05) + 0.05 * rng.random())
        ]
    )
    columns = ["pga_g", "pgv_cm_s", "arias_m_s"]
    curves = TableIda(with_measures(ida, measures, columns))
    choice = recommend_ida_measure(curves, measures, columns, given=["magnitude"])
    assert choice.recommended == decides
    best = choice.table.iloc[0]
    assert best["beta_amplitude"] == pytest.approx(0.2, abs=0.06)
    assert best["theta"] == pytest.approx(1.0, rel=0.2 * power)
    assert best["chosen_fraction"] > 0.9 and best["p_magnitude"] > 0.01
    with pytest.raises(InputError, match="does not grow with the amplitude"):
        recommend_ida_measure(curves, measures, ["d5_95_s"])


def test_capacities_of_two_kinds_are_found_not_lognormal_and_the_shares_are_offered():
    """Half of the motions overturn at 0.1 g, half at 1 g: no lognormal curve is like that."""
    rng = np.random.default_rng(1)
    low, high = (
        0.1 * np.exp(0.05 * rng.normal(size=20)),
        np.exp(0.05 * rng.normal(size=22)),
    )
    first = reading(fragility_table(ida_of([*low, *high], np.geomspace(0.05, 2.0, 60))))
    assert first["p_fit"] < 0.01
    said = r"The lognormal curve is rejected .* median is .* 90 % limits\) and β .* 90 % limits\)"
    assert re.search(said, first["warnings"])
    assert first["theta_isotonic"] == pytest.approx(1.0, rel=0.15)
    assert first["beta_isotonic"] == pytest.approx(0.5 * np.log(10), rel=0.1)


@pytest.mark.parametrize(
    ("never", "said"),
    [(20, "and which does not go from 16 to 84 %"), (60, "does not reach a half")],
)
def test_shares_of_motions_that_mostly_overturn_nothing_have_no_numbers_that_are_not(
    never, said
):
    rng = np.random.default_rng(1)
    capacities = [*0.1 * np.exp(0.02 * rng.normal(size=30)), *[1.5] * 6, *[9.0] * never]
    table = fragility_table(ida_of(capacities, np.geomspace(0.05, 2.0, 40)))
    first = reading(table, "mean_probability")
    assert first["p_fit"] < 0.05
    assert said in first["warnings"] and "nan" not in first["warnings"]


def test_facts_of_a_row_are_those_that_it_knows():
    """Without β nothing is said of its parts, nor where it holds all of them."""
    row = {"n_motions": 6, "beta": 0.4, "beta_statistical": 0.1}
    assert "Beta of the motions 0.400" in curve_facts(row)
    for unknown in ({"beta": math.nan}, {"beta_holds_all": True}):
        assert curve_facts(row | unknown) == "6 motions."


def test_motion_that_moves_the_median_most_is_named():
    capacities, levels = (
        [0.3, 0.31, 0.29, 0.305, 0.295, 2.0],
        np.geomspace(0.1, 3.0, 200),
    )
    row, without = (
        reading(fragility_table(ida_of(some, levels)))
        for some in (capacities, capacities[:-1])
    )
    assert row["influential"] == "m5" and "only 6 motions" in row["warnings"]
    assert row["influence"] == pytest.approx(without["theta"] / row["theta"], rel=1e-6)


def dependent_tests(seed):
    """Tests of 12 motions in which only PGV decides and each motion has a whim of its own."""
    rng = np.random.default_rng(seed)
    motion = np.repeat(np.arange(12), 40)
    pgv = np.exp(rng.normal(3.0, 0.6, motion.size))
    # a second measure that is constant under a motion can learn the whims by heart
    other = np.exp(rng.normal(0.0, 0.5, 12))[motion]
    whim = 0.4 * rng.normal(size=12)[motion]
    fell = np.log(pgv) + whim + 0.2 * rng.normal(size=motion.size) > 3.0
    return pd.DataFrame(
        {"pgv_cm_s": pgv, "other_cm": other, "overturned": fell, "motion": motion}
    )


def test_second_measure_is_not_recommended_for_what_it_learns_of_the_motions_by_heart():
    """AIC takes 480 tests of 12 motions for independent and asks for the surface nearly always."""
    helped, aic = 0, 0
    for seed in range(20):
        table = dependent_tests(seed)
        choice = recommend_measure(table, ["pgv_cm_s", "other_cm"], replicates=20)
        assert choice.recommended == "pgv_cm_s"
        helped += "use the surface" in choice.words
        lone = fit_lognormal(observations_from_table(table, "pgv_cm_s")).aic
        both = fit_vector(
            table, ("pgv_cm_s", "other_cm"), earthquake=None, try_interaction=False
        )
        aic += both.aic < lone - 2
    assert aic >= 10
    assert helped <= 3


def test_measure_that_decides_together_with_another_is_recommended_with_it():
    rng = np.random.default_rng(3)
    motion = np.repeat(np.arange(40), 20)
    first, two = np.exp(rng.normal(0, 0.6, (2, motion.size)))
    fell = np.log(first) + np.log(two) + 0.2 * rng.normal(size=motion.size) > 0
    table = pd.DataFrame(
        {"pga_g": first, "pgv_cm_s": two, "overturned": fell, "motion": motion}
    )
    words = recommend_measure(table, ["pga_g", "pgv_cm_s"], replicates=20).words
    assert "use the surface in both" in words
    assert words.startswith("Use P")


def test_where_one_lognormal_curve_is_rejected_all_are_compared_without_a_form():
    rows = pd.DataFrame(
        {
            "configuration": ["low", "high"],
            "theta": [0.30, 0.40],
            "theta_isotonic": [0.32, 0.39],
            "p_fit": [0.01, 0.50],
        }
    )
    found = compared_curves(rows)
    assert found.nonparametric and found.rejected == ["low"]
    assert list(found.rows["theta"]) == [0.32, 0.39]
    kept = compared_curves(rows.assign(p_fit=0.5))
    assert not kept.nonparametric and list(kept.rows["theta"]) == [0.30, 0.40]


def test_earthquakes_that_a_measure_parts_wholly_are_foretold_by_the_others():
    """No finite curve is the likeliest of outcomes that a level parts, but a penalised one is finite and steep."""
    logs = np.log(np.geomspace(0.1, 1.0, 40))[:, None]
    fell = (logs[:, 0] > np.log(0.3)).astype(float)
    scores = outcome_scores(logs, fell, np.ones(40), np.arange(40) % 8)
    assert np.isfinite(scores).all()
    # of five outcomes each a coin would score 5 ln 1/2
    assert (scores > 5 * np.log(0.5)).all()


def test_of_measures_that_score_worse_the_next_best_is_named():
    rows = [
        {
            "measure": name,
            "im": name,
            "unit": "g",
            "theta": 0.4,
            "beta": 0.3,
            "auc": 0.8,
        }
        for name in ("best", "worst", "middle")
    ]
    apart = np.array([0.1, -0.1, 0.2, -0.2, 0.05, -0.05])
    scores = np.array([[0.0] * 6, -9.0 + apart, -4.0 + apart])
    found = _select(rows, scores, tests=6, given=[], replicates=50, seed=1)
    assert list(found.table["measure"]) == ["best", "middle", "worst"]
    assert "middle is worse: -4.000" in found.words
    assert "worst is worse" not in found.words
