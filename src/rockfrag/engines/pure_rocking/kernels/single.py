"""One history: integrate one body through an acceleration, contact event by contact event.

Every step size, root and decision depends on this one case alone, and nothing needs what a web page does not have.

In: a record BODY, a STATE to begin with and a motion. Out: samples, contact events and a summary. Theory:
``docs/derivation.md``; the life of a case: ``docs/kernels.md``.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rockfrag.base.arrays import fields
from rockfrag.engines.compile.jit import entry_kernel, inlined_kernel, kernel
from rockfrag.engines.pure_rocking.kernels import (
    contact_states,
    equations,
    record,
    roots,
)
from rockfrag.engines.pure_rocking.kernels.chatter import (
    HISTORY,
    RESTORING,
    SAFETY_OF_BLOCKS,
    SAFETY_OF_STACKS,
    Ahead,
    dies_out,
    fill_restoring,
)
from rockfrag.engines.pure_rocking.kernels.demand import (
    add_demand,
    ask_impulses,
    no_demand,
)
from rockfrag.engines.pure_rocking.kernels.impact import impact, stuck
from rockfrag.engines.pure_rocking.kernels.taylor import (
    ORDER,
    SERIES,
    Step,
    fill_series,
)

GRAZING_SPEED = 1e-3  # relative speed [rad/s] below which a contact grazes
CLOSED = 1e-13  # opening [rad] below which a contact closes together with the other
MAX_CONTACT_EVENTS_PER_STEP = 400
"""Contact events of a sample after which its contacts are made to stay closed."""


class Shaking(NamedTuple):
    """What a body is shaken with."""

    # acceleration of the ground [m/s²], linear between samples, zero after the last
    samples: NDArray[np.float64]
    # likewise upwards, over gravity [-]; as many, or none where it is zero
    vertical: NDArray[np.float64]
    scale: float  # factor on them
    dt: float  # sampling interval [s]
    substeps: int  # steps per sample
    # samples that the integration goes on after the last one, at most
    free_samples: int


SCRATCH = np.dtype(
    [
        *fields("state before trial", of=equations.STATE),
        *fields("series", of=SERIES),
        *fields("restoring", of=RESTORING),
        *fields("balances", 9, of=record.BALANCE),
        *fields("beyond", of=np.bool_),  # whether a block is beyond its balance
    ],
    align=True,
)
"""Memory that an integration works in."""


@entry_kernel
def integrate(body, shaking, initial, history, contact_events, summary, work):
    """Integrate one body through its shaking and, after it, free rocking.

    Parameters
    ----------
    body : record ``BODY``
    shaking : a :class:`Shaking`: samples [m/s²], interval [s], steps
    initial : record ``STATE``, of which angles and rates count
    history, contact_events : arrays of ``SAMPLE`` and ``CONTACT_EVENT``, filled as far as they reach
    summary : record ``SUMMARY``, changed in place
    work : record ``SCRATCH`` to work in

    Returns
    -------
    Number of samples done, the first one included.
    """
    state = work.state
    record.copy_state(initial, state)
    record.begin(state, summary)
    samples, scale = shaking.samples, shaking.scale
    n = samples.size
    state.ground = samples[0] * scale
    state.gravity = _gravity(body, shaking, 0)
    state.c1, state.c2 = contact_states.first_contacts(state)
    state.c1, state.c2 = contact_states.settle(body, state)
    record.fill_balances(body, work.balances)
    fill_restoring(body, work.restoring, work.trial)
    work.beyond = False
    if len(history) > 0:
        record.keep_sample(body, state, history[0], 0.0)
    done = 1
    for k in range(n - 1 + shaking.free_samples):
        right = samples[k + 1] * scale if k + 1 < n else 0.0
        _through_sample(body, shaking, k, contact_events, summary, work)
        done = k + 2
        state.ground, state.gravity = right, _gravity(body, shaking, k + 1)
        if len(history) > k + 1:
            record.keep_sample(body, state, history[k + 1], summary.work)
        if _note_fall(body, state, (done - 1) * shaking.dt, summary):
            break
        if not work.beyond:
            add_demand(summary.demand, summary.beyond)
            no_demand(summary.beyond)
        if k >= n - 1 and state.c1 == 0 and state.c2 == 0:
            break
    return done


@kernel
def _note_fall(body, state, clock, summary):
    """Note in the summary a block that lies down at the time ``clock`` [s]; return whether one does."""
    lying1 = abs(state.theta1) >= contact_states.HALF_TURN
    turned2 = max(abs(state.theta2), abs(state.theta2 - state.theta1))
    lying2 = turned2 >= contact_states.HALF_TURN
    if lying1 or lying2:
        summary.fallen = 1 if lying1 and not body.fixed else 2
        summary.fall_time = clock
    return lying1 or lying2


@inlined_kernel
def _gravity(body, shaking, k):
    """Sum of gravity and the ground's upward acceleration at sample k [m/s²]."""
    if k < shaking.vertical.size:
        return body.gravity + body.gravity * (shaking.scale * shaking.vertical[k])
    return body.gravity


