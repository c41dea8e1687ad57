"""A round base that rolls on its rim: how it begins, and how it passes near flat.

In: a state next to flat. Out: the state beyond, in closed form, or laid flat. Theory: ``docs/space.md``, "Steps"
and "Derivations", equations 18 to 25.

Names (``_body`` explains the state and the numbers of contacts):

- ``body``, ``s``: records ``BODY`` and ``CASE``; ``y``: the state, shape (15,)
- ``rows``: the world's axes as the body sees them, ``rows[2]`` the upward one
- ``gravity``: effective gravity, equation 1, in the world [m/s²]
"""

from rockfrag.base.elementary import sin_cos
from rockfrag.engines.algebra import vectors as algebra
from rockfrag.engines.compile.jit import kernel
from rockfrag.engines.spatial import _body as solid
from rockfrag.engines.spatial import _case as case
from rockfrag.engines.spatial import _contacts as contacts
from rockfrag.engines.spatial import _gaps as gaps
from rockfrag.engines.spatial import _modes as modes
from rockfrag.engines.spatial import _outcome as outcome
from rockfrag.engines.spatial import _rest as rest

# tilt with which a round base begins to roll: at none it has no direction [rad]
RIM_START = 1e-7
# tilt below which a round base passes through flat in closed form [rad]
FLAT_PASS = 1e-8
AFTER_PASS = 1e-9  # first step after such a pass [s]
# energy of a wobble at which a round body lies down, over that at which a body rests after an impact: rolling
# loses nothing, so that it would go on for ever, by micrometres
LEAST_WOBBLE = 100.0


@kernel
def start_rolling(body, y, towards_x, towards_y, gravity, s):
    """Tilt a flat round body by RIM_START towards a direction of the base, and let it roll.

    The direction (towards_x, towards_y) is in the body. What the tilt takes counts as work of the ground's motion.
    """
    size = max(algebra.norm(towards_x, towards_y), algebra.TINY)
    u = (towards_x / size, towards_y / size)
    before = (y[solid.PLACE], y[solid.PLACE + 1], y[solid.HEIGHT])
    tilt_about(body, y, u, RIM_START)
    after = (y[solid.PLACE], y[solid.PLACE + 1], y[solid.HEIGHT])
    moving = (gravity[0], gravity[1], gravity[2] + s.field[case.GRAVITY])
    y[solid.WORK] += algebra.dot(moving, algebra.minus(after, before))
    s.closed[0], s.slides[0] = solid.rim_contact(body), case.STICKS
    s.count, s.rests = 1, 0
    gaps.settle(body, y, s)


@kernel
def tilt_about(body, y, u, tilt):
    """Give a flat body a small tilt [rad] about its lowest point, which is towards the unit vector u of the base.

    That point stays where it is in the plan; the height of the centre of mass is left to what follows. The axis
    (-u[1], u[0]) of the turn is level and across u.
    """
    gaps.lay_flat(body, y)
    p = (
        body.centre[0] + body.rim * u[0],
        body.centre[1] + body.rim * u[1],
        -body.height,
    )
    before = solid.position_of_base(y, algebra.rotation(y), p)
    algebra.turn(y, (-tilt * u[1], tilt * u[0], 0.0))
    after = solid.position_of_base(y, algebra.rotation(y), p)
    y[solid.PLACE] += before[0] - after[0]
    y[solid.PLACE + 1] += before[1] - after[1]


@kernel
def rim_instead_of_feet(body, y, gravity, s):
    """Replace the feet of a round base by its lowest point as soon as fewer than three of them carry.

    Feet are the four points of the rim on which it stands flat (:func:`_points.stand_on_feet`). It tips towards
    those that are left.
    """
    n = s.count
    if body.rim == 0.0 or n == 0 or n > 2 or s.closed[0] == solid.rim_contact(body):
        return
    towards_x, towards_y, sliding = 0.0, 0.0, case.STICKS
    for i in range(n):
        towards_x += body.points[s.closed[i], 0] - body.centre[0]
        towards_y += body.points[s.closed[i], 1] - body.centre[1]
        sliding = max(sliding, s.slides[i])
    tip_over_rim(body, y, towards_x, towards_y, sliding, gravity, s)


@kernel
def tip_over_rim(body, y, towards_x, towards_y, sliding, gravity, s):
    """Tilt a flat body towards the direction (towards_x, towards_y) of the base; let it roll or slide.

    ``sliding`` is STICKS or SLIDES; a body that slides keeps its velocities. Energy that this gains is paid back.
    """
    omega = solid.omega_of(y)
    velocity = solid.centre_velocity(y)
    before = solid.balance(body, y, s.field[case.GRAVITY])
    start_rolling(body, y, towards_x, towards_y, gravity, s)
    if sliding == case.SLIDES:
        s.slides[0] = case.SLIDES
        solid.set_spin(y, omega)
        solid.set_velocity(y, velocity)
    solid.pay(body, y, solid.balance(body, y, s.field[case.GRAVITY]) - before)


