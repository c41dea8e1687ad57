"""Tests on units, ranks, adjustments, equivalence and power agree with definitions, scipy and enumeration."""

import math
from itertools import product

import numpy as np
import pytest
from scipy import stats
from statsmodels.stats.multitest import multipletests

from rockfrag.pedestal import cluster_means
from rockfrag.pedestal.cluster_means import (
    Estimate,
    benjamini_hochberg,
    detectable_ratio,
    earthquake_means,
    equivalence,
    holm,
    leave_one_earthquake_out,
    mean_effect,
    sign_flip_test,
    t_estimate,
)
from rockfrag.pedestal.paired_tests import pair_tests
from rockfrag.pedestal.study import rank_probabilities


def test_t_on_units_is_the_one_sample_t_test():
    x = np.array([0.05, 0.21, -0.03, 0.11])
    ours = t_estimate(x)
    theirs = stats.ttest_1samp(x, 0)
    assert ours.p == pytest.approx(theirs.pvalue, rel=1e-12)
    assert (ours.lower, ours.upper) == pytest.approx(tuple(theirs.confidence_interval(0.95)))


def test_units_without_scatter_have_a_stated_result():
    same = t_estimate([0.0, 0.0, 0.0])
    assert np.isnan([same.p, same.lower, same.upper]).all()
    assert np.isnan(t_estimate([0.2]).p)


@pytest.mark.parametrize(
    ("values", "p", "smallest"),
    [
        ([0.5, 0.6, 0.7, 0.8], 0.125, 0.125),
        # of the eight patterns four have sums of three or more
        ([1.0, 2.0, 0.0], 0.5, 0.25),
    ],
)
def test_flipped_signs_of_few_are_all_counted(values, p, smallest):
    found = sign_flip_test(values)
    assert (found.p, found.smallest_p, found.exact) == (p, smallest, True)


def test_drawn_sign_flips_agree_with_enumerated_ones(monkeypatch):
    x = np.random.default_rng(2).normal(0.1, 0.2, 12)
    exact = sign_flip_test(x).p
    monkeypatch.setattr("rockfrag.pedestal.cluster_means.DRAWS", 2_000)
    drawn = sign_flip_test(x, seed=5)
    assert not drawn.exact
    assert drawn.p == pytest.approx(exact, abs=4 * np.sqrt(exact * (1 - exact) / 2e3))
    assert drawn == sign_flip_test(x, seed=5)


def test_effect_is_mean_of_pairs_and_its_units_are_earthquakes(tests_table):
    table = pair_tests(tests_table(3)).table
    effect = mean_effect(table)
    assert effect.mean == pytest.approx(table["d"].mean(), abs=1e-14)
    assert effect.units == 4
    item = mean_effect(table[table["earthquake"] == "Kobe"])
    assert item.units == 3
    # one with more motions than another counts once
    fewer = table[~((table["earthquake"] == "Kobe") & (table["floor"] == "F5"))]
    assert mean_effect(fewer).mean == pytest.approx(earthquake_means(fewer).mean())
    assert len(earthquake_means(fewer)) == 4


def test_leaving_an_earthquake_out_finds_the_one_that_matters(tests_table):
    table = pair_tests(tests_table(3, sd_earthquake=0, sd_motion=0, sd_pair=0.01)).table
    table = table.assign(d=table["d"] + 1.0 * (table["earthquake"] == "Friuli"))
    result = leave_one_earthquake_out(table)
    assert result.loc[result["largest_change"], "without"].tolist() == ["Friuli"]
    assert len(result) == 4
    for row in result.to_dict("records"):
        assert row["ratio"] == mean_effect(table[table["earthquake"] != row["without"]]).ratio


def test_of_very_many_earthquakes_none_is_left_out(tests_table, monkeypatch):
    table = pair_tests(tests_table(3)).table
    monkeypatch.setattr("rockfrag.pedestal.cluster_means.MOST_LEFT_OUT", 3)
    assert leave_one_earthquake_out(table).empty


