"""Contact with Coulomb's cone: impulses P and velocities u = W P + b after them (or forces and accelerations).

    u_n ≥ 0,  P_n ≥ 0,  P_n u_n = 0,  |P_t| ≤ µ P_n,  P_t = -µ P_n u_t / |u_t| where u_t ≠ 0

for at most four contacts.  Sets of contacts that push are tried, the smallest first.  Within a set all contacts
stick if the cones allow it; if not, Newton's method on the projections of Alart and Curnier (1991) finds which
slide and where to.

In: fields of the record ``s`` for n contacts: ``delassus``, W [-, for a unit of mass], (3 n, 3 n); ``free``, b
[m/s]; ``friction`` and ``holds``, coefficients of what slides and what sticks. Out: ``impulse``, P [m/s];
``after``, u [m/s]; ``grip``, the coefficient that each contact had. Theory: ``docs/space.md``, equations 5, 13-17.

Contact i has the rows 3 i and 3 i + 1 along its surface and 3 i + 2 away from it. A set is a ``mask`` of bits, or
the ``size`` numbers in ``s.member``. ``given[i]``: contact i slides, along the unit vector ``way[i]``.
"""

import math

import numpy as np

from rockfrag.base.elementary import sin_cos
from rockfrag.engines.algebra.vectors import (
    TINY,
    factor,
    norm,
    substitute,
)
from rockfrag.engines.compile.jit import kernel
from rockfrag.engines.spatial._case import (
    MOST,
    in_set,
    picks_wall,
)
from rockfrag.engines.spatial._delassus import largest_compliance
from rockfrag.engines.spatial._relax import relax, velocity_after
from rockfrag.engines.spatial._stick import speed_to_stop
from rockfrag.engines.spatial._together import (
    push_by_two,
    stick_together,
    stop_at,
)

ORDER = (0, 1, 2, 4, 8, 3, 5, 6, 9, 10, 12, 7, 11, 13, 14, 15)
"""Sets of four contacts as bits, the smallest first."""

# part of the largest compliance added while solving, and removed by repetition [-]
SOFT = 1e-8
# residual over what is to be stopped at which Newton's method ends [-]
CLOSE_ENOUGH = 1e-13
# velocity over the largest one to stop that is rounding [-]; shear beyond a cone, over its limit, that is [-];
# difference of energy over the square of that velocity below which two sets do equally well [-]
ROUNDING, ON_CONE, EQUAL = 1e-11, 1e-12, 1e-12
# slip over the largest velocity to stop above which a contact slides, and velocity over it at which a contact that
# does not push may be approached beside walls [-]
SLIPS, PRESSED = 1e-9, 1e-9
NEWTON_STEPS = 32
# part of a step by which the residual has to fall, else the step is halved [-]; residual over the wanted one that
# will do at last [-]
FALLS_BY, GOOD_ENOUGH = 0.1, 100
# added to the derivative, so that a direction that W leaves open is not stepped along [-]
STAYS = 1e-11
HALVINGS = 12  # times that a step of Newton's method is halved at most
# steps that may leave the residual as it was; then there is no solution nearby
MOST_STUCK = 4
RIGHT_ANGLE = 1.5707963267948966  # [rad]
# steps of false position at most, and the part between two directions at which it ends [-]
SEARCHES, NARROW = 60, 1e-15

RAYS = np.array(
    [(4.0, y) for y in range(-4, 4)]
    + [(-x, 4.0) for x in range(-4, 4)]
    + [(-4.0, -y) for y in range(-4, 4)]
    + [(x, -4.0) for x in range(-4, 4)]
)
RAYS /= np.sqrt((RAYS * RAYS).sum(axis=1, keepdims=True))
"""Directions between which that of a slip is looked for, around a square: the same bits everywhere."""


@kernel
def fill_after(s, n):
    """Fill s.after with the velocities of n contacts after the impulses, u = W P + b."""
    for row in range(3 * n):
        s.after[row] = velocity_after(s, n, row)


