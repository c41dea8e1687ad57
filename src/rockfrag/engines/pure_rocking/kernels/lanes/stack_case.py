"""The life of a stack's case, a CASE record: taken, at rest, in a lane, through its contact events, and put down.

``place_one``, ``store_one`` and their like carry it in and out of lanes of one rotation and of two.

In: records CASE, and the lanes. Out: the same after a step or a contact event. Docs: ``docs/kernels.md``, "One
impact of one stack, from `overturns` to the outcome".
"""

import math
from collections import namedtuple
from typing import Any

import numpy as np

from rockfrag.base.arrays import fields, whole
from rockfrag.engines.compile.by_reference import by_reference
from rockfrag.engines.compile.jit import inlined_kernel, kernel, lowest_bit, take_next
from rockfrag.engines.pure_rocking.kernels import chatter, contact_states, equations
from rockfrag.engines.pure_rocking.kernels.impact import ground_impact, interface_impact
from rockfrag.engines.pure_rocking.kernels.lanes import case as lanes
from rockfrag.engines.pure_rocking.kernels.lanes import (
    stack_constants,
    stack_one,
    stack_two,
)
from rockfrag.engines.pure_rocking.kernels.roots import slope, value
from rockfrag.engines.pure_rocking.kernels.single import (
    MAX_CONTACT_EVENTS_PER_STEP,
    resolve_impact,
)
from rockfrag.engines.pure_rocking.kernels.taylor import SERIES, quick_sine_cosine

# cases in flight, so that lanes of one kind or the other can always be filled
SLOTS = 2 * lanes.LANES

CASE = np.dtype(
    [
        *whole("number slot body"),  # number of the case, -1 for none
        # sampling interval [s], the largest part of it that a step of two rotations may take, and the scale
        *fields("interval part factor"),
        # ground accelerations between which the body rests, and the least energy that overturns it
        *fields("low high barrier"),
        # samples: of its motion the first and the last, the last of free rocking, and the one it has reached
        *whole("first last free_last k"),
        *fields("tau"),  # time since then
        *whole("c1 c2"),  # the state, with rates per sample
        *fields("theta1 omega1 theta2 omega2"),
        *fields("gravity"),  # of a ground that does not move vertically
        # of its last contact event the ground acceleration, gravity over the above, the sample, and how many that
        # has had
        *fields("ground weight"),
        *whole("counted_sample contact_events"),
        *fields("peak1 peak2 fast near"),  # extremes so far, as in the lanes
        *whole("impacts given_way fallen"),  # what fell: 1 the pedestal, 2 the statue
    ],
    align=True,
)
"""A case in flight; time is counted in samples."""


MEMORY = np.dtype(
    [
        *fields("one", of=stack_one.LANE),
        *fields("two", of=stack_two.LANE),
        *fields("cases", SLOTS, of=CASE),
        *whole("waiting", 2, SLOTS),  # slots that wait for a lane of either kind
        *whole("waits busy", 2),  # how many wait, and how many lanes are taken
        # constants of the slots' bodies in every contact state
        *fields("ones", SLOTS, 9, of=stack_constants.ONE),
        *fields("twos", SLOTS, 9, of=stack_constants.TWO),
        *fields("impacts", SLOTS, 9, of=stack_constants.IMPACT),
        *fields("restoring", SLOTS, of=chatter.RESTORING),
        # of the steps that contact events are looked for in
        *fields("series", lanes.LANES, of=SERIES),
        *fields("state", of=equations.STATE),  # of a case, with rates per second
    ],
    align=True,
)
"""Memory that a thread works in."""

Worker = by_reference(namedtuple("Worker", MEMORY.names))  # type: ignore[arg-type]
"""The parts of that memory."""


def worker() -> Any:
    """Memory for one thread."""
    memory = np.zeros(1, MEMORY)[0]
    return Worker(*(memory[name] for name in MEMORY.names))


@kernel
def begin(worker):
    """Set the memory to that of a thread that has not taken a case yet."""
    for i in range(lanes.LANES):
        worker.one.slot[i] = worker.two.slot[i] = -1
        # these are written only where the ground moves vertically
        worker.one.was_weight[i] = worker.one.before_weight[i] = 1.0
        worker.two.was_weight[i] = 1.0
    for slot in range(SLOTS):
        case = worker.cases[slot]
        case.number, case.body, case.slot = -1, -1, slot
    for kind in range(2):
        worker.waits[kind] = worker.busy[kind] = 0


