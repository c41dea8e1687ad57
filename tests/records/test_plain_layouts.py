"""Plain text of any layout: what stands above the samples is never one of them, and all that is stated counts."""

import numpy as np
import pytest
from obspy import Stream, Trace

from rockfrag.errors import InputError
from rockfrag.records.parsing.quantities import TO_SI
from rockfrag.records.parsing.text_file import NotAcceleration
from rockfrag.records.read import read_motion, read_record
from rockfrag.units import GRAVITY

N = 400
WAVE = 0.3 * np.convolve(np.random.default_rng(0).normal(size=N + 5), np.ones(6) / 6, "valid")


@pytest.fixture
def write(tmp_path):
    """Write a text and return its path."""

    def written(text, name="record.txt"):
        path = tmp_path / name
        path.write_text(text)
        return path

    return written


def column(form="{:.6e}", values=WAVE):
    return "".join(form.format(value) + "\n" for value in values)


def timed(dt=0.005, separator=",", form="{:.5f}"):
    return "".join(f"{i * dt:.6g}{separator}{form.format(v)}\n" for i, v in enumerate(WAVE))


def in_rows(width, separator=" ", form="{:.6e}"):
    words = [form.format(value) for value in WAVE]
    return "".join(separator.join(words[i : i + width]) + "\n" for i in range(0, N, width))


def beside(*columns, separator=" "):
    rows = zip(*columns, strict=True)
    return "".join(separator.join(f"{value:.6f}" for value in row) + "\n" for row in rows)


NUMBERED = "".join(f"{i + 1} {v:.5f}\n" for i, v in enumerate(WAVE))
# steps of 0.00244 s printed to milliseconds: three columns, and no series of rows
UNEVEN = "".join(f"{i * 0.00244:.3f} {v:.5f} {v:.5f}\n" for i, v in enumerate(WAVE))
MIXED = column("{!r}", [float(f"{v:.4g}") for v in WAVE])
ROW_NUMBERS = "".join(f"{i},{i * 0.01:.2f},{v:.6f}\n" for i, v in enumerate(WAVE))
NOISE = np.random.default_rng(1).normal(size=(3, N))
DAMAGED = ("nan", "*****", "1.2.3", "0x1p3")
LATER = (f"{N + 7}\n", f"{N + 7}\n0.005\n", f"{N - 7} 0.005\n", f"npts {N + 7}\n")
NO_INTERVALS = ("Delta 0.5 deg", "Filter 0.1 - 25 Hz", "sampled by A", "Frequency range: 0.1 Hz")
GSE = ("WID2 2009/04/06", "BEGIN GSE2.0\nMSG_TYPE DATA")

REFUSED = [
    (f"Time (days),Acc (g)\n{timed()}", None, r"'days' of column .* is no unit of time known here"),
    (NUMBERED, None, "counts by ones"),
    ("No,Acc (g)\n" + NUMBERED.replace(" ", ","), None, "dt="),
    (UNEVEN, None, r"time column steps by 0\.00244 s"),
    ("0.02\n" + MIXED, None, "give it with dt="),
    *((text + column(), 0.005, rf"promises \d+ samples but {N} follow") for text in LATER),
    (f"{N}\n0.005\n" + column(), 0.01, r"0\.005 s, not 0\.01 s"),
    ("title\n34.1 118.2 7\n" + in_rows(8), 0.01, r"line 2.*above the samples is neither"),
    *((f"{bad}\n" + column(), 0.01, "line 1") for bad in DAMAGED),
    *((f"0 {bad}\n" + timed(0.01, " "), 0.01, "line 1") for bad in DAMAGED),
    *((f"{line}\n{column()}", None, "give it with dt=") for line in NO_INTERVALS),
    (f"npts 90 dt .02\n{column()}", None, f"promises 90 samples but {N} follow"),
    (f"dt = 0.01\ntime step: 0.02\n{column()}", None, r"intervals of 0\.01 and 0\.02"),
    (f"unit: cm/s2\nTime (s),Acc (g)\n{timed()}", None, "in g, but the lines above it say cm/s2"),
    (f"dt = 0.01\n{timed()}", None, r"dt = 0\.01 s, but times step by 0\.005 s"),
    (f"Scale factor: 2.5\n{column()}", 0.01, "factor that is not applied"),
    (beside(*NOISE), 0.01, "may be 3 columns side by side or one series"),
    (beside(*(np.roll(WAVE, 70 * i) for i in range(5))), 0.01, "may be 5 columns side by side"),
    *((f"{start}\n{column()}", None, r"GSE file.*convert it.*MSEED") for start in GSE),
    ("just some words\nand more\n", None, "begins with 'just some words'"),
]


