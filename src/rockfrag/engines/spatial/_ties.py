"""Ties of a body in space: how long they are, whether they are taut, and how they pull.

In: a record ``BODY``, a state y. Out: forces and moments for a unit of mass [N/kg, N m/kg]. Theory:
``docs/holding.md``, "Tie: cord, strap, bracket".

- ``rows``: the world's axes as the body sees them, ``rows[2]`` the upward one; ``s``: record ``CASE``
- ``i``: number of a constraint
"""

import math

from rockfrag.engines.algebra.vectors import (
    cross,
    dot,
    plus,
    scaled,
    to_body,
    to_world,
)
from rockfrag.engines.compile.jit import kernel
from rockfrag.engines.spatial import _body as solid


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
def twist_by_ties(s):
    """Moment of the ties about the centre of mass, in the body [N m/kg]."""
    return (s.twisted[0], s.twisted[1], s.twisted[2])


@kernel
def load_on(body, y, rows, gravity, s):
    """Effective gravity and the force of the ties, in the body [N/kg]; the ties' part is kept in ``s``."""
    fill_tie_forces(body, y, rows, s)
    weight = to_body(rows, gravity)
    return plus(weight, (s.pulled[0], s.pulled[1], s.pulled[2]))