@kernel
def cones_hold(s, n, mask, small):
    """Whether the impulses of a set push, and are within the cones of its contacts that stick.

    What slides a given way has the shear of its cone anyway. ``small`` is an impulse that is rounding [m/s].
    """
    for i in range(n):
        if in_set(mask, i):
            normal = s.impulse[3 * i + 2]
            if normal < -small:
                return False
            shear = norm(s.impulse[3 * i], s.impulse[3 * i + 1])
            if not s.given[i] and shear > s.grip[i] * normal * (1 + ON_CONE) + small:
                return False
    return True


@kernel
def members(s, n, mask):
    """Fill s.member with the numbers of the contacts of a set; return how many there are."""
    size = 0
    for i in range(n):
        if in_set(mask, i):
            s.member[size] = i
            size += 1
    return size


@kernel
def grip_before(s, i):
    """Coefficient of contact i before it is known what it does: kinetic if it slid as it came, else static [-]."""
    return s.friction[i] if s.slid[i] else s.holds[i]


@kernel
def residuals(s, size, x, pace, out):
    """Fill ``out`` with the residuals of equation 17 (``docs/space.md``) for the members of a set, three each.

    ``x`` holds trial impulses as s.impulse does, and ``pace`` is ϱ, 1 over the largest compliance, which makes an
    impulse of a velocity. s.after gets the velocities. Returned is the largest residual as a velocity [m/s].
    """
    worst = 0.0
    for m in range(size):
        a = 3 * s.member[m]
        for k in range(a, a + 3):
            value = s.free[k]
            for other in range(size):
                j = 3 * s.member[other]
                for c in range(j, j + 3):
                    value += s.delassus[k, c] * x[c]
            s.after[k] = value
    for m in range(size):
        i = s.member[m]
        a, b, c = 3 * i, 3 * i + 1, 3 * i + 2
        out[3 * m + 2] = s.after[c] * pace
        if s.given[i]:
            out[3 * m] = x[a] + s.friction[i] * x[c] * s.way[i, 0]
            out[3 * m + 1] = x[b] + s.friction[i] * x[c] * s.way[i, 1]
        else:
            u, v = x[a] - pace * s.after[a], x[b] - pace * s.after[b]
            limit = s.grip[i] * max(x[c], 0.0)
            length = norm(u, v)
            shortened = 1.0 if length <= limit else limit / length
            out[3 * m], out[3 * m + 1] = x[a] - shortened * u, x[b] - shortened * v
        for k in range(3 * m, 3 * m + 3):
            worst = max(worst, abs(out[k]))
    return worst / pace


@kernel
def slopes_in_plane(s, m, x, pace, size):
    """Fill s.matrix with the two rows of the derivative of P_t - Π(P_t - ϱ u_t), for member m of a set.

    ``x`` and ``pace`` are as in :func:`residuals`. Within the cone Π changes nothing and ϱ u_t is left. Outside,
    with the unit vector (e, f) of P_t - ϱ u_t and ``ratio``, the limit over its length, a change d of P_t - ϱ u_t
    changes Π by ratio times its part across (e, f), and a change of the limit by that along (e, f).
    """
    i = s.member[m]
    a, b, c = 3 * i, 3 * i + 1, 3 * i + 2
    u, v = x[a] - pace * s.after[a], x[b] - pace * s.after[b]
    limit = s.grip[i] * max(x[c], 0.0)
    length = norm(u, v)
    sticks = length <= limit
    e, f, ratio = 0.0, 0.0, 1.0
    if not sticks:
        e, f, ratio = u / length, v / length, limit / length
    for other in range(size):
        for k in range(3):
            j, at = 3 * s.member[other] + k, 3 * other + k
            if sticks:
                s.matrix[3 * m, at] = pace * s.delassus[a, j]
                s.matrix[3 * m + 1, at] = pace * s.delassus[b, j]
                continue
            du = -pace * s.delassus[a, j] + (1.0 if j == a else 0.0)
            dv = -pace * s.delassus[b, j] + (1.0 if j == b else 0.0)
            along = e * du + f * dv
            longer = s.grip[i] if j == c and x[c] > 0 else 0.0
            s.matrix[3 * m, at] = (
                (1.0 if j == a else 0.0) - ratio * (du - along * e) - longer * e
            )
            s.matrix[3 * m + 1, at] = (
                (1.0 if j == b else 0.0) - ratio * (dv - along * f) - longer * f
            )


