"""Where contacts are, and what accelerations, forces and impulses a mode has (``docs/contact.md``, 1 to 6).

``p`` and ``w`` are records ``BODY`` and ``WORK`` (``records.py``). ``q`` and ``v`` have x, y [m] and the clockwise
rotation θ [rad] of body k, from place 3 k on, and their rates.  Contact k is under body k, or at a wall; its
ends are 0 (left) and 1 (right).

In: a record ``BODY``, coordinates, velocities and a mode. Out: in the working memory accelerations [m/s², rad/s²]
and forces [N] of the closed ends, or velocities and impulses [N s] of an impact. The equations are 1 to 3 and 7.
"""

import math
from typing import NamedTuple

from rockfrag.base.elementary import sin_cos
from rockfrag.engines.compile.jit import inlined_kernel, kernel
from rockfrag.engines.planar.equations import solve_equations
from rockfrag.engines.planar.records import AT_EDGE
from rockfrag.engines.planar.support import rubbing
from rockfrag.engines.planar.ties import fill_tie_accelerations, is_any_taut
from rockfrag.engines.planar.walls import any_closed, wall_end

SHEAR, COUPLE = 2, 3
"""What an unknown of an interface is, besides the normal force at its ends 0 and 1."""
CORNER, FACE_EDGE, EITHER = 1, 0, -1
"""Kinds of an end of an interface: a corner of the base on the face below, the edge of that face against the base,
and whichever of both it is as the bodies lie."""


@inlined_kernel
def copy(p, of, into):
    """Copy the numbers of all coordinates, three a body, from ``of`` into ``into``."""
    for d in range(3 * p.count):
        into[d] = of[d]


@inlined_kernel
def look_at(p, w, q):
    """Take sines and cosines of the rotations in ``q``."""
    for k in range(p.count):
        w.sin[k], w.cos[k] = sin_cos(q[3 * k + 2])


@inlined_kernel
def corner_of(p, w, q, k, end):
    """Corner (x, y) [m] of the base of body k at an end, 0 or 1, in ``q``, after :func:`look_at` with it."""
    cx, cy = p.corner[k, end, 0], p.corner[k, end, 1]
    c, s = w.cos[k], w.sin[k]
    return q[3 * k] + cx * c + cy * s, q[3 * k + 1] - cx * s + cy * c


@inlined_kernel
def end_of(p, w, q, k, end, kind):
    """End of interface k in the configuration ``q``, after :func:`look_at` with it.

    ``kind``: CORNER, FACE_EDGE or EITHER.

    Returns
    -------
    x, y : the point [m]
    tx, ty : unit tangent there, to the right; the normal, upwards, is (-ty, tx)
    gap : between both sides [m]
    beyond : how far the corner is beyond the edge of the face [m]
    kind : CORNER or FACE_EDGE
    """
    if k >= p.count:
        return wall_end(p, w, q, k, end, kind)
    x, y = corner_of(p, w, q, k, end)
    if k == 0:
        return x, y, 1.0, 0.0, y, -math.inf, CORNER
    # tangent of the face below, whose normal is (-ty, tx)
    tx = w.cos[k - 1] * p.tilt_cos[k] - w.sin[k - 1] * p.tilt_sin[k]
    ty = -(w.sin[k - 1] * p.tilt_cos[k] + w.cos[k - 1] * p.tilt_sin[k])
    # middle of the face below
    fx, fy = p.face[k, 0], p.face[k, 1]
    ox = q[3 * k - 3] + fx * w.cos[k - 1] + fy * w.sin[k - 1]
    oy = q[3 * k - 2] - fx * w.sin[k - 1] + fy * w.cos[k - 1]
    side = 2 * end - 1
    beyond = side * ((x - ox) * tx + (y - oy) * ty) - p.half[k]
    if kind == EITHER:
        kind = CORNER if beyond <= AT_EDGE * p.size else FACE_EDGE
    if kind == CORNER:
        return x, y, tx, ty, -ty * (x - ox) + tx * (y - oy), beyond, CORNER
    # edge of the face, and tangent of the base above it
    ex = ox + side * p.half[k] * tx
    ey = oy + side * p.half[k] * ty
    c, s = w.cos[k], w.sin[k]
    tx = c * p.tilt_cos[k] - s * p.tilt_sin[k]
    ty = -(s * p.tilt_cos[k] + c * p.tilt_sin[k])
    return ex, ey, tx, ty, -ty * (x - ex) + tx * (y - ey), beyond, FACE_EDGE


