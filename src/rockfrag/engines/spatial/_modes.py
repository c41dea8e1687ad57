"""Impacts, and which mode follows: both from the one problem of contacts with Coulomb's cone.

In: a state at a contact event and the points that touch. Out: the velocities after an impact [m/s, rad/s], and
which points stick, slide or part. Theory: ``docs/space.md``, "Friction and impacts" and "Derivations", equations 5
and 9 to 21.

Names (``_body`` explains the state and the numbers of contacts):

- ``body``, ``s``: records ``BODY`` and ``CASE``; ``y``: the state, shape (15,)
- ``rows``: the world's axes as the body sees them, ``rows[2]`` the upward one
- ``gravity``: effective gravity, equation 1, in the world [m/s²]; ``weight``: the same and the ties, in the body
- ``s.closed``: numbers of the ``s.count`` contacts of the mode; ``s.which``: of the n contacts of a small system,
  those that touch and are solved for
- ``found``: the contacts of a small system that push, as bits: bit k for ``s.which[k]``; -1 without a solution
- ``s.free``, ``s.impulse``, ``s.after``: of contact k at 3 k and 3 k + 1 along it, and at 3 k + 2 away from it
"""

import math

from rockfrag.base.elementary import atan2
from rockfrag.engines.algebra import vectors as algebra
from rockfrag.engines.compile.jit import kernel
from rockfrag.engines.spatial import _body as solid
from rockfrag.engines.spatial import _forces as forces
from rockfrag.engines.spatial import _stick as stick
from rockfrag.engines.spatial._cone import solve_cones

TOUCH = 1e-10  # gap below which a point touches [m]
FLAT = 1e-9  # sine of the tilt below which a body is flat [-]
CLOSE = 1e-6  # velocity after an impact below which a point stays closed at first [m/s]
# the velocity that points slip above when the mode is chosen [m/s]
AT_REST = forces.SLIP_FLOOR
# the same where no mode was found otherwise: one may hardly slip [m/s]
SLOW_SLIP = 30 * AT_REST
# velocity above which points that touch leave when the mode is chosen [m/s]
LEAVES = 1e-8
# difference of velocities that is rounding [m/s]: of contacts as fast as each other the first ones are kept
AS_FAST = 1e-14
# velocity, of the centre of mass and of the spin times its height, below which a body may be laid to rest [m/s]
STILL = 10 * CLOSE
# velocity below which a point without a way of slip does not slip [m/s]; shear over the limit of its cone from
# which it does [-]
NO_SLIP, AT_LIMIT = 1e-12, 1 - 1e-9
# hops of one end of an edge beside the other: speed above which they are followed [m/s]; part by which each is
# slower than the one before, at least [-]; and what closing them may change of the body's angular velocity [rad/s]
FASTEST_HOP, SLOWING, CHATTER = 1e-2, 0.05, 1e-6
# impulse beyond friction, for a unit of mass, that points which slip or leave slowly are stopped by unseen [m/s]
BEYOND = 1e-3
# contacts beyond the first four, beside a wall, that are taken in at most, one at a time; velocity [m/s] or, over
# gravity, acceleration [-] at which they approach
TAKEN_IN, MISSED = 8, 1e-9
# how often the ratios of walls are halved at most, and the energy that an impact may gain by rounding, over that
# which there is [-]
RATIO_HALVINGS, ROUNDING = 40, 1e-12
# force of ties over the weight [-], and distance of the centre of pressure from a face's edge over the furthest
# point's [-], that are rounding; and what two directions differ by that are one [-]
NO_FORCE, ON_EDGE, PARALLEL = 1e-9, 1e-9, 1e-9
NO_LIMIT = 1e300  # margin of what cannot happen
# compliance of contacts, over the largest of a body, by which gaps at walls are closed [-], and how many times
GAP_SOFTNESS, CLOSINGS = 1e-3, 3
# what ends a step: a point lands or opens, sticks no more or slips no more, a tie turns taut or slack, or breaks
LANDS, OPENS, LEAVES_CONE, SLIP_ENDS, TIE_TURNS, TIE_BREAKS = 1, 2, 3, 4, 5, 6
NOTHING = 0

# places of s.counters: impacts; problems of contacts with several solutions, and with none; points that began to
# slide; flights; modes that no forces allow (Painlevé)
COUNTERS = 6
IMPACTS, AMBIGUOUS, UNSOLVED, SLIDINGS, FLIGHTS, JAMS = range(COUNTERS)


@kernel
def touching(body, y, rows, s):
    """Fill s.which with the contacts that touch, at most four, the fastest to approach; return how many.

    A round base that lies flat stands on four points of its rim, as its lowest point has no direction.
    """
    if body.rim > 0 and algebra.norm(rows[2][0], rows[2][1]) < FLAT:
        return stand_on_feet(body, y, rows, s)
    n = 0
    for i in solid.candidates(body):
        if solid.gap(body, y, rows[2], i) > TOUCH:
            continue
        n = keep_fastest(i, solid.velocity_of(body, y, rows, i)[2], n, s)
    for i in solid.wall_candidates(body):
        n = add_wall_contact(body, y, rows, i, n, s)
    return n


