"""Integrating one column through one motion, contact event by contact event, with friction and flight.

In: a record ``BODY``, a ground motion [m/s²] and a start. Out: ``outcome`` (a record ``OUTCOME``) and, where they
are kept, samples and contact events.

Theory: ``docs/contact.md``, "Accumulating contact events" and "Falls"; of columns ``docs/columns.md``.
"""

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rockfrag.base.arrays import fields, whole
from rockfrag.engines.compile.jit import entry_kernel, kernel
from rockfrag.engines.planar import impact
from rockfrag.engines.planar import step as stepping
from rockfrag.engines.planar.bonds import (
    count_broken,
    fill_rest_margins,
    note_breaking,
    note_loads,
    note_rest_loads,
)
from rockfrag.engines.planar.carried import (
    carried_energies,
    carry_along,
    is_carried,
    swings_on,
)
from rockfrag.engines.planar.records import MOST
from rockfrag.engines.planar.search import BONDED, mode_number, wall_number
from rockfrag.engines.planar.solve import (
    copy,
    end_of,
    look_at,
    solve_motion,
    solve_nearest,
)
from rockfrag.engines.planar.support import GUIDED, change_spring, note_stroke, slope
from rockfrag.engines.planar.ties import (
    change_ties,
    is_any_taut,
    least_tie_margin,
    note_tensions,
)
from rockfrag.engines.planar.walls import any_closed, note_forces
from rockfrag.engines.planar.witness import breaks_a_law
from rockfrag.engines.pure_rocking.kernels.single import Shaking
from rockfrag.laws.momentum import NUMBER as MOMENTUM

# contact events within a sample after which accumulating ones are ended ten times as coarsely, and again
MOST_CONTACT_EVENTS = 300
# contact events on the spot after which a step is taken without looking for more
MOST_IDLE = 30
# impulses on the spot after which a step is taken in any case, so that time goes on; fewer lose energy where ever
# coarser impacts end what repeats
MOST_JOLTS = 60
# margin of a step after contact events on the spot that is no small one [-]
LARGEST_FAILURE = 1e-3
BURST = 100.0  # margin at the end of a step beyond which a shorter one is taken [-] ...
LEAST_STEP = 1e-9  # ... down to this part of a sample
SHUT_GAP = 1e-11  # gap over the half width below which an end touches [-]
AT_REST = 1e-3  # speed over √(g b) below which what leans is at rest [-]
SPRUNG = 0.01  # error of a step with a taut tie over that of others [-]


SAMPLE = np.dtype(
    [
        *fields("q v", 3 * MOST),  # coordinates of the bodies and their rates
        # of each interface and, α = θ'', of each body
        *fields("slip normal shear alpha", MOST),
        *fields(
            "work friction_loss impact_loss tied"
        ),  # ledgers so far, as in WORK [J]
        *whole("mode"),
    ]
)
"""What is kept of a sample."""

CONTACT_EVENT = np.dtype(
    [
        *fields("time"),
        # its kind, the modes before and after, and whether a wall gave an impulse
        *whole("kind before after at_wall"),
        *fields("energy_before energy_after"),
        *fields("slip", MOST),
        # coordinates of the bodies, and their rates before and after
        *fields("q v_before v_after", 3 * MOST),
    ]
)
"""What is kept of a contact event."""

CHANGE, IMPACT, PARADOX, FALLEN, PASSING = 0, 1, 2, 3, 4
AT_WALL, TIED, BROKEN = 5, 6, 7
"""Kinds of contact events.

PASSING is a corner that passes an edge while nothing else changes, AT_WALL a change without an impulse at a wall
alone, TIED a tie that gets taut or slack, BROKEN a tie or a bond that breaks.
"""


Array = NDArray[np.float64]


class Kept(NamedTuple):
    """Tables that an integration fills as far as they have rows."""

    history: NDArray[Any]  # (n,) SAMPLE
    contact_events: NDArray[Any]  # (n,) CONTACT_EVENT


