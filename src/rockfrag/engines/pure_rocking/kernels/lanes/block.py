"""Ensembles of lone blocks, many cases side by side, each in a lane from its uplift to its outcome.

With ψ = θc - |θ|, A the ground acceleration over g, positive where it pushes the block back down, and W gravity
over g, ψ'' = p² (W sin ψ + A cos ψ) on either pivot (Housner, 1963).  Time is counted in samples.

In: cases, and motions over g. Out: records OUTCOME. Theory: ``docs/kernels.md``, "A certain fall" and "Series".
"""

import math

import numpy as np

from rockfrag.base.arrays import fields, whole
from rockfrag.base.elementary import acos, cos
from rockfrag.engines.compile.jit import (
    entry_kernel,
    inlined_kernel,
    kernel,
    lowest_bit,
    take_next,
)
from rockfrag.engines.pure_rocking.kernels import taylor
from rockfrag.engines.pure_rocking.kernels.chatter import Ahead, block_dies_out
from rockfrag.engines.pure_rocking.kernels.contact_states import HALF_TURN
from rockfrag.engines.pure_rocking.kernels.impact import block_impact
from rockfrag.engines.pure_rocking.kernels.lanes import case as cases
from rockfrag.engines.pure_rocking.kernels.lanes.series import rates_of_one
from rockfrag.engines.pure_rocking.kernels.roots import NEVER, crossing, graze, hops
from rockfrag.engines.pure_rocking.kernels.single import MAX_CONTACT_EVENTS_PER_STEP

LANES = 64  # as many as ``next_samples`` has bits for
TOUCHES, FALLS = 1.0, 2.0  # flags of a lane: it may have touched, or falls for certain

PIVOT = np.dtype(
    [
        *fields("alpha tan sine cosine"),  # critical angle
        *fields("swing"),  # p² dt²
        # ratio of angular velocities of the impact that ends rocking on this pivot
        *fields("restitution"),
        *fields("per_alpha per_swing"),  # 1/θc and 1/(p² dt² θc²)
    ]
)
"""What the lanes know of a block on one pivot."""

LANE = np.dtype(
    [
        # number of its case, -1 for none; samples: reached, first and last of its motion, and the one after the
        # one reached, if its motion has one
        *whole("case body motion k first last following", LANES),
        *whole("side", LANES),  # 1 on the right pivot, -1 on the left, 0 at rest
        # sample of the last impact, and how many that has had
        *whole("fell counted_sample contact_events", LANES),
        *fields("psi omega", LANES),  # the state, ψ and ψ'
        # A and W now, at the end of the sample
        *fields("ground ground_end weight weight_end", LANES),
        # part of the sample that is left, and time since sample k
        *fields("part_left tau", LANES),
        # so far: least ψ/θc, most |ψ'|, distance from balance squared
        *fields("low fast near", LANES),
        # these where the step began
        *fields("was_psi was_omega was_left was_low was_fast was_near", LANES),
        # θc, κ = p² dt², 1/θc and 1/(κ θc²) of the pivot
        *fields("angle kappa per_angle per_speed", LANES),
        # the most that A and W can be from here on, and √(light² + bound²) + heavy - light, with the least W
        *fields("bound heavy barrier", LANES),
        # scale of the motion over g, and that times the side
        *fields("factor signed", LANES),
        *fields("flag when", LANES),  # when: time in the step at which ψ passes θc
        *fields("rates", taylor.ORDER - 1, LANES),  # Taylor coefficients 1 to 6 of ψ'
    ],
    align=True,
)
"""The lanes: a row of LANES numbers for each quantity."""


# the lanes, and what their cases have come to so far; the pedestal's part stays zero
MEMORY = np.dtype(
    [*fields("lane", of=LANE), *fields("tallies", LANES, of=cases.OUTCOME)], align=True
)
"""Memory that a thread works in."""


def worker() -> np.void:
    """Memory for one thread."""
    return np.zeros(1, MEMORY)[0]


@kernel
def advance(lane, upward):
    """Advance all lanes to the end of their samples, flag contact events; if not ``upward`` the weight is one."""
    if upward:
        _advance(lane, True)
    else:
        _advance(lane, False)


