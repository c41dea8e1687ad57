"""The rest of a body's record from its base, inertia and height: plain arithmetic, also for kernels (see ``jit``).

So a body has the same bits on every processor, and in a page.

In: vertices or a radius, height [m] and tensor of inertia over the mass [m²]. Out: the other fields of a record
``BODY``. Theory: ``docs/space.md``, "Coordinates".
"""

import math
from typing import Any

from rockfrag.base.elementary import hypot, sin_cos

FEET = 32  # points of a rim of which four carry a round body that slides flat


def fill_body(body: Any, g: float) -> bool:
    """Complete the record of a body, which has its inertia, height, friction and plan; whether it can stand.

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
        # tensor about the point
        for j in range(3):
            for k in range(3):
                about[j, k] = inertia[j, k] - p[j] * p[k]
            about[j, j] += square
        _invert(about, inverses[i])
    return bool(body.nearest > 0)


def _fill_rim(body: Any) -> None:
    """Fill in what follows of a round base from its radius ρ, its centre, the height h and the tensor of inertia.

    These are points of its rim; how near and far the rim lies from below the centre of mass; the arm of friction
    of a base that spins flat (``docs/space.md``, equation 6); and the turns of the contact in a pass through flat,
    π √(1 + ρ²/(A + h²)) rolling and π √(1 + ρ²/A) sliding, A the moment of inertia across ("Near flat" there).
    """
    radius, x, y, points = body.rim, body.centre[0], body.centre[1], body.points
    body.count = FEET
    for i in range(FEET):
        sine, cosine = sin_cos(i * 2 * math.pi / FEET)
        points[i, 0], points[i, 1] = x + radius * cosine, y + radius * sine
    off = hypot(x, y)
    body.nearest, body.furthest = radius - off, radius + off
    across = (body.inertia[0, 0] + body.inertia[1, 1]) / 2
    body.twist = 2 * radius / 3
    square = radius * radius
    body.pass_turn = math.pi * math.sqrt(
        1 + square / (across + body.height * body.height)
    )
    body.slide_turn = math.pi * math.sqrt(1 + square / across)


def _reach_of_polygon(body: Any) -> None:
    """Fill how near and far the edges of a base lie from the centre, and its radius in torsion."""
    body.nearest, body.furthest = math.inf, 0.0
    moment = area = 0.0
    for i in range(body.count):
        j = i + 1 if i + 1 < body.count else 0
        x, y = body.points[i, 0], body.points[i, 1]
        along, across = body.points[j, 0] - x, body.points[j, 1] - y
        length = hypot(along, across)
        edge = (across * x - along * y) / length
        start = x * (along / length) + y * (across / length)
        moment += edge * _distances_of_edge(edge, start, length)
        area += edge * length / 2
        body.nearest = min(body.nearest, edge)
        body.furthest = max(body.furthest, hypot(x, y))
    body.twist = moment / area


def _distances_of_edge(far: float, start: float, length: float) -> float:
    """Integral of distances over the triangle between an edge and the origin, over its height ``far`` [m²].

    The edge goes along a line from ``start``, as seen from the foot of the height, for a ``length`` [m].
    """
    end = start + length
    first, last = hypot(far, start), hypot(far, end)
    logarithm = _logarithm((end + last) / (start + first))
    return (end * last - start * first + far * far * logarithm) / 6


def _logarithm(x: float) -> float:
    """Natural logarithm, to 1e-14, by square roots and the series of the inverse hyperbolic tangent."""
    for _ in range(8):
        x = math.sqrt(x)
    z = (x - 1) / (x + 1)
    s = z * z
    return 512 * z * (1 + s * (1 / 3 + s * (1 / 5 + s * (1 / 7 + s * (1 / 9)))))


def _invert(of: Any, into: Any) -> None:
    """Inverse of a symmetric matrix by its cofactors, which are divided by its largest entry before."""
    size = max(of[0, 0], of[1, 1], of[2, 2])
    a, b, c = of[0, 0] / size, of[0, 1] / size, of[0, 2] / size
    d, e, f = of[1, 1] / size, of[1, 2] / size, of[2, 2] / size
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
    body : record ``BODY``, changed in place
    i : number of the wall
    direction, distance : towards the wall, from x towards y [rad], and of its face from the base's origin [m]
    centre : of mass, from that origin in the plan [m]

    Returns
    -------
    The gap [m]; what touches by rounding touches.
    """
    sine, cosine = sin_cos(direction)
    x, y = -cosine, -sine
    body.away[i, 0], body.away[i, 1] = x, y
    from_centre = distance + (x * centre[0] + y * centre[1])
    least = math.inf
    for k in range(body.corners):
        at = x * body.corner[k, 0] + y * body.corner[k, 1]
        least = min(least, from_centre + at)
    body.distance[i] = from_centre + max(-least, 0.0)
    return least
