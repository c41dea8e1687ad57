"""Marching one body through one acceleration history, event by event.

Between events the rotations follow their series; an event (a contact closes, a contact's force criterion
fails) is located on the series and handled before the march goes on.  Every step size, root and decision
depends on this one case alone.
"""

import math

import numpy as np

from rockfrag.rocking._compile import kernel
from rockfrag.rocking._glide import glide
from rockfrag.rocking._mechanics import (
    FIXED,
    GRAVITY,
    LINEAR,
    accelerations,
    coupling,
    equations,
    first_moment1,
    first_moment2,
    ground_hold,
    impact,
    inertia1,
    inertia2,
    interface_hold,
    kinetic_energy,
    potential_energy,
    settle,
    stick,
)
from rockfrag.rocking._series import ORDER, closing_time, slope, value
from rockfrag.rocking._step import CRITICAL, FREQUENCY2, GAP, SCRATCH, TH1, TH2, series

# Entries of the summary of a march.
(
    FALLEN,  # 0 none, 1 pedestal (or both as one), 2 statue or lone block
    FALL_TIME,  # [s], NaN if none
    PEAK1,  # max |θ1| [rad]
    PEAK2,
    SPEED1,  # max |θ1'| [rad/s]
    SPEED2,
    RATIO1,  # max θ/θcritical of the pedestal (with what stands on it)
    RATIO2,
    IMPACTS,
    GRAZINGS,  # contacts that closed or nearly closed without speed
    CLOSEST,  # least distance to an unstable equilibrium, in units of (θc, p θc)
    CLOSURES,  # chatters closed
    FORCED,  # contacts closed because a step had too many events
    WORK,  # work of the ground acceleration on the moving body [J]
    REST_TIME,  # time from which it rests for good [s], NaN if it does not
    N_EVENTS,
) = range(16)
SUMMARY = 16

# Columns of the history: state after each sample.
HISTORY = 9  # θ1, ω1, θ2, ω2, c1, c2, θ1'', θ2'', work so far
# Columns of the events.
EVENT = 14  # time, kind, c1, c2, n1, n2, ω1⁻, ω2⁻, ω1⁺, ω2⁺, θ1, θ2, kinetic energy before, after
OPENING, CLOSING, CHATTER = 0.0, 1.0, 2.0

HALF_TURN = 0.5 * math.pi
GRAZING_SPEED = 1e-3
"""Relative speed [rad/s] below which a contact grazes."""
MAX_EVENTS_PER_STEP = 400
FINE_DROP, COARSE_DROP = 1e-9, 1e-2
"""Height of the flights [rad] below which impacts that are sure to end at rest are no longer followed, where
the history is kept and where only the verdict matters."""


@kernel
def _balance(p, c1, c2):
    """Critical angle and frequency of the pedestal with what stands on it, on pole c1."""
    s2 = c2 if c2 != 0 else 1
    if c2 == 0:
        v1x, v1y = first_moment1(p, c1, s2)
        v2x, v2y = first_moment2(p, s2)
        e, _ = coupling(p, c1, s2)
        vx, vy = v1x + v2x, v1y + v2y
        inertia = inertia1(p, c1, s2) + 2.0 * e + inertia2(p, s2)
    else:
        vx, vy = first_moment1(p, c1, s2)
        inertia = inertia1(p, c1, s2)
    return math.atan2(-c1 * vx, vy), vx, vy, inertia


@kernel
def barrier(p):
    """Least energy [J] that could overturn the body at rest without help from the ground."""
    least = math.inf
    for s2 in (1, -1):
        vx, vy = first_moment2(p, s2)
        least = min(least, math.hypot(vx, vy) - vy)
        if p[FIXED] == 0.0:
            for s1 in (1, -1):
                vx, vy = first_moment1(p, s1, s2)
                least = min(least, math.hypot(vx, vy) - vy)
                wx, wy = first_moment2(p, s2)
                vx, vy = vx + wx, vy + wy
                least = min(least, math.hypot(vx, vy) - vy)
    return least * p[GRAVITY]