@inlined_kernel
def _substep(body, shaking, k, sub):
    """Return part ``sub``, counted from 0, of the interval after sample k as a :class:`Step`."""
    samples, scale, substeps = shaking.samples, shaking.scale, shaking.substeps
    n = samples.size
    left = samples[k] * scale if k < n else 0.0
    right = samples[k + 1] * scale if k + 1 < n else 0.0
    heavy, heavier = _gravity(body, shaking, k), _gravity(body, shaking, k + 1)
    return Step(
        shaking.dt / substeps,
        left + (right - left) * (sub / substeps),
        (right - left) / substeps,
        heavy + (heavier - heavy) * (sub / substeps),
        (heavier - heavy) / substeps,
    )


@inlined_kernel
def _rest_of(step, tau):
    """Return the rest of a :class:`Step` of which the part ``tau`` [-] has passed."""
    left = 1.0 - tau
    return Step(
        step.length * left,
        step.ground + step.rise * tau,
        step.rise * left,
        step.gravity + step.lift * tau,
        step.lift * left,
    )


@inlined_kernel
def _clock(shaking, k, passed):
    """Time [s] at which ``passed`` substeps, whole ones and part of one, have gone by since sample k."""
    return (k + passed / shaking.substeps) * shaking.dt


class NextEvent(NamedTuple):
    """The next contact event in a step."""

    when: float  # time in the step [-], roots.NEVER if there is none
    # closed contact that opens, contact_states.GROUND or INTERFACE; 0 if contacts close
    fails: int
    closes1: bool  # whether the ground's contact closes
    closes2: bool  # whether the interface's does


@kernel
def _through_sample(body, shaking, k, contact_events, summary, work):
    """Take the state of ``work`` from sample k to the next one, from contact event to contact event.

    What is left of a substep is one step: its series are filled, the state follows them to the first contact event
    or to the end, the event changes the state, and the rest is a step again.
    """
    state, count = work.state, 0
    for sub in range(shaking.substeps):
        substep = _substep(body, shaking, k, sub)
        # part of the substep that has passed
        tau = 0.0
        # of so many that forcing has not ended them (:func:`_land`) the rest of the sample is left out
        while tau < 1.0 and count <= MAX_CONTACT_EVENTS_PER_STEP + 20:
            left = 1.0 - tau
            step = _rest_of(substep, tau)
            fill_series(body, state, step, work.series)
            contact_event = _next_contact_event(
                body, state, step, work.series, work.trial
            )
            at = min(1.0, contact_event.when)
            lifts = _follow(body, step, at, summary, work)
            if lifts != roots.NEVER and math.isnan(summary.lost_contact):
                clock = _clock(shaking, k, sub + tau + lifts * left)
                _note_lifting(body, clock, state, contact_events, summary)
            tau += at * left
            if contact_event.when > 1.0:
                break
            count += 1
            state.ground = substep.ground + substep.rise * tau
            state.gravity = substep.gravity + substep.lift * tau
            kind = _through_contact_event(
                body, shaking, (k, sub + tau), contact_event, count, summary, work
            )
            clock = _clock(shaking, k, sub + tau)
            record.keep_contact_event(
                body, clock, kind, work.before, state, contact_events, summary
            )


