"""Units, channels, times and zero levels are known, asked for or refused, never guessed."""

import gzip
import json

import numpy as np
import obspy
import pytest
from obspy import Stream, Trace, UTCDateTime
from obspy.core.inventory.response import PolesZerosResponseStage

from rockfrag.base.errors import InputError
from rockfrag.base.units import GRAVITY
from rockfrag.cli.main import main
from rockfrag.records.files_beside import with_files_beside
from rockfrag.records.motion import Motion, write_motion_set
from rockfrag.records.parsing.quantities import canonical_unit
from rockfrag.records.quality_flags import quality_flags
from rockfrag.records.read import read_motion
from rockfrag.records.write import motions_of_study, write_motion, write_motions

from .built_records import CMB, build, inventory_of_cmb


def two_columns(path, times, values):
    np.savetxt(
        path, np.column_stack([times, values]), fmt=["%.10g", "%.17g"], delimiter="\t"
    )
    return path


def test_an_unstated_unit_is_asked_for_with_the_peak_of_each_candidate(tmp_path):
    """Two columns without any header, peak 2.5 about a zero mean."""
    values = [0.0, 2.5, -2.5, 1.0, -1.0, 0.0]
    bare = two_columns(tmp_path / "bare.txt", np.arange(6) * 0.01, values)
    with pytest.raises(InputError) as caught:
        read_motion(bare)
    peaks = {"g": 24.525, "m/s2": 2.5, "cm/s2": 0.025, "gal": 0.025, "mm/s2": 0.0025}
    for unit, peak in peaks.items():
        assert f"{peak / GRAVITY:.3g} g if {unit}" in str(caught.value)
        motion = read_motion(bare, unit=unit)
        assert motion.pga == pytest.approx(peak, rel=1e-15)
        assert motion.provenance[0]["unit_stated"] is False


@pytest.mark.parametrize(
    ("kind", "wish", "words"),
    [
        ("plain_two_columns", {"unit": "furlong"}, "furlong"),
        ("at2_peer", {"unit": "gal"}, "states its unit as g, not gal"),
        ("at2_peer", {"dt": 0.01}, r"states dt = 0\.005 s"),
        ("smc", {"channel": "UP"}, "no channel answers to 'UP'"),
        ("geonet_v1a", {"channel": "E"}, "no channel answers to 'E'"),
        ("geonet_v1a", {}, "1: N10E; 2: N80W; 3: Up"),
    ],
)
def test_a_wish_that_contradicts_the_file_is_refused(tmp_path, kind, wish, words):
    with pytest.raises(InputError, match=words):
        read_motion(build(kind, tmp_path).path, **wish)


def test_spellings_of_one_unit():
    known = (
        "CM/SEC/SEC",
        "cm/s^2",
        "cm/sec2",
        "cm/s/s",
        "gal",
        "Gals",
        "cm/s**2",
        "(cm/s2)",
    )
    assert set(map(canonical_unit, known)) == {"cm/s2"}


def test_several_channels_are_listed_and_chosen_by_name_orientation_or_number(tmp_path):
    built = build("geonet_v1a", tmp_path)
    for wanted, number in (
        ("N10E", 0),
        ("010", 0),
        ("10 deg", 0),
        ("280", 1),
        ("up", 2),
        ("2", 1),
    ):
        motion = read_motion(built.path, channel=wanted)
        np.testing.assert_allclose(
            motion.acceleration, built.samples[number] / 1000, atol=1e-9
        )
        assert motion.metadata["component"] == built.components[number]


def test_a_time_column_that_does_not_step_evenly_is_refused_with_its_line(tmp_path):
    times = np.arange(40) * 0.01
    moved = times + 0.004 * (np.arange(40) == 17)
    for wrong, line in ((moved, 18), (np.delete(times, 20), 21)):
        with pytest.raises(
            InputError, match=f"line {line}: times are not equally spaced"
        ):
            read_motion(
                two_columns(tmp_path / "jump.txt", wrong, np.sin(wrong)), unit="g"
            )


def test_a_step_that_looks_rounded_is_reported_and_can_be_replaced(tmp_path):
    """0.0025 s printed to milliseconds and added up gives steps of 0.003 s, 333.33 a second."""
    times = np.arange(40) * 0.003
    path = two_columns(tmp_path / "rounded.txt", times, np.sin(times))
    with pytest.raises(InputError, match=r"steps by 0\.003 s.*333\.33.*dt="):
        read_motion(path, unit="g")
    motion = read_motion(path, unit="g", dt=0.0025)
    assert motion.dt == 0.0025
    assert motion.provenance[1]["step"] == "replace time column"
    assert read_motion(path, unit="g", dt=0.003).dt == 0.003


INTERVALS = (0.02, 0.01, 0.005, 0.004, 0.0025, 0.00244, 1 / 256, 1 / 300, 0.001)


