"""Solving the equations of a mode: forces at closed contacts from the motion that they must bring about.

In: rows (motion at a contact per coordinate of both its bodies), columns (what a force does to them) and
right-hand sides of each contact, at most three.  Out: the forces and how they change the motion
(``docs/contact.md``, 3).

A column of bodies is a chain: what hangs on a body from above answers a force at its base like one body of another
compliance.  So contacts are eliminated from the uppermost down, each by at most three equations, and what is above
the first contact that has changed since the last solution stands.  Contacts with walls close the chain to loops;
their equations are solved all together.

``p`` and ``w`` are records ``BODY`` and ``WORK`` (``records.py``). Equations of contact k begin at 3 k; places of
a row or a column are the coordinates x, y and θ of the body below (0 to 2) and of that above (3 to 5).
"""

from rockfrag.engines.compile.jit import inlined_kernel, kernel

SINGULAR = 1e-9
"""Pivot over the largest coefficient of its equation below which equations say the same thing twice."""
SMALL = 1e-7  # pivot over its coefficient before elimination below which contacts are not eliminated one by one


@kernel
def solve_equations(p, w, standing, changed):
    """Find forces ``w.force`` and the change of motion ``w.moved`` of all above what stands; False if singular.

    ``standing``: number of bodies from below that stand still; ``changed``: the uppermost contact of the column
    whose equations are not those of the last call.
    """
    if _is_chain(p, w):
        solved = True
        for k in range(changed, standing - 1, -1):
            solved = solved and _eliminate_contact(p, w, k, k > standing)
        if solved:
            _substitute(p, w, standing)
            return True
    # nothing of the chain stands for the next call
    w.listed[:] = -1
    return _solve_jointly(p, w, standing)


@inlined_kernel
def _is_chain(p, w):
    """Whether no contact with a wall has equations."""
    alone = True
    for k in range(p.count, p.contacts):
        alone = alone and w.unknowns[k] == 0
    return alone


@kernel
def _eliminate_contact(p, w, k, on_body):
    """Eliminate the forces of contact k, under all that hangs on its body; False if singular.

    Equation 3' of ``docs/contact.md``: A λ = r - C e - C' M⁻¹ F, with K the compliance of body k and all above, e
    its motion by forces above, M the mass below, F the force at its base, C and D rows and columns at body k, C'
    and D' at the body below. So λ = g - H F: ``w.gain`` has g = A⁻¹ (r - C e), ``w.shared`` H = A⁻¹ C' M⁻¹.
    """
    size = w.unknowns[k]
    if k == p.count - 1:
        _hang_nothing(p, w, k)
    _fill_small(p, w, k, on_body)
    if not _reduce(w.small, size, 7 if on_body else 4):
        return False
    for i in range(size):
        w.gain[3 * k + i] = w.small[i, 3]
    if on_body:
        _hang_on_below(p, w, k)
    return True


@inlined_kernel
def _hang_nothing(p, w, k):
    """Fill compliance K and motion e of the uppermost body, k: its own inverse masses, and none."""
    for d in range(3):
        w.hanging[k, d] = 0.0
        for e in range(3):
            w.compliance[k, d, e] = p.inverse[3 * k + d] if d == e else 0.0


@inlined_kernel
def _fill_small(p, w, k, on_body):
    """Fill ``w.small``, the small system of contact k: A in columns 0 to 2, r - C e in 3, and C' M⁻¹ in 4 to 6.

    The last ones only where the contact is ``on_body``, not on the ground. Letters as of
    :func:`_eliminate_contact`.
    """
    size, first, lower = w.unknowns[k], 3 * k, 3 * k - 3
    small = w.small
    for j in range(size):
        # K D
        at = first + j
        x, y, turn = w.column[at, 3], w.column[at, 4], w.column[at, 5]
        for d in range(3):
            w.yields_to[j, d] = (
                w.compliance[k, d, 0] * x
                + w.compliance[k, d, 1] * y
                + w.compliance[k, d, 2] * turn
            )
    for i in range(size):
        at = first + i
        x, y, turn = w.row[at, 3], w.row[at, 4], w.row[at, 5]
        hangs = x * w.hanging[k, 0] + y * w.hanging[k, 1] + turn * w.hanging[k, 2]
        small[i, 3] = w.right[at] - hangs
        for j in range(size):
            moves = w.yields_to[j, 0], w.yields_to[j, 1], w.yields_to[j, 2]
            small[i, j] = x * moves[0] + y * moves[1] + turn * moves[2]
        if on_body:
            for d in range(3):
                small[i, 4 + d] = w.row[at, d] * p.inverse[lower + d]
            for j in range(size):
                for d in range(3):
                    small[i, j] += small[i, 4 + d] * w.column[first + j, d]


