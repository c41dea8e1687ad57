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
    """Make the memory of one thread, a record ``MEMORY``."""
    return np.zeros(1, MEMORY)[0]


@kernel
def advance(lane, upward):
    """Advance all lanes to the end of their samples and flag contact events; if not ``upward`` the weight is one.

    The two calls make two copies of the loop, so that a weight of one costs nothing.
    """
    if upward:
        _advance(lane, True)
    else:
        _advance(lane, False)


@inlined_kernel
def _advance(lane, upward):
    """Advance every lane by the rest of its sample, and store where that begins, where it ends, and its flag.

    Everything is stored in every lane: conditional stores cost many times as much. ``upward``, whether the weight
    varies, is known where this is compiled into ``advance``. Rates ``w`` are per step, ``omega`` per sample.
    """
    for i in range(LANES):
        psi, omega = lane.psi[i], lane.omega[i]
        left = lane.part_left[i]
        a, a_end = lane.ground[i], lane.ground_end[i]
        u = lane.weight[i] if upward else 1.0
        u_end = lane.weight_end[i] if upward else 1.0
        w = omega * left
        turn = taylor.quick_sine_cosine(psi)
        ground, weight = (a, a_end - a), (u, u_end - u, upward)
        rates = rates_of_one(turn, w, lane.kappa[i] * left * left, ground, weight)
        taylor.keep_rates(lane.rates, i, rates)
        end = psi + taylor.travel(rates, 1.0)
        w_end = taylor.rate_at(rates, 1.0)
        flag = _flag(lane, i, (psi, w, rates[1]), (end, w_end))
        lane.flag[i] = FALLS if _is_certain(lane, i, turn, omega, w) else flag
        # rate at the end per sample
        omega_end = w_end / left
        _keep_extremes(lane, i, _turning_point(psi, w, end, w_end), omega_end)
        lane.was_psi[i], lane.was_omega[i], lane.was_left[i] = psi, omega, left
        lane.psi[i], lane.omega[i] = end, omega_end
        lane.ground[i] = a_end
        if upward:
            lane.weight[i] = u_end
        lane.part_left[i] = 1.0


@inlined_kernel
def _is_certain(lane, i, turn, omega, w):
    """Whether the block of lane i falls whatever the ground does: ``docs/kernels.md``, "A certain fall".

    ``turn``: sine and cosine of ψ as the step begins; ``omega``, ``w``: ψ' then, per sample and per step.
    """
    s, c = turn
    barrier = lane.barrier[i] - lane.heavy[i] * c + lane.bound[i] * s
    return (w < 0.0) & (0.5 * omega * omega >= lane.kappa[i] * barrier)


@inlined_kernel
def _flag(lane, i, begin, end):
    """Flag of a step of lane i: TOUCHES if the block may meet the ground in it, or lies at its end; or QUIET.

    ``begin`` has ψ and its first and second derivative, ``end`` ψ and the first one, by time in steps. An impact
    is where ψ rises to the critical angle.
    """
    psi, w, bend = begin
    psi_end, w_end = end
    angle = lane.angle[i]
    grazes = (w > 0.0) & (w_end < 0.0)
    touches = psi_end >= angle
    lies = psi_end <= angle - HALF_TURN
    # leaves, and may fall back and be pulled open again before the sample is over
    falls_back = hops(angle - psi, -w, -w_end, -bend)
    return TOUCHES if touches | grazes | lies | falls_back else cases.QUIET


@inlined_kernel
def _turning_point(psi, w, psi_end, w_end):
    """Least ψ of a step, that of a parabola where the block turns back in it; rates are per step."""
    turn = psi + 0.5 * w * w / min(w - w_end, -1e-300)
    return turn if (w < 0.0) & (w_end > 0.0) else psi_end


@inlined_kernel
def _keep_extremes(lane, i, psi, omega):
    """Store the extremes of lane i before its step, and take ψ and ψ' [1/sample] of the step into them."""
    low = psi * lane.per_angle[i]
    near = low * low + omega * omega * lane.per_speed[i]
    was_low, was_fast, was_near = lane.low[i], lane.fast[i], lane.near[i]
    lane.was_low[i], lane.was_fast[i], lane.was_near[i] = was_low, was_fast, was_near
    lane.low[i] = min(was_low, low)
    lane.fast[i] = max(was_fast, abs(omega))
    lane.near[i] = min(was_near, near)


