"""Whether a body that stands goes on standing: margins of tipping, of sliding and of what holds it.

In: a state at rest and the effective gravity. Out: margins, negative where the body tips or slides or its bond
breaks. Theory: ``docs/space.md``, "Friction and impacts"; ``docs/holding.md``.

Names (``_body`` explains the state and the numbers of contacts):

- ``body``, ``s``: records ``BODY`` and ``CASE``; ``y``: the state, shape (15,)
- ``rows``: the world's axes as the body sees them, ``rows[2]`` the upward one
- ``gravity``: effective gravity, equation 1, in the world [m/s²]
"""

from typing import Any, NamedTuple

from rockfrag.engines.algebra import vectors as algebra
from rockfrag.engines.compile.jit import kernel
from rockfrag.engines.spatial import _body as solid
from rockfrag.engines.spatial import _case as case
from rockfrag.engines.spatial import _limits as limits
from rockfrag.engines.spatial import _ties as ties

# force of ties over the weight [-] that is rounding; and what two directions differ by that are one [-]
NO_FORCE, PARALLEL = 1e-9, 1e-9


class Load(NamedTuple):
    """What acts on a body as it stands, in the world."""

    force: Any  # gravity and ties, (x, y, up) [N/kg]
    tilting: Any  # the force at the centre of mass that would tip it as they do [N/kg]
    twisting: float  # moment about the vertical [N m/kg]
    tied: bool  # whether a tie acts


@kernel
def rest_margin(body, y, rows, gravity, s):
    """Least margin by which a body rests [m/s²]: against tipping over each edge of its base, and against sliding.

    Negative: the ground does not carry it at rest (``docs/space.md``, equation 21).
    """
    if s.bonded:
        return bond_margin(body, rows, gravity)
    return standing_margin(body, y, rows, load_at_rest(body, y, rows, gravity, s))


@kernel
def standing_margin(body, y, rows, load):
    """Least margin by which a body that no bond holds rests under a load, as :func:`rest_margin` says.

    Edges lie between points that touch and follow each other around the base. With less than two points it is -1:
    no rest.
    """
    tilting, margin = load.tilting, grip_margin(body, load)
    if body.rim > 0:
        return min(margin, topple_margin(body, rows, tilting))
    last = -1
    first = -1
    for i in range(body.count):
        if solid.gap(body, y, rows[2], i) > limits.TOUCH:
            continue
        if last >= 0:
            margin = min(margin, tipping_margin(body, y, rows, tilting, last, i))
        else:
            first = i
        last = i
    if first == last:
        return -1.0
    return min(margin, tipping_margin(body, y, rows, tilting, last, first))


@kernel
def load_at_rest(body, y, rows, gravity, s):
    """What acts on a body as it stands: gravity and taut ties, less what walls bear. See :class:`Load`.

    A force f at the height z over the centre of mass tips as one of f (1 + z / h) at that centre would.
    """
    force, tilting, twisting, tied = gravity, gravity, 0.0, False
    if is_tied(body, y, rows, s):
        tied = True
        moment = algebra.to_world(rows, ties.twist_by_ties(s))
        force = algebra.to_world(rows, (s.pulled[0], s.pulled[1], s.pulled[2]))
        force = algebra.plus(gravity, force)
        x, z = moment[1] / body.height, -moment[0] / body.height
        tilting, twisting = algebra.plus(force, (x, z, 0.0)), moment[2]
    if body.walls:
        force = borne_by_ground(body, y, rows, force)
        tilting = borne_by_ground(body, y, rows, tilting)
    return Load(force, tilting, twisting, tied)


@kernel
def grip_margin(body, load):
    """By how much static friction of the whole base holds more than acts along it [m/s²].

    Beside a moment about the vertical it holds less: its limit is an ellipse, whose axis is the moment that an
    even pressure bears (Howe and Cutkosky 1996).
    """
    level = algebra.norm(load.force[0], load.force[1])
    if load.twisting != 0.0:
        level = algebra.norm(level, load.twisting / body.twist)
    return -body.static * load.force[2] - level


@kernel
def tipping_margin(body, y, rows, gravity, i, j):
    """Margin of rest against tipping over the edge from point i to j [m/s²]; without limit if a wall is there."""
    if body.walls and backed_by_wall(body, y, rows, i, j):
        return limits.NO_LIMIT
    return edge_margin(body, y, rows, gravity, i, j)


