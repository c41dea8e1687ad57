"""Where contacts are, and what accelerations, forces and impulses a mode has (``docs/contact.md``, 1 to 6)."""

import math

from rockfrag.elementary import sin_cos
from rockfrag.engines.kernels.jit import inlined_kernel, kernel

AT_EDGE = 1e-9
"""A corner counts as over the face until it is this share of the half width beyond the edge: bases as wide as
their face stand on it and not on its edges."""


@inlined_kernel
def look_at(p, w, q):
    """Take sines and cosines of the rotations in ``q``."""
    for k in range(p.count):
        w.sin[k], w.cos[k] = sin_cos(q[3 * k + 2])


@inlined_kernel
def face_axis(p, w, k):
    """Tangent of the face below interface k (its normal is (-ty, tx))."""
    if k == 0:
        return 1.0, 0.0
    c = w.cos[k - 1] * p.tilt_cos[k] - w.sin[k - 1] * p.tilt_sin[k]
    s = w.sin[k - 1] * p.tilt_cos[k] + w.cos[k - 1] * p.tilt_sin[k]
    return c, -s


@kernel
def end_of(p, w, q, k, end, kind):
    """End of interface k in the configuration ``q``.

    ``kind``: 1 a corner on the face, 0 the face's edge against the base, -1 whichever it is.

    Returns
    -------
    Point (x, y), tangent (tx, ty), gap [m], how far the corner is beyond the edge [m], kind.
    """
    cx, cy = p.corner[k, end, 0], p.corner[k, end, 1]
    c, s = w.cos[k], w.sin[k]
    x = q[3 * k] + cx * c + cy * s
    y = q[3 * k + 1] - cx * s + cy * c
    if k == 0:
        return x, y, 1.0, 0.0, y, -math.inf, 1
    tx, ty = face_axis(p, w, k)
    fx, fy = p.face[k, 0], p.face[k, 1]
    ox = q[3 * k - 3] + fx * w.cos[k - 1] + fy * w.sin[k - 1]
    oy = q[3 * k - 2] - fx * w.sin[k - 1] + fy * w.cos[k - 1]
    side = 2 * end - 1
    beyond = side * ((x - ox) * tx + (y - oy) * ty) - p.half[k]
    if kind < 0:
        kind = 1 if beyond <= AT_EDGE * p.size else 0
    if kind == 1:
        return x, y, tx, ty, -ty * (x - ox) + tx * (y - oy), beyond, 1
    ex = ox + side * p.half[k] * tx
    ey = oy + side * p.half[k] * ty
    tx = c * p.tilt_cos[k] - s * p.tilt_sin[k]
    ty = -(s * p.tilt_cos[k] + c * p.tilt_sin[k])
    return ex, ey, tx, ty, -ty * (x - ex) + tx * (y - ey), beyond, 0


@inlined_kernel
def rate(p, q, v, k, x, y, dx, dy):
    """Velocity of body k relative to what is below it, at (x, y) along (dx, dy) [m/s].

    With accelerations for ``v`` the part of the relative acceleration that is linear in them.
    """
    found = dx * (v[3 * k] + v[3 * k + 2] * (y - q[3 * k + 1]))
    found += dy * (v[3 * k + 1] - v[3 * k + 2] * (x - q[3 * k]))
    if k > 0:
        found -= dx * (v[3 * k - 3] + v[3 * k - 1] * (y - q[3 * k - 2]))
        found -= dy * (v[3 * k - 2] - v[3 * k - 1] * (x - q[3 * k - 3]))
    return found


