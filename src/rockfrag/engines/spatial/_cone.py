"""Contact with Coulomb's cone: impulses P and velocities u = W P + b after them (or forces and accelerations).

    u_n ≥ 0,  P_n ≥ 0,  P_n u_n = 0,  |P_t| ≤ µ P_n,  P_t = -µ P_n u_t / |u_t| where u_t ≠ 0

for at most four contacts.  Sets of contacts that push are tried, the smallest first.  Within a set all contacts
stick if the cones allow it; if not, Newton's method on the projections of Alart and Curnier (1991) finds which
slide and where to.
"""

import math

from numba import njit

from rockfrag.engines.spatial._algebra import factor, substitute
from rockfrag.engines.spatial._forces import MOST

ORDER = (0, 1, 2, 4, 8, 3, 5, 6, 9, 10, 12, 7, 11, 13, 14, 15)
"""Sets of four contacts as bits, the smallest first."""

SOFT = 1e-8
"""Part of the largest compliance added while solving, and removed by repetition [-]."""

CLOSE_ENOUGH = 1e-13
"""Residual, relative to what is to be stopped, at which Newton's method ends [-]."""

NEWTON_STEPS = 60


@njit(cache=True)
def compliance(s, n):
    """Return the largest diagonal entry."""
    largest = 0.0
    for i in range(3 * n):
        largest = max(largest, s.delassus[i, i])
    return largest


@njit(cache=True)
def product(s, n, x, out):
    """Fill in out = W x + b."""
    for i in range(3 * n):
        value = s.free[i]
        for j in range(3 * n):
            value += s.delassus[i, j] * x[j]
        out[i] = value


@njit(cache=True)
def in_set(mask, i):
    """Whether contact i belongs to a set."""
    return (mask >> i) & 1


@njit(cache=True)
def stick_together(s, n, mask, soft):
    """Solve for impulses at which all of a set stick (or slide the given way); the others get none."""
    size = 0
    for j in range(n):
        if not in_set(mask, j):
            continue
        for axis in range(2 if s.given[j] else 0, 3):
            row = 0
            for i in range(n):
                if not in_set(mask, i):
                    continue
                for k in range(2 if s.given[i] else 0, 3):
                    value = s.delassus[3 * i + k, 3 * j + axis]
                    if s.given[j]:
                        push = s.delassus[3 * i + k, 3 * j] * s.way[j, 0]
                        push += s.delassus[3 * i + k, 3 * j + 1] * s.way[j, 1]
                        value -= s.friction[j] * push
                    s.matrix[row, size] = value
                    s.right[row] = -s.free[3 * i + k]
                    row += 1
            size += 1
    for i in range(size):
        s.matrix[i, i] += soft
        s.unknown[i] = 0.0
    if not factor(s.matrix, s.order, size):
        return False
    for _ in range(3):
        for i in range(size):
            s.vector[i] = s.right[i] + soft * s.unknown[i]
        substitute(s.matrix, s.order, size, s.vector)
        for i in range(size):
            s.unknown[i] = s.vector[i]
    spread(s, n, mask)
    return True


@njit(cache=True)
def spread(s, n, mask):
    """Write the unknowns of a set to the impulses."""
    row = 0
    for i in range(n):
        for k in range(3):
            s.impulse[3 * i + k] = 0.0
        if not in_set(mask, i):
            continue
        if s.given[i]:
            normal = s.unknown[row]
            s.impulse[3 * i] = -s.friction[i] * normal * s.way[i, 0]
            s.impulse[3 * i + 1] = -s.friction[i] * normal * s.way[i, 1]
            s.impulse[3 * i + 2] = normal
            row += 1
        else:
            for k in range(3):
                s.impulse[3 * i + k] = s.unknown[row]
                row += 1


@njit(cache=True)
def fraction_between(s, first, second, edge):
    """Share the impulse along the edge between two sticking contacts so that both cones hold, if they can."""
    p, along = s.impulse, 0.0
    room_for = (0.0, 0.0)
    for i in (first, second):
        part = p[3 * i] * edge[0] + p[3 * i + 1] * edge[1]
        along += part
        p[3 * i] -= part * edge[0]
        p[3 * i + 1] -= part * edge[1]
        free = (s.friction[i] * p[3 * i + 2]) ** 2 - p[3 * i] ** 2 - p[3 * i + 1] ** 2
        room_for = (room_for[1], math.sqrt(max(free, 0.0)))
    whole = room_for[0] + room_for[1]
    part = 0.5 if whole == 0.0 else room_for[0] / whole
    for k in range(2):
        p[3 * first + k] += part * along * edge[k]
        p[3 * second + k] += (1.0 - part) * along * edge[k]


