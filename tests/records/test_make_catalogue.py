"""A catalogue finds which components are of one record, and says what it is not sure of."""

import os
import re

import numpy as np
import pytest

from rockfrag.base.errors import InputError
from rockfrag.cli.main import main
from rockfrag.motions.catalogued import read_motions
from rockfrag.records.catalogue import read_catalogue, repeated_motions
from rockfrag.records.make_catalogue import make_catalogue, read_search_results
from rockfrag.records.parsing.directions import azimuth_of, is_vertical

from .built_records import build, pack, peer_download
from .fields import wave


def write(path, seed, dt=0.01):
    rows = [f"{i * dt:.3f} {value}" for i, value in enumerate(wave(seed))]
    path.write_text("\n".join(rows) + "\n")


def partners(draft):
    """Return the second component of each file, without folders."""
    return {
        file.rpartition("/")[2]: second.rpartition("/")[2]
        for file, second in zip(draft.table["file"], draft.table["second"], strict=True)
    }


PAIRS = {
    **{
        ("A-CLS000", "A-CLS090"): "",
        ("120111", "120112"): "",
        ("ISE-WE", "ISE-NS"): "",
    },
    **{
        ("b_E", "b_N"): "",
        ("H-E10050", "H-E10320"): "H-E10-UP",
        ("C08050", "C08320"): "C08-UP",
    },
    **{("H-E04140", "H-E04230"): "H-E04-UP", ("CLW-LN", "CLW-TR"): "CLW-UP"},
}
"""Names of two horizontal components, and of their vertical one."""


@pytest.mark.parametrize("name", ["STA_{0}_{1}.txt", "STA_{0}.{1}"])
def test_of_one_record_in_three_quantities_one_is_taken(tmp_path, name):
    for seed, letter in enumerate("avd"):
        write(tmp_path / name.format("NS", letter), 2 * seed)
        write(tmp_path / name.format("EW", letter), 2 * seed + 1)
    draft = make_catalogue([tmp_path], unit="g", folder=tmp_path)
    assert len(draft.table) == 2
    assert sorted({why.split()[0] for _, why in draft.left_out}) == [
        "displacement",
        "velocity",
    ]


@pytest.mark.parametrize("prefix", ["", "RSN173_IMPVALL.H_"])
def test_names_that_differ_in_the_component_are_of_one_record(tmp_path, prefix):
    names = [
        name for pair, vertical in PAIRS.items() for name in (*pair, vertical) if name
    ]
    for seed, name in enumerate([*names, "lone7"]):
        write(tmp_path / f"{prefix}{name}.txt", seed)
    draft = make_catalogue([tmp_path], unit="g", folder=tmp_path)
    table = draft.table.set_index("file")
    for pair, vertical in PAIRS.items():
        first, other, upright = (
            f"{prefix}{name}.txt" if name else "" for name in (*pair, vertical)
        )
        assert table["second"][[first, other]].tolist() == [other, first]
        assert set(table["vertical"][[first, other]]) == {upright}
    assert table.loc[f"{prefix}lone7.txt", "second"] == ""
    assert any(
        "lone7.txt: its other horizontal component" in line for line in draft.warnings
    )


def test_components_that_are_not_perpendicular_or_not_alike_are_no_pair(tmp_path):
    write(tmp_path / "A-CLS000.txt", 1)
    write(tmp_path / "A-CLS045.txt", 2)
    write(tmp_path / "B-XYZ000.txt", 3)
    write(tmp_path / "B-XYZ090.txt", 4, dt=0.02)
    assert set(
        partners(make_catalogue([tmp_path], unit="g", folder=tmp_path)).values()
    ) == {""}


def test_components_of_one_file_have_its_vertical(tmp_path):
    build("geonet_v1a", tmp_path)
    build("unam_senses", tmp_path)
    table = make_catalogue([tmp_path], folder=tmp_path).table
    unam, geonet = "RAC_04042010222544.dat", "hses.V1A"
    pairs = [(f"{unam}#N90E", f"{unam}#N00E"), (f"{geonet}#N10E", f"{geonet}#N80W")]
    assert table["file"].tolist() == [file for pair in pairs for file in pair]
    assert table["second"].tolist() == [file for pair in pairs for file in pair[::-1]]
    assert table["vertical"].tolist() == [f"{unam}#V"] * 2 + [f"{geonet}#Up"] * 2
    assert table["component"].tolist() == ["N90E", "N00E", "N10E", "N80W"]
    assert table["date"].tolist() == ["2004-01-02"] * 2 + ["2016-11-13"] * 2
    assert table["magnitude"].tolist() == [5.8, 5.8, 7.82, 7.82]
    assert is_vertical("V;+")
    assert azimuth_of("N90E;") == 90


