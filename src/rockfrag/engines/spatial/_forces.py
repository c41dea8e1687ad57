"""Accelerations and contact forces of a mode: which points are closed, and which of them slide.

In: a record ``BODY``, a state y, the ground's acceleration [m/s²] and a mode. Out: dy/dt, and the forces of the
closed points [N/kg]. Theory: ``docs/space.md``, equations 2 to 4; a face that
slides 6 and 7.
"""

import math

import numpy as np

from rockfrag.base.arrays import fields, whole
from rockfrag.engines.compile.jit import inlined_kernel, kernel
from rockfrag.engines.spatial import _algebra as algebra
from rockfrag.engines.spatial import _body as solid
from rockfrag.engines.spatial._algebra import (
    cross,
    dot,
    factor,
    minus,
    norm,
    plus,
    rotation,
    scaled,
    solve_symmetric,
    substitute,
    times,
    to_body,
    to_world,
)

MOST = 4  # contacts that carry at once
MOST_NEAR = 16  # contacts that a step of time stepping looks at
STICKS, SLIDES = 0, 1
FLIGHT, PIVOT, HINGE, GENERAL, REST, SLIDER = 0, 1, 2, 3, 4, 5
# slip velocity below which a point slips in the direction noted, if at all [m/s]
SLIP_FLOOR = 1e-4
# part of the largest compliance that is added to all, so that redundant forces are the least ones [-]
SOFTNESS = 1e-9
STAGES = 7
# of the series of an angle in a step
HINGE_ORDER = 7
# what is integrated of a body on one contact that sticks: attitude, angular velocity, place in the plan, work
TURNING = 10

CASE = np.dtype(
    [
        # the mode: number of closed points, whether it rests; whether nothing holds but what sticks, so that cones
        # are not looked at; whether the rates at the end of the last step are still right
        *whole("count rests jammed goes_on"),
        # numbers of the closed points, and which of them slide ...
        *whole("closed slides", MOST),
        *fields("direction anchor", MOST, 2),  # ... and where to, or where they stick
        *fields(
            "lam", MOST, 3
        ),  # contact forces or impulses, along each contact and across it
        # effective gravity at the beginning of the interval, its rate, and gravity on ground at rest
        *fields("field", 7),
        # a small system: contacts, whether and which way of slip is given; whether they slipped before an impact,
        # and where to; coefficients of what slides, of what has not slipped, of what sticks (tried, and chosen);
        # directions between
        *whole("which given slid", MOST),
        *fields("way came", MOST, 2),
        # velocities (or accelerations) of contacts but for the body's rotation, in the body
        *fields("load", MOST, 3),
        *fields("friction holds grip best_grip", MOST),
        *fields("edge", MOST, MOST, 2),
        *fields("delassus matrix", 3 * MOST, 3 * MOST),
        *fields("free vector right unknown impulse after best trial kept", 3 * MOST),
        *whole("order", 3 * MOST),
        *whole("member", MOST),  # contacts of a set
        # a step: rates at its stages, the state at its end, slip at its beginning
        *fields("slopes", STAGES, solid.SIZE),
        *fields("new", solid.SIZE),
        # rates of a body that turns about one contact, at the beginning and at the end of a step
        *fields("turning", 2, TURNING),
        # series of the angle of a body that rocks about an edge, and of its sine and cosine
        *fields("angle sine cosine", HINGE_ORDER + 1),
        *fields("slip", MOST, 2),
        *whole("armed", MOST),
        *whole("counters", 8),
        # largest horizontal and vertical acceleration of the ground soon [m/s²], and how long that is [s]
        *fields("soon", 3),
        # largest impulse of an impact along the ground beyond friction, for a unit of mass [m/s]
        *fields("beyond"),
        # velocity after an impact below which a point that touches stays closed [m/s]
        *fields("close"),
        # force and moment of the ties, in the body, for a unit of mass
        *fields("pulled twisted", 3),
        # whether a bond is whole; of each constraint whether it has broken, and whether a tie is taut; how often
        # it was hit, the largest impulse and force for a unit of mass, and when it broke [s]
        # time at the beginning of an interval [s]
        *whole("bonded"),
        *fields("began"),
        *whole("broken taut", solid.MOST_CONSTRAINTS),
        *fields("hits impact force breaks", solid.HOLDERS),
        # contacts near ground and walls in time stepping; how fast each may close [m/s], its friction, what an
        # impulse along each of its axes gives to its velocity there, its impulse for a unit of mass, and that by
        # which it is put in place
        *whole("near", MOST_NEAR),
        *fields("closes rubs moved", MOST_NEAR),
        *fields("gives shove", MOST_NEAR, 3),
    ],
    align=True,
)
"""What an analysis changes in place; its record goes through all kernels."""


