"""Stacks side by side of which both blocks rotate, the ground and the interface being open.

One pass advances every lane by one step, which ends with its sample or takes the largest part of it that is
allowed.  Time is counted in samples; ``t`` is the table of a body (``_stack_table``) and ``o`` its row of
the contact state.
"""

import numba

from rockfrag.rocking import _stack_table as table
from rockfrag.rocking._compile import inlined_kernel, kernel
from rockfrag.rocking._events import first_closing, ground_gap, interface_gap
from rockfrag.rocking._passes import QUIET, WITHIN
from rockfrag.rocking._pendulum import HALF_TURN, dips, hops, rate, sine_cosine, travel
from rockfrag.rocking._series import crossing_time
from rockfrag.rocking._stack_table import CLOSES, LANES, NEARS, TWO_COLUMNS
from rockfrag.rocking._step import GAP
from rockfrag.rocking._step import TH1 as SERIES1
from rockfrag.rocking._step import TH2 as SERIES2
from rockfrag.rocking._two_pendulums import rates_of_two

# Rows of the lanes after those of the table's columns.
(
    SIGN1,  # sides that ground and interface open to
    SIGN2,
    FACTOR,
    PART,  # the largest part of a sample that a step may take
    GROUND_END,  # acceleration of the ground at the end of the sample
    TH1,  # the state; the acceleration of the ground; the part of the sample that is left
    RATE1,
    TH2,
    RATE2,
    GROUND,
    LEFT,
    RATIO1,  # extremes so far: of θ/θcritical, |θ2'|, and distance from balance squared
    RATIO2,
    FAST,
    NEAR,
    FLAG,
    WAS_TH1,  # these where the step began
    WAS_RATE1,
    WAS_TH2,
    WAS_RATE2,
    WAS_GROUND,
    WAS_LEFT,
    WAS_RATIO1,
    WAS_RATIO2,
    WAS_FAST,
    WAS_NEAR,
    P1,  # Taylor coefficients of both rates
    P2,
    P3,
    P4,
    P5,
    P6,
    Q1,
    Q2,
    Q3,
    Q4,
    Q5,
    Q6,
) = (LANES * row for row in range(TWO_COLUMNS, TWO_COLUMNS + 38))
ROWS = TWO_COLUMNS + 38

# The table's columns as rows of the lanes.
_V1X, _V1Y, _V2X, _V2Y, _M11, _M22, _E, _F, _PER_ANGLE1, _PER_ANGLE2, _PER_SPEED1, _PER_SPEED2 = (
    LANES * column for column in range(TWO_COLUMNS)
)
INERTIAS = _M11, _M22

REMNANT = 1e-12
"""Part of a sample that is not worth a step of its own."""


@numba.njit(inline="always", error_model="numpy")
def _span(left, part):
    """Length of a step with so much of the sample left and so large a part of it allowed."""
    return left if left <= part + REMNANT else part


