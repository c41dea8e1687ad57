"""Marching one body through one motion, event by event, with friction and flight."""

import math

from rockfrag.rocking.contact._modes import (
    approach,
    kinetic_energy,
    project,
    settle,
    strike,
)
from rockfrag.rocking.contact._solve import end_of, look_at, solve
from rockfrag.rocking.contact._step import (
    EDGE,
    FALL,
    FRICTION,
    GAP,
    comes_near,
    first_failure,
    least_margin,
    margin_at,
    start_step,
    take_step,
)
from rockfrag.rocking.kernels.jit import entry_kernel, kernel

MOST_EVENTS = 300
"""Events within a sample after which accumulating ones are ended ten times as coarsely, and again."""

MOST_IDLE = 30
"""Events on the spot after which a step is taken without looking for more."""

HISTORY = 24
"""Columns of a history: q (6), v (6), slip (2), normal force (2), shear (2), work, rubbed, struck, mode, angular
acceleration (2)."""

EVENT = 14
"""Columns of the events: time, kind, mode before and after, slip of both interfaces [m], kinetic energy before and
after [J], rotations (2), angular velocities before (2) and after (2)."""
CHANGE, IMPACT, PARADOX, FALLEN, PASSING = 0, 1, 2, 3, 4
"""Kinds of events: the last is a corner that passes an edge while nothing else changes."""


@entry_kernel
def march_cases(
    cases, bodies, horizontal, vertical, offsets, dts, factors, substeps, free_samples, closing,
    starts, outcome, history, events, w,
):  # fmt: skip
    """March some ``cases`` of bodies × motions × scales, and keep their outcomes.

    Parameters
    ----------
    bodies : (bodies,) BODY
    horizontal, vertical : all motions end to end; ``offsets`` (motions + 1,) where each begins
    factors : (motions, scales)
    substeps, free_samples : (bodies, motions)
    starts : (bodies, 2, 6)
    outcome : (cases,) OUTCOME
    history, events : of no rows
    """
    scales = factors.shape[1]
    motions = factors.shape[0]
    for case in cases:
        b = case // (motions * scales)
        m = case // scales - b * motions
        scale = factors[m, case - (b * motions + m) * scales]
        begin, end = offsets[m], offsets[m + 1]
        up = vertical[begin:end] if vertical.size > 0 else vertical
        _, _, fall = march(
            bodies[b], horizontal[begin:end], up, dts[m], scale, substeps[b, m], free_samples[b, m],
            starts[b], closing, history, events, w,
        )  # fmt: skip
        out = outcome[case]
        out.fallen = w.fallen
        out.time = fall
        out.impacts = w.impacts
        out.paradoxes = w.paradoxes
        out.forced = w.forced
        out.flights = w.flights
        for k in range(bodies[b].count):
            out.peak[k] = w.peak[k]
            out.peak_speed[k] = w.peak_speed[k]
            out.peak_slip[k] = w.peak_slip[k]
            out.slid[k] = w.slid[k]
            look_at(bodies[b], w, w.q)
            out.slip[k] = slip(bodies[b], w, k)


