"""Impacts of a stack by the table of its body, with time counted in samples.

The general treatment is in ``_mechanics.impact`` and ``_events.strike``; here are the cases that make nearly
all impacts of an ensemble: one contact of two closes, momentum is conserved, and both come off; and a
landing of what rocks alone (pattern 3 or 4), whose outcome is the same for every speed but for its size.

``case`` is a case with its state at the event (``_stack_cases.CASE``), ``t`` holds the tables of bodies
(``_stack_table``), and ``before`` and ``after`` are rows of contact states in them.
"""

import math

from rockfrag.rocking._compile import inlined_kernel, kernel
from rockfrag.rocking._events import COARSE_DROP, FASTEST, chatter_dies
from rockfrag.rocking._mechanics import settle
from rockfrag.rocking._one_rotation import least_hold
from rockfrag.rocking._pendulum import sine_cosine
from rockfrag.rocking._stack_table import (
    AFTER1,
    AFTER2,
    BOTH11,
    BOTH12,
    BOTH21,
    BOTH22,
    GROUND,
    M11,
    M22,
    NEXT1,
    NEXT2,
    RESTORING_AT,
    SHARE,
    V1X,
    V1Y,
    V2X,
    V2Y,
    E,
    F,
    impacts_of,
    state,
)

CHATTER_ERROR = 1e-7
"""Largest ω² T [rad²/s] of a chatter that is closed at once; see ``chatter_closes``."""
FASTEST_CHATTER = 0.1
"""Speed [rad/s] above which no chatter is closed."""
CHATTER_TIME = 0.08
"""Time [s] over which the ground is looked at, at most, before a chatter is closed."""


@inlined_kernel
def _couplings(t, o, cosine, sine):
    """M11, M12, M22, D of a contact state at cos Δ, sin Δ."""
    e, f = t[o + E], t[o + F]
    m11, m22 = t[o + M11], t[o + M22]
    return m11, e * cosine + f * sine, m22, f * cosine - e * sine


@inlined_kernel
def _ground_impact(t, before, after, products, cosine, sine, omega1, omega2):
    """Velocities after the ground closes (thesis eq. 2.68-2.71): both momenta about the new poles."""
    _, old12, m22, _ = _couplings(t, before, cosine, sine)
    m11, m12, _, _ = _couplings(t, after, cosine, sine)
    q1 = t[products + GROUND] * omega1 + m12 * omega2
    q2 = old12 * omega1 + m22 * omega2
    share = 1.0 / (m11 * m22 - m12 * m12)
    return (m22 * q1 - m12 * q2) * share, (m11 * q2 - m12 * q1) * share


@inlined_kernel
def _interface_impact(t, after, products, omega1, omega2):
    """Velocities after the interface closes, Δ = 0: momentum of the whole and of the statue."""
    m11, m12, m22 = t[after + M11], t[after + E], t[after + M22]
    q1 = t[products + BOTH11] * omega1 + t[products + BOTH12] * omega2
    q2 = t[products + BOTH21] * omega1 + t[products + BOTH22] * omega2
    share = 1.0 / (m11 * m22 - m12 * m12)
    return (m22 * q1 - m12 * q2) * share, (m11 * q2 - m12 * q1) * share


@kernel
def _opening(t, o, ground, side, sine, cosine, omega1, omega2, g):
    """Acceleration that opens a contact further: at zero ground acceleration, per unit of it; inertia.

    The inertia is that of the opening alone, the momentum that its impacts conserve being given.
    """
    s1, k1, s2, k2 = sine, cosine, sine, cosine
    if ground:
        s1, k1 = 0.0, 1.0
    m11, m12, m22, d = _couplings(t, o, k2 * k1 + s2 * s1, s2 * k1 - k2 * s1)
    v1x, v1y = t[o + V1X], t[o + V1Y]
    v2x, v2y = t[o + V2X], t[o + V2Y]
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