@kernel
def rest_interval(p):
    """Ground accelerations [m/s²] between which the body at rest stays at rest.

    Every criterion of rest is linear in the acceleration (thesis eq. 2.21-2.25).
    """
    low = -math.inf
    high = math.inf
    for which in (1, 2):
        if which == 1 and p[FIXED] > 0.0:
            continue
        for s in (1, -1):
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
    _, _, _, f1, f2 = equations(p, s if which == 1 else 1, s if which == 2 else 1, 0, 0, 0, 0, a)
    return s * (f1 + f2) if which == 1 else s * f2


@kernel
def _hold(p, which, c1, c2, q, tau, h, a):
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
def _failing_time(p, which, c1, c2, q, end, h, a0, ramp):
    """Find when a closed contact's criterion first fails in [0, end]; 2.0 if it holds."""
    at_start = _hold(p, which, c1, c2, q, 0.0, h, a0)
    at_end = _hold(p, which, c1, c2, q, end, h, a0 + ramp * end)
    high = end
    if at_end >= 0.0:
        # a parabola through the middle shows a dip between the ends
        middle = _hold(p, which, c1, c2, q, 0.5 * end, h, a0 + 0.5 * ramp * end)
        curve = 2.0 * (at_start + at_end - 2.0 * middle)
        if curve <= 0.0:
            return 2.0
        vertex = -(4.0 * middle - 3.0 * at_start - at_end) / (2.0 * curve)
        if not 0.0 < vertex < 1.0:
            return 2.0
        high = vertex * end
        if _hold(p, which, c1, c2, q, high, h, a0 + ramp * high) >= 0.0:
            return 2.0
    low = 0.0
    if at_start < 0.0:
        return 0.0
    while high - low > 1e-13:
        tau = 0.5 * (low + high)
        if _hold(p, which, c1, c2, q, tau, h, a0 + ramp * tau) >= 0.0:
            low = tau
        else:
            high = tau
    return high


@kernel
def _restoring(p, c1, c2, a):
    """Angular acceleration that brings pattern 3 or 4 back, at rest on its way out."""
    alpha1, alpha2 = accelerations(p, c1, c2, 0.0, 0.0, 0.0, 0.0, a)
    return -c2 * alpha2 if c1 == 0 else -c1 * alpha1


@kernel
def _least_restoring(p, a):
    """Least restoring acceleration [rad/s²] over the ways in which the body can leave rest."""
    least = min(_restoring(p, 0, 1, a), _restoring(p, 0, -1, a))
    if p[FIXED] == 0.0:
        least = min(least, _restoring(p, 1, 0, a), _restoring(p, -1, 0, a))
    return least


@kernel
def _chatter_dies(
    p, was1, was2, old1, old2, c1, c2, omega1, omega2, drop, k, tau, dt, acceleration, scale
):  # fmt: skip
    """Whether the impacts that follow one at θ1 = θ2 = 0 are over before anything else can happen.

    With a restoring acceleration of at least D, flights at speed ω last at most 2 ω / D, and impacts leave
    the share e of the speed (√ of that of the kinetic energy), so together they last 2 ω / D / (1 - e).  If
    the ground stays below the thresholds of rest that long, the body is at rest afterwards, whatever
    the flights were like.  Flights of no more than D/p²/50 keep D within 2 %, and those of more than
    ``drop`` [rad] are followed.
    """
    speed = max(abs(omega1), abs(omega2))
    before = kinetic_energy(p, was1, was2, 0.0, old1, 0.0, old2)
    after = kinetic_energy(p, c1, c2, 0.0, omega1, 0.0, omega2)
    e = math.sqrt(after / before)
    if e > 0.999:
        return False
    vx, vy = first_moment2(p, 1)
    frequency2 = p[GRAVITY] * math.hypot(vx, vy) / inertia2(p, 1)
    # a pedestal that is thrown about lengthens the flights of the statue
    safety = 1.03 if p[FIXED] > 0.0 else 1.5
    least = math.inf
    n = acceleration.size
    for ahead in range(33):
        i = k + ahead
        a = acceleration[i] * scale if i < n else 0.0
        least = min(least, _least_restoring(p, a))
        if least <= 0.0 or speed * speed * frequency2 > 0.04 * least * least:
            return False
        if speed * speed > 2.0 * drop * least:
            return False
        time = safety * 2.0 * speed / (least * (1.0 - e))
        if ahead > 0 and time <= (ahead - tau) * dt:
            return True
        if time > 32.0 * dt:
            return False
    return False


