"""Sorting, quantiles, factors and statics of the core beside NumPy and beside the balance of moments."""

import math

import numpy as np
import pytest
from scipy import special, stats

from rockfrag.assess.core.draws import make_draws
from rockfrag.base.plausible import LARGEST_PEAK
from rockfrag.base.units import GRAVITY

from ...mutants.plain import plain_library

with plain_library():
    from rockfrag.assess.core import (
        bodies,
        demands,
        estimates,
        fractions,
        hazards,
        ordering,
        scales,
        velocity,
    )


def test_numbers_are_sorted_and_summed_up_as_numpy_does():
    rng = np.random.default_rng(1)
    for size in (1, 2, 3, 8, 33):
        values = rng.normal(size=size).round(1)
        ordered = values.copy()
        ordering.sort(ordered)
        assert ordered.tolist() == sorted(values)
        for part in (0.0, 0.05, 0.5, 0.77, 1.0):
            found = ordering.quantile(ordered, size, part)
            assert found == pytest.approx(np.quantile(values, part))
        assert ordering.mean(values) == pytest.approx(values.mean())
        assert ordering.variance(values) == pytest.approx(values.var())
    # of the first numbers alone
    assert ordering.quantile(np.array([1.0, 2.0, 9.0]), 2, 0.5) == 1.5


def test_a_level_lies_between_the_points_of_its_hazard_curve_by_logarithms():
    levels, rates = np.array([0.1, 0.2, 0.5, 1.0]), np.array([1e-1, 3e-2, 1e-3, 1e-4])
    found = np.zeros(1)
    for rate in (1e-1, 5e-2, 3e-2, 1e-2, 5e-4, 1e-4):
        hazards.fill_level(levels, rates, rate, found)
        log = np.interp(-math.log(rate), -np.log(rates), np.log(levels))
        assert found[0] == pytest.approx(math.exp(log))


def test_of_a_spread_a_part_lies_below_a_value_and_without_one_all_or_nothing():
    for middle, spread in ((0.0, 0.1), (-0.4, 0.6), (1.0, 2.0)):
        for value in (-1.0, 0.2, 1.3):
            found = fractions._part(value, middle, spread)
            assert found == pytest.approx(stats.norm.cdf(value, middle, spread))
    assert [fractions._part(value, 0.3, 0.0) for value in (0.2, 0.3, 0.4)] == [0, 1, 1]


def test_a_strength_is_enough_for_95_percent_of_the_motions_and_none_less_is():
    rng = np.random.default_rng(2)
    for count in (1, 2, 20, 21, 41):
        asked = rng.uniform(1, 9, count)
        least = demands.ask(asked, np.zeros(count))
        assert least in asked
        assert demands.count_held(asked, least) >= 0.95 * (count - 1)
        less = asked[asked < least]
        assert less.size == 0 or demands.count_held(asked, less.max()) - 1 < 0.95 * (
            count - 1
        )
    assert demands.ask(np.zeros(0), np.zeros(0)) == 0.0


def test_motions_are_scaled_tenfold_at_most_and_no_further_than_is_believed():
    levels, values = np.array([0.05, 0.5, 5.0, 60.0]), np.array([0.5, 2.0])
    # the second is believed up to twice what it was
    peaks = np.array([0.0, LARGEST_PEAK / 2.0])
    factors, allowed = np.zeros((2, 4)), np.zeros((2, 4), bool)
    scales.fill_scales(levels, values, peaks, factors, allowed)
    assert factors == pytest.approx(levels / values[:, None])
    assert allowed.tolist() == [[True, True, True, False], [False, True, False, False]]
    held = np.zeros((2, 4))
    scales.fill_factors(factors, np.ones((2, 4), bool), peaks, held)
    assert held[0] == pytest.approx(factors[0])
    assert held[1] == pytest.approx(np.minimum(factors[1], 2.0))
    scales.fill_factors(factors, allowed, peaks, held)
    assert (held[~allowed] < 1e-6).all()
    assert scales.peak_of(np.array([1.0, -3.0, 2.0])) == 3.0
    both = np.zeros(3)
    first, second = np.array([1.0, 2.0, 0.0]), np.array([0.0, 1.0, -2.0])
    scales.fill_direction(first, second, 0.6, 0.8, both)
    assert both == pytest.approx(0.6 * first + 0.8 * second)