# --------------------------------------------------------------------------- phases of a case

NO_CASE, ONE_ROTATES, BOTH_ROTATE = -1, 0, 1  # what lane a case needs


@inlined_kernel
def lane_of(case):
    """Kind of lane that a case needs: ONE_ROTATES, BOTH_ROTATE, or NO_CASE."""
    if case.number < 0:
        return NO_CASE
    return BOTH_ROTATE if case.c1 != 0 and case.c2 != 0 else ONE_ROTATES


@inlined_kernel
def rocks_on(case):
    """Whether a case goes on in a lane: it has not fallen, does not rest, and its motion is not over."""
    return case.fallen == 0 and case.k < case.last and (case.c1 != 0 or case.c2 != 0)


@kernel
def next_case(case, ensemble, motions, worker, outcomes):
    """Take the case of a slot through rest and the end of its motion until it rocks, or no case is left.

    A case that ends on the way is written into ``outcomes``, and the slot takes the next one; ``case.number`` is
    -1 where there is none.
    """
    while True:
        if case.number >= 0:
            if case.fallen == 0 and _rocks_again(case, ensemble, motions, worker.state):
                return
            _put_down(case, outcomes[case.number])
        number = take_next(ensemble.counter)
        if number >= ensemble.count:
            case.number = -1
            return
        _take_up(case, number, ensemble, motions, worker)


@kernel
def _rocks_again(case, ensemble, motions, state):
    """Take a case that has not fallen to where it rocks next, and return whether it does before it ends.

    ``state`` is a record STATE to work in.
    """
    body = ensemble.bodies[case.body]
    if case.c1 == 0 and case.c2 == 0:
        # at rest, until the ground lifts it
        return _lift_off(case, body, motions, state)
    if case.k < case.last:
        return True
    # free rocking goes on for as long as its energy may overturn the body
    to_state(case, state)
    return case.k < case.free_last and not _is_safe(body, state, case.barrier)


@kernel
def _lift_off(case, body, motions, state):
    """Take a case at rest to the next instant at which its motion lifts it, and return whether there is one."""
    if case.k >= case.last or case.factor == 0.0:
        return False
    k, tau, ground, weight = lanes.next_uplift(
        motions, case.k, case.tau, case.last, case.factor, (case.low, case.high)
    )
    if k < 0:
        return False
    case.k, case.tau, case.ground, case.weight = k, tau, ground, weight
    case.theta1, case.omega1, case.theta2, case.omega2 = 0.0, 0.0, 0.0, 0.0
    to_state(case, state)
    case.c1, case.c2 = contact_states.uplift(body, state)
    return True


@kernel
def _is_safe(body, state, least):
    """Whether nothing can fall once the ground is still: energy cannot grow, and is less than ``least`` [J]."""
    if (
        equations.kinetic_energy(body, state) + equations.potential_energy(body, state)
        >= least
    ):
        return False
    # low energy on this side of balance, not beyond it
    c1, c2 = state.c1, state.c2
    if c2 != 0 and c2 * state.theta2 >= equations.balance(body, 0, c2)[0]:
        return False
    return c1 == 0 or c1 * state.theta1 < equations.balance(body, c1, c2)[0]


@inlined_kernel
def _put_down(case, outcome):
    """Write what remains of a case into a record OUTCOME."""
    outcome.fallen = case.fallen
    outcome.certain = case.k - case.first
    outcome.peak1, outcome.peak2 = case.peak1, case.peak2
    outcome.fast, outcome.unstable_distance = case.fast, math.sqrt(case.near)
    outcome.impacts, outcome.given_way = case.impacts, case.given_way


