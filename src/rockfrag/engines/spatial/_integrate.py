"""One analysis: a body, a motion of the ground, contact event by contact event.

In: a record ``BODY``, accelerations of shape (n, 3) [m/s²], scales, a state to begin with. Out: outcomes and
counters, the state at the end and, if wanted, the history. Theory: ``docs/space.md``, "Steps" and "Derivations",
equations 18 to 25.

An interval is the time between two samples of the motion.

- ``y``: the state, changed in place; ``s``: record ``CASE``, with the mode; ``out``: the outcome, shape (OUTCOME,)
- ``tau``: time in an interval, ``dt`` its length, ``h`` a step [s]; ``rows``: the world's axes in the body
- ``gravity``: effective gravity in the world, equation 1; ``g``: that on ground at rest [m/s²]
- ``cut``: energy over rest at which a body rests, over that which a fall takes (``body.barrier``) [-]
"""

import math

from rockfrag.engines.algebra import vectors as algebra
from rockfrag.engines.compile.jit import entry_kernel, kernel
from rockfrag.engines.spatial import _at_rest as at_rest
from rockfrag.engines.spatial import _body as solid
from rockfrag.engines.spatial import _case as case
from rockfrag.engines.spatial import _contacts as contacts
from rockfrag.engines.spatial import _events as events
from rockfrag.engines.spatial import _forces as forces
from rockfrag.engines.spatial import _gaps as gaps
from rockfrag.engines.spatial import _ground as ground
from rockfrag.engines.spatial import _holders as holders
from rockfrag.engines.spatial import _limits as limits
from rockfrag.engines.spatial import _modes as modes
from rockfrag.engines.spatial import _outcome as outcome
from rockfrag.engines.spatial import _rim as rim
from rockfrag.engines.spatial import _step as step
from rockfrag.engines.spatial import _stepping as stepping

SHORTEST = 1e-11  # step [s]
NO_TIME = 1e-12  # part of an interval that is rounding [-]
STUCK = 100  # steps of no length in a row after which a step is forced
# velocity that closes contacts at most, however often it is doubled [m/s]
MOST_CLOSE = 1e-3
# step above which a contact is looked for that touched inside of it alone [s]
LOOKS_INSIDE = 1e-7
# step that is forced at most [s]; tilt below which a wobble that cannot be followed lies flat [rad]
FORCED, NEXT_TO_FLAT = 1e-6, 1e-3
# contact events in one interval after which the velocity that closes contacts is doubled
MANY = 40
# steps in one interval after which errors of COARSE [m, m/s, rad/s] are allowed to what slides: slip that hardly
# begins is stiff.  What rolls keeps its tolerance, as it may pass near flat, where such errors feed energy
HURRY, COARSE = 1000, 1e-6
# steps in one interval after which a body that is next to flat is laid flat; after twice as many more the interval
# ends.  Both are counted as paradoxes
GIVE_UP = 2000
# contact events in one interval beside walls after which the rest of it is passed by time stepping, and where the
# one before was; and so many times that steps
RESTLESS, AGAIN, STIFF = 24, 6, 4
PATIENCE = 30  # times that this may happen before an analysis ends as one that stood
# after which an analysis ends as one that stood, counted as a paradox
MOST_STEPS = 400_000
# intervals on ground at rest in which a body that walls or ties hold hardly moves, after which it is at rest
STILL = 20


@entry_kernel
def integrate_scales(
    bodies,
    acceleration,
    peaks,
    scales,
    dt,
    g,
    extra,
    tolerance,
    cut,
    ends,
    history,
    outs,
    counts,
    cases,
):
    """Integrate one analysis after the other, at each of several scales, as :func:`integrate` does.

    Parameters
    ----------
    bodies, cases : records of ``body`` and ``s`` there, in arrays of one, which are quicker to pass, shape (1,)
    acceleration, dt, g, extra, tolerance, cut, history : as there
    peaks : takes what is asked for there, shape (n, 4)
    scales : of the motion, shape (scales,) [-]
    ends : states to begin with, and then those at the end, shape (scales, SIZE)
    outs : takes the outcomes, shape (scales, OUTCOME)
    counts : takes the counters, shape (scales, COUNTERS)
    """
    body, s = bodies[0], cases[0]
    ground.fill_peaks(acceleration, peaks)
    for k in range(scales.shape[0]):
        integrate(
            body,
            acceleration,
            peaks,
            scales[k],
            dt,
            g,
            extra,
            tolerance,
            cut,
            ends[k],
            history,
            outs[k],
            s,
        )
        for i in range(limits.COUNTERS):
            counts[k, i] = s.counters[i]


