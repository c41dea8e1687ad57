"""Which mode follows: a body rests, lies flat, or some of its points stick or slide while others part.

In: a state at a contact event. Out: the mode, in ``s``. Theory: ``docs/space.md``, "Friction and impacts" and
"Derivations", equations 9 to 21.

Names (``_body`` explains the state and the numbers of contacts):

- ``body``, ``s``: records ``BODY`` and ``CASE``; ``y``: the state, shape (15,)
- ``rows``: the world's axes as the body sees them, ``rows[2]`` the upward one
- ``gravity``: effective gravity, equation 1, in the world [m/s²]; ``weight``: the same and the ties, in the body
- ``found``: the contacts of a small system that push, as bits: bit k for ``s.which[k]``; -1 without a solution
"""

from rockfrag.engines.algebra import vectors as algebra
from rockfrag.engines.compile.jit import kernel
from rockfrag.engines.spatial import _body as solid
from rockfrag.engines.spatial import _case as case
from rockfrag.engines.spatial import _contacts as contacts
from rockfrag.engines.spatial import _face as face
from rockfrag.engines.spatial import _gaps as gaps
from rockfrag.engines.spatial import _limits as limits
from rockfrag.engines.spatial import _points as points
from rockfrag.engines.spatial import _problem as problem
from rockfrag.engines.spatial import _rest as rest
from rockfrag.engines.spatial import _stick as stick
from rockfrag.engines.spatial import _ties as ties

# velocity that points slip above where no mode was found otherwise: one may hardly slip [m/s]
SLOW_SLIP = 30 * limits.AT_REST
# velocity, of the centre of mass and of the spin times its height, below which a body may be laid to rest [m/s]
STILL = 10 * limits.CLOSE


@kernel
def choose_mode(body, tau, y, s):
    """Choose the mode that goes on from the state y, and write it to ``s``; return whether one was found.

    ``tau`` is the time in the interval [s]. In this order: rest, a face that slides, or the forces of the contacts
    that touch and do not leave. Where there are no such forces, points that slip by less than SLOW_SLIP are tried
    as points that stick. Velocity that the mode forbids is taken away.
    """
    rows = algebra.rotation(y)
    gravity = case.effective_gravity_at(s.field, tau)
    if may_rest(body, y, rows, gravity, s):
        gaps.come_to_rest(body, y, s)
        return True
    was_flying = s.count == 0
    flat = points.lies_flat(body, y, rows) and not points.meets_wall(body, y, rows)
    if flat and face.stay_on_face(body, tau, y, rows, gravity, s):
        return True
    n, slipping = pick_closed(body, y, rows, limits.AT_REST, s)
    found, solutions = solve_forces(body, y, rows, gravity, n, limits.AT_REST, s)
    if found < 0:
        n, fewer = pick_closed(body, y, rows, SLOW_SLIP, s)
        if fewer < slipping:
            found, solutions = solve_forces(body, y, rows, gravity, n, SLOW_SLIP, s)
    s.counters[limits.AMBIGUOUS] += solutions > 1
    if found < 0:
        return False
    s.jammed = 0
    contacts.write_mode(body, y, rows, n, found, s)
    contacts.hold(body, y, rows, s)
    if s.count == 0 and not was_flying:
        s.counters[limits.FLIGHTS] += 1
    return True


@kernel
def may_rest(body, y, rows, gravity, s):
    """Whether a body hardly moves, three points touch, and the ground carries it at rest."""
    spin = body.height * algebra.length(solid.omega_of(y))
    still = algebra.length(solid.centre_velocity(y)) + spin < STILL
    stands = still and points.count_touching(body, y, rows) >= 3
    return stands and rest.rest_margin(body, y, rows, gravity, s) >= 0


@kernel
def pick_closed(body, y, rows, slow, s):
    """Fill s.which with the contacts that touch and do not leave, and how each slips.

    What is slower than ``slow`` [m/s] sticks. Returned are how many contacts there are, and how many of them slip.
    """
    n = points.touching(body, y, rows, s)
    kept, slipping = 0, 0
    for i in range(n):
        u = solid.velocity_of(body, y, rows, s.which[i])
        u = solid.in_frame(body, s.which[i], u)
        if u[2] > limits.LEAVES:
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
        problem.let_slip(k, s)
    return slips


@kernel
def solve_forces(body, y, rows, gravity, n, slow, s):
    """Solve for the forces at the n contacts s.which; return the set that pushes, and how many would do.

    Beside walls more contacts may touch than are solved for at once. A round at a time, what would be passed
    through takes the place of the contact that is least needed, until none would be. ``slow`` is the velocity
    above which a contact slips [m/s]. s.impulse gets the forces [N/kg], s.after the accelerations [m/s²].
    """
    weight = ties.load_on(body, y, rows, gravity, s)
    moment = stick.fill_accelerations(body, y, rows, weight, n, s)
    if not case.picks_wall(n, s):
        return problem.solve(body, y, rows, n, 0, moment, s)
    found, solutions = -1, 0
    for _ in range(problem.TAKEN_IN):
        for i in range(n):
            u = (s.free[3 * i], s.free[3 * i + 1], s.free[3 * i + 2])
            u = solid.in_frame(body, s.which[i], u)
            s.free[3 * i], s.free[3 * i + 1], s.free[3 * i + 2] = u
        found, solutions = problem.solve(body, y, rows, n, 0, moment, s)
        if found < 0:
            break
        moves = pushed_by(body, rows, n, weight, moment, s)
        i = problem.missed(
            body, y, rows, n, moves, problem.MISSED * s.field[case.GRAVITY], True, s
        )
        at = problem.least_needed(n, found, s)
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
