"""Impacts, and which mode follows: both from the one problem of contacts with Coulomb's cone.

In: a state at an event and the points that touch. Out: the velocities after an impact [m/s, rad/s], and which
points stick, slide or part. Theory: ``docs/space.md``, "Friction and impacts", equation 5.
"""

import math

from rockfrag.base.elementary import atan2
from rockfrag.engines.compile.jit import kernel
from rockfrag.engines.spatial import _algebra as algebra
from rockfrag.engines.spatial import _body as solid
from rockfrag.engines.spatial import _forces as forces
from rockfrag.engines.spatial import _stick as stick
from rockfrag.engines.spatial._cone import solve_cones

TOUCH = 1e-10  # gap below which a point touches [m]
CLOSE = 1e-6  # velocity after an impact below which a point stays closed at first [m/s]
# the velocity that points slip above when the mode is chosen [m/s]
AT_REST = forces.SLIP_FLOOR
# the same where no mode was found otherwise: one may hardly slip [m/s]
SLOW_SLIP = 30 * AT_REST
# velocity above which points that touch leave when the mode is chosen [m/s]
LEAVES = 1e-8
# hops of one end of an edge beside the other: speed above which they are followed [m/s]; part by which each is
# slower than the one before, at least [-]; and what closing them may change of the body's angular velocity [rad/s]
FASTEST_HOP, SLOWING, CHATTER = 1e-2, 0.05, 1e-6
# impulse beyond friction, for a unit of mass, that points which slip or leave slowly are stopped by unseen [m/s]
BEYOND = 1e-3
# contacts beyond the first four, beside a wall, that are taken in at most, one at a time; velocity [m/s] or, over
# gravity, acceleration [-] at which they approach
TAKEN_IN, MISSED = 8, 1e-9
# compliance of contacts, over the largest of a body, by which gaps at walls are closed [-], and how many times
GAP_SOFTNESS, CLOSINGS = 1e-3, 3
LANDS, OPENS, LEAVES_CONE, SLIP_ENDS, TIE_TURNS, TIE_BREAKS = 1, 2, 3, 4, 5, 6
NOTHING = 0

COUNTERS = 6
IMPACTS, AMBIGUOUS, UNSOLVED, SLIDINGS, FLIGHTS, JAMS = range(COUNTERS)


@kernel
def touching(body, y, rows, s):
    """Fill in s.which with the points that touch, at most MOST, the fastest to approach; return their number."""
    n = 0
    if body.rim > 0 and algebra.norm(rows[2][0], rows[2][1]) < 1e-9:
        return stand_on_feet(body, y, rows, s)
    for i in solid.candidates(body):
        if solid.gap(body, y, rows[2], i) > TOUCH:
            continue
        n = keep_fastest(i, solid.velocity_of(body, y, rows, i)[2], n, s)
    for i in solid.wall_candidates(body):
        n = add_wall_contact(body, y, rows, i, n, s)
    return n


@kernel
def add_wall_contact(body, y, rows, i, n, s):
    """Add a contact of a wall to those that touch, if it does; return how many there are."""
    if not solid.may_meet(body, i) or solid.gap_of(body, y, rows, i) > TOUCH:
        return n
    return keep_fastest(i, solid.approach_of(body, y, rows, i), n, s)


@kernel
def keep_fastest(i, velocity, n, s):
    """Add contact i to the n of s.which, in the place of the slowest to approach if all are taken; return n."""
    speed = s.vector
    if n < forces.MOST:
        s.which[n], speed[n] = i, velocity
        return n + 1
    last = 0
    for k in range(1, forces.MOST):
        if speed[k] > speed[last]:
            last = k
    if velocity < speed[last] - 1e-14:
        s.which[last], speed[last] = i, velocity
    return n


@kernel
def picks_wall(n, s):
    """Whether one of the contacts s.which is of a wall."""
    found = False
    for k in range(n):
        found = found or s.which[k] >= solid.WALLS
    return found


