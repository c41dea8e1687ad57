"""The likelihood of capacities between bounds: its terms are its own derivatives, and sum to one."""

import numpy as np
import pytest

from rockfrag.fragility.censored import (
    Brackets,
    _fit_weighted,
    _terms,
    _without_a_block,
    fit_brackets,
)

# exact, between two bounds, below one, above one; of ln IM
LOW = np.array([[-0.4, -0.7, -np.inf, 0.3, -2.0]])
HIGH = np.array([[-0.4, 0.2, -0.1, np.inf, 1.5]])
COEFFICIENTS = np.array([[0.35, 1.8], [-0.9, 0.6]])
STEP = 1e-5


def value_at(coefficients):
    return _terms(LOW, HIGH, coefficients).value


@pytest.mark.parametrize(("place", "name"), [(0, "score0"), (1, "score1")])
def test_scores_are_slopes_of_the_likelihood(place, name):
    side = STEP * np.eye(2)[place]
    slope = (value_at(COEFFICIENTS + side) - value_at(COEFFICIENTS - side)) / (2 * STEP)
    found = getattr(_terms(LOW, HIGH, COEFFICIENTS), name)
    assert found == pytest.approx(slope, rel=1e-7, abs=1e-8)


@pytest.mark.parametrize(
    ("score", "place", "name"),
    [
        ("score0", 0, "h00"),
        ("score0", 1, "h01"),
        ("score1", 0, "h01"),
        ("score1", 1, "h11"),
    ],
)
def test_bends_are_slopes_of_the_scores(score, place, name):
    side = STEP * np.eye(2)[place]
    after, before = (
        getattr(_terms(LOW, HIGH, COEFFICIENTS + sign * side), score)
        for sign in (1, -1)
    )
    found = getattr(_terms(LOW, HIGH, COEFFICIENTS), name)
    assert found == pytest.approx((after - before) / (2 * STEP), rel=1e-7, abs=1e-8)


def test_fractions_of_intervals_that_touch_sum_to_one():
    ends = np.array([-np.inf, -8.0, -1.0, -0.2, 0.4, 2.0, 9.0, np.inf])
    fractions = np.exp(_terms(ends[None, :-1], ends[None, 1:], COEFFICIENTS).value)
    assert fractions.sum(axis=1) == pytest.approx(1.0, abs=1e-14)


def test_rows_that_share_a_bracket_and_rows_that_do_not_are_fitted_as_alone():
    low = np.log([0.2, 0.25, 0.5, 0.3])
    high = np.log([0.3, 0.4, 0.7, 0.5])
    # the first two share 0.25 to 0.3, all four nothing
    weights = np.array([[1.0, 1.0, 0.0, 0.0], [1.0, 1.0, 1.0, 1.0]])
    together = _fit_weighted(low, high, weights)
    for row in range(2):
        alone = _fit_weighted(low, high, weights[row : row + 1])
        for name in together._fields:
            both = getattr(together, name)[row], getattr(alone, name)[0]
            assert both[0] == pytest.approx(both[1], rel=1e-9, nan_ok=True)
    assert not np.isnan(together.coefficients[0]).all()
    assert np.isfinite(together.coefficients[1]).all()


def test_of_amplitudes_that_are_all_bounded_on_one_side_there_is_a_level_and_no_slope():
    """All overturned at their first step, or none ever: the probability is one, or none, at every amplitude."""
    low, high = np.log([0.2, 0.3, 0.1]), np.log([0.25, 0.4, 0.35])
    nothing = np.full(3, np.inf)
    ones = np.ones((1, 3))
    at_once = _fit_weighted(-nothing, high, ones).coefficients[0]
    never = _fit_weighted(low, nothing, ones).coefficients[0]
    assert at_once[0] == np.inf and np.isnan(at_once[1])
    assert never[0] == -np.inf and np.isnan(never[1])


def test_where_all_tests_agree_their_likelihood_is_one():
    """A median far enough above all, or below, makes their outcomes certain."""
    bounds = np.array([0.2, 0.3, 0.1])
    names = np.array(list("abc"), dtype=object)
    survived = Brackets(bounds, np.full(3, np.inf), names, names)
    at_once = Brackets(np.zeros(3), bounds, names, names)
    for tests in (survived, at_once):
        fit = fit_brackets(tests)
        assert np.isnan(fit.theta) and fit.log_likelihood == 0


def test_without_a_curve_of_all_each_block_is_left_out_by_a_fit_of_its_own():
    """Half of the tests overturn at once, half never: the flatter a curve, the likelier are both."""
    at_once = np.arange(12) % 2 == 0
    low = np.where(at_once, -np.inf, np.log(0.6))
    high = np.where(at_once, np.log(0.3), np.inf)
    weights = 1.0 - np.eye(12)
    found = _without_a_block(low, high, weights)
    assert np.array_equal(found, _fit_weighted(low, high, weights).coefficients)


def test_where_the_brackets_left_touch_in_one_amplitude_none_is_left_out_by_a_step():
    """Without the last bracket the others share 0.3, and no more: their curve rises there at once."""
    low, high = np.log([0.2, 0.3, 0.2, 0.3, 0.5]), np.log([0.3, 0.4, 0.3, 0.4, 0.6])
    weights = 1.0 - np.eye(5)
    found = _without_a_block(low, high, weights)
    assert np.array_equal(found, _fit_weighted(low, high, weights).coefficients)
    assert -found[4, 0] / found[4, 1] == pytest.approx(np.log(0.3))
    assert found[4, 1] > 1e4 > found[:4, 1].max()
