"""Bodies from meshes: mass properties as in closed form, edges where the points carry, bad meshes refused."""

from pathlib import Path

import numpy as np
import pytest
import trimesh

from rockfrag.errors import InputError
from rockfrag.system.blocks import Block
from rockfrag.system.mesh import read_shape

WIDTH, DEPTH, HEIGHT, MASS = 0.4, 0.6, 1.0, 300.0


def written(mesh: trimesh.Trimesh, path: Path) -> Path:
    mesh.export(path)
    return path


@pytest.fixture(params=[".obj", ".ply", ".stl"])
def box(request: pytest.FixtureRequest, tmp_path: Path) -> Path:
    """A uniform box somewhere in space, in one of the formats."""
    mesh = trimesh.creation.box((WIDTH, DEPTH, HEIGHT))
    mesh.apply_translation([3.0, -2.0, 7.0])
    return written(mesh, tmp_path / f"box{request.param}")


def test_a_box_has_the_mass_properties_of_the_closed_form(box: Path):
    shape = read_shape(box, mass=MASS)
    assert shape.volume == pytest.approx(WIDTH * DEPTH * HEIGHT, rel=1e-6)
    assert shape.cg_height == pytest.approx(HEIGHT / 2, rel=1e-6)
    # I = m (b² + h²) / 3 with half sides, for rotation in the plane of the width
    for direction, side in ((0, WIDTH), (90, DEPTH)):
        expected = MASS * (side**2 + HEIGHT**2) / 12
        assert shape.block(direction, 1e-6).inertia == pytest.approx(expected, rel=1e-6)
    assert read_shape(box, density=1250.0).mass == pytest.approx(300.0, rel=1e-6)


def test_a_block_comes_from_a_mesh_or_from_measured_edges(box: Path):
    mesh = read_shape(box, mass=MASS).block(0, 0.001, retreat=0.01)
    inertia = MASS * (WIDTH**2 + HEIGHT**2) / 12
    hand = Block.from_edges(0.19, 0.19, cg_height=0.5, height=HEIGHT, mass=MASS, inertia=inertia)
    assert mesh.width == pytest.approx(hand.width, rel=1e-6)
    assert mesh.cg_offset == pytest.approx(0, abs=1e-6)
    assert mesh.frequency() == pytest.approx(hand.frequency(), rel=1e-6)
    uneven = Block.from_edges(0.1, 0.3, cg_height=0.5, height=HEIGHT, mass=MASS, inertia=inertia)
    # θ > 0 leans over the right edge, which is the further one
    assert uneven.critical_angle(+1) == pytest.approx(np.arctan2(0.3, 0.5))
    assert uneven.critical_angle(-1) == pytest.approx(np.arctan2(0.1, 0.5))


def test_over_its_diagonal_a_box_reaches_half_the_diagonal(box: Path):
    diagonal = np.degrees(np.arctan2(DEPTH, WIDTH))
    edges = read_shape(box, mass=MASS).edges(float(diagonal), 0.001)
    assert edges[1] == pytest.approx(np.hypot(WIDTH, DEPTH) / 2, rel=1e-6)


def test_the_worst_direction_is_across_the_shorter_side(box: Path):
    direction, angle = read_shape(box, mass=MASS).worst_direction(0.001)
    assert direction % 180 == 0
    assert angle == pytest.approx(np.arctan(WIDTH / HEIGHT), rel=1e-6)


def on_feet(heights: tuple[float, float, float, float]) -> trimesh.Trimesh:
    """A box on four small feet of given heights, at the corners of a square of 0.2 m."""
    body = trimesh.creation.box((0.4, 0.4, 1.0))
    body.apply_translation([0, 0, 0.6])
    parts = [body]
    for (x, y), height in zip(((1, 1), (-1, 1), (-1, -1), (1, -1)), heights, strict=True):
        foot = trimesh.creation.box((0.02, 0.02, height))
        foot.apply_translation([0.1 * x, 0.1 * y, 0.1 - height / 2])
        parts.append(foot)
    return trimesh.util.concatenate(parts)


def test_which_feet_carry_depends_on_the_contact_tolerance(tmp_path: Path):
    shape = read_shape(written(on_feet((0.1, 0.1, 0.1, 0.095)), tmp_path / "feet.ply"), mass=300)
    assert shape.edges(0, 0.001)[1] == pytest.approx(0.11, abs=1e-3)
    corner = 135.0 + 180.0
    # without the short foot the base ends at the diagonal through the two others
    assert shape.edges(corner, 0.001)[1] < 0.02
    assert shape.edges(corner, 0.006)[1] == pytest.approx(0.11 * np.sqrt(2), abs=1e-3)


def test_an_edge_that_retreats_makes_the_block_narrower(box: Path):
    shape = read_shape(box, mass=MASS)
    assert shape.block(0, 0.001, retreat=0.05).width == pytest.approx(WIDTH - 0.1, rel=1e-6)
    with pytest.raises(InputError, match="cannot stand"):
        shape.block(0, 0.001, retreat=0.3)


def test_another_scan_moves_points_by_its_tolerance_only(box: Path):
    shape = read_shape(box, mass=MASS)
    other = shape.scanned_again(0.001, np.random.default_rng(1))
    moved = other.points - shape.points
    assert not moved[:, :2].any()
    assert 0 < np.abs(moved[:, 2]).max() < 0.006


def test_a_mesh_inside_out_is_turned(tmp_path: Path):
    mesh = trimesh.creation.box((WIDTH, DEPTH, HEIGHT))
    mesh.invert()
    assert read_shape(written(mesh, tmp_path / "in.ply"), mass=MASS).volume > 0


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
def test_what_makes_no_sense_is_refused(box: Path, change: dict[str, float | None], sentence: str):
    with pytest.raises(InputError, match=sentence):
        read_shape(box, **{"mass": MASS * 10, **change})


def test_a_mesh_with_a_hole_is_refused(tmp_path: Path):
    mesh = trimesh.creation.box((WIDTH, DEPTH, HEIGHT))
    mesh.update_faces(np.arange(len(mesh.faces)) > 0)
    with pytest.raises(InputError, match=r"not closed \(3 edges"):
        read_shape(written(mesh, tmp_path / "hole.ply"), mass=MASS)


@pytest.mark.parametrize("content", [b"", b"solid nothing\nendsolid", b"ply\nformat ascii 1.0\n"])
@pytest.mark.parametrize("ending", [".ply", ".stl", ".obj", ".txt"])
def test_what_is_no_mesh_is_refused(tmp_path: Path, content: bytes, ending: str):
    path = tmp_path / f"broken{ending}"
    path.write_bytes(content)
    with pytest.raises(InputError):
        read_shape(path, mass=1.0)
    with pytest.raises(InputError, match=r"no such file|is read from"):
        read_shape(tmp_path / f"absent{ending}", mass=1.0)
