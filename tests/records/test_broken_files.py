"""A file that is damaged or no record gives one clear error that names it, within bounded time and memory."""

import gzip
import os
import pickle
import re
import tracemalloc
from contextlib import contextmanager, suppress
from types import SimpleNamespace

import numpy as np
import obspy
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from obspy import Stream, Trace

from rockfrag.base.errors import InputError
from rockfrag.records.parsing import text_file
from rockfrag.records.parsing.text_file import NotAcceleration
from rockfrag.records.read import FORMATS, read_motion, read_record

from ..case_tables import case_tables
from .built_records import build
from .record_texts import knet_text

CASES = case_tables(__file__)
QUICK = settings(
    max_examples=6,
    database=None,
    derandomize=True,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)
AT2_HEADER = "PEER\nA, B, 090\nIN UNITS OF G\nNPTS= 3, DT= {dt} SEC\n"


@pytest.fixture
def read_bytes(monkeypatch):
    """Number of bytes that were asked of each file, as they are read."""
    counts, opened = [], text_file._opened

    @contextmanager
    def counted(path):
        with opened(path) as file:

            def read(size):
                block = file.read(size)
                counts.append(len(block))
                return block

            yield SimpleNamespace(read=read)

    monkeypatch.setattr(text_file, "_opened", counted)
    return counts


def read_all(path, dt=None):
    """Read every channel, in any unit."""
    return [channel.samples for channel in read_record(path, dt).channels]


def outcome(path, dt=None):
    """Samples of a file, or None where reading gave the one clear error."""
    for candidate in FORMATS:
        assert candidate.is_format(str(path)) in (True, False)
    try:
        samples = read_all(path, dt)
    except InputError as error:
        message = str(error)
        assert path.name in message
        assert message.endswith(".")
        return None
    for values in samples:
        assert np.isfinite(values).all()
    return samples


def lines_of(built):
    return built.path.read_bytes().rstrip(b"\x1a").splitlines(keepends=True)


def last_number_line(built):
    """Number (from zero) of the last line that is a row of samples."""
    row = re.compile(rb"[-+\d.eE\s,;]*\d[-+\d.eE\s,;]*")
    return max(i for i, line in enumerate(lines_of(built)) if row.fullmatch(line))


@QUICK
@given(data=st.data())
def test_a_truncated_file_gives_an_error_or_all_whole_samples(built, tmp_path, data):
    content = built.path.read_bytes().rstrip(b"\x1a")
    size = data.draw(st.integers(0, len(content) - 1))
    path = tmp_path / built.path.name
    path.write_bytes(content[:size])
    samples = outcome(path, built.dt_to_give)
    if samples is None:
        return
    # what is left is shorter by whole samples or channels, or lost digits of the very last one
    whole = read_all(built.path, built.dt_to_give)
    for left, right in zip(samples, whole, strict=False):
        common = min(left.size, right.size) - 1
        np.testing.assert_array_equal(left[:common], right[:common])


@QUICK
@given(data=st.data())
def test_a_blank_line_anywhere_is_skipped_or_an_error(built, tmp_path, data):
    lines = lines_of(built)
    lines.insert(data.draw(st.integers(0, len(lines))), b"\n")
    path = tmp_path / built.path.name
    path.write_bytes(b"".join(lines))
    samples = outcome(path, built.dt_to_give)
    if samples is not None:
        for left, right in zip(
            samples, read_all(built.path, built.dt_to_give), strict=True
        ):
            np.testing.assert_array_equal(left, right)


@QUICK
@given(text=st.text(max_size=300), blob=st.binary(max_size=300))
def test_no_plugin_raises_on_anything(tmp_path, text, blob):
    path = tmp_path / "anything"
    for content in (text.encode("utf-8", errors="surrogatepass"), blob):
        path.write_bytes(content)
        for candidate in FORMATS:
            assert candidate.is_format(str(path)) in (True, False)
        known = any(candidate.is_format(path) for candidate in FORMATS)
        with suppress(InputError) if known else pytest.raises(InputError):
            read_motion(path, unit="g", channel="1")