@kernel
def add_wall_contact(body, y, rows, i, n, s):
    """Add contact i of a corner with a wall to the n of s.which that touch, if it does; return their number."""
    if not solid.may_meet(body, i) or solid.gap_of(body, y, rows, i) > TOUCH:
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
    if n < forces.MOST:
        s.which[n], away[n] = i, velocity
        return n + 1
    slowest = 0
    for k in range(1, forces.MOST):
        if away[k] > away[slowest]:
            slowest = k
    if velocity < away[slowest] - AS_FAST:
        s.which[slowest], away[slowest] = i, velocity
    return n


@kernel
def picks_wall(n, s):
    """Whether one of the n contacts of the small system, s.which, is of a corner with a wall."""
    found = False
    for k in range(n):
        found = found or s.which[k] >= solid.WALLS
    return found


@kernel
def stand_on_feet(body, y, rows, s):
    """Fill s.which with the feet of a flat round base: four points of its rim; return how many touch.

    ``body.points`` holds 32 points of the rim in equal steps of angle. The first foot is the one next to where the
    body would tip: ahead of its centre if it slides, else where the ground's motion pushes it. The others follow
    at right angles.
    """
    centre = (body.centre[0], body.centre[1], -body.height)
    forwards = solid.point_velocity(y, rows, centre)
    if algebra.norm(forwards[0], forwards[1]) < AT_REST:
        forwards = (s.field[0], s.field[1], 0.0)
    ahead = algebra.to_body(rows, (forwards[0], forwards[1], 0.0))
    quarter = body.count // forces.MOST
    turns = atan2(ahead[1], ahead[0]) / (2 * math.pi)
    first = math.floor(turns * body.count + 0.5) % body.count
    n = 0
    for k in range(forces.MOST):
        i = (first + k * quarter) % body.count
        if solid.gap(body, y, rows[2], i) <= TOUCH:
            s.which[n] = i
            n += 1
    return n


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
def kind_of_mode(s):
    """PIVOT or HINGE of a mode in which nothing is closed but one point or two that stick, or else GENERAL."""
    kind = forces.kind_of(s)
    return kind if kind in (forces.PIVOT, forces.HINGE) else forces.GENERAL


@kernel
def hold_still(body, y, rows, kind, s):
    """Stop the point or the edge that sticks by an impulse, in the state y (``docs/space.md``, equations 11, 12).

    ``kind`` is PIVOT or HINGE, as :func:`kind_of_mode` found. To both ends of an edge one load is given, the
    velocity of the centre of mass, so that an impulse can stop both: :func:`_forces.stop_edge` needs no tolerance.
    """
    velocity = algebra.to_body(rows, solid.centre_velocity(y))
    momentum = algebra.times(body.inertia, solid.omega_of(y))
    i = s.closed[0]
    if kind == forces.PIVOT:
        turn, push = forces.stop_point(body, rows[2], i, velocity, momentum)
    else:
        turn, push, _, _, _ = forces.stop_edge(
            body, rows[2], i, s.closed[1], velocity, velocity, momentum, 0.0
        )
    pushed = algebra.to_world(rows, push)
    solid.set_velocity(y, algebra.plus(solid.centre_velocity(y), pushed))
    solid.set_spin(y, turn)


@kernel
def hold(body, y, rows, s):
    """Take from the state y the velocity that the conditions of its mode forbid, by the least kinetic energy.

    What sticks may not move, what slides only along its surface. The impulses that see to it are without friction;
    of all changes of velocity that do it theirs is that of the least kinetic energy (Gauss).
    """
    n = s.count
    if n == 0:
        return
    kind = kind_of_mode(s)
    if kind != forces.GENERAL:
        hold_still(body, y, rows, kind, s)
        return
    twist = forces.twist_of(body, s)
    forces.fill_velocities(body, y, rows, s.closed, n, s.free, twist)
    forces.solve_general(body, y, rows, n, False, s)
    for i in range(n):
        push = (s.lam[i, 0], s.lam[i, 1], s.lam[i, 2])
        forces.push_at(body, y, rows, s.closed[i], push, twist)


@kernel
def impact(body, y, gravity, least, s):
    """Change the state y by an impact of all points that touch, and write the mode after it to ``s``.

    ``least`` is how many contacts push at least: 0 of a landing; 1 of an impact without a collision, which stands
    in for contact forces that do not exist (Painlevé). The mode keeps the contacts that pushed, and those that
    leave slowly.
    """
    rows = algebra.rotation(y)
    before = solid.centre_velocity(y)
    n = touching(body, y, rows, s)
    momentum = stick.fill_velocities(body, y, rows, n, s)
    if picks_wall(n, s):
        impact_at_wall(body, y, rows, gravity, n, least, s)
        return
    note_slips(body, n, s)
    found, solutions = solve(body, y, rows, n, least, momentum, s)
    s.counters[IMPACTS] += 1
    s.counters[AMBIGUOUS] += solutions > 1
    s.jammed = 0
    if found < 0:
        # last resort: no point that touches approaches or slips any more
        s.counters[UNSOLVED] += 1
        for i in range(n):
            s.closed[i], s.slides[i] = s.which[i], forces.STICKS
        s.count, s.rests = n, 0
        hold(body, y, rows, s)
        return
    for i in range(n):
        push = (s.impulse[3 * i], s.impulse[3 * i + 1], s.impulse[3 * i + 2])
        forces.push_at(body, y, rows, s.which[i], push)
    keep_slow_contacts(body, y, rows, gravity, n, found, s)
    witness(body, y, before, s)


