"""One contact that sticks, or the two of an edge, in closed form: accelerations and forces, and what stops them.

In: a record ``BODY``, arms of the contacts and loads on them. Out: angular accelerations [rad/s²] and forces
[N/kg], or angular velocities and impulses. Theory: ``docs/space.md``, equations 4 and 11 to 13.

- ``rows``: the world's axes as the body sees them, ``up`` = rows[2]; ``omega``: angular velocity in the body
- ``weight``: effective gravity and the ties' force, in the body [N/kg]; ``s``: record ``CASE``
- ``i``, ``j``: numbers of contacts, ``p``, ``q`` their arms from the centre of mass, in the body [m]
"""

import math

from rockfrag.engines.algebra.vectors import (
    cross,
    dot,
    minus,
    plus,
    scaled,
    solve_symmetric,
    times,
    to_world,
)
from rockfrag.engines.compile.jit import inlined_kernel, kernel
from rockfrag.engines.spatial import _body as solid
from rockfrag.engines.spatial._ties import twist_by_ties


@inlined_kernel
def pivot_acceleration(body, p, turned, omega, weight, i, s):
    """Angular acceleration about a sticking point i [rad/s²] and the force at it [N/kg] (equation 4).

    All is in the body. ``p`` is the point's arm and ``turned`` its acceleration without accelerations, β. About a
    vertex the inertia is known; about the lowest point of a rim it changes as the rim rolls.
    """
    load = plus(turned, weight)
    if i == solid.rim_contact(body):
        gyroscopic = cross(omega, times(body.inertia, omega))
        moment = minus(minus(twist_by_ties(s), gyroscopic), cross(p, load))
        alpha = turn_about(body, p, moment)
    else:
        # Euler's equation about the vertex, which is fixed in the body
        gyroscopic = cross(omega, times(body.about[i], omega))
        moment = minus(minus(twist_by_ties(s), gyroscopic), cross(p, weight))
        alpha = times(body.about_inverse[i], moment)
    return alpha, scaled(-1.0, plus(cross(alpha, p), load))


@kernel
def turn_about(body, p, moment):
    """Angular velocity (or acceleration) that a moment about the body's point p gives it if that point is held.

    It is the solution of [J + |p|² 1 - p pᵀ] ω = moment; all in the body, for a unit of mass.
    """
    m = body.inertia
    square = dot(p, p)
    return solve_symmetric(
        m[0, 0] + square - p[0] * p[0], m[0, 1] - p[0] * p[1], m[0, 2] - p[0] * p[2],
        m[1, 1] + square - p[1] * p[1], m[1, 2] - p[1] * p[2], m[2, 2] + square - p[2] * p[2], moment,
    )  # fmt: skip


@kernel
def stop_point(body, up, i, load, momentum):
    """Angular velocity after an impact that stops point i, and the impulse, both in the body (equation 11).

    ``load`` is the velocity of the point but for rotation [m/s], and ``momentum`` the angular momentum about the
    centre of mass [m²/s], before; or accelerations and the moment. Of a vertex the inverse of its inertia is
    known.
    """
    p = solid.arm(body, up, i)
    moment = minus(momentum, cross(p, load))
    rolls = i == solid.rim_contact(body)
    inverse = body.about_inverse[i]
    alpha = turn_about(body, p, moment) if rolls else times(inverse, moment)
    force = scaled(-1.0, plus(cross(alpha, p), load))
    return alpha, force


@kernel
def stop_edge(body, up, i, j, first, second, momentum, small):
    """Angular velocity after an impact that stops points i and j, and its impulse (equation 12).

    ``first`` and ``second`` are the loads of :func:`stop_point`, of i and j: velocities but for those of rotation.
    With ω after the impact, the edge L e from i to j and the inertia J about i,

    - both stop if (first - second)·e = 0 and ω = e × (first - second) / L + σ e;
    - σ follows from the moment about the edge, e·J ω = e·(momentum - p × first);
    - the impulse is -(ω × p + first), and what turns the body otherwise is that at j, (J ω - moment) × e / L.

    Returned are, in the body: the angular velocity [rad/s]; the impulse of both [m/s]; that at j but for its part
    along the edge; the edge's unit vector e; and whether both can be stopped, up to ``small`` [m/s].
    """
    p, q = solid.arm(body, up, i), solid.arm(body, up, j)
    edge = minus(q, p)
    length = math.sqrt(dot(edge, edge))
    e = scaled(1.0 / length, edge)
    # a turn about the edge, beside that which makes up for different loads
    apart = minus(first, second)
    turn = scaled(1.0 / length, cross(e, apart))
    moment = minus(momentum, cross(p, first))
    about = body.about[i]
    left = minus(moment, times(about, turn))
    turn = plus(turn, scaled(dot(e, left) / dot(e, times(about, e)), e))
    push = scaled(-1.0, plus(cross(turn, p), first))
    far = scaled(1.0 / length, cross(minus(times(about, turn), moment), e))
    return turn, push, far, e, abs(dot(e, apart)) <= small


@kernel
def edge_of(body, up, s):
    """Arm of the first of two closed contacts, the unit vector from it to the second, and their distance [m]."""
    p, q = solid.arm(body, up, s.closed[0]), solid.arm(body, up, s.closed[1])
    way = minus(q, p)
    length = math.sqrt(dot(way, way))
    return p, scaled(1.0 / length, way), length


@kernel
def edge_forces(body, rows, edge, spin, weight, s):
    """Fill s.lam with the forces at both ends of an edge that stick [N/kg], in axes of the ground (equation 13).

    ``edge`` is what :func:`edge_of` returns and ``spin`` the angular velocity about it [rad/s]. Returned are the
    angular acceleration about the edge [rad/s²], which is the part of equation 4 along it, and the force of both
    ends together in the body [N/kg].
    """
    p, e, length = edge
    twist = twist_by_ties(s)
    square = spin * spin
    inertia = dot(e, times(body.about[s.closed[0]], e))
    alpha = dot(e, minus(twist, cross(p, weight))) / inertia
    bias = scaled(square, minus(scaled(dot(e, p), e), p))
    force = scaled(-1.0, plus(plus(scaled(alpha, cross(e, p)), bias), weight))
    # but for its part along the edge, the force at the far end follows from the moment about the near one
    momentum = times(body.inertia, e)
    left = plus(scaled(alpha, momentum), scaled(square, cross(e, momentum)))
    left = minus(minus(left, twist), cross(p, force))
    far = scaled(1.0 / length, cross(left, e))
    split_force(body, rows, e, force, far, s)
    return alpha, force


@kernel
def split_force(body, rows, e, force, far, s):
    """Share the part of the force of an edge that is along it so that both ends hold if they can; fill s.lam."""
    far, edge = to_world(rows, far), to_world(rows, e)
    near = minus(to_world(rows, force), far)
    along = dot(near, edge)
    across = minus(near, scaled(along, edge))
    friction = body.static * body.static
    first = max(friction * across[2] ** 2 - across[0] ** 2 - across[1] ** 2, 0.0)
    second = max(friction * far[2] ** 2 - far[0] ** 2 - far[1] ** 2, 0.0)
    first, second = math.sqrt(first), math.sqrt(second)
    part = 0.5 if first + second == 0.0 else first / (first + second)
    for k in range(3):
        s.lam[0, k] = across[k] + part * along * edge[k]
        s.lam[1, k] = far[k] + (1.0 - part) * along * edge[k]
