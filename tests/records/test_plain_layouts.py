"""Plain text of any layout: what stands above the samples is never one of them, and all that is stated counts."""

import numpy as np
import pytest
from obspy import Stream, Trace

from rockfrag.errors import InputError
from rockfrag.records.parsing.text_file import NotAcceleration
from rockfrag.records.read import FORMATS, read_motion, read_record
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


def pga(path, **given):
    return read_motion(path, **given).pga


class TestTime:
    @pytest.mark.parametrize(
        "title", ["Time (ms)", "Time [msec]", "time_ms", "t(ms)", "Time (milliseconds)", "T [MS]"]
    )
    @pytest.mark.parametrize("separator", [",", ";", "\t"])
    def test_milliseconds_are_no_seconds_in_two_columns_or_three(self, write, title, separator):
        two = write(f"{title}{separator}Acceleration (g)\n{timed(0.5, separator)}", "two.csv")
        rows = "".join(
            f"{i * 0.5:g}{separator}{v:.5f}{separator}{v / 2:.5f}\n" for i, v in enumerate(WAVE)
        )
        three = write(f"{title}{separator}Acc X (g){separator}Acc Y (g)\n{rows}", "three.csv")
        assert read_motion(two).dt == 0.0005
        assert {channel.dt for channel in read_record(three).channels} == {0.0005}

    @pytest.mark.parametrize("step", [0.1, 0.5, 0.977, 1.0, 5.0, 10.0])
    def test_every_step_of_milliseconds_is_read(self, write, step):
        path = write(f"Time (ms),Acceleration (g)\n{timed(step)}")
        assert read_motion(path).dt == pytest.approx(step / 1000, rel=1e-4)

    def test_a_line_of_units_below_the_titles_counts(self, write):
        assert read_motion(write(f"time,acc\nms,g\n{timed(0.5)}")).dt == 0.0005

    def test_minutes_are_minutes_and_days_are_refused(self, write):
        assert read_motion(write(f"Time (min),Acc (g)\n{timed(0.01)}")).dt == pytest.approx(0.6)
        with pytest.raises(InputError, match=r"'days' of column .* is no unit of time known here"):
            read_record(write(f"Time (days),Acc (g)\n{timed()}"))

    def test_a_column_that_counts_samples_is_no_time(self, write):
        numbered = "".join(f"{i + 1} {v:.5f}\n" for i, v in enumerate(WAVE))
        with pytest.raises(InputError, match="counts by ones"):
            read_record(write(numbered))
        assert read_motion(write(numbered), unit="g", dt=0.01).dt == 0.01
        titled = write("No,Acc (g)\n" + numbered.replace(" ", ","))
        with pytest.raises(InputError, match="dt="):
            read_record(titled)
        assert read_motion(titled, dt=0.01).acceleration.size == N

    def test_times_that_are_not_even_are_no_samples_of_a_series(self, write):
        """Steps of 0.00244 s printed to milliseconds: three columns, and no series of rows."""
        rows = "".join(f"{i * 0.00244:.3f} {v:.5f} {v:.5f}\n" for i, v in enumerate(WAVE))
        with pytest.raises(InputError, match=r"time column steps by 0\.00244 s"):
            read_record(write(rows))
        assert len(read_record(write(rows), 0.00244).channels) == 2


