"""What is kept of one history: its summary, its samples and its contact events.

In: a body and its state in each step. Out: records of samples, of contact events and of the summary. Docs:
``docs/rocking.md``, "What a response says about itself".
"""

import math

import numpy as np

from rockfrag.base.arrays import fields, whole
from rockfrag.base.elementary import hypot, sin_cos
from rockfrag.engines.compile.jit import entry_kernel, inlined_kernel, kernel
from rockfrag.engines.pure_rocking.kernels import equations
from rockfrag.engines.pure_rocking.kernels.demand import (
    DEMAND,
    add_demand,
    ask_forces,
    no_demand,
)
from rockfrag.engines.pure_rocking.kernels.roots import NEVER, bend, slope, value

SUMMARY = np.dtype(
    [
        *whole("fallen"),  # 0 none, 1 pedestal (or both as one), 2 statue or lone block
        *fields("fall_time"),  # [s], NaN if none
        *fields("speed2"),  # max |θ'| of the statue [rad/s]
        # max θ/θcritical of the pedestal (with what stands on it), of the statue
        *fields("ratio1 ratio2"),
        *whole("impacts grazings"),  # a graze: a contact that closed without speed
        # least distance to an unstable equilibrium, in units of (θc, p θc), and work of the ground [J]
        *fields("unstable_distance work"),
        # given_way: impacts in which the law of a measured restitution had to give way
        *whole("contact_events given_way"),
        # when a normal force first was none [s], NaN if it never was
        *fields("lost_contact"),
        # until the fall is certain, and since a block has last passed balance
        *fields("demand beyond", of=DEMAND),
    ],
    align=True,
)
"""Summary of a history."""

SAMPLE = np.dtype(
    [
        *fields("theta1 omega1 theta2 omega2"),  # [rad], [rad/s]
        *whole("c1 c2"),  # contact states of ground and interface
        # angular accelerations [rad/s²], and work of the ground so far [J]
        *fields("alpha1 alpha2 work"),
    ],
    align=True,
)
"""State at a sample."""

CONTACT_EVENT = np.dtype(
    [
        *fields("time"),  # [s]
        *whole("kind"),  # OPENING and its like
        *fields("before after", of=equations.STATE),
        *fields("energy_before energy_after"),  # kinetic [J]
    ],
    align=True,
)
"""A change of the contact state."""

OPENING, CLOSING, CHATTER, LIFTING = 0, 1, 2, 3
"""Kinds of contact events; a contact that lifts would have to pull as a whole; integration goes on as if so."""

BALANCE = np.dtype(fields("critical frequency2"))
"""A way to balance: critical angle [rad] and squared frequency parameter [1/s²]."""


@inlined_kernel
def copy_state(source, target):
    """Make one state equal to another."""
    target.c1, target.c2 = source.c1, source.c2
    target.ground, target.gravity = source.ground, source.gravity
    target.theta1, target.omega1 = source.theta1, source.omega1
    target.theta2, target.omega2 = source.theta2, source.omega2


@kernel
def move_within(step, series, tau, state):
    """Fill angles, rates, ground and gravity of a state at the time ``tau`` [-] of a step.

    ``step``: a ``taylor.Step``; ``series``: its SERIES.
    """
    first, two = series.one.angle, series.two.angle
    state.theta1, state.omega1 = value(first, tau), slope(first, tau) / step.length
    state.theta2, state.omega2 = value(two, tau), slope(two, tau) / step.length
    state.ground = step.ground + step.rise * tau
    state.gravity = step.gravity + step.lift * tau


@kernel
def begin(state, summary):
    """Set a SUMMARY to that of a history that begins with a STATE and has not moved yet."""
    summary.fallen, summary.fall_time = 0, math.nan
    summary.impacts, summary.grazings = 0, 0
    summary.contact_events, summary.given_way = 0, 0
    summary.unstable_distance, summary.work = math.inf, 0.0
    summary.lost_contact = math.nan
    no_demand(summary.demand)
    no_demand(summary.beyond)
    summary.ratio1, summary.ratio2 = 0.0, 0.0
    summary.speed2 = abs(state.omega2)