@kernel
def at_wall(s):
    """Whether a closed point is at a wall."""
    found = False
    for k in range(s.count):
        found = found or s.closed[k] >= solid.WALLS
    return found


@kernel
def kind_of(s):
    """Kind of a mode."""
    n = s.count
    if s.rests:
        return REST
    if n == 0:
        return FLIGHT
    if at_wall(s):
        return GENERAL
    if n == 1:
        return PIVOT if s.slides[0] == STICKS else SLIDER
    if n == 2 and s.slides[0] == STICKS and s.slides[1] == STICKS:
        return HINGE
    return GENERAL


@kernel
def effective_gravity_at(field, tau):
    """Effective gravity in the world."""
    return (
        field[0] + field[3] * tau,
        field[1] + field[4] * tau,
        field[2] + field[5] * tau,
    )


@kernel
def stretch_of(body, y, rows, i):
    """Direction in the world from a tie's knot to its anchor, its length, and how fast that grows."""
    p = (body.knot[i, 0], body.knot[i, 1], body.knot[i, 2])
    at, u = to_world(rows, p), solid.point_velocity(y, rows, p)
    x, z, up = (
        body.anchor[i, 0] - y[solid.PLACE] - at[0],
        body.anchor[i, 1] - y[solid.PLACE + 1] - at[1],
        body.anchor[i, 2] - y[solid.UP] - at[2],
    )
    length = math.sqrt(x * x + z * z + up * up)
    way = (x / length, z / length, up / length)
    return way, length, -dot(way, u)


@kernel
def tie_margin(body, length, rate, i):
    """How far a tie is from its other state [m]: positive where it pulls, or a bracket pushes."""
    k, c = body.stiffness[i], body.damping[i]
    long = length - body.natural[i]
    pulls = min(long, long + c * rate / k)
    short = body.shortest[i] - length
    pushes = min(short, short - c * rate / k)
    return max(pulls, pushes) if body.shortest[i] > 0.0 else pulls


@kernel
def tie_force(body, length, rate, i):
    """Force with which a tie pulls, for a unit of mass; negative of a bracket that pushes."""
    k, c = body.stiffness[i], body.damping[i]
    if length > body.natural[i]:
        return max(k * (length - body.natural[i]) + c * rate, 0.0)
    if length < body.shortest[i]:
        return min(k * (length - body.shortest[i]) + c * rate, 0.0)
    return 0.0


@kernel
def fill_tie_forces(body, y, rows, s):
    """Fill in force and moment of the ties that have not broken, in the body."""
    for k in range(3):
        s.pulled[k] = s.twisted[k] = 0.0
    for i in range(body.constraints):
        if not body.ties[i] or s.broken[i]:
            continue
        way, length, rate = stretch_of(body, y, rows, i)
        force = scaled(tie_force(body, length, rate, i), to_body(rows, way))
        turned = cross((body.knot[i, 0], body.knot[i, 1], body.knot[i, 2]), force)
        for k in range(3):
            s.pulled[k] += force[k]
            s.twisted[k] += turned[k]