@kernel
def integrate(
    body, acceleration, peaks, scale, dt, g, extra, tolerance, cut, y, history, out, s
):
    """Integrate one analysis of a body from the state ``y``; it ends ``extra`` intervals after the motion at most.

    Parameters
    ----------
    body : record ``BODY``
    acceleration : of the ground (x, y, up), linear between samples, shape (n, 3) [m/s²]
    peaks : largest horizontal and vertical ones from each sample on, and of the next WINDOW, shape (n, 4)
    scale : of both [-]
    dt : interval of the samples [s]
    g : acceleration of gravity [m/s²]
    extra : intervals after the motion at most
    tolerance : error of a step [m, m/s, rad/s]
    cut : energy at which a body rests, over what a fall takes [-]
    y : state, shape (SIZE,), changed in place
    history : takes a sample of each interval, as many as fit, shape (m, COLUMNS)
    out : takes the outcome, shape (OUTCOME,)
    s : record ``CASE`` to work in, whose counters tell the contact events afterwards
    """
    started = solid.energy(body, y, g)
    start = solid.position_of_base(y, algebra.rotation(y), (0.0, 0.0, -body.height))
    before = outcome.heading(y)
    begin(body, acceleration, scale, dt, g, y, out, s)
    last = acceleration.shape[0] - 1
    stuck = lost_track = still = 0
    patience = RESTLESS
    ahead = dt
    k = 0
    while k <= last + extra:
        skips = s.rests == 1 and s.bonded == 0 and k + ground.WINDOW <= last
        if skips and at_rest.rests_on(body, y, peaks, k, scale, g, s):
            for _ in range(ground.WINDOW):
                outcome.record(history, k, y, before, out, s)
                k += 1
            continue
        ground.set_field(s.field, acceleration, k, scale, dt, g)
        s.began = k * dt
        ground.note_soon(s, peaks, k, scale, dt)
        outcome.record(history, k, y, before, out, s)
        if k > last:
            still = still + 1 if hardly_moves(body, y, cut) else 0
            free = body.constraints == 0 and solid.energy(body, y, g) < body.barrier
            if s.rests == 1 or free or still > STILL:
                # on a ground at rest it stands, has too little energy left to fall, or leans and does not move
                break
        if s.bonded:
            holders.note_bond(body, y, 0.0, s)
        ahead, stuck, patience, lost = cross_interval(
            body, dt, y, tolerance, cut, ahead, stuck, patience,
            peaks[min(k, last)], scale, (k + 1) * dt, out, s,
        )  # fmt: skip
        lost_track += lost
        if solid.is_known(y):
            outcome.note_walk(body, y, start, out)
            before = outcome.note_turn(y, before, out)
        fell, many = out[outcome.FELL] > 0, out[outcome.STEPS] > MOST_STEPS
        if fell or many or lost_track > PATIENCE:
            break
        k += 1
    if out[outcome.FELL] == 0.0:
        outcome.record(history, k, y, before, out, s)
    if solid.is_known(y):
        out[outcome.TURN] += outcome.turn_since(before, y)
    finish(body, y, started, g, out, s)


@kernel
def begin(body, acceleration, scale, dt, g, y, out, s):
    """Begin an analysis: outcome and counters at 0, the body bonded or in the mode that its state asks for."""
    for i in range(outcome.OUTCOME):
        out[i] = 0.0
    for i in range(limits.COUNTERS):
        s.counters[i] = 0
    out[outcome.CERTAIN_TIME] = math.nan
    ground.set_field(s.field, acceleration, 0, scale, dt, g)
    s.count = s.rests = s.jammed = s.goes_on = 0
    s.beyond = 0.0
    holders.begin_holding(body, y, s)
    if s.bonded:
        gaps.come_to_rest(body, y, s)
    else:
        modes.choose_mode(body, 0.0, y, s)
        rim.rim_instead_of_feet(body, y, case.effective_gravity_at(s.field, 0.0), s)
    contacts.anchor_all(body, y, s)


