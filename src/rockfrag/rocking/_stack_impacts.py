"""Impacts of a stack from the tables of its contact states.

The general treatment is in ``_mechanics.impact`` and ``_events.strike``; here are the cases that make nearly
all impacts of an ensemble: one contact of two closes, momentum is conserved, and both come off; and a
landing of what rocks alone (pattern 3 or 4), whose outcome is the same for every speed but for its size.
"""

import math

from rockfrag.rocking._compile import kernel
from rockfrag.rocking._mechanics import I1, I2, M1, M2, arm1, arm2, impact, reach
from rockfrag.rocking._pendulum import sine_cosine
from rockfrag.rocking._stack_advance import CORNER, HOLD, LANES, M11, M22, V1X, V1Y, V2X, V2Y, E, F

# Columns of the table of impacts: products of the velocity fields before and after.
GROUND, BOTH11, BOTH12, BOTH21, BOTH22 = range(5)
# and of a landing: contacts and velocities after it, at unit speed before
NEXT1, NEXT2, AFTER1, AFTER2 = range(5, 9)
COLUMNS = 9

CHATTER_ERROR = 1e-7
"""Largest ω² T [rad²/s] of a chatter that is closed at once; see ``chatter_closes``."""
FASTEST_CHATTER = 0.1
"""Speed [rad/s] above which no chatter is closed."""
CHATTER_SAMPLES = 4
"""Samples ahead that a chatter may last."""


@kernel
def impact_table(p, table):
    """Fill the (9, COLUMNS) table of a body: row 3 c1 + c2 + 4 for the contact state before."""
    for c1 in (-1, 1):
        for c2 in (-1, 1):
            row = table[3 * c1 + c2 + 4]
            ax, ay = arm1(p, c1)
            bx, by = arm1(p, -c1)
            dx, dy = reach(p, c1, c2)
            ex, ey = reach(p, -c1, c2)
            row[GROUND] = p[I1] + p[M1] * (ax * bx + ay * by) + p[M2] * (dx * ex + dy * ey)
            ex, ey = reach(p, c1, -c2)
            rx, ry = arm2(p, c2)
            sx, sy = arm2(p, -c2)
            row[BOTH11] = p[I1] + p[M1] * (ax * ax + ay * ay) + p[M2] * (dx * ex + dy * ey)
            row[BOTH12] = p[M2] * (ex * rx + ey * ry)
            row[BOTH21] = p[M2] * (dx * sx + dy * sy)
            row[BOTH22] = p[I2] + p[M2] * (rx * sx + ry * sy)
    for c1, c2 in ((0, 1), (0, -1), (1, 0), (-1, 0)):
        row = table[3 * c1 + c2 + 4]
        n1, n2, w1, w2 = impact(p, c1, c2, c1 != 0, c2 != 0, 0.0, -1.0 * c1, 0.0, -1.0 * (c1 + c2))
        row[NEXT1], row[NEXT2], row[AFTER1], row[AFTER2] = n1, n2, w1, w2