@kernel
def fill_slopes(s, size, x, pace):
    """Fill s.matrix, (3 size, 3 size), with the derivative of :func:`residuals` by the impulses of a set."""
    for m in range(size):
        i = s.member[m]
        row = 3 * m
        for other in range(size):
            for k in range(3):
                at = 3 * other + k
                s.matrix[row, at] = s.matrix[row + 1, at] = 0.0
                s.matrix[row + 2, at] = (
                    pace * s.delassus[3 * i + 2, 3 * s.member[other] + k]
                )
        if s.given[i]:
            for k in range(2):
                s.matrix[row + k, row + k] = 1.0
                s.matrix[row + k, row + 2] = s.friction[i] * s.way[i, k]
        else:
            slopes_in_plane(s, m, x, pace, size)
        # redundant directions: the step stays where it is
        for k in range(3):
            s.matrix[row + k, row + k] += STAYS


@kernel
def newton(s, size, pace, small):
    """Improve the impulses of the members of a set until the residuals vanish; return whether they do.

    ``pace`` is one over the largest compliance, by which impulses and velocities are compared, and ``small`` the
    residual [m/s] at which it ends. A step is halved until it takes away a tenth of what it should.
    """
    x = s.impulse
    worst = residuals(s, size, x, pace, s.right)
    stuck = 0
    for _ in range(NEWTON_STEPS):
        if worst <= small:
            return True
        fill_slopes(s, size, x, pace)
        for i in range(3 * size):
            s.vector[i] = -s.right[i]
        if not factor(s.matrix, s.order, 3 * size):
            return False
        substitute(s.matrix, s.order, 3 * size, s.vector)
        step = 1.0
        for _ in range(HALVINGS):
            for m in range(size):
                for k in range(3):
                    j = 3 * s.member[m] + k
                    s.trial[j] = x[j] + step * s.vector[3 * m + k]
            least = residuals(s, size, s.trial, pace, s.right)
            if least < worst * (1 - FALLS_BY * step) or least <= small:
                break
            step *= 0.5
        for m in range(size):
            for j in range(3 * s.member[m], 3 * s.member[m] + 3):
                x[j] = s.trial[j]
        stuck += least >= worst
        if stuck > MOST_STUCK:
            return False
        worst = least
    return worst <= GOOD_ENOUGH * small


@kernel
def start_sliding(s, n, mask, turned):
    """Begin with each contact of a set stopped alone and sliding: fill s.impulse for :func:`newton`.

    It slides the way it came, turned by an angle ``turned`` [rad], or its given way.
    """
    for i in range(n):
        a = 3 * i
        s.impulse[a] = s.impulse[a + 1] = s.impulse[a + 2] = 0.0
        if not in_set(mask, i):
            continue
        normal = max(-s.free[a + 2], 0.0) / s.delassus[a + 2, a + 2]
        u, v = s.free[a], s.free[a + 1]
        size = max(norm(u, v), TINY)
        e, f = u / size, v / size
        sine, cosine = sin_cos(turned)
        e, f = e * cosine - f * sine, e * sine + f * cosine
        if s.given[i]:
            e, f = s.way[i, 0], s.way[i, 1]
        grip = s.friction[i] if s.given[i] else s.grip[i]
        s.impulse[a] = -grip * normal * e
        s.impulse[a + 1] = -grip * normal * f
        s.impulse[a + 2] = normal


@kernel
def others_open(s, n, mask, small):
    """Whether no contact outside of a set approaches faster than ``small`` [m/s]."""
    found = True
    for i in range(n):
        found = found and (in_set(mask, i) or not s.after[3 * i + 2] < -small)
    return found


@kernel
def stick_set(s, n, mask, size, largest):
    """Solve for the impulses at which one set sticks, and fill s.grip; whether its equations have a solution.

    ``largest`` is the largest compliance. Contacts that slipped before may have lost their static friction; an
    edge then splits its impulse anew.
    """
    for m in range(size):
        s.grip[s.member[m]] = s.holds[s.member[m]]
    if not stop_set(s, n, mask, size, largest):
        return False
    if lose_grip(s, n, mask, size, largest) and size == 2:
        fraction_in_set(s, s.member[0], s.member[1])
    return True