@kernel
def impact_at_wall(body, y, rows, gravity, n, least, s):
    """Change the state y by an impact at walls and at the ground; arguments are those of :func:`impact`.

    ``n`` contacts are in s.which. More may touch than these: a round at a time, the one that would be passed
    through fastest takes the place of the one that is least needed.
    """
    came = (solid.centre_velocity(y), solid.omega_of(y))
    before = solid.energy(body, y, s.field[forces.GRAVITY])
    found, solutions = -1, 0
    for _ in range(TAKEN_IN):
        found, solutions = bounce_without_gain(body, y, rows, n, least, came, before, s)
        if found < 0:
            break
        load = algebra.to_body(rows, solid.centre_velocity(y))
        i = missed(body, y, rows, n, (load, solid.omega_of(y)), MISSED, False, s)
        at = least_needed(n, found, s)
        if i < 0 or at < 0:
            break
        s.which[at] = i
    s.counters[IMPACTS] += 1
    s.counters[AMBIGUOUS] += solutions > 1
    s.jammed = 0
    if found < 0:
        s.counters[UNSOLVED] += 1
        for i in range(n):
            smooth = solid.is_smooth(body, s.which[i])
            s.slides[i] = forces.SLIDES if smooth else forces.STICKS
            s.closed[i] = s.which[i]
        s.count, s.rests = n, 0
        hold(body, y, rows, s)
        return
    note_impulses(body, n, found, s)
    keep_slow_contacts(body, y, rows, gravity, n, found, s)


@kernel
def bounce_without_gain(body, y, rows, n, least, came, before, s):
    """Solve an impact at walls; return the set that pushes and how many would do.

    Newton's ratio together with friction may gain energy. The ratios of all walls are halved until they do not.
    ``came`` are the velocity [m/s] and the angular one [rad/s] before, which each trial begins with, and
    ``before`` the energy [J/kg].
    """
    part, found, solutions = 1.0, -1, 0
    for _ in range(RATIO_HALVINGS):
        solid.set_velocity(y, came[0])
        solid.set_spin(y, came[1])
        found, solutions = bounce(body, y, rows, n, least, part, s)
        if found < 0:
            break
        gained = solid.energy(body, y, s.field[forces.GRAVITY]) - before
        if gained <= ROUNDING * (before + s.field[forces.GRAVITY] * body.height):
            break
        part *= 0.5
    return found, solutions


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
    if is_tie or solid.gap_of(body, y, rows, i) > TOUCH:
        return 0.0
    if pushed and solid.approach_of(body, y, rows, i) > LEAVES:
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
    return missed(body, y, rows, 0, moves, CLOSE, False, s) >= 0


@kernel
def least_needed(n, found, s):
    """Place in s.which of the contact that another one may replace; -1 if all push.

    It is the one that is not in the set ``found`` and parts fastest, by s.after.
    """
    best = -1
    for k in range(n):
        apart = s.after[3 * k + 2]
        if not forces.in_set(found, k) and (best < 0 or apart > s.after[3 * best + 2]):
            best = k
    return best


@kernel
def bounce(body, y, rows, n, least, part, s):
    """Push the state y at the contacts s.which by the ratios of walls; return the set, and how many would do.

    A wall with the ratio e asks for u_n⁺ ≥ -e u_n⁻: e u_n⁻ is added to the velocity that is stopped. ``part`` is
    what all ratios are multiplied by. s.after gets the velocities as they are after the impact.
    """
    forces.fill_velocities(body, y, rows, s.which, n, s.free)
    note_slips(body, n, s)
    for i in range(n):
        if s.which[i] >= solid.WALLS:
            ratio = part * body.ratio[solid.wall_of(s.which[i])]
            s.free[3 * i + 2] += ratio * min(s.free[3 * i + 2], 0.0)
    forces.fill_delassus(body, rows, s.which, n, s.delassus)
    fill_edges(body, y, rows, s.which, n, s)
    found, solutions = solve_cones(s, n, least)
    for i in range(n if found >= 0 else 0):
        push = (s.impulse[3 * i], s.impulse[3 * i + 1], s.impulse[3 * i + 2])
        forces.push_at(body, y, rows, s.which[i], push)
    if found >= 0:
        # how contacts really part: those of a wall by its ratio too
        forces.fill_velocities(body, y, rows, s.which, n, s.after)
    return found, solutions


@kernel
def note_impulses(body, n, found, s):
    """Count the hits at each wall by the contacts of the set ``found``, and keep the largest impulse [m/s]."""
    for w in range(body.constraints):
        whole = 0.0
        for i in range(n):
            at_this = s.which[i] >= solid.WALLS and solid.wall_of(s.which[i]) == w
            if at_this and forces.in_set(found, i):
                whole += s.impulse[3 * i + 2]
        if whole > 0.0:
            s.hits[w] += 1.0
            s.impact[w] = max(s.impact[w], whole)


@kernel
def witness(body, y, before, s):
    """Note, and count, the momentum that an impact would need beyond what friction can give [m/s].

    ``before`` is the velocity of the centre of mass before; its change is the impulse of all contacts for a unit
    of mass. Static friction bears so much of its normal part along the ground. The largest excess stays in
    s.beyond, and one above BEYOND counts as a problem without a solution.
    """
    east, north, up = solid.VELOCITY, solid.VELOCITY + 1, solid.VELOCITY + 2
    shear = algebra.norm(y[east] - before[0], y[north] - before[1])
    beyond = shear - body.static * (y[up] - before[2])
    s.beyond = max(s.beyond, beyond)
    s.counters[UNSOLVED] += beyond > BEYOND


