"""Plain text of any layout: what stands above the samples is never one of them, and all that is stated counts."""

import numpy as np
import pytest
from obspy import Stream, Trace

from rockfrag.base.errors import InputError
from rockfrag.base.units import GRAVITY
from rockfrag.records.parsing.quantities import TO_SI
from rockfrag.records.parsing.text_file import NotAcceleration
from rockfrag.records.read import read_motion, read_record

from ..case_tables import case_tables
from .fields import lines

CASES = case_tables(__file__)
N = 400
WAVE = 0.3 * np.convolve(
    np.random.default_rng(0).normal(size=N + 5), np.ones(6) / 6, "valid"
)


@pytest.fixture
def write(tmp_path):
    """Write a text, with the samples that it names, and return its path."""
    path = tmp_path / "record.txt"

    def written(text):
        path.write_text(text.format_map(BODIES))
        return path

    return written


def beside(*columns):
    return lines(" ".join(["{:.6f}"] * len(columns)), *columns) + "\n"


def timed(dt=0.005, separator=","):
    return lines(f"{{:.6g}}{separator}{{:.5f}}", np.arange(N) * dt, WAVE) + "\n"


def in_rows(width, separator=" ", form="{:.6e}"):
    words = [form.format(value) for value in WAVE]
    return "".join(
        separator.join(words[i : i + width]) + "\n" for i in range(0, N, width)
    )


def bodies():
    """Return samples in all layouts, by their names in the tables of cases."""
    counted = np.arange(N)
    numbered = lines("{} {:.5f}", counted + 1, WAVE) + "\n"
    noise = np.random.default_rng(1).normal(size=(3, N))
    return {
        "column": in_rows(1),
        "decimal_commas": in_rows(1, form="{:.5f}").replace(".", ","),
        "decimal_commas_by_tabs": timed(0.01, "\t").replace(".", ","),
        # of as many digits as each sample needs
        "mixed": in_rows(1, form="{:.4g}"),
        "numbered": numbered,
        "numbered_commas": numbered.replace(" ", ","),
        "numbered_rows": lines("{},{:.2f},{:.6f}", counted, counted * 0.01, WAVE)
        + "\n",
        # steps of 0.00244 s printed to milliseconds: three columns, and no series of rows
        "uneven": lines("{:.3f} {:.5f} {:.5f}", counted * 0.00244, WAVE, WAVE) + "\n",
        "noise_3": beside(*noise),
        "rolled_5": beside(*(np.roll(WAVE, 70 * i) for i in range(5))),
        "timed": timed(),
        "timed_blanks": timed(separator=" "),
        "hundredths": timed(0.01, " "),
        "hundredths_commas": timed(0.01),
        "halves": timed(0.5),
        "halves_semicolons": timed(0.5, ";"),
        "halves_tabs": timed(0.5, "\t"),
        "steps_of_0_1": timed(0.1),
        "steps_of_0_977": timed(0.977),
        "steps_of_10": timed(10),
        **{f"rows_{width}": in_rows(width) for width in (3, 5, 6, 8)},
        "rows_8_short": in_rows(8, form="{:9.6f}"),
        "rows_8_commas": in_rows(8, ",", "{:9.6f}"),
        "rows_8_semicolons": in_rows(8, ";"),
        "rows_8_ending_in_commas": in_rows(8, ", ").replace("\n", ",\n"),
        "rows_of_a_comma": ",\n" * 4700,
        "rows_of_two_commas": ", ,\n" * 4700,
    }


BODIES = bodies()


@pytest.mark.parametrize(("text", "dt", "words"), CASES["refused"])
def test_what_cannot_be_told_is_refused(write, text, dt, words):
    with pytest.raises(InputError, match=words):
        read_record(write(text), dt)


@pytest.mark.parametrize("text", CASES["other_quantities"])
def test_another_quantity_is_refused_whatever_the_unit(write, text):
    with pytest.raises(NotAcceleration):
        read_motion(write(text), unit="g", dt=0.01)


@pytest.mark.parametrize(("text", "unit", "given", "dt"), CASES["read"])
def test_what_stands_above_the_samples_is_never_one_of_them(
    write, text, unit, given, dt
):
    motion = read_motion(write(text), unit=unit, dt=given)
    assert motion.dt == pytest.approx(dt, rel=1e-12)
    factor = TO_SI[unit or "g"]
    np.testing.assert_allclose(motion.acceleration, WAVE * factor, atol=6e-5 * factor)


def test_milliseconds_are_no_seconds_in_three_columns(write):
    rows = lines("{:g},{:.5f},{:.5f}", np.arange(N) * 0.5, WAVE, WAVE / 2)
    record = read_record(write(f"Time [msec],Acc X (g),Acc Y (g)\n{rows}\n"))
    assert {channel.dt for channel in record.channels} == {0.0005}