@kernel
def push_along(body, rows, i, axis):
    """Unit impulse along an axis of contact i, as the body sees it."""
    if i < solid.WALLS:
        return rows[axis]
    unit = (
        1.0 if axis == 0 else 0.0,
        1.0 if axis == 1 else 0.0,
        1.0 if axis == 2 else 0.0,
    )
    return to_body(rows, solid.from_frame(body, i, unit))


@kernel
def response(body, rows, p, q, push):
    """Velocity in the world of point p after an impulse, as the body sees it, at point q."""
    turn = times(body.inverse, cross(q, push))
    return to_world(rows, plus(push, cross(turn, p)))


@kernel
def twist_of(body, s):
    """Part of its distance from the centre at which the friction of a closed point acts; 1 but on a flat face.

    Pressed evenly, a face that spins is held by µ N times the mean distance of its points from the centre
    (``docs/space.md``), which is less than the distance of the points that carry it here.
    """
    if s.count < 3 or at_wall(s):
        return 1.0
    total = 0.0
    for k in range(s.count):
        p = body.points[s.closed[k]]
        total += norm(p[0] - body.centre[0], p[1] - body.centre[1])
    return body.twist * s.count / total


@kernel
def slip_of(body, y, rows, k, s):
    """Velocity of where friction acts on the closed point number k: two along its contact, one away from it [m/s].

    ``rows`` are the world's axes as the body sees them; ``rows[2]`` is the upward one.
    """
    p = solid.arm(body, rows[2], s.closed[k])
    # friction of a flat face acts nearer its centre, at the mean distance of its points
    if s.count >= 3:
        p = solid.towards_centre(body, p, twist_of(body, s))
    return solid.in_frame(body, s.closed[k], solid.point_velocity(y, rows, p))


@kernel
def fill_delassus(body, rows, which, n, delassus, twist=1.0):
    """Fill in the Delassus matrix W of n contacts: velocities u = W P by impulses P for a unit of mass.

    Row 3 i + k is the velocity of contact i and column 3 j + k the impulse at contact j, k along the contact (0,
    1) and across it (2). What is along the ground is at the part ``twist`` of a contact's distance from the centre
    (:func:`twist_of`), and what is across it at the contact itself.
    """
    up = rows[2]
    for j in range(n):
        q = solid.arm(body, up, which[j])
        rubs = solid.towards_centre(body, q, twist)
        for axis in range(3):
            at = q if axis == 2 else rubs
            push = push_along(body, rows, which[j], axis)
            for i in range(n):
                p = solid.arm(body, up, which[i])
                u = response(body, rows, p, at, push)
                if twist != 1.0:
                    p = solid.towards_centre(body, p, twist)
                    flat = response(body, rows, p, at, push)
                    u = (flat[0], flat[1], u[2])
                u = solid.in_frame(body, which[i], u)
                for k in range(3):
                    delassus[3 * i + k, 3 * j + axis] = u[k]


@kernel
def fill_velocities(body, y, rows, which, n, out, twist=1.0):
    """Fill in the velocities of n contacts ``which``: for each two along it and one away from it [m/s], (3 n,).

    Those along the ground are at the part ``twist`` of a contact's distance from the centre, where friction of a
    face that turns about the vertical acts.
    """
    for i in range(n):
        p = solid.arm(body, rows[2], which[i])
        u = solid.in_frame(body, which[i], solid.point_velocity(y, rows, p))
        out[3 * i], out[3 * i + 1], out[3 * i + 2] = u
        if twist != 1.0:
            p = solid.towards_centre(body, p, twist)
            out[3 * i], out[3 * i + 1], _ = solid.point_velocity(y, rows, p)