@kernel
def solve(body, y, rows, n, least, moment, s):
    """Find the impulses (or forces) at the n contacts s.which; return the set that pushes, and how many would do.

    Arguments are those of :func:`_stick.stick_alone_or_by_two`, which finds nearly all. What slides, regains its
    grip or is at a wall goes to the cones at once.
    """
    plain = not picks_wall(n, s)
    for i in range(n):
        regains = s.slid[i] and s.friction[i] < s.holds[i]
        plain = plain and not (s.given[i] or regains)
    if plain:
        found, solutions = stick.stick_alone_or_by_two(body, rows, n, least, moment, s)
        if found >= 0:
            return found, solutions
    forces.fill_delassus(body, rows, s.which, n, s.delassus)
    fill_edges(body, y, rows, s.which, n, s)
    return solve_cones(s, n, least)


@kernel
def note_slips(body, n, s):
    """Fill what friction in an impact depends on, for each contact of s.which, from s.free.

    ``s.slid`` and ``s.came``: whether it slips before and where to; ``s.friction`` and ``s.holds``: its kinetic
    and static coefficients; no contact has the direction of its slip given but one without friction.
    """
    for i in range(n):
        u, v = s.free[3 * i], s.free[3 * i + 1]
        speed = algebra.norm(u, v)
        s.given[i], s.slid[i] = 0, speed > AT_REST
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
def chatters(body, y, rows, gravity, i, k, leaving, s):
    """Whether contact k hops so little beside contact i, on which the body pivots, that both may close.

    ``i`` and ``k`` are places in s.which, ``leaving`` the speed of the hop [m/s]. Impacts at either end conserve
    the momentum about the edge between them, with which the body goes on when the hops are over. What is left out
    of it is at most that of equation 18 (``docs/space.md``), and must be below CHATTER.
    """
    if leaving > FASTEST_HOP:
        return False
    up, omega = rows[2], solid.omega_of(y)
    weight = forces.load_on(body, y, rows, gravity, s)
    here, there = s.which[i], s.which[k]
    p, turned = solid.arm_and_bias(body, up, omega, here)
    alpha, force = forces.pivot_acceleration(body, p, turned, omega, weight, here, s)
    q = solid.arm(body, up, there)
    # acceleration of the far end while the body pivots
    far = algebra.plus(weight, solid.bias(body, up, omega, q, there))
    far = algebra.plus(far, algebra.plus(force, algebra.cross(alpha, q)))
    falls = -algebra.dot(up, far)
    if falls <= 0.0:
        return False
    edge = algebra.minus(q, p)
    length = math.sqrt(algebra.dot(edge, edge))
    g = s.field[forces.GRAVITY]
    left_out = leaving**3 * g / (SLOWING * falls**2 * length * body.height)
    return left_out < CHATTER


@kernel
def hopping(body, y, rows, gravity, n, found, s):
    """Place in s.which of a contact that chatters beside the only one that pushed, and stuck; -1 if there is none.

    Rims do not hop. Of several contacts it is the one that leaves slowest.
    """
    slowest, alone = -1, -1
    for k in range(n):
        if found == 1 << k:
            alone = k
        elif slowest < 0 or s.after[3 * k + 2] < s.after[3 * slowest + 2]:
            slowest = k
    if alone < 0 or slowest < 0 or body.rim > 0.0:
        return -1
    if algebra.norm(s.after[3 * alone], s.after[3 * alone + 1]) > AT_REST:
        return -1
    leaving = s.after[3 * slowest + 2]
    closes = chatters(body, y, rows, gravity, alone, slowest, leaving, s)
    return slowest if closes else -1


@kernel
def keep_slow_contacts(body, y, rows, gravity, n, found, s):
    """Write the mode after an impact to ``s``: contacts that pushed, leave more slowly than s.close, or chatter.

    In: the n contacts s.which with s.after, and the set ``found`` that pushed. What is kept though it would leave
    is held, which changes the state y by little.
    """
    count = 0
    slow = False
    hops = -1
    if not picks_wall(n, s):
        hops = hopping(body, y, rows, gravity, n, found, s)
    for i in range(n):
        leaving = s.after[3 * i + 2]
        if forces.in_set(found, i) or leaving < s.close or i == hops:
            slow = slow or not forces.in_set(found, i)
            s.closed[count] = s.which[i]
            slip = algebra.norm(s.after[3 * i], s.after[3 * i + 1])
            slides = slip > max(s.close, AT_REST) and i != hops
            slides = slides or solid.is_smooth(body, s.which[i])
            s.slides[count] = forces.SLIDES if slides else forces.STICKS
            count += 1
    s.count, s.rests = count, 0
    if slow:
        hold(body, y, rows, s)


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
def pulled_by_ties(body, y, rows, s):
    """Whether ties act at a body as it stands with more than rounding; their force stays in s.pulled [N/kg]."""
    forces.fill_tie_forces(body, y, rows, s)
    pulled = abs(s.pulled[0]) + abs(s.pulled[1]) + abs(s.pulled[2])
    return pulled > NO_FORCE * s.field[forces.GRAVITY]


