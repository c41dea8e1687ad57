"""The one problem of contacts with Coulomb's cone: which of those that touch push, and how much.

In: contacts that touch, and how each would move if none pushed. Out: impulses, or forces, and which contacts push.
Impacts and the choice of a mode both ask it. Theory: ``docs/space.md``, "Friction and impacts" and "Derivations",
equations 9 to 14.

Names (``_body`` explains the state and the numbers of contacts):

- ``body``, ``s``: records ``BODY`` and ``CASE``; ``y``: the state, shape (15,)
- ``rows``: the world's axes as the body sees them, ``rows[2]`` the upward one
- ``s.which``: of the n contacts of a small system, those that touch and are solved for
- ``found``: the contacts of a small system that push, as bits: bit k for ``s.which[k]``; -1 without a solution
- ``s.free``, ``s.impulse``, ``s.after``: of contact k at 3 k and 3 k + 1 along it, and at 3 k + 2 away from it
"""

from rockfrag.engines.algebra import vectors as algebra
from rockfrag.engines.compile.jit import kernel
from rockfrag.engines.spatial import _body as solid
from rockfrag.engines.spatial import _case as case
from rockfrag.engines.spatial import _delassus as delassus
from rockfrag.engines.spatial import _limits as limits
from rockfrag.engines.spatial import _stick as stick
from rockfrag.engines.spatial._cone import solve_cones

# contacts beyond the first four, beside a wall, that are taken in at most, one at a time; velocity [m/s] or, over
# gravity, acceleration [-] at which they approach
TAKEN_IN, MISSED = 8, 1e-9


@kernel
def fill_edges(body, y, rows, which, n, s):
    """Fill s.edge[i, j], (n, n, 2), with the unit vectors from contact i to j of ``which`` along their surface.

    Of contacts with the ground they are in axes of the ground; of those with walls see :func:`along_wall`.
    Impulses along an edge may be split between its ends (``docs/space.md``, equation 13).
    """
    for i in range(n):
        p = solid.position_of_base(y, rows, solid.arm(body, rows[2], which[i]))
        for j in range(n):
            if which[i] >= solid.WALLS or which[j] >= solid.WALLS:
                along_wall(body, y, rows, which, i, j, s)
                continue
            q = solid.position_of_base(y, rows, solid.arm(body, rows[2], which[j]))
            length = max(algebra.norm(q[0] - p[0], q[1] - p[1]), algebra.TINY)
            s.edge[i, j, 0] = (q[0] - p[0]) / length
            s.edge[i, j, 1] = (q[1] - p[1]) / length


@kernel
def along_wall(body, y, rows, which, i, j, s):
    """Fill s.edge[i, j], if contacts i or j of ``which`` are at a wall, with the unit vector from i to j along it.

    The two components are those of equation 9 along the wall. Contacts of different surfaces have no edge to split
    an impulse along: theirs is (0, 0).
    """
    s.edge[i, j, 0] = s.edge[i, j, 1] = 0.0
    first, second = which[i], which[j]
    both_at_walls = first >= solid.WALLS and second >= solid.WALLS
    if not both_at_walls or solid.wall_of(first) != solid.wall_of(second):
        return
    p, q = solid.arm(body, rows[2], first), solid.arm(body, rows[2], second)
    along = solid.in_frame(body, first, algebra.to_world(rows, algebra.minus(q, p)))
    length = max(algebra.norm(along[0], along[1]), algebra.TINY)
    s.edge[i, j, 0], s.edge[i, j, 1] = along[0] / length, along[1] / length


@kernel
def note_slips(body, n, s):
    """Fill what friction in an impact depends on, for each contact of s.which, from s.free.

    ``s.slid`` and ``s.came``: whether it slips before and where to; ``s.friction`` and ``s.holds``: its kinetic
    and static coefficients; no contact has the direction of its slip given but one without friction.
    """
    for i in range(n):
        u, v = s.free[3 * i], s.free[3 * i + 1]
        speed = algebra.norm(u, v)
        s.given[i], s.slid[i] = 0, speed > limits.AT_REST
        if s.slid[i]:
            s.came[i, 0], s.came[i, 1] = u / speed, v / speed
        s.friction[i] = solid.kinetic_of(body, s.which[i])
        s.holds[i] = solid.static_of(body, s.which[i])
        if solid.is_smooth(body, s.which[i]):
            let_slip(i, s)


