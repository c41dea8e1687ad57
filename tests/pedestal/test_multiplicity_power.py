"""Adjustments, equivalence and power agree with their definitions."""

import math

import numpy as np
import pytest
from statsmodels.stats.multitest import multipletests

from rockfrag.pedestal.cluster_means import Estimate, equivalence, t_estimate
from rockfrag.pedestal.power import benjamini_hochberg, detectable_ratio, holm
from rockfrag_thesis.hypotheses.contrasts import power_note, power_of_t, units_needed

P = np.array([0.01, 0.04, 0.039, 0.2, 0.6])


@pytest.mark.parametrize(("ours", "name"), [(holm, "holm"), (benjamini_hochberg, "fdr_bh")])
def test_adjusted_p_values_are_those_of_statsmodels(ours, name):
    assert ours(P) == pytest.approx(multipletests(P, method=name)[1], abs=1e-15)


def test_tests_that_could_not_be_made_do_not_count():
    with_nan = holm([*P, math.nan])
    assert np.isnan(with_nan[-1])
    assert with_nan[:-1] == pytest.approx(holm(P))


def test_p_values_outside_0_to_1_are_refused():
    with pytest.raises(ValueError, match="outside 0 to 1"):
        holm([0.2, 1.2])


@pytest.mark.parametrize(("pairs_an_earthquake", "percent"), [(9, 10.0), (3, 17.9)])
def test_four_earthquakes_show_what_the_documentation_says(pairs_an_earthquake, percent):
    """0.134 per pair and no other scatter: the test is t over four means, not over 36 pairs."""
    sd = 0.134 / math.sqrt(pairs_an_earthquake)
    effect = Estimate(0.0, sd / 2, 4, -1.0, 1.0, 1.0)
    assert 100 * (detectable_ratio(effect) - 1) == pytest.approx(percent, abs=0.05)


def test_detectable_change_and_units_needed_have_the_power_by_definition():
    effect = t_estimate([0.1, -0.05, 0.08, 0.02])
    detectable = power_of_t(detectable_ratio(effect), effect.sd, effect.units)
    assert detectable == pytest.approx(0.8, abs=1e-6)
    n = int(units_needed(effect))
    fewer, enough = (power_of_t(effect.ratio, effect.sd, k) for k in (n - 1, n))
    assert fewer < 0.8 <= enough
    assert f"{n} earthquakes" in power_note(effect)


def test_power_of_degenerate_data_is_stated():
    assert detectable_ratio(t_estimate([0.1])) == math.inf
    assert math.isnan(detectable_ratio(t_estimate([0.0, 0.0, 0.0])))
    assert units_needed(t_estimate([0.1, -0.1])) == math.inf
    assert "no power" in power_note(t_estimate([0.1]))
    assert "steps are not known" in power_note(t_estimate([0.0, 0.0, 0.0]))


def test_equivalence_needs_both_sides():
    rng = np.random.default_rng(0)
    near = rng.normal(0, 0.02, 12)
    assert equivalence(t_estimate(near)) < 0.05
    assert equivalence(t_estimate(near + 0.2)) >= 0.05
    assert equivalence(t_estimate(near - 0.2)) >= 0.05
    # few and scattered values: neither different from nothing nor equivalent to it
    vague = t_estimate([0.3, -0.3, 0.2, -0.1])
    assert vague.p > 0.05 and equivalence(vague) >= 0.05


def test_equivalence_agrees_with_the_90_percent_interval():
    for spread in np.linspace(0.02, 0.3, 30):
        values = 0.02 + spread * np.array([-1.0, -0.3, 0.4, 0.9])
        interval = t_estimate(values, confidence=0.90)
        inside = -math.log(1.1) < interval.lower and interval.upper < math.log(1.1)
        assert (equivalence(t_estimate(values)) < 0.05) == inside
