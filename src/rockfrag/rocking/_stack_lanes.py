"""Ensembles of stacks, many cases side by side.

Each lane carries one case.  One pass takes every lane to the end of its sample with the same straight-line
arithmetic (``_stack_advance``); what is rare (events, rest, verdicts, the next case) is handled lane by lane
between passes.  A case's numbers depend on that case alone, so neither the number of lanes nor their
neighbours nor the threads change a bit of them.
"""

import math

import numpy as np

from rockfrag.rocking._compile import allocating_kernel, kernel
from rockfrag.rocking._events import MAX_EVENTS_PER_STEP, let_go, rest_interval
from rockfrag.rocking._mechanics import (
    GRAVITY,
    first_moment2,
    kinetic_energy,
    potential_energy,
)
from rockfrag.rocking._rest import uplift
from rockfrag.rocking._series import slope, value
from rockfrag.rocking._stack_advance import (
    BEFORE,
    CLOSES,
    COLUMNS,
    FAST,
    FLAG,
    GROUND,
    GROUND_END,
    HALF_TURN,
    LANES,
    M11,
    M22,
    NEAR,
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
    row,
)
from rockfrag.rocking._stack_events import (
    closing,
    collide,
    next_event,
    note,
    restore,
    rise,
    take_series,
)
from rockfrag.rocking._stack_impacts import STATES, TABLE, body_table, least_hold
from rockfrag.rocking._step import TH1 as SERIES1
from rockfrag.rocking._step import TH2 as SERIES2
from rockfrag.rocking._tally import SUMMARY, balance, barrier, scratch

# Columns of the results.
FALLEN, CERTAIN, PEAK1, PEAK2, SPEED, IMPACTS, CLOSEST = range(7)
RESULTS = 7


@allocating_kernel
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
    x = np.zeros(ROWS * LANES)
    summary = np.zeros(SUMMARY)
    # table of the body of each lane, and which body and interval it is for
    t = np.zeros(LANES * TABLE)
    bodies = np.full(LANES, -1, dtype=np.int64)
    intervals_of = np.zeros(LANES)
    low = np.zeros(LANES)
    high = np.zeros(LANES)
    least_energy = np.zeros(LANES)
    cases = np.full(LANES, -1, dtype=np.int64)
    where = np.zeros(LANES, dtype=np.int64)
    starts = np.zeros(LANES, dtype=np.int64)
    ends = np.zeros(LANES, dtype=np.int64)
    frees = np.zeros(LANES, dtype=np.int64)
    events = np.zeros(LANES, dtype=np.int64)
    counted = np.zeros(LANES, dtype=np.int64)
    repeats = np.zeros(LANES, dtype=np.bool_)
    contact1 = np.zeros(LANES, dtype=np.int64)
    contact2 = np.zeros(LANES, dtype=np.int64)
    factor = np.zeros(LANES)
    impacts = np.zeros(LANES)
    q = scratch()
    return _march(
        first, last, parameters, intervals, free, factors, rows, offsets, lasts, samples, highest, lowest,
        closing_speed, results,
        q, x, summary, t, bodies, intervals_of, low, high, least_energy, cases, where, starts, ends, frees, events,
        counted, repeats, contact1, contact2, factor, impacts,
    )  # fmt: skip


