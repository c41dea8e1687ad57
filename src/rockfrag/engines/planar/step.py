"""One step between contact events, and the first contact event in it.

``p`` and ``w`` are records ``BODY`` and ``WORK`` (``records.py``). ``q`` and ``v`` have x, y [m] and the clockwise
rotation θ [rad] of body k, from place 3 k on, and their rates.

In: coordinates and velocities at an instant and a mode. Out: those at the end of the step [s], or at the first
event in it. What must stay positive: ``docs/contact.md``, equations 4 to 6; the step: Dormand and Prince (1980).
"""

import math
from typing import NamedTuple

from rockfrag.engines.compile.jit import kernel
from rockfrag.engines.planar.bonds import bond_margin
from rockfrag.engines.planar.search import BONDED
from rockfrag.engines.planar.solve import (
    AT_EDGE,
    CORNER,
    EITHER,
    copy,
    end_of,
    look_at,
    rate,
    solve_motion,
)
from rockfrag.engines.planar.support import GUIDED, least_support_margin, slope
from rockfrag.engines.planar.ties import (
    least_tie_margin,
    power,
    start_ties,
    turns_back,
)
from rockfrag.engines.planar.walls import any_closed, climbs, has_left
from rockfrag.engines.pure_rocking.kernels.dormand_prince import INSTANTS, WEIGHTS

# slack before a contact event is seen, so that what has just begun is not taken for its end [-]: forces over
# weight; speeds over √(g b) and lengths over b
SLACK, TOUCH = 1e-12, 1e-13
UNSLIPPED = 2e-11
"""Slack of slips where a wall presses: more than what counts as no slip as a mode is sought (``impact.STILL``).
Two contacts may hold what is so slow at once, so that no impulse stops it, and it would fail again on the spot."""
ERROR = 1e-7  # error of a step above which it is taken again, half as long [-]
# fraction of a sampling interval below which a step is not made shorter
SHORTEST = 1e-7
# fraction of the half width by which a corner that comes in under an edge hangs beside the face and not over it:
# its base is at a right angle to the face, and the body has fallen
HANGING = 1e-6
WIDTH = 1e-12  # fraction of a step to which the time of a contact event is found
# channels of an interface: its two ends (gap or pressure), their edges, ...
GAP, EDGE = 0, 2
# ... stick or slip, the fall of the body above it, and the bond; of a wall, that it is left upwards
FRICTION, FALL, BREAK = 4, 5, 6


MOTIONS, FORCES = False, True
"""What margins are taken of: of motions alone, or of forces too."""


class Instant(NamedTuple):
    """A time [s], and the accelerations of the ground then [m/s²]."""

    time: float
    ah: float
    av: float


class Stretch(NamedTuple):
    """A stretch of time over which the accelerations of the ground are linear."""

    length: float  # [s]
    ah: float  # horizontal acceleration at its beginning [m/s²]
    av: float  # likewise upwards
    # by which they rise over it [m/s²]
    rise_h: float
    rise_v: float


@kernel
def beginning(stretch, part):
    """First ``part`` of a stretch, a fraction of its length [-], as a :class:`Stretch`."""
    rise_h, rise_v = part * stretch.rise_h, part * stretch.rise_v
    return Stretch(part * stretch.length, stretch.ah, stretch.av, rise_h, rise_v)


@kernel
def rest_of(stretch, part):
    """What is left of a stretch after its first ``part``, a fraction of its length [-], as a :class:`Stretch`."""
    ah, av = ground_at(stretch, part)
    left = 1.0 - part
    length, rise_h = left * stretch.length, left * stretch.rise_h
    return Stretch(length, ah, av, rise_h, left * stretch.rise_v)


@kernel
def ground_at(stretch, part):
    """Horizontal and upward acceleration of the ground [m/s²] at a fraction ``part`` of a stretch."""
    return stretch.ah + part * stretch.rise_h, stretch.av + part * stretch.rise_v


@kernel
def start_step(p, w):
    """Take ``q``, ``v`` and ``a`` as the start of a step; ``look_at`` must have been called with ``q``."""
    copy(p, w.q, w.q0)
    copy(p, w.v, w.v0)
    copy(p, w.a, w.a0)
    start_ties(p, w)
    # speeds at which open ends part
    for k in range(p.contacts):
        for end in range(2):
            w.early[k, end] = 0.0
            if w.closed[k, end] == 0:
                x, y, tx, ty, _, _, _ = end_of(p, w, w.q0, k, end, EITHER)
                w.early[k, end] = rate(p, w.q0, w.v0, k, x, y, -ty, tx)


