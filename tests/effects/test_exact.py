"""Tests on units, ranks, adjustments, equivalence and power agree with definitions, scipy and enumeration."""

import math
from itertools import product

import numpy as np
import pytest
from scipy import stats
from statsmodels.stats.multitest import multipletests

from rockfrag.effects import cluster_means
from rockfrag.effects.cluster_means import (
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
from rockfrag.effects.paired_tests import pair_tests
from rockfrag.effects.study import rank_probabilities

from .conftest import synthetic_tests


def test_t_on_units_is_the_one_sample_t_test():
    x = np.array([0.05, 0.21, -0.03, 0.11])
    ours = t_estimate(x)
    theirs = stats.ttest_1samp(x, 0)
    assert ours.p == pytest.approx(theirs.pvalue, rel=1e-12)
    assert (ours.lower, ours.upper) == pytest.approx(
        tuple(theirs.confidence_interval(0.95))
    )
    # units that all jump alike are not certain beyond what the steps allow
    alike = t_estimate([0.1, 0.1, 0.1, 0.1], resolution=0.05)
    assert 0 < alike.p < 0.05 and alike.lower == pytest.approx(0.05)


def test_flipped_signs_are_counted_or_drawn_or_normal_and_agree(monkeypatch):
    few = sign_flip_test([0.5, 0.6, 0.7, 0.8])
    assert (few.p, few.smallest_p, few.exact) == (0.125, 0.125, True)
    # of the eight patterns four have sums of three or more
    assert sign_flip_test([1.0, 2.0, 0.0]).p == 0.5
    x = np.random.default_rng(2).normal(0.1, 0.2, 12)
    exact = sign_flip_test(x).p
    values = np.random.default_rng(4).normal(0.08, 1.0, 400)
    many = sign_flip_test(values)
    monkeypatch.setattr(cluster_means, "DRAWS", 2_000)
    drawn = sign_flip_test(x, seed=5)
    assert not drawn.exact and drawn == sign_flip_test(x, seed=5)
    assert drawn.p == pytest.approx(exact, abs=4 * np.sqrt(exact * (1 - exact) / 2e3))
    monkeypatch.setattr(cluster_means, "MOST_DRAWN", 100)
    assert sign_flip_test(values).p == pytest.approx(many.p, abs=0.015)


def test_effect_is_mean_of_pairs_and_its_units_are_earthquakes():
    table = pair_tests(synthetic_tests(3)).table
    effect = mean_effect(table)
    assert effect.mean == pytest.approx(table["d"].mean(), abs=1e-14)
    assert effect.units == 4
    assert mean_effect(table[table["earthquake"] == "Kobe"]).units == 3
    # one with more motions than another counts once
    fewer = table[~((table["earthquake"] == "Kobe") & (table["floor"] == "F5"))]
    assert mean_effect(fewer).mean == pytest.approx(earthquake_means(fewer).mean())
    assert len(earthquake_means(fewer)) == 4


def test_leaving_an_earthquake_out_finds_the_one_that_matters(monkeypatch):
    table = pair_tests(
        synthetic_tests(3, sd_earthquake=0, sd_motion=0, sd_pair=0.01)
    ).table
    table = table.assign(d=table["d"] + 1.0 * (table["earthquake"] == "Friuli"))
    result = leave_one_earthquake_out(table)
    assert result.loc[result["largest_change"], "without"].tolist() == ["Friuli"]
    assert len(result) == 4
    for row in result.to_dict("records"):
        assert (
            row["ratio"]
            == mean_effect(table[table["earthquake"] != row["without"]]).ratio
        )
    monkeypatch.setattr(cluster_means, "MOST_LEFT_OUT", 3)
    assert leave_one_earthquake_out(table).empty


def test_ranks_are_certain_of_a_clear_order_and_share_ties():
    tests = synthetic_tests(floor_effect={"GF": 0.5, "F3": -0.5}, sd_pair=0.02)
    table = pair_tests(tests).table
    ranks = rank_probabilities(table, "floor", "earthquake", 1).set_index("level")
    assert ranks.loc["GF", "p_largest"] == ranks.loc["F3", "p_smallest"] == 1.0
    inside = rank_probabilities(table, "earthquake", "motion", 1, within=True)
    assert inside[["p_largest", "p_smallest"]].sum().tolist() == pytest.approx([1, 1])
    tied = rank_probabilities(table.assign(d=0.0), "object", "motion", 1)
    assert tied["p_largest"].tolist() == pytest.approx([1 / 3] * 3)


def test_what_levels_share_does_not_blur_their_order():
    """A large earthquake effect moves all floors together, so the ranks must not notice it."""
    table = pair_tests(synthetic_tests()).table
    shift = table["earthquake"].str.len() - 7.0
    same, moved = (
        rank_probabilities(table.assign(d=table["d"] + by), "floor", "earthquake", 1)
        for by in (0.0, shift)
    )
    assert moved["p_largest"].tolist() == same["p_largest"].tolist()


@pytest.mark.parametrize(
    ("ours", "name"), [(holm, "holm"), (benjamini_hochberg, "fdr_bh")]
)
def test_adjusted_p_values_are_those_of_statsmodels_and_unknown_ones_do_not_count(
    ours, name
):
    p = np.array([0.01, 0.04, 0.039, 0.2, 0.6])
    theirs = multipletests(p, method=name)[1]
    assert ours([*p, math.nan]) == pytest.approx(
        [*theirs, math.nan], abs=1e-15, nan_ok=True
    )
    with pytest.raises(ValueError, match="outside 0 to 1"):
        ours([0.2, 1.2])


@pytest.mark.parametrize(("pairs_an_earthquake", "percent"), [(9, 10.0), (3, 17.9)])
def test_four_earthquakes_show_what_the_documentation_says(
    pairs_an_earthquake, percent
):
    """0.134 per pair and no other scatter: the test is t over four means, not over 36 pairs."""
    sd = 0.134 / math.sqrt(pairs_an_earthquake)
    effect = Estimate(0.0, sd / 2, 4, -1.0, 1.0, 1.0)
    assert 100 * (detectable_ratio(effect) - 1) == pytest.approx(percent, abs=0.05)


def test_degenerate_units_have_a_stated_result():
    same, alone = t_estimate([0.0, 0.0, 0.0]), t_estimate([0.2])
    assert np.isnan(
        [same.p, same.lower, same.upper, alone.p, detectable_ratio(same)]
    ).all()
    assert detectable_ratio(alone) == math.inf


def test_equivalence_agrees_with_the_90_percent_interval():
    for spread, middle in product(np.linspace(0.02, 0.3, 30), (-0.2, 0.02, 0.2)):
        values = middle + spread * np.array([-1.0, -0.3, 0.4, 0.9])
        interval = t_estimate(values, confidence=0.90)
        inside = -math.log(1.1) < interval.lower and interval.upper < math.log(1.1)
        assert (equivalence(t_estimate(values)) < 0.05) == inside
