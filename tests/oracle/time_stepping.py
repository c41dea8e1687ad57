"""An oracle: time stepping with complementarity (Stewart and Trinkle 1996), plain and slow.

It knows no modes and no contact events.  In each step of constant length the velocities are those after impulses
that keep every corner from sinking through the face under it and obey Coulomb's law, found by Gauss-Seidel
iteration over the contacts; where Newton's method on which of them press, stick and slide comes to an end, the
iteration starts from what it has found, and only has to confirm it.  Candidates are each corner of a base over the
face below, and each edge of a face under the base above, as long as one lies over the other.  The method is of
first order in the step.
"""

import math

import numba
import numpy as np

from rockfrag.system import System, as_system

from .standing import standing


def body_table(system: System) -> np.ndarray:
    """Mass, inertia, corners and top edges from the centre, tilt of the base and of the top, start (x, y)."""
    return np.array(
        [
            [b.mass, b.inertia, *b.corners.ravel(), *b.edges.ravel(), b.base, b.face, *b.centre]
            for b in standing(system)
        ]
    )


@numba.njit(cache=True)
def _candidates(table, q, points, axes, gaps, below):
    """Contact points, axis angles (of the face), gaps and the body above; number of them."""
    n = 0
    for k in range(table.shape[0]):
        x, y, th = q[3 * k], q[3 * k + 1], q[3 * k + 2]
        c, s = math.cos(th), math.sin(th)
        corners = np.empty((2, 2))
        for i in range(2):
            cx, cy = table[k, 2 + 2 * i], table[k, 3 + 2 * i]
            corners[i, 0], corners[i, 1] = x + cx * c + cy * s, y - cx * s + cy * c
        if k == 0:
            for i in range(2):
                points[n] = corners[i]
                axes[n], gaps[n], below[n] = 0.0, corners[i, 1], k
                n += 1
            continue
        xl, yl, tl = q[3 * k - 3], q[3 * k - 2], q[3 * k - 1]
        c, s = math.cos(tl), math.sin(tl)
        edges = np.empty((2, 2))
        for i in range(2):
            ex, ey = table[k - 1, 6 + 2 * i], table[k - 1, 7 + 2 * i]
            edges[i, 0], edges[i, 1] = xl + ex * c + ey * s, yl - ex * s + ey * c
        for segment, others, angle, sign in (
            (edges, corners, tl + table[k - 1, 11], 1.0),
            (corners, edges, th + table[k, 10], -1.0),
        ):
            tx, ty = math.cos(angle), -math.sin(angle)
            length = (segment[1, 0] - segment[0, 0]) * tx + (segment[1, 1] - segment[0, 1]) * ty
            for i in range(2):
                dx, dy = others[i, 0] - segment[0, 0], others[i, 1] - segment[0, 1]
                along = dx * tx + dy * ty
                if -1e-12 <= along <= length + 1e-12:
                    points[n] = others[i]
                    axes[n], gaps[n], below[n] = angle, sign * (-dx * ty + dy * tx), k
                    n += 1
    return n


@numba.njit(cache=True)
def _response(jn, jt, inverse, below, count, w):
    """Fill what a unit of each impulse (normal 2 c, tangent 2 c + 1) changes along each, and a little more."""
    for c in range(count):
        for e in range(c + 1):
            for i in range(2):
                above = jn[c] if i == 0 else jt[c]
                for j in range(2):
                    other = jn[e] if j == 0 else jt[e]
                    total = 0.0
                    if below[e] == below[c]:
                        for d in range(3 if below[c] == 0 else 0, 6):
                            total += above[d] * other[d] * inverse[3 * below[c] - 3 + d]
                    elif below[e] == below[c] - 1:
                        for d in range(3):
                            total += above[d] * other[d + 3] * inverse[3 * below[c] - 3 + d]
                    w[2 * c + i, 2 * e + j] = w[2 * e + j, 2 * c + i] = total
        w[2 * c, 2 * c] *= 1.0 + 1e-9
        w[2 * c + 1, 2 * c + 1] *= 1.0 + 1e-9