def test_a_body_lifts_over_the_edge_whose_moment_is_first_overcome():
    """Moment of the weight about each edge against that of the push at the height of the centre."""
    rng, height = np.random.default_rng(3), 0.7
    corners = np.array([(-0.3, -0.2), (0.25, -0.25), (0.35, 0.1), (-0.2, 0.3)])
    x, y = rng.normal(size=(2, 50))
    found = scales.lifting_over_edges(corners, height, x, y)

    def least_moment(factor: float) -> float:
        """Least moment that holds the body down, over all edges and samples, for a unit of mass."""
        least = math.inf
        for here, there in zip(corners, np.roll(corners, -1, axis=0), strict=True):
            way = (there - here) / np.linalg.norm(there - here)
            outward = np.array([way[1], -way[0]])
            # the ground moves, so that the body is pushed the other way
            push = -factor * (outward[0] * x + outward[1] * y)
            least = min(least, (GRAVITY * (outward @ here) - height * push).min())
        return least

    assert least_moment(0.999 * found) > 0 > least_moment(1.001 * found)
    assert scales.lifting_in_plane(0.25, 3.0) * 3.0 == pytest.approx(0.25 * GRAVITY)


def test_a_rim_lifts_at_the_nearest_of_its_points():
    x, y = np.array([1.0, 3.0, 0.0]), np.array([0.0, 4.0, -2.0])
    level = GRAVITY * 0.2 / 0.5 / 5.0
    assert scales.lifting_over_rim(0.2, 0.0, 0.0, 0.5, x, y) == pytest.approx(level)
    aside = scales.lifting_over_rim(0.2, 0.03, -0.04, 0.5, x, y)
    assert aside == pytest.approx(level * 0.15 / 0.2)


@pytest.mark.parametrize("earthquakes", [2, 5, 30])
def test_weights_of_earthquakes_are_dirichlets_as_wide_as_student_asks(earthquakes):
    """So that a mean of n values has the variance t² s²/(n - 1), s² with n in its denominator."""
    weights = make_draws(1, earthquakes).weights
    n, m = earthquakes, earthquakes + 1
    assert weights.shape[1] == m
    assert weights.sum(axis=1) == pytest.approx(1.0)
    assert weights.mean(axis=0) == pytest.approx(1 / m, rel=0.25)
    student = stats.t(n - 1).ppf(0.95) / special.ndtri(0.95)
    # Dirichlet's parameter a: n a + 1 values are as good as (n - 1)/t²
    a = max((n - 1) / student**2 - 1, 0.1 * n) / n
    expected = (1 / m) * (1 - 1 / m) / (m * a + 1)
    assert weights.var(axis=0).mean() == pytest.approx(expected, rel=0.1)


def test_errors_of_a_rate_leave_its_mean_and_have_their_spreads():
    z = special.ndtri((np.arange(4000) + 0.5) / 4000)
    normals = np.column_stack([z, np.random.default_rng(4).permutation(z)])
    rates, spreads = np.full(4000, 2e-3), np.array([0.3, 0.5])
    estimates.fill_errors(rates, normals, spreads)
    assert rates.mean() == pytest.approx(2e-3, rel=0.02)
    assert np.log(rates).std() == pytest.approx(math.hypot(*spreads), rel=0.03)
    # a positive normal value is a larger rate
    assert np.corrcoef(np.log(rates), normals @ spreads)[0, 1] == pytest.approx(1.0)


