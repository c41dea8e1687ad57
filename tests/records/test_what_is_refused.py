"""What is cut short, contradicts itself or is no record of acceleration is refused as that."""

import gzip
import time

import numpy as np
import pytest
from obspy import Stream, Trace

from rockfrag.errors import InputError
from rockfrag.records.parsing.text_file import NotAcceleration
from rockfrag.records.read import read_motion, read_record

from .built_records import knet_text

PEER = "PEER STRONG MOTION\nQUAKE, PLACE, 090\nACCELERATION IN UNITS OF G\n{size}\n 1.0 2.0 3.0\n"


@pytest.mark.parametrize("dt", ["1e-30", "1e308", "1000", "1e-9", "0", "-1"])
def test_an_interval_that_no_recorder_has_is_refused_at_once(tmp_path, dt):
    path = tmp_path / "dt.AT2"
    path.write_text(PEER.format(size=f"NPTS= 3, DT= {dt} SEC"))
    start = time.perf_counter()
    with pytest.raises(InputError, match=r"dt\.AT2, line 4: .*sampling interval"):
        read_motion(path)
    assert time.perf_counter() - start < 2


@pytest.mark.parametrize(
    ("content", "words"),
    [
        ("Time;a\n0;1\n".encode("utf-16"), "UTF-16 text; save it as UTF-8"),
        (b"<!DOCTYPE html>\n<html><body>Please log in</body></html>", r"web page \(HTML\)"),
        (b"version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 9\n", "git lfs pull"),
        (b"%PDF-1.4\n", "PDF"),
        (b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1" + bytes(600), "Excel workbook; save the sheet as CSV"),
        (b"MATLAB 5.0 MAT-file, Platform" + bytes(100), "MATLAB"),
        (bytes(5000), "nothing but zero bytes"),
        (b"<?xml version='1.0'?><FDSNStationXML/>", "describes instruments"),
    ],
)  # fmt: skip
def test_what_is_no_record_is_told_by_its_kind(tmp_path, content, words):
    path = tmp_path / "record.dat"
    path.write_bytes(content)
    with pytest.raises(InputError, match=words):
        read_motion(path, unit="g")


@pytest.mark.parametrize("zeros", [b"\x00", b"0\n", b"0 0\n", b"0 0 0 0 0\n", b"0"])
def test_fifty_megabytes_of_zeros_are_refused_in_two_seconds(tmp_path, zeros):
    path = tmp_path / "zeros.txt"
    path.write_bytes(zeros * (50 * 2**20 // len(zeros)))
    start = time.perf_counter()
    with pytest.raises(InputError):
        read_motion(path, unit="g", dt=0.01)
    assert time.perf_counter() - start < 2


@pytest.mark.parametrize(
    "text",
    [
        "Period [s],PSA [g]\n" + "".join(f"{i / 100},0.{i}\n" for i in range(1, 90)),
        "T (s), Sa (g), Sv, Sd\nPeriod,PSA,PSV,SD\n" + "1,2,3,4\n" * 9,
        "Frequency (Hz)\tAmplitude\n" + "".join(f"{i} {i}\n" for i in range(1, 90)),
    ],
)
def test_spectra_are_no_records(tmp_path, text):
    path = tmp_path / "psa.csv"
    path.write_text(text)
    with pytest.raises(NotAcceleration, match=r"spectrum|none of the columns"):
        read_motion(path, unit="g")


class TestCutShort:
    @pytest.fixture
    def knet(self, tmp_path):
        """Four seconds of K-NET at 100 Hz."""
        path = tmp_path / "AOM001.EW"
        path.write_text(knet_text())
        return path

    def test_a_k_net_file_is_held_to_its_duration(self, knet):
        assert read_motion(knet).acceleration.size == 400
        lines = knet.read_text().splitlines(keepends=True)
        knet.write_text("".join(lines[:-10]))
        with pytest.raises(InputError, match=r"promises 400 samples \(4 s\) but 320 follow"):
            read_motion(knet)
        motion = read_motion(knet, cut_short=True)
        assert motion.acceleration.size == 320
        assert motion.provenance[1] == {
            "step": "read a file that is cut short",
            "samples_promised": 400,
            "samples_read": 320,
        }
        knet.write_text("".join(lines[:17]))
        with pytest.raises(InputError, match="cut short"):
            read_motion(knet)

    @pytest.mark.parametrize("end", [b"}", b"} ", b"} \\\n", b"} -factor", b"} -factor 2"])
    def test_a_script_cut_after_its_values_does_not_lose_its_factor(self, builders, tmp_path, end):
        path = builders["opensees"](tmp_path).path
        whole = path.read_bytes()
        path.write_bytes(whole[: whole.index(b"}")] + end)
        with pytest.raises(InputError, match="-factor may be cut off"):
            read_motion(path)

    def test_a_taiwanese_file_is_held_to_its_length(self, builders, tmp_path):
        path = builders["cwa"](tmp_path).path
        text = path.read_text().replace("#RecordLength(sec): 1\n", "#RecordLength(sec): 0.86\n")
        lines = text.splitlines(keepends=True)
        path.write_text(text)
        assert read_record(path).channels[0].npts == 43
        path.write_text("".join(lines[:-9]))
        with pytest.raises(InputError, match=r"promises 0\.86 s of record but 0\.68 s follow"):
            read_record(path)
        assert read_record(path, cut_short=True).channels[0].npts == 34

    def test_miniseed_that_ends_within_a_record_is_refused(self, tmp_path):
        path = tmp_path / "a.mseed"
        trace = Trace(np.arange(4000, dtype=np.int32) % 977, {"station": "A", "channel": "HNE"})
        Stream([trace]).write(str(path), format="MSEED", reclen=512)
        content = path.read_bytes()
        path.write_bytes(content[:-100])
        with pytest.raises(InputError, match="no whole number of MiniSEED records"):
            read_motion(path, unit="g")

    @pytest.mark.parametrize(
        "name",
        ["at2_peer", "cosmos_v1", "csmip_v1", "smc", "esm", "bhrc", "csmnc", "usc_volume_2", "unam",
         "afad", "csmip_v1_pairs", "plain_one_column"],
    )  # fmt: skip
    def test_what_there_is_is_read_on_request_and_the_provenance_says_so(
        self, builders, tmp_path, name
    ):
        built = builders[name](tmp_path)
        encoding = "latin-1"
        lines = built.path.read_bytes().decode(encoding).splitlines(keepends=True)
        first = next(i for i, line in enumerate(lines) if "END" in line.upper()[:12] or "/&" in line)\
            if any("/&" in line for line in lines) else len(lines)  # fmt: skip
        kept = "".join(lines[: first - 3])
        built.path.write_bytes(kept.encode(encoding))
        unit = None if built.unit else "g"
        with pytest.raises(InputError, match=r"promises|cut short|fill rows"):
            read_motion(built.path, unit=unit, channel="1")
        motion = read_motion(built.path, unit=unit, channel="1", cut_short=True)
        size = motion.acceleration.size
        whole = built.samples[0]
        assert 10 < size < whole.size
        factor = motion.provenance[0]["factor_to_m_s2"]
        np.testing.assert_allclose(
            motion.acceleration, whole[:size] * factor, atol=2 * built.tolerance * factor + 1e-12
        )
        (step,) = [s for s in motion.provenance if s["step"] == "read a file that is cut short"]
        assert step["samples_read"] == size


def test_a_trace_of_unknown_unit_is_not_written_as_g(tmp_path):
    stream = Stream([Trace(np.arange(100.0))])
    for name in ("AT2", "SEISMOSOFT", "OPENSEES"):
        with pytest.raises(InputError, match="does not state a unit of acceleration"):
            stream.write(str(tmp_path / "counts"), format=name)
    assert not (tmp_path / "counts").exists()


def test_a_pickle_is_never_opened(tmp_path):
    """ObsPy's own reader of pickles would run what the file says."""
    import pickle

    class Harm:
        def __reduce__(self):
            return (open, (str(tmp_path / "harm"), "w"))

    path = tmp_path / "a.pickle"
    path.write_bytes(pickle.dumps(Harm(), protocol=2))
    with pytest.raises(InputError):
        read_motion(path, unit="g")
    assert not (tmp_path / "harm").exists()


def test_a_damaged_packed_file_is_told(tmp_path):
    path = tmp_path / "a.AT2.gz"
    path.write_bytes(gzip.compress(b"PEER" * 1000)[:-20])
    with pytest.raises(InputError, match=r"a\.AT2\.gz"):
        read_motion(path)