@kernel
def fill_accelerations(body, y, rows, weight, s, twist):
    """Fill s.free with the accelerations of closed points without contact forces, two along each and one across.

    ``weight`` is the effective gravity in the body, ``twist`` that of :func:`twist_of`, which is 1 beside walls.
    """
    omega, out, which = solid.omega_of(y), s.free, s.closed
    spin = solid.free_spin(body, omega, twist_by_ties(s))
    for i in range(s.count):
        p = solid.arm(body, rows[2], which[i])
        b = solid.bias(body, rows[2], omega, p, which[i])
        u = to_world(rows, plus(plus(weight, cross(spin, p)), b))
        u = solid.in_frame(body, which[i], u)
        out[3 * i], out[3 * i + 1], out[3 * i + 2] = u
        if twist != 1.0:
            p = solid.towards_centre(body, p, twist)
            b = solid.bias(body, rows[2], omega, p, which[i])
            u = to_world(rows, plus(plus(weight, cross(spin, p)), b))
            out[3 * i], out[3 * i + 1] = u[0], u[1]


@kernel
def slip_direction(s, i, u, v):
    """Direction of slip of contact i whose velocity in the plan is (u, v)."""
    speed = norm(u, v)
    if speed > SLIP_FLOOR:
        return u / speed, v / speed
    return s.direction[i, 0], s.direction[i, 1]


@kernel
def twist_by_ties(s):
    """Moment of the ties in the body, for a unit of mass."""
    return (s.twisted[0], s.twisted[1], s.twisted[2])


@kernel
def load_on(body, y, rows, gravity, s):
    """Effective gravity and the force of the ties, in the body, for a unit of mass; their moment is kept."""
    fill_tie_forces(body, y, rows, s)
    weight = to_body(rows, gravity)
    return plus(weight, (s.pulled[0], s.pulled[1], s.pulled[2]))


@inlined_kernel
def pivot_acceleration(body, p, turned, omega, weight, i, s):
    """Angular acceleration about a sticking point, the force at it, both in the body.

    ``p`` and ``turned`` are the point's arm and the part of its acceleration that comes from no acceleration.
    """
    load = plus(turned, weight)
    if i == solid.rim_contact(body):
        gyroscopic = cross(omega, times(body.inertia, omega))
        moment = minus(minus(twist_by_ties(s), gyroscopic), cross(p, load))
        alpha = turn_about(body, p, moment)
    else:
        # Euler's equation about the vertex, which is fixed in the body
        gyroscopic = cross(omega, times(body.about[i], omega))
        moment = minus(minus(twist_by_ties(s), gyroscopic), cross(p, weight))
        alpha = times(body.about_inverse[i], moment)
    return alpha, scaled(-1.0, plus(cross(alpha, p), load))


@kernel
def turn_about(body, p, moment):
    """Angular velocity (or acceleration) that a moment about the body's point p gives it if that point is held."""
    m = body.inertia
    square = dot(p, p)
    return solve_symmetric(
        m[0, 0] + square - p[0] * p[0], m[0, 1] - p[0] * p[1], m[0, 2] - p[0] * p[2],
        m[1, 1] + square - p[1] * p[1], m[1, 2] - p[1] * p[2], m[2, 2] + square - p[2] * p[2], moment,
    )  # fmt: skip


@kernel
def stop_point(body, up, i, load, momentum):
    """Angular velocity with which a body leaves an impact that stops point i, and the impulse, both in the body.

    ``load`` is the velocity of the point but for rotation, and ``momentum`` the angular momentum about the centre
    of mass, before; or accelerations and the moment.
    """
    p = solid.arm(body, up, i)
    moment = minus(momentum, cross(p, load))
    rolls = i == solid.rim_contact(body)
    inverse = body.about_inverse[i]
    alpha = turn_about(body, p, moment) if rolls else times(inverse, moment)
    force = scaled(-1.0, plus(cross(alpha, p), load))
    return alpha, force