@inlined_kernel
def _chatter_closes(
    case, t, before, after, ground, old, side, sine, cosine, omega1, omega2, longest, g, samples
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
    sine, cosine : of the statue's rotation
    longest : time that it may take at most [samples]
    """
    h, k, tau, last, factor = case.interval, case.k, case.tau, case.last, case.factor
    speed = abs(omega1) if ground else abs(omega2 - omega1)
    if speed > FASTEST_CHATTER * h:
        return False
    here, per_here, inertia = _opening(t, after, ground, side, sine, cosine, omega1, omega2, g)
    there, per_there, of_old = _opening(t, before, ground, -side, sine, cosine, omega1, omega2, g)
    e = speed / abs(old)
    left = e * e * inertia / of_old
    if left > 0.98:
        return False
    longest = min(longest, CHATTER_ERROR * h / (speed * speed))
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


@inlined_kernel
def _closed(t, o, ground, cosine, sine, omega1, omega2):
    """Velocities once the contact stays closed, with the momentum of (ω1, ω2) in this state."""
    m11, m12, m22, _ = _couplings(t, o, cosine, sine)
    if ground:
        return 0.0, omega2 + m12 * omega1 / m22
    both = ((m11 + m12) * omega1 + (m12 + m22) * omega2) / (m11 + 2.0 * m12 + m22)
    return both, both


@inlined_kernel
def land(case, p, t, g, closing_speed, samples):
    """Take what rocks alone through its landing; whether that was possible here."""
    products = impacts_of(case.table, case.c1, case.c2)
    n1 = int(t[products + NEXT1])
    n2 = int(t[products + NEXT2])
    omega = abs(case.rate2)
    v1, v2 = omega * t[products + AFTER1], omega * t[products + AFTER2]
    h = case.interval
    # a contact that comes off slower than this stays closed
    slow = closing_speed * h
    slow1 = n1 != 0 and abs(v1) < slow
    slow2 = n2 != 0 and abs(v2 - v1) < slow
    rests = (n1 == 0 or slow1) and (n2 == 0 or slow2)
    if (slow1 or slow2) and not rests:
        return False
    speed = max(abs(v1), abs(v2)) / h
    restoring = case.table + RESTORING_AT
    if not rests and speed < t[restoring + FASTEST]:
        rests = chatter_dies(
            speed, t[products + SHARE], 1.5, t, restoring, COARSE_DROP, case.k, case.tau, h, samples,
            case.last, case.factor,
        )  # fmt: skip
    if rests:
        n1, n2, v1, v2 = 0, 0, 0.0, 0.0
    if n1 == 0 and n2 == 0:
        settled = case.low < case.now < case.high
    elif n1 == 0 or n2 == 0:
        settled = least_hold(t, state(case.table, n1, n2), 0.0, v2, case.now, g) > 0.0
    else:
        settled = True
    if not settled:
        n1, n2 = settle(p, n1, n2, 0.0, v1 / h, 0.0, v2 / h, case.now)
    case.c1, case.c2, case.rate1, case.rate2 = n1, n2, v1, v2
    return True


@inlined_kernel
def meet(case, t, ground, g, closing_speed, samples):
    """Take two rocking blocks through the closing of one contact; whether that was possible here."""
    c1, c2, omega1, omega2 = case.c1, case.c2, case.rate1, case.rate2
    before = state(case.table, c1, c2)
    products = impacts_of(case.table, c1, c2)
    sine, cosine = sine_cosine(case.theta2)
    if ground:
        n1, n2 = -c1, c2
        after = state(case.table, n1, n2)
        v1, v2 = _ground_impact(t, before, after, products, cosine, sine, omega1, omega2)
        side, off, old = n1, v1, omega1
        gap, toward = abs(case.theta2), c2 * (v1 - v2)
    else:
        n1, n2 = c1, -c2
        after = state(case.table, n1, n2)
        v1, v2 = _interface_impact(t, after, products, omega1, omega2)
        side, off, old = n2, v2 - v1, omega2 - omega1
        gap, toward = abs(case.theta1), -c1 * v1
    if side * off <= closing_speed * case.interval:
        return False
    # half the time in which the other contact would close
    longest = 0.5 * gap / toward if toward > 0.0 else math.inf
    if _chatter_closes(
        case, t, before, after, ground, old, side, sine, cosine, v1, v2, longest, g, samples
    ):
        v1, v2 = _closed(t, after, ground, cosine, sine, v1, v2)
        if ground:
            n1 = 0
        else:
            n2 = 0
    case.c1, case.c2, case.rate1, case.rate2 = n1, n2, v1, v2
    return True
