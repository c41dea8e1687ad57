"""One step of Dormand and Prince's pair of order 5 (1980), and what must not become negative in it."""

import math

import numpy as np
from numba import njit

from rockfrag.engines.spatial._algebra import normalise, rotation
from rockfrag.engines.spatial._body import (
    SIZE,
    arm,
    first_candidate,
    gap,
    last_candidate,
    point_velocity,
)
from rockfrag.engines.spatial._forces import SLIDES, STAGES, rates
from rockfrag.engines.spatial._modes import (
    AT_REST,
    LANDS,
    LEAVES_CONE,
    NOTHING,
    OPENS,
    SLIP_ENDS,
    TOUCH,
)

NODES = np.array([0.0, 0.2, 0.3, 0.8, 8 / 9, 1.0, 1.0])
WEIGHTS = np.array(
    [
        [0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [0.2, 0.0, 0.0, 0.0, 0.0, 0.0],
        [3 / 40, 9 / 40, 0.0, 0.0, 0.0, 0.0],
        [44 / 45, -56 / 15, 32 / 9, 0.0, 0.0, 0.0],
        [19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729, 0.0, 0.0],
        [9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656, 0.0],
        [35 / 384, 0.0, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84],
    ]
)
ERROR = np.array(
    [71 / 57600, 0.0, -71 / 16695, 71 / 1920, -17253 / 339200, 22 / 525, -1 / 40],
)

LEAST_FORCE = 1e-9
"""Force a contact may pull, or shear beyond its cone, before that is seen, over the weight [-]."""


@njit(cache=True)
def attempt(body, tau, h, y, s):
    """Take a step from y to s.new; s.slopes[0] holds the rates at its beginning.  Return the error's estimate.

    Afterwards s.slopes[6] and s.lam are the rates and forces at the end.
    """
    slopes, new = s.slopes, s.new
    for stage in range(1, STAGES):
        for i in range(SIZE):
            total = 0.0
            for j in range(stage):
                total += WEIGHTS[stage, j] * slopes[j, i]
            new[i] = y[i] + h * total
        if stage == STAGES - 1:
            normalise(new)
        rates(body, tau + NODES[stage] * h, new, slopes[stage], s)
    worst = 0.0
    for i in range(13):
        total = 0.0
        for stage in range(STAGES):
            total += ERROR[stage] * slopes[stage, i]
        worst = max(worst, abs(h * total) / (1.0 + abs(y[i])))
    return worst


@njit(cache=True)
def slip_along(body, y, rows, i, s):
    """Slip velocity of closed point i along a direction of the plan."""
    u = point_velocity(y, rows, arm(body, rows[2], s.closed[i]))
    return u[0] * s.slip[i, 0] + u[1] * s.slip[i, 1]


@njit(cache=True)
def is_closed(s, i):
    """Whether point i is closed in a mode."""
    found = False
    for k in range(s.count):
        found = found or s.closed[k] == i
    return found


@njit(cache=True)
def begin_slips(body, y, s):
    """Note each sliding point's direction, and whether it is fast enough for its slip to end."""
    rows = rotation(y)
    for i in range(s.count):
        s.armed[i] = 0
        if s.slides[i] == SLIDES:
            u = point_velocity(y, rows, arm(body, rows[2], s.closed[i]))
            speed = math.hypot(u[0], u[1])
            s.slip[i, 0], s.slip[i, 1] = s.direction[i, 0], s.direction[i, 1]
            if speed > 2 * AT_REST:
                s.slip[i, 0], s.slip[i, 1] = u[0] / speed, u[1] / speed
                s.direction[i, 0], s.direction[i, 1] = s.slip[i, 0], s.slip[i, 1]
                s.armed[i] = 1


@njit(cache=True)
def sinks(body, y, rows, i):
    """Whether an open point moves down, and not by rounding alone."""
    return point_velocity(y, rows, arm(body, rows[2], i))[2] < -1e-10


@njit(cache=True)
def margin(body, y, s):
    """Return the least of all that must not be negative, and what it belongs to."""
    rows = rotation(y)
    least, what = 1e300, NOTHING
    for i in range(first_candidate(body), last_candidate(body)):
        if not is_closed(s, i):
            value = gap(body, y, rows[2], i) + 0.5 * TOUCH
            if value < 0.5 * TOUCH and not sinks(body, y, rows, i):
                value += TOUCH
            if value < least:
                least, what = value, LANDS
    small = LEAST_FORCE * s.field[6]
    for i in range(s.count):
        value = s.lam[i, 2] + small
        if value < least:
            least, what = value, OPENS
        if s.slides[i] == SLIDES:
            value = slip_along(body, y, rows, i, s) + (-AT_REST if s.armed[i] else AT_REST)
            if value < least:
                least, what = value, SLIP_ENDS
        else:
            value = body.static * s.lam[i, 2] - math.hypot(s.lam[i, 0], s.lam[i, 1]) + small
            if value < least:
                least, what = value, LEAVES_CONE
    return least, what


@njit(cache=True)
def dips(body, y, h, s):
    """Whether a point that is open at both ends of a step may have touched inside it."""
    new = s.new
    before, after = rotation(y), rotation(new)
    for i in range(first_candidate(body), last_candidate(body)):
        if is_closed(s, i):
            continue
        sinking = point_velocity(y, before, arm(body, before[2], i))[2]
        rising = point_velocity(new, after, arm(body, after[2], i))[2]
        if sinking < 0 < rising:
            lowest = gap(body, y, before[2], i) - 0.5 * h * sinking**2 / (rising - sinking)
            if lowest - 0.02 * h * (rising - sinking) < -0.5 * TOUCH:
                return True
    return False