@kernel
def stand_on_feet(body, y, rows, s):
    """Fill in s.which with four points of a flat rim, the first where the body would tip; return their number."""
    p = (body.centre[0], body.centre[1], -body.height)
    u = solid.point_velocity(y, rows, p)
    if algebra.norm(u[0], u[1]) < AT_REST:
        u = (s.field[0], s.field[1], 0.0)
    front = algebra.to_body(rows, (u[0], u[1], 0.0))
    each = body.count // forces.MOST
    part = atan2(front[1], front[0]) / (2 * math.pi)
    first = math.floor(part * body.count + 0.5) % body.count
    n = 0
    for k in range(forces.MOST):
        i = (first + k * each) % body.count
        if solid.gap(body, y, rows[2], i) <= TOUCH:
            s.which[n] = i
            n += 1
    return n


@kernel
def fill_edges(body, y, rows, which, n, s):
    """Fill in the directions between contacts in the plan."""
    for i in range(n):
        p = solid.position_of_base(y, rows, solid.arm(body, rows[2], which[i]))
        for j in range(n):
            if which[i] >= solid.WALLS or which[j] >= solid.WALLS:
                along_wall(body, y, rows, which, i, j, s)
                continue
            q = solid.position_of_base(y, rows, solid.arm(body, rows[2], which[j]))
            length = max(algebra.norm(q[0] - p[0], q[1] - p[1]), 1e-300)
            s.edge[i, j, 0] = (q[0] - p[0]) / length
            s.edge[i, j, 1] = (q[1] - p[1]) / length


@kernel
def along_wall(body, y, rows, which, i, j, s):
    """Fill in the direction between two contacts of one wall along it; of others, which share nothing, none."""
    s.edge[i, j, 0] = s.edge[i, j, 1] = 0.0
    first, second = which[i], which[j]
    walls = first >= solid.WALLS and second >= solid.WALLS
    if not walls or solid.wall_of(first) != solid.wall_of(second):
        return
    p, q = solid.arm(body, rows[2], first), solid.arm(body, rows[2], second)
    way = solid.in_frame(body, first, algebra.to_world(rows, algebra.minus(q, p)))
    length = max(algebra.norm(way[0], way[1]), 1e-300)
    s.edge[i, j, 0], s.edge[i, j, 1] = way[0] / length, way[1] / length


@kernel
def kind_of_mode(s):
    """PIVOT or HINGE of a mode in which nothing is closed but one point or two that stick, or else GENERAL."""
    kind = forces.kind_of(s)
    return kind if kind in (forces.PIVOT, forces.HINGE) else forces.GENERAL


@kernel
def hold_still(body, y, rows, kind, s):
    """Take away what velocity is left at a point or an edge that sticks."""
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
    """Take away what velocity is left against the conditions of a mode, by the least kinetic energy."""
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
    """Solve an impact of all points that touch, and hold those that hardly leave."""
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
    """Solve an impact at walls, and what it asks of the ground, with the ratios of the walls.

    Newton's ratio and friction together may gain energy; then all ratios are halved until they do not.
    """
    came = (solid.centre_velocity(y), solid.omega_of(y))
    before = solid.energy(body, y, s.field[6])
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
    """Solve an impact at walls from the velocities that came, with the largest part of the ratios without gain."""
    part, found, solutions = 1.0, -1, 0
    for _ in range(40):
        solid.set_velocity(y, came[0])
        solid.set_spin(y, came[1])
        found, solutions = bounce(body, y, rows, n, least, part, s)
        if found < 0:
            break
        gained = solid.energy(body, y, s.field[6]) - before
        if gained <= 1e-12 * (before + s.field[6] * body.height):
            break
        part *= 0.5
    return found, solutions


@kernel
def missed(body, y, rows, n, moves, small, pushed, s):
    """Contact that touches, is none of s.which and approaches fastest; -1 if none approaches.

    ``moves`` holds the velocity of the centre of mass and the angular velocity, in the body; or, where the body is
    ``pushed``, accelerations, and what leaves already is left out.
    """
    load, spin = moves
    worst, fastest = -1, -small
    for k in range(solid.meetings(body)):
        i = solid.meeting(body, k)
        u = approaches(body, y, rows, n, i, load, spin, pushed, s)
        if u < fastest:
            worst, fastest = i, u
    return worst


