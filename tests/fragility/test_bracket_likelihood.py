"""The likelihood of capacities between bounds: its terms are its own derivatives, and sum to one."""

import numpy as np
import pytest

from rockfrag.fragility.censored import _fit_weighted, _terms

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
