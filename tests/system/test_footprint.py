"""Outlines in the plan: nearest edges and reaches of a rectangle and of a triangle that lie anywhere."""

import math

import pytest

from rockfrag.system.footprint import nearest_edge, pads_in_circle, reach

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
