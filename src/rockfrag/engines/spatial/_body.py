"""What the kernels know of a body, and where and how fast its points are.

A state y holds C (0:3), the centre of mass relative to the ground; the quaternion world ← body (3:7); the
velocity of C (7:10, world); the angular velocity (10:13, body); the work done by the ground's motion (13) and
the energy lost by friction (14).  Everything is for a unit of mass: energies in J/kg, forces in N/kg.

Symbols in all modules of this folder; "in the body" and "in the world" say which axes a vector's parts are along:

- ``rows``: rows of the attitude R, the world's axes in the body, of which ``rows[2]``, or ``up``, is the vertical,
  n of equation 3;
- ``omega``, ``alpha``, ``turn``: angular velocity [rad/s], acceleration [rad/s²], and velocity after an impact, in
  the body; ``weight``: effective gravity in the body [N/kg];
- ``p``, ``q``: arms of contacts from the centre of mass [m], ``e``: unit vector along an edge, in the body;
- ``push``: impulse [N s/kg] or force [N/kg] at a contact, in the body if nothing else is said;
- ``s``: record ``CASE`` with the mode; ``s.field[GRAVITY]`` is gravity on ground at rest [m/s²];
- ``i``: number of a contact. A polygon's vertices are 0 to count - 1; the lowest point of a rim is ``count``; from
  WALLS on follow the corners at walls: MOST_CORNERS numbers a wall, one a corner.

In: a record ``BODY`` and a state. Out: arms [m], velocities [m/s] and heights of points. Theory:
``docs/space.md``, "Coordinates", equations 1 to 3 and 9.
"""

import math

import numpy as np

from rockfrag.base.arrays import fields, whole
from rockfrag.engines.algebra.vectors import (
    TINY,
    cross,
    dot,
    minus,
    norm,
    plus,
    times,
    to_world,
)
from rockfrag.engines.compile.jit import inlined_kernel, kernel

SIZE = 15
# where a state has the centre of mass, the attitude (a quaternion), its velocity, the angular velocity in the
# body, the work of the ground's motion and what friction has taken
PLACE, ATTITUDE, VELOCITY, SPIN, WORK, FRICTION = 0, 3, 7, 10, 13, 14
# and the height of the centre of mass over the ground, and its velocity upwards
HEIGHT, UPWARD = PLACE + 2, VELOCITY + 2
MOST_VERTICES = 64
MOST_CONSTRAINTS = 8  # walls and ties
BOND = MOST_CONSTRAINTS  # row of a bond among what holds a body
HOLDERS = MOST_CONSTRAINTS + 1
MOST_CORNERS = 2 * MOST_VERTICES  # of base and face, that may touch walls
# number of a contact from which it is one of a corner with a wall: those of a wall follow each other
WALLS = 1000

BODY = np.dtype(
    [
        *whole("count"),  # vertices of the base; of a round one, some points of its rim
        *fields("rim"),  # radius of a round base [m]; 0 for a polygon
        *fields("centre", 2),  # centre of a round base [m]
        *fields("height"),  # of the centre of mass over the base [m]
        # distances in the base from below the centre of mass: of its furthest point, of its nearest edge [m]
        *fields("furthest nearest"),
        # mean distance of the base's points from its centre: arm of the friction of a base that spins flat [m]
        *fields("twist"),
        *fields("static kinetic"),  # coefficients of friction [-]
        # energy over rest below which nothing falls on ground at rest [J/kg]
        *fields("barrier"),
        # turn of the contact of a round base that passes through flat, rolling, and sliding without friction [rad]
        *fields("pass_turn slide_turn"),
        # tensor over the mass, about the centre of mass [m²], and its inverse
        *fields("inertia inverse", 3, 3),
        *fields("points", MOST_VERTICES, 3),  # vertices, anticlockwise [m]
        # tensor about each vertex [m²]
        *fields("about about_inverse", MOST_VERTICES, 3, 3),
        # a bond: whether there is one; what it holds in tension and shear, for a unit of mass [N/kg]; half the
        # distances of its pads, and the centre of mass from between them [m]
        *whole("bonded"),
        *fields("tension shear"),
        *fields("pads aside", 2),
        # walls and ties: how many; of each whether it is a tie
        *whole("constraints"),
        *whole("ties", MOST_CONSTRAINTS),
        # of a tie: where it is fastened, from the centre of mass; where it ends, from where that is at first, on
        # the ground [m]; stiffness, damping and strength for a unit of mass; natural length [m]; the length below
        # which it pushes, 0 of a cord [m]
        *fields("knot anchor", MOST_CONSTRAINTS, 3),
        *fields("stiffness damping strength natural shortest", MOST_CONSTRAINTS),
        # of a wall: the direction away from it in the plan, its distance from the origin against that direction
        # [m], coefficients of friction and ratio of speeds after and before an impact [-]
        *fields("away", MOST_CONSTRAINTS, 2),
        *fields("distance wall_static wall_kinetic ratio", MOST_CONSTRAINTS),
        # corners of base and face that may touch walls, from the centre of mass [m]
        *whole("walls corners"),
        *fields("corner", MOST_CORNERS, 3),
    ],
    align=True,
)
"""A body on a base, in its own frame with the origin at the centre of mass and z up."""