def test_flipped_signs_of_many_are_those_that_are_drawn(monkeypatch):
    values = np.random.default_rng(4).normal(0.08, 1.0, 400)
    drawn = sign_flip_test(values)
    monkeypatch.setattr(cluster_means, "MOST_DRAWN", 100)
    assert sign_flip_test(values).p == pytest.approx(drawn.p, abs=0.015)


def test_clear_order_of_floors_is_found_with_certainty(tests_table):
    tests = tests_table(1, floor_effect={"GF": 0.5, "F3": -0.5}, sd_pair=0.02)
    ranks = rank_probabilities(pair_tests(tests).table, "floor", "earthquake", 1).set_index("level")
    assert ranks.loc["GF", "p_largest"] == ranks.loc["F3", "p_smallest"] == 1.0


def test_what_levels_share_does_not_blur_their_order(tests_table):
    """A large earthquake effect moves all floors together, so the ranks must not notice it."""
    table = pair_tests(tests_table(1)).table
    shift = table["earthquake"].map(
        {"Friuli": 3.0, "Kobe": -3.0, "Loma Prieta": 1.0, "Northridge": 0.0}
    )
    same = rank_probabilities(table, "floor", "earthquake", 1)
    moved = rank_probabilities(table.assign(d=table["d"] + shift), "floor", "earthquake", 1)
    assert moved["p_largest"].tolist() == same["p_largest"].tolist()


def test_probabilities_add_to_one_and_ties_share(tests_table):
    table = pair_tests(tests_table(1)).table
    for factor, cluster, within in (("object", "motion", False), ("earthquake", "motion", True)):
        ranks = rank_probabilities(table, factor, cluster, 1, within=within)
        assert ranks["p_largest"].sum() == pytest.approx(1)
        assert ranks["p_smallest"].sum() == pytest.approx(1)
    tied = rank_probabilities(table.assign(d=0.0), "object", "motion", 1)
    assert tied["p_largest"].tolist() == pytest.approx([1 / 3] * 3)


P = np.array([0.01, 0.04, 0.039, 0.2, 0.6])


@pytest.mark.parametrize(("ours", "name"), [(holm, "holm"), (benjamini_hochberg, "fdr_bh")])
def test_adjusted_p_values_are_those_of_statsmodels(ours, name):
    assert ours(P) == pytest.approx(multipletests(P, method=name)[1], abs=1e-15)


def test_tests_that_could_not_be_made_do_not_count():
    with_nan = holm([*P, math.nan])
    assert np.isnan(with_nan[-1])
    assert with_nan[:-1] == pytest.approx(holm(P))
    with pytest.raises(ValueError, match="outside 0 to 1"):
        holm([0.2, 1.2])


@pytest.mark.parametrize(("pairs_an_earthquake", "percent"), [(9, 10.0), (3, 17.9)])
def test_four_earthquakes_show_what_the_documentation_says(pairs_an_earthquake, percent):
    """0.134 per pair and no other scatter: the test is t over four means, not over 36 pairs."""
    sd = 0.134 / math.sqrt(pairs_an_earthquake)
    effect = Estimate(0.0, sd / 2, 4, -1.0, 1.0, 1.0)
    assert 100 * (detectable_ratio(effect) - 1) == pytest.approx(percent, abs=0.05)


def test_power_of_degenerate_data_is_stated():
    assert detectable_ratio(t_estimate([0.1])) == math.inf
    assert math.isnan(detectable_ratio(t_estimate([0.0, 0.0, 0.0])))


def test_equivalence_agrees_with_the_90_percent_interval():
    for spread, middle in product(np.linspace(0.02, 0.3, 30), (-0.2, 0.02, 0.2)):
        values = middle + spread * np.array([-1.0, -0.3, 0.4, 0.9])
        interval = t_estimate(values, confidence=0.90)
        inside = -math.log(1.1) < interval.lower and interval.upper < math.log(1.1)
        assert (equivalence(t_estimate(values)) < 0.05) == inside
