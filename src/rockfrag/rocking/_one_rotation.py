"""Stacks side by side of which one part rotates: the statue on its pedestal, or both blocks as one.

One pass advances every lane from where it is within a sample to the end of that sample.  Time is counted in
samples; ``t`` is the table of a body (``_stack_table``) and ``o`` its row of the contact state.
"""

import numba

from rockfrag.rocking import _stack_table as table
from rockfrag.rocking._compile import inlined_kernel, kernel
from rockfrag.rocking._events import between
from rockfrag.rocking._passes import QUIET
from rockfrag.rocking._pendulum import HALF_TURN, dips, hops, rate, rates, sine_cosine, travel
from rockfrag.rocking._series import ORDER, closing_time, crossing_time, slope, value
from rockfrag.rocking._stack_table import (
    CLOSES,
    CORNER,
    HOLD,
    LANES,
    NEARS,
    ONE_COLUMNS,
    RELEASE,
)
from rockfrag.rocking._step import GAP
from rockfrag.rocking._step import TH1 as SERIES

# Rows of the lanes after those of the table's columns.
(
    SIGN,  # side that the rocking contact opens to
    FACTOR,
    GROUND_END,  # acceleration of the ground at the end of the sample
    THETA,  # the state; the acceleration of the ground; the part of the sample that is left
    OMEGA,
    GROUND,
    LEFT,
    RATIO,  # extremes so far: of θ/θcritical, |θ'|, and distance from balance squared
    FAST,
    NEAR,
    FLAG,
    WAS_THETA,  # these where the step began ...
    WAS_OMEGA,
    WAS_GROUND,
    WAS_LEFT,
    WAS_RATIO,
    WAS_FAST,
    WAS_NEAR,
    BEFORE_THETA,  # ... and where the step before that began, if BEFORE
    BEFORE_OMEGA,
    BEFORE_GROUND,
    BEFORE_LEFT,
    BEFORE,
    STEPS,
    W1,  # Taylor coefficients of θ'
    W2,
    W3,
    W4,
    W5,
    W6,
) = (LANES * row for row in range(ONE_COLUMNS, ONE_COLUMNS + 30))
ROWS = ONE_COLUMNS + 30

# The table's columns as rows of the lanes.
_GX, _GY, _PER_ANGLE, _PER_SPEED = (
    LANES * column for column in (table.GX, table.GY, table.PER_ANGLE, table.PER_SPEED)
)
_RIGHT = LANES * HOLD
_LEFT = LANES * (HOLD + CORNER)


@numba.njit(inline="always", error_model="numpy")
def _moment(x, o, stride, s, c, alpha, square, a):
    """Contact moment of a closed contact at one corner, whose coefficients are ``stride`` apart from ``o``."""
    moment = (x[o] + x[o + stride] * s + x[o + 2 * stride] * c) * alpha
    moment += (x[o + 3 * stride] + x[o + 4 * stride] * s + x[o + 5 * stride] * c) * square
    moment += (x[o + 6 * stride] + x[o + 7 * stride] * s + x[o + 8 * stride] * c) * a
    return moment + (x[o + 9 * stride] + x[o + 10 * stride] * s + x[o + 11 * stride] * c)


@numba.njit(inline="always", error_model="numpy")
def _rates(x, i, theta, w, left, a, a_end, g):
    """Sine and cosine of θ and Taylor coefficients of θ' over what is left of a lane's sample."""
    s, c = sine_cosine(theta)
    gx, gy = x[_GX + i], x[_GY + i]
    down = -1.0 / g
    w1, w2, w3, w4, w5, w6 = rates(
        gx * c + gy * s, gy * c - gx * s, w, left * left, a * down, (a_end - a) * down
    )
    return s, c, w1, w2, w3, w4, w5, w6


