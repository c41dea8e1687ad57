"""The rest of a body's record from its base, inertia and height: plain arithmetic, also for kernels (see ``jit``).

So a body has the same bits on every processor, and in a page.

In: vertices or a radius, height [m] and tensor of inertia over the mass [m²]. Out: the other fields of a record
``BODY``. Theory: ``docs/space.md``, "Coordinates", and equations 6, 7 and 20.

All is in the body: the origin of the plan is below the centre of mass, vertices follow each other anticlockwise.
"""

import math
from typing import Any

from rockfrag.base.elementary import hypot, sin_cos

# points of a rim of which four carry a round body that slides flat: a multiple of four, as these stand at right
# angles
FEET = 32
# square roots by which a number comes next to 1, where the series of the logarithm converges
ROOTS = 8


def fill_body(body: Any, g: float) -> bool:
    """Complete the record of a body, which has its inertia, height, friction and plan; whether it can stand.

    Filled in are the inverse of the inertia, the heights of points and the tensor about each, how near and far the
    base reaches, the arm of friction in spin, the turns of a near-flat pass, and the energy below which nothing
    falls.

    Parameters
    ----------
    body : record ``BODY``, changed in place
    g : acceleration of gravity [m/s²]

    Returns
    -------
    Whether the centre of mass is above the base.
    """
    # fields of a record are looked up slowly outside of kernels
    inertia, points, abouts = body.inertia, body.points, body.about
    inverses, height = body.about_inverse, body.height
    _invert(inertia, body.inverse)
    if body.rim > 0:
        _fill_rim(body)
    else:
        _reach_of_polygon(body)
    body.barrier = g * (hypot(body.nearest, height) - height)
    for i in range(body.count):
        p, about = points[i], abouts[i]
        p[2] = -height
        square = p[0] * p[0] + p[1] * p[1] + p[2] * p[2]
        # tensor about the point (equation 4): J + |p|² 1 - p pᵀ
        for j in range(3):
            for k in range(3):
                about[j, k] = inertia[j, k] - p[j] * p[k]
            about[j, j] += square
        _invert(about, inverses[i])
    return bool(body.nearest > 0)


def _fill_rim(body: Any) -> None:
    """Fill what follows from the radius of a round base.

    - ``count`` and ``points``: FEET points of the rim [m];
    - ``nearest`` and ``furthest``: distances of the rim from below the centre of mass [m];
    - ``twist``: mean distance of the base's points from its centre [m], equation 6;
    - ``pass_turn`` and ``slide_turn``: turn of the contact in a pass near flat, π √(1 + ρ²/(A + h²)) where it
      rolls, and π √(1 + ρ²/A) where it slides without friction [rad], equation 20.
    """
    radius, x, y, points = body.rim, body.centre[0], body.centre[1], body.points
    body.count = FEET
    for i in range(FEET):
        sine, cosine = sin_cos(i * 2 * math.pi / FEET)
        points[i, 0], points[i, 1] = x + radius * cosine, y + radius * sine
    off = hypot(x, y)
    body.nearest, body.furthest = radius - off, radius + off
    body.twist = 2 * radius / 3
    # A: mean moment of inertia about an axis across the body's, at the centre of mass [m²]
    across = (body.inertia[0, 0] + body.inertia[1, 1]) / 2
    square = radius * radius
    body.pass_turn = math.pi * math.sqrt(
        1 + square / (across + body.height * body.height)
    )
    body.slide_turn = math.pi * math.sqrt(1 + square / across)


