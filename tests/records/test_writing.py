"""A motion written for another program reads back as it was."""

import numpy as np
import pytest

from rockfrag.cli import main
from rockfrag.errors import InputError
from rockfrag.records.motion import Motion, write_motion_set
from rockfrag.records.read import read_motion
from rockfrag.records.write import motions_of_study, write_motion, write_motions

ENDINGS = [".AT2", ".csv", ".dat", ".tcl", ".mseed"]


@pytest.fixture
def motion():
    """A floor motion with a mean, which a raw recording would lose."""
    samples = 0.3 + np.random.default_rng(3).normal(size=1001)
    facts = {"earthquake": "Friuli 1976", "station": "TMZ", "component": "000", "floor": "attic"}
    return Motion(samples, 0.005, "Friuli attic", facts)


@pytest.mark.parametrize("ending", ENDINGS)
def test_a_motion_reads_back_without_a_question(tmp_path, motion, ending):
    back = read_motion(write_motion(motion, tmp_path / f"m{ending}"))
    np.testing.assert_allclose(back.acceleration, motion.acceleration, rtol=1e-14)
    assert back.dt == pytest.approx(motion.dt, rel=1e-12)
    if ending in (".AT2", ".dat"):
        facts = {key: back.metadata[key] for key in ("earthquake", "station", "component")}
        assert facts == {"earthquake": "Friuli 1976", "station": "TMZ", "component": "000"}


@pytest.mark.parametrize("unit", ["g", "cm/s2", "mm/s2"])
def test_the_unit_of_the_numbers_can_be_chosen(tmp_path, motion, unit):
    path = write_motion(motion, tmp_path / "m.csv", unit=unit)
    back = read_motion(path)
    assert back.metadata["unit"] == unit
    np.testing.assert_allclose(back.acceleration, motion.acceleration, rtol=1e-14)


def test_what_cannot_be_written_is_told(tmp_path, motion):
    with pytest.raises(InputError, match=r"'\.xyz' names no format"):
        write_motion(motion, tmp_path / "m.xyz")
    with pytest.raises(InputError, match="'PDF' is no format"):
        write_motion(motion, tmp_path / "m.csv", "PDF")
    with pytest.raises(InputError, match="MiniSEED is written in m/s2"):
        write_motion(motion, tmp_path / "m.mseed", unit="g")
    (tmp_path / "file").write_text("")
    with pytest.raises(InputError, match="cannot be written"):
        write_motion(motion, tmp_path / "file" / "m.csv")


def test_motions_of_a_study_are_written_by_their_names(tmp_path, motion):
    other = Motion(motion.acceleration[:50], 0.01, "Kobe/ground")
    write_motion_set([motion, other], tmp_path / "floors.parquet")
    found = motions_of_study(tmp_path / "floors.parquet")
    paths = write_motions(found, tmp_path / "out", "AT2")
    assert [path.name for path in paths] == ["Friuli-attic.AT2", "Kobe-ground.AT2"]
    same = [motion, Motion(motion.acceleration, 0.01, motion.name)]
    with pytest.raises(InputError, match="would have one file"):
        write_motions(same, tmp_path / "out", "AT2")
    with pytest.raises(InputError, match="no motions of a study"):
        motions_of_study(tmp_path / "absent.parquet")


def test_records_and_studies_are_written_from_the_command_line(tmp_path, motion, capsys):
    record = write_motion(motion, tmp_path / "m.csv")
    assert main(["write", str(record), str(tmp_path / "m.tcl")]) == 0
    np.testing.assert_allclose(read_motion(tmp_path / "m.tcl").acceleration, motion.acceleration)
    write_motion_set([motion], tmp_path / "floors.parquet")
    assert (
        main(["write", str(tmp_path / "floors.parquet"), str(tmp_path), "--format", "mseed"]) == 0
    )
    assert "Friuli-attic.mseed" in capsys.readouterr().out
