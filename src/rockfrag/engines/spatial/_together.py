"""Contacts that stick at once: the impulses that stop them, and how those that hold the same thing share it.

In: fields of the record ``CASE`` for n contacts: ``delassus``, W [-, for a unit of mass], ``free``, the velocities
b without impulses [m/s], ``given`` and ``way``, what slides and where to. Out: ``impulse`` [m/s]; or accelerations
and forces. Theory: ``docs/space.md``, equations 10, 14 and 15.

Contact k has the rows 3 k, 3 k + 1 (along) and 3 k + 2 (away); a set is a ``mask`` of bits.
"""

from rockfrag.engines.algebra.vectors import (
    dot,
    factor,
    norm,
    plus,
    scaled,
    solve_symmetric,
    substitute,
)
from rockfrag.engines.compile.jit import kernel
from rockfrag.engines.spatial._case import in_set

LEAST_LOAD = 0.03  # part of all normal impulses that a contact counts with at least where they share [-]
PASSES = 3  # in which what the softness shifts is removed (equation 15)


@kernel
def stick_together(s, n, mask, soft):
    """Solve for the impulses at which all of a set stick, or slide the given way; fill s.impulse, others 0.

    Unknowns are three of a contact that sticks, and the normal one of a contact that slides, with which its
    friction goes. They are solved for as those of soft contacts (``docs/space.md``, equation 15), ``soft`` the
    softness. What several contacts hold together is shared anew, by what each is pressed with, where one would
    bear more shear than that allows. Returned is whether there is a solution.
    """
    for i in range(n):
        s.yields[i] = 1.0
    done = False
    for _ in range(2):
        done = hold_softly(s, n, mask, soft)
        if not (done and yields_by_load(s, n, mask)):
            break
    return done


@kernel
def yields_by_load(s, n, mask):
    """Fill s.yields of a set by the normal impulses; return whether one that sticks bears too much shear.

    The softness along the surface is as the square of the mean normal impulse over a contact's own: the sum of the
    squares of what each uses of its friction is then the least.
    """
    total, size, beyond = 0.0, 0, False
    for i in range(n):
        if in_set(mask, i) and not s.given[i]:
            normal = max(s.impulse[3 * i + 2], 0.0)
            shear = norm(s.impulse[3 * i], s.impulse[3 * i + 1])
            beyond = beyond or shear > s.holds[i] * normal
            total += normal
            size += 1
    if not beyond or size < 2 or total <= 0.0:
        return False
    for i in range(n):
        normal = max(s.impulse[3 * i + 2], LEAST_LOAD * total)
        s.yields[i] = 1.0 if s.given[i] else (total / (size * normal)) ** 2
    return True


@kernel
def hold_softly(s, n, mask, soft):
    """Solve for the impulses of :func:`stick_together`, contacts as soft along their surface as s.yields says."""
    size = 0
    for j in range(n):
        if not in_set(mask, j):
            continue
        for axis in range(2 if s.given[j] else 0, 3):
            row = 0
            for i in range(n):
                if not in_set(mask, i):
                    continue
                # conditions of contact i: no velocity, or, where it slides, none away from its surface
                for k in range(2 if s.given[i] else 0, 3):
                    value = s.delassus[3 * i + k, 3 * j + axis]
                    if s.given[j]:
                        push = s.delassus[3 * i + k, 3 * j] * s.way[j, 0]
                        push += s.delassus[3 * i + k, 3 * j + 1] * s.way[j, 1]
                        value -= s.friction[j] * push
                    s.matrix[row, size] = value
                    s.right[row] = -s.free[3 * i + k]
                    row += 1
            s.softness[size] = soft * (s.yields[j] if axis < 2 else 1.0)
            size += 1
    for i in range(size):
        s.matrix[i, i] += s.softness[i]
        s.unknown[i] = 0.0
    done = factor(s.matrix, s.order, size)
    # what the softness shifts one more pass with it as a reference removes
    for _ in range(PASSES if done else 0):
        for i in range(size):
            s.vector[i] = s.right[i] + s.softness[i] * s.unknown[i]
        substitute(s.matrix, s.order, size, s.vector)
        for i in range(size):
            s.unknown[i] = s.vector[i]
    spread(s, n, mask)
    return done


@kernel
def push_by_two(s, sticks, slides, way, grip):
    """Impulse at which contact ``sticks`` sticks, beside contact ``slides`` that slides along ``way``.

    With the coefficient ``grip`` this is equation 14 (``docs/space.md``), with contact 1 that sticks. Returned are
    P_1, (3,); the normal impulse N at the other; and f, (3,), with P_2 = N f.
    """
    w, a, b = s.delassus, 3 * sticks, 3 * slides
    unit = (-grip * way[0], -grip * way[1], 1.0)
    # P_1 = without + N by_unit
    without = stop_at(w, a, (s.free[a], s.free[a + 1], s.free[a + 2]))
    by_unit = stop_at(w, a, effect(w, a, b, unit))
    # velocity of the other away from its surface, without N and by a unit of it
    left = s.free[b + 2] + dot(row_of(w, b + 2, a), without)
    gives = dot(row_of(w, b + 2, b), unit) + dot(row_of(w, b + 2, a), by_unit)
    normal = -left / gives
    return plus(without, scaled(normal, by_unit)), normal, unit


@kernel
def row_of(w, i, b):
    """Entries i, b to b + 2 of W: what impulses at the contact whose first row is b do to the velocity i."""
    return (w[i, b], w[i, b + 1], w[i, b + 2])


@kernel
def effect(w, a, b, push):
    """Velocity of the contact whose first row in W is a, by an impulse ``push`` at that whose first row is b."""
    return (
        dot(row_of(w, a, b), push),
        dot(row_of(w, a + 1, b), push),
        dot(row_of(w, a + 2, b), push),
    )


@kernel
def stop_at(w, a, velocity):
    """Impulse at the contact whose first row in W is a that takes a velocity of it away: -W_aa⁻¹ velocity."""
    return solve_symmetric(
        w[a, a], w[a, a + 1], w[a, a + 2], w[a + 1, a + 1], w[a + 1, a + 2],
        w[a + 2, a + 2], scaled(-1.0, velocity),
    )  # fmt: skip


@kernel
def spread(s, n, mask):
    """Write s.unknown, the unknowns of a set in :func:`stick_together`, to s.impulse, three a contact."""
    row = 0
    for i in range(n):
        x = y = z = 0.0
        if in_set(mask, i) and s.given[i]:
            z = s.unknown[row]
            x, y = -s.friction[i] * z * s.way[i, 0], -s.friction[i] * z * s.way[i, 1]
            row += 1
        elif in_set(mask, i):
            x, y, z = s.unknown[row], s.unknown[row + 1], s.unknown[row + 2]
            row += 3
        s.impulse[3 * i], s.impulse[3 * i + 1], s.impulse[3 * i + 2] = x, y, z
