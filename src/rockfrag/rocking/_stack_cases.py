"""Cases in flight: what each carries, what an event makes of it, and where it goes between events.

A case is a body × motion × scale.  There are SLOTS of them in flight, and ``t`` holds the tables of their bodies.
"""

import math

import numpy as np

from rockfrag.rocking import _one_rotation as one
from rockfrag.rocking import _two_rotations as two
from rockfrag.rocking._compile import inlined_kernel, kernel
from rockfrag.rocking._events import COARSE_DROP, MAX_EVENTS_PER_STEP, let_go, rest_interval, strike
from rockfrag.rocking._intrinsics import take_next
from rockfrag.rocking._mechanics import (
    first_moment2,
    ground_hold,
    interface_hold,
    kinetic_energy,
    pole,
    potential_energy,
    settle,
)
from rockfrag.rocking._pendulum import HALF_TURN
from rockfrag.rocking._rest import uplift
from rockfrag.rocking._series import slope, value
from rockfrag.rocking._stack_impacts import land, meet
from rockfrag.rocking._stack_table import (
    LANES,
    ONE_COLUMNS,
    RELEASE,
    RESTORING_AT,
    TWO_COLUMNS,
    body_table,
    state,
)
from rockfrag.rocking._step import TH1 as SERIES1
from rockfrag.rocking._step import TH2 as SERIES2
from rockfrag.rocking._tally import balance, barrier

SLOTS = 2 * LANES

CASE = np.dtype(
    [
        # number of the case, -1 for none; its body, and where the table of that begins
        ("number", np.int64), ("body", np.int64), ("table", np.int64),
        # sampling interval [s], the largest part of it that a step of two rotations may take, and the scale
        ("interval", np.float64), ("part", np.float64), ("factor", np.float64),
        # ground accelerations between which the body rests, and the least energy that overturns it
        ("low", np.float64), ("high", np.float64), ("barrier", np.float64),
        # samples: of its motion the first and the last, and the last of free rocking
        ("first", np.int64), ("last", np.int64), ("free_last", np.int64),
        # the sample it has reached, and the time since then
        ("k", np.int64), ("tau", np.float64),
        # the state, with rates per sample
        ("c1", np.int64), ("c2", np.int64),
        ("theta1", np.float64), ("rate1", np.float64), ("theta2", np.float64), ("rate2", np.float64),
        # of its last event the ground acceleration, the sample, and how many that sample has had
        ("now", np.float64), ("crowded", np.int64), ("crowd", np.int64),
        # extremes so far, as in the rows of the lanes; impacts; what fell, 1 the pedestal, 2 the statue
        ("peak1", np.float64), ("peak2", np.float64), ("fast", np.float64), ("near", np.float64),
        ("impacts", np.int64), ("fallen", np.int64),
    ],
    align=True,
)  # fmt: skip
"""A case in flight; time is counted in samples."""

OUTCOME = np.dtype(
    [
        # what fell, and the number of samples after which that was certain
        ("fallen", np.int64), ("certain", np.int64),
        # extremes, with the distance from balance itself; impacts
        ("peak1", np.float64), ("peak2", np.float64), ("fast", np.float64), ("closest", np.float64),
        ("impacts", np.int64),
    ],
    align=True,
)  # fmt: skip
"""What remains of a case."""


@inlined_kernel
def kind_of(case):
    """Which lanes a case needs: 0 for those of one rotation, 1 for those of two; -1 for none."""
    if case.number < 0:
        return -1
    return 1 if case.c1 != 0 and case.c2 != 0 else 0


@inlined_kernel
def goes_on(case):
    """Whether a case rocks on within its motion."""
    return case.fallen == 0 and case.k < case.last and (case.c1 != 0 or case.c2 != 0)