def test_a_packed_download_of_peer_is_read(tmp_path):
    folder = peer_download(tmp_path / "download", 5)
    members = {f"PEER/{file.name}": file.read_bytes() for file in folder.iterdir()}
    path = pack(tmp_path / "download.zip", members)
    catalogue = tmp_path / "motions.csv"
    assert main(["catalogue", str(path), "--output", str(catalogue)]) == 0
    table = read_catalogue(catalogue)
    assert len(table) == 10
    assert table["magnitude"].tolist() == [6.93] * 10
    first = table.iloc[2]
    assert first["name"] == "RSN701_LOMAP_S01000"
    assert first["second"].endswith("PEER/RSN701_LOMAP_S01090.AT2")
    assert first["vertical"].endswith("PEER/RSN701_LOMAP_S01-UP.AT2")
    assert (first["earthquake"], first["distance_km"]) == ("Loma Prieta 1989", 5.0)
    assert (table["vertical"] == "").sum() == 4
    motions = read_motions(catalogue)
    np.testing.assert_allclose(
        motions[3].acceleration, 1.1 * wave(101) * 9.81, atol=1e-6
    )
    assert motions[3].metadata["station"] == "Station 1"


def test_a_listed_file_that_is_missing_is_said(tmp_path):
    folder = peer_download(tmp_path / "download", 2)
    (folder / "RSN701_LOMAP_S01090.AT2").unlink()
    draft = make_catalogue([folder], folder=tmp_path)
    assert len(draft.table) == 3
    assert any(
        "RSN701: RSN701_LOMAP_S01090.AT2 is listed but" in w for w in draft.warnings
    )


def test_a_search_file_cut_short_or_without_its_section_is_refused(tmp_path):
    folder = peer_download(tmp_path / "download", 2)
    path = folder / "_SearchResults.csv"
    text = path.read_text()
    path.write_text(text[: text.index("1, SRSS")])
    with pytest.raises(InputError, match="has no row; the file is cut short"):
        read_search_results(path)
    path.write_text("nothing")
    with pytest.raises(InputError, match="no section"):
        read_search_results(path)


def test_unreadable_files_copies_and_unstated_units_are_said(tmp_path, capsys):
    built = build("at2_peer", tmp_path)
    (tmp_path / "copy.AT2").write_bytes(built.path.read_bytes())
    (tmp_path / "cut.AT2").write_bytes(built.path.read_bytes()[:-30])
    write(tmp_path / "plain.txt", 1)
    assert main(["catalogue", str(tmp_path)]) == 1
    told = capsys.readouterr()
    assert told.out.splitlines()[0].startswith("name,earthquake")
    assert "peer.AT2: the same record as" in told.err
    assert "cut.AT2, line 5: the header promises 43 samples" in told.err
    assert "plain.txt: the file does not state its unit" in told.err
    with pytest.raises(InputError, match="no horizontal component"):
        make_catalogue([tmp_path / "plain.txt"])


def test_a_record_beside_its_archives_is_there_once(tmp_path):
    """Whoever unpacks beside the archive does not count every record twice."""
    for seed, name in enumerate(("A-CLS000", "A-CLS090")):
        write(tmp_path / f"{name}.txt", seed)
    members = {file.name: file.read_bytes() for file in tmp_path.iterdir()}
    for packed in ("inner.zip", "other.zip"):
        pack(tmp_path / packed, members)
    draft = make_catalogue([tmp_path], unit="g", folder=tmp_path)
    assert partners(draft) == {
        "A-CLS000.txt": "A-CLS090.txt",
        "A-CLS090.txt": "A-CLS000.txt",
    }
    assert (
        "inner.zip#A-CLS000.txt: the same record as A-CLS000.txt; left out"
        in draft.warnings
    )
    (tmp_path / "A-CLS000.txt").unlink()
    draft = make_catalogue([tmp_path], unit="g", folder=tmp_path)
    # a pair is worth more than one of its components by itself
    assert draft.table["file"].tolist() == [
        "inner.zip#A-CLS000.txt",
        "inner.zip#A-CLS090.txt",
    ]


