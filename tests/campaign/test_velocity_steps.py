"""A base that is hit and stopped, as a campaign with the size of the block as the one unknown."""

import csv
import json
import logging
from pathlib import Path

import pytest

from rockfrag.base.yaml_file import read_yaml
from rockfrag.stages.campaign import run
from rockfrag.stages.job import Job
from rockfrag.study.loading import load_any

ROOT = Path(__file__).parents[2]


def study_of(folder: Path, rows: list[dict[str, str]], trials: int = 32) -> Path:
    """Write the campaign of Oxford's block with some tests."""
    table = ["test,distance_mm,velocity_m_s,overturned"]
    table += [
        f"{n},{row['distance_mm']},{row['velocity_m_s']},{row['outcome']}"
        for n, row in enumerate(rows)
    ]
    (folder / "tests.csv").write_text("\n".join(table) + "\n")
    content = read_yaml(ROOT / "config" / "oxford.yaml")
    content["campaign"]["tests"] = "tests.csv"
    content["trials"] = trials
    path = folder / "steps.yaml"
    # YAML holds JSON
    path.write_text(json.dumps(content))
    return path


def test_oxford_is_right_in_nine_of_ten_tests_with_one_unknown(tmp_path, shared):
    with (shared / "measured" / "oxford" / "single_block.csv").open() as file:
        rows = [
            row | {"outcome": "no" if row["outcome"] == "stood" else "yes"}
            for row in csv.DictReader(file)
        ]
    study = load_any(study_of(tmp_path, rows))
    job = Job(study, tmp_path / "results", 1, logging.getLogger("steps"))
    tables = dict(_first_tables(job))
    best = tables["trials"].iloc[0]
    assert best["right_in_sample"] >= 0.9
    # chosen by other tests, it is right in as many
    assert tables["tests"]["right"].mean() >= 0.9
    fell = [row["outcome"] == "yes" for row in rows]
    assert best["right_in_sample"] > max(sum(fell), len(fell) - sum(fell)) / len(fell)


def _first_tables(job):
    """Tests and trials, without what follows from them."""
    for name, table in run(job):
        yield name, table
        if name == "trials":
            return


def test_a_size_is_of_a_block_by_hand(tmp_path):
    rows = [{"distance_mm": "10", "velocity_m_s": "0.2", "outcome": "no"}] * 2
    path = study_of(tmp_path, rows)
    content = json.loads(path.read_text())
    content["object"]["pedestal"] = [dict(content["object"])]
    content["unknowns"]["friction"] = [0.5, 0.5]
    del content["unknowns"]["restitution"]
    path.write_text(json.dumps(content))
    with pytest.raises(ValueError, match="size"):
        load_any(path)
