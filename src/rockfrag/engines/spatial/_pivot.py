"""One step of a body that turns about one contact that sticks: a vertex of its base, or the lowest point of a rim.

Attitude and angular velocity are all that there is to integrate: where the centre of mass is and how fast it moves
follows from them. The way that a rim rolls and the work are integrals along the step. All of it is in numbers of
the function, none in arrays: what a stage waits for is then not the memory.

In: a state and a mode with one such contact. Out: the state at the end of a step, the force there and the error.
Theory: ``docs/space.md``, equation 4.

- ``turned``: the TURNING numbers of what turns, the quaternion and the angular velocity in the body [rad/s];
  ``rate``: their rates, k0 to k6 at the stages
- ``along``: rates of what is integrated along a step: place in the plan [m/s] and work of the ground's motion
  [W/kg], a0 to a6 at the stages; ``went``: what these sum up to in the step [m, J/kg]
"""

import math

from rockfrag.engines.algebra.vectors import (
    cross,
    dot,
    plus,
    quaternion_rate,
    rotation_of,
    scaled,
    to_body,
    to_world,
)
from rockfrag.engines.compile.jit import inlined_kernel, kernel
from rockfrag.engines.pure_rocking.kernels.dormand_prince import (
    ERRORS,
    INSTANTS,
    WEIGHTS,
)
from rockfrag.engines.spatial import _body as solid
from rockfrag.engines.spatial._case import (
    ALONG,
    GRAVITY,
    TURNING,
    effective_gravity_at,
)
from rockfrag.engines.spatial._closed_forms import pivot_acceleration


@inlined_kernel
def turning_rates(body, tau, turned, s):
    """Rates of what turns and of what is integrated along, and what is left to know of a state.

    Returned are ``rate``, ``along``, and the rows of R, the force at the contact [N/kg] and the velocity of the
    centre of mass [m/s], both in the body. The contact is at rest, so that the velocity is p × ω, p its arm.
    """
    w, x, y, z, a, b, c = turned
    omega = (a, b, c)
    rows = rotation_of(w, x, y, z)
    weight = to_body(rows, effective_gravity_at(s.field, tau))
    contact = s.closed[0]
    p, biased = solid.arm_and_bias(body, rows[2], omega, contact)
    alpha, force = pivot_acceleration(body, p, biased, omega, weight, contact, s)
    velocity = cross(p, omega)
    attitude = quaternion_rate((w, x, y, z), omega)
    rate = (*attitude, *alpha)
    along = (
        dot(rows[0], velocity),
        dot(rows[1], velocity),
        dot(plus(weight, scaled(s.field[GRAVITY], rows[2])), velocity),
    )
    return rate, along, (rows, force, velocity)


@inlined_kernel
def more(turned, part, rate):
    """Add a part of the rates to what turns."""
    return (
        turned[0] + part * rate[0],
        turned[1] + part * rate[1],
        turned[2] + part * rate[2],
        turned[3] + part * rate[3],
        turned[4] + part * rate[4],
        turned[5] + part * rate[5],
        turned[6] + part * rate[6],
    )


@inlined_kernel
def part_of(part, rate):
    """Part of the rates of what turns."""
    return (
        part * rate[0],
        part * rate[1],
        part * rate[2],
        part * rate[3],
        part * rate[4],
        part * rate[5],
        part * rate[6],
    )


@inlined_kernel
def turning_of(y):
    """Attitude and angular velocity of a state."""
    return (*solid.attitude_of(y), *solid.omega_of(y))


@kernel
def begin(body, tau, y, s):
    """Fill s.turning[0] with the rates at the beginning of a step."""
    rate, along, _ = turning_rates(body, tau, turning_of(y), s)
    keep(rate, along, 0, s)


@kernel
def go_on(s):
    """Take the rates at the end of the last step as those at the beginning of the next."""
    for i in range(TURNING + ALONG):
        s.turning[0, i] = s.turning[1, i]


@inlined_kernel
def keep(rate, along, end, s):
    """Fill s.turning with the rates at the beginning of a step (``end`` 0) or at its end (1)."""
    for i in range(TURNING):
        s.turning[end, i] = rate[i]
    for i in range(ALONG):
        s.turning[end, TURNING + i] = along[i]