@kernel
def rim_contact(body):
    """Number of the contact that is the lowest point of a rim; -1 of a polygon, which has none."""
    return body.count if body.rim > 0 else -1


@kernel
def rim_direction(up):
    """Direction in the base from its centre to the lowest point of the rim, and the sine of the tilt.

    ``up`` is the vertical as the body sees it. A flat body has no lowest point: any direction will do.
    """
    sine = norm(up[0], up[1])
    if sine < TINY:
        return (1.0, 0.0, 0.0), 0.0
    return (-up[0] / sine, -up[1] / sine, 0.0), sine


@kernel
def wall_of(i):
    """Number of the wall of contact i, which is one of a corner with a wall."""
    return (i - WALLS) // MOST_CORNERS


@kernel
def arm(body, up, i):
    """Point of contact i from the centre of mass, in the body [m]; ``up`` is the vertical as the body sees it."""
    if i >= WALLS:
        k = (i - WALLS) % MOST_CORNERS
        return (body.corner[k, 0], body.corner[k, 1], body.corner[k, 2])
    if i == rim_contact(body):
        u, _ = rim_direction(up)
        return (
            body.centre[0] + body.rim * u[0],
            body.centre[1] + body.rim * u[1],
            -body.height,
        )
    return (body.points[i, 0], body.points[i, 1], body.points[i, 2])


@kernel
def towards_centre(body, p, part):
    """Point p of the base moved towards the base's centre, from which it keeps a part of its distance [m]."""
    x, y = body.centre[0], body.centre[1]
    return (x + part * (p[0] - x), y + part * (p[1] - y), p[2])


@kernel
def bias(body, up, omega, p, i):
    """Acceleration of contact i that does not come from accelerations, β of equation 3, in the body [m/s²].

    ``p`` is its arm. The point of a rim moves along it as the vertical turns in the body, dn/dt = n × ω.
    """
    moved = cross(omega, p)
    if i == rim_contact(body):
        # velocity of the lowest point along the rim, by the rate of change of ``up`` in the body
        u, sine = rim_direction(up)
        turn = cross(up, omega)
        along = turn[0] * u[0] + turn[1] * u[1]
        # what turns the direction u, and the rim's point with it, against it
        across_x, across_y = turn[0] - along * u[0], turn[1] - along * u[1]
        scale = -body.rim
        moved = plus(moved, (scale * across_x / sine, scale * across_y / sine, 0.0))
    return cross(omega, moved)


@inlined_kernel
def arm_and_bias(body, up, omega, i):
    """Return :func:`arm` and :func:`bias` of a contact with the ground; of a rim with one root for both."""
    if i != rim_contact(body):
        p = (body.points[i, 0], body.points[i, 1], body.points[i, 2])
        return p, cross(omega, cross(omega, p))
    square = max(up[0] * up[0] + up[1] * up[1], TINY)
    # the root and the division do not wait for each other
    per_sine = math.sqrt(square) * (1.0 / square)
    x, y = -up[0] * per_sine, -up[1] * per_sine
    p = (body.centre[0] + body.rim * x, body.centre[1] + body.rim * y, -body.height)
    # how fast the lowest point goes round the rim
    turn = cross(up, omega)
    round_ = body.rim * (turn[0] * y - turn[1] * x) * per_sine
    moved = plus(cross(omega, p), (-round_ * y, round_ * x, 0.0))
    return p, cross(omega, moved)


