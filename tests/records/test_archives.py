"""Archives of data centres: members are read with their units, named, and unpacked within bounds."""

import gzip
import tracemalloc
import zipfile

import numpy as np
import pytest
from obspy import Stream, Trace

from rockfrag.base.errors import InputError
from rockfrag.records.formats import obspy_native
from rockfrag.records.parsing.text_file import NotAcceleration
from rockfrag.records.read import read_motion, read_record
from rockfrag.records.sources import archive as archives

from .built_records import build, pack, pack_tar


@pytest.mark.parametrize(
    "packer", [(pack, "a.zip"), (pack_tar, "a.tar"), (pack_tar, "a.tar.gz")]
)
def test_a_member_keeps_the_unit_of_its_file(tmp_path, packer):
    """The unit of a CSMIP file is cm/s²: taken for g it would be 981 times as much."""
    built = build("csmip_v2", tmp_path)
    path = packer[0](tmp_path / packer[1], {"V/csmip.V2": built.path.read_bytes()})
    motion = read_motion(path, channel="90")
    np.testing.assert_allclose(motion.acceleration, built.samples[0] / 100, rtol=1e-12)
    assert motion.metadata["unit"] == "cm/s2"
    with pytest.raises(InputError, match="states its unit as cm/s2, not g"):
        read_motion(path, unit="g", channel="90")


def test_members_are_named_and_chosen_by_name_channel_or_number(tmp_path):
    first, second = build("csmip_v2", tmp_path), build("at2_peer", tmp_path)
    contents = {f"data/{b.path.name}": b.path.read_bytes() for b in (first, second)}
    path = pack(
        tmp_path / "two.zip", {**contents, "README.txt": b"words", "x.xml": b"<?xml?>"}
    )
    with pytest.raises(
        InputError, match=r"1: data/csmip\.V2 90; 2: data/csmip\.V2 UP; 3: data/peer"
    ):
        read_motion(path)
    samples = second.samples[0] * 9.81
    for name, channel in (
        (f"{path}#data/peer.AT2", None),
        (f"{path}#peer.AT2", None),
        (path, "peer.AT2"),
        (path, "data/peer.AT2 090"),
        (path, "3"),
    ):
        motion = read_motion(name, channel=channel)
        np.testing.assert_allclose(motion.acceleration, samples, rtol=1e-6)
    up = read_motion(path, channel="csmip.V2#UP")
    np.testing.assert_allclose(up.acceleration, first.samples[1] / 100, rtol=1e-12)
    assert up.provenance[0]["member"] == "data/csmip.V2"
    with pytest.raises(InputError, match=r"no member is called 'z'; there are"):
        read_motion(f"{path}#z")


def test_an_archive_in_an_archive_is_unpacked_once(tmp_path):
    built = build("at2_peer", tmp_path)
    inner = pack(tmp_path / "inner.zip", {"peer.AT2": built.path.read_bytes()})
    outer = pack(tmp_path / "outer.zip", {"inner.zip": inner.read_bytes()})
    record = read_record(outer)
    assert record.channels[0].npts == 43
    assert read_motion(f"{outer}#inner.zip/peer.AT2").acceleration.size == 43
    deeper = pack(tmp_path / "deeper.zip", {"outer.zip": outer.read_bytes()})
    with pytest.raises(InputError, match="no member of the archive holds acceleration"):
        read_record(deeper)


def test_a_broken_member_is_named_and_does_not_hide_the_others(tmp_path):
    built = build("at2_peer", tmp_path)
    content = built.path.read_bytes()
    path = pack(tmp_path / "a.zip", {"good.AT2": content, "cut.AT2": content[:-40]})
    record = read_record(path)
    assert len(record.channels) == 1
    ((name, error),) = record.left_out
    assert name == "cut.AT2"
    assert "a.zip#cut.AT2" in str(error)
    with pytest.raises(InputError, match=r"a\.zip#cut\.AT2.*promises 43 samples"):
        read_motion(f"{path}#cut.AT2")


def test_an_archive_of_velocities_is_no_record(tmp_path):
    built = build("at2_peer", tmp_path)
    text = (
        built.path.read_text()
        .replace("ACCELERATION", "VELOCITY")
        .replace("OF G", "OF CM/S")
    )
    path = pack(tmp_path / "v.zip", {"a.VT2": text})
    with pytest.raises(NotAcceleration, match="velocity"):
        read_record(path)


def test_names_that_lead_out_of_the_folder_stay_inside(tmp_path):
    built = build("at2_peer", tmp_path)
    inside = tmp_path / "deep" / "er"
    inside.mkdir(parents=True)
    path = pack(inside / "a.zip", {"../../evil.AT2": built.path.read_bytes()})
    assert read_record(path).channels[0].npts == 43
    assert not (tmp_path / "evil.AT2").exists()


def test_what_unpacks_to_too_much_is_refused(tmp_path, monkeypatch):
    monkeypatch.setattr(archives, "MAX_TOTAL", 10_000)
    bomb = tmp_path / "bomb.zip"
    with zipfile.ZipFile(bomb, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("zeros.AT2", b"0" * 1_000_000)
    with pytest.raises(InputError, match="unpacks to more than"):
        read_record(bomb)


def test_workbooks_locks_and_damage_are_told(tmp_path):
    book = pack(
        tmp_path / "book.xlsx", {"[Content_Types].xml": b"", "xl/workbook.xml": b""}
    )
    with pytest.raises(InputError, match="an Excel workbook"):
        read_record(book)
    damaged = pack(tmp_path / "damaged.zip", {"a.AT2": b"x" * 100})
    damaged.write_bytes(damaged.read_bytes()[:80])
    with pytest.raises(InputError, match="cannot be unpacked"):
        read_record(damaged)


@pytest.mark.slow
@pytest.mark.parametrize("content", [b"\x00", b"0 0\n", b"1", b"1.5 2.5\n", b"\n"])
def test_a_packed_file_of_a_gigabyte_is_refused_within_little_memory(tmp_path, content):
    path = tmp_path / "packed.txt.gz"
    block = content * (2**20 // len(content))
    with gzip.open(path, "wb", compresslevel=1) as file:
        for _ in range(300):
            file.write(block)
    tracemalloc.start()
    with pytest.raises(InputError, match=r"packed\.txt\.gz"):
        read_record(path)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak < 2**28


def test_miniseed_of_more_samples_than_memory_holds_is_refused(tmp_path, monkeypatch):
    """Steim's compression packs seven samples of a quiet record into four bytes."""
    path = tmp_path / "quiet.mseed"
    trace = Trace(np.zeros(100_000, dtype=np.int32), {"station": "A", "channel": "HNE"})
    Stream([trace]).write(str(path), format="MSEED", encoding="STEIM2")
    assert path.stat().st_size < 100_000
    monkeypatch.setattr(obspy_native, "MOST_SAMPLES", 99_999)
    with pytest.raises(
        InputError, match="100,000 samples are more than the 99,999 of a record"
    ):
        read_record(path)
