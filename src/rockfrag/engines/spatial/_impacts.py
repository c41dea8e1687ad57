"""Impacts: velocities that jump where points come down or meet a wall.

In: a state at a contact event and the points that touch. Out: the velocities after the impact [m/s, rad/s], and
which contacts stay closed. Theory: ``docs/space.md``, "Friction and impacts" and "Derivations", equations 5 and 9
to 21.

Names (``_body`` explains the state and the numbers of contacts):

- ``body``, ``s``: records ``BODY`` and ``CASE``; ``y``: the state, shape (15,)
- ``rows``: the world's axes as the body sees them, ``rows[2]`` the upward one
- ``gravity``: effective gravity, equation 1, in the world [m/s²]
- ``found``: the contacts of a small system that push, as bits: bit k for ``s.which[k]``; -1 without a solution
"""

from rockfrag.engines.algebra import vectors as algebra
from rockfrag.engines.compile.jit import kernel
from rockfrag.engines.spatial import _body as solid
from rockfrag.engines.spatial import _case as case
from rockfrag.engines.spatial import _contacts as contacts
from rockfrag.engines.spatial import _delassus as delassus
from rockfrag.engines.spatial import _hops as hops
from rockfrag.engines.spatial import _limits as limits
from rockfrag.engines.spatial import _points as points
from rockfrag.engines.spatial import _problem as problem
from rockfrag.engines.spatial import _stick as stick
from rockfrag.engines.spatial._cone import solve_cones

# impulse beyond friction, for a unit of mass, that points which slip or leave slowly are stopped by unseen [m/s]
BEYOND = 1e-3
# how often the ratios of walls are halved at most, and the energy that an impact may gain by rounding, over that
# which there is [-]
RATIO_HALVINGS, ROUNDING = 40, 1e-12


@kernel
def impact(body, y, gravity, least, s):
    """Change the state y by an impact of all points that touch, and write the mode after it to ``s``.

    ``least`` is how many contacts push at least: 0 of a landing; 1 of an impact without a collision, which stands
    in for contact forces that do not exist (Painlevé). The mode keeps the contacts that pushed, and those that
    leave slowly.
    """
    rows = algebra.rotation(y)
    before = solid.centre_velocity(y)
    n = points.touching(body, y, rows, s)
    momentum = stick.fill_velocities(body, y, rows, n, s)
    if case.picks_wall(n, s):
        impact_at_wall(body, y, rows, gravity, n, least, s)
        return
    problem.note_slips(body, n, s)
    found, solutions = problem.solve(body, y, rows, n, least, momentum, s)
    if not is_solved(body, y, rows, n, found, solutions, s):
        return
    for i in range(n):
        push = (s.impulse[3 * i], s.impulse[3 * i + 1], s.impulse[3 * i + 2])
        delassus.push_at(body, y, rows, s.which[i], push)
    pushed = (solid.centre_velocity(y), solid.omega_of(y))
    # what chatters is closed, but followed where it would slip
    for closes in (True, False):
        solid.set_velocity(y, pushed[0])
        solid.set_spin(y, pushed[1])
        hops.keep_slow_contacts(body, y, rows, gravity, n, found, closes, s)
        if not beyond_friction(body, y, before) > BEYOND:
            break
    witness(body, y, before, s)


@kernel
def impact_at_wall(body, y, rows, gravity, n, least, s):
    """Change the state y by an impact at walls and at the ground; arguments are those of :func:`impact`.

    ``n`` contacts are in s.which. More may touch than these: a round at a time, the one that would be passed
    through fastest takes the place of the one that is least needed.
    """
    came = (solid.centre_velocity(y), solid.omega_of(y))
    before = solid.energy(body, y, s.field[case.GRAVITY])
    found, solutions = -1, 0
    for _ in range(problem.TAKEN_IN):
        found, solutions = bounce_without_gain(body, y, rows, n, least, came, before, s)
        if found < 0:
            break
        load = algebra.to_body(rows, solid.centre_velocity(y))
        i = problem.missed(
            body, y, rows, n, (load, solid.omega_of(y)), problem.MISSED, False, s
        )
        at = problem.least_needed(n, found, s)
        if i < 0 or at < 0:
            break
        s.which[at] = i
    if not is_solved(body, y, rows, n, found, solutions, s):
        return
    note_impulses(body, n, found, s)
    hops.keep_slow_contacts(body, y, rows, gravity, n, found, False, s)