@kernel
def carry_on(
    case, t, counter, count, bodies, intervals, parts, free, factors, rows, offsets, lasts, samples,
    highest, lowest, outcomes,
):  # fmt: skip
    """Take a slot through rest and the ends of motions, and through as many cases as end there."""
    n_motions, n_scales = factors.shape
    while True:
        if case.number >= 0 and case.fallen == 0:
            p = bodies[case.body]
            if case.c1 == 0 and case.c2 == 0:
                if case.k < case.last and case.factor != 0.0:
                    k, tau, now = uplift(
                        case.k, case.tau, case.low, case.high, case.factor, samples, highest, lowest,
                        case.last,
                    )  # fmt: skip
                    if k >= 0:
                        case.k, case.tau = k, tau
                        case.c1, case.c2 = _rise(p, case.c1, case.c2, now)
                        case.theta1, case.rate1, case.theta2, case.rate2 = 0.0, 0.0, 0.0, 0.0
                        return
            elif case.k < case.last or (case.k < case.free_last and not _safe(p, case)):
                return
        if case.number >= 0:
            outcome = outcomes[case.number]
            outcome.fallen = case.fallen
            outcome.certain = case.k - case.first
            outcome.peak1, outcome.peak2 = case.peak1, case.peak2
            outcome.fast, outcome.closest = case.fast, math.sqrt(case.near)
            outcome.impacts = case.impacts
        number = take_next(counter)
        if number >= count:
            case.number = -1
            return
        motion = (number // n_scales) % n_motions
        body = number // (n_scales * n_motions)
        h = intervals[body, motion]
        if case.body != body or case.interval != h:
            p = bodies[body]
            body_table(p, h, t, case.table)
            case.low, case.high = rest_interval(p)
            case.barrier = barrier(p)
        case.number, case.body, case.interval = number, body, h
        case.part = parts[body, motion]
        case.factor = factors[motion, number % n_scales]
        sampled = rows[body, motion]
        case.first, case.last = offsets[sampled], lasts[sampled]
        case.free_last = case.last + free[body, motion]
        case.k, case.tau = case.first, 0.0
        case.c1, case.c2, case.fallen, case.crowded, case.impacts = 0, 0, 0, -1, 0
        case.peak1, case.peak2, case.fast, case.near = 0.0, 0.0, 0.0, math.inf


@kernel
def _rise(p, c1, c2, a):
    """Contact state that a body at rest, c1 = c2 = 0, takes at or beyond the threshold ``a``."""
    c1, c2 = settle(p, c1, c2, 0.0, 0.0, 0.0, 0.0, a)
    if c1 == 0 and c2 == 0:
        # rounding at the threshold: open the contact with the least hold
        hold1, corner1 = ground_hold(p, c2, 0.0, 0.0, 0.0, a, 0.0)
        hold2, corner2 = interface_hold(p, c1, 0.0, 0.0, 0.0, 0.0, a, 0.0)
        if hold1 <= hold2:
            return corner1, 0
        return 0, corner2
    return c1, c2


@kernel
def _safe(p, case):
    """Whether nothing can fall once the ground is still: energy cannot grow and does not suffice."""
    c1, c2, h = case.c1, case.c2, case.interval
    theta1, theta2 = case.theta1, case.theta2
    energy = kinetic_energy(p, c1, c2, theta1, case.rate1 / h, theta2, case.rate2 / h)
    energy += potential_energy(p, c1, c2, theta1, theta2)
    if energy >= case.barrier:
        return False
    # low energy on this side of balance, not beyond it
    if c2 != 0:
        vx, vy = first_moment2(p, pole(c2))
        if c2 * theta2 >= math.atan2(-c2 * vx, vy):
            return False
    if c1 != 0:
        critical, _, _, _ = balance(p, c1, c2)
        if c1 * theta1 >= critical:
            return False
    return True


@inlined_kernel
def _count_event(case):
    """Count an event of a case within its sample."""
    if case.crowded != case.k:
        case.crowded = case.k
        case.crowd = 0
    case.crowd += 1


@inlined_kernel
def _forced(case):
    """Whether its sample has had so many events that contacts must stay closed."""
    return case.crowd > MAX_EVENTS_PER_STEP


@kernel
def strike_case(case, t, p, closes1, closes2, closing_speed, samples, summary):
    """Contacts and velocities after contacts close, as single simulations find them."""
    h = case.interval
    n1, n2, v1, v2, _ = strike(
        p, case.c1, case.c2, closes1, closes2, case.theta1, case.rate1 / h, case.theta2, case.rate2 / h,
        case.now, closing_speed, _forced(case), COARSE_DROP, t, case.table + RESTORING_AT,
        case.k, case.tau, h, samples, case.last, case.factor, summary,
    )  # fmt: skip
    case.c1, case.c2, case.rate1, case.rate2 = n1, n2, v1 * h, v2 * h


@inlined_kernel
def pass_event(case):
    """Take a case that has been through its event, or to the end of its step, to the sample that it is in."""
    stuck = case.crowded == case.k and case.crowd > MAX_EVENTS_PER_STEP + 20
    if case.tau >= 1.0 - 1e-13 or stuck:
        case.tau = 0.0
        case.k += 1
    if abs(case.theta1) >= HALF_TURN:
        case.fallen = 1
    elif max(abs(case.theta2), abs(case.theta2 - case.theta1)) >= HALF_TURN:
        case.fallen = 2


@inlined_kernel
def event_of_one(i, case, x, t, q, bodies, samples, g, closing_speed):
    """Take a case in lane i of those of one rotation to its event or to the step's end, and through the event.

    Returns
    -------
    Whether ground and interface close and ``strike_case`` has to say what comes of it.
    """
    if x[one.FLAG + i] == RELEASE and x[one.BEFORE + i] == 1.0:
        # it let go in the sample before
        one.go_back(x, i, g)
        case.k -= 1
    one.take_series(x, i, q)
    c1, c2 = case.c1, case.c2
    o = state(case.table, c1, c2)
    left = x[one.WAS_LEFT + i]
    when, fails = one.next_event(t, o, x, i, q, g)
    at = min(1.0, when)
    theta, omega = value(q, SERIES1, at), slope(q, SERIES1, at) / left
    peak, case.fast, case.near = one.nearest(t, o, x, i, theta, omega)
    if c2 == 0:
        case.peak1 = peak
        case.theta1, case.rate1 = theta, omega
    else:
        case.peak2 = peak
        case.theta1, case.rate1 = 0.0, 0.0
    case.theta2, case.rate2 = theta, omega
    case.tau = 1.0
    if when > 1.0:
        return False, False
    case.tau -= left * (1.0 - at)
    now = x[one.WAS_GROUND + i] + (x[one.GROUND_END + i] - x[one.WAS_GROUND + i]) * at
    case.now = now
    p, h = bodies[case.body], case.interval
    _count_event(case)
    if fails:
        case.c1, case.c2 = let_go(
            p, 1 if c1 == 0 else 2, at == 0.0, c1, c2, case.theta1, case.rate1 / h, theta, omega / h, now
        )  # fmt: skip
        return False, False
    case.impacts += 1
    case.theta1, case.theta2 = 0.0, 0.0
    if _forced(case) or not land(case, p, t, g, closing_speed, samples):
        return c1 != 0, c2 != 0
    return False, False


@inlined_kernel
def event_of_two(i, case, x, t, q, bodies, samples, g, closing_speed):
    """Likewise of a case in lane i of those of two rotations."""
    two.take_series(x, i, q)
    c1, c2 = case.c1, case.c2
    left, span = x[two.WAS_LEFT + i], two.span_of(x, i)
    when, closes1, closes2 = two.next_event(c1, c2, x, i, q)
    at = min(1.0, when)
    t1, w1 = value(q, SERIES1, at), slope(q, SERIES1, at) / span
    t2, w2 = value(q, SERIES2, at), slope(q, SERIES2, at) / span
    case.peak1, case.peak2, case.fast, case.near = two.nearest(
        t, state(case.table, c1, c2), x, i, t1, w1, t2, w2
    )
    case.tau = 1.0 - left + span * at
    case.theta1, case.rate1, case.theta2, case.rate2 = t1, w1, t2, w2
    if when > 1.0:
        return False, False
    case.now = x[two.WAS_GROUND + i] + (x[two.GROUND_END + i] - x[two.WAS_GROUND + i]) * (
        at * span / left
    )
    _count_event(case)
    if closes1:
        t1 = 0.0
    if closes2:
        t2 = t1
    case.theta1, case.theta2 = t1, t2
    case.impacts += 1
    if (
        closes1 == closes2
        or bodies[case.body].measured
        or _forced(case)
        or not meet(case, t, closes1, g, closing_speed, samples)
    ):
        return closes1, closes2
    return False, False


@inlined_kernel
def place_one(i, case, x, t, samples):
    """Place a case into lane i of those of one rotation."""
    o = state(case.table, case.c1, case.c2)
    for m in range(ONE_COLUMNS):
        x[m * LANES + i] = t[o + m]
    x[one.SIGN + i] = case.c1 + case.c2
    x[one.THETA + i], x[one.OMEGA + i] = case.theta2, case.rate2
    x[one.FACTOR + i], x[one.LEFT + i] = case.factor, 1.0 - case.tau
    x[one.GROUND + i], x[one.GROUND_END + i] = _ground(case, samples)
    x[one.STEPS + i] = 0.0
    x[one.RATIO + i] = case.peak1 if case.c2 == 0 else case.peak2
    x[one.FAST + i], x[one.NEAR + i] = case.fast, case.near


@inlined_kernel
def place_two(i, case, x, t, samples):
    """Place a case into lane i of those of two rotations."""
    o = state(case.table, case.c1, case.c2)
    for m in range(TWO_COLUMNS):
        x[m * LANES + i] = t[o + m]
    x[two.SIGN1 + i], x[two.SIGN2 + i] = case.c1, case.c2
    x[two.TH1 + i], x[two.RATE1 + i] = case.theta1, case.rate1
    x[two.TH2 + i], x[two.RATE2 + i] = case.theta2, case.rate2
    x[two.FACTOR + i], x[two.LEFT + i], x[two.PART + i] = case.factor, 1.0 - case.tau, case.part
    x[two.GROUND + i], x[two.GROUND_END + i] = _ground(case, samples)
    x[two.RATIO1 + i], x[two.RATIO2 + i] = case.peak1, case.peak2
    x[two.FAST + i], x[two.NEAR + i] = case.fast, case.near


@inlined_kernel
def _ground(case, samples):
    """Acceleration of the ground at the time of a case and at the end of its sample."""
    before = case.factor * samples[case.k] if case.k <= case.last else 0.0
    after = case.factor * samples[case.k + 1] if case.k < case.last else 0.0
    return before + case.tau * (after - before), after


@inlined_kernel
def store_one(i, case, x):
    """Store what lane i of those of one rotation has reached at the end of a sample."""
    theta, omega = x[one.THETA + i], x[one.OMEGA + i]
    case.theta2, case.rate2 = theta, omega
    if case.c2 == 0:
        case.theta1, case.rate1, case.peak1 = theta, omega, x[one.RATIO + i]
    else:
        case.theta1, case.rate1, case.peak2 = 0.0, 0.0, x[one.RATIO + i]
    case.fast, case.near, case.tau = x[one.FAST + i], x[one.NEAR + i], 0.0


@inlined_kernel
def store_two(i, case, x):
    """Likewise of those of two rotations."""
    case.theta1, case.rate1 = x[two.TH1 + i], x[two.RATE1 + i]
    case.theta2, case.rate2 = x[two.TH2 + i], x[two.RATE2 + i]
    case.peak1, case.peak2 = x[two.RATIO1 + i], x[two.RATIO2 + i]
    case.fast, case.near, case.tau = x[two.FAST + i], x[two.NEAR + i], 0.0