@kernel
def rest_margin(body, y, rows, gravity, s):
    """Least margin by which a body rests [m/s²]: against tipping over each edge of its base, and against sliding.

    Negative: the ground does not carry it at rest (``docs/space.md``, equation 21). Edges lie between points that
    touch and follow each other around the base. With ties in tension, or with less than two points, it is -1: no
    rest.
    """
    if s.bonded:
        return bond_margin(body, rows, gravity)
    if body.constraints > 0 and pulled_by_ties(body, y, rows, s):
        return -1.0
    if body.walls:
        gravity = borne_by_ground(body, y, rows, gravity)
    level = algebra.norm(gravity[0], gravity[1])
    margin = -body.static * gravity[2] - level
    if body.rim > 0:
        return min(margin, topple_margin(body, rows, gravity))
    last = -1
    first = -1
    for i in range(body.count):
        if solid.gap(body, y, rows[2], i) > TOUCH:
            continue
        if last >= 0:
            margin = min(margin, tipping_margin(body, y, rows, gravity, last, i))
        else:
            first = i
        last = i
    if first == last:
        return -1.0
    return min(margin, tipping_margin(body, y, rows, gravity, last, first))


@kernel
def tipping_margin(body, y, rows, gravity, i, j):
    """Margin of rest against tipping over the edge from point i to j [m/s²]; without limit if a wall is there."""
    if body.walls and backed_by_wall(body, y, rows, i, j):
        return NO_LIMIT
    return edge_margin(body, y, rows, gravity, i, j)


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
        touch += high and solid.gap_of(body, y, rows, at) <= TOUCH
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
def pulled_off(body, gravity):
    """Whether static friction of the whole base cannot hold it under an effective gravity in the world [m/s²]."""
    return algebra.norm(gravity[0], gravity[1]) > -body.static * gravity[2]


@kernel
def topple_margin(body, rows, gravity):
    """Margin of a flat round body against tipping, whatever it slides [m/s²] (``docs/space.md``, equation 21)."""
    centre = algebra.to_world(rows, (body.centre[0], body.centre[1], 0.0))
    moment_x = body.height * gravity[0] + gravity[2] * centre[0]
    moment_y = body.height * gravity[1] + gravity[2] * centre[1]
    overturning = algebra.norm(moment_x, moment_y)
    return (-body.rim * gravity[2] - overturning) / body.height


@kernel
def lies_flat(body, y, rows):
    """Whether a body lies flat on the ground, neither rises nor begins to tilt; it may slide and spin."""
    if algebra.norm(rows[2][0], rows[2][1]) > FLAT or abs(y[solid.UPWARD]) > LEAVES:
        return False
    turns = algebra.norm(y[solid.SPIN], y[solid.SPIN + 1]) > LEAVES / body.furthest
    return not turns and abs(y[solid.HEIGHT] - body.height) < TOUCH


@kernel
def meets_wall(body, y, rows):
    """Whether a corner of base or face touches a wall."""
    found = False
    for i in solid.wall_candidates(body):
        if not found and solid.may_meet(body, i):
            found = solid.gap_of(body, y, rows, i) <= TOUCH
    return found


@kernel
def carried_flat(body, tau, y, rows, gravity, s):
    """Whether a body that lies flat, and slides or is about to, stays on its face; s gets the mode of a polygon.

    A polygon stays if the centre of pressure under it is inside. A round base stays if friction cannot tip it, µ h
    less than the distance of the rim; or if it does not slide yet and the ground carries it. ``tau`` is the time
    in the interval [s].
    """
    if body.rim == 0.0:
        slide_flat(body, y, rows, gravity, s)
        forces.rates(body, tau, y, s.slopes[0], s)
        return pressure_margin(body, s) > ON_EDGE * body.furthest
    off = algebra.norm(body.centre[0], body.centre[1])
    if body.kinetic * body.height + off < body.rim:
        return True
    return (
        algebra.norm(y[solid.VELOCITY], y[solid.VELOCITY + 1]) < AT_REST
        and topple_margin(body, rows, gravity) >= 0
    )


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


@kernel
def pressure_margin(body, s):
    """Distance of the centre of pressure of a face from its nearest edge, or the rim; negative outside [m]."""
    x, y = pressure_centre(body, s)
    if body.rim > 0:
        return body.rim - algebra.norm(x, y)
    least = NO_LIMIT
    for i in range(body.count):
        p, q = body.points[i], body.points[i + 1 if i + 1 < body.count else 0]
        along, across = q[0] - p[0], q[1] - p[1]
        moment = across * (p[0] - x) - along * (p[1] - y)
        least = min(least, moment / algebra.norm(along, across))
    return least


@kernel
def pick_feet(body, y, rows, s):
    """Fill s.which with the points on which a whole face slides; return how many.

    Of a polygon they are four vertices at most, evenly taken; of a round base its four feet.
    """
    if body.rim > 0:
        return touching(body, y, rows, s)
    n = min(body.count, forces.MOST)
    for k in range(n):
        s.which[k] = k * body.count // n
    return n