@pytest.mark.parametrize(
    ("dt", "form"), [*((dt, ".6f") for dt in INTERVALS), (0.00125, ".6g")]
)
def test_rounded_print_of_times_gives_the_exact_interval(tmp_path, dt, form):
    times = np.arange(20_000 if form == ".6g" else 4000) * dt
    path = tmp_path / "t.txt"
    path.write_text("".join(f"{t:{form}} {np.sin(t):.6f}\n" for t in times))
    assert read_motion(path, unit="g").dt == pytest.approx(dt, rel=2e-6)


def sac(path, values, **header):
    trace = Trace(
        np.asarray(values, dtype=np.float32), {"delta": 0.01, "station": "ABC"}
    )
    trace.stats.channel = "HNE"
    trace.stats.starttime = UTCDateTime(2019, 7, 6)
    trace.stats.sac = header
    trace.write(str(path), format="SAC")
    return path


def test_the_zero_level_of_a_raw_recorder_is_removed_and_noted(tmp_path):
    values = 0.02 + 0.01 * np.sin(np.arange(400) * 0.1)
    path = sac(tmp_path / "raw.sac", values)
    with pytest.raises(InputError, match="does not state its unit"):
        read_motion(path)
    motion = read_motion(path, unit="g")
    assert motion.acceleration.mean() == pytest.approx(0, abs=1e-12)
    step = motion.provenance[-1]
    assert step["step"] == "remove zero level"
    assert step["offset_m_s2"] == pytest.approx(
        np.float32(values).mean() * 9.81, rel=1e-6
    )


def test_gravity_in_a_plain_file_is_removed_and_noted_but_a_small_mean_is_kept(
    tmp_path,
):
    wave = 0.1 * np.sin(np.arange(400) * 0.1)
    times = np.arange(400) * 0.01
    vertical = read_motion(
        two_columns(tmp_path / "z.txt", times, 1.003 + wave), unit="g"
    )
    assert vertical.provenance[-1]["offset_m_s2"] == pytest.approx(
        9.81 * (1.003 + wave.mean())
    )
    kept = read_motion(two_columns(tmp_path / "x.txt", times, 0.2 + wave), unit="g")
    np.testing.assert_allclose(kept.acceleration, 9.81 * (0.2 + wave), rtol=1e-14)
    assert len(kept.provenance) == 1


@pytest.mark.parametrize(("idep", "held"), [(6, "displacement"), (7, "velocity")])
def test_a_sac_file_of_another_quantity_is_refused(tmp_path, idep, held):
    with pytest.raises(InputError, match=f"{held}, not acceleration"):
        read_motion(sac(tmp_path / "v.sac", np.ones(9), idep=idep), unit="g")


def test_miniseed_without_a_response_asks_for_the_unit(tmp_path):
    path = tmp_path / "counts.mseed"
    trace = Trace(
        np.arange(100, dtype=np.int32) % 7, {"station": "CMB", "channel": "HNE"}
    )
    Stream([trace]).write(str(path), format="MSEED")
    with pytest.raises(InputError, match="does not state its unit"):
        read_motion(path)
    (tmp_path / "other.xml").write_text("<not-a-station/>")
    assert read_motion(path, unit="mm/s2").metadata["unit"] == "mm/s2"


def test_miniseed_with_stationxml_is_acceleration(tmp_path):
    """A flat response of S counts per m/s² is a division by S."""
    sensitivity = 4.0e5
    counts = np.round(2e5 * np.sin(np.arange(2000) * 0.05)).astype(np.int32) + 12345
    Stream([Trace(counts, {**CMB, "channel": "HNE"})]).write(
        str(tmp_path / "a.mseed"), "MSEED"
    )
    stage = PolesZerosResponseStage(
        1, sensitivity, 1.0, "M/S**2", "COUNTS", "LAPLACE (RADIANS/SECOND)", 1.0, [], []
    )
    inventory = inventory_of_cmb(sensitivity, stage)
    inventory.write(str(tmp_path / "CMB.xml"), format="STATIONXML")
    motion = read_motion(tmp_path / "a.mseed")
    expected = counts / sensitivity
    np.testing.assert_allclose(
        motion.acceleration, expected - expected.mean(), atol=1e-9
    )
    assert motion.metadata["unit"] == "m/s2"
    assert motion.provenance[1]["step"] == "remove response"


