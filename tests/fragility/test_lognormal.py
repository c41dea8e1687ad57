"""A lognormal fragility curve from outcomes."""

import numpy as np
import pandas as pd
import pytest
import statsmodels.api as sm

from rockfrag.base.errors import InputError
from rockfrag.fragility import lognormal
from rockfrag.fragility.batch_glm import fit_batch
from rockfrag.fragility.estimators import fragility_of
from rockfrag.fragility.lognormal import fit_lognormal
from rockfrag.fragility.observations import labels, observations_from_table

STRIPES = pd.DataFrame(
    {
        "pga_g": [0.2, 0.3, 0.4, 0.6, 0.7, 0.8, 0.9, 1.0],
        "overturned": [0, 0, 0, 4, 6, 13, 12, 16],
        "trials": 40,
    }
)


def outcomes_of(im, outcomes, motions=None):
    table = pd.DataFrame({"pga_g": im, "overturned": outcomes})
    table["motion"] = motions if motions is not None else range(len(table))
    return observations_from_table(table, "pga_g")


def test_published_stripes_give_their_maximum_likelihood_estimate():
    fit = fit_lognormal(
        observations_from_table(STRIPES, "pga_g", trials="trials", motion=None)
    )
    assert fit.theta == pytest.approx(1.076116, abs=1e-5)
    assert fit.beta == pytest.approx(0.429237, abs=1e-5)
    assert fit.log_likelihood == pytest.approx(-10.797705, abs=1e-5)
    assert (fit.se_log_theta, fit.se_beta) == pytest.approx(
        (0.07097, 0.08210), abs=1e-5
    )
    assert (fit.n, fit.n_overturned, fit.im, fit.unit) == (320, 51, "PGA", "g")
    assert fit.probability(fit.theta) == pytest.approx(0.5)
    assert fit.probability(0.0) == 0.0


def test_logit_and_probit_agree_on_the_median():
    rng = np.random.default_rng(2)
    im = 0.35 * np.exp(rng.normal(0.0, 0.8, 5_000))
    cloud = outcomes_of(im, im > 0.35 * np.exp(rng.normal(0.0, 0.4, 5_000)))
    probit, logit = fit_lognormal(cloud), fit_lognormal(cloud, link="logit")
    assert logit.theta == pytest.approx(probit.theta, rel=0.02)
    # sd of the logistic distribution is π/√3; the tails differ, so only nearly
    assert logit.beta * np.pi / np.sqrt(3) == pytest.approx(probit.beta, rel=0.15)


@pytest.mark.parametrize("link", ["probit", "logit"])
def test_the_fast_batch_equals_statsmodels(link):
    rng = np.random.default_rng(3)
    x = rng.normal(size=(60, 2))
    design = np.column_stack([np.ones(60), x])
    trials = rng.integers(0, 4, size=(5, 60)).astype(float)
    failures = rng.binomial(trials.astype(int), 0.2 + 0.6 * (x[:, 0] > 0)).astype(float)
    batch = fit_batch(design, failures, trials, link=link)
    name = sm.families.links.Probit if link == "probit" else sm.families.links.Logit
    assert batch.converged.all()
    for k in range(5):
        used = trials[k] > 0
        counts = np.column_stack([failures[k], trials[k] - failures[k]])[used]
        model = sm.GLM(counts, design[used], family=sm.families.Binomial(name()))
        result = model.fit(tol=1e-13)
        assert batch.coefficients[k] == pytest.approx(result.params, abs=1e-7)
        hessian = -model.hessian(result.params, observed=False)
        assert batch.information[k] == pytest.approx(hessian, rel=1e-5, abs=1e-9)


@pytest.mark.parametrize("link", ["probit", "logit"])
def test_a_fitted_curve_is_that_of_statsmodels(link):
    rng = np.random.default_rng(4)
    for median, spread, count in ((0.3, 0.4, 40), (2.0, 0.9, 200), (0.05, 0.2, 900)):
        im = median * np.exp(rng.normal(0.0, 0.7, count))
        fell = im > median * np.exp(rng.normal(0.0, spread, count))
        found = fit_lognormal(outcomes_of(im, fell), link=link)
        design = np.column_stack([np.ones(count), np.log(im)])
        name = sm.families.links.Probit if link == "probit" else sm.families.links.Logit
        model = sm.GLM(fell.astype(float), design, sm.families.Binomial(name()))
        result = model.fit(tol=1e-13, maxiter=200)
        theta = np.exp(-result.params[0] / result.params[1])
        assert found.theta == pytest.approx(theta, rel=1e-7)
        assert found.beta == pytest.approx(1 / result.params[1], rel=1e-7)
        assert found.log_likelihood == pytest.approx(result.llf, rel=1e-12)