@kernel
def _take_up(case, number, ensemble, motions, worker):
    """Begin the case of a ``number`` in a slot, at rest; fill its body's constants, unless they are there."""
    body, motion, scale = lanes.place_of(number, ensemble)
    h = ensemble.intervals[body, motion]
    slot = case.slot
    if case.body != body or case.interval != h:
        record, scratch = ensemble.bodies[body], worker.state
        stack_constants.fill_constants(
            record,
            h,
            worker.ones[slot],
            worker.twos[slot],
            worker.impacts[slot],
            scratch,
        )
        chatter.fill_restoring(record, worker.restoring[slot], scratch)
        case.low, case.high = contact_states.rest_interval(record, scratch)
        case.barrier = equations.barrier(record)
    case.number, case.body, case.interval = number, body, h
    case.gravity, case.weight = ensemble.bodies[body].gravity, 1.0
    case.part = ensemble.parts[body, motion]
    case.factor = ensemble.factors[motion, scale]
    sampled = ensemble.rows[body, motion]
    case.first, case.last = motions.offsets[sampled], motions.lasts[sampled]
    case.free_last = case.last + ensemble.free[body, motion]
    case.k, case.tau = case.first, 0.0
    case.c1, case.c2, case.fallen, case.counted_sample = 0, 0, 0, -1
    case.impacts, case.given_way = 0, 0
    case.peak1, case.peak2, case.fast, case.near = 0.0, 0.0, 0.0, math.inf


@kernel
def to_state(case, state):
    """Write a case's state into a record STATE, with rates per second."""
    h = case.interval
    state.c1, state.c2, state.ground = case.c1, case.c2, case.ground
    state.gravity = case.weight * case.gravity
    state.theta1, state.omega1 = case.theta1, case.omega1 / h
    state.theta2, state.omega2 = case.theta2, case.omega2 / h


@inlined_kernel
def _ahead(case, motions):
    """Return the ground from the case's instant on, a ``chatter.Ahead``."""
    return chatter.Ahead(
        samples=motions.samples,
        vertical=motions.vertical,
        factor=case.factor,
        last=case.last,
        k=case.k,
        tau=case.tau,
        dt=case.interval,
    )


# --------------------------------------------------------------------------- contact events


@kernel
def contact_event_of_one(i, case, worker, ensemble, motions, g):
    """Take a case in lane i of those of one rotation through its contact event, or to the step's end.

    Returned is whether ground and interface close and ``general_impact`` has still to say what comes of it.
    """
    lane, series = worker.one, worker.series[i]
    if lane.flag[i] == lanes.RELEASE and lane.has_before[i] == 1.0:
        # it let go in the sample before
        stack_one.go_back(lane, i, g, motions.vertical.size > 0)
        case.k -= 1
    stack_one.take_series(lane, i, series)
    c1, c2 = case.c1, case.c2
    left = lane.was_left[i]
    constants = worker.ones[case.slot, equations.number_of(c1, c2)]
    when, fails = stack_one.next_contact_event(constants, lane, i, series, g)
    at = min(1.0, when)
    _move_one(i, case, lane, series, at)
    case.tau = 1.0
    if when > 1.0:
        return False, False
    # part of the sample's interval that has passed at the contact event
    case.tau -= left * (1.0 - at)
    case.ground, case.weight = stack_one.ground_and_weight_at(lane, i, at)
    body = ensemble.bodies[case.body]
    _count_contact_event(case)
    if fails:
        to_state(case, worker.state)
        contact = contact_states.GROUND if c1 == 0 else contact_states.INTERFACE
        case.c1, case.c2 = contact_states.release(
            body, worker.state, contact, at == 0.0
        )
        return False, False
    case.impacts += 1
    case.theta1, case.theta2 = 0.0, 0.0
    if _forced(case) or not _impact_alone(case, worker, body, g, motions):
        return c1 != 0, c2 != 0
    return False, False


@inlined_kernel
def _move_one(i, case, lane, series, at):
    """Move a case in lane i of those of one rotation to the time ``at`` [-] of its step, with extremes so far."""
    theta = value(series.one.angle, at)
    omega = slope(series.one.angle, at) / lane.was_left[i]
    peak, case.fast, case.near = stack_one.nearest(lane, i, theta, omega)
    if case.c2 == 0:
        # both turn as one
        case.peak1 = peak
        case.theta1, case.omega1 = theta, omega
    else:
        case.peak2 = peak
        case.theta1, case.omega1 = 0.0, 0.0
    case.theta2, case.omega2 = theta, omega


@kernel
def find_contact_events_of_two(stops, worker):
    """Find contact events of lanes of two rotations before any goes through one (``block._find_impacts``).

    ``stops`` has a bit for each lane that stops.
    """
    lane = worker.two
    while stops != 0:
        i = lowest_bit(stops)
        stops &= stops - 1
        if lane.slot[i] >= 0 and lane.flag[i] > lanes.QUIET:
            case, series = worker.cases[lane.slot[i]], worker.series[i]
            stack_two.take_series(lane, i, series)
            lane.when[i], lane.closes1[i], lane.closes2[i] = (
                stack_two.next_contact_event(case.c1, case.c2, lane.flag[i], series)
            )