@kernel
def least_hold(table, theta, omega, ground, g):
    """Least contact moment of the closed contact of pattern 3 or 4; negative if it would have to pull.

    ``theta`` and ``omega`` are those of what rocks, ``ground`` the acceleration of the ground.
    """
    s, c = sine_cosine(theta)
    v2x, v2y = table[V2X // LANES], table[V2Y // LANES]
    push = ground * (v2y * c - v2x * s) - g * (v2x * c + v2y * s)
    alpha = -push / table[M22 // LANES]
    least = math.inf
    for at in (HOLD, HOLD + CORNER):
        moment = (table[at] + table[at + 1] * s + table[at + 2] * c) * alpha
        moment += (table[at + 3] + table[at + 4] * s + table[at + 5] * c) * omega * omega
        moment += (table[at + 6] + table[at + 7] * s + table[at + 8] * c) * ground
        moment += table[at + 9] + table[at + 10] * s + table[at + 11] * c
        least = min(least, moment)
    return least


@kernel
def _couplings(table, cosine, sine):
    """M11, M12, M22, D of a contact state at cos Δ, sin Δ."""
    e, f = table[E // LANES], table[F // LANES]
    return (
        table[M11 // LANES],
        e * cosine + f * sine,
        table[M22 // LANES],
        f * cosine - e * sine,
    )


@kernel
def ground_impact(before, after, products, cosine, sine, omega1, omega2):
    """Velocities after the ground closes (thesis eq. 2.68-2.71): both momenta about the new poles."""
    _, old12, m22, _ = _couplings(before, cosine, sine)
    m11, m12, _, _ = _couplings(after, cosine, sine)
    q1 = products[GROUND] * omega1 + m12 * omega2
    q2 = old12 * omega1 + m22 * omega2
    share = 1.0 / (m11 * m22 - m12 * m12)
    return (m22 * q1 - m12 * q2) * share, (m11 * q2 - m12 * q1) * share


@kernel
def interface_impact(after, products, omega1, omega2):
    """Velocities after the interface closes, Δ = 0: momentum of the whole and of the statue."""
    m11, m12, m22 = after[M11 // LANES], after[E // LANES], after[M22 // LANES]
    q1 = products[BOTH11] * omega1 + products[BOTH12] * omega2
    q2 = products[BOTH21] * omega1 + products[BOTH22] * omega2
    share = 1.0 / (m11 * m22 - m12 * m12)
    return (m22 * q1 - m12 * q2) * share, (m11 * q2 - m12 * q1) * share


@kernel
def _opening(table, ground, c1, c2, trig, omega1, omega2, g):
    """Acceleration that opens a contact further: at zero ground acceleration, per unit of it; inertia.

    ``inertia`` is that of the opening alone, the momentum that its impacts conserve being given.
    """
    s1, k1, s2, k2 = trig
    sine, cosine = s2 * k1 - k2 * s1, k2 * k1 + s2 * s1
    m11, m12, m22, d = _couplings(table, cosine, sine)
    v1x, v1y = table[V1X // LANES], table[V1Y // LANES]
    v2x, v2y = table[V2X // LANES], table[V2Y // LANES]
    f1 = d * omega2 * omega2 - g * (v1x * k1 + v1y * s1)
    f2 = -d * omega1 * omega1 - g * (v2x * k2 + v2y * s2)
    a1 = v1y * k1 - v1x * s1
    a2 = v2y * k2 - v2x * s2
    determinant = m11 * m22 - m12 * m12
    if ground:
        still = c1 * (m12 * f2 - m22 * f1) / determinant
        pushed = c1 * (m12 * a2 - m22 * a1) / determinant
        return still, pushed, determinant / m22
    still = c2 * ((m12 + m22) * f1 - (m11 + m12) * f2) / determinant
    pushed = c2 * ((m12 + m22) * a1 - (m11 + m12) * a2) / determinant
    return still, pushed, determinant / (m11 + 2.0 * m12 + m22)


@kernel
def chatter_closes(
    before, after, ground, was1, was2, old, c1, c2, theta1, omega1, theta2, omega2, g, k, tau, dt, samples,
    last, factor,
):  # fmt: skip
    """Whether a contact that comes off may stay closed at once, while the other is open.

    All impacts of the contact conserve the momentum of what rocks on, so that its velocity at their end is the
    one of a contact that stays closed now, but for what the hops change meanwhile.  With restoring
    accelerations D and D' on the two poles, and e e' the share of the hops' energy that two impacts leave,
    hops of speed ω are over within T = 2 ω (1/D + e'/D') / (1 - e e').  The opening returns to zero after every
    hop, so what remains is of second order, ω² T in velocity.  T is taken half as long again, and nothing
    else may happen in twice that time.
    """
    speed = abs(omega1) if ground else abs(omega2 - omega1)
    if speed > FASTEST_CHATTER:
        return False
    s1, k1 = sine_cosine(theta1)
    s2, k2 = sine_cosine(theta2)
    trig = (s1, k1, s2, k2)
    here, per_here, inertia = _opening(after, ground, c1, c2, trig, omega1, omega2, g)
    there, per_there, old_inertia = _opening(before, ground, was1, was2, trig, omega1, omega2, g)
    e = speed / abs(old)
    loss = 1.0 - e * e * inertia / old_inertia
    if loss < 0.02:
        return False
    gap = abs(theta2 - theta1) if ground else abs(theta1)
    toward = max(0.0, -c2 * (omega2 - omega1)) if ground else max(0.0, -c1 * omega1)
    longest = min(CHATTER_ERROR / (speed * speed), 0.5 * gap / max(toward, 1e-300))
    least = math.inf
    other = math.inf
    for ahead in range(CHATTER_SAMPLES):
        a = factor * samples[k + ahead] if k + ahead <= last else 0.0
        least = min(least, -(here + per_here * a))
        other = min(other, -(there + per_there * a))
        if least <= 0.0 or other <= 0.0:
            return False
        time = 3.0 * speed * (1.0 / least + (1.0 - loss) / (e * other)) / loss
        if time > longest:
            return False
        if ahead > 0 and time <= (ahead - tau) * dt:
            return True
    return False


@kernel
def closed(table, ground, cosine, sine, omega1, omega2):
    """Velocities once the contact stays closed, with the momentum of (ω1, ω2) in this state."""
    m11, m12, m22, _ = _couplings(table, cosine, sine)
    if ground:
        return 0.0, omega2 + m12 * omega1 / m22
    both = ((m11 + m12) * omega1 + (m12 + m22) * omega2) / (m11 + 2.0 * m12 + m22)
    return both, both