@pytest.mark.parametrize(
    "bad", [b"1e400", b"nan", b"0x1p3", b"1_0", b"*****", b"1.2.3", b"\xff\xfe"]
)
def test_a_value_that_is_no_finite_number_is_named_with_its_line(built, tmp_path, bad):
    lines = lines_of(built)
    number = last_number_line(built)
    lines[number] = b" " + bad + b"\n"
    path = tmp_path / built.path.name
    path.write_bytes(b"".join(lines))
    with pytest.raises(InputError, match=rf"line {number + 1}\b") as caught:
        read_motion(
            path, unit=None if built.unit else "g", channel="1", dt=built.dt_to_give
        )
    assert path.name in str(caught.value)
    with pytest.raises(InputError, match=rf"line {number + 1}\b"):
        obspy.read(path, format=built.format, dt=built.dt_to_give)


COUNTED = [
    "at2_peer",
    "cosmos_v1",
    "csmip_v1",
    "smc",
    "esm",
    "bhrc",
    "csmnc",
    "usc_volume_2",
    "unam",
]
COUNTED += ["afad", "csmip_v1_pairs", "plain_one_column"]


@pytest.mark.parametrize("kind", COUNTED)
def test_what_there_is_is_read_on_request_and_the_provenance_says_so(tmp_path, kind):
    built = build(kind, tmp_path)
    lines, whole = lines_of(built), built.samples[-1]
    built.path.write_bytes(b"".join(lines[: last_number_line(built) - 2]))
    asked = {"unit": None if built.unit else "g", "channel": str(len(built.samples))}
    with pytest.raises(InputError, match=r"promises|cut short|fill rows"):
        read_motion(built.path, **asked)
    motion = read_motion(built.path, **asked, cut_short=True)
    size = motion.acceleration.size
    assert 10 < size < whole.size
    factor = motion.provenance[0]["factor_to_m_s2"]
    tolerance = 2 * built.tolerance * factor + 1e-12
    np.testing.assert_allclose(
        motion.acceleration, whole[:size] * factor, atol=tolerance
    )
    (step,) = [
        s for s in motion.provenance if s["step"] == "read a file that is cut short"
    ]
    assert step["samples_read"] == size


def test_a_k_net_file_is_held_to_its_duration(tmp_path):
    path = tmp_path / "AOM001.EW"
    path.write_text(knet_text())
    assert read_motion(path).acceleration.size == 400
    lines = path.read_text().splitlines(keepends=True)
    path.write_text("".join(lines[:-10]))
    with pytest.raises(
        InputError, match=r"promises 400 samples \(4 s\) but 320 follow"
    ):
        read_motion(path)
    motion = read_motion(path, cut_short=True)
    assert motion.acceleration.size == 320
    promised = {"samples_promised": 400, "samples_read": 320}
    assert motion.provenance[1] == {"step": "read a file that is cut short", **promised}
    path.write_text("".join(lines[:17]))
    with pytest.raises(InputError, match="cut short"):
        read_motion(path)


@pytest.mark.parametrize("end", [b"}", b"} ", b"} \\\n", b"} -factor", b"} -factor 2"])
def test_a_script_cut_after_its_values_does_not_lose_its_factor(tmp_path, end):
    path = build("opensees", tmp_path).path
    whole = path.read_bytes()
    path.write_bytes(whole[: whole.index(b"}")] + end)
    with pytest.raises(InputError, match="-factor may be cut off"):
        read_motion(path)


def test_a_taiwanese_file_is_held_to_its_length(tmp_path):
    path = build("cwa", tmp_path).path
    text = path.read_text().replace(
        "#RecordLength(sec): 1\n", "#RecordLength(sec): 0.86\n"
    )
    lines = text.splitlines(keepends=True)
    path.write_text(text)
    assert read_record(path).channels[0].npts == 43
    path.write_text("".join(lines[:-9]))
    with pytest.raises(
        InputError, match=r"promises 0\.86 s of record but 0\.68 s follow"
    ):
        read_record(path)
    assert read_record(path, cut_short=True).channels[0].npts == 34


def test_miniseed_that_ends_within_a_record_is_refused(tmp_path):
    path = tmp_path / "a.mseed"
    trace = Trace(
        np.arange(4000, dtype=np.int32) % 977, {"station": "A", "channel": "HNE"}
    )
    Stream([trace]).write(str(path), format="MSEED", reclen=512)
    path.write_bytes(path.read_bytes()[:-100])
    with pytest.raises(InputError, match="no whole number of MiniSEED records"):
        read_motion(path, unit="g")