@entry_kernel
def integrate_blocks(ensemble, motions, worker, outcomes):
    """Integrate an ensemble of lone blocks: this thread takes case after case until none is left.

    Each pass advances all lanes by a sample; lanes that then stop, for a contact event, a fall or the end of their
    motion, are handled one by one (``docs/kernels.md``, "Two schedulers").

    Parameters
    ----------
    ensemble : an :class:`Ensemble` whose bodies are ``PIVOT``, with factors over g
    motions : a :class:`Motions` [m/s²]
    worker : record ``MEMORY`` of this thread
    outcomes : records ``OUTCOME`` of all cases, changed in place

    Returns
    -------
    Steps that lanes made, to see how busy they were, in a tuple.
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
    """Take note of a certain fall of lane i in its ``tally`` (OUTCOME), and mark the lane as fallen.

    Before balance (ψ > 0) the distance to it is that at which the block passes it with the speed that energy
    leaves it, w² - 2 κ (1 - cos ψ), the ground being still; beyond, that of now.
    """
    _restore_extremes(lane, i)
    psi, w = lane.was_psi[i], lane.was_omega[i]
    square = w * w / lane.kappa[i]
    if psi > 0.0:
        square -= 2.0 * (1.0 - cos(psi))
    else:
        square += psi * psi
    distance = math.sqrt(max(0.0, square)) / lane.angle[i]
    tally.unstable_distance = min(tally.unstable_distance, distance)
    lane.fell[i] = 1


@inlined_kernel
def _restore_extremes(lane, i):
    """Forget what the step of a lane would have reached without its contact event."""
    lane.low[i] = lane.was_low[i]
    lane.fast[i] = lane.was_fast[i]
    lane.near[i] = lane.was_near[i]


@inlined_kernel
def _take_contact_event(lane, i, tally, ensemble, motions):
    """Take a lane through the impact in its step, or to the step's end if there is none.

    Afterwards the lane stands at the part ``tau`` of the interval after sample ``k``; its ``side`` is 0 where the
    block rests. ``tally`` is the OUTCOME of its case so far.
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
        side, psi, w = _after_impact(lane, i, tau, w, ensemble, motions)
    if tau >= 1.0 - 1e-13:
        lane.k[i] = k + 1
        tau = 0.0
    lane.side[i] = side
    lane.psi[i], lane.omega[i], lane.tau[i] = psi, w, tau


@inlined_kernel
def _after_impact(lane, i, tau, w, ensemble, motions):
    """Side, ψ and ψ' [1/sample] of lane i after an impact at the part ``tau`` of its sample, at the rate ``w``.

    The block goes from its pivot to the other one, at rotation zero. The side is 0 where it rests from then on: it
    hardly comes off, meets too often within a sample, or its impacts are sure to end (``block_dies_out``).
    """
    k, side, factor = lane.k[i], lane.side[i], lane.factor[i]
    if lane.counted_sample[i] != k:
        lane.counted_sample[i] = k
        lane.contact_events[i] = 0
    lane.contact_events[i] += 1
    there = _pivot(lane, i, side, ensemble)
    w = block_impact(there, w)
    side = -side
    here = _pivot(lane, i, side, ensemble)
    psi = here.alpha
    ahead = Ahead(motions.samples, motions.vertical, factor, lane.last[i], k, tau, 1.0)
    still = w > -1e-12 or lane.contact_events[i] > MAX_CONTACT_EVENTS_PER_STEP
    if still or block_dies_out(-w, side, here, there, ahead):
        side = 0
    return side, psi, w


@inlined_kernel
def _rates_of(lane, i):
    """Taylor coefficients 0 to 6 of ψ' per step, over the step of lane i."""
    rows = lane.rates
    w = lane.was_omega[i] * lane.was_left[i]
    return w, rows[0, i], rows[1, i], rows[2, i], rows[3, i], rows[4, i], rows[5, i]


@kernel
def _find_impacts(lane, stops):
    """Find when ψ reaches the critical angle in lanes that end beyond it; ``stops`` has a bit for each that stops.

    All are found before any goes through its impact, as a processor works on several at once.
    """
    while stops != 0:
        i = lowest_bit(stops)
        stops &= stops - 1
        if lane.flag[i] == TOUCHES and lane.psi[i] >= lane.angle[i]:
            lane.when[i] = _flight(
                lane.was_psi[i] - lane.angle[i], _rates_of(lane, i), 1.0
            )


