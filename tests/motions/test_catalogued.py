"""All motions of a folder or a catalogue, with both components of each record."""

import numpy as np
import pytest

from rockfrag import read_motions
from rockfrag.assess.motions import motion_set
from rockfrag.assess.place import Place
from rockfrag.assess.request import Records
from rockfrag.base.errors import InputError
from rockfrag.motions.catalogued import LeftOut, pairs_of


def wave(seed, scale=1.0):
    noise = np.random.default_rng(seed).normal(size=300)
    return scale * (np.sin(np.arange(300) * 0.1) + 0.1 * noise)


def record(folder, name, seed):
    rows = [f"{i * 0.01:.2f},{x:.6f}" for i, x in enumerate(wave(seed))]
    text = "\n".join(["Time (s),Acceleration (m/s^2)", *rows]) + "\n"
    (folder / f"{name}.csv").write_text(text)


@pytest.fixture
def folder(tmp_path):
    """Three records of two horizontal components, one of them with a vertical."""
    inside = tmp_path / "records"
    inside.mkdir()
    for number, station in enumerate(("AAA", "BBB", "CCC")):
        for k, axis in enumerate(("000", "090")):
            record(inside, f"{station}{axis}", 10 * number + k)
    record(inside, "AAA-UP", 99)
    return inside


def catalogue(folder, *rows, columns="name,earthquake,station,file,second"):
    path = folder / "motions.csv"
    path.write_text("\n".join([columns, *rows]) + "\n")
    return path


def test_a_folder_is_read_with_both_components_of_each_record(folder):
    with pytest.warns(LeftOut, match="its earthquake is not stated"):
        motions = read_motions(folder)
    assert len(motions) == 6
    np.testing.assert_allclose(motions[3].acceleration, wave(11), atol=1e-6)
    assert pairs_of(motions) == ((0, 1), (2, 3), (4, 5))
    assert motions[0].metadata["vertical"].endswith("AAA-UP.csv")


def test_what_is_no_record_is_named_and_what_cannot_be_read_refused(folder):
    (folder / "X.vel").write_text("0 1\n0.01 2\n0.02 1\n0.03 0\n")
    with pytest.warns(LeftOut, match=r"left out, its name says velocity.*X\.vel"):
        read_motions(folder, unit="g")
    (folder / "bad.AT2").write_text(
        "a\nACCELERATION IN UNITS OF G\nNPTS= 9, DT= .01\n1\n"
    )
    with pytest.raises(InputError, match=r"bad\.AT2.*promises 9 samples"):
        read_motions(folder, unit="g")


def test_a_second_component_that_has_no_row_is_a_motion(folder):
    """Rows that name their second component give what rows for both components give."""
    short = [f"{s},Event {s},{s},{s}000.csv,{s}090.csv" for s in ("AAA", "BBB", "CCC")]
    motions = read_motions(catalogue(folder, *short))
    assert len(motions) == 6
    assert [m.metadata["file"] for m in motions[:2]] == ["AAA000.csv", "AAA090.csv"]
    assert {m.metadata["station"] for m in motions[:2]} == {"AAA"}
    long = [
        row
        for s in ("AAA", "BBB", "CCC")
        for row in (
            f"{s}0,Event {s},{s},{s}000.csv,{s}090.csv",
            f"{s}9,Event {s},{s},{s}090.csv,{s}000.csv",
        )
    ]
    both = read_motions(catalogue(folder, *long))
    for one, other in zip(motions, both, strict=True):
        np.testing.assert_array_equal(one.acceleration, other.acceleration)
    assert pairs_of(motions) == pairs_of(both) == ((0, 1), (2, 3), (4, 5))


def test_an_assessment_shakes_with_the_second_components_of_a_catalogue(
    folder, tmp_path
):
    rows = [f"{s},Event {s},,{s}000.csv,{s}090.csv" for s in ("AAA", "BBB", "CCC")]
    path = catalogue(folder, *rows)
    found = motion_set(Records(paths=(path,)), Place(), tmp_path)
    assert len(found.ground) == 6
    assert found.pairs == ((0, 1), (2, 3), (4, 5))
    assert len(set(found.earthquakes)) == 3


def test_the_direction_and_factor_of_a_row_are_those_of_its_motion(folder):
    columns = "name,earthquake,file,second,direction,scale_factor"
    row = "A,Event,AAA000.csv,AAA090.csv,stronger,2"
    record(folder, "X000", 5)
    path = catalogue(folder, row, "B,Event,X000.csv,BBB090.csv,,3", columns=columns)
    turned, first, second = read_motions(path)
    np.testing.assert_allclose(first.acceleration, 3 * wave(5), atol=1e-5)
    np.testing.assert_allclose(second.acceleration, 3 * wave(11), atol=1e-5)
    strongest = 2 * np.hypot(wave(0), wave(1)).max()
    assert turned.pga == pytest.approx(strongest, rel=1e-3)


def test_a_catalogue_states_units_itself(folder):
    path = catalogue(folder, "A,E,S,AAA000.csv,")
    with pytest.raises(InputError, match="a catalogue states units"):
        read_motions(path, unit="g")