@kernel
def take_step(p, w, stretch, energy_balance):
    """Go on from q0, v0, a0 to q1, v1, a1 in ``w`` by Dormand and Prince's pair of order 5.

    Parameters
    ----------
    p, w : records ``BODY`` and ``WORK``
    stretch : the step and its ground
    energy_balance : whether work and losses are wanted

    Returns
    -------
    Work of the ground, energy lost to friction, and energy given to ties [J]; zero if not wanted.
    """
    h = stretch.length
    size = 3 * p.count
    for d in range(size):
        w.kv[d, 0] = w.v0[d]
        w.ka[d, 0] = w.a0[d]
    work, friction_loss, tied = 0.0, 0.0, 0.0
    if energy_balance:
        look_at(p, w, w.q0)
        solve_motion(p, w, w.q0, w.v0, stretch.ah, stretch.av)
        # powers are integrated with the weights of the solution of order 5
        of_ground, of_friction, of_ties = _powers(
            p, w, w.q0, w.v0, stretch.ah, stretch.av
        )
        work += WEIGHTS[6, 0] * of_ground
        friction_loss += WEIGHTS[6, 0] * of_friction
        tied += WEIGHTS[6, 0] * of_ties
    for stage in range(1, 7):
        for d in range(size):
            if stage == 1:
                w.v1[d] = w.v0[d] + h * 0.2 * w.ka[d, 0]
                w.q1[d] = w.q0[d] + h * 0.2 * w.kv[d, 0]
                continue
            # weighted rates of the stages before: velocity and acceleration
            velocity = WEIGHTS[stage, 0] * w.kv[d, 0]
            acceleration = WEIGHTS[stage, 0] * w.ka[d, 0]
            for early in range(1, stage):
                weight = WEIGHTS[stage, early]
                if weight != 0.0:
                    velocity += weight * w.kv[d, early]
                    acceleration += weight * w.ka[d, early]
            w.v1[d] = w.v0[d] + h * acceleration
            w.q1[d] = w.q0[d] + h * velocity
        look_at(p, w, w.q1)
        ah, av = ground_at(stretch, INSTANTS[stage])
        solve_motion(p, w, w.q1, w.v1, ah, av)
        for d in range(size):
            w.kv[d, stage] = w.v1[d]
            w.ka[d, stage] = w.out[d]
        if energy_balance and 2 <= stage <= 5:
            of_ground, of_friction, of_ties = _powers(p, w, w.q1, w.v1, ah, av)
            work += WEIGHTS[6, stage] * of_ground
            friction_loss += WEIGHTS[6, stage] * of_friction
            tied += WEIGHTS[6, stage] * of_ties
    copy(p, w.out, w.a1)
    return work * h, friction_loss * h, tied * h


@kernel
def step_error(p, w, h):
    """Error of a step's velocities by the pair's own estimate over √(g b) [-]; large in Painlevé's cases.

    The estimate is the difference of the solutions of order 5 and 4 (Dormand and Prince, 1980, table 2), of the
    accelerations at the stages in ``w.ka``; ``h``: length of the step [s].
    """
    worst = 0.0
    for d in range(3 * p.count):
        off = (
            71.0 / 57600.0 * w.ka[d, 0]
            - 71.0 / 16695.0 * w.ka[d, 2]
            + 71.0 / 1920.0 * w.ka[d, 3]
        )
        off += (
            -17253.0 / 339200.0 * w.ka[d, 4]
            + 22.0 / 525.0 * w.ka[d, 5]
            - 0.025 * w.ka[d, 6]
        )
        worst = max(worst, abs(off) * (p.size if d % 3 == 2 else 1.0))
    return worst * h / p.speed


