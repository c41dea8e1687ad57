"""Finding and handling what ends a step: a contact closes, or a closed one can no longer hold."""

import math

from rockfrag.rocking._compile import kernel
from rockfrag.rocking._mechanics import (
    accelerations,
    equations,
    first_moment2,
    ground_hold,
    impact,
    inertia2,
    interface_hold,
    kinetic_energy,
    settle,
    stick,
)
from rockfrag.rocking._series import ORDER, closing_time, slope, value
from rockfrag.rocking._step import GAP, TH1, TH2
from rockfrag.rocking._tally import (
    CHATTER,
    CLOSING,
    CLOSURES,
    FORCED,
    GRAZINGS,
    IMPACTS,
)

GRAZING_SPEED = 1e-3
"""Relative speed [rad/s] below which a contact grazes."""
MAX_EVENTS_PER_STEP = 400
FINE_DROP, COARSE_DROP = 1e-9, 1e-2
"""Height of the flights [rad] below which impacts that are sure to end at rest are no longer followed, where
the history is kept and where only the verdict matters."""


@kernel
def rest_interval(p):
    """Ground accelerations [m/s²] between which the body at rest stays at rest.

    Every criterion of rest is linear in the acceleration (thesis eq. 2.21-2.25).
    """
    low = -math.inf
    high = math.inf
    for which in (1, 2):
        if which == 1 and p.fixed:
            continue
        for s in (1.0, -1.0):
            still, pushed = _rest_moment(p, which, s, 0.0), _rest_moment(p, which, s, 1.0)
            limit = still / (still - pushed)
            if still > pushed:
                high = min(high, limit)
            else:
                low = max(low, limit)
    return low, high


@kernel
def _rest_moment(p, which, s, a):
    """Contact moment s τ(s) of the ground (1) or the interface (2) at rest under acceleration a."""
    _, _, _, f1, f2 = equations(
        p, s if which == 1 else 1.0, s if which == 2 else 1.0, 0.0, 0.0, 0.0, 0.0, a
    )
    return s * (f1 + f2) if which == 1 else s * f2


@kernel
def hold_at(p, which, c1, c2, q, tau, h, a):
    """Least contact moment at τ: of the ground (which = 1) or the interface (2)."""
    t1 = value(q, TH1, tau)
    t2 = value(q, TH2, tau)
    w1 = slope(q, TH1, tau) / h
    w2 = slope(q, TH2, tau) / h
    alpha1, alpha2 = accelerations(p, c1, c2, t1, w1, t2, w2, a)
    if which == 1:
        least, _ = ground_hold(p, c2, t1, t2, w2, a, alpha2)
    else:
        least, _ = interface_hold(p, c1, t1, w1, t2, w2, a, alpha1)
    return least


@kernel
def between(low, at_low, high, at_high):
    """Next point of regula falsi, kept inside the bracket so that both its ends move."""
    tau = high - at_high * (high - low) / (at_high - at_low)
    return min(max(tau, low + 4e-14), high - 4e-14)


@kernel
def _failing_time(p, which, c1, c2, q, end, h, a0, ramp):
    """Find when a closed contact's criterion first fails in [0, end]; 2.0 if it holds."""
    at_start = hold_at(p, which, c1, c2, q, 0.0, h, a0)
    at_end = hold_at(p, which, c1, c2, q, end, h, a0 + ramp * end)
    high = end
    if at_end >= 0.0:
        # a parabola through the middle shows a dip between the ends
        middle = hold_at(p, which, c1, c2, q, 0.5 * end, h, a0 + 0.5 * ramp * end)
        curve = 2.0 * (at_start + at_end - 2.0 * middle)
        if curve <= 0.0:
            return 2.0
        vertex = -(4.0 * middle - 3.0 * at_start - at_end) / (2.0 * curve)
        if not 0.0 < vertex < 1.0:
            return 2.0
        high = vertex * end
        at_end = hold_at(p, which, c1, c2, q, high, h, a0 + ramp * high)
        if at_end >= 0.0:
            return 2.0
    low = 0.0
    if at_start < 0.0:
        return 0.0
    # regula falsi, Illinois; the bracket closes to 1e-13 from both sides
    moved = 0
    for _ in range(200):
        if high - low <= 1e-13:
            break
        tau = between(low, at_start, high, at_end)
        hold = hold_at(p, which, c1, c2, q, tau, h, a0 + ramp * tau)
        if hold >= 0.0:
            low = tau
            at_start = hold
            if moved == 1:
                at_end *= 0.5
            moved = 1
        else:
            high = tau
            at_end = hold
            if moved == -1:
                at_start *= 0.5
            moved = -1
    return high