def test_an_interval_holds_nine_tenths_of_the_draws_and_all_fractions_by_one_earthquake():
    draws = make_draws(1, 2)
    size = len(draws.sources)
    values = np.random.default_rng(5).permutation(np.linspace(0.2, 0.7, size))
    for earthquakes, limits in ((2, (0.225, 0.675)), (1, (0.0, 1.0))):
        found, work = np.zeros(estimates.MOTIONS + 2), np.zeros((2, size))
        given = estimates.FRACTION, 1.0, values.mean(), 1.0, values, *work
        estimates.fill_estimate(
            *given, draws.bins, len(draws.weights), earthquakes, found
        )
        assert found[estimates.VALUE] == pytest.approx(0.45)
        inner = found[[estimates.LOWER, estimates.UPPER]]
        assert inner == pytest.approx(limits, abs=2 / size)


def test_a_box_has_the_moments_of_its_sides_alone_and_with_a_square_pedestal():
    width, depth, height, mass = 0.3, 0.5, 1.2, 80.0
    own = np.array([width, height, mass, math.nan, math.nan, 0.0, depth])
    found = np.zeros(4)
    bodies.tell_box(own, own, found)
    sides = (depth, height), (width, height), (width, depth)
    of_box = [mass * (a**2 + b**2) / 12 for a, b in sides]
    assert found == pytest.approx([*of_box, depth])
    for wide in (0.4, 0.7):
        pedestal = np.array([wide, 0.6, 200.0, math.nan, math.nan, 0.0, math.nan])
        whole = np.zeros(7)
        bodies.join(pedestal, own, whole)
        bodies.tell_box(whole, own, found)
        centre = (mass * (0.6 + height / 2) + 200.0 * 0.3) / (mass + 200.0)
        # both about their common centre, by Steiner's rule
        away = mass * (0.6 + height / 2 - centre) ** 2 + 200.0 * (0.3 - centre) ** 2
        below = 200.0 * (wide**2 + 0.6**2) / 12, 200.0 * wide**2 / 6
        assert found[0] == pytest.approx(of_box[0] + below[0] + away)
        assert found[1] == pytest.approx(of_box[1] + below[0] + away)
        assert found[2] == pytest.approx(of_box[2] + below[1])
        assert found[3] == max(depth, wide)


@pytest.mark.parametrize(
    ("faster", "by_statics", "falls", "counts"),
    [
        # as strong as at the next level
        (2.0, False, [0, 1, 1, 1], [1, 1, 1, 0]),
        # what does not rock at a level topples at none
        (2.0, True, [0, 0, 1, 1], [1, 1, 1, 0]),
        (0.5, False, [0, 0, 0, 1], [0, 1, 1, 1]),
        # where it rocks, and did not at the level before, that says nothing
        (0.5, True, [0, 0, 0, 1], [0, 1, 0, 1]),
    ],
)
def test_a_motion_as_fast_as_the_site_is_as_strong_as_at_another_level(
    faster, by_statics, falls, counts
):
    """By one that rocks and topples an object from 4 on, where velocity alone decides."""
    levels, fell = (
        np.array([1.0, 2.0, 4.0, 8.0]),
        np.array([[False, False, True, True]]),
    )
    places = np.zeros((1, 4), dtype=np.int64)
    allowed, overturned, rocked = np.zeros((3, 1, 4), dtype=bool)
    velocity.fill_moved(
        levels,
        np.ones_like(fell),
        fell,
        fell,
        np.array([0.3]),
        np.full(4, 0.3 + math.log(faster)),
        np.zeros(1),
        1.0,
        by_statics,
        np.zeros(4),
        places,
        allowed,
        overturned,
        rocked,
    )
    assert overturned[0].astype(int).tolist() == falls
    assert allowed[0].astype(int).tolist() == counts
    assert (rocked >= overturned).all()
    step = 1 if faster > 1 else -1
    assert places[0].tolist() == np.clip(np.arange(4) + step, 0, 3).tolist()
