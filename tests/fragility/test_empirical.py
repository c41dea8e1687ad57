"""Fractions of overturned tests without a curve, and the non-parametric fragility function."""

import numpy as np
import pandas as pd
import pytest
from scipy import stats

from rockfrag.errors import InputError
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
from rockfrag.fragility.observations import observations_from_table
from rockfrag.shaketable.definitions import Swept

from .made import ida_of


def ida(fell, amplitudes=None, motion="m"):
    amplitudes = amplitudes or [round(0.1 * (k + 1), 1) for k in range(len(fell))]
    return pd.DataFrame({"motion": motion, "amplitude_g": amplitudes, "overturned": fell})


def test_wilson_limits_solve_their_defining_equation():
    lower, upper = wilson_interval([3, 0, 10], [10, 10, 10])
    z = stats.norm.ppf(0.95)
    for p in (lower[0], upper[0]):
        assert abs(0.3 - p) == pytest.approx(z * np.sqrt(p * (1 - p) / 10))
    assert lower[1] == pytest.approx(0.0, abs=1e-12)
    assert upper[2] == pytest.approx(1.0)


def test_windows_are_found_between_first_and_always():
    row = find_resurrections(ida([0, 1, 1, 0, 0, 1, 0, 1, 1])).iloc[0]
    assert (row.first_lower, row.first_upper) == (0.1, 0.2)
    assert (row.always_lower, row.always_upper) == (0.7, 0.8)
    assert row.resurrections == 2
    expected = np.log(np.sqrt(0.5 * 0.6) / np.sqrt(0.3 * 0.4)) + np.log(
        np.sqrt(0.7 * 0.8) / np.sqrt(0.6 * 0.7)
    )
    assert row.window_width == pytest.approx(expected)


def test_the_order_of_rows_does_not_matter_and_open_ends_stay_open():
    table = ida([0, 1, 0, 0])
    pd.testing.assert_frame_equal(find_resurrections(table), find_resurrections(table.iloc[::-1]))
    row = find_resurrections(table).iloc[0]
    # survived to the end: no window closed, no amplitude above which it always overturned
    assert row.resurrections == 0 and np.isnan(row.always_upper) and row.always_lower == 0.4
    never = find_resurrections(ida([0, 0])).iloc[0]
    assert never.first_lower == 0.2 and np.isnan(never.first_upper)
    at_once = find_resurrections(ida([1, 1])).iloc[0]
    assert (at_once.first_lower, at_once.first_upper, at_once.always_lower) == (0.0, 0.1, 0.0)


def test_a_repeated_amplitude_of_a_ida_is_refused():
    with pytest.raises(InputError, match=r"row 2.*already has the amplitude 0.1"):
        find_resurrections(ida([0, 1], [0.1, 0.1]))


def test_the_local_share_shows_a_fall_that_no_fitted_curve_can():
    im = np.repeat([0.1, 0.3, 1.0], 30)
    fell = np.repeat([0, 1, 0], 30)
    outcomes = observations_from_table(
        pd.DataFrame({"pga_g": im, "overturned": fell}), "pga_g", motion=None
    )
    low, peak, high = local_fraction(outcomes, [0.1, 0.3, 1.0], bandwidth=0.2)
    assert peak > 0.95 and low < 0.05 and high < 0.05
    # far beyond the data the nearest tests decide, without a division by zero
    assert local_fraction(outcomes, [1e6], bandwidth=0.2)[0] == pytest.approx(0.0, abs=1e-9)


def test_bins_hold_about_equal_numbers_and_stripes_keep_their_levels():
    rng = np.random.default_rng(2)
    table = pd.DataFrame({"pga_g": np.exp(rng.normal(size=997)), "overturned": 0})
    cloud = fraction_in_bins(observations_from_table(table, "pga_g", motion=None), bins=10)
    assert cloud.tests.sum() == 997 and cloud.tests.between(99, 100).all()
    assert (cloud.im_lower.to_numpy()[1:] > cloud.im_upper.to_numpy()[:-1]).all()
    table["pga_g"] = rng.choice([0.2, 0.4, 0.8], 997)
    stripes = fraction_in_bins(observations_from_table(table, "pga_g", motion=None), bins=10)
    assert stripes.im.to_numpy() == pytest.approx([0.2, 0.4, 0.8])


RNG = 20261122


def swept(log_capacity, earthquakes, levels):
    """Outcomes of motions with one capacity each at common levels."""
    table = ida_of(np.exp(log_capacity), levels)
    labels = [f"e{k}" for k in np.repeat(earthquakes, levels.size)]
    return observations_from_table(
        table.assign(earthquake=labels), "amplitude_g", earthquake="earthquake"
    )


def test_outcomes_and_capacities_give_the_same_curve():
    rng = np.random.default_rng(RNG)
    earthquakes = np.repeat(np.arange(6), 3)
    log_a = 0.3 * rng.normal(size=18)
    found = swept(log_a, earthquakes, np.geomspace(0.2, 5, 1000))
    tested = fractions_of_outcomes(found, found.earthquake, 0.9)
    exact = fractions_of_capacities(log_a, earthquakes.astype(object), 0.9)
    assert tested.theta == pytest.approx(exact.theta, rel=0.02)
    assert tested.theta_limits == pytest.approx(exact.theta_limits, rel=0.01)
    assert tested.beta == pytest.approx(exact.beta, rel=0.01)
    assert tested.beta_limits == pytest.approx(exact.beta_limits, rel=0.03)