@kernel
def slide_flat(body, y, rows, gravity, s):
    """Let the body slide on its whole face: write such a mode to ``s``.

    Points slide where they slip to; those that do not slip yet slide where effective gravity takes them.
    """
    level = max(algebra.norm(gravity[0], gravity[1]), algebra.TINY)
    n = pick_feet(body, y, rows, s)
    s.count, s.rests = n, 0
    for i in range(n):
        s.closed[i], s.slides[i] = s.which[i], forces.SLIDES
    for i in range(n):
        u = forces.slip_of(body, y, rows, i, s)
        s.direction[i, 0], s.direction[i, 1] = gravity[0] / level, gravity[1] / level
        s.direction[i, 0], s.direction[i, 1] = forces.slip_direction(s, i, u[0], u[1])


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
def count_touching(body, y, rows):
    """How many points of the base touch; of a round one, of the 32 points of its rim that body.points holds."""
    n = 0
    for i in range(body.count):
        n += solid.gap(body, y, rows[2], i) <= TOUCH
    return n


@kernel
def come_to_rest(body, y, s):
    """Let the body rest where it is: no velocity, flat, and the mode in ``s``."""
    s.count, s.rests = 0, 1
    solid.set_velocity(y, (0.0, 0.0, 0.0))
    solid.set_spin(y, (0.0, 0.0, 0.0))
    lay_flat(body, y)


@kernel
def lay_flat(body, y):
    """Turn the base into the ground's plane by the least rotation, and set it down; changes the state y.

    The rotation is about the horizontal axis across the tilt, by the sine of it; two more rounds take what this
    leaves of its third power.
    """
    for _ in range(3):
        up = algebra.rotation(y)[2]
        algebra.turn(y, (-up[1], up[0], 0.0))
    y[solid.HEIGHT] = body.height


@kernel
def choose_mode(body, tau, y, s):
    """Choose the mode that goes on from the state y, and write it to ``s``; return whether one was found.

    ``tau`` is the time in the interval [s]. In this order: rest, a face that slides, or the forces of the contacts
    that touch and do not leave. Where there are no such forces, points that slip by less than SLOW_SLIP are tried
    as points that stick. Velocity that the mode forbids is taken away.
    """
    rows = algebra.rotation(y)
    gravity = forces.effective_gravity_at(s.field, tau)
    if may_rest(body, y, rows, gravity, s):
        come_to_rest(body, y, s)
        return True
    was_flying = s.count == 0
    flat = lies_flat(body, y, rows) and not meets_wall(body, y, rows)
    if flat and stay_on_face(body, tau, y, rows, gravity, s):
        return True
    n, slipping = pick_closed(body, y, rows, AT_REST, s)
    found, solutions = solve_forces(body, y, rows, gravity, n, AT_REST, s)
    if found < 0:
        n, fewer = pick_closed(body, y, rows, SLOW_SLIP, s)
        if fewer < slipping:
            found, solutions = solve_forces(body, y, rows, gravity, n, SLOW_SLIP, s)
    s.counters[AMBIGUOUS] += solutions > 1
    if found < 0:
        return False
    s.jammed = 0
    write_mode(body, y, rows, n, found, s)
    hold(body, y, rows, s)
    if s.count == 0 and not was_flying:
        s.counters[FLIGHTS] += 1
    return True


@kernel
def may_rest(body, y, rows, gravity, s):
    """Whether a body hardly moves, three points touch, and the ground carries it at rest."""
    spin = body.height * algebra.length(solid.omega_of(y))
    still = algebra.length(solid.centre_velocity(y)) + spin < STILL
    stands = still and count_touching(body, y, rows) >= 3
    return stands and rest_margin(body, y, rows, gravity, s) >= 0


@kernel
def stay_on_face(body, tau, y, rows, gravity, s):
    """Let a body that lies flat slide or rest on its whole face; return whether it stays on it.

    Points that slip by less than twice AT_REST may stick, if the ground carries the body at rest. A polygon that
    neither slips nor begins to is left to the forces of its contacts.
    """
    slip = algebra.norm(y[solid.VELOCITY], y[solid.VELOCITY + 1])
    slip += body.furthest * abs(y[solid.SPIN + 2])
    stands = rest_margin(body, y, rows, gravity, s) >= 0
    slides = slip >= 2 * AT_REST or pulled_off(body, gravity) or body.rim > 0
    if not slides or not carried_flat(body, tau, y, rows, gravity, s):
        return False
    if slip < 2 * AT_REST and stands:
        come_to_rest(body, y, s)
    else:
        slide_flat(body, y, rows, gravity, s)
        s.counters[SLIDINGS] += 1
    s.jammed = 0
    return True


@kernel
def pick_closed(body, y, rows, slow, s):
    """Fill s.which with the contacts that touch and do not leave, and how each slips.

    What is slower than ``slow`` [m/s] sticks. Returned are how many contacts there are, and how many of them slip.
    """
    n = touching(body, y, rows, s)
    kept, slipping = 0, 0
    for i in range(n):
        u = solid.velocity_of(body, y, rows, s.which[i])
        u = solid.in_frame(body, s.which[i], u)
        if u[2] > LEAVES:
            continue
        s.which[kept] = s.which[i]
        slipping += note_slip(body, kept, u, slow, s)
        kept += 1
    return kept, slipping


@kernel
def note_slip(body, k, u, slow, s):
    """Note in ``s`` how contact k of a small system slips where a mode is chosen; return whether it does.

    ``u`` is its velocity, two components along it and one away [m/s]; what is slower than ``slow`` sticks. A
    contact that slips has its direction given (``given``, ``way``) and kinetic friction, one that sticks static
    friction (``holds``).
    """
    speed = algebra.norm(u[0], u[1])
    slips = speed > slow
    s.given[k], s.slid[k] = slips, 0
    if slips:
        s.way[k, 0], s.way[k, 1] = u[0] / speed, u[1] / speed
    s.friction[k] = solid.kinetic_of(body, s.which[k])
    s.holds[k] = solid.static_of(body, s.which[k])
    if solid.is_smooth(body, s.which[k]):
        let_slip(k, s)
    return slips


