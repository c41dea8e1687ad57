"""Solving the equations of a mode: forces at closed contacts from the motion that they must bring about.

In: rows (motion at a contact per coordinate of both its bodies), columns (what a force does to them) and
right-hand sides of each contact, at most three.  Out: the forces and how they change the motion
(``docs/contact.md``, 3).

A column of bodies is a chain: what hangs on a body from above resists its motion like one body of another
inertia (Featherstone, Rigid Body Dynamics Algorithms, 2008, chapter 7).  So contacts are eliminated from the
uppermost down, and what is above the first contact that has changed since the last solution stands.  Contacts
with walls close the chain to loops; their equations are solved all together.
"""

from rockfrag.engines.algebra.vectors import (
    cross,
    dot,
    minus,
    plus,
    rows_times,
    scaled,
    times_rows,
)
from rockfrag.engines.compile.jit import inlined_kernel, kernel

SINGULAR = 1e-9
"""Pivot over the largest coefficient of its equation below which equations say the same thing twice."""
SMALL = 1e-7  # determinant over its terms below which a body is not taken to yield
NOTHING = (0.0, 0.0, 0.0)
SAME = (
    (1.0, 0.0, 0.0),
    (0.0, 1.0, 0.0),
    (0.0, 0.0, 1.0),
)  # motion of a body that is carried along


@kernel
def solve_equations(p, w, q, standing, changed):
    """Find ``w.force`` and ``w.moved``, the change of motion of all bodies that move; False if singular.

    Parameters
    ----------
    p, w : records ``BODY`` and ``WORK``, with the equations of each contact in ``w``
    q : coordinates, x, y [m] and θ [rad] of each body, shape (3 MOST,)
    standing : number of bodies, from below, that do not move
    changed : uppermost contact of the column whose equations are not those of the last call
    """
    if _is_chain(p, w):
        solved = True
        for k in range(changed, standing - 1, -1):
            solved = solved and _eliminate_contact(p, w, q, k, k > standing)
        if solved:
            _substitute(p, w, standing)
            return True
    # the next call must eliminate all contacts anew
    w.listed[:] = -1
    return _solve_jointly(p, w, standing)


@inlined_kernel
def _is_chain(p, w):
    """Whether no contact with a wall has equations."""
    alone = True
    for k in range(p.count, p.contacts):
        alone = alone and w.unknowns[k] == 0
    return alone


@inlined_kernel
def _vector(a, i, first):
    """Three entries of row i, from the ``first`` on."""
    return a[i, first], a[i, first + 1], a[i, first + 2]


@inlined_kernel
def _matrix(a, k):
    """Rows of matrix k."""
    return (
        (a[k, 0, 0], a[k, 0, 1], a[k, 0, 2]),
        (a[k, 1, 0], a[k, 1, 1], a[k, 1, 2]),
        (a[k, 2, 0], a[k, 2, 1], a[k, 2, 2]),
    )


@inlined_kernel
def _eliminate_contact(p, w, q, k, on_body):
    """Eliminate contact k, under all that hangs on its body; False if it is singular.

    Equation 3' of ``docs/contact.md``: a body and all above ask F = J a + w of the contact at its base, with its
    motion a. The contact lets it move as a = T X a' + t, with X a' its motion if it were welded to the body below,
    whose motion is a'. ``w.follows`` has T X, ``w.still`` t, ``w.inertia`` J, ``w.asks`` w.
    """
    if k == p.count - 1:
        _hang_nothing(p, w, k)
    inertia, asks = _matrix(w.inertia, k), _vector(w.asks, k, 0)
    size, follows = w.unknowns[k], SAME
    if size == 3:
        solved, still = _hold(w, k, p.size)
    elif size == 2:
        solved, still, follows = _leave_one_way(w, k, inertia, asks)
    else:
        solved, still, follows = _press_once(w, k, size, inertia, asks)
    if not solved:
        return False
    w.still[k, 0], w.still[k, 1], w.still[k, 2] = still
    if on_body:
        _hang_on_below(p, w, q, k, follows)
    return True


@inlined_kernel
def _hang_nothing(p, w, k):
    """Let body k resist by its own inertia alone."""
    own = p.mass[k], p.mass[k], p.inertia[k]
    for d in range(3):
        w.asks[k, d] = 0.0
        for e in range(3):
            w.inertia[k, d, e] = own[d] if d == e else 0.0


