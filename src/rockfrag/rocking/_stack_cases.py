"""Cases in flight: what each carries, what an event makes of it, and where it goes between events.

A case is a body × motion × scale.  There are SLOTS of them in flight; slot j keeps its numbers in the rows of
two flat arrays, ``s`` of floats and ``n`` of integers, and the table of its body in ``t``.
"""

import math

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
    potential_energy,
    settle,
)
from rockfrag.rocking._pendulum import HALF_TURN
from rockfrag.rocking._rest import uplift
from rockfrag.rocking._series import slope, value
from rockfrag.rocking._stack_impacts import land, meet
from rockfrag.rocking._stack_table import (
    HAS_MEASURED,
    LANES,
    ONE_COLUMNS,
    RELEASE,
    RESTORING_AT,
    TABLE,
    TWO_COLUMNS,
    body_table,
    state,
)
from rockfrag.rocking._step import TH1 as SERIES1
from rockfrag.rocking._step import TH2 as SERIES2
from rockfrag.rocking._tally import balance, barrier

SLOTS = 2 * LANES

(
    TH1,  # the state, rates per sample
    RATE1,
    TH2,
    RATE2,
    TAU,  # time since sample K
    FACTOR,
    INTERVAL,  # sampling interval [s]
    PART,  # the largest part of it that a step of two rotations may take
    LOW,  # ground accelerations between which the body rests
    HIGH,
    BARRIER,  # least energy that overturns the body
    PEAK1,  # extremes so far, as in the rows of the lanes
    PEAK2,
    FAST,
    NEAR,
    HITS,
) = (SLOTS * row for row in range(16))
FLOATS = 16 * SLOTS

(
    CASE,  # -1 for none
    K,  # the sample it has reached, its motion's last one, that of the end of free rocking, and the first
    END,
    FREE_END,
    START,
    BODY,
    C1,
    C2,
    FELL,  # 1 the pedestal, 2 the statue
    CROWDED,  # the sample of the last event, and how many it has had
    CROWD,
) = (SLOTS * row for row in range(11))
INTEGERS = 11 * SLOTS

# Columns of the results.
R_FALLEN, R_CERTAIN, R_PEAK1, R_PEAK2, R_SPEED, R_IMPACTS, R_CLOSEST = range(7)
RESULTS = 7


@inlined_kernel
def kind_of(n, j):
    """Which lanes the case of slot j needs: 0 for those of one rotation, 1 for those of two; -1 for none."""
    if n[CASE + j] < 0:
        return -1
    return 1 if n[C1 + j] != 0 and n[C2 + j] != 0 else 0


@inlined_kernel
def goes_on(n, j):
    """Whether the case of slot j rocks on within its motion."""
    return n[FELL + j] == 0 and n[K + j] < n[END + j] and (n[C1 + j] != 0 or n[C2 + j] != 0)


