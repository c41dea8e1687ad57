"""Stacks side by side of which one part rotates: the statue on its pedestal, or both blocks as one.

One pass advances every lane from where it is within a sample to the end of that sample.  Time is counted in
samples.

In: lanes with their states. Out: their states a sample later, and a flag for each that has a contact event.
Theory: ``docs/kernels.md``, "Series".
"""

import numpy as np

from rockfrag.base.arrays import fields, whole
from rockfrag.engines.compile.jit import inlined_kernel, kernel
from rockfrag.engines.pure_rocking.kernels import roots, taylor
from rockfrag.engines.pure_rocking.kernels.contact_states import HALF_TURN
from rockfrag.engines.pure_rocking.kernels.lanes.case import (
    CLOSES,
    LANES,
    NEARS,
    QUIET,
    RELEASE,
)
from rockfrag.engines.pure_rocking.kernels.lanes.series import rates_of_one
from rockfrag.engines.pure_rocking.kernels.lanes.stack_constants import (
    HOLD,
    OF_GRAVITY,
    OF_GRAVITY_COS,
    OF_GRAVITY_SIN,
    OF_GROUND,
    OF_GROUND_COS,
    OF_GROUND_SIN,
    OF_ROTATION,
    OF_ROTATION_COS,
    OF_ROTATION_SIN,
    OF_SQUARE,
    OF_SQUARE_COS,
    OF_SQUARE_SIN,
)

LANE = np.dtype(
    [
        # its case, -1 for none; sample it has reached, the last of its motion, and the one after the one reached,
        # if its motion has one
        *whole("slot k last following", LANES),
        # constants of its contact state (stack_constants.ONE), and the side that the rocking contact opens to
        *fields("gx gy per_angle per_speed", LANES),
        *fields("right left", HOLD, LANES),
        *fields("side", LANES),
        *fields("factor", LANES),  # scale of its motion
        # at the end of the sample: acceleration of the ground, and gravity over that of a ground that does not
        # move vertically
        *fields("ground_end weight_end", LANES),
        # the state; the acceleration of the ground, and the weight; the part of the sample that is left
        *fields("theta omega ground weight part_left", LANES),
        # so far: θ/θcritical, |θ'|, distance from balance squared
        *fields("ratio fast near", LANES),
        *fields("flag", LANES),
        # these where the step began ...
        *fields("was_theta was_omega was_ground was_left was_weight", LANES),
        *fields("was_ratio was_fast was_near", LANES),
        # ... and where the step before that began, if it was of the same lane's case
        *fields(
            "before_theta before_omega before_ground before_weight before_left", LANES
        ),
        *fields("has_before has_step", LANES),
        *fields("rates", taylor.ORDER - 1, LANES),  # Taylor coefficients 1 to 6 of θ'
    ],
    align=True,
)
"""The lanes: a row of LANES numbers for each quantity."""


@inlined_kernel
def _moment(hold, i, turn, alpha, square, ground_and_weight):
    """Moment that closes a contact at one of its corners, negative if the contact would have to pull.

    Parameters
    ----------
    hold : coefficients by row (``stack_constants.HOLD``), shape (HOLD, lanes)
    i : number of the lane
    turn : sine and cosine of θ
    alpha, square : θ'' and θ'² per sample²
    ground_and_weight : acceleration of the ground [m/s²], and gravity over that of a ground that stays level [-]

    Returns
    -------
    The moment [kg m² per sample²].
    """
    ground, weight = ground_and_weight
    s, c = turn
    by_rotation = (
        hold[OF_ROTATION, i]
        + hold[OF_ROTATION_SIN, i] * s
        + hold[OF_ROTATION_COS, i] * c
    )
    by_square = (
        hold[OF_SQUARE, i] + hold[OF_SQUARE_SIN, i] * s + hold[OF_SQUARE_COS, i] * c
    )
    by_ground = (
        hold[OF_GROUND, i] + hold[OF_GROUND_SIN, i] * s + hold[OF_GROUND_COS, i] * c
    )
    by_gravity = (
        hold[OF_GRAVITY, i] + hold[OF_GRAVITY_SIN, i] * s + hold[OF_GRAVITY_COS, i] * c
    )
    moment = by_rotation * alpha
    moment += by_square * square
    moment += by_ground * ground
    return moment + weight * by_gravity


@inlined_kernel
def _rates(g_over_inertia, turn, w, left, ground, weight):
    """Taylor coefficients 0 to 6 of θ' over the rest of a sample, by time in steps (``series.rates_of_one``).

    θ'' = W (gx cos θ + gy sin θ) - (a/g) (gy cos θ - gx sin θ) is ψ'' of a lone block with other sine and cosine.

    Parameters
    ----------
    g_over_inertia : gx, gy (``stack_constants.ONE``) [per sample²]
    turn : sine and cosine of θ as the step begins
    w : θ' then [rad per step]
    left : length of the step [samples]
    ground : acceleration of the ground then over -g, and what it grows by [-]
    weight : W then, what it grows by, and whether it varies
    """
    (gx, gy), (s, c) = g_over_inertia, turn
    return rates_of_one(
        (gx * c + gy * s, gy * c - gx * s), w, left * left, ground, weight
    )