@kernel
def _march(
    first, last, parameters, intervals, free, factors, rows, offsets, lasts, samples, highest, lowest,
    closing_speed, results,
    q, x, summary, t, bodies, intervals_of, low, high, least_energy, cases, where, starts, ends, frees, events,
    counted, repeats, contact1, contact2, factor, impacts,
):  # fmt: skip
    """``stack_cases`` with its working arrays, one entry per lane in most of them."""
    n_motions, n_scales = factors.shape
    g = parameters[0, GRAVITY]
    upcoming = first
    busy = 0
    passes = 0
    filling = True
    while filling or busy > 0:
        if not filling:
            passes += 1
            advance(x, g)
        for i in range(LANES):
            case = cases[i]
            if not filling:
                if case < 0:
                    continue
                if x[FLAG + i] == QUIET and not repeats[i]:
                    k = where[i] + 1
                    where[i] = k
                    if k < ends[i]:
                        x[GROUND_END + i] = factor[i] * samples[k + 1]
                        continue
            k = where[i]
            end = ends[i]
            h = intervals_of[i]
            start = TABLE * i
            c1 = contact1[i]
            c2 = contact2[i]
            tau = 0.0
            t1, w1, t2, w2 = 0.0, 0.0, 0.0, 0.0
            fell = 0.0
            if case >= 0:
                flag = x[FLAG + i]
                if flag == RELEASE and x[BEFORE + i] == 1.0 and not repeats[i]:
                    # it let go in the sample before, which the next pass repeats
                    where[i] = k - 1
                    repeats[i] = True
                    restore(x, i)
                    continue
                if flag == QUIET and not repeats[i]:
                    t2 = x[TH2 + i]
                    w2 = x[RATE2 + i]
                    t1 = x[TH1 + i] if c2 != 0 else t2
                    w1 = x[RATE1 + i] if c2 != 0 else w2
                else:
                    if flag == QUIET:
                        restore(x, i)
                    left = x[REST_OF + i]
                    now = x[GROUND + i]
                    ramp = x[GROUND_END + i] - now
                    o = start + STATES + COLUMNS * row(c1, c2)
                    take_series(x, i, c2, q)
                    surely = flag == CLOSES and not repeats[i]
                    repeats[i] = False
                    fails = 0
                    if surely:
                        when, closes1, closes2 = closing(c1, c2, q)
                        if c1 == 0 or c2 == 0:
                            w2 = slope(q, SERIES2, when) / left
                            surely = least_hold(t, o, 0.0, w2, now + ramp * when, g) >= 0.0
                    if not surely:
                        when, fails, closes1, closes2 = next_event(
                            t, o, c1, c2, q, left, now, ramp, g
                        )
                    at = min(1.0, when)
                    t2 = value(q, SERIES2, at)
                    w2 = slope(q, SERIES2, at) / left
                    t1 = value(q, SERIES1, at)
                    w1 = slope(q, SERIES1, at) / left
                    note(x, i, c1, c2, t1, w1, t2, w2)
                    tau = 1.0 - left * (1.0 - at)
                    if when > 1.0:
                        tau = 1.0
                    else:
                        if counted[i] != k:
                            counted[i] = k
                            events[i] = 0
                        events[i] += 1
                        now += ramp * at
                        if fails != 0:
                            c1, c2 = let_go(
                                parameters[bodies[i]], fails, at == 0.0, c1, c2, t1, w1 / h, t2, w2 / h,
                                now,
                            )  # fmt: skip
                        else:
                            if closes1:
                                t1 = 0.0
                            if closes2 or c2 == 0:
                                t2 = t1
                            impacts[i] += 1.0
                            c1, c2, w1, w2 = collide(
                                parameters, bodies[i], t, start, closes1, closes2, c1, c2, t1, w1, t2, w2,
                                now, g, closing_speed, events[i] > MAX_EVENTS_PER_STEP, k, tau, h, samples,
                                end, factor[i], summary,
                            )  # fmt: skip
                        if events[i] > MAX_EVENTS_PER_STEP + 20:
                            tau = 1.0
                    if tau >= 1.0 - 1e-13:
                        tau = 0.0
                        k += 1
                if abs(t1) >= HALF_TURN:
                    fell = 1.0
                elif max(abs(t2), abs(t2 - t1)) >= HALF_TURN:
                    fell = 2.0
            # through rest and the ends of motions, and through as many cases as end there
            while True:
                over = True
                if case >= 0 and fell == 0.0:
                    if c1 == 0 and c2 == 0:
                        if k < end and factor[i] != 0.0:
                            k, tau, now = uplift(
                                k, tau, low[i], high[i], factor[i], samples, highest, lowest, end
                            )
                            if k >= 0:
                                c1, c2 = rise(parameters[bodies[i]], c1, c2, now)
                                over = False
                    elif k < end:
                        over = False
                    else:
                        over = k >= frees[i] or _safe(
                            parameters[bodies[i]], c1, c2, t1, w1 / h, t2, w2 / h, least_energy[i]
                        )
                if not over:
                    break
                if case >= 0:
                    result = results[case - first]
                    result[FALLEN] = fell
                    result[CERTAIN] = k - starts[i]
                    result[PEAK1] = x[RATIO1 + i]
                    result[PEAK2] = x[RATIO2 + i]
                    result[SPEED] = x[FAST + i]
                    result[IMPACTS] = impacts[i]
                    result[CLOSEST] = math.sqrt(x[NEAR + i])
                    busy -= 1
                    case = -1
                if upcoming >= last:
                    break
                case = upcoming
                upcoming += 1
                busy += 1
                motion = (case // n_scales) % n_motions
                body = case // (n_scales * n_motions)
                h = intervals[body, motion]
                if bodies[i] != body or intervals_of[i] != h:
                    bodies[i] = body
                    intervals_of[i] = h
                    p = parameters[body]
                    body_table(p, h, t, start)
                    low[i], high[i] = rest_interval(p)
                    least_energy[i] = barrier(p)
                factor[i] = factors[motion, case % n_scales]
                sampled = rows[body, motion]
                k = offsets[sampled]
                tau = 0.0
                starts[i] = k
                end = lasts[sampled]
                ends[i] = end
                frees[i] = end + free[body, motion]
                counted[i] = -1
                c1 = 0
                c2 = 0
                t1, w1, t2, w2 = 0.0, 0.0, 0.0, 0.0
                fell = 0.0
                impacts[i] = 0.0
                x[RATIO1 + i] = 0.0
                x[RATIO2 + i] = 0.0
                x[FAST + i] = 0.0
                x[NEAR + i] = math.inf
            cases[i] = case
            if case < 0:
                _idle(x, i)
                continue
            where[i] = k
            contact1[i] = c1
            contact2[i] = c2
            o = start + STATES + COLUMNS * row(c1, c2)
            for n in range(COLUMNS):
                x[n * LANES + i] = t[o + n]
            x[TH1 + i] = t1 if c2 != 0 else 0.0
            x[RATE1 + i] = w1 if c2 != 0 else 0.0
            x[TH2 + i] = t2
            x[RATE2 + i] = w2
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
    for n in range(ROWS):
        x[n * LANES + i] = 0.0
    x[REST_OF + i] = 1.0
    x[M11 + i] = 1.0
    x[M22 + i] = 1.0


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