class Cases(NamedTuple):
    """Bodies × motions × scales, the scale running fastest."""

    bodies: NDArray[Any]  # (bodies,) BODY
    starts: Array  # (bodies, 2, 3 MOST) coordinates and velocities
    # horizontal, vertical: all motions end to end; ``vertical`` may be empty
    horizontal: Array
    vertical: Array
    offsets: NDArray[np.int64]  # (motions + 1,) where each begins
    dts: Array  # (motions,) sampling intervals [s]
    factors: Array  # (motions, scales)
    # substeps, free_samples: (bodies, motions)
    substeps: NDArray[np.int64]
    free_samples: NDArray[np.int64]
    # (bodies,) speed over √(g b) below which contacts stay closed after an impact [-]
    closing: Array


class Interval(NamedTuple):
    """From one sample of a motion to the next."""

    number: int  # of the first sample
    now: stepping.Instant
    late: stepping.Instant
    ground: stepping.Stretch
    substeps: int  # no step is longer than one of them


@entry_kernel
def integrate_cases(numbers, cases, nothing, w, outcomes):
    """Integrate the cases of some ``numbers``, and keep their outcomes; ``nothing`` is a KEPT without rows."""
    motions, scales = cases.factors.shape
    for number in numbers:
        b = number // (motions * scales)
        m = number // scales - b * motions
        begin, end = cases.offsets[m], cases.offsets[m + 1]
        up = cases.vertical[begin:end] if cases.vertical.size > 0 else cases.vertical
        shaking = Shaking(
            cases.horizontal[begin:end],
            up,
            cases.factors[m, number % scales],
            cases.dts[m],
            cases.substeps[b, m],
            cases.free_samples[b, m],
        )
        integrate(
            cases.bodies[b], shaking, cases.starts[b], cases.closing[b], nothing, w
        )
        look_at(cases.bodies[b], w, w.q)
        for k in range(cases.bodies[b].count):
            w.outcome.slip[k] = slip(cases.bodies[b], w, k)
        outcomes[number] = w.outcome


@entry_kernel
def integrate(p, shaking, start, closing, kept, w):
    """Integrate one column from ``start`` through its shaking and on until it rests or has fallen.

    Parameters
    ----------
    p : record BODY, the column
    shaking : a :class:`Shaking`
    start : coordinates and velocities that it begins with [m, rad; m/s, rad/s], shape (2, 3 MOST)
    closing : speed over √(g b) below which a contact stays closed after an impact [-]
    kept : a :class:`Kept`, what is kept of the history
    w : record WORK, the memory; tells the number of contact events

    Returns
    -------
    Number of samples done.
    """
    _begin(p, w, start)
    keeps = kept.history.shape[0] > 0
    now = _now(shaking, 0)
    _handle(p, w, now, closing, False, kept)
    if keeps:
        _keep(p, w, kept.history[0], now)
    done = 1
    shaken = shaking.samples.size - 1
    for i in range(shaken + shaking.free_samples):
        late = _now(shaking, i + 1)
        ground = stepping.Stretch(
            shaking.dt, now.ah, now.av, late.ah - now.ah, late.av - now.av
        )
        interval = Interval(i, now, late, ground, shaking.substeps)
        _cross_interval(p, w, interval, closing, kept)
        done = i + 2
        now = late
        if keeps:
            _keep(p, w, kept.history[i + 1], now)
        if w.outcome.overturned_body > 0:
            break
        if i >= shaken and _stays(p, w):
            break
    w.outcome.leaning = 1 if _leans(p, w) else 0
    return done


@kernel
def _stays(p, w):
    """Whether a column stays as it is over a ground at rest, or goes on as an isolator swings."""
    if w.resting == 1 or (w.is_stale == 0 and _lies_still(p, w)):
        return True
    return w.knows_rest == 1 and is_carried(p, w) and swings_on(p, w)


@kernel
def _cross_interval(p, w, interval, closing, kept):
    """Take a column from one sample of its motion to the next, or to its fall."""
    w.tau = 0.0
    w.met = 0
    while w.tau < 1.0 and w.outcome.overturned_body == 0:
        if w.resting == 1:
            _rest(p, w, interval, closing, kept)
        elif not (is_carried(p, w) and _carry_to_end(p, w, interval, kept)):
            w.knows_rest = 0
            _step(p, w, interval, closing, kept)


