"""One analysis: a body, a motion of the ground, contact event by contact event.

In: a record ``BODY``, accelerations of shape (n, 3) [m/s²], scales, a state to begin with. Out: outcomes and
counters (their places are named constants here), the state at the end and, if wanted, the history. Theory:
``docs/space.md``, "Steps" and "Derivations", equations 18 to 25.

An interval is the time between two samples of the motion.

- ``y``: the state, changed in place; ``s``: record ``CASE``, with the mode; ``out``: the outcome, shape (OUTCOME,)
- ``tau``: time in an interval, ``dt`` its length, ``h`` a step [s]; ``rows``: the world's axes in the body
- ``gravity``: effective gravity in the world, equation 1; ``g``: that on ground at rest [m/s²]
- ``cut``: energy over rest at which a body rests, over that which a fall takes (``body.barrier``) [-]
"""

import math

from rockfrag.base.elementary import atan2, sin_cos
from rockfrag.engines.algebra import vectors as algebra
from rockfrag.engines.compile.jit import entry_kernel, kernel
from rockfrag.engines.pure_rocking.kernels.roots import narrowed
from rockfrag.engines.spatial import _body as solid
from rockfrag.engines.spatial import _forces as forces
from rockfrag.engines.spatial import _hinge as hinge
from rockfrag.engines.spatial import _modes as modes
from rockfrag.engines.spatial import _step as step
from rockfrag.engines.spatial import _stepping as stepping

# tilt with which a round base begins to roll: at none it has no direction [rad]
RIM_START = 1e-7
# tilt below which a round base passes through flat in closed form [rad]
FLAT_PASS = 1e-8
SHORTEST = 1e-11  # step [s]
# part of an interval that is rounding [-]; of gravity, by which a margin of rest is none [-]
NO_TIME, NO_MARGIN = 1e-12, 1e-9
# steps of no length in a row after which one contact is changed outright, and after which a step is forced
SOON_STUCK, STUCK = 3, 100
# velocity that closes contacts at most, however often it is doubled [m/s]
MOST_CLOSE = 1e-3
# step above which a contact is looked for that touched inside of it alone [s]; first step after a near-flat pass
# [s]
LOOKS_INSIDE, AFTER_PASS = 1e-7, 1e-9
# step that is forced at most [s]; tilt below which a wobble that cannot be followed lies flat [rad]
FORCED, NEXT_TO_FLAT = 1e-6, 1e-3
# time in which rates stay: its square times an acceleration is less than TOUCH [s]
BRIEF = 1e-6
# how many contacts take part in an impact at least: in a landing, and in one that no collision brings about
LANDING, NO_COLLISION = 0, 1
# margins at which an instant is known: of gaps [m]; of forces [N/kg] and slips [m/s], which is less than what is
# not seen of forces (LEAST_FORCE), and 1e-5 of the slip that counts as ended (AT_REST)
CLOSED, UNSEEN = 1e-12, 1e-9
# contact events in one interval after which the velocity that closes contacts is doubled
MANY = 40
# steps in one interval after which errors of COARSE [m, m/s, rad/s] are allowed to what slides: slip that hardly
# begins is stiff.  What rolls keeps its tolerance, as it may pass near flat, where such errors feed energy
HURRY, COARSE = 1000, 1e-6
# steps in one interval after which a body that is next to flat is laid flat; after twice as many more the interval
# ends.  Both are counted as paradoxes
GIVE_UP = 2000
# contact events in one interval beside walls after which the rest of it is passed by time stepping, and where the
# one before was; and so many times that steps
RESTLESS, AGAIN, STIFF = 24, 6, 4
PATIENCE = 30  # times that this may happen before an analysis ends as one that stood
# after which an analysis ends as one that stood, counted as a paradox
MOST_STEPS = 400_000

# energy over rest, as a part of what a fall takes, below which a rattle is not followed that ends before the
# ground could lift the body
RATTLE = 1e-3
# energy of a wobble at which a round body lies down, over that at which a body rests after an impact: rolling
# loses nothing, so that it would go on for ever, by micrometres
LEAST_WOBBLE = 100.0
# intervals on ground at rest in which a body that walls or ties hold hardly moves, after which it is at rest
STILL = 20
# intervals that a body at rest passes at once where the ground cannot move it
WINDOW = 16

# outcomes of each constraint and of the bond: hits, largest impulse and force, instant of breaking
OF_HOLDER = 4
OUTCOME = 18 + OF_HOLDER * solid.HOLDERS
(
    FELL, FALL_AZIMUTH, FALL_FIRST, FALL_SECOND, PEAK_RATIO, PEAK_TILT, PEAK_SPEED, WALK_X, WALK_Y, TURN, STEPS,
    LOST, ENERGY_BALANCE, CERTAIN_TIME, CONTACT_EVENTS, GAINED,
    BEYOND, LEANS, HELD,
) = range(19)  # fmt: skip
"""Outcomes; from HELD on four of each constraint and the bond: hits, impulse, force, instant of breaking."""

COLUMNS = 17
TURNED, COUNT, FIRST, SECOND = range(solid.WORK, COLUMNS)
"""Columns of a history: y[0:13], turn about the vertical, number of closed points, and the first two of them."""

RESTS = 99  # number of closed points that a history has of a body at rest


@kernel
def set_field(field, acceleration, k, scale, dt, g):
    """Fill s.field for interval k: effective gravity at its beginning [m/s²], its rate [m/s³], and g.

    The ground is at rest one sample after the last.
    """
    last = acceleration.shape[0] - 1
    for i in range(3):
        now = scale * acceleration[k, i] if k <= last else 0.0
        then = scale * acceleration[k + 1, i] if k < last else 0.0
        field[i], field[3 + i] = -now, -(then - now) / dt
    field[2] -= g
    field[forces.GRAVITY] = g


