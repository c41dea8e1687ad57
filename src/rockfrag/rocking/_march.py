"""Marching one body through one acceleration history, event by event.

Between events the rotations follow their series; an event is located on the series and handled before the
march goes on.  Every step size, root and decision depends on this one case alone.
"""

import math

from rockfrag.rocking._compile import entry_kernel, kernel
from rockfrag.rocking._events import (
    FINE_DROP,
    MAX_EVENTS_PER_STEP,
    let_go,
    next_event,
    restoring_table,
    strike,
)
from rockfrag.rocking._mechanics import settle
from rockfrag.rocking._pendulum import HALF_TURN
from rockfrag.rocking._series import slope, value
from rockfrag.rocking._step import RESTORING, TH1, TH2, series
from rockfrag.rocking._tally import (
    CLOSEST,
    FALL_TIME,
    FALLEN,
    OPENING,
    PEAK1,
    PEAK2,
    REST_TIME,
    SPEED1,
    SPEED2,
    WORK,
    keep_event,
    keep_sample,
    track,
    ways_to_balance,
    work,
)


@entry_kernel
def march(
    p, acceleration, dt, scale, substeps, free_samples, initial, closing_speed,
    history, events, q, summary,
):  # fmt: skip
    """March one body through ``scale × acceleration`` and, after it, free rocking.

    Parameters
    ----------
    p : BODY of the body
    acceleration : samples [m/s²]; zero after the last
    dt : sampling interval [s]
    substeps : steps per sample
    free_samples : samples that the march goes on after the last one at most
    initial : θ1, ω1, θ2, ω2 at the first sample
    closing_speed : separation speed after an impact [rad/s] below which a contact stays closed
    history : (samples, HISTORY), filled until the march ends
    events : (capacity, EVENT)
    q : (SCRATCH,) see ``scratch``
    summary : (SUMMARY,)

    Returns
    -------
    Number of samples done, the first included.
    """
    _begin(initial, summary)
    n = acceleration.size
    theta1, omega1, theta2, omega2 = initial[0], initial[1], initial[2], initial[3]
    c1, c2 = _first_contacts(theta1, omega1, theta2, omega2)
    c1, c2 = settle(p, c1, c2, theta1, omega1, theta2, omega2, acceleration[0] * scale)
    ways_to_balance(p, q)
    restoring_table(p, q, RESTORING)
    first = acceleration[0] * scale
    keep_sample(p, 0, c1, c2, theta1, omega1, theta2, omega2, first, history, summary)
    h = dt / substeps
    done = 1
    for k in range(n - 1 + free_samples):
        free = k >= n - 1
        left = acceleration[k] * scale if k < n else 0.0
        right = acceleration[k + 1] * scale if k + 1 < n else 0.0
        n_events = 0
        for sub in range(substeps):
            a0 = left + (right - left) * (sub / substeps)
            ramp = (right - left) / substeps
            tau = 0.0
            while tau < 1.0 and n_events <= MAX_EVENTS_PER_STEP + 20:
                remaining = 1.0 - tau
                now = a0 + ramp * tau
                hr = h * remaining
                rise = ramp * remaining
                series(p, c1, c2, theta1, omega1, theta2, omega2, hr, now, rise, q)
                when, fails, closes1, closes2 = next_event(p, c1, c2, q, hr, now, rise)
                at = min(1.0, when)
                theta1 = value(q, TH1, at) if c1 != 0 else 0.0
                omega1 = slope(q, TH1, at) / hr if c1 != 0 else 0.0
                theta2 = value(q, TH2, at) if c2 != 0 else theta1
                omega2 = slope(q, TH2, at) / hr if c2 != 0 else omega1
                if c1 != 0 or c2 != 0:
                    track(p, c1, c2, q, at, theta1, omega1, theta2, omega2, hr, summary)
                    summary[WORK] += work(p, c1, c2, q, at, hr, now, rise)
                tau += at * remaining
                if when > 1.0:
                    break
                n_events += 1
                now = a0 + ramp * tau
                was1, was2, old1, old2 = c1, c2, omega1, omega2
                if fails != 0:
                    kind = OPENING
                    c1, c2 = let_go(
                        p, fails, at == 0.0, c1, c2, theta1, omega1, theta2, omega2, now
                    )
                else:
                    if closes1:
                        theta1 = 0.0
                    if closes2 or c2 == 0:
                        theta2 = theta1
                    c1, c2, omega1, omega2, kind = strike(
                        p, c1, c2, closes1, closes2, theta1, omega1, theta2, omega2, now,
                        closing_speed, n_events > MAX_EVENTS_PER_STEP, FINE_DROP, q, RESTORING, k,
                        (sub + tau) / substeps, dt, acceleration, n - 1, scale, summary,
                    )  # fmt: skip
                keep_event(
                    p, (k + (sub + tau) / substeps) * dt, kind, was1, was2, old1, old2,
                    c1, c2, theta1, omega1, theta2, omega2, events, summary,
                )  # fmt: skip
        done = k + 2
        keep_sample(p, k + 1, c1, c2, theta1, omega1, theta2, omega2, right, history, summary)
        lying1 = abs(theta1) >= HALF_TURN
        lying2 = abs(theta2) >= HALF_TURN or abs(theta2 - theta1) >= HALF_TURN
        if lying1 or lying2:
            summary[FALLEN] = 1.0 if lying1 and not p.fixed else 2.0
            summary[FALL_TIME] = (done - 1) * dt
            break
        if free and c1 == 0 and c2 == 0:
            break
    return done


@kernel
def _begin(initial, summary):
    """Set the summary to that of a march that has not moved yet."""
    summary[:] = 0.0
    summary[FALL_TIME] = math.nan
    summary[REST_TIME] = 0.0
    summary[CLOSEST] = math.inf
    summary[PEAK1] = abs(initial[0])
    summary[SPEED1] = abs(initial[1])
    summary[PEAK2] = abs(initial[2])
    summary[SPEED2] = abs(initial[3])


@kernel
def _first_contacts(theta1, omega1, theta2, omega2):
    """Contacts at the start: those with an angle, or opening, are open."""
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
    return c1, c2