@kernel
def solve_forces(body, y, rows, gravity, n, slow, s):
    """Solve for the forces at the n contacts s.which; return the set that pushes, and how many would do.

    Beside walls more contacts may touch than are solved for at once. A round at a time, what would be passed
    through takes the place of the contact that is least needed, until none would be. ``slow`` is the velocity
    above which a contact slips [m/s]. s.impulse gets the forces [N/kg], s.after the accelerations [m/s²].
    """
    weight = forces.load_on(body, y, rows, gravity, s)
    moment = stick.fill_accelerations(body, y, rows, weight, n, s)
    if not picks_wall(n, s):
        return solve(body, y, rows, n, 0, moment, s)
    found, solutions = -1, 0
    for _ in range(TAKEN_IN):
        for i in range(n):
            u = (s.free[3 * i], s.free[3 * i + 1], s.free[3 * i + 2])
            u = solid.in_frame(body, s.which[i], u)
            s.free[3 * i], s.free[3 * i + 1], s.free[3 * i + 2] = u
        found, solutions = solve(body, y, rows, n, 0, moment, s)
        if found < 0:
            break
        moves = pushed_by(body, rows, n, weight, moment, s)
        i = missed(body, y, rows, n, moves, MISSED * s.field[forces.GRAVITY], True, s)
        at = least_needed(n, found, s)
        if i < 0 or at < 0:
            break
        s.which[at] = i
        u = solid.in_frame(body, i, solid.velocity_of(body, y, rows, i))
        note_slip(body, at, u, slow, s)
        stick.fill_accelerations(body, y, rows, weight, n, s)
    return found, solutions


@kernel
def pushed_by(body, rows, n, weight, moment, s):
    """Acceleration of the centre of mass [m/s²] and angular acceleration [rad/s²], in the body, under s.impulse.

    ``weight`` [N/kg] and ``moment`` [N m/kg] are, in the body, what acts beside the forces of the n contacts.
    """
    load, spin = weight, algebra.times(body.inverse, moment)
    for k in range(n):
        push = (s.impulse[3 * k], s.impulse[3 * k + 1], s.impulse[3 * k + 2])
        push = algebra.to_body(rows, solid.from_frame(body, s.which[k], push))
        p = solid.arm(body, rows[2], s.which[k])
        load = algebra.plus(load, push)
        spin = algebra.plus(spin, algebra.times(body.inverse, algebra.cross(p, push)))
    return load, spin


@kernel
def write_mode(body, y, rows, n, found, s):
    """Write the mode of a solution to ``s``: the contacts of the set ``found`` are closed, and stick or slide.

    What had a way of slip given slides there. What had none slides, the way it accelerates, where its force is at
    the limit of its cone.
    """
    count = 0
    s.rests = 0
    for i in range(n):
        if not forces.in_set(found, i):
            continue
        s.closed[count] = s.which[i]
        s.slides[count] = forces.STICKS
        u, v = s.after[3 * i], s.after[3 * i + 1]
        if s.given[i]:
            s.slides[count] = forces.SLIDES
            s.direction[count, 0], s.direction[count, 1] = s.way[i, 0], s.way[i, 1]
        else:
            shear = algebra.norm(s.impulse[3 * i], s.impulse[3 * i + 1])
            limit = s.grip[i] * s.impulse[3 * i + 2]
            size = algebra.norm(u, v)
            if size > NO_SLIP and shear > limit * AT_LIMIT:
                s.slides[count] = forces.SLIDES
                s.direction[count, 0], s.direction[count, 1] = u / size, v / size
                s.counters[SLIDINGS] += 1
        count += 1
    s.count = count
    anchor_all(body, y, s)


@kernel
def insist(body, what, s):
    """Change one contact of a mode that was chosen again and again though it ends at once.

    ``what`` is what ends it. If it OPENS, the contact with the least normal force opens; else the one furthest out
    of its cone slides, against its shear.
    """
    worst, value = 0, NO_LIMIT
    for i in range(s.count):
        shear = algebra.norm(s.lam[i, 0], s.lam[i, 1])
        grip = solid.static_of(body, s.closed[i])
        here = s.lam[i, 2] if what == OPENS else grip * s.lam[i, 2] - shear
        if here < value and (what == OPENS or s.slides[i] == forces.STICKS):
            worst, value = i, here
    if what == OPENS:
        for i in range(worst, s.count - 1):
            s.closed[i], s.slides[i] = s.closed[i + 1], s.slides[i + 1]
            for k in range(2):
                s.direction[i, k], s.anchor[i, k] = (
                    s.direction[i + 1, k],
                    s.anchor[i + 1, k],
                )
        s.count -= 1
    else:
        shear = algebra.norm(s.lam[worst, 0], s.lam[worst, 1])
        s.slides[worst] = forces.SLIDES
        for k in range(2):
            s.direction[worst, k] = -s.lam[worst, k] / shear