@entry_kernel
def march(
    p, horizontal, vertical, dt, scale, substeps, free_samples, start, closing, history, events, w
):
    """March one body through ``scale`` × the motion and on until it rests or has fallen.

    Parameters
    ----------
    p : BODY
    horizontal, vertical : samples [m/s²], zero after the last; an empty ``vertical`` is zero throughout
    dt : sampling interval [s]
    substeps : steps per sample
    free_samples : samples that the march goes on after the last one at most
    start : (2, 6) coordinates and velocities
    closing : speed over √(g b) below which a contact stays closed after an impact
    history : (samples, HISTORY), or of no rows
    events : (capacity, EVENT), or of no rows
    w : WORK

    Returns
    -------
    Samples done, events met, and the time of the fall [s] (NaN if none; ``w.fallen`` says which).
    """
    _begin(p, w, start)
    n = horizontal.size
    keeps = history.shape[0] > 0
    ledger = keeps
    up = vertical.size > 0
    count = _handle(p, w, 0.0, _at(horizontal, 0, scale, n), _at(vertical, 0, scale, n) if up else 0.0,
                    closing, True, False, events, 0)  # fmt: skip
    fresh = True  # the acceleration in w.a is not that of this state and mode
    if keeps:
        _keep(
            p,
            w,
            0,
            _at(horizontal, 0, scale, n),
            _at(vertical, 0, scale, n) if up else 0.0,
            history,
        )
    known_rest = False
    done = 1
    fall = math.nan
    idle = 0
    for i in range(n - 1 + free_samples):
        left, right = _at(horizontal, i, scale, n), _at(horizontal, i + 1, scale, n)
        low, high = 0.0, 0.0
        if up:
            low, high = _at(vertical, i, scale, n), _at(vertical, i + 1, scale, n)
        tau = 0.0
        met = 0
        while tau < 1.0:
            if w.resting == 1:
                if not known_rest:
                    _rest_margins(p, w)
                    known_rest = True
                tau = _rest_ends(p, w, tau, left, right, low, high)
                if tau > 1.0:
                    break
                known_rest = False
                fresh = True
                count = _handle(p, w, (i + tau) * dt, left + tau * (right - left), low + tau * (high - low),
                                closing, True, True, events, count)  # fmt: skip
                met += 1
                if w.resting == 1:
                    # it failed by rounding only
                    tau += 1e-9
                continue
            known_rest = False
            step = (math.floor(tau * substeps + 1e-9) + 1.0) / substeps - tau
            h = step * dt
            ah, av = left + tau * (right - left), low + tau * (high - low)
            rise_h, rise_v = step * (right - left), step * (high - low)
            if fresh:
                look_at(p, w, w.q)
                solve(p, w, w.q, w.v, ah, av, False)
                for d in range(3 * p.count):
                    w.a[d] = w.out[d]
            start_step(p, w)
            work, rubbed = take_step(p, w, h, ah, av, rise_h, rise_v, ledger)
            at_end = least_margin(p, w, w.q1, w.v1)
            when = 2.0
            if idle <= MOST_IDLE:
                when = _event_in_step(p, w, at_end, h, ah, av, rise_h, rise_v)
            else:
                # events that do not let time go on: leave them behind
                idle = 0
                w.forced += 1
            if when > 1.0:
                for d in range(3 * p.count):
                    w.q[d] = w.q1[d]
                    w.v[d] = w.v1[d]
                    w.a[d] = w.a1[d]
                fresh = False
                project(p, w)
                tau += step
                if 1.0 - tau < 1e-12:
                    tau = 1.0
            else:
                margin_at(p, w, when, h, ah, av, rise_h, rise_v)  # sets what fails
                if when > 0.0:
                    work, rubbed = take_step(
                        p, w, when * h, ah, av, when * rise_h, when * rise_v, ledger
                    )
                    for d in range(3 * p.count):
                        w.q[d] = w.q1[d]
                        w.v[d] = w.v1[d]
                else:
                    work = 0.0
                    rubbed = 0.0
                    for d in range(3 * p.count):
                        w.q[d] = w.q0[d]
                        w.v[d] = w.v0[d]
                project(p, w)
                tau += when * step
                idle = idle + 1 if when < 1e-9 else 0
                met += 1
                coarser = closing * 10.0 ** (met // MOST_EVENTS)
                if met >= MOST_EVENTS:
                    w.forced += 1
                count = _handle(p, w, (i + tau) * dt, left + tau * (right - left), low + tau * (high - low),
                                coarser, False, False, events, count)  # fmt: skip
                fresh = True
                if met > 10 * MOST_EVENTS:
                    tau = 1.0
            w.work += work
            w.rubbed += rubbed
            _track(p, w)
            if w.fallen > 0:
                fall = (i + tau) * dt
                break
        done = i + 2
        if keeps:
            _keep(p, w, i + 1, right, high, history)
        if w.fallen > 0:
            break
        if i >= n - 1 and w.resting == 1:
            break
    return done, count, fall


@kernel
def _at(samples, i, scale, n):
    return samples[i] * scale if i < n else 0.0


@kernel
def _begin(p, w, start):
    for d in range(3 * p.count):
        w.q[d] = start[0, d]
        w.v[d] = start[1, d]
        w.a[d] = 0.0
    look_at(p, w, w.q)
    for k in range(2):
        w.slides[k] = 0
        for end in range(2):
            w.closed[k, end] = 0
            w.kind[k, end] = 0
            w.touching[k, end] = 0
            if k < p.count:
                _, _, _, _, gap, _, w.kind[k, end] = end_of(p, w, w.q, k, end, -1)
                w.closed[k, end] = 1 if gap < 1e-11 * p.size else 0
    w.work = w.rubbed = w.struck = 0.0
    for k in range(2):
        w.peak[k] = w.peak_speed[k] = w.peak_slip[k] = 0.0
        w.slid[k] = 0
    w.impacts = w.slips = w.flights = w.paradoxes = w.forced = w.fallen = w.resting = 0


@kernel
def _track(p, w):
    """Keep the largest rotations, angular velocities and slips."""
    for k in range(p.count):
        theta = w.q[3 * k + 2]
        limit = p.critical[k, 1] if theta > 0.0 else p.critical[k, 0]
        w.peak[k] = max(w.peak[k], abs(theta) / limit)
        w.peak_speed[k] = max(w.peak_speed[k], abs(w.v[3 * k + 2]))
        w.peak_slip[k] = max(w.peak_slip[k], abs(slip(p, w, k)))


@kernel
def _event_in_step(p, w, at_end, h, ah, av, rise_h, rise_v):
    """Fraction of the step at which something fails first; 2.0 if nothing does."""
    high = 2.0
    at_high = at_end
    if at_end < 0.0:
        high = 1.0
    near = comes_near(p, w)
    if near or at_end < 0.02:
        for quarter in range(1, 4):
            if not near and quarter != 2:
                continue
            tau = 0.25 * quarter
            value = margin_at(p, w, tau, h, ah, av, rise_h, rise_v)
            if value < 0.0:
                high = tau
                at_high = value
                break
    if high > 1.0:
        return 2.0
    at_low = margin_at(p, w, 0.0, h, ah, av, rise_h, rise_v)
    if at_low < 0.0:
        return 0.0
    return first_failure(p, w, 0.0, at_low, high, at_high, h, ah, av, rise_h, rise_v)


@kernel
def _handle(p, w, time, ah, av, closing, all_ends, exclude, events, count):
    """Change the mode at an event, whose failing channels are in ``w.fails``.

    ``all_ends``: the state is new (start, end of rest), and only ends that touch count.  ``exclude``: the old
    mode is known to fail.

    Returns
    -------
    Number of events so far.
    """
    for d in range(3 * p.count):
        w.old_v[d] = w.v[d]
    for k in range(2):
        w.old_slides[k] = w.slides[k]
        for end in range(2):
            w.old_closed[k, end] = w.closed[k, end]
    passes = False
    if not all_ends:
        for k in range(p.count):
            if w.fails[k, FALL] == 1:
                w.fallen = k + 1
                return _note(p, w, time, FALLEN, events, count)
    look_at(p, w, w.q)
    for k in range(p.count):
        leaves0, leaves1 = 0, 0
        if not all_ends:
            for end in range(2):
                if w.closed[k, end] == 1 and w.fails[k, GAP + end] == 1:
                    exclude = True
                if w.closed[k, end] == 1 and w.fails[k, EDGE + end] == 1:
                    passes = True
                    if w.closed[k, 1 - end] == 1:
                        w.kind[k, end] = 1 - w.kind[k, end]
                    elif end == 0:
                        leaves0 = 1
                    else:
                        leaves1 = 1
            if w.fails[k, FRICTION] == 1:
                if w.slides[k] == 0:
                    exclude = True
                else:
                    w.slides[k] = 0
                    project(p, w)
                    w.resting = 0
        for end in range(2):
            touches = w.closed[k, end] == 1
            if not touches:
                _, _, _, _, gap, _, kind = end_of(p, w, w.q, k, end, -1)
                touches = gap < 1e-11 * p.size
                if not all_ends and w.fails[k, GAP + end] == 1:
                    touches = True
                if touches:
                    w.kind[k, end] = kind
            w.touching[k, end] = 1 if touches else 0
        if leaves0 == 1:
            w.touching[k, 0] = 0
        if leaves1 == 1:
            w.touching[k, 1] = 0
    _shut(p, w)
    kind = PASSING if passes else CHANGE
    hit = False
    for k in range(p.count):
        for end in range(2):
            if w.touching[k, end] == 1 and approach(p, w, k, end) < -1e-13 * p.speed:
                hit = True
    if hit:
        strike(p, w, ah, av, closing * p.speed, False)
        _touch_closed(p, w)
        kind = IMPACT
        exclude = False
    if not settle(p, w, ah, av, exclude):
        w.paradoxes += 1
        strike(p, w, ah, av, closing * p.speed, True)
        _touch_closed(p, w)
        settle(p, w, ah, av, False)
        kind = PARADOX
    for k in range(p.count):
        if w.slides[k] != 0 and w.old_slides[k] == 0:
            w.slips += 1
        if w.closed[k, 0] + w.closed[k, 1] == 0 and w.old_closed[k, 0] + w.old_closed[k, 1] > 0:
            w.flights += 1
    return _note(p, w, time, kind, events, count)


@kernel
def _touch_closed(p, w):
    """Let the ends that an impact has closed be those that touch."""
    for k in range(p.count):
        for end in range(2):
            w.touching[k, end] = w.closed[k, end]


@kernel
def _shut(p, w):
    """Set the gaps of touching ends to zero."""
    for k in range(p.count):
        if w.touching[k, 0] == 0 and w.touching[k, 1] == 0:
            continue
        if w.touching[k, 0] == 1 and w.touching[k, 1] == 1:
            w.q[3 * k + 2] = w.q[3 * k - 1] if k > 0 else 0.0
        end = 0 if w.touching[k, 0] == 1 else 1
        look_at(p, w, w.q)
        _, _, tx, ty, gap, _, _ = end_of(p, w, w.q, k, end, w.kind[k, end])
        for body in range(k, p.count):
            w.q[3 * body] += gap * ty
            w.q[3 * body + 1] -= gap * tx
    look_at(p, w, w.q)


@kernel
def _rest_margins(p, w):
    """Margins of rest as linear functions of the two accelerations of the ground."""
    look_at(p, w, w.q)
    for load in range(3):
        ah = 1.0 if load == 1 else 0.0
        av = 1.0 if load == 2 else 0.0
        solve(p, w, w.q, w.v, ah, av, False)
        for k in range(p.count):
            pressed = w.normal[k, 0] + w.normal[k, 1]
            hold = p.static[k] * pressed
            unit = 1.0 / (p.weight * max(p.static[k], 1.0))
            w.rest[4 * k, load] = w.normal[k, 0] / p.weight
            w.rest[4 * k + 1, load] = w.normal[k, 1] / p.weight
            w.rest[4 * k + 2, load] = (hold - w.shear[k]) * unit
            w.rest[4 * k + 3, load] = (hold + w.shear[k]) * unit
    for row in range(4 * p.count):
        w.rest[row, 1] -= w.rest[row, 0]
        w.rest[row, 2] -= w.rest[row, 0]


@kernel
def _rest_ends(p, w, tau, left, right, low, high):
    """Fraction of the sample interval, from ``tau`` on, at which rest ends; 2.0 if it lasts."""
    when = 2.0
    for row in range(4 * p.count):
        late = w.rest[row, 0] + w.rest[row, 1] * right + w.rest[row, 2] * high
        if late < 0.0:
            slope = w.rest[row, 1] * (right - left) + w.rest[row, 2] * (high - low)
            if slope < 0.0:
                when = min(when, max(tau, 1.0 - late / slope))
    return when


@kernel
def _mode_number(p, closed, slides):
    """Mode as one number: for each interface its closed ends (bits) and 4 × (slip + 1)."""
    number = 0
    for k in range(p.count):
        one = closed[k, 0] + 2 * closed[k, 1] + 4 * (slides[k] + 1)
        number += one * 16**k
    return number


@kernel
def _note(p, w, time, kind, events, count):
    """Write an event, if there is room; return the number of events so far."""
    before = _mode_number(p, w.old_closed, w.old_slides)
    after = _mode_number(p, w.closed, w.slides)
    if kind == CHANGE and before == after:
        return count
    if count < events.shape[0]:
        event = events[count]
        event[0] = time
        event[1] = kind
        event[2] = before
        event[3] = after
        event[6] = kinetic_energy(p, w.old_v)
        event[7] = kinetic_energy(p, w.v)
        for k in range(p.count):
            event[4 + k] = slip(p, w, k)
            event[8 + k] = w.q[3 * k + 2]
            event[10 + k] = w.old_v[3 * k + 2]
            event[12 + k] = w.v[3 * k + 2]
    return count + 1


@kernel
def slip(p, w, k):
    """Displacement along interface k of the corner that carries, from where it stood at first [m].

    ``look_at`` must have been called with ``w.q``.
    """
    relative = w.q[3 * k + 2] - (w.q[3 * k - 1] if k > 0 else 0.0)
    end = 1 if relative >= 0.0 else 0
    x, _, _, _, _, beyond, _ = end_of(p, w, w.q, k, end, 1)
    if k == 0:
        return x - p.standing[0] - p.corner[0, end, 0]
    side = 2 * end - 1
    # as it stood: corner and face in the standing configuration
    dx = p.standing[3] + p.corner[1, end, 0] - p.standing[0] - p.face[1, 0]
    dy = p.standing[4] + p.corner[1, end, 1] - p.standing[1] - p.face[1, 1]
    along = dx * p.tilt_cos[1] - dy * p.tilt_sin[1]
    return side * (beyond + p.half[1]) - along


@kernel
def _keep(p, w, i, ah, av, history):
    look_at(p, w, w.q)
    solve(p, w, w.q, w.v, ah, av, False)
    for d in range(3 * p.count):
        history[i, d] = w.q[d]
        history[i, 6 + d] = w.v[d]
    for k in range(p.count):
        history[i, 12 + k] = slip(p, w, k)
        history[i, 14 + k] = w.normal[k, 0] + w.normal[k, 1]
        history[i, 16 + k] = w.shear[k]
        history[i, 22 + k] = w.out[3 * k + 2]
    history[i, 18] = w.work
    history[i, 19] = w.rubbed
    history[i, 20] = w.struck
    history[i, 21] = _mode_number(p, w.closed, w.slides)