@kernel
def approaches(body, y, rows, n, i, load, spin, pushed, s):
    """Velocity (or acceleration) away of contact i, if it touches and is none of s.which; else 0."""
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
def least_needed(n, found, s):
    """The contact that another one may take the place of: it does not push, and parts fastest.

    In: the set ``found`` that pushes, as bits, and s.after, the velocities along both ways and across, three a
    contact. Out: the place in s.which, -1 if all push.
    """
    best = -1
    for k in range(n):
        apart = s.after[3 * k + 2]
        if not forces.in_set(found, k) and (best < 0 or apart > s.after[3 * best + 2]):
            best = k
    return best


@kernel
def bounce(body, y, rows, n, least, part, s):
    """Push with the impulses at the contacts s.which that part of the walls' ratios ask for; return the set."""
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
    """Count hits at walls, and keep their largest impulse."""
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
    """Note, and count, what the whole change of momentum asks of friction beyond what it can give.

    ``before`` is the velocity of the centre of mass before the impact; its change is the impulse of all contacts
    for a unit of mass [m/s], of which static friction bears so much of the normal part.
    """
    x, z, up = solid.VELOCITY, solid.VELOCITY + 1, solid.VELOCITY + 2
    shear = algebra.norm(y[x] - before[0], y[z] - before[1])
    beyond = shear - body.static * (y[up] - before[2])
    s.beyond = max(s.beyond, beyond)
    s.counters[UNSOLVED] += beyond > BEYOND


@kernel
def solve(body, y, rows, n, least, moment, s):
    """Find the impulses (or forces) at the contacts s.which; return the set that pushes, and how many would do."""
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
    """Note which contacts slip before an impact, and where to, and the coefficients of friction in it."""
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
    """Let contact i of a small system slip: without friction its direction is of no effect.

    Its way of slip is given, and it counts as one that did not slip before, as there is no grip for it to regain.
    """
    s.given[i], s.slid[i] = 1, 0
    s.way[i, 0], s.way[i, 1] = 1.0, 0.0


@kernel
def chatters(body, y, rows, gravity, i, k, leaving, s):
    """Whether contact k hops, with a speed, beside contact i on which the body pivots, so little that both close.

    Impacts at either end conserve the momentum about the edge between them, with which it goes on when hops are
    over.  What is left out is of the third order: the tilt of the edge in a hop, u² / (2 a L), turns gravity's
    moment, over h, for the time of all hops, 2 u / (a (1 - r)).
    """
    if leaving > FASTEST_HOP:
        return False
    up, omega = rows[2], solid.omega_of(y)
    weight = forces.load_on(body, y, rows, gravity, s)
    here, there = s.which[i], s.which[k]
    p, turned = solid.arm_and_bias(body, up, omega, here)
    alpha, force = forces.pivot_acceleration(body, p, turned, omega, weight, here, s)
    q = solid.arm(body, up, there)
    free = algebra.plus(weight, solid.bias(body, up, omega, q, there))
    free = algebra.plus(free, algebra.plus(force, algebra.cross(alpha, q)))
    falls = -algebra.dot(up, free)
    if falls <= 0.0:
        return False
    edge = algebra.minus(q, p)
    length = math.sqrt(algebra.dot(edge, edge))
    left_out = leaving**3 * s.field[6] / (SLOWING * falls**2 * length * body.height)
    return left_out < CHATTER


@kernel
def hopping(body, y, rows, gravity, n, found, s):
    """Contact that chatters beside the only one that pushed, and stuck; -1 if there is none."""
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
    """Close, together with those that pushed, the contacts that leave more slowly than CLOSE, or chatter."""
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
    """Margin by which a bond holds [N/kg], against tension at a pad and against shear (``docs/holding.md``)."""
    weight = -gravity[2]
    shear = body.shear + body.static * weight - algebra.norm(gravity[0], gravity[1])
    return min(2.0 * (0.5 * body.tension - bond_tension(body, rows, gravity)), shear)


@kernel
def bond_tension(body, rows, gravity):
    """Force by which one side of a bond is pulled, for a unit of mass; negative where it is pressed."""
    flat = algebra.to_body(rows, (gravity[0], gravity[1], 0.0))
    whole = gravity[2]
    for k in range(2):
        moment = body.height * flat[k] - gravity[2] * body.aside[k]
        whole += abs(moment) / body.pads[k]
    return 0.5 * whole