@kernel
def fill_balances(body, balances):
    """Fill the records BALANCE of a body, shape (9,), by ``equations.number_of`` its contacts; none is of rest."""
    for c1 in (1, -1, 0):
        for c2 in (-1, 0, 1):
            if c1 != 0 or c2 != 0:
                critical, vx, vy, inertia = equations.balance(body, c1, c2)
                way = balances[equations.number_of(c1, c2)]
                way.critical = critical
                way.frequency2 = body.gravity * hypot(vx, vy) / inertia


@kernel
def _approach(way, side, theta, omega, summary):
    """Take a rotation [rad] and its rate [rad/s] into the summary's closest approach to a way to balance.

    ``way``: record BALANCE; ``side``: +1 or -1, the pivot of the rotation. Returned is θ/θcritical, positive
    there.
    """
    away = 1.0 - side * theta / way.critical
    speed = omega / way.critical
    square = away * away + speed * speed / way.frequency2
    if square < summary.unstable_distance * summary.unstable_distance:
        summary.unstable_distance = math.sqrt(square)
    return side * theta / way.critical


@kernel
def track(balances, state, summary):
    """Take a state into the summary's extremes and closest approach to balance (``balances``, records BALANCE).

    Returned is whether a block is beyond its balance.
    """
    ratio1, ratio2 = 0.0, 0.0
    theta1, theta2 = state.theta1, state.theta2
    omega1, omega2 = state.omega1, state.omega2
    summary.speed2 = max(summary.speed2, abs(omega2))
    c1, c2 = state.c1, state.c2
    if c2 != 0:
        ratio2 = _approach(
            balances[equations.number_of(0, c2)], c2, theta2, omega2, summary
        )
        summary.ratio2 = max(summary.ratio2, ratio2)
    if c1 != 0:
        ratio1 = _approach(
            balances[equations.number_of(c1, c2)], c1, theta1, omega1, summary
        )
        summary.ratio1 = max(summary.ratio1, ratio1)
    return ratio1 >= 1.0 or ratio2 >= 1.0


@kernel
def note_demand(body, step, series, end, work, summary):
    """Note which friction and normal forces a step demands of its contacts, up to the instant ``end`` in it.

    Forces are computed at the beginning, in the middle and at the end; between these they are nearly parabolas,
    and steps are short. Demands of a block beyond its balance are kept apart, and count once it has come back.
    Times in the step are parts of its length [-]. Returned is the one at which a normal force first vanished;
    NEVER if all push, or beyond balance.
    """
    state, trial = work.state, work.trial
    # what has come back from beyond balance was not yet a fall
    inside = not work.beyond
    demand = summary.demand if inside else summary.beyond
    if inside:
        add_demand(summary.demand, summary.beyond)
        no_demand(summary.beyond)
    lifts = NEVER
    least = math.inf
    first, two = series.one.angle, series.two.angle
    per = 1.0 / (step.length * step.length)
    trial.c1, trial.c2 = state.c1, state.c2
    for part in range(3):
        tau = 0.5 * part * end
        move_within(step, series, tau, trial)
        before = least
        least = ask_forces(
            body, trial, bend(first, tau) * per, bend(two, tau) * per, demand
        )
        if least <= 0.0 and lifts == NEVER and inside:
            # a straight line between the two
            fraction = before / (before - least) if part > 0 else 0.0
            lifts = tau if part == 0 else tau - 0.5 * end * (1.0 - fraction)
    return lifts


