"""Ensembles of stacks, many cases side by side.

Each lane carries one case.  One pass takes every lane to the end of its sample with the same straight-line
arithmetic (``_stack_advance``); what is rare (events, rest, verdicts, the next case) is handled lane by lane
between passes.  A case's numbers depend on that case alone, so neither the number of lanes nor their
neighbours nor the threads change a bit of them.
"""

import math

import numpy as np

from rockfrag.rocking._compile import kernel
from rockfrag.rocking._events import (
    COARSE_DROP,
    MAX_EVENTS_PER_STEP,
    RESTORING,
    chatter_dies,
    let_go,
    rest_interval,
    restoring_table,
    strike,
)
from rockfrag.rocking._lanes import next_uplift
from rockfrag.rocking._mechanics import (
    GRAVITY,
    MEASURED,
    first_moment2,
    ground_hold,
    interface_hold,
    kinetic_energy,
    potential_energy,
    settle,
)
from rockfrag.rocking._pendulum import sine_cosine
from rockfrag.rocking._series import ORDER, closing_time, crossing_time, slope, value
from rockfrag.rocking._stack_advance import (
    BEFORE,
    BEFORE2,
    BEFORE_GROUND,
    BEFORE_RATE2,
    BEFORE_REST,
    CLOSES,
    COLUMNS,
    FAST,
    FLAG,
    GROUND,
    GROUND_END,
    HALF_TURN,
    LANES,
    NEAR,
    P1,
    PER_ANGLE11,
    PER_ANGLE12,
    PER_ANGLE22,
    PER_SPEED11,
    PER_SPEED12,
    PER_SPEED22,
    Q1,
    QUIET,
    RATE1,
    RATE2,
    RATIO1,
    RATIO2,
    RELEASE,
    REST_OF,
    ROWS,
    TH1,
    TH2,
    advance,
    commit,
    contact_table,
)
from rockfrag.rocking._stack_impacts import (
    AFTER1,
    AFTER2,
    NEXT1,
    NEXT2,
    chatter_closes,
    closed,
    ground_impact,
    impact_table,
    interface_impact,
    least_hold,
)
from rockfrag.rocking._stack_impacts import COLUMNS as PRODUCTS
from rockfrag.rocking._step import GAP
from rockfrag.rocking._step import TH1 as SERIES1
from rockfrag.rocking._step import TH2 as SERIES2
from rockfrag.rocking._tally import SUMMARY, balance, barrier, scratch

# Columns of the results.
FALLEN, CERTAIN, PEAK1, PEAK2, SPEED, IMPACTS, CLOSEST = range(7)
RESULTS = 7


