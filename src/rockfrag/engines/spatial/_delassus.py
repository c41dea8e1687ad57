"""What impulses and forces at contacts do to a body: velocities of contacts by them, and changes of its state.

In: a record ``BODY``, a state y, numbers of contacts. Out: Delassus matrices [-, for a unit of mass], velocities
[m/s], rates. Theory: ``docs/space.md``, equations 6 and 10.

- ``rows``: the world's axes as the body sees them, ``up`` = rows[2]; ``omega``: angular velocity in the body
- ``i``, ``j``: numbers of contacts, ``p``, ``q`` their arms from the centre of mass, in the body [m]
- ``s``: record ``CASE``; contact k of a small system has the rows 3 k, 3 k + 1 (along) and 3 k + 2 (away)
- ``twist``: part of its distance from the base's centre at which the friction of a contact acts (:func:`twist_of`)
"""

from rockfrag.engines.algebra.vectors import (
    cross,
    norm,
    plus,
    scaled,
    times,
    to_body,
    to_world,
)
from rockfrag.engines.compile.jit import kernel
from rockfrag.engines.spatial import _body as solid
from rockfrag.engines.spatial._case import at_wall


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
def largest_compliance(s, n):
    """Largest diagonal entry of the Delassus matrix of n contacts [-]: the most that a unit impulse gives."""
    largest = 0.0
    for i in range(3 * n):
        largest = max(largest, s.delassus[i, i])
    return largest


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