@kernel
def _instant(interval, tau):
    """Instant at a fraction of an interval."""
    ah, av = stepping.ground_at(interval.ground, tau)
    return stepping.Instant((interval.number + tau) * interval.ground.length, ah, av)


@kernel
def _rest(p, w, interval, closing, kept):
    """Take a column that rests to the end of an interval, or to the instant at which its rest ends."""
    if w.knows_rest == 0:
        _rest_margins(p, w)
        w.knows_rest = 1
    w.tau = _rest_ends(p, w, w.tau, interval.now, interval.late)
    if w.tau > 1.0:
        note_rest_loads(p, w, interval.late)
        return
    w.knows_rest = 0
    w.is_stale = 1
    # what fails is that all rests
    w.fails[:] = 0
    w.tie_fails[:] = w.spring_fails = 0
    first = w.row_of_rest // 4
    broken = w.whole[first] == BONDED
    w.fails[first, stepping.BREAK] = 1 if broken else 0
    _handle(p, w, _instant(interval, w.tau), closing, not broken, kept)
    w.met += 1
    if w.resting == 1:
        # it failed by rounding only
        w.tau += 1e-9


@kernel
def _carry_to_end(p, w, interval, kept):
    """Take what an isolator carries to the end of an interval; False if something else happens before."""
    if w.knows_rest == 0:
        _rest_margins(p, w)
        w.knows_rest = 1
    stretch = stepping.rest_of(interval.ground, w.tau)
    if not carry_along(p, w, stretch):
        return False
    if kept.history.shape[0] > 0:
        work, friction_loss, tied = carried_energies(p, w, stretch)
        w.work += work
        w.friction_loss += friction_loss
        w.tied += tied
    w.tau = 1.0
    w.is_stale = 1
    w.idle = w.jolts = 0
    _track(p, w)
    return True


@kernel
def _step(p, w, interval, closing, kept):
    """Take one step within an interval, which ends with its first contact event if it meets one."""
    keeps = kept.history.shape[0] > 0
    part, stretch, energies, at_end = _accurate_step(p, w, interval, keeps)
    when = 2.0
    if w.idle <= MOST_IDLE or at_end < -LARGEST_FAILURE:
        when = _contact_event_in_step(p, w, at_end, stretch)
    if w.idle > MOST_IDLE:
        # contact events that do not let time go on: leave them behind, or end them by an impulse where a step
        # would not be a small one; if many do not help, the step is taken all the same
        w.idle = 0
        w.forced += 1
        if w.jolts == MOST_JOLTS:
            when = 2.0
        if when <= 1.0:
            w.jolts += 1
            _end_repeating(p, w, _instant(interval, w.tau), closing, kept)
            return
    if when > 1.0:
        _end_step(p, w, part)
    else:
        if keeps:
            shorter = stepping.beginning(stretch, when)
            energies = stepping.take_step(p, w, shorter, True)
        impact.project(p, w)
        w.tau += when * part
        w.idle = w.idle + 1 if when < 1e-9 else 0
        w.jolts = w.jolts if w.idle > 0 else 0
        _meet(p, w, interval, closing, kept)
    work, friction_loss, tied = energies
    w.work += work
    w.friction_loss += friction_loss
    w.tied += tied
    _track(p, w)
    if not _is_known(p, w):
        w.outcome.paradoxes += 1
        w.outcome.overturned_body = p.count
    if w.outcome.overturned_body > 0:
        w.outcome.overturning_time = _instant(interval, w.tau).time