@inlined_kernel
def rate(p, q, v, k, x, y, dx, dy):
    """Velocity along (dx, dy) of body k relative to what is below it, at the point (x, y) of contact k [m/s].

    ``v`` has velocities, or accelerations, whose relative acceleration without :func:`bias` is then returned
    [m/s²].
    """
    b = 3 * p.upper[k]
    found = dx * (v[b] + v[b + 2] * (y - q[b + 1]))
    found += dy * (v[b + 1] - v[b + 2] * (x - q[b]))
    if p.lower[k] >= 0:
        found -= dx * (v[b - 3] + v[b - 1] * (y - q[b - 2]))
        found -= dy * (v[b - 2] - v[b - 1] * (x - q[b - 3]))
    return found


@inlined_kernel
def bias(p, q, v, k, x, y, dx, dy, kind):
    """Relative acceleration along (dx, dy) at (x, y), seen from the face, where all accelerations vanish [m/s²].

    β of equation 2 in ``docs/contact.md``: the centripetal accelerations of both bodies, and Coriolis's by the
    velocity u of the one relative to the other, as the body with the face turns (ω_f). ``kind`` as of
    :func:`end_of`.
    """
    b = 3 * p.upper[k]
    omega = v[b + 2]
    rx, ry = x - q[b], y - q[b + 1]
    ax, ay = -omega * omega * rx, -omega * omega * ry
    ux, uy = v[b] + omega * ry, v[b + 1] - omega * rx
    omega_of_face = 0.0 if kind == CORNER else omega
    if p.lower[k] >= 0:
        omega_below = v[b - 1]
        rx, ry = x - q[b - 3], y - q[b - 2]
        ax += omega_below * omega_below * rx
        ay += omega_below * omega_below * ry
        ux -= v[b - 3] + omega_below * ry
        uy -= v[b - 2] - omega_below * rx
        if kind == CORNER:
            omega_of_face = omega_below
    ax -= 2.0 * omega_of_face * uy
    ay += 2.0 * omega_of_face * ux
    return dx * ax + dy * ay


@inlined_kernel
def fill_row(p, q, k, x, y, dx, dy, row):
    """Fill ``row``: what (x, y) at contact k moves along (dx, dy) per coordinate of the bodies below and above it.

    It is J of ``docs/contact.md``, equation 2: in places 0 to 2 for x, y and θ of the body below, zero if that is
    the ground, and in places 3 to 5 for those of the body above.
    """
    b = 3 * p.upper[k]
    row[3] = dx
    row[4] = dy
    row[5] = dx * (y - q[b + 1]) - dy * (x - q[b])
    row[0] = row[1] = row[2] = 0.0
    if p.lower[k] >= 0:
        row[0] = -dx
        row[1] = -dy
        row[2] = dy * (x - q[b - 3]) - dx * (y - q[b - 2])


class Sought(NamedTuple):
    """What a mode is solved for: how a motion goes on, or the velocities after an impact."""

    ah: float  # horizontal acceleration of the ground, of no effect in an impact [m/s²]
    av: float  # likewise upwards
    impact: bool
    rubs: bool  # whether contacts that slide have friction


@kernel
def solve_motion(p, w, q, v, ah, av):
    """Solve how the mode in ``w`` goes on; False if its equations are singular.

    ``look_at`` must have been called with ``q``.

    Parameters
    ----------
    p, w : records ``BODY`` and ``WORK``
    q, v : coordinates and velocities, x, y [m] and θ [rad] of each body, shape (3 MOST,)
    ah, av : accelerations of the ground, to the right and upwards [m/s²]

    Fills in ``w``
    --------------
    out : accelerations [m/s², rad/s²]
    normal, shear : forces of closed ends and of interfaces [N]
    """
    sought = Sought(ah, av, False, True)
    if p.is_held == 1 and (any_closed(p, w) or is_any_taut(p, w)):
        return solve_generally(p, w, q, v, sought, 0)
    standing = standing_bodies(p, w)
    if p.count < 3:
        if p.count == 1 or standing == 1:
            _solve_top(p, w, q, v, ah, av)
            return True
        standing = 0
    if not solve_generally(p, w, q, v, sought, standing):
        return False
    if standing > 0:
        _carry(p, w, q, ah, av, standing)
    return True


@kernel
def solve_impact(p, w):
    """Solve an impact at ``w.q`` and ``w.v`` in the mode in ``w``; False if its equations are singular.

    Velocities after it are then in ``w.out``, impulses [N s] in ``w.normal`` and ``w.shear``.
    """
    return solve_generally(p, w, w.q, w.v, Sought(0.0, 0.0, True, True), 0)