@inlined_kernel
def _advance(lane, upward):
    """Advance every lane; ``upward`` is known where this is compiled into ``advance``.

    Everything is stored in every lane: conditional stores cost many times as much. ψ = θc - |θ| is the angle to
    balance, of which an impact at ψ = θc begins anew; ``w`` and ``v`` are its rates per step, at both ends of it.

    When a fall is certain, whatever the ground does: ``docs/kernels.md``, "A certain fall".
    """
    for i in range(LANES):
        psi = lane.psi[i]
        omega = lane.omega[i]
        left = lane.part_left[i]
        kappa = lane.kappa[i]
        angle = lane.angle[i]
        a = lane.ground[i]
        a_end = lane.ground_end[i]
        w = omega * left
        s, c = taylor.quick_sine_cosine(psi)
        u = lane.weight[i] if upward else 1.0
        u_end = lane.weight_end[i] if upward else 1.0
        weight = u, u_end - u, upward
        rates = rates_of_one((s, c), w, kappa * left * left, (a, a_end - a), weight)
        end = psi + taylor.travel(rates, 1.0)
        v = taylor.rate_at(rates, 1.0)
        taylor.keep_rates(lane.rates, i, rates)
        # what may happen in the step
        barrier = lane.barrier[i] - lane.heavy[i] * c + lane.bound[i] * s
        certain = (w < 0.0) & (0.5 * omega * omega >= kappa * barrier)
        grazes = (w > 0.0) & (v < 0.0)
        touches = end >= angle
        lies = end <= angle - HALF_TURN
        # leaves, and may fall back and be pulled open again before the sample is over
        falls_back = hops(angle - psi, -w, -v, -rates[1])
        flag = TOUCHES if touches | grazes | lies | falls_back else cases.QUIET
        flag = FALLS if certain else flag
        lane.flag[i] = flag
        # extremes so far; the turning point of a parabola lies between the samples
        turn = psi + 0.5 * w * w / min(w - v, -1e-300)
        low = (turn if (w < 0.0) & (v > 0.0) else end) * lane.per_angle[i]
        v = v / left
        near = low * low + v * v * lane.per_speed[i]
        was_low, was_fast, was_near = lane.low[i], lane.fast[i], lane.near[i]
        lane.was_low[i], lane.was_fast[i], lane.was_near[i] = (
            was_low,
            was_fast,
            was_near,
        )
        lane.low[i] = min(was_low, low)
        lane.fast[i] = max(was_fast, abs(v))
        lane.near[i] = min(was_near, near)
        # where the step began and where it ends
        lane.was_psi[i], lane.was_omega[i], lane.was_left[i] = psi, omega, left
        lane.psi[i] = end
        lane.omega[i] = v
        lane.ground[i] = a_end
        if upward:
            lane.weight[i] = u_end
        lane.part_left[i] = 1.0


@entry_kernel
def integrate_blocks(ensemble, motions, worker, outcomes):
    """Integrate an ensemble of lone blocks, factors over g, a worker a thread; steps of lanes, in a tuple.

    Parameters
    ----------
    ensemble : an :class:`Ensemble` of bodies, scales and steps
    motions : a :class:`Motions`, accelerations over g
    worker : named tuple of records, the memory of one thread
    outcomes : records ``OUTCOME`` of all cases, changed in place
    """
    lane, tallies = worker.lane, worker.tallies
    upward = motions.vertical.size > 0
    busy = 0
    for i in range(LANES):
        lane.case[i] = -1
        _next_case(lane, i, tallies[i], ensemble, motions, outcomes)
        _place(lane, i, ensemble, motions)
        if lane.case[i] >= 0:
            busy += 1
    passes = 0
    while busy > 0:
        passes += 1
        advance(lane, upward)
        stops = cases.next_samples(lane, lane.signed, LANES, motions)
        _find_impacts(lane, stops)
        while stops != 0:
            i = lowest_bit(stops)
            stops &= stops - 1
            if lane.case[i] < 0:
                continue
            if lane.flag[i] == FALLS:
                _fall(lane, i, tallies[i])
            elif lane.flag[i] != cases.QUIET:
                _take_contact_event(lane, i, tallies[i], ensemble, motions)
            else:
                lane.tau[i] = 0.0
            if lane.fell[i] != 0 or lane.side[i] == 0 or lane.k[i] >= lane.last[i]:
                _next_case(lane, i, tallies[i], ensemble, motions, outcomes)
                if lane.case[i] < 0:
                    busy -= 1
            _place(lane, i, ensemble, motions)
    return (passes * LANES,)