@kernel
def _accurate_step(p, w, interval, keeps):
    """Take a step that is short enough for its error, and for forces that grow within it.

    Parameters
    ----------
    p, w, interval : records, and the interval that the step lies in from ``w.tau`` on
    keeps : whether energies are added up

    Returns
    -------
    Its length as a fraction of the interval, its stretch, energies as of :func:`step.take_step` [J], and the least
    margin at its end [-].
    """
    tau, substeps, ground = w.tau, interval.substeps, interval.ground
    part = (math.floor(tau * substeps + 1e-9) + 1.0) / substeps - tau
    ah, av = stepping.ground_at(ground, tau)
    if w.is_stale == 1:
        look_at(p, w, w.q)
        solve_motion(p, w, w.q, w.v, ah, av)
        copy(p, w.out, w.a)
    stepping.start_step(p, w)
    accuracy = stepping.ERROR
    if p.is_held == 1 and is_any_taut(p, w):
        # springs are stiff, and their energy is given in the ledger
        accuracy *= SPRUNG
    while True:
        stretch = stepping.Stretch(
            part * ground.length, ah, av, part * ground.rise_h, part * ground.rise_v
        )
        energies = stepping.take_step(p, w, stretch, keeps)
        error = stepping.step_error(p, w, stretch.length)
        if part < stepping.SHORTEST or error <= accuracy:
            break
        part *= 0.5
    at_end = stepping.least_margin(p, w, w.q1, w.v1, True)
    while not at_end >= -BURST and part > LEAST_STEP:
        # sliding that jams: forces grow faster than the step sees
        part *= 0.125
        stretch = stepping.beginning(stretch, 0.125)
        energies = stepping.take_step(p, w, stretch, keeps)
        at_end = stepping.least_margin(p, w, w.q1, w.v1, True)
    return part, stretch, energies, at_end


@kernel
def _end_step(p, w, part):
    """Take the end of a step without a contact event as the state; the step is ``part`` of the interval."""
    copy(p, w.q1, w.q)
    copy(p, w.v1, w.v)
    copy(p, w.a1, w.a)
    w.is_stale = 0
    w.jolts = 0
    if p.is_held == 1:
        _note_holding(p, w)
    impact.project(p, w)
    w.tau += part
    if 1.0 - w.tau < 1e-12:
        w.tau = 1.0


