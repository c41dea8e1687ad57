"""Levels that are simulated: outcomes at all levels are those of all levels, as far as they change in one band."""

import numpy as np
import pytest

from rockfrag.assess.outcomes import by_band
from rockfrag.outcomes.limit_states import OVERTURNS, ROCKS

LEVELS = np.geomspace(0.05, 8.0, 28)


def all_at_once(capacities, lifting, islands=()):
    """States of motions that topple from a level on, but for islands of the other outcome: (motion, level)."""
    fell = np.asarray(capacities)[:, np.newaxis] <= LEVELS
    for motion, level in islands:
        fell[motion, level] = ~fell[motion, level]
    lifted = np.asarray(lifting)[:, np.newaxis] <= LEVELS
    return {OVERTURNS: (fell & lifted)[np.newaxis], ROCKS: lifted[np.newaxis]}


def found_by_band(whole, lifting):
    """The same states by a band, and how many levels were simulated in which it moves."""
    scales = np.broadcast_to(LEVELS, whole[ROCKS][0].shape).copy()
    counted = []

    def simulate(chosen):
        counted.append(int((chosen & whole[ROCKS][0]).sum()))
        return {name: cases & chosen for name, cases in whole.items()}

    return by_band(scales, np.asarray(lifting), simulate), sum(counted)


def test_outcomes_are_those_of_all_levels_for_a_third_of_the_work():
    rng = np.random.default_rng(1)
    lifting = rng.uniform(0.1, 0.6, 200)
    capacities = lifting * rng.uniform(1.0, 6.0, 200)
    whole = all_at_once(capacities, lifting)
    found, count = found_by_band(whole, lifting)
    for name in (OVERTURNS, ROCKS):
        np.testing.assert_array_equal(found[name], whole[name])
    assert count < 0.4 * whole[ROCKS].size


@pytest.mark.parametrize("capacity", [1e-3, 0.3, 1e3])
def test_all_none_and_one_that_is_never_lifted(capacity):
    lifting = [0.2, 1e6]
    whole = all_at_once([capacity, capacity], lifting)
    found, _ = found_by_band(whole, lifting)
    np.testing.assert_array_equal(found[OVERTURNS], whole[OVERTURNS])
    assert not found[ROCKS][0, 1].any()


def test_outcomes_that_change_there_and_back_are_kept():
    """It topples at a level of the scan, stands at the next and topples for good later: all between counts."""
    first = int(LEVELS.searchsorted(0.2))
    islands = [(0, first + 3), (0, first + 7)]
    whole = all_at_once([LEVELS[first + 9]], [0.2], islands)
    found, _ = found_by_band(whole, [0.2])
    np.testing.assert_array_equal(found[OVERTURNS], whole[OVERTURNS])
