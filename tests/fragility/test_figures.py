"""Figures say what the numbers say."""

import numpy as np
import pandas as pd
import pytest

from rockfrag.fragility.estimators import fit_cloud
from rockfrag.fragility.goodness import goodness_of_fit
from rockfrag.fragility.observations import observations_from_table
from rockfrag.report.figures.fragility import (
    calibration_figure,
    measures_figure,
)


@pytest.fixture(scope="module")
def ida():
    """Synthetic IDA curves of eight motions, half of them with a structural resurrection."""
    rng = np.random.default_rng(1)
    levels = np.geomspace(0.1, 1.5, 40)
    rows = []
    for k in range(8):
        a = 0.4 * np.exp(0.3 * rng.normal())
        fell = (levels > a) & ~((levels > 1.3 * a) & (levels < 1.6 * a) & (k % 2 == 0))
        rows += [
            {"motion": f"m{k}", "amplitude_g": level, "pgv_cm_s": 80 * level**1.2, "overturned": x}
            for level, x in zip(levels, fell, strict=True)
        ]
    return pd.DataFrame(rows)


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
