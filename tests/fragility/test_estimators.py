"""Every estimator returns the parameters that made its data."""

import numpy as np
import pandas as pd
import pytest
from scipy import optimize, stats

from rockfrag.base.errors import InputError
from rockfrag.fragility.censored import brackets_from_table, fit_brackets
from rockfrag.fragility.estimators import (
    fit_cloud,
    fit_incremental,
    fit_step_tests,
    fit_stripes,
)

from .made import ida_of

THETA, BETA = 0.35, 0.4


def capacities(n, seed):
    return np.exp(np.random.default_rng(seed).normal(np.log(THETA), BETA, n))


def step_tests(capacity, step, limit=np.inf, start=0.05):
    """Brackets of tests whose amplitude rises by the factor 1 + step from a random start."""
    rng = np.random.default_rng(int(1000 * step))
    rows = []
    for k, a in enumerate(capacity):
        levels = start * (1 + step) ** (np.arange(400) + rng.random())
        levels = levels[levels <= limit]
        lower, upper = [0.0, *levels[levels < a]], [*levels[levels >= a], np.nan]
        rows.append((f"m{k}", f"e{k}", lower[-1], upper[0]))
    return pd.DataFrame(rows, columns=["motion", "earthquake", "lower_g", "upper_g"])


def within(fit, sigmas=3.5):
    """Both parameters lie within their standard errors of the truth."""
    assert abs(np.log(fit.theta / THETA)) < sigmas * fit.se_log_theta
    assert abs(fit.beta - BETA) < sigmas * fit.se_beta


def test_clouds_recover_the_parameters():
    rng = np.random.default_rng(1)
    im = np.exp(rng.normal(np.log(0.3), 0.7, 1500))
    table = pd.DataFrame(
        {"pga_g": im, "overturned": im > capacities(1500, 2), "motion": range(1500)}
    )
    result = fit_cloud(table, "pga_g")
    within(result.fit)
    # with one test per motion the limits over motions must agree with the likelihood's own
    half = 0.5 * np.log(result.interval.theta[1] / result.interval.theta[0])
    assert half == pytest.approx(1.645 * result.fit.se_log_theta, rel=0.1)


def test_stripes_recover_the_parameters_as_counts_and_as_single_tests():
    levels = np.array([0.1, 0.2, 0.3, 0.4, 0.6, 0.9])
    rng = np.random.default_rng(3)
    counts = rng.binomial(500, stats.norm.cdf(np.log(levels / THETA) / BETA))
    table = pd.DataFrame({"pga_g": levels, "overturned": counts, "trials": 500})
    pooled = fit_stripes(table, "pga_g", trials="trials", motion=None)
    within(pooled.fit)
    level = np.repeat(levels, 500)
    fell = np.concatenate([np.arange(500) < count for count in counts])
    single = pd.DataFrame(
        {"pga_g": level, "overturned": fell, "motion": np.arange(level.size)}
    )
    tests = fit_stripes(single, "pga_g")
    assert tests.fit.theta == pytest.approx(pooled.fit.theta, rel=1e-8)
    assert tests.fit.log_likelihood == pytest.approx(
        pooled.fit.log_likelihood, abs=1e-6
    )
    assert tests.interval.groups == 3000


def test_stripes_without_motions_speak_of_tests():
    """Eight stripes of 40 tests (as Baker's, 2015) are no 8 motions; two of three tests are few tests."""
    levels = np.linspace(0.2, 1.6, 8)
    counts = np.round(40 * stats.norm.cdf(np.log(levels / THETA) / BETA))
    table = pd.DataFrame({"pga_g": levels, "overturned": counts, "trials": 40})
    many = fit_stripes(table, "pga_g", trials="trials", motion=None)
    assert not any("based on only" in words for words in many.warnings)
    few = pd.DataFrame(
        {"pga_g": [0.2, 0.5, 0.9], "overturned": [0, 1, 2], "trials": [2, 2, 3]}
    )
    said = fit_stripes(few, "pga_g", trials="trials", motion=None).warnings
    assert any("based on only 7 tests" in words for words in said)
    named = few.assign(motion=["a", "b", "c"])
    said = fit_stripes(named, "pga_g", trials="trials").warnings
    assert any("based on only 3 motions" in words for words in said)


@pytest.mark.parametrize(("motions", "few"), [(9, True), (10, False)])
def test_ten_motions_are_no_longer_few(motions, few):
    fell = np.array([0, 0, 0, 1, 0, 1, 0, 1, 1, 1])[:motions]
    levels, names = np.linspace(0.2, 1.1, 10)[:motions], list("abcdefghij")[:motions]
    table = pd.DataFrame({"pga_g": levels, "overturned": fell, "motion": names})
    said = fit_cloud(table, "pga_g").warnings
    assert any(f"based on only {motions} motions" in words for words in said) == few


