"""Fractions of overturned tests without a curve, and the non-parametric fragility function."""

import numpy as np
import pandas as pd
import pytest
from scipy import stats

from rockfrag.base.errors import InputError
from rockfrag.fragility.counted import count_ida
from rockfrag.fragility.empirical import (
    TableIda,
    find_resurrections,
    fraction_in_bins,
    local_fraction,
    resurrections_of,
    wilson_interval,
)
from rockfrag.fragility.estimators import fragility_of
from rockfrag.fragility.fractions import (
    fractions_of_capacities,
    fractions_of_outcomes,
    knots_of,
)
from rockfrag.fragility.ida_curves import outcome_bins, with_measures
from rockfrag.fragility.measure_selection import area_under_curve
from rockfrag.fragility.observations import cells, observations_from_table
from rockfrag.shaketable.definitions import Swept, swept_of

from .made import ida_of


def ida(fell):
    amplitudes = [round(0.1 * (k + 1), 1) for k in range(len(fell))]
    return pd.DataFrame({"motion": "m", "amplitude_g": amplitudes, "overturned": fell})


def test_windows_are_found_between_first_and_always_whatever_the_order_of_rows():
    table = ida([0, 1, 1, 0, 0, 1, 0, 1, 1])
    row = find_resurrections(table.iloc[::-1]).iloc[0]
    assert (row.first_lower, row.first_upper) == (0.1, 0.2)
    assert (row.always_lower, row.always_upper) == (0.7, 0.8)
    assert row.resurrections == 2
    widths = np.log([(0.5 * 0.6) / (0.3 * 0.4), (0.7 * 0.8) / (0.6 * 0.7)]) / 2
    assert row.window_width == pytest.approx(widths.sum())
    with pytest.raises(InputError, match=r"row 10.*already has the amplitude 0.9"):
        find_resurrections(pd.concat([table, table.tail(1)]))


@pytest.mark.parametrize(
    ("fell", "bounds"),
    [
        # survived to the end: no window closed, no amplitude above which it always overturned
        ([0, 1, 0, 0], (0.1, 0.2, 0.4, np.nan)),
        ([0, 0], (0.2, np.nan, 0.2, np.nan)),
        ([1, 1], (0.0, 0.1, 0.0, 0.1)),
    ],
)
def test_open_ends_of_an_ida_curve_stay_open(fell, bounds):
    row = find_resurrections(ida(fell)).iloc[0]
    names = ["first_lower", "first_upper", "always_lower", "always_upper"]
    assert row[names].tolist() == pytest.approx(bounds, nan_ok=True)
    assert row.resurrections == 0


def test_the_local_share_shows_a_fall_that_no_fitted_curve_can():
    rng = np.random.default_rng(1)
    im = np.repeat([0.1, 0.3, 1.0], 300) * np.exp(0.01 * rng.normal(size=900))
    table = pd.DataFrame({"pga_g": im, "overturned": np.repeat([0, 1, 0], 300)})
    outcomes = observations_from_table(table, "pga_g", motion=None)
    # far beyond the data the nearest tests decide, without a division by zero
    low, peak, high, beyond = local_fraction(outcomes, [0.1, 0.3, 1.0, 1e6])
    assert peak > 0.95 and max(low, high, beyond) < 0.05


def test_bins_hold_about_equal_numbers_and_stripes_keep_their_levels():
    rng = np.random.default_rng(2)
    table = pd.DataFrame({"pga_g": np.exp(rng.normal(size=997)), "overturned": 0})
    cloud = fraction_in_bins(observations_from_table(table, "pga_g", motion=None))
    assert cloud.tests.sum() == 997 and cloud.tests.between(99, 100).all()
    assert (cloud.im_lower.to_numpy()[1:] > cloud.im_upper.to_numpy()[:-1]).all()
    assert cloud.im.between(cloud.im_lower, cloud.im_upper).all()
    table["pga_g"] = rng.choice([0.2, 0.4, 0.8], 997)
    stripes = fraction_in_bins(observations_from_table(table, "pga_g", motion=None))
    assert stripes.im.to_numpy() == pytest.approx([0.2, 0.4, 0.8])
    # as many values as cells have one each, however often they stand there
    assert cells(np.array([1.0] * 9 + [2.0, 3.0]), 3)[1].tolist() == [1.0, 2.0, 3.0]


RNG = 20261122


def outcomes_of(log_capacity, each, levels):
    """Outcomes of motions with one capacity each, so many an earthquake, at common levels."""
    table = ida_of(np.exp(log_capacity), levels, each=each)
    return observations_from_table(table, "amplitude_g", earthquake="earthquake")