@kernel
def rest_ends(body, y, s, tau, dt):
    """Time in the interval when the ground no longer carries the body at rest [s], -1 if it does to the end.

    The margin of rest is a concave function of time within an interval, so that it is enough to look at both ends;
    its zero is found by false position.
    """
    field = s.field
    gravity = forces.effective_gravity_at(field, dt)
    level = algebra.norm(gravity[0], gravity[1])
    upright = level * body.height < -gravity[2] * body.nearest * (1 - NO_MARGIN)
    if upright and level < -body.static * gravity[2] and not s.bonded:
        # a flat body rests whichever way it is pulled
        return -1.0
    rows = algebra.rotation(y)
    below = modes.rest_margin(body, y, rows, gravity, s)
    if below >= 0:
        return -1.0
    above = modes.rest_margin(body, y, rows, forces.effective_gravity_at(field, tau), s)
    if above <= 0:
        return tau
    bracket = (tau, above, dt, below, 0)
    for _ in range(100):
        low, above, high, below, _ = bracket
        middle = (low * below - high * above) / (below - above)
        value = modes.rest_margin(
            body, y, rows, forces.effective_gravity_at(field, middle), s
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
    gravity = forces.effective_gravity_at(s.field, tau)
    if body.walls:
        gravity = modes.borne_by_ground(body, y, rows, gravity)
    small = NO_MARGIN * s.field[forces.GRAVITY]
    level = algebra.norm(gravity[0], gravity[1])
    s.rests = 0
    whole = modes.rest_margin(body, y, rows, gravity, s)
    if -body.static * gravity[2] - level < small or whole < -small:
        slide_or_jump(body, y, tau, s, gravity, level, whole < -small)
        return
    if body.rim > 0:
        b = algebra.to_body(rows, (gravity[0], gravity[1], 0.0))
        # the moment about the base's centre (equation 21), in the body
        centre = -gravity[2] / body.height
        towards_x = b[0] - centre * body.centre[0]
        towards_y = b[1] - centre * body.centre[1]
        start_rolling(body, y, towards_x, towards_y, gravity, s)
        return
    s.count = 0
    last, first = -1, -1
    for i in range(body.count):
        if solid.gap(body, y, rows[2], i) <= modes.TOUCH:
            if last >= 0:
                add_edge(body, y, rows, gravity, last, i, small, s)
            else:
                first = i
            last = i
    add_edge(body, y, rows, gravity, last, first, small, s)
    modes.anchor_all(body, y, s)


@kernel
def slide_or_jump(body, y, tau, s, gravity, level, jumps):
    """Leave rest by sliding on the whole base, or, after a jump of the ground's acceleration, in any mode.

    ``level`` is the horizontal part of the effective gravity [m/s²]; a ground that ``jumps`` has left the margin
    of rest behind at once.
    """
    if jumps and modes.choose_mode(body, tau, y, s):
        return
    n = modes.pick_feet(body, y, algebra.rotation(y), s)
    for i in range(n):
        s.closed[i], s.slides[i] = s.which[i], forces.SLIDES
        s.direction[i, 0], s.direction[i, 1] = gravity[0] / level, gravity[1] / level
    s.count = n
    s.counters[modes.SLIDINGS] += 1


@kernel
def add_edge(body, y, rows, gravity, i, j, small, s):
    """Close the ends of the edge from point i to j if the body tips over it; of two edges their vertex alone.

    It tips where the margin is not above ``small`` [m/s²].
    """
    if modes.edge_margin(body, y, rows, gravity, i, j) > small:
        return
    if s.count == 0:
        s.closed[0], s.closed[1] = i, j
        s.slides[0] = forces.STICKS
        s.slides[1] = forces.STICKS
        s.count = 2
    else:
        shared = i if i in (s.closed[0], s.closed[1]) else j
        s.closed[0] = shared
        s.count = 1


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
    moving = (gravity[0], gravity[1], gravity[2] + s.field[forces.GRAVITY])
    y[solid.WORK] += algebra.dot(moving, algebra.minus(after, before))
    s.closed[0], s.slides[0] = solid.rim_contact(body), forces.STICKS
    s.count, s.rests = 1, 0
    modes.settle(body, y, s)


@kernel
def tilt_about(body, y, u, tilt):
    """Give a flat body a small tilt [rad] about its lowest point, which is towards the unit vector u of the base.

    That point stays where it is in the plan; the height of the centre of mass is left to what follows. The axis
    (-u[1], u[0]) of the turn is level and across u.
    """
    modes.lay_flat(body, y)
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
def pass_flat(body, y, s):
    """Let a rim pass through flat in closed form, changing y (``docs/space.md``, "A near-flat pass", equation 20).

    Its contact turns by a fixed angle, ``body.pass_turn`` rolling and ``slide_turn`` sliding [rad], and the tilt
    rises as it sank. A body whose tilt rises already is left as it is.
    """
    gravity = s.field[forces.GRAVITY]
    up = algebra.rotation(y)[2]
    from_here, tilt = solid.rim_direction(up)
    # rate of the vertical as the body sees it, towards the upright while the body sinks
    sinking = algebra.cross(up, solid.omega_of(y))
    if sinking[0] * up[0] + sinking[1] * up[1] >= 0.0:
        return
    before = solid.energy(body, y, gravity)
    slides = s.slides[0] == forces.SLIDES
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
    if s.slides[0] == forces.SLIDES:
        y[solid.UPWARD] -= rising(body, y, solid.rim_contact(body))
    else:
        modes.settle(body, y, s)


@kernel
def lowest_open(body, y, s):
    """Number of the open contact that is nearest to the ground or its wall, at a wall of those that approach."""
    rows = algebra.rotation(y)
    lowest, found = modes.NO_LIMIT, 0
    for i in solid.candidates(body):
        if not step.is_closed(s, i):
            height = solid.gap(body, y, rows[2], i)
            if height < lowest:
                lowest, found = height, i
    for i in solid.wall_candidates(body):
        if solid.may_meet(body, i) and not step.is_closed(s, i):
            height = solid.gap_of(body, y, rows, i)
            if height < lowest and solid.approach_of(body, y, rows, i) < 0.0:
                lowest, found = height, i
    return found


@kernel
def rising(body, y, i):
    """Velocity of contact i away from the ground or its wall [m/s]."""
    return solid.approach_of(body, y, algebra.rotation(y), i)


@kernel
def guess_landing(body, h, y, below, s):
    """Time in a step [s] at which the point lands that is lowest after it; its gap is ``below``, negative [m].

    It is the last zero of the cubic through gaps and velocities at both ends, above + fall x + square x² + cube
    x³, x the part of the step (``docs/space.md``, equation 23), by Newton's method; about an edge then that of
    the series of the angle.
    """
    i = lowest_open(body, s.new, s)
    above, fall = solid.gap_of(body, y, algebra.rotation(y), i), h * rising(body, y, i)
    end = h * rising(body, s.new, i)
    square = 3.0 * (below - above) - 2.0 * fall - end
    cube = 2.0 * (above - below) + fall + end
    # the last time that it comes down, also where it has only just gone up
    part = 1.0 if end < 0.0 else above / (above - below)
    for _ in range(5):
        value = above + part * (fall + part * (square + part * cube))
        part -= value / (fall + part * (2.0 * square + part * 3.0 * cube))
    if step.kind_of_step(body, s) == forces.HINGE:
        part = hinge.landing(body, y, i, part, 0.5 * modes.TOUCH, s)
    return h * part


@kernel
def locate(body, tau, h, y, s):
    """Find the first instant in a step h at which a margin vanishes; return it, from the beginning [s], and which.

    s.new gets the state there. False position (Illinois) between the last instant that is admissible and the first
    that is not takes whole steps from y, where both margins are of one kind; else the bracket is halved. A landing
    begins with :func:`guess_landing` and ends with a step of Newton's.
    """
    below, what = step.margin(body, s.new, s)
    middle = guess_landing(body, h, y, below, s) if what == modes.LANDS else 0.0
    forces.rates(body, tau, y, s.slopes[0], s)
    above, what_above = step.margin(body, y, s)
    if above <= 0:
        for i in range(solid.SIZE):
            s.new[i] = y[i]
        return 0.0, what_above
    bracket, what_below = (0.0, above, h, below, 0), what
    for _ in range(80):
        low, above, high, below, _ = bracket
        # margins of two kinds have no chord in common
        alike = what_above == what_below
        if alike and not low < middle < high:
            middle = (low * below - high * above) / (below - above)
        if not low < middle < high:
            middle = 0.5 * (low + high)
            bracket = (low, above, high, below, 0)
        step.attempt(body, tau, middle, y, s)
        value, what = step.margin(body, s.new, s)
        at, middle = middle, 0.0
        if value < 0.0:
            what_below = what
        else:
            what_above = what
        rate = 0.0
        if what == modes.LANDS and what_below == modes.LANDS:
            rate = rising(body, s.new, lowest_open(body, s.new, s))
        if rate < 0.0:
            # a last step of Newton's, so short that the rates at its beginning suffice
            rest = -value / rate
            middle = at + rest
            if abs(rest) < BRIEF and low < at + rest < high:
                step.go_on_by(body, at, rest, tau, y, s)
                return at + rest, what
        bracket = narrowed(bracket, at, value)
        is_gap = what in (modes.LANDS, modes.TIE_TURNS, modes.TIE_BREAKS)
        if abs(value) < (CLOSED if is_gap else UNSEEN):
            return at, what
        if bracket[2] - bracket[0] < 1e-14:
            break
    step.attempt(body, tau, bracket[2], y, s)
    _, what = step.margin(body, s.new, s)
    return bracket[2], what


@kernel
def stop_slips(body, y, s):
    """Let points whose slip has ended stick, before the mode is chosen anew, and stop what is left of it.

    Slip ends at AT_REST; of several points the others stick too where theirs is below twice that.
    """
    rows = algebra.rotation(y)
    for i in range(s.count):
        if s.slides[i] == forces.SLIDES:
            u = forces.slip_of(body, y, rows, i, s)
            slow = algebra.norm(u[0], u[1]) < 2 * modes.AT_REST
            if slow and not solid.is_smooth(body, s.closed[i]):
                s.slides[i] = forces.STICKS
    modes.hold(body, y, rows, s)


@kernel
def rim_instead_of_feet(body, y, gravity, s):
    """Replace the feet of a round base by its lowest point as soon as fewer than three of them carry.

    Feet are the four points of the rim on which it stands flat (:func:`_modes.stand_on_feet`). It tips towards
    those that are left.
    """
    n = s.count
    if body.rim == 0.0 or n == 0 or n > 2 or s.closed[0] == solid.rim_contact(body):
        return
    towards_x, towards_y, sliding = 0.0, 0.0, forces.STICKS
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
    before = solid.balance(body, y, s.field[forces.GRAVITY])
    start_rolling(body, y, towards_x, towards_y, gravity, s)
    if sliding == forces.SLIDES:
        s.slides[0] = forces.SLIDES
        solid.set_spin(y, omega)
        solid.set_velocity(y, velocity)
    solid.pay(body, y, solid.balance(body, y, s.field[forces.GRAVITY]) - before)


@kernel
def slides_any(s):
    """Whether any closed point slides."""
    found = False
    for i in range(s.count):
        found = found or s.slides[i] == forces.SLIDES
    return found


@kernel
def rattle_ends(body, left, s):
    """Whether a polygon with so much energy left [J/kg] rattles to rest before the ground could lift it.

    A rattle lasts as long as equation 19 (``docs/space.md``) says, with what the strongest ground of the next
    intervals, s.soon, leaves of the moment that rights the body. That ground may neither tip it nor make it slide.
    """
    if body.rim > 0.0 or left > RATTLE * body.barrier:
        return False
    weight = s.field[forces.GRAVITY] - s.soon[1]
    rights = weight * body.nearest - s.soon[0] * body.height
    if rights <= 0.0 or s.soon[0] >= body.static * weight:
        return False
    square = body.nearest * body.nearest
    inertia = max(body.inertia[0, 0], body.inertia[1, 1])
    inertia += body.height * body.height + body.furthest * body.furthest
    lasts = math.sqrt(2.0 * left * inertia) * inertia / (rights * square)
    return lasts <= s.soon[2]


@kernel
def note_soon(s, peaks, k, scale, dt):
    """Fill s.soon: largest horizontal and vertical acceleration soon [m/s²], and how long that is [s].

    ``peaks`` are those of :func:`fill_peaks`, ``k`` the interval.
    """
    inside = k < peaks.shape[0]
    for i in range(2):
        s.soon[i] = scale * peaks[k, 2 + i] if inside else 0.0
    s.soon[2] = (WINDOW - 1) * dt


@kernel
def happen(body, what, tau, y, cut, stuck, s):
    """Change velocities and mode by what ended a step; return the energy lost [J/kg].

    ``what`` is one of modes.LANDS and those behind it, and y the state then. First it takes effect, then the mode
    that goes on is chosen. ``stuck`` is how many steps in a row had hardly any length: then one contact is changed
    outright.
    """
    gravity = forces.effective_gravity_at(s.field, tau)
    before = solid.balance(body, y, s.field[forces.GRAVITY])
    if what == modes.LANDS:
        land(body, y, gravity, cut, s)
    elif what == modes.SLIP_ENDS:
        stop_slips(body, y, s)
    elif what == modes.TIE_TURNS:
        turn_ties(body, y, tau, False, s)
    elif what == modes.TIE_BREAKS:
        turn_ties(body, y, tau, True, s)
    if what == modes.OPENS and body.rim > 0 and s.count >= 3:
        # the centre of pressure has come to the rim, over which the face tips as it slides
        towards_x, towards_y = modes.pressure_centre(body, s)
        tip_over_rim(body, y, towards_x, towards_y, forces.SLIDES, gravity, s)
    elif stuck > SOON_STUCK and what in (modes.OPENS, modes.LEAVES_CONE):
        modes.insist(body, what, s)
    elif forces.kind_of(s) != forces.REST:
        follow(body, tau, y, gravity, s)
    rim_instead_of_feet(body, y, gravity, s)
    return before - solid.balance(body, y, s.field[forces.GRAVITY])


@kernel
def land(body, y, gravity, cut, s):
    """Solve the impact of a landing; let the body rest if little energy is left and the ground carries it."""
    modes.impact(body, y, gravity, LANDING, s)
    rows = algebra.rotation(y)
    if body.rim == 0.0 and modes.count_touching(body, y, rows) >= 3:
        # the points that open begin with no gap, not with one of rounding; what comes down by that lands as well
        modes.lay_flat(body, y)
        if modes.is_approached(body, y, s):
            modes.impact(body, y, gravity, LANDING, s)
    left = solid.energy(body, y, s.field[forces.GRAVITY])
    carried = (
        stands_within_balance(body, rows)
        and modes.rest_margin(body, y, rows, gravity, s) >= 0
    )
    if carried and (left < cut * body.barrier or rattle_ends(body, left, s)):
        modes.come_to_rest(body, y, s)


@kernel
def follow(body, tau, y, gravity, s):
    """Choose the mode that follows; where contact forces do not exist (Painlevé), after an impact, or jammed.

    What slides has an impact without a collision; if there is no mode after it either, what is closed sticks.
    """
    if modes.choose_mode(body, tau, y, s):
        return
    s.counters[modes.JAMS] += 1
    free = slides_any(s)
    if free:
        modes.impact(body, y, gravity, NO_COLLISION, s)
        free = modes.choose_mode(body, tau, y, s)
    if not free:
        modes.jam(body, y, s)


@kernel
def note_peaks(body, y, rows, out):
    """Keep the largest tilt and speed."""
    up = rows[2]
    sine = algebra.norm(up[0], up[1])
    if sine > modes.FLAT:
        # tangent of the tilt at which the centre of mass is over the base's outline in the direction of the tilt
        critical = reach_towards_tilt(body, rows) / body.height
        # x / (1 + x²) < arc tangent of x < x, so most states need no arc tangent
        if sine * (1 + critical * critical) > out[PEAK_RATIO] * critical * up[2]:
            tilt = atan2(sine, up[2])
            out[PEAK_RATIO] = max(out[PEAK_RATIO], tilt / atan2(critical, 1.0))
            out[PEAK_TILT] = max(out[PEAK_TILT], tilt)
        elif sine > out[PEAK_TILT] * up[2]:
            out[PEAK_TILT] = max(out[PEAK_TILT], atan2(sine, up[2]))
    speed = algebra.length(solid.omega_of(y))
    out[PEAK_SPEED] = max(out[PEAK_SPEED], speed)


@kernel
def note_walk(body, y, start, out):
    """Keep how far the base's point below the centre of mass is from where it was at first."""
    below = (0.0, 0.0, -body.height)
    foot = solid.position_of_base(y, algebra.rotation(y), below)
    out[WALK_X], out[WALK_Y] = foot[0] - start[0], foot[1] - start[1]


@kernel
def is_beyond(body, y):
    """Whether the centre of mass is beyond the outline of the base: the body would fall on ground at rest."""
    rows = algebra.rotation(y)
    sine = algebra.norm(rows[2][0], rows[2][1])
    return reach_towards_tilt(body, rows) * rows[2][2] < sine * body.height


@kernel
def stands_within_balance(body, rows):
    """Whether the centre of mass is above the base: what leans at a wall beyond it has little energy too."""
    up = rows[2]
    sine = algebra.norm(up[0], up[1])
    reach = reach_towards_tilt(body, rows)
    return up[2] > 0.0 and sine * body.height <= up[2] * reach


@kernel
def reach_towards_tilt(body, rows):
    """How far the base reaches in the direction in which the body tilts, from below its centre of mass [m]."""
    u, _ = solid.rim_direction(rows[2])
    if body.rim > 0:
        return body.rim + body.centre[0] * u[0] + body.centre[1] * u[1]
    reach = 0.0
    for i in range(body.count):
        reach = max(reach, body.points[i, 0] * u[0] + body.points[i, 1] * u[1])
    return reach


@kernel
def heading(y):
    """Twist of a body's quaternion about the vertical: cosine and sine of half the angle, but for their size."""
    return y[solid.ATTITUDE], y[solid.ATTITUDE + 3]


@kernel
def turn_since(before, y):
    """Angle by which a body has turned about the vertical since a heading, less than half a turn [rad]."""
    now = heading(y)
    cosine = before[0] * now[0] + before[1] * now[1]
    sine = before[0] * now[1] - before[1] * now[0]
    if cosine < 0.0:
        # the other quaternion of the same attitude
        cosine, sine = -cosine, -sine
    return 2.0 * atan2(sine, cosine)


@kernel
def note_turn(y, before, out):
    """Add the turn about the vertical since a heading if it is large; return the heading from which more counts.

    An arc tangent is dear, and few bodies turn far.
    """
    now = heading(y)
    cosine = before[0] * now[0] + before[1] * now[1]
    sine = before[0] * now[1] - before[1] * now[0]
    if 2.0 * abs(sine) > abs(cosine):
        out[TURN] += turn_since(before, y)
        return now
    return before


@kernel
def fall_is_certain(body, y, rows, peaks, scale, g):
    """Whether the body leans further over its furthest point than the steepest effective gravity to come.

    It has to tilt further, too (``docs/space.md``, equation 25). ``peaks`` are the largest horizontal and vertical
    acceleration from now on, before the ``scale`` [m/s²].
    """
    if body.constraints > 0:
        # what holds it may catch it
        return False
    up = rows[2]
    sine = algebra.norm(up[0], up[1])
    # sine and cosine of the tilt beyond, times the same length
    beyond = sine * body.height - up[2] * body.furthest
    if beyond <= 0:
        return False
    within = up[2] * body.height + sine * body.furthest
    if beyond * (g - scale * peaks[1]) <= within * scale * peaks[0]:
        return False
    turning = algebra.cross(up, solid.omega_of(y))
    return up[0] * turning[0] + up[1] * turning[1] > 0


@kernel
def note_fall(y, s, time, out):
    """Write down that the body fell, where to, over what, and when that was certain, at ``time`` [s].

    The direction is that of the body's axis in the plan; what it falls over are at most two vertices, or the rim.
    """
    rows = algebra.rotation(y)
    out[FELL], out[CERTAIN_TIME] = 1.0, time
    out[FALL_AZIMUTH] = atan2(rows[1][2], rows[0][2])
    out[FALL_FIRST] = out[FALL_SECOND] = -1.0
    for k in range(s.count - 1, -1, -1):
        if s.closed[k] < solid.WALLS:
            out[FALL_SECOND] = out[FALL_FIRST]
            out[FALL_FIRST] = s.closed[k]


@kernel
def record(history, k, y, before, out, s):
    """Write sample k of the history, shape (m, COLUMNS), if there is room; of a body at rest RESTS contacts.

    ``before`` is the heading from which the turn counts on. Where fewer than two contacts are closed, the last
    columns hold what was there before.
    """
    if k >= history.shape[0]:
        return
    for i in range(solid.WORK):
        history[k, i] = y[i]
    history[k, TURNED] = out[TURN] + turn_since(before, y)
    history[k, COUNT] = RESTS if s.rests else s.count
    history[k, FIRST] = s.closed[0]
    history[k, SECOND] = s.closed[1]


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
    lift = s.field[forces.GRAVITY] * body.rim * algebra.norm(rows[2][0], rows[2][1])
    if tilting + 0.5 * y[solid.UPWARD] ** 2 + lift >= small:
        return 0.0
    before = solid.energy(body, y, s.field[forces.GRAVITY])
    gravity = forces.effective_gravity_at(s.field, tau)
    if modes.rest_margin(body, y, rows, gravity, s) >= 0 and before < small:
        modes.come_to_rest(body, y, s)
    elif s.slides[0] == forces.SLIDES and body.kinetic * body.height < body.rim:
        y[solid.UPWARD] = y[solid.SPIN] = y[solid.SPIN + 1] = 0.0
        modes.lay_flat(body, y)
        if not modes.choose_mode(body, tau, y, s):
            modes.jam(body, y, s)
    return before - solid.energy(body, y, s.field[forces.GRAVITY])


@kernel
def slow_power(x):
    """Return x to the power 3/16, next to the 1/5 of the order, by square roots: the same bits everywhere."""
    root = math.sqrt(math.sqrt(math.sqrt(x)))
    return root * math.sqrt(root)


@kernel
def advance(body, tau, dt, next_step, y, tolerance, cut, stuck, s, out):
    """Take one step of an interval, up to its end or to what happens first.

    ``next_step`` is the longest that is tried [s], ``tolerance`` the error allowed to it. Returned are the time in
    the interval, the next step and the length of this one [s].
    """
    g = s.field[forces.GRAVITY]
    step.begin(body, tau, y, s)
    # equal steps to the end of the interval, where the ground's acceleration has a kink
    h = (dt - tau) / math.ceil((dt - tau) / next_step)
    most = 5.0
    while True:
        error = step.attempt(body, tau, h, y, s)
        out[STEPS] += 1
        if error <= tolerance or h <= SHORTEST:
            least, what = step.margin(body, s.new, s)
            # a corner that has dipped into a wall does not count at the end of a step, whatever else happens there
            hides = least >= 0 or body.walls
            if hides and h > LOOKS_INSIDE and step.dips(body, y, h, s):
                h *= 0.5
                continue
            break
        h *= max(0.2, 0.9 * slow_power(tolerance / error))
        # else the next step would be rejected too
        most = 1.0
    grow = most
    if error > 1e-4 * tolerance:
        # of less the growth is five times in any case
        grow = min(most, max(0.3, 0.9 * slow_power(tolerance / error)))
    ahead = h * grow
    if least < 0:
        h, what = locate(body, tau, h, y, s)
    else:
        what = modes.NOTHING
    exact = step.kind_of_step(body, s) != forces.GENERAL
    if exact and body.rim > 0:
        note_loss(solid.balance(body, y, g) - solid.balance(body, s.new, g), out)
    for i in range(solid.SIZE):
        y[i] = s.new[i]
    if body.constraints > 0:
        note_forces(body, y, s)
    if what != modes.NOTHING:
        out[CONTACT_EVENTS] += 1
        note_loss(happen(body, what, tau + h, y, cut, stuck, s), out)
        return tau + h, dt, h
    if not exact:
        before = solid.energy(body, y, g)
        modes.settle(body, y, s)
        if body.walls:
            # contacts that are wedged may be raised
            solid.pay(body, y, solid.energy(body, y, g) - before)
        note_loss(before - solid.energy(body, y, g), out)
    # whether the rates at the end of a step are those at the beginning of the next
    sticks = forces.kind_of(s) in (forces.FLIGHT, forces.PIVOT, forces.HINGE)
    s.goes_on = exact or (sticks and body.rim == 0.0)
    if body.rim > 0:
        ahead = look_after_rim(body, y, tau + h, cut, ahead, s, out)
    return tau + h, ahead, h


@kernel
def note_loss(loss, out):
    """Add energy lost at once [J/kg]; what is gained is a defect, of which the whole is kept."""
    out[LOST] += loss
    out[GAINED] += max(-loss, 0.0)


@kernel
def look_after_rim(body, y, tau, cut, ahead, s, out):
    """Pass a rim through flat, or let it rest, after a step; return the next step [s], else ``ahead``."""
    if s.count != 1:
        return ahead
    up = algebra.rotation(y)[2]
    if algebra.norm(up[0], up[1]) >= FLAT_PASS:
        note_loss(small_rim(body, y, tau, cut, s), out)
        return ahead
    before = solid.energy(body, y, s.field[forces.GRAVITY])
    s.goes_on = 0
    pass_flat(body, y, s)
    note_loss(before - solid.energy(body, y, s.field[forces.GRAVITY]), out)
    return AFTER_PASS


@entry_kernel
def integrate_scales(
    bodies,
    acceleration,
    peaks,
    scales,
    dt,
    g,
    extra,
    tolerance,
    cut,
    ends,
    history,
    outs,
    counts,
    cases,
):
    """Integrate one analysis after the other, at each of several scales, as :func:`integrate` does.

    Parameters
    ----------
    bodies, cases : records of ``body`` and ``s`` there, in arrays of one, which are quicker to pass, shape (1,)
    acceleration, dt, g, extra, tolerance, cut, history : as there
    peaks : takes what is asked for there, shape (n, 4)
    scales : of the motion, shape (scales,) [-]
    ends : states to begin with, and then those at the end, shape (scales, SIZE)
    outs : takes the outcomes, shape (scales, OUTCOME)
    counts : takes the counters, shape (scales, COUNTERS)
    """
    body, s = bodies[0], cases[0]
    fill_peaks(acceleration, peaks)
    for k in range(scales.shape[0]):
        integrate(
            body,
            acceleration,
            peaks,
            scales[k],
            dt,
            g,
            extra,
            tolerance,
            cut,
            ends[k],
            history,
            outs[k],
            s,
        )
        for i in range(modes.COUNTERS):
            counts[k, i] = s.counters[i]


@kernel
def fill_peaks(acceleration, peaks):
    """Fill the largest horizontal and vertical acceleration from each sample on, and in WINDOW of them: (n, 4)."""
    level, lift = 0.0, 0.0
    for k in range(acceleration.shape[0] - 1, -1, -1):
        across = algebra.norm(acceleration[k, 0], acceleration[k, 1])
        along = abs(acceleration[k, 2])
        level, lift = max(level, across), max(lift, along)
        peaks[k, 0], peaks[k, 1], peaks[k, 2], peaks[k, 3] = level, lift, across, along
    part = 1
    while part < WINDOW:
        # the largest of twice as many samples
        look_ahead(peaks, part)
        part *= 2
    look_ahead(peaks, 1)


@kernel
def look_ahead(peaks, part):
    """Let each of the last two columns of ``peaks`` be at least what it is ``part`` samples later."""
    for k in range(peaks.shape[0] - part):
        for i in range(2, 4):
            peaks[k, i] = max(peaks[k, i], peaks[k + part, i])


@kernel
def rests_on(body, peaks, k, scale, g):
    """Whether a body at rest stays there for the next WINDOW intervals, whichever way the ground pushes."""
    level, weight = scale * peaks[k, 2], g - scale * peaks[k, 3]
    upright = level * body.height < weight * body.nearest * (1 - NO_MARGIN)
    return upright and level < body.static * weight


@kernel
def integrate(
    body, acceleration, peaks, scale, dt, g, extra, tolerance, cut, y, history, out, s
):
    """Integrate one analysis of a body from the state ``y``; it ends ``extra`` intervals after the motion at most.

    Parameters
    ----------
    body : record ``BODY``
    acceleration : of the ground (x, y, up), linear between samples, shape (n, 3) [m/s²]
    peaks : largest horizontal and vertical ones from each sample on, and of the next WINDOW, shape (n, 4)
    scale : of both [-]
    dt : interval of the samples [s]
    g : acceleration of gravity [m/s²]
    extra : intervals after the motion at most
    tolerance : error of a step [m, m/s, rad/s]
    cut : energy at which a body rests, over what a fall takes [-]
    y : state, shape (SIZE,), changed in place
    history : takes a sample of each interval, as many as fit, shape (m, COLUMNS)
    out : takes the outcome, shape (OUTCOME,)
    s : record ``CASE`` to work in, whose counters tell the contact events afterwards
    """
    for i in range(OUTCOME):
        out[i] = 0.0
    set_field(s.field, acceleration, 0, scale, dt, g)
    started = solid.energy(body, y, g)
    start = solid.position_of_base(y, algebra.rotation(y), (0.0, 0.0, -body.height))
    before = heading(y)
    s.count = s.rests = s.jammed = s.goes_on = 0
    s.beyond = 0.0
    begin_holding(body, y, s)
    for i in range(modes.COUNTERS):
        s.counters[i] = 0
    if s.bonded:
        modes.come_to_rest(body, y, s)
    else:
        modes.choose_mode(body, 0.0, y, s)
        rim_instead_of_feet(body, y, forces.effective_gravity_at(s.field, 0.0), s)
    modes.anchor_all(body, y, s)
    out[CERTAIN_TIME] = math.nan
    last = acceleration.shape[0] - 1
    stuck = lost_track = still = 0
    patience = RESTLESS
    ahead = dt
    k = 0
    while k <= last + extra:
        skips = s.rests == 1 and s.bonded == 0 and k + WINDOW <= last
        if skips and rests_on(body, peaks, k, scale, g):
            for _ in range(WINDOW):
                record(history, k, y, before, out, s)
                k += 1
            continue
        set_field(s.field, acceleration, k, scale, dt, g)
        s.began = k * dt
        note_soon(s, peaks, k, scale, dt)
        record(history, k, y, before, out, s)
        if k > last:
            free = body.constraints == 0 and solid.energy(body, y, g) < body.barrier
            still = still + 1 if hardly_moves(body, y, cut) else 0
            if s.rests == 1 or free or still > STILL:
                # on a ground at rest it stands, has too little energy left to fall, or leans and does not move
                break
        if s.bonded:
            note_bond(body, y, 0.0, s)
        tau = 0.0
        many = 0
        began = out[CONTACT_EVENTS]
        seen = began
        s.close = modes.CLOSE
        while dt - tau > NO_TIME * dt:
            if forces.kind_of(s) == forces.REST:
                tau = rest_ends(body, y, s, tau, dt)
                if tau < 0:
                    break
                if s.bonded:
                    note_bond(body, y, tau, s)
                    # what is left is an ordinary contact
                    s.bonded, s.breaks[solid.BOND] = 0, s.began + tau
                    continue
                s.goes_on = 0
                standing = solid.balance(body, y, g)
                leave_rest(body, y, tau, s)
                note_loss(standing - solid.balance(body, y, g), out)
                ahead = dt
                if forces.kind_of(s) == forces.REST:
                    break
            hurries = many >= HURRY and slides_any(s)
            allowed = max(tolerance, COARSE) if hurries else tolerance
            tau, ahead, h = advance(
                body, tau, dt, ahead, y, allowed, cut, stuck, s, out
            )
            stuck = stuck + 1 if h < SHORTEST else 0
            many += 1
            changes = max(out[CONTACT_EVENTS] - began, many / STIFF)
            is_left = dt - tau > NO_TIME * dt
            if is_left and changes >= patience and solid.meets_walls_alone(body):
                note_loss(stepping.pass_interval(body, tau, dt, y, s), out)
                tau = dt
                patience = AGAIN
            if out[STEPS] > MOST_STEPS:
                s.counters[modes.UNSOLVED] += 1
                break
            if many % GIVE_UP == 0:
                s.goes_on = 0
                note_loss(give_up(body, tau, y, s), out)
                lost_track += 1
                if many > 2 * GIVE_UP:
                    break
            if out[CONTACT_EVENTS] - seen >= MANY:
                seen = out[CONTACT_EVENTS]
                s.close = min(2.0 * s.close, MOST_CLOSE)
            if stuck > STUCK:
                # nothing is consistent here: let the motion go on as it is for a moment
                tau = force_step(body, tau, dt, y, s)
                stuck = 0
            if not solid.is_known(y):
                s.counters[modes.UNSOLVED] += 1
                note_fall(y, s, (k + 1) * dt, out)
                break
            rows = algebra.rotation(y)
            note_peaks(body, y, rows, out)
            soon = peaks[min(k, last)]
            if rows[2][2] <= 0.0 or fall_is_certain(body, y, rows, soon, scale, g):
                note_fall(y, s, (k + 1) * dt, out)
                break
        if solid.is_known(y):
            note_walk(body, y, start, out)
            before = note_turn(y, before, out)
        if out[FELL] > 0 or lost_track > PATIENCE or out[STEPS] > MOST_STEPS:
            break
        if many < AGAIN:
            patience = RESTLESS
        k += 1
    if out[FELL] == 0.0:
        record(history, k, y, before, out, s)
    if solid.is_known(y):
        out[TURN] += turn_since(before, y)
    out[BEYOND] = s.beyond
    out[LEANS] = out[FELL] == 0.0 and body.constraints > 0 and is_beyond(body, y)
    for i in range(solid.HOLDERS):
        at = HELD + OF_HOLDER * i
        out[at], out[at + 1] = s.hits[i], s.impact[i]
        out[at + 2], out[at + 3] = s.force[i], s.breaks[i]
    out[ENERGY_BALANCE] = (
        solid.energy(body, y, g)
        - started
        - y[solid.WORK]
        + y[solid.FRICTION]
        + out[LOST]
    )


@kernel
def hardly_moves(body, y, cut):
    """Whether a body that walls or ties hold has less energy of motion than is followed."""
    return body.constraints > 0 and solid.kinetic_energy(body, y) < cut * body.barrier


@kernel
def begin_holding(body, y, s):
    """Let all that holds the body be whole, ties be taut or slack as they are, and no force be noted yet."""
    s.bonded = body.bonded
    rows = algebra.rotation(y)
    for i in range(solid.HOLDERS):
        s.hits[i] = s.impact[i] = s.force[i] = 0.0
        s.breaks[i] = math.nan
    for i in range(body.constraints):
        s.broken[i] = s.taut[i] = 0
        if body.ties[i]:
            _, length, rate = forces.stretch_of(body, y, rows, i)
            s.taut[i] = forces.tie_margin(body, length, rate, i) > 0.0


@kernel
def note_bond(body, y, tau, s):
    """Keep the largest tension of a side of the bond, at ``tau`` [N/kg]: at most half of what the bond holds."""
    rows = algebra.rotation(y)
    pulled = modes.bond_tension(body, rows, forces.effective_gravity_at(s.field, tau))
    s.force[solid.BOND] = max(s.force[solid.BOND], min(pulled, 0.5 * body.tension))


@kernel
def note_forces(body, y, s):
    """Keep the largest force of each wall and tie in the state y [N/kg]."""
    rows = algebra.rotation(y)
    for i in range(body.constraints):
        if not body.ties[i]:
            pressed = 0.0
            for k in range(s.count):
                at = s.closed[k]
                if at >= solid.WALLS and solid.wall_of(at) == i:
                    pressed += s.lam[k, 2]
            s.force[i] = max(s.force[i], pressed)
            continue
        if s.broken[i]:
            continue
        _, length, rate = forces.stretch_of(body, y, rows, i)
        s.force[i] = max(s.force[i], abs(forces.tie_force(body, length, rate, i)))


@kernel
def turn_ties(body, y, tau, breaks, s):
    """Let ties that have come to their other state be in it, or break those that bear all they can."""
    rows = algebra.rotation(y)
    for i in range(body.constraints):
        if not body.ties[i] or s.broken[i]:
            continue
        _, length, rate = forces.stretch_of(body, y, rows, i)
        value = forces.tie_margin(body, length, rate, i)
        if breaks:
            force = abs(forces.tie_force(body, length, rate, i))
            if force >= body.strength[i] * (1.0 - 1e-6):
                s.broken[i], s.breaks[i] = 1, s.began + tau
                s.force[i] = body.strength[i]
        elif s.taut[i] == 1 and value < 0.0:
            s.taut[i] = 0
        elif s.taut[i] == 0 and value > 0.0:
            s.taut[i] = 1
            s.hits[i] += 1.0


@kernel
def give_up(body, tau, y, s):
    """End a wobble that cannot be followed any more, which counts as a problem; return the energy lost [J/kg]."""
    before = solid.energy(body, y, s.field[forces.GRAVITY])
    s.counters[modes.UNSOLVED] += 1
    up = algebra.rotation(y)[2]
    if body.rim > 0 and algebra.norm(up[0], up[1]) < NEXT_TO_FLAT:
        y[solid.UPWARD] = y[solid.SPIN] = y[solid.SPIN + 1] = 0.0
        modes.lay_flat(body, y)
    if not modes.choose_mode(body, tau, y, s):
        modes.jam(body, y, s)
    return before - solid.energy(body, y, s.field[forces.GRAVITY])


@kernel
def force_step(body, tau, dt, y, s):
    """Take a short step whatever the margins say, which counts as a problem; return the time after it [s]."""
    h = min(FORCED, dt - tau)
    s.goes_on = 0
    forces.rates(body, tau, y, s.slopes[0], s)
    while step.attempt(body, tau, h, y, s) > COARSE * 1e-3 and h > SHORTEST:
        h *= 0.25
    for i in range(solid.SIZE):
        y[i] = s.new[i]
    algebra.normalise(y)
    s.counters[modes.UNSOLVED] += 1
    return tau + h