@pytest.mark.parametrize("limit", [np.inf, 0.4])
def test_step_protocols_recover_the_parameters_also_when_a_third_is_censored(limit):
    tests = step_tests(capacities(800, 4), 0.10, limit)
    result = fit_step_tests(tests)
    within(result.fit)
    # nothing is to be warned of
    assert result.fit.warnings == ()
    assert (result.fit.n_overturned < 600) == (limit == 0.4)
    assert result.interval.theta[0] < THETA < result.interval.theta[1]


def test_brackets_of_all_kinds_agree_with_direct_maximisation():
    rng = np.random.default_rng(5)
    a = capacities(40, 6)
    low, high = a * np.exp(-0.2 * rng.random(40)), a * np.exp(0.2 * rng.random(40))
    low[:8], high[8:16] = 0.0, np.nan
    low[16:20] = high[16:20] = a[16:20]
    table = pd.DataFrame({"lower_g": low, "upper_g": high, "motion": range(40)})
    fit = fit_brackets(brackets_from_table(table))

    def minus_log_likelihood(p):
        m, s = p[0], np.exp(p[1])
        lower = np.where(low > 0, np.log(np.maximum(low, 1e-9)), -np.inf)
        upper = np.where(np.isnan(high), np.inf, np.log(high))
        fraction = stats.norm.cdf(upper, m, s) - stats.norm.cdf(lower, m, s)
        density = stats.norm.pdf(np.log(a), m, s)
        return -np.log(np.where(lower == upper, density, fraction)).sum()

    options = {"method": "Nelder-Mead", "options": {"xatol": 1e-9, "fatol": 1e-11}}
    best = optimize.minimize(minus_log_likelihood, [-1, -1], **options)
    assert (fit.theta, fit.beta) == pytest.approx(tuple(np.exp(best.x)), rel=1e-6)
    assert fit.log_likelihood == pytest.approx(-best.fun, abs=1e-8)


@pytest.mark.parametrize(
    ("lower", "upper", "theta", "said"),
    [
        ([0.2, 0.25], [0.3, 0.35], 0.275, "not resolved"),
        ([0.2, 0.25], [np.nan, np.nan], np.nan, "survived 0.2 g"),
        # some capacities are below it and some above, with any dispersion
        (
            [0.0, 0.4, 0.4],
            [0.4, np.nan, np.inf],
            np.nan,
            "one level, 0.4 g, where 1 overturned",
        ),
    ],
)
def test_brackets_that_give_no_curve_or_no_dispersion_say_so(lower, upper, theta, said):
    tests = pd.DataFrame({"lower_g": lower, "upper_g": upper})
    found = fit_step_tests(tests, motion=None, earthquake=None)
    assert found.fit.theta == pytest.approx(theta, rel=0.01, nan_ok=True)
    assert said in found.fit.warnings[0]
    assert np.isnan(theta) == np.isnan([found.fit.beta, *found.interval.theta]).all()


@pytest.mark.parametrize(
    ("low", "high"), [(0.3, 0.2), (-0.1, 0.2), (np.nan, 0.2), (0.0, np.nan)]
)
def test_bounds_that_are_no_bracket_are_refused(low, high):
    with pytest.raises(InputError, match="row 1"):
        brackets_from_table(
            pd.DataFrame({"lower_g": [low], "upper_g": [high]}), motion=None
        )


def test_ida_curves_with_survival_windows_separate_first_from_always():
    levels = np.exp(np.arange(np.log(0.1), np.log(1.5), 0.05))
    first = capacities(300, 9)
    ida, ratio = ida_of(first, levels), np.divide.outer(levels, first).T.ravel()
    # one half survives again between 1.3 and 1.6 times its first overturning
    again = (
        (ratio > 1.3)
        & (ratio < 1.6)
        & (np.repeat(np.arange(300), levels.size) % 2 == 0)
    )
    result = fit_incremental(ida.assign(overturned=ida["overturned"] & ~again))
    within(result.first.fit)
    assert (
        result.first.fit.theta < result.probability.fit.theta < result.always.fit.theta
    )
    assert result.fraction_with_resurrections == pytest.approx(0.5, abs=0.02)
    widths = result.resurrections.query("resurrections == 1").window_width
    assert widths.median() == pytest.approx(np.log(1.6 / 1.3), abs=0.03)


def test_tests_that_overturn_at_once_count_below_all_others_and_those_never_above():
    lower, upper = [0.0, 0.0, 0.3, 0.4, 0.5], [0.2, 0.2, 0.35, 0.45, np.nan]
    tests = pd.DataFrame({"lower_g": lower, "upper_g": upper})
    found = fit_step_tests(tests, motion=None, earthquake=None).checks.fractions
    assert found.fraction[0] == pytest.approx(2 / 5)
    assert found.fraction[-1] == pytest.approx(4 / 5)
    assert 0.2 < found.theta < 0.35