@kernel
def carry_on(
    j, s, n, t, counter, count, parameters, intervals, parts, free, factors, rows, offsets, lasts, samples,
    highest, lowest, results,
):  # fmt: skip
    """Take slot j through rest and the ends of motions, and through as many cases as end there."""
    n_motions, n_scales = factors.shape
    while True:
        case = n[CASE + j]
        if case >= 0 and n[FELL + j] == 0:
            p = parameters[n[BODY + j]]
            k, end, factor = n[K + j], n[END + j], s[FACTOR + j]
            if n[C1 + j] == 0 and n[C2 + j] == 0:
                if k < end and factor != 0.0:
                    k, tau, now = uplift(
                        k,
                        s[TAU + j],
                        s[LOW + j],
                        s[HIGH + j],
                        factor,
                        samples,
                        highest,
                        lowest,
                        end,
                    )
                    if k >= 0:
                        n[K + j], s[TAU + j] = k, tau
                        n[C1 + j], n[C2 + j] = _rise(p, n[C1 + j], n[C2 + j], now)
                        s[TH1 + j], s[RATE1 + j], s[TH2 + j], s[RATE2 + j] = 0.0, 0.0, 0.0, 0.0
                        return
            elif k < end or (k < n[FREE_END + j] and not _safe(p, s, n, j)):
                return
        if case >= 0:
            result = results[case]
            result[R_FALLEN] = n[FELL + j]
            result[R_CERTAIN] = n[K + j] - n[START + j]
            result[R_PEAK1] = s[PEAK1 + j]
            result[R_PEAK2] = s[PEAK2 + j]
            result[R_SPEED] = s[FAST + j]
            result[R_IMPACTS] = s[HITS + j]
            result[R_CLOSEST] = math.sqrt(s[NEAR + j])
        case = take_next(counter)
        if case >= count:
            n[CASE + j] = -1
            return
        motion = (case // n_scales) % n_motions
        body = case // (n_scales * n_motions)
        h = intervals[body, motion]
        if n[BODY + j] != body or s[INTERVAL + j] != h:
            p = parameters[body]
            body_table(p, h, t, TABLE * j)
            s[LOW + j], s[HIGH + j] = rest_interval(p)
            s[BARRIER + j] = barrier(p)
        n[CASE + j], n[BODY + j], s[INTERVAL + j] = case, body, h
        s[PART + j] = parts[body, motion]
        s[FACTOR + j] = factors[motion, case % n_scales]
        sampled = rows[body, motion]
        n[START + j] = n[K + j] = offsets[sampled]
        n[END + j] = lasts[sampled]
        n[FREE_END + j] = lasts[sampled] + free[body, motion]
        n[C1 + j], n[C2 + j], n[FELL + j], n[CROWDED + j] = 0, 0, 0, -1
        s[TAU + j], s[HITS + j] = 0.0, 0.0
        s[PEAK1 + j], s[PEAK2 + j], s[FAST + j], s[NEAR + j] = 0.0, 0.0, 0.0, math.inf


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
def _safe(p, s, n, j):
    """Whether nothing can fall once the ground is still: energy cannot grow and does not suffice."""
    c1, c2, h = n[C1 + j], n[C2 + j], s[INTERVAL + j]
    theta1, theta2 = s[TH1 + j], s[TH2 + j]
    energy = kinetic_energy(p, c1, c2, theta1, s[RATE1 + j] / h, theta2, s[RATE2 + j] / h)
    energy += potential_energy(p, c1, c2, theta1, theta2)
    if energy >= s[BARRIER + j]:
        return False
    # low energy on this side of balance, not beyond it
    if c2 != 0:
        vx, vy = first_moment2(p, c2)
        if c2 * theta2 >= math.atan2(-c2 * vx, vy):
            return False
    if c1 != 0:
        critical, _, _, _ = balance(p, c1, c2)
        if c1 * theta1 >= critical:
            return False
    return True


@inlined_kernel
def _crowded(n, j):
    """Count an event of slot j; whether its sample has had so many that contacts must stay closed."""
    if n[CROWDED + j] != n[K + j]:
        n[CROWDED + j] = n[K + j]
        n[CROWD + j] = 0
    n[CROWD + j] += 1
    return n[CROWD + j] > MAX_EVENTS_PER_STEP


@inlined_kernel
def _put(s, n, j, c1, c2, t1, w1, t2, w2, tau):
    """Put the state after an event, or at the end of the step, into slot j."""
    stuck = n[CROWDED + j] == n[K + j] and n[CROWD + j] > MAX_EVENTS_PER_STEP + 20
    if tau >= 1.0 - 1e-13 or stuck:
        tau = 0.0
        n[K + j] += 1
    n[C1 + j], n[C2 + j] = c1, c2
    s[TH1 + j], s[RATE1 + j], s[TH2 + j], s[RATE2 + j], s[TAU + j] = t1, w1, t2, w2, tau
    if abs(t1) >= HALF_TURN:
        n[FELL + j] = 1
    elif max(abs(t2), abs(t2 - t1)) >= HALF_TURN:
        n[FELL + j] = 2


@kernel
def strike_case(
    s, n, j, t, p, closes1, closes2, c1, c2, t1, w1, t2, w2, now, closing_speed, forced, k, tau, samples,
    summary,
):  # fmt: skip
    """Contacts and velocities after contacts close, as single simulations find them."""
    h = s[INTERVAL + j]
    n1, n2, v1, v2, _ = strike(
        p, c1, c2, closes1, closes2, t1, w1 / h, t2, w2 / h, now, closing_speed, forced, COARSE_DROP,
        t[TABLE * j + RESTORING_AT :], k, tau, h, samples, n[END + j], s[FACTOR + j], summary,
    )  # fmt: skip
    return n1, n2, v1 * h, v2 * h


@inlined_kernel
def event_of_one(i, j, x, s, n, t, q, parameters, samples, g, closing_speed, summary):
    """Take the case of slot j, in lane i of those of one rotation, through its event or to the step's end."""
    if x[one.FLAG + i] == RELEASE and x[one.BEFORE + i] == 1.0:
        # it let go in the sample before
        one.go_back(x, i, g)
        n[K + j] -= 1
    one.take_series(x, i, q)
    c1, c2 = n[C1 + j], n[C2 + j]
    o = state(TABLE * j, c1, c2)
    left = x[one.WAS_LEFT + i]
    when, fails = one.next_event(t, o, x, i, q, g)
    at = min(1.0, when)
    theta, omega = value(q, SERIES1, at), slope(q, SERIES1, at) / left
    s[_peak(c2) + j], s[FAST + j], s[NEAR + j] = one.nearest(t, o, x, i, theta, omega)
    t1, w1 = (theta, omega) if c2 == 0 else (0.0, 0.0)
    t2, w2 = theta, omega
    tau = 1.0
    if when <= 1.0:
        tau -= left * (1.0 - at)
        now = x[one.WAS_GROUND + i] + (x[one.GROUND_END + i] - x[one.WAS_GROUND + i]) * at
        p = parameters[n[BODY + j]]
        h = s[INTERVAL + j]
        forced = _crowded(n, j)
        if fails:
            c1, c2 = let_go(p, 1 if c1 == 0 else 2, at == 0.0, c1, c2, t1, w1 / h, t2, w2 / h, now)
        else:
            s[HITS + j] += 1.0
            k = n[K + j]
            done, n1, n2, v1, v2 = land(
                p, t, TABLE * j, c1, c2, omega, now, closing_speed, k, tau, h, samples, n[END + j],
                s[FACTOR + j],
            )  # fmt: skip
            if forced or not done:
                n1, n2, v1, v2 = strike_case(
                    s, n, j, t, p, c1 != 0, c2 != 0, c1, c2, 0.0, w1, 0.0, w2, now, closing_speed, forced,
                    k, tau, samples, summary,
                )  # fmt: skip
            c1, c2, t1, w1, t2, w2 = n1, n2, 0.0, v1, 0.0, v2
    _put(s, n, j, c1, c2, t1, w1, t2, w2, tau)


@inlined_kernel
def event_of_two(i, j, x, s, n, t, q, parameters, samples, g, closing_speed, summary):
    """Take the case of slot j, in lane i of those of two rotations, through its event or to the step's end."""
    two.take_series(x, i, q)
    c1, c2 = n[C1 + j], n[C2 + j]
    left, span = x[two.WAS_LEFT + i], two.span_of(x, i)
    when, closes1, closes2 = two.next_event(c1, c2, x, i, q)
    at = min(1.0, when)
    t1, w1 = value(q, SERIES1, at), slope(q, SERIES1, at) / span
    t2, w2 = value(q, SERIES2, at), slope(q, SERIES2, at) / span
    s[PEAK1 + j], s[PEAK2 + j], s[FAST + j], s[NEAR + j] = two.nearest(
        t, state(TABLE * j, c1, c2), x, i, t1, w1, t2, w2
    )
    tau = 1.0 - left + span * at
    if when <= 1.0:
        now = x[two.WAS_GROUND + i] + (x[two.GROUND_END + i] - x[two.WAS_GROUND + i]) * (
            at * span / left
        )
        forced = _crowded(n, j)
        if closes1:
            t1 = 0.0
        if closes2:
            t2 = t1
        s[HITS + j] += 1.0
        k = n[K + j]
        done, n1, n2, v1, v2 = False, 0, 0, 0.0, 0.0
        if closes1 != closes2 and t[TABLE * j + HAS_MEASURED] == 0.0 and not forced:
            done, n1, n2, v1, v2 = meet(
                t, TABLE * j, closes1, c1, c2, t1, w1, t2, w2, g, closing_speed, k, tau, s[INTERVAL + j],
                samples, n[END + j], s[FACTOR + j],
            )  # fmt: skip
        if not done:
            n1, n2, v1, v2 = strike_case(
                s, n, j, t, parameters[n[BODY + j]], closes1, closes2, c1, c2, t1, w1, t2, w2, now,
                closing_speed, forced, k, tau, samples, summary,
            )  # fmt: skip
        c1, c2, w1, w2 = n1, n2, v1, v2
    _put(s, n, j, c1, c2, t1, w1, t2, w2, tau)


@inlined_kernel
def _peak(c2):
    """Where a slot keeps the largest rotation of what rotates alone."""
    return PEAK1 if c2 == 0 else PEAK2


@inlined_kernel
def place_one(i, j, x, s, n, t, samples):
    """Place the case of slot j into lane i of those of one rotation."""
    c1, c2 = n[C1 + j], n[C2 + j]
    o = state(TABLE * j, c1, c2)
    for m in range(ONE_COLUMNS):
        x[m * LANES + i] = t[o + m]
    x[one.SIGN + i] = c1 + c2
    x[one.THETA + i], x[one.OMEGA + i] = s[TH2 + j], s[RATE2 + j]
    x[one.FACTOR + i], x[one.LEFT + i] = s[FACTOR + j], 1.0 - s[TAU + j]
    x[one.GROUND + i], x[one.GROUND_END + i] = _ground(s, n, j, samples)
    x[one.STEPS + i] = 0.0
    x[one.RATIO + i], x[one.FAST + i], x[one.NEAR + i] = s[_peak(c2) + j], s[FAST + j], s[NEAR + j]


@inlined_kernel
def place_two(i, j, x, s, n, t, samples):
    """Place the case of slot j into lane i of those of two rotations."""
    c1, c2 = n[C1 + j], n[C2 + j]
    o = state(TABLE * j, c1, c2)
    for m in range(TWO_COLUMNS):
        x[m * LANES + i] = t[o + m]
    x[two.SIGN1 + i], x[two.SIGN2 + i] = c1, c2
    x[two.TH1 + i], x[two.RATE1 + i] = s[TH1 + j], s[RATE1 + j]
    x[two.TH2 + i], x[two.RATE2 + i] = s[TH2 + j], s[RATE2 + j]
    x[two.FACTOR + i], x[two.LEFT + i], x[two.PART + i] = (
        s[FACTOR + j],
        1.0 - s[TAU + j],
        s[PART + j],
    )
    x[two.GROUND + i], x[two.GROUND_END + i] = _ground(s, n, j, samples)
    x[two.RATIO1 + i], x[two.RATIO2 + i] = s[PEAK1 + j], s[PEAK2 + j]
    x[two.FAST + i], x[two.NEAR + i] = s[FAST + j], s[NEAR + j]


@inlined_kernel
def _ground(s, n, j, samples):
    """Acceleration of the ground at the time of slot j and at the end of its sample."""
    k, end, factor = n[K + j], n[END + j], s[FACTOR + j]
    before = factor * samples[k] if k <= end else 0.0
    after = factor * samples[k + 1] if k < end else 0.0
    return before + s[TAU + j] * (after - before), after


@inlined_kernel
def store_one(i, j, x, s, n):
    """Store what lane i of those of one rotation has reached at the end of a sample in slot j."""
    alone = n[C2 + j] != 0
    s[TH2 + j], s[RATE2 + j] = x[one.THETA + i], x[one.OMEGA + i]
    s[TH1 + j], s[RATE1 + j] = (0.0, 0.0) if alone else (x[one.THETA + i], x[one.OMEGA + i])
    s[_peak(n[C2 + j]) + j], s[FAST + j], s[NEAR + j] = (
        x[one.RATIO + i],
        x[one.FAST + i],
        x[one.NEAR + i],
    )
    s[TAU + j] = 0.0


@inlined_kernel
def store_two(i, j, x, s):
    """Likewise of those of two rotations."""
    s[TH1 + j], s[RATE1 + j] = x[two.TH1 + i], x[two.RATE1 + i]
    s[TH2 + j], s[RATE2 + j] = x[two.TH2 + i], x[two.RATE2 + i]
    s[PEAK1 + j], s[PEAK2 + j] = x[two.RATIO1 + i], x[two.RATIO2 + i]
    s[FAST + j], s[NEAR + j] = x[two.FAST + i], x[two.NEAR + i]
    s[TAU + j] = 0.0