# --------------------------------------------------------------------------- contact events


@inlined_kernel
def _pivot(lane, i, side, ensemble):
    """Constants of a lane's block on the pivot of ``side``."""
    return ensemble.bodies[lane.body[i], lane.motion[i], 0 if side > 0 else 1]


@inlined_kernel
def _fall(lane, i, tally):
    """Take note of a certain fall, which passes balance at the latest at the speed that energy leaves it."""
    _restore_extremes(lane, i)
    psi, w = lane.was_psi[i], lane.was_omega[i]
    near = w * w / lane.kappa[i]
    if psi > 0.0:
        near -= 2.0 * (1.0 - cos(psi))
    else:
        near += psi * psi
    near = math.sqrt(max(0.0, near)) / lane.angle[i]
    tally.unstable_distance = min(tally.unstable_distance, near)
    lane.fell[i] = 1


@inlined_kernel
def _restore_extremes(lane, i):
    """Forget what the step of a lane would have reached without its contact event."""
    lane.low[i], lane.fast[i], lane.near[i] = (
        lane.was_low[i],
        lane.was_fast[i],
        lane.was_near[i],
    )


@inlined_kernel
def _take_contact_event(lane, i, tally, ensemble, motions):
    """Take a lane through the impact in its step, or to the step's end if there is none.

    Afterwards the lane stands at the part ``tau`` of the interval after sample ``k``; its ``side`` is 0 where the
    block rests.
    """
    k, side = lane.k[i], lane.side[i]
    _restore_extremes(lane, i)
    t, psi, w, stays = _contact_event(lane, i, tally)
    tau = 1.0
    if stays:
        side = 0
    elif t > 1.0:
        if psi <= lane.angle[i] - HALF_TURN:
            lane.fell[i] = 1
    else:
        tau -= lane.was_left[i] * (1.0 - t)
        tally.impacts += 1
        if lane.counted_sample[i] != k:
            lane.counted_sample[i] = k
            lane.contact_events[i] = 0
        lane.contact_events[i] += 1
        # from the pivot there to the other one, at rotation zero
        there = _pivot(lane, i, side, ensemble)
        w = block_impact(there, w)
        side = -side
        here = _pivot(lane, i, side, ensemble)
        psi = here.alpha
        factor = lane.factor[i]
        ahead = Ahead(
            motions.samples, motions.vertical, factor, lane.last[i], k, tau, 1.0
        )
        # it hardly comes off, meets too often, or its impacts are sure to end
        still = w > -1e-12 or lane.contact_events[i] > MAX_CONTACT_EVENTS_PER_STEP
        if still or block_dies_out(-w, side, here, there, ahead):
            side = 0
    if tau >= 1.0 - 1e-13:
        lane.k[i] = k + 1
        tau = 0.0
    lane.side[i] = side
    lane.psi[i], lane.omega[i], lane.tau[i] = psi, w, tau


@inlined_kernel
def _rates_of(lane, i):
    """Taylor coefficients 0 to 6 of ψ' over a lane's step."""
    rows = lane.rates
    w = lane.was_omega[i] * lane.was_left[i]
    return w, rows[0, i], rows[1, i], rows[2, i], rows[3, i], rows[4, i], rows[5, i]


@kernel
def _find_impacts(lane, stops):
    """Find the impacts of all lanes before any goes through one, as a processor works on several at once."""
    while stops != 0:
        i = lowest_bit(stops)
        stops &= stops - 1
        if lane.flag[i] == TOUCHES and lane.psi[i] >= lane.angle[i]:
            lane.when[i] = _flight(
                lane.was_psi[i] - lane.angle[i], _rates_of(lane, i), 1.0
            )