@kernel
def _note_lifting(body, clock, state, contact_events, summary):
    """Note that a normal force first vanishes at the time ``clock`` [s]; the state goes on unchanged."""
    summary.lost_contact = clock
    record.keep_contact_event(
        body, clock, record.LIFTING, state, state, contact_events, summary
    )


@kernel
def _through_contact_event(body, shaking, instant, contact_event, count, summary, work):
    """Take the state of ``work`` through a contact event; the state before it is left in ``work.before``.

    Parameters
    ----------
    body : record ``BODY``
    shaking : a :class:`Shaking`
    instant : a sample, and the substeps that have passed since [-]
    contact_event : a :class:`NextEvent`
    count : number of contact events since the sample, this one included
    summary : record ``SUMMARY``, changed in place
    work : record ``SCRATCH``, whose state has come to the instant

    Returns
    -------
    Kind of the contact event (``record.OPENING`` and its like).
    """
    state = work.state
    # contacts that close do so exactly, and what stands on an open contact turns with it
    if contact_event.fails == 0 and contact_event.closes1:
        state.theta1 = 0.0
    if contact_event.fails == 0 and (contact_event.closes2 or state.c2 == 0):
        state.theta2 = state.theta1
    record.copy_state(state, work.before)
    if contact_event.fails != 0:
        no_time_passed = contact_event.when == 0.0
        state.c1, state.c2 = contact_states.release(
            body, state, contact_event.fails, no_time_passed
        )
        return record.OPENING
    k, passed = instant
    forced = count > MAX_CONTACT_EVENTS_PER_STEP
    closes = contact_event.closes1, contact_event.closes2
    part = k, passed / shaking.substeps
    return _land(body, shaking, part, closes, forced, summary, work)


@kernel
def _follow(body, step, at, summary, work):
    """Move the state to the time ``at`` of its step [-]; note demands, extremes and the ground's work on the way.

    Returned is the time in the step [-] at which a normal force first vanishes, NEVER if none does
    (``record.note_demand``).
    """
    state, series = work.state, work.series
    _move(state, series, at, step.length)
    lifts = record.note_demand(body, step, series, at, work, summary)
    if state.c1 != 0 or state.c2 != 0:
        work.beyond = record.track(work.balances, state, summary)
        summary.work += record.work_of(body, state.c1, state.c2, series, at, step)
    return lifts


@kernel
def _land(body, shaking, instant, closes, forced, summary, work):
    """Take the state of ``work`` through the impact of the contacts that close, and return its kind.

    ``instant``: a sample and the part of the interval after it [-]; ``closes``: whether ground and interface
    close; ``forced``: contacts must stay closed, as there were too many contact events.
    """
    state, before = work.state, work.before
    k, part = instant
    summary.impacts += 1
    speed = abs(state.omega1 if closes[0] else state.omega2 - state.omega1)
    summary.grazings += 1 if speed < GRAZING_SPEED else 0
    ahead = Ahead(
        shaking.samples,
        shaking.vertical,
        shaking.scale,
        shaking.samples.size - 1,
        k,
        part,
        shaking.dt,
    )
    kind, gave_way = resolve_impact(
        body, state, closes, work.restoring, ahead, HISTORY, forced
    )
    summary.given_way += gave_way
    demand = summary.beyond if work.beyond else summary.demand
    # of a series of impacts that is ended at once the first one demands impulses as all do
    after = state
    if kind != record.CLOSING:
        after = _after_impact(body, before, closes, work.trial)
    ask_impulses(body, before, after, demand)
    return kind


