"""A witness of impacts: what contacts have given, from the whole change of momentum (``docs/contact.md``).

What is above a contact has been pushed by that contact and by nothing else, so its change of momentum and of
angular momentum is the resultant of the contact and where it acts.  Nothing here is shared with the search and its
equations.  Impulses on bodies from outside the column would be taken from the change first.

``p`` and ``w`` are records ``BODY`` and ``WORK`` (``records.py``). ``q`` and ``v`` have x, y [m] and the clockwise
rotation θ [rad] of body k, from place 3 k on, and their rates.

In: a record ``BODY`` and its working memory with the velocities before and after an impact. Out: whether a law of
impacts (equations 8 to 10) is broken by more than the tolerance.
"""

from typing import NamedTuple

from rockfrag.base.elementary import sin_cos
from rockfrag.engines.compile.jit import kernel
from rockfrag.engines.planar.support import GUIDED

SHUT = 30.0
"""What shutting slow ends asks of impulses at most, over mass and closing speed [-]."""
ROUNDING = 1e-6  # fraction of mass times √(g b) below which an impulse is none
TOUCHES = 1e-12  # gap over the half width below which an end touches [-]
ACROSS = 1e-6  # distance behind a low wall's face over the half width from which a corner is across its edge [-]


class Limits(NamedTuple):
    """What is allowed: speeds [m/s], impulses [Ns], and whether impacts are plastic."""

    speed: float
    impulse: float
    plastic: bool


@kernel
def _turned(x, y, angle):
    """Vector (x, y) turned clockwise by an angle [rad]."""
    s, c = sin_cos(angle)
    return x * c + y * s, y * c - x * s


@kernel
def _place(p, q, k, end):
    """End of contact k, as bodies lie in ``q``: its point (x, y) [m], the unit tangent there, and the gap [m].

    The point is a corner of the base where that is over the face below, and otherwise the edge of the face.
    ``end`` is 0 (left) or 1.
    """
    x, y = _turned(p.corner[k, end, 0], p.corner[k, end, 1], q[3 * k + 2])
    x, y = x + q[3 * k], y + q[3 * k + 1]
    if k == 0:
        return x, y, 1.0, 0.0, y
    # edge of the face below, whose body has turned by ``below``
    side, tilt, below = 2 * end - 1, (p.tilt_cos[k], -p.tilt_sin[k]), q[3 * k - 1]
    ex = p.face[k, 0] + side * p.half[k] * tilt[0]
    ey = p.face[k, 1] + side * p.half[k] * tilt[1]
    ex, ey = _turned(ex, ey, below)
    ex, ey = ex + q[3 * k - 3], ey + q[3 * k - 2]
    tx, ty = _turned(tilt[0], tilt[1], below)
    if side * ((x - ex) * tx + (y - ey) * ty) <= 1e-9 * p.size:
        return x, y, tx, ty, (y - ey) * tx - (x - ex) * ty
    # the edge of the face is against the base
    tx, ty = _turned(tilt[0], tilt[1], q[3 * k + 2])
    return ex, ey, tx, ty, (y - ey) * tx - (x - ex) * ty


@kernel
def _speed(q, v, k, point, direction):
    """Velocity of body k relative to what is below it, at a point (x, y) along a unit direction (dx, dy) [m/s]."""
    x, y = point
    dx, dy = direction
    found = dx * (v[3 * k] + v[3 * k + 2] * (y - q[3 * k + 1]))
    found += dy * (v[3 * k + 1] - v[3 * k + 2] * (x - q[3 * k]))
    if k > 0:
        found -= dx * (v[3 * k - 3] + v[3 * k - 1] * (y - q[3 * k - 2]))
        found -= dy * (v[3 * k - 2] - v[3 * k - 1] * (x - q[3 * k - 3]))
    return found


