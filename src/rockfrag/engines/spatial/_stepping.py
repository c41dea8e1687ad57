"""Time stepping through what is left of an interval in which contacts change too often to be followed.

A body that rattles or is wedged between ground and walls has events without end, and a foot that hardly slips
under a large coefficient of friction is stiff.  In short equal steps velocities obey, at their end, all contacts
that are near (Stewart and Trinkle 1996): none sinks further than its gap, friction within Coulomb's cone, found by
Gauss-Seidel.  The method is of first order in the step and, within it, loses energy and never gains any.

In: state and case at an instant of the interval. Out: both at its end. Theory: ``docs/space.md``, equation 24.

The n contacts that are near have the numbers s.near; ``k`` is a place there, ``i`` the number. Of each ``gives``
is its own compliance along each axis [-], ``closes`` how fast it may approach, gap over step [m/s], ``shove`` its
impulse [m/s]; axes 0 and 1 are along the contact, 2 is away from it.
"""

from rockfrag.engines.algebra import vectors as algebra
from rockfrag.engines.compile.jit import kernel
from rockfrag.engines.spatial import _body as solid
from rockfrag.engines.spatial import _case as case
from rockfrag.engines.spatial import _contacts as contacts
from rockfrag.engines.spatial import _delassus as delassus
from rockfrag.engines.spatial import _gaps as gaps
from rockfrag.engines.spatial import _limits as limits
from rockfrag.engines.spatial import _modes as modes
from rockfrag.engines.spatial import _ties as ties

PARTS = 16  # steps of a whole interval
NEAR = 1e-3  # gap below which a contact may be met in a step [m]
SWEEPS = 40  # of Gauss and Seidel's at most
# change of a contact's velocity in a sweep at which they end [m/s]
SETTLED = 1e-9


@kernel
def pass_interval(body, tau, dt, y, s):
    """Step from ``tau`` to the end of an interval dt [s] and choose the mode; return the energy lost [J/kg]."""
    parts = 1 + int(PARTS * (dt - tau) / dt)
    h = (dt - tau) / parts
    s.goes_on = 0
    s.rests = 0
    s.jammed = 0
    lost, n = 0.0, 0
    for part in range(parts):
        before = solid.balance(body, y, s.field[case.GRAVITY])
        n = take_step(body, tau + part * h, h, y, s)
        lost += loss_since(body, before, y, s)
    before = solid.balance(body, y, s.field[case.GRAVITY])
    close_pressed(body, y, n, s)
    if not modes.choose_mode(body, dt, y, s):
        contacts.jam(body, y, s)
    return lost + loss_since(body, before, y, s)


@kernel
def loss_since(body, before, y, s):
    """Take from the velocities what energy was gained since a balance; return what was lost [J/kg]."""
    gained = solid.balance(body, y, s.field[case.GRAVITY]) - before
    solid.pay(body, y, gained)
    return before - solid.balance(body, y, s.field[case.GRAVITY])


@kernel
def take_step(body, tau, h, y, s):
    """Take one step of h from ``tau`` in the interval [s]; return how many contacts were near.

    The state y is changed in place: velocities by gravity, ties and the impulses of contacts, and then places by
    these velocities.
    """
    rows = algebra.rotation(y)
    weight = ties.load_on(
        body, y, rows, case.effective_gravity_at(s.field, tau + 0.5 * h), s
    )
    load = algebra.to_world(rows, weight)
    spin = solid.free_spin(body, solid.omega_of(y), ties.twist_by_ties(s))
    for k in range(3):
        y[solid.VELOCITY + k] += h * load[k]
        y[solid.SPIN + k] += h * spin[k]
    n = find_near(body, y, rows, h, s)
    for _ in range(SWEEPS):
        if n == 0 or sweep(body, y, rows, n, s) < SETTLED:
            break
    note_pushes(body, n, s)
    # of the ground's motion, in the effective gravity less gravity itself, and of ties
    y[solid.WORK] += h * (
        load[0] * y[solid.VELOCITY]
        + load[1] * y[solid.VELOCITY + 1]
        + (load[2] + s.field[case.GRAVITY]) * y[solid.UPWARD]
    )
    y[solid.WORK] += h * algebra.dot(ties.twist_by_ties(s), solid.omega_of(y))
    for k in range(3):
        y[solid.PLACE + k] += h * y[solid.VELOCITY + k]
    algebra.turn(y, algebra.scaled(h, solid.omega_of(y)))
    put_in_place(body, y, n, s)
    return n


@kernel
def find_near(body, y, rows, h, s):
    """Fill in the contacts that are near, and what each can do in a step of h; return how many there are."""
    n = 0
    for k in range(solid.meetings(body)):
        n = add_near(body, y, rows, solid.meeting(body, k), n, h, s)
    return n