@kernel
def _after_impact(body, before, closes, after):
    """Fill the STATE ``after`` an impact from momentum and restitution alone, and return it.

    Chatter that is closed at once (:func:`resolve_impact`) is left out; ``closes`` as of :func:`_land`.
    """
    record.copy_state(before, after)
    n1, n2, w1, w2, _ = impact(body, before, closes[0], closes[1])
    after.c1, after.c2, after.omega1, after.omega2 = n1, n2, w1, w2
    return after


@kernel
def _move(state, series, tau, h):
    """Move a state to the time ``tau`` [-] of its series over a step of ``h`` [s]."""
    first, two = series.one.angle, series.two.angle
    open1, open2 = state.c1 != 0, state.c2 != 0
    state.theta1 = roots.value(first, tau) if open1 else 0.0
    state.omega1 = roots.slope(first, tau) / h if open1 else 0.0
    state.theta2 = roots.value(two, tau) if open2 else state.theta1
    state.omega2 = roots.slope(two, tau) / h if open2 else state.omega1


@kernel
def resolve_impact(body, state, closes, restoring, ahead, chatter_tolerance, forced):
    """Take a state through an impact: momentum and restitution, then whatever of the chatter after it is closed.

    A contact that comes off slower than the closing speed stays closed, one that has met too often within a sample
    (``forced``) too, and impacts that are sure to end at rest are not followed (``docs/kernels.md``, "Accumulating
    impacts").

    Parameters
    ----------
    body : record ``BODY``
    state : record ``STATE`` just before the impact, changed in place
    closes : whether ground and interface close
    restoring : record ``chatter.RESTORING`` of the body
    ahead : the ground from now on, a :class:`Ahead`
    chatter_tolerance : a :class:`ChatterTolerance`
    forced : whether contacts that meet must stay closed

    Returns
    -------
    Kind of the contact event, ``record.CLOSING`` or ``record.CHATTER``; 1 if a law had to give way, otherwise 0.
    """
    closes1, closes2 = closes
    kind = record.CLOSING
    free1 = closes1 or state.c1 == 0
    free2 = closes2 or state.c2 == 0
    n1, n2, w1, w2, gave_way = impact(body, state, closes1, closes2)
    limit = math.inf if forced else chatter_tolerance.closing_speed
    slow1 = free1 and n1 != 0 and abs(w1) < limit
    slow2 = free2 and n2 != 0 and abs(w2 - w1) < limit
    if slow1 or slow2:
        n1 = 0 if slow1 else n1
        n2 = 0 if slow2 else n2
        w1, w2 = stuck(body, state, n1, n2)
        kind = record.CHATTER
    before = equations.kinetic_energy(body, state)
    state.c1, state.c2, state.omega1, state.omega2 = n1, n2, w1, w2
    level = state.theta1 == 0.0 and state.theta2 == 0.0
    speed = max(abs(w1), abs(w2))
    if (
        kind == record.CLOSING
        and level
        and (n1 != 0 or n2 != 0)
        and speed < restoring.fastest
    ):
        fraction = math.sqrt(equations.kinetic_energy(body, state) / before)
        safety = SAFETY_OF_BLOCKS if body.fixed else SAFETY_OF_STACKS
        if dies_out(speed, fraction, safety, restoring, chatter_tolerance.drop, ahead):
            state.c1, state.c2, state.omega1, state.omega2 = 0, 0, 0.0, 0.0
            kind = record.CHATTER
    if not forced:
        state.c1, state.c2 = contact_states.settle(body, state)
    return kind, gave_way


# --------------------------------------------------------------------------- finding the next contact event


@kernel
def _hold_at(body, contact, step, series, tau, trial):
    """Least contact moment [N m] of a closed contact at the time ``tau`` of a step, negative where it lets go.

    ``contact``: GROUND or INTERFACE; ``trial``: a STATE with the contacts of the step, moved to that time.
    """
    record.move_within(step, series, tau, trial)
    alpha = equations.accelerations(body, trial.c1, trial.c2, trial)
    return equations.hold(body, contact, (trial.c1, trial.c2), trial, alpha)[0]


