"""Impacts of a stack from the table of its body, with time counted in samples.

The general treatment is in ``_mechanics.impact`` and ``_events.strike``; here are the cases that make nearly
all impacts of an ensemble: one contact of two closes, momentum is conserved, and both come off; and a
landing of what rocks alone (pattern 3 or 4), whose outcome is the same for every speed but for its size.

The table is one flat array ``t``: views of its rows would cost more than what is read from them.  ``o`` is
where the row of a contact state begins.
"""

import math

from rockfrag.rocking._compile import kernel
from rockfrag.rocking._events import restoring_table
from rockfrag.rocking._mechanics import (
    I1,
    I2,
    M1,
    M2,
    MEASURED,
    arm1,
    arm2,
    impact,
    kinetic_energy,
    reach,
)
from rockfrag.rocking._pendulum import sine_cosine
from rockfrag.rocking._stack_advance import (
    COLUMNS,
    CORNER,
    HOLD,
    LANES,
    M11,
    M22,
    V1X,
    V1Y,
    V2X,
    V2Y,
    contact_table,
    row,
)
from rockfrag.rocking._stack_advance import E as E_ROW
from rockfrag.rocking._stack_advance import F as F_ROW
from rockfrag.rocking._step import RESTORED

# Rows of impacts, one per contact state before: products of the velocity fields before and after, ...
GROUND, BOTH11, BOTH12, BOTH21, BOTH22 = range(5)
# ... and of a landing contacts and velocities after it, at unit speed before, and √ of the energy left.
NEXT1, NEXT2, AFTER1, AFTER2, SHARE = range(5, 10)
PRODUCTS = 10

# Places in the table of a body.
STATES = 0
IMPACTS = STATES + 9 * COLUMNS
RESTORING_AT = IMPACTS + 9 * PRODUCTS
HAS_MEASURED = RESTORING_AT + RESTORED
TABLE = HAS_MEASURED + 1

CHATTER_ERROR = 1e-7
"""Largest ω² T [rad²/s] of a chatter that is closed at once; see ``chatter_closes``."""
FASTEST_CHATTER = 0.1
"""Speed [rad/s] above which no chatter is closed."""
CHATTER_TIME = 0.08
"""Time [s] over which the ground is looked at, at most, before a chatter is closed."""


@kernel
def body_table(p, h, t, start):
    """Fill the table of a body for a sampling interval h [s] from place ``start``."""
    contact_table(p, h * h, t, start + STATES)
    _impact_table(p, t, start + IMPACTS)
    restoring_table(p, t, start + RESTORING_AT)
    t[start + HAS_MEASURED] = p[MEASURED]


@kernel
def _impact_table(p, t, start):
    for c1 in (-1, 1):
        for c2 in (-1, 1):
            o = start + PRODUCTS * row(c1, c2)
            ax, ay = arm1(p, c1)
            bx, by = arm1(p, -c1)
            dx, dy = reach(p, c1, c2)
            ex, ey = reach(p, -c1, c2)
            t[o + GROUND] = p[I1] + p[M1] * (ax * bx + ay * by) + p[M2] * (dx * ex + dy * ey)
            ex, ey = reach(p, c1, -c2)
            rx, ry = arm2(p, c2)
            sx, sy = arm2(p, -c2)
            t[o + BOTH11] = p[I1] + p[M1] * (ax * ax + ay * ay) + p[M2] * (dx * ex + dy * ey)
            t[o + BOTH12] = p[M2] * (ex * rx + ey * ry)
            t[o + BOTH21] = p[M2] * (dx * sx + dy * sy)
            t[o + BOTH22] = p[I2] + p[M2] * (rx * sx + ry * sy)
    for c1, c2 in ((0, 1), (0, -1), (1, 0), (-1, 0)):
        o = start + PRODUCTS * row(c1, c2)
        old1, old2 = -1.0 * c1, -1.0 * (c1 + c2)
        n1, n2, w1, w2 = impact(p, c1, c2, c1 != 0, c2 != 0, 0.0, old1, 0.0, old2)
        before = kinetic_energy(p, c1, c2, 0.0, old1, 0.0, old2)
        after = kinetic_energy(p, n1, n2, 0.0, w1, 0.0, w2)
        t[o + NEXT1], t[o + NEXT2], t[o + AFTER1], t[o + AFTER2] = n1, n2, w1, w2
        t[o + SHARE] = math.sqrt(after / before)