@kernel
def solve_nearest(p, w, v):
    """Find in ``w.out`` the velocities that keep the mode in ``w`` and are nearest to ``v``; False if singular.

    They are nearest in kinetic energy: those after an impact in which nothing rubs.
    """
    return solve_generally(p, w, w.q, v, Sought(0.0, 0.0, True, False), 0)


@kernel
def standing_bodies(p, w):
    """Number of bodies, from the ground up, that stand on what stands."""
    for k in range(p.count):
        if not w.closed[k].all() or w.slides[k] != 0:
            return k
    return p.count


@kernel
def _fill_equations(p, w, q, v, k, sought):
    """Fill the equations of contact k (``docs/contact.md``, 3), none if it is open, at most three.

    A closed end asks that its normal motion vanish, one that sticks also its tangential one, once for both ends.
    Equation i, from 3 k on, has ``w.row[i]``, the motion that it asks for, ``w.column[i]``, the force that brings
    it about (the normal one with the friction of a contact that slides), ``w.right[i]`` and ``w.what[i]``, an end,
    SHEAR or COUPLE.

    In an impact motions are velocities, and laws of restitution act in three ways: an end departs at the speed
    ``w.back``; the part ``w.fraction`` of its impulse acts at the other end too; or a couple lets the end
    ``w.drive`` (-1 if none) depart at the speed ``w.depart``.
    """
    impact = sought.impact
    friction = rubbing(p, w, q, k, impact) if sought.rubs else 0.0
    m = 3 * k
    first = True
    for end in range(2):
        if w.closed[k, end] == 0:
            continue
        x, y, tx, ty, _, _, kind = end_of(p, w, q, k, end, w.kind[k, end])
        fill_row(p, q, k, x, y, -ty, tx, w.row[m])
        w.what[m] = end
        w.right[m] = (
            w.back[k, end] if impact else -bias(p, q, v, k, x, y, -ty, tx, kind)
        )
        fill_row(p, q, k, x, y, -ty - friction * tx, tx - friction * ty, w.column[m])
        if impact and w.fraction[k, end] > 0.0:
            # what the impulse brings about at the other end; ``light`` is free memory for a row here
            xo, yo, to, no, _, _, _ = end_of(p, w, q, k, 1 - end, w.kind[k, 1 - end])
            fill_row(p, q, k, xo, yo, -no - friction * to, to - friction * no, w.light)
            for d in range(6):
                w.column[m, d] += w.fraction[k, end] * w.light[d]
        m += 1
        # both ends lie on one line, which one shear holds
        if first and w.slides[k] == 0:
            fill_row(p, q, k, x, y, tx, ty, w.row[m])
            fill_row(p, q, k, x, y, tx, ty, w.column[m])
            w.what[m] = SHEAR
            w.right[m] = 0.0 if impact else -bias(p, q, v, k, x, y, tx, ty, kind)
            m += 1
        first = False
    if impact and w.drive[k] >= 0:
        end = w.drive[k]
        x, y, tx, ty, _, _, _ = end_of(p, w, q, k, end, w.kind[k, end])
        fill_row(p, q, k, x, y, -ty, tx, w.row[m])
        # a couple turns body k (place 5), and what is below it (place 2) the other way
        w.column[m, :] = 0.0
        w.column[m, 5], w.column[m, 2] = 1.0, -1.0 if k > 0 else 0.0
        w.what[m] = COUPLE
        w.right[m] = w.depart[k]
        m += 1
    w.unknowns[k] = m - 3 * k


@kernel
def solve_generally(p, w, q, v, sought, standing):
    """Solve any mode by elimination above the first ``standing`` bodies (``docs/contact.md``, 3; impacts 7).

    In and out as of :func:`solve_motion`, with a :class:`Sought`; False if singular. Three steps: motion without
    contact forces into ``w.out``; forces that bring about what the mode asks of the motion; the motion that they
    add.
    """
    _fill_motion_without_forces(p, w, q, v, sought, standing)
    # under gravity alone two bodies do not move relative to each other
    is_forced = sought.impact or is_any_taut(p, w)
    for k in range(standing, p.contacts):
        _fill_equations(p, w, q, v, k, sought)
        # place d of a row is coordinate base + d: 0 to 2 of the body below, which count unless it is the ground or
        # stands, and 3 to 5 of the body above
        base = 3 * p.upper[k] - 3
        begin = 3 if k == standing or p.lower[k] < 0 else 0
        if begin == 0 and not is_forced:
            continue
        for i in range(3 * k, 3 * k + w.unknowns[k]):
            for d in range(begin, 6):
                w.right[i] -= w.row[i, d] * w.out[base + d]
    # what a search has listed no longer stands
    w.listed[:] = -1
    if not solve_equations(p, w, q, standing, p.count - 1):
        return False
    for d in range(3 * standing, 3 * p.count):
        w.out[d] += w.moved[d]
    _keep_forces(p, w, q, sought.impact, standing)
    return True