def test_one_day_with_two_names_of_an_earthquake_is_said(tmp_path):
    text = build("at2_peer", tmp_path).path.read_text()
    (tmp_path / "other.AT2").write_text(
        text.replace("LOMA PRIETA 10/18/89 00:05", "Loma Prieta, 10/18/1989").replace(
            ".1", ".2"
        )
    )
    draft = make_catalogue([tmp_path], folder=tmp_path)
    (line,) = [
        line for line in draft.warnings if "on the same day (1989-10-18)" in line
    ]
    assert "'Loma Prieta, 10/18/1989'" in line
    assert "'LOMA PRIETA 10/18/89 00:05'" in line


def test_its_own_output_is_no_record(tmp_path, capsys):
    for seed, name in enumerate(("A-CLS000", "A-CLS090")):
        write(tmp_path / f"{name}.txt", seed)
    for _ in range(2):
        output = tmp_path / "cat.csv"
        asked = ["catalogue", str(tmp_path), "--unit", "g", "--output", str(output)]
        assert main(asked) == 0
        assert "cat.csv:" not in capsys.readouterr().err
    assert main(["info", str(tmp_path), "--unit", "g"]) == 0


def test_many_warnings_are_told_by_kind_with_one_example(tmp_path, capsys):
    for seed in range(40):
        write(tmp_path / f"lone{seed}x.txt", seed)
    assert main(["catalogue", str(tmp_path), "--unit", "g"]) == 0
    told = capsys.readouterr().err.splitlines()
    assert len(told) < 10
    assert any(
        re.match(r"40 times: its other horizontal.*the first is .*lone0x\.txt", x)
        for x in told
    )


def test_messages_name_the_options_of_the_command_line(tmp_path, capsys):
    build("at2_peer", tmp_path)
    write(tmp_path / "a.txt", 1)
    (tmp_path / "b.txt").write_text("0.1\n0.2\n0.3\n0.1\n")
    main(["catalogue", str(tmp_path)])
    told = capsys.readouterr().err
    assert "give --unit (g, m/s2" in told
    assert "give it with --dt (in seconds)" in told
    assert main(["info", str(tmp_path / "a.txt")]) == 1
    assert "give --unit" in capsys.readouterr().err
    (tmp_path / "motions.csv").write_text("name,earthquake,file\nA,E,a.txt\n")
    with pytest.raises(InputError, match=r"give the column unit \(g, m/s2"):
        read_motions(tmp_path / "motions.csv")


def test_names_that_no_table_shows_are_replaced_or_refused(tmp_path, capsys):
    """A stranger's archive does not write to the terminal, nor line feeds into a catalogue."""
    write(tmp_path / "a.txt", 1)
    pack(
        tmp_path / "h.zip", {"\x1b[31mred\nline.txt": (tmp_path / "a.txt").read_bytes()}
    )
    (tmp_path / "a.txt").unlink()
    output = tmp_path / "cat.csv"
    assert main(["info", str(tmp_path / "h.zip"), "--unit", "g"]) == 0
    assert (
        main(["catalogue", str(tmp_path), "--unit", "g", "--output", str(output)]) == 0
    )
    told = capsys.readouterr()
    assert "\x1b" not in told.out + told.err + output.read_text(encoding="utf-8")
    assert len(read_catalogue(output)) == 1
    assert read_motions(output)[0].acceleration.size == 43
    strange = os.fsencode(tmp_path) + b"/r\xff.txt"
    with open(strange, "wb") as file:
        file.write(b"0 0.1\n0.01 0.2\n0.02 0.1\n0.03 0\n")
    assert main(["info", os.fsdecode(strange), "--unit", "g"]) == 0
    assert main(["info", str(tmp_path), "--unit", "g"]) == 0
    assert main(["catalogue", str(tmp_path), "--unit", "g"]) == 1
    assert "rename the file" in capsys.readouterr().err


def test_rows_of_a_catalogue_are_numbered_as_lines_and_repeats_are_named(tmp_path):
    write(tmp_path / "a.txt", 1)
    path = tmp_path / "motions.csv"
    path.write_text(
        "name,earthquake,file,unit\n\nA,E,a.txt,g\n\nB,E,none.txt,g\nC,E,a.txt,g\n"
    )
    with pytest.raises(InputError, match=r"line 5: .*none\.txt"):
        read_motions(path)
    assert repeated_motions(read_catalogue(path)) == [
        "motion C is the same as A: a.txt"
    ]
