"""Units, titles and words by one grammar: applied, or refused, and never passed over."""

import random
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path

import numpy as np
import pytest
from obspy import Stream, Trace

from rockfrag.base.errors import InputError
from rockfrag.records.make_catalogue import make_catalogue
from rockfrag.records.parsing.directions import azimuth_of, is_vertical
from rockfrag.records.parsing.quantities import canonical_unit, quantity_of, to_si
from rockfrag.records.parsing.text_file import NotAcceleration
from rockfrag.records.read import read_motion, read_record

from ..fuzz.texts import texts

G, N, DT = 9.81, 200, 0.01
TIMES = np.arange(N) * DT
WAVE = 2.4525 * np.exp(-(((TIMES - 1) / 0.4) ** 2)) * np.cos(9 * (TIMES - 1))
PEAK = float(np.abs(WAVE).max())


@pytest.fixture
def write(tmp_path):
    """Write lines of a header and rows of columns, and return the path."""

    def written(header, *columns, mark=",", name="record.txt", encoding="utf-8"):
        rows = [
            mark.join(f"{x:.9g}" for x in row) for row in zip(*columns, strict=True)
        ]
        path = tmp_path / name
        path.write_bytes("\n".join([header, *rows, ""]).encode(encoding))
        return path

    return written


@pytest.mark.parametrize(
    ("writing", "factor"),
    [
        *(("ft/s^2", 0.3048), ("dm/s2", 0.1), ("m·s⁻²", 1.0), ("м/с²", 1.0)),
        *(("µg", G / 1e6), ("mGal", 1e-5), ("cm/seg/seg", 0.01), ("m/s.s", 1.0)),
        *(("10-3 g", G / 1e3), ("10⁻³ g", G / 1e3), ("0.001 g", G / 1e3)),
        *(("g/10", G / 10), ("%g", G / 100), ("gal (cm/s/s)", 0.01), ("g, filtered", G)),
    ],
)  # fmt: skip
def test_a_unit_in_a_title_is_applied_with_its_factor(write, writing, factor):
    path = write(f"Time (s);Acceleration ({writing})", TIMES, WAVE / factor, mark=";")
    assert read_motion(path).pga == pytest.approx(PEAK, rel=1e-8)
    other = "g" if canonical_unit(writing) != "g" else "m/s2"
    with pytest.raises(InputError, match="states its unit as"):
        read_motion(path, unit=other)


@pytest.mark.parametrize(
    ("tail", "factor"),
    [("g", G), ("m_s2", 1), ("cms2", 0.01), ("milli_g", G / 1e3), ("ft_s2", 0.3048)],
)
def test_a_unit_behind_an_underscore_is_one(write, tail, factor):
    path = write(f"time,acc_x_{tail}", TIMES, WAVE / factor)
    assert read_motion(path).pga == pytest.approx(PEAK, rel=1e-8)
    assert read_record(path).channels[0].component == "x"


@pytest.mark.parametrize("unit", ["g", "m/s2", "gal"])
@pytest.mark.parametrize(
    "title",
    [
        *("Acc (g x1000)", "Acc (m/s2 x 100)", "Acc (1000*g)", "Acc (g × 10)"),
        *("Acc (yd/s^2)", "Acc (V)", "Acc (kN)", "Acc (lsb)", "Acc furlong/s2"),
    ],
)  # fmt: skip
def test_what_may_be_meant_either_way_is_refused_whatever_the_user_says(
    write, title, unit
):
    path = write(f"Time (s),{title}", TIMES, WAVE)
    for given in (None, unit):
        with pytest.raises(InputError):
            read_motion(path, unit=given)


@pytest.mark.parametrize(
    "line",
    [
        *("Acceleration in g, multiply by 0.001", "Scale factor: 0.01", "multiplier: 2"),
        *("Factor de escala: 0.001", "Units: g x1000", "Units: furlong/s2", "Unit: V"),
    ],
)  # fmt: skip
def test_words_of_a_factor_or_of_an_unknown_unit_are_refused(write, line):
    for unit in (None, "g"):
        with pytest.raises(InputError):
            read_motion(write(f"{line}\ndt = 0.01", WAVE), unit=unit)


