"""Impacts (or changes of mode) in which one point or an edge pushes and sticks, in closed form.

They are nearly all there are.  What they are not goes to the one problem of cones (``_cone``).

In: a state and the n contacts ``s.which`` of a small system, those that touch. Out: impulses a unit of mass [m/s],
or nothing if it is another case. Theory: ``docs/space.md``, "Derivations", equations 11 to 13.

Names, all vectors in the body but those of the record ``s``:

- ``i``, ``j``, ``k``: places in s.which; ``up``: the vertical, ``rows[2]``
- ``s.load``: velocity of a contact but for rotation before the impulse, b of equation 11 [m/s]; of a change of
  mode accelerations stand in the place of velocities, and forces in that of impulses
- ``moment``: angular momentum before, L of equation 11 [m²/s], or the moment without contact forces [m²/s²]
- ``turn``: angular velocity after [rad/s]; ``push``: impulse of all contacts together [m/s]
- ``small``: a velocity that is rounding [m/s]
"""

import math

from rockfrag.engines.algebra.vectors import (
    TINY,
    cross,
    dot,
    minus,
    plus,
    scaled,
    times,
    to_body,
    to_world,
)
from rockfrag.engines.compile.jit import kernel
from rockfrag.engines.spatial import _body as solid
from rockfrag.engines.spatial._closed_forms import (
    stop_edge,
    stop_point,
)
from rockfrag.engines.spatial._ties import twist_by_ties

NOTHING = (0.0, 0.0, 0.0)
ROUNDING = 1e-11  # speed over the largest one to stop below which a contact does not approach [-]
ON_CONE = 1e-12  # shear beyond a cone, over its limit, that is rounding [-]
EQUAL = 1e-12  # difference of work, over the square of that speed, below which sets do equally well [-]


@kernel
def load_of(s, k):
    """Velocity of contact k of a small system but for rotation, in the body [m/s]."""
    return (s.load[k, 0], s.load[k, 1], s.load[k, 2])


@kernel
def fill_velocities(body, y, rows, n, s):
    """Fill s.load and s.free with how the n contacts s.which move before an impact; return the angular momentum.

    s.load is in the body, s.free in axes of the ground, three components a contact [m/s]; the angular momentum, J
    ω over the mass, is in the body [m²/s].
    """
    omega = solid.omega_of(y)
    velocity = to_body(rows, solid.centre_velocity(y))
    for k in range(n):
        s.load[k, 0], s.load[k, 1], s.load[k, 2] = velocity
        fill_free(body, rows, k, omega, s)
    return times(body.inertia, omega)


@kernel
def fill_accelerations(body, y, rows, weight, n, s):
    """Fill in how the n contacts s.which accelerate without forces; return the moment that turns the body.

    ``s.load`` gets the acceleration of each but for the body's own, in the body, ``s.free`` all of it, in axes of
    the ground [m/s²]. ``weight`` is the effective gravity and the force of ties, in the body [N/kg]; the moment is
    that of ties and the gyroscopic one [N m/kg].
    """
    omega = solid.omega_of(y)
    moment = minus(twist_by_ties(s), cross(omega, times(body.inertia, omega)))
    spin = times(body.inverse, moment)
    for k in range(n):
        p = solid.arm(body, rows[2], s.which[k])
        bias = solid.bias(body, rows[2], omega, p, s.which[k])
        s.load[k, 0], s.load[k, 1], s.load[k, 2] = plus(weight, bias)
        fill_free(body, rows, k, spin, s)
    return moment


@kernel
def fill_free(body, rows, k, spin, s):
    """Fill s.free, from 3 k on, with the velocity of contact k in axes of the ground; ``spin`` is ω."""
    p = solid.arm(body, rows[2], s.which[k])
    free = to_world(rows, plus(load_of(s, k), cross(spin, p)))
    s.free[3 * k], s.free[3 * k + 1], s.free[3 * k + 2] = free


@kernel
def upward_speed(body, up, k, turn, push, s):
    """Velocity upwards of contact k after the impulse ``push`` that leaves the body with ``turn`` [m/s]."""
    p = solid.arm(body, up, s.which[k])
    after = plus(plus(load_of(s, k), push), cross(turn, p))
    return dot(up, after)


