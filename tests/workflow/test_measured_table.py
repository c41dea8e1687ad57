"""A table of measured tests goes from its CSV to a report, and an absent one is named."""

from pathlib import Path

import pandas as pd
import pytest

from rockfrag.errors import InputError
from rockfrag.study.loading import load_any

from .measured_example import write_example, write_synthetic
from .running import ROOT, snakemake


def test_the_example_names_the_table_that_the_user_must_give():
    if (ROOT / "resources" / "measured" / "granite_rock_1.csv").exists():
        pytest.skip("somebody has put the table there")
    with pytest.raises(InputError) as caught:
        load_any(ROOT / "config" / "measured-example.yaml")
    assert "\n" not in str(caught.value)
    for word in ("measured-example.yaml", "key table", "resources/measured/granite_rock_1.csv"):
        assert word in str(caught.value)


def test_a_wrong_key_of_a_measured_table_is_named(tmp_path: Path):
    write_synthetic(tmp_path)
    with pytest.raises(InputError, match="key confidence: expected a probability"):
        load_any(write_example(tmp_path, "synthetic.csv", confidence=90))
    with pytest.raises(InputError, match=r"key measures\.pga_g"):
        load_any(write_example(tmp_path, "synthetic.csv", measures={"pga_g": "pga_g"}))


def test_a_synthetic_table_runs_from_csv_to_report(tmp_path: Path):
    write_synthetic(tmp_path)
    write_example(tmp_path, "synthetic.csv", replicates=20)
    done = snakemake(tmp_path, "--cores", "1")
    assert done.returncode == 0, done.stderr[-3000:]
    results = tmp_path / "results" / "measured-example"
    curves = pd.read_csv(results / "fragility.csv").set_index("im")
    assert curves.loc["PGV", "theta"] == pytest.approx(40, rel=0.1)
    assert pd.read_parquet(results / "recommendation.parquet")["im"].iloc[0] == "PGV"
    page = (results / "report.html").read_text()
    assert "PGV predicts overturning best" in page
    assert 'class="simulated"' not in page
    assert 'src="http' not in page
    assert (results / "figures" / "two_measures_measured_pga_g_pgv_cm_s.png").stat().st_size > 1000


@pytest.mark.slow
def test_the_granite_rock_runs_through_the_workflow(tmp_path: Path, shared: Path):
    table = (shared / "measured" / "granite_rock_1.csv").resolve()
    write_example(tmp_path, str(table))
    done = snakemake(tmp_path, "--cores", "1")
    assert done.returncode == 0, done.stderr[-3000:]
    results = tmp_path / "results" / "measured-example"
    aic = pd.read_csv(results / "recommendation.csv").set_index("im")["aic"]
    assert aic["PGA"] == pytest.approx(656.0, abs=0.1)
    assert aic["PGV"] == pytest.approx(309.0, abs=0.1)
    page = (results / "report.html").read_text()
    assert "PGV predicts overturning best" in page
    assert "Adding PGA does not improve the prediction" in page