@pytest.mark.parametrize(
    "line",
    ["UNITS OF G, MULTIPLY BY 0.001", "UNITS OF G X 1000", "UNITS OF 1000 G"],
)
def test_a_factor_in_the_header_of_peer_is_refused(write, line):
    header = f"PEER\nTest, 1/1/2001, Station, 90\nACCELERATION TIME SERIES IN {line}"
    path = write(f"{header}\nNPTS= {N}, DT= .01 SEC", WAVE, name="a.AT2")
    with pytest.raises(InputError, match="factor"):
        read_motion(path)


def test_a_letter_before_a_unit_is_a_direction_and_no_prefix(write):
    record = read_record(write("time,N_gal,E_gal", TIMES, WAVE, WAVE))
    assert [(c.component, c.unit) for c in record.channels] == [
        *(("N", "cm/s2"), ("E", "cm/s2"))
    ]  # fmt: skip
    assert quantity_of("ngal") == "acceleration"
    assert to_si("ngal") == pytest.approx(1e-11)


@pytest.mark.parametrize(
    ("titles", "vertical"),
    [
        *(("EW VER NS", 1), ("N00E UPDO N90E", 1), ("LONG TRAN VERT", 2)),
        *(("HN1 HN2 HN3", 2), ("南北 东西 垂直", 2), ("С-Ю В-З Верт", 2), ("KG DB Düşey", 2)),
    ],
)  # fmt: skip
def test_verticals_are_told_in_the_words_of_networks(write, titles, vertical):
    path = write(
        f"dt = 0.01, unit: gal\n{titles}", WAVE, WAVE[::-1], 0.4 * WAVE, mark=" "
    )
    components = [channel.component for channel in read_record(path).channels]
    assert components == titles.split()
    assert [is_vertical(name) for name in components].index(True) == vertical
    table = make_catalogue([path], folder=path.parent).table
    assert len(table) == 2
    assert set(table["vertical"]) == {f"record.txt#{components[vertical]}"}
    assert (table["second"] != "").all()


def test_a_title_that_is_not_known_takes_no_name_away(write):
    path = write("dt = 0.01, unit: gal\nEW FOO NS", WAVE, WAVE, WAVE[::-1], mark="  ")
    assert [c.component for c in read_record(path).channels] == ["EW", "NS"]


def test_azimuths_in_other_languages():
    assert [azimuth_of(x) for x in ("EO", "Norte", "南北", "Doğu")] == [90, 0, 0, 90]


@pytest.mark.parametrize(
    "title", ["Absolute acceleration (m/s^2)", "Foo (m/s2)", "aT_ms2"]
)
def test_the_magnitude_of_components_is_no_motion(write, title):
    parts = WAVE, 0.5 * WAVE[::-1], G + 0.1 * WAVE
    length = np.sqrt(sum(part**2 for part in parts))
    titles = (
        "Time (s),Acceleration x (m/s^2),Acceleration y (m/s^2),Acceleration z (m/s^2)"
    )
    path = write(f"{titles},{title}", TIMES, *parts, length)
    assert [c.component for c in read_record(path).channels] == ["x", "y", "z"]
    alone = write("Time (s),Absolute acceleration (m/s^2)", TIMES, length)
    with pytest.raises(NotAcceleration, match="magnitude"):
        read_motion(alone)


def test_the_absolute_acceleration_of_a_floor_has_a_sign_and_is_read(write):
    path = write("Time (s),Absolute acceleration (m/s^2)", TIMES, WAVE)
    assert read_motion(path).pga == pytest.approx(PEAK)


@pytest.mark.parametrize(
    ("titles", "encoding"),
    [
        *(("时间(s),加速度(m/s^2)", "gbk"), ("時間(s),加速度(m/s^2)", "cp932")),
        *(("Zaman (s),İvme (m/s²)", "cp1254"), ("Время (с),Ускорение (м/с²)", "utf-8")),
        *(("Tiempo,Aceleración (m/s²)", "latin-1"), ("Timp,Accelerație (m/s2)", "utf-8")),
        *(("Χρόνος (s),Επιτάχυνση (m/s²)", "cp1253"), ("Время,Ускорение (m/s2)", "cp1251")),
    ],
)  # fmt: skip
def test_titles_in_other_languages_and_encodings(write, titles, encoding):
    path = write(titles, TIMES, WAVE, encoding=encoding)
    motion = read_motion(path)
    assert (motion.dt, motion.pga) == (DT, pytest.approx(PEAK, rel=1e-8))
    assert motion.metadata["component"] == ""
    with pytest.raises(InputError, match="times step by"):
        read_motion(path, dt=0.02)


