"""Fragility from a user's table of tests."""

import numpy as np
import pandas as pd
import pytest

from rockfrag.errors import InputError
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


@pytest.mark.parametrize(
    ("line", "row", "column", "words"),
    [
        ("r1,,0.1,yes,6", 202, "pga_g", "nothing is not a finite number"),
        ("r1,abc,0.1,yes,6", 202, "pga_g", "'abc' is not"),
        ("r1,0,0.1,yes,6", 202, "pga_g", "above zero"),
        ("r1,0.1,-0.1,yes,6", 202, "ratio_s", "above zero"),
        ("r1,0.1,0.1,0.7,6", 202, "fell", "no outcome"),
        (",0.1,0.1,no,6", 202, "Record", "label is missing"),
    ],
)
def test_an_unusable_cell_is_named_by_file_row_and_column(csv, line, row, column, words):
    with csv.open("a") as handle:
        handle.write(line + "\n")
    with pytest.raises(InputError, match=f"rock.csv, row {row}, column '{column}'.*{words}"):
        fit_user_table(csv, MEASURES, overturned="fell", motion="Record")


def test_missing_files_columns_and_rows_are_said(csv, tmp_path):
    with pytest.raises(InputError, match="no such file"):
        fit_user_table(tmp_path / "none.csv", ["pga_g"])
    with pytest.raises(InputError, match="no column 'toppled'; the file has Record"):
        fit_user_table(csv, ["pga_g"], overturned="toppled")
    empty = tmp_path / "empty.csv"
    empty.write_text("pga_g,overturned\n")
    with pytest.raises(InputError, match="no row below the header"):
        fit_user_table(empty, ["pga_g"])
    empty.write_text("")
    with pytest.raises(InputError, match="not a readable CSV"):
        fit_user_table(empty, ["pga_g"])


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
    assert result.surface is not None
    assert result.surface.aic == pytest.approx(309.4, abs=0.1)
    assert result.choice.name == "PGV"
    assert (result.outcomes["pga_g"].n, result.outcomes["pga_g"].n_overturned) == (582, 243)