@inlined_kernel
def _hang_on_below(p, w, k):
    """Keep H, and hang body k on the body below: compliance M⁻¹ (1 - D' H), motion M⁻¹ D' g.

    Letters as of :func:`_eliminate_contact`; ``w.small`` has been solved, so that its column 3 holds g and columns
    4 to 6 hold H.
    """
    size, first = w.unknowns[k], 3 * k
    small = w.small
    for i in range(size):
        for d in range(3):
            w.shared[first + i, d] = small[i, 4 + d]
    for d in range(3):
        light = p.inverse[first - 3 + d]
        hangs, by_x, by_y, by_turn = 0.0, 0.0, 0.0, 0.0
        for j in range(size):
            by = light * w.column[first + j, d]
            hangs += by * small[j, 3]
            by_x -= by * small[j, 4]
            by_y -= by * small[j, 5]
            by_turn -= by * small[j, 6]
        w.hanging[k - 1, d] = hangs
        w.compliance[k - 1, d, 0] = by_x
        w.compliance[k - 1, d, 1] = by_y
        w.compliance[k - 1, d, 2] = by_turn
        w.compliance[k - 1, d, d] += light


@inlined_kernel
def _reduce(a, size, width):
    """Solve at most three equations by Gauss's elimination; False if they are singular.

    Row i of ``a`` has the coefficients of equation i in columns 0 to 2, and its right-hand sides from column 3 to
    ``width`` - 1, which become the solutions. Two equations exchange rows for the larger pivot; three do not: they
    are those of a contact that sticks, symmetric but for what slides above.
    """
    if size == 1:
        return _reduce_one(a, width)
    if size == 2:
        return _reduce_two(a, width)
    if size == 3:
        return _reduce_three(a, width)
    return True


@inlined_kernel
def _reduce_one(a, width):
    """Solve one equation as :func:`_reduce` does."""
    if a[0, 0] == 0.0:
        return False
    pivot = 1.0 / a[0, 0]
    for c in range(3, width):
        a[0, c] *= pivot
    return True


@inlined_kernel
def _reduce_two(a, width):
    """Solve two equations as :func:`_reduce` does; row i has the larger pivot.

    ``b`` has the coefficients in that order, ``c11`` is that of the second equation after elimination.
    """
    swap = abs(a[1, 0]) > abs(a[0, 0])
    i, j = (1, 0) if swap else (0, 1)
    b00, b01, b10, b11 = a[i, 0], a[i, 1], a[j, 0], a[j, 1]
    if b00 == 0.0:
        return False
    p0 = 1.0 / b00
    f1 = b10 * p0
    c11 = b11 - f1 * b01
    if not abs(c11) > SINGULAR * (abs(b11) + abs(f1 * b01)):
        return False
    p1 = 1.0 / c11
    for c in range(3, width):
        top = a[i, c]
        bottom = (a[j, c] - f1 * top) * p1
        a[0, c], a[1, c] = (top - b01 * bottom) * p0, bottom
    return True


@inlined_kernel
def _reduce_three(a, width):
    """Solve three equations as :func:`_reduce` does, without exchange; False where a pivot is small.

    ``b`` has the coefficients, ``c`` and ``d`` those of the second and third equation after one and two
    eliminations, ``f`` the factors of equations that are taken off, ``p`` one over each pivot.
    """
    b00, b01, b02 = a[0, 0], a[0, 1], a[0, 2]
    b10, b11, b12 = a[1, 0], a[1, 1], a[1, 2]
    b20, b21, b22 = a[2, 0], a[2, 1], a[2, 2]
    if not abs(b00) > SMALL * (abs(b01) + abs(b02)):
        return False
    p0 = 1.0 / b00
    f1, f2 = b10 * p0, b20 * p0
    c11, c12 = b11 - f1 * b01, b12 - f1 * b02
    c21, c22 = b21 - f2 * b01, b22 - f2 * b02
    if not abs(c11) > SMALL * (abs(b11) + abs(c12)):
        return False
    p1 = 1.0 / c11
    f3 = c21 * p1
    d22 = c22 - f3 * c12
    if not abs(d22) > SMALL * abs(b22):
        return False
    p2 = 1.0 / d22
    for c in range(3, width):
        top = a[0, c]
        middle = a[1, c] - f1 * top
        bottom = (a[2, c] - f2 * top - f3 * middle) * p2
        middle = (middle - c12 * bottom) * p1
        a[2, c], a[1, c] = bottom, middle
        a[0, c] = (top - b01 * middle - b02 * bottom) * p0
    return True


@kernel
def _substitute(p, w, standing):
    """Forces and changes of motion from the lowest contact up, of what :func:`_eliminate_contact` has left.

    Each force at contact k is ``w.gain`` less ``w.shared`` times what the contact below does to the body between.
    """
    # force and moment of a contact on the body above it; columns 0 to 2 of ``w.column`` are of the body below
    push_x = push_y = twist = 0.0
    for k in range(standing, p.count):
        first, body = 3 * k, 3 * k
        own_x = own_y = own_twist = 0.0
        for i in range(first, first + w.unknowns[k]):
            force = w.gain[i]
            if k > standing:
                force -= w.shared[i, 0] * push_x + w.shared[i, 1] * push_y
                force -= w.shared[i, 2] * twist
            w.force[i] = force
            own_x += w.column[i, 3] * force
            own_y += w.column[i, 4] * force
            own_twist += w.column[i, 5] * force
            if k > standing:
                for d in range(3):
                    w.moved[body - 3 + d] += (
                        p.inverse[body - 3 + d] * w.column[i, d] * force
                    )
        push_x, push_y, twist = own_x, own_y, own_twist
        w.moved[body] = p.inverse[body] * push_x
        w.moved[body + 1] = p.inverse[body + 1] * push_y
        w.moved[body + 2] = p.inverse[body + 2] * twist


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
