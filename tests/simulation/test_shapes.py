"""Bodies from meshes: mass properties as in closed form, edges where the points carry, bad meshes refused."""

from pathlib import Path

import numpy as np
import pytest
import trimesh

from rockfrag.base.errors import InputError
from rockfrag.system.blocks import Block
from rockfrag.system.mesh import Shape, read_shape

WIDTH, DEPTH, HEIGHT, MASS = 0.4, 0.6, 1.0, 300.0


def box_file(folder: Path, ending: str = ".ply") -> Path:
    """A uniform box somewhere in space."""
    mesh = trimesh.creation.box((WIDTH, DEPTH, HEIGHT))
    mesh.apply_translation([3.0, -2.0, 7.0])
    mesh.export(folder / f"box{ending}")
    return folder / f"box{ending}"


@pytest.fixture
def box(tmp_path: Path) -> Shape:
    return read_shape(box_file(tmp_path), mass=MASS)


@pytest.mark.parametrize("ending", [".obj", ".ply", ".stl"])
def test_a_box_has_the_mass_properties_of_the_closed_form(tmp_path: Path, ending: str):
    path = box_file(tmp_path, ending)
    shape = read_shape(path, mass=MASS)
    assert shape.volume == pytest.approx(WIDTH * DEPTH * HEIGHT, rel=1e-6)
    assert shape.cg_height == pytest.approx(HEIGHT / 2, rel=1e-6)
    # I = m (b² + h²) / 3 with half sides, for rotation in the plane of the width
    for direction, side in ((0, WIDTH), (90, DEPTH)):
        expected = MASS * (side**2 + HEIGHT**2) / 12
        assert shape.block(direction, 1e-6).inertia == pytest.approx(expected, rel=1e-6)
    assert read_shape(path, density=1250.0).mass == pytest.approx(MASS, rel=1e-6)


def test_edges_of_a_box_and_its_worst_direction(box: Shape):
    diagonal = np.degrees(np.arctan2(DEPTH, WIDTH))
    assert box.edges(diagonal, 0.001)[1] == pytest.approx(
        np.hypot(WIDTH, DEPTH) / 2, rel=1e-6
    )
    direction, angle = box.worst_direction(0.001)
    assert direction % 180 == 0
    assert angle == pytest.approx(np.arctan(WIDTH / HEIGHT), rel=1e-6)
    narrow = box.block(0, 0.001, retreat=0.05)
    assert (narrow.width, narrow.cg_offset) == pytest.approx(
        (WIDTH - 0.1, 0.0), abs=1e-6
    )
    with pytest.raises(InputError, match="cannot stand"):
        box.block(0, 0.001, retreat=0.3)
    # another scan moves points by its tolerance, up and down
    moved = box.scanned_again(0.001, np.random.default_rng(1)).points - box.points
    assert not moved[:, :2].any()
    assert 0 < np.abs(moved[:, 2]).max() < 0.006


def test_a_block_of_measured_edges_leans_over_each_at_its_own_angle():
    uneven = Block.from_edges(0.1, 0.3, cg_height=0.5, height=HEIGHT, mass=MASS)
    # θ > 0 leans over the right edge, which is the further one
    assert uneven.critical_angle(+1) == pytest.approx(np.arctan2(0.3, 0.5))
    assert uneven.critical_angle(-1) == pytest.approx(np.arctan2(0.1, 0.5))


def test_which_feet_carry_depends_on_the_contact_tolerance(tmp_path: Path):
    body = trimesh.creation.box((0.4, 0.4, 1.0))
    body.apply_translation([0, 0, 0.6])
    parts = [body]
    for x, y, height in ((1, 1, 0.1), (-1, 1, 0.1), (-1, -1, 0.1), (1, -1, 0.095)):
        foot = trimesh.creation.box((0.02, 0.02, height))
        foot.apply_translation([0.1 * x, 0.1 * y, 0.1 - height / 2])
        parts.append(foot)
    trimesh.util.concatenate(parts).export(tmp_path / "feet.ply")
    shape = read_shape(tmp_path / "feet.ply", mass=300)
    assert shape.edges(0, 0.001)[1] == pytest.approx(0.11, abs=1e-3)
    # without the short foot the base ends at the diagonal through the two others
    assert shape.edges(315.0, 0.001)[1] < 0.02
    assert shape.edges(315.0, 0.006)[1] == pytest.approx(0.11 * np.sqrt(2), abs=1e-3)


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"mass": None}, "either the mass or the density"),
        ({"density": 2000.0}, "either the mass or the density"),
        ({"mass": -1.0}, "mass: expected a positive number"),
        ({"metres_per_unit": 0.3048}, "kg/m³, which no solid object has"),
        ({"metres_per_unit": 1000.0}, "m large"),
    ],
)
def test_what_makes_no_sense_is_refused(tmp_path: Path, change: dict, sentence: str):
    with pytest.raises(InputError, match=sentence):
        read_shape(box_file(tmp_path), **{"mass": MASS * 10, **change})


def test_a_mesh_inside_out_is_turned_and_one_with_a_hole_refused(tmp_path: Path):
    mesh = trimesh.creation.box((WIDTH, DEPTH, HEIGHT))
    mesh.invert()
    mesh.export(tmp_path / "in.ply")
    assert read_shape(tmp_path / "in.ply", mass=MASS).volume > 0
    mesh.update_faces(np.arange(len(mesh.faces)) > 0)
    mesh.export(tmp_path / "hole.ply")
    with pytest.raises(InputError, match=r"not closed \(3 edges"):
        read_shape(tmp_path / "hole.ply", mass=MASS)


@pytest.mark.parametrize(
    "content", [b"", b"solid nothing\nendsolid", b"ply\nformat ascii 1.0\n"]
)
@pytest.mark.parametrize("ending", [".ply", ".stl", ".obj", ".txt"])
def test_what_is_no_mesh_is_refused(tmp_path: Path, content: bytes, ending: str):
    path = tmp_path / f"broken{ending}"
    path.write_bytes(content)
    with pytest.raises(InputError):
        read_shape(path, mass=1.0)
    with pytest.raises(InputError, match=r"no such file|is read from"):
        read_shape(tmp_path / f"absent{ending}", mass=1.0)