@kernel
def pulled_by_ties(body, y, rows, s):
    """Whether ties pull at a body as it stands with more than rounding; their force stays in s.pulled [N/kg]."""
    forces.fill_tie_forces(body, y, rows, s)
    pulled = abs(s.pulled[0]) + abs(s.pulled[1]) + abs(s.pulled[2])
    gravity = s.field[6]
    return pulled > 1e-9 * gravity


@kernel
def rest_margin(body, y, rows, gravity, s):
    """Least margin of acceleration by which the body rests: over the edges of its base, and of friction."""
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
    """Margin of rest against tipping over an edge; none is needed where a wall stands against it."""
    if body.walls and backed_by_wall(body, y, rows, i, j):
        return 1e300
    return edge_margin(body, y, rows, gravity, i, j)


@kernel
def backed_by_wall(body, y, rows, i, j):
    """Whether a wall touches a body all along its side over the edge from point i to j."""
    p, q = solid.arm(body, rows[2], i), solid.arm(body, rows[2], j)
    edge = algebra.to_world(rows, algebra.minus(q, p))
    length = algebra.norm(edge[0], edge[1])
    outward = (edge[1] / length, -edge[0] / length)
    for w in range(body.constraints):
        along = outward[0] * body.away[w, 0] + outward[1] * body.away[w, 1]
        if not body.ties[w] and along <= -1.0 + 1e-9 and lies_against(body, y, rows, w):
            return True
    return False


@kernel
def lies_against(body, y, rows, w):
    """Whether a body that stands touches wall w with a side, at two of its upper corners."""
    touch = 0
    for k in range(body.corners):
        at = solid.WALLS + w * solid.MOST_CORNERS + k
        high = body.corner[k, 2] > 0.0
        touch += high and solid.gap_of(body, y, rows, at) <= TOUCH
    return touch >= 2


@kernel
def borne_by_ground(body, y, rows, gravity):
    """Part of the effective gravity that the ground has to bear under a body at rest beside walls.

    What presses a side against a wall the wall can bear, at the height of the centre of mass.
    """
    for w in range(body.constraints):
        a, b = body.away[w, 0], body.away[w, 1]
        into = -(a * gravity[0] + b * gravity[1])
        if not body.ties[w] and into > 0.0 and lies_against(body, y, rows, w):
            gravity = (gravity[0] + into * a, gravity[1] + into * b, gravity[2])
    return gravity


@kernel
def pulled_off(body, gravity):
    """Whether static friction of the whole base cannot hold it."""
    return algebra.norm(gravity[0], gravity[1]) > -body.static * gravity[2]


@kernel
def topple_margin(body, rows, gravity):
    """Margin by which the ground carries a round body that is flat, whatever it slides."""
    centre = algebra.to_world(rows, (body.centre[0], body.centre[1], 0.0))
    x = body.height * gravity[0] + gravity[2] * centre[0]
    y = body.height * gravity[1] + gravity[2] * centre[1]
    return (-body.rim * gravity[2] - algebra.norm(x, y)) / body.height


@kernel
def lies_flat(body, y, rows):
    """Whether a body lies flat and does not tilt."""
    if algebra.norm(rows[2][0], rows[2][1]) > 1e-9 or abs(y[solid.RISES]) > LEAVES:
        return False
    turns = algebra.norm(y[solid.SPIN], y[solid.SPIN + 1]) > LEAVES / body.furthest
    return not turns and abs(y[solid.UP] - body.height) < TOUCH


@kernel
def meets_wall(body, y, rows):
    """Whether a corner touches a wall."""
    found = False
    for i in solid.wall_candidates(body):
        if not found and solid.may_meet(body, i):
            found = solid.gap_of(body, y, rows, i) <= TOUCH
    return found


@kernel
def carried_flat(body, tau, y, rows, gravity, s):
    """Whether a body that lies flat, and slides or is about to, stays on its face; a polygon slides on it then."""
    if body.rim == 0.0:
        slide_flat(body, y, rows, gravity, s)
        forces.rates(body, tau, y, s.slopes[0], s)
        return pressure_margin(body, s) > 1e-9 * body.furthest
    off = algebra.norm(body.centre[0], body.centre[1])
    if body.kinetic * body.height + off < body.rim:
        return True
    return (
        algebra.norm(y[solid.VELOCITY], y[solid.VELOCITY + 1]) < AT_REST
        and topple_margin(body, rows, gravity) >= 0
    )