def test_empty_folder_and_dangling_link_say_what_they_are(tmp_path):
    empty = tmp_path / "empty.AT2"
    empty.touch()
    link = tmp_path / "link.AT2"
    link.symlink_to(tmp_path / "nothing")
    for path, words in (
        (empty, "empty"),
        (tmp_path, "folder"),
        (link, "leads to nothing"),
    ):
        with pytest.raises(InputError, match=words):
            read_motion(path)
        assert not any(candidate.is_format(path) for candidate in FORMATS)
    with pytest.raises(InputError, match="no such file"):
        read_motion(tmp_path / "absent.AT2")


@pytest.mark.parametrize("header", ["", AT2_HEADER.format(dt=".01"), "0 0\n1 1\n2 2\n"])
def test_an_endless_line_of_digits_is_not_slurped(tmp_path, read_bytes, header):
    """64 MiB of digits stand for more: the file is read in blocks and given up in the first."""
    path = tmp_path / "digits.txt"
    path.write_text(header + "1" * (64 * 2**20))
    tracemalloc.start()
    with pytest.raises(InputError, match=r"digits\.txt, line \d+: the line is longer"):
        read_motion(path, unit="g")
    for candidate in FORMATS:
        candidate.is_format(str(path))
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak < 16 * 2**20
    assert 0 < sum(read_bytes) < 16 * 2**20


def test_a_file_too_large_for_a_record_is_refused_unread(tmp_path):
    path = tmp_path / "huge.AT2"
    with path.open("wb") as file:
        file.write(AT2_HEADER.format(dt=".01").encode())
        file.truncate(10**9)
    with pytest.raises(InputError, match="too many for a record"):
        read_motion(path)
    with pytest.raises(InputError, match="too many for a record"):
        obspy.read(path, format="AT2")


@pytest.mark.parametrize("zeros", [b"\x00", b"0\n", b"0 0\n", b"0 0 0 0 0\n", b"0"])
def test_fifty_megabytes_of_zeros_are_refused_after_a_few(tmp_path, read_bytes, zeros):
    path = tmp_path / "zeros.txt"
    path.write_bytes(zeros * (50 * 2**20 // len(zeros)))
    with pytest.raises(InputError):
        read_motion(path, unit="g", dt=0.01)
    assert 0 < sum(read_bytes) < 16 * 2**20


def test_a_file_without_permission_gives_the_error(tmp_path):
    path = build("at2_peer", tmp_path).path
    path.chmod(0)
    if os.access(path, os.R_OK):
        pytest.skip("this user may read everything")
    with pytest.raises(InputError, match=path.name):
        read_motion(path)


@pytest.mark.parametrize("dt", ["1e-30", "1e308", "1000", "1e-9", "0", "-1"])
def test_an_interval_that_no_recorder_has_is_refused_at_once(tmp_path, dt):
    path = tmp_path / "dt.AT2"
    path.write_text(AT2_HEADER.format(dt=dt) + " 1.0 2.0 3.0\n")
    # before anything is made of as many samples as that would take
    tracemalloc.start()
    with pytest.raises(InputError, match=r"dt\.AT2, line 4: .*sampling interval"):
        read_motion(path)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak < 16 * 2**20


@pytest.mark.parametrize(("head", "zeros", "words"), CASES["foreign"])
def test_what_is_no_record_is_told_by_its_kind(tmp_path, head, zeros, words):
    path = tmp_path / "record.dat"
    path.write_bytes(head.encode("latin-1") + bytes(zeros))
    with pytest.raises(InputError, match=words):
        read_motion(path, unit="g")


@pytest.mark.parametrize(("header", "row"), CASES["spectra"])
def test_spectra_are_no_records(tmp_path, header, row):
    path = tmp_path / "psa.csv"
    path.write_text("\n".join([header, *(row.format(i=i) for i in range(1, 90)), ""]))
    with pytest.raises(NotAcceleration, match=r"spectrum|none of the columns"):
        read_motion(path, unit="g")


def test_a_trace_of_unknown_unit_is_not_written_as_g(tmp_path):
    stream = Stream([Trace(np.arange(100.0))])
    for name in ("AT2", "SEISMOSOFT", "OPENSEES"):
        with pytest.raises(InputError, match="does not state a unit of acceleration"):
            stream.write(str(tmp_path / "counts"), format=name)
    assert not (tmp_path / "counts").exists()


def test_a_pickle_is_never_opened(tmp_path):
    """ObsPy's own reader of pickles would run what the file says."""

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