@kernel
def _powers(p, w, q, v, ah, av):
    """Power of the ground, and power lost to friction and given to ties, with the forces in ``w`` [W].

    ``q`` and ``v`` are coordinates and velocities, three a body, ``ah`` and ``av`` the ground's accelerations
    [m/s²]. What slides in a dish is pushed back by its slope too: that force is held, not lost.
    """
    work, lost, held = 0.0, 0.0, 0.0
    # contacts of bodies first, one under each, and then those of walls
    for k in range(p.contacts):
        if k < p.count:
            work -= p.mass[k] * (ah * v[3 * k] + av * v[3 * k + 1])
        if w.slides[k] != 0:
            end = 0 if w.closed[k, 0] == 1 else 1
            x, y, tx, ty, _, _, _ = end_of(p, w, q, k, end, w.kind[k, end])
            speed = rate(p, q, v, k, x, y, tx, ty)
            dish = 0.0
            if w.whole[k] == GUIDED:
                dish = slope(p, w, q, k) * (w.normal[k, 0] + w.normal[k, 1])
            held += dish * speed
            lost -= (w.shear[k] + dish) * speed
    return work, lost, held + power(p, w, q, v)


@kernel
def least_margin(p, w, q, v, forces):
    """Least of all that must stay positive (``docs/contact.md``, 4 to 6); ``w.fails`` says what is negative.

    With ``forces`` those in ``w`` count, without them motions alone do: gaps, edges, slips and falls.
    """
    least = math.inf
    for k in range(p.contacts):
        pressed = 0.0
        w.fails[k, FALL] = 0
        for end in range(2):
            w.fails[k, GAP + end] = w.fails[k, EDGE + end] = 0
            if w.closed[k, end] == 1:
                pressed += w.normal[k, end]
                margin = _margin_of_closed_end(p, w, q, k, end, forces)
            else:
                margin = _margin_of_open_end(p, w, q, k, end)
            least = min(least, margin)
        w.fails[k, FRICTION] = 0
        if w.closed[k].any():
            least = min(least, _margin_of_friction(p, w, q, v, k, forces, pressed))
        if k < p.count:
            least = min(least, _margin_of_fall(p, w, q, k))
    if p.is_held == 1:
        least = min(least, _least_of_holding(p, w, q, v, forces))
    return least


@kernel
def _margin_of_closed_end(p, w, q, k, end, forces):
    """Least margin of a closed end: its force over the weight, and how far its corner is from an edge [-].

    What is negative is noted in ``w.fails``: the force (GAP), the edge, and the fall of a body that hangs beside
    its face.
    """
    slides = w.slides[k] != 0
    margin = math.inf
    if forces and w.whole[k] == 0:
        # a force that friction multiplies counts as the shear that it brings about
        stiff = max(1.0, p.kinetic[k]) if slides else 1.0
        margin = stiff * w.normal[k, end] / p.weight + SLACK
    if margin < 0.0:
        w.fails[k, GAP + end] = 1
    has_edge = k > 0 and (k < p.count or p.wall_top[k] < math.inf)
    if not (has_edge and slides):
        return margin
    _, _, _, _, _, beyond, _ = end_of(p, w, q, k, end, w.kind[k, end])
    inside = AT_EDGE - beyond / p.size
    inside = (inside if w.kind[k, end] == CORNER else -inside) + TOUCH
    if inside < 0.0:
        w.fails[k, EDGE + end] = 1
    if inside < 0.0 and k < p.count:
        _, _, _, _, over, _, _ = end_of(p, w, q, k, end, CORNER)
        if over < -HANGING * p.size:
            w.fails[k, FALL] = 1
    return min(margin, inside)


@kernel
def _margin_of_open_end(p, w, q, k, end):
    """Least margin of an open end: its gap, and how far the base still reaches over the face, over b [-].

    A gap that has closed is noted in ``w.fails``.
    """
    _, _, _, _, gap, beyond, _ = end_of(p, w, q, k, end, EITHER)
    margin = gap / p.size + TOUCH
    if margin < 0.0:
        w.fails[k, GAP + end] = 1
    if k < p.count and beyond < -2.0 * p.half[k]:
        margin = min(margin, (2.0 * p.half[k] + beyond) / p.size)
    return margin