@kernel
def advance(lane, g, upward):
    """Advance all lanes to the end of their samples, flag contact events; if not ``upward`` weights are one."""
    if upward:
        _advance(lane, g, True)
    else:
        _advance(lane, g, False)


@inlined_kernel
def _advance(lane, g, upward):
    """Advance every lane by the rest of its sample, and store where that begins, where it ends, and its flag.

    Everything is stored in every lane: conditional stores cost many times as much. Times are in samples, but for
    ``turning`` and what follows from ``rates``, which are per step; ``g``: gravity [m/s²]; ``upward``: whether
    weights vary.
    """
    down = -1.0 / g
    for i in range(LANES):
        left = lane.part_left[i]
        theta, omega = lane.theta[i], lane.omega[i]
        a, a_end = lane.ground[i], lane.ground_end[i]
        # from rates per step to rates per sample
        per = 1.0 / left
        # angular velocity per step
        turning = omega * left
        turn = taylor.quick_sine_cosine(theta)
        u = lane.weight[i] if upward else 1.0
        u_end = lane.weight_end[i] if upward else 1.0
        ground = a * down, (a_end - a) * down
        weight = u, u_end - u, upward
        rates = _rates((lane.gx[i], lane.gy[i]), turn, turning, left, ground, weight)
        taylor.keep_rates(lane.rates, i, rates)
        end = theta + taylor.travel(rates, 1.0)
        end_turning = taylor.rate_at(rates, 1.0)
        flag = _flag(lane.side[i], (theta, turning, rates[1]), (end, end_turning))
        # the closed contact would have to be pulled
        square = omega * omega
        alpha = rates[1] * per * per
        right = _moment(lane.right, i, turn, alpha, square, (a, u))
        other = _moment(lane.left, i, turn, alpha, square, (a, u))
        lane.flag[i] = RELEASE if (right < 0.0) | (other < 0.0) else flag
        _keep_steps(lane, i, theta, omega)
        lane.was_ground[i], lane.was_left[i] = a, left
        end_omega = end_turning * per
        lane.theta[i], lane.omega[i] = end, end_omega
        lane.ground[i] = a_end
        if upward:
            lane.before_weight[i] = lane.was_weight[i]
            lane.was_weight[i] = u
            lane.weight[i] = u_end
        lane.part_left[i] = 1.0
        lane.was_ratio[i], lane.was_fast[i] = lane.ratio[i], lane.fast[i]
        lane.was_near[i] = lane.near[i]
        lane.ratio[i], lane.fast[i], lane.near[i] = nearest(lane, i, end, end_omega)


@inlined_kernel
def _flag(side, begin, end):
    """Flag of a step: the contact CLOSES, NEARS (it may close and open again, or a body lies), or QUIET.

    ``begin`` has the angle and its first and second derivative, ``end`` angle and first one, by time in steps.
    """
    theta, turning, bend = begin
    theta_end, turning_end = end
    gap, out, out_end = side * theta, side * turning, side * turning_end
    near = roots.dips(gap, out, out_end) | roots.hops(gap, out, out_end, side * bend)
    flag = NEARS if near | (abs(theta_end) >= HALF_TURN) else QUIET
    return CLOSES if side * theta_end < 0.0 else flag


@inlined_kernel
def _keep_steps(lane, i, theta, omega):
    """Store where this step of lane i began, but for ground and length, and all of where the one before did."""
    lane.before_theta[i] = lane.was_theta[i]
    lane.before_omega[i] = lane.was_omega[i]
    lane.before_ground[i] = lane.was_ground[i]
    lane.before_left[i] = lane.was_left[i]
    lane.has_before[i] = lane.has_step[i]
    lane.has_step[i] = 1.0
    lane.was_theta[i] = theta
    lane.was_omega[i] = omega


@inlined_kernel
def take_series(lane, i, series):
    """Copy the Taylor coefficients of θ over the step of lane i into a record SERIES, and fill that of the gap."""
    angle, gap, side = series.one.angle, series.gap, lane.side[i]
    angle[0] = lane.was_theta[i]
    angle[1] = lane.was_omega[i] * lane.was_left[i]
    for n in range(taylor.ORDER - 1):
        angle[2 + n] = lane.rates[n, i] * (1.0 / (n + 2))
    for n in range(taylor.ORDER + 1):
        gap[n] = side * angle[n]


