"""Every dialect of every format gives the samples, the interval and the facts that it was built from."""

import gzip
import io

import numpy as np
import obspy
import pytest
from obspy import UTCDateTime
from obspy.core.util.base import ENTRY_POINTS, buffered_load_entry_point

from rockfrag.errors import InputError
from rockfrag.records.parsing.quantities import TO_SI
from rockfrag.records.read import FORMATS, read_motion, read_record

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


def test_samples_interval_and_facts_are_read(built):
    stream = read_stream(built)
    assert len(stream) == len(built.samples)
    for trace, samples, component in zip(stream, built.samples, built.components, strict=True):
        assert trace.stats._format == built.format
        assert trace.stats.station == built.station
        assert trace.stats.delta == pytest.approx(built.dt, rel=1e-14)
        assert trace.stats.rockfrag.unit == built.unit
        assert trace.stats.rockfrag.component == component
        np.testing.assert_allclose(trace.data, samples, rtol=0, atol=built.tolerance)
        if built.start_time is None:
            assert not trace.stats.rockfrag.start_time_stated
        else:
            assert trace.stats.starttime == UTCDateTime(built.start_time)


def test_a_file_gives_the_same_however_it_is_opened(built, tmp_path):
    whole = read_stream(built)
    packed = tmp_path / f"{built.path.name}.gz"
    packed.write_bytes(gzip.compress(built.path.read_bytes()))
    opened = [read_stream(built, x) for x in (packed, io.BytesIO(built.path.read_bytes()))]
    for trace, *others, head in zip(whole, *opened, read_stream(built, headonly=True), strict=True):
        for other in others:
            np.testing.assert_array_equal(other.data, trace.data)
        assert head.data.size == 0
        assert [head.stats[key] for key in FACTS] == [trace.stats[key] for key in FACTS]
    given = {"unit": None if built.unit else "g", "channel": "1", "dt": built.dt_to_give}
    motions = [read_motion(path, **given).acceleration for path in (packed, built.path)]
    np.testing.assert_array_equal(*motions)
    start = whole[0].stats.starttime
    window = {"starttime": start + 5 * built.dt, "endtime": start + 9 * built.dt}
    cut = read_stream(built, **window)[0]
    np.testing.assert_array_equal(cut.data, whole[0].data[5:10])


def test_motions_are_in_metres_per_second_squared(built):
    unit = None if built.unit else "cm/s2"
    for number, samples in enumerate(built.samples, start=1):
        motion = read_motion(built.path, unit=unit, channel=str(number), dt=built.dt_to_give)
        factor = TO_SI[built.unit or "cm/s2"]
        np.testing.assert_allclose(
            motion.acceleration, samples * factor, rtol=0, atol=built.tolerance * factor + 1e-15
        )
        assert motion.dt == built.dt
        assert motion.metadata["format"] == built.format
        assert motion.metadata["start_time"] == built.start_time
        assert motion.provenance[0]["sha256"] == read_record(built.path, built.dt_to_give).sha256


SIZE = "NPTS=  43, DT= .00500 SEC"
KIND = "ACCELERATION TIME HISTORY IN UNITS OF G. FILTER POINTS: HP=0.1 Hz LP=40.0 Hz"
SIZES = [
    *("NPTS=   43, DT= .00500 SEC", "NPTS= 43, DT= .0050 SEC,      ", "npts:43;dt:0.005"),
    *("DT= .005 SEC NPTS = 43", "43   .0050   NPTS, DT", "  .0050  43 DT, NPTS"),
    *("NPTS, DT=  43, .0050", "NPTS=  43, DT= 5.0E-03 SEC", "DT= 5.0D-03 SEC, npts = 43"),
    *("  43    0.0050    NPTS, DT", "NPTS= 43, DT= 5 MSEC", "NPTS= 43, DT= 5. msec"),
    "NPTS= 43, DT= 5 ms",
]
UNITS = {
    "ACCELERATION TIME SERIES IN UNITS OF CM/SEC/SEC": "cm/s2",
    "ACCELERATION TIME HISTORY IN UNITS OF CM/S**2": "cm/s2",
    "The units are (g)": "g",
    "Acceleration in m/s^2": "m/s2",
    "ACCELERATION TIME HISTORY": "",
}
WLT = {
    "STATION NO. 36456": "Station Id. WLT  ",
    "36456-S4384-83123.01": "15481673.CI.WLT.--.HN",
}
IN_A_COMMENT = {
    "Sta Chan  1: 340 deg": "Sta Chan   ?:Other  ",
    "     340": "    -999",
    "| 43 ": "|<SCNL>J2236.BNZ.CE.--    <AUTH> 2019/02/01 21:38:15.000",
}
NO_START = [
    ("agram", "YEAR=1987", "YEAR=99999999999"),
    ("cwa", "2018/02/06-23:50:29", "9999/12/31-23:59:59"),
    ("smc", "      1989       291", "      9999       365"),
    ("unam", "2004/01/01", "9999/12/31"),
    ("csmip_v2", "05/02/83, 16:42:48.2 PDT", "13/45/83, 16:42:48.2 PDT"),
    ("csmip_v2", "05/02/83, 16:42:48.2 PDT", "05/02/83, 16:42:48.2 XYZ"),
]
DIALECTS = [
    *(("at2_peer", {SIZE: line}, {"npts": 43, "delta": 0.005}) for line in SIZES),
    *(("at2_peer", {KIND: words}, {"unit": unit}) for words, unit in UNITS.items()),
    ("csmip_v2_modern", WLT, {"network": "CI", "station": "WLT"}),
    ("cosmos_v1", IN_A_COMMENT, {"channel": "BNZ", "component": "BNZ"}),
    *((kind, {old: new}, {"start_time_stated": False}) for kind, old, new in NO_START),
]


