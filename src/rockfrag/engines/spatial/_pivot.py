"""One step of a body that turns about one contact that sticks: a vertex of its base, or the lowest point of a rim.

Attitude and angular velocity are all that there is to integrate: where the centre of mass is and how fast it moves
follows from them, but for the way that a rim rolls.

In: a state and a mode with one such contact. Out: the state at the end of a step, the force there and the error.
Theory: ``docs/space.md``, equation 4.

``turned``, shape (TURNING,), is what is integrated: quaternion, angular velocity in the body [rad/s], place in the
plan [m] and work of the ground's motion [J/kg].
"""

import math

from rockfrag.engines.compile.jit import inlined_kernel, kernel
from rockfrag.engines.pure_rocking.kernels.dormand_prince import (
    INSTANTS,
    WEIGHTS,
    error_rate,
)
from rockfrag.engines.spatial import _body as solid
from rockfrag.engines.spatial._algebra import (
    cross,
    dot,
    plus,
    rotation,
    rotation_of,
    scaled,
    to_body,
    to_world,
)
from rockfrag.engines.spatial._forces import (
    GRAVITY,
    STAGES,
    TURNING,
    effective_gravity_at,
    pivot_acceleration,
)

# where what is integrated has the attitude, the angular velocity, the place in the plan and the work
ATTITUDE, SPIN, PLAN, WORK = 0, 4, 7, TURNING - 1


@kernel
def fill_turning(y, turned):
    """Fill ``turned`` with what is integrated of a state y."""
    for i in range(4):
        turned[ATTITUDE + i] = y[solid.ATTITUDE + i]
    for i in range(3):
        turned[SPIN + i] = y[solid.SPIN + i]
    for i in range(2):
        turned[PLAN + i] = y[solid.PLACE + i]
    turned[WORK] = y[solid.WORK]


@kernel
def turning_rates(body, tau, turned, slope, s):
    """Fill ``slope`` with the rates of ``turned``; return the attitude, the force and the velocity.

    Returned are the rows of R, the force at the contact [N/kg] and the velocity of the centre of mass [m/s], both
    in the body. The contact is at rest, so that the velocity is p × ω, p its arm.
    """
    w, x, i, z = turned[0], turned[1], turned[2], turned[3]
    omega = (turned[4], turned[5], turned[6])
    rows = rotation_of(w, x, i, z)
    weight = to_body(rows, effective_gravity_at(s.field, tau))
    contact = s.closed[0]
    p, biased = solid.arm_and_bias(body, rows[2], omega, contact)
    alpha, force = pivot_acceleration(body, p, biased, omega, weight, contact, s)
    velocity = cross(p, omega)
    slope[0] = -0.5 * (x * omega[0] + i * omega[1] + z * omega[2])
    slope[1] = 0.5 * (w * omega[0] + i * omega[2] - z * omega[1])
    slope[2] = 0.5 * (w * omega[1] + z * omega[0] - x * omega[2])
    slope[3] = 0.5 * (w * omega[2] + x * omega[1] - i * omega[0])
    slope[4], slope[5], slope[6] = alpha
    slope[7], slope[8] = dot(rows[0], velocity), dot(rows[1], velocity)
    slope[WORK] = dot(plus(weight, scaled(s.field[GRAVITY], rows[2])), velocity)
    return rows, force, velocity


@kernel
def begin(body, tau, y, s):
    """Fill s.turning[0] with the rates at the beginning of a step."""
    fill_turning(y, s.turned)
    turning_rates(body, tau, s.turned, s.turning[0], s)


@kernel
def go_on(s):
    """Take the rates at the end of the last step as those at the beginning of the next."""
    for i in range(TURNING):
        s.turning[0, i] = s.turning[STAGES - 1, i]


@kernel
def attempt(body, tau, h, y, s):
    """Step from y to s.new, with the force at the contact in s.lam; return the estimate of the error.

    A step h [s] of Dormand and Prince's pair, of which every stage asks for :func:`turning_rates`.
    """
    k, new = s.turning, s.turned
    fill_turning(y, s.turned_before)
    before = s.turned_before
    # written out, so that the compiler knows the weights
    blend(k, before, h, 1, new)
    turning_rates(body, tau + INSTANTS[1] * h, new, k[1], s)
    blend(k, before, h, 2, new)
    turning_rates(body, tau + INSTANTS[2] * h, new, k[2], s)
    blend(k, before, h, 3, new)
    turning_rates(body, tau + INSTANTS[3] * h, new, k[3], s)
    blend(k, before, h, 4, new)
    turning_rates(body, tau + INSTANTS[4] * h, new, k[4], s)
    blend(k, before, h, 5, new)
    turning_rates(body, tau + INSTANTS[5] * h, new, k[5], s)
    blend(k, before, h, 6, new)
    size = math.sqrt(new[0] ** 2 + new[1] ** 2 + new[2] ** 2 + new[3] ** 2)
    for i in range(4):
        new[i] /= size
    rows, force, velocity = turning_rates(body, tau + h, new, k[STAGES - 1], s)
    s.lam[0, 0], s.lam[0, 1], s.lam[0, 2] = to_world(rows, force)
    write_state(body, y, rows, velocity, s)
    return error_of(body, h, y, s)


@inlined_kernel
def blend(k, before, h, stage, new):
    """Fill ``new`` with the state at which a stage of the step h is looked at, from the rates k before it."""
    for i in range(TURNING):
        rate = WEIGHTS[stage, 0] * k[0, i]
        for early in range(1, stage):
            rate += WEIGHTS[stage, early] * k[early, i]
        new[i] = before[i] + h * rate


@kernel
def write_state(body, y, rows, velocity, s):
    """Write the state s.new that belongs to attitude and angular velocity at the end of a step.

    ``velocity`` is that of the centre of mass in the body [m/s].
    """
    new, turned = s.new, s.turned
    contact = s.closed[0]
    moved = to_world(rows, solid.arm(body, rows[2], contact))
    rolls, forwards = contact == solid.rim_contact(body), to_world(rows, velocity)
    for i in range(2):
        # a rim goes where it rolls, a vertex stays
        stays = s.anchor[0, i] - moved[i]
        new[solid.PLACE + i] = turned[PLAN + i] if rolls else stays
    new[solid.PLACE + 2] = -moved[2]
    for i in range(4):
        new[solid.ATTITUDE + i] = turned[ATTITUDE + i]
    for i in range(3):
        new[solid.VELOCITY + i] = forwards[i]
        new[solid.SPIN + i] = turned[SPIN + i]
    new[solid.WORK], new[solid.FRICTION] = turned[WORK], y[solid.FRICTION]


@kernel
def error_of(body, h, y, s):
    """Largest error, by the step of order 4, of attitude and angular velocity, or of what they move."""
    worst, weight = 0.0, solid.weight_of_attitude(body, y)
    p = solid.arm(body, rotation(y)[2], s.closed[0])
    for i in range(WORK):
        scale = weight if i < SPIN else 1.0 + abs(s.turned_before[i])
        worst = max(worst, abs(h * error_rate(s.turning, i)) / scale)
    # an error of a component of the quaternion is half of that of the attitude
    return worst * max(1.0, 2.0 * math.sqrt(dot(p, p)))
