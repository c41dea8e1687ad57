"""One step of a body that rocks about an edge of its base, whose ends both stick: one angle, as a power series.

With the edge e, the effective gravity w as the body sees it at the beginning of the step and r its rate, d from
the edge to the centre of mass and I the inertia about the edge, all for a unit of mass, the angle ϑ that the body
turns by in the step obeys

    I ϑ'' = e·(d × (w + r t)) cos ϑ + [(d·e) e - d]·(w + r t) sin ϑ

In: a state and a mode with two such contacts. Out: the state at the end of a step, the forces there and the error.
Theory: ``docs/space.md``, equations 8, 13 and 22.
"""

from rockfrag.base.elementary import sin_cos
from rockfrag.engines.algebra.vectors import (
    cross,
    dot,
    minus,
    normalise,
    rotation,
    scaled,
    times,
    to_body,
    to_world,
)
from rockfrag.engines.compile.jit import kernel
from rockfrag.engines.spatial import _body as solid
from rockfrag.engines.spatial import _case as case
from rockfrag.engines.spatial import _closed_forms as closed

ORDER = case.HINGE_ORDER


@kernel
def attempt(body, tau, h, y, s):
    """Step from y to s.new, with the forces at both ends in s.lam; return the estimate of the error [rad/s].

    The error is the last term of the series of the angular velocity. ``tau`` is the time in the interval, ``h``
    the step [s].
    """
    rows = rotation(y)
    edge = closed.edge_of(body, rows[2], s)
    p, e, _ = edge
    inertia = dot(e, times(body.about[s.closed[0]], e))
    field = s.field
    weight = to_body(rows, case.effective_gravity_at(field, tau))
    rate = scaled(h, to_body(rows, (field[3], field[4], field[5])))
    # arms about the edge, as it is and after a quarter of a turn: e × d and (d·e) e - d of equation 8, with d = -p
    upright = cross(p, e)
    turned = minus(p, scaled(dot(p, e), e))
    scale = h * h / inertia
    started = h * dot(e, solid.omega_of(y))
    fill_series(
        s,
        started,
        (scale * dot(upright, weight), scale * dot(turned, weight)),
        (scale * dot(upright, rate), scale * dot(turned, rate)),
    )
    angle, speed = sums(s)
    rows = write_state(y, e, p, (angle, speed / h), s)
    lifted = s.field[case.GRAVITY] * (s.new[solid.HEIGHT] - y[solid.HEIGHT])
    # the work of the moment is what the energy of the turn has grown by
    work = 0.5 * inertia * (speed * speed - started * started) / (h * h)
    s.new[solid.WORK] = y[solid.WORK] + work + lifted
    weight = to_body(rows, case.effective_gravity_at(field, tau + h))
    closed.edge_forces(body, rows, edge, speed / h, weight, s)
    return abs(s.angle[ORDER]) * ORDER / h


@kernel
def fill_series(s, speed, moment, growth):
    """Fill in the series of the angle and of its sine and cosine, for a time t that runs from 0 to 1.

    angle'' = (m₀ + g₀ t) cosine + (m₁ + g₁ t) sine, sine' = cosine angle', cosine' = -sine angle'; element k of
    each is the coefficient of tᵏ. ``speed`` is the angular velocity times the step h [rad], and ``moment``, m, and
    its ``growth``, g, are moments times h² over the inertia [rad].
    """
    angle, sine, cosine = s.angle, s.sine, s.cosine
    angle[0], angle[1] = 0.0, speed
    sine[0], cosine[0] = 0.0, 1.0
    for k in range(ORDER - 1):
        total = moment[0] * cosine[k] + moment[1] * sine[k]
        if k > 0:
            total += growth[0] * cosine[k - 1] + growth[1] * sine[k - 1]
        angle[k + 2] = total / ((k + 1) * (k + 2))
        rises, falls = 0.0, 0.0
        for j in range(k + 1):
            turns = (k + 1 - j) * angle[k + 1 - j]
            rises += cosine[j] * turns
            falls += sine[j] * turns
        sine[k + 1], cosine[k + 1] = rises / (k + 1), -falls / (k + 1)


@kernel
def sums(s):
    """Angle at the end of a step [rad], and its rate times the step [rad]."""
    angle = s.angle
    turned, speed = 0.0, 0.0
    for k in range(ORDER, 0, -1):
        turned += angle[k]
        speed += k * angle[k]
    return turned, speed


@kernel
def landing(body, y, i, part, below, s):
    """Part of a step after which an open point is ``below`` the ground, by Newton's method from one near it.

    ``y`` is the state at the beginning of the step, whose series are those of ``s``. A point at d from an end of
    the edge is at the height (d·e)(e·k) + [d - (d·e) e]·k cos ϑ + (e × d)·k sin ϑ over it, with k upwards.
    """
    up = rotation(y)[2]
    p, e, _ = closed.edge_of(body, up, s)
    d = minus(solid.arm(body, up, i), p)
    level = dot(d, e) * dot(e, up)
    upright, turned = dot(d, up) - level, dot(cross(e, d), up)
    for _ in range(4):
        value, rate = 0.0, 0.0
        for k in range(ORDER - 1, -1, -1):
            rate = rate * part + value
            value = value * part + upright * s.cosine[k] + turned * s.sine[k]
        part -= (value + level + below) / rate
    return part


@kernel
def write_state(y, e, p, turned, s):
    """Write the state after a turn about the edge to s.new; return the rows of its attitude.

    ``e`` and ``p`` are the edge's direction and its first end from the centre of mass, in the body, and ``turned``
    the angle of the turn and its rate.
    """
    new = s.new
    # the attitude before, times the quaternion of the turn
    sine, cosine = sin_cos(0.5 * turned[0])
    a, b, c = sine * e[0], sine * e[1], sine * e[2]
    w, x, i, z = solid.attitude_of(y)
    attitude = (
        w * cosine - (x * a + i * b + z * c),
        x * cosine + (w * a + i * c - z * b),
        i * cosine + (w * b + z * a - x * c),
        z * cosine + (w * c + x * b - i * a),
    )
    solid.set_attitude(new, attitude)
    normalise(new)
    rows = rotation(new)
    omega = scaled(turned[1], e)
    # the edge stays where it is
    moved = to_world(rows, p)
    solid.set_place(new, s.anchor[0, 0] - moved[0], s.anchor[0, 1] - moved[1])
    new[solid.HEIGHT] = -moved[2]
    solid.set_velocity(new, to_world(rows, cross(p, omega)))
    solid.set_spin(new, omega)
    new[solid.FRICTION] = y[solid.FRICTION]
    return rows