@numba.njit(cache=True)
def _newton(w, free, mu, count, press, slide, pn, pt, a, x, of):
    """Impulses of the contacts that press, stick (``slide`` 0) and slide; False if the iteration has no end.

    Alart and Curnier 1991.  The band of the equations is used, as contacts are listed from below.
    """
    for _ in range(30):
        m = 0
        for c in range(count):
            if press[c]:
                of[m] = 2 * c
                m += 1
                if slide[c] == 0:
                    of[m] = 2 * c + 1
                    m += 1
        for i in range(m):
            x[i] = -free[of[i]]
            for j in range(m):
                c = of[j] // 2
                a[i, j] = w[of[i], of[j]]
                if of[j] % 2 == 0 and slide[c] != 0:
                    a[i, j] += slide[c] * mu[c] * w[of[i], 2 * c + 1]
        for i in range(m):
            high = i + 1
            for j in range(i + 1, m):
                if a[i, j] != 0.0:
                    high = j + 1
            if abs(a[i, i]) < 1e-14:
                return False
            for j in range(i + 1, m):
                factor = a[j, i] / a[i, i]
                if factor != 0.0:
                    for d in range(i, high):
                        a[j, d] -= factor * a[i, d]
                    x[j] -= factor * x[i]
        for i in range(m - 1, -1, -1):
            for j in range(i + 1, m):
                x[i] -= a[i, j] * x[j]
            x[i] /= a[i, i]
        for c in range(count):
            pn[c] = pt[c] = 0.0
        for i in range(m):
            c = of[i] // 2
            if of[i] % 2 == 1:
                pt[c] = x[i]
            else:
                pn[c] = x[i]
                pt[c] = slide[c] * mu[c] * x[i]
        same = True
        for c in range(count):
            un, ut = free[2 * c], free[2 * c + 1]
            for e in range(count):
                un += w[2 * c, 2 * e] * pn[e] + w[2 * c, 2 * e + 1] * pt[e]
                ut += w[2 * c + 1, 2 * e] * pn[e] + w[2 * c + 1, 2 * e + 1] * pt[e]
            was, way = press[c], slide[c]
            press[c] = pn[c] > 0.0 if was else un < 0.0
            if not press[c]:
                slide[c] = 0
            elif was and way == 0 and abs(pt[c]) > mu[c] * pn[c] * (1.0 + 1e-9):
                slide[c] = 1 if pt[c] > 0.0 else -1
            elif way * ut > 1e-12:
                slide[c] = 0
            same = same and press[c] == was and slide[c] == way
        if same:
            return True
    return False


