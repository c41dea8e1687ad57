"""A body that lies flat: it stands, slides on its face, or its centre of pressure leaves that.

In: a state in which it lies flat. Out: the mode in which it goes on. Theory: ``docs/space.md``, "Friction and
impacts".

Names (``_body`` explains the state and the numbers of contacts):

- ``body``, ``s``: records ``BODY`` and ``CASE``; ``y``: the state, shape (15,)
- ``rows``: the world's axes as the body sees them, ``rows[2]`` the upward one
- ``gravity``: effective gravity, equation 1, in the world [m/s²]; ``load``: gravity and ties, :class:`_rest.Load`
"""

from rockfrag.engines.algebra import vectors as algebra
from rockfrag.engines.compile.jit import kernel
from rockfrag.engines.spatial import _body as solid
from rockfrag.engines.spatial import _case as case
from rockfrag.engines.spatial import _delassus as delassus
from rockfrag.engines.spatial import _forces as forces
from rockfrag.engines.spatial import _gaps as gaps
from rockfrag.engines.spatial import _limits as limits
from rockfrag.engines.spatial import _points as points
from rockfrag.engines.spatial import _rest as rest

# distance of the centre of pressure from a face's edge over the furthest point's [-] that is rounding
ON_EDGE = 1e-9


@kernel
def stay_on_face(body, tau, y, rows, gravity, s):
    """Let a body that lies flat slide or rest on its whole face; return whether it stays on it.

    Points that slip by less than twice AT_REST may stick, if the ground carries the body at rest. A polygon that
    neither slips nor begins to is left to the forces of its contacts, and so is a round base with a taut tie.
    """
    slip = algebra.norm(y[solid.VELOCITY], y[solid.VELOCITY + 1])
    slip += body.furthest * abs(y[solid.SPIN + 2])
    load = rest.load_at_rest(body, y, rows, gravity, s)
    stands = rest.standing_margin(body, y, rows, load) >= 0
    slides = slip >= 2 * limits.AT_REST or rest.grip_margin(body, load) < 0
    slides = slides or (body.rim > 0 and not load.tied)
    if not slides or not carried_flat(body, tau, y, rows, load, s):
        return False
    if slip < 2 * limits.AT_REST and stands:
        gaps.come_to_rest(body, y, s)
    else:
        slide_flat(body, y, rows, load, s)
        s.counters[limits.SLIDINGS] += 1
    s.jammed = 0
    return True


@kernel
def carried_flat(body, tau, y, rows, load, s):
    """Whether a body that lies flat, and slides or is about to, stays on its face; s gets the mode of most.

    It stays if the centre of pressure under it is inside. A round base without ties stays if friction cannot tip
    it, µ h less than the distance of the rim; or if it does not slide yet and the ground carries it. ``tau`` is
    the time in the interval [s].
    """
    if body.rim == 0.0 or load.tied:
        slide_flat(body, y, rows, load, s)
        forces.rates(body, tau, y, s.slopes[0], s)
        return pressure_margin(body, s) > ON_EDGE * body.furthest
    off = algebra.norm(body.centre[0], body.centre[1])
    if body.kinetic * body.height + off < body.rim:
        return True
    return (
        algebra.norm(y[solid.VELOCITY], y[solid.VELOCITY + 1]) < limits.AT_REST
        and rest.topple_margin(body, rows, load.tilting) >= 0
    )


@kernel
def slide_flat(body, y, rows, load, s):
    """Let the body slide on its whole face: write such a mode to ``s``.

    Points slide where they slip to; those that do not slip yet slide where the load takes them.
    """
    # by ties the body turns as well [1/s²]
    turns = load.twisting / body.inertia[2, 2]
    n = points.pick_feet(body, y, rows, s)
    s.count, s.rests = n, 0
    for i in range(n):
        s.closed[i], s.slides[i] = s.which[i], case.SLIDES
    for i in range(n):
        u = delassus.slip_of(body, y, rows, i, s)
        p = algebra.to_world(rows, solid.arm(body, rows[2], s.closed[i]))
        x, z = load.force[0] - turns * p[1], load.force[1] + turns * p[0]
        level = max(algebra.norm(x, z), algebra.TINY)
        s.direction[i, 0], s.direction[i, 1] = x / level, z / level
        s.direction[i, 0], s.direction[i, 1] = forces.slip_direction(s, i, u[0], u[1])


@kernel
def pressure_margin(body, s):
    """Distance of the centre of pressure of a face from its nearest edge, or the rim; negative outside [m]."""
    x, y = pressure_centre(body, s)
    if body.rim > 0:
        return body.rim - algebra.norm(x, y)
    least = limits.NO_LIMIT
    for i in range(body.count):
        p, q = body.points[i], body.points[i + 1 if i + 1 < body.count else 0]
        along, across = q[0] - p[0], q[1] - p[1]
        moment = across * (p[0] - x) - along * (p[1] - y)
        least = min(least, moment / algebra.norm(along, across))
    return least


@kernel
def pressure_centre(body, s):
    """Where the normal forces of the closed points act, in the base of the body, (x, y) [m].

    It counts from the centre of a round base, and of a polygon from below the centre of mass, where body.centre is
    0.
    """
    x, y, total = 0.0, 0.0, algebra.TINY
    for i in range(s.count):
        x += s.lam[i, 2] * (body.points[s.closed[i], 0] - body.centre[0])
        y += s.lam[i, 2] * (body.points[s.closed[i], 1] - body.centre[1])
        total += s.lam[i, 2]
    return x / total, y / total
