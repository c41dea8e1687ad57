"""Statistics of curves beside the same computed in another, plainer way."""

import itertools
import math

import numpy as np
import pandas as pd
import pytest
import statsmodels.api as sm
from scipy import special, stats

from rockfrag.fragility.batch_glm import fit_batch
from rockfrag.fragility.censored import (
    Brackets,
    bracket_interval,
    bracket_log_scores,
)
from rockfrag.fragility.exports import StateCurve, _nested
from rockfrag.fragility.fractions import (
    _dispersion,
    _limits,
    _witnesses,
    fractions_of_capacities,
    fractions_of_outcomes,
)
from rockfrag.fragility.held_out import fraction_best, outcome_scores, paired_p
from rockfrag.fragility.observations import observations_from_table
from rockfrag.fragility.toppling_velocity import toppling_velocity


def test_beyond_all_that_was_tried_the_limits_are_those_of_a_fraction():
    """Nothing is known below the lowest value but that the fraction is no less than 0, and above but 1."""
    table = pd.DataFrame(
        {
            "pga_g": np.repeat([0.2, 0.4, 0.8], 4),
            "overturned": [0, 1] * 2 + [0, 1, 1, 1] * 2,
        }
    )
    data = observations_from_table(table, "pga_g", motion=None)
    found = fractions_of_outcomes(data, np.arange(12).astype(object) % 4, 0.9)
    value, lower, upper = found.at([0.19, 0.3, 0.85, 5.0])
    assert found.fraction[0] == 0.5 > value[0] > 0.3
    assert lower[0] == 0.0
    assert (lower[1], upper[1]) == (found.lower[0], found.upper[1])
    assert (lower[2], upper[2]) == (lower[3], upper[3]) == (found.lower[-1], 1.0)
    assert value[3] == found.fraction[-1] < 1


def test_pointwise_limits_are_jeffreys_for_as_many_trials_as_the_error_shows():
    fraction, error = np.array([0.2, 0.5, 0.9]), np.array([0.1, 0.05, 0.1])
    lower, upper = _limits(fraction, error, np.float64(0), 10_000, 0.8)
    for k, (p, e) in enumerate(zip(fraction, error, strict=True)):
        n = p * (1 - p) / e**2
        ends = stats.beta(n * p + 0.5, n - n * p + 0.5).ppf([0.1, 0.9])
        assert (lower[k], upper[k]) == pytest.approx(ends)
    # no more trials than motions
    few = _limits(fraction[:1], error[:1], np.float64(0), 4, 0.8)
    assert few[0][0] == pytest.approx(stats.beta(1.3, 3.7).ppf(0.1))
    # of none among n groups, and of all
    none, every = _limits(np.array([0.0, 1.0]), np.zeros(2), np.float64(6), 50, 0.8)
    assert none[0] == 0.0 and every[1] == 1.0
    assert every[0] == pytest.approx(stats.beta(0.5, 6.5).ppf(0.9))
    assert none[1] == pytest.approx(stats.beta(6.5, 0.5).ppf(0.1))


def test_witnesses_of_none_and_of_all_are_counted_group_by_group():
    rng = np.random.default_rng(1)
    for _ in range(20):
        total = rng.integers(0, 3, (5, 7)).astype(float)
        zeros, ones = sorted(rng.integers(0, 8, 2))
        fraction = np.where(np.arange(7) < zeros, 0.0, 0.5)
        fraction[ones:] = 1.0
        found = _witnesses(fraction, total)
        for k in range(7):
            expected = 0
            for row in total:
                tried = range(k, 7) if fraction[k] == 0 else range(k + 1)
                ends = fraction[k] in (0.0, 1.0)
                expected += ends and any(
                    row[j] and fraction[j] == fraction[k] for j in tried
                )
            assert found[k] == expected


def test_the_dispersion_is_that_of_harrell_and_davis():
    """Quantiles as sums of order statistics under weights of a beta distribution."""
    rng = np.random.default_rng(2)
    capacity = np.sort(rng.normal(size=25))
    fraction = np.arange(1, 26) / 25
    quantiles = []
    for end in (0.1587, 0.8413):
        edges = stats.beta(26 * end, 26 * (1 - end)).cdf(np.arange(26) / 25)
        quantiles.append(np.diff(edges) @ capacity)
    expected = (quantiles[1] - quantiles[0]) / 2
    assert _dispersion(capacity, fraction, 25) == pytest.approx(expected)
    whole = fractions_of_capacities(capacity, np.arange(25).astype(object), 0.9)
    assert whole.beta == pytest.approx(expected, rel=1e-6)


def test_a_bracket_scores_by_its_probability_and_by_none_where_there_is_no_fit():
    lower, upper = np.array([0.1, 0.2, 0.3, 0.4]), np.array([0.2, 0.35, 0.5, math.inf])
    labels = np.array(list("abcd"), dtype=object)
    brackets = Brackets(lower, upper, labels, labels, "PGA", "g")
    weights = np.array([[1.0, 1.0, 1.0, 1.0], [0.0, 0.0, 0.0, 1.0]])
    scores = bracket_log_scores(brackets, weights)
    assert (scores[1] == -np.inf).all()

    def log_likelihood(theta: float, beta: float) -> np.ndarray:
        with np.errstate(divide="ignore"):
            ends = stats.norm.cdf(np.log([lower / theta, upper / theta]) / beta)
        return np.log(ends[1] - ends[0])

    # whatever the curve, all four together are no more probable than under the fit
    best = scores[0].sum()
    others = [
        log_likelihood(theta, beta).sum()
        for theta, beta in itertools.product(
            np.geomspace(0.2, 0.5, 40), np.geomspace(0.2, 1.5, 40)
        )
    ]
    assert max(others) < best < max(others) + 0.01