@numba.njit(cache=True)
def step_through(table, friction, g, horizontal, vertical, dt, substeps, tail, q, v, rows):
    """March; fills rows (samples, 6 n) with q, v at samples.

    Returns the body that fell (0: none), when, and the number of rows.
    """
    n = table.shape[0]
    h = dt / substeps
    m = 4 * n
    points, axes, gaps = np.zeros((m, 2)), np.zeros(m), np.zeros(m)
    below = np.zeros(m, np.int64)
    # of each contact: what it takes of the body below (3) and of the one above (3)
    jn, jt = np.zeros((m, 6)), np.zeros((m, 6))
    wn, wt = np.zeros(m), np.zeros(m)
    pn, pt = np.zeros(m), np.zeros(m)
    weights, free, mu = np.zeros((2 * m, 2 * m)), np.zeros(2 * m), np.zeros(m)
    press, slide = np.zeros(m, np.bool_), np.zeros(m, np.int64)
    tried_n, tried_t = np.zeros(m), np.zeros(m)
    a, x, of = np.zeros((2 * m, 2 * m)), np.zeros(2 * m), np.zeros(2 * m, np.int64)
    inverse = np.zeros(3 * n)
    for k in range(n):
        inverse[3 * k] = inverse[3 * k + 1] = 1.0 / table[k, 0]
        inverse[3 * k + 2] = 1.0 / table[k, 1]
    last = horizontal.size - 1
    previous = 0
    for i in range(last + tail):
        rows[i, : 3 * n] = q
        rows[i, 3 * n :] = v
        for j in range(substeps):
            part = (j + 0.5) / substeps
            ah = av = 0.0
            if i < last:
                ah = horizontal[i] + part * (horizontal[i + 1] - horizontal[i])
                av = vertical[i] + part * (vertical[i + 1] - vertical[i])
            count = _candidates(table, q, points, axes, gaps, below)
            if count != previous:
                pn[:] = 0.0
                pt[:] = 0.0
                press[:] = True
                slide[:] = 0
            previous = count
            for k in range(n):
                v[3 * k] -= h * ah
                v[3 * k + 1] -= h * (g + av)
            for c in range(count):
                tx, ty = math.cos(axes[c]), -math.sin(axes[c])
                jn[c, :] = 0.0
                jt[c, :] = 0.0
                wn[c] = wt[c] = 0.0
                first, low = 3 * below[c] - 3, 3 if below[c] == 0 else 0
                for at in range(low, 6, 3):
                    k, sign = below[c] - 1 + at // 3, -1.0 if at == 0 else 1.0
                    rx, ry = points[c, 0] - q[3 * k], points[c, 1] - q[3 * k + 1]
                    jt[c, at], jt[c, at + 1] = sign * tx, sign * ty
                    jt[c, at + 2] = sign * (tx * ry - ty * rx)
                    jn[c, at], jn[c, at + 1] = -sign * ty, sign * tx
                    jn[c, at + 2] = sign * (-ty * ry - tx * rx)
                for d in range(low, 6):
                    wn[c] += jn[c, d] ** 2 * inverse[first + d]
                    wt[c] += jt[c, d] ** 2 * inverse[first + d]
                free[2 * c], free[2 * c + 1], mu[c] = gaps[c] / h, 0.0, friction[below[c]]
                for d in range(low, 6):
                    free[2 * c] += jn[c, d] * v[first + d]
                    free[2 * c + 1] += jt[c, d] * v[first + d]
            _response(jn, jt, inverse, below, count, weights)
            if _newton(weights, free, mu, count, press, slide, tried_n, tried_t, a, x, of):
                for c in range(count):
                    pn[c], pt[c] = tried_n[c], tried_t[c]
            for c in range(count):
                first, low = 3 * below[c] - 3, 3 if below[c] == 0 else 0
                for d in range(low, 6):
                    v[first + d] += inverse[first + d] * (jn[c, d] * pn[c] + jt[c, d] * pt[c])
            for _ in range(2000):
                change = 0.0
                largest = 1e-300
                for c in range(count):
                    first, low = 3 * below[c] - 3, 3 if below[c] == 0 else 0
                    speed = 0.0
                    for d in range(low, 6):
                        speed += jn[c, d] * v[first + d]
                    new = max(0.0, pn[c] - (speed + gaps[c] / h) / wn[c])
                    delta = new - pn[c]
                    pn[c] = new
                    change = max(change, abs(delta))
                    largest = max(largest, new)
                    for d in range(low, 6):
                        v[first + d] += inverse[first + d] * jn[c, d] * delta
                    speed = 0.0
                    for d in range(low, 6):
                        speed += jt[c, d] * v[first + d]
                    limit = friction[below[c]] * pn[c]
                    new = min(max(pt[c] - speed / wt[c], -limit), limit)
                    delta = new - pt[c]
                    pt[c] = new
                    change = max(change, abs(delta))
                    for d in range(low, 6):
                        v[first + d] += inverse[first + d] * jt[c, d] * delta
                if change <= 1e-8 * largest:
                    break
            moving = 0.0
            for d in range(3 * n):
                q[d] += h * v[d]
                moving = max(moving, abs(v[d]))
            for k in range(n):
                relative = q[3 * k + 2] - (q[3 * k - 1] if k else 0.0)
                off = k > 0 and _apart(table, q, k)
                if abs(q[3 * k + 2]) >= math.pi / 2 or abs(relative) >= math.pi / 2 or off:
                    return k + 1, i * dt + (j + 1) * h, i + 1
        if i >= last and moving < 1e-4:
            return 0, math.nan, i + 1
    return 0, math.nan, last + tail


@numba.njit(cache=True)
def _apart(table, q, above):
    """Whether a base no longer lies over the face below."""
    tl = q[3 * above - 1] + table[above - 1, 11]
    tx, ty = math.cos(tl), -math.sin(tl)
    ends = np.empty((2, 2))
    for part, k, first in ((0, above - 1, 6), (1, above, 2)):
        c, s = math.cos(q[3 * k + 2]), math.sin(q[3 * k + 2])
        for i in range(2):
            ex, ey = table[k, first + 2 * i], table[k, first + 1 + 2 * i]
            px, py = q[3 * k] + ex * c + ey * s, q[3 * k + 1] - ex * s + ey * c
            ends[part, i] = px * tx + py * ty
    return ends[1, 0] > ends[0, 1] or ends[1, 1] < ends[0, 0]


def time_stepping(body, acceleration, dt, friction, *, step=2e-05, vertical=None, tail=8.0, g=9.81):
    """Whether, which and when a body fell, and q, v at the samples."""
    table = body_table(as_system(body))
    n = len(table)
    q = np.zeros(3 * n)
    for k in range(n):
        q[3 * k : 3 * k + 2] = table[k, 12:]
    steps = round(tail / dt)
    rows = np.zeros((len(acceleration) + steps, 6 * n))
    values = np.ascontiguousarray(acceleration, dtype=float)
    up = np.zeros_like(values) if vertical is None else np.ascontiguousarray(vertical, dtype=float)
    fallen, when, count = step_through(
        table, np.array(friction, dtype=float), g, values, up, dt, max(1, math.ceil(dt / step - 1e-9)),
        steps, q, np.zeros(3 * n), rows,
    )  # fmt: skip
    return fallen > 0, fallen, when, rows[:count]
