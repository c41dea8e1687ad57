"""What stands beside every curve: whether it describes the data, and who moves it."""

import numpy as np
import pandas as pd
import pytest

from rockfrag.fragility.estimators import fit_cloud, fit_step_tests
from rockfrag.fragility.ida_curves import fragility_table
from rockfrag.fragility.lognormal import fit_lognormal
from rockfrag.fragility.measure_selection import recommend_measure
from rockfrag.fragility.observations import observations_from_table
from rockfrag.fragility.vector import fit_vector

from .made import ida_of, reading


def test_capacities_of_two_kinds_are_found_not_lognormal_and_the_shares_are_offered():
    """Half of the motions overturn at 0.1 g, half at 1 g: no lognormal curve is like that."""
    rng = np.random.default_rng(1)
    low, high = 0.1 * np.exp(0.05 * rng.normal(size=20)), np.exp(0.05 * rng.normal(size=22))
    first = reading(fragility_table(ida_of([*low, *high], np.geomspace(0.05, 2.0, 60))))
    assert first["p_fit"] < 0.01
    assert "The lognormal curve is rejected" in first["warnings"]
    assert first["theta_isotonic"] == pytest.approx(1.0, rel=0.15)
    assert first["beta_isotonic"] == pytest.approx(0.5 * np.log(10), rel=0.1)


@pytest.mark.parametrize(
    ("never", "said"),
    [(20, "and which does not go from 16 to 84 %"), (60, "does not reach a half")],
)
def test_shares_of_motions_that_mostly_overturn_nothing_are_offered_without_numbers_that_are_not(
    never: int, said: str
):
    rng = np.random.default_rng(1)
    capacities = [*0.1 * np.exp(0.02 * rng.normal(size=30)), *np.full(6, 1.5), *np.full(never, 9.0)]
    table = fragility_table(ida_of(capacities, np.geomspace(0.05, 2.0, 40)))
    first = reading(table, "mean_probability")
    assert first["p_fit"] < 0.05
    assert said in first["warnings"]
    assert "nan" not in first["warnings"]


def test_lognormal_capacities_pass_and_agree_with_the_shares():
    rng = np.random.default_rng(2)
    ida = ida_of(0.4 * np.exp(0.3 * rng.normal(size=60)), np.geomspace(0.05, 3.0, 120))
    first = reading(fragility_table(ida))
    assert first["p_fit"] > 0.05 and "does not describe" not in first["warnings"]
    assert first["theta_isotonic"] == pytest.approx(first["theta"], rel=0.1)
    assert first["beta_isotonic"] == pytest.approx(first["beta"], rel=0.25)


def test_motion_that_moves_the_median_most_is_named():
    capacities, levels = [0.3, 0.31, 0.29, 0.305, 0.295, 2.0], np.geomspace(0.1, 3.0, 200)
    row, without = (
        reading(fragility_table(ida_of(some, levels))) for some in (capacities, capacities[:-1])
    )
    assert row["influential"] == "m5"
    assert row["influence"] == pytest.approx(without["theta"] / row["theta"], rel=1e-6)


def test_few_motions_are_said():
    row = fragility_table(ida_of([0.3, 0.5, 0.4, 0.6], np.geomspace(0.1, 2.0, 60))).iloc[0]
    assert "based on only 4 motions" in row["warnings"]
    tests = pd.DataFrame(
        {"lower_g": [0.3, 0.4, 0.5], "upper_g": [0.33, 0.44, 0.55], "motion": list("abc")}
    )
    found = fit_step_tests(tests, earthquake=None)
    assert any("only 3 motions" in note for note in found.warnings)


def dependent_tests(seed):
    """Tests of 12 motions in which only PGV decides and each motion has a whim of its own."""
    rng = np.random.default_rng(seed)
    motion = np.repeat(np.arange(12), 40)
    pgv = np.exp(rng.normal(3.0, 0.6, motion.size))
    # a second measure that is constant under a motion can learn the whims by heart
    other = np.exp(rng.normal(0.0, 0.5, 12))[motion]
    whim = 0.4 * rng.normal(size=12)[motion]
    fell = np.log(pgv) + whim + 0.2 * rng.normal(size=motion.size) > 3.0
    return pd.DataFrame({"pgv_cm_s": pgv, "other_cm": other, "overturned": fell, "motion": motion})


def test_second_measure_is_not_recommended_for_what_it_learns_of_the_motions_by_heart():
    """AIC takes 480 tests of 12 motions for independent and asks for the surface nearly always."""
    helped, aic = 0, 0
    for seed in range(20):
        table = dependent_tests(seed)
        choice = recommend_measure(table, ["pgv_cm_s", "other_cm"], replicates=20)
        assert choice.recommended == "pgv_cm_s"
        helped += "use the surface" in choice.words
        lone = fit_lognormal(observations_from_table(table, "pgv_cm_s")).aic
        both = fit_vector(table, ("pgv_cm_s", "other_cm"), earthquake=None, try_interaction=False)
        aic += both.aic < lone - 2
    assert aic >= 10
    assert helped <= 3


def test_measure_that_decides_together_with_another_is_recommended_with_it():
    rng = np.random.default_rng(3)
    motion = np.repeat(np.arange(40), 20)
    first, two = np.exp(rng.normal(0, 0.6, (2, motion.size)))
    fell = np.log(first) + np.log(two) + 0.2 * rng.normal(size=motion.size) > 0
    table = pd.DataFrame({"pga_g": first, "pgv_cm_s": two, "overturned": fell, "motion": motion})
    words = recommend_measure(table, ["pga_g", "pgv_cm_s"], replicates=20).words
    assert "use the surface in both" in words
    assert words.startswith("Use P")


def test_goodness_of_a_cloud_is_kept_with_its_calibration():
    rng = np.random.default_rng(4)
    peaks = np.exp(rng.normal(np.log(0.4), 0.6, 300))
    table = pd.DataFrame(
        {"pga_g": peaks, "overturned": peaks > 0.4 * np.exp(0.3 * rng.normal(size=300))}
    )
    found = fit_cloud(table, "pga_g", motion=None)
    assert found.checks.p_fit == found.checks.goodness.p_value > 0.05
    assert abs(found.checks.largest_residual) < 0.2
