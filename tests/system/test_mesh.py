"""A body described by points of its surface: where it stands, and the planar block or the body in space it is."""

import math

import numpy as np
import pytest

from rockfrag.base.errors import InputError
from rockfrag.system import mesh

# a prism on a hexagon that widens upwards, of no symmetry; the centre of gravity is the origin
BASE = np.array(
    [(-0.3, -0.2), (0.25, -0.25), (0.35, 0.1), (0.1, 0.3), (-0.2, 0.25), (-0.4, 0.0)]
)
LOW, HIGH, PITS = -0.5, 0.7, 0.004


def shape():
    """Points of both faces, and some that lie 4 mm higher beyond the base; masses at points tell the inertia."""
    above = np.column_stack([1.5 * BASE, np.full(6, HIGH)])
    below = np.column_stack([BASE, np.full(6, LOW)])
    beyond = np.column_stack([1.2 * BASE, np.full(6, LOW + PITS)])
    points = np.concatenate([above, below, beyond])
    inertia = sum((p @ p) * np.eye(3) - np.outer(p, p) for p in points)
    return mesh.Shape(points, 40.0, inertia, 0.1, "stone.obj"), points


def test_it_stands_on_the_polygon_of_the_points_that_are_low_enough():
    stone, _ = shape()
    assert stone.cg_height == 0.5
    assert stone.height == pytest.approx(1.2)
    for tolerance, size in ((0.003, 1.0), (0.005, 1.2)):
        polygon = stone.contact_polygon(tolerance)
        assert sorted(map(tuple, polygon)) == sorted(map(tuple, size * BASE))
        # in order around it
        turns = np.roll(polygon, -1, axis=0) - polygon
        ahead = np.roll(turns, -1, axis=0)
        assert (turns[:, 0] * ahead[:, 1] > turns[:, 1] * ahead[:, 0]).all()
        for direction in (0.0, 40.0, 250.0):
            angle = math.radians(direction)
            along = size * BASE @ (math.cos(angle), math.sin(angle))
            reach = (-along.min(), along.max())
            assert stone.edges(direction, tolerance) == pytest.approx(reach)
    outline = stone.outline
    assert sorted(map(tuple, outline)) == sorted(map(tuple, 1.5 * BASE))


def test_a_block_leans_over_its_edges_and_turns_about_the_axis_across_its_plane():
    stone, points = shape()
    for direction in (0.0, 40.0, 250.0):
        angle = math.radians(direction)
        way = np.array([math.cos(angle), math.sin(angle), 0.0])
        left, right = stone.edges(direction, 0.003)
        block = stone.block(direction, 0.003, retreat=0.01)
        assert block.critical_angle(1) == pytest.approx(math.atan2(right - 0.01, 0.5))
        assert block.critical_angle(-1) == pytest.approx(math.atan2(left - 0.01, 0.5))
        assert (block.mass, block.height) == (40.0, pytest.approx(1.2))
        # distances of its points from that axis, squared
        assert block.inertia == pytest.approx(
            ((points @ way) ** 2 + points[:, 2] ** 2).sum()
        )
    # one edge alone is too far in
    with pytest.raises(InputError, match=r"0\.0400 and -0\.0100 m .*cannot stand"):
        stone.block(0.0, 0.003, retreat=0.36)


def test_a_body_in_space_is_turned_so_that_the_direction_is_its_x():
    stone, points = shape()
    for direction in (0.0, 40.0, 250.0):
        angle = -math.radians(direction)
        c, s = math.cos(angle), math.sin(angle)
        turned = points @ np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]])
        body = stone.body(direction, 0.003)
        found = np.array(body.base.vertices)
        assert np.abs(found[:, None] - turned[None, 6:12, :2]).sum(axis=2).min(
            axis=1
        ) == pytest.approx(0, abs=1e-12)
        assert len(found) == 6
        tensor = sum((p @ p) * np.eye(3) - np.outer(p, p) for p in turned)
        assert body.tensor == pytest.approx(tensor)
        assert (body.mass, body.centre[2], body.height) == (
            40.0,
            0.5,
            pytest.approx(1.2),
        )
        # edges that lie further in
        nearer = np.array(stone.body(direction, 0.003, retreat=0.03).base.vertices)
        before = np.sort(mesh.edge_distances(found))
        assert np.sort(mesh.edge_distances(nearer)) == pytest.approx(before - 0.03)
    with pytest.raises(InputError, match="cannot stand"):
        stone.body(0.0, 0.003, retreat=0.3)


def test_the_worst_direction_is_that_of_the_nearest_edge():
    stone, _ = shape()
    direction, angle = stone.worst_direction(0.003, 0.05)
    distances = mesh.edge_distances(BASE)
    normal = mesh.outward_normals(BASE)[distances.argmin()]
    assert angle == pytest.approx(math.atan2(distances.min(), 0.5), rel=2e-3)
    assert direction == pytest.approx(
        math.degrees(math.atan2(normal[1], normal[0])) % 360, abs=0.05
    )


def test_corners_that_hardly_turn_are_left_out_and_others_kept():
    corners = np.array([(-1, -1), (0, -1 - 1e-4), (1, -1), (1, 1), (0, 1.1), (-1, 1.0)])
    kept = mesh._without_hardly_turning(corners)
    assert kept.tolist() == corners[[0, 2, 3, 4, 5]].tolist()
    many = 60
    angle = 2 * np.pi * np.arange(many) / many
    around = np.column_stack([np.cos(angle), np.sin(angle)])
    # each is 0.3 % of the size off its chord, so that only their number counts
    assert len(mesh._without_hardly_turning(around)) == mesh.MOST_CORNERS


def test_a_body_on_too_few_points_is_told_what_to_do():
    tip = np.array(
        [(0.0, 0.0, -0.5), (0.4, 0.1, 0.3), (-0.4, -0.05, 0.3), (0.05, 0.4, 0.4)]
    )
    with pytest.raises(
        InputError, match=r"within 1 mm .* 1 point.* give a larger contact"
    ):
        mesh.Shape(tip, 1.0, np.eye(3), 0.1, "tip").contact_polygon(0.001)
    # it lies on three points of a plane across y
    fin = np.array([(0, 0, -0.5), (0.4, -0.2, 0.3), (-0.4, -0.2, 0.3), (0, -0.2, 0.9)])
    with pytest.raises(InputError, match=r"with y up it stands on 3 points"):
        mesh.Shape(fin, 1.0, np.eye(3), 0.1, "fin").contact_polygon(0.001)