def test_what_a_record_is_read_with_is_known_beforehand(tmp_path):
    """So that a study is computed again where it changes."""
    counts = np.arange(100, dtype=np.int32) % 7
    header = {**CMB, "channel": "HNE"}
    Stream([Trace(counts, header)]).write(str(tmp_path / "a.mseed"), "MSEED")
    stations = tmp_path / "CMB.xml"
    inventory_of_cmb(100.0).write(str(stations), format="STATIONXML")
    packed = tmp_path / "b.mseed.gz"
    packed.write_bytes(gzip.compress((tmp_path / "a.mseed").read_bytes()))
    script, values = tmp_path / "old.tcl", tmp_path / "its values.txt"
    values.write_text("0.1 -0.2\n0.3\n")
    script.write_text('set a "Series -dt 0.02 -filePath {its values.txt} -factor 2"\n')
    counted = [tmp_path / "a.mseed", packed]
    assert {read_motion(path).metadata["unit"] for path in counted} == {"m/s2"}
    assert read_motion(script, unit="g").acceleration.size == 3
    assert set(with_files_beside(counted)) == {*counted, stations}
    assert with_files_beside([script]) == [script, values]
    # text takes no StationXML, and what is not there has nothing beside it
    text = two_columns(tmp_path / "text.txt", [0, 0.01, 0.02], [0.0, 1.0, 0.0])
    absent = tmp_path / "absent.mseed"
    assert with_files_beside([text, absent, text]) == [text, absent]


def test_a_file_name_with_wildcards_is_a_name(tmp_path):
    path = sac(tmp_path / "a[1]*.sac", [1.0, 2.0, 3.0])
    assert read_motion(path, unit="g").acceleration.size == 3


@pytest.mark.parametrize("file", ["out.AT2", "out.txt"])
@pytest.mark.parametrize("dt", [0.005, 0.01, 1 / 256, 0.00244, 0.0024])
def test_what_was_written_reads_back_the_same_to_the_last_bit(tmp_path, file, dt):
    rng = np.random.default_rng(3)
    values = rng.normal(size=1001) * 10.0 ** rng.integers(-12, 3, size=1001)
    values[:4] = [0.0, -0.0, 5e-324, 1.7e308]
    header = {
        "delta": dt,
        "rockfrag": {"unit": "g", "earthquake": "E", "component": "090"},
    }
    stream = Stream([Trace(values, {**header, "station": "GILROY"})])
    path = tmp_path / file
    stream.write(str(path), format="AT2" if file.endswith("AT2") else "PLAINTEXT")
    back = obspy.read(path)[0]
    np.testing.assert_array_equal(back.data, values)
    assert back.stats.delta == pytest.approx(dt, rel=1e-11)
    assert back.stats.rockfrag.unit == "g"
    if file.endswith("AT2"):
        assert (back.stats.station, back.stats.rockfrag.component) == ("GILROY", "090")


@pytest.mark.parametrize("name", ["AT2", "PLAINTEXT"])
def test_several_traces_or_samples_that_are_not_finite_are_refused(tmp_path, name):
    path = tmp_path / "out"
    good = Trace(np.ones(3))
    for stream in (Stream([good, good]), Stream([Trace(np.array([1.0, np.nan]))])):
        with pytest.raises(InputError):
            stream.write(str(path), format=name)
        assert not path.exists()


@pytest.fixture
def motion():
    """A floor motion with a mean, which a raw recording would lose."""
    samples = 0.3 + np.random.default_rng(3).normal(size=1001)
    facts = {
        "earthquake": "Friuli 1976",
        "station": "TMZ",
        "component": "000",
        "floor": "attic",
    }
    return Motion(samples, 0.005, "Friuli attic", facts)


@pytest.mark.parametrize("unit", [None, "g", "cm/s2", "mm/s2"])
@pytest.mark.parametrize("ending", [".AT2", ".csv", ".dat", ".tcl", ".mseed"])
def test_a_motion_reads_back_without_a_question(tmp_path, motion, ending, unit):
    unit = None if ending == ".mseed" else unit
    back = read_motion(write_motion(motion, tmp_path / f"m{ending}", unit=unit))
    assert unit in (None, back.metadata["unit"])
    np.testing.assert_allclose(back.acceleration, motion.acceleration, rtol=1e-14)
    assert back.dt == pytest.approx(motion.dt, rel=1e-12)
    if ending in (".AT2", ".dat"):
        facts = {
            key: back.metadata[key] for key in ("earthquake", "station", "component")
        }
        assert facts == {
            "earthquake": "Friuli 1976",
            "station": "TMZ",
            "component": "000",
        }


def test_what_cannot_be_written_is_told(tmp_path, motion):
    with pytest.raises(InputError, match=r"'\.xyz' names no format"):
        write_motion(motion, tmp_path / "m.xyz")
    with pytest.raises(InputError, match="'PDF' is no format"):
        write_motion(motion, tmp_path / "m.csv", "PDF")
    with pytest.raises(InputError, match="MiniSEED is written in m/s2"):
        write_motion(motion, tmp_path / "m.mseed", unit="g")
    (tmp_path / "file").write_text("")
    with pytest.raises(InputError, match="cannot be written"):
        write_motion(motion, tmp_path / "file" / "m.csv")