@kernel
def contact_event_of_two(i, case, worker, ensemble, motions, g):
    """Take a case in lane i of those of two rotations through the contact event found, or to the step's end.

    Returned is as of :func:`contact_event_of_one`.
    """
    lane, series = worker.two, worker.series[i]
    left = lane.was_left[i]
    span = stack_two.span_of(left, lane.part[i])
    when, closes1, closes2 = lane.when[i], lane.closes1[i] != 0, lane.closes2[i] != 0
    at = min(1.0, when)
    one, two = series.one.angle, series.two.angle
    theta1, omega1 = value(one, at), slope(one, at) / span
    theta2, omega2 = value(two, at), slope(two, at) / span
    case.peak1, case.peak2, case.fast, case.near = stack_two.nearest(
        lane, i, (theta1, omega1, theta2, omega2)
    )
    case.tau = 1.0 - left + span * at
    case.theta1, case.omega1 = theta1, omega1
    case.theta2, case.omega2 = theta2, omega2
    if when > 1.0:
        return False, False
    rise = lane.ground_end[i] - lane.was_ground[i]
    lift = lane.weight_end[i] - lane.was_weight[i]
    case.ground = lane.was_ground[i] + rise * (at * span / left)
    case.weight = lane.was_weight[i] + lift * (at * span / left)
    _count_contact_event(case)
    if closes1:
        case.theta1 = 0.0
    if closes2:
        case.theta2 = case.theta1
    case.impacts += 1
    if (
        closes1 == closes2
        or ensemble.bodies[case.body].measured
        or _forced(case)
        or not close_one(case, worker, closes1, g, motions)
    ):
        return closes1, closes2
    return False, False


@kernel
def general_impact(case, worker, body, closes, motions):
    """Take a case through the closing of contacts as single histories do (``single.resolve_impact``).

    ``closes``: whether ground and interface close.
    """
    state = worker.state
    to_state(case, state)
    ahead = _ahead(case, motions)
    restoring = worker.restoring[case.slot]
    _, gave_way = resolve_impact(
        body, state, closes, restoring, ahead, chatter.OUTCOME, _forced(case)
    )
    case.given_way += gave_way
    h = case.interval
    case.c1, case.c2 = state.c1, state.c2
    case.omega1, case.omega2 = state.omega1 * h, state.omega2 * h


@inlined_kernel
def _impact_alone(case, worker, body, g, motions):
    """Take what rocks alone through its landing by its record IMPACT; return whether that was possible.

    The outcome at unit speed is scaled by the speed. Where only one of two contacts that come off does so too
    slowly nothing is changed, and ``general_impact`` has to do it. Rates are per sample; ``g``: gravity [m/s²].
    """
    landing = worker.impacts[case.slot, equations.number_of(case.c1, case.c2)]
    # both blocks turn as one, or the statue alone: its rate is that of what rocks
    speed = abs(case.omega2)
    v1, v2 = speed * landing.after1, speed * landing.after2
    n1, n2 = landing.next1, landing.next2
    # a contact that comes off slower than this stays closed
    slow = chatter.OUTCOME.closing_speed * case.interval
    slow1 = n1 != 0 and abs(v1) < slow
    slow2 = n2 != 0 and abs(v2 - v1) < slow
    rests = (n1 == 0 or slow1) and (n2 == 0 or slow2)
    if (slow1 or slow2) and not rests:
        return False
    if rests or _comes_to_rest(case, worker, landing.fraction, v1, v2, motions):
        n1, n2, v1, v2 = 0, 0, 0.0, 0.0
    case.c1, case.c2, case.omega1, case.omega2 = n1, n2, v1, v2
    case.given_way += landing.gives_way
    if not _is_settled(case, worker, g):
        to_state(case, worker.state)
        case.c1, case.c2 = contact_states.settle(body, worker.state)
    return True