@kernel
def advance(x, g):
    """Advance every lane to the end of its sample, and flag those with an event in between.

    Everything is stored in every lane: conditional stores cost many times as much.
    """
    for i in range(LANES):
        left = x[LEFT + i]
        theta = x[THETA + i]
        omega = x[OMEGA + i]
        a = x[GROUND + i]
        a_end = x[GROUND_END + i]
        per = 1.0 / left
        w = omega * left
        s, c, w1, w2, w3, w4, w5, w6 = _rates(x, i, theta, w, left, a, a_end, g)
        x[W1 + i], x[W2 + i], x[W3 + i], x[W4 + i], x[W5 + i], x[W6 + i] = w1, w2, w3, w4, w5, w6
        n = theta + travel(w, w1, w2, w3, w4, w5, w6, 1.0)
        z = rate(w, w1, w2, w3, w4, w5, w6, 1.0)
        # the contact closes, nearly closes, or may close and open again
        sign = x[SIGN + i]
        gap = sign * theta
        out = sign * w
        end = sign * z
        near = dips(gap, out, end) | hops(gap, out, end, sign * w1)
        flag = NEARS if near | (abs(n) >= HALF_TURN) else QUIET
        flag = CLOSES if sign * n < 0.0 else flag
        # the closed contact would have to be pulled
        square = omega * omega
        alpha = w1 * per * per
        right = _moment(x, _RIGHT + i, LANES, s, c, alpha, square, a)
        other = _moment(x, _LEFT + i, LANES, s, c, alpha, square, a)
        x[FLAG + i] = RELEASE if (right < 0.0) | (other < 0.0) else flag
        x[BEFORE_THETA + i] = x[WAS_THETA + i]
        x[BEFORE_OMEGA + i] = x[WAS_OMEGA + i]
        x[BEFORE_GROUND + i] = x[WAS_GROUND + i]
        x[BEFORE_LEFT + i] = x[WAS_LEFT + i]
        x[BEFORE + i] = x[STEPS + i]
        x[STEPS + i] = 1.0
        x[WAS_THETA + i] = theta
        x[WAS_OMEGA + i] = omega
        x[WAS_GROUND + i] = a
        x[WAS_LEFT + i] = left
        x[THETA + i] = n
        z = z * per
        x[OMEGA + i] = z
        x[GROUND + i] = a_end
        x[LEFT + i] = 1.0
        was_ratio, was_fast, was_near = x[RATIO + i], x[FAST + i], x[NEAR + i]
        x[WAS_RATIO + i], x[WAS_FAST + i], x[WAS_NEAR + i] = was_ratio, was_fast, was_near
        ratio = x[_PER_ANGLE + i] * n
        away = (1.0 - ratio) * (1.0 - ratio) + x[_PER_SPEED + i] * z * z
        x[RATIO + i] = max(was_ratio, ratio)
        x[FAST + i] = max(was_fast, abs(z))
        x[NEAR + i] = min(was_near, away)


@inlined_kernel
def take_series(x, i, q):
    """Copy the series of a lane's step into the scratch array of the events, and of the gap too."""
    q[SERIES] = x[WAS_THETA + i]
    q[SERIES + 1] = x[WAS_OMEGA + i] * x[WAS_LEFT + i]
    for n in range(6):
        q[SERIES + 2 + n] = x[W1 + n * LANES + i] * (1.0 / (n + 2))
    for n in range(ORDER + 1):
        q[GAP + n] = x[SIGN + i] * q[SERIES + n]


@kernel
def go_back(x, i, g):
    """Put a lane back to where its last step began, and work its series out again."""
    theta, omega, left = x[BEFORE_THETA + i], x[BEFORE_OMEGA + i], x[BEFORE_LEFT + i]
    end, a = x[WAS_GROUND + i], x[BEFORE_GROUND + i]
    x[WAS_THETA + i], x[WAS_OMEGA + i], x[WAS_LEFT + i] = theta, omega, left
    x[GROUND_END + i], x[WAS_GROUND + i] = end, a
    _, _, w1, w2, w3, w4, w5, w6 = _rates(x, i, theta, omega * left, left, a, end, g)
    x[W1 + i], x[W2 + i], x[W3 + i], x[W4 + i], x[W5 + i], x[W6 + i] = w1, w2, w3, w4, w5, w6


@inlined_kernel
def next_event(t, o, x, i, q, g):
    """Time in the lane's step of its next event, 2 if there is none; whether the closed contact lets go."""
    left, now = x[WAS_LEFT + i], x[WAS_GROUND + i]
    ramp = x[GROUND_END + i] - now
    if x[FLAG + i] == CLOSES:
        when = crossing_time(q, GAP)
        omega = slope(q, SERIES, when) / left
        if least_hold(t, o, 0.0, omega, now + ramp * when, g) >= 0.0:
            return when, False
    else:
        when = closing_time(q, GAP, 1.0)
    time = _release(t, o, q, min(1.0, when), left, now, ramp, g)
    if time < when:
        return time, True
    return when, False


@kernel
def least_hold(t, o, theta, omega, ground, g):
    """Least contact moment of the closed contact; negative if it would have to pull."""
    s, c = sine_cosine(theta)
    gx, gy = t[o + table.GX], t[o + table.GY]
    alpha = gx * c + gy * s - ground / g * (gy * c - gx * s)
    return min(
        _moment(t, o + HOLD, 1, s, c, alpha, omega * omega, ground),
        _moment(t, o + HOLD + CORNER, 1, s, c, alpha, omega * omega, ground),
    )


@kernel
def _release(t, o, q, end, left, now, ramp, g):
    """Time up to ``end`` at which the closed contact lets go; 2 if it holds.

    Regula falsi, Illinois; the time is within 1e-13 after the release.
    """
    low = 0.0
    high = end
    at_low = least_hold(t, o, q[SERIES], q[SERIES + 1] / left, now, g)
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
        omega = slope(q, SERIES, tau) / left
        hold = least_hold(t, o, value(q, SERIES, tau), omega, now + ramp * tau, g)
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


@inlined_kernel
def nearest(t, o, x, i, theta, omega):
    """Largest θ/θcritical, |θ'| and least distance from balance squared, up to an event at θ, θ'."""
    ratio = t[o + table.PER_ANGLE] * theta
    near = (1.0 - ratio) * (1.0 - ratio) + t[o + table.PER_SPEED] * omega * omega
    return (
        max(x[WAS_RATIO + i], ratio),
        max(x[WAS_FAST + i], abs(omega)),
        min(x[WAS_NEAR + i], near),
    )