@kernel
def jam(body, y, s):
    """Let all that is closed stick without a look at the cones (Painlevé), until one opens or one lands.

    Contacts without friction go on to slide. What sticks does no work, so no energy comes in.
    """
    for i in range(s.count):
        if not solid.is_smooth(body, s.closed[i]):
            s.slides[i] = forces.STICKS
    s.jammed = 1
    anchor_all(body, y, s)
    hold(body, y, algebra.rotation(y), s)


@kernel
def anchor_all(body, y, s):
    """Note in s.anchor where the closed points are in the plan, (x, y) [m]: what sticks is put back there."""
    rows = algebra.rotation(y)
    for k in range(s.count):
        p = solid.position_of_base(y, rows, solid.arm(body, rows[2], s.closed[k]))
        s.anchor[k, 0], s.anchor[k, 1] = p[0], p[1]


@kernel
def settle(body, y, s):
    """Put the state y back on the conditions of its mode, from which steps drift by their error.

    Of a pivot or a hinge place and velocity follow from the attitude and the spin; what else is closed is moved to
    the ground and stopped by what is least in kinetic energy.
    """
    rows = algebra.rotation(y)
    kind = forces.kind_of(s)
    if kind in (forces.PIVOT, forces.HINGE):
        i = s.closed[0]
        p = solid.arm(body, rows[2], i)
        omega = solid.omega_of(y)
        if kind == forces.HINGE:
            q = solid.arm(body, rows[2], s.closed[1])
            e = algebra.minus(q, p)
            omega = algebra.scaled(algebra.dot(e, omega) / algebra.dot(e, e), e)
            solid.set_spin(y, omega)
        moved = algebra.to_world(rows, p)
        y[solid.HEIGHT] = -moved[2]
        if i != solid.rim_contact(body):
            x, z = s.anchor[0, 0] - moved[0], s.anchor[0, 1] - moved[1]
            solid.set_place(y, x, z)
        solid.set_velocity(y, algebra.to_world(rows, algebra.cross(p, omega)))
    elif kind in (forces.GENERAL, forces.SLIDER):
        close_gaps(body, y, rows, s)
        hold(body, y, algebra.rotation(y), s)


@kernel
def close_gaps(body, y, rows, s):
    """Move the body so that its closed points are on the ground, by what is least in its kinetic energy.

    Of two points each is lifted as a vertical impulse there would: two equations W_nn P = -gap with the
    compliances of both (``docs/space.md``, equation 10). A face is laid flat.
    """
    n = s.count
    if forces.at_wall(s):
        close_gaps_at_wall(body, y, s)
        return
    if n >= 3:
        lay_flat(body, y)
        return
    forces.fill_delassus(body, rows, s.closed, n, s.delassus)
    first = solid.gap(body, y, rows[2], s.closed[0])
    if n == 1:
        y[solid.HEIGHT] -= first
        return
    second = solid.gap(body, y, rows[2], s.closed[1])
    # vertical displacement at each by a vertical impulse at each: row 3 k + 2 is the vertical at point k
    own, mixed, other = s.delassus[2, 2], s.delassus[2, 5], s.delassus[5, 5]
    determinant = own * other - mixed * mixed
    lift_first = -(other * first - mixed * second) / determinant
    lift_second = -(own * second - mixed * first) / determinant
    lift_at(body, y, rows, s.closed[0], lift_first)
    lift_at(body, y, rows, s.closed[1], lift_second)


@kernel
def close_gaps_at_wall(body, y, s):
    """Move the body by what its closed points are off the ground and the walls, as impulses P there would.

    Four contacts of an upright body may say one thing twice, and contradict each other by the errors of steps. So
    the gaps are closed as by soft contacts, (W_nn + soft) P = -gap, W_nn the rows and columns 3 k + 2 of the
    Delassus matrix, which do not move the body far for that; and what this leaves of the gaps twice more.
    """
    n = s.count
    for _ in range(CLOSINGS):
        rows = algebra.rotation(y)
        forces.fill_delassus(body, rows, s.closed, n, s.delassus)
        soft = GAP_SOFTNESS * forces.largest_compliance(s, n)
        for i in range(n):
            for j in range(n):
                s.matrix[i, j] = s.delassus[3 * i + 2, 3 * j + 2]
            s.matrix[i, i] += soft
            s.vector[i] = -solid.gap_of(body, y, rows, s.closed[i])
        if not algebra.factor(s.matrix, s.order, n):
            return
        algebra.substitute(s.matrix, s.order, n, s.vector)
        for i in range(n):
            shift_at(body, y, rows, s.closed[i], s.vector[i])


@kernel
def shift_at(body, y, rows, i, size):
    """Displace the body as a small impulse at contact i, away from its surface, would in a unit of time.

    ``size`` is that of the impulse for a unit of mass, in a unit of time a length [m].
    """
    p = solid.arm(body, rows[2], i)
    push = algebra.scaled(size, forces.push_along(body, rows, i, 2))
    moved = algebra.to_world(rows, push)
    for k in range(3):
        y[k] += moved[k]
    algebra.turn(y, algebra.times(body.inverse, algebra.cross(p, push)))


@kernel
def lift_at(body, y, rows, i, size):
    """Displace the body as a small vertical impulse at point i of the base would: see :func:`shift_at`."""
    p = solid.arm(body, rows[2], i)
    y[solid.HEIGHT] += size
    algebra.turn(
        y, algebra.scaled(size, algebra.times(body.inverse, algebra.cross(p, rows[2])))
    )
