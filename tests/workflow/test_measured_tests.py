"""Measured tests go through the simulation's statistics; what too few cannot carry is said."""

from pathlib import Path

import numpy as np
import pandas as pd

from rockfrag.shaketable.laboratory_table import read_measured
from rockfrag.stages.measured_tests import measured_tables

HEADER = "test,object,pedestal,earthquake,floor,lower_g,upper_g,censored,overturned_body,repetition,remark"


def tables(folder: Path, rows: list[str]) -> dict[str, pd.DataFrame]:
    path = folder / "synthetic.csv"
    path.write_text("\n".join([HEADER, *rows]) + "\n")
    tests = read_measured(path)
    slenderness = {"T1": 3.0, "T2": 4.0, "T3": 5.0}
    return measured_tables(tests, tests, slenderness, seed=1, level=0.9)


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