def test_estimates_lie_in_their_limits_and_the_curve_in_its_band_and_never_falls():
    rng = np.random.default_rng(RNG)
    for earthquakes, each in ((4, 1), (4, 3), (12, 2)):
        for _ in range(30):
            labels = np.repeat(np.arange(earthquakes), each)
            item = swept(rng.standard_t(2, labels.size), labels, np.geomspace(0.05, 20, 60))
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
    lone = swept(of_earthquake, np.arange(5), levels)
    tenfold = swept(np.repeat(of_earthquake, 10), np.repeat(np.arange(5), 10), levels)
    item, ten = (fractions_of_outcomes(data, data.earthquake, 0.9) for data in (lone, tenfold))
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
    assert found.theta == pytest.approx(1.05, rel=0.02) and found.theta_limits[1] < np.inf
    assert np.isnan(found.beta) and np.isnan(found.beta_limits).all()
    few = fractions_of_capacities(np.array([0.1, np.inf, np.inf]), np.arange(3).astype(object), 0.9)
    assert np.isnan(few.theta) and np.isnan(few.theta_limits).all()


def test_one_group_has_a_curve_and_no_limits():
    found = fractions_of_capacities(np.array([0.1, 0.3]), np.array(["e", "e"], dtype=object), 0.9)
    value, lower, upper = found.at([1.2])
    assert np.isfinite(value).all() and np.isnan(lower).all() and np.isnan(upper).all()


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
    many, known = (fractions_of_capacities(capacity, groups, 0.9) for groups in (each, each % 60))
    assert np.array_equal(many.fraction, known.fraction)
    assert many.theta == known.theta
    width = np.diff(np.log(many.theta_limits))[0] / np.diff(np.log(known.theta_limits))[0]
    assert 0.6 < width < 1.7
    assert (many.lower <= many.fraction).all() and (many.fraction <= many.upper).all()


MOTIONS = 24
AMPLITUDES = np.geomspace(0.05, 2.0, 120)


def parts(size: int) -> list[Swept]:
    """Motions of eight earthquakes that overturn above scattered amplitudes, most with a resurrection."""
    rng = np.random.default_rng(4)
    capacity = 0.4 * np.exp(0.35 * rng.normal(size=MOTIONS))
    near = np.abs(np.log(AMPLITUDES / capacity[:, None])) < 0.15
    fell = (capacity[:, None] < AMPLITUDES) ^ (near & (rng.random(near.shape) < 0.1))
    about = pd.DataFrame(
        {
            "configuration": "T",
            "earthquake": [f"earthquake {k // 3}" for k in range(MOTIONS)],
            "floor": "ground",
            "motion": [f"motion {k}" for k in range(MOTIONS)],
        }
    )
    return [
        Swept(
            about.iloc[i : i + size].reset_index(drop=True),
            AMPLITUDES,
            fell[i : i + size],
            fell[i : i + size].astype(np.intp),
            ("", "statue"),
        )
        for i in range(0, MOTIONS, size)
    ]


def measures() -> pd.DataFrame:
    rng = np.random.default_rng(5)
    return pd.DataFrame(
        {
            "name": [f"motion {k}" for k in range(MOTIONS)],
            "pga_g": rng.uniform(0.1, 0.6, MOTIONS),
            "pgv_cm_s": rng.uniform(5, 50, MOTIONS),
            "arias_m_s": rng.uniform(0.1, 2, MOTIONS),
        }
    )


def rows() -> pd.DataFrame:
    return parts(MOTIONS)[0].rows(("configuration", "earthquake", "floor", "motion"))


@pytest.mark.parametrize("column", ["pga_g", "pgv_cm_s", "arias_m_s"])
def test_counts_give_the_curve_of_the_rows(column: str):
    wanted = {"": [column], "ground": [column]}
    counted = count_ida(resurrections_of(parts(5)), parts(5), measures(), wanted)["ground"]
    table = TableIda(with_measures(rows(), measures(), [column]))
    few, many = counted.outcomes(column), table.outcomes(column)
    assert (few.n, few.n_overturned) == (many.n, many.n_overturned)
    assert (few.n_motions, few.n_earthquakes) == (many.n_motions, many.n_earthquakes)
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
    assert bins[0]["fraction"].to_numpy() == pytest.approx(bins[1]["fraction"].to_numpy(), abs=0.03)
    assert bins[0]["motions"].to_numpy() == pytest.approx(bins[1]["motions"].to_numpy(), abs=1)


def test_parts_change_nothing_and_windows_are_those_of_the_table():
    known = TableIda(rows()).resurrections("amplitude_g")
    counted = [
        count_ida(resurrections_of(parts(k)), parts(k), measures(), {"": ["pga_g"]})[""]
        for k in (1, 7, 24)
    ]
    for found in counted:
        windows = found.resurrections("amplitude_g")[known.columns]
        pd.testing.assert_frame_equal(windows, known, check_dtype=False)
        outcomes = found.outcomes("pga_g").overturned
        assert np.array_equal(outcomes, counted[0].outcomes("pga_g").overturned)