@kernel
def stop_set(s, n, mask, size, largest):
    """Solve for the impulses at which one set stops (or slides the given way); whether there is a solution.

    Arguments are those of :func:`stick_set`. One contact has a closed form; of two the impulse along their edge is
    split.
    """
    for i in range(3 * n):
        s.impulse[i] = 0.0
    if size == 1:
        stick_alone(s, s.member[0])
    elif size > 1:
        if not stick_together(s, n, mask, SOFT * largest):
            return False
        if size == 2:
            fraction_in_set(s, s.member[0], s.member[1])
    return True


@kernel
def lose_grip(s, n, mask, size, largest):
    """Give contacts that slipped before kinetic friction where Routh's path asks for it; whether there are any.

    A contact of the set, all of which stick, slipped along ``s.came`` and has stopped. Where its shear is against
    that slip, kinetic friction has stopped it, and no more than that may be used: ``s.grip`` becomes the kinetic
    coefficient. Where its shear is along that slip, it has stuck since, and static friction holds if it also holds
    the same set coming down straight (:func:`slips_on`); else slip goes on, with kinetic friction
    (``docs/space.md``, "Static and kinetic friction in an impact"). ``s.impulse`` and ``s.free`` stay.
    """
    lost, regains = False, False
    for m in range(size):
        i = s.member[m]
        if s.slid[i] and s.friction[i] < s.holds[i]:
            along = (
                s.impulse[3 * i] * s.came[i, 0] + s.impulse[3 * i + 1] * s.came[i, 1]
            )
            regains = regains or along >= 0.0
            if along < 0.0:
                s.grip[i], lost = s.friction[i], True
    if regains and slips_on(s, n, mask, size, largest):
        lost = True
    return lost


@kernel
def slips_on(s, n, mask, size, largest):
    """Give kinetic friction to contacts that would slip if the set came down straight; whether there are any.

    Arguments are those of :func:`lose_grip`. Asked are those that slipped before; they come down without that slip
    here, and static friction has to hold them. ``s.impulse`` and ``s.free`` stay.
    """
    lost = False
    for i in range(3 * n):
        s.trial[i], s.kept[i] = s.impulse[i], s.free[i]
        if i % 3 != 2:
            s.free[i] = 0.0
    stop_set(s, n, mask, size, largest)
    for m in range(size):
        i = s.member[m]
        shear = norm(s.impulse[3 * i], s.impulse[3 * i + 1])
        if s.slid[i] and shear > s.holds[i] * s.impulse[3 * i + 2]:
            s.grip[i], lost = s.friction[i], True
    for i in range(3 * n):
        s.impulse[i], s.free[i] = s.trial[i], s.kept[i]
    return lost


@kernel
def stick_alone(s, i):
    """Solve for the impulse at which contact i, alone in its set, sticks (or slides the given way)."""
    a, b, c = 3 * i, 3 * i + 1, 3 * i + 2
    w = s.delassus
    if s.given[i]:
        way = (-s.friction[i] * s.way[i, 0], -s.friction[i] * s.way[i, 1])
        normal = -s.free[c] / (w[c, c] + w[c, a] * way[0] + w[c, b] * way[1])
        s.impulse[a], s.impulse[b], s.impulse[c] = (
            way[0] * normal,
            way[1] * normal,
            normal,
        )
    else:
        push = stop_at(w, a, (s.free[a], s.free[b], s.free[c]))
        s.impulse[a], s.impulse[b], s.impulse[c] = push


@kernel
def slide_set(s, n, mask, size, largest, scale):
    """Solve for one set of contacts of which some slides; return whether a solution within the cones was found.

    One alone, and two of which one sticks, are found in closed form. Others begin with what would let all stick,
    its shears shortened to the cones, and go on by Newton's method; where that leads nowhere, slips in four
    directions at right angles are tried. Contacts that then slip have kinetic friction.

    In: set ``mask`` of ``size`` contacts among n, the largest compliance [-] and the scale of velocities [m/s].
    Out: the impulses in s.impulse.
    """
    small, pace = ROUNDING * scale, 1.0 / largest
    if size == 1:
        return slide_alone(s, n, s.member[0])
    if size == 2 and slide_one_end(s, n, small):
        return True
    if size == 0 or not stick_together(s, n, mask, SOFT * largest):
        return False
    shorten_to_cones(s, n, mask)
    found = newton(s, size, pace, CLOSE_ENOUGH * scale)
    for k in range(4):
        if found and cones_hold(s, n, mask, small / largest):
            break
        start_sliding(s, n, mask, RIGHT_ANGLE * k)
        found = newton(s, size, pace, CLOSE_ENOUGH * scale)
    return found and ends_kinetically(s, size, pace, scale)


