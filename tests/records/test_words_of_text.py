"""What words above the samples of plain text state is taken, or held against the samples and the user."""

import numpy as np
import pytest

from rockfrag.base.errors import InputError
from rockfrag.base.units import GRAVITY
from rockfrag.records.make_catalogue import make_catalogue
from rockfrag.records.parsing.text_file import NotAcceleration
from rockfrag.records.read import read_motion

N, DT = 240, 0.01
TIMES = np.arange(N) * DT
WAVE = 1.9 * np.exp(-(((TIMES - 1) / 0.5) ** 2)) * np.cos(11 * (TIMES - 1))
OTHER = 0.8 * np.exp(-(((TIMES - 1.2) / 0.5) ** 2)) * np.sin(8 * (TIMES - 1))
THIRD = 0.5 * np.sin(13 * TIMES)


@pytest.fixture
def write(tmp_path):
    """Write lines of words above columns of numbers, and return the path."""

    def written(words, *columns, name="record.txt", form="{:.7e}", mark=" "):
        rows = [mark.join(map(form.format, row)) for row in zip(*columns, strict=True)]
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("\n".join([*words.splitlines(), *rows, ""]), encoding="utf-8")
        return path

    return written


@pytest.mark.parametrize(
    "words",
    [
        *("Frequency: 100 Hz", "Freq. 100Hz", "frequency (Hz) = 100", "fs = 0.1 kHz"),
        *("data_rate = 100 Hz", "Frecuencia: 100 Hz", "Taux : 100 Hz", "Частота: 100 Гц"),
        *("sampling: 0.01 s", "Sampling every 0.01 sec", "DT=1/100", "Δt=10ms"),
        *("INTERVALO DE MUESTREO: 1/100 seg", "Sample Period (ms) 10", "频率: 100 Hz"),
    ],
)  # fmt: skip
def test_words_state_the_interval_and_are_held_against_the_user(write, words):
    path = write(words, WAVE)
    assert read_motion(path, unit="m/s2").dt == pytest.approx(DT, rel=1e-12)
    with pytest.raises(InputError, match=r"states an interval of 0\.01 s, not 0\.04 s"):
        read_motion(path, unit="m/s2", dt=0.04)


@pytest.mark.parametrize(
    "words",
    [
        *("Natural frequency: 200 Hz", "Filter frequency: 100 Hz", "Frequency: 5 Hz"),
        *("Frequency range: 0.1-100 Hz", "baud rate: 9600", "Sampling time: 10:00:00"),
        *("Excitation frequency: 100 Hz", "Corner frequency: 100 Hz", "interval: 1/3/2001"),
    ],
)  # fmt: skip
def test_other_frequencies_and_times_state_no_interval(write, words):
    with pytest.raises(InputError, match="without sampling interval"):
        read_motion(write(words, WAVE), unit="m/s2")


@pytest.mark.parametrize(
    "words",
    [
        *("Count: 400", "N = 400", "length: 400", "length 400 samples", "nsamp=400"),
        *("NDTS=400", "Длина записи: 400", "Data length = 400 points", "npnts 400"),
    ],
)  # fmt: skip
def test_a_count_in_words_must_be_that_of_the_samples(write, words):
    with pytest.raises(InputError, match="promises 400 samples but 240 follow"):
        read_motion(write(f"{words}\ndt = 0.01 s", WAVE), unit="m/s2")


@pytest.mark.parametrize(
    "words",
    [
        *("Duration: 2.4 s", "DURATION (sec) = 2.39", "Record duration: 2 s", "Dauer: 2,40 s"),
        *("Durée : 2400 ms", "duración del registro = 2.4", "记录时间: 2.4 s", "Süre 2,4 sn"),
    ],
)  # fmt: skip
def test_a_duration_in_words_is_held_against_the_user(write, words):
    path = write(words, WAVE)
    assert read_motion(path, unit="m/s2", dt=DT).acceleration.size == N
    with pytest.raises(InputError, match=r"4\.8 s long, but the header states a dur"):
        read_motion(path, unit="m/s2", dt=2 * DT)


@pytest.mark.parametrize(
    "words",
    [
        *("Significant duration: 0.8 s", "Duration D5-95: 1.1 s", "Duration: 00:40:00"),
        *("Event duration 40 s (felt)", "duration magnitude: 4.1", "Duration 12 km"),
    ],
)
def test_other_durations_are_not_that_of_the_record(write, words):
    assert read_motion(write(words, WAVE), unit="m/s2", dt=DT).acceleration.size == N


