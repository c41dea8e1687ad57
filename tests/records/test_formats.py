"""Every dialect of every format gives the samples, the interval and the facts that it was built from."""

import gzip
import io
import time

import numpy as np
import obspy
import pytest
from obspy.core.util.base import ENTRY_POINTS, buffered_load_entry_point

from rockfrag.base.errors import InputError
from rockfrag.records.parsing.quantities import TO_SI
from rockfrag.records.read import FORMATS, read_motion, read_record

from ..case_tables import case_tables
from .built_records import build

CASES = case_tables(__file__)
FACTS = ("npts", "delta", "starttime")


def claims(source):
    """Names of all ObsPy plugins, its own included, that claim a file."""
    found = []
    for name, entry in ENTRY_POINTS["waveform"].items():
        group = f"obspy.plugin.waveform.{entry.name}"
        is_format = buffered_load_entry_point(entry.dist.name, group, "isFormat")
        if is_format(source):
            found.append(name)
    return found


def read_stream(built, source=None, **options):
    """Read a built record through ObsPy, with the interval that its file does not state."""
    given = {} if built.stated_dt else {"dt": built.dt}
    return obspy.read(built.path if source is None else source, **given, **options)


def test_exactly_one_plugin_claims_a_file(built):
    assert claims(str(built.path)) == [built.format]


def test_samples_interval_and_facts_are_read_in_the_units_of_the_file_and_of_motions(
    built,
):
    stream = read_stream(built)
    assert len(stream) == len(built.samples)
    unit = None if built.unit else "cm/s2"
    factor = TO_SI[built.unit or "cm/s2"]
    sha256 = read_record(built.path, built.dt_to_give).sha256
    for number, trace in enumerate(stream):
        samples = built.samples[number]
        assert trace.stats._format == built.format
        assert trace.stats.station == built.station
        assert trace.stats.delta == pytest.approx(built.dt, rel=1e-14)
        assert trace.stats.rockfrag.unit == built.unit
        assert trace.stats.rockfrag.component == built.components[number]
        np.testing.assert_allclose(trace.data, samples, rtol=0, atol=built.tolerance)
        assert trace.stats.rockfrag.start_time_stated == (built.start_time is not None)
        assert built.start_time in (None, str(trace.stats.starttime))
        channel = str(number + 1)
        motion = read_motion(
            built.path, unit=unit, channel=channel, dt=built.dt_to_give
        )
        tolerance = built.tolerance * factor + 1e-15
        np.testing.assert_allclose(
            motion.acceleration, samples * factor, rtol=0, atol=tolerance
        )
        assert motion.dt == built.dt
        assert motion.metadata["format"] == built.format
        assert motion.metadata["start_time"] == built.start_time
        assert motion.provenance[0]["sha256"] == sha256


def test_a_file_gives_the_same_however_it_is_opened(built, tmp_path):
    whole = read_stream(built)
    packed = tmp_path / f"{built.path.name}.gz"
    packed.write_bytes(gzip.compress(built.path.read_bytes()))
    opened = [
        read_stream(built, x) for x in (packed, io.BytesIO(built.path.read_bytes()))
    ]
    for trace, *others, head in zip(
        whole, *opened, read_stream(built, headonly=True), strict=True
    ):
        for other in others:
            np.testing.assert_array_equal(other.data, trace.data)
        assert head.data.size == 0
        assert [head.stats[key] for key in FACTS] == [trace.stats[key] for key in FACTS]
    given = {
        "unit": None if built.unit else "g",
        "channel": "1",
        "dt": built.dt_to_give,
    }
    motions = [read_motion(path, **given).acceleration for path in (packed, built.path)]
    np.testing.assert_array_equal(*motions)
    start = whole[0].stats.starttime
    window = {"starttime": start + 5 * built.dt, "endtime": start + 9 * built.dt}
    cut = read_stream(built, **window)[0]
    np.testing.assert_array_equal(cut.data, whole[0].data[5:10])


def altered(kind, folder, changes):
    """Build a record of a kind in which words are exchanged."""
    built = build(kind, folder)
    content = built.path.read_bytes()
    for old, new in changes.items():
        assert old.encode() in content
        content = content.replace(old.encode(), new.encode("latin-1"))
    built.path.write_bytes(content)
    return built


