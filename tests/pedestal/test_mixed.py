"""Mixed models are believed only when they give the means of balanced data."""

import numpy as np
import pytest

from rockfrag.errors import InputError
from rockfrag.pedestal.mixed import (
    AMPLITUDE,
    EFFECT,
    EFFECT_BY_FLOOR,
    FitDisagreementError,
    check_fixed_effects,
    fit_mixed,
    long_rows,
)
from rockfrag.pedestal.paired_tests import pair_tests


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
    pairs = pair_tests(tests_table(2, floor_effect={"GF": 0.2, "F5": -0.1})).table
    fit = fit_mixed(pairs, EFFECT_BY_FLOOR)
    terms = fit.coefficients.set_index("term")["estimate"]
    means = pairs.groupby("floor")["d"].mean()
    # sum coding drops the last floor in alphabetical order, GF
    assert terms["C(floor, Sum)[S.F3]"] == pytest.approx(means["F3"] - means.mean(), abs=1e-6)
    assert terms["C(floor, Sum)[S.F5]"] == pytest.approx(means["F5"] - means.mean(), abs=1e-6)


def test_amplitude_model_gives_the_same_pedestal_effect_as_the_pairs(tests_table):
    pairs = pair_tests(tests_table(2)).table
    fit = fit_mixed(long_rows(pairs), AMPLITUDE)
    terms = fit.coefficients.set_index("term")["estimate"]
    third_floor = pairs[pairs["floor"] == "F3"]
    assert terms["C(ped)[T.1]"] == pytest.approx(third_floor["d"].mean(), abs=1e-5)


@pytest.mark.parametrize("optimiser", ["lbfgs", "bfgs"])
@pytest.mark.parametrize("seed", range(4))
def test_no_event_variance_never_ends_in_a_silent_zero(tests_table, optimiser, seed):
    """Whatever the optimiser: either the mean of the data comes out, or an error."""
    pairs = pair_tests(tests_table(seed, sd_event=0.0)).table
    try:
        fit = fit_mixed(pairs, EFFECT, optimiser=optimiser)
    except FitDisagreementError:
        assert optimiser == "lbfgs"
        return
    assert fit.coefficients["estimate"][0] == pytest.approx(pairs["d"].mean(), abs=1e-5)
    assert fit.coefficients["estimate"][0] != 0.0


def test_zero_intercept_is_refused():
    with pytest.raises(FitDisagreementError, match="Intercept came out as 0, but the means"):
        check_fixed_effects(["Intercept"], EFFECT, np.zeros(1), np.array([0.1]), np.ones(1), True)


def test_nan_is_refused():
    with pytest.raises(FitDisagreementError):
        check_fixed_effects(
            ["Intercept"], EFFECT, np.array([np.nan]), np.zeros(1), np.ones(1), True
        )


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


def test_optimiser_that_returns_zero_as_converged_is_caught(tests_table, monkeypatch):
    """The trap itself: an intercept of exactly zero, said to have converged."""
    pairs = pair_tests(tests_table(1, sd_event=0.0)).table

    class Zero:
        fe_params = np.zeros(1)
        vcomp = np.array([1e9, 1e-3])
        scale = 0.02
        converged = True

    monkeypatch.setattr(
        "statsmodels.regression.mixed_linear_model.MixedLM.fit", lambda self, **options: Zero()
    )
    with pytest.raises(FitDisagreementError, match="Intercept came out as 0"):
        fit_mixed(pairs, EFFECT, optimiser="lbfgs")


def test_variance_that_the_data_do_not_show_is_zero_whatever_the_optimiser_says(tests_table):
    """Event means closer together than their motions allow: REML's event variance is zero."""
    pairs = pair_tests(tests_table(1)).table
    table = pairs.assign(d=pairs["d"] - pairs.groupby("event")["d"].transform("mean") + 0.1)
    fit = fit_mixed(table, EFFECT)
    assert fit.sd_event == pytest.approx(0, abs=2e-3)
    assert fit.coefficients["estimate"][0] == pytest.approx(0.1, abs=1e-6)


@pytest.mark.parametrize("formula", [EFFECT, EFFECT_BY_FLOOR])
def test_large_sets_use_the_direct_search_alone_with_the_same_result(
    tests_table, monkeypatch, formula
):
    pairs = pair_tests(tests_table(1)).table
    both = fit_mixed(pairs, formula).coefficients
    monkeypatch.setattr("rockfrag.pedestal.mixed.LARGEST_FOR_STATSMODELS", 10)
    direct = fit_mixed(pairs, formula)
    assert direct.notes[0].endswith("direct search of the restricted likelihood only")
    for column in ("estimate", "se"):
        assert direct.coefficients[column].to_numpy() == pytest.approx(
            both[column].to_numpy(), abs=1e-6
        )
