"""A catalogue finds which components are of one record, and says what it is not sure of."""

import zipfile

import numpy as np
import pytest

from rockfrag.cli import main
from rockfrag.errors import InputError
from rockfrag.records.catalogue import load_motions, read_catalogue
from rockfrag.records.make_catalogue import make_catalogue
from rockfrag.records.peer_search import read_search_results

from .built_records import peer_download, wave


def write(path, seed, dt=0.01):
    rows = [f"{i * dt:.3f} {value}" for i, value in enumerate(wave(seed, 0.3, 5))]
    path.write_text("\n".join(rows) + "\n")


def partners(draft):
    """Return the second component of each file, without folders."""
    return {
        file.rpartition("/")[2]: second.rpartition("/")[2]
        for file, second in zip(draft.table["file"], draft.table["second"], strict=True)
    }


def test_names_that_differ_in_the_component_are_of_one_record(tmp_path):
    names = ["A-CLS000", "A-CLS090", "120111", "120112", "ISE-WE", "ISE-NS", "b_E", "b_N", "lone7"]
    for seed, name in enumerate(names):
        write(tmp_path / f"{name}.txt", seed)
    draft = make_catalogue([tmp_path], unit="g", folder=tmp_path)
    assert partners(draft) == {
        "A-CLS000.txt": "A-CLS090.txt",
        "A-CLS090.txt": "A-CLS000.txt",
        "120111.txt": "120112.txt",
        "120112.txt": "120111.txt",
        "ISE-WE.txt": "ISE-NS.txt",
        "ISE-NS.txt": "ISE-WE.txt",
        "b_E.txt": "b_N.txt",
        "b_N.txt": "b_E.txt",
        "lone7.txt": "",
    }
    assert any("lone7.txt: its other horizontal component" in line for line in draft.warnings)


def test_components_that_are_not_perpendicular_or_not_alike_are_no_pair(tmp_path):
    write(tmp_path / "A-CLS000.txt", 1)
    write(tmp_path / "A-CLS045.txt", 2)
    write(tmp_path / "B-XYZ000.txt", 3)
    write(tmp_path / "B-XYZ090.txt", 4, dt=0.02)
    assert set(partners(make_catalogue([tmp_path], unit="g", folder=tmp_path)).values()) == {""}


def test_components_of_one_file_have_its_vertical(tmp_path, builders):
    path = builders["geonet_v1a"](tmp_path).path
    draft = make_catalogue([path], folder=tmp_path)
    assert draft.table["file"].tolist() == ["hses.V1A#N10E", "hses.V1A#N80W"]
    assert draft.table["second"].tolist() == ["hses.V1A#N80W", "hses.V1A#N10E"]
    assert set(draft.table["vertical"]) == {"hses.V1A#Up"}
    assert draft.table["date"].tolist() == ["2016-11-13"] * 2
    assert draft.table["magnitude"].tolist() == [7.82, 7.82]


@pytest.mark.parametrize("packed", [False, True])
def test_a_download_of_peer_is_read_unpacked_or_packed(tmp_path, packed):
    folder = peer_download(tmp_path / "download", 5)
    path = folder
    if packed:
        path = tmp_path / "download.zip"
        with zipfile.ZipFile(path, "w") as archive:
            for file in folder.iterdir():
                archive.write(file, f"PEER/{file.name}")
    catalogue = tmp_path / "motions.csv"
    assert main(["catalogue", str(path), "--output", str(catalogue)]) == 0
    table = read_catalogue(catalogue)
    assert len(table) == 10
    assert table["magnitude"].tolist() == [6.93] * 10
    motions = load_motions(catalogue)
    np.testing.assert_allclose(motions[3].acceleration, 1.1 * wave(101, 0.3, 5) * 9.81, atol=1e-6)
    assert motions[3].metadata["station"] == "Station 1"


def test_a_listed_file_that_is_missing_is_said(tmp_path):
    folder = peer_download(tmp_path / "download", 2)
    (folder / "RSN701_LOMAP_S01090.AT2").unlink()
    draft = make_catalogue([folder], folder=tmp_path)
    assert len(draft.table) == 3
    assert any("RSN701: RSN701_LOMAP_S01090.AT2 is listed but" in w for w in draft.warnings)


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


def test_unreadable_files_copies_and_unstated_units_are_said(tmp_path, builders, capsys):
    built = builders["at2_peer"](tmp_path)
    (tmp_path / "copy.AT2").write_bytes(built.path.read_bytes())
    (tmp_path / "cut.AT2").write_bytes(built.path.read_bytes()[:-30])
    write(tmp_path / "plain.txt", 1)
    assert main(["catalogue", str(tmp_path)]) == 1
    told = capsys.readouterr()
    assert told.out.splitlines()[0].startswith("name,event")
    assert "peer.AT2: the same record as" in told.err
    assert "cut.AT2, line 5: the header promises 43 samples" in told.err
    assert "plain.txt: the file does not state its unit" in told.err
    with pytest.raises(InputError, match="no horizontal component"):
        make_catalogue([tmp_path / "plain.txt"])