@inlined_kernel
def _contact_event(lane, i, tally):
    """Find the next impact in the step of lane i, and note in its ``tally`` the extremes on the way.

    Returns
    -------
    t : time of the impact in the step [-], NEVER if there is none
    psi, omega : ψ [rad] and ψ' [rad per sample] just before it, or at the end of the step
    stays : whether the block stays on the ground from the beginning of the step
    """
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
    """Time in the step at which ψ reaches the critical angle, passed by the time ``end``; NEVER if it stays there.

    ``gap`` is ψ less that angle as the step begins, ``rates`` the Taylor coefficients of ψ' per step.
    """
    _, w1, w2, w3, w4, w5, w6 = rates
    # of the opening angle, -gap less the integral of ψ'
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
    """Take ψ [rad] and its rate ``w`` [rad per sample] into the extremes of a ``tally``.

    The distance from balance is √(ψ² + w²/κ) over the critical ``angle``.
    """
    tally.peak2 = max(tally.peak2, 1.0 - psi / angle)
    tally.fast = max(tally.fast, abs(w))
    if abs(psi) < tally.unstable_distance * angle:
        tally.unstable_distance = min(
            tally.unstable_distance, math.sqrt(psi * psi + w * w / kappa) / angle
        )


# --------------------------------------------------------------------------- between cases


@kernel
def _next_case(lane, i, tally, ensemble, motions, outcomes):
    """Take a lane through rest and the ends of motions until it rocks, or no case is left (``case`` -1).

    A case that ends on the way, at rest or fallen, is written into ``outcomes``, and the lane takes the next one.
    """
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
        tally.peak1 = 0.0
        tally.peak2 = 0.0
        tally.fast = 0.0
        tally.unstable_distance = math.inf


@inlined_kernel
def _rise(lane, i, ensemble, motions):
    """Take the block of lane i, if it rests, to the instant at which the ground lifts it, if it does."""
    k, last, factor = lane.k[i], lane.last[i], lane.factor[i]
    if lane.fell[i] != 0 or lane.side[i] != 0 or k >= last or factor == 0.0:
        return
    # accelerations over g between which the block rests: tan θc of either pivot
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
    """Whether the block of lane i falls once the ground is still, with extremes noted in its ``tally``.

    Every speed follows from the energy ψ'²/2 + κ cos ψ, which only impacts change: the block falls where it passes
    balance (energy ≥ κ, or ψ ≤ 0 and no speed back), and never once neither pivot can be left to beyond balance.
    """
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
    """Write the outcome (OUTCOME) of the case in lane i from its ``tally`` and the lane's extremes."""
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
    """Begin the case of a ``number`` in lane i, at rest at the first sample of its motion."""
    body, motion, scale = cases.place_of(number, ensemble)
    lane.case[i], lane.body[i], lane.motion[i] = number, body, motion
    lane.low[i], lane.fast[i], lane.near[i] = 1.0, 0.0, math.inf
    lane.factor[i] = ensemble.factors[motion, scale]
    lane.tau[i] = 0.0
    # the motion as it is sampled for this body
    sampled = ensemble.rows[body, motion]
    lane.first[i] = motions.offsets[sampled]
    lane.k[i] = motions.offsets[sampled]
    lane.last[i] = motions.lasts[sampled]
    lane.side[i], lane.fell[i], lane.counted_sample[i] = 0, 0, -1


@inlined_kernel
def _place(lane, i, ensemble, motions):
    """Fill what lane i needs for the rest of its sample from its case, side, sample ``k`` and ``tau``.

    That is the ground, the weight, the constants of its pivot, and the bounds of what is ahead. A lane without a
    case stands still at a harmless place.
    """
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
    most = motions.ahead_high[k // cases.BLOCK]
    least = motions.ahead_low[k // cases.BLOCK]
    bound = max(max(0.0, factor * most * side), factor * least * side)
    light, heavy = cases.weights_ahead(motions, k, factor)
    lane.bound[i], lane.heavy[i] = bound, heavy
    lane.barrier[i] = math.sqrt(light * light + bound * bound) + (heavy - light)
    if light <= 0.0:
        # where gravity may vanish, no fall is certain before the block lies down
        lane.barrier[i] = math.inf