@pytest.mark.parametrize("first", ["0", "0.0", "-0"])
def test_a_zero_is_a_sample(write, first):
    path = write(f"{first}\n" + in_rows(1, form="{:.5f}"))
    assert read_motion(path, unit="g", dt=0.01).acceleration.size == N + 1


@pytest.mark.parametrize("line", CASES["intervals"])
def test_an_interval_in_words_is_used_and_held_against_the_user(write, line):
    path = write(f"{line}\n{{column}}")
    assert read_motion(path, unit="g").dt == 0.005
    assert read_motion(path, unit="g", dt=0.005).dt == 0.005
    with pytest.raises(InputError, match=r"0\.005 s, not 0\.01 s; leave dt= out"):
        read_record(path, 0.01)


@pytest.mark.parametrize("line", CASES["units"])
def test_a_unit_in_words_is_used_and_held_against_the_user(write, line):
    path = write(f"{line}\n{{timed_blanks}}")
    assert read_motion(path).metadata["unit"] == "m/s2"
    with pytest.raises(InputError, match="states its unit as m/s2, not g"):
        read_motion(path, unit="g")


def test_the_unit_of_a_peak_is_not_that_of_the_samples(write):
    with pytest.raises(InputError, match="does not state its unit"):
        read_motion(write("Peak acceleration in cm/s2: 3.1\n{timed_blanks}"))


def test_per_cent_of_g_is_no_g(write):
    path = write("Time (s),Acc (%g)\n{timed}")
    assert read_motion(path).pga == pytest.approx(
        np.abs(WAVE).max() * GRAVITY / 100, rel=1e-4
    )


def test_a_vertical_beside_directions_is_no_velocity(write):
    rows = lines("{:.2f},{:.5f},{:.5f},{:.5f}", np.arange(N) / 100, WAVE, WAVE, WAVE)
    record = read_record(write(f"Time,N,E,V\n{rows}\n"))
    assert [channel.component for channel in record.channels] == ["N", "E", "V"]
    assert len(read_record(write(f"t,a,v,d\n{rows}\n")).channels) == 1


def test_sigma(write):
    motion = read_motion(write(CASES["sigma"] + in_rows(5, "", "{:14.7E}")))
    np.testing.assert_allclose(motion.acceleration, WAVE, rtol=1e-6)
    assert (motion.dt, motion.metadata["component"]) == (0.005, "NS")


@pytest.mark.parametrize("header", CASES["greek"])
def test_greek_network(write, header):
    record = read_record(write(header + beside(WAVE, WAVE[::-1], 0.5 * WAVE)))
    assert [(c.component, c.unit, c.dt) for c in record.channels] == [
        (name, "cm/s2", 0.01) for name in "ENZ"
    ]
    np.testing.assert_allclose(record.channels[2].samples, 0.5 * WAVE, atol=1e-6)


@pytest.mark.parametrize(
    "header", ["% dt = 0.005 s\n% unit: m/s2\n", "% m/s^2, dt 0.005\n"]
)
def test_two_components_below_comments(write, header):
    path = write(header + beside(WAVE, WAVE[::-1]))
    assert read_motion(path, channel="2").acceleration == pytest.approx(
        WAVE[::-1], abs=1e-6
    )
    assert read_record(path, 0.005).channels[0].unit == "m/s2"


def test_components_without_titles_are_not_one_series(write):
    """Samples of one channel follow each other more smoothly than those of two."""
    columns = beside(WAVE, WAVE[::-1], np.roll(WAVE, 100))
    assert len(read_record(write(columns), 0.01).channels) == 3
    assert len(read_record(write("{uneven}"), 0.00244).channels) == 2


def test_seismic_handler_is_read_by_obspy(write):
    path = write("")
    Stream([Trace(WAVE, {"delta": 0.05, "station": "TEST"})]).write(
        str(path), format="SH_ASC"
    )
    assert path.read_text().startswith("DELTA:")
    record = read_record(path)
    assert (record.format, record.channels[0].dt, record.channels[0].npts) == (
        "SH_ASC",
        0.05,
        N,
    )


def test_a_peak_above_3_g_by_the_users_unit_is_refused_unless_forced(write):
    path = write(lines("{:.6e}", 100 * WAVE))
    with pytest.raises(InputError, match=r"above 3 g.*force=True or in the file"):
        read_motion(path, unit="g", dt=0.01)
    assert read_motion(path, unit="g", dt=0.01, force=True).pga > 3 * GRAVITY
    assert read_motion(path, unit="gal", dt=0.01).pga < GRAVITY


def test_a_value_that_overflows_is_told_with_its_file(write, recwarn):
    with pytest.raises(InputError, match=r"record\.txt: sample 2 of 4 is 1e\+308"):
        read_motion(write("0.0\n1e308\n0.0\n0.1\n"), unit="g", dt=0.01)
    assert not recwarn.list