@kernel
def march(
    p, acceleration, dt, scale, substeps, free_samples, initial, closing_speed,
    history, events, q, summary,
):  # fmt: skip
    """March one body through ``scale × acceleration`` and, after it, free rocking.

    Parameters
    ----------
    p : parameter array of the body
    acceleration : samples [m/s²]; zero after the last
    dt : sampling interval [s]
    substeps : steps per sample
    free_samples : samples that the march goes on after the last one at most
    initial : θ1, ω1, θ2, ω2 at the first sample
    closing_speed : separation speed after an impact [rad/s] below which a contact stays closed
    history : (samples, HISTORY) or (0, HISTORY) to keep none; filled until the march ends
    events : (capacity, EVENT)
    q : (SCRATCH,) see ``scratch``
    summary : (SUMMARY,)

    Returns
    -------
    Number of samples done, the first included.
    """
    summary[:] = 0.0
    summary[FALL_TIME] = math.nan
    summary[REST_TIME] = 0.0
    summary[CLOSEST] = math.inf
    keep = history.shape[0] > 0
    n = acceleration.size
    theta1, omega1, theta2, omega2 = initial[0], initial[1], initial[2], initial[3]
    # the initial contacts: those with an angle are open
    c1 = 0
    c2 = 0
    if theta1 != 0.0:
        c1 = 1 if theta1 > 0.0 else -1
    elif omega1 != 0.0:
        c1 = 1 if omega1 > 0.0 else -1
    if theta2 != theta1:
        c2 = 1 if theta2 > theta1 else -1
    elif omega2 != omega1:
        c2 = 1 if omega2 > omega1 else -1
    c1, c2 = settle(p, c1, c2, theta1, omega1, theta2, omega2, acceleration[0] * scale)
    _ways_to_balance(p, q)
    least_energy = barrier(p)
    rest_low, rest_high = rest_interval(p)
    # no chatter is closed above this speed: 0.2 D/p with the D of a still ground
    vx, vy = first_moment2(p, 1)
    fast = 0.2 * _least_restoring(p, 0.0)
    fast /= math.sqrt(p[GRAVITY] * math.hypot(vx, vy) / inertia2(p, 1))

    if keep:
        alpha1, alpha2 = accelerations(
            p, c1, c2, theta1, omega1, theta2, omega2, acceleration[0] * scale
        )
        row = history[0]
        row[0], row[1], row[2], row[3] = theta1, omega1, theta2, omega2
        row[4], row[5], row[6], row[7] = c1, c2, alpha1, alpha2
    summary[PEAK1] = abs(theta1)
    summary[PEAK2] = abs(theta2)
    summary[SPEED1] = abs(omega1)
    summary[SPEED2] = abs(omega2)

    h = dt / substeps
    done = 1
    gliding = not keep and p[LINEAR] == 0.0
    extremes = np.zeros(3)
    k = -1
    while k + 1 < n - 1 + free_samples:
        k += 1
        if gliding and c1 == 0 and c2 != 0 and k < n - 1:
            k, theta2, omega2 = glide(
                p, c2, theta2, omega2, k, n - 1, substeps, dt, acceleration, scale, extremes
            )
            summary[RATIO2] = max(summary[RATIO2], extremes[0])
            summary[SPEED2] = max(summary[SPEED2], extremes[1])
            summary[CLOSEST] = min(summary[CLOSEST], math.sqrt(extremes[2]))
        free = k >= n - 1
        if free and not keep:
            # nothing drives it any more and energy cannot grow
            energy = kinetic_energy(p, c1, c2, theta1, omega1, theta2, omega2)
            energy += potential_energy(p, c1, c2, theta1, theta2)
            if energy < least_energy:
                upright = abs(theta1) < HALF_TURN and abs(theta2) < HALF_TURN
                if upright and _inside(p, c1, c2, theta1, theta2):
                    break
        left = acceleration[k] * scale if k < n else 0.0
        right = acceleration[k + 1] * scale if k + 1 < n else 0.0
        at_rest = c1 == 0 and c2 == 0 and not keep and k + 1 < n
        if at_rest and rest_low < left < rest_high and rest_low < right < rest_high:
            continue
        n_events = 0
        for sub in range(substeps):
            a0 = left + (right - left) * (sub / substeps)
            ramp = (right - left) / substeps
            tau = 0.0
            while tau < 1.0:
                remaining = 1.0 - tau
                now = a0 + ramp * tau
                series(
                    p, c1, c2, theta1, omega1, theta2, omega2,
                    h * remaining, now, ramp * remaining, q,
                )  # fmt: skip
                hr = h * remaining
                # the earliest event on (0, 1] of the rest of this step
                when = 2.0
                fails = 0
                closes1 = False
                closes2 = False
                if c1 != 0:
                    for i in range(ORDER + 1):
                        q[GAP + i] = c1 * q[TH1 + i]
                    when = closing_time(q, GAP, 1.0)
                    closes1 = when <= 1.0
                if c2 != 0:
                    for i in range(ORDER + 1):
                        q[GAP + i] = c2 * (q[TH2 + i] - q[TH1 + i])
                    time = closing_time(q, GAP, min(1.0, when))
                    if time < when:
                        closes1 = False
                        closes2 = True
                        when = time
                    elif closes1 and value(q, GAP, when) < 1e-13:
                        closes2 = True
                end = min(1.0, when)
                if c1 == 0 and p[FIXED] == 0.0:
                    time = _failing_time(p, 1, c1, c2, q, end, hr, now, ramp * remaining)
                    if time < when:
                        when = time
                        fails = 1
                        closes1 = False
                        closes2 = False
                        end = min(end, time)
                if c2 == 0:
                    time = _failing_time(p, 2, c1, c2, q, end, hr, now, ramp * remaining)
                    if time < when:
                        when = time
                        fails = 2
                        closes1 = False
                        closes2 = False
                at = min(1.0, when)
                moving = c1 != 0 or c2 != 0
                if keep and moving:
                    summary[WORK] += _work(p, c1, c2, q, at, hr, now, ramp * remaining)
                t1 = value(q, TH1, at)
                t2 = value(q, TH2, at)
                w1 = slope(q, TH1, at) / hr
                w2 = slope(q, TH2, at) / hr
                if moving:
                    _track(p, c1, c2, q, at, t1, w1, t2, w2, hr, summary)
                theta1, omega1, theta2, omega2 = t1, w1, t2, w2
                if c1 == 0:
                    theta1 = 0.0
                    omega1 = 0.0
                if c2 == 0:
                    theta2 = theta1
                    omega2 = omega1
                tau += at * remaining
                if when > 1.0:
                    break
                n_events += 1
                clock = (k + (sub + tau) / substeps) * dt
                now = a0 + ramp * tau
                was1, was2, old1, old2 = c1, c2, omega1, omega2
                energy = 0.0
                if keep:
                    energy = kinetic_energy(p, c1, c2, theta1, omega1, theta2, omega2)
                if fails != 0:
                    c1, c2 = settle(p, c1, c2, theta1, omega1, theta2, omega2, now)
                    if was1 == c1 and was2 == c2 and at == 0.0:
                        # rounding at a threshold: let it pass to the next instant
                        if fails == 1:
                            _, corner = ground_hold(p, c2, theta1, theta2, omega2, now, 0.0)
                            c1 = corner
                        else:
                            _, corner = interface_hold(
                                p, c1, theta1, omega1, theta2, omega2, now, 0.0
                            )
                            c2 = corner
                    kind = OPENING
                else:
                    kind = CLOSING
                    if closes1:
                        theta1 = 0.0
                    if closes2:
                        theta2 = theta1
                    if closes1 and c2 == 0:
                        theta2 = theta1
                    speed = abs(omega1) if closes1 else abs(omega2 - omega1)
                    if speed < GRAZING_SPEED:
                        summary[GRAZINGS] += 1.0
                    summary[IMPACTS] += 1.0
                    c1, c2, omega1, omega2 = impact(
                        p, c1, c2, closes1, closes2, theta1, omega1, theta2, omega2
                    )
                    # too slow to matter, or too many: the contact stays closed
                    forced = n_events > MAX_EVENTS_PER_STEP
                    limit = math.inf if forced else closing_speed
                    slow1 = closes1 and c1 != 0 and abs(omega1) < limit
                    slow2 = closes2 and c2 != 0 and abs(omega2 - omega1) < limit
                    if slow1 or slow2:
                        c1 = 0 if slow1 else c1
                        c2 = 0 if slow2 else c2
                        omega1, omega2 = stick(p, was1, was2, c1, c2, theta1, old1, theta2, old2)
                        summary[FORCED if forced else CLOSURES] += 1.0
                        kind = CHATTER
                    elif theta1 == 0.0 and theta2 == 0.0 and (c1 != 0 or c2 != 0):
                        speed = max(abs(omega1), abs(omega2))
                        drop = FINE_DROP if keep else COARSE_DROP
                        if speed < fast and _chatter_dies(
                            p, was1, was2, old1, old2, c1, c2, omega1, omega2, drop, k,
                            (sub + tau) / substeps, dt, acceleration, scale,
                        ):  # fmt: skip
                            c1 = 0
                            c2 = 0
                            omega1 = 0.0
                            omega2 = 0.0
                            summary[CLOSURES] += 1.0
                            kind = CHATTER
                    if not forced:
                        c1, c2 = settle(p, c1, c2, theta1, omega1, theta2, omega2, now)
                count = int(summary[N_EVENTS])
                if count < events.shape[0]:
                    row = events[count]
                    row[0], row[1] = clock, kind
                    row[2], row[3], row[4], row[5] = was1, was2, c1, c2
                    row[6], row[7], row[8], row[9] = old1, old2, omega1, omega2
                    row[10], row[11] = theta1, theta2
                    row[12] = energy
                    if keep:
                        row[13] = kinetic_energy(p, c1, c2, theta1, omega1, theta2, omega2)
                summary[N_EVENTS] = count + 1.0
                if c1 == 0 and c2 == 0:
                    summary[REST_TIME] = clock
                else:
                    summary[REST_TIME] = math.nan
                if n_events > MAX_EVENTS_PER_STEP + 20:
                    break
        done = k + 2
        if keep:
            alpha1, alpha2 = accelerations(p, c1, c2, theta1, omega1, theta2, omega2, right)
            row = history[done - 1]
            row[0], row[1], row[2], row[3] = theta1, omega1, theta2, omega2
            row[4], row[5], row[6], row[7] = c1, c2, alpha1, alpha2
            row[8] = summary[WORK]
        lying1 = abs(theta1) >= HALF_TURN
        lying2 = abs(theta2) >= HALF_TURN or abs(theta2 - theta1) >= HALF_TURN
        if lying1 or lying2:
            summary[FALLEN] = 1.0 if lying1 and p[FIXED] == 0.0 else 2.0
            summary[FALL_TIME] = (done - 1) * dt
            break
        if free and c1 == 0 and c2 == 0:
            break
    return done