@kernel
def stop_edge(body, up, i, j, first, second, momentum, small):
    """Angular velocity after an impact that stops points i and j, and its impulse.

    Returned are also the impulse at j but for its part along the edge, the edge's direction, and whether both can
    be stopped.  ``first`` and ``second`` are the loads of :func:`stop_point`: velocities at i and j but for those
    of rotation. With ω after the impact, the edge L e from i to j and the inertia J about i,

    - both stop if (first - second)·e = 0 and ω = e × (first - second) / L + σ e;
    - σ follows from the moment about the edge, e·J ω = e·(momentum - p × first);
    - the impulse is -(ω × p + first), and what turns the body otherwise is that at j, (J ω - moment) × e / L.
    """
    p, q = solid.arm(body, up, i), solid.arm(body, up, j)
    edge = minus(q, p)
    length = math.sqrt(dot(edge, edge))
    e = scaled(1.0 / length, edge)
    # a turn about the edge, beside that which makes up for different loads
    apart = minus(first, second)
    turn = scaled(1.0 / length, cross(e, apart))
    moment = minus(momentum, cross(p, first))
    about = body.about[i]
    left = minus(moment, times(about, turn))
    turn = plus(turn, scaled(dot(e, left) / dot(e, times(about, e)), e))
    push = scaled(-1.0, plus(cross(turn, p), first))
    far = scaled(1.0 / length, cross(minus(times(about, turn), moment), e))
    return turn, push, far, e, abs(dot(e, apart)) <= small


@kernel
def slide_on_one_point(body, y, rows, omega, free_spin, weight, s):
    """Force at the one closed contact, which slides, with its arm and its velocity (``docs/space.md``, 4).

    Friction is kinetic, against the slip, and the normal force is the one that keeps the contact from
    accelerating upwards.  In: the rows of the attitude, the angular velocity, and the angular acceleration and the
    effective gravity without the force, both in the body.  Out: the force [N/kg] and the arm [m] in the body, the
    velocity of the point in axes of the ground [m/s].
    """
    i = s.closed[0]
    up = rows[2]
    p = solid.arm(body, up, i)
    velocity = solid.point_velocity(y, rows, p)
    way = slip_direction(s, 0, velocity[0], velocity[1])
    # a unit of normal force, with the friction that comes with it, and how the point accelerates by it
    unit = to_body(rows, (-body.kinetic * way[0], -body.kinetic * way[1], 1.0))
    by_unit = plus(unit, cross(times(body.inverse, cross(p, unit)), p))
    bias = solid.bias(body, up, omega, p, i)
    without = plus(plus(weight, cross(free_spin, p)), bias)
    normal = -dot(up, without) / dot(up, by_unit)
    return scaled(normal, unit), p, velocity


@kernel
def edge_of(body, up, s):
    """Arm of the first of two closed contacts, the unit vector from it to the second, and their distance [m]."""
    p, q = solid.arm(body, up, s.closed[0]), solid.arm(body, up, s.closed[1])
    way = minus(q, p)
    length = math.sqrt(dot(way, way))
    return p, scaled(1.0 / length, way), length


@kernel
def edge_forces(body, rows, edge, spin, weight, s):
    """Fill s.lam with the forces at both ends of an edge that stick, for ``docs/space.md``, "Two that stick".

    ``edge`` is what :func:`edge_of` returns and ``spin`` the angular velocity about it [rad/s]; ``weight`` is in
    the body. Returned are the angular acceleration about the edge [rad/s²] and the sum of the forces, in the body.
    """
    p, e, length = edge
    twist = twist_by_ties(s)
    square = spin * spin
    inertia = dot(e, times(body.about[s.closed[0]], e))
    alpha = dot(e, minus(twist, cross(p, weight))) / inertia
    bias = scaled(square, minus(scaled(dot(e, p), e), p))
    force = scaled(-1.0, plus(plus(scaled(alpha, cross(e, p)), bias), weight))
    # but for its part along the edge, the force at the far end follows from the moment about the near one
    momentum = times(body.inertia, e)
    left = plus(scaled(alpha, momentum), scaled(square, cross(e, momentum)))
    left = minus(minus(left, twist), cross(p, force))
    far = scaled(1.0 / length, cross(left, e))
    share_force(body, rows, e, force, far, s)
    return alpha, force


