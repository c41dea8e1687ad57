"""Ties of bodies to the ground: what they pull, when they get taut, slacken and break (``docs/holding.md``, 3).

A tie is a spring with a dashpot; that it becomes taut or slack ends a step, so within one its force is smooth.

``p`` and ``w`` are records ``BODY`` and ``WORK`` (``records.py``). ``q`` and ``v`` have x, y [m] and the clockwise
rotation θ [rad] of body k, from place 3 k on, and their rates.

In: a record ``BODY``, coordinates and velocities. Out: tensions [N], the accelerations that they cause [m/s²], and
margins that are negative once a tie changes its state.
"""

import math

from rockfrag.engines.compile.jit import kernel
from rockfrag.engines.planar.support import spring_force

SLACK, TAUT, PUSHED, BROKEN = 0, 1, -1, 2
"""States of a tie; a bracket, which pushes too, is PUSHED where it is shorter than its play allows."""
JUST = 1e-13  # slack before a change is seen: of lengths over b, forces over the weight [-]


@kernel
def _stretched(p, w, q, v, t):
    """Geometry of tie t, after ``look_at`` with ``q``.

    Returns
    -------
    rx, ry : point on its body, from the centre of gravity [m]
    ex, ey : unit vector from there towards its other end
    length : of the tie [m]
    speed : rate of the length [m/s]
    """
    b = 3 * p.tie_body[t]
    c, s = w.cos[p.tie_body[t]], w.sin[p.tie_body[t]]
    px, py = p.tie_point[t, 0], p.tie_point[t, 1]
    rx, ry = px * c + py * s, -px * s + py * c
    ex, ey = p.tie_anchor[t, 0] - q[b] - rx, p.tie_anchor[t, 1] - q[b + 1] - ry
    length = math.sqrt(ex * ex + ey * ey)
    if length > 0.0:
        ex, ey = ex / length, ey / length
    speed = -ex * (v[b] + v[b + 2] * ry) - ey * (v[b + 1] - v[b + 2] * rx)
    return rx, ry, ex, ey, length, speed


@kernel
def tension(p, w, q, v, t):
    """Force of tie t in its state, positive as it pulls [N], and the rate of its length [m/s]."""
    _, _, _, _, length, speed = _stretched(p, w, q, v, t)
    if w.taut[t] == TAUT:
        natural = p.tie_long[t]
    elif w.taut[t] == PUSHED:
        natural = p.tie_short[t]
    else:
        return 0.0, speed
    return p.tie_stiffness[t] * (length - natural) + p.tie_damping[t] * speed, speed


@kernel
def is_any_taut(p, w):
    """Whether a tie or the spring of an isolator pulls or pushes."""
    taut = p.is_sprung == 1
    for t in range(p.ties):
        taut = taut or w.taut[t] == TAUT or w.taut[t] == PUSHED
    return taut


@kernel
def fill_tie_accelerations(p, w, q, v):
    """Fill ``w.drift`` with accelerations [m/s², rad/s²] by ties and the spring of an isolator.

    ``look_at`` must have been called with ``q``.
    """
    for d in range(3 * p.count):
        w.drift[d] = 0.0
    if p.is_sprung == 1:
        w.drift[0] -= spring_force(p, w, q) * p.inverse[0]
    for t in range(p.ties):
        if w.taut[t] == SLACK or w.taut[t] == BROKEN:
            continue
        force, _ = tension(p, w, q, v, t)
        rx, ry, ex, ey, _, _ = _stretched(p, w, q, v, t)
        b = 3 * p.tie_body[t]
        w.drift[b] += force * ex * p.inverse[b]
        w.drift[b + 1] += force * ey * p.inverse[b + 1]
        w.drift[b + 2] += force * (ex * ry - ey * rx) * p.inverse[b + 2]


@kernel
def power(p, w, q, v):
    """Power that ties and the spring of an isolator take from the bodies [W]."""
    taken = spring_force(p, w, q) * v[0] if p.is_sprung == 1 else 0.0
    for t in range(p.ties):
        force, speed = tension(p, w, q, v, t)
        taken += force * speed
    return taken