@kernel
def edge_margin(body, y, rows, gravity, i, j):
    """Margin of rest against tipping over the edge from point i to the next point j that touches [m/s²].

    It is the moment about the edge of the effective gravity over the height of the centre of mass, positive while
    it holds the body down (``docs/space.md``, equation 21).
    """
    p = solid.position_of_base(y, rows, solid.arm(body, rows[2], i))
    q = solid.position_of_base(y, rows, solid.arm(body, rows[2], j))
    length = algebra.norm(q[0] - p[0], q[1] - p[1])
    # outwards in the plan; how far the edge lies out there, and what acts that way
    normal = ((q[1] - p[1]) / length, -(q[0] - p[0]) / length)
    x, z, height = y[solid.PLACE], y[solid.PLACE + 1], y[solid.HEIGHT]
    reach = normal[0] * (p[0] - x) + normal[1] * (p[1] - z)
    outward = normal[0] * gravity[0] + normal[1] * gravity[1]
    return -(height * outward + reach * gravity[2]) / height


@kernel
def backed_by_wall(body, y, rows, i, j):
    """Whether a body cannot tip over the edge from point i to j, as its side there lies against a wall."""
    p, q = solid.arm(body, rows[2], i), solid.arm(body, rows[2], j)
    edge = algebra.to_world(rows, algebra.minus(q, p))
    length = algebra.norm(edge[0], edge[1])
    outward = (edge[1] / length, -edge[0] / length)
    for w in range(body.constraints):
        along = outward[0] * body.away[w, 0] + outward[1] * body.away[w, 1]
        against = not body.ties[w] and along <= -1.0 + PARALLEL
        if against and lies_against(body, y, rows, w):
            return True
    return False


@kernel
def lies_against(body, y, rows, w):
    """Whether a body that stands touches wall w with a side: at two or more of its upper corners."""
    touch = 0
    for k in range(body.corners):
        at = solid.WALLS + w * solid.MOST_CORNERS + k
        high = body.corner[k, 2] > 0.0
        touch += high and solid.gap_of(body, y, rows, at) <= limits.TOUCH
    return touch >= 2


@kernel
def borne_by_ground(body, y, rows, gravity):
    """Part of the effective gravity [m/s²] that the ground has to bear under a body at rest beside walls.

    A wall can bear what presses a side against it, at the height of the centre of mass; that part is taken out.
    """
    for w in range(body.constraints):
        a, b = body.away[w, 0], body.away[w, 1]
        into = -(a * gravity[0] + b * gravity[1])
        if not body.ties[w] and into > 0.0 and lies_against(body, y, rows, w):
            gravity = (gravity[0] + into * a, gravity[1] + into * b, gravity[2])
    return gravity


@kernel
def topple_margin(body, rows, gravity):
    """Margin of a flat round body against tipping, whatever it slides [m/s²] (``docs/space.md``, equation 21)."""
    centre = algebra.to_world(rows, (body.centre[0], body.centre[1], 0.0))
    moment_x = body.height * gravity[0] + gravity[2] * centre[0]
    moment_y = body.height * gravity[1] + gravity[2] * centre[1]
    overturning = algebra.norm(moment_x, moment_y)
    return (-body.rim * gravity[2] - overturning) / body.height


@kernel
def bond_margin(body, rows, gravity):
    """What a bond has left [N/kg]: of its tension, at the worst of four pads, and of its shear with friction.

    Source: ``docs/holding.md``, 2.
    """
    weight = -gravity[2]
    shear = body.shear + body.static * weight - algebra.norm(gravity[0], gravity[1])
    # all pads hold twice what a side of two holds
    tension = body.tension - 2.0 * bond_tension(body, rows, gravity)
    return min(tension, shear)


@kernel
def bond_tension(body, rows, gravity):
    """Twice the tension of that of a bond's four pads that is in most tension [N/kg]; negative if all are pressed.

    A pad takes a quarter of the load, and of the moment about each axis a quarter over half the distance of the
    pads, which body.pads holds; body.aside is how far the centre of mass is from between them. Twice a pad's is
    what a side of two pads bears where one moment vanishes.
    """
    flat = algebra.to_body(rows, (gravity[0], gravity[1], 0.0))
    total = gravity[2]
    for k in range(2):
        moment = body.height * flat[k] - gravity[2] * body.aside[k]
        total += abs(moment) / body.pads[k]
    return 0.5 * total


@kernel
def is_tied(body, y, rows, s):
    """Whether ties act at a body as it stands with more than rounding; their force stays in s.pulled [N/kg]."""
    if body.constraints == 0:
        return False
    ties.fill_tie_forces(body, y, rows, s)
    pulled = abs(s.pulled[0]) + abs(s.pulled[1]) + abs(s.pulled[2])
    return pulled > NO_FORCE * s.field[case.GRAVITY]