@njit(cache=True)
def cones_hold(s, n, mask, small):
    """Whether the impulses of a set push, and stay within the cones of the contacts that stick."""
    for i in range(n):
        if in_set(mask, i):
            p = s.impulse[3 * i + 2]
            if p < -small:
                return False
            shear = math.hypot(s.impulse[3 * i], s.impulse[3 * i + 1])
            if not s.given[i] and shear > s.friction[i] * p * (1 + 1e-12) + small:
                return False
    return True


@njit(cache=True)
def residuals(s, n, mask, x, pace, out):
    """Residuals of the projections; return the largest that counts as a velocity."""
    product(s, n, x, s.after)
    worst = 0.0
    for i in range(n):
        a, b, c = 3 * i, 3 * i + 1, 3 * i + 2
        if not in_set(mask, i):
            out[a], out[b], out[c] = x[a], x[b], x[c]
            continue
        out[c] = s.after[c] * pace
        if s.given[i]:
            out[a] = x[a] + s.friction[i] * x[c] * s.way[i, 0]
            out[b] = x[b] + s.friction[i] * x[c] * s.way[i, 1]
        else:
            u, v = x[a] - pace * s.after[a], x[b] - pace * s.after[b]
            limit = s.friction[i] * max(x[c], 0.0)
            size = math.hypot(u, v)
            factor_ = 1.0 if size <= limit else limit / size
            out[a], out[b] = x[a] - factor_ * u, x[b] - factor_ * v
        for k in (a, b, c):
            worst = max(worst, abs(out[k]))
    return worst / pace


@njit(cache=True)
def slopes_in_plane(s, i, x, pace, n):
    """Fill in the rows of the projection's derivative for the shear of a contact that may slide."""
    a, b, c = 3 * i, 3 * i + 1, 3 * i + 2
    u, v = x[a] - pace * s.after[a], x[b] - pace * s.after[b]
    limit = s.friction[i] * max(x[c], 0.0)
    size = math.hypot(u, v)
    if size <= limit:
        for j in range(3 * n):
            s.matrix[a, j] = pace * s.delassus[a, j]
            s.matrix[b, j] = pace * s.delassus[b, j]
        return
    e, f = u / size, v / size
    ratio = limit / size
    for j in range(3 * n):
        du = -pace * s.delassus[a, j] + (1.0 if j == a else 0.0)
        dv = -pace * s.delassus[b, j] + (1.0 if j == b else 0.0)
        along = e * du + f * dv
        grow = s.friction[i] if j == c and x[c] > 0 else 0.0
        s.matrix[a, j] = (1.0 if j == a else 0.0) - ratio * (du - along * e) - grow * e
        s.matrix[b, j] = (1.0 if j == b else 0.0) - ratio * (dv - along * f) - grow * f


@njit(cache=True)
def fill_slopes(s, n, mask, x, pace):
    """Fill in the derivative of the residuals."""
    for i in range(n):
        a, b, c = 3 * i, 3 * i + 1, 3 * i + 2
        for j in range(3 * n):
            for k in (a, b, c):
                s.matrix[k, j] = 1.0 if j == k and not in_set(mask, i) else 0.0
        if not in_set(mask, i):
            continue
        for j in range(3 * n):
            s.matrix[c, j] = pace * s.delassus[c, j]
        if s.given[i]:
            for k in range(2):
                s.matrix[a + k, a + k] = 1.0
                s.matrix[a + k, c] = s.friction[i] * s.way[i, k]
        else:
            slopes_in_plane(s, i, x, pace, n)
        # redundant directions: the step stays where it is
        for k in (a, b, c):
            s.matrix[k, k] += 1e-11


@njit(cache=True)
def newton(s, n, mask, pace, small):
    """Improve s.impulse until the residuals vanish; return whether they do."""
    x = s.impulse
    worst = residuals(s, n, mask, x, pace, s.right)
    for _ in range(NEWTON_STEPS):
        if worst <= small:
            return True
        fill_slopes(s, n, mask, x, pace)
        for i in range(3 * n):
            s.vector[i] = -s.right[i]
        if not factor(s.matrix, s.order, 3 * n):
            return False
        substitute(s.matrix, s.order, 3 * n, s.vector)
        step = 1.0
        for _ in range(12):
            for i in range(3 * n):
                s.trial[i] = x[i] + step * s.vector[i]
            least = residuals(s, n, mask, s.trial, pace, s.right)
            if least < worst * (1 - 0.1 * step) or least <= small:
                break
            step *= 0.5
        for i in range(3 * n):
            x[i] = s.trial[i]
        worst = least
    return worst <= 100 * small