@kernel
def ground_gap(c1, q):
    """Fill GAP with the series of the ground's opening angle; return its value at the end of the step."""
    end = 0.0
    for i in range(ORDER + 1):
        q[GAP + i] = c1 * q[TH1 + i]
        end += q[GAP + i]
    return end


@kernel
def interface_gap(c2, q):
    """Fill GAP with the series of the interface's opening angle, likewise."""
    end = 0.0
    for i in range(ORDER + 1):
        q[GAP + i] = c2 * (q[TH2 + i] - q[TH1 + i])
        end += q[GAP + i]
    return end


@kernel
def first_closing(c1, c2, q):
    """Time in a step at which a contact closes first, 2 if none does; whether ground and interface do."""
    when = 2.0
    closes1 = False
    closes2 = False
    if c1 != 0:
        ground_gap(c1, q)
        when = closing_time(q, GAP, 1.0)
        closes1 = when <= 1.0
    if c2 != 0:
        interface_gap(c2, q)
        time = closing_time(q, GAP, min(1.0, when))
        if time < when:
            closes1 = False
            closes2 = True
            when = time
        elif closes1 and value(q, GAP, when) < 1e-13:
            closes2 = True
    return when, closes1, closes2


@kernel
def next_event(p, c1, c2, q, h, a0, ramp):
    """Find the earliest event within the step of series ``q``.

    Returns
    -------
    Its time (2 if there is none by 1), which closed contact fails (1 ground, 2 interface, 0 none), and
    whether the ground and the interface close.
    """
    when, closes1, closes2 = first_closing(c1, c2, q)
    fails = 0
    for which in (1, 2):
        if (which == 1 and (c1 != 0 or p.fixed)) or (which == 2 and c2 != 0):
            continue
        time = _failing_time(p, which, c1, c2, q, min(1.0, when), h, a0, ramp)
        if time < when:
            when = time
            fails = which
    if fails != 0:
        return when, fails, False, False
    return when, 0, closes1, closes2


@kernel
def let_go(p, fails, stuck, c1, c2, theta1, omega1, theta2, omega2, a):
    """Contact state after a closed contact can no longer hold.

    ``stuck``: no time has passed since the last event, so a state that stays as it is would never end.
    """
    n1, n2 = settle(p, c1, c2, theta1, omega1, theta2, omega2, a)
    if stuck and n1 == c1 and n2 == c2:
        # rounding at a threshold: open the contact that fails
        alpha1, alpha2 = accelerations(p, c1, c2, theta1, omega1, theta2, omega2, a)
        if fails == 1:
            _, n1 = ground_hold(p, c2, theta1, theta2, omega2, a, alpha2)
        else:
            _, n2 = interface_hold(p, c1, theta1, omega1, theta2, omega2, a, alpha1)
    return n1, n2


@kernel
def strike(
    p, c1, c2, closes1, closes2, theta1, omega1, theta2, omega2, a, closing_speed, forced, drop, t, restoring,
    k, tau, dt, samples, last, scale, summary,
):  # fmt: skip
    """Contact state, velocities and kind of event after contacts close.

    A contact that comes off slower than ``closing_speed`` stays closed, one that has met too often
    within a step (``forced``) too, and impacts that are sure to end at rest are not followed.  ``t`` holds a
    ``restoring_table`` from place ``restoring``.
    """
    kind = CLOSING
    if (abs(omega1) if closes1 else abs(omega2 - omega1)) < GRAZING_SPEED:
        summary[GRAZINGS] += 1.0
    summary[IMPACTS] += 1.0
    n1, n2, w1, w2 = impact(p, c1, c2, closes1, closes2, theta1, omega1, theta2, omega2)
    limit = math.inf if forced else closing_speed
    slow1 = (closes1 or c1 == 0) and n1 != 0 and abs(w1) < limit
    slow2 = (closes2 or c2 == 0) and n2 != 0 and abs(w2 - w1) < limit
    if slow1 or slow2:
        n1 = 0 if slow1 else n1
        n2 = 0 if slow2 else n2
        w1, w2 = stick(p, c1, c2, n1, n2, theta1, omega1, theta2, omega2)
        summary[FORCED if forced else CLOSURES] += 1.0
        kind = CHATTER
    elif theta1 == 0.0 and theta2 == 0.0 and (n1 != 0 or n2 != 0):
        speed = max(abs(w1), abs(w2))
        if speed < t[restoring + FASTEST]:
            before = kinetic_energy(p, c1, c2, 0.0, omega1, 0.0, omega2)
            after = kinetic_energy(p, n1, n2, 0.0, w1, 0.0, w2)
            share = math.sqrt(after / before)
            # a pedestal that is thrown about lengthens the flights of the statue
            safety = 1.03 if p.fixed else 1.5
            if chatter_dies(
                speed, share, safety, t, restoring, drop, k, tau, dt, samples, last, scale
            ):
                n1, n2, w1, w2 = 0, 0, 0.0, 0.0
                summary[CLOSURES] += 1.0
                kind = CHATTER
    if not forced:
        n1, n2 = settle(p, n1, n2, theta1, w1, theta2, w2, a)
    return n1, n2, w1, w2, kind