@kernel
def advance(x, g):
    """Advance every lane by a step, and flag those with an event in it.

    A lane is QUIET at the end of its sample, and WITHIN it after a step that does not reach that end.
    Everything is stored in every lane: conditional stores cost many times as much.
    """
    for i in range(LANES):
        left = x[LEFT + i]
        span = _span(left, x[PART + i])
        scale = span * span
        t1 = x[TH1 + i]
        t2 = x[TH2 + i]
        rate1 = x[RATE1 + i]
        rate2 = x[RATE2 + i]
        w1 = rate1 * span
        w2 = rate2 * span
        a = x[GROUND + i]
        a_end = x[GROUND_END + i]
        rise = (a_end - a) * (span / left)
        s1, c1 = sine_cosine(t1)
        s2, c2 = sine_cosine(t2)
        sd = s2 * c1 - c2 * s1
        cd = c2 * c1 + s2 * s1
        e = x[_E + i]
        f = x[_F + i]
        v1x = scale * x[_V1X + i]
        v1y = scale * x[_V1Y + i]
        v2x = scale * x[_V2X + i]
        v2y = scale * x[_V2Y + i]
        p1, p2, p3, p4, p5, p6, q1, q2, q3, q4, q5, q6 = rates_of_two(
            x[_M11 + i], x[_M22 + i], e * cd + f * sd, f * cd - e * sd,
            v1y * c1 - v1x * s1, v1x * c1 + v1y * s1, v2y * c2 - v2x * s2, v2x * c2 + v2y * s2,
            g, w1, w2, a, rise,
        )  # fmt: skip
        n1 = t1 + travel(w1, p1, p2, p3, p4, p5, p6, 1.0)
        n2 = t2 + travel(w2, q1, q2, q3, q4, q5, q6, 1.0)
        z1 = rate(w1, p1, p2, p3, p4, p5, p6, 1.0)
        z2 = rate(w2, q1, q2, q3, q4, q5, q6, 1.0)
        x[P1 + i], x[P2 + i], x[P3 + i], x[P4 + i], x[P5 + i], x[P6 + i] = p1, p2, p3, p4, p5, p6
        x[Q1 + i], x[Q2 + i], x[Q3 + i], x[Q4 + i], x[Q5 + i], x[Q6 + i] = q1, q2, q3, q4, q5, q6
        # a contact closes, nearly closes, or may close and open again
        sign1 = x[SIGN1 + i]
        sign2 = x[SIGN2 + i]
        from1 = sign1 * t1
        out1 = sign1 * w1
        in1 = sign1 * z1
        from2 = sign2 * (t2 - t1)
        out2 = sign2 * (w2 - w1)
        in2 = sign2 * (z2 - z1)
        closes = (sign1 * n1 < 0.0) | (sign2 * (n2 - n1) < 0.0)
        near = dips(from1, out1, in1) | hops(from1, out1, in1, sign1 * p1)
        near |= dips(from2, out2, in2) | hops(from2, out2, in2, sign2 * (q1 - p1))
        lies = (max(abs(n1), abs(n2)) >= HALF_TURN) | (abs(n2 - n1) >= HALF_TURN)
        flag = WITHIN if span < left else QUIET
        flag = CLOSES if closes else flag
        flag = NEARS if near | lies else flag
        x[FLAG + i] = flag
        x[WAS_TH1 + i] = t1
        x[WAS_RATE1 + i] = rate1
        x[WAS_TH2 + i] = t2
        x[WAS_RATE2 + i] = rate2
        x[WAS_GROUND + i] = a
        x[WAS_LEFT + i] = left
        per = 1.0 / span
        z1 = z1 * per
        z2 = z2 * per
        x[TH1 + i] = n1
        x[RATE1 + i] = z1
        x[TH2 + i] = n2
        x[RATE2 + i] = z2
        x[GROUND + i] = a + rise if span < left else a_end
        x[LEFT + i] = left - span if span < left else 1.0
        was_ratio1, was_ratio2 = x[RATIO1 + i], x[RATIO2 + i]
        was_fast, was_near = x[FAST + i], x[NEAR + i]
        x[WAS_RATIO1 + i], x[WAS_RATIO2 + i] = was_ratio1, was_ratio2
        x[WAS_FAST + i], x[WAS_NEAR + i] = was_fast, was_near
        ratio1 = x[_PER_ANGLE1 + i] * n1
        ratio2 = x[_PER_ANGLE2 + i] * n2
        away1 = (1.0 - ratio1) * (1.0 - ratio1) + x[_PER_SPEED1 + i] * z1 * z1
        away2 = (1.0 - ratio2) * (1.0 - ratio2) + x[_PER_SPEED2 + i] * z2 * z2
        x[RATIO1 + i] = max(was_ratio1, ratio1)
        x[RATIO2 + i] = max(was_ratio2, ratio2)
        x[FAST + i] = max(was_fast, abs(z2))
        x[NEAR + i] = min(was_near, min(away1, away2))


@inlined_kernel
def span_of(x, i):
    """Length of a lane's step."""
    return _span(x[WAS_LEFT + i], x[PART + i])


@inlined_kernel
def take_series(x, i, q):
    """Copy the series of a lane's step into the scratch array of the events."""
    span = span_of(x, i)
    q[SERIES1], q[SERIES1 + 1] = x[WAS_TH1 + i], x[WAS_RATE1 + i] * span
    q[SERIES2], q[SERIES2 + 1] = x[WAS_TH2 + i], x[WAS_RATE2 + i] * span
    for n in range(6):
        q[SERIES1 + 2 + n] = x[P1 + n * LANES + i] * (1.0 / (n + 2))
        q[SERIES2 + 2 + n] = x[Q1 + n * LANES + i] * (1.0 / (n + 2))


@inlined_kernel
def next_event(c1, c2, x, i, q):
    """Time in the lane's step of its first closing, 2 if there is none; whether ground and interface close."""
    if x[FLAG + i] != CLOSES:
        return first_closing(c1, c2, q)
    when1 = 2.0
    when2 = 2.0
    if ground_gap(c1, q) < 0.0:
        when1 = crossing_time(q, GAP)
    if interface_gap(c2, q) < 0.0:
        when2 = crossing_time(q, GAP)
    when = min(when1, when2)
    return when, when1 <= when + 1e-13, when2 <= when + 1e-13


@inlined_kernel
def nearest(t, o, x, i, theta1, omega1, theta2, omega2):
    """Largest θ/θcritical of both, |θ2'|, least distance from balance squared, up to an event at θ, θ'."""
    ratio1 = t[o + table.PER_ANGLE1] * theta1
    ratio2 = t[o + table.PER_ANGLE2] * theta2
    away1 = (1.0 - ratio1) * (1.0 - ratio1) + t[o + table.PER_SPEED1] * omega1 * omega1
    away2 = (1.0 - ratio2) * (1.0 - ratio2) + t[o + table.PER_SPEED2] * omega2 * omega2
    return (
        max(x[WAS_RATIO1 + i], ratio1),
        max(x[WAS_RATIO2 + i], ratio2),
        max(x[WAS_FAST + i], abs(omega2)),
        min(x[WAS_NEAR + i], min(away1, away2)),
    )
