"""Which files are components of one record, which is the vertical, and what is no component at all."""

import zlib

import numpy as np
import pytest
from obspy import Stream, Trace, UTCDateTime

from rockfrag.base.errors import InputError
from rockfrag.cli.main import main
from rockfrag.records.component_names import numbered_records, parts_of
from rockfrag.records.make_catalogue import make_catalogue
from rockfrag.records.parsing.text_file import NotAcceleration
from rockfrag.records.read import read_motion

from .built_records import build
from .fields import wave
from .record_texts import peer_file


def peer(
    folder, name, *, event="Tabas, Iran, 9/16/1978", station="Tabas", component=""
):
    """Write an AT2 file whose second line says event, station and component, if it says a component."""
    words = "ACCELERATION TIME SERIES IN UNITS OF G"
    samples = wave(zlib.crc32(f"{name}{event}".encode()) % 1000)
    line = f"{event}, {station}, {component}" if component else "no facts"
    (folder / f"{name}.AT2").write_text(peer_file(line, words, samples))


def columns(path, *series, dt=0.01, titles=""):
    rows = [
        " ".join([f"{i * dt:.3f}", *(f"{x:.5f}" for x in row)])
        for i, row in enumerate(zip(*series, strict=True))
    ]
    path.write_text("\n".join([titles, *rows][not titles :]) + "\n")


def found(folder, **given):
    """Return motions, those with a second component, and verticals of the catalogue of a folder."""
    table = make_catalogue([folder], folder=folder, **given).table
    return len(table), int((table["second"] != "").sum()), set(table["vertical"]) - {""}


@pytest.mark.parametrize(
    ("first", "second", "vertical"),
    [
        ("RSN143_TABAS_TAB-L1", "RSN143_TABAS_TAB-T1", "RSN143_TABAS_TAB-V1"),
        ("RSN6906_D_GDLCN55W", "RSN6906_D_GDLCS35W", "RSN6906_D_GDLCUP"),
        ("RSN8119_CCHURCH_PRPCW", "RSN8119_CCHURCH_PRPCS", "RSN8119_CCHURCH_PRPCUP"),
        (
            "RSN2114_DENALI_PS10-047",
            "RSN2114_DENALI_PS10-317",
            "RSN2114_DENALI_PS10-UP",
        ),
        ("SYL090-hor1", "SYL360-hor2", "SYL-UP"),
        ("ELC180-hor1", "ELC270-hor2", "ELCDWN-up"),
        ("ABC_NS_acc", "ABC_EW_acc", "ABC_UD_acc"),
        ("ABC_north", "ABC_east", "ABC_vertical"),
        ("ABC_H1", "ABC_H2", "ABC_V"),
        ("TCU045-E", "TCU045-N", "TCU045-V"),
        ("CHY074E", "CHY074N", "CHY074V"),
        ("ABBAR--L", "ABBAR--T", "ABBAR--V"),
        ("STA_HNE_20200101", "STA_HNN_20200101", "STA_HNZ_20200101"),
        ("rec_EW_acc_corrected", "rec_NS_acc_corrected", "rec_UD_acc_corrected"),
    ],
)
def test_names_tell_the_components_of_one_record(tmp_path, first, second, vertical):
    """The last of the pairs by their headers where there is one: W and S behind a name are no words."""
    components = {first: "W", second: "S", vertical: "UP"}
    for name in (first, second, vertical):
        stated = components[name] if "CCHURCH" in name else ""
        peer(tmp_path, name, component=stated)
    assert found(tmp_path) == (2, 2, {f"{vertical}.AT2"})


def test_headers_tell_them_before_names_do(tmp_path):
    """Event, station and azimuth of line 2 of an AT2 pair files of any name, and part those of other events."""
    for name, component in (("a", "90"), ("b", "360"), ("c", "UP")):
        peer(tmp_path, name, component=component)
    for name, component in (("x000", "000"), ("x090", "090")):
        event = f"Event of {component}, 1/1/2001"
        peer(tmp_path, name, event=event, component=component)
    table = make_catalogue([tmp_path], folder=tmp_path).table.set_index("name")
    assert table.loc["a", "second"] == "b.AT2"
    assert table.loc["a", "vertical"] == "c.AT2"


@pytest.mark.parametrize(
    ("names", "paired"),
    [
        (["r0", "r1", "r2"], 0),
        ([f"GM{i}" for i in range(1, 12)], 0),
        (["r01", "r02"], 0),
        (["120111", "120112"], 2),
        (["A1", "A2"], 2),
    ],
)
def test_records_that_are_numbered_are_no_pair(tmp_path, names, paired):
    for seed, name in enumerate(names):
        columns(tmp_path / f"{name}.txt", wave(seed))
    assert found(tmp_path, unit="g") == (len(names), paired, set())
    draft = make_catalogue([tmp_path], unit="g", folder=tmp_path)
    said = [w for w in draft.warnings if "by the numbers in their names alone" in w]
    assert len(said) == (1 if paired else 0)


