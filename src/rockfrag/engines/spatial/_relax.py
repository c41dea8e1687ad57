"""Impulses within all cones, one contact after the other, of contacts that share what they hold together.

A corner at a wall may hold what the friction of a foot holds too. Linear equations know one way to share such a
load, which may lie outside a cone though others lie within. Gauss and Seidel's method comes to one of these, if
slowly.

In: the small system of contacts of ``_cone``, with the impulses to begin from. Out: impulses within the cones.
Theory: ``docs/space.md``, equation 24 without gaps.
"""

from rockfrag.engines.algebra.vectors import norm
from rockfrag.engines.compile.jit import kernel

MOST_ROUNDS = 1000  # in each of which every contact has its turn


@kernel
def relax(s, n, settled):
    """Correct s.impulse of n contacts, within their cones, until they stop them; return whether they do.

    What sticks has the coefficient s.grip, what slides a given way s.friction. It ends where no correction changes
    a velocity by more than ``settled`` [m/s].
    """
    for _ in range(MOST_ROUNDS):
        worst = 0.0
        for i in range(n):
            worst = max(worst, correct_normal(s, n, i), correct_shear(s, n, i))
        if worst <= settled:
            return True
    return False


@kernel
def stops(s, n, small):
    """Whether no contact that sticks moves, and none that slides leaves, faster than ``small`` [m/s]."""
    held = True
    for i in range(n):
        for k in range(3):
            if k == 2 or not s.given[i]:
                held = held and abs(velocity_after(s, n, 3 * i + k)) <= small
    return held


@kernel
def velocity_after(s, n, row):
    """Velocity, (W P + b) in one row, after the impulses of n contacts [m/s]."""
    value = s.free[row]
    for j in range(3 * n):
        value += s.delassus[row, j] * s.impulse[j]
    return value


@kernel
def correct_normal(s, n, i):
    """Correct the normal impulse of contact i; return by how much as a velocity [m/s]."""
    c = 3 * i + 2
    soft, before = s.delassus[c, c], s.impulse[c]
    s.impulse[c] = max(before - velocity_after(s, n, c) / soft, 0.0)
    return abs(s.impulse[c] - before) * soft


@kernel
def correct_shear(s, n, i):
    """Correct the impulse of contact i along its surface, as its normal one allows; return by how much [m/s]."""
    a, b = 3 * i, 3 * i + 1
    # one compliance for both: the larger one, which corrects too little rather than much
    soft = max(s.delassus[a, a], s.delassus[b, b])
    normal, x, y = s.impulse[3 * i + 2], s.impulse[a], s.impulse[b]
    if s.given[i]:
        s.impulse[a] = -s.friction[i] * normal * s.way[i, 0]
        s.impulse[b] = -s.friction[i] * normal * s.way[i, 1]
    else:
        u, v = x - velocity_after(s, n, a) / soft, y - velocity_after(s, n, b) / soft
        shear, limit = norm(u, v), s.grip[i] * normal
        part = limit / shear if shear > limit else 1.0
        s.impulse[a], s.impulse[b] = part * u, part * v
    return norm(s.impulse[a] - x, s.impulse[b] - y) * soft
