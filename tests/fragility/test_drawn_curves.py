"""Points for drawing are those of the fitted curve, its band and its outcomes."""

import numpy as np
import pytest

from rockfrag.fragility.ida_curves import tables_of_ida_curves
from rockfrag.fragility.ida_data import TableIda

from .made import ida_of, reading


def tables_of(thresholds):
    """Curve of one body and its points."""
    ida = TableIda(ida_of(thresholds, np.geomspace(0.1, 1.6, 30)))
    return tables_of_ida_curves([({"configuration": "vase"}, ida)], ["amplitude_g"])


def test_the_points_pass_through_the_median_between_the_limits_of_the_band():
    found = tables_of([0.3, 0.4, 0.5, 0.7, 0.9])
    theta = reading(found.curves, "mean_probability")["theta"]
    points = found.bands
    assert np.interp(theta, points["x"], points["probability"]) == pytest.approx(0.5, abs=0.01)
    assert (points["lower"] <= points["probability"]).all()
    assert (points["probability"] <= points["upper"]).all()
    assert found.bins["tests"].sum() == 5 * 30


def test_where_nothing_overturned_there_is_no_curve_but_there_are_outcomes():
    found = tables_of([9.0, 9.0])
    assert found.bands["probability"].isna().all()
    assert (found.bands["local"].dropna() == 0).all()
    assert (found.bins["fraction"] == 0).all()


def test_one_motion_has_a_curve_without_a_band():
    found = tables_of([0.5])
    assert found.bands["lower"].isna().all()
    assert np.isfinite(found.bands["local"]).any()