@pytest.mark.parametrize(
    "words", ["n = 4", "Butterworth, n = 4", "Counts: 12 tests", "Length: 400 m"]
)
def test_other_numbers_are_no_count(write, words):
    path = write(f"{words}\ndt = 0.01 s", WAVE)
    assert read_motion(path, unit="m/s2").acceleration.size == N


@pytest.mark.parametrize(
    "words",
    [
        *("Velocity time history", "Ground velocity", "vel", "Geschwindigkeit [cm/s]"),
        *("Vitesse (m/s)", "Скорость, см/с", "速度(cm/s)", "Desplazamiento (cm)"),
        *("Spostamento in mm", "変位 (cm)", "Response spectrum", "Fourier amplitude"),
        *("Force (kN)", "Pressure [kPa]", "Rotation (rad)", "Hız (cm/s)"),
        *("Kiihtyvyys (mV)", "Kiihtyvyys [kN*1000]", "Data (mm)", "Record (cm/s)"),
    ],
)  # fmt: skip
def test_a_title_of_another_quantity_is_refused_whatever_the_user_says(write, words):
    for given in (f"{words}\ndt = 0.01", f"dt = 0.01\n{words}"):
        with pytest.raises(NotAcceleration):
            read_motion(write(given, WAVE), unit="m/s2")


@pytest.mark.parametrize(
    "words",
    [
        *("spectrum-compatible motion", "Spectrally matched record", "Drift corrected"),
        *("Rupture velocity 2.5 (km/s)", "Distance 12 (km)", "Sampling rate 100 (Hz)"),
        *("Shear wave velocity: 300 m/s", "Rupture velocity 2.5 km/s", "Station Speed"),
        *("Acceleration and velocity of test 3", "Force balance sensor, test of a wall"),
    ],
)  # fmt: skip
def test_remarks_on_other_quantities_do_not_refuse_a_record(write, words):
    path = write(f"{words}\nUnits: m/s2\ndt = 0.01", WAVE)
    assert read_motion(path).pga == pytest.approx(1.9, rel=1e-6)
    if " (" in words:
        path = write(f"{words}\ndt = 0.01", WAVE)
        assert read_motion(path, unit="m/s2").pga == pytest.approx(1.9, rel=1e-6)


FACTORS = (
    *("mit 9,81 multiplizieren", "multiplicar los valores por 9.81", "1 unit = 0.001 g"),
    *("Divide all values by 1000", "facteur multiplicatif : 0.01", "Data x 1e-6 g"),
    "Values must be multiplied with 0.01 to get m/s2",
    *("Acceleration in thousandths of g", "Beschleunigung in tausendstel g"),
    *("Values in thousandths of g", "thousandths of g", "# tenths of gal"),
)  # fmt: skip


@pytest.mark.parametrize(
    "words", ["Values in mg", "240 samples in milli g", "Werte in mg"]
)
def test_values_in_a_unit_are_the_samples_whatever_a_user_says(write, words):
    path = write(f"{words}\ndt = 0.01", WAVE)
    assert read_motion(path).pga == pytest.approx(np.abs(WAVE).max() * GRAVITY / 1000)
    with pytest.raises(InputError):
        read_motion(path, unit="g")


@pytest.mark.parametrize("unit", [None, "g"])
@pytest.mark.parametrize("words", FACTORS)
def test_words_of_a_factor_are_never_passed_over(write, words, unit):
    with pytest.raises(InputError):
        read_motion(write(f"{words}\ndt = 0.01", WAVE), unit=unit)


@pytest.mark.parametrize("words", ["Units 0.002G", "unit=0.002g", "Unit: 2·10⁻³ g"])
def test_a_part_of_a_unit_is_a_unit(write, words):
    path = write(f"{words}\ndt = 0.01", WAVE)
    try:
        pga = read_motion(path).pga
    except InputError:
        pga = 0.002 * 9.81 * 1.9
    assert pga == pytest.approx(0.002 * 9.81 * 1.9, rel=1e-6)
    with pytest.raises(InputError):
        read_motion(path, unit="g")


@pytest.mark.parametrize(
    "unit",
    [
        *("thousandths of g", "promille g", "10E-3 g", "fps2", "ips2", "normalized"),
        *("0.001 V", "0.5 N", "V/g", "arb. u.", "sixths of g", "m/s2 RMS"),
    ],
)  # fmt: skip
def test_a_unit_that_other_words_change_is_no_unit(write, unit):
    path = write(f"Time (s);Acc X ({unit})", TIMES, WAVE, mark=";")
    for given in (None, "m/s2", "g"):
        with pytest.raises(InputError):
            read_motion(path, unit=given)