@kernel
def breaks_a_law(p, w, closing, plastic):
    """Whether the impact from ``old_v`` to ``v`` breaks a law, by more than shutting slow ends asks.

    The laws are 8 to 10 of ``docs/contact.md``: P_n ≥ 0 at each end, nothing at ends that part, |P_t| ≤ µ ΣP_n
    with µ the kinetic coefficient for a shear against the old slip, and no gain of energy.

    Parameters
    ----------
    p, w : records ``BODY`` and ``WORK``
    closing : speed over √(g b) below which ends are shut after an impact [-]
    plastic : whether no contact has a law of restitution; with one, ends may be pushed and part
    """
    mass, gain = _mass_and_gain(p, w)
    slack = (SHUT * closing + ROUNDING) * p.speed
    limits = Limits(slack, slack * mass, plastic)
    broken = gain > ROUNDING * mass * p.speed * p.speed
    # what contact k has given is the change of momentum of all bodies from k up, but for what walls have given
    push_x = push_y = turn = 0.0
    for k in range(p.count - 1, -1, -1):
        jump_x, jump_y, jump_turn = _momentum_change(p, w, k)
        push_x, push_y, turn = push_x + jump_x, push_y + jump_y, turn + jump_turn
        if p.contacts > p.count:
            wall_x, wall_y, wall_turn = _given_by_walls(p, w, k)
            push_x, push_y, turn = push_x - wall_x, push_y - wall_y, turn - wall_turn
        if w.whole[k] != GUIDED:
            resultant = push_x, push_y, turn
            broken = broken or _contact_breaks(p, w, k, resultant, limits)
    for k in range(p.count, p.contacts):
        broken = broken or _wall_breaks(p, w, k, limits)
    return broken


@kernel
def _mass_and_gain(p, w):
    """Mass of all bodies [kg], and the kinetic energy that an impact has given to them [J].

    ``w.old_v`` and ``w.v`` are the velocities before and after; ``p.inverse`` has 1/m, 1/m and 1/I of each body,
    so that body k has places 3 k to 3 k + 2.
    """
    mass = gain = 0.0
    for k in range(p.count):
        mass += p.mass[k]
        for d in range(3 * k, 3 * k + 3):
            gain += 0.5 * (w.v[d] * w.v[d] - w.old_v[d] * w.old_v[d]) / p.inverse[d]
    return mass, gain


@kernel
def _momentum_change(p, w, k):
    """Change of momentum (x, y) of body k in an impact [N s], and of its clockwise moment about 0, 0 [N s m]."""
    jump_x = (w.v[3 * k] - w.old_v[3 * k]) * p.mass[k]
    jump_y = (w.v[3 * k + 1] - w.old_v[3 * k + 1]) * p.mass[k]
    spin = (w.v[3 * k + 2] - w.old_v[3 * k + 2]) * p.inertia[k]
    return jump_x, jump_y, spin + jump_x * w.q[3 * k + 1] - jump_y * w.q[3 * k]


@kernel
def _wall_tangent(p, w, k, end):
    """Point (x, y) [m] and unit tangent of an end of contact k with a wall, from the corners of the body's side.

    Either a corner of the side is on the face of the wall, or the upper edge of the wall on the side.
    """
    body = p.upper[k]
    x, y = _turned(p.edge[k, end, 0], p.edge[k, end, 1], w.q[3 * body + 2])
    x, y = x + w.q[3 * body], y + w.q[3 * body + 1]
    behind = p.side[k] * (x - p.wall_x[k])
    if y <= p.wall_top[k] and behind < ACROSS * p.size:
        return x, y, 0.0, float(p.side[k])
    # the wall's edge is against the side
    tx, ty = _turned(p.flank[k, 0], p.flank[k, 1], w.q[3 * body + 2])
    return p.wall_x[k], p.wall_top[k], tx, ty


@kernel
def _given_by_walls(p, w, body):
    """Impulse (x, y) that walls have given to a body [N s], and its moment about the origin, clockwise [N s m].

    The normal is (-ty, tx). One shear holds both ends of a contact: they lie on one line, so it is put at the
    first.
    """
    push_x = push_y = turn = 0.0
    for k in range(p.count, p.contacts):
        if p.upper[k] != body:
            continue
        shear = w.hit_shear[k]
        for end in range(2):
            if w.hit[k, end] == 0.0:
                continue
            x, y, tx, ty = _wall_tangent(p, w, k, end)
            along, shear = shear, 0.0
            jump_x = along * tx - w.hit[k, end] * ty
            jump_y = along * ty + w.hit[k, end] * tx
            push_x, push_y = push_x + jump_x, push_y + jump_y
            turn += jump_x * y - jump_y * x
    return push_x, push_y, turn


