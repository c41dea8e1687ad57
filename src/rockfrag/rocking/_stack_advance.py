"""Many stacks side by side: the rows of the lanes, and one step of all of them.

A lane is advanced from where it is within a sample to the end of that sample.  All patterns share the
arithmetic of two rotations.  Where only one rotates (pattern 4, and pattern 3 with both blocks as one) it
is the second; the first stands still, uncoupled.  Time is counted in samples.
"""

import math

import numba
import numpy as np

from rockfrag.rocking._compile import kernel
from rockfrag.rocking._mechanics import (
    GRAVITY,
    coupling,
    first_moment1,
    first_moment2,
    inertia1,
    inertia2,
)
from rockfrag.rocking._pendulum import rate, sine_cosine, travel
from rockfrag.rocking._tally import balance
from rockfrag.rocking._two_pendulums import rates_of_two

LANES = 16
HALF_TURN = 0.5 * math.pi

# What a contact state fixes: columns of the table of a body and, times LANES, rows of the lanes.
(
    V1X,  # first moments times the sampling interval squared
    V1Y,
    V2X,
    V2Y,
    PER_SPEED11,  # (1 over critical angle, frequency and interval)² of the pedestal, by either rotation
    PER_SPEED12,
    PER_SPEED22,  # and of the statue
    PER_ANGLE11,  # 1 over the critical angle, likewise, positive on the side of the pole
    PER_ANGLE12,
    PER_ANGLE22,
    M11,
    M22,
    E,
    F,
    SIGN1,  # sides that ground and interface open to; 0 if closed
    SIGN2,
    # what holds the closed contact of pattern 3 or 4 at its right corner: coefficients of
    # (1, sin θ, cos θ) θ'', (sin θ, cos θ, 1) θ'², and (sin θ, cos θ) of the ground and of gravity
    RIGHT_A, RIGHT_AS, RIGHT_AC, RIGHT_W, RIGHT_WS, RIGHT_WC, RIGHT_G, RIGHT_GS, RIGHT_GC,
    RIGHT_X, RIGHT_XS, RIGHT_XC,
    # and at its left corner
    LEFT_A, LEFT_AS, LEFT_AC, LEFT_W, LEFT_WS, LEFT_WC, LEFT_G, LEFT_GS, LEFT_GC,
    LEFT_X, LEFT_XS, LEFT_XC,
) = (LANES * row for row in range(40))  # fmt: skip
COLUMNS = 40
HOLD = RIGHT_A // LANES
CORNER = 12

# The other rows of the lanes.
(
    TH1, RATE1, TH2, RATE2,
    GROUND, GROUND_END,  # acceleration now and at the end of the sample
    REST_OF,  # the part of the sample that is left
    FLAG,
    BEFORE2, BEFORE_RATE2, BEFORE_GROUND, BEFORE_REST, BEFORE,  # where the step before began, if it had no event
    P1, P2, P3, P4, P5, P6,  # Taylor coefficients of both rates
    Q1, Q2, Q3, Q4, Q5, Q6,
    RATIO1, RATIO2, FAST, NEAR,  # extremes of the case so far
) = (LANES * row for row in range(COLUMNS, COLUMNS + 29))  # fmt: skip
ROWS = COLUMNS + 29

QUIET, CLOSES, RELEASE, NEARS = 0.0, 1.0, 2.0, 3.0


@kernel
def row(c1, c2):
    """Row of a contact state."""
    return 3 * c1 + c2 + 4


