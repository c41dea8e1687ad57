"""Studies of other people's things run from configuration to report, and the report fits them."""

import random
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from rockfrag.records.motion import read_motion_set
from rockfrag.records.read import read_motion

from .asking_studies import draw, fate
from .checked_report import run_and_check
from .studies import STUDIES, Foreign, run

SLOW = [pytest.mark.slow]


@pytest.mark.parametrize(
    "name",
    [pytest.param(name, marks=SLOW * study.slow) for name, study in STUDIES.items()],
)
def test_the_study_runs_and_its_report_fits_it(name: str, tmp_path: Path):
    study = STUDIES[name]
    results, page = run_and_check(study, tmp_path)
    tests = pd.read_parquet(results / "tests.parquet")
    tests = tests[tests["definition"] == "step_protocol"]
    assert len(tests) == len(study.configurations) * len(study.records) * len(
        study.floors or [1]
    )
    # what is not known is shown as a bound wherever tests are shown
    bounds = tests[tests["amplitude_g"].isna()]
    shown = [cell for table in page.tables for row in table for cell in row]
    assert sum(cell.startswith((">", "<")) for cell in shown) >= len(bounds)
    for object_name in study.blocks:
        used = any(object_name in pair for pair in study.configurations.values())
        assert not used or any(object_name in word for word in page.words)


@pytest.mark.parametrize(
    "number", [2, 22, *(pytest.param(n, marks=SLOW) for n in (7, 12, 17))]
)
def test_random_studies_end_with_a_report_or_are_refused_in_a_sentence(
    number, tmp_path
):
    assert fate(draw(random.Random(f"0 {number}")), tmp_path)[1] == []


def test_the_motions_of_all_floors_are_written(tmp_path: Path):
    study = Foreign(
        blocks={"cabinet": (50.0, 160.0, 90.0)},
        configurations={"cabinet": ("cabinet", None)},
        records={"quake": "quake"},
        floors={"roof": 3, "cellar": 0},
        content={"write_motions": "AT2"},
    )
    results = run(study, tmp_path)
    motions = read_motion_set(results / "motions" / "floors.parquet")
    assert {motion.metadata["floor"] for motion in motions} == {"roof", "cellar"}
    for motion in motions:
        again = read_motion(results / "motions" / "written" / f"{motion.name}.AT2")
        assert again.dt == pytest.approx(motion.dt)
        limit = 1e-6 * np.abs(motion.acceleration).max()
        np.testing.assert_allclose(again.acceleration, motion.acceleration, atol=limit)
