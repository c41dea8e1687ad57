"""The interval likelihood: right on exact figures, right on steps, right on tests without end."""

import math

import numpy as np
import pytest
from scipy import stats

from rockfrag.errors import InputError
from rockfrag.pedestal.censored import _rectangle, fit_censored
from rockfrag.pedestal.paired_tests import pair_tests


def censor(tests, limit):
    """End every test at ``limit`` [g]."""
    over = tests["amplitude_g"] > limit
    cut = tests.copy()
    cut.loc[over, "censored"] = "right"
    cut.loc[over, "lower_g"] = limit
    cut.loc[over, ["upper_g", "amplitude_g"]] = np.nan
    return cut


def test_rectangle_of_the_bivariate_normal_agrees_with_scipy():
    for rho in (0.0, 0.5, 0.9):
        a, b, c, d = -0.5, 1.2, 0.1, 0.9
        box = stats.multivariate_normal([0, 0], [[1, rho], [rho, 1]])
        theirs = box.cdf([b, d], lower_limit=[a, c])
        item = [np.array([v]) for v in (a, b, c, d)]
        ours = _rectangle(*item, rho, math.sqrt(1 - rho**2))[0]
        assert ours == pytest.approx(theirs, abs=1e-5)


def test_upper_quadrant_has_its_closed_form():
    rho = 0.7
    zero, inf = np.array([0.0]), np.array([np.inf])
    ours = _rectangle(zero, inf, zero, inf, rho, math.sqrt(1 - rho**2))[0]
    assert ours == pytest.approx(0.25 + math.asin(rho) / (2 * math.pi), abs=1e-9)


def test_exact_figures_give_the_mean_of_the_pairs(tests_table):
    tests = tests_table(1)
    table = pair_tests(tests).table
    fit = fit_censored(tests)
    assert fit.effect.mean == pytest.approx(table["d"].mean(), abs=2e-5)
    # of balanced pairs the mean square of d is 2 σ²
    assert 2 * fit.sd_test**2 == pytest.approx(table["d"].var(ddof=0), rel=1e-3)


def test_jackknife_over_earthquakes_is_the_t_interval_on_exact_balanced_data(tests_table):
    tests = tests_table(1)
    effect = fit_censored(tests).effect
    earthquakes = pair_tests(tests).table.groupby("earthquake")["d"].mean()
    assert effect.se == pytest.approx(earthquakes.std(ddof=1) / 2, rel=1e-2)


def test_censored_tests_do_not_bias_the_effect(tests_table):
    """Unfinished tests make the mean of complete pairs low; the likelihood is not."""
    truth, full, kept, fitted = 0.15, [], [], []
    for seed in range(5):
        tests = tests_table(seed, effect=truth, sd_earthquake=0.0, sd_motion=0.0)
        cut = censor(tests, 0.45)
        assert 0.02 < (cut["censored"] == "right").mean() < 0.5
        full.append(pair_tests(tests).table["d"].mean())
        finished = pair_tests(cut).table
        kept.append(finished.loc[finished["bound"] == "", "d"].mean())
        fitted.append(fit_censored(cut).effect.mean)
    error = 0.134 / 6 / math.sqrt(len(fitted))
    assert abs(np.mean(fitted) - truth) < 3 * error
    # on the same data, against the mean that a stronger shaker would have found
    bias_of_kept = np.mean(kept) - np.mean(full)
    assert bias_of_kept < 0
    assert abs(np.mean(fitted) - np.mean(full)) < abs(bias_of_kept) / 2


def test_wide_steps_are_intervals_and_not_figures(tests_table):
    """Steps of 20 %: the reported figure is the end of the step, the truth anywhere inside."""
    truth, fitted = 0.1, []
    for seed in range(5):
        tests = tests_table(seed, effect=truth, sd_earthquake=0.0, sd_motion=0.0)
        steps = np.floor(np.log(tests["amplitude_g"] / 0.05) / math.log(1.2))
        lower = 0.05 * 1.2**steps
        upper = lower * 1.2
        stepped = tests.assign(lower_g=lower, upper_g=upper, amplitude_g=upper)
        fitted.append(fit_censored(stepped).effect.mean)
    error = 0.134 / 6 / math.sqrt(len(fitted))
    assert abs(np.mean(fitted) - truth) < 3 * error


def test_side_that_never_overturned_is_an_error(tests_table):
    tests = tests_table(1)
    cut = censor(tests, 1e-3)
    whole = tests.where(tests["pedestal"] == "NP", cut)
    with pytest.raises(InputError, match="pedestal = P overturned"):
        fit_censored(whole)


def test_pairs_that_agree_to_the_digit_are_said(tests_table):
    tests = tests_table(1, effect=0, sd_earthquake=0, sd_motion=0, sd_pair=0)
    with pytest.raises(InputError, match="same figure"):
        fit_censored(tests)