@inlined_kernel
def bias(q, v, k, x, y, dx, dy, kind):
    """Relative acceleration at (x, y) along (dx, dy), seen from the face, where all accelerations vanish."""
    turn = v[3 * k + 2]
    rx, ry = x - q[3 * k], y - q[3 * k + 1]
    ax, ay = -turn * turn * rx, -turn * turn * ry
    ux, uy = v[3 * k] + turn * ry, v[3 * k + 1] - turn * rx
    owner = 0.0 if kind == 1 else turn
    if k > 0:
        below = v[3 * k - 1]
        rx, ry = x - q[3 * k - 3], y - q[3 * k - 2]
        ax += below * below * rx
        ay += below * below * ry
        ux -= v[3 * k - 3] + below * ry
        uy -= v[3 * k - 2] - below * rx
        if kind == 1:
            owner = below
    ax -= 2.0 * owner * uy
    ay += 2.0 * owner * ux
    return dx * ax + dy * ay


@inlined_kernel
def fill_row(p, q, k, x, y, dx, dy, row):
    row[3 * k] = dx
    row[3 * k + 1] = dy
    row[3 * k + 2] = dx * (y - q[3 * k + 1]) - dy * (x - q[3 * k])
    if k > 0:
        row[3 * k - 3] = -dx
        row[3 * k - 2] = -dy
        row[3 * k - 1] = dy * (x - q[3 * k - 3]) - dx * (y - q[3 * k - 2])
    else:
        row[3] = 0.0
        row[4] = 0.0
        row[5] = 0.0


@kernel
def solve(p, w, q, v, ah, av, impact, rough=True):
    """Accelerations of the mode in ``w``, or velocities after an ``impact``, into ``w.out``.

    Without ``rough`` sliding contacts have no friction: the velocities nearest to ``v`` in kinetic energy that
    keep the mode.

    Normal forces (impulses) of closed ends go to ``w.normal``, shear of interfaces to ``w.shear``.  ``look_at``
    must have been called with ``q``.

    Returns
    -------
    Whether the equations had a solution.
    """
    if p.count == 1 and not impact:
        return _solve_lone(p, w, q, v, ah, av)
    stands = w.closed[0, 0] == 1 and w.closed[0, 1] == 1 and w.slides[0] == 0
    flat = w.closed[1, 0] == 1 and w.closed[1, 1] == 1
    if stands and not impact and not (flat and w.slides[1] == 0):
        return _solve_statue(p, w, q, v, ah, av)
    return solve_generally(p, w, q, v, ah, av, impact, rough)


@kernel
def solve_generally(p, w, q, v, ah, av, impact, rough):
    """Solve any mode by elimination, as :func:`solve` does those that it has no formulas for."""
    m = 0
    for k in range(p.count):
        friction = w.slides[k] * p.kinetic[k] if rough else 0.0
        first = True
        for end in range(2):
            if w.closed[k, end] == 0:
                continue
            x, y, tx, ty, _, _, kind = end_of(p, w, q, k, end, w.kind[k, end])
            fill_row(p, q, k, x, y, -ty, tx, w.row[m])
            w.owner[m] = 3 * k + end
            right = -bias(q, v, k, x, y, -ty, tx, kind) if not impact else 0.0
            if w.slides[k] != 0:
                fill_row(p, q, k, x, y, -ty - friction * tx, tx - friction * ty, w.column[m])
            else:
                for d in range(6):
                    w.column[m, d] = w.row[m, d]
            w.matrix[m, 6] = right
            m += 1
            if first and w.slides[k] == 0:
                fill_row(p, q, k, x, y, tx, ty, w.row[m])
                for d in range(6):
                    w.column[m, d] = w.row[m, d]
                w.owner[m] = 3 * k + 2
                w.matrix[m, 6] = -bias(q, v, k, x, y, tx, ty, kind) if not impact else 0.0
                m += 1
            first = False
    for k in range(p.count):
        if impact:
            w.out[3 * k] = v[3 * k]
            w.out[3 * k + 1] = v[3 * k + 1]
            w.out[3 * k + 2] = v[3 * k + 2]
        else:
            w.out[3 * k] = -ah
            w.out[3 * k + 1] = -(p.g + av)
            w.out[3 * k + 2] = 0.0
        w.normal[k, 0] = 0.0
        w.normal[k, 1] = 0.0
        w.shear[k] = 0.0
    for i in range(m):
        total = w.matrix[i, 6]
        for d in range(6):
            total -= w.row[i, d] * w.out[d]
        w.matrix[i, 6] = total
        for d in range(6):
            w.light[d] = w.row[i, d] * p.inverse[d]
        for j in range(m):
            total = 0.0
            for d in range(6):
                total += w.light[d] * w.column[j, d]
            w.matrix[i, j] = total
    if not eliminate(w.matrix, m):
        return False
    for i in range(m):
        force = w.matrix[i, 6]
        k = w.owner[i] // 3
        end = w.owner[i] - 3 * k
        if end == 2:
            w.shear[k] += force
        else:
            w.normal[k, end] = force
            w.shear[k] -= w.slides[k] * p.kinetic[k] * force
        for d in range(6):
            w.out[d] += p.inverse[d] * w.column[i, d] * force
    return True