@inlined_kernel
def _hold(w, k, size):
    """Whether three equations hold a body, and t of its motion; T is 1. ``size``: a length of the bodies [m]."""
    at = 3 * k
    first, second = _vector(w.row, at, 3), _vector(w.row, at + 1, 3)
    third = _vector(w.row, at + 2, 3)
    across = cross(second, third)
    whole = dot(first, across)
    if not abs(whole) > SINGULAR * size:
        return False, NOTHING
    part = 1.0 / whole
    still = scaled(part * w.right[at], across)
    still = plus(still, scaled(part * w.right[at + 1], cross(third, first)))
    still = plus(still, scaled(part * w.right[at + 2], cross(first, second)))
    return True, still


@inlined_kernel
def _leave_one_way(w, k, inertia, asks):
    """Whether two equations can be solved, and t and T of the motion that they leave.

    The body moves as they ask plus s S, where S breaks neither and s is such that Z (J a + w) = 0, where Z meets
    neither force.
    """
    at = 3 * k
    first, second = _vector(w.row, at, 3), _vector(w.row, at + 1, 3)
    way = cross(first, second)
    idle = cross(_vector(w.column, at, 3), _vector(w.column, at + 1, 3))
    idle_inertia = times_rows(idle, inertia)
    resists = dot(idle_inertia, way)
    size = abs(idle_inertia[0] * way[0]) + abs(idle_inertia[1] * way[1])
    if not abs(resists) > SINGULAR * (size + abs(idle_inertia[2] * way[2])):
        return False, NOTHING, SAME
    part = 1.0 / dot(way, way)
    asked = scaled(part * w.right[at], cross(second, way))
    asked = plus(asked, scaled(part * w.right[at + 1], cross(way, first)))
    pivot = 1.0 / resists
    still = minus(
        asked, scaled(pivot * (dot(idle_inertia, asked) + dot(idle, asks)), way)
    )
    follows = (
        minus(SAME[0], scaled(pivot * way[0], idle_inertia)),
        minus(SAME[1], scaled(pivot * way[1], idle_inertia)),
        minus(SAME[2], scaled(pivot * way[2], idle_inertia)),
    )
    return True, still, follows


@inlined_kernel
def _press_once(w, k, size, inertia, asks):
    """Whether one equation or none can be solved, and t and T of the motion that it leaves.

    With K = 1/J, row c and column d its force is (r + c K w + c X a') / (c K d).
    """
    by_x, by_y = cross(inertia[1], inertia[2]), cross(inertia[2], inertia[0])
    by_turn = cross(inertia[0], inertia[1])
    # K is these cofactors over the determinant
    cofactors = by_x, by_y, by_turn
    whole = dot(inertia[2], by_turn)
    largest = abs(inertia[0][0] * by_x[0]) + abs(inertia[1][1] * by_y[1])
    if not abs(whole) > SMALL * (largest + abs(inertia[2][2] * by_turn[2])):
        return False, NOTHING, SAME
    part = 1.0 / whole
    falls = times_rows(scaled(-part, asks), cofactors)
    if size == 0:
        return True, falls, (NOTHING, NOTHING, NOTHING)
    row = _vector(w.row, 3 * k, 3)
    yields = times_rows(scaled(part, _vector(w.column, 3 * k, 3)), cofactors)
    pivot = dot(row, yields)
    if pivot == 0.0:
        return False, NOTHING, SAME
    light = 1.0 / pivot
    still = minus(falls, scaled(light * (dot(row, falls) - w.right[3 * k]), yields))
    follows = (
        scaled(light * yields[0], row),
        scaled(light * yields[1], row),
        scaled(light * yields[2], row),
    )
    return True, still, follows


@inlined_kernel
def _hang_on_below(p, w, q, k, follows):
    """Keep T X, and hang body k on the body below: J' = M + Xᵀ J T X and w' = Xᵀ (J t + w)."""
    inertia, still = _matrix(w.inertia, k), _vector(w.still, k, 0)
    across, up = q[3 * k] - q[3 * k - 3], q[3 * k + 1] - q[3 * k - 2]
    asks = plus(rows_times(inertia, still), _vector(w.asks, k, 0))
    _hang_nothing(p, w, k - 1)
    if w.unknowns[k] == 0:
        asks = NOTHING
    w.asks[k - 1, 0], w.asks[k - 1, 1] = asks[0], asks[1]
    w.asks[k - 1, 2] = asks[2] + up * asks[0] - across * asks[1]
    for d in range(3):
        row = follows[d]
        w.follows[k, d, 0], w.follows[k, d, 1] = row[0], row[1]
        w.follows[k, d, 2] = row[2] + up * row[0] - across * row[1]
    if w.unknowns[k] == 0:
        return
    moves = _matrix(w.follows, k)
    by_x, by_y = times_rows(inertia[0], moves), times_rows(inertia[1], moves)
    by_turn = times_rows(inertia[2], moves)
    for d in range(3):
        w.inertia[k - 1, 0, d] += by_x[d]
        w.inertia[k - 1, 1, d] += by_y[d]
        w.inertia[k - 1, 2, d] += by_turn[d] + up * by_x[d] - across * by_y[d]


