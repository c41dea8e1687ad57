"""Shaking by what fell and what stands: coverage in synthetic cemeteries, and what does not average out."""

import math

import numpy as np
import pytest
from scipy import special, stats

from rockfrag.base.errors import InputError
from rockfrag.survival.directions_of_falls import fall_direction
from rockfrag.survival.shaking_posterior import (
    Falls,
    Prior,
    ShakingPosterior,
    shaking_posterior,
    smoothed,
)

LEVELS = np.geomspace(2.0, 320.0, 80)
X = np.log(LEVELS)
MIDDLE, BETWEEN_MOTIONS, OWN = math.log(45.0), 0.38, 0.25
PGV, PGV_SPREAD = 40.0, 0.6


def steps(capacities) -> np.ndarray:
    """Whether motions topple an object, by ln of the level from which each does."""
    return (np.asarray(capacities)[:, np.newaxis] <= X).astype(float)


def ratios(rng, count: int) -> np.ndarray:
    """PGV over PGA of motions [cm/s per g]."""
    return np.exp(rng.normal(math.log(110.0), 0.43, count))


def posterior(falls, *, shared: float, prior=None, ratio=None) -> ShakingPosterior:
    motions = len(falls[0].toppled)
    ratio = np.full(motions, 110.0) if ratio is None else ratio
    return shaking_posterior(
        LEVELS,
        LEVELS / ratio[:, np.newaxis],
        falls,
        shared_spread=shared,
        prior=prior,
    )


@pytest.mark.parametrize("stones", [5, 30, 300])
def test_the_interval_of_pgv_holds_it_in_nine_of_ten_synthetic_cemeteries(stones):
    """The motion of a world is none of those by which it is judged, and its model error is its own."""
    rng = np.random.default_rng(58)
    shared, worlds, held = 0.2, 300, 0
    prior = Prior(PGV, PGV_SPREAD)
    for _ in range(worlds):
        pgv = rng.normal(math.log(PGV), PGV_SPREAD)
        fells = rng.normal(MIDDLE, BETWEEN_MOTIONS) + shared * rng.normal()
        fallen = int((pgv > rng.normal(fells, OWN, stones)).sum())
        judged = steps(rng.normal(MIDDLE, BETWEEN_MOTIONS, 50))
        falls = [Falls(fallen, stones, judged, OWN)]
        _, low, high = posterior(falls, shared=shared, prior=prior).pgv()
        held += math.log(low) <= pgv <= math.log(high)
    assert 0.87 <= held / worlds <= 0.93


def test_the_interval_of_pga_holds_it_too_where_both_were_known_before():
    rng = np.random.default_rng(7)
    prior = Prior(PGV, 0.6, 0.3, 0.5, 0.73)
    held = np.zeros(2)
    worlds = 150
    for _ in range(worlds):
        covariance = [[0.36, 0.73 * 0.3], [0.73 * 0.3, 0.25]]
        pgv, pga = rng.multivariate_normal([math.log(PGV), math.log(0.3)], covariance)
        fells = rng.normal(MIDDLE, BETWEEN_MOTIONS)
        fallen = int((pgv > rng.normal(fells, OWN, 40)).sum())
        judged = steps(rng.normal(MIDDLE, BETWEEN_MOTIONS, 50))
        falls = [Falls(fallen, 40, judged, OWN)]
        found = posterior(falls, shared=0.0, prior=prior, ratio=ratios(rng, 50))
        for i, (value, limits) in enumerate(((pgv, found.pgv()), (pga, found.pga()))):
            held[i] += math.log(limits[1]) <= value <= math.log(limits[2])
    assert ((held / worlds > 0.84) & (held / worlds < 0.96)).all()


