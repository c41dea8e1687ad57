"""A study that asks for its motions in a format of records gets them, and they read back as they are."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from rockfrag.records.motion import read_motion_set
from rockfrag.records.read import read_motion

from .studies import Foreign, run

STUDY = Foreign(
    blocks={"cabinet": (50.0, 160.0, 90.0)},
    configurations={"cabinet": ("cabinet", None)},
    records={"quake": "quake"},
    floors={"roof": 3, "cellar": 0},
)


@pytest.mark.parametrize("format", ["AT2", "CSV"])
def test_the_motions_of_all_floors_are_written(tmp_path: Path, format: str):
    results = run(replace(STUDY, content={"write_motions": format}), tmp_path)
    motions = read_motion_set(results / "motions" / "floors.parquet")
    assert {motion.metadata["floor"] for motion in motions} == {"roof", "cellar"}
    for motion in motions:
        (path,) = (results / "motions" / "written").glob(f"{motion.name}.*")
        again = read_motion(path)
        assert again.dt == pytest.approx(motion.dt)
        limit = 1e-6 * np.abs(motion.acceleration).max()
        np.testing.assert_allclose(again.acceleration, motion.acceleration, atol=limit)
