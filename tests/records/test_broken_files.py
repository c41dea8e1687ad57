"""A damaged file gives one clear error that names it, within bounded time and memory."""

import os
import re
import time
import tracemalloc
from contextlib import suppress

import numpy as np
import obspy
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from rockfrag.errors import InputError
from rockfrag.records.read import FORMATS, read_motion, read_record

QUICK = settings(
    max_examples=6,
    database=None,
    derandomize=True,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)


def read_all(path, dt=None):
    """Read every channel, in any unit."""
    record = read_record(path, dt)
    return [channel.samples() for channel in record.channels]


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
        for left, right in zip(samples, read_all(built.path, built.dt_to_give), strict=True):
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


def lines_of(built):
    return built.path.read_bytes().rstrip(b"\x1a").splitlines(keepends=True)


def last_number_line(built):
    """Number (from zero) of the last line that is a row of samples."""
    lines = lines_of(built)
    return max(
        i for i, line in enumerate(lines) if re.fullmatch(rb"[-+\d.eE\s,;]*\d[-+\d.eE\s,;]*", line)
    )


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
        read_motion(path, unit=None if built.unit else "g", channel="1", dt=built.dt_to_give)
    assert path.name in str(caught.value)
    with pytest.raises(InputError, match=rf"line {number + 1}\b"):
        obspy.read(path, format=built.format, dt=built.dt_to_give)


def test_empty_folder_and_dangling_link_say_what_they_are(tmp_path):
    empty = tmp_path / "empty.AT2"
    empty.touch()
    link = tmp_path / "link.AT2"
    link.symlink_to(tmp_path / "nothing")
    for path, words in ((empty, "empty"), (tmp_path, "folder"), (link, "leads to nothing")):
        with pytest.raises(InputError, match=words):
            read_motion(path)
        assert not any(candidate.is_format(path) for candidate in FORMATS)
    with pytest.raises(InputError, match="no such file"):
        read_motion(tmp_path / "absent.AT2")


AT2_HEADER = b"PEER\nA, B, 090\nIN UNITS OF G\nNPTS= 3, DT= .01 SEC\n"


@pytest.mark.parametrize("header", [b"", AT2_HEADER, b"0 0\n1 1\n2 2\n"])
def test_an_endless_line_of_digits_is_not_slurped(tmp_path, header):
    """64 MiB of digits stand for more: the file is read in blocks and given up in the first."""
    path = tmp_path / "digits.txt"
    path.write_bytes(header + b"1" * (64 * 2**20))
    tracemalloc.start()
    start = time.perf_counter()
    with pytest.raises(InputError, match=r"digits\.txt, line \d+: the line is longer"):
        read_motion(path, unit="g")
    for candidate in FORMATS:
        candidate.is_format(str(path))
    assert time.perf_counter() - start < 2.0
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak < 16 * 2**20


def test_a_file_too_large_for_a_record_is_refused_unread(tmp_path):
    path = tmp_path / "huge.AT2"
    with path.open("wb") as file:
        file.write(AT2_HEADER)
        file.truncate(10**9)
    with pytest.raises(InputError, match="too many for a record"):
        read_motion(path)
    with pytest.raises(InputError, match="too many for a record"):
        obspy.read(path, format="AT2")


def test_a_file_without_permission_gives_the_error(tmp_path, builders):
    path = builders["at2_peer"](tmp_path).path
    path.chmod(0)
    if os.access(path, os.R_OK):
        pytest.skip("this user may read everything")
    with pytest.raises(InputError, match=path.name):
        read_motion(path)
