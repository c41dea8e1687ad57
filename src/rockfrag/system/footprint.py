"""Outlines of bases in the plan, as numbers: their nearest edge, how far they reach, and pads under them.

Plain Python that kernels may call too, so that what stands at a wall or on pads has the same bits in a page.
Points run anticlockwise and are counted from the origin of a base, x and y [m].

In: points. Out: distances [m] and directions [-]. Docs: ``docs/holding.md``.
"""

import math
from collections.abc import Sequence

from rockfrag.base.elementary import hypot

Points = Sequence[Sequence[float]]


def nearest_edge(points: Points, count: int) -> tuple[float, float, float]:
    """Distance of a polygon's nearest edge from its origin [m], and the direction across it, outwards.

    Parameters
    ----------
    points, count : of the outline, and how many they are

    Returns
    -------
    The distance, and both components of the direction.
    """
    least = math.inf
    for i in range(count):
        least = min(least, _edge(points, count, i)[0])
    # of two alike the first, whatever rounding says
    for i in range(count):
        found = _edge(points, count, i)
        if found[0] <= least * (1 + 1e-9):
            return found
    return least, 1.0, 0.0


def _edge(points: Points, count: int, i: int) -> tuple[float, float, float]:
    """Distance of edge i from the origin [m], and both components of the unit vector across it, outwards."""
    x, y = points[i][0], points[i][1]
    following = points[(i + 1) % count]
    along, up = following[0] - x, following[1] - y
    length = hypot(along, up)
    east, north = up / length, -along / length
    return east * x + north * y, east, north


def reach(points: Points, count: int, east: float, north: float) -> float:
    """How far an outline reaches from its origin in a direction [m].

    Parameters
    ----------
    points, count : of the outline, and how many they are
    east, north : of the direction

    Returns
    -------
    The distance [m].
    """
    most = -math.inf
    for i in range(count):
        most = max(most, east * points[i][0] + north * points[i][1])
    return most


def pads_in_circle(radius: float, part: float) -> tuple[float, float]:
    """Half the distances of four pads in a circle, along x and y [m].

    Parameters
    ----------
    radius : of the circle [m]
    part : distance of the pads from its middle over its radius [-]

    Returns
    -------
    Both half distances [m].
    """
    half = part * radius * math.sqrt(0.5)
    return half, half


def pads_in_polygon(points: Points, count: int, part: float) -> tuple[float, float]:
    """Half the distances of four pads near the corners of a rectangle, or in another outline [m].

    Parameters
    ----------
    points, count : of the outline, and how many they are
    part : distance of the pads from its middle over that of its edge [-]

    Returns
    -------
    Both half distances [m].
    """
    wide, deep = 0.0, 0.0
    for i in range(count):
        wide, deep = max(wide, abs(points[i][0])), max(deep, abs(points[i][1]))
    is_upright = count == 4
    for i in range(count):
        aside = abs(abs(points[i][0]) - wide) + abs(abs(points[i][1]) - deep)
        is_upright = is_upright and aside < 1e-9
    if is_upright:
        return part * wide, part * deep
    # within the circle that touches the nearest edge
    return pads_in_circle(nearest_edge(points, count)[0], part)