@kernel
def _solve_lone(p, w, q, v, ah, av):
    """Accelerations and forces of a lone block, whose equations are solved by hand: those of :func:`solve`."""
    fx, fy = -ah, -(p.g + av)
    turn = v[2]
    light, slow = p.inverse[0], p.inverse[2]
    slides = w.slides[0]
    w.normal[0, 0] = 0.0
    w.normal[0, 1] = 0.0
    push, shear, twist = 0.0, 0.0, 0.0
    if w.closed[0, 0] == 1 and w.closed[0, 1] == 1:
        left, _, _, _, _, _, _ = end_of(p, w, q, 0, 0, 1)
        right, y, _, _, _, _, _ = end_of(p, w, q, 0, 1, 1)
        rx0, rx1, ry = left - q[0], right - q[0], y - q[1]
        push = -fy / light
        shear = -slides * p.kinetic[0] * push if slides != 0 else -fx / light
        # no turning: N0 rx0 + N1 rx1 = T ry
        w.normal[0, 1] = (shear * ry - push * rx0) / (rx1 - rx0)
        w.normal[0, 0] = push - w.normal[0, 1]
    elif w.closed[0, 0] == 1 or w.closed[0, 1] == 1:
        end = 0 if w.closed[0, 0] == 1 else 1
        x, y, _, _, _, _, _ = end_of(p, w, q, 0, end, 1)
        rx, ry = x - q[0], y - q[1]
        across = light + rx * rx * slow
        both = -rx * ry * slow
        need = turn * turn * ry - fy
        if slides != 0:
            push = need / (across - slides * p.kinetic[0] * both)
            shear = -slides * p.kinetic[0] * push
        else:
            along = light + ry * ry * slow
            also = turn * turn * rx - fx
            whole = across * along - both * both
            push = (need * along - also * both) / whole
            shear = (also * across - need * both) / whole
        w.normal[0, end] = push
        twist = ry * shear - rx * push
    w.shear[0] = shear
    w.out[0] = fx + shear * light
    w.out[1] = fy + push * light
    w.out[2] = twist * slow
    return True


