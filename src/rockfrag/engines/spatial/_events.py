"""Contact events: where in a step one happens, and what it does.

In: a step whose end is beyond an event. Out: the instant of the event [s] and the state after it. Theory:
``docs/space.md``, "Steps" and "Friction and impacts".

Names (``_body`` explains the state and the numbers of contacts):

- ``body``, ``s``: records ``BODY`` and ``CASE``; ``y``: the state, shape (15,)
- ``rows``: the world's axes as the body sees them, ``rows[2]`` the upward one
- ``tau``: time in an interval, ``h`` a step [s]; ``gravity``: effective gravity, equation 1, in the world [m/s²]
- ``cut``: energy over rest at which a body rests, over that which a fall takes (``body.barrier``) [-]
"""

import math

from rockfrag.engines.algebra import vectors as algebra
from rockfrag.engines.compile.jit import kernel
from rockfrag.engines.pure_rocking.kernels.roots import narrowed
from rockfrag.engines.spatial import _body as solid
from rockfrag.engines.spatial import _case as case
from rockfrag.engines.spatial import _contacts as contacts
from rockfrag.engines.spatial import _delassus as delassus
from rockfrag.engines.spatial import _face as face
from rockfrag.engines.spatial import _forces as forces
from rockfrag.engines.spatial import _gaps as gaps
from rockfrag.engines.spatial import _hinge as hinge
from rockfrag.engines.spatial import _holders as holders
from rockfrag.engines.spatial import _impacts as impacts
from rockfrag.engines.spatial import _limits as limits
from rockfrag.engines.spatial import _modes as modes
from rockfrag.engines.spatial import _outcome as outcome
from rockfrag.engines.spatial import _points as points
from rockfrag.engines.spatial import _problem as problem
from rockfrag.engines.spatial import _rest as rest
from rockfrag.engines.spatial import _rim as rim
from rockfrag.engines.spatial import _step as step

# how many contacts take part in an impact at least: in a landing, and in one that no collision brings about
LANDING, NO_COLLISION = 0, 1
# margins at which an instant is known: of gaps [m]; of forces [N/kg] and slips [m/s], which is less than what is
# not seen of forces (LEAST_FORCE), and 1e-5 of the slip that counts as ended (AT_REST)
CLOSED, UNSEEN = 1e-12, 1e-9
# steps of no length in a row after which one contact is changed outright
SOON_STUCK = 3
# time in which rates stay: its square times an acceleration is less than TOUCH [s]
BRIEF = 1e-6
# energy over rest, as a part of what a fall takes, below which a rattle is not followed that ends before the
# ground could lift the body
RATTLE = 1e-3


@kernel
def locate(body, tau, h, y, s):
    """Find the first instant in a step h at which a margin vanishes; return it, from the beginning [s], and which.

    s.new gets the state there. False position (Illinois) between the last instant that is admissible and the first
    that is not takes whole steps from y, where both margins are of one kind; else the bracket is halved. A landing
    begins with :func:`guess_landing` and ends with a step of Newton's.
    """
    below, what = step.margin(body, s.new, s)
    middle = guess_landing(body, h, y, below, s) if what == limits.LANDS else 0.0
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
        if what == limits.LANDS and what_below == limits.LANDS:
            rate = rim.rising(body, s.new, lowest_open(body, s.new, s))
        if rate < 0.0:
            # a last step of Newton's, so short that the rates at its beginning suffice
            rest = -value / rate
            middle = at + rest
            if abs(rest) < BRIEF and low < at + rest < high:
                step.go_on_by(body, at, rest, tau, y, s)
                return at + rest, what
        bracket = narrowed(bracket, at, value)
        is_gap = what in (limits.LANDS, limits.TIE_TURNS, limits.TIE_BREAKS)
        if abs(value) < (CLOSED if is_gap else UNSEEN):
            return at, what
        if bracket[2] - bracket[0] < 1e-14:
            break
    step.attempt(body, tau, bracket[2], y, s)
    _, what = step.margin(body, s.new, s)
    return bracket[2], what


@kernel
def guess_landing(body, h, y, below, s):
    """Time in a step [s] at which the point lands that is lowest after it; its gap is ``below``, negative [m].

    It is the last zero of the cubic through gaps and velocities at both ends, above + fall x + square x² + cube
    x³, x the part of the step (``docs/space.md``, equation 23), by Newton's method; about an edge then that of
    the series of the angle.
    """
    i = lowest_open(body, s.new, s)
    above, fall = (
        solid.gap_of(body, y, algebra.rotation(y), i),
        h * rim.rising(body, y, i),
    )
    end = h * rim.rising(body, s.new, i)
    square = 3.0 * (below - above) - 2.0 * fall - end
    cube = 2.0 * (above - below) + fall + end
    # the last time that it comes down, also where it has only just gone up
    part = 1.0 if end < 0.0 else above / (above - below)
    for _ in range(5):
        value = above + part * (fall + part * (square + part * cube))
        part -= value / (fall + part * (2.0 * square + part * 3.0 * cube))
    if step.kind_of_step(body, s) == case.HINGE:
        part = hinge.landing(body, y, i, part, 0.5 * limits.TOUCH, s)
    return h * part