@kernel
def _fill_motion_without_forces(p, w, q, v, sought, standing):
    """Fill ``w.out``: accelerations without contact forces, none of standing bodies; or velocities before."""
    for k in range(p.count):
        for d in range(3 * k, 3 * k + 3):
            w.out[d] = v[d] if sought.impact else 0.0
        if not sought.impact and k >= standing:
            w.out[3 * k], w.out[3 * k + 1] = -sought.ah, -(p.g + sought.av)
    if p.ties + p.is_sprung > 0 and not sought.impact:
        fill_tie_accelerations(p, w, q, v)
        for d in range(3 * p.count):
            w.out[d] += w.drift[d]


@kernel
def _keep_forces(p, w, q, impact, standing):
    """Sum up the unknowns that were solved to normal forces of ends and shears of contacts [N], or [N s].

    ``impact``: whether they are impulses; ``standing``: number of bodies from below that stand still.
    """
    for k in range(p.contacts):
        w.normal[k, 0] = w.normal[k, 1] = w.shear[k] = 0.0
    for k in range(standing, p.contacts):
        friction = rubbing(p, w, q, k, impact)
        for i in range(3 * k, 3 * k + w.unknowns[k]):
            force, end = w.force[i], w.what[i]
            if end == SHEAR:
                w.shear[k] += force
            elif end < SHEAR:
                # with a law of restitution the other end gets a fraction of it too
                fraction = w.fraction[k, end] if impact else 0.0
                w.normal[k, end] += force
                w.normal[k, 1 - end] += fraction * force
                w.shear[k] -= friction * (force + fraction * force)


@kernel
def _carry(p, w, q, ah, av, standing):
    """Fill the forces [N] under the first ``standing`` bodies, which do not move, from the uppermost down.

    ``ah``, ``av``: accelerations of the ground [m/s²].
    """
    for body in range(standing - 1, -1, -1):
        # of what is above on the body, the moment clockwise about its centre
        push_x, push_y, moment = 0.0, 0.0, 0.0
        above = body + 1
        shear = w.shear[above] if above < p.count else 0.0
        for end in range(2):
            if above == p.count or w.closed[above, end] == 0:
                continue
            x, y, tx, ty, _, _, _ = end_of(p, w, q, above, end, w.kind[above, end])
            fx = shear * tx - w.normal[above, end] * ty
            fy = shear * ty + w.normal[above, end] * tx
            # at the first closed end
            shear = 0.0
            push_x += fx
            push_y += fy
            moment -= fx * (y - q[3 * body + 1]) - fy * (x - q[3 * body])
        push_x += p.mass[body] * ah
        push_y += p.mass[body] * (p.g + av)
        _hold_still(p, w, q, body, push_x, push_y, moment)


@kernel
def _hold_still(p, w, q, k, push_x, push_y, moment):
    """Fill the forces at interface k that keep body k still under a push and a moment.

    ``push_x``, ``push_y``: at its centre [N]; ``moment``: clockwise [N m]. The far end bears what the moment about
    the near one asks.
    """
    x, y, tx, ty, _, _, _ = end_of(p, w, q, k, 0, w.kind[k, 0])
    far_x, far_y, _, _, _, _, _ = end_of(p, w, q, k, 1, w.kind[k, 1])
    rx, ry = x - q[3 * k], y - q[3 * k + 1]
    shear = push_x * tx + push_y * ty
    push = push_y * tx - push_x * ty
    # arms of the normals at both ends about the centre
    near = -ty * ry - tx * rx
    far = -ty * (far_y - q[3 * k + 1]) - tx * (far_x - q[3 * k])
    w.shear[k] = shear
    w.normal[k, 1] = -(moment + shear * (tx * ry - ty * rx) + push * near) / (
        far - near
    )
    w.normal[k, 0] = push - w.normal[k, 1]