@kernel
def let_slip(i, s):
    """Let contact i of a small system, which has no friction, slip whatever its velocity.

    Its direction of slip is given, any will do. It counts as not having slipped before, so that it regains no
    grip.
    """
    s.given[i], s.slid[i] = 1, 0
    s.way[i, 0], s.way[i, 1] = 1.0, 0.0


@kernel
def solve(body, y, rows, n, least, moment, s):
    """Find the impulses (or forces) at the n contacts s.which; return the set that pushes, and how many would do.

    Arguments are those of :func:`_stick.stick_alone_or_by_two`, which finds nearly all. What slides, regains its
    grip or is at a wall goes to the cones at once.
    """
    plain = not case.picks_wall(n, s)
    for i in range(n):
        regains = s.slid[i] and s.friction[i] < s.holds[i]
        plain = plain and not (s.given[i] or regains)
    if plain:
        found, solutions = stick.stick_alone_or_by_two(body, rows, n, least, moment, s)
        if found >= 0:
            return found, solutions
    delassus.fill_delassus(body, rows, s.which, n, s.delassus)
    fill_edges(body, y, rows, s.which, n, s)
    return solve_cones(s, n, least)


@kernel
def missed(body, y, rows, n, moves, small, pushed, s):
    """Number of the contact that touches, is none of s.which and approaches fastest; -1 if none approaches.

    ``moves`` holds what the centre of mass and the body do after an impact: velocity [m/s] and angular velocity
    [rad/s] in the body. If ``pushed``, they are accelerations in their place, and contacts that leave already are
    left out. What approaches more slowly than ``small`` [m/s or m/s²] does not count.
    """
    load, spin = moves
    fastest, least = -1, -small
    for k in range(solid.meetings(body)):
        i = solid.meeting(body, k)
        u = approaches(body, y, rows, n, i, load, spin, pushed, s)
        if u < least:
            fastest, least = i, u
    return fastest


@kernel
def approaches(body, y, rows, n, i, load, spin, pushed, s):
    """Velocity [m/s] or acceleration [m/s²] of contact i away from its surface, if it touches outside of s.which.

    It is 0 of all others; arguments are those of :func:`missed`.
    """
    for k in range(n):
        if s.which[k] == i:
            return 0.0
    is_tie = i >= solid.WALLS and body.ties[solid.wall_of(i)]
    if is_tie or solid.gap_of(body, y, rows, i) > limits.TOUCH:
        return 0.0
    if pushed and solid.approach_of(body, y, rows, i) > limits.LEAVES:
        return 0.0
    p = solid.arm(body, rows[2], i)
    u = algebra.plus(load, algebra.cross(spin, p))
    if pushed:
        u = algebra.plus(u, solid.bias(body, rows[2], solid.omega_of(y), p, i))
    return solid.in_frame(body, i, algebra.to_world(rows, u))[2]


@kernel
def is_approached(body, y, s):
    """Whether a contact that touches comes closer."""
    rows = algebra.rotation(y)
    moves = (algebra.to_body(rows, solid.centre_velocity(y)), solid.omega_of(y))
    return missed(body, y, rows, 0, moves, limits.CLOSE, False, s) >= 0


@kernel
def least_needed(n, found, s):
    """Place in s.which of the contact that another one may replace; -1 if all push.

    It is the one that is not in the set ``found`` and parts fastest, by s.after.
    """
    best = -1
    for k in range(n):
        apart = s.after[3 * k + 2]
        if not case.in_set(found, k) and (best < 0 or apart > s.after[3 * best + 2]):
            best = k
    return best
