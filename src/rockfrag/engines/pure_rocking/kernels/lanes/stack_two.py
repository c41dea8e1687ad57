"""Stacks side by side of which both blocks rotate, the ground and the interface being open.

One pass advances every lane by one step, which ends with its sample or takes the largest part of it that is
allowed. Time is counted in samples.

In: lanes with their states. Out: their states a step later, and a flag for each that has a contact event.
Theory: ``docs/kernels.md``, "Series".
"""

import numpy as np

from rockfrag.base.arrays import fields, whole
from rockfrag.engines.compile.jit import inlined_kernel, kernel
from rockfrag.engines.pure_rocking.kernels import taylor
from rockfrag.engines.pure_rocking.kernels.contact_states import (
    GROUND,
    HALF_TURN,
    INTERFACE,
)
from rockfrag.engines.pure_rocking.kernels.lanes.case import (
    CLOSES,
    LANES,
    NEARS,
    QUIET,
    WITHIN,
)
from rockfrag.engines.pure_rocking.kernels.lanes.series import rates_of_two
from rockfrag.engines.pure_rocking.kernels.roots import NEVER, crossing_time, dips, hops
from rockfrag.engines.pure_rocking.kernels.single import fill_gap, first_closing

LANE = np.dtype(
    [
        *whole("slot k last following", LANES),  # as in ``stack_one``
        # constants of its contact state (stack_constants.TWO), and the sides that its contacts open to
        *fields("v1x v1y v2x v2y m11 m22 e f", LANES),
        *fields("per_angle1 per_angle2 per_speed1 per_speed2 side1 side2", LANES),
        # scale of its motion, the largest part of a sample that a step may take
        *fields("factor part", LANES),
        *fields("ground_end weight_end", LANES),  # as in ``stack_one``, and those below
        *fields("theta1 omega1 theta2 omega2 ground weight part_left", LANES),
        *fields("ratio1 ratio2 fast near", LANES),
        *fields("flag", LANES),
        # time of its contact event in the step, whether ground and interface close then (numba has no rows of
        # booleans)
        *fields("when", LANES),
        *whole("closes1 closes2", LANES),
        # these where the step began
        *fields(
            "was_theta1 was_omega1 was_theta2 was_omega2 was_ground was_weight was_left",
            LANES,
        ),
        *fields("was_ratio1 was_ratio2 was_fast was_near", LANES),
        *fields("rates1 rates2", taylor.ORDER - 1, LANES),  # Taylor coefficients 1 to 6
    ],
    align=True,
)
"""The lanes: a row of LANES numbers for each quantity."""

REMNANT = 1e-12  # part of a sample that is not worth a step of its own
TOGETHER = 1e-13  # part of a step within which two contacts close together


@inlined_kernel
def span_of(left, part):
    """Length of a step [samples] with ``left`` of the sample to go and at most ``part`` of it allowed."""
    return left if left <= part + REMNANT else part


@kernel
def advance(lane, g, upward):
    """Advance every lane by a step and flag contact events in it; without ``upward`` all weights are one."""
    if upward:
        _advance(lane, g, True)
    else:
        _advance(lane, g, False)


@inlined_kernel
def _advance(lane, g, upward):
    """Advance every lane by a step and store everything in each: conditional stores cost many times as much.

    Pairs are of pedestal and statue; times are in samples up to :func:`_rates`, and in steps within it.
    """
    for i in range(LANES):
        left = lane.part_left[i]
        span = span_of(left, lane.part[i])
        angles = lane.theta1[i], lane.theta2[i]
        # angular velocities per sample and per step
        velocities = lane.omega1[i], lane.omega2[i]
        turns = velocities[0] * span, velocities[1] * span
        a, a_end = lane.ground[i], lane.ground_end[i]
        u = lane.weight[i] if upward else 1.0
        u_end = lane.weight_end[i] if upward else 1.0
        rise, lift = (a_end - a) * (span / left), (u_end - u) * (span / left)
        gravity = g * u, g * lift, upward
        rates1, rates2 = _rates(lane, i, span, angles, turns, (a, rise), gravity)
        taylor.keep_rates(lane.rates1, i, rates1)
        taylor.keep_rates(lane.rates2, i, rates2)
        ends = (
            angles[0] + taylor.travel(rates1, 1.0),
            angles[1] + taylor.travel(rates2, 1.0),
        )
        end_turns = taylor.rate_at(rates1, 1.0), taylor.rate_at(rates2, 1.0)
        bends = rates1[1], rates2[1]
        flag = _flag(lane, i, (angles, turns, bends), (ends, end_turns))
        lane.flag[i] = WITHIN if (flag == QUIET) & (span < left) else flag
        _keep_start(lane, i, angles, velocities)
        lane.was_ground[i] = a
        lane.was_left[i] = left
        per = 1.0 / span
        end_velocities = end_turns[0] * per, end_turns[1] * per
        lane.theta1[i], lane.theta2[i] = ends
        lane.omega1[i], lane.omega2[i] = end_velocities
        lane.ground[i] = a + rise if span < left else a_end
        if upward:
            lane.was_weight[i] = u
            lane.weight[i] = u + lift if span < left else u_end
        lane.part_left[i] = left - span if span < left else 1.0
        _keep_extremes(lane, i, ends, end_velocities)