@kernel
def ends_kinetically(s, size, pace, scale):
    """Solve for a set anew while more of its contacts come to slide; whether a solution was found each time.

    ``scale`` is the largest velocity to stop [m/s], and ``pace`` is as in :func:`newton`.
    """
    found = True
    while found and slip_kinetically(s, size, SLIPS * scale):
        found = newton(s, size, pace, CLOSE_ENOUGH * scale)
    return found


@kernel
def shorten_to_cones(s, n, mask):
    """Shorten the shear of each contact of a set to what friction allows under its normal impulse; fill s.grip."""
    for i in range(n):
        if in_set(mask, i) and not s.given[i]:
            a = 3 * i
            s.grip[i] = grip_before(s, i)
            limit = s.grip[i] * max(s.impulse[a + 2], 0.0)
            shear = norm(s.impulse[a], s.impulse[a + 1])
            if shear > limit:
                s.impulse[a] *= limit / shear
                s.impulse[a + 1] *= limit / shear


@kernel
def slide_one_end(s, n, small):
    """Solve for the two contacts of a set of which one sticks and the other slides across; whether there is such.

    The slip of the one is across the line between them, to one side or the other: four cases, each linear
    (``docs/space.md``, equation 14). ``small`` is a velocity that is rounding [m/s].
    """
    for k in range(2):
        sticks, slides = s.member[k], s.member[1 - k]
        edge = s.edge[sticks, slides]
        on_one_surface = edge[0] != 0.0 or edge[1] != 0.0
        if s.given[sticks] or s.given[slides] or not on_one_surface:
            return False
        s.grip[sticks] = grip_before(s, sticks)
        s.grip[slides] = s.friction[slides]
        for side in (1.0, -1.0):
            way = (-side * edge[1], side * edge[0])
            if slides_to(s, n, sticks, slides, way, small):
                return True
    return False


@kernel
def slides_to(s, n, sticks, slides, way, small):
    """Solve for contact ``sticks`` and contact ``slides``, along the unit vector ``way``; whether both do so.

    The one has to stay within its cone, the other to slip along ``way`` and not off it by more than ``small``
    [m/s].
    """
    a, b = 3 * sticks, 3 * slides
    push, normal, unit = push_by_two(s, sticks, slides, way, s.grip[slides])
    shear = norm(push[0], push[1])
    if not (normal >= 0.0 and push[2] >= 0.0 and shear <= s.grip[sticks] * push[2]):
        return False
    for i in range(3 * n):
        s.impulse[i] = 0.0
    for k in range(3):
        s.impulse[a + k], s.impulse[b + k] = push[k], normal * unit[k]
    fill_after(s, n)
    along = s.after[b] * way[0] + s.after[b + 1] * way[1]
    off = s.after[b] * way[1] - s.after[b + 1] * way[0]
    return along >= 0.0 and abs(off) <= small


@kernel
def slip_kinetically(s, size, slow):
    """Give contacts of a set that slide with static friction kinetic one; whether there were any.

    What slips by no more than ``slow`` [m/s] does not slide.
    """
    changed = False
    for m in range(size):
        i = s.member[m]
        slides = not s.given[i] and norm(s.after[3 * i], s.after[3 * i + 1]) > slow
        if slides and s.grip[i] > s.friction[i]:
            s.grip[i], changed = s.friction[i], True
    return changed