@kernel
def _substitute(p, w, standing):
    """Changes of motion and forces from the lowest contact up, of what :func:`_eliminate_contact` has left."""
    moved = NOTHING
    for k in range(standing, p.count):
        at, still = 3 * k, _vector(w.still, k, 0)
        moved = (
            plus(still, rows_times(_matrix(w.follows, k), moved))
            if k > standing
            else still
        )
        w.moved[at], w.moved[at + 1], w.moved[at + 2] = moved
        if w.unknowns[k] == 0:
            continue
        asked = plus(rows_times(_matrix(w.inertia, k), moved), _vector(w.asks, k, 0))
        # forces whose columns add up to what is asked
        first = _vector(w.column, at, 3)
        if w.unknowns[k] == 1:
            w.force[at] = dot(asked, first) / dot(first, first)
            continue
        second = _vector(w.column, at + 1, 3)
        third = _vector(w.column, at + 2, 3)
        across = cross(first, second)
        if w.unknowns[k] == 2:
            third = across
        part = 1.0 / dot(across, third)
        w.force[at] = part * dot(asked, cross(second, third))
        w.force[at + 1] = part * dot(asked, cross(third, first))
        w.force[at + 2] = part * dot(asked, across)


@kernel
def _solve_jointly(p, w, standing):
    """Solve all equations at once, whatever bodies they share: (C M⁻¹ D) λ = r in ``w.matrix`` and ``w.joint``.

    Returned is False if they are singular; forces and motion go where :func:`solve_equations` says.
    """
    m = 0
    for k in range(standing, p.contacts):
        for i in range(3 * k, 3 * k + w.unknowns[k]):
            w.place[m] = i
            w.joint[m] = w.right[i]
            m += 1
    for i in range(m):
        at = w.place[i]
        k = at // 3
        begin, base = 0, 3 * p.upper[k] - 3
        if k == standing or p.lower[k] < 0:
            begin = 3
        w.largest[i] = 0.0
        for j in range(m):
            # row i and column j share bodies where their places, shifted by the bodies between, overlap
            other = w.place[j]
            total, shift = 0.0, 3 * (p.upper[other // 3] - p.upper[k])
            for d in range(max(begin, shift), min(6, 6 + shift)):
                total += w.row[at, d] * p.inverse[base + d] * w.column[other, d - shift]
            w.matrix[i, j] = total
            w.largest[i] = max(w.largest[i], abs(total))
    if not _eliminate(w, m, 0.0 if _is_chain(p, w) else SINGULAR):
        return False
    for d in range(3 * standing, 3 * p.count):
        w.moved[d] = 0.0
    for i in range(m):
        at, force = w.place[i], w.joint[i]
        k = at // 3
        w.force[at] = force
        begin, base = 0, 3 * p.upper[k] - 3
        if k == standing or p.lower[k] < 0:
            begin = 3
        for d in range(begin, 6):
            w.moved[base + d] += p.inverse[base + d] * w.column[at, d] * force
    return True


@kernel
def _eliminate(w, m, singular):
    """Solve m equations by Gauss's elimination with row exchange, in place, into ``w.joint``.

    Returned is False if a pivot is less than ``singular`` times the largest coefficient of its equation.
    """
    a, right = w.matrix, w.joint
    for i in range(m):
        best = i
        for j in range(i + 1, m):
            if abs(a[j, i]) > abs(a[best, i]):
                best = j
        if a[best, i] == 0.0 or abs(a[best, i]) < singular * w.largest[best]:
            # walls and faces may ask for the same thing twice
            return False
        if best != i:
            for j in range(i, m):
                a[i, j], a[best, j] = a[best, j], a[i, j]
            right[i], right[best] = right[best], right[i]
            w.largest[i], w.largest[best] = w.largest[best], w.largest[i]
        pivot = 1.0 / a[i, i]
        for j in range(i + 1, m):
            factor = a[j, i] * pivot
            if factor != 0.0:
                for c in range(i + 1, m):
                    a[j, c] -= factor * a[i, c]
                right[j] -= factor * right[i]
    for i in range(m - 1, -1, -1):
        total = right[i]
        for j in range(i + 1, m):
            total -= a[i, j] * right[j]
        right[i] = total / a[i, i]
    return True