@inlined_kernel
def _contact_event(lane, i, tally):
    """Time of the next impact in the step, or NEVER; ψ and ψ' then or at the end; whether it never left."""
    psi = lane.was_psi[i]
    left = lane.was_left[i]
    angle = lane.angle[i]
    kappa = lane.kappa[i]
    rates = _rates_of(lane, i)
    w = rates[0]
    gap = psi - angle
    end, v = lane.psi[i], lane.omega[i]
    t = NEVER
    if end >= angle:
        t = lane.when[i]
        if t > 1.0:
            return t, end, v, True
    elif w > 0.0 and v < 0.0:
        t = graze(gap, rates)
    elif w <= 0.0 and v < 0.0 and min(gap, 0.0) + 0.5 * rates[1] >= 0.0:
        # may fall back within the step and be pulled open again before its end
        for part in range(1, 8):
            if min(gap, 0.0) + taylor.travel(rates, part / 8) >= 0.0:
                t = _flight(gap, rates, part / 8)
                break
    if t > 1.0:
        _note(tally, end, v, angle, kappa)
        if w < 0.0 and v > 0.0:
            low = psi + taylor.travel(rates, w / (w - v * left))
            _note(tally, low, 0.0, angle, kappa)
        return t, end, v, False
    v = max(0.0, taylor.rate_at(rates, t)) / left
    if gap >= 0.0:
        # the highest point of a flight that begins and ends in this step
        low = psi + taylor.travel(rates, 0.5 * t)
        _note(tally, low, v, angle, kappa)
    tally.fast = max(tally.fast, v)
    return t, angle, v, False


@inlined_kernel
def _flight(gap, rates, end):
    """Time at which ψ reaches the angle of impact, passed by the time ``end``; NEVER if it stays there."""
    _, w1, w2, w3, w4, w5, w6 = rates
    series = (
        -gap,
        -rates[0],
        -0.5 * w1,
        -1 / 3 * w2,
        -0.25 * w3,
        -0.2 * w4,
        -1 / 6 * w5,
        -1 / 7 * w6,
    )
    t = crossing(series, end)
    return NEVER if gap >= 0.0 and t == 0.0 else t


@inlined_kernel
def _note(tally, psi, w, angle, kappa):
    """Keep the largest rotation and speed and the closest approach to balance."""
    tally.peak2 = max(tally.peak2, 1.0 - psi / angle)
    tally.fast = max(tally.fast, abs(w))
    if abs(psi) < tally.unstable_distance * angle:
        tally.unstable_distance = min(
            tally.unstable_distance, math.sqrt(psi * psi + w * w / kappa) / angle
        )


# --------------------------------------------------------------------------- between cases


@kernel
def _next_case(lane, i, tally, ensemble, motions, outcomes):
    """Take a lane through rest and the ends of motions, and through as many cases as end there."""
    while True:
        if lane.case[i] >= 0:
            _rise(lane, i, ensemble, motions)
            if lane.fell[i] == 0 and lane.side[i] != 0:
                if lane.k[i] < lane.last[i]:
                    return
                if _falls_freely(lane, i, tally, ensemble):
                    lane.fell[i] = 1
            _put_down(lane, i, tally, outcomes[lane.case[i]])
        number = take_next(ensemble.counter)
        if number >= ensemble.count:
            lane.case[i] = -1
            return
        _take_up(lane, i, number, ensemble, motions)
        tally.fallen, tally.certain, tally.impacts = 0, 0, 0
        tally.peak1, tally.peak2, tally.fast, tally.unstable_distance = (
            0.0,
            0.0,
            0.0,
            math.inf,
        )


@inlined_kernel
def _rise(lane, i, ensemble, motions):
    """Take a block at rest to the instant at which the ground pushes it over, if it does."""
    k, last, factor = lane.k[i], lane.last[i], lane.factor[i]
    if lane.fell[i] != 0 or lane.side[i] != 0 or k >= last or factor == 0.0:
        return
    interval = -_pivot(lane, i, 1, ensemble).tan, _pivot(lane, i, -1, ensemble).tan
    k, tau, ground, _ = cases.next_uplift(
        motions, k, lane.tau[i], last, factor, interval
    )
    if k >= 0:
        # it rocks towards the side that the ground comes from
        side = -1 if ground > 0.0 else 1
        lane.k[i], lane.tau[i], lane.side[i] = k, tau, side
        lane.psi[i], lane.omega[i] = _pivot(lane, i, side, ensemble).alpha, 0.0