@kernel
def off_direction(s, i, e, f):
    """How far contact i would be driven off the unit vector (e, f) of the plan if it slid that way alone.

    With u = W P + b (equation 5 of ``docs/space.md``), P = P_n (-µ e, -µ f, 1) and u_n = 0 the normal impulse is
    P_n = -b_n / D with D = W_nn - µ (W_nx e + W_ny f), and the slip u_t. Both D and D u_t are linear in (e, f), so
    that the slip across (e, f) times D has at most four zeros around the circle.

    Returns
    -------
    across : slip across (e, f), times D
    denominator : D
    along : slip along (e, f), times D
    """
    x, y, z = 3 * i, 3 * i + 1, 3 * i + 2
    w, b, friction = s.delassus, s.free, s.friction[i]
    denominator = w[z, z] - friction * (w[z, x] * e + w[z, y] * f)
    by_unit_x = w[x, z] - friction * (w[x, x] * e + w[x, y] * f)
    by_unit_y = w[y, z] - friction * (w[y, x] * e + w[y, y] * f)
    slip_x = b[x] * denominator - b[z] * by_unit_x
    slip_y = b[y] * denominator - b[z] * by_unit_y
    return e * slip_y - f * slip_x, denominator, e * slip_x + f * slip_y


@kernel
def slide_alone(s, n, i):
    """Solve for the impulse at which contact i, alone in its set, slides, with the least energy left, if it can.

    All zeros of equation 16 (``docs/space.md``) between two neighbours of RAYS are tried. Returned is whether one
    of them pushes and slides.
    """
    for j in range(3 * n):
        s.impulse[j] = 0.0
    if s.given[i]:
        return False
    a, b, c = 3 * i, 3 * i + 1, 3 * i + 2
    found, least, mu = False, 0.0, s.friction[i]
    p, q = RAYS[-1, 0], RAYS[-1, 1]
    before = off_direction(s, i, p, q)[0]
    for k in range(RAYS.shape[0]):
        u, v = RAYS[k, 0], RAYS[k, 1]
        after = off_direction(s, i, u, v)[0]
        if (before > 0) != (after > 0):
            e, f = direction_between(s, i, p, q, u, v, before, after)
            _, d, slip = off_direction(s, i, e, f)
            normal = -s.free[c] / d if d != 0.0 else -1.0
            # the slip is still times d
            if normal > 0 and slip * d > 0:
                # twice the change of energy, P·b + P·u
                left = normal * (s.free[c] - mu * (s.free[a] * e + s.free[b] * f))
                left -= normal * mu * slip / d
                if not found or left < least:
                    found, least = True, left
                    s.impulse[a], s.impulse[c] = -mu * normal * e, normal
                    s.impulse[b] = -mu * normal * f
        p, q, before = u, v, after
    return found


@kernel
def direction_between(s, i, p, q, u, v, before, after):
    """Find the direction in which contact i slides on, between two, by false position (Illinois).

    ``before`` and ``after``, of opposite signs, are what :func:`off_direction` first returns of the unit vectors
    (p, q) and (u, v); returned is the unit vector between them where it vanishes.
    """
    low, high, side = 0.0, 1.0, 0
    e, f = p, q
    for _ in range(SEARCHES):
        part = (low * after - high * before) / (after - before)
        e, f = p + part * (u - p), q + part * (v - q)
        size = norm(e, f)
        e, f = e / size, f / size
        value = off_direction(s, i, e, f)[0]
        if (value > 0) == (before > 0):
            low, before = part, value
            after *= 0.5 if side > 0 else 1.0
            side = 1
        else:
            high, after = part, value
            before *= 0.5 if side < 0 else 1.0
            side = -1
        if value == 0.0 or high - low < NARROW:
            break
    return e, f


@kernel
def fraction_in_set(s, first, second):
    """Split the impulse along the edge between two contacts so that both cones hold, if they can.

    In and out: s.impulse (``docs/space.md``, equation 13). What slides a given way is left as it is.
    """
    if s.given[first] or s.given[second]:
        return
    edge = (s.edge[first, second, 0], s.edge[first, second, 1])
    p, along = s.impulse, 0.0
    # what the cones of both leave for a part along the edge
    room_for = (0.0, 0.0)
    for i in (first, second):
        part = p[3 * i] * edge[0] + p[3 * i + 1] * edge[1]
        along += part
        p[3 * i] -= part * edge[0]
        p[3 * i + 1] -= part * edge[1]
        free = (s.grip[i] * p[3 * i + 2]) ** 2 - p[3 * i] ** 2 - p[3 * i + 1] ** 2
        room_for = (room_for[1], math.sqrt(max(free, 0.0)))
    both = room_for[0] + room_for[1]
    part = 0.5 if both == 0.0 else room_for[0] / both
    for k in range(2):
        p[3 * first + k] += part * along * edge[k]
        p[3 * second + k] += (1.0 - part) * along * edge[k]