# Places in a restoring table after the four pairs of accelerations.
FREQUENCY2, FASTEST = 8, 9


@kernel
def restoring_table(p, table, n):
    """Fill, from place ``n``, the numbers with which a chatter is closed at θ1 = θ2 = 0.

    Four angular accelerations that bring the body back to rest on the ways in which it can leave it, each
    a constant plus a factor times the ground acceleration; p²; and the speed above which no chatter is closed,
    0.2 D/p with the D of a still ground.
    """
    for i, (c1, c2) in enumerate(((0, 1), (0, -1), (1, 0), (-1, 0))):
        at = n + 2 * i
        if c1 != 0 and p.fixed:
            table[at], table[at + 1] = math.inf, 0.0
        else:
            still = _restoring(p, c1, c2, 0.0)
            table[at], table[at + 1] = still, _restoring(p, c1, c2, 1.0) - still
    vx, vy = first_moment2(p, 1.0)
    frequency2 = p.gravity * math.hypot(vx, vy) / inertia2(p, 1.0)
    table[n + FREQUENCY2] = frequency2
    table[n + FASTEST] = 0.2 * _least_restoring(table, n, 0.0) / math.sqrt(frequency2)


@kernel
def _restoring(p, c1, c2, a):
    """Angular acceleration that brings pattern 3 or 4 back, at rest on its way out."""
    alpha1, alpha2 = accelerations(p, c1, c2, 0.0, 0.0, 0.0, 0.0, a)
    return -c2 * alpha2 if c1 == 0 else -c1 * alpha1


@kernel
def _least_restoring(t, n, a):
    """Least restoring acceleration [rad/s²] over the ways in which the body can leave rest."""
    return min(
        min(t[n] + t[n + 1] * a, t[n + 2] + t[n + 3] * a),
        min(t[n + 4] + t[n + 5] * a, t[n + 6] + t[n + 7] * a),
    )


@kernel
def chatter_dies(
    speed, share, safety, t, restoring, drop, k, tau, dt, samples, last, scale
):  # fmt: skip
    """Whether the impacts that follow one at θ1 = θ2 = 0 are over before anything else can happen.

    With a restoring acceleration of at least D, flights at ``speed`` ω last at most 2 ω / D, and impacts leave
    the ``share`` e of the speed (√ of that of the kinetic energy), so together they last 2 ω / D / (1 - e),
    here times ``safety``.  If the ground stays below the thresholds of rest that long, the body is at rest
    afterwards, whatever the flights were like.  Flights of no more than D/p²/50 keep D within 2 %, and those of
    more than ``drop`` [rad] are followed.  ``t`` holds a ``restoring_table`` from place ``restoring``.
    """
    if share > 0.999:
        return False
    frequency2 = t[restoring + FREQUENCY2]
    least = math.inf
    for ahead in range(33):
        i = k + ahead
        a = samples[i] * scale if i <= last else 0.0
        least = min(least, _least_restoring(t, restoring, a))
        if least <= 0.0 or speed * speed * frequency2 > 0.04 * least * least:
            return False
        if speed * speed > 2.0 * drop * least:
            return False
        time = safety * 2.0 * speed / (least * (1.0 - share))
        if ahead > 0 and time <= (ahead - tau) * dt:
            return True
        if time > 32.0 * dt:
            return False
    return False