def test_motions_of_a_study_are_written_by_their_names(tmp_path, motion):
    other = Motion(motion.acceleration[:50], 0.01, "Kobe/ground")
    write_motion_set([motion, other], tmp_path / "floors.parquet")
    found = motions_of_study(tmp_path / "floors.parquet")
    paths = write_motions(found, tmp_path / "out", "AT2")
    assert [path.name for path in paths] == ["Friuli-attic.AT2", "Kobe-ground.AT2"]
    with pytest.raises(InputError, match="out: 'PDF' is no format"):
        write_motions(found, tmp_path / "out", "PDF")
    same = [motion, Motion(motion.acceleration, 0.01, motion.name)]
    with pytest.raises(InputError, match="would have one file"):
        write_motions(same, tmp_path / "out", "AT2")
    with pytest.raises(InputError, match="no motions of a study"):
        motions_of_study(tmp_path / "absent.parquet")


def test_records_and_studies_are_written_from_the_command_line(
    tmp_path, motion, capsys
):
    record = write_motion(motion, tmp_path / "m.csv")
    assert main(["write", str(record), str(tmp_path / "m.tcl")]) == 0
    np.testing.assert_allclose(
        read_motion(tmp_path / "m.tcl").acceleration, motion.acceleration
    )
    write_motion_set([motion], tmp_path / "floors.parquet")
    assert (
        main(
            [
                "write",
                str(tmp_path / "floors.parquet"),
                str(tmp_path),
                "--format",
                "mseed",
            ]
        )
        == 0
    )
    assert "Friuli-attic.mseed" in capsys.readouterr().out


def quake(dt=0.01, peak=3.0):
    """A burst that begins and ends quietly, its velocity back at zero."""
    t = np.arange(0, 20, dt)
    wave = np.exp(-(((t - 8) / 2.5) ** 2)) * np.sin(2 * np.pi * 1.3 * (t - 8))
    wave += 0.3 * np.exp(-(((t - 7) / 2) ** 2)) * np.sin(2 * np.pi * 4.1 * (t - 7))
    return wave * peak / np.abs(wave).max()


def said(acceleration, dt=0.01):
    return "; ".join(quality_flags(Motion(acceleration, dt)))


def test_a_record_in_order_is_not_doubted():
    assert said(quake()) == ""


@pytest.mark.parametrize(
    ("samples", "dt", "words"),
    [
        (981 * quake(), 0.01, "above 3 g"),
        (quake() + 0.3, 0.01, "a drift"),
        (np.clip(quake(), -1.5, 1.5), 0.01, "clipped"),
        (quake()[700:], 0.01, "triggered late"),
        (quake(peak=1.0) + 5 * (np.arange(2000) == 300), 0.01, "a lone spike"),
        (np.repeat(quake(0.02), 2), 0.01, "repeats the one before"),
        (np.zeros(500), 0.01, "all samples are zero"),
        (quake(0.05), 0.05, "too long"),
    ],
)
def test_what_looks_wrong_is_said(samples, dt, words):
    assert words in said(samples, dt)


def test_info_says_quality_flags_status_and_values_as_json_and_csv(tmp_path, capsys):
    write_motion(Motion(quake(), 0.01, "fine"), tmp_path / "a.AT2")
    write_motion(Motion(40 * quake(), 0.01, "strong"), tmp_path / "b.AT2")
    assert main(["info", str(tmp_path), "--format", "json"]) == 0
    fine, strong = json.loads(capsys.readouterr().out)
    assert fine["quality_flags"] == ""
    assert "above 3 g" in strong["quality_flags"]
    assert fine["pga_g"] == pytest.approx(3 / 9.81)
    (tmp_path / "c.AT2").write_text("broken")
    assert main(["info", str(tmp_path), "--format", "csv"]) == 1
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) == 4
    assert lines[0].endswith("quality_flags,error,status")
    assert lines[3].endswith("unreadable")


def test_velocities_in_a_folder_are_no_bad_files_but_named_ones_are(tmp_path, capsys):
    built = build("at2_peer", tmp_path)
    text = (
        built.path.read_text()
        .replace("ACCELERATION", "VELOCITY")
        .replace("OF G", "OF CM/S")
    )
    (tmp_path / "peer.VT2").write_text(text)
    assert main(["info", str(tmp_path)]) == 0
    assert main(["info", str(tmp_path / "peer.VT2")]) == 1
    capsys.readouterr()


def test_a_picture_of_every_channel(tmp_path, capsys):
    built = build("geonet_v1a", tmp_path)
    assert (
        main(["info", str(built.path), "--pictures", str(tmp_path / "pictures")]) == 0
    )
    assert len(list((tmp_path / "pictures").glob("*.png"))) == 3
    capsys.readouterr()
