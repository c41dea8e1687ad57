"""The weight of a motion's velocity: the maximum of the penalised likelihood, held against known capacities."""

import numpy as np
import pytest
from scipy import optimize, stats

from rockfrag.assess.core.velocity import (
    ERROR,
    FIRST,
    MEMORY,
    MOST_LEVELS,
    STATE,
    WEIGHT,
    fill_weight,
)

LEVELS = np.geomspace(0.05, 2.0, MOST_LEVELS)


def weighed(log_capacities, logs, *, jackknifes=False):
    """What is left of motions, each an earthquake, that topple an object from a level on."""
    fell = np.exp(log_capacities)[:, np.newaxis] <= LEVELS
    allowed, numbers = np.ones_like(fell), np.arange(logs.size)
    tests, found = np.zeros((fell.size, MEMORY)), np.zeros(5)
    given = LEVELS, allowed, fell, logs, numbers
    fill_weight(*given, jackknifes, tests, np.zeros(STATE), found)
    return found, fell


def some_motions(count=60, weight=0.7, scatter=0.3):
    rng = np.random.default_rng(2)
    logs = rng.normal(0.0, 0.5, count)
    return np.log(0.4) - weight * logs + rng.normal(0.0, scatter, count), logs


def test_the_fit_is_the_maximum_of_the_likelihood_with_jeffreys_prior():
    capacities, logs = some_motions()
    found, fell = weighed(capacities, logs)
    x = np.log(LEVELS)[np.newaxis] + 0 * logs[:, np.newaxis]
    rows = np.column_stack([np.ones(x.size), x.ravel(), np.repeat(logs, LEVELS.size)])

    def loss(c):
        eta = rows @ c
        falls, stands = stats.norm.logcdf(eta), stats.norm.logcdf(-eta)
        weight = np.exp(2 * stats.norm.logpdf(eta) - falls - stands)
        _, log = np.linalg.slogdet(rows.T @ (weight[:, np.newaxis] * rows))
        return -np.where(fell.ravel(), falls, stands).sum() - 0.5 * log

    best = optimize.minimize(loss, found[FIRST:] * 1.05 + 0.01, tol=1e-12)
    assert found[FIRST:] == pytest.approx(best.x, rel=1e-4)
    assert loss(found[FIRST:]) <= best.fun + 1e-9


def test_the_weight_is_that_of_the_capacities():
    for weight in (0.0, 0.5, 1.2):
        found, _ = weighed(*some_motions(400, weight, 0.2))
        assert found[WEIGHT] == pytest.approx(weight, abs=0.08)


def test_the_error_is_that_of_weights_of_many_sets():
    rng = np.random.default_rng(6)
    weights, errors = [], []
    for _ in range(40):
        logs = rng.normal(0.0, 0.5, 40)
        capacities = np.log(0.4) - 0.7 * logs + rng.normal(0.0, 0.3, 40)
        found, _ = weighed(capacities, logs, jackknifes=True)
        weights.append(found[WEIGHT])
        errors.append(found[ERROR])
    assert np.median(errors) == pytest.approx(np.std(weights), rel=0.35)


def test_outcomes_that_a_plane_parts_have_a_finite_weight():
    logs = np.linspace(-1, 1, 30)
    found, _ = weighed(np.log(0.4) - 0.5 * logs, logs)
    assert found[WEIGHT] == pytest.approx(0.5, abs=0.1)


def test_where_all_fall_or_none_does_nothing_follows():
    logs = np.linspace(-1, 1, 10)
    for level in (1e-3, 1e3):
        found, _ = weighed(np.full(10, np.log(level)), logs)
        assert np.isnan(found[WEIGHT])