@pytest.mark.parametrize(("text", "dt", "words"), REFUSED, ids=[words for *_, words in REFUSED])
def test_what_cannot_be_told_is_refused(write, text, dt, words):
    with pytest.raises(InputError, match=words):
        read_record(write(text), dt)


TITLES = (
    *("Force (kN)", "Temperature (C)", "Resistance (Ohm)", "Load", "Strain (µε)", "qc (MPa)"),
    *("Displacement (m)", "Velocity", "Signal (mV)", "Acc (counts)", "Volt", "Pressure [kPa]"),
)
OTHERS = {
    **{title: f"Time (s),{title}\n{timed(0.01)}" for title in TITLES},
    "words of velocity": f"Velocity time history (cm/s)\n{column()}",
    "words of displacement": f"displacement in cm\n{column()}",
    "cone penetration": f"Depth (m),qc (MPa)\n{timed(0.01)}",
    "cone penetration without units": f"Depth qc\n{timed(0.01, ' ')}",
}


@pytest.mark.parametrize("name", OTHERS)
def test_another_quantity_is_refused_whatever_the_unit(write, name):
    with pytest.raises(NotAcceleration):
        read_motion(write(OTHERS[name]), unit="g", dt=0.01)


COUNTS = (f"{N}\n0.005\n", f"{N} 0.005\n", f"0.005 {N}\n")
ABOVE = (*COUNTS, f"0.005\n{N}\n", "1 \n5.000000e-03 \n", "0.005\n", f"a title\n{N}\n0.005\n")
COMMENTS = ("# my record", "# my own record", "% a b", "! Kobe 1995")
OF_THE_SITE = (
    "Shear wave velocity (m/s): 760",
    "Corrected for displacement",
    "N: 37",
    "Vs30 = 760 m/s",
)
EMOD3D = f"CACS 000 title\n{N} 5.0e-03 0 0 -1.0 0.0 0.0 0.0\n"
SHAKE = f'"El Centro"\n"Total No. of Points :",{N},"@ DT =",.02\n'
MILLISECONDS = ("Time (ms)", "Time [msec]", "time_ms", "t(ms)", "Time (milliseconds)", "T [MS]")
TABLE = f"Time (s),Acc (g)\n{timed()}"

READ = {
    "milliseconds below the titles": (f"time,acc\nms,g\n{timed(0.5)}", None, None, 0.0005),
    **{
        f"steps of {step} ms": (f"Time (ms),Acc (g)\n{timed(step)}", None, None, step / 1000)
        for step in (0.1, 0.5, 0.977, 1.0, 5.0, 10.0)
    },
    **{
        f"{title!r} by {mark!r}": (f"{title}{mark}Acc (g)\n{timed(0.5, mark)}", None, None, 0.0005)
        for title in MILLISECONDS
        for mark in ",;\t"
    },
    "minutes": (f"Time (min),Acc (g)\n{timed(0.01)}", None, None, 0.6),
    "a column that counts samples": (NUMBERED, "g", 0.01, 0.01),
    "titled so": ("No,Acc (g)\n" + NUMBERED.replace(" ", ","), None, 0.01, 0.01),
    "an interval like a sample": ("0.02\n" + MIXED, "g", 0.02, 0.02),
    **{f"{text!r} above": (text + column(), "g", None, 0.005) for text in ABOVE},
    **{f"{text!r} and dt given": (text + column(), "g", 0.005, 0.005) for text in ABOVE},
    **{
        f"{text!r} above {name}": (text + body, "g", None, 0.005)
        for name, body in {"5": in_rows(5), "8": in_rows(8), "two": timed(0.005, " ")}.items()
        for text in COUNTS
    },
    **{line: (f"{line}\n{timed(0.01, ' ')}", "g", None, 0.01) for line in COMMENTS},
    **{line: (f"{line}\n{column()}", "g", 0.01, 0.01) for line in OF_THE_SITE},
    **{f"EMOD3D {k}": (EMOD3D + in_rows(k), "cm/s2", None, 0.005) for k in (6, 8)},
    **{f"SHAKE {mark!r}": (SHAKE + in_rows(8, mark, "{:9.6f}"), "g", None, 0.02) for mark in " ,"},
    **{f"rows by {mark!r}": (in_rows(8, mark), "g", 0.01, 0.01) for mark in (",", ";", ", ")},
    "commas at the ends of rows": (in_rows(8, ",").replace("\n", ",\n"), "g", 0.01, 0.01),
    "rows of three": (in_rows(3), "g", 0.01, 0.01),
    **{
        f"empty rows {row!r}": (TABLE + f"{row}\n" * 4700, None, None, 0.005)
        for row in (",", ", ,")
    },
    "decimal commas by tabs": (timed(0.01, "\t").replace(".", ","), "g", None, 0.01),
    "decimal commas in a column": (column("{:.5f}").replace(".", ","), "g", 0.01, 0.01),
    "numbered rows": (",Time (s),Acc (g)\n" + ROW_NUMBERS, None, None, 0.01),
}