def test_what_stands_behind_the_component_is_part_of_the_record():
    assert parts_of("X_NS_filtered") == ("X filtered", "NS")
    assert parts_of("X_NS_raw")[0] != parts_of("X_NS_filtered")[0]
    assert parts_of("lone7") == ("lone7", "")
    assert numbered_records(["r0", "r1", "B1", "B2"]) == {"r0", "r1"}


def test_velocity_and_displacement_beside_acceleration_are_left_out_and_named(tmp_path):
    for seed, axis in enumerate("ENZ"):
        for ending, scale in (
            (".acc", 1),
            (".vel", 30),
            (".disp", 20),
            ("_vel.txt", 9),
        ):
            columns(tmp_path / f"TTN033_{axis}{ending}", scale * wave(seed))
    draft = make_catalogue([tmp_path], unit="m/s2", folder=tmp_path)
    assert draft.table["file"].tolist() == ["TTN033_E.acc", "TTN033_N.acc"]
    assert set(draft.table["vertical"]) == {"TTN033_Z.acc"}
    named = " ".join(draft.summary())
    for axis in "ENZ":
        for ending in (".vel", ".disp", "_vel.txt"):
            assert f"TTN033_{axis}{ending}" in named
    with pytest.raises(NotAcceleration, match="its name says velocity"):
        read_motion(tmp_path / "TTN033_E.vel", unit="m/s2")


def test_the_length_of_a_vector_is_no_component(tmp_path):
    series = [wave(seed) for seed in (1, 2, 3)]
    length = np.sqrt(sum(x**2 for x in series))
    for title in ("Absolute_acc_(m/s2)", "acc_w_(m/s2)"):
        titles = f"time_(s) acc_x_(m/s2) acc_y_(m/s2) acc_z_(m/s2) {title}"
        columns(tmp_path / "phone.txt", *series, length, titles=titles)
        count, paired, upright = found(tmp_path)
        assert (count, paired, len(upright)) == (2, 2, 1)


def test_every_file_of_a_folder_is_in_the_catalogue_or_named(tmp_path, capsys):
    build("at2_peer", tmp_path)
    build("csmip_v2", tmp_path)
    spectra = "RESPONSE AND FOURIER AMPLITUDE SPECTRA, VOLUME III\n" + "1 2 3\n" * 20
    (tmp_path / "CE89146.V3").write_text(spectra)
    (tmp_path / "words.txt").write_text("no numbers at all\n")
    (tmp_path / "paper.pdf").write_bytes(b"%PDF-1.4")
    columns(tmp_path / "X.vel", wave(5))
    output = tmp_path / "cat.csv"
    for _ in range(2):
        asked = ["catalogue", str(tmp_path), "--unit", "g", "--output", str(output)]
        assert main(asked) == 1
        told = capsys.readouterr().err + output.read_text()
        for file in tmp_path.iterdir():
            assert file.name in told, file.name


def mseed(path, *parts, channel="HNE", dt=0.01, kind="f4"):
    """Write parts of one channel, each by its first sample and its samples."""
    header = {"network": "XX", "station": "AAA", "channel": channel, "delta": dt}
    start = UTCDateTime(2020, 1, 1)
    traces = [
        Trace(data.astype(kind), {**header, "starttime": start + first * dt})
        for first, data in parts
    ]
    Stream(traces).write(str(path), format="MSEED")
    return path


WAVE = np.sin(np.arange(500) * 0.1)


@pytest.mark.parametrize("lost", [1, 200])
def test_a_gap_is_said_and_no_second_channel(tmp_path, lost):
    parts = (0, WAVE), (500 + lost, WAVE)
    path = mseed(tmp_path / "gap.mseed", *parts)
    for channel in (None, "1", 1, "HNE"):
        with pytest.raises(
            InputError, match=rf"a gap: no samples .* {lost} are missing"
        ):
            read_motion(path, unit="m/s2", channel=channel)
    with pytest.raises(InputError, match="gap"):
        make_catalogue([path], "m/s2")


def test_other_channels_of_a_file_with_a_gap_are_read(tmp_path):
    gap = mseed(tmp_path / "a", (0, WAVE), (600, WAVE)).read_bytes()
    whole = mseed(tmp_path / "b", (0, WAVE), channel="HNN").read_bytes()
    path = tmp_path / "both.mseed"
    path.write_bytes(gap + whole)
    (tmp_path / "a").unlink(), (tmp_path / "b").unlink()
    assert read_motion(path, unit="m/s2", channel="HNN").acceleration.size == 500
    draft = make_catalogue([path], "m/s2", folder=tmp_path)
    assert draft.table["component"].tolist() == ["HNN"]
    assert any("gap" in error for error in draft.errors)