@inlined_kernel
def _comes_to_rest(case, worker, fraction, v1, v2, motions):
    """Whether the impacts after a landing at zero rotation are sure to end at rest (``chatter.dies_out``).

    ``fraction``: part of the speed that an impact leaves [-]; ``v1``, ``v2``: rates after it [rad per sample].
    """
    speed = max(abs(v1), abs(v2)) / case.interval
    restoring = worker.restoring[case.slot]
    if not speed < restoring.fastest:
        return False
    drop, ahead = chatter.OUTCOME.drop, _ahead(case, motions)
    return chatter.dies_out(
        speed, fraction, chatter.SAFETY_OF_STACKS, restoring, drop, ahead
    )


@inlined_kernel
def _is_settled(case, worker, g):
    """Whether forces keep the contacts of a case that has just landed closed, all that are: by its constants."""
    if case.c1 == 0 and case.c2 == 0:
        return case.low * case.weight < case.ground < case.high * case.weight
    if case.c1 == 0 or case.c2 == 0:
        constants = worker.ones[case.slot, equations.number_of(case.c1, case.c2)]
        ground_and_weight = case.ground, case.weight
        omega = case.omega2
        return stack_one.least_hold(constants, 0.0, omega, ground_and_weight, g) > 0.0
    return True


@inlined_kernel
def close_one(case, worker, ground, g, motions):
    """Take two rocking blocks through an impact at one contact; return whether that could be done here.

    ``ground``: whether it is the ground's contact, not the interface's. Of each choice of pivots ``worker`` keeps
    what an impact needs. The contact comes off on its other pivot, as rocking goes on, or is shut where the hops
    that follow are sure to be short (``chatter.may_close``). Where it would not come off nothing is changed, and
    ``general_impact`` has to look at both contacts.
    """
    c1, c2, omega1, omega2 = case.c1, case.c2, case.omega1, case.omega2
    constants, number = worker.twos[case.slot], equations.number_of(c1, c2)
    before, products = constants[number], worker.impacts[case.slot, number]
    sine, cosine = quick_sine_cosine(case.theta2)
    if ground:
        n1, n2 = -c1, c2
        after = constants[equations.number_of(n1, n2)]
        v1, v2 = ground_impact(
            before, after, products.ground, (cosine, sine), omega1, omega2
        )
        # of the closing contact: side, rates after and before; of the other: gap, and rate at which it closes
        side, off, old = n1, v1, omega1
        gap, toward = abs(case.theta2), c2 * (v1 - v2)
    else:
        n1, n2 = c1, -c2
        after = constants[equations.number_of(n1, n2)]
        v1, v2 = interface_impact(after, products, omega1, omega2)
        side, off, old = n2, v2 - v1, omega2 - omega1
        gap, toward = abs(case.theta1), -c1 * v1
    if side * off <= chatter.OUTCOME.closing_speed * case.interval:
        return False
    # half the time in which the other contact would close
    longest = 0.5 * gap / toward if toward > 0.0 else math.inf
    hop = chatter.Hop(ground, side, old, cosine, sine, v1, v2)
    if chatter.may_close(hop, before, after, longest, g, _ahead(case, motions)):
        v1, v2 = chatter.closed(hop, after)
        if ground:
            n1 = 0
        else:
            n2 = 0
    case.c1, case.c2, case.omega1, case.omega2 = n1, n2, v1, v2
    return True


@inlined_kernel
def _count_contact_event(case):
    """Count a contact event of a case within its sample."""
    if case.counted_sample != case.k:
        case.counted_sample = case.k
        case.contact_events = 0
    case.contact_events += 1


@inlined_kernel
def _forced(case):
    """Whether its sample has had so many contact events that contacts must stay closed."""
    return case.contact_events > MAX_CONTACT_EVENTS_PER_STEP


@inlined_kernel
def after_contact_event(case):
    """Take a case past its contact event, or past the end of its step, to the sample that it is in."""
    # so many in one sample that time goes on whatever happens
    are_too_many = (
        case.counted_sample == case.k
        and case.contact_events > MAX_CONTACT_EVENTS_PER_STEP + 20
    )
    if case.tau >= 1.0 - 1e-13 or are_too_many:
        case.tau = 0.0
        case.k += 1
    if abs(case.theta1) >= contact_states.HALF_TURN:
        case.fallen = 1
    elif (
        max(abs(case.theta2), abs(case.theta2 - case.theta1))
        >= contact_states.HALF_TURN
    ):
        case.fallen = 2


