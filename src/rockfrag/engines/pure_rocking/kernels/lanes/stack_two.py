"""Stacks side by side of which both blocks rotate, the ground and the interface being open.

One pass advances every lane by one step, which ends with its sample or takes the largest part of it that is
allowed. Time is counted in samples.
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


@inlined_kernel
def span_of(left, part):
    """Length of a step with so much of the sample left and so large a part of it allowed."""
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
    """Advance every lane by a step: to the end of its sample (QUIET), or WITHIN it; see ``stack_one._advance``."""
    for i in range(LANES):
        left = lane.part_left[i]
        span = span_of(left, lane.part[i])
        scale = span * span
        t1 = lane.theta1[i]
        t2 = lane.theta2[i]
        omega1 = lane.omega1[i]
        omega2 = lane.omega2[i]
        w1 = omega1 * span
        w2 = omega2 * span
        a = lane.ground[i]
        a_end = lane.ground_end[i]
        u = lane.weight[i] if upward else 1.0
        u_end = lane.weight_end[i] if upward else 1.0
        rise = (a_end - a) * (span / left)
        lift = (u_end - u) * (span / left)
        s1, c1 = taylor.quick_sine_cosine(t1)
        s2, c2 = taylor.quick_sine_cosine(t2)
        sd = s2 * c1 - c2 * s1
        cd = c2 * c1 + s2 * s1
        e = lane.e[i]
        f = lane.f[i]
        v1x = scale * lane.v1x[i]
        v1y = scale * lane.v1y[i]
        v2x = scale * lane.v2x[i]
        v2y = scale * lane.v2y[i]
        rates1, rates2 = taylor.rates_of_two(
            (lane.m11[i], lane.m22[i], e * cd + f * sd, f * cd - e * sd),
            (v1y * c1 - v1x * s1, v1x * c1 + v1y * s1),
            (v2y * c2 - v2x * s2, v2x * c2 + v2y * s2),
            (w1, w2), (a, rise), (g * u, g * lift, upward),
        )  # fmt: skip
        n1 = t1 + taylor.travel(rates1, 1.0)
        n2 = t2 + taylor.travel(rates2, 1.0)
        z1 = taylor.rate_at(rates1, 1.0)
        z2 = taylor.rate_at(rates2, 1.0)
        taylor.keep_rates(lane.rates1, i, rates1)
        taylor.keep_rates(lane.rates2, i, rates2)
        # a contact closes, nearly closes, or may close and open again
        side1 = lane.side1[i]
        side2 = lane.side2[i]
        gap1, out1, end1, bend1 = side1 * t1, side1 * w1, side1 * z1, side1 * rates1[1]
        gap2, out2, end2 = side2 * (t2 - t1), side2 * (w2 - w1), side2 * (z2 - z1)
        bend2 = side2 * (rates2[1] - rates1[1])
        closes = (side1 * n1 < 0.0) | (side2 * (n2 - n1) < 0.0)
        near = dips(gap1, out1, end1) | hops(gap1, out1, end1, bend1)
        near |= dips(gap2, out2, end2) | hops(gap2, out2, end2, bend2)
        lies = (max(abs(n1), abs(n2)) >= HALF_TURN) | (abs(n2 - n1) >= HALF_TURN)
        flag = WITHIN if span < left else QUIET
        flag = CLOSES if closes else flag
        flag = NEARS if near | lies else flag
        lane.flag[i] = flag
        lane.was_theta1[i] = t1
        lane.was_omega1[i] = omega1
        lane.was_theta2[i] = t2
        lane.was_omega2[i] = omega2
        lane.was_ground[i] = a
        lane.was_left[i] = left
        per = 1.0 / span
        z1 = z1 * per
        z2 = z2 * per
        lane.theta1[i] = n1
        lane.omega1[i] = z1
        lane.theta2[i] = n2
        lane.omega2[i] = z2
        lane.ground[i] = a + rise if span < left else a_end
        if upward:
            lane.was_weight[i] = u
            lane.weight[i] = u + lift if span < left else u_end
        lane.part_left[i] = left - span if span < left else 1.0
        was_ratio1, was_ratio2 = lane.ratio1[i], lane.ratio2[i]
        was_fast, was_near = lane.fast[i], lane.near[i]
        lane.was_ratio1[i], lane.was_ratio2[i] = was_ratio1, was_ratio2
        lane.was_fast[i], lane.was_near[i] = was_fast, was_near
        ratio1 = lane.per_angle1[i] * n1
        ratio2 = lane.per_angle2[i] * n2
        away1 = (1.0 - ratio1) * (1.0 - ratio1) + lane.per_speed1[i] * z1 * z1
        away2 = (1.0 - ratio2) * (1.0 - ratio2) + lane.per_speed2[i] * z2 * z2
        lane.ratio1[i] = max(was_ratio1, ratio1)
        lane.ratio2[i] = max(was_ratio2, ratio2)
        lane.fast[i] = max(was_fast, abs(z2))
        lane.near[i] = min(was_near, min(away1, away2))


@inlined_kernel
def take_series(lane, i, series):
    """Copy the series of a lane's step out."""
    first, two = series.one.angle, series.two.angle
    span = span_of(lane.was_left[i], lane.part[i])
    first[0], first[1] = lane.was_theta1[i], lane.was_omega1[i] * span
    two[0], two[1] = lane.was_theta2[i], lane.was_omega2[i] * span
    for n in range(taylor.ORDER - 1):
        first[2 + n] = lane.rates1[n, i] * (1.0 / (n + 2))
        two[2 + n] = lane.rates2[n, i] * (1.0 / (n + 2))


@inlined_kernel
def next_contact_event(c1, c2, flag, series):
    """Time in a step of its first closing, NEVER if there is none; whether ground and interface close."""
    if flag != CLOSES:
        return first_closing(c1, c2, series)
    when1 = NEVER
    when2 = NEVER
    if fill_gap(series, GROUND, c1) < 0.0:
        when1 = crossing_time(series.gap)
    if fill_gap(series, INTERFACE, c2) < 0.0:
        when2 = crossing_time(series.gap)
    when = min(when1, when2)
    return when, when1 <= when + 1e-13, when2 <= when + 1e-13


@inlined_kernel
def nearest(lane, i, state):
    """Largest θ/θcritical of both, |θ2'|, least distance from balance squared, up to a contact event."""
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