def _reach_of_polygon(body: Any) -> None:
    """Fill how near and far a polygon reaches from below the centre of mass, and the mean distance of its points.

    The mean distance is the integral of distances over the area, both summed over the triangles between an edge
    and the origin (``docs/space.md``, equations 6 and 7). An edge on whose wrong side the origin is has a negative
    distance.
    """
    body.nearest, body.furthest = math.inf, 0.0
    integral = area = 0.0
    for i in range(body.count):
        j = i + 1 if i + 1 < body.count else 0
        x, y = body.points[i, 0], body.points[i, 1]
        along, across = body.points[j, 0] - x, body.points[j, 1] - y
        length = hypot(along, across)
        # distance of the edge's line, and where the edge begins on it, from the foot of that distance
        edge = (across * x - along * y) / length
        start = x * (along / length) + y * (across / length)
        integral += edge * _distances_of_edge(edge, start, length)
        area += edge * length / 2
        body.nearest = min(body.nearest, edge)
        body.furthest = max(body.furthest, hypot(x, y))
    body.twist = integral / area


def _distances_of_edge(far: float, start: float, length: float) -> float:
    """Integral of distances over the triangle between an edge and the origin, over its height ``far`` [m²].

    It is that of equation 7 (``docs/space.md``). The edge goes along a line from ``start``, as seen from the foot
    of the height, for a ``length`` [m].
    """
    end = start + length
    first, last = hypot(far, start), hypot(far, end)
    logarithm = _logarithm((end + last) / (start + first))
    return (end * last - start * first + far * far * logarithm) / 6


def _logarithm(x: float) -> float:
    """Natural logarithm of a positive number, to 1e-14: square roots, then the series of 2 artanh.

    With z = (x - 1)/(x + 1), ln x = 2 (z + z³/3 + z⁵/5 + …); each root halves the logarithm.
    """
    for _ in range(ROOTS):
        x = math.sqrt(x)
    z = (x - 1) / (x + 1)
    s = z * z
    # 512 is twice the 2⁸ that eight roots divide by
    return 512 * z * (1 + s * (1 / 3 + s * (1 / 5 + s * (1 / 7 + s * (1 / 9)))))


def _invert(of: Any, into: Any) -> None:
    """Inverse of a symmetric matrix (3, 3) by its cofactors, written to ``into``.

    The matrix is divided by its largest entry before, so that products neither overflow nor vanish.
    """
    size = max(of[0, 0], of[1, 1], of[2, 2])
    a, b, c = of[0, 0] / size, of[0, 1] / size, of[0, 2] / size
    d, e, f = of[1, 1] / size, of[1, 2] / size, of[2, 2] / size
    # cofactors of the first row of [[a, b, c], [b, d, e], [c, e, f]]
    p, q, s = d * f - e * e, c * e - b * f, b * e - c * d
    scale = 1.0 / ((a * p + b * q + c * s) * size)
    into[0, 0], into[1, 1], into[2, 2] = (
        p * scale,
        (a * f - c * c) * scale,
        (a * d - b * b) * scale,
    )
    xy, xz, yz = q * scale, s * scale, (b * c - a * e) * scale
    into[0, 1], into[1, 0] = xy, xy
    into[0, 2], into[2, 0] = xz, xz
    into[1, 2], into[2, 1] = yz, yz


def fill_wall(
    body: Any,
    i: int,
    direction: float,
    distance: float,
    centre: tuple[float, float],
) -> float:
    """Fill where a wall stands, of a body whose corners are there already; how far the body stands from it.

    Parameters
    ----------
    body : record ``BODY``, changed in place: ``away`` and ``distance`` of the wall
    i : number of the wall
    direction, distance : towards the wall, from x towards y [rad], and of its face from the base's origin [m]
    centre : of mass, from that origin in the plan [m]

    Returns
    -------
    The gap [m]; what touches by rounding touches.
    """
    sine, cosine = sin_cos(direction)
    # away from the wall, in the plan
    x, y = -cosine, -sine
    body.away[i, 0], body.away[i, 1] = x, y
    # of the wall from below the centre of mass, then of each corner from the wall
    from_centre = distance + (x * centre[0] + y * centre[1])
    least = math.inf
    for k in range(body.corners):
        at = x * body.corner[k, 0] + y * body.corner[k, 1]
        least = min(least, from_centre + at)
    body.distance[i] = from_centre + max(-least, 0.0)
    return least