@kernel
def look_after_rim(body, y, tau, cut, ahead, s, out):
    """Pass a rim through flat, or let it rest, after a step; return the next step [s], else ``ahead``."""
    if s.count != 1:
        return ahead
    up = algebra.rotation(y)[2]
    if algebra.norm(up[0], up[1]) >= FLAT_PASS:
        outcome.note_loss(small_rim(body, y, tau, cut, s), out)
        return ahead
    before = solid.energy(body, y, s.field[case.GRAVITY])
    s.goes_on = 0
    pass_flat(body, y, s)
    outcome.note_loss(before - solid.energy(body, y, s.field[case.GRAVITY]), out)
    return AFTER_PASS


@kernel
def pass_flat(body, y, s):
    """Let a rim pass through flat in closed form, changing y (``docs/space.md``, "A near-flat pass", equation 20).

    Its contact turns by a fixed angle, ``body.pass_turn`` rolling and ``slide_turn`` sliding [rad], and the tilt
    rises as it sank. A body whose tilt rises already is left as it is.
    """
    gravity = s.field[case.GRAVITY]
    up = algebra.rotation(y)[2]
    from_here, tilt = solid.rim_direction(up)
    # rate of the vertical as the body sees it, towards the upright while the body sinks
    sinking = algebra.cross(up, solid.omega_of(y))
    if sinking[0] * up[0] + sinking[1] * up[1] >= 0.0:
        return
    before = solid.energy(body, y, gravity)
    slides = s.slides[0] == case.SLIDES
    angle = body.slide_turn if slides else body.pass_turn
    goes_back = sinking[0] * from_here[1] - sinking[1] * from_here[0] < 0
    if goes_back:
        # on the way in which the contact goes round already
        angle = -angle
    sine, cosine = sin_cos(angle)
    to_there = (
        cosine * from_here[0] - sine * from_here[1],
        sine * from_here[0] + cosine * from_here[1],
    )
    # so far that it is not below FLAT_PASS again at once
    tilt_about(body, y, to_there, max(2 * FLAT_PASS, tilt))
    rise(body, y, to_there, algebra.norm(sinking[0], sinking[1]), s)
    # a base that is not symmetrical would gain in the new direction
    solid.pay(body, y, solid.energy(body, y, gravity) - before)


@kernel
def rise(body, y, u, rate, s):
    """Let a body that is next to flat tilt up about the rim's point towards u, at a ``rate`` [rad/s]."""
    y[solid.SPIN], y[solid.SPIN + 1] = -rate * u[1], rate * u[0]
    if s.slides[0] == case.SLIDES:
        y[solid.UPWARD] -= rising(body, y, solid.rim_contact(body))
    else:
        gaps.settle(body, y, s)


@kernel
def rising(body, y, i):
    """Velocity of contact i away from the ground or its wall [m/s]."""
    return solid.approach_of(body, y, algebra.rotation(y), i)


@kernel
def small_rim(body, y, tau, cut, s):
    """Lay a round body flat whose wobble is below the cut-off if the ground carries it; return the loss [J/kg].

    One that slides and cannot tip by friction goes on flat, and slides on its face.
    """
    rows = algebra.rotation(y)
    small = LEAST_WOBBLE * cut * body.barrier
    # of the motion that tilts the body, what it would lose by lying down [J/kg]
    a, b, _ = solid.omega_of(y)
    tilting = 0.5 * (body.inertia[0, 0] * a**2 + body.inertia[1, 1] * b**2)
    lift = s.field[case.GRAVITY] * body.rim * algebra.norm(rows[2][0], rows[2][1])
    if tilting + 0.5 * y[solid.UPWARD] ** 2 + lift >= small:
        return 0.0
    before = solid.energy(body, y, s.field[case.GRAVITY])
    gravity = case.effective_gravity_at(s.field, tau)
    if rest.rest_margin(body, y, rows, gravity, s) >= 0 and before < small:
        gaps.come_to_rest(body, y, s)
    elif s.slides[0] == case.SLIDES and body.kinetic * body.height < body.rim:
        y[solid.UPWARD] = y[solid.SPIN] = y[solid.SPIN + 1] = 0.0
        gaps.lay_flat(body, y)
        if not modes.choose_mode(body, tau, y, s):
            contacts.jam(body, y, s)
    return before - solid.energy(body, y, s.field[case.GRAVITY])