def test_parts_that_follow_each_other_are_one_series_and_others_a_fault(tmp_path):
    joined = mseed(tmp_path / "a.mseed", (0, WAVE), (500, WAVE))
    assert read_motion(joined, unit="m/s2").acceleration.size == 1000
    over = mseed(tmp_path / "b.mseed", (0, WAVE), (400, 2 * WAVE))
    with pytest.raises(InputError, match="overlap and differ"):
        read_motion(over, unit="m/s2")


def test_of_three_numbered_components_the_third_is_the_vertical_and_said(tmp_path):
    for number in "123":
        samples = WAVE * int(number)
        mseed(tmp_path / f"{number}.mseed", (0, samples), channel=f"HN{number}")
    draft = make_catalogue([tmp_path], "m/s2", folder=tmp_path)
    assert draft.table["component"].tolist() == ["HN1", "HN2"]
    assert set(draft.table["vertical"]) == {"3.mseed"}
    assert any("HN3 is taken for the vertical" in line for line in draft.warnings)


def test_of_titles_that_are_numbers_the_third_is_the_vertical_and_said(tmp_path):
    titles = "Time (s),1 (m/s2),2 (m/s2),3 (m/s2)\n"
    samples = [",".join(f"{k * value:.5f}" for k in (1, 2, 3)) for value in WAVE]
    rows = [f"{k * 0.01:.2f},{row}\n" for k, row in enumerate(samples)]
    (tmp_path / "logger.csv").write_text(titles + "".join(rows))
    draft = make_catalogue([tmp_path], folder=tmp_path)
    assert draft.table["component"].tolist() == ["1", "2"]
    assert set(draft.table["vertical"]) == {"logger.csv#3"}
    assert any("3 is taken for the vertical" in line for line in draft.warnings)


def test_a_channel_is_chosen_by_a_whole_number_too(tmp_path):
    path = build("geonet_v1a", tmp_path).path
    by_word, by_number = (read_motion(path, channel=two) for two in ("2", 2))
    np.testing.assert_array_equal(by_word.acceleration, by_number.acceleration)
    with pytest.raises(InputError, match="there is no channel 4"):
        read_motion(path, channel=4)


def test_a_message_of_one_of_several_channels_names_it(tmp_path):
    columns(tmp_path / "a.txt", wave(1), wave(2), titles="time NS EW")
    for channel in ("NS", "EW"):
        with pytest.raises(InputError, match=rf"channel {channel}: .*state its unit"):
            read_motion(tmp_path / "a.txt", channel=channel)


def test_the_last_row_may_be_filled_up_with_zeros(tmp_path):
    """The El Centro that stands at many places: 1559 points said, rows of eight, a zero at the end."""
    samples = wave(3)  # 43 of them
    filled = np.append(samples, np.zeros(5)).reshape(-1, 8)
    rows = "\n".join(" ".join(f"{x:9.5f}" for x in row) for row in filled)
    head = "# {} points at equal spacing of 0.02 sec\n# The units are (g)\n"
    path = tmp_path / "a.dat"
    path.write_text(head.format(43) + rows + "\n")
    motion = read_motion(path)
    assert (motion.acceleration.size, motion.dt) == (43, 0.02)
    for count in (42, 39):
        path.write_text(head.format(count) + rows + "\n")
        with pytest.raises(InputError, match=f"promises {count} samples"):
            read_motion(path)


def test_a_header_of_at2_may_state_its_size_twice_if_it_agrees(tmp_path):
    text = build("at2_peer", tmp_path).path.read_text()
    line = next(x for x in text.splitlines() if x.startswith("NPTS"))
    path = tmp_path / "b.AT2"
    path.write_text(text.replace(line, f"{line}\n{line}"))
    assert read_motion(path).acceleration.size == 43
    path.write_text(text.replace(line, f"{line}\n{line.replace('.00500', '.01000')}"))
    with pytest.raises(InputError, match="differ"):
        read_motion(path)


def test_fields_of_at2_that_touch_are_told_apart_by_their_signs(tmp_path):
    samples = -np.abs(wave(4)) - 0.01
    rows = ["".join(f"{x:.5f}" for x in samples[i : i + 6]) for i in range(0, 43, 6)]
    head = "a\nACCELERATION IN UNITS OF G\nNPTS= 43, DT= .01 SEC\n"
    (tmp_path / "a.AT2").write_text(head + "\n".join(rows) + "\n")
    np.testing.assert_allclose(
        read_motion(tmp_path / "a.AT2").acceleration, samples * 9.81, atol=1e-4
    )