@kernel
def go_back(lane, i, g, upward):
    """Put lane i back to where its last step began, and work its series out again, to the same bits.

    So the sample before is looked at again, in which its contact let go. ``g``, ``upward`` as of :func:`advance`.
    """
    theta, omega, left = lane.before_theta[i], lane.before_omega[i], lane.before_left[i]
    end, a = lane.was_ground[i], lane.before_ground[i]
    lane.was_theta[i], lane.was_omega[i], lane.was_left[i] = theta, omega, left
    lane.ground_end[i], lane.was_ground[i] = end, a
    heavy, u = lane.was_weight[i], lane.before_weight[i]
    lane.weight_end[i], lane.was_weight[i] = heavy, u
    down = -1.0 / g
    ground = a * down, (end - a) * down
    turn = taylor.quick_sine_cosine(theta)
    rates = _rates(
        (lane.gx[i], lane.gy[i]),
        turn,
        omega * left,
        left,
        ground,
        (u, heavy - u, upward),
    )
    taylor.keep_rates(lane.rates, i, rates)


@inlined_kernel
def next_contact_event(constants, lane, i, series, g):
    """Find the next contact event in the step of lane i.

    ``constants``: of its contact state (``stack_constants.ONE``); ``series``: from :func:`take_series`.
    Returned are its time in the step [-], NEVER if there is none, and whether it is the closed contact that opens.
    """
    if lane.flag[i] == CLOSES:
        when = roots.crossing_time(series.gap)
        omega = roots.slope(series.one.angle, when) / lane.was_left[i]
        there = ground_and_weight_at(lane, i, when)
        # what still holds as the other contact closes has held until then
        if least_hold(constants, 0.0, omega, there, g) >= 0.0:
            return when, False
    else:
        when = roots.closing_time(series.gap, 1.0)
    time = _release_time(constants, lane, i, series, min(1.0, when), g)
    if time < when:
        return time, True
    return when, False


@inlined_kernel
def ground_and_weight_at(lane, i, tau):
    """Acceleration of the ground [m/s²], and weight [-], at the time ``tau`` [-] of the step of lane i."""
    ground, weight = lane.was_ground[i], lane.was_weight[i]
    return (
        ground + (lane.ground_end[i] - ground) * tau,
        weight + (lane.weight_end[i] - weight) * tau,
    )


@kernel
def least_hold(constants, theta, omega, ground_and_weight, g):
    """Least contact moment of the closed contact [kg m² per sample²], negative where it would have to pull.

    ``constants``: of the contact state (``stack_constants.ONE``); ``theta`` [rad], ``omega`` [rad per sample];
    ``ground_and_weight`` as of :func:`_moment`.
    """
    ground, weight = ground_and_weight
    turn = taylor.quick_sine_cosine(theta)
    s, c = turn
    alpha = weight * (constants.gx * c + constants.gy * s) - ground / g * (
        constants.gy * c - constants.gx * s
    )
    return min(
        _moment(constants.right, 0, turn, alpha, omega * omega, ground_and_weight),
        _moment(constants.left, 0, turn, alpha, omega * omega, ground_and_weight),
    )


@kernel
def _release_time(constants, lane, i, series, end, g):
    """Time up to ``end`` of the step of lane i [-] at which the closed contact lets go; NEVER if it stays."""
    angle, left = series.one.angle, lane.was_left[i]
    at_low = least_hold(
        constants, angle[0], angle[1] / left, ground_and_weight_at(lane, i, 0.0), g
    )
    if at_low < 0.0:
        return 0.0
    omega = roots.slope(angle, end) / left
    at_high = least_hold(
        constants,
        roots.value(angle, end),
        omega,
        ground_and_weight_at(lane, i, end),
        g,
    )
    if at_high >= 0.0:
        return roots.NEVER
    bracket = (0.0, at_low, end, at_high, -1)
    for _ in range(200):
        if roots.is_narrow(bracket):
            break
        tau = roots.guess_between(bracket)
        omega = roots.slope(angle, tau) / left
        hold = least_hold(
            constants,
            roots.value(angle, tau),
            omega,
            ground_and_weight_at(lane, i, tau),
            g,
        )
        bracket = roots.narrowed(bracket, tau, hold)
    return roots.end_of(bracket)


@inlined_kernel
def nearest(lane, i, theta, omega):
    """Extremes of lane i up to θ [rad], θ' [rad per sample]: largest θ/θcritical and |θ'|, least distance squared.

    The distance is from balance, in units of (θc, p θc).
    """
    ratio = lane.per_angle[i] * theta
    near = (1.0 - ratio) * (1.0 - ratio) + lane.per_speed[i] * omega * omega
    return (
        max(lane.was_ratio[i], ratio),
        max(lane.was_fast[i], abs(omega)),
        min(lane.was_near[i], near),
    )