@kernel
def _wall_breaks(p, w, k, limits):
    """Whether contact k with a wall has broken a law: it pulls, rubs too much, or lets a corner through.

    ``limits``: the :class:`Limits` that each may be passed by.
    """
    pressed = w.hit[k, 0] + w.hit[k, 1]
    broken = min(w.hit[k, 0], w.hit[k, 1]) < -limits.impulse
    broken = broken or abs(w.hit_shear[k]) > p.static[k] * pressed + limits.impulse
    for end in range(2):
        if w.hit[k, end] > 0.0:
            x, y, tx, ty = _wall_tangent(p, w, k, end)
            body = 3 * p.upper[k]
            speed = -ty * (w.v[body] + w.v[body + 2] * (y - w.q[body + 1]))
            speed += tx * (w.v[body + 1] - w.v[body + 2] * (x - w.q[body]))
            broken = broken or speed < -limits.speed
    return broken


@kernel
def _contact_breaks(p, w, k, resultant, limits):
    """Whether contact k breaks law 8 or 9 by the ``resultant`` that it has given.

    That is x, y [N s] and the moment about the origin, clockwise [N s m], split into a shear and the normal
    impulses of the ends that touch. Where none does it must vanish; where one does it must pass through that end;
    and no end may pull. A law of restitution may give a couple, or an impulse within the base: then (not
    ``limits.plastic``) it may pass beside the one end, and one of both may pull as long as both together press.
    Last, the shear must be within Coulomb's limit: of kinetic friction where it brakes the slip before, else of
    static.
    """
    push_x, push_y, turn = resultant
    slack, allowed, plastic = limits.speed, limits.impulse, limits.plastic
    x0, y0, tx, ty, gap0 = _place(p, w.q, k, 0)
    x1, y1, ux, uy, gap1 = _place(p, w.q, k, 1)
    left, right = abs(gap0) < TOUCHES * p.size, abs(gap1) < TOUCHES * p.size
    if not (left or right):
        return abs(push_x) + abs(push_y) > allowed
    if not left:
        x0, y0, tx, ty = x1, y1, ux, uy
    along, pressed = push_x * tx + push_y * ty, push_y * tx - push_x * ty
    # moment about the end that touches first, from which follows what the far end has given
    off = turn - push_x * y0 + push_y * x0
    if not (left and right):
        # one end carries all
        if plastic and abs(off) > allowed * p.size:
            return True
        x1, y1, far = x0, y0, 0.0
    else:
        far = -off / ((x1 - x0) * tx + (y1 - y0) * ty)
    least = min(pressed - far, far) if left and right else pressed
    if least < -allowed and (plastic or pressed < -allowed):
        return True
    if _end_breaks(w, k, (x0, y0, -ty, tx), pressed - far, limits):
        return True
    if _end_breaks(w, k, (x1, y1, -ty, tx), far, limits):
        return True
    slid = _speed(w.q, w.old_v, k, (x0, y0), (tx, ty))
    brakes = abs(slid) > slack and slid * along < 0.0
    limit = p.kinetic[k] if brakes else p.static[k]
    return abs(along) > limit * max(0.0, pressed) + allowed


@kernel
def _end_breaks(w, k, end, given, limits):
    """Whether an end breaks law 8: it comes closer after an impact, or parts although it was pushed.

    ``end``: x, y [m] and the unit normal of the end of contact k; ``given``: normal impulse at it [N s].
    """
    x, y, nx, ny = end
    speed = _speed(w.q, w.v, k, (x, y), (nx, ny))
    parts = limits.plastic and given > limits.impulse and speed > limits.speed
    return speed < -limits.speed or parts