def test_a_title_whose_letters_cannot_be_read_states_no_unit(write):
    path = write("Time (s);NS [см/с2]", TIMES, WAVE, mark=";")
    path.write_bytes(path.read_text(encoding="utf-8").encode("cp932"))
    with pytest.raises(InputError, match="cannot be read; save the file as UTF-8"):
        read_motion(path, unit="g")


def test_an_unknown_unit_of_an_unknown_word_above_one_column_is_stated(write):
    for words in ("Kiihtyvyys (V)", "Kiihtyvyys [widgets/s2]"):
        with pytest.raises(InputError, match=r"velocity|unit"):
            read_motion(write(f"dt = 0.01\n{words}", WAVE), unit="g")


def test_what_a_digit_is_worth_is_a_factor_of_counts_and_a_remark_on_others(write):
    words = "dt = 0.01\nResolution: 0.06 mg/LSB\nAcceleration"
    assert read_motion(write(words, WAVE), unit="m/s2").pga == pytest.approx(1.9)
    counts = write(words, np.round(1e4 * WAVE), form="{:.0f}")
    with pytest.raises(InputError, match="counts"):
        read_motion(counts, unit="m/s2", force=True)


PEAKS = (
    *("PGA = {} g", "Peak acceleration: {} g", "PGA: {}g", "PGA (g): {}"),
    *("Maximum acceleration = -{} g", "Aceleración máxima: {} g", "最大加速度 = {} g"),
    *("accélération maximale : {} g", "Spitzenbeschleunigung: {} g", "Max. Acc. (g) {}"),
    *("PEAK VALUES: ACCEL={} G AT 3.2 SEC, VEL=12 CM/S", "Максимальное ускорение: {} g"),
)  # fmt: skip


@pytest.mark.parametrize("words", PEAKS)
def test_a_peak_in_words_is_held_against_the_samples(write, words):
    own, another = words.format(f"{1.9 / 9.81:.4f}"), words.format("0.5")
    for unit, stated in ((None, "\nAcceleration in m/s2"), ("m/s2", "")):
        path = write(f"{own}\ndt = 0.01{stated}", WAVE)
        assert read_motion(path, unit=unit).pga == pytest.approx(1.9, rel=1e-6)
        with pytest.raises(InputError, match=r"states a peak of 0\.5 g"):
            read_motion(write(f"{another}\ndt = 0.01{stated}", WAVE), unit=unit)


@pytest.mark.parametrize(
    "words",
    ["Full scale: max 4 g", "Trigger at peak 0.01 g", "scaled to PGA 0.4 g", "Max 4"],
)
def test_peaks_of_sensors_and_targets_are_not_those_of_the_samples(write, words):
    path = write(f"{words}\ndt = 0.01\nAcceleration in m/s2", WAVE)
    assert read_motion(path).pga == pytest.approx(1.9, rel=1e-6)


def test_a_peak_is_held_against_samples_in_a_part_of_a_unit(write):
    titles = "PGA = 3.80 m/s2\nTime (s);Acc (10^-3 dm/s2)"
    with pytest.raises(InputError, match=r"states a peak of 3\.8 m/s2"):
        read_motion(write(titles, TIMES, 1e4 * WAVE, mark=";"))


def test_peaks_of_several_components_fit_in_any_order(write):
    titles = "Time (s);NS (m/s2);EW (m/s2)"
    peaks = [np.abs(wave).max() for wave in (WAVE, OTHER)]
    for order in (peaks, peaks[::-1]):
        words = "\n".join(f"Peak acceleration: {peak:.4f} m/s2" for peak in order)
        path = write(f"{words}\n{titles}", TIMES, WAVE, OTHER, mark=";")
        assert read_motion(path, channel="NS").pga == pytest.approx(1.9, rel=1e-6)
    twice = write(f"{words}\n{titles}", TIMES, 2 * WAVE, OTHER, mark=";")
    with pytest.raises(InputError, match="states peaks of"):
        read_motion(twice, channel="EW")


@pytest.mark.parametrize(
    "name",
    [
        *("X_E.vel", "X_E.VEL", "X_E.disp", "X_E.DIS", "X.dsp", "a-vel.txt", "E.vel.txt"),
        *("velocity_E.dat", "disp_N.csv", "velocidad.txt", "desplazamiento_N.txt"),
        *("vitesse.txt", "geschwindigkeit_E.txt", "vel/X_E.txt", "Displacement/N.txt"),
    ],
)  # fmt: skip
def test_a_name_that_says_velocity_or_displacement_is_believed(write, name):
    path = write("", TIMES, WAVE, name=name)
    with pytest.raises(NotAcceleration, match=r"name.* says (velocity|displacement)"):
        read_motion(path, unit="m/s2")
    path = write("acceleration", TIMES, WAVE, name=name)
    assert read_motion(path, unit="m/s2").dt == DT