@pytest.mark.parametrize("name", READ)
def test_what_stands_above_the_samples_is_never_one_of_them(write, name):
    text, unit, given, dt = READ[name]
    motion = read_motion(write(text), unit=unit, dt=given)
    assert motion.dt == pytest.approx(dt, rel=1e-12)
    factor = TO_SI[unit or "g"]
    np.testing.assert_allclose(motion.acceleration, WAVE * factor, atol=6e-5 * factor)


@pytest.mark.parametrize("title", MILLISECONDS)
def test_milliseconds_are_no_seconds_in_three_columns(write, title):
    rows = "".join(f"{i * 0.5:g},{v:.5f},{v / 2:.5f}\n" for i, v in enumerate(WAVE))
    record = read_record(write(f"{title},Acc X (g),Acc Y (g)\n{rows}"))
    assert {channel.dt for channel in record.channels} == {0.0005}


@pytest.mark.parametrize("first", ["0", "0.0", "-0"])
def test_a_zero_is_a_sample(write, first):
    path = write(f"{first}\n" + column("{:.5f}"))
    assert read_motion(path, unit="g", dt=0.01).acceleration.size == N + 1


@pytest.mark.parametrize(
    "line",
    [
        *("Time Step: 0.005", "#DELTA: 0.005", "# dt = 0.005", "Time Increment (s)  : 0.005"),
        *("sampling frequency: 200.0 Hz", "Sampling rate = 200", "dt 0.005 s", '"@ DT =",.005'),
        *("sampling interval (ms): 5", "data at 200 samples per second", "Δt = 0.005"),
        *("sampled at 200 Hz", "400 points at 0.005 sec intervals"),
    ],
)
def test_an_interval_in_words_is_used_and_held_against_the_user(write, line):
    path = write(f"{line}\n{column()}")
    assert read_motion(path, unit="g").dt == 0.005
    assert read_motion(path, unit="g", dt=0.005).dt == 0.005
    with pytest.raises(InputError, match=r"0\.005 s, not 0\.01 s; leave dt= out"):
        read_record(path, 0.01)


@pytest.mark.parametrize(
    "line",
    [
        *("Acceleration in m/s2", "acc: m/s2", "units: m/s^2", "Station X unit m/s2"),
        *("Unit = m/s/s", "Accel" + "aration time series in m/s/s", "Acceleration (m/s²)"),
        *("# m/s2", "acc_m/s2"),
    ],
)
def test_a_unit_in_words_is_used_and_held_against_the_user(write, line):
    path = write(f"{line}\n{timed(0.005, ' ')}")
    assert read_motion(path).metadata["unit"] == "m/s2"
    with pytest.raises(InputError, match="states its unit as m/s2, not g"):
        read_motion(path, unit="g")


def test_the_unit_of_a_peak_is_not_that_of_the_samples(write):
    with pytest.raises(InputError, match="does not state its unit"):
        read_motion(write(f"Peak acceleration in cm/s2: 3.1\n{timed(0.005, ' ')}"))


def test_per_cent_of_g_is_no_g(write):
    path = write(f"Time (s),Acc (%g)\n{timed()}")
    assert read_motion(path).pga == pytest.approx(np.abs(WAVE).max() * GRAVITY / 100, rel=1e-4)


