"""Accelerations and contact forces of a mode: which points are closed, and which of them slide.

In: a record ``BODY``, a state y, the ground's acceleration [m/s²] and a mode. Out: dy/dt, and the forces of the
closed points [N/kg]. Theory: ``docs/space.md``, equations 2 to 4; a face that slides 6 and 7; systems of contacts
9 to 15.

- ``rows``: the world's axes as the body sees them, ``up`` = rows[2]; ``omega``: angular velocity in the body
- ``weight``: effective gravity and the ties' force, in the body [N/kg]
- ``i``: number of a contact, ``p`` its arm from the centre of mass, in the body [m]
- ``s``: record ``CASE``; contact k of a small system has the rows 3 k, 3 k + 1 (along) and 3 k + 2 (away)
- ``twist``: part of its distance from the base's centre at which the friction of a contact acts
"""

from rockfrag.engines.algebra import vectors as algebra
from rockfrag.engines.algebra.vectors import (
    cross,
    dot,
    norm,
    plus,
    rotation,
    scaled,
    times,
    to_body,
    to_world,
)
from rockfrag.engines.compile.jit import kernel
from rockfrag.engines.spatial import _body as solid
from rockfrag.engines.spatial._case import (
    GRAVITY,
    HINGE,
    PIVOT,
    SLIDER,
    SLIDES,
    effective_gravity_at,
    kind_of,
)
from rockfrag.engines.spatial._closed_forms import (
    edge_forces,
    edge_of,
    pivot_acceleration,
)
from rockfrag.engines.spatial._delassus import (
    fill_delassus,
    largest_compliance,
    slip_of,
    turned_by,
    twist_of,
)
from rockfrag.engines.spatial._ties import (
    load_on,
    twist_by_ties,
)
from rockfrag.engines.spatial._together import (
    push_by_two,
    stick_together,
)

# slip velocity below which a point slips in the direction noted, if at all [m/s]
SLIP_FLOOR = 1e-4
# part of the largest compliance that is added to all, so that redundant forces are the least ones [-]
SOFTNESS = 1e-9


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
