"""Events of a stack in its lane: when the next one happens, and what becomes of the contacts.

Time is counted in samples; ``t`` is the table of the body (``_stack_impacts``) and ``o`` the row of its contact
state.
"""

import math

from rockfrag.rocking._compile import kernel
from rockfrag.rocking._events import (
    COARSE_DROP,
    FASTEST,
    between,
    chatter_dies,
    first_closing,
    ground_gap,
    interface_gap,
    strike,
)
from rockfrag.rocking._mechanics import ground_hold, interface_hold, settle
from rockfrag.rocking._pendulum import sine_cosine
from rockfrag.rocking._series import ORDER, crossing_time, slope, value
from rockfrag.rocking._stack_advance import (
    BEFORE,
    BEFORE2,
    BEFORE_GROUND,
    BEFORE_RATE2,
    BEFORE_REST,
    COLUMNS,
    FAST,
    GROUND,
    GROUND_END,
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
    RATE1,
    RATE2,
    RATIO1,
    RATIO2,
    REST_OF,
    TH1,
    TH2,
    row,
)
from rockfrag.rocking._stack_impacts import (
    AFTER1,
    AFTER2,
    HAS_MEASURED,
    IMPACTS,
    NEXT1,
    NEXT2,
    PRODUCTS,
    RESTORING_AT,
    SHARE,
    STATES,
    chatter_closes,
    closed,
    ground_impact,
    interface_impact,
    least_hold,
)
from rockfrag.rocking._step import GAP
from rockfrag.rocking._step import TH1 as SERIES1
from rockfrag.rocking._step import TH2 as SERIES2


@kernel
def take_series(x, i, c2, q):
    """Copy the series of a lane's step into the scratch array of the events."""
    left = x[REST_OF + i]
    q[SERIES2] = x[TH2 + i]
    q[SERIES2 + 1] = x[RATE2 + i] * left
    for n in range(6):
        q[SERIES2 + 2 + n] = x[Q1 + n * LANES + i] * (1.0 / (n + 2))
    if c2 == 0:
        for n in range(ORDER + 1):
            q[SERIES1 + n] = q[SERIES2 + n]
    else:
        q[SERIES1] = x[TH1 + i]
        q[SERIES1 + 1] = x[RATE1 + i] * left
        for n in range(6):
            q[SERIES1 + 2 + n] = x[P1 + n * LANES + i] * (1.0 / (n + 2))


@kernel
def restore(x, i):
    """Put a lane back to where its last step began."""
    x[TH2 + i] = x[BEFORE2 + i]
    x[RATE2 + i] = x[BEFORE_RATE2 + i]
    x[GROUND_END + i] = x[GROUND + i]
    x[GROUND + i] = x[BEFORE_GROUND + i]
    x[REST_OF + i] = x[BEFORE_REST + i]
    x[BEFORE + i] = 0.0


@kernel
def closing(c1, c2, q):
    """Time of the first closing, one being sure, and whether it is the ground's and the interface's."""
    when1 = 2.0
    when2 = 2.0
    if c1 != 0 and ground_gap(c1, q) < 0.0:
        when1 = crossing_time(q, GAP)
    if c2 != 0 and interface_gap(c2, q) < 0.0:
        when2 = crossing_time(q, GAP)
    when = min(when1, when2)
    return when, when1 <= when + 1e-13, when2 <= when + 1e-13


@kernel
def next_event(t, o, c1, c2, q, left, now, rise, g):
    """Time of the next event in this step, 2 if there is none; the contact that fails; what closes."""
    when, closes1, closes2 = first_closing(c1, c2, q)
    if c1 == 0 or c2 == 0:
        time = _release(t, o, q, min(1.0, when), left, now, rise, g)
        if time < when:
            return time, 1 if c1 == 0 else 2, False, False
    return when, 0, closes1, closes2