@pytest.mark.parametrize(
    "words",
    [
        *("INTERVALO DE MUESTREO (SEGUNDOS): 0.01", "Tasa de muestreo: 100 muestras/s"),
        *("Abtastrate: 100 Hz", "Pas de temps = 0.01 s", "Шаг дискретизации: 0.01"),
        *("采样率: 100 Hz", "Örnekleme aralığı (ms): 10", "data_rate = 100 Hz", "dt_ms = 10"),
    ],
)  # fmt: skip
def test_an_interval_in_other_words_is_used_and_held_against_the_user(write, words):
    path = write(words, WAVE)
    assert read_motion(path, unit="g").dt == DT
    with pytest.raises(InputError, match=r"0\.01 s, not 0\.05 s"):
        read_motion(path, unit="g", dt=0.05)


def test_counts_in_spanish_and_intervals_that_no_record_has(write):
    with pytest.raises(InputError, match="promises 199 samples but 200"):
        read_motion(write("NUMERO DE DATOS: 199", WAVE), unit="g", dt=DT)
    path = write("INTERVALO DE MUESTREO (SEGUNDOS): 100.0", WAVE)
    with pytest.raises(InputError, match="interval of 100 s, which no record has"):
        read_motion(path, unit="g", dt=DT)


def test_a_column_that_rises_like_times_is_held_against_the_user(write):
    path = write("Aika,Kiihtyvyys (g)", TIMES, WAVE / G)
    with pytest.raises(InputError, match=r"if it is time, call it 'time \(s\)'"):
        read_motion(path)
    assert read_motion(path, dt=DT).dt == DT
    with pytest.raises(
        InputError, match=r"rises evenly by 0\.01, which is not 0\.02 s"
    ):
        read_motion(path, dt=0.02)


def test_a_round_first_sample_is_no_interval(write):
    noise = WAVE + 1e-4 * np.random.default_rng(1).normal(size=N)
    path = write("0.02", noise[1:])
    with pytest.raises(InputError, match="give it with dt="):
        read_motion(path, unit="m/s2")
    assert read_motion(path, unit="m/s2", dt=DT).acceleration.size == N


@pytest.mark.parametrize("first", ["0.2499", "9.81"])
def test_a_number_that_is_no_sample_and_no_interval_is_refused(tmp_path, first):
    path = tmp_path / "a.txt"
    path.write_text(first + "\n" + "".join(f"{x:.6e}\n" for x in WAVE))
    with pytest.raises(InputError, match="looks like no sample"):
        read_motion(path, unit="g", dt=DT)


ROWS = {
    "quoted": ('"Time (s)","Acceleration (g)"', '"{t:.2f}","{a:.8f}"'),
    "decimal commas in quotes": ('"Time (s)","Acc (g)"', '"{t:.2f}","{a:.8f}"'),
    "clock": ("datetime,acc (g)", "2023-05-09T10:00:{t:06.3f},{a:.8f}"),
    "day and clock": ("Date,Time,acc (g)", "2023-05-09,23:59:{t:06.3f},{a:.8f}"),
    "clock by blanks": ("# time acc_g", "10:00:{t:06.3f} {a:.8f}"),
}


@pytest.mark.parametrize("kind", ROWS)
def test_rows_of_other_programs(tmp_path, kind):
    title, row = ROWS[kind]
    rows = [row.format(t=t, a=a / G) for t, a in zip(TIMES, WAVE, strict=True)]
    if kind.startswith("decimal"):
        rows = [line.replace(".", ",") for line in rows]
    path = tmp_path / "a.csv"
    path.write_text("\n".join([title, *rows, ""]))
    motion = read_motion(path)
    assert (motion.dt, motion.acceleration.size) == (DT, N)
    np.testing.assert_allclose(motion.acceleration, WAVE, atol=1e-6)


