"""Mixed models are believed only when they give the means of balanced data."""

import warnings

import numpy as np
import pytest
import statsmodels.formula.api as smf

from rockfrag.errors import InputError
from rockfrag.pedestal.mixed import (
    AMPLITUDE,
    EFFECT,
    EFFECT_BY_FLOOR,
    FitDisagreementError,
    _Reml,
    check_fixed_effects,
    fit_mixed,
    long_rows,
)
from rockfrag.pedestal.paired_tests import pair_tests

SLENDERNESS = {"T1": 3.0, "T2": 4.0, "T3": 5.0}


def test_intercept_is_the_mean_of_the_pairs(tests_table):
    pairs = pair_tests(tests_table(1)).table
    fit = fit_mixed(pairs, EFFECT)
    assert fit.balanced
    row = fit.coefficients.iloc[0]
    assert row["estimate"] == pytest.approx(pairs["d"].mean(), abs=1e-4 * row["se"])


def test_variances_are_those_of_the_analysis_of_variance(tests_table):
    # where each mean square exceeds the one below, REML of balanced data equals the classic table
    pairs = pair_tests(tests_table(5, sd_event=0.3, sd_motion=0.2)).table
    fit = fit_mixed(pairs, EFFECT)
    motion = pairs.groupby(["event", "floor"])["d"].mean()
    event = motion.groupby("event").mean()
    within = pairs["d"] - pairs.groupby(["event", "floor"])["d"].transform("mean")
    ms_residual = (within**2).sum() / 24
    ms_motion = 3 * ((motion - event.reindex(motion.index, level="event")) ** 2).sum() / 8
    ms_event = 9 * event.var(ddof=1)
    assert ms_event > ms_motion > ms_residual
    assert fit.sd_residual**2 == pytest.approx(ms_residual, rel=1e-3)
    assert fit.sd_motion**2 == pytest.approx((ms_motion - ms_residual) / 3, rel=1e-3)
    assert fit.sd_event**2 == pytest.approx((ms_event - ms_motion) / 9, rel=1e-3)
    assert fit.coefficients["se"][0] == pytest.approx(np.sqrt(ms_event / 36), rel=1e-3)


def test_floor_coefficients_are_differences_of_floor_means(tests_table):
    pairs = pair_tests(tests_table(2, floor_effect={"GF": 0.2, "F5": -0.1}), SLENDERNESS).table
    fit = fit_mixed(pairs, EFFECT_BY_FLOOR)
    terms = fit.coefficients.set_index("term")["estimate"]
    means = pairs.groupby("floor")["d"].mean()
    # sum coding drops the last floor in alphabetical order, GF
    assert terms["C(floor, Sum)[S.F3]"] == pytest.approx(means["F3"] - means.mean(), abs=1e-6)
    assert terms["C(floor, Sum)[S.F5]"] == pytest.approx(means["F5"] - means.mean(), abs=1e-6)


def test_amplitude_model_gives_the_same_pedestal_effect_as_the_pairs(tests_table):
    pairs = pair_tests(tests_table(2), SLENDERNESS).table
    fit = fit_mixed(long_rows(pairs), AMPLITUDE)
    terms = fit.coefficients.set_index("term")["estimate"]
    third_floor = pairs[pairs["floor"] == "F3"]
    assert terms["C(ped)[T.1]"] == pytest.approx(third_floor["d"].mean(), abs=1e-5)


@pytest.mark.parametrize("formula", [EFFECT, EFFECT_BY_FLOOR])
@pytest.mark.parametrize("seed", range(3))
def test_direct_search_reaches_the_likelihood_of_statsmodels_or_more(tests_table, seed, formula):
    """The fixed effects are the same, and no optimiser finds a better maximum."""
    rows = pair_tests(tests_table(seed, sd_event=0.3, sd_motion=0.2), SLENDERNESS).table
    ours = fit_mixed(rows, formula)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        theirs = smf.mixedlm(
            formula,
            rows.assign(one=1),
            groups="one",
            re_formula="0",
            vc_formula={"event": "0+C(event)", "motion": "0+C(event):C(floor)"},
        ).fit(reml=True, method="bfgs")
    terms = ours.coefficients.set_index("term")["estimate"]
    assert terms.to_numpy() == pytest.approx(np.asarray(theirs.fe_params), abs=1e-6)
    reml = _Reml(theirs.model.endog, theirs.model.exog, rows)
    at_theirs = reml.at(np.asarray(theirs.vcomp) / theirs.scale).loglik
    at_ours = reml.at(np.array([ours.sd_event, ours.sd_motion]) ** 2 / ours.sd_residual**2).loglik
    assert at_ours >= at_theirs - 1e-6


def test_zero_intercept_is_refused():
    with pytest.raises(FitDisagreementError, match="Intercept came out as 0, but the means"):
        check_fixed_effects(["Intercept"], EFFECT, np.zeros(1), np.array([0.1]), np.ones(1))


def test_nan_is_refused():
    with pytest.raises(FitDisagreementError):
        check_fixed_effects(["Intercept"], EFFECT, np.array([np.nan]), np.zeros(1), np.ones(1))


def test_missing_pairs_are_fitted_and_marked_unbalanced(tests_table):
    pairs = pair_tests(tests_table(1).iloc[6:]).table
    fit = fit_mixed(pairs, EFFECT)
    assert not fit.balanced
    assert fit.coefficients["estimate"][0] == pytest.approx(pairs["d"].mean(), abs=0.02)


def test_too_few_motions_or_no_scatter_is_said(tests_table):
    pairs = pair_tests(tests_table(1)).table
    with pytest.raises(InputError, match="at least two events"):
        fit_mixed(pairs[pairs["event"] == "Kobe"], EFFECT)
    with pytest.raises(InputError, match="no scatter"):
        fit_mixed(pairs.assign(d=0.0), EFFECT)


def test_variance_that_the_data_do_not_show_is_zero(tests_table):
    """Event means closer together than their motions allow: REML's event variance is zero."""
    pairs = pair_tests(tests_table(1)).table
    table = pairs.assign(d=pairs["d"] - pairs.groupby("event")["d"].transform("mean") + 0.1)
    fit = fit_mixed(table, EFFECT)
    assert fit.sd_event == pytest.approx(0, abs=2e-3)
    assert fit.coefficients["estimate"][0] == pytest.approx(0.1, abs=1e-6)