@kernel
def contact_table(p, hh, t, start):
    """Fill, from place ``start``, what the contact states of a body fix; ``hh``: sampling interval squared.

    There are nine rows of COLUMNS each, in the order of ``row``.
    """
    g = p[GRAVITY]
    for c1 in (-1, 0, 1):
        for c2 in (-1, 0, 1):
            o = start + COLUMNS * row(c1, c2)
            for n in range(COLUMNS):
                t[o + n] = 0.0
            t[o + M11 // LANES] = 1.0
            t[o + M22 // LANES] = 1.0
            if c1 == 0 and c2 == 0:
                continue
            if c1 != 0:
                critical, vx, vy, inertia = balance(p, c1, c2)
                slot = 1 if c2 == 0 else 0
                t[o + PER_ANGLE11 // LANES + slot] = c1 / critical
                per = hh * g * math.hypot(vx, vy) * critical * critical
                t[o + PER_SPEED11 // LANES + slot] = inertia / per
                t[o + SIGN1 // LANES] = c1 if c2 != 0 else 0
                t[o + SIGN2 // LANES] = c1
            if c2 != 0:
                vx, vy = first_moment2(p, c2)
                critical = math.atan2(-c2 * vx, vy)
                t[o + PER_ANGLE22 // LANES] = c2 / critical
                per = hh * g * math.hypot(vx, vy) * critical * critical
                t[o + PER_SPEED22 // LANES] = inertia2(p, c2) / per
                t[o + SIGN2 // LANES] = c2
                t[o + M22 // LANES] = inertia2(p, c2)
                t[o + V2X // LANES], t[o + V2Y // LANES] = hh * vx, hh * vy
            if c1 != 0 and c2 != 0:
                t[o + M11 // LANES] = inertia1(p, c1, c2)
                t[o + E // LANES], t[o + F // LANES] = coupling(p, c1, c2)
                vx, vy = first_moment1(p, c1, c2)
                t[o + V1X // LANES], t[o + V1Y // LANES] = hh * vx, hh * vy
            elif c1 != 0:
                e, _ = coupling(p, c1, 1)
                v1x, v1y = first_moment1(p, c1, 1)
                v2x, v2y = first_moment2(p, 1)
                t[o + M22 // LANES] = inertia1(p, c1, 1) + 2.0 * e + inertia2(p, 1)
                t[o + V2X // LANES], t[o + V2Y // LANES] = hh * (v1x + v2x), hh * (v1y + v2y)
                _interface_hold(p, c1, hh, t, o + HOLD)
            else:
                _ground_hold(p, c2, hh, t, o + HOLD)


@kernel
def _ground_hold(p, c2, hh, t, o):
    """Moments of the ground on a standing pedestal in pattern 4 (``_mechanics.ground_hold``)."""
    for s1, at in ((1, o), (-1, o + CORNER)):
        e, f = coupling(p, s1, c2)
        vx, vy = first_moment1(p, s1, c2)
        # (e cos θ + f sin θ) θ'' + (f cos θ - e sin θ) θ'² + a vy - g vx
        t[at + 1], t[at + 2] = s1 * f, s1 * e
        t[at + 4], t[at + 5] = -s1 * e, s1 * f
        t[at + 6] = s1 * hh * vy
        t[at + 9] = -s1 * hh * p[GRAVITY] * vx


@kernel
def _interface_hold(p, c1, hh, t, o):
    """Moments of the interface on the statue that turns with its pedestal (``interface_hold``)."""
    for s2, at in ((1, o), (-1, o + CORNER)):
        e, f = coupling(p, c1, s2)
        vx, vy = first_moment2(p, s2)
        # (e + m22) θ'' - f θ'² + a (vy cos θ - vx sin θ) - g (vx cos θ + vy sin θ)
        t[at] = s2 * (e + inertia2(p, s2))
        t[at + 3] = -s2 * f
        weight = s2 * hh * p[GRAVITY]
        t[at + 7], t[at + 8] = -s2 * hh * vx, s2 * hh * vy
        t[at + 10], t[at + 11] = -weight * vy, -weight * vx


@numba.njit(inline="always", error_model="numpy")
def _hops(gap, out, out_at_end, bend):
    """Whether a contact that opens, and still opens at the end, may have closed in between.

    The cubic through rate and acceleration at the start and rate at the end, over time, is
    out + bend τ / 2 + c τ² / 3; it must have a minimum within the step that is negative, either by half.
    """
    c = out_at_end - out - bend
    return (
        (out >= 0.0)
        & (out_at_end > 0.0)
        & (gap + 0.5 * bend < 0.0)
        & (-0.5 * bend < c)
        & (bend * bend > 3.5 * out * c)
    )


@kernel
def advance(x, g):
    """Advance every lane to the end of its sample; flag those with an event, which stay where they are."""
    for i in range(LANES):
        left = x[REST_OF + i]
        scale = left * left
        t1 = x[TH1 + i]
        t2 = x[TH2 + i]
        w1 = x[RATE1 + i] * left
        w2 = x[RATE2 + i] * left
        a = x[GROUND + i]
        s1, c1 = sine_cosine(t1)
        s2, c2 = sine_cosine(t2)
        sd = s2 * c1 - c2 * s1
        cd = c2 * c1 + s2 * s1
        e = x[E + i]
        f = x[F + i]
        v1x = scale * x[V1X + i]
        v1y = scale * x[V1Y + i]
        v2x = scale * x[V2X + i]
        v2y = scale * x[V2Y + i]
        p1, p2, p3, p4, p5, p6, q1, q2, q3, q4, q5, q6 = rates_of_two(
            x[M11 + i], x[M22 + i], e * cd + f * sd, f * cd - e * sd,
            v1y * c1 - v1x * s1, v1x * c1 + v1y * s1, v2y * c2 - v2x * s2, v2x * c2 + v2y * s2,
            g, w1, w2, a, x[GROUND_END + i] - a,
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
        dips = ((out1 < 0.0) & (in1 > 0.0) & (from1 * (in1 - out1) < out1 * out1)) | (
            (out2 < 0.0) & (in2 > 0.0) & (from2 * (in2 - out2) < out2 * out2)
        )
        hops = _hops(from1, out1, in1, sign1 * p1) | _hops(from2, out2, in2, sign2 * (q1 - p1))
        lies = (max(abs(n1), abs(n2)) >= HALF_TURN) | (abs(n2 - n1) >= HALF_TURN)
        # a closed contact would have to be pulled
        square = w2 * w2
        right = (x[RIGHT_A + i] + x[RIGHT_AS + i] * s2 + x[RIGHT_AC + i] * c2) * q1
        right += (x[RIGHT_W + i] + x[RIGHT_WS + i] * s2 + x[RIGHT_WC + i] * c2) * square
        right += scale * (a * (x[RIGHT_G + i] + x[RIGHT_GS + i] * s2 + x[RIGHT_GC + i] * c2))
        right += scale * (x[RIGHT_X + i] + x[RIGHT_XS + i] * s2 + x[RIGHT_XC + i] * c2)
        other = (x[LEFT_A + i] + x[LEFT_AS + i] * s2 + x[LEFT_AC + i] * c2) * q1
        other += (x[LEFT_W + i] + x[LEFT_WS + i] * s2 + x[LEFT_WC + i] * c2) * square
        other += scale * (a * (x[LEFT_G + i] + x[LEFT_GS + i] * s2 + x[LEFT_GC + i] * c2))
        other += scale * (x[LEFT_X + i] + x[LEFT_XS + i] * s2 + x[LEFT_XC + i] * c2)
        flag = CLOSES if closes else QUIET
        flag = NEARS if dips | hops | lies else flag
        flag = RELEASE if (right < 0.0) | (other < 0.0) else flag
        x[FLAG + i] = flag
        # without an event the lane is at the end of the sample
        quiet = flag == QUIET
        z1 = z1 / left
        z2 = z2 / left
        ratio1 = x[PER_ANGLE11 + i] * n1 + x[PER_ANGLE12 + i] * n2
        ratio2 = x[PER_ANGLE22 + i] * n2
        away1 = (1.0 - ratio1) * (1.0 - ratio1)
        away1 += x[PER_SPEED11 + i] * z1 * z1 + x[PER_SPEED12 + i] * z2 * z2
        away2 = (1.0 - ratio2) * (1.0 - ratio2) + x[PER_SPEED22 + i] * z2 * z2
        x[RATIO1 + i] = max(x[RATIO1 + i], ratio1 if quiet else 0.0)
        x[RATIO2 + i] = max(x[RATIO2 + i], ratio2 if quiet else 0.0)
        x[FAST + i] = max(x[FAST + i], abs(z2) if quiet else 0.0)
        x[NEAR + i] = min(x[NEAR + i], min(away1, away2) if quiet else np.inf)
        x[BEFORE2 + i] = t2 if quiet else x[BEFORE2 + i]
        x[BEFORE_RATE2 + i] = x[RATE2 + i] if quiet else x[BEFORE_RATE2 + i]
        x[BEFORE_GROUND + i] = a if quiet else x[BEFORE_GROUND + i]
        x[BEFORE_REST + i] = left if quiet else x[BEFORE_REST + i]
        x[BEFORE + i] = 1.0 if quiet else x[BEFORE + i]
        x[TH1 + i] = n1 if quiet else t1
        x[TH2 + i] = n2 if quiet else t2
        x[RATE1 + i] = z1 if quiet else x[RATE1 + i]
        x[RATE2 + i] = z2 if quiet else x[RATE2 + i]
        x[GROUND + i] = x[GROUND_END + i] if quiet else a
        x[REST_OF + i] = 1.0 if quiet else left
