"""Which points of a body touch the ground and walls.

In: a state. Out: the points that touch, of which those few that an impact or a choice of a mode is about are kept.
Theory: ``docs/space.md``, "Friction and impacts".

Names (``_body`` explains the state and the numbers of contacts):

- ``body``, ``s``: records ``BODY`` and ``CASE``; ``y``: the state, shape (15,)
- ``rows``: the world's axes as the body sees them, ``rows[2]`` the upward one
- ``s.which``: of the n contacts of a small system, those that touch and are solved for
"""

import math

from rockfrag.base.elementary import atan2
from rockfrag.engines.algebra import vectors as algebra
from rockfrag.engines.compile.jit import kernel
from rockfrag.engines.spatial import _body as solid
from rockfrag.engines.spatial import _case as case
from rockfrag.engines.spatial import _limits as limits
from rockfrag.engines.spatial import _rest as rest

# difference of velocities that is rounding [m/s]: of contacts as fast as each other the first ones are kept
AS_FAST = 1e-14


@kernel
def touching(body, y, rows, s):
    """Fill s.which with the contacts that touch, at most four, the fastest to approach; return how many.

    A round base that lies flat stands on four points of its rim, as its lowest point has no direction.
    """
    if body.rim > 0 and algebra.norm(rows[2][0], rows[2][1]) < limits.FLAT:
        return stand_on_feet(body, y, rows, s)
    n = 0
    for i in solid.candidates(body):
        if solid.gap(body, y, rows[2], i) > limits.TOUCH:
            continue
        n = keep_fastest(i, solid.velocity_of(body, y, rows, i)[2], n, s)
    for i in solid.wall_candidates(body):
        n = add_wall_contact(body, y, rows, i, n, s)
    return n


@kernel
def add_wall_contact(body, y, rows, i, n, s):
    """Add contact i of a corner with a wall to the n of s.which that touch, if it does; return their number."""
    if not solid.may_meet(body, i) or solid.gap_of(body, y, rows, i) > limits.TOUCH:
        return n
    return keep_fastest(i, solid.approach_of(body, y, rows, i), n, s)


@kernel
def keep_fastest(i, velocity, n, s):
    """Add contact i to the n of s.which; return how many there are, at most four.

    ``velocity`` is that of the contact away from the ground or its wall [m/s]. If all four places are taken, i
    takes that of the slowest to approach, if it is faster. ``s.vector`` holds the velocities of those that are
    kept.
    """
    away = s.vector
    if n < case.MOST:
        s.which[n], away[n] = i, velocity
        return n + 1
    slowest = 0
    for k in range(1, case.MOST):
        if away[k] > away[slowest]:
            slowest = k
    if velocity < away[slowest] - AS_FAST:
        s.which[slowest], away[slowest] = i, velocity
    return n


@kernel
def stand_on_feet(body, y, rows, s):
    """Fill s.which with the feet of a flat round base: four points of its rim; return how many touch.

    ``body.points`` holds 32 points of the rim in equal steps of angle. The first foot is the one next to where the
    body would tip: ahead of its centre if it slides, else where the ground's motion and ties push it. The others
    follow at right angles.
    """
    centre = (body.centre[0], body.centre[1], -body.height)
    forwards = solid.point_velocity(y, rows, centre)
    if algebra.norm(forwards[0], forwards[1]) < limits.AT_REST:
        now = (s.field[0], s.field[1], s.field[2])
        forwards = rest.load_at_rest(body, y, rows, now, s).tilting
    ahead = algebra.to_body(rows, (forwards[0], forwards[1], 0.0))
    quarter = body.count // case.MOST
    turns = atan2(ahead[1], ahead[0]) / (2 * math.pi)
    first = math.floor(turns * body.count + 0.5) % body.count
    n = 0
    for k in range(case.MOST):
        i = (first + k * quarter) % body.count
        if solid.gap(body, y, rows[2], i) <= limits.TOUCH:
            s.which[n] = i
            n += 1
    return n


@kernel
def pick_feet(body, y, rows, s):
    """Fill s.which with the points on which a whole face slides; return how many.

    Of a polygon they are four vertices at most, evenly taken; of a round base its four feet.
    """
    if body.rim > 0:
        return touching(body, y, rows, s)
    n = min(body.count, case.MOST)
    for k in range(n):
        s.which[k] = k * body.count // n
    return n


@kernel
def count_touching(body, y, rows):
    """How many points of the base touch; of a round one, of the 32 points of its rim that body.points holds."""
    n = 0
    for i in range(body.count):
        n += solid.gap(body, y, rows[2], i) <= limits.TOUCH
    return n


@kernel
def lies_flat(body, y, rows):
    """Whether a body lies flat on the ground, neither rises nor begins to tilt; it may slide and spin."""
    if (
        algebra.norm(rows[2][0], rows[2][1]) > limits.FLAT
        or abs(y[solid.UPWARD]) > limits.LEAVES
    ):
        return False
    turns = (
        algebra.norm(y[solid.SPIN], y[solid.SPIN + 1]) > limits.LEAVES / body.furthest
    )
    return not turns and abs(y[solid.HEIGHT] - body.height) < limits.TOUCH


@kernel
def meets_wall(body, y, rows):
    """Whether a corner of base or face touches a wall."""
    found = False
    for i in solid.wall_candidates(body):
        if not found and solid.may_meet(body, i):
            found = solid.gap_of(body, y, rows, i) <= limits.TOUCH
    return found
