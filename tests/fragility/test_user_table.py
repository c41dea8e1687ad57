"""Fragility from a user's table of tests."""

import numpy as np
import pandas as pd
import pytest

from rockfrag.fragility.user_table import fit_user_table


@pytest.fixture
def csv(tmp_path):
    """200 synthetic tests in which a velocity decides and the acceleration only follows it."""
    rng = np.random.default_rng(1)
    velocity = np.exp(rng.normal(np.log(30.0), 0.8, 200))
    ratio = np.exp(rng.normal(np.log(0.1), 0.5, 200))
    capacity = np.exp(rng.normal(np.log(30.0), 0.25, 200))
    table = pd.DataFrame(
        {
            "Record": [f"r{k % 40}" for k in range(200)],
            "pga_g": velocity / 980.665 / ratio,
            "ratio_s": ratio,
            "fell": np.where(velocity > capacity, "yes", "no"),
            "magnitude": rng.uniform(5, 7.5, 200),
        }
    )
    path = tmp_path / "rock.csv"
    table.to_csv(path, index=False)
    return path


MEASURES = {"pga_g": ["pga_g"], "pgv_cm_s": ["pga_g", "ratio_s", 980.665]}


def test_the_measure_that_decides_is_recommended_with_its_reasons(csv):
    result = fit_user_table(
        csv, MEASURES, overturned="fell", motion="Record", given=["magnitude"], replicates=50
    )
    assert (result.choice.recommended, result.choice.name) == ("pgv_cm_s", "PGV")
    fit = result.fits["pgv_cm_s"].fit
    assert fit.theta == pytest.approx(30.0, rel=0.1)
    assert fit.beta == pytest.approx(0.25, abs=0.1)
    assert result.fits["pgv_cm_s"].interval.groups == 40
    compared = result.choice.table.set_index("im")
    assert compared.loc["PGV", "beta"] < compared.loc["PGA", "beta"]
    assert compared.loc["PGV", "auc"] > compared.loc["PGA", "auc"]
    assert compared.loc["PGV", "chosen_fraction"] > 0.95
    assert compared.loc["PGV", "p_magnitude"] > 0.01
    assert "one measure is enough" in result.choice.words
    assert result.goodness["pgv_cm_s"].p_value > 0.05
    assert set(result.table["measure"]) == {"pga_g", "pgv_cm_s"}
    assert result.bins.groupby("measure").tests.sum().tolist() == [200, 200]


def test_a_table_in_which_all_survived_gives_a_bound_and_no_recommendation(tmp_path):
    path = tmp_path / "stout.csv"
    pd.DataFrame({"pga_g": [0.1, 0.2, 0.3], "overturned": 0}).to_csv(path, index=False)
    result = fit_user_table(path, ["pga_g"])
    assert result.choice.recommended == ""
    assert "None of 3 tests overturned" in result.table["warnings"].iloc[0]


def test_the_granite_rock_follows_its_velocity(shared):
    path = shared / "measured" / "granite_rock_1.csv"
    measures = {"pga_g": ["pga_g"], "pgv_cm_s": ["pga_g", "pgv_over_pga_s", 980.665]}
    result = fit_user_table(path, measures, motion="record", replicates=50)
    assert result.fits["pga_g"].fit.aic == pytest.approx(656.0, abs=0.1)
    assert result.fits["pgv_cm_s"].fit.aic == pytest.approx(309.0, abs=0.1)
    assert result.two_measures is not None
    assert result.two_measures.fits["aic"].iloc[0] == pytest.approx(309.4, abs=0.1)
    assert result.choice.name == "PGV"
    assert (result.outcomes["pga_g"].n, result.outcomes["pga_g"].n_overturned) == (582, 243)