def test_a_clock_goes_on_past_midnight(tmp_path):
    clocks = [
        f"23:59:{59 + t:06.3f}" if t < 1 else f"00:00:{t - 1:06.3f}" for t in TIMES
    ]
    path = tmp_path / "a.csv"
    rows = (f"{c},{a:.8f}" for c, a in zip(clocks, WAVE, strict=True))
    path.write_text("time,acc (m/s2)\n" + "\n".join(rows))
    assert read_motion(path).dt == DT


def test_a_list_of_tcl_goes_on_at_each_end_of_a_line(tmp_path):
    rows = [" ".join(f"{x:.7E}" for x in WAVE[i : i + 5]) for i in range(0, N, 5)]
    path = tmp_path / "gm.txt"
    for text in ("\\\n".join(rows), "{\n" + "\\\n".join(rows) + "}\n"):
        path.write_text(text)
        motion = read_motion(path, unit="m/s2", dt=DT)
        np.testing.assert_allclose(motion.acceleration, WAVE, rtol=1e-6)


def labview(path: Path, unit="g", samples=N, step=DT) -> Path:
    """Write a LabVIEW measurement of two channels."""
    head = "LabVIEW Measurement\t\nSeparator\tTab\nX_Columns\tOne\n***End_of_Header***\t\n\t\n"
    head += f"Channels\t2\t\t\nSamples\t{samples}\t{samples}\t\nY_Unit_Label\t{unit}\tm/s2\t\n"
    head += f"Delta_X\t{step}\t{step}\t\n***End_of_Header***\t\t\n"
    rows = "".join(
        f"{t:.6f}\t{a / G:.8f}\t{a:.8f}\n" for t, a in zip(TIMES, WAVE, strict=True)
    )
    path.write_text(
        head + "X_Value\tAcceleration table\tAcceleration block\tComment\n" + rows
    )
    return path


def test_labview_measurements_have_a_unit_and_a_step_a_channel(tmp_path):
    path = labview(tmp_path / "a.lvm")
    for channel, name in (("1", "table"), ("block", "block")):
        motion = read_motion(path, channel=channel)
        assert (motion.dt, motion.metadata["component"]) == (DT, name)
        np.testing.assert_allclose(motion.acceleration, WAVE, atol=1e-6)
    for wrong, words in (
        *(({"unit": "yd/s2"}, "no unit of acc"), ({"samples": 210}, "promises 210")),
        ({"step": 0.02}, "Delta_X gives"),
    ):
        with pytest.raises(InputError, match=words):
            read_motion(labview(tmp_path / "b.lvm", **wrong), channel="1")


@pytest.mark.parametrize(("code", "words"), [("EHZ", "velocity"), ("HNE", "counts")])
def test_whole_numbers_without_a_response_are_counts(tmp_path, code, words):
    path = tmp_path / "a.mseed"
    counts = np.round(1000 * WAVE).astype(np.int32)
    trace = Trace(counts, {"station": "R", "channel": code, "delta": DT})
    Stream([trace]).write(str(path), format="MSEED")
    with pytest.raises(
        InputError, match=f"does not state its unit.*{words}"
    ) as refused:
        read_motion(path)
    assert "if g" not in str(refused.value)
    if code == "EHZ":
        with pytest.raises(InputError, match="velocity"):
            read_motion(path, unit="m/s2")


def test_what_a_text_states_is_true_of_what_is_read_or_it_is_refused(tmp_path):
    """Unit × factor × titles × language × times × header; `make fuzz` draws 20 000."""
    make, rng, fates = texts(tmp_path), random.Random(56), {"used": 0, "refused": 0}
    for _ in range(300):
        _, attempt = make(rng)
        try:
            attempt()
            fates["used"] += 1
        except InputError:
            fates["refused"] += 1
    assert fates["used"] > 90


def test_the_page_of_formats_shows_what_the_readers_read():
    root = Path(__file__).resolve().parents[2]
    spec = spec_from_file_location("tables", root / "maintenance" / "record_tables.py")
    tables = module_from_spec(spec)
    spec.loader.exec_module(tables)
    page = tables.PAGE.read_text(encoding="utf-8")
    assert tables.page_with_table(page) == page


def test_azimuths_above_columns_are_no_samples(write):
    path = write("360,90", WAVE, WAVE[::-1])
    with pytest.raises(InputError, match="looks like titles"):
        read_motion(path, unit="gal", dt=DT, channel="1")
