"""Points for drawing are those of the fitted curve, its band and its outcomes."""

import numpy as np
import pytest

from rockfrag.fragility.checks import goodness_of_fit
from rockfrag.fragility.empirical import TableIda
from rockfrag.fragility.estimators import fit_cloud
from rockfrag.fragility.ida_curves import tables_of_ida_curves
from rockfrag.fragility.observations import observations_from_table
from rockfrag.report.measured_page import calibration_figure, measures_figure

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


@pytest.fixture(scope="module")
def ida():
    """Synthetic IDA curves of eight motions, half of them with a structural resurrection."""
    levels = np.geomspace(0.1, 1.5, 40)
    capacity = 0.4 * np.exp(0.3 * np.random.default_rng(1).normal(size=8))
    table, ratio = ida_of(capacity, levels), np.divide.outer(levels, capacity).T.ravel()
    window = (ratio > 1.3) & (ratio < 1.6) & (np.arange(ratio.size) // 40 % 2 == 0)
    return table.assign(
        pgv_cm_s=80 * table["amplitude_g"] ** 1.2, overturned=table["overturned"] & ~window
    )


def test_each_measure_has_a_panel_with_its_curve(ida):
    pga, pgv = fit_cloud(ida, "amplitude_g"), fit_cloud(ida, "pgv_cm_s")
    data = {name: observations_from_table(ida, name) for name in ("amplitude_g", "pgv_cm_s")}
    figure = measures_figure({"amplitude_g": pga, "pgv_cm_s": pgv}, data)
    assert [axes.get_xlabel() for axes in figure.axes] == ["PGA [g]", "PGV [cm/s]"]
    assert f"AIC {pgv.fit.aic:.1f}" in figure.axes[1].get_title(loc="left")


def test_calibration_is_drawn_with_its_p_value(ida):
    outcomes = observations_from_table(ida, "amplitude_g")
    judged = goodness_of_fit(outcomes, fit_cloud(ida, "amplitude_g").fit, replicates=20)
    figure = calibration_figure({"T1": judged})
    assert figure.axes[0].get_legend().get_texts()[0].get_text().startswith("T1 (p = ")
