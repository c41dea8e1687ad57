"""Goodness of fit and intensity-measure selection."""

import numpy as np
import pandas as pd
import pytest
from scipy import stats

from rockfrag.errors import InputError
from rockfrag.fragility.goodness import goodness_of_fit
from rockfrag.fragility.lognormal import fit_lognormal
from rockfrag.fragility.measure_selection import area_under_curve, recommend_measure
from rockfrag.fragility.measure_selection_ida import recommend_ida_measure
from rockfrag.fragility.observations import observations_from_table

from .made import ida_of


def cloud(n, seed, probability):
    rng = np.random.default_rng(seed)
    im = np.exp(rng.normal(np.log(0.35), 0.8, n))
    table = pd.DataFrame({"pga_g": im, "overturned": rng.random(n) < probability(im)})
    return observations_from_table(table, "pga_g", motion=None)


def lognormal(im):
    return stats.norm.cdf(np.log(im / 0.35) / 0.4)


def test_a_wrong_shape_fails():
    wrong = cloud(800, 1, lambda im: np.where(im > 1.0, 0.5, lognormal(im)))
    judged = goodness_of_fit(wrong, fit_lognormal(wrong), replicates=200)
    assert judged.p_value < 0.01
    assert "is rejected" in judged.words


def test_p_values_of_true_curves_are_uniform():
    values = []
    for seed in range(40):
        data = cloud(150, 100 + seed, lognormal)
        values.append(goodness_of_fit(data, fit_lognormal(data), replicates=60).p_value)
    assert stats.kstest(values, "uniform").pvalue > 0.01


def test_the_calibration_curve_lies_on_the_diagonal_for_a_true_curve():
    data = cloud(5000, 2, lognormal)
    table = goodness_of_fit(data, fit_lognormal(data), replicates=20).calibration
    assert table.predicted.to_numpy() == pytest.approx(table.observed.to_numpy(), abs=0.06)
    assert table.tests.sum() == 5000
    inside = table.predicted.between(table.observed_lower, table.observed_upper)
    assert inside.mean() >= 0.7


def test_ida_curves_are_judged_as_motions_with_one_capacity_each():
    rng = np.random.default_rng(3)
    table = ida_of(0.35 * np.exp(0.4 * rng.normal(size=30)), np.geomspace(0.1, 1.2, 20))
    data = observations_from_table(table, "amplitude_g")
    judged = goodness_of_fit(data, fit_lognormal(data), replicates=200)
    assert judged.dependence == "motions"
    assert judged.p_value > 0.05


def test_the_area_under_the_curve_is_the_share_of_ordered_pairs():
    table = pd.DataFrame({"pga_g": [1, 2, 3, 3, 4], "overturned": [0, 1, 0, 1, 1]})
    data = observations_from_table(table, "pga_g", motion=None)
    # pairs (overturned, survived): 2>1, 2<3, 3>1, 3=3, 4>1, 4>3
    assert area_under_curve(data) == pytest.approx((1 + 0 + 1 + 0.5 + 1 + 1) / 6)


def test_a_measure_that_leaves_out_duration_is_found_insufficient():
    rng = np.random.default_rng(4)
    n = 600
    pga = np.exp(rng.normal(np.log(0.35), 0.7, n))
    duration = rng.uniform(5.0, 40.0, n)
    effective = pga * (duration / 15.0) ** 0.4
    table = pd.DataFrame(
        {
            "pga_g": pga,
            "effective_g": effective,
            "duration_s": duration,
            "overturned": effective > 0.35 * np.exp(0.3 * rng.normal(size=n)),
            "motion": np.arange(n),
        }
    )
    choice = recommend_measure(table, ["pga_g", "effective_g"], given=["duration_s"], replicates=50)
    assert choice.recommended == "effective_g"
    found = choice.table.set_index("measure")["p_duration_s"]
    assert found["pga_g"] < 1e-3
    assert found["effective_g"] > 0.01
    worse = recommend_measure(table, ["pga_g"], given=["duration_s"], replicates=20)
    assert "not sufficient" in worse.words


def test_proportional_measures_are_equals_and_make_no_surface():
    data = cloud(300, 5, lognormal)
    table = pd.DataFrame({"a_g": data.im, "b_g": 2.0 * data.im, "overturned": data.overturned})
    choice = recommend_measure(table, ["a_g", "b_g"], motion=None, replicates=20)
    assert "is not distinguishable from" in choice.words
    assert "Adding" not in choice.words


@pytest.mark.parametrize("decides", ["pga_g", "pgv_cm_s", "arias_m_s"])
def test_ida_curves_recommend_the_measure_that_decides(decides):
    rng = np.random.default_rng(11)
    motions = 40
    measures = pd.DataFrame({"name": [f"m{k}" for k in range(motions)]}).assign(
        pga_g=np.exp(rng.normal(-1.0, 0.5, motions)),
        pgv_cm_s=np.exp(rng.normal(3.0, 0.5, motions)),
        arias_m_s=np.exp(rng.normal(0.0, 1.0, motions)),
        magnitude=rng.uniform(5.0, 7.5, motions),
    )
    power = 2 if decides == "arias_m_s" else 1
    # the measure at overturning is 1 with a scatter of 0.2 in ln amplitude
    at_unit = measures[decides] / measures["pga_g"] ** power
    capacity = (np.exp(0.2 * power * rng.normal(size=motions)) / at_unit) ** (1 / power)
    ida = pd.DataFrame(
        [
            {"motion": name, "earthquake": name, "amplitude_g": a, "overturned": a > limit}
            for name, limit in zip(measures["name"], capacity, strict=True)
            for a in limit * np.exp(np.arange(-1.0, 1.0, 0.05) + 0.05 * rng.random())
        ]
    )
    columns = ["pga_g", "pgv_cm_s", "arias_m_s"]
    choice = recommend_ida_measure(ida, measures, columns, given=["magnitude"], replicates=50)
    assert choice.recommended == decides
    best = choice.table.iloc[0]
    assert best["beta_amplitude"] == pytest.approx(0.2, abs=0.06)
    assert best["theta"] == pytest.approx(1.0, rel=0.2 * power)
    assert best["chosen_fraction"] > 0.9 and best["p_magnitude"] > 0.01
    with pytest.raises(InputError, match="does not grow with the amplitude"):
        recommend_ida_measure(ida, measures.assign(d5_95_s=1.0), ["d5_95_s"])