@kernel
def least_hold(t, o, theta, omega, ground, g):
    """Least contact moment of the closed contact of pattern 3 or 4; negative if it would have to pull.

    ``theta`` and ``omega`` are those of what rocks, ``ground`` the acceleration of the ground.
    """
    s, c = sine_cosine(theta)
    v2x, v2y = t[o + V2X // LANES], t[o + V2Y // LANES]
    alpha = (g * (v2x * c + v2y * s) - ground * (v2y * c - v2x * s)) / t[o + M22 // LANES]
    least = math.inf
    for at in (o + HOLD, o + HOLD + CORNER):
        moment = (t[at] + t[at + 1] * s + t[at + 2] * c) * alpha
        moment += (t[at + 3] + t[at + 4] * s + t[at + 5] * c) * omega * omega
        moment += (t[at + 6] + t[at + 7] * s + t[at + 8] * c) * ground
        moment += t[at + 9] + t[at + 10] * s + t[at + 11] * c
        least = min(least, moment)
    return least


@kernel
def _couplings(t, o, cosine, sine):
    """M11, M12, M22, D of a contact state at cos Δ, sin Δ."""
    e, f = t[o + E_ROW // LANES], t[o + F_ROW // LANES]
    m11, m22 = t[o + M11 // LANES], t[o + M22 // LANES]
    return m11, e * cosine + f * sine, m22, f * cosine - e * sine


@kernel
def ground_impact(t, before, after, products, cosine, sine, omega1, omega2):
    """Velocities after the ground closes (thesis eq. 2.68-2.71): both momenta about the new poles."""
    _, old12, m22, _ = _couplings(t, before, cosine, sine)
    m11, m12, _, _ = _couplings(t, after, cosine, sine)
    q1 = t[products + GROUND] * omega1 + m12 * omega2
    q2 = old12 * omega1 + m22 * omega2
    share = 1.0 / (m11 * m22 - m12 * m12)
    return (m22 * q1 - m12 * q2) * share, (m11 * q2 - m12 * q1) * share


@kernel
def interface_impact(t, after, products, omega1, omega2):
    """Velocities after the interface closes, Δ = 0: momentum of the whole and of the statue."""
    m11, m12, m22 = t[after + M11 // LANES], t[after + E_ROW // LANES], t[after + M22 // LANES]
    q1 = t[products + BOTH11] * omega1 + t[products + BOTH12] * omega2
    q2 = t[products + BOTH21] * omega1 + t[products + BOTH22] * omega2
    share = 1.0 / (m11 * m22 - m12 * m12)
    return (m22 * q1 - m12 * q2) * share, (m11 * q2 - m12 * q1) * share


@kernel
def _opening(t, o, ground, side, s1, k1, s2, k2, omega1, omega2, g):
    """Acceleration that opens a contact further: at zero ground acceleration, per unit of it; inertia.

    The inertia is that of the opening alone, the momentum that its impacts conserve being given.
    """
    m11, m12, m22, d = _couplings(t, o, k2 * k1 + s2 * s1, s2 * k1 - k2 * s1)
    v1x, v1y = t[o + V1X // LANES], t[o + V1Y // LANES]
    v2x, v2y = t[o + V2X // LANES], t[o + V2Y // LANES]
    f1 = d * omega2 * omega2 - g * (v1x * k1 + v1y * s1)
    f2 = -d * omega1 * omega1 - g * (v2x * k2 + v2y * s2)
    a1 = v1y * k1 - v1x * s1
    a2 = v2y * k2 - v2x * s2
    determinant = m11 * m22 - m12 * m12
    if ground:
        by1, by2, inertia = -m22, m12, determinant / m22
    else:
        by1, by2 = m12 + m22, -(m11 + m12)
        inertia = determinant / (m11 + 2.0 * m12 + m22)
    scale = side / determinant
    return scale * (by1 * f1 + by2 * f2), scale * (by1 * a1 + by2 * a2), inertia


@kernel
def chatter_closes(
    t, before, after, ground, old, side, theta1, omega1, theta2, omega2, toward, g, k, tau, h, samples, last,
    factor,
):  # fmt: skip
    """Whether a contact that comes off may stay closed at once, while the other is open.

    All impacts of the contact conserve the momentum of what rocks on, so that its velocity at their end is the
    one of a contact that stays closed now, but for what the hops change meanwhile.  With restoring
    accelerations D and D' on the two poles, and e e' the share of the hops' energy that two impacts leave,
    hops of speed ω are over within T = 2 ω (1/D + e'/D') / (1 - e e').  The opening returns to zero after every
    hop, so what remains is of second order, ω² T in velocity.  T is taken half as long again, and nothing
    else may happen in twice that time.

    Parameters
    ----------
    before, after : rows of the contact states
    ground : whether it is the ground's contact
    old : relative velocity before the impact
    side : sign of the opening after it
    toward : speed at which the other contact closes, if positive
    """
    speed = abs(omega1) if ground else abs(omega2 - omega1)
    if speed > FASTEST_CHATTER * h:
        return False
    s1, k1 = sine_cosine(theta1)
    s2, k2 = sine_cosine(theta2)
    here, per_here, inertia = _opening(t, after, ground, side, s1, k1, s2, k2, omega1, omega2, g)
    there, per_there, of_old = _opening(t, before, ground, -side, s1, k1, s2, k2, omega1, omega2, g)
    e = speed / abs(old)
    left = e * e * inertia / of_old
    if left > 0.98:
        return False
    gap = abs(theta2 - theta1) if ground else abs(theta1)
    longest = CHATTER_ERROR * h / (speed * speed)
    if toward > 0.0:
        longest = min(longest, 0.5 * gap / toward)
    hops = 3.0 * speed / (1.0 - left)
    back = left / e
    # the ground's acceleration over twice the time that its present value gives, sample by sample
    a_left = factor * samples[k] if k <= last else 0.0
    a_right = factor * samples[k + 1] if k < last else 0.0
    a = a_left + tau * (a_right - a_left)
    least = -(here + per_here * a)
    other = -(there + per_there * a)
    if least <= 0.0 or other <= 0.0:
        return False
    span = 2.0 * hops * (1.0 / least + back / other)
    if span > 2.0 * longest or span > CHATTER_TIME / h:
        return False
    n = 1
    while True:
        x = min(n - tau, span)
        a = a_right + (x - (n - tau)) * (a_right - a_left)
        least = min(least, -(here + per_here * a))
        other = min(other, -(there + per_there * a))
        if least <= 0.0 or other <= 0.0:
            return False
        if x == span:
            break
        n += 1
        a_left = a_right
        a_right = factor * samples[k + n] if k + n <= last else 0.0
    return hops * (1.0 / least + back / other) <= min(longest, span)


@kernel
def closed(t, o, ground, cosine, sine, omega1, omega2):
    """Velocities once the contact stays closed, with the momentum of (ω1, ω2) in this state."""
    m11, m12, m22, _ = _couplings(t, o, cosine, sine)
    if ground:
        return 0.0, omega2 + m12 * omega1 / m22
    both = ((m11 + m12) * omega1 + (m12 + m22) * omega2) / (m11 + 2.0 * m12 + m22)
    return both, both