class TestNumbersAbove:
    @pytest.mark.parametrize(
        "header",
        [
            f"{N}\n0.005\n",
            f"0.005\n{N}\n",
            f"{N} 0.005\n",
            f"0.005 {N}\n",
            "1 \n5.000000e-03 \n",
            "0.005\n",
            f"a title\n{N}\n0.005\n",
        ],
    )
    @pytest.mark.parametrize("given", [None, 0.005])
    def test_a_count_and_an_interval_are_no_samples(self, write, header, given):
        motion = read_motion(write(header + column()), unit="g", dt=given)
        assert motion.dt == 0.005
        np.testing.assert_allclose(motion.acceleration, WAVE * GRAVITY, atol=1e-5)

    @pytest.mark.parametrize("body", [in_rows(5), in_rows(8), timed(0.005, " ")])
    @pytest.mark.parametrize("header", [f"{N}\n0.005\n", f"{N} 0.005\n", f"0.005 {N}\n"])
    def test_they_stand_above_rows_and_columns_too(self, write, header, body):
        motion = read_motion(write(header + body), unit="g")
        assert (motion.acceleration.size, motion.dt) == (N, 0.005)

    def test_an_interval_that_samples_could_be_is_one_when_the_user_says_so(self, write):
        mixed = column("{!r}", [float(f"{v:.4g}") for v in WAVE])
        with pytest.raises(InputError, match="give it with dt="):
            read_record(write("0.02\n" + mixed))
        assert read_motion(write("0.02\n" + mixed), unit="g", dt=0.02).acceleration.size == N

    @pytest.mark.parametrize("first", ["0", "0.0", "-0"])
    def test_a_zero_is_a_sample(self, write, first):
        path = write(f"{first}\n" + column("{:.5f}"))
        assert read_motion(path, unit="g", dt=0.01).acceleration.size == N + 1

    def test_a_count_that_does_not_fit_is_an_error(self, write):
        for header in (f"{N + 7}\n", f"{N + 7}\n0.005\n", f"{N - 7} 0.005\n", f"npts {N + 7}\n"):
            with pytest.raises(InputError, match=rf"promises \d+ samples but {N} follow"):
                read_record(write(header + column()), 0.005)

    def test_an_interval_against_the_users_is_an_error(self, write):
        with pytest.raises(InputError, match=r"0\.005 s, not 0\.01 s"):
            read_record(write(f"{N}\n0.005\n" + column()), 0.01)

    def test_numbers_that_state_nothing_known_are_an_error(self, write):
        with pytest.raises(InputError, match=r"line 2.*above the samples is neither"):
            read_record(write("title\n34.1 118.2 7\n" + in_rows(8)), 0.01)

    @pytest.mark.parametrize("bad", ["nan", "*****", "1.2.3", "0x1p3"])
    def test_a_first_row_that_is_damaged_is_no_header(self, write, bad):
        with pytest.raises(InputError, match="line 1"):
            read_record(write(f"{bad}\n" + column()), 0.01)
        with pytest.raises(InputError, match="line 1"):
            read_record(write(f"0 {bad}\n" + timed(0.01, " ")))


class TestWords:
    @pytest.mark.parametrize(
        "line",
        ["Time Step: 0.005", "#DELTA: 0.005", "# dt = 0.005", "Time Increment (s)  : 0.005",
         "sampling frequency: 200.0 Hz", "Sampling rate = 200", "dt 0.005 s", '"@ DT =",.005',
         "sampling interval (ms): 5", "data at 200 samples per second", "Δt = 0.005",
         "sampled at 200 Hz", "400 points at 0.005 sec intervals"],
    )  # fmt: skip
    def test_an_interval_in_words_is_used_and_held_against_the_user(self, write, line):
        path = write(f"{line}\n{column()}")
        assert read_motion(path, unit="g").dt == 0.005
        assert read_motion(path, unit="g", dt=0.005).dt == 0.005
        with pytest.raises(InputError, match=r"0\.005 s, not 0\.01 s; leave dt= out"):
            read_record(path, 0.01)

    def test_what_looks_like_an_interval_is_none(self, write):
        for line in (
            "Delta 0.5 deg",
            "Filter 0.1 - 25 Hz",
            "sampled by A",
            "Frequency range: 0.1 Hz",
        ):
            with pytest.raises(InputError, match="give it with dt="):
                read_record(write(f"{line}\n{column()}"))

    @pytest.mark.parametrize(
        "line",
        ["Acceleration in m/s2", "acc: m/s2", "units: m/s^2", "Station X unit m/s2", "Unit = m/s/s",
         "Accel" "aration time series in m/s/s", "Acceleration (m/s²)", "# m/s2", "acc_m/s2"],
    )  # fmt: skip
    def test_a_unit_in_words_is_used_and_held_against_the_user(self, write, line):
        path = write(f"{line}\n{timed(0.005, ' ')}")
        assert read_motion(path).metadata["unit"] == "m/s2"
        with pytest.raises(InputError, match="states its unit as m/s2, not g"):
            read_motion(path, unit="g")

    def test_the_unit_of_a_peak_is_not_that_of_the_samples(self, write):
        with pytest.raises(InputError, match="does not state its unit"):
            read_motion(write(f"Peak acceleration in cm/s2: 3.1\n{timed(0.005, ' ')}"))

    def test_a_count_in_words_is_held_against_the_samples(self, write):
        with pytest.raises(InputError, match=f"promises 90 samples but {N} follow"):
            read_record(write(f"npts 90 dt .02\n{column()}"))

    def test_statements_that_exclude_each_other_are_an_error(self, write):
        with pytest.raises(InputError, match=r"intervals of 0\.01 and 0\.02"):
            read_record(write(f"dt = 0.01\ntime step: 0.02\n{column()}"))
        with pytest.raises(InputError, match="is in g, but the lines above it say cm/s2"):
            read_record(write(f"unit: cm/s2\nTime (s),Acc (g)\n{timed()}"))
        with pytest.raises(InputError, match=r"dt = 0\.01 s, but times step by 0\.005 s"):
            read_record(write(f"dt = 0.01\n{timed()}"))

    def test_a_comment_above_two_columns_is_no_title(self, write):
        for comment in ("# my record", "# my own record", "% a b", "! Kobe 1995"):
            motion = read_motion(write(f"{comment}\n{timed(0.01, ' ')}"), unit="g")
            assert (motion.dt, motion.acceleration.size) == (0.01, N)

    def test_a_factor_that_is_not_applied_is_an_error(self, write):
        with pytest.raises(InputError, match="factor that is not applied"):
            read_record(write(f"Scale factor: 2.5\n{column()}"), 0.01)

    @pytest.mark.parametrize("words", ["Velocity time history (cm/s)", "displacement in cm"])
    def test_words_of_another_quantity_refuse(self, write, words):
        with pytest.raises(NotAcceleration, match=r"velocity|displacement"):
            read_record(write(f"{words}\n{column()}"), 0.01)

    @pytest.mark.parametrize(
        "line",
        ["Shear wave velocity (m/s): 760", "Corrected for displacement", "N: 37", "Vs30 = 760 m/s"],
    )
    def test_a_fact_about_the_site_is_none_about_the_samples(self, write, line):
        motion = read_motion(write(f"{line}\n{column()}"), unit="g", dt=0.01)
        assert motion.acceleration.size == N