@kernel
def finish(body, y, started, g, out, s):
    """Write what is known at the end: how it stands, what held it, and what the energy since the start leaves."""
    out[outcome.BEYOND] = s.beyond
    out[outcome.LEANS] = (
        out[outcome.FELL] == 0.0 and body.constraints > 0 and outcome.is_beyond(body, y)
    )
    for i in range(solid.HOLDERS):
        at = outcome.HELD + outcome.OF_HOLDER * i
        out[at], out[at + 1] = s.hits[i], s.impact[i]
        out[at + 2], out[at + 3] = s.force[i], s.breaks[i]
    out[outcome.ENERGY_BALANCE] = (
        solid.energy(body, y, g)
        - started
        - y[solid.WORK]
        + y[solid.FRICTION]
        + out[outcome.LOST]
    )


@kernel
def cross_interval(
    body, dt, y, tolerance, cut, ahead, stuck, patience, soon, scale, ends, out, s
):
    """Integrate to the end of an interval, or to a fall.

    Parameters
    ----------
    ahead : longest step that is tried first [s]
    stuck : steps of no length in a row that came before
    patience : contact events after which the interval is passed by time stepping, beside walls
    soon : largest accelerations from here on, a row of ``peaks``
    ends : time of the motion at the end [s]

    Returns
    -------
    The first three for the next interval, and how often the body could not be followed.
    """
    tau = 0.0
    many = lost_track = 0
    began = out[outcome.CONTACT_EVENTS]
    seen = began
    s.close = limits.CLOSE
    while dt - tau > NO_TIME * dt:
        if case.kind_of(s) == case.REST:
            tau = wait(body, tau, dt, y, out, s)
            if tau < 0:
                break
            ahead = dt
        hurries = many >= HURRY and events.slides_any(s)
        allowed = max(tolerance, COARSE) if hurries else tolerance
        tau, ahead, h = advance(body, tau, dt, ahead, y, allowed, cut, stuck, s, out)
        stuck = stuck + 1 if h < SHORTEST else 0
        many += 1
        changes = max(out[outcome.CONTACT_EVENTS] - began, many / STIFF)
        is_left = dt - tau > NO_TIME * dt
        if is_left and changes >= patience and solid.meets_walls_alone(body):
            outcome.note_loss(stepping.pass_interval(body, tau, dt, y, s), out)
            tau = dt
            patience = AGAIN
        if out[outcome.STEPS] > MOST_STEPS:
            s.counters[limits.UNSOLVED] += 1
            break
        if many % GIVE_UP == 0:
            s.goes_on = 0
            outcome.note_loss(give_up(body, tau, y, s), out)
            lost_track += 1
            if many > 2 * GIVE_UP:
                break
        if out[outcome.CONTACT_EVENTS] - seen >= MANY:
            seen = out[outcome.CONTACT_EVENTS]
            s.close = min(2.0 * s.close, MOST_CLOSE)
        if stuck > STUCK:
            # nothing is consistent here: let the motion go on as it is for a moment
            tau = force_step(body, tau, dt, y, s)
            stuck = 0
        if falls(body, y, soon, scale, out, s):
            outcome.note_fall(y, s, ends, out)
            break
    return ahead, stuck, RESTLESS if many < AGAIN else patience, lost_track


@kernel
def wait(body, tau, dt, y, out, s):
    """Let a body rest until it moves, or its bond breaks and it moves; return when, or -1 if it does not [s]."""
    tau = at_rest.rest_ends(body, y, s, tau, dt)
    if tau >= 0 and s.bonded:
        holders.note_bond(body, y, tau, s)
        # what is left is an ordinary contact
        s.bonded, s.breaks[solid.BOND] = 0, s.began + tau
        is_left = dt - tau > NO_TIME * dt
        tau = at_rest.rest_ends(body, y, s, tau, dt) if is_left else -1.0
    if tau < 0:
        return -1.0
    s.goes_on = 0
    g = s.field[case.GRAVITY]
    standing = solid.balance(body, y, g)
    at_rest.leave_rest(body, y, tau, s)
    outcome.note_loss(standing - solid.balance(body, y, g), out)
    return -1.0 if case.kind_of(s) == case.REST else tau


@kernel
def falls(body, y, soon, scale, out, s):
    """Whether a body lies down, or can only fall, or its state is no number any more; note its peaks."""
    if not solid.is_known(y):
        s.counters[limits.UNSOLVED] += 1
        return True
    rows = algebra.rotation(y)
    outcome.note_peaks(body, y, rows, out)
    g = s.field[case.GRAVITY]
    return rows[2][2] <= 0.0 or outcome.fall_is_certain(body, y, rows, soon, scale, g)