def test_penalised_logit_of_one_proportion_adds_half_a_failure_and_half_a_survival():
    # Firth (1993): with a logit link and a constant the penalised estimate is (y + 1/2) / (n + 1)
    counts = np.array([[0.5], [3.0]]), np.array([[7.0]] * 2)
    fit = fit_batch(np.ones((1, 1)), *counts, link="logit", penalised=True)
    expected = np.array([(0.5 + 0.5) / 8, 3.5 / 8])
    assert 1 / (1 + np.exp(-fit.coefficients[:, 0])) == pytest.approx(
        expected, abs=1e-9
    )


def test_separated_outcomes_give_a_penalised_estimate_inside_the_gap_and_say_so():
    fit = fit_lognormal(outcomes_of([0.1, 0.2, 0.3, 0.5, 0.6, 0.7], [0, 0, 0, 1, 1, 1]))
    assert "penalised" in fit.method
    assert 0.3 < fit.theta < 0.5
    assert fit.beta > 0.02  # not the silent 4e-4 of an unpenalised fit
    assert any("0.3" in note and "0.5" in note for note in fit.warnings)


@pytest.mark.parametrize(
    ("outcomes", "said"),
    [
        ([0, 0, 0, 0, 0, 0], "θ is above"),
        ([1, 1, 1, 1, 1, 1], "θ is below"),
        ([1, 1, 0, 1, 0, 0], "does not rise"),
        ([1, 1, 1, 0, 0, 0], "does not rise"),
    ],
)
def test_outcomes_that_agree_or_fall_with_the_measure_give_a_reason_and_no_curve(
    outcomes, said
):
    fit = fit_lognormal(outcomes_of([0.1, 0.2, 0.3, 0.5, 0.6, 0.7], outcomes))
    assert np.isnan([fit.theta, fit.beta]).all()
    assert said in fit.warnings[0]


def test_tests_at_one_level_of_which_some_overturn_give_their_count_and_no_curve():
    levels = 0.5 * (1 + 1e-15 * np.arange(6))
    found = fragility_of(outcomes_of(levels, [1, 0, 1, 0, 0, 0]))
    assert np.isnan(found.fit.theta) and np.isnan(found.interval.theta).all()
    assert found.fit.warnings == (
        "All 6 tests are at one PGA, 0.5 g, where 2 overturned: a fragility curve needs at least two levels.",
    )


def test_one_motion_and_repeated_rows_are_stated():
    fit = fit_lognormal(
        outcomes_of([0.1, 0.2, 0.3, 0.2, 0.1], [0, 1, 1, 0, 0], ["a"] * 5)
    )
    assert any("one motion" in note for note in fit.warnings)
    assert any("1 of 5 rows repeat" in note for note in fit.warnings)


@pytest.mark.parametrize(
    ("table", "column", "trials", "words"),
    [
        (STRIPES.assign(overturned=41), "pga_g", "trials", "fraction between 0 and 1"),
        (
            STRIPES,
            "pga_g",
            None,
            "row 4, column 'overturned': overturned must be 0 or 1",
        ),
        (STRIPES, "pgv_cm_s", "trials", "no column 'pgv_cm_s'"),
        (STRIPES.iloc[:0], "pga_g", "trials", "no row"),
    ],
)
def test_counts_and_tables_that_cannot_be_are_refused(table, column, trials, words):
    with pytest.raises(InputError, match=words):
        observations_from_table(table, column, trials=trials, motion=None)


def test_many_tests_are_fitted_by_cells_with_the_likelihood_of_the_tests(monkeypatch):
    rng = np.random.default_rng(8)
    levels = rng.choice(np.geomspace(0.2, 2.0, 25), 600)
    fell = rng.uniform(size=600) < levels / (levels + 0.6)
    outcomes = outcomes_of(levels, fell)
    alone = fit_lognormal(outcomes)
    monkeypatch.setattr(lognormal, "MOST_ROWS", 100)
    by_cells = fit_lognormal(outcomes)
    assert by_cells.theta == pytest.approx(alone.theta, rel=1e-9)
    assert by_cells.n_motions == alone.n_motions
    probability = alone.probability(levels)
    expected = np.log(np.where(fell, probability, 1 - probability)).sum()
    assert alone.log_likelihood == pytest.approx(expected, rel=1e-9)
    assert by_cells.log_likelihood == pytest.approx(expected, rel=1e-9)


def test_a_label_that_is_missing_is_named_by_its_row():
    names = pd.DataFrame({"motion": ["a", "b", None, "d"]})
    with pytest.raises(InputError, match=r"table, row 3, column 'motion': the label"):
        labels(names, "motion")