@kernel
def _release(t, o, q, end, left, now, rise, g):
    """Time up to ``end`` at which the closed contact of pattern 3 or 4 lets go; 2 if it holds.

    Regula falsi, Illinois; the time is within 1e-13 after the release.
    """
    low = 0.0
    high = end
    at_low = least_hold(t, o, q[SERIES2], q[SERIES2 + 1] / left, now, g)
    if at_low < 0.0:
        return 0.0
    at_high = 0.0
    moved = 0
    for count in range(200):
        if high - low <= 1e-13:
            break
        tau = high
        if count > 0:
            tau = between(low, at_low, high, at_high)
        omega = slope(q, SERIES2, tau) / left
        hold = least_hold(t, o, value(q, SERIES2, tau), omega, now + rise * tau, g)
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
def collide(
    parameters, body, t, start, closes1, closes2, c1, c2, t1, w1, t2, w2, now, g, closing_speed, forced, k,
    tau, h, samples, end, factor, summary,
):  # fmt: skip
    """Contacts and velocities after one or both contacts close; ``forced`` keeps them closed."""
    state = row(c1, c2)
    before = start + STATES + COLUMNS * state
    products = start + IMPACTS + PRODUCTS * state
    if not forced:
        if (c1 == 0 or c2 == 0) and not (closes1 and closes2):
            n1 = int(t[products + NEXT1])
            n2 = int(t[products + NEXT2])
            v1 = abs(w2) * t[products + AFTER1]
            v2 = abs(w2) * t[products + AFTER2]
            slow = closing_speed * h
            fast1 = n1 == 0 or abs(v1) >= slow
            fast2 = n2 == 0 or abs(v2 - v1) >= slow
            if (n1 != 0 or n2 != 0) and fast1 and fast2:
                speed = max(abs(v1), abs(v2)) / h
                restoring = start + RESTORING_AT
                if speed < t[restoring + FASTEST] and chatter_dies(
                    speed, t[products + SHARE], 1.5, t, restoring, COARSE_DROP, k, tau, h, samples, end,
                    factor,
                ):  # fmt: skip
                    n1, n2, v1, v2 = 0, 0, 0.0, 0.0
                if n1 == 0 or n2 == 0:
                    n1, n2 = settle(parameters[body], n1, n2, 0.0, v1 / h, 0.0, v2 / h, now)
                return n1, n2, v1, v2
        elif c1 != 0 and c2 != 0 and closes1 != closes2 and t[start + HAS_MEASURED] == 0.0:
            n1 = -c1 if closes1 else c1
            n2 = c2 if closes1 else -c2
            after = start + STATES + COLUMNS * row(n1, n2)
            sine, cosine = 0.0, 1.0
            if closes1:
                sine, cosine = sine_cosine(t2)
                v1, v2 = ground_impact(t, before, after, products, cosine, sine, w1, w2)
                side, off, old, toward = n1, v1, w1, c2 * (v1 - v2)
            else:
                v1, v2 = interface_impact(t, after, products, w1, w2)
                side, off, old, toward = n2, v2 - v1, w2 - w1, -c1 * v1
            if side * off > closing_speed * h:
                if chatter_closes(
                    t, before, after, closes1, old, side, t1, v1, t2, v2, toward, g, k, tau, h, samples,
                    end, factor,
                ):  # fmt: skip
                    v1, v2 = closed(t, after, closes1, cosine, sine, v1, v2)
                    if closes1:
                        n1 = 0
                    else:
                        n2 = 0
                return n1, n2, v1, v2
    n1, n2, v1, v2, _ = strike(
        parameters[body], c1, c2, closes1, closes2, t1, w1 / h, t2, w2 / h, now, closing_speed, forced,
        COARSE_DROP, t[start + RESTORING_AT :], k, tau, h, samples, end, factor, summary,
    )  # fmt: skip
    return n1, n2, v1 * h, v2 * h


@kernel
def rise(p, c1, c2, a):
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
def note(x, i, c1, c2, t1, w1, t2, w2):
    """Keep the extremes at an event."""
    near = math.inf
    if c2 != 0:
        away = 1.0 - x[PER_ANGLE22 + i] * t2
        x[RATIO2 + i] = max(x[RATIO2 + i], 1.0 - away)
        near = away * away + x[PER_SPEED22 + i] * w2 * w2
    if c1 != 0:
        away = 1.0 - (x[PER_ANGLE11 + i] + x[PER_ANGLE12 + i]) * t1
        x[RATIO1 + i] = max(x[RATIO1 + i], 1.0 - away)
        near = min(near, away * away + (x[PER_SPEED11 + i] + x[PER_SPEED12 + i]) * w1 * w1)
    x[NEAR + i] = min(x[NEAR + i], near)
    x[FAST + i] = max(x[FAST + i], abs(w2))
