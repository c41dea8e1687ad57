"""Rest: how long it lasts, and how it ends.

In: a body at rest and the ground's motion. Out: the instant at which it is no longer at rest, and the mode in
which it goes on. Theory: ``docs/space.md``, "Steps".

Names (``_body`` explains the state and the numbers of contacts):

- ``body``, ``s``: records ``BODY`` and ``CASE``; ``y``: the state, shape (15,)
- ``rows``: the world's axes as the body sees them, ``rows[2]`` the upward one
- ``tau``: time in an interval [s]; ``gravity``: effective gravity, equation 1, in the world [m/s²]
"""

from rockfrag.engines.algebra import vectors as algebra
from rockfrag.engines.compile.jit import kernel
from rockfrag.engines.pure_rocking.kernels.roots import narrowed
from rockfrag.engines.spatial import _body as solid
from rockfrag.engines.spatial import _case as case
from rockfrag.engines.spatial import _contacts as contacts
from rockfrag.engines.spatial import _face as face
from rockfrag.engines.spatial import _limits as limits
from rockfrag.engines.spatial import _modes as modes
from rockfrag.engines.spatial import _rest as rest
from rockfrag.engines.spatial import _rim as rim

NO_MARGIN = 1e-9  # part of gravity by which a margin of rest is none [-]


@kernel
def rests_on(body, y, peaks, k, scale, g, s):
    """Whether a body at rest stays there for the next WINDOW intervals, whichever way the ground pushes."""
    level, weight = scale * peaks[k, 2], g - scale * peaks[k, 3]
    upright = level * body.height < weight * body.nearest * (1 - NO_MARGIN)
    carried = upright and level < body.static * weight
    return carried and not rest.is_tied(body, y, algebra.rotation(y), s)


@kernel
def rest_ends(body, y, s, tau, dt):
    """Time in the interval when the ground no longer carries the body at rest [s], -1 if it does to the end.

    The margin of rest is a concave function of time within an interval, so that it is enough to look at both ends;
    its zero is found by false position.
    """
    field = s.field
    gravity = case.effective_gravity_at(field, dt)
    level = algebra.norm(gravity[0], gravity[1])
    upright = level * body.height < -gravity[2] * body.nearest * (1 - NO_MARGIN)
    rows = algebra.rotation(y)
    carried = upright and level < -body.static * gravity[2]
    if carried and not s.bonded and not rest.is_tied(body, y, rows, s):
        # a flat body rests whichever way it is pulled
        return -1.0
    below = rest.rest_margin(body, y, rows, gravity, s)
    if below >= 0:
        return -1.0
    above = rest.rest_margin(body, y, rows, case.effective_gravity_at(field, tau), s)
    if above <= 0:
        return tau
    bracket = (tau, above, dt, below, 0)
    for _ in range(100):
        low, above, high, below, _ = bracket
        middle = (low * below - high * above) / (below - above)
        value = rest.rest_margin(
            body, y, rows, case.effective_gravity_at(field, middle), s
        )
        bracket = narrowed(bracket, middle, value)
        if abs(value) < 1e-14:
            return middle
        if bracket[2] - bracket[0] < 1e-15:
            break
    return bracket[2]


@kernel
def leave_rest(body, y, tau, s):
    """Choose how the body leaves rest at ``tau``, and write the mode to ``s``: it slides or tips.

    It tips over the rim, or over each edge whose margin is gone; two edges at once leave the vertex that they
    share.
    """
    rows = algebra.rotation(y)
    gravity = case.effective_gravity_at(s.field, tau)
    load = rest.load_at_rest(body, y, rows, gravity, s)
    gravity = load.force
    small = NO_MARGIN * s.field[case.GRAVITY]
    s.rests = 0
    jumps = load.tied or rest.standing_margin(body, y, rows, load) < -small
    if jumps or rest.grip_margin(body, load) < small:
        slide_or_jump(body, y, tau, s, load, jumps)
        return
    if body.rim > 0:
        b = algebra.to_body(rows, (gravity[0], gravity[1], 0.0))
        # the moment about the base's centre (equation 21), in the body
        centre = -gravity[2] / body.height
        towards_x = b[0] - centre * body.centre[0]
        towards_y = b[1] - centre * body.centre[1]
        rim.start_rolling(body, y, towards_x, towards_y, gravity, s)
        return
    s.count = 0
    last, first = -1, -1
    for i in range(body.count):
        if solid.gap(body, y, rows[2], i) <= limits.TOUCH:
            if last >= 0:
                add_edge(body, y, rows, gravity, last, i, small, s)
            else:
                first = i
            last = i
    add_edge(body, y, rows, gravity, last, first, small, s)
    contacts.anchor_all(body, y, s)


@kernel
def slide_or_jump(body, y, tau, s, load, jumps):
    """Leave rest by sliding on the whole base, or, after a jump of the load, in any mode.

    A load that ``jumps`` has left the margin of rest behind at once; so may one with a taut tie.
    """
    if jumps and modes.choose_mode(body, tau, y, s):
        return
    face.slide_flat(body, y, algebra.rotation(y), load, s)
    s.counters[limits.SLIDINGS] += 1


@kernel
def add_edge(body, y, rows, gravity, i, j, small, s):
    """Close the ends of the edge from point i to j if the body tips over it; of two edges their vertex alone.

    It tips where the margin is not above ``small`` [m/s²].
    """
    if rest.edge_margin(body, y, rows, gravity, i, j) > small:
        return
    if s.count == 0:
        s.closed[0], s.closed[1] = i, j
        s.slides[0] = case.STICKS
        s.slides[1] = case.STICKS
        s.count = 2
    else:
        shared = i if i in (s.closed[0], s.closed[1]) else j
        s.closed[0] = shared
        s.count = 1