@kernel
def _inside(p, c1, c2, theta1, theta2):
    """Whether no block is beyond the angle at which it balances."""
    if c2 != 0:
        vx, vy = first_moment2(p, c2)
        if c2 * theta2 >= math.atan2(-c2 * vx, vy):
            return False
    if c1 != 0:
        critical, _, _, _ = _balance(p, c1, c2)
        if c1 * theta1 >= critical:
            return False
    return True


@kernel
def _track(p, c1, c2, q, at, t1, w1, t2, w2, h, summary):
    """Update peaks and the closest approach to an unstable equilibrium after a step."""
    summary[PEAK1] = max(summary[PEAK1], abs(t1))
    summary[PEAK2] = max(summary[PEAK2], abs(t2))
    summary[SPEED1] = max(summary[SPEED1], abs(w1))
    summary[SPEED2] = max(summary[SPEED2], abs(w2))
    # a peak between samples: the rate changes sign
    if q[TH2 + 1] * w2 < 0.0:
        tau = q[TH2 + 1] / (q[TH2 + 1] - w2 * h) * at
        summary[PEAK2] = max(summary[PEAK2], abs(value(q, TH2, tau)))
    if q[TH1 + 1] * w1 < 0.0:
        tau = q[TH1 + 1] / (q[TH1 + 1] - w1 * h) * at
        summary[PEAK1] = max(summary[PEAK1], abs(value(q, TH1, tau)))
    if c2 != 0:
        column = 6 if c2 > 0 else 7
        critical = q[CRITICAL + column]
        away = 1.0 - c2 * t2 / critical
        speed = w2 / critical
        square = away * away + speed * speed / q[FREQUENCY2 + column]
        if square < summary[CLOSEST] * summary[CLOSEST]:
            summary[CLOSEST] = math.sqrt(square)
        summary[RATIO2] = max(summary[RATIO2], c2 * t2 / critical)
    if c1 != 0:
        column = 1 + c2 + (0 if c1 > 0 else 3)
        critical = q[CRITICAL + column]
        away = 1.0 - c1 * t1 / critical
        speed = w1 / critical
        square = away * away + speed * speed / q[FREQUENCY2 + column]
        if square < summary[CLOSEST] * summary[CLOSEST]:
            summary[CLOSEST] = math.sqrt(square)
        summary[RATIO1] = max(summary[RATIO1], c1 * t1 / critical)