@kernel
def weight_of_attitude(body, up):
    """Size of an error of the attitude that counts as an error of one of other numbers [-].

    Of a rim an error δ turns the contact round it by δ over the tilt, so that the flatter the body the less it may
    be: 1e3 times the tilt, and 1e-4 at least.
    """
    if body.rim == 0.0:
        return 1.0
    return min(1.0, 1e3 * norm(up[0], up[1]) + 1e-4)


@kernel
def gap(body, y, up, i):
    """Height of point i of the base over the ground [m]."""
    return y[HEIGHT] + dot(up, arm(body, up, i))


@kernel
def gap_of(body, y, rows, i):
    """Distance of contact i from the ground or its wall [m]."""
    if i < WALLS:
        return gap(body, y, rows[2], i)
    wall = wall_of(i)
    corner = to_world(rows, arm(body, rows[2], i))
    east, north = y[PLACE] + corner[0], y[PLACE + 1] + corner[1]
    return body.distance[wall] + body.away[wall, 0] * east + body.away[wall, 1] * north


@kernel
def in_frame(body, i, u):
    """Components of a vector u of the world: two along contact i, one away from its surface (equation 9)."""
    if i < WALLS:
        return u
    a, b = body.away[wall_of(i), 0], body.away[wall_of(i), 1]
    return (a * u[1] - b * u[0], u[2], a * u[0] + b * u[1])


@kernel
def from_frame(body, i, u):
    """Vector of the world that has the components u at contact i: :func:`in_frame` the other way round."""
    if i < WALLS:
        return u
    a, b = body.away[wall_of(i), 0], body.away[wall_of(i), 1]
    return (a * u[2] - b * u[0], a * u[0] + b * u[2], u[1])


@kernel
def approach_of(body, y, rows, i):
    """Velocity of contact i away from the ground or its wall [m/s]: negative where it approaches."""
    return in_frame(body, i, velocity_of(body, y, rows, i))[2]


@kernel
def static_of(body, i):
    """Coefficient of static friction of contact i [-]."""
    return body.static if i < WALLS else body.wall_static[wall_of(i)]


@kernel
def kinetic_of(body, i):
    """Coefficient of kinetic friction of contact i [-]."""
    return body.kinetic if i < WALLS else body.wall_kinetic[wall_of(i)]


@kernel
def is_smooth(body, i):
    """Whether contact i has no friction at all, so that it slips whichever way."""
    return i >= WALLS and body.wall_static[wall_of(i)] == 0.0


@kernel
def wall_candidates(body):
    """All numbers that contacts of corners with walls can have; none without a wall.

    Among them are numbers of corners and walls that are not there: :func:`may_meet` tells.
    """
    return range(WALLS, WALLS + MOST_CORNERS * (body.constraints if body.walls else 0))


@kernel
def may_meet(body, i):
    """Whether contact i is of a corner and a wall that are there; ties have numbers among walls."""
    there = (i - WALLS) % MOST_CORNERS < body.corners
    return there and not body.ties[wall_of(i)]


@kernel
def attitude_of(y):
    """Attitude, a quaternion."""
    return (y[ATTITUDE], y[ATTITUDE + 1], y[ATTITUDE + 2], y[ATTITUDE + 3])


@kernel
def set_place(y, x, z):
    """Put the centre of mass at a place in the plan."""
    y[PLACE], y[PLACE + 1] = x, z


@kernel
def set_attitude(y, attitude):
    """Give a body an attitude."""
    for k in range(4):
        y[ATTITUDE + k] = attitude[k]


@kernel
def centre_velocity(y):
    """Velocity of the centre of mass in the world."""
    return (y[VELOCITY], y[VELOCITY + 1], y[VELOCITY + 2])