def test_outcomes_and_capacities_give_the_same_curve():
    rng = np.random.default_rng(RNG)
    log_a = 0.3 * rng.normal(size=18)
    found = outcomes_of(log_a, 3, np.geomspace(0.2, 5, 1000))
    tested = fractions_of_outcomes(found, found.earthquake, 0.9)
    exact = fractions_of_capacities(log_a, np.arange(18).astype(object) // 3, 0.9)
    assert tested.theta == pytest.approx(exact.theta, rel=0.02)
    assert tested.theta_limits == pytest.approx(exact.theta_limits, rel=0.01)
    assert tested.beta == pytest.approx(exact.beta, rel=0.01)
    assert tested.beta_limits == pytest.approx(exact.beta_limits, rel=0.03)


def test_estimates_lie_in_their_limits_and_the_curve_in_its_band_and_never_falls():
    rng = np.random.default_rng(RNG)
    for earthquakes, each in ((4, 1), (4, 3), (12, 2)):
        for _ in range(30):
            log_a = rng.standard_t(2, earthquakes * each)
            item = outcomes_of(log_a, each, np.geomspace(0.05, 20, 60))
            found = fractions_of_outcomes(item, item.earthquake, 0.9)
            x = np.geomspace(0.01, 100, 200)
            value, lower, upper = found.at(x)
            assert (np.diff(value) >= 0).all() and value[0] == 0
            assert ((lower <= value) & (value <= upper)).all() and (upper > lower).all()
            if np.isfinite(found.theta):
                assert found.theta_limits[0] <= found.theta <= found.theta_limits[1]
            if np.isfinite(found.beta):
                assert found.beta_limits[0] <= found.beta <= found.beta_limits[1]


def test_limits_are_over_earthquakes_and_not_over_amplitudes_or_motions_of_one():
    """Ten motions of one earthquake that agree are worth one motion."""
    rng = np.random.default_rng(RNG)
    of_earthquake = 0.4 * rng.normal(size=5)
    levels = np.geomspace(0.1, 10, 200)
    lone = outcomes_of(of_earthquake, 1, levels)
    tenfold = outcomes_of(np.repeat(of_earthquake, 10), 10, levels)
    item, ten = (
        fractions_of_outcomes(data, data.earthquake, 0.9) for data in (lone, tenfold)
    )
    assert ten.theta_limits == item.theta_limits
    assert ten.upper[0] == item.upper[0] < 1
    # where the limits of the curve pass one half (Woodruff 1952)
    low, high = item.theta_limits
    assert item.upper[item.im <= low].max() < 0.5 <= item.upper[item.im > low].min()
    assert item.lower[item.im < high].max() <= 0.5 < item.lower[item.im >= high].min()
    careless = fractions_of_outcomes(tenfold, tenfold.motion, 0.9)
    assert careless.upper[0] < 0.5 * item.upper[0]


def test_curve_may_stop_below_one_and_then_has_no_more_than_it_knows():
    """A sixth of the motions overturns nothing: the median is known, the 84 % point is not."""
    log_a = np.append(np.linspace(-0.5, 0.4, 10), [np.inf, np.inf])
    found = fractions_of_capacities(log_a, np.arange(12).astype(object), 0.9)
    assert (
        found.theta == pytest.approx(1.05, rel=0.02) and found.theta_limits[1] < np.inf
    )
    assert np.isnan([found.beta, *found.beta_limits]).all()
    few = fractions_of_capacities(
        np.array([0.1, np.inf, np.inf]), np.arange(3).astype(object), 0.9
    )
    assert np.isnan([few.theta, *few.theta_limits]).all()
    of_one_group = fractions_of_capacities(log_a, np.zeros(12, dtype=object), 0.9)
    value, lower, upper = of_one_group.at([1.2])
    assert np.isfinite(value).all() and np.isnan([lower, upper]).all()


def test_points_rise_strictly_even_where_values_differ_by_rounding():
    """Programs that read the points refuse any two at one value."""
    x = np.array([0.5, 0.5 * (1 + 1e-12), 0.7, 0.7 * (1 + 1e-9), 0.9])
    fraction = np.array([0.0, 0.2, 0.5, 0.8, 1.0])
    at, value = knots_of(x, fraction)
    assert (np.diff(at) > 1e-7).all() and (np.diff(value) > 1e-7).all()
    assert value[0] == 0 and value[-1] == 1


def test_many_groups_are_left_out_in_blocks_with_the_same_curve():
    rng = np.random.default_rng(RNG)
    capacity = np.round(0.3 * rng.normal(size=600), 2)
    each = np.arange(600).astype(object)
    many, known = (
        fractions_of_capacities(capacity, groups, 0.9) for groups in (each, each % 60)
    )
    assert np.array_equal(many.fraction, known.fraction)
    assert many.theta == known.theta
    width = (
        np.diff(np.log(many.theta_limits))[0] / np.diff(np.log(known.theta_limits))[0]
    )
    assert 0.6 < width < 1.7


MOTIONS = 24
COLUMNS = ("pga_g", "pgv_cm_s", "arias_m_s")


@pytest.fixture(scope="module")
def counted():
    """Curves of eight earthquakes, most with a resurrection, as a table and as counts of whole and of parts."""
    rng = np.random.default_rng(4)
    levels, capacity = (
        np.geomspace(0.05, 2.0, 120),
        0.4 * np.exp(0.35 * rng.normal(size=MOTIONS)),
    )
    near = np.abs(np.log(levels / capacity[:, None])) < 0.15
    about = {"object": "T", "pedestal": "NP", "floor": "ground", "overturned_body": ""}
    table = ida_of(capacity, levels, each=3).assign(**about)
    table["overturned"] ^= (near & (rng.random(near.shape) < 0.1)).ravel()
    measures = pd.DataFrame({"name": table["motion"].unique()}).assign(
        pga_g=rng.uniform(0.1, 0.6, MOTIONS),
        pgv_cm_s=rng.uniform(5, 50, MOTIONS),
        arias_m_s=rng.uniform(0.1, 2, MOTIONS),
    )
    parts = list(swept_of(table))
    fell = np.vstack([part.overturned for part in parts])
    rows = pd.concat([part.about for part in parts], ignore_index=True)
    whole = [Swept(rows, levels, fell, np.zeros(fell.shape, dtype=np.intp), [""])]
    counts = [
        count_ida(
            resurrections_of(some), some, measures, {"": COLUMNS, "ground": COLUMNS}
        )
        for some in (whole, parts)
    ]
    return TableIda(with_measures(table, measures, COLUMNS)), *counts


@pytest.mark.parametrize("column", COLUMNS)
def test_counts_give_the_curve_of_the_rows(counted, column: str):
    few, many = counted[1]["ground"].outcomes(column), counted[0].outcomes(column)
    for name in ("n", "n_overturned", "n_motions", "n_earthquakes"):
        assert getattr(few, name) == getattr(many, name)
    found, known = fragility_of(few), fragility_of(many)
    # a cell's width in units of β, squared, is what cells change
    assert found.fit.theta == pytest.approx(known.fit.theta, rel=1e-4)
    assert found.fit.beta == pytest.approx(known.fit.beta, rel=1e-3)
    assert found.fit.log_likelihood == pytest.approx(known.fit.log_likelihood, rel=1e-3)
    assert found.interval.theta == pytest.approx(known.interval.theta, rel=1e-3)
    assert found.interval.groups == known.interval.groups == 8
    assert found.checks.p_fit == pytest.approx(known.checks.p_fit, abs=0.02)
    assert area_under_curve(few) == pytest.approx(area_under_curve(many), abs=1e-3)
    bins = [outcome_bins({}, found, few), outcome_bins({}, known, many)]
    assert bins[0]["fraction"].to_numpy() == pytest.approx(
        bins[1]["fraction"].to_numpy(), abs=0.03
    )
    assert bins[0]["motions"].to_numpy() == pytest.approx(
        bins[1]["motions"].to_numpy(), abs=1
    )


@pytest.mark.parametrize("column", COLUMNS)
def test_counts_hold_the_tests_of_the_rows_value_by_value(counted, column: str):
    rows, few = counted[0].outcomes(column), counted[1][""].outcomes(column)
    pooled = few.by_value()
    assert (np.diff(pooled.im) > 0).all()
    assert (pooled.n, pooled.n_overturned) == (few.n, few.n_overturned)
    for im, fell, trials in zip(
        pooled.im, pooled.overturned, pooled.trials, strict=True
    ):
        here = few.im == im
        assert (fell, trials) == (few.overturned[here].sum(), few.trials[here].sum())
    # motions of one capacity: above it all their tests overturn, in whatever cell
    capacity = np.log(np.quantile(rows.im, [0.3, 0.6]) * (1 + 1e-6))
    edges = np.quantile(few.im, [0.2, 0.5, 0.8])
    cell = np.searchsorted(edges, few.im, side="right")
    found = few.drawn(np.repeat(capacity[:, None], MOTIONS, axis=1), cell)
    # a cell of counts is known to its width
    at = np.searchsorted(edges, rows.im, side="right")
    for one, numbers in zip(capacity, found, strict=True):
        falls = rows.log_im > one
        assert numbers.sum() == falls.sum()
        assert numbers == pytest.approx(np.bincount(at, falls, minlength=4), abs=4)


def test_parts_change_nothing_and_windows_are_those_of_the_table(counted):
    table, *counts = counted
    known = table.resurrections("amplitude_g")
    whole, parts = (count[""] for count in counts)
    for found in (whole, parts):
        windows = found.resurrections("amplitude_g")[known.columns]
        pd.testing.assert_frame_equal(windows, known, check_dtype=False)
    outcomes = [found.outcomes("pga_g").overturned for found in (whole, parts)]
    assert np.array_equal(*outcomes)


def test_on_a_floor_its_own_motions_count_alone():
    rng, levels, parts = np.random.default_rng(5), np.geomspace(0.05, 2.0, 30), []
    about = {"object": "T", "pedestal": "NP", "overturned_body": ""}
    for floor in ("hall", "loft"):
        table = ida_of(rng.uniform(0.1, 1.0, 4), levels).assign(floor=floor, **about)
        table["motion"] += floor
        parts.append(list(swept_of(table)))
    hall, loft = parts
    names = [name for each in (hall + loft) for name in each.about["motion"].unique()]
    measures = pd.DataFrame({"name": names, "pga_g": rng.uniform(0.1, 0.6, 8)})
    alone, beside = (
        count_ida(resurrections_of(some), some, measures, {"hall": ["pga_g"]})["hall"]
        for some in (hall, hall + loft)
    )
    for name in ("im", "overturned", "trials"):
        own, found = (getattr(each.outcomes("pga_g"), name) for each in (alone, beside))
        assert np.array_equal(own, found)
    assert list(beside.resurrections("amplitude_g")["floor"]) == ["hall"] * 4


def test_binomial_limits_are_those_of_wilson():
    """Where the fraction lies as many standard errors of itself away as belong to the level (Wilson, 1927)."""
    fell, trials = np.array([0.0, 3.0, 10.0]), np.array([10.0, 12.0, 10.0])
    for level, z in ((0.90, 1.6448536), (0.95, 1.9599640)):
        limits = np.array(wilson_interval(fell, trials, level))
        away = np.abs(fell / trials - limits)
        expected = z * np.sqrt(limits * (1 - limits) / trials)
        np.testing.assert_allclose(away, expected, rtol=1e-6, atol=1e-7)
        # the limit of "none of n": z² / (n + z²)
        assert limits[1, 0] == pytest.approx(z**2 / (10 + z**2), rel=1e-6)


def test_each_value_counts_where_a_single_motion_tried_it():
    outcomes = observations_from_table(
        pd.DataFrame({"pga_g": [0.1, 0.2, 0.3, 0.4], "overturned": [0, 0, 1, 1]}),
        "pga_g",
        motion=None,
    )
    found = fractions_of_outcomes(outcomes, np.array(list("abcd"), object), 0.9)
    np.testing.assert_array_equal(found.fraction, [0.0, 0.0, 1.0, 1.0])
    assert 0.2 <= found.theta <= 0.3


def test_the_local_fraction_is_the_mean_under_a_normal_kernel_of_half_silvermans_width():
    im, fell = np.array([0.1, 0.2, 0.4, 0.5, 0.9]), np.array([0, 1, 0, 1, 1])
    table = pd.DataFrame({"pga_g": im, "overturned": fell})
    wide = 0.53 * np.log(im).std() * 5**-0.2
    at = np.array([0.08, 0.3, 0.45, 1.0])
    weight = stats.norm.pdf(np.log(at)[:, None], np.log(im), wide)
    expected = weight @ fell / weight.sum(axis=1)
    outcomes = observations_from_table(table, "pga_g", motion=None)
    assert local_fraction(outcomes, at) == pytest.approx(expected)


def test_counts_have_the_local_fraction_of_as_many_single_tests():
    counts = pd.DataFrame(
        {"pga_g": [0.1, 0.3, 0.8], "overturned": [0, 3, 4], "trials": [2, 7, 5]}
    )
    alone = [
        {"pga_g": row.pga_g, "overturned": k < row.overturned}
        for row in counts.itertuples()
        for k in range(row.trials)
    ]
    pooled = observations_from_table(counts, "pga_g", trials="trials", motion=None)
    single = observations_from_table(pd.DataFrame(alone), "pga_g", motion=None)
    at = [0.1, 0.2, 0.5, 1.0]
    assert local_fraction(pooled, at) == pytest.approx(local_fraction(single, at))


@pytest.mark.parametrize("names", [["a", "a", "b"], ["a", "b", "b"]])
def test_measures_that_name_a_motion_twice_are_refused(names):
    measures = pd.DataFrame({"name": names, "pga_g": [0.3, 0.4, 0.5]})
    ida_curve = pd.DataFrame({"motion": ["a", "b"], "amplitude_g": [0.1, 0.2]})
    with pytest.raises(InputError, match="has two rows"):
        with_measures(ida_curve, measures, ["pga_g"])
