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
            [
                b.mass,
                b.inertia,
                *b.corners.ravel(),
                *b.edges.ravel(),
                b.base,
                b.face,
                *b.centre,
            ]
            for b in standing(system)
        ]
    )


@numba.njit(cache=True)
def _ends(table, q, k, first):
    """Where the corners of body k (``first`` 2) or its top edges (6) are, shape (2, 2)."""
    c, s = math.cos(q[3 * k + 2]), math.sin(q[3 * k + 2])
    found = np.empty((2, 2))
    for i in range(2):
        x, y = table[k, first + 2 * i], table[k, first + 1 + 2 * i]
        found[i, 0], found[i, 1] = (
            q[3 * k] + x * c + y * s,
            q[3 * k + 1] - x * s + y * c,
        )
    return found


@numba.njit(cache=True)
def _candidates(table, q, points, axes, gaps, below):
    """Contact points, axis angles (of the face), gaps and the body above; number of them."""
    n = 0
    for k in range(table.shape[0]):
        corners = _ends(table, q, k, 2)
        if k == 0:
            for i in range(2):
                points[n] = corners[i]
                axes[n], gaps[n], below[n] = 0.0, corners[i, 1], k
                n += 1
            continue
        edges = _ends(table, q, k - 1, 6)
        for segment, others, angle, sign in (
            (edges, corners, q[3 * k - 1] + table[k - 1, 11], 1.0),
            (corners, edges, q[3 * k + 2] + table[k, 10], -1.0),
        ):
            tx, ty = math.cos(angle), -math.sin(angle)
            length = (segment[1, 0] - segment[0, 0]) * tx + (
                segment[1, 1] - segment[0, 1]
            ) * ty
            for i in range(2):
                dx, dy = others[i, 0] - segment[0, 0], others[i, 1] - segment[0, 1]
                along = dx * tx + dy * ty
                if -1e-12 <= along <= length + 1e-12:
                    points[n] = others[i]
                    axes[n], gaps[n], below[n] = angle, sign * (-dx * ty + dy * tx), k
                    n += 1
    return n


@numba.njit(cache=True)
def _jacobian(q, points, axes, below, count):
    """What each velocity gives to the speeds along normal (row 2 c) and tangent (2 c + 1) of each contact."""
    rows = np.zeros((2 * count, q.size))
    for c in range(count):
        tx, ty = math.cos(axes[c]), -math.sin(axes[c])
        for k, sign in ((below[c] - 1, -1.0), (below[c], 1.0)):
            if k >= 0:
                rx, ry = points[c, 0] - q[3 * k], points[c, 1] - q[3 * k + 1]
                rows[2 * c, 3 * k : 3 * k + 3] = (
                    -sign * ty,
                    sign * tx,
                    -sign * (ty * ry + tx * rx),
                )
                rows[2 * c + 1, 3 * k : 3 * k + 3] = (
                    sign * tx,
                    sign * ty,
                    sign * (tx * ry - ty * rx),
                )
    return rows


@numba.njit(cache=True)
def _newton(w, free, mu, press, slide, p):
    """Impulses of the contacts that press, stick (``slide`` 0) and slide; False if the iteration has no end.

    Alart and Curnier 1991.
    """
    for _ in range(30):
        solved = np.zeros(free.size, np.bool_)
        solved[::2], solved[1::2] = press, press & (slide == 0)
        of, along = np.flatnonzero(solved), w.copy()
        along[:, ::2] += w[:, 1::2] * (slide * mu)
        p[:] = 0.0
        p[of] = np.linalg.solve(along[of][:, of], -free[of])
        p[1::2] += slide * mu * p[::2]
        u = free + w @ p
        same = True
        for c in range(press.size):
            was, way = press[c], slide[c]
            press[c] = p[2 * c] > 0.0 if was else u[2 * c] < 0.0
            if not press[c]:
                slide[c] = 0
            elif (
                was and way == 0 and abs(p[2 * c + 1]) > mu[c] * p[2 * c] * (1.0 + 1e-9)
            ):
                slide[c] = 1 if p[2 * c + 1] > 0.0 else -1
            elif way * u[2 * c + 1] > 1e-12:
                slide[c] = 0
            same = same and press[c] == was and slide[c] == way
        if same:
            return True
    return False


