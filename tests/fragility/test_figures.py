"""Figures say what the numbers say."""

import numpy as np
import pytest

from rockfrag.fragility.estimators import fit_cloud
from rockfrag.fragility.goodness import goodness_of_fit
from rockfrag.fragility.observations import observations_from_table
from rockfrag.report.figures.fragility import calibration_figure, measures_figure

from .made import ida_of


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