@kernel
def others_stay_out(body, up, n, i, j, turn, push, small, s):
    """Whether no contact but i and j (-1: none) approaches the ground after the impulse ``push`` of these two.

    ``turn`` is the angular velocity after it. What approaches more slowly than ``small`` does not count; a
    velocity that is no number does.
    """
    for k in range(n):
        stops = k in (i, j)
        # what is no number does not stay out
        if not stops and not upward_speed(body, up, k, turn, push, s) >= -small:
            return False
    return True


@kernel
def within_cone(up, push, friction, small):
    """Whether an impulse pushes and is within the cone of a coefficient of friction, up to ``small``."""
    normal = dot(up, push)
    shear = math.sqrt(max(dot(push, push) - normal * normal, 0.0))
    return normal >= -small and shear <= friction * normal * (1 + ON_CONE) + small


@kernel
def room_along(up, push, along, friction):
    """Impulse along an edge that one of its ends can bear beside what it bears across it [m/s].

    ``push`` is the impulse of the end, ``along`` its part along the edge. The room is √(µ² N² - P⊥²), s of
    equation 13 (``docs/space.md``).
    """
    normal = dot(up, push)
    across = dot(push, push) - normal * normal - along * along
    return math.sqrt(max((friction * normal) ** 2 - max(across, 0.0), 0.0))


@kernel
def split_along(up, first, second, e, friction_first, friction_second):
    """Split the impulse of an edge along it so that both ends' cones hold, if they can (equation 13).

    ``first`` and ``second`` are the impulses of the ends in the body and ``e`` the unit vector along the edge;
    only their sum along e is given. Returned are the two impulses with parts along e that are in proportion to
    what each cone leaves.
    """
    near, far = dot(first, e), dot(second, e)
    room_first = room_along(up, first, near, friction_first)
    room_second = room_along(up, second, far, friction_second)
    part = (
        0.5
        if room_first + room_second == 0.0
        else room_first / (room_first + room_second)
    )
    along = near + far
    return (
        plus(first, scaled(part * along - near, e)),
        plus(second, scaled((1.0 - part) * along - far, e)),
    )


@kernel
def speed_to_stop(s, n):
    """Largest component of the velocities that there is to stop [m/s], or of accelerations [m/s²]."""
    scale = TINY
    for i in range(3 * n):
        scale = max(scale, abs(s.free[i]))
    return scale


@kernel
def keep(rows, n, i, j, first, second, s):
    """Write the impulses of contacts i and j, in the body, to s.impulse, in axes of the ground; others get none.

    A contact -1 is none.
    """
    for k in range(3 * n):
        s.impulse[k] = 0.0
    if i >= 0:
        push = to_world(rows, first)
        s.impulse[3 * i], s.impulse[3 * i + 1], s.impulse[3 * i + 2] = push
    if j >= 0:
        push = to_world(rows, second)
        s.impulse[3 * j], s.impulse[3 * j + 1], s.impulse[3 * j + 2] = push


@kernel
def fill_after(body, rows, n, turn, push, s):
    """Fill s.after with the velocities of all n contacts after an impulse, in axes of the ground [m/s]."""
    for k in range(n):
        p = solid.arm(body, rows[2], s.which[k])
        after = to_world(rows, plus(plus(load_of(s, k), push), cross(turn, p)))
        s.after[3 * k], s.after[3 * k + 1], s.after[3 * k + 2] = after


@kernel
def work_of(rows, k, push, s):
    """Twice the kinetic energy that an impulse at contact k takes by stopping it, as a negative number [J/kg].

    After the impulse the contact is at rest, so that twice the change is P·(b + 0).
    """
    p = to_world(rows, push)
    return p[0] * s.free[3 * k] + p[1] * s.free[3 * k + 1] + p[2] * s.free[3 * k + 2]