@numba.njit(cache=True)
def _relax(w, free, mu, p):
    """Gauss-Seidel iteration over the contacts from impulses that are nearly those sought."""
    u = free + w @ p
    for _ in range(2000):
        change, largest = 0.0, 1e-300
        for i in range(p.size):
            new = p[i] - u[i] / w[i, i]
            if i % 2 == 0:
                new = max(0.0, new)
                largest = max(largest, new)
            else:
                limit = mu[i // 2] * p[i - 1]
                new = min(max(new, -limit), limit)
            u += w[i] * (new - p[i])
            change = max(change, abs(new - p[i]))
            p[i] = new
        if change <= 1e-8 * largest:
            break


@numba.njit(cache=True)
def step_through(
    table, friction, g, horizontal, vertical, dt, substeps, tail, q, v, rows
):
    """March; fills rows (samples, 6 n) with q, v at samples.

    Returns the body that fell (0: none), when, and the number of rows.
    """
    n = table.shape[0]
    h = dt / substeps
    m = 4 * n
    points, axes, gaps = np.zeros((m, 2)), np.zeros(m), np.zeros(m)
    below = np.zeros(m, np.int64)
    p, press, slide = np.zeros(0), np.zeros(0, np.bool_), np.zeros(0, np.int64)
    inverse = np.zeros(3 * n)
    inverse[::3] = inverse[1::3] = 1.0 / table[:, 0]
    inverse[2::3] = 1.0 / table[:, 1]
    last = horizontal.size - 1
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
            if count != press.size:
                p, press = np.zeros(2 * count), np.ones(count, np.bool_)
                slide = np.zeros(count, np.int64)
            v[::3] -= h * ah
            v[1::3] -= h * (g + av)
            jacobian = _jacobian(q, points, axes, below, count)
            w, free, mu = (
                (jacobian * inverse) @ jacobian.T,
                jacobian @ v,
                friction[below[:count]],
            )
            w += 1e-9 * np.diag(np.diag(w))
            free[::2] += gaps[:count] / h
            tried = np.zeros(2 * count)
            if _newton(w, free, mu, press, slide, tried):
                p[:] = tried
            _relax(w, free, mu, p)
            v += inverse * (jacobian.T @ p)
            q += h * v
            for k in range(n):
                relative = q[3 * k + 2] - (q[3 * k - 1] if k else 0.0)
                off = k > 0 and _apart(table, q, k)
                if (
                    abs(q[3 * k + 2]) >= math.pi / 2
                    or abs(relative) >= math.pi / 2
                    or off
                ):
                    return k + 1, i * dt + (j + 1) * h, i + 1
        if i >= last and np.abs(v).max() < 1e-4:
            return 0, math.nan, i + 1
    return 0, math.nan, last + tail


@numba.njit(cache=True)
def _apart(table, q, above):
    """Whether a base no longer lies over the face below."""
    tl = q[3 * above - 1] + table[above - 1, 11]
    tx, ty = math.cos(tl), -math.sin(tl)
    face, base = _ends(table, q, above - 1, 6), _ends(table, q, above, 2)
    low, high = face[:, 0] * tx + face[:, 1] * ty
    left, right = base[:, 0] * tx + base[:, 1] * ty
    return left > high or right < low


def time_stepping(
    body, acceleration, dt, friction, *, step=2e-05, vertical=None, tail=8.0, g=9.81
):
    """Whether, which and when a body fell, and q, v at the samples."""
    table = body_table(as_system(body))
    n = len(table)
    q = np.zeros(3 * n)
    for k in range(n):
        q[3 * k : 3 * k + 2] = table[k, 12:]
    steps = round(tail / dt)
    rows = np.zeros((len(acceleration) + steps, 6 * n))
    values = np.ascontiguousarray(acceleration, dtype=float)
    up = (
        np.zeros_like(values)
        if vertical is None
        else np.ascontiguousarray(vertical, dtype=float)
    )
    fallen, when, count = step_through(
        table, np.array(friction, dtype=float), g, values, up, dt, max(1, math.ceil(dt / step - 1e-9)),
        steps, q, np.zeros(3 * n), rows,
    )  # fmt: skip
    return fallen > 0, fallen, when, rows[:count]
