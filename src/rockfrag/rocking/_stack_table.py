"""The table of a stack: all that its contact states fix, so that lanes and events need only look it up.

A table is one flat array (views of rows would cost more than what is read from them) and holds, from its
place 0, a row for every contact state, a row of impacts for every contact state, and what chatter at rest is
closed with.  Time is counted in samples, so lengths of time in it carry the sampling interval.
"""

import math

from rockfrag.rocking._compile import kernel
from rockfrag.rocking._events import restoring_table
from rockfrag.rocking._mechanics import (
    arm1,
    arm2,
    coupling,
    first_moment1,
    first_moment2,
    impact,
    inertia1,
    inertia2,
    kinetic_energy,
    pole,
    reach,
)
from rockfrag.rocking._step import RESTORED
from rockfrag.rocking._tally import balance

LANES = 16
"""Lanes of each kind."""

CLOSES, NEARS, RELEASE = 1.0, 2.0, 3.0
"""Flags of the events of a lane's step."""

# Columns of a state in which one rotates: the statue (pattern 4), or both blocks as one (pattern 3).
(
    GX,  # first moments about the pole times g over the moment of inertia, per sample²
    GY,
    PER_ANGLE,  # 1 over the critical angle, positive on the side of the pole
    PER_SPEED,  # (1 over critical angle, frequency and interval)²
    # what holds the closed contact at its right corner: coefficients of (1, sin θ, cos θ) θ'',
    # (sin θ, cos θ, 1) θ'², and (sin θ, cos θ) of the ground and of gravity
    RIGHT_A, RIGHT_AS, RIGHT_AC, RIGHT_W, RIGHT_WS, RIGHT_WC, RIGHT_G, RIGHT_GS, RIGHT_GC,
    RIGHT_X, RIGHT_XS, RIGHT_XC,
    # and at its left corner
    LEFT_A, LEFT_AS, LEFT_AC, LEFT_W, LEFT_WS, LEFT_WC, LEFT_G, LEFT_GS, LEFT_GC,
    LEFT_X, LEFT_XS, LEFT_XC,
) = range(28)  # fmt: skip
HOLD = RIGHT_A
CORNER = LEFT_A - RIGHT_A
ONE_COLUMNS = 28

# Columns of a state in which both rotate (patterns 1 and 2).
(
    V1X,  # first moments per sample²
    V1Y,
    V2X,
    V2Y,
    M11,
    M22,
    E,
    F,
    PER_ANGLE1,
    PER_ANGLE2,
    PER_SPEED1,
    PER_SPEED2,
) = range(12)
TWO_COLUMNS = 12

COLUMNS = max(ONE_COLUMNS, TWO_COLUMNS)

# Columns of a row of impacts: products of the velocity fields before and after, ...
GROUND, BOTH11, BOTH12, BOTH21, BOTH22 = range(5)
# ... and of a landing contacts and velocities after it, at unit speed before, and √ of the energy left.
NEXT1, NEXT2, AFTER1, AFTER2, SHARE = range(5, 10)
PRODUCTS = 10

# Places in the table.
IMPACTS = 9 * COLUMNS
RESTORING_AT = IMPACTS + 9 * PRODUCTS
TABLE = RESTORING_AT + RESTORED


@kernel
def state(start, c1, c2):
    """Where the row of a contact state begins in the table that begins at ``start``."""
    return start + COLUMNS * (3 * c1 + c2 + 4)


@kernel
def impacts_of(start, c1, c2):
    """Where the row of impacts from a contact state begins, likewise."""
    return start + IMPACTS + PRODUCTS * (3 * c1 + c2 + 4)


@kernel
def body_table(p, h, t, start):
    """Fill the table of a body for a sampling interval h [s] from place ``start``."""
    hh = h * h
    for c1 in (-1, 0, 1):
        for c2 in (-1, 0, 1):
            o = state(start, c1, c2)
            at = impacts_of(start, c1, c2)
            if c1 != 0 and c2 != 0:
                _both_rotate(p, c1, c2, hh, t, o)
                _meeting(p, c1, c2, t, at)
            elif c1 != 0 or c2 != 0:
                _one_rotates(p, c1, c2, hh, t, o)
                _landing(p, c1, c2, t, at)
    restoring_table(p, t, start + RESTORING_AT)


@kernel
def _one_rotates(p, c1, c2, hh, t, o):
    g = p.gravity
    if c1 != 0:
        critical, vx, vy, inertia = balance(p, c1, c2)
        _interface_hold(p, c1, hh, t, o + HOLD)
    else:
        s2 = pole(c2)
        vx, vy = first_moment2(p, s2)
        inertia = inertia2(p, s2)
        critical = math.atan2(-c2 * vx, vy)
        _ground_hold(p, c2, hh, t, o + HOLD)
    per = hh * g / inertia
    t[o + GX], t[o + GY] = per * vx, per * vy
    t[o + PER_ANGLE] = (c1 + c2) / critical
    t[o + PER_SPEED] = 1.0 / (per * math.hypot(vx, vy) * critical * critical)