@kernel
def stick_alone_or_by_two(body, rows, n, least, moment, s):
    """Find the fewest contacts, none, one or two, that stick while no other approaches, as ``_cone.fewest`` does.

    Of sets of one size the one is taken that takes most kinetic energy away. ``moment`` is what
    :func:`fill_velocities` or :func:`fill_accelerations` returned; no set of fewer than ``least`` is looked for.
    Returned are the set as bits (-1 if there is none) and how many of its size would do; ``s.impulse`` and
    ``s.after`` have the impulses and the velocities after them.
    """
    up = rows[2]
    scale = speed_to_stop(s, n)
    small, equal_work = ROUNDING * scale, EQUAL * scale * scale
    spin = times(body.inverse, moment)
    if least == 0 and others_stay_out(body, up, n, -1, -1, spin, NOTHING, small, s):
        keep(rows, n, -1, -1, NOTHING, NOTHING, s)
        fill_after(body, rows, n, spin, NOTHING, s)
        return 0, 1
    chosen, solutions = stick_alone(body, rows, n, moment, small, equal_work, s)
    if chosen < 0:
        chosen, solutions = stick_by_two(body, rows, n, moment, small, equal_work, s)
    for k in range(n if chosen >= 0 else 0):
        # all had the friction of what has not slipped
        s.grip[k] = s.holds[k]
    return chosen, solutions


@kernel
def stick_alone(body, rows, n, moment, small, equal_work, s):
    """Find the contact that sticks alone while no other approaches, and takes most kinetic energy away.

    Works that differ by no more than ``equal_work`` [J/kg] are equal: the first one is taken. In and out are as in
    :func:`stick_alone_or_by_two`.
    """
    up = rows[2]
    chosen, solutions, lowest = -1, 0, 0.0
    best_turn, best_push = NOTHING, NOTHING
    for i in range(n):
        turn, push = stop_point(body, up, s.which[i], load_of(s, i), moment)
        if not within_cone(up, push, s.holds[i], small):
            continue
        if not others_stay_out(body, up, n, i, i, turn, push, small, s):
            continue
        solutions += 1
        change = work_of(rows, i, push, s)
        if chosen < 0 or change < lowest - equal_work:
            chosen, lowest = 1 << i, change
            best_turn, best_push = turn, push
            keep(rows, n, i, -1, push, NOTHING, s)
    if chosen >= 0:
        fill_after(body, rows, n, best_turn, best_push, s)
    return chosen, solutions


@kernel
def stick_by_two(body, rows, n, moment, small, equal_work, s):
    """Find the two contacts that stick while no other approaches, and take most kinetic energy away.

    In and out are as in :func:`stick_alone`.
    """
    up = rows[2]
    chosen, solutions, lowest = -1, 0, 0.0
    best_turn, best_push = NOTHING, NOTHING
    for j in range(n):
        for i in range(j):
            turn, push, near, far, holds = hold_edge(body, up, i, j, moment, small, s)
            if not holds:
                continue
            if not others_stay_out(body, up, n, i, j, turn, push, small, s):
                continue
            solutions += 1
            change = work_of(rows, i, near, s) + work_of(rows, j, far, s)
            if chosen < 0 or change < lowest - equal_work:
                chosen, lowest = (1 << i) | (1 << j), change
                best_turn, best_push = turn, push
                keep(rows, n, i, j, near, far, s)
    if chosen >= 0:
        fill_after(body, rows, n, best_turn, best_push, s)
    return chosen, solutions


@kernel
def hold_edge(body, up, i, j, moment, small, s):
    """Stop contacts i and j (``docs/space.md``, equations 12 and 13).

    Returned are the angular velocity after it; the impulse of both together, of i and of j; and whether both can
    be stopped, and friction holds at both. What acts along the edge between them is split so that it does, if it
    can.
    """
    turn, push, far, e, fits = stop_edge(
        body,
        up,
        s.which[i],
        s.which[j],
        load_of(s, i),
        load_of(s, j),
        moment,
        small,
    )
    near = plus(push, scaled(-1.0, far))
    near, far = split_along(up, near, far, e, s.holds[i], s.holds[j])
    holds = within_cone(up, near, s.holds[i], small)
    holds = holds and within_cone(up, far, s.holds[j], small)
    return turn, push, near, far, fits and holds