@kernel
def share_force(body, rows, e, force, far, s):
    """Share the part of the force of an edge that is along it so that both ends hold if they can; fill s.lam."""
    far, edge = to_world(rows, far), to_world(rows, e)
    near = minus(to_world(rows, force), far)
    along = dot(near, edge)
    across = minus(near, scaled(along, edge))
    friction = body.static * body.static
    first = max(friction * across[2] ** 2 - across[0] ** 2 - across[1] ** 2, 0.0)
    second = max(friction * far[2] ** 2 - far[0] ** 2 - far[1] ** 2, 0.0)
    first, second = math.sqrt(first), math.sqrt(second)
    part = 0.5 if first + second == 0.0 else first / (first + second)
    for k in range(3):
        s.lam[0, k] = across[k] + part * along * edge[k]
        s.lam[1, k] = far[k] + (1.0 - part) * along * edge[k]


@kernel
def in_set(mask, i):
    """Whether contact i belongs to a set."""
    return (mask >> i) & 1


@kernel
def stick_together(s, n, mask, soft):
    """Solve for impulses at which all of a set stick (or slide the given way); the others get none."""
    size = 0
    for j in range(n):
        if not in_set(mask, j):
            continue
        for axis in range(2 if s.given[j] else 0, 3):
            row = 0
            for i in range(n):
                if not in_set(mask, i):
                    continue
                for k in range(2 if s.given[i] else 0, 3):
                    value = s.delassus[3 * i + k, 3 * j + axis]
                    if s.given[j]:
                        push = s.delassus[3 * i + k, 3 * j] * s.way[j, 0]
                        push += s.delassus[3 * i + k, 3 * j + 1] * s.way[j, 1]
                        value -= s.friction[j] * push
                    s.matrix[row, size] = value
                    s.right[row] = -s.free[3 * i + k]
                    row += 1
            size += 1
    for i in range(size):
        s.matrix[i, i] += soft
        s.unknown[i] = 0.0
    done = factor(s.matrix, s.order, size)
    # what the softness shifts one more pass with it as a reference removes
    for _ in range(3 if done else 0):
        for i in range(size):
            s.vector[i] = s.right[i] + soft * s.unknown[i]
        substitute(s.matrix, s.order, size, s.vector)
        for i in range(size):
            s.unknown[i] = s.vector[i]
    spread(s, n, mask)
    return done


@kernel
def push_by_two(s, sticks, slides, way, grip):
    """Solve for the impulses (or forces) of a contact a that sticks beside a contact b that slides a given way.

    With u = W P + free (``docs/space.md``, equation 5) and the ``way`` of slip, P_b = N (-grip way, 1). Contact a
    stops, W_aa P_a + W_ab P_b + u_a = 0, and b does not leave: the normal row of W_ba P_a + W_bb P_b + u_b = 0.
    P_a is linear in N, which follows from the latter.

    Returns
    -------
    P_a : along the contact, twice, and across it, for a unit of mass
    N : normal impulse at b
    unit : P_b over N
    """
    w, a, b = s.delassus, 3 * sticks, 3 * slides
    normal_row = b + 2
    unit = (-grip * way[0], -grip * way[1], 1.0)
    without = stop_at(w, a, (s.free[a], s.free[a + 1], s.free[a + 2]))
    by_unit = stop_at(w, a, effect(w, a, b, unit))
    # velocity of b across its contact: without an impulse there, and by a unit of it
    leaves = s.free[normal_row] + dot(row_of(w, normal_row, a), without)
    given = dot(row_of(w, normal_row, b), unit)
    given += dot(row_of(w, normal_row, a), by_unit)
    normal = -leaves / given
    return plus(without, scaled(normal, by_unit)), normal, unit


@kernel
def row_of(w, i, b):
    """Return what impulses at the contact whose first row is b do to one velocity."""
    return (w[i, b], w[i, b + 1], w[i, b + 2])