# --------------------------------------------------------------------------- in and out of lanes


@inlined_kernel
def place_one(i, case, worker, motions):
    """Place a case into lane i of those of one rotation."""
    number = equations.number_of(case.c1, case.c2)
    lane, constants = worker.one, worker.ones[case.slot, number]
    lane.gx[i], lane.gy[i] = constants.gx, constants.gy
    lane.per_angle[i], lane.per_speed[i] = constants.per_angle, constants.per_speed
    for n in range(stack_constants.HOLD):
        lane.right[n, i], lane.left[n, i] = constants.right[n, 0], constants.left[n, 0]
    lane.side[i] = case.c1 + case.c2
    lane.theta[i], lane.omega[i] = case.theta2, case.omega2
    lane.factor[i], lane.part_left[i] = case.factor, 1.0 - case.tau
    lane.ground[i], lane.ground_end[i] = _ground(case, motions.samples)
    lane.weight[i], lane.weight_end[i] = _weight(case, motions)
    lane.has_step[i] = 0.0
    lane.ratio[i] = case.peak1 if case.c2 == 0 else case.peak2
    lane.fast[i], lane.near[i] = case.fast, case.near


@inlined_kernel
def place_two(i, case, worker, motions):
    """Place a case into lane i of those of two rotations."""
    lane, number = worker.two, equations.number_of(case.c1, case.c2)
    two = worker.twos[case.slot, number]
    lane.v1x[i], lane.v1y[i] = two.v1x, two.v1y
    lane.v2x[i], lane.v2y[i] = two.v2x, two.v2y
    lane.m11[i], lane.m22[i], lane.e[i], lane.f[i] = two.m11, two.m22, two.e, two.f
    lane.per_angle1[i], lane.per_angle2[i] = two.per_angle1, two.per_angle2
    lane.per_speed1[i], lane.per_speed2[i] = two.per_speed1, two.per_speed2
    lane.side1[i], lane.side2[i] = case.c1, case.c2
    lane.theta1[i], lane.omega1[i] = case.theta1, case.omega1
    lane.theta2[i], lane.omega2[i] = case.theta2, case.omega2
    lane.factor[i], lane.part[i] = case.factor, case.part
    lane.part_left[i] = 1.0 - case.tau
    lane.ground[i], lane.ground_end[i] = _ground(case, motions.samples)
    lane.weight[i], lane.weight_end[i] = _weight(case, motions)
    lane.ratio1[i], lane.ratio2[i] = case.peak1, case.peak2
    lane.fast[i], lane.near[i] = case.fast, case.near


@inlined_kernel
def _weight(case, motions):
    """Weight [-] at the time of a case and at the end of its sample."""
    before = (
        lanes.weight_of(motions, case.k, case.factor) if case.k <= case.last else 1.0
    )
    after = (
        lanes.weight_of(motions, case.k + 1, case.factor) if case.k < case.last else 1.0
    )
    return before + case.tau * (after - before), after


@inlined_kernel
def _ground(case, samples):
    """Acceleration of the ground [m/s²] at the time of a case and at the end of its sample."""
    before = case.factor * samples[case.k] if case.k <= case.last else 0.0
    after = case.factor * samples[case.k + 1] if case.k < case.last else 0.0
    return before + case.tau * (after - before), after


@inlined_kernel
def store_one(i, case, lane):
    """Store what lane i of those of one rotation has reached at the end of a sample."""
    theta, omega = lane.theta[i], lane.omega[i]
    case.theta2, case.omega2 = theta, omega
    if case.c2 == 0:
        case.theta1, case.omega1, case.peak1 = theta, omega, lane.ratio[i]
    else:
        case.theta1, case.omega1, case.peak2 = 0.0, 0.0, lane.ratio[i]
    case.fast, case.near, case.tau = lane.fast[i], lane.near[i], 0.0


@inlined_kernel
def store_two(i, case, lane):
    """Store what lane i of those of two rotations has reached at the end of a sample."""
    case.theta1, case.omega1 = lane.theta1[i], lane.omega1[i]
    case.theta2, case.omega2 = lane.theta2[i], lane.omega2[i]
    case.peak1, case.peak2 = lane.ratio1[i], lane.ratio2[i]
    case.fast, case.near, case.tau = lane.fast[i], lane.near[i], 0.0
