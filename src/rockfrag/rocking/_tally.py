"""What a march keeps of a response: its summary, and on request its history and its events."""

import math

import numpy as np

from rockfrag.rocking._compile import entry_kernel, kernel
from rockfrag.rocking._mechanics import (
    accelerations,
    coupling,
    first_moment1,
    first_moment2,
    inertia1,
    inertia2,
    kinetic_energy,
    pole,
    potential_energy,
)
from rockfrag.rocking._series import slope, value
from rockfrag.rocking._step import CRITICAL, FREQUENCY2, SCRATCH, TH1, TH2

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


@kernel
def balance(p, c1, c2):
    """Critical angle and frequency of the pedestal with what stands on it, on pole c1."""
    s1, s2 = pole(c1), pole(c2)
    if c2 == 0:
        v1x, v1y = first_moment1(p, s1, s2)
        v2x, v2y = first_moment2(p, s2)
        e, _ = coupling(p, s1, s2)
        vx, vy = v1x + v2x, v1y + v2y
        inertia = inertia1(p, s1, s2) + 2.0 * e + inertia2(p, s2)
    else:
        vx, vy = first_moment1(p, s1, s2)
        inertia = inertia1(p, s1, s2)
    return math.atan2(-c1 * vx, vy), vx, vy, inertia


@kernel
def barrier(p):
    """Least energy [J] that could overturn the body at rest without help from the ground."""
    least = math.inf
    for s2 in (1.0, -1.0):
        vx, vy = first_moment2(p, s2)
        least = min(least, math.hypot(vx, vy) - vy)
        if not p.fixed:
            for s1 in (1.0, -1.0):
                vx, vy = first_moment1(p, s1, s2)
                least = min(least, math.hypot(vx, vy) - vy)
                wx, wy = first_moment2(p, s2)
                vx, vy = vx + wx, vy + wy
                least = min(least, math.hypot(vx, vy) - vy)
    return least * p.gravity


@kernel
def ways_to_balance(p, q):
    """Fill CRITICAL and FREQUENCY2: the pedestal's in columns 0 to 5, the statue's in 6 and 7."""
    for c1 in (1, -1):
        for c2 in (-1, 0, 1):
            critical, vx, vy, inertia = balance(p, c1, c2)
            column = 1 + c2 + (0 if c1 > 0 else 3)
            q[CRITICAL + column] = critical
            q[FREQUENCY2 + column] = p.gravity * math.hypot(vx, vy) / inertia
    for c2 in (1, -1):
        vx, vy = first_moment2(p, pole(c2))
        column = 6 if c2 > 0 else 7
        q[CRITICAL + column] = math.atan2(-c2 * vx, vy)
        q[FREQUENCY2 + column] = p.gravity * math.hypot(vx, vy) / inertia2(p, pole(c2))


@kernel
def _approach(q, column, side, theta, omega, ratio, summary):
    """Update the largest θ/θcritical and the closest approach to one way to balance."""
    critical = q[CRITICAL + column]
    away = 1.0 - side * theta / critical
    speed = omega / critical
    square = away * away + speed * speed / q[FREQUENCY2 + column]
    if square < summary[CLOSEST] * summary[CLOSEST]:
        summary[CLOSEST] = math.sqrt(square)
    summary[ratio] = max(summary[ratio], side * theta / critical)


@kernel
def _peak(q, row, end, theta, rate_at_end, h, peak, speed, summary):
    """Update the largest |θ|, between samples too, and the largest |θ'|."""
    summary[peak] = max(summary[peak], abs(theta))
    summary[speed] = max(summary[speed], abs(rate_at_end))
    if q[row + 1] * rate_at_end < 0.0:
        # the rate changes sign within the step
        tau = q[row + 1] / (q[row + 1] - rate_at_end * h) * end
        summary[peak] = max(summary[peak], abs(value(q, row, tau)))


@kernel
def track(p, c1, c2, q, end, theta1, omega1, theta2, omega2, h, summary):
    """Update peaks and the closest approach to an unstable equilibrium after a step of series ``q``."""
    _peak(q, TH1, end, theta1, omega1, h, PEAK1, SPEED1, summary)
    _peak(q, TH2, end, theta2, omega2, h, PEAK2, SPEED2, summary)
    if c2 != 0:
        _approach(q, 6 if c2 > 0 else 7, c2, theta2, omega2, RATIO2, summary)
    if c1 != 0:
        _approach(q, 1 + c2 + (0 if c1 > 0 else 3), c1, theta1, omega1, RATIO1, summary)


@kernel
def work(p, c1, c2, q, end, h, a0, ramp):
    """Work of the ground acceleration, -∫ a (m1 x1' + m2 x2') dt, over (0, end] of a step [J]."""
    s1, s2 = pole(c1), pole(c2)
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
            if p.linear > 0:
                rate = v1y * w1 + v2y * w2
            else:
                rate = w1 * (v1y * math.cos(t1) - v1x * math.sin(t1))
                rate += w2 * (v2y * math.cos(t2) - v2x * math.sin(t2))
            total -= weights[i] * (a0 + ramp * tau) * rate
    return 0.5 * end * total


@kernel
def keep_sample(p, k, c1, c2, theta1, omega1, theta2, omega2, a, history, summary):
    """Write the state at sample ``k`` into the history."""
    alpha1, alpha2 = accelerations(p, c1, c2, theta1, omega1, theta2, omega2, a)
    row = history[k]
    row[0], row[1], row[2], row[3] = theta1, omega1, theta2, omega2
    row[4], row[5], row[6], row[7] = c1, c2, alpha1, alpha2
    row[8] = summary[WORK]


@kernel
def keep_event(
    p, clock, kind, was1, was2, old1, old2, c1, c2, theta1, omega1, theta2, omega2, events, summary
):  # fmt: skip
    """Write an event, if there is room, and count it."""
    count = int(summary[N_EVENTS])
    if count < events.shape[0]:
        row = events[count]
        row[0], row[1] = clock, kind
        row[2], row[3], row[4], row[5] = was1, was2, c1, c2
        row[6], row[7], row[8], row[9] = old1, old2, omega1, omega2
        row[10], row[11] = theta1, theta2
        row[12] = kinetic_energy(p, was1, was2, theta1, old1, theta2, old2)
        row[13] = kinetic_energy(p, c1, c2, theta1, omega1, theta2, omega2)
    summary[N_EVENTS] = count + 1.0
    summary[REST_TIME] = clock if c1 == 0 and c2 == 0 else math.nan


@entry_kernel
def fill_energies(p, history, kinetic, potential):
    """Fill the kinetic and potential energy [J] of each row of a history."""
    for i in range(history.shape[0]):
        row = history[i]
        c1, c2 = int(row[4]), int(row[5])
        kinetic[i] = kinetic_energy(p, c1, c2, row[0], row[1], row[2], row[3])
        potential[i] = potential_energy(p, c1, c2, row[0], row[2])


def scratch():
    """Scratch array of a march."""
    return np.zeros(SCRATCH)