@kernel
def _meet(p, w, interval, closing, kept):
    """Take a column through a contact event; many of them in one interval are ended more and more coarsely."""
    w.met += 1
    # by products: a page has no powers
    tens = 1.0
    for _ in range(w.met // MOST_CONTACT_EVENTS):
        tens *= 10.0
    coarser = closing * tens
    if w.met >= MOST_CONTACT_EVENTS:
        w.forced += 1
    _handle(p, w, _instant(interval, w.tau), coarser, False, kept)
    copy(p, w.out, w.a)
    w.is_stale = 0
    if w.met > 10 * MOST_CONTACT_EVENTS:
        w.tau = 1.0


@kernel
def _note_holding(p, w):
    """Keep the largest forces of walls, bonds and ties."""
    note_forces(p, w)
    note_loads(p, w)
    note_tensions(p, w)


@kernel
def _fastest(p, w):
    """Largest rate of the bodies."""
    fastest = 0.0
    for d in range(3 * p.count):
        fastest = max(fastest, abs(w.v[d]))
    return fastest


@kernel
def _lies_still(p, w):
    """Whether walls or ties hold what neither moves nor accelerates."""
    largest = 0.0
    for d in range(3 * p.count):
        largest = max(largest, abs(w.a[d]))
    still = _fastest(p, w) < 1e-9 * p.speed and largest < 1e-9 * p.g
    return p.is_held == 1 and still


@kernel
def _leans(p, w):
    """Whether a body that has not fallen rests beyond its balance, against a wall or in a tie."""
    if p.is_held == 0 or w.resting == 1 or w.outcome.overturned_body > 0:
        return False
    beyond = False
    for k in range(p.count):
        beyond = beyond or abs(w.q[3 * k + 2]) > _critical(p, w, k)
    held = is_any_taut(p, w) or any_closed(p, w)
    return held and beyond and _fastest(p, w) < AT_REST * p.speed


@kernel
def _critical(p, w, k):
    """Angle of body k beyond which it falls to the side to which it is turned [rad]."""
    return p.critical[k, 1] if w.q[3 * k + 2] > 0.0 else p.critical[k, 0]


@kernel
def _now(shaking, i):
    """Sample i of a motion."""
    ah, av = 0.0, 0.0
    if i < shaking.samples.size:
        ah = shaking.samples[i] * shaking.scale
        if shaking.vertical.size > 0:
            av = shaking.vertical[i] * shaking.scale
    return stepping.Instant(i * shaking.dt, ah, av)


@kernel
def _begin(p, w, start):
    """Set the start, and what is told of the case to nothing."""
    copy(p, start[0], w.q)
    copy(p, start[1], w.v)
    look_at(p, w, w.q)
    impact.lift_laws(p, w)
    w.slides[:] = w.touching[:] = w.fails[:] = w.whole[:] = 0
    w.taut[:] = w.tie_fails[:] = w.row_of_rest = 0
    for k in range(p.contacts):
        for end in range(2):
            _, _, _, _, gap, _, w.kind[k, end] = end_of(p, w, w.q, k, end, -1)
            w.closed[k, end] = 1 if gap < SHUT_GAP * p.size else 0
    w.work = w.friction_loss = w.impact_loss = w.tied = 0.0
    outcome = w.outcome
    outcome.leaning = 0
    outcome.hits[:] = 0
    outcome.largest_impulse[:] = outcome.largest_force[:] = 0.0
    outcome.breaking_time[:] = math.nan
    outcome.stroke[:] = math.nan
    for k in range(p.count):
        w.whole[k] = p.is_bonded[k] * w.closed[k, 0] * w.closed[k, 1]
    if p.is_supported == 1:
        w.whole[0] = GUIDED
        outcome.stroke[p.support_number] = 0.0
    w.yields = w.spring_fails = 0
    w.plastic = 0.0
    note_breaking(p, w, 0.0)
    least_tie_margin(p, w, w.q, w.v)
    outcome.peak_rotation[:] = outcome.peak_velocity[:] = outcome.peak_slip[:] = 0.0
    outcome.slid[:] = outcome.flights[:] = 0
    outcome.impacts = outcome.paradoxes = outcome.overturned_body = (
        outcome.parted_contact
    ) = 0
    outcome.several_modes = outcome.given_way = w.forced = w.met = w.resting = (
        w.noted
    ) = 0
    w.idle = w.jolts = w.knows_rest = 0
    w.is_stale = 1
    outcome.overturning_time = math.nan


@kernel
def _is_known(p, w):
    """Whether all of a state are numbers."""
    known = True
    for d in range(3 * p.count):
        known = known and math.isfinite(w.q[d]) and math.isfinite(w.v[d])
    return known


@kernel
def _track(p, w):
    """Keep the largest rotations, angular velocities and slips, and the stroke of an isolator."""
    note_stroke(p, w)
    for k in range(p.count):
        if not (w.closed[k, 0] and w.closed[k, 1]):
            # a body on its whole base is carried along
            part = abs(w.q[3 * k + 2]) / _critical(p, w, k)
            w.outcome.peak_rotation[k] = max(w.outcome.peak_rotation[k], part)
        w.outcome.peak_velocity[k] = max(
            w.outcome.peak_velocity[k], abs(w.v[3 * k + 2])
        )
        w.outcome.peak_slip[k] = max(w.outcome.peak_slip[k], abs(slip(p, w, k)))


@kernel
def _contact_event_in_step(p, w, at_end, stretch):
    """Fraction of the step at which something fails first; 2.0 if nothing does.

    State and ``w.fails`` are then those of that instant, on the quintic through the step.
    """
    high, at_high = 1.0 if at_end < 0.0 else 2.0, at_end
    by_force = stepping.force_fails(p, w)
    near = stepping.comes_near(p, w, stretch.length)
    for tau in (0.25, 0.5, 0.75):
        looks = tau == 0.5 and at_end < 0.02
        if near or looks:
            value = stepping.margin_at(p, w, tau, stretch, looks)
            if value < 0.0:
                high, at_high = tau, value
                by_force = looks and stepping.force_fails(p, w)
                break
    if high > 1.0:
        return 2.0
    return stepping.first_failure(p, w, (high, at_high, by_force), stretch)


@kernel
def _handle(p, w, now, closing, exclude, kept):
    """Change the mode at a contact event, whose failing channels are in ``w.fails``.

    Parameters
    ----------
    p, w : records ``BODY`` and ``WORK``
    now : its :class:`Instant <rockfrag.engines.planar.step.Instant>`
    closing : as in :func:`integrate`
    exclude : whether the old mode is known to fail
    kept : a :class:`Kept`
    """
    _remember(p, w)
    if _falls(p, w):
        _note(p, w, now.time, FALLEN, kept)
        return
    # what fails in ties, in a spring and in each contact, and which ends touch therefore
    look_at(p, w, w.q)
    broken = count_broken(p, w)
    kind = TIED if change_ties(p, w, now.time) else CHANGE
    change_spring(p, w)
    for k in range(p.contacts):
        fails, passes = _change_contact(p, w, k, now)
        exclude = exclude or fails
        kind = PASSING if passes else kind
    _shut(p, w)
    # ends that come down meet; then the mode that the forces allow is searched for
    if _is_hit(p, w):
        impact.strike(p, w, now.ah, now.av, closing * p.speed)
        kind = IMPACT
        exclude = False
    if not impact.settle(p, w, now.ah, now.av, exclude):
        # no mode is consistent (Painlevé): an impact without approach
        w.outcome.paradoxes += 1
        impact.strike_unapproached(p, w, now.ah, now.av, closing * p.speed)
        impact.settle(p, w, now.ah, now.av, False)
        kind = PARADOX
    if kind == IMPACT and _is_unlawful(p, w, closing):
        w.outcome.paradoxes += 1
    note_breaking(p, w, now.time)
    if count_broken(p, w) > broken and kind != IMPACT and kind != PARADOX:
        kind = BROKEN
    for k in range(p.count):
        w.outcome.flights[k] += w.old_closed[k].any() and not w.closed[k].any()
    _note(p, w, now.time, kind, kept)


@kernel
def _falls(p, w):
    """Whether a body falls; the first one, and the interface that is open furthest, are then written down."""
    for k in range(p.contacts):
        if w.fails[k, stepping.FALL] == 1:
            w.outcome.overturned_body = p.upper[k] + 1
            w.outcome.parted_contact = _parted(w, p.upper[k])
            return True
    return False


@kernel
def _change_contact(p, w, k, now):
    """Change what fails at contact k; whether the old mode cannot go on, and whether a corner passes an edge."""
    if w.fails[k, stepping.BREAK] == 1 and w.whole[k] == BONDED:
        solve_motion(p, w, w.q, w.v, now.ah, now.av)
        note_loads(p, w)
        w.whole[k] = 0
    fails, passes, leaves = False, False, -1
    for end in range(2):
        if w.closed[k, end] == 1 and w.fails[k, stepping.GAP + end] == 1:
            fails = True
        if w.closed[k, end] == 1 and w.fails[k, stepping.EDGE + end] == 1:
            passes = True
            if w.closed[k, 1 - end] == 1:
                w.kind[k, end] = 1 - w.kind[k, end]
            else:
                leaves = end
    if w.fails[k, stepping.FRICTION] == 1 and w.slides[k] == 0:
        fails = True
    elif w.fails[k, stepping.FRICTION] == 1:
        w.slides[k] = 0
        # what slip speed the step has left goes by an impulse: a shift of the speed could add energy
        solve_nearest(p, w, w.v)
        copy(p, w.out, w.v)
        impact.project(p, w)
        w.resting = 0
    _read_touching(p, w, k, leaves)
    return fails, passes


@kernel
def _read_touching(p, w, k, leaves):
    """Read which ends of contact k touch: closed ones and those without a gap, but for the end ``leaves``."""
    for end in range(2):
        w.touching[k, end] = w.closed[k, end]
        if w.closed[k, end] == 0:
            _, _, _, _, gap, _, kind = end_of(p, w, w.q, k, end, -1)
            if w.fails[k, stepping.GAP + end] == 1 or gap < SHUT_GAP * p.size:
                w.touching[k, end], w.kind[k, end] = 1, kind
    if leaves >= 0:
        w.touching[k, leaves] = 0
    if w.fails[k, stepping.BREAK] == 1 and k >= p.count:
        w.touching[k, :] = 0


@kernel
def _is_hit(p, w):
    """Whether an end that touches comes closer."""
    for k in range(p.contacts):
        for end in range(2):
            touches = w.touching[k, end] == 1
            if touches and impact.parting_speed(p, w, k, end) < -1e-13 * p.speed:
                return True
    return False


@kernel
def _is_unlawful(p, w, closing):
    """Whether an impact breaks a law that its contacts have."""
    plastic = True
    for k in range(p.count):
        plastic = plastic and p.law[k, 0] == MOMENTUM and p.law[k, 1] == MOMENTUM
    for k in range(p.count, p.contacts):
        plastic = plastic and p.bounce[k] == 0.0
    return breaks_a_law(p, w, closing, plastic)


@kernel
def _end_repeating(p, w, now, closing, kept):
    """End contact events that repeat at the beginning of a step by an impulse, as where no mode is consistent.

    Coordinates and velocities are those with which the step began; ``closing`` as in :func:`integrate`.
    """
    copy(p, w.q0, w.q)
    copy(p, w.v0, w.v)
    _remember(p, w)
    impact.touch_closed(p, w)
    look_at(p, w, w.q)
    impact.strike_unapproached(p, w, now.ah, now.av, closing * p.speed)
    impact.settle(p, w, now.ah, now.av, False)
    note_breaking(p, w, now.time)
    w.met += 1
    w.is_stale = 1
    _note(p, w, now.time, PARADOX, kept)


@kernel
def _remember(p, w):
    """Keep velocities and mode as they are before a contact event."""
    copy(p, w.v, w.old_v)
    w.hit[:] = 0.0
    w.hit_shear[:] = 0.0
    for k in range(p.contacts):
        w.old_slides[k] = w.slides[k]
        for end in range(2):
            w.old_closed[k, end] = w.closed[k, end]


@kernel
def _shut(p, w):
    """Set the gaps of touching ends to zero."""
    for k in range(p.count):
        if not w.touching[k].any():
            continue
        if w.touching[k].all():
            w.q[3 * k + 2] = w.q[3 * k - 1] if k > 0 else 0.0
        end = 0 if w.touching[k, 0] == 1 else 1
        look_at(p, w, w.q)
        _, _, tx, ty, gap, _, _ = end_of(p, w, w.q, k, end, w.kind[k, end])
        for body in range(k, p.count):
            w.q[3 * body] += gap * ty
            w.q[3 * body + 1] -= gap * tx
    for k in range(p.count, p.contacts):
        _keep_out(p, w, k)
    look_at(p, w, w.q)


@kernel
def _keep_out(p, w, k):
    """Shift a body that touches a wall, and what stands on it, out of the wall."""
    look_at(p, w, w.q)
    for end in range(2):
        if w.touching[k, end] == 1:
            _, _, tx, ty, gap, _, _ = end_of(p, w, w.q, k, end, w.kind[k, end])
            if gap < 0.0:
                for body in range(p.upper[k], p.count):
                    w.q[3 * body] += gap * ty
                    w.q[3 * body + 1] -= gap * tx


@kernel
def _rest_margins(p, w):
    """Margins of rest as linear functions of the two accelerations of what all stands on."""
    look_at(p, w, w.q)
    # what an isolator carries rests on its plate as if that were the ground
    slides, w.slides[0] = w.slides[0], 0
    for load in range(3):
        ah = 1.0 if load == 1 else 0.0
        av = 1.0 if load == 2 else 0.0
        solve_motion(p, w, w.q, w.v, ah, av)
        for k in range(p.count):
            if w.whole[k] == BONDED:
                fill_rest_margins(p, w, k, load)
                continue
            pressed = w.normal[k, 0] + w.normal[k, 1]
            hold = p.static[k] * pressed
            w.shear[k] += slope(p, w, w.q, k) * pressed
            unit = 1.0 / (p.weight * max(p.static[k], 1.0))
            w.rest[4 * k, load] = w.normal[k, 0] / p.weight
            w.rest[4 * k + 1, load] = w.normal[k, 1] / p.weight
            w.rest[4 * k + 2, load] = (hold - w.shear[k]) * unit
            w.rest[4 * k + 3, load] = (hold + w.shear[k]) * unit
            if w.whole[k] == GUIDED:
                # a plate is never lifted off
                w.rest[4 * k, load] = w.rest[4 * k + 1, load] = 1.0
    for row in range(4 * p.count):
        w.rest[row, 1] -= w.rest[row, 0]
        w.rest[row, 2] -= w.rest[row, 0]
    w.slides[0] = slides


@kernel
def _rest_ends(p, w, tau, early, late):
    """Fraction of the sample interval, from ``tau`` on, at which rest ends; 2.0 if it lasts."""
    when = 2.0
    for row in range(4 * p.count):
        margin = w.rest[row, 0] + w.rest[row, 1] * late.ah + w.rest[row, 2] * late.av
        if margin < 0.0:
            slope = w.rest[row, 1] * (late.ah - early.ah) + w.rest[row, 2] * (
                late.av - early.av
            )
            # accelerations, and so the margin, are linear: it vanishes at 1 - margin / slope
            if slope < 0.0 and max(tau, 1.0 - margin / slope) < when:
                when = max(tau, 1.0 - margin / slope)
                w.row_of_rest = row
    return when


@kernel
def _note(p, w, time, kind, kept):
    """Count a contact event, and write it if there is room."""
    before = mode_number(p, w.old_closed, w.old_slides)
    after = mode_number(p, w.closed, w.slides)
    at_walls = wall_number(p, w.old_closed, w.old_slides) != wall_number(
        p, w.closed, w.slides
    )
    if kind == CHANGE and before == after:
        if not at_walls:
            return
        kind = AT_WALL
    if w.noted < kept.contact_events.shape[0]:
        found = kept.contact_events[w.noted]
        found.time, found.kind, found.before, found.after = time, kind, before, after
        found.at_wall = 1 if w.hit.any() else 0
        found.energy_before = impact.kinetic_energy(p, w.old_v)
        found.energy_after = impact.kinetic_energy(p, w.v)
        copy(p, w.q, found.q)
        copy(p, w.old_v, found.v_before)
        copy(p, w.v, found.v_after)
        for k in range(p.count):
            found.slip[k] = slip(p, w, k)
    w.noted += 1


@kernel
def slip(p, w, k):
    """Slip of the corner that carries along interface k [m], after ``look_at`` with ``w.q``."""
    relative = w.q[3 * k + 2] - (w.q[3 * k - 1] if k > 0 else 0.0)
    end = 1 if relative >= 0.0 else 0
    x, _, _, _, _, beyond, _ = end_of(p, w, w.q, k, end, 1)
    if k == 0:
        return x - p.standing[0] - p.corner[0, end, 0]
    side = 2 * end - 1
    # as it stood: corner and face in the standing configuration
    at = 3 * k
    dx = p.standing[at] + p.corner[k, end, 0] - p.standing[at - 3] - p.face[k, 0]
    dy = p.standing[at + 1] + p.corner[k, end, 1] - p.standing[at - 2] - p.face[k, 1]
    along = dx * p.tilt_cos[k] - dy * p.tilt_sin[k]
    return side * (beyond + p.half[k]) - along


@kernel
def _parted(w, body):
    """Interface, from 1, that is open furthest under a body that falls."""
    widest, parted = -1.0, 0
    for k in range(body + 1):
        turned = abs(w.q[3 * k + 2] - (w.q[3 * k - 1] if k > 0 else 0.0))
        if turned > widest:
            widest, parted = turned, k + 1
    return parted


@kernel
def _keep(p, w, sample, now):
    """Fill a sample of the history."""
    look_at(p, w, w.q)
    solve_motion(p, w, w.q, w.v, now.ah, now.av)
    copy(p, w.q, sample.q)
    copy(p, w.v, sample.v)
    for k in range(p.count):
        sample.slip[k], sample.shear[k] = slip(p, w, k), w.shear[k]
        sample.normal[k] = w.normal[k, 0] + w.normal[k, 1]
        sample.alpha[k] = w.out[3 * k + 2]
    sample.work, sample.friction_loss, sample.impact_loss = (
        w.work,
        w.friction_loss,
        w.impact_loss,
    )
    sample.tied = w.tied
    sample.mode = mode_number(p, w.closed, w.slides)