@kernel
def lowest_open(body, y, s):
    """Number of the open contact that is nearest to the ground or its wall, at a wall of those that approach."""
    rows = algebra.rotation(y)
    lowest, found = limits.NO_LIMIT, 0
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
def happen(body, what, tau, y, cut, stuck, s):
    """Change velocities and mode by what ended a step; return the energy lost [J/kg].

    ``what`` is one of modes.LANDS and those behind it, and y the state then. First it takes effect, then the mode
    that goes on is chosen. ``stuck`` is how many steps in a row had hardly any length: then one contact is changed
    outright.
    """
    gravity = case.effective_gravity_at(s.field, tau)
    before = solid.balance(body, y, s.field[case.GRAVITY])
    if what == limits.LANDS:
        land(body, y, gravity, cut, s)
    elif what == limits.SLIP_ENDS:
        stop_slips(body, y, s)
    elif what == limits.TIE_TURNS:
        holders.turn_ties(body, y, tau, False, s)
    elif what == limits.TIE_BREAKS:
        holders.turn_ties(body, y, tau, True, s)
    if what == limits.OPENS and body.rim > 0 and s.count >= 3:
        # the centre of pressure has come to the rim, over which the face tips as it slides
        towards_x, towards_y = face.pressure_centre(body, s)
        rim.tip_over_rim(body, y, towards_x, towards_y, case.SLIDES, gravity, s)
    elif stuck > SOON_STUCK and what in (limits.OPENS, limits.LEAVES_CONE):
        contacts.insist(body, what, s)
    elif case.kind_of(s) != case.REST:
        follow(body, tau, y, gravity, s)
    rim.rim_instead_of_feet(body, y, gravity, s)
    return before - solid.balance(body, y, s.field[case.GRAVITY])


@kernel
def land(body, y, gravity, cut, s):
    """Solve the impact of a landing; let the body rest if little energy is left and the ground carries it."""
    impacts.impact(body, y, gravity, LANDING, s)
    rows = algebra.rotation(y)
    if body.rim == 0.0 and points.count_touching(body, y, rows) >= 3:
        # the points that open begin with no gap, not with one of rounding; what comes down by that lands as well
        gaps.lay_flat(body, y)
        if problem.is_approached(body, y, s):
            impacts.impact(body, y, gravity, LANDING, s)
    left = solid.energy(body, y, s.field[case.GRAVITY])
    carried = (
        outcome.stands_within_balance(body, rows)
        and rest.rest_margin(body, y, rows, gravity, s) >= 0
    )
    if carried and (left < cut * body.barrier or rattle_ends(body, left, s)):
        gaps.come_to_rest(body, y, s)


@kernel
def follow(body, tau, y, gravity, s):
    """Choose the mode that follows; where contact forces do not exist (Painlevé), after an impact, or jammed.

    What slides has an impact without a collision; if there is no mode after it either, what is closed sticks.
    """
    if modes.choose_mode(body, tau, y, s):
        return
    s.counters[limits.JAMS] += 1
    free = slides_any(s)
    if free:
        impacts.impact(body, y, gravity, NO_COLLISION, s)
        free = modes.choose_mode(body, tau, y, s)
    if not free:
        contacts.jam(body, y, s)


@kernel
def stop_slips(body, y, s):
    """Let points whose slip has ended stick, before the mode is chosen anew, and stop what is left of it.

    Slip ends at AT_REST; of several points the others stick too where theirs is below twice that.
    """
    rows = algebra.rotation(y)
    for i in range(s.count):
        if s.slides[i] == case.SLIDES:
            u = delassus.slip_of(body, y, rows, i, s)
            slow = algebra.norm(u[0], u[1]) < 2 * limits.AT_REST
            if slow and not solid.is_smooth(body, s.closed[i]):
                s.slides[i] = case.STICKS
    contacts.hold(body, y, rows, s)


@kernel
def slides_any(s):
    """Whether any closed point slides."""
    found = False
    for i in range(s.count):
        found = found or s.slides[i] == case.SLIDES
    return found


@kernel
def rattle_ends(body, left, s):
    """Whether a polygon with so much energy left [J/kg] rattles to rest before the ground could lift it.

    A rattle lasts as long as equation 19 (``docs/space.md``) says, with what the strongest ground of the next
    intervals, s.soon, leaves of the moment that rights the body. That ground may neither tip it nor make it slide.
    """
    if body.rim > 0.0 or left > RATTLE * body.barrier:
        return False
    weight = s.field[case.GRAVITY] - s.soon[1]
    rights = weight * body.nearest - s.soon[0] * body.height
    if rights <= 0.0 or s.soon[0] >= body.static * weight:
        return False
    square = body.nearest * body.nearest
    inertia = max(body.inertia[0, 0], body.inertia[1, 1])
    inertia += body.height * body.height + body.furthest * body.furthest
    lasts = math.sqrt(2.0 * left * inertia) * inertia / (rights * square)
    return lasts <= s.soon[2]