@kernel
def attempt(body, tau, h, y, s):
    """Step from y to s.new, with the force at the contact in s.lam; return the estimate of the error.

    A step h [s] of Dormand and Prince's pair, of which every stage asks for :func:`turning_rates`.
    """
    k = s.turning
    before = turning_of(y)
    k0 = (k[0, 0], k[0, 1], k[0, 2], k[0, 3], k[0, 4], k[0, 5], k[0, 6])
    a0 = (k[0, 7], k[0, 8], k[0, 9])
    w = WEIGHTS
    k1, _, _ = turning_rates(
        body, tau + INSTANTS[1] * h, more(before, h * w[1, 0], k0), s
    )
    turned = more(part_of(w[2, 0], k0), w[2, 1], k1)
    k2, a2, _ = turning_rates(body, tau + INSTANTS[2] * h, more(before, h, turned), s)
    turned = more(more(part_of(w[3, 0], k0), w[3, 1], k1), w[3, 2], k2)
    k3, a3, _ = turning_rates(body, tau + INSTANTS[3] * h, more(before, h, turned), s)
    turned = more(more(part_of(w[4, 0], k0), w[4, 1], k1), w[4, 2], k2)
    turned = more(turned, w[4, 3], k3)
    k4, a4, _ = turning_rates(body, tau + INSTANTS[4] * h, more(before, h, turned), s)
    turned = more(more(part_of(w[5, 0], k0), w[5, 1], k1), w[5, 2], k2)
    turned = more(more(turned, w[5, 3], k3), w[5, 4], k4)
    k5, a5, _ = turning_rates(body, tau + INSTANTS[5] * h, more(before, h, turned), s)
    turned = more(more(part_of(w[6, 0], k0), w[6, 2], k2), w[6, 3], k3)
    turned = more(more(turned, w[6, 4], k4), w[6, 5], k5)
    turned = unit(more(before, h, turned))
    k6, a6, rest = turning_rates(body, tau + h, turned, s)
    keep(k6, a6, 1, s)
    went = scaled(h, summed(w[6], a0, a2, a3, a4, a5))
    write_state(body, y, turned, went, rest, s)
    e = ERRORS
    off = more(more(part_of(e[0], k0), e[2], k2), e[3], k3)
    off = more(more(more(off, e[4], k4), e[5], k5), e[6], k6)
    off_along = plus(summed(e, a0, a2, a3, a4, a5), scaled(e[6], a6))
    return h * error_of(body, before, off, off_along, s)


@kernel
def go_on_by(body, tau, rest, y, s):
    """Go on from s.new to the instant ``tau`` by a time ``rest`` [s] so short that the rates there suffice."""
    k, new = s.turning, s.new
    rate = (k[1, 0], k[1, 1], k[1, 2], k[1, 3], k[1, 4], k[1, 5], k[1, 6])
    went = (
        new[solid.PLACE] - y[solid.PLACE] + rest * k[1, 7],
        new[solid.PLACE + 1] - y[solid.PLACE + 1] + rest * k[1, 8],
        new[solid.WORK] - y[solid.WORK] + rest * k[1, 9],
    )
    turned = unit(more(turning_of(new), rest, rate))
    rate, along, then = turning_rates(body, tau, turned, s)
    keep(rate, along, 1, s)
    write_state(body, y, turned, went, then, s)


@inlined_kernel
def summed(w, a0, a2, a3, a4, a5):
    """Sum of what is integrated along a step over its stages, with their weights."""
    return (
        w[0] * a0[0] + w[2] * a2[0] + w[3] * a3[0] + w[4] * a4[0] + w[5] * a5[0],
        w[0] * a0[1] + w[2] * a2[1] + w[3] * a3[1] + w[4] * a4[1] + w[5] * a5[1],
        w[0] * a0[2] + w[2] * a2[2] + w[3] * a3[2] + w[4] * a4[2] + w[5] * a5[2],
    )


@inlined_kernel
def unit(turned):
    """Give the quaternion of what turns the length 1."""
    w, x, y, z, a, b, c = turned
    size = 1.0 / math.sqrt(w * w + x * x + y * y + z * z)
    return (w * size, x * size, y * size, z * size, a, b, c)


@inlined_kernel
def write_state(body, y, turned, went, rest, s):
    """Write the state that belongs to attitude and angular velocity at the end of a step to s.new.

    ``rest`` are the last three that :func:`turning_rates` returned there; the force goes to s.lam.
    """
    new = s.new
    rows, force, velocity = rest
    s.lam[0, 0], s.lam[0, 1], s.lam[0, 2] = to_world(rows, force)
    contact = s.closed[0]
    moved = to_world(rows, solid.arm(body, rows[2], contact))
    if contact == solid.rim_contact(body):
        # a rim goes where it rolls, a vertex stays
        x, z = y[solid.PLACE] + went[0], y[solid.PLACE + 1] + went[1]
    else:
        x, z = s.anchor[0, 0] - moved[0], s.anchor[0, 1] - moved[1]
    solid.set_place(new, x, z)
    new[solid.HEIGHT] = -moved[2]
    w, x, i, z, a, b, c = turned
    solid.set_attitude(new, (w, x, i, z))
    solid.set_velocity(new, to_world(rows, velocity))
    solid.set_spin(new, (a, b, c))
    new[solid.WORK] = y[solid.WORK] + went[2]
    new[solid.FRICTION] = y[solid.FRICTION]


@inlined_kernel
def error_of(body, before, off, off_along, s):
    """Largest error in a unit of time of attitude and angular velocity, or of what they move."""
    up = rotation_of(before[0], before[1], before[2], before[3])[2]
    weight = solid.weight_of_attitude(body, up)
    p = solid.arm(body, up, s.closed[0])
    attitude = max(max(abs(off[0]), abs(off[1])), max(abs(off[2]), abs(off[3])))
    worst = attitude / weight
    for i in range(4, TURNING):
        worst = max(worst, abs(off[i]) / (1.0 + abs(before[i])))
    worst = max(worst, max(abs(off_along[0]), abs(off_along[1])))
    # an error of a component of the quaternion is half of that of the attitude
    return worst * max(1.0, 2.0 * math.sqrt(dot(p, p)))
