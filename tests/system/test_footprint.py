"""Outlines in the plan: nearest edges and reaches of a rectangle and of a triangle that lie anywhere."""

import math

import pytest

from rockfrag.system.footprint import (
    nearest_edge,
    pads_in_circle,
    pads_in_polygon,
    reach,
)

TURN = 0.4


def turned(x: float, y: float) -> tuple[float, float]:
    """A point turned anticlockwise about the origin."""
    c, s = math.cos(TURN), math.sin(TURN)
    return c * x - s * y, s * x + c * y


def test_the_nearest_edge_of_a_rectangle_is_seen_at_right_angles():
    corners = [(-0.3, -0.5), (0.1, -0.5), (0.1, 0.7), (-0.3, 0.7)]
    outline = [turned(*corner) for corner in corners]
    distance, *across = nearest_edge(outline, 4)
    assert distance == pytest.approx(0.1)
    assert across == pytest.approx(turned(1.0, 0.0))
    assert reach(outline, 4, *across) == pytest.approx(distance)
    assert reach(outline, 4, *turned(0.0, 1.0)) == pytest.approx(0.7)


def test_of_a_regular_triangle_every_edge_is_half_a_corner_away():
    corners = [
        (math.cos(a), math.sin(a)) for a in (0.0, 2 * math.pi / 3, -2 * math.pi / 3)
    ]
    distance, *across = nearest_edge(corners, 3)
    assert distance == pytest.approx(0.5)
    # of edges alike the first
    assert across == pytest.approx((0.5, math.sqrt(0.75)))


def test_four_pads_in_a_circle_lie_at_their_part_of_its_radius():
    wide, deep = pads_in_circle(0.4, 0.75)
    assert wide == deep
    assert math.hypot(wide, deep) == pytest.approx(0.75 * 0.4)


def test_four_pads_lie_towards_the_corners_of_a_rectangle_along_its_sides():
    corners = [(-0.3, -0.5), (0.3, -0.5), (0.3, 0.5), (-0.3, 0.5)]
    assert pads_in_polygon(corners, 4, 0.8) == pytest.approx((0.24, 0.4))


@pytest.mark.parametrize("sides", [3, 4, 5, 8])
def test_pads_in_another_outline_lie_in_the_circle_that_touches_its_nearest_edge(sides):
    angles = [0.1 + 2 * math.pi * k / sides for k in range(sides)]
    corners = [(0.5 * math.cos(a), 0.5 * math.sin(a)) for a in angles]
    # of a regular polygon
    touching = 0.5 * math.cos(math.pi / sides)
    found = pads_in_polygon(corners, sides, 0.8)
    assert math.hypot(*found) == pytest.approx(0.8 * touching)
    assert found[0] == found[1]


def test_a_rectangle_that_lies_aside_of_its_origin_has_no_pads_outside():
    corners = [(-0.1, -0.5), (0.3, -0.5), (0.3, 0.5), (-0.1, 0.5)]
    wide, deep = pads_in_polygon(corners, 4, 1.0)
    assert wide == deep == pytest.approx(0.1 * math.sqrt(0.5))