def altered(built, changes):
    """The path of a built record in which words are exchanged."""
    content = built.path.read_bytes()
    for old, new in changes.items():
        assert old.encode() in content
        content = content.replace(old.encode(), new.encode("latin-1"))
    built.path.write_bytes(content)
    return built.path


@pytest.mark.parametrize(("kind", "changes", "facts"), DIALECTS)
def test_dialects_of_headers_are_read(builders, tmp_path, kind, changes, facts):
    built = builders[kind](tmp_path)
    path = altered(built, changes)
    assert claims(str(path)) == [built.format]
    stats = obspy.read(path)[0].stats
    assert facts.items() <= {**stats, **stats.rockfrag}.items()


NO_ACCELERATION = "not acceleration"
COUNTS = {
    "at2_peer": "NPTS=  {}",
    "cosmos_v1": "   {}  acceleration pts",
    "csmip_v2": " {} POINTS OF ACCEL DATA",
    "csmip_v1_pairs": "NO. OF POINTS =  {}",
    "smc": "{:10}",
    "esm": "NDATA: {}",
    "plain_one_column": "{} 0.0100",
    "renadic": "NO. OF POINTS =  {}",
    # fields that touch are no separated numbers; the counts matter all the same
    "cosmos_touching": "{} acceleration pts",
}
REFUSED = [
    ("at2_peer", "ACCELERATION TIME HISTORY", "VELOCITY, CM/S", "velocity.* not acceleration"),
    ("at2_peer", "ACCELERATION TIME HISTORY", "DISPLACEMENT", "displacement.* not acceleration"),
    ("esm", "ACCELERATION", "VELOCITY", NO_ACCELERATION),
    ("esm", "ACCELERATION", "DISPLACEMENT", NO_ACCELERATION),
    ("esm", "cm/s^2", "cm/s", NO_ACCELERATION),
    ("smc", "2 CORRECTED ACCELEROGRAM", "3 VELOCITY", NO_ACCELERATION),
    ("smc", "2 CORRECTED ACCELEROGRAM", "4 DISPLACEMENT", NO_ACCELERATION),
    ("smc", "2 CORRECTED ACCELEROGRAM", "5 RESPONSE SPECTRA", NO_ACCELERATION),
    ("cosmos_v1", "acceleration pts, approx", "velocity pts, approx", "velocity.* not acceler"),
    ("cosmos_v1", "units=cm/sec2(04)", "units=counts (50)", "raw counts"),
    ("esm", "Ελλάς", "Forlì", r"line 9: byte 0xec is not UTF-8"),
    # times that lie far apart are refused before they are filled in
    ("csmip_v1_pairs", f"{990 + 42 * 0.02:7.3f}", " 1e+12 ", r"old\.V1.* apart on average"),
    *(
        (kind, form.format(43), form.format(wrong), ".")
        for kind, form in COUNTS.items()
        for wrong in (42, 44, 0, 10**9)
    ),
]


@pytest.mark.parametrize(("kind", "old", "new", "words"), REFUSED)
def test_a_header_that_cannot_be_meant_is_refused(builders, tmp_path, kind, old, new, words):
    built = builders[kind](tmp_path)
    path = altered(built, {old: new})
    with pytest.raises(InputError, match=words) as refused:
        read_motion(path, unit=None if built.unit else "g", channel="1")
    assert path.name in str(refused.value)
    with pytest.raises(InputError, match=words):
        obspy.read(path, format=built.format)