@kernel
def effect(w, a, b, push):
    """Velocity of the contact whose first row is a, by an impulse at that of row b."""
    return (
        dot(row_of(w, a, b), push),
        dot(row_of(w, a + 1, b), push),
        dot(row_of(w, a + 2, b), push),
    )


@kernel
def stop_at(w, a, velocity):
    """Impulse at the contact whose first row is a that takes a velocity of it away."""
    return solve_symmetric(
        w[a, a], w[a, a + 1], w[a, a + 2], w[a + 1, a + 1], w[a + 1, a + 2],
        w[a + 2, a + 2], scaled(-1.0, velocity),
    )  # fmt: skip


@kernel
def spread(s, n, mask):
    """Write the unknowns of a set to the impulses."""
    row = 0
    for i in range(n):
        x = y = z = 0.0
        if in_set(mask, i) and s.given[i]:
            z = s.unknown[row]
            x, y = -s.friction[i] * z * s.way[i, 0], -s.friction[i] * z * s.way[i, 1]
            row += 1
        elif in_set(mask, i):
            x, y, z = s.unknown[row], s.unknown[row + 1], s.unknown[row + 2]
            row += 3
        s.impulse[3 * i], s.impulse[3 * i + 1], s.impulse[3 * i + 2] = x, y, z


@kernel
def solve_general(body, y, rows, n, rubs, s):
    """Fill s.lam with the forces [N/kg] (or impulses) of the n closed contacts that undo s.free in a mode.

    What sticks is stopped in all directions; of what slides the normal velocity alone, with kinetic friction
    against its slip if it ``rubs`` (``docs/space.md``, "All others"). ``s.free`` holds the accelerations (or
    velocities) without these, two along each contact and one across it.
    """
    fill_delassus(body, rows, s.closed, n, s.delassus, twist_of(body, s))
    for i in range(n):
        u = slip_of(body, y, rows, i, s)
        s.way[i, 0], s.way[i, 1] = slip_direction(s, i, u[0], u[1])
        s.given[i], s.friction[i] = s.slides[i], 0.0
        if rubs:
            s.friction[i] = solid.kinetic_of(body, s.closed[i])
    # a wall may hold what the ground holds already, which leaves nothing to divide by
    on_ground = max(s.closed[0], s.closed[1]) < solid.WALLS
    one_slides = s.slides[0] != s.slides[1]
    if n == 2 and on_ground and one_slides:
        hold_beside_slider(s)
        return
    all_contacts = (1 << n) - 1
    stick_together(s, n, all_contacts, SOFTNESS * largest_compliance(s, n))
    for i in range(n):
        for k in range(3):
            s.lam[i, k] = s.impulse[3 * i + k]


@kernel
def hold_beside_slider(s):
    """Fill s.lam of two contacts of which one slides, an edge as in most of these modes, in closed form."""
    slides = 0 if s.slides[0] == SLIDES else 1
    way = (s.way[slides, 0], s.way[slides, 1])
    push, normal, unit = push_by_two(s, 1 - slides, slides, way, s.friction[slides])
    for k in range(3):
        s.lam[1 - slides, k], s.lam[slides, k] = push[k], normal * unit[k]


@kernel
def largest_compliance(s, n):
    """Largest diagonal entry of the Delassus matrix of n contacts."""
    largest = 0.0
    for i in range(3 * n):
        largest = max(largest, s.delassus[i, i])
    return largest