@kernel
def solve_cones(s, n, least):
    """Find the impulses: all that push stick if that is possible; the fewest that push; the least energy left.

    At ``least`` so many of the n contacts push. Returned are the set that pushes as bits (-1 if none was found),
    and how many sets of that size would do; s.impulse, s.after and s.grip have the solution.
    """
    chosen, solutions = fewest(s, n, least, False)
    if chosen < 0:
        chosen, solutions = fewest(s, n, least, True)
    if chosen < 0:
        chosen, solutions = shared(s, n, least)
    if chosen >= 0:
        for i in range(3 * n):
            s.impulse[i] = s.best[i]
        for i in range(n):
            s.grip[i] = s.best_grip[i]
        fill_after(s, n)
    return chosen, solutions


@kernel
def fewest(s, n, least, slide):
    """Find the smallest set of contacts that sticks (or slides); of several the one that leaves the least energy.

    Returned are the set, as bits, -1 if there is none, and how many sets of that size there are; s.best has its
    impulses. Sets are tried by size, so that larger ones are left out as soon as one is found.
    """
    largest, scale = largest_compliance(s, n), speed_to_stop(s, n)
    chosen, solutions, size_found, lowest = -1, 0, MOST, 0.0
    for k in range(1 << MOST):
        mask = ORDER[k]
        size = members(s, n, mask)
        if mask >= (1 << n) or size < least or size > size_found:
            continue
        solved = (
            slide_set(s, n, mask, size, largest, scale)
            if slide
            else stick_set(s, n, mask, size, largest)
        )
        fill_after(s, n)
        if solved and is_solution(s, n, mask, scale, largest):
            solutions += 1
            change = change_of_energy(s, n)
            if chosen < 0 or change < lowest - EQUAL * scale * scale:
                chosen, lowest, size_found = mask, change, size
                keep_best(s, n)
    return chosen, solutions


@kernel
def shared(s, n, least):
    """Find impulses of contacts that share what they hold: by Gauss and Seidel's method, then by Newton's.

    In and out are as in :func:`fewest`; the set is that of all that come to push.
    """
    largest, scale = largest_compliance(s, n), speed_to_stop(s, n)
    pace = 1.0 / largest
    for i in range(n):
        s.grip[i] = grip_before(s, i)
        for k in range(3):
            s.impulse[3 * i + k] = 0.0
    relax(s, n, ROUNDING * scale)
    mask = 0
    for i in range(n):
        if s.impulse[3 * i + 2] > SLIPS * scale * pace:
            mask |= 1 << i
        else:
            for k in range(3):
                s.impulse[3 * i + k] = 0.0
    size = members(s, n, mask)
    found = size >= max(least, 1) and newton(s, size, pace, CLOSE_ENOUGH * scale)
    found = found and ends_kinetically(s, size, pace, scale)
    fill_after(s, n)
    if not (found and is_solution(s, n, mask, scale, largest)):
        return -1, 0
    keep_best(s, n)
    return mask, 1


@kernel
def is_solution(s, n, mask, scale, largest):
    """Whether impulses of a set push and lie within the cones, and nothing outside of it approaches.

    ``scale`` is the largest velocity to stop [m/s], and ``largest`` the largest compliance.
    """
    small = ROUNDING * scale
    approached = (PRESSED if picks_wall(n, s) else ROUNDING) * scale
    return cones_hold(s, n, mask, small / largest) and others_open(
        s, n, mask, approached
    )


@kernel
def change_of_energy(s, n):
    """Change of kinetic energy by the impulses, P·b + P·W P/2 = P·(b + u)/2 [J/kg]."""
    change = 0.0
    for i in range(3 * n):
        change += 0.5 * s.impulse[i] * (s.free[i] + s.after[i])
    return change


@kernel
def keep_best(s, n):
    """Keep the impulses and the friction of a set as the best so far."""
    for i in range(3 * n):
        s.best[i] = s.impulse[i]
    for i in range(n):
        s.best_grip[i] = s.grip[i]