@kernel
def work_of(body, c1, c2, series, end, step):
    """Work of the ground's acceleration over (0, end] of a step [J]: -∫ Σ m (a x' + a_v y') dt.

    ``end`` is a part of the step [-]; ``series`` has the angles over the step. Velocities x' and y' of the centres
    of gravity follow from the first moments m1 r1 + m2 d and m2 r2, turned by θ1 and θ2 (``equations``).
    """
    s1, s2 = equations.pivot(c1), equations.pivot(c2)
    v1x, v1y = equations.first_moment1(body, s1, s2)
    v2x, v2y = equations.first_moment2(body, s2)
    # Gauss-Legendre, six points: exact to order 11
    nodes = (0.2386191860831969, 0.6612093864662645, 0.9324695142031521)
    weights = (0.4679139345726910, 0.3607615730481386, 0.1713244923791704)
    total = 0.0
    for i in range(3):
        for sign in (-1.0, 1.0):
            # Σ m x' and -Σ m y', by time in steps, at a point of the quadrature
            tau = 0.5 * end * (1.0 + sign * nodes[i])
            t1 = value(series.one.angle, tau)
            t2 = value(series.two.angle, tau)
            w1 = slope(series.one.angle, tau)
            w2 = slope(series.two.angle, tau)
            if body.linear > 0:
                rate = v1y * w1 + v2y * w2
                fall = (v1x + v1y * t1) * w1 + (v2x + v2y * t2) * w2
            else:
                sine1, cosine1 = sin_cos(t1)
                sine2, cosine2 = sin_cos(t2)
                rate = w1 * (v1y * cosine1 - v1x * sine1) + w2 * (
                    v2y * cosine2 - v2x * sine2
                )
                fall = w1 * (v1x * cosine1 + v1y * sine1) + w2 * (
                    v2x * cosine2 + v2y * sine2
                )
            upward = step.gravity + step.lift * tau - body.gravity
            total -= weights[i] * (step.ground + step.rise * tau) * rate
            total += weights[i] * upward * fall
    return 0.5 * end * total


@kernel
def keep_sample(body, state, sample, work):
    """Write a state into a record SAMPLE of the history; ``work``: of the ground until then [J]."""
    alpha1, alpha2 = equations.accelerations(body, state.c1, state.c2, state)
    sample.theta1, sample.omega1 = state.theta1, state.omega1
    sample.theta2, sample.omega2 = state.theta2, state.omega2
    sample.c1, sample.c2 = state.c1, state.c2
    sample.alpha1, sample.alpha2 = alpha1, alpha2
    sample.work = work


@kernel
def keep_contact_event(body, time, kind, before, after, contact_events, summary):
    """Write a contact event at a time [s], if there is room, and count it in the summary.

    ``kind``: OPENING and its like; ``before``, ``after``: records STATE.
    """
    if summary.contact_events < len(contact_events):
        contact_event = contact_events[summary.contact_events]
        contact_event.time, contact_event.kind = time, kind
        copy_state(before, contact_event.before)
        copy_state(after, contact_event.after)
        contact_event.energy_before = equations.kinetic_energy(body, before)
        contact_event.energy_after = equations.kinetic_energy(body, after)
    summary.contact_events += 1


@entry_kernel
def fill_energies(body, history, kinetic, potential, scratch):
    """Fill the kinetic and potential energy [J] of each SAMPLE of a history; ``scratch`` is a STATE."""
    for i in range(len(history)):
        sample = history[i]
        scratch.c1, scratch.c2 = sample.c1, sample.c2
        scratch.theta1, scratch.omega1 = sample.theta1, sample.omega1
        scratch.theta2, scratch.omega2 = sample.theta2, sample.omega2
        kinetic[i] = equations.kinetic_energy(body, scratch)
        potential[i] = equations.potential_energy(body, scratch)


@entry_kernel
def fill_sines(theta, sine, cosine):
    """Fill the sine and cosine of each angle of arrays of two dimensions."""
    for i in range(theta.shape[0]):
        for j in range(theta.shape[1]):
            sine[i, j], cosine[i, j] = sin_cos(theta[i, j])