@kernel
def rates(body, tau, y, dy, s):
    """Fill in dy/dt, and the contact forces in world components.

    ``s.field`` holds the effective gravity at the beginning of the interval, its rate, and the gravity of a ground
    at rest; ``tau`` counts from there.
    """
    rows = rotation(y)
    omega = solid.omega_of(y)
    gravity = effective_gravity_at(s.field, tau)
    weight = load_on(body, y, rows, gravity, s)
    tied = (s.pulled[0], s.pulled[1], s.pulled[2])
    load = plus(gravity, to_world(rows, tied))
    kind = kind_of(s)
    lost = 0.0
    if kind == PIVOT:
        i = s.closed[0]
        p, turned = solid.arm_and_bias(body, rows[2], omega, i)
        alpha, force = pivot_acceleration(body, p, turned, omega, weight, i, s)
        pushed = to_world(rows, force)
        s.lam[0, 0], s.lam[0, 1], s.lam[0, 2] = pushed
        acceleration = plus(load, pushed)
    elif kind == HINGE:
        edge = edge_of(body, rows[2], s)
        turned, force = edge_forces(body, rows, edge, dot(edge[1], omega), weight, s)
        alpha = scaled(turned, edge[1])
        acceleration = plus(load, to_world(rows, force))
    elif kind == SLIDER:
        spin = solid.free_spin(body, omega, twist_by_ties(s))
        force, p, u = slide_on_one_point(body, y, rows, omega, spin, weight, s)
        pushed = to_world(rows, force)
        s.lam[0, 0], s.lam[0, 1], s.lam[0, 2] = pushed
        acceleration = plus(load, pushed)
        alpha = plus(spin, times(body.inverse, cross(p, force)))
        lost = -pushed[0] * u[0] - pushed[1] * u[1]
    else:
        alpha = solid.free_spin(body, omega, twist_by_ties(s))
        acceleration = load
        n = s.count
        if n > 0:
            twist = twist_of(body, s)
            fill_accelerations(body, y, rows, weight, s, twist)
            solve_general(body, y, rows, n, True, s)
            for i in range(n):
                push = (s.lam[i, 0], s.lam[i, 1], s.lam[i, 2])
                if s.slides[i]:
                    u = slip_of(body, y, rows, i, s)
                    lost -= push[0] * u[0] + push[1] * u[1]
                push = solid.from_frame(body, s.closed[i], push)
                acceleration = plus(acceleration, push)
                alpha = plus(alpha, turned_by(body, rows, s.closed[i], push, twist))
    fill_rates(y, omega, alpha, acceleration, dy)
    dy[solid.WORK] = (
        load[0] * y[solid.VELOCITY]
        + load[1] * y[solid.VELOCITY + 1]
        + (load[2] + s.field[6]) * y[solid.RISES]
    )
    dy[solid.WORK] += dot(twist_by_ties(s), omega)
    dy[solid.FRICTION] = lost


@kernel
def fill_rates(y, omega, alpha, acceleration, dy):
    """Fill in the rates of a state: those of place and attitude from its velocities, those of velocities as given.

    ``acceleration`` is that of the centre of mass in the world [m/s²], ``alpha`` the angular one in the body.
    """
    attitude = algebra.quaternion_rate(solid.attitude_of(y), omega)
    for k in range(3):
        dy[solid.PLACE + k] = y[solid.VELOCITY + k]
        dy[solid.VELOCITY + k] = acceleration[k]
        dy[solid.SPIN + k] = alpha[k]
    for k in range(4):
        dy[solid.ATTITUDE + k] = attitude[k]


@kernel
def turned_by(body, rows, i, push, twist):
    """Angular acceleration by a force, in axes of the ground, at contact i."""
    p = solid.arm(body, rows[2], i)
    if twist == 1.0:
        return times(body.inverse, cross(p, to_body(rows, push)))
    rubs = solid.towards_centre(body, p, twist)
    level = to_body(rows, (push[0], push[1], 0.0))
    moment = plus(cross(p, scaled(push[2], rows[2])), cross(rubs, level))
    return times(body.inverse, moment)


@kernel
def push_at(body, y, rows, i, impulse, twist=1.0):
    """Change the velocities in ``y`` by an impulse for a unit of mass, along contact i and across it."""
    impulse = solid.from_frame(body, i, impulse)
    turned = turned_by(body, rows, i, impulse, twist)
    for k in range(3):
        y[solid.VELOCITY + k] += impulse[k]
        y[solid.SPIN + k] += turned[k]