@pytest.mark.parametrize(
    "name", ["X_E.acc", "Velino.txt", "disposal.txt", "accvel.acc", "vel/acc_E.txt"]
)
def test_other_names_say_nothing_against_a_record(write, name):
    assert read_motion(write("", TIMES, WAVE, name=name), unit="m/s2").dt == DT


@pytest.mark.parametrize("title", ["Sample", "No.", "Nummer", "序号"])
def test_numbers_of_samples_that_jump_are_a_gap(write, title):
    numbers = np.arange(N) + 5 * (np.arange(N) > 99)
    path = write(f"{title};Acc (m/s2)", numbers, WAVE, form="{:.9g}", mark=";")
    with pytest.raises(InputError, match=r"line 102.*goes from 99 to 105.*gap"):
        read_motion(path, dt=DT)


def test_a_counter_may_begin_anew(write):
    numbers = np.arange(N) % 64
    path = write("counter;Acc (m/s2)", numbers, WAVE, form="{:.9g}", mark=";")
    assert read_motion(path, dt=DT).acceleration.size == N


def test_a_round_first_sample_is_asked_about_even_where_dt_is_the_same(write):
    samples = WAVE.copy()
    samples[0] = DT
    path = write("", samples, form="{:.5f}")
    with pytest.raises(InputError, match="may be the interval or a sample"):
        read_motion(path, unit="m/s2", dt=DT)
    told = write("dt = 0.01 s", samples, form="{:.5f}")
    assert read_motion(told, unit="m/s2").acceleration.size == N


@pytest.mark.parametrize("above", ["0.2499", "0.25", "240 0.2499"])
def test_a_scale_above_the_samples_is_no_interval(write, above):
    with pytest.raises(InputError, match="above the samples"):
        read_motion(write(above, WAVE), unit="m/s2")


def test_four_columns_without_titles_are_no_series(write):
    noise = np.random.default_rng(3).normal(size=(3, N))
    columns = (*noise, np.sqrt((noise**2).sum(axis=0)))
    with pytest.raises(InputError, match="4 columns side by side or one series"):
        read_motion(write("dt = 0.01", *columns), unit="m/s2")


@pytest.mark.parametrize(
    ("title", "factor", "shift"),
    [("Total (m/s2)", 1, 0), ("a (g)", 9.81, 0), ("total (m/s2)", 1, 9.81)],
)
def test_the_length_of_a_vector_is_no_component(write, title, factor, shift):
    third = THIRD + shift
    length = np.sqrt(WAVE**2 + OTHER**2 + third**2) - shift
    columns = (TIMES, WAVE, OTHER, third, length / factor)
    titles = f"Time (s);ax (m/s2);ay (m/s2);az (m/s2);{title}"
    path = write(titles, *columns, mark=";", form="{:.9e}")
    table = make_catalogue([path], folder=path.parent).table
    assert table["component"].tolist() == ["ax", "ay"]
    assert table["vertical"].str.endswith("#az").all()


@pytest.mark.parametrize(
    "names",
    [
        *(("NS_r7", "EW_r7", "UD_r7"), ("P180 (1)", "P090 (1)", "PUP (1)")),
        *(("P180_g", "P090_g", "PUP_g"), ("E.one", "N.one", "Z.one")),
    ],
)  # fmt: skip
def test_components_are_known_by_more_names(write, names):
    for name, wave in zip(names, (WAVE, OTHER, THIRD), strict=True):
        path = write("dt = 0.01\nAcceleration (m/s2)", wave, name=f"{name}.txt")
    table = make_catalogue([path.parent], folder=path.parent).table
    assert len(table) == 2
    assert (table["second"] != "").all()
    assert (table["vertical"] == f"{names[2]}.txt").all()


@pytest.mark.parametrize("titles", ["TR;VT;LN", "N;D;E", "EW;VER;NS", "L;V;T"])
def test_the_vertical_is_known_wherever_it_stands(write, titles):
    named = "Time (s);" + ";".join(f"{title} (m/s2)" for title in titles.split(";"))
    path = write(named, TIMES, WAVE, THIRD, OTHER, mark=";")
    table = make_catalogue([path], folder=path.parent).table
    assert table["component"].tolist() == titles.split(";")[::2]
    assert (table["vertical"] != "").all()


def test_a_title_of_an_empty_last_column_takes_no_part(write):
    rows = write("Time (s),Acc (m/s2),Comment", TIMES, WAVE, mark=",")
    rows.write_text(
        rows.read_text().replace("\n", ",\n").replace("Comment,", "Comment")
    )
    assert read_motion(rows).pga == pytest.approx(1.9, rel=1e-6)