@kernel
def advance(body, tau, dt, next_step, y, tolerance, cut, stuck, s, out):
    """Take one step of an interval, up to its end or to what happens first.

    ``next_step`` is the longest that is tried [s], ``tolerance`` the error allowed to it. Returned are the time in
    the interval, the next step and the length of this one [s].
    """
    g = s.field[case.GRAVITY]
    step.begin(body, tau, y, s)
    # equal steps to the end of the interval, where the ground's acceleration has a kink
    h = (dt - tau) / math.ceil((dt - tau) / next_step)
    most = 5.0
    while True:
        error = step.attempt(body, tau, h, y, s)
        out[outcome.STEPS] += 1
        if error <= tolerance or h <= SHORTEST:
            least, what = step.margin(body, s.new, s)
            # a corner that has dipped into a wall does not count at the end of a step, whatever else happens there
            hides = least >= 0 or body.walls
            if hides and h > LOOKS_INSIDE and step.dips(body, y, h, s):
                h *= 0.5
                continue
            break
        h *= max(0.2, 0.9 * slow_power(tolerance / error))
        # else the next step would be rejected too
        most = 1.0
    grow = most
    if error > 1e-4 * tolerance:
        # of less the growth is five times in any case
        grow = min(most, max(0.3, 0.9 * slow_power(tolerance / error)))
    ahead = h * grow
    if least < 0:
        h, what = events.locate(body, tau, h, y, s)
    else:
        what = limits.NOTHING
    exact = step.kind_of_step(body, s) != case.GENERAL
    if exact and body.rim > 0:
        outcome.note_loss(
            solid.balance(body, y, g) - solid.balance(body, s.new, g), out
        )
    for i in range(solid.SIZE):
        y[i] = s.new[i]
    if body.constraints > 0:
        holders.note_forces(body, y, s)
    if what != limits.NOTHING:
        out[outcome.CONTACT_EVENTS] += 1
        outcome.note_loss(events.happen(body, what, tau + h, y, cut, stuck, s), out)
        return tau + h, dt, h
    if not exact:
        before = solid.energy(body, y, g)
        gaps.settle(body, y, s)
        if body.walls:
            # contacts that are wedged may be raised
            solid.pay(body, y, solid.energy(body, y, g) - before)
        outcome.note_loss(before - solid.energy(body, y, g), out)
    # whether the rates at the end of a step are those at the beginning of the next
    sticks = case.kind_of(s) in (case.FLIGHT, case.PIVOT, case.HINGE)
    s.goes_on = exact or (sticks and body.rim == 0.0)
    if body.rim > 0:
        ahead = rim.look_after_rim(body, y, tau + h, cut, ahead, s, out)
    return tau + h, ahead, h


@kernel
def slow_power(x):
    """Return x to the power 3/16, next to the 1/5 of the order, by square roots: the same bits everywhere."""
    root = math.sqrt(math.sqrt(math.sqrt(x)))
    return root * math.sqrt(root)


@kernel
def hardly_moves(body, y, cut):
    """Whether a body that walls or ties hold has less energy of motion than is followed."""
    return body.constraints > 0 and solid.kinetic_energy(body, y) < cut * body.barrier


@kernel
def give_up(body, tau, y, s):
    """End a wobble that cannot be followed any more, which counts as a problem; return the energy lost [J/kg]."""
    before = solid.energy(body, y, s.field[case.GRAVITY])
    s.counters[limits.UNSOLVED] += 1
    up = algebra.rotation(y)[2]
    if body.rim > 0 and algebra.norm(up[0], up[1]) < NEXT_TO_FLAT:
        y[solid.UPWARD] = y[solid.SPIN] = y[solid.SPIN + 1] = 0.0
        gaps.lay_flat(body, y)
    if not modes.choose_mode(body, tau, y, s):
        contacts.jam(body, y, s)
    return before - solid.energy(body, y, s.field[case.GRAVITY])


@kernel
def force_step(body, tau, dt, y, s):
    """Take a short step whatever the margins say, which counts as a problem; return the time after it [s]."""
    h = min(FORCED, dt - tau)
    s.goes_on = 0
    forces.rates(body, tau, y, s.slopes[0], s)
    while step.attempt(body, tau, h, y, s) > COARSE * 1e-3 and h > SHORTEST:
        h *= 0.25
    for i in range(solid.SIZE):
        y[i] = s.new[i]
    algebra.normalise(y)
    s.counters[limits.UNSOLVED] += 1
    return tau + h