@kernel
def _margin_of_friction(p, w, q, v, k, forces, pressed):
    """Margin of a closed contact [-], noted in ``w.fails``: of its slip if it slides, of its shear if it sticks.

    Slip counts over √(g b), in its own direction; shear is what friction has left of µ ΣN, over the weight.
    ``pressed``: ΣN, sum of the normal forces of its ends [N].
    """
    margin = math.inf
    if w.slides[k] != 0:
        end = 0 if w.closed[k, 0] == 1 else 1
        x, y, tx, ty, _, _, _ = end_of(p, w, q, k, end, w.kind[k, end])
        slack = UNSLIPPED if any_closed(p, w) else TOUCH
        margin = w.slides[k] * rate(p, q, v, k, x, y, tx, ty) / p.speed + slack
    elif forces and w.whole[k] != BONDED:
        shear = w.shear[k] + slope(p, w, q, k) * pressed
        margin = p.static[k] * pressed - abs(shear)
        margin = margin / (p.weight * max(p.static[k], 1.0)) + SLACK
    if margin < 0.0:
        w.fails[k, FRICTION] = 1
    return margin


@kernel
def _margin_of_fall(p, w, q, k):
    """Angle that body k has left to a right angle, from upright and from the body below [rad].

    A fall is noted in ``w.fails``: where that angle is used up, or the base has left the edge of the face below.
    """
    rotation = q[3 * k + 2]
    turned = abs(rotation)
    if k > 0:
        rotation_below = q[3 * k - 1]
        turned = max(turned, abs(rotation - rotation_below))
    margin = 0.5 * math.pi - turned
    # what sticks with an end closed stays over the face until it has turned
    holds = w.closed[k].any() and w.slides[k] == 0
    if k > 0 and not holds and off_the_edge(p, w, q, k):
        w.fails[k, FALL] = 1
    if margin < 0.0:
        w.fails[k, FALL] = 1
    return margin


@kernel
def _least_of_holding(p, w, q, v, forces):
    """Least margin of what holds bodies [-]: ties, supports, bonds, and low walls that a body may climb.

    With ``forces`` those that bonds bear count too; ``w.fails`` says which bond breaks, and what passes a wall.
    """
    least = min(least_tie_margin(p, w, q, v), least_support_margin(p, w, q, v))
    for k in range(p.contacts):
        w.fails[k, BREAK] = 0
        if forces and w.whole[k] == BONDED:
            margin = bond_margin(p, w, k)
            w.fails[k, BREAK] = 1 if margin < 0.0 else 0
            least = min(least, margin)
        if k >= p.count and w.closed[k].any() and has_left(p, w, q, k):
            # it no longer rests on the wall
            w.fails[k, BREAK] = 1
            least = -TOUCH
        if k >= p.count and climbs(p, w, q, k):
            w.fails[k, FALL] = 1
            least = -TOUCH
    return least


@kernel
def off_the_edge(p, w, q, k):
    """Whether the base above interface k no longer reaches over the face below."""
    for end in range(2):
        _, _, _, _, _, beyond, _ = end_of(p, w, q, k, end, CORNER)
        if beyond < AT_EDGE * p.size - 2.0 * p.half[k]:
            return True
    return False


@kernel
def force_fails(p, w):
    """Whether one of the failing channels in ``w.fails`` is of a force."""
    for k in range(p.contacts):
        if w.fails[k, BREAK] == 1 and w.whole[k] == BONDED:
            return True
        if w.fails[k, FRICTION] == 1 and w.slides[k] == 0:
            return True
        for end in range(2):
            if w.fails[k, GAP + end] == 1 and w.closed[k, end] == 1:
                return True
    return False


@kernel
def margin_at(p, w, tau, stretch, forces):
    """Least margin at the fraction ``tau`` of the step; w.q and w.v are then those of that instant.

    They lie on the quintic that has the coordinates, velocities and accelerations of both ends of the step.
    Without ``forces`` it is that of motions alone, which needs no equations to be solved.
    """
    h, t2 = stretch.length, tau * tau
    t3 = t2 * tau
    for d in range(3 * p.count):
        q0, v0, a0 = w.q0[d], h * w.v0[d], 0.5 * h * h * w.a0[d]
        v1, a1 = h * w.v1[d], 0.5 * h * h * w.a1[d]
        rise = w.q1[d] - q0 - v0 - a0
        turn = v1 - v0 - 2.0 * a0
        bend = a1 - a0
        # coefficients of τ³ to τ⁵
        c3 = 10.0 * rise - 4.0 * turn + bend
        c4 = -15.0 * rise + 7.0 * turn - 2.0 * bend
        c5 = 6.0 * rise - 3.0 * turn + bend
        w.q[d] = q0 + v0 * tau + a0 * t2 + t3 * (c3 + tau * (c4 + tau * c5))
        w.v[d] = (
            v0 + 2.0 * a0 * tau + t2 * (3.0 * c3 + tau * (4.0 * c4 + 5.0 * tau * c5))
        ) / h
    look_at(p, w, w.q)
    if forces:
        ah, av = ground_at(stretch, tau)
        solve_motion(p, w, w.q, w.v, ah, av)
    return least_margin(p, w, w.q, w.v, forces)