@kernel
def pressure_centre(body, s):
    """Where the normal forces of closed points act together, in the body [m].

    Seen from the centre of a round base, of a polygon from below the centre of mass.
    """
    x, y, whole = 0.0, 0.0, 1e-300
    for i in range(s.count):
        x += s.lam[i, 2] * (body.points[s.closed[i], 0] - body.centre[0])
        y += s.lam[i, 2] * (body.points[s.closed[i], 1] - body.centre[1])
        whole += s.lam[i, 2]
    return x / whole, y / whole


@kernel
def pressure_margin(body, s):
    """Distance of the centre of pressure of a face from its edge, negative outside [m]."""
    x, y = pressure_centre(body, s)
    if body.rim > 0:
        return body.rim - algebra.norm(x, y)
    least = 1e300
    for i in range(body.count):
        p, q = body.points[i], body.points[i + 1 if i + 1 < body.count else 0]
        along, across = q[0] - p[0], q[1] - p[1]
        moment = across * (p[0] - x) - along * (p[1] - y)
        least = min(least, moment / algebra.norm(along, across))
    return least


@kernel
def pick_feet(body, y, rows, s):
    """Fill in s.which with the points on which a face slides; return their number."""
    if body.rim > 0:
        return touching(body, y, rows, s)
    n = min(body.count, forces.MOST)
    for k in range(n):
        s.which[k] = k * body.count // n
    return n


@kernel
def slide_flat(body, y, rows, gravity, s):
    """Let a body slide on points of its face, those that do not slip yet the way it is pulled."""
    level = max(algebra.norm(gravity[0], gravity[1]), 1e-300)
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

    It is the moment about the edge of the effective gravity, over the mass and the height of the centre of mass,
    positive while it holds the body down.
    """
    p = solid.position_of_base(y, rows, solid.arm(body, rows[2], i))
    q = solid.position_of_base(y, rows, solid.arm(body, rows[2], j))
    length = algebra.norm(q[0] - p[0], q[1] - p[1])
    # outwards in the plan; how far the edge lies out there, and what acts that way
    normal = ((q[1] - p[1]) / length, -(q[0] - p[0]) / length)
    x, z, height = y[solid.PLACE], y[solid.PLACE + 1], y[solid.UP]
    reach = normal[0] * (p[0] - x) + normal[1] * (p[1] - z)
    outward = normal[0] * gravity[0] + normal[1] * gravity[1]
    return -(height * outward + reach * gravity[2]) / height


@kernel
def count_touching(body, y, rows):
    """Number of vertices of the base that touch, or of the points of a rim that stand for it."""
    n = 0
    for i in range(body.count):
        n += solid.gap(body, y, rows[2], i) <= TOUCH
    return n


@kernel
def come_to_rest(body, y, s):
    """Make the body rest where it is."""
    s.count, s.rests = 0, 1
    solid.set_velocity(y, (0.0, 0.0, 0.0))
    solid.set_spin(y, (0.0, 0.0, 0.0))
    lay_flat(body, y)


@kernel
def lay_flat(body, y):
    """Turn the base into the ground's plane by the least rotation, and set it down."""
    for _ in range(3):
        up = algebra.rotation(y)[2]
        algebra.turn(y, (-up[1], up[0], 0.0))
    y[solid.UP] = body.height