@kernel
def _both_rotate(p, c1, c2, hh, t, o):
    g = p.gravity
    s1, s2 = pole(c1), pole(c2)
    t[o + M11], t[o + M22] = inertia1(p, s1, s2), inertia2(p, s2)
    t[o + E], t[o + F] = coupling(p, s1, s2)
    critical, vx, vy, inertia = balance(p, c1, c2)
    t[o + V1X], t[o + V1Y] = hh * vx, hh * vy
    t[o + PER_ANGLE1] = c1 / critical
    t[o + PER_SPEED1] = inertia / (hh * g * math.hypot(vx, vy) * critical * critical)
    vx, vy = first_moment2(p, s2)
    critical = math.atan2(-c2 * vx, vy)
    t[o + V2X], t[o + V2Y] = hh * vx, hh * vy
    t[o + PER_ANGLE2] = c2 / critical
    t[o + PER_SPEED2] = t[o + M22] / (hh * g * math.hypot(vx, vy) * critical * critical)


@kernel
def _ground_hold(p, c2, hh, t, o):
    """Moments of the ground on a standing pedestal in pattern 4 (``_mechanics.ground_hold``)."""
    s2 = pole(c2)
    for s1, at in ((1.0, o), (-1.0, o + CORNER)):
        e, f = coupling(p, s1, s2)
        vx, vy = first_moment1(p, s1, s2)
        # (e cos θ + f sin θ) θ'' + (f cos θ - e sin θ) θ'² + a vy - g vx
        for n in range(CORNER):
            t[at + n] = 0.0
        t[at + 1], t[at + 2] = s1 * f, s1 * e
        t[at + 4], t[at + 5] = -s1 * e, s1 * f
        t[at + 6] = s1 * hh * vy
        t[at + 9] = -s1 * hh * p.gravity * vx


@kernel
def _interface_hold(p, c1, hh, t, o):
    """Moments of the interface on the statue that turns with its pedestal (``interface_hold``)."""
    s1 = pole(c1)
    for s2, at in ((1.0, o), (-1.0, o + CORNER)):
        e, f = coupling(p, s1, s2)
        vx, vy = first_moment2(p, s2)
        # (e + m22) θ'' - f θ'² + a (vy cos θ - vx sin θ) - g (vx cos θ + vy sin θ)
        for n in range(CORNER):
            t[at + n] = 0.0
        t[at] = s2 * (e + inertia2(p, s2))
        t[at + 3] = -s2 * f
        weight = s2 * hh * p.gravity
        t[at + 7], t[at + 8] = -s2 * hh * vx, s2 * hh * vy
        t[at + 10], t[at + 11] = -weight * vy, -weight * vx


@kernel
def _meeting(p, c1, c2, t, o):
    """Impacts of one contact while the other stays open."""
    s1, s2 = pole(c1), pole(c2)
    ax, ay = arm1(p, s1)
    bx, by = arm1(p, -s1)
    dx, dy = reach(p, s1, s2)
    ex, ey = reach(p, -s1, s2)
    t[o + GROUND] = p.i1 + p.m1 * (ax * bx + ay * by) + p.m2 * (dx * ex + dy * ey)
    ex, ey = reach(p, s1, -s2)
    rx, ry = arm2(p, s2)
    sx, sy = arm2(p, -s2)
    t[o + BOTH11] = p.i1 + p.m1 * (ax * ax + ay * ay) + p.m2 * (dx * ex + dy * ey)
    t[o + BOTH12] = p.m2 * (ex * rx + ey * ry)
    t[o + BOTH21] = p.m2 * (dx * sx + dy * sy)
    t[o + BOTH22] = p.i2 + p.m2 * (rx * sx + ry * sy)


@kernel
def _landing(p, c1, c2, t, o):
    """Landing of what rocks alone: the outcome is the same for every speed but for its size."""
    old1, old2 = -1.0 * c1, -1.0 * (c1 + c2)
    n1, n2, w1, w2 = impact(p, c1, c2, c1 != 0, c2 != 0, 0.0, old1, 0.0, old2)
    before = kinetic_energy(p, c1, c2, 0.0, old1, 0.0, old2)
    after = kinetic_energy(p, n1, n2, 0.0, w1, 0.0, w2)
    t[o + NEXT1], t[o + NEXT2], t[o + AFTER1], t[o + AFTER2] = n1, n2, w1, w2
    t[o + SHARE] = math.sqrt(after / before)