@inlined_kernel
def _solve_top(p, w, q, v, ah, av):
    """Do as :func:`solve_motion` where of at most two bodies only the upper one moves, solved by hand.

    ``ah``, ``av``: accelerations of the ground [m/s²].
    """
    k = p.count - 1
    # acceleration without contact forces, and one over mass and moment of inertia
    fx, fy = -ah, -(p.g + av)
    light, slow = p.inverse[3 * k], p.inverse[3 * k + 2]
    w.normal[k, 0] = w.normal[k, 1] = w.shear[k] = 0.0
    # force and torque on the body, and the torque, clockwise, of that force on the centre of what is below
    force_x, force_y, torque, below = 0.0, 0.0, 0.0, 0.0
    if w.closed[k, 0] == 1 and w.closed[k, 1] == 1:
        force_x, force_y, below = _press_flat(p, w, q, k, fx, fy)
    elif w.closed[k, 0] == 1 or w.closed[k, 1] == 1:
        force_x, force_y, torque, below = _press_at_end(p, w, q, v, k, fx, fy)
    w.out[3 * k] = fx + force_x * light
    w.out[3 * k + 1] = fy + force_y * light
    w.out[3 * k + 2] = torque * slow
    if k > 0:
        w.out[0] = w.out[1] = w.out[2] = 0.0
        push_x = force_x + p.mass[0] * ah
        push_y = force_y + p.mass[0] * (p.g + av)
        _hold_still(p, w, q, 0, push_x, push_y, below)


@inlined_kernel
def _press_flat(p, w, q, k, fx, fy):
    """Forces of an interface closed at both ends, which keep body k level under accelerations fx, fy of its own.

    Returned are the force on the body, x and y [N], and its moment, clockwise, about the centre of body 0 [N m].
    """
    light = p.inverse[3 * k]
    x, y, tx, ty, _, _, _ = end_of(p, w, q, k, 0, w.kind[k, 0])
    far_x, far_y, _, _, _, _, _ = end_of(p, w, q, k, 1, w.kind[k, 1])
    rx, ry = x - q[3 * k], y - q[3 * k + 1]
    # arms of normal (-ty, tx) and tangent (tx, ty) at the first end, and of the normal at the far one
    near, along = -ty * ry - tx * rx, tx * ry - ty * rx
    far = -ty * (far_y - q[3 * k + 1]) - tx * (far_x - q[3 * k])
    # it neither parts nor turns
    push = (ty * fx - tx * fy) / light
    shear = -(tx * fx + ty * fy) / light
    if w.slides[k] != 0:
        shear = -w.slides[k] * p.kinetic[k] * push
    far_push = (along * shear + near * push) / (near - far)
    w.normal[k, 0], w.normal[k, 1], w.shear[k] = push - far_push, far_push, shear
    force_x, force_y = shear * tx - push * ty, push * tx + shear * ty
    moment = force_y * (x - q[0]) - force_x * (y - q[1])
    moment += far_push * (tx * (far_x - x) + ty * (far_y - y))
    return force_x, force_y, moment


@inlined_kernel
def _press_at_end(p, w, q, v, k, fx, fy):
    """Forces of an interface closed at one end, about which body k turns, under accelerations fx, fy of its own.

    Returned are the force on the body, x and y [N], its torque [N m], and its moment, clockwise, about the centre
    of body 0 [N m].
    """
    end = 0 if w.closed[k, 0] == 1 else 1
    light, slow = p.inverse[3 * k], p.inverse[3 * k + 2]
    x, y, tx, ty, _, _, kind = end_of(p, w, q, k, end, w.kind[k, end])
    rx, ry = x - q[3 * k], y - q[3 * k + 1]
    # arms of normal (-ty, tx) and tangent (tx, ty)
    near, along = -ty * ry - tx * rx, tx * ry - ty * rx
    # accelerations of the end by unit forces, along the normal and crosswise, and the one that forces have to give
    by_push, by_both = light + near * near * slow, near * along * slow
    need = ty * fx - tx * fy - bias(p, q, v, k, x, y, -ty, tx, kind)
    if w.slides[k] != 0:
        rubs = -w.slides[k] * p.kinetic[k]
        push = need / (by_push + rubs * by_both)
        shear = rubs * push
    else:
        by_shear = light + along * along * slow
        also = -tx * fx - ty * fy - bias(p, q, v, k, x, y, tx, ty, kind)
        whole = by_push * by_shear - by_both * by_both
        push = (need * by_shear - also * by_both) / whole
        shear = (also * by_push - need * by_both) / whole
    w.normal[k, end], w.shear[k] = push, shear
    force_x, force_y = shear * tx - push * ty, push * tx + shear * ty
    moment = force_y * (x - q[0]) - force_x * (y - q[1])
    return force_x, force_y, near * push + along * shear, moment
