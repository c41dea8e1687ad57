"""Fractions of overturned tests without a curve."""

import numpy as np
import pandas as pd
import pytest
from scipy import stats

from rockfrag.errors import InputError
from rockfrag.fragility.empirical import (
    find_resurrections,
    fraction_in_bins,
    local_fraction,
    wilson_interval,
)
from rockfrag.fragility.observations import observations_from_table


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