def test_brackets_that_touch_have_the_limits_of_all_of_them():
    lower, upper = np.array([0.3, 0.2] * 4), np.array([0.4, 0.3] * 4)
    labels = np.arange(8).astype(object)
    found = bracket_interval(Brackets(lower, upper, labels, labels, "PGA", "g"))
    assert found.theta[0] >= 0.2
    if found.method != "jackknife":
        assert found.theta == pytest.approx((0.2, 0.4))


@pytest.mark.parametrize("start", [(0.0, 0.0), (8.0, -6.0), (-6.0, 9.0), (0.0, 25.0)])
@pytest.mark.parametrize("penalised", [True, False])
def test_a_regression_ends_at_the_same_maximum_wherever_it_starts(start, penalised):
    rng = np.random.default_rng(3)
    x = rng.normal(size=40)
    fell = (rng.random(40) < special.ndtr(0.3 + 1.2 * x)).astype(float)
    design, ones = np.column_stack([np.ones(40), x]), np.ones((1, 40))
    fits = [
        fit_batch(design, fell[None], ones, penalised=penalised, start=where)
        for where in (None, np.array(start))
    ]
    assert all(fit.converged.all() for fit in fits)
    assert fits[1].coefficients == pytest.approx(fits[0].coefficients, abs=1e-6)


def test_levels_and_chances_of_exported_states_are_those_of_their_curves_in_the_other_unit():
    states = {
        "first": StateCurve(
            pd.Series(dtype=object), 40.0, 0.5, np.empty(0), np.empty(0)
        ),
        "second": StateCurve(
            pd.Series(dtype=object), 90.0, 0.3, np.empty(0), np.empty(0)
        ),
    }
    levels, chances, lowered = _nested(states, 0.01)
    assert levels.min() == pytest.approx(0.4 * math.exp(-4 * 0.5))
    assert levels.max() == pytest.approx(0.9 * math.exp(4 * 0.3), rel=0.5)
    before = np.ones(levels.size)
    for name, curve in states.items():
        expected = stats.lognorm(curve.beta, scale=curve.theta / 100).cdf(levels)
        assert chances[name] == pytest.approx(np.minimum(expected, before))
        before = chances[name]
    most = stats.lognorm(0.3, scale=0.9).cdf(levels) - stats.lognorm(
        0.5, scale=0.4
    ).cdf(levels)
    assert lowered == pytest.approx(max(0.0, most.max()))


def test_groups_are_scored_by_a_curve_that_knows_nothing_of_them():
    """By a probit of the other groups, one after the other; the penalty hardly moves it."""
    rng = np.random.default_rng(5)
    groups = np.repeat(np.arange(6), 50)
    x = rng.normal(size=300)
    fell = (rng.random(300) < special.ndtr(0.2 + 1.5 * x)).astype(float)
    found = outcome_scores(x[:, None], fell, np.ones(300), groups)
    for group in range(6):
        own = groups == group
        fit = sm.Probit(fell[~own], sm.add_constant(x[~own])).fit(disp=0)
        p = fit.predict(sm.add_constant(x[own]))
        expected = (fell[own] * np.log(p) + (1 - fell[own]) * np.log1p(-p)).sum()
        assert found[group] == pytest.approx(expected, abs=0.25)


def test_the_p_value_of_two_measures_is_that_of_a_paired_t_test():
    rng = np.random.default_rng(6)
    first, second = rng.normal(size=(2, 12))
    assert paired_p(first, second) == pytest.approx(
        stats.ttest_rel(first, second).pvalue
    )
    assert paired_p(first, first) == 1.0
    assert math.isnan(paired_p(first[:1], second[:1]))


def test_the_better_of_two_measures_is_best_in_as_many_samples_as_a_normal_sum_says():
    rng = np.random.default_rng(7)
    scores = np.stack([np.zeros(60), rng.normal(0.1, 1.0, 60)])
    found = fraction_best(scores, 4000, 1)
    expected = stats.norm.cdf(scores[1].mean() / (scores[1].std() / math.sqrt(60)))
    assert found.sum() == pytest.approx(1.0)
    assert found[1] == pytest.approx(expected, abs=0.03)


@pytest.mark.parametrize(
    ("width", "height", "told"),
    [
        *(
            (0.1001, 1.0, True),
            (0.0999, 1.0, False),
            (0.799, 1.5, True),
            (0.801, 1.5, False),
        ),
        *(
            (0.2, 0.301, True),
            (0.2, 0.299, False),
            (0.5, 2.99, True),
            (0.5, 3.01, False),
        ),
        *((0.4, 0.501, True), (0.4, 0.499, False), (0.1, 2.999, True)),
    ],
)
def test_medians_are_told_up_to_the_edges_of_what_was_fitted(width, height, told):
    """Widths of 0.1 to 0.8 m, heights of 0.3 to 3 m, slendernesses from 1.25."""
    assert np.isfinite(toppling_velocity(width, height)[0]) == told