@kernel
def first_failure(p, w, failure, stretch):
    """Find the fraction of the step just after the least margin has become negative, and go to the state there.

    Where no force is among what fails, motions alone are followed on the way, which needs no equations to be
    solved; if a force turns out to fail at the instant found, it is sought again with forces.

    Parameters
    ----------
    p, w : records ``BODY`` and ``WORK``
    failure : a fraction of the step, the negative margin there, and whether a force is among what fails
    stretch : the step and its ground

    Returns
    -------
    The fraction [-].
    """
    high, at_high, by_force = failure
    if not by_force:
        at_low = margin_at(p, w, 0.0, stretch, MOTIONS)
        high = _root(p, w, (at_low, high, at_high), stretch, MOTIONS)
        at_high = margin_at(p, w, high, stretch, FORCES)
        if not force_fails(p, w):
            return high
    at_low = margin_at(p, w, 0.0, stretch, FORCES)
    high = _root(p, w, (at_low, high, at_high), stretch, FORCES)
    margin_at(p, w, high, stretch, FORCES)
    return high


@kernel
def _root(p, w, bracket, stretch, forces):
    """Fraction of the step just after the least margin has become negative, by Chandrupatla's method.

    ``bracket``: margin at the beginning, a fraction of the step, and the margin there.  The least of several
    margins has kinks, and often starts at its slack and rises before it falls: a parabola is trusted only where
    the last three values allow it, and the interval is halved elsewhere (T. R. Chandrupatla, Advances in
    Engineering Software 28, 1997, 145-149).
    """
    at_low, high, at_high = bracket
    if at_low < 0.0:
        return 0.0
    x1, f1, x2, f2 = high, at_high, 0.0, at_low
    part = 0.5
    while True:
        x = x1 + part * (x2 - x1)
        value = margin_at(p, w, x, stretch, forces)
        if (value < 0.0) == (f1 < 0.0):
            x3, f3 = x1, f1
        else:
            x3, f3 = x2, f2
            x2, f2 = x1, f1
        x1, f1 = x, value
        width = abs(x2 - x1)
        if width <= WIDTH:
            return x1 if f1 < 0.0 else x2
        # bisection, unless the inverse parabola through three points is to be trusted
        part = 0.5
        xi, phi = (x1 - x2) / (x3 - x2), (f1 - f2) / (f3 - f2)
        if phi * phi < xi and (1.0 - phi) * (1.0 - phi) < 1.0 - xi:
            part = f1 / (f2 - f1) * (f3 / (f2 - f3))
            part += (x3 - x1) / (x2 - x1) * (f1 / (f3 - f1)) * (f2 / (f3 - f2))
        least = 0.5 * WIDTH / width
        part = min(max(part, least), 1.0 - least)


@kernel
def comes_near(p, w, length):
    """Whether in a step a gap first narrowed and widens as it ends, after ``look_at`` with ``w.q1``.

    ``w.early`` has the speed at which each gap opened as the step began [m/s], 0 for ends that were closed;
    ``length``: of the step [s].
    """
    if p.ties > 0 and turns_back(p, w, length):
        return True
    for k in range(p.contacts):
        for end in range(2):
            if w.early[k, end] < 0.0:
                x, y, tx, ty, gap, _, _ = end_of(p, w, w.q1, k, end, EITHER)
                if k >= p.count and gap > -w.early[k, end] * length:
                    # it cannot have come as far as the wall
                    continue
                if rate(p, w.q1, w.v1, k, x, y, -ty, tx) > 0.0:
                    return True
    return False