@inlined_kernel
def _rates(lane, i, span, angles, turns, ground, gravity):
    """Taylor coefficients of both rotations over a step of lane i, ``span`` long, time counted in steps.

    ``turns``: θ1' and θ2' as it begins; ``ground`` and ``gravity`` as of :func:`rates_of_two`.
    """
    scale = span * span
    s1, c1 = taylor.quick_sine_cosine(angles[0])
    s2, c2 = taylor.quick_sine_cosine(angles[1])
    # sine and cosine of θ2 - θ1
    sd = s2 * c1 - c2 * s1
    cd = c2 * c1 + s2 * s1
    e, f = lane.e[i], lane.f[i]
    v1x, v1y = scale * lane.v1x[i], scale * lane.v1y[i]
    v2x, v2y = scale * lane.v2x[i], scale * lane.v2y[i]
    mass = lane.m11[i], lane.m22[i], e * cd + f * sd, f * cd - e * sd
    weight1 = v1y * c1 - v1x * s1, v1x * c1 + v1y * s1
    weight2 = v2y * c2 - v2x * s2, v2x * c2 + v2y * s2
    return rates_of_two(mass, weight1, weight2, turns, ground, gravity)


@inlined_kernel
def _flag(lane, i, begin, end):
    """Flag of a step of lane i: a contact CLOSES, NEARS (it may close and open again, or a body lies), or QUIET.

    ``begin`` has angles and their first and second derivatives, ``end`` angles and first ones, by time in steps;
    each is a pair, of pedestal and statue. The interface opens by the difference of both.
    """
    (angle1, angle2), (turn1, turn2), (bend1, bend2) = begin
    (end1, end2), (end_turn1, end_turn2) = end
    side1, side2 = lane.side1[i], lane.side2[i]
    gap1, out1, out1_end = side1 * angle1, side1 * turn1, side1 * end_turn1
    gap2, out2 = side2 * (angle2 - angle1), side2 * (turn2 - turn1)
    out2_end = side2 * (end_turn2 - end_turn1)
    closes = (side1 * end1 < 0.0) | (side2 * (end2 - end1) < 0.0)
    near = dips(gap1, out1, out1_end) | hops(gap1, out1, out1_end, side1 * bend1)
    near |= dips(gap2, out2, out2_end)
    near |= hops(gap2, out2, out2_end, side2 * (bend2 - bend1))
    lies = (max(abs(end1), abs(end2)) >= HALF_TURN) | (abs(end2 - end1) >= HALF_TURN)
    flag = CLOSES if closes else QUIET
    return NEARS if near | lies else flag


@inlined_kernel
def _keep_start(lane, i, angles, velocities):
    """Store the angles and the velocities, per sample, with which a step of lane i began."""
    lane.was_theta1[i], lane.was_theta2[i] = angles
    lane.was_omega1[i], lane.was_omega2[i] = velocities


@inlined_kernel
def _keep_extremes(lane, i, angles, velocities):
    """Store the extremes so far of lane i before its step, and take the end of the step into them."""
    lane.was_ratio1[i], lane.was_ratio2[i] = lane.ratio1[i], lane.ratio2[i]
    lane.was_fast[i], lane.was_near[i] = lane.fast[i], lane.near[i]
    state = angles[0], velocities[0], angles[1], velocities[1]
    ratio1, ratio2, fast, near = nearest(lane, i, state)
    lane.ratio1[i], lane.ratio2[i] = ratio1, ratio2
    lane.fast[i], lane.near[i] = fast, near


@inlined_kernel
def take_series(lane, i, series):
    """Copy the Taylor coefficients of both angles over the step of lane i into a record SERIES."""
    first, two = series.one.angle, series.two.angle
    span = span_of(lane.was_left[i], lane.part[i])
    first[0], first[1] = lane.was_theta1[i], lane.was_omega1[i] * span
    two[0], two[1] = lane.was_theta2[i], lane.was_omega2[i] * span
    for n in range(taylor.ORDER - 1):
        first[2 + n] = lane.rates1[n, i] * (1.0 / (n + 2))
        two[2 + n] = lane.rates2[n, i] * (1.0 / (n + 2))


@inlined_kernel
def next_contact_event(c1, c2, flag, series):
    """Find the first closing in a step: its time [-], NEVER if none, and whether ground and interface close.

    ``c1``, ``c2``: contact states; ``flag``: of the step; ``series``: of its angles.
    """
    if flag != CLOSES:
        # a gap may dip below zero and come back
        return first_closing(c1, c2, series)
    # a gap is negative at the end, so that it has one root to be found
    when1 = NEVER
    when2 = NEVER
    if fill_gap(series, GROUND, c1) < 0.0:
        when1 = crossing_time(series.gap)
    if fill_gap(series, INTERFACE, c2) < 0.0:
        when2 = crossing_time(series.gap)
    when = min(when1, when2)
    return when, when1 <= when + TOGETHER, when2 <= when + TOGETHER


@inlined_kernel
def nearest(lane, i, state):
    """Extremes of lane i up to a state: largest θ/θcritical of both, |θ2'|, least distance from balance squared.

    ``state``: θ1, θ1', θ2, θ2' [rad, rad per sample], at a contact event or at the end of a step.
    """
    theta1, omega1, theta2, omega2 = state
    ratio1 = lane.per_angle1[i] * theta1
    ratio2 = lane.per_angle2[i] * theta2
    away1 = (1.0 - ratio1) * (1.0 - ratio1) + lane.per_speed1[i] * omega1 * omega1
    away2 = (1.0 - ratio2) * (1.0 - ratio2) + lane.per_speed2[i] * omega2 * omega2
    return (
        max(lane.was_ratio1[i], ratio1),
        max(lane.was_ratio2[i], ratio2),
        max(lane.was_fast[i], abs(omega2)),
        min(lane.was_near[i], min(away1, away2)),
    )