@kernel
def _failing_time(body, contact, step, series, end, trial):
    """Find when in [0, end] of a step a closed contact would first have to be pulled; NEVER if it stays pressed.

    ``contact`` and ``trial`` as of :func:`_hold_at`. The instant is bracketed by the step's ends, or by its start
    and a dip between them, and found by regula falsi. A contact that is pulled at the start alone, as it may by
    rounding just after a contact event, and pressed from then to the end counts as pressed.
    """
    at_start = _hold_at(body, contact, step, series, 0.0, trial)
    at_end = _hold_at(body, contact, step, series, end, trial)
    high = end
    if at_end >= 0.0:
        # a parabola through the middle shows a dip between the ends
        middle = _hold_at(body, contact, step, series, 0.5 * end, trial)
        curve = 2.0 * (at_start + at_end - 2.0 * middle)
        if curve <= 0.0:
            return roots.NEVER
        vertex = -(4.0 * middle - 3.0 * at_start - at_end) / (2.0 * curve)
        if not 0.0 < vertex < 1.0:
            return roots.NEVER
        high = vertex * end
        at_end = _hold_at(body, contact, step, series, high, trial)
        if at_end >= 0.0:
            return roots.NEVER
    if at_start < 0.0:
        return 0.0
    bracket = (0.0, at_start, high, at_end, 0)
    for _ in range(200):
        if roots.is_narrow(bracket):
            break
        tau = roots.guess_between(bracket)
        bracket = roots.narrowed(
            bracket, tau, _hold_at(body, contact, step, series, tau, trial)
        )
    return roots.end_of(bracket)


@kernel
def fill_gap(series, contact, side):
    """Fill ``series.gap`` with the opening angle [rad] of a contact that opens to a ``side``, +1 or -1.

    Returned is the angle at the end of the step, negative if the contact has closed.
    """
    first, two, gap = series.one.angle, series.two.angle, series.gap
    end = 0.0
    for i in range(ORDER + 1):
        gap[i] = (
            side * first[i]
            if contact == contact_states.GROUND
            else side * (two[i] - first[i])
        )
        end += gap[i]
    return end


@kernel
def first_closing(c1, c2, series):
    """Find the first closing in a step of the open ones of the contacts ``c1`` (ground) and ``c2`` (interface).

    ``series.gap`` is used on the way. Returned are its time in the step, from 0 to 1, NEVER if none closes, and
    whether ground and interface close then.
    """
    when = roots.NEVER
    closes1 = False
    closes2 = False
    if c1 != 0:
        fill_gap(series, contact_states.GROUND, c1)
        when = roots.closing_time(series.gap, 1.0)
        closes1 = when <= 1.0
    if c2 != 0:
        fill_gap(series, contact_states.INTERFACE, c2)
        time = roots.closing_time(series.gap, min(1.0, when))
        if time < when:
            closes1 = False
            closes2 = True
            when = time
        elif closes1 and roots.value(series.gap, when) < CLOSED:
            closes2 = True
    return when, closes1, closes2


@kernel
def _next_contact_event(body, state, step, series, trial):
    """Return the :class:`NextEvent` of a step whose series are filled; ``trial`` is a STATE to work in."""
    c1, c2 = state.c1, state.c2
    when, closes1, closes2 = first_closing(c1, c2, series)
    trial.c1, trial.c2 = c1, c2
    fails = 0
    for contact in (contact_states.GROUND, contact_states.INTERFACE):
        open_ = c1 != 0 if contact == contact_states.GROUND else c2 != 0
        if open_ or (contact == contact_states.GROUND and body.fixed):
            continue
        time = _failing_time(body, contact, step, series, min(1.0, when), trial)
        if time < when:
            when = time
            fails = contact
    if fails != 0:
        closes1, closes2 = False, False
    return NextEvent(when, fails, closes1, closes2)