class TestQuantities:
    @pytest.mark.parametrize(
        "title",
        ["Force (kN)", "Temperature (C)", "Resistance (Ohm)", "Load", "Strain (µε)", "qc (MPa)",
         "Displacement (m)", "Velocity", "Signal (mV)", "Acc (counts)", "Volt", "Pressure [kPa]"],
    )  # fmt: skip
    def test_a_column_of_another_quantity_is_refused_whatever_the_unit(self, write, title):
        with pytest.raises(NotAcceleration):
            read_motion(write(f"Time (s),{title}\n{timed()}"), unit="g")

    def test_a_cone_penetration_test_is_no_motion(self, write):
        for header in ("Depth (m),qc (MPa)", "Depth qc"):
            text = timed(0.01, "," if "," in header else " ")
            with pytest.raises(NotAcceleration):
                read_motion(write(f"{header}\n{text}"), unit="g", dt=0.01)

    def test_per_cent_of_g_is_no_g(self, write):
        path = write(f"Time (s),Acc (%g)\n{timed()}")
        assert pga(path) == pytest.approx(np.abs(WAVE).max() * GRAVITY / 100, rel=1e-4)

    def test_a_vertical_beside_directions_is_no_velocity(self, write):
        rows = "".join(f"{i / 100:.2f},{v:.5f},{v:.5f},{v:.5f}\n" for i, v in enumerate(WAVE))
        record = read_record(write("Time,N,E,V\n" + rows))
        assert [channel.component for channel in record.channels] == ["N", "E", "V"]
        record = read_record(write("t,a,v,d\n" + rows))
        assert len(record.channels) == 1