@kernel
def stack_cases(
    first, last, parameters, intervals, free, factors, rows, offsets, lasts, samples, highest, lowest,
    closing_speed, results,
):  # fmt: skip
    """March cases ``first`` ≤ n < ``last`` of bodies × motions × scales, the scale running fastest.

    Parameters
    ----------
    parameters : (bodies, PARAMETERS)
    intervals : (bodies, motions) sampling interval of the sampled motion [s]
    free : (bodies, motions) samples of free rocking
    factors : (motions, scales)
    rows : (bodies, motions) which of the sampled motions to use
    offsets : (sampled motions + 1,) where each begins; each ends with a sample of zero
    lasts : (sampled motions,) its last sample
    samples : all sampled motions end to end [m/s²]
    highest, lowest : extremes of each BLOCK of ``samples``
    results : (last - first, RESULTS)

    Returns
    -------
    Number of samples that lanes were advanced by.
    """
    n_motions, n_scales = factors.shape
    first_body = first // (n_motions * n_scales)
    n_bodies = (last - 1) // (n_motions * n_scales) + 1 - first_body
    x = np.zeros(ROWS * LANES)
    hh = np.ones(LANES)
    g = parameters[0, GRAVITY]
    q = scratch()
    summary = np.zeros(SUMMARY)
    tables = np.zeros((n_bodies, 9, COLUMNS))
    products = np.zeros((n_bodies, 9, PRODUCTS))
    about = np.zeros((n_bodies, 3 + RESTORING))
    known = np.zeros(n_bodies, dtype=np.bool_)
    cases = np.full(LANES, -1, dtype=np.int64)
    bodies = np.zeros(LANES, dtype=np.int64)
    where = np.zeros(LANES, dtype=np.int64)
    starts = np.zeros(LANES, dtype=np.int64)
    ends = np.zeros(LANES, dtype=np.int64)
    frees = np.zeros(LANES, dtype=np.int64)
    events = np.zeros(LANES, dtype=np.int64)
    counted = np.zeros(LANES, dtype=np.int64)
    releases = np.zeros(LANES, dtype=np.bool_)
    contact1 = np.zeros(LANES, dtype=np.int64)
    contact2 = np.zeros(LANES, dtype=np.int64)
    dts = np.ones(LANES)
    factor = np.zeros(LANES)
    impacts = np.zeros(LANES)
    upcoming = first
    busy = 0
    passes = 0
    for i in range(LANES):
        _idle(x, i)
    filling = True
    while filling or busy > 0:
        if not filling:
            passes += 1
            advance(x, g, hh)
            commit(x, hh)
        for i in range(LANES):
            case = cases[i]
            if filling:
                if case >= 0:
                    continue
            elif case < 0:
                continue
            elif x[FLAG + i] == QUIET and not releases[i]:
                k = where[i] + 1
                where[i] = k
                if k < ends[i]:
                    x[GROUND_END + i] = factor[i] * samples[k + 1]
                    continue
            k = where[i]
            end = ends[i]
            h = dts[i]
            tau = 0.0
            c1 = contact1[i]
            c2 = contact2[i]
            t1 = 0.0
            w1 = 0.0
            t2 = 0.0
            w2 = 0.0
            done = case < 0
            fell = 0.0
            if case >= 0:
                p = parameters[first_body + bodies[i]]
                flag = x[FLAG + i]
                if flag == RELEASE and x[BEFORE + i] == 1.0 and not releases[i]:
                    # it let go in the sample before, which the next pass repeats
                    where[i] = k - 1
                    releases[i] = True
                    _restore(x, i)
                    continue
                if flag != QUIET or releases[i]:
                    if flag == QUIET:
                        _restore(x, i)
                    left = x[REST_OF + i]
                    now = x[GROUND + i]
                    rise = x[GROUND_END + i] - now
                    hr = h * left
                    table = tables[bodies[i]][3 * c1 + c2 + 4]
                    _take_series(x, i, c1, c2, left, q)
                    surely = flag == CLOSES and not releases[i]
                    fails = 0
                    if surely:
                        when, closes1, closes2 = _closing(c1, c2, q)
                        if c1 == 0 or c2 == 0:
                            w2 = slope(q, SERIES2, when) / hr
                            surely = least_hold(table, 0.0, w2, now + rise * when, g) >= 0.0
                    if not surely:
                        when, fails, closes1, closes2 = _next_event(
                            c1, c2, table, q, hr, now, rise, g
                        )
                    releases[i] = False
                    at = min(1.0, when)
                    t1 = value(q, SERIES1, at) if c1 != 0 else 0.0
                    w1 = slope(q, SERIES1, at) / hr if c1 != 0 else 0.0
                    t2 = value(q, SERIES2, at) if c2 != 0 else t1
                    w2 = slope(q, SERIES2, at) / hr if c2 != 0 else w1
                    _note(x, i, hh, t1, w1, t2, w2, c1, c2, h)
                    tau = 1.0 - left * (1.0 - at)
                    if when > 1.0:
                        tau = 1.0
                    else:
                        if counted[i] != k:
                            counted[i] = k
                            events[i] = 0
                        events[i] += 1
                        now += rise * at
                        if fails != 0:
                            c1, c2 = let_go(p, fails, at == 0.0, c1, c2, t1, w1, t2, w2, now)
                        else:
                            if closes1:
                                t1 = 0.0
                            if closes2 or c2 == 0:
                                t2 = t1
                            impacts[i] += 1.0
                            b = bodies[i]
                            forced = events[i] > MAX_EVENTS_PER_STEP
                            settled = False
                            if c1 == 0 or c2 == 0:
                                if not closes1 or not closes2:
                                    settled, n1, n2, v1, v2 = _land(
                                        p, about[b], products[b][3 * c1 + c2 + 4], c1, c2, w2, now,
                                        closing_speed, k, tau, h, samples, end, factor[i],
                                    )  # fmt: skip
                            elif closes1 != closes2 and p[MEASURED] == 0.0:
                                settled, n1, n2, v1, v2 = _strike(
                                    tables[b], products[b], closes1, c1, c2, t1, w1, t2, w2, g,
                                    closing_speed, k, tau, h, samples, end, factor[i],
                                )  # fmt: skip
                            if settled and not forced:
                                c1, c2, w1, w2 = n1, n2, v1, v2
                            else:
                                c1, c2, w1, w2, _ = strike(
                                    p, c1, c2, closes1, closes2, t1, w1, t2, w2, now, closing_speed,
                                    forced, COARSE_DROP, about[b, 3:],
                                    k, tau, h, samples, end, factor[i], summary,
                                )  # fmt: skip
                        if events[i] > MAX_EVENTS_PER_STEP + 20:
                            tau = 1.0
                    if tau >= 1.0 - 1e-13:
                        tau = 0.0
                        k += 1
                else:
                    t1, w1, t2, w2 = _state(x, i, c1, c2, h)
                if abs(t1) >= HALF_TURN:
                    fell = 1.0
                elif max(abs(t2), abs(t2 - t1)) >= HALF_TURN:
                    fell = 2.0
            # through rest and the ends of motions, and through as many cases as end there
            while True:
                if case >= 0 and not done:
                    if fell != 0.0:
                        done = True
                    elif c1 == 0 and c2 == 0:
                        if k >= end:
                            done = True
                        else:
                            k, tau, now = _uplift(
                                k, tau, about[bodies[i], 0], about[bodies[i], 1], factor[i], samples,
                                highest, lowest, end,
                            )  # fmt: skip
                            if k < 0:
                                done = True
                            else:
                                c1, c2 = _rise(parameters[first_body + bodies[i]], c1, c2, now)
                                break
                    elif k >= end:
                        p = parameters[first_body + bodies[i]]
                        done = k >= frees[i] or _safe(
                            p, c1, c2, t1, w1, t2, w2, about[bodies[i], 2]
                        )
                        if not done:
                            break
                    else:
                        break
                if case >= 0:
                    _finish(x, i, fell, k - starts[i], impacts[i], h, results[case - first])
                    busy -= 1
                    case = -1
                if upcoming >= last:
                    break
                case = upcoming
                upcoming += 1
                busy += 1
                motion = (case // n_scales) % n_motions
                body = case // (n_scales * n_motions)
                j = body - first_body
                bodies[i] = j
                if not known[j]:
                    known[j] = True
                    p = parameters[body]
                    contact_table(p, tables[j])
                    impact_table(p, products[j])
                    about[j, 0], about[j, 1] = rest_interval(p)
                    about[j, 2] = barrier(p)
                    restoring_table(p, about[j, 3:])
                factor[i] = factors[motion, case % n_scales]
                row = rows[body, motion]
                k = offsets[row]
                tau = 0.0
                starts[i] = k
                end = lasts[row]
                ends[i] = end
                frees[i] = end + free[body, motion]
                counted[i] = -1
                h = intervals[body, motion]
                dts[i] = h
                hh[i] = h * h
                c1 = 0
                c2 = 0
                t1 = 0.0
                w1 = 0.0
                t2 = 0.0
                w2 = 0.0
                fell = 0.0
                impacts[i] = 0.0
                x[RATIO1 + i] = 0.0
                x[RATIO2 + i] = 0.0
                x[FAST + i] = 0.0
                x[NEAR + i] = math.inf
                done = factor[i] == 0.0
            cases[i] = case
            if case < 0:
                _idle(x, i)
                continue
            where[i] = k
            contact1[i] = c1
            contact2[i] = c2
            _place(x, i, tables[bodies[i]][3 * c1 + c2 + 4], hh[i])
            x[TH1 + i] = t1 if c2 != 0 else 0.0
            x[RATE1 + i] = w1 * h if c2 != 0 else 0.0
            x[TH2 + i] = t2
            x[RATE2 + i] = w2 * h
            before = factor[i] * samples[k] if k <= end else 0.0
            after = factor[i] * samples[k + 1] if k < end else 0.0
            x[GROUND + i] = before + tau * (after - before)
            x[GROUND_END + i] = after
            x[REST_OF + i] = 1.0 - tau
            x[BEFORE + i] = 0.0
        filling = False
    return passes * LANES


@kernel
def _idle(x, i):
    """Let a lane without a case stand still at a harmless place."""
    for row in range(ROWS):
        x[row * LANES + i] = 0.0
    for n in range(COLUMNS):
        x[n * LANES + i] = 0.0
    x[REST_OF + i] = 1.0
    x[10 * LANES + i] = 1.0
    x[11 * LANES + i] = 1.0


@kernel
def _place(x, i, table, hh):
    """Fill the rows that a contact state fixes, with time in samples."""
    for n in range(COLUMNS):
        x[n * LANES + i] = table[n]


@kernel
def _state(x, i, c1, c2, h):
    """θ1, ω1, θ2, ω2 of a lane [rad, rad/s]."""
    t2 = x[TH2 + i]
    w2 = x[RATE2 + i] / h
    if c2 == 0:
        return t2, w2, t2, w2
    return x[TH1 + i], x[RATE1 + i] / h, t2, w2


@kernel
def _take_series(x, i, c1, c2, left, q):
    """Copy the series of a lane's step into the scratch array of the events."""
    q[SERIES1] = x[TH1 + i]
    q[SERIES1 + 1] = x[RATE1 + i] * left
    q[SERIES2] = x[TH2 + i]
    q[SERIES2 + 1] = x[RATE2 + i] * left
    for n in range(6):
        q[SERIES1 + 2 + n] = x[P1 + n * LANES + i] / (n + 2)
        q[SERIES2 + 2 + n] = x[Q1 + n * LANES + i] / (n + 2)
    if c2 == 0:
        for n in range(8):
            q[SERIES1 + n] = q[SERIES2 + n]


@kernel
def _restore(x, i):
    """Put a lane back to where its last step began."""
    x[TH2 + i] = x[BEFORE2 + i]
    x[RATE2 + i] = x[BEFORE_RATE2 + i]
    x[GROUND_END + i] = x[GROUND + i]
    x[GROUND + i] = x[BEFORE_GROUND + i]
    x[REST_OF + i] = x[BEFORE_REST + i]
    x[BEFORE + i] = 0.0


@kernel
def _next_event(c1, c2, table, q, h, now, rise, g):
    """Time of the next event in this step, 2 if there is none; the contact that fails; what closes."""
    when = 2.0
    closes1 = False
    closes2 = False
    if c1 != 0:
        for n in range(ORDER + 1):
            q[GAP + n] = c1 * q[SERIES1 + n]
        when = closing_time(q, GAP, 1.0)
        closes1 = when <= 1.0
    if c2 != 0:
        for n in range(ORDER + 1):
            q[GAP + n] = c2 * (q[SERIES2 + n] - q[SERIES1 + n])
        time = closing_time(q, GAP, min(1.0, when))
        if time < when:
            when = time
            closes1 = False
            closes2 = True
    if c1 == 0 or c2 == 0:
        time = _release(table, q, min(1.0, when), h, now, rise, g)
        if time < when:
            return time, 1 if c1 == 0 else 2, False, False
    return when, 0, closes1, closes2


@kernel
def _release(table, q, end, h, now, rise, g):
    """Time up to ``end`` at which the closed contact of pattern 3 or 4 lets go; 2 if it holds.

    Regula falsi, Illinois; the time is within 1e-13 after the release.
    """
    low = 0.0
    high = end
    at_low = least_hold(table, q[SERIES2], q[SERIES2 + 1] / h, now, g)
    if at_low < 0.0:
        return 0.0
    at_high = 0.0
    moved = 0
    for count in range(200):
        if high - low <= 1e-13:
            break
        tau = high
        if count > 0:
            tau = high - at_high * (high - low) / (at_high - at_low)
            tau = min(max(tau, low + 4e-14), high - 4e-14)
        hold = least_hold(
            table, value(q, SERIES2, tau), slope(q, SERIES2, tau) / h, now + rise * tau, g
        )
        if hold < 0.0:
            high = tau
            at_high = hold
            if moved == -1:
                at_low *= 0.5
            moved = -1
        elif count == 0:
            return 2.0
        else:
            low = tau
            at_low = hold
            if moved == 1:
                at_high *= 0.5
            moved = 1
    return high


@kernel
def _closing(c1, c2, q):
    """Time of the first closing, and whether it is the ground's and the interface's."""
    when1 = 2.0
    when2 = 2.0
    if c1 != 0:
        end = 0.0
        for n in range(ORDER + 1):
            q[GAP + n] = c1 * q[SERIES1 + n]
            end += q[GAP + n]
        if end < 0.0:
            when1 = crossing_time(q, GAP)
    if c2 != 0:
        end = 0.0
        for n in range(ORDER + 1):
            q[GAP + n] = c2 * (q[SERIES2 + n] - q[SERIES1 + n])
            end += q[GAP + n]
        if end < 0.0:
            when2 = crossing_time(q, GAP)
    when = min(when1, when2)
    return when, when1 <= when + 1e-13, when2 <= when + 1e-13


@kernel
def _strike(
    tables, products, ground, c1, c2, t1, w1, t2, w2, g, closing_speed, k, tau, h, samples, end, factor
):  # fmt: skip
    """State after one contact of two closes: whether it is settled here, contacts and velocities."""
    state = 3 * c1 + c2 + 4
    before = tables[state]
    n1 = -c1 if ground else c1
    n2 = c2 if ground else -c2
    after = tables[3 * n1 + n2 + 4]
    sine, cosine = 0.0, 1.0
    if ground:
        sine, cosine = sine_cosine(t2)
        v1, v2 = ground_impact(before, after, products[state], cosine, sine, w1, w2)
        off = n1 * v1
        old = w1
    else:
        v1, v2 = interface_impact(after, products[state], w1, w2)
        off = n2 * (v2 - v1)
        old = w2 - w1
    if off <= closing_speed:
        return False, n1, n2, v1, v2
    if chatter_closes(
        before, after, ground, c1, c2, old, n1, n2, t1, v1, t2, v2, g, k, tau, h, samples, end, factor
    ):  # fmt: skip
        v1, v2 = closed(after, ground, cosine, sine, v1, v2)
        if ground:
            n1 = 0
        else:
            n2 = 0
    return True, n1, n2, v1, v2


@kernel
def _land(
    p, about, outcome, c1, c2, omega, a, closing_speed, k, tau, h, samples, end, factor
):  # fmt: skip
    """State after what rocks alone comes down: whether it is settled here, contacts and velocities."""
    speed = abs(omega)
    n1 = int(outcome[NEXT1])
    n2 = int(outcome[NEXT2])
    v1 = speed * outcome[AFTER1]
    v2 = speed * outcome[AFTER2]
    if n1 == 0 and n2 == 0:
        return False, n1, n2, v1, v2
    if (n1 != 0 and abs(v1) < closing_speed) or (n2 != 0 and abs(v2 - v1) < closing_speed):
        return False, n1, n2, v1, v2
    old1 = 0.0 if c1 == 0 else omega
    restoring = about[3:]
    if max(abs(v1), abs(v2)) < restoring[9] and chatter_dies(
        p,
        restoring,
        c1,
        c2,
        old1,
        omega,
        n1,
        n2,
        v1,
        v2,
        COARSE_DROP,
        k,
        tau,
        h,
        samples,
        end,
        factor,
    ):
        n1, n2, v1, v2 = 0, 0, 0.0, 0.0
    n1, n2 = settle(p, n1, n2, 0.0, v1, 0.0, v2, a)
    return True, n1, n2, v1, v2


@kernel
def _note(x, i, hh, t1, w1, t2, w2, c1, c2, h):
    """Keep the extremes at an event."""
    if c2 != 0:
        ratio = x[PER_ANGLE22 + i] * t2
        x[RATIO2 + i] = max(x[RATIO2 + i], ratio)
        near = (1.0 - ratio) * (1.0 - ratio) + x[PER_SPEED22 + i] * w2 * w2
        x[NEAR + i] = min(x[NEAR + i], near)
    if c1 != 0:
        ratio = (x[PER_ANGLE11 + i] + x[PER_ANGLE12 + i]) * t1
        x[RATIO1 + i] = max(x[RATIO1 + i], ratio)
        speed = (x[PER_SPEED11 + i] + x[PER_SPEED12 + i]) * w1 * w1
        x[NEAR + i] = min(x[NEAR + i], (1.0 - ratio) * (1.0 - ratio) + speed)
    x[FAST + i] = max(x[FAST + i], abs(w2) * h)


@kernel
def _uplift(k, tau, low, high, factor, samples, highest, lowest, end):
    """Sample and time within it at which a body at rest rises, and the acceleration; -1 if it stays."""
    a0 = factor * samples[k]
    a1 = factor * samples[k + 1]
    now = a0 + tau * (a1 - a0)
    if now > low and now < high and a1 >= low and a1 <= high:
        least = low / factor
        most = high / factor
        if factor < 0.0:
            least, most = most, least
        m = next_uplift(samples, highest, lowest, k + 1, end, least, most)
        if m < 0:
            return -1, 0.0, 0.0
        k = m - 1
        tau = 0.0
        a0 = factor * samples[k]
        a1 = factor * samples[m]
        now = a0
    if now > low and now < high:
        limit = high if a1 > high else low
        tau = min(max(tau, (limit - a0) / (a1 - a0)), 1.0 - 1e-9)
        now = limit
    return k, tau, now


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
def _finish(x, i, fell, sample, impacts, h, result):
    result[FALLEN] = fell
    result[CERTAIN] = sample
    result[PEAK1] = x[RATIO1 + i]
    result[PEAK2] = x[RATIO2 + i]
    result[SPEED] = x[FAST + i]
    result[IMPACTS] = impacts
    result[CLOSEST] = math.sqrt(x[NEAR + i])


@kernel
def _safe(p, c1, c2, theta1, omega1, theta2, omega2, least_energy):
    """Whether nothing can fall once the ground is still: energy cannot grow and does not suffice."""
    energy = kinetic_energy(p, c1, c2, theta1, omega1, theta2, omega2)
    energy += potential_energy(p, c1, c2, theta1, theta2)
    if energy >= least_energy:
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