@pytest.mark.parametrize(
    "header",
    [
        "ACCELERATION IN UNITS OF G\nNPTS= 43, DT= .01\n",
        "Source: me\nTime[s] Accel[g]\n",
        "#Earthquake Information\n#StationCode: ECU\n#SampleRate(Hz): 100\n"
        "#AmplitudeUnit: gal\n#DataSequence: Time U(+)\n",
    ],
)
def test_what_a_stricter_format_knows_is_not_plain_text(tmp_path, header):
    path = tmp_path / "short.txt"
    columns = 1 if "NPTS" in header else 2
    rows = "".join(
        f"{i * 0.01:10.3f}{np.sin(i):10.5f}"[20 - 10 * columns :] + "\n" for i in range(43)
    )
    path.write_text(header + rows)
    assert len(claims(str(path))) == 1
    assert claims(str(path)) != ["PLAINTEXT"]
    assert obspy.read(path)[0].stats.npts == 43


def test_peer_columns_that_touch_are_read(builders, tmp_path):
    built = builders["at2_peer"](tmp_path)
    header = built.path.read_text().split("\n")[:4]
    values = -np.abs(built.samples[0]) - 0.1
    fields = [f"{value:15.8E}" for value in values]
    assert all(len(field) == 15 and field[0] == "-" for field in fields)
    rows = ["".join(fields[i : i + 5]) for i in range(0, len(fields), 5)]
    built.path.write_text("\n".join(header + rows) + "\n")
    np.testing.assert_allclose(obspy.read(built.path)[0].data, values, rtol=1e-8)


def test_a_long_line_of_anything_is_recognised_or_not_at_once(tmp_path):
    """Patterns must not take more than linear time on lines made to confuse them."""
    import time

    path = tmp_path / "confusing.txt"
    for content in ("1," * 8000 + "x", "1.1" * 5000, "(" * 16000, " ,A(" * 4000, "1 " * 8000 + "x"):
        path.write_text((content + "\n") * 3)
        start = time.perf_counter()
        for candidate in FORMATS:
            candidate.is_format(str(path))
        assert time.perf_counter() - start < 1.0


HUNDREDTHS = [f"{i / 100:g}" for i in range(20)]


@pytest.mark.parametrize(
    ("header", "row", "components", "unit"),
    [
        ("Time(s);NS(gal);EW(gal)", "{t};1;2", ["NS", "EW"], "cm/s2"),
        ("time,N,E,Z\ns,m/s^2,m/s^2,m/s^2", "{t},1,2,3", ["N", "E", "Z"], "m/s2"),
        ("t,ax,ay", "{t},1,2", ["ax", "ay"], ""),
        ("# time acc_x acc_y", "{t} 1 2", ["x", "y"], ""),
        ("Time [sec] Acc [m/s2] Vel [m/s] Disp [m]", "{t} 1 2 3", [""], "m/s2"),
        ('"Time [s]","Acceleration [g]","Velocity [cm/s]"', "{t},1,2", [""], "g"),
        (
            " SITE CODE= 1,,\n SAMPLING RATE= 100Hz,,\n UNIT  = gal(cm/s/s),,\n NS,EW,UD",
            "1,2,3",
            ["NS", "EW", "UD"],
            "cm/s2",
        ),
        (
            "Time [s] - Plot 0\tAmplitude - Plot 0\tTime [s] - Plot 1\tAmplitude - Plot 1\t",
            "{t}\t1\t{t}\t2\t",
            ["Amplitude - Plot 0", "Amplitude - Plot 1"],
            "",
        ),
    ],
)
def test_titles_of_columns_say_what_they_hold(tmp_path, header, row, components, unit):
    path = tmp_path / "columns.txt"
    path.write_text("\n".join([header, *(row.format(t=t) for t in HUNDREDTHS)]) + "\n")
    assert claims(str(path)) == ["PLAINTEXT"]
    record = read_record(path)
    assert [channel.component for channel in record.channels] == components
    assert {(channel.unit, channel.dt, channel.npts) for channel in record.channels} == {
        (unit, 0.01, 20)
    }
    if not unit:
        given = read_motion(path, unit="m/s2", channel=components[0])
        assert given.pga == 1.0
        with pytest.raises(InputError, match="does not state its unit"):
            read_motion(path, channel=components[0])


def test_titles_that_cannot_be_told_apart_are_not_guessed(tmp_path):
    path = tmp_path / "columns.txt"
    rows = "".join(f"{t} 1 2 3\n" for t in HUNDREDTHS)
    path.write_text("Time and the acceleration, velocity and displacement of it\n" + rows)
    with pytest.raises(InputError, match="cannot be told apart into 4 titles"):
        read_record(path)
    path.write_text(rows)
    assert [c.component for c in read_record(path).channels] == ["column 2", "column 3", "column 4"]


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