def test_a_shared_error_of_slenderness_does_not_shrink_with_the_number_of_stones():
    widths = []
    for stones in (10, 100, 1000, 100_000):
        # one motion, known exactly, so that nothing but the shared error is left
        falls = [Falls(stones // 2, stones, steps([MIDDLE]), OWN)]
        _, low, high = posterior(falls, shared=0.2).pgv()
        widths.append(math.log(high / low))
    # 90 % of a normal error of 20 %
    least = 2 * float(special.ndtri(0.95)) * 0.2
    assert widths[0] > widths[1] > widths[2]
    assert widths[-1] == pytest.approx(least, rel=0.05) and min(widths) > 0.95 * least
    own = [Falls(50_000, 100_000, steps([MIDDLE]), OWN)]
    _, low, high = posterior(own, shared=0.0).pgv()
    # two levels
    assert math.log(high / low) < 2 * (X[1] - X[0])


def test_counts_are_binomial_once_the_motion_is_known():
    """One motion and no shared error: Bayes' rule by scipy's binomial on the same levels."""
    falls = [Falls(31, 60, steps([MIDDLE]), OWN), Falls(2, 40, steps([4.4]), 0.3)]
    found = posterior(falls, shared=0.0)
    likelihood = np.ones(LEVELS.size)
    for group, capacity in zip(falls, (MIDDLE, 4.4), strict=True):
        chance = smoothed(X, group.toppled, group.spread)[0]
        # a step at a level lies between it and the one below
        assert np.allclose(
            chance, special.ndtr((X - capacity) / group.spread), atol=0.1
        )
        likelihood *= stats.binom.pmf(group.fallen, group.count, chance)
    assert found.probability == pytest.approx(likelihood / likelihood.sum(), abs=1e-9)


def test_splitting_a_crowd_into_two_says_the_same():
    judged = steps([3.4, 3.8, 4.2])
    whole = posterior([Falls(31, 60, judged, OWN)], shared=0.2).probability
    parts = [Falls(20, 35, judged, OWN), Falls(11, 25, judged, OWN)]
    assert posterior(parts, shared=0.2).probability == pytest.approx(whole)


def test_all_that_fell_bounds_from_below_and_all_that_stands_from_above():
    judged = steps([3.6, 4.0])
    fell = posterior([Falls(8, 8, judged, OWN)], shared=0.1)
    stood = posterior([Falls(0, 8, judged, OWN)], shared=0.1)
    assert fell.open_above and not fell.open_below
    assert stood.open_below and not stood.open_above
    assert fell.pgv()[1] > 25 and stood.pgv()[2] < 60
    half = posterior([Falls(4, 8, judged, OWN)], shared=0.1)
    assert not (half.open_above or half.open_below)
    assert stood.pgv()[0] < half.pgv()[0] < fell.pgv()[0]


def test_what_was_known_before_stays_where_nothing_stands_or_falls_there():
    far = [Falls(0, 5, np.zeros((3, LEVELS.size)), OWN)]
    found = posterior(far, shared=0.2, prior=Prior(PGV, PGV_SPREAD))
    middle, low, high = found.pgv()
    assert middle == pytest.approx(PGV, rel=0.02)
    assert math.log(high / low) == pytest.approx(2 * 1.645 * PGV_SPREAD, rel=0.03)
    assert found.information_bit == pytest.approx(0.0, abs=1e-6)


def test_acceleration_known_before_weighs_the_motions():
    judged = steps([MIDDLE, MIDDLE])
    ratio = np.array([60.0, 200.0])
    falls = [Falls(15, 30, judged, OWN)]
    fast = posterior(falls, shared=0.1, prior=Prior(45.0, 0.5, 0.2, 0.3), ratio=ratio)
    slow = posterior(falls, shared=0.1, prior=Prior(45.0, 0.5, 0.8, 0.3), ratio=ratio)
    assert fast.joint[1].sum() > 0.9 > 0.1 > slow.joint[1].sum()
    assert fast.pga()[0] < slow.pga()[0]


def test_impossible_counts_are_refused():
    with pytest.raises(InputError, match="7 of 5"):
        posterior([Falls(7, 5, steps([MIDDLE]), OWN)], shared=0.1)


def test_falls_point_to_their_mean_and_those_of_chance_point_nowhere():
    rng = np.random.default_rng(2)
    held, alike = 0, []
    for _ in range(200):
        angles = np.degrees(rng.vonmises(math.radians(350), 4.0, 20)) % 360
        found = fall_direction(angles)
        away = abs((found.azimuth - 350 + 180) % 360 - 180)
        held += away <= found.within
        alike.append(fall_direction(rng.uniform(0, 360, 20)).points_somewhere)
        assert found.points_somewhere
    assert 0.84 <= held / 200 <= 0.95
    assert np.mean(alike) < 0.1
    assert fall_direction([10, 20, 30]) is None
    assert fall_direction([0, 90, 180, 270, 45, 225]).within == 180