class TestLayouts:
    def test_emod3d(self, write):
        text = f"CACS 000 title\n{N} 5.0e-03 0 0 -1.0 0.0 0.0 0.0\n"
        for width in (6, 8):
            motion = read_motion(write(text + in_rows(width)), unit="cm/s2")
            assert (motion.acceleration.size, motion.dt) == (N, 0.005)

    @pytest.mark.parametrize("separator", [" ", ","])
    def test_shake(self, write, separator):
        text = f'"El Centro"\n"Total No. of Points :",{N},"@ DT =",.02\n'
        motion = read_motion(write(text + in_rows(8, separator, "{:9.6f}"), "a.ACC"), unit="g")
        assert (motion.acceleration.size, motion.dt) == (N, 0.02)

    def test_sigma(self, write):
        """Fields of 14 columns that touch."""
        rows = "".join(
            "".join(f"{v:14.7E}" for v in WAVE[i : i + 5]) + "\n" for i in range(0, N, 5)
        )
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
            "*"
            * 40
            + "\n\nstation: PRF0\nsampling frequency (fs): 100.0\ndelta: 0.01\nunits: gal\n"
            "components: E N Z\nstarttime: 2015-07-24 09:58:34\n\n",
        ],
    )
    def test_greek_network(self, write, header):
        record = read_record(write(header + beside(WAVE, WAVE[::-1], 0.5 * WAVE)))
        assert [(c.component, c.unit, c.dt) for c in record.channels] == [
            (name, "cm/s2", 0.01) for name in "ENZ"
        ]
        np.testing.assert_allclose(record.channels[2].samples(), 0.5 * WAVE, atol=1e-6)

    @pytest.mark.parametrize("header", ["% dt = 0.005 s\n% unit: m/s2\n", "% m/s^2, dt 0.005\n"])
    def test_two_components_below_comments(self, write, header):
        path = write(header + beside(WAVE, WAVE[::-1]))
        assert read_motion(path, channel="2").acceleration == pytest.approx(WAVE[::-1], abs=1e-6)
        assert read_record(path, 0.005).channels[0].unit == "m/s2"

    def test_components_without_titles_are_not_one_series(self, write):
        """Samples of one channel follow each other more smoothly than those of two."""
        columns = beside(WAVE, WAVE[::-1], np.roll(WAVE, 100))
        assert len(read_record(write(columns), 0.01).channels) == 3
        assert read_motion(write(in_rows(3)), unit="g", dt=0.01).acceleration.size == N
        noise = np.random.default_rng(1).normal(size=(3, N))
        with pytest.raises(InputError, match="may be 3 columns side by side or one series"):
            read_record(write(beside(*noise)), 0.01)
        with pytest.raises(InputError, match="may be 5 columns side by side"):
            read_record(write(beside(*(np.roll(WAVE, 70 * i) for i in range(5)))), 0.01)

    @pytest.mark.parametrize("separator", [",", ";", ", "])
    def test_rows_may_be_separated_by_commas_or_semicolons(self, write, separator):
        motion = read_motion(write(in_rows(8, separator), "A10000.csv"), unit="g", dt=0.01)
        np.testing.assert_allclose(motion.acceleration, WAVE * GRAVITY, atol=1e-5)
        trailing = in_rows(8, separator).replace("\n", separator.strip() + "\n")
        assert read_motion(write(trailing), unit="g", dt=0.01).acceleration.size == N

    @pytest.mark.parametrize("empty", [",", ", ,", ",,"])
    def test_the_empty_rows_of_a_spreadsheet_are_none(self, write, empty):
        path = write(f"Time (s),Acc (g)\n{timed()}" + f"{empty}\n" * 4700)
        assert read_motion(path).acceleration.size == N

    def test_decimal_commas_without_semicolons_are_told(self, write):
        tabs = timed(0.01, "\t").replace(".", ",")
        assert read_motion(write(tabs), unit="g").dt == 0.01
        motion = read_motion(write(column("{:.5f}").replace(".", ",")), unit="g", dt=0.01)
        np.testing.assert_allclose(motion.acceleration, WAVE * GRAVITY, atol=1e-4)

    def test_a_table_that_numbers_its_rows_is_read_by_its_titles(self, write):
        rows = "".join(f"{i},{i * 0.01:.2f},{v:.6f}\n" for i, v in enumerate(WAVE))
        motion = read_motion(write(",Time (s),Acc (g)\n" + rows))
        np.testing.assert_allclose(motion.acceleration, WAVE * GRAVITY, atol=1e-5)
        assert motion.dt == 0.01

    def test_foreign_formats_say_how_to_convert(self, write):
        for start in ("WID2 2009/04/06", "BEGIN GSE2.0\nMSG_TYPE DATA"):
            with pytest.raises(InputError, match=r"GSE file.*convert it.*MSEED"):
                read_record(write(f"{start}\n{column()}", "a.gse"))

    def test_seismic_handler_is_read_by_obspy(self, write):
        path = write("", "a.ASC")
        Stream([Trace(WAVE, {"delta": 0.05, "station": "TEST"})]).write(str(path), format="SH_ASC")
        assert path.read_text().startswith("DELTA:")
        record = read_record(path)
        assert (record.format, record.channels[0].dt, record.channels[0].npts) == (
            "SH_ASC",
            0.05,
            N,
        )

    def test_what_is_not_known_says_what_was_seen(self, write):
        with pytest.raises(InputError, match="begins with 'just some words'"):
            read_record(write("just some words\nand more\n"))

    def test_exactly_one_format_claims_each_layout(self, write):
        for text in (column(), timed(), in_rows(5), f"{N} 0.01\n{in_rows(8)}"):
            assert len([f for f in FORMATS if f.is_format(str(write(text)))]) == 1


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
