"""A table of measured tests goes from its CSV to a report, and an absent one is named."""

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest

from rockfrag.errors import InputError
from rockfrag.shaketable.tests_table import read_measured
from rockfrag.stages.pedestal import measured_tables
from rockfrag.study.loading import load_any

from .conftest import write_example, write_synthetic
from .running import ROOT, finished, snakemake


def test_the_example_names_the_table_that_the_user_must_give():
    if (ROOT / "resources" / "measured" / "granite_rock_1.csv").exists():
        pytest.skip("somebody has put the table there")
    where = r"measured-example\.yaml: key table: .*resources/measured/granite_rock_1\.csv"
    with pytest.raises(InputError, match=where):
        load_any(ROOT / "config" / "measured-example.yaml")


LACKED = "expected a column of .*pga_g"


@pytest.mark.parametrize(
    ("key", "value", "words"),
    [
        ("confidence", 90, "key confidence: expected a probability"),
        ("measures", {"pga_g": "pga_g"}, r"key measures\.pga_g"),
        ("measures", {"pgv_cm_s": ["pgv"]}, r"measures\.pgv_cm_s\[0\]"),
        ("columns", {"overturned": "fell"}, LACKED),
        ("columns", {"overturned": "overturned", "earthquake": "quake"}, LACKED),
    ],
)
def test_a_wrong_key_of_a_measured_table_is_named(tmp_path: Path, key, value, words):
    write_synthetic(tmp_path)
    with pytest.raises(InputError, match=words):
        load_any(write_example(tmp_path, "synthetic.csv", **{key: value}))


def test_a_synthetic_table_runs_from_csv_to_report(tmp_path: Path):
    write_synthetic(tmp_path)
    write_example(tmp_path, "synthetic.csv", replicates=20)
    finished(snakemake(tmp_path, "--cores", "1"))
    results = tmp_path / "results" / "measured-example"
    curves = pd.read_csv(results / "fragility.csv").set_index("im")
    assert curves.loc["PGV", "theta"] == pytest.approx(40, rel=0.1)
    assert pd.read_parquet(results / "recommendation.parquet")["im"].iloc[0] == "PGV"
    page = (results / "report.html").read_text()
    assert "PGV predicts overturning best" in page
    assert 'class="simulated"' not in page
    assert 'src="http' not in page
    assert (results / "figures" / "two_measures_measured_pga_g_pgv_cm_s.png").stat().st_size > 1000


HEADER = "test,object,pedestal,earthquake,floor,lower_g,upper_g,censored,overturned_body,repetition,remark"


def tables(folder: Path, rows: list[str]) -> dict[str, pd.DataFrame]:
    path = folder / "synthetic.csv"
    path.write_text("\n".join([HEADER, *rows]) + "\n")
    tests = read_measured(path)
    known = {"slenderness": {"T1": 3.0, "T2": 4.0, "T3": 5.0}, "seed": 1}
    settings = SimpleNamespace(confidence=0.9)
    return measured_tables(tests, tests, SimpleNamespace(**known, fragility=settings))


def test_an_empty_table_says_that_it_is_empty(tmp_path: Path):
    found = tables(tmp_path, [])
    assert found["measured/notes"]["note"].iloc[0].endswith("has no rows yet.")


def test_one_test_is_set_beside_the_simulation_and_carries_no_statistics(tmp_path: Path):
    found = tables(tmp_path, ["s,T1,NP,A,GF,0.5,0.55,none,statue,1,synthetic"])
    assert found["measured/beside"]["ratio"].tolist() == [1.0]
    assert len(found["measured/notes"]) == 1


def test_a_full_synthetic_table_has_curves_and_an_effect(tmp_path: Path):
    rng = np.random.default_rng(2)
    rows = []
    for object_name, level in (("T1", 0.5), ("T2", 0.4), ("T3", 0.3)):
        for earthquake in "ABCD":
            for floor in ("GF", "F3", "F5"):
                for side in ("P", "NP"):
                    a = level * np.exp(0.1 * rng.normal())
                    name = f"synthetic {len(rows)}"
                    rows.append(
                        f"{name},{object_name},{side},{earthquake},{floor},{a:.4f},{1.05 * a:.4f},none,statue,1,"
                    )
    found = tables(tmp_path, rows)
    whole = found["measured/effects"].query("scope == 'whole'")["ratio"].iloc[0]
    assert 0.9 < whole < 1.1
    curves = found["measured/fragility"].set_index("configuration")["theta"]
    assert curves["T1"] > curves["T2"] > curves["T3"]