@kernel
def _solve_statue(p, w, q, v, ah, av):
    """Accelerations and forces where the pedestal stands and the statue does not: those of :func:`solve`."""
    fx, fy = -ah, -(p.g + av)
    light, slow = p.inverse[3], p.inverse[5]
    w.normal[1, 0] = 0.0
    w.normal[1, 1] = 0.0
    w.shear[1] = 0.0
    pull_x, pull_y, twist, moment = 0.0, 0.0, 0.0, 0.0
    if w.closed[1, 0] == 1 and w.closed[1, 1] == 1:
        # it slides flat: what accelerates it apart vanishes, and it does not turn
        x, y, tx, ty, _, _, _ = end_of(p, w, q, 1, 0, w.kind[1, 0])
        rx, ry = x - q[3], y - q[4]
        one, two = -ty * ry - tx * rx, tx * ry - ty * rx
        x1, y1, _, _, _, _, _ = end_of(p, w, q, 1, 1, w.kind[1, 1])
        other = -ty * (y1 - q[4]) - tx * (x1 - q[3])
        push = (ty * fx - tx * fy) / light
        shear = -w.slides[1] * p.kinetic[1] * push
        w.normal[1, 1] = (two * shear + one * push) / (one - other)
        w.normal[1, 0] = push - w.normal[1, 1]
        w.shear[1] = shear
        pull_x, pull_y = shear * tx - push * ty, push * tx + shear * ty
        moment = pull_y * (x - q[0]) - pull_x * (y - q[1])
        moment += w.normal[1, 1] * (tx * (x1 - x) + ty * (y1 - y))
    elif w.closed[1, 0] == 1 or w.closed[1, 1] == 1:
        end = 0 if w.closed[1, 0] == 1 else 1
        x, y, tx, ty, _, _, kind = end_of(p, w, q, 1, end, w.kind[1, end])
        rx, ry = x - q[3], y - q[4]
        # arms of normal (-ty, tx) and tangent (tx, ty)
        one, two = -ty * ry - tx * rx, tx * ry - ty * rx
        across = light + one * one * slow
        both = one * two * slow
        need = ty * fx - tx * fy - bias(q, v, 1, x, y, -ty, tx, kind)
        if w.slides[1] != 0:
            push = need / (across - w.slides[1] * p.kinetic[1] * both)
            shear = -w.slides[1] * p.kinetic[1] * push
        else:
            along = light + two * two * slow
            also = -tx * fx - ty * fy - bias(q, v, 1, x, y, tx, ty, kind)
            whole = across * along - both * both
            push = (need * along - also * both) / whole
            shear = (also * across - need * both) / whole
        w.normal[1, end] = push
        w.shear[1] = shear
        pull_x, pull_y = shear * tx - push * ty, push * tx + shear * ty
        twist = one * push + two * shear
        moment = pull_y * (x - q[0]) - pull_x * (y - q[1])
    left, _, _, _, _, _, _ = end_of(p, w, q, 0, 0, 1)
    right, y, _, _, _, _, _ = end_of(p, w, q, 0, 1, 1)
    rx0, rx1, ry = left - q[0], right - q[0], y - q[1]
    shear = pull_x - p.mass[0] * fx
    push = pull_y - p.mass[0] * fy
    w.normal[0, 1] = (shear * ry + moment - push * rx0) / (rx1 - rx0)
    w.normal[0, 0] = push - w.normal[0, 1]
    w.shear[0] = shear
    w.out[0] = 0.0
    w.out[1] = 0.0
    w.out[2] = 0.0
    w.out[3] = fx + pull_x * light
    w.out[4] = fy + pull_y * light
    w.out[5] = twist * slow
    return True


@kernel
def eliminate(a, m):
    """Solve m equations whose right-hand side is column 6, in place; False if they are singular."""
    for i in range(m):
        best = i
        for j in range(i + 1, m):
            if abs(a[j, i]) > abs(a[best, i]):
                best = j
        if a[best, i] == 0.0:
            return False
        if best != i:
            for j in range(i, m):
                a[i, j], a[best, j] = a[best, j], a[i, j]
            a[i, 6], a[best, 6] = a[best, 6], a[i, 6]
        pivot = 1.0 / a[i, i]
        for j in range(i + 1, m):
            factor = a[j, i] * pivot
            if factor != 0.0:
                for c in range(i + 1, m):
                    a[j, c] -= factor * a[i, c]
                a[j, 6] -= factor * a[i, 6]
    for i in range(m - 1, -1, -1):
        total = a[i, 6]
        for j in range(i + 1, m):
            total -= a[i, j] * a[j, 6]
        a[i, 6] = total / a[i, i]
    return True