@kernel
def _falls_freely(lane, i, tally, ensemble):
    """Whether the block falls once the ground is still; every speed follows from energy."""
    psi, w, side = lane.psi[i], lane.omega[i], lane.side[i]
    for _ in range(64):
        here = _pivot(lane, i, side, ensemble)
        angle, kappa = here.alpha, here.swing
        energy = 0.5 * w * w + kappa * cos(psi)
        if (psi > 0.0 and w <= 0.0) or psi <= 0.0:
            if psi > 0.0 and energy < kappa:
                _note(tally, acos(energy / kappa), 0.0, angle, kappa)
            elif psi > 0.0 or w <= 0.0 or energy < kappa:
                _note(tally, 0.0, math.sqrt(2.0 * abs(energy - kappa)), angle, kappa)
                return True
        v = math.sqrt(max(0.0, 2.0 * (energy - kappa * cos(angle))))
        tally.fast = max(tally.fast, v)
        w = block_impact(here, v)
        side = -side
        other = here
        here = _pivot(lane, i, side, ensemble)
        psi, kappa = here.alpha, here.swing
        left = 0.5 * w * w
        if left < kappa * (1.0 - cos(psi)) and left < other.swing * (
            1.0 - cos(other.alpha)
        ):
            _note(tally, acos(left / kappa + cos(psi)), 0.0, psi, kappa)
            return False
    return False


@inlined_kernel
def _put_down(lane, i, tally, outcome):
    """Write down what remains of a lane's case."""
    fell = lane.fell[i] != 0
    outcome.fallen = 2 if fell else 0
    outcome.certain = lane.k[i] - lane.first[i] if fell else 0
    outcome.peak1, outcome.peak2 = 0.0, max(tally.peak2, 1.0 - lane.low[i])
    outcome.fast = max(tally.fast, lane.fast[i])
    outcome.unstable_distance = min(tally.unstable_distance, math.sqrt(lane.near[i]))
    # a lone block comes off as was measured, whatever the law
    outcome.impacts, outcome.given_way = tally.impacts, 0


@inlined_kernel
def _take_up(lane, i, number, ensemble, motions):
    """Begin a case in a lane, at rest."""
    body, motion, scale = cases.place_of(number, ensemble)
    lane.case[i], lane.body[i], lane.motion[i] = number, body, motion
    lane.low[i], lane.fast[i], lane.near[i] = 1.0, 0.0, math.inf
    lane.factor[i] = ensemble.factors[motion, scale]
    lane.tau[i] = 0.0
    sampled = ensemble.rows[body, motion]
    lane.first[i] = motions.offsets[sampled]
    lane.k[i] = motions.offsets[sampled]
    lane.last[i] = motions.lasts[sampled]
    lane.side[i], lane.fell[i], lane.counted_sample[i] = 0, 0, -1


@inlined_kernel
def _place(lane, i, ensemble, motions):
    """Place what a lane rocks on with; a lane without a case stands still at a harmless place."""
    if lane.case[i] < 0:
        lane.k[i], lane.last[i], lane.part_left[i], lane.angle[i] = 0, 0, 1.0, 1.0
        lane.psi[i], lane.omega[i], lane.kappa[i] = 0.0, 0.0, 0.0
        return
    k, side, tau = lane.k[i], lane.side[i], lane.tau[i]
    factor = lane.factor[i]
    signed = side * factor
    lane.signed[i] = signed
    before = signed * motions.samples[k]
    after = signed * motions.samples[k + 1]
    lane.ground[i] = before + tau * (after - before)
    lane.ground_end[i] = after
    light = cases.weight_of(motions, k, factor)
    heavy = cases.weight_of(motions, k + 1, factor)
    lane.weight[i], lane.weight_end[i] = light + tau * (heavy - light), heavy
    lane.part_left[i] = 1.0 - tau
    pivot = _pivot(lane, i, side, ensemble)
    lane.angle[i], lane.kappa[i] = pivot.alpha, pivot.swing
    lane.per_angle[i], lane.per_speed[i] = pivot.per_alpha, pivot.per_swing
    # largest A that can still push the block on this pivot back down
    most, least = (
        motions.ahead_high[k // cases.BLOCK],
        motions.ahead_low[k // cases.BLOCK],
    )
    bound = max(max(0.0, factor * most * side), factor * least * side)
    light, heavy = cases.weights_ahead(motions, k, factor)
    lane.bound[i], lane.heavy[i] = bound, heavy
    lane.barrier[i] = math.sqrt(light * light + bound * bound) + (heavy - light)
    if light <= 0.0:
        # where gravity may vanish, no fall is certain before the block lies down
        lane.barrier[i] = math.inf