@kernel
def add_near(body, y, rows, i, n, h, s):
    """Add contact i to those that are near, if it is and there is room; return how many there are.

    Of each are kept its number (``near``), its coefficient of friction (``rubs``), how fast it may close in the
    step (``closes``), and by how much a unit impulse along each of its axes changes the velocity along that axis
    (``gives``), which is all that Gauss and Seidel's method asks for; its impulse (``shove``) begins at none.
    """
    gap = solid.gap_of(body, y, rows, i)
    if gap > NEAR or n == case.MOST_NEAR:
        return n
    u = solid.in_frame(body, i, solid.velocity_of(body, y, rows, i))
    slips = algebra.norm(u[0], u[1]) > limits.AT_REST
    s.near[n] = i
    s.rubs[n] = solid.kinetic_of(body, i) if slips else solid.static_of(body, i)
    s.closes[n] = max(gap, 0.0) / h
    for axis in range(3):
        push = delassus.push_along(body, rows, i, axis)
        p = solid.arm(body, rows[2], i)
        answer = solid.in_frame(body, i, delassus.response(body, rows, p, p, push))
        s.gives[n, axis] = answer[axis]
        s.shove[n, axis] = 0.0
    return n + 1


@kernel
def sweep(body, y, rows, n, s):
    """Correct the impulse of each near contact once, and the velocities in y with it (equation 24).

    Returned is the largest change of a contact's velocity [m/s].
    """
    worst = 0.0
    for k in range(n):
        i = s.near[k]
        u = solid.in_frame(body, i, solid.velocity_of(body, y, rows, i))
        normal = max(s.shove[k, 2] - (u[2] + s.closes[k]) / s.gives[k, 2], 0.0)
        change = normal - s.shove[k, 2]
        s.shove[k, 2] = normal
        delassus.push_at(body, y, rows, i, (0.0, 0.0, change))
        worst = max(worst, abs(change) * s.gives[k, 2])
        u = solid.in_frame(body, i, solid.velocity_of(body, y, rows, i))
        # one compliance for both axes along the contact: the larger one, which corrects too little rather than
        # much
        soft = max(s.gives[k, 0], s.gives[k, 1])
        a, b = s.shove[k, 0] - u[0] / soft, s.shove[k, 1] - u[1] / soft
        shear, limit = algebra.norm(a, b), s.rubs[k] * normal
        if shear > limit:
            a, b = a * limit / shear, b * limit / shear
        change = algebra.norm(a - s.shove[k, 0], b - s.shove[k, 1])
        delassus.push_at(body, y, rows, i, (a - s.shove[k, 0], b - s.shove[k, 1], 0.0))
        s.shove[k, 0], s.shove[k, 1] = a, b
        worst = max(worst, change * soft)
    return worst


@kernel
def put_in_place(body, y, n, s):
    """Move the body by little, so that near contacts that were pressed touch and no other lies behind its wall.

    Velocities at the end of a step leave gaps of what the body turns in it, squared. They are closed as impulses
    are found, one after the other: where gaps contradict each other, as of four contacts of a body that is wedged,
    equations for all at once would move it far. s.moved has by how much each was moved, as an impulse [m].
    """
    for k in range(n):
        s.moved[k] = 0.0
    for _ in range(SWEEPS):
        worst = 0.0
        for k in range(n):
            rows = algebra.rotation(y)
            gap = solid.gap_of(body, y, rows, s.near[k])
            moved = s.moved[k] - gap / s.gives[k, 2]
            if s.shove[k, 2] == 0.0:
                moved = max(moved, 0.0)
            change = moved - s.moved[k]
            if change != 0.0:
                gaps.shift_at(body, y, rows, s.near[k], change)
                s.moved[k] = moved
            worst = max(worst, abs(change) * s.gives[k, 2])
        if worst < limits.TOUCH:
            break


@kernel
def note_pushes(body, n, s):
    """Keep the largest impulse of each wall in a step [m/s]."""
    for w in range(body.constraints):
        whole = 0.0
        for k in range(n):
            if s.near[k] >= solid.WALLS and solid.wall_of(s.near[k]) == w:
                whole += s.shove[k, 2]
        s.impact[w] = max(s.impact[w], whole)


@kernel
def close_pressed(body, y, n, s):
    """Close the contacts that were pressed in the last step, at most MOST, as ones that slide."""
    s.count = 0
    for k in range(n):
        if s.shove[k, 2] > 0.0 and s.count < case.MOST:
            s.closed[s.count], s.slides[s.count] = s.near[k], case.SLIDES
            s.count += 1
