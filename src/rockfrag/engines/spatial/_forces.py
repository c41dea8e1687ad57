"""Accelerations and contact forces of a mode: which points are closed, and which of them slide.

In: a record ``BODY``, a state y, the ground's acceleration [m/s²] and a mode. Out: dy/dt, and the forces of the
closed points [N/kg]. Theory: ``docs/space.md``, equations 2 to 4; a face that slides 6 and 7; systems of contacts
9 to 15.

- ``rows``: the world's axes as the body sees them, ``up`` = rows[2]; ``omega``: angular velocity in the body
- ``gravity``: effective gravity in the world [m/s²]; ``weight``: the same and the ties' force, in the body [N/kg]
- ``i``, ``j``: numbers of contacts, ``p``, ``q`` their arms from the centre of mass, in the body [m]
- ``s``: record ``CASE``; contact k of a small system has the rows 3 k, 3 k + 1 (along) and 3 k + 2 (away)
- ``twist``: part of its distance from the base's centre at which the friction of a contact acts (:func:`twist_of`)
"""

import math

import numpy as np

from rockfrag.base.arrays import fields, whole
from rockfrag.engines.algebra import vectors as algebra
from rockfrag.engines.algebra.vectors import (
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
from rockfrag.engines.compile.jit import inlined_kernel, kernel
from rockfrag.engines.spatial import _body as solid

MOST = 4  # contacts that carry at once
MOST_NEAR = 16  # contacts that a step of time stepping looks at
STICKS, SLIDES = 0, 1
# kinds of a mode: nothing closed; one contact that sticks; two; any other; at rest; one contact that slides
FLIGHT, PIVOT, HINGE, GENERAL, REST, SLIDER = 0, 1, 2, 3, 4, 5
# slip velocity below which a point slips in the direction noted, if at all [m/s]
SLIP_FLOOR = 1e-4
# part of the largest compliance that is added to all, so that redundant forces are the least ones [-]
SOFTNESS = 1e-9
LEAST_LOAD = 0.03  # part of all normal impulses that a contact counts with at least where they share [-]
PASSES = 3  # in which what the softness shifts is removed (equation 15)
# place of the gravity on ground at rest [m/s²] in s.field, behind the effective one and its rate
GRAVITY = 6
STAGES = 7
# of the series of an angle in a step
HINGE_ORDER = 7
# numbers that are integrated of a body on one contact that sticks: attitude and angular velocity, on which rates
# depend; and what follows along the step, the place in the plan and the work
TURNING, ALONG = 7, 3

CASE = np.dtype(
    [
        # the mode: number of closed points; whether the body rests; whether what is closed sticks whatever its
        # cone says (jammed); whether the rates at the end of the last step are those at the beginning of the next
        *whole("count rests jammed goes_on"),
        # numbers of the closed points, and which of them slide ...
        *whole("closed slides", MOST),
        *fields("direction anchor", MOST, 2),  # ... and where to, or where they stick
        *fields(
            "lam", MOST, 3
        ),  # contact forces or impulses, along each contact and across it
        # effective gravity at the beginning of the interval [m/s²], its rate [m/s³], and at GRAVITY that of a
        # ground at rest
        *fields("field", 7),
        # a small system of contacts that touch: their numbers (which); whether a contact slides along a unit
        # vector (given, way); whether it slipped before an impact, and where to (slid, came)
        *whole("which given slid", MOST),
        *fields("way came", MOST, 2),
        # velocities (or accelerations) of contacts but for the body's rotation, in the body
        *fields("load", MOST, 3),
        # coefficients of friction of a contact: kinetic (friction), static (holds), the one it is tried with
        # (grip), and that of the best set; unit vectors along the surface from contact to contact (edge)
        *fields("friction holds grip best_grip", MOST),
        *fields("edge", MOST, MOST, 2),
        # W of equation 10; velocities without impulses b (free), impulses P, velocities after them W P + b
        # (after), all along and away from each contact; the rest is memory of what solves for them
        *fields("delassus matrix", 3 * MOST, 3 * MOST),
        *fields("free vector right unknown impulse after best trial kept", 3 * MOST),
        *whole("order", 3 * MOST),
        *whole("member", MOST),  # contacts of a set
        # a step: rates at its stages, the state at its end, slip at its beginning
        *fields("slopes", STAGES, solid.SIZE),
        *fields("new", solid.SIZE),
        # rates of a body that turns about one contact, at the beginning and at the end of a step
        *fields("turning", 2, TURNING + ALONG),
        # series of the angle of a body that rocks about an edge, and of its sine and cosine
        *fields("angle sine cosine", HINGE_ORDER + 1),
        *fields("slip", MOST, 2),
        *whole("armed", MOST),
        *whole("counters", 8),
        # largest horizontal and vertical acceleration of the ground soon [m/s²], and how long that is [s]
        *fields("soon", 3),
        # largest impulse of an impact along the ground beyond friction, for a unit of mass [m/s]
        *fields("beyond"),
        # how soft contacts are along their surface, over the softness of all, and of each unknown
        *fields("yields", MOST),
        *fields("softness", 3 * MOST),
        # velocity after an impact below which a point that touches stays closed [m/s]
        *fields("close"),
        # force and moment of the ties, in the body, for a unit of mass [N/kg, N m/kg]
        *fields("pulled twisted", 3),
        # whether a bond is whole; of each constraint whether it has broken, and whether a tie is taut; how often
        # it was hit, the largest impulse and force for a unit of mass, and when it broke [s]
        # time at the beginning of an interval [s]
        *whole("bonded"),
        *fields("began"),
        *whole("broken taut", solid.MOST_CONSTRAINTS),
        *fields("hits impact force breaks", solid.HOLDERS),
        # contacts near ground and walls in time stepping, their numbers (near); how fast each may close in the
        # step (closes) [m/s]; its coefficient of friction (rubs); displacement away from its surface by which it
        # was put in place, as an impulse (moved) [m]; what a unit impulse along each of its axes gives to its
        # velocity along the same axis (gives) [-]; its impulse for a unit of mass (shove) [m/s]
        *whole("near", MOST_NEAR),
        *fields("closes rubs moved", MOST_NEAR),
        *fields("gives shove", MOST_NEAR, 3),
    ],
    align=True,
)
"""What an analysis changes in place; its record goes through all kernels."""


@kernel
def picks_wall(n, s):
    """Whether one of the n contacts of the small system, s.which, is of a corner with a wall."""
    found = False
    for k in range(n):
        found = found or s.which[k] >= solid.WALLS
    return found


@kernel
def at_wall(s):
    """Whether a closed point is a corner at a wall."""
    found = False
    for k in range(s.count):
        found = found or s.closed[k] >= solid.WALLS
    return found


@kernel
def kind_of(s):
    """Kind of a mode: REST, FLIGHT, PIVOT, SLIDER, HINGE or GENERAL, which is all that touches a wall too."""
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
    """Effective gravity in the world [m/s²] at the time tau in an interval [s]; ``field`` as in CASE."""
    return (
        field[0] + field[3] * tau,
        field[1] + field[4] * tau,
        field[2] + field[5] * tau,
    )


@kernel
def stretch_of(body, y, rows, i):
    """Unit vector in the world from tie i's knot to its anchor, its length [m], and how fast that grows [m/s]."""
    p = (body.knot[i, 0], body.knot[i, 1], body.knot[i, 2])
    at, u = to_world(rows, p), solid.point_velocity(y, rows, p)
    east, north, up = (
        body.anchor[i, 0] - y[solid.PLACE] - at[0],
        body.anchor[i, 1] - y[solid.PLACE + 1] - at[1],
        body.anchor[i, 2] - y[solid.HEIGHT] - at[2],
    )
    length = math.sqrt(east * east + north * north + up * up)
    way = (east / length, north / length, up / length)
    return way, length, -dot(way, u)


@kernel
def tie_margin(body, length, rate, i):
    """How far tie i is from its other state, taut or slack [m]: positive where it pulls, or a bracket pushes.

    ``length`` and ``rate`` are those of :func:`stretch_of`. It is taut if it is long and its force, k long + c
    rate, does not push; of a bracket also where it is short and pushes.
    """
    k, c = body.stiffness[i], body.damping[i]
    long = length - body.natural[i]
    pulls = min(long, long + c * rate / k)
    short = body.shortest[i] - length
    pushes = min(short, short - c * rate / k)
    return max(pulls, pushes) if body.shortest[i] > 0.0 else pulls


@kernel
def tie_force(body, length, rate, i):
    """Force with which tie i pulls [N/kg]; negative of a bracket that pushes (``docs/holding.md``)."""
    k, c = body.stiffness[i], body.damping[i]
    if length > body.natural[i]:
        return max(k * (length - body.natural[i]) + c * rate, 0.0)
    if length < body.shortest[i]:
        return min(k * (length - body.shortest[i]) + c * rate, 0.0)
    return 0.0


@kernel
def fill_tie_forces(body, y, rows, s):
    """Fill s.pulled [N/kg] and s.twisted [N m/kg], force and moment of the whole ties, in the body."""
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
    """Unit impulse along an axis of contact i, in the body: axes 0 and 1 along its surface, 2 away from it."""
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
    """Velocity in the world of point p after an impulse ``push`` at point q, all in the body (equation 10)."""
    turn = times(body.inverse, cross(q, push))
    return to_world(rows, plus(push, cross(turn, p)))


@kernel
def twist_of(body, s):
    """Part of its distance from the centre at which the friction of a closed point acts; 1 but on a flat face.

    Pressed evenly, a face that spins is held by µ N times the mean distance of its points from the centre
    (``docs/space.md``, equation 6), which is less than the distance of the points that carry it here.
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
    """Velocity of where friction acts on the k-th closed point: two along its contact, one away from it [m/s]."""
    p = solid.arm(body, rows[2], s.closed[k])
    # friction of a flat face acts nearer its centre, at the mean distance of its points
    if s.count >= 3:
        p = solid.towards_centre(body, p, twist_of(body, s))
    return solid.in_frame(body, s.closed[k], solid.point_velocity(y, rows, p))


@kernel
def fill_delassus(body, rows, which, n, delassus, twist=1.0):
    """Fill the Delassus matrix W of n contacts ``which``, (3 n, 3 n): velocities u = W P by impulses P.

    Row 3 i + k is the component k of contact i, column 3 j + l the impulse along the axis l of contact j
    (``docs/space.md``, equation 10). What is along the ground acts, and is looked at, at the part ``twist`` of a
    contact's distance from the base's centre; what is away from it at the contact itself.
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
                    along = response(body, rows, p, at, push)
                    u = (along[0], along[1], u[2])
                u = solid.in_frame(body, which[i], u)
                for k in range(3):
                    delassus[3 * i + k, 3 * j + axis] = u[k]


@kernel
def fill_velocities(body, y, rows, which, n, out, twist=1.0):
    """Fill ``out``, (3 n,), with the velocities of n contacts ``which``: two along each, one away from it [m/s].

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
    """Fill s.free, (3 n,), with accelerations of the closed points without contact forces [m/s²].

    Of each two are along it, one away; those along it at the part ``twist`` of its distance from the base's
    centre, which is 1 beside walls. ``weight`` is in the body.
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
    """Direction of slip of the i-th closed contact with the velocity (u, v) [m/s]; if slow, the one noted."""
    speed = norm(u, v)
    if speed > SLIP_FLOOR:
        return u / speed, v / speed
    return s.direction[i, 0], s.direction[i, 1]


@kernel
def twist_by_ties(s):
    """Moment of the ties about the centre of mass, in the body [N m/kg]."""
    return (s.twisted[0], s.twisted[1], s.twisted[2])


@kernel
def load_on(body, y, rows, gravity, s):
    """Effective gravity and the force of the ties, in the body [N/kg]; the ties' part is kept in ``s``."""
    fill_tie_forces(body, y, rows, s)
    weight = to_body(rows, gravity)
    return plus(weight, (s.pulled[0], s.pulled[1], s.pulled[2]))


@inlined_kernel
def pivot_acceleration(body, p, turned, omega, weight, i, s):
    """Angular acceleration about a sticking point i [rad/s²] and the force at it [N/kg] (equation 4).

    All is in the body. ``p`` is the point's arm and ``turned`` its acceleration without accelerations, β. About a
    vertex the inertia is known; about the lowest point of a rim it changes as the rim rolls.
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
    """Angular velocity (or acceleration) that a moment about the body's point p gives it if that point is held.

    It is the solution of [J + |p|² 1 - p pᵀ] ω = moment; all in the body, for a unit of mass.
    """
    m = body.inertia
    square = dot(p, p)
    return solve_symmetric(
        m[0, 0] + square - p[0] * p[0], m[0, 1] - p[0] * p[1], m[0, 2] - p[0] * p[2],
        m[1, 1] + square - p[1] * p[1], m[1, 2] - p[1] * p[2], m[2, 2] + square - p[2] * p[2], moment,
    )  # fmt: skip


@kernel
def stop_point(body, up, i, load, momentum):
    """Angular velocity after an impact that stops point i, and the impulse, both in the body (equation 11).

    ``load`` is the velocity of the point but for rotation [m/s], and ``momentum`` the angular momentum about the
    centre of mass [m²/s], before; or accelerations and the moment. Of a vertex the inverse of its inertia is
    known.
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
    """Angular velocity after an impact that stops points i and j, and its impulse (equation 12).

    ``first`` and ``second`` are the loads of :func:`stop_point`, of i and j: velocities but for those of rotation.
    With ω after the impact, the edge L e from i to j and the inertia J about i,

    - both stop if (first - second)·e = 0 and ω = e × (first - second) / L + σ e;
    - σ follows from the moment about the edge, e·J ω = e·(momentum - p × first);
    - the impulse is -(ω × p + first), and what turns the body otherwise is that at j, (J ω - moment) × e / L.

    Returned are, in the body: the angular velocity [rad/s]; the impulse of both [m/s]; that at j but for its part
    along the edge; the edge's unit vector e; and whether both can be stopped, up to ``small`` [m/s].
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
    """Force at the one closed contact, which slides, with its arm and its velocity ("All others").

    Friction is kinetic, against the slip, and the normal force is the one that keeps the contact from accelerating
    upwards. In: the rows of the attitude, the angular velocity, and the angular acceleration and the effective
    gravity without the force, both in the body. Out: the force [N/kg] and the arm [m] in the body, the velocity of
    the point in axes of the ground [m/s].
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
    """Fill s.lam with the forces at both ends of an edge that stick [N/kg], in axes of the ground (equation 13).

    ``edge`` is what :func:`edge_of` returns and ``spin`` the angular velocity about it [rad/s]. Returned are the
    angular acceleration about the edge [rad/s²], which is the part of equation 4 along it, and the force of both
    ends together in the body [N/kg].
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
    split_force(body, rows, e, force, far, s)
    return alpha, force


@kernel
def split_force(body, rows, e, force, far, s):
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
    """Whether (1 or 0) contact i belongs to a set, whose contacts are bits of the mask."""
    return (mask >> i) & 1


@kernel
def stick_together(s, n, mask, soft):
    """Solve for the impulses at which all of a set stick, or slide the given way; fill s.impulse, others 0.

    Unknowns are three of a contact that sticks, and the normal one of a contact that slides, with which its
    friction goes. They are solved for as those of soft contacts (``docs/space.md``, equation 15), ``soft`` the
    softness. What several contacts hold together is shared anew, by what each is pressed with, where one would
    bear more shear than that allows. Returned is whether there is a solution.
    """
    for i in range(n):
        s.yields[i] = 1.0
    done = False
    for _ in range(2):
        done = hold_softly(s, n, mask, soft)
        if not (done and yields_by_load(s, n, mask)):
            break
    return done


@kernel
def yields_by_load(s, n, mask):
    """Fill s.yields of a set by the normal impulses; return whether one that sticks bears too much shear.

    The softness along the surface is as the square of the mean normal impulse over a contact's own: the sum of the
    squares of what each uses of its friction is then the least.
    """
    total, size, beyond = 0.0, 0, False
    for i in range(n):
        if in_set(mask, i) and not s.given[i]:
            normal = max(s.impulse[3 * i + 2], 0.0)
            shear = norm(s.impulse[3 * i], s.impulse[3 * i + 1])
            beyond = beyond or shear > s.holds[i] * normal
            total += normal
            size += 1
    if not beyond or size < 2 or total <= 0.0:
        return False
    for i in range(n):
        normal = max(s.impulse[3 * i + 2], LEAST_LOAD * total)
        s.yields[i] = 1.0 if s.given[i] else (total / (size * normal)) ** 2
    return True


@kernel
def hold_softly(s, n, mask, soft):
    """Solve for the impulses of :func:`stick_together`, contacts as soft along their surface as s.yields says."""
    size = 0
    for j in range(n):
        if not in_set(mask, j):
            continue
        for axis in range(2 if s.given[j] else 0, 3):
            row = 0
            for i in range(n):
                if not in_set(mask, i):
                    continue
                # conditions of contact i: no velocity, or, where it slides, none away from its surface
                for k in range(2 if s.given[i] else 0, 3):
                    value = s.delassus[3 * i + k, 3 * j + axis]
                    if s.given[j]:
                        push = s.delassus[3 * i + k, 3 * j] * s.way[j, 0]
                        push += s.delassus[3 * i + k, 3 * j + 1] * s.way[j, 1]
                        value -= s.friction[j] * push
                    s.matrix[row, size] = value
                    s.right[row] = -s.free[3 * i + k]
                    row += 1
            s.softness[size] = soft * (s.yields[j] if axis < 2 else 1.0)
            size += 1
    for i in range(size):
        s.matrix[i, i] += s.softness[i]
        s.unknown[i] = 0.0
    done = factor(s.matrix, s.order, size)
    # what the softness shifts one more pass with it as a reference removes
    for _ in range(PASSES if done else 0):
        for i in range(size):
            s.vector[i] = s.right[i] + s.softness[i] * s.unknown[i]
        substitute(s.matrix, s.order, size, s.vector)
        for i in range(size):
            s.unknown[i] = s.vector[i]
    spread(s, n, mask)
    return done


@kernel
def push_by_two(s, sticks, slides, way, grip):
    """Impulse at which contact ``sticks`` sticks, beside contact ``slides`` that slides along ``way``.

    With the coefficient ``grip`` this is equation 14 (``docs/space.md``), with contact 1 that sticks. Returned are
    P_1, (3,); the normal impulse N at the other; and f, (3,), with P_2 = N f.
    """
    w, a, b = s.delassus, 3 * sticks, 3 * slides
    unit = (-grip * way[0], -grip * way[1], 1.0)
    # P_1 = without + N by_unit
    without = stop_at(w, a, (s.free[a], s.free[a + 1], s.free[a + 2]))
    by_unit = stop_at(w, a, effect(w, a, b, unit))
    # velocity of the other away from its surface, without N and by a unit of it
    left = s.free[b + 2] + dot(row_of(w, b + 2, a), without)
    gives = dot(row_of(w, b + 2, b), unit) + dot(row_of(w, b + 2, a), by_unit)
    normal = -left / gives
    return plus(without, scaled(normal, by_unit)), normal, unit


@kernel
def row_of(w, i, b):
    """Entries i, b to b + 2 of W: what impulses at the contact whose first row is b do to the velocity i."""
    return (w[i, b], w[i, b + 1], w[i, b + 2])


@kernel
def effect(w, a, b, push):
    """Velocity of the contact whose first row in W is a, by an impulse ``push`` at that whose first row is b."""
    return (
        dot(row_of(w, a, b), push),
        dot(row_of(w, a + 1, b), push),
        dot(row_of(w, a + 2, b), push),
    )


@kernel
def stop_at(w, a, velocity):
    """Impulse at the contact whose first row in W is a that takes a velocity of it away: -W_aa⁻¹ velocity."""
    return solve_symmetric(
        w[a, a], w[a, a + 1], w[a, a + 2], w[a + 1, a + 1], w[a + 1, a + 2],
        w[a + 2, a + 2], scaled(-1.0, velocity),
    )  # fmt: skip


@kernel
def spread(s, n, mask):
    """Write s.unknown, the unknowns of a set in :func:`stick_together`, to s.impulse, three a contact."""
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
    against its slip if it ``rubs`` (``docs/space.md``, "All others"). s.free has the accelerations (or velocities)
    without them.
    """
    fill_delassus(body, rows, s.closed, n, s.delassus, twist_of(body, s))
    fill_directions(body, y, rows, n, s)
    for i in range(n):
        s.given[i], s.friction[i] = s.slides[i], 0.0
        s.holds[i] = solid.static_of(body, s.closed[i])
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
def fill_directions(body, y, rows, n, s):
    """Fill s.way of n closed contacts with the direction of their slip, less where a face turns about one of them.

    Next to the point that a face turns about a contact would rub this way and that: below SLIP_FLOOR its friction
    is in proportion to its slip, as the friction of a whole face is around that point.
    """
    fastest = 0.0
    for i in range(n):
        u = slip_of(body, y, rows, i, s)
        fastest = max(fastest, norm(u[0], u[1]))
        s.way[i, 0], s.way[i, 1] = u[0], u[1]
    moves = n >= 3 and fastest >= 2 * SLIP_FLOOR
    for i in range(n):
        u, v = s.way[i, 0], s.way[i, 1]
        if moves and norm(u, v) < SLIP_FLOOR:
            s.way[i, 0], s.way[i, 1] = u / SLIP_FLOOR, v / SLIP_FLOOR
        else:
            s.way[i, 0], s.way[i, 1] = slip_direction(s, i, u, v)


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
    """Largest diagonal entry of the Delassus matrix of n contacts [-]: the most that a unit impulse gives."""
    largest = 0.0
    for i in range(3 * n):
        largest = max(largest, s.delassus[i, i])
    return largest


@kernel
def rates(body, tau, y, dy, s):
    """Fill ``dy``, (15,), with dy/dt, and s.lam with the contact forces along and away from each contact [N/kg].

    ``tau`` is the time in the interval [s], at whose beginning s.field holds the effective gravity. Each kind of
    mode has its own equation: 4, its part along an edge, or the linear system of all others (``docs/space.md``).
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
        + (load[2] + s.field[GRAVITY]) * y[solid.UPWARD]
    )
    dy[solid.WORK] += dot(twist_by_ties(s), omega)
    dy[solid.FRICTION] = lost


@kernel
def fill_rates(y, omega, alpha, acceleration, dy):
    """Fill in the rates of a state: of place and attitude from its velocities, of velocities as given.

    The quaternion q changes by q ∘ ω/2, ``omega`` in the body [rad/s]. ``acceleration`` is that of the centre of
    mass in the world [m/s²], ``alpha`` the angular one in the body [rad/s²].
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
    """Angular acceleration in the body [rad/s²] by a force ``push`` at contact i, in axes of the ground [N/kg].

    Its horizontal part acts at the part ``twist`` of the contact's distance from the base's centre.
    """
    p = solid.arm(body, rows[2], i)
    if twist == 1.0:
        return times(body.inverse, cross(p, to_body(rows, push)))
    rubs = solid.towards_centre(body, p, twist)
    level = to_body(rows, (push[0], push[1], 0.0))
    moment = plus(cross(p, scaled(push[2], rows[2])), cross(rubs, level))
    return times(body.inverse, moment)


@kernel
def push_at(body, y, rows, i, impulse, twist=1.0):
    """Change the velocities in ``y`` by an impulse [m/s]: two components along contact i, one away from it."""
    impulse = solid.from_frame(body, i, impulse)
    turned = turned_by(body, rows, i, impulse, twist)
    for k in range(3):
        y[solid.VELOCITY + k] += impulse[k]
        y[solid.SPIN + k] += turned[k]