@kernel
def set_velocity(y, velocity):
    """Give the centre of mass a velocity in the world."""
    for k in range(3):
        y[VELOCITY + k] = velocity[k]


@kernel
def set_spin(y, omega):
    """Give the body an angular velocity in the body."""
    for k in range(3):
        y[SPIN + k] = omega[k]


@kernel
def omega_of(y):
    """Angular velocity in the body [rad/s]."""
    return (y[SPIN], y[SPIN + 1], y[SPIN + 2])


@kernel
def point_velocity(y, rows, p):
    """Velocity in the world of the body's point p [m/s]."""
    turned = to_world(rows, cross(omega_of(y), p))
    return (y[VELOCITY] + turned[0], y[VELOCITY + 1] + turned[1], y[UPWARD] + turned[2])


@kernel
def velocity_of(body, y, rows, i):
    """Velocity in the world of contact i, a vertex, the lowest point of a rim or a corner at a wall [m/s]."""
    return point_velocity(y, rows, arm(body, rows[2], i))


@kernel
def kinetic_energy(body, y):
    """Energy of motion, v²/2 + ω·J ω/2 [J/kg]."""
    velocity, omega = centre_velocity(y), omega_of(y)
    momentum = times(body.inertia, omega)
    return 0.5 * (dot(velocity, velocity) + dot(omega, momentum))


@kernel
def energy(body, y, g):
    """Kinetic energy and the energy of height over rest, with the acceleration of gravity g [J/kg]."""
    return kinetic_energy(body, y) + g * (y[HEIGHT] - body.height)


@kernel
def is_known(y):
    """Whether all of a state are numbers, none of them infinite."""
    known = True
    for i in range(SIZE):
        known = known and math.isfinite(y[i])
    return known


@kernel
def balance(body, y, g):
    """Energy less the work of the ground's motion [J/kg]: constant while a body turns about a contact."""
    return energy(body, y, g) - y[WORK]


@kernel
def pay(body, y, gained):
    """Take energy that was gained [J/kg] from the velocities, as far as there is any.

    All velocities shrink by √(1 - gained/kinetic energy).
    """
    moving = kinetic_energy(body, y)
    if gained > 0.0 and moving > 0.0:
        left = math.sqrt(max(1.0 - gained / moving, 0.0))
        for k in range(3):
            y[VELOCITY + k] *= left
            y[SPIN + k] *= left


@kernel
def meets_walls_alone(body):
    """Whether walls, and no ties, hold a body."""
    found = body.walls == 1
    for i in range(body.constraints):
        found = found and not body.ties[i]
    return found


@kernel
def free_spin(body, omega, moment):
    """Angular acceleration without contacts, J⁻¹ (moment - ω × J ω), in the body [rad/s²].

    ``moment`` is that of ties, for a unit of mass [N m/kg].
    """
    left = minus(moment, cross(omega, times(body.inertia, omega)))
    return times(body.inverse, left)


@kernel
def candidates(body):
    """Numbers of the contacts with the ground of a body that is not flat: the rim's alone, or the vertices."""
    first = body.count if body.rim > 0 else 0
    return range(first, body.count + (first > 0))


@kernel
def meetings(body):
    """How many contacts there may be with the ground and all walls, numbered by :func:`meeting`.

    Walls include ties, which nothing meets.
    """
    on_ground = 1 if body.rim > 0 else body.count
    return on_ground + body.corners * (body.constraints if body.walls else 0)


@kernel
def meeting(body, k):
    """Number of the k-th of all contacts that there may be, as :func:`arm` takes it: the ground's first."""
    on_ground = 1 if body.rim > 0 else body.count
    if k < on_ground:
        return body.count if body.rim > 0 else k
    wall, corner = (k - on_ground) // body.corners, (k - on_ground) % body.corners
    return WALLS + MOST_CORNERS * wall + corner


@kernel
def position_of_base(y, rows, p):
    """Where in the plan the body's point p is, (x, y) in axes of the ground [m]."""
    moved = to_world(rows, p)
    return (y[PLACE] + moved[0], y[PLACE + 1] + moved[1])