@kernel
def is_solved(body, y, rows, n, found, solutions, s):
    """Count an impact of the n contacts s.which, and how many ``solutions`` it has; whether it has any.

    As a last resort no point that touches approaches or, but at a smooth wall, slips any more.
    """
    s.counters[limits.IMPACTS] += 1
    s.counters[limits.AMBIGUOUS] += solutions > 1
    s.jammed = 0
    if found >= 0:
        return True
    s.counters[limits.UNSOLVED] += 1
    for i in range(n):
        smooth = solid.is_smooth(body, s.which[i])
        s.slides[i] = case.SLIDES if smooth else case.STICKS
        s.closed[i] = s.which[i]
    s.count, s.rests = n, 0
    contacts.hold(body, y, rows, s)
    return False


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
        gained = solid.energy(body, y, s.field[case.GRAVITY]) - before
        if gained <= ROUNDING * (before + s.field[case.GRAVITY] * body.height):
            break
        part *= 0.5
    return found, solutions


@kernel
def bounce(body, y, rows, n, least, part, s):
    """Push the state y at the contacts s.which by the ratios of walls; return the set, and how many would do.

    A wall with the ratio e asks for u_n⁺ ≥ -e u_n⁻: e u_n⁻ is added to the velocity that is stopped. ``part`` is
    what all ratios are multiplied by. s.after gets the velocities as they are after the impact.
    """
    delassus.fill_velocities(body, y, rows, s.which, n, s.free)
    problem.note_slips(body, n, s)
    for i in range(n):
        if s.which[i] >= solid.WALLS:
            ratio = part * body.ratio[solid.wall_of(s.which[i])]
            s.free[3 * i + 2] += ratio * min(s.free[3 * i + 2], 0.0)
    delassus.fill_delassus(body, rows, s.which, n, s.delassus)
    problem.fill_edges(body, y, rows, s.which, n, s)
    found, solutions = solve_cones(s, n, least)
    for i in range(n if found >= 0 else 0):
        push = (s.impulse[3 * i], s.impulse[3 * i + 1], s.impulse[3 * i + 2])
        delassus.push_at(body, y, rows, s.which[i], push)
    if found >= 0:
        # how contacts really part: those of a wall by its ratio too
        delassus.fill_velocities(body, y, rows, s.which, n, s.after)
    return found, solutions


@kernel
def note_impulses(body, n, found, s):
    """Count the hits at each wall by the contacts of the set ``found``, and keep the largest impulse [m/s]."""
    for w in range(body.constraints):
        whole = 0.0
        for i in range(n):
            at_this = s.which[i] >= solid.WALLS and solid.wall_of(s.which[i]) == w
            if at_this and case.in_set(found, i):
                whole += s.impulse[3 * i + 2]
        if whole > 0.0:
            s.hits[w] += 1.0
            s.impact[w] = max(s.impact[w], whole)


@kernel
def witness(body, y, before, s):
    """Note, and count, the momentum that an impact would need beyond what friction can give [m/s].

    ``before`` is the velocity of the centre of mass before. The largest excess stays in s.beyond, and one above
    BEYOND counts as a problem without a solution.
    """
    beyond = beyond_friction(body, y, before)
    s.beyond = max(s.beyond, beyond)
    s.counters[limits.UNSOLVED] += beyond > BEYOND


@kernel
def beyond_friction(body, y, before):
    """Momentum along the ground, for a unit of mass, that no static friction bears beside that upwards [m/s].

    The change of the velocity of the centre of mass, which was ``before``, is the impulse of all contacts.
    """
    after = solid.centre_velocity(y)
    shear = algebra.norm(after[0] - before[0], after[1] - before[1])
    return shear - body.static * (after[2] - before[2])