@kernel
def _ways_to_balance(p, q):
    """Fill CRITICAL and FREQUENCY2: the pedestal's in columns 0 to 5, the statue's in 6 and 7."""
    for c1 in (1, -1):
        for c2 in (-1, 0, 1):
            critical, vx, vy, inertia = _balance(p, c1, c2)
            column = 1 + c2 + (0 if c1 > 0 else 3)
            q[CRITICAL + column] = critical
            q[FREQUENCY2 + column] = p[GRAVITY] * math.hypot(vx, vy) / inertia
    for c2 in (1, -1):
        vx, vy = first_moment2(p, c2)
        column = 6 if c2 > 0 else 7
        q[CRITICAL + column] = math.atan2(-c2 * vx, vy)
        q[FREQUENCY2 + column] = p[GRAVITY] * math.hypot(vx, vy) / inertia2(p, c2)


@kernel
def _work(p, c1, c2, q, end, h, a0, ramp):
    """Work of the ground acceleration, -∫ a (m1 x1' + m2 x2') dt, over (0, end] of a step [J]."""
    s1 = c1 if c1 != 0 else 1
    s2 = c2 if c2 != 0 else 1
    v1x, v1y = first_moment1(p, s1, s2)
    v2x, v2y = first_moment2(p, s2)
    # Gauss-Legendre, six points: exact to order 11
    nodes = (0.2386191860831969, 0.6612093864662645, 0.9324695142031521)
    weights = (0.4679139345726910, 0.3607615730481386, 0.1713244923791704)
    total = 0.0
    for i in range(3):
        for sign in (-1.0, 1.0):
            tau = 0.5 * end * (1.0 + sign * nodes[i])
            t1 = value(q, TH1, tau)
            t2 = value(q, TH2, tau)
            w1 = slope(q, TH1, tau)
            w2 = slope(q, TH2, tau)
            if p[LINEAR] > 0.0:
                rate = v1y * w1 + v2y * w2
            else:
                rate = w1 * (v1y * math.cos(t1) - v1x * math.sin(t1))
                rate += w2 * (v2y * math.cos(t2) - v2x * math.sin(t2))
            total -= weights[i] * (a0 + ramp * tau) * rate
    return 0.5 * end * total


@kernel
def scratch():
    """Scratch array of a march."""
    return np.zeros(SCRATCH)