@njit(cache=True)
def start_sliding(s, n, mask, turned):
    """Begin with each contact of a set stopped alone, sliding the way it came, turned by an angle."""
    for i in range(n):
        a = 3 * i
        for k in range(3):
            s.impulse[a + k] = 0.0
        if not in_set(mask, i):
            continue
        normal = max(-s.free[a + 2], 0.0) / s.delassus[a + 2, a + 2]
        u, v = s.free[a], s.free[a + 1]
        size = max(math.hypot(u, v), 1e-300)
        e, f = u / size, v / size
        e, f = (
            e * math.cos(turned) - f * math.sin(turned),
            e * math.sin(turned) + f * math.cos(turned),
        )
        if s.given[i]:
            e, f = s.way[i, 0], s.way[i, 1]
        s.impulse[a] = -s.friction[i] * normal * e
        s.impulse[a + 1] = -s.friction[i] * normal * f
        s.impulse[a + 2] = normal


@njit(cache=True)
def others_open(s, n, mask, small):
    """Whether contacts outside of a set do not approach."""
    product(s, n, s.impulse, s.after)
    approaching = 0
    for i in range(n):
        approaching += not in_set(mask, i) and s.after[3 * i + 2] < -small
    return approaching == 0


@njit(cache=True)
def clip_to_cones(s, n, mask):
    """Shorten shears to the cones, from which Newton's method then begins."""
    for i in range(n):
        if in_set(mask, i) and not s.given[i]:
            a = 3 * i
            limit = s.friction[i] * max(s.impulse[a + 2], 0.0)
            size = math.hypot(s.impulse[a], s.impulse[a + 1])
            if size > limit:
                s.impulse[a] *= limit / size
                s.impulse[a + 1] *= limit / size


@njit(cache=True)
def bits(mask):
    """Return the number of contacts in a set."""
    return (mask & 1) + ((mask >> 1) & 1) + ((mask >> 2) & 1) + ((mask >> 3) & 1)


@njit(cache=True)
def solve_set(s, n, mask, scale):
    """Solve for one set; return whether all of it pushes and nothing else approaches."""
    if mask == 0:
        for i in range(3 * n):
            s.impulse[i] = 0.0
        return others_open(s, n, mask, 1e-11 * scale)
    largest = compliance(s, n)
    small = 1e-11 * scale
    if not stick_together(s, n, mask, SOFT * largest):
        return False
    if bits(mask) == 2:
        fraction_in_set(s, n, mask)
    if cones_hold(s, n, mask, small / largest):
        return others_open(s, n, mask, small)
    pace = 1.0 / largest
    clip_to_cones(s, n, mask)
    found = newton(s, n, mask, pace, CLOSE_ENOUGH * scale)
    for k in range(4):
        if found and cones_hold(s, n, mask, small / largest):
            break
        start_sliding(s, n, mask, 1.5707963267948966 * k)
        found = newton(s, n, mask, pace, CLOSE_ENOUGH * scale)
    if not (found and cones_hold(s, n, mask, small / largest)):
        return False
    return others_open(s, n, mask, small)


@njit(cache=True)
def fraction_in_set(s, n, mask):
    """Share along the edge between the two contacts of a set, if both may stick."""
    first, second = -1, -1
    for i in range(n):
        if in_set(mask, i):
            if s.given[i]:
                return
            if first < 0:
                first = i
            else:
                second = i
    fraction_between(s, first, second, (s.edge[first, second, 0], s.edge[first, second, 1]))


@njit(cache=True)
def scale_of(s, n):
    """Largest velocity (or acceleration) that there is to stop."""
    largest = 1e-300
    for i in range(3 * n):
        largest = max(largest, abs(s.free[i]))
    return largest


@njit(cache=True)
def energy_left(s, n):
    """Change of kinetic energy by the impulses: P·b + P·W P / 2."""
    change = 0.0
    for i in range(3 * n):
        change += 0.5 * s.impulse[i] * (s.free[i] + s.after[i])
    return change


@njit(cache=True)
def solve_cones(s, n, least):
    """Find the impulses: the fewest contacts that push, and of those the least energy.

    Parameters
    ----------
    s
        With Delassus matrix, free velocities, friction, given ways of slip, and directions between contacts.
    n
        Number of contacts.
    least
        Least number of contacts that push.

    Returns
    -------
    The set that pushes as bits (-1 if none was found), and how many sets of that size would do.
    """
    scale = scale_of(s, n)
    chosen, ways, size_found, lowest = -1, 0, 99, 0.0
    for k in range(1 << MOST):
        mask = ORDER[k]
        size = bits(mask)
        if mask >= (1 << n) or size < least or size > size_found:
            continue
        if solve_set(s, n, mask, scale):
            ways += 1
            change = energy_left(s, n)
            if chosen < 0 or change < lowest - 1e-12 * scale * scale:
                chosen, lowest, size_found = mask, change, size
                for i in range(3 * n):
                    s.best[i] = s.impulse[i]
    if chosen >= 0:
        for i in range(3 * n):
            s.impulse[i] = s.best[i]
        product(s, n, s.impulse, s.after)
    return chosen, ways
