"""Where bodies meet walls: contacts of one body with the ground whose face is upright (``docs/holding.md``, 1).

Ends of such a contact are the two corners of the body's side towards the wall, in the order in which the wall's
tangent meets them, so that its normal points to the body: from below at a wall to the right, from above at one to
the left.  Where a low wall ends below the upper corner, that end is the wall's edge against the body's side.

In: a record ``BODY`` and coordinates. Out: point, directions and gap [m] of each end at a wall; hits, and
impulses [N s].
"""

import math

from rockfrag.engines.compile.jit import inlined_kernel, kernel
from rockfrag.engines.planar.records import AT_EDGE

# impulse over mass and √(g b) below which a wall was not hit [-]
UNFELT = 1e-6
# distance behind the wall over the half width from which a corner is there and not on its face [-]
ACROSS = 1e-6


@inlined_kernel
def _flank_corner(p, w, q, k, end):
    """Corner (x, y) of a body's side at end ``end`` of its contact k with a wall."""
    body = p.upper[k]
    c, s = w.cos[body], w.sin[body]
    dx, dy = p.edge[k, end, 0], p.edge[k, end, 1]
    return q[3 * body] + dx * c + dy * s, q[3 * body + 1] - dx * s + dy * c


@inlined_kernel
def _along_side(p, w, k):
    """Direction (x, y) of a body's side, from its end 0 to its end 1, at its contact k with a wall."""
    body = p.upper[k]
    c, s = w.cos[body], w.sin[body]
    dx, dy = p.flank[k, 0], p.flank[k, 1]
    return dx * c + dy * s, -dx * s + dy * c


@kernel
def wall_end(p, w, q, k, end, kind):
    """End of contact k with a wall in the configuration ``q``, as :func:`rockfrag.engines.planar.solve.end_of`."""
    side, top = p.side[k], p.wall_top[k]
    x, y = _flank_corner(p, w, q, k, end)
    tx, ty, gap = 0.0, float(side), side * (p.wall_x[k] - x)
    if p.is_stop[k] == 1 and end == 1:
        # a plate meets its stop at one place
        gap = math.inf
    if top == math.inf:
        return x, y, tx, ty, gap, -math.inf, 1
    upper = 1 if side > 0 else 0
    beyond = y - top if end == upper else -math.inf
    if end == upper and -gap > ACROSS * p.size:
        # the body lies across the wall's edge, and its corner is behind it
        beyond = max(beyond, -gap)
    if kind < 0 and is_above(p, w, q, k):
        # past the wall, or clear of it: nothing of the side is beside it
        return x, y, tx, ty, math.inf, beyond, 1
    if kind < 0:
        kind = 1 if beyond <= AT_EDGE * p.size else 0
    if kind == 1:
        return x, y, tx, ty, gap, beyond, 1
    tx, ty = _along_side(p, w, k)
    ex, ey = p.wall_x[k], top
    return ex, ey, tx, ty, -ty * (x - ex) + tx * (y - ey), beyond, 0


@kernel
def is_above(p, w, q, k):
    """Whether the lower corner of the side of a body is above the upper edge of the wall."""
    _, y = _flank_corner(p, w, q, k, 0 if p.side[k] > 0 else 1)
    return y > p.wall_top[k] + AT_EDGE * p.size


@kernel
def has_left(p, w, q, k):
    """Whether a contact that is closed has left a low wall upwards.

    Its corner is above the wall's face then, or the wall's edge is below the lower corner of the side, along the
    side: a side that lies on the edge may have its lower corner above it.
    """
    upper = 1 if p.side[k] > 0 else 0
    if w.closed[k, upper] == 0 or w.kind[k, upper] == 1:
        return is_above(p, w, q, k)
    x, y = _flank_corner(p, w, q, k, 1 - upper)
    tx, ty = _along_side(p, w, k)
    up = p.side[k] * ((p.wall_x[k] - x) * tx + (p.wall_top[k] - y) * ty)
    return up < -AT_EDGE * p.size


@kernel
def climbs(p, w, q, k):
    """Whether the lower corner of the side of a body is above and behind the wall's upper edge."""
    if p.wall_top[k] == math.inf or not is_above(p, w, q, k):
        return False
    x, _ = _flank_corner(p, w, q, k, 0 if p.side[k] > 0 else 1)
    return p.side[k] * (x - p.wall_x[k]) > AT_EDGE * p.size


@kernel
def any_closed(p, w):
    """Whether a body presses on a wall in the mode in ``w``."""
    presses = False
    for k in range(p.count, p.contacts):
        presses = presses or w.closed[k].any()
    return presses


@kernel
def note_impulses(p, w):
    """Count the hits of walls in an impact whose impulses are in ``w``, and add these to what walls have given."""
    for k in range(p.count, p.contacts):
        given = w.normal[k, 0] + w.normal[k, 1]
        w.hit_shear[k] += w.shear[k]
        for end in range(2):
            w.hit[k, end] += w.normal[k, end]
        if given > UNFELT * p.weight / p.g * p.speed:
            at = p.wall[k]
            w.outcome.hits[at] += 1
            w.outcome.largest_impulse[at] = max(w.outcome.largest_impulse[at], given)


@kernel
def note_forces(p, w):
    """Keep the largest forces on walls, with those of a motion in ``w``."""
    for k in range(p.count, p.contacts):
        if not w.closed[k].any():
            # what stands there is of an impact, or of another case
            continue
        at, force = p.wall[k], w.normal[k, 0] + w.normal[k, 1]
        w.outcome.largest_force[at] = max(w.outcome.largest_force[at], force)