def test_a_vertical_beside_directions_is_no_velocity(write):
    rows = "".join(f"{i / 100:.2f},{v:.5f},{v:.5f},{v:.5f}\n" for i, v in enumerate(WAVE))
    record = read_record(write("Time,N,E,V\n" + rows))
    assert [channel.component for channel in record.channels] == ["N", "E", "V"]
    assert len(read_record(write("t,a,v,d\n" + rows)).channels) == 1


def test_sigma(write):
    """Fields of 14 columns that touch."""
    rows = "".join("".join(f"{v:14.7E}" for v in WAVE[i : i + 5]) + "\n" for i in range(0, N, 5))
    text = (
        "Earthquake Date & Time             : 2009-04-06 01:32:39\nStation Code / Name           : 2987 / "
        "Somewhere, Italy\nOrientation                   : NS\nFilter Cut-off Frequency (Hz) : 0.100 - "
        f"50.000\nTime Increment (s)            : 0.005\nNumber of Data                : {N}\nPGA (m/s/s)   "
        "                : 5.0693293E+00\nAccelaration time series in m/s/s\n"
    )
    motion = read_motion(write(text + rows, "16833_H1.cor.acc"))
    np.testing.assert_allclose(motion.acceleration, WAVE, rtol=1e-6)
    assert (motion.dt, motion.metadata["component"]) == (0.005, "NS")


@pytest.mark.parametrize(
    "header",
    [
        "station: PRF0\nsampling frequency: 100.0 Hz\nunits: cm/s^2\ncomponents: E N Z\n",
        "*" * 40 + "\n\nstation: PRF0\nsampling frequency (fs): 100.0\ndelta: 0.01\nunits: gal\n"
        "components: E N Z\nstarttime: 2015-07-24 09:58:34\n\n",
    ],
)
def test_greek_network(write, header):
    record = read_record(write(header + beside(WAVE, WAVE[::-1], 0.5 * WAVE)))
    assert [(c.component, c.unit, c.dt) for c in record.channels] == [
        (name, "cm/s2", 0.01) for name in "ENZ"
    ]
    np.testing.assert_allclose(record.channels[2].samples(), 0.5 * WAVE, atol=1e-6)


@pytest.mark.parametrize("header", ["% dt = 0.005 s\n% unit: m/s2\n", "% m/s^2, dt 0.005\n"])
def test_two_components_below_comments(write, header):
    path = write(header + beside(WAVE, WAVE[::-1]))
    assert read_motion(path, channel="2").acceleration == pytest.approx(WAVE[::-1], abs=1e-6)
    assert read_record(path, 0.005).channels[0].unit == "m/s2"


def test_components_without_titles_are_not_one_series(write):
    """Samples of one channel follow each other more smoothly than those of two."""
    columns = beside(WAVE, WAVE[::-1], np.roll(WAVE, 100))
    assert len(read_record(write(columns), 0.01).channels) == 3
    assert len(read_record(write(UNEVEN), 0.00244).channels) == 2


def test_seismic_handler_is_read_by_obspy(write):
    path = write("", "a.ASC")
    Stream([Trace(WAVE, {"delta": 0.05, "station": "TEST"})]).write(str(path), format="SH_ASC")
    assert path.read_text().startswith("DELTA:")
    record = read_record(path)
    assert (record.format, record.channels[0].dt, record.channels[0].npts) == ("SH_ASC", 0.05, N)


def test_a_peak_above_3_g_by_the_users_unit_is_refused_unless_forced(write):
    path = write(column("{:.6e}", 100 * WAVE))
    with pytest.raises(InputError, match=r"above 3 g.*force=True or in the file"):
        read_motion(path, unit="g", dt=0.01)
    assert read_motion(path, unit="g", dt=0.01, force=True).pga > 3 * GRAVITY
    assert read_motion(path, unit="gal", dt=0.01).pga < GRAVITY


def test_a_value_that_overflows_is_told_with_its_file(write, recwarn):
    with pytest.raises(InputError, match=r"record\.txt: sample 2 of 4 is 1e\+308"):
        read_motion(write("0.0\n1e308\n0.0\n0.1\n"), unit="g", dt=0.01)
    assert not recwarn.list