@kernel
def start_ties(p, w):
    """Note the rates of lengths [m/s] at the start of a step in ``w.tie_early``."""
    for t in range(p.ties):
        _, _, _, _, _, w.tie_early[t] = _stretched(p, w, w.q0, w.v0, t)


@kernel
def turns_back(p, w, time):
    """Whether a slack tie that lengthens and then shortens, or the reverse, may get taut in a step.

    ``time``: length of the step [s]; ``w.tie_early`` has the rates of lengths as it began.
    """
    for t in range(p.ties):
        if w.taut[t] == SLACK:
            _, _, _, _, length, speed = _stretched(p, w, w.q1, w.v1, t)
            reach = abs(w.tie_early[t]) * time
            may = length + reach > p.tie_long[t]
            if p.is_bracket[t] == 1:
                may = may or length - reach < p.tie_short[t]
            if may and w.tie_early[t] * speed < 0.0:
                return True
    return False


@kernel
def least_tie_margin(p, w, q, v):
    """Least margin of all ties [-], negative where one changes its state; ``w.tie_fails`` says which do.

    A slack tie must not get taut; one that pulls must go on pulling, and bear less than its strength, over the
    weight.
    """
    least = math.inf
    for t in range(p.ties):
        margin = math.inf
        if w.taut[t] == SLACK:
            margin = _slack_margin(p, w, q, v, t)
        elif w.taut[t] != BROKEN:
            force, _ = tension(p, w, q, v, t)
            margin = w.taut[t] * force / p.weight
            margin = min(margin, (p.tie_strength[t] - abs(force)) / p.weight) + JUST
        w.tie_fails[t] = 1 if margin < 0.0 else 0
        least = min(least, margin)
    return least


@kernel
def _slack_margin(p, w, q, v, t):
    """Margin of a slack tie [-]: its length within its natural ones, over b, or no force if the dashpot held."""
    _, _, _, _, length, speed = _stretched(p, w, q, v, t)
    k, c = p.tie_stiffness[t], p.tie_damping[t]
    longer = length - p.tie_long[t]
    margin = max(-longer / p.size, -(k * longer + c * speed) / p.weight)
    if p.is_bracket[t] == 1:
        shorter = p.tie_short[t] - length
        free = max(-shorter / p.size, -(k * shorter - c * speed) / p.weight)
        margin = min(margin, free)
    return margin + JUST


@kernel
def change_ties(p, w, time):
    """Let the ties that fail get taut, slacken or break at a time [s]; return whether any does.

    The record of outcomes counts them by ``p.tie_number``, their place among all that holds the bodies.
    """
    changed = False
    for t in range(p.ties):
        if w.tie_fails[t] == 0:
            continue
        changed = True
        w.tie_fails[t] = 0
        at = p.tie_number[t]
        if w.taut[t] == SLACK:
            _, _, _, _, length, _ = _stretched(p, w, w.q, w.v, t)
            # a bracket pulls beyond the middle of its play, and pushes below
            middle = 0.5 * (p.tie_long[t] + p.tie_short[t])
            longer = p.is_bracket[t] == 0 or length > middle
            w.taut[t] = TAUT if longer else PUSHED
            w.outcome.hits[at] += 1
            # a dashpot bears most as it begins
            _note_tension(p, w, t)
            continue
        force = _note_tension(p, w, t)
        # up to rounding: it fails either as its strength is reached or as its force vanishes
        if abs(force) >= p.tie_strength[t] * (1.0 - 1e-9):
            w.taut[t] = BROKEN
            w.outcome.breaking_time[at] = time
        else:
            w.taut[t] = SLACK
    return changed


@kernel
def note_tensions(p, w):
    """Keep the largest forces of ties in the state ``w.q``, ``w.v``."""
    for t in range(p.ties):
        _note_tension(p, w, t)


@kernel
def _note_tension(p, w, t):
    """Keep the largest force of tie t in the state ``w.q``, ``w.v``; return the force, positive in tension [N]."""
    force, _ = tension(p, w, w.q, w.v, t)
    at = p.tie_number[t]
    w.outcome.largest_force[at] = max(w.outcome.largest_force[at], abs(force))
    return force