SIZE = "NPTS=  43, DT= .00500 SEC"
SIZES = [
    ["at2_peer", {SIZE: line}, {"npts": 43, "delta": 0.005}] for line in CASES["sizes"]
]


@pytest.mark.parametrize(("kind", "changes", "facts"), [*SIZES, *CASES["dialects"]])
def test_dialects_of_headers_are_read(tmp_path, kind, changes, facts):
    built = altered(kind, tmp_path, changes)
    assert claims(str(built.path)) == [built.format]
    stats = obspy.read(built.path)[0].stats
    assert facts.items() <= {**stats, **stats.rockfrag}.items()


WRONG_COUNTS = [
    [kind, form.format(43), form.format(wrong), "."]
    for kind, form in CASES["counts"]
    for wrong in (42, 44, 0, 10**9)
]


@pytest.mark.parametrize(
    ("kind", "old", "new", "words"), [*CASES["refused"], *WRONG_COUNTS]
)
def test_a_header_that_cannot_be_meant_is_refused(tmp_path, kind, old, new, words):
    built = altered(kind, tmp_path, {old: new})
    with pytest.raises(InputError, match=words) as refused:
        read_motion(built.path, unit=None if built.unit else "g", channel="1")
    assert built.path.name in str(refused.value)
    with pytest.raises(InputError, match=words):
        obspy.read(built.path, format=built.format)


@pytest.mark.parametrize(
    ("content", "end"),
    [("1,", "x"), ("1.1", ""), ("(", ""), (" ,A(", ""), ("1 ", "x")],
)
def test_a_long_line_of_anything_is_recognised_or_not_in_linear_time(
    tmp_path, content, end
):
    """Patterns must not take more on lines made to confuse them: 16 times where they go back again and again."""
    path = tmp_path / "confusing.txt"

    def seconds(size: int) -> float:
        path.write_text((content * (size // len(content)) + end + "\n") * 3)
        times = []
        for _ in range(3):
            start = time.process_time()
            for candidate in FORMATS:
                candidate.is_format(str(path))
            times.append(time.process_time() - start)
        return min(times)

    assert seconds(32_000) < 8 * max(seconds(8_000), 0.002)


HUNDREDTHS = [f"{i / 100:g}" for i in range(20)]


@pytest.mark.parametrize(("header", "row", "components", "unit"), CASES["titles"])
def test_titles_of_columns_say_what_they_hold(tmp_path, header, row, components, unit):
    path = tmp_path / "columns.txt"
    path.write_text("\n".join([header, *(row.format(t=t) for t in HUNDREDTHS)]) + "\n")
    assert claims(str(path)) == ["PLAINTEXT"]
    record = read_record(path)
    assert [channel.component for channel in record.channels] == components
    facts = {(channel.unit, channel.dt, channel.npts) for channel in record.channels}
    assert facts == {(unit, 0.01, 20)}
    if not unit:
        given = read_motion(path, unit="m/s2", channel=components[0])
        assert given.pga == 1.0
        with pytest.raises(InputError, match="does not state its unit"):
            read_motion(path, channel=components[0])


def test_titles_that_cannot_be_told_apart_are_not_guessed(tmp_path):
    path = tmp_path / "columns.txt"
    rows = "".join(f"{t} 1 2 3\n" for t in HUNDREDTHS)
    path.write_text(
        "Time and the acceleration, velocity and displacement of it\n" + rows
    )
    with pytest.raises(InputError, match="cannot be told apart into 4 titles"):
        read_record(path)
    path.write_text(rows)
    assert [c.component for c in read_record(path).channels] == [
        "column 2",
        "column 3",
        "column 4",
    ]


def test_an_opensees_script_may_name_the_file_of_its_values(tmp_path):
    (tmp_path / "values.txt").write_text("0.1 -0.2\n0.3\n")
    path = tmp_path / "old.tcl"
    path.write_text('set accel "Series -dt 0.02 -filePath values.txt -factor 2"\n')
    motion = read_motion(path, unit="g")
    np.testing.assert_allclose(motion.acceleration, np.array([0.2, -0.4, 0.6]) * 9.81)
    assert motion.dt == 0.02
    path.write_text("timeSeries Path 1 -dt 0.02 -filePath values.txt -factor $g\n")
    with pytest.raises(InputError, match=r"-factor is '\$g', which is no number"):
        read_motion(path, unit="g")