@kernel
def choose_mode(body, tau, y, s):
    """Choose the mode that follows for the points that touch and do not leave; return whether one was found."""
    rows = algebra.rotation(y)
    gravity = forces.effective_gravity_at(s.field, tau)
    spin = body.height * algebra.length(solid.omega_of(y))
    still = algebra.length(solid.centre_velocity(y)) + spin < 10 * CLOSE
    if (
        still
        and count_touching(body, y, rows) >= 3
        and rest_margin(body, y, rows, gravity, s) >= 0
    ):
        come_to_rest(body, y, s)
        return True
    was_flying = s.count == 0
    if lies_flat(body, y, rows) and not meets_wall(body, y, rows):
        slip = algebra.norm(y[solid.VELOCITY], y[solid.VELOCITY + 1])
        slip += body.furthest * abs(y[solid.SPIN + 2])
        stands = rest_margin(body, y, rows, gravity, s) >= 0
        slides = slip >= 2 * AT_REST or pulled_off(body, gravity) or body.rim > 0
        if slides and carried_flat(body, tau, y, rows, gravity, s):
            if slip < 2 * AT_REST and stands:
                come_to_rest(body, y, s)
            else:
                slide_flat(body, y, rows, gravity, s)
                s.counters[SLIDINGS] += 1
            s.jammed = 0
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
def pick_closed(body, y, rows, slow, s):
    """Fill s.which with points that touch and do not leave, and how each slips; count both."""
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

    ``u`` is its velocity, along it and across it [m/s]; what is slower than ``slow`` sticks.  A contact that slips
    has its direction given (``given``, ``way``) and kinetic friction, one that sticks static friction (``holds``).
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
    """Solve for the forces at the contacts s.which; return the set that pushes, and how many would do.

    Beside walls more contacts may touch than are solved for at once. A round at a time, what would be passed
    through takes the place of the contact that is least needed, until none would be. ``n`` is the number of
    contacts, and ``slow`` the velocity above which they slip [m/s].
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
        i = missed(body, y, rows, n, moves, MISSED * s.field[6], True, s)
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
    """Acceleration and angular acceleration, in the body, under the forces that were found."""
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
    """Read the mode off a solution: closed or open, sticks or slides and where to."""
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
            if size > 1e-12 and shear > limit * (1 - 1e-9):
                s.slides[count] = forces.SLIDES
                s.direction[count, 0], s.direction[count, 1] = u / size, v / size
                s.counters[SLIDINGS] += 1
        count += 1
    s.count = count
    anchor_all(body, y, s)


@kernel
def insist(body, what, s):
    """Open the contact that pulls most, or slide the one furthest out of its cone, where a mode comes again."""
    worst, value = 0, 1e300
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
    """Let all that is closed stick without a look at the cones (Painlevé), until one opens or one lands."""
    for i in range(s.count):
        if not solid.is_smooth(body, s.closed[i]):
            s.slides[i] = forces.STICKS
    s.jammed = 1
    anchor_all(body, y, s)
    hold(body, y, algebra.rotation(y), s)


@kernel
def anchor_all(body, y, s):
    """Note where the closed points are in the plan."""
    rows = algebra.rotation(y)
    for k in range(s.count):
        p = solid.position_of_base(y, rows, solid.arm(body, rows[2], s.closed[k]))
        s.anchor[k, 0], s.anchor[k, 1] = p[0], p[1]


@kernel
def settle(body, y, s):
    """Put a state back on the conditions of its mode, from which steps drift by their error."""
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
        y[solid.UP] = -moved[2]
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

    Of two points each is lifted as a vertical impulse there would: two equations with the compliances of both.
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
        y[solid.UP] -= first
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
    """Move the body by what its closed points are off the ground and the walls.

    Each contact k displaces the body as an impulse P_k away from its surface would. Of the compliances W between
    these, rows 3 k + 2 of the Delassus matrix, follows W P = -gaps. Four contacts of an upright body may say one
    thing twice, and contradict each other by the errors of steps, so contacts are soft, (W + soft) P = -gaps,
    which does not move the body far for that. What this leaves of the gaps is closed in the same way, CLOSINGS
    times.
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
    """Displace the body as a small impulse would that the ground or the wall gives to contact i."""
    p = solid.arm(body, rows[2], i)
    push = algebra.scaled(size, forces.push_along(body, rows, i, 2))
    moved = algebra.to_world(rows, push)
    for k in range(3):
        y[k] += moved[k]
    algebra.turn(y, algebra.times(body.inverse, algebra.cross(p, push)))


@kernel
def lift_at(body, y, rows, i, size):
    """Displace the body as a small vertical impulse at point i would."""
    p = solid.arm(body, rows[2], i)
    y[solid.UP] += size
    algebra.turn(
        y, algebra.scaled(size, algebra.times(body.inverse, algebra.cross(p, rows[2])))
    )
