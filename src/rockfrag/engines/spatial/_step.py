"""One step of Dormand and Prince's pair of order 5 (1980), and what must not become negative in it.

In: a state and a mode. Out: the state at the end of a step, its error, and the first zero of what must stay
positive. Theory: ``docs/space.md``, "Steps", and equation 23.

- ``y``: the state at the beginning, ``s.new``: that at the end; ``tau``: time in the interval, ``h``: the step [s]
- ``s.slopes``: rates at the stages of the step, (STAGES, 15); ``rows``: the world's axes as the body sees them
- margins are gaps [m], normal forces and what cones leave [N/kg], or slips [m/s]: the sign of the least counts,
  which is negative if any is
"""

from rockfrag.engines.algebra.vectors import cross, dot, norm, normalise, rotation
from rockfrag.engines.compile.jit import kernel
from rockfrag.engines.pure_rocking.kernels.dormand_prince import (
    INSTANTS,
    WEIGHTS,
    error_rate,
)
from rockfrag.engines.spatial import _body as solid
from rockfrag.engines.spatial import _case as case
from rockfrag.engines.spatial import _face as face
from rockfrag.engines.spatial import _hinge as hinge
from rockfrag.engines.spatial import _limits as limits
from rockfrag.engines.spatial import _pivot as pivot
from rockfrag.engines.spatial._case import (
    SLIDES,
    STAGES,
    at_wall,
)
from rockfrag.engines.spatial._cone import cones_hold
from rockfrag.engines.spatial._delassus import slip_of
from rockfrag.engines.spatial._forces import rates
from rockfrag.engines.spatial._relax import relax, stops
from rockfrag.engines.spatial._ties import (
    stretch_of,
    tie_force,
    tie_margin,
)

# velocity away from its surface below which an open contact approaches it, and not by rounding alone [m/s]
DOWN = -1e-10
ON_EDGE = 1e-12  # distance of the centre of pressure from the edge of a face that is rounding [m]
# part of a step, times the change of velocity in it, by which a point may dip below the parabola of its velocities
DEEPER = 0.02
BACKWARD = 1e-8  # slip against its own direction that is rounding [m/s]
NEAR_FLAT = 1e-6  # tilt below which a rim that rolls goes on to roll [rad]
# over the weight that a contact may pull, or shear beyond its cone, unseen [-]
LEAST_FORCE = 1e-9
# acceleration, over gravity, to which forces that are spread anew hold what sticks [-]
SPREAD = 1e-8


@kernel
def kind_of_step(body, s):
    """PIVOT or HINGE, modes with a step of their own if no wall or tie holds the body, or else GENERAL."""
    kind = case.kind_of(s)
    own = kind in (case.PIVOT, case.HINGE) and body.constraints == 0
    return kind if own else case.GENERAL


@kernel
def begin(body, tau, y, s):
    """Fill in the rates at the beginning of a step, unless they are those at the end of the last (s.goes_on)."""
    kind = kind_of_step(body, s)
    if kind == case.PIVOT:
        if s.goes_on:
            pivot.go_on(s)
        else:
            pivot.begin(body, tau, y, s)
    elif kind == case.GENERAL:
        if s.goes_on:
            for i in range(solid.SIZE):
                s.slopes[0, i] = s.slopes[STAGES - 1, i]
        else:
            rates(body, tau, y, s.slopes[0], s)
        begin_slips(body, y, s)
    s.goes_on = 0


@kernel
def attempt(body, tau, h, y, s):
    """Step from y to s.new, with the forces in s.lam at its end; return the estimate of the error.

    The error is the largest of the components, over their size [m, -, m/s, rad/s].
    """
    kind = kind_of_step(body, s)
    if kind == case.PIVOT:
        return pivot.attempt(body, tau, h, y, s)
    if kind == case.HINGE:
        return hinge.attempt(body, tau, h, y, s)
    return attempt_any(body, tau, h, y, s)


@kernel
def go_on_by(body, at, rest, tau, y, s):
    """Go on from s.new, the state at ``at`` after ``tau`` [s], by a time ``rest`` of either sign.

    It is so short that the rates at the end of the step to ``at`` suffice; about an edge the step is taken anew.
    """
    kind = kind_of_step(body, s)
    if kind == case.PIVOT:
        pivot.go_on_by(body, tau + at + rest, rest, y, s)
        return
    if kind == case.HINGE:
        attempt(body, tau, at + rest, y, s)
        return
    for i in range(solid.SIZE):
        s.new[i] += rest * s.slopes[STAGES - 1, i]
    normalise(s.new)


@kernel
def attempt_any(body, tau, h, y, s):
    """Step from y to s.new in any mode, with s.slopes, and the forces at its end in s.lam; return the error."""
    k, new = s.slopes, s.new
    for stage in range(1, STAGES):
        for i in range(solid.SIZE):
            new[i] = WEIGHTS[stage, 0] * k[0, i]
        for early in range(1, stage):
            weight = WEIGHTS[stage, early]
            if weight != 0.0:
                for i in range(solid.SIZE):
                    new[i] += weight * k[early, i]
        for i in range(solid.SIZE):
            new[i] = y[i] + h * new[i]
        if stage == STAGES - 1:
            normalise(new)
        rates(body, tau + INSTANTS[stage] * h, new, k[stage], s)
    return error_of(body, h, y, s)


@kernel
def error_of(body, h, y, s):
    """Largest component of the difference to the step of order 4, over its size."""
    worst, weight = 0.0, solid.weight_of_attitude(body, rotation(y)[2])
    for i in range(solid.WORK):
        scale = weight if solid.ATTITUDE <= i < solid.VELOCITY else 1.0 + abs(y[i])
        worst = max(worst, abs(h * error_rate(s.slopes, i)) / scale)
    return worst


@kernel
def slip_along(body, y, rows, i, s):
    """Slip of the i-th closed contact along its own direction of slip at the step's beginning, s.slip[i] [m/s].

    It is negative once the contact slips back.
    """
    u = slip_of(body, y, rows, i, s)
    return u[0] * s.slip[i, 0] + u[1] * s.slip[i, 1]


@kernel
def is_closed(s, i):
    """Whether the contact of number i is closed in the mode."""
    found = False
    for k in range(s.count):
        found = found or s.closed[k] == i
    return found


@kernel
def closed_on_ground(s):
    """Set of the closed contacts with the ground, as bits."""
    closed = 0
    for k in range(s.count):
        if s.closed[k] < solid.WALLS:
            closed |= 1 << s.closed[k]
    return closed


@kernel
def begin_slips(body, y, s):
    """Fill s.slip with each sliding point's direction, and s.armed with whether its slip may end in the step.

    It may if it is faster than twice the velocity at which slip ends.
    """
    rows = rotation(y)
    for i in range(s.count):
        s.armed[i] = 0
        if s.slides[i] == SLIDES:
            u = slip_of(body, y, rows, i, s)
            speed = norm(u[0], u[1])
            s.slip[i, 0], s.slip[i, 1] = s.direction[i, 0], s.direction[i, 1]
            if speed > 2 * limits.AT_REST:
                s.slip[i, 0], s.slip[i, 1] = u[0] / speed, u[1] / speed
                s.direction[i, 0], s.direction[i, 1] = s.slip[i, 0], s.slip[i, 1]
                s.armed[i] = 1


@kernel
def face_slip(body, y, rows, s):
    """Margin of slip of a face [m/s]: by how much its fastest point is above the velocity at which slip ends.

    Of one whose slip cannot end, as it has not begun to, it is by how much the fastest point slips forwards.
    """
    fastest, forwards, armed = 0.0, -1.0, 0
    for i in range(s.count):
        u = slip_of(body, y, rows, i, s)
        fastest = max(fastest, norm(u[0], u[1]))
        forwards = max(forwards, slip_along(body, y, rows, i, s))
        armed = max(armed, s.armed[i])
    return fastest - limits.AT_REST if armed else forwards + BACKWARD


@kernel
def slides_flat(s):
    """Whether a body slides on its face: three or more points of the ground are closed, and slide."""
    found = s.count >= 3 and not at_wall(s)
    for i in range(s.count):
        found = found and s.slides[i] == SLIDES
    return found


@kernel
def margin(body, y, s):
    """Return the least of all that must not be negative in the state y, and what happens where it is.

    Gaps [m], normal forces and cones [N/kg] and slips [m/s] are looked at together: where the least is negative,
    the step has gone too far, whatever its unit. An instant is looked for between margins of one kind.
    """
    rows = rotation(y)
    least = ground_margin(body, y, rows, s)
    if body.walls:
        least = lesser(least, walls_margin(body, y, rows, s))
    if slides_flat(s):
        # without a wall a body on its face meets nothing
        tips = face_margin(body, s)
        least = lesser(least, tips) if body.walls else tips
        slip = face_slip(body, y, rows, s)
        least = lesser(least, (slip, limits.SLIP_ENDS))
    else:
        least = lesser(least, contacts_margin(body, y, rows, s))
    if body.constraints > 0:
        least = lesser(least, ties_margin(body, y, rows, s))
    return least


@kernel
def lesser(first, other):
    """Return the lesser of two margins, each with what it belongs to; the first if the other is no number."""
    return other if other[0] < first[0] else first


@kernel
def ground_margin(body, y, rows, s):
    """Least gap of the open points of the base, from half of TOUCH below the ground on [m].

    A point that is next to touch, but does not come down, has just parted: it is left alone until it is further
    below.
    """
    least = limits.NO_LIMIT
    closed = closed_on_ground(s)
    turns = cross(rows[2], solid.omega_of(y))
    for i in solid.candidates(body):
        if not case.in_set(closed, i):
            p = solid.arm(body, rows[2], i)
            value = y[solid.HEIGHT] + dot(rows[2], p) + 0.5 * limits.TOUCH
            if (
                value < 0.5 * limits.TOUCH
                and not y[solid.UPWARD] + dot(turns, p) < DOWN
            ):
                value += limits.TOUCH
            least = min(least, value)
    return least, limits.LANDS


@kernel
def walls_margin(body, y, rows, s):
    """Least gap of the open corners from their walls [m], as :func:`ground_margin`."""
    least = limits.NO_LIMIT
    for i in solid.wall_candidates(body):
        if not solid.may_meet(body, i) or is_closed(s, i):
            continue
        value = solid.gap_of(body, y, rows, i) + 0.5 * limits.TOUCH
        meets = solid.approach_of(body, y, rows, i) < DOWN
        if value < 0.5 * limits.TOUCH and not meets:
            # what lies a little behind a wall, by the errors of steps, is pushed out as soon as it moves on
            value = max(value + limits.TOUCH, 0.5 * limits.TOUCH)
        least = min(least, value)
    return least, limits.LANDS


@kernel
def face_margin(body, s):
    """Distance of the centre of pressure of a face that slides from its edge [m], over which it tips."""
    return face.pressure_margin(body, s) + ON_EDGE, limits.OPENS


@kernel
def contacts_margin(body, y, rows, s):
    """Least margin of the closed contacts, and what happens where it is negative.

    A contact opens where its normal force vanishes, slides where its shear reaches its cone [N/kg], and sticks
    where its slip ends [m/s]. Slip that has not begun yet, which is not armed, may only go forwards.
    """
    small = LEAST_FORCE * s.field[case.GRAVITY]
    # a rim that passes near flat is pushed as by an impact, of which the cone is not asked
    passes = body.rim > 0 and norm(rows[2][0], rows[2][1]) < NEAR_FLAT
    if at_wall(s) and s.count >= 3 and not s.jammed:
        spread_load(s)
    least = (limits.NO_LIMIT, limits.NOTHING)
    for i in range(s.count):
        least = lesser(least, (s.lam[i, 2] + small, limits.OPENS))
        if solid.is_smooth(body, s.closed[i]):
            continue
        if s.slides[i] == SLIDES:
            off = -limits.AT_REST if s.armed[i] else BACKWARD
            slip = slip_along(body, y, rows, i, s) + off
            least = lesser(least, (slip, limits.SLIP_ENDS))
        elif not (s.jammed or passes):
            grip = solid.static_of(body, s.closed[i]) * s.lam[i, 2]
            left = grip - norm(s.lam[i, 0], s.lam[i, 1]) + small
            least = lesser(least, (left, limits.LEAVES_CONE))
    return least


@kernel
def spread_load(s):
    """Spread anew what closed contacts hold together, if that lies outside a cone and need not; fill s.lam.

    The system is the one that :func:`_forces.solve_general` solved last, whose motion is the same however it is
    spread.
    """
    n, small = s.count, SPREAD * s.field[case.GRAVITY]
    for i in range(n):
        s.grip[i] = s.holds[i]
    if cones_hold(s, n, (1 << n) - 1, 0.0):
        return
    if relax(s, n, small) and stops(s, n, small):
        for i in range(n):
            for k in range(3):
                s.lam[i, k] = s.impulse[3 * i + k]


@kernel
def ties_margin(body, y, rows, s):
    """Least margin of the ties that have not broken [m], and whether that one breaks, or turns taut or slack."""
    least, what = limits.NO_LIMIT, limits.NOTHING
    for i in range(body.constraints):
        if not body.ties[i] or s.broken[i]:
            continue
        _, length, rate = stretch_of(body, y, rows, i)
        value = tie_margin(body, length, rate, i)
        value = 0.5 * limits.TOUCH + (value if s.taut[i] else -value)
        if value < least:
            least, what = value, limits.TIE_TURNS
        force = abs(tie_force(body, length, rate, i))
        value = (body.strength[i] - force) / body.stiffness[i]
        if value < least:
            least, what = value, limits.TIE_BREAKS
    return least, what


@kernel
def dips(body, y, h, s):
    """Whether a contact that is open at both ends of a step of h may have touched inside it."""
    if body.rim > 0 and not body.walls and is_closed(s, body.count):
        # no other point of a rim may touch
        return False
    new = s.new
    before, after = rotation(y), rotation(new)
    turns, turns_then = (
        cross(before[2], solid.omega_of(y)),
        cross(after[2], solid.omega_of(new)),
    )
    closed = closed_on_ground(s)
    for i in solid.candidates(body):
        if not case.in_set(closed, i):
            p = solid.arm(body, before[2], i)
            sinking = y[solid.UPWARD] + dot(turns, p)
            rising = new[solid.UPWARD] + dot(turns_then, solid.arm(body, after[2], i))
            if touches_between(y[solid.HEIGHT] + dot(before[2], p), sinking, rising, h):
                return True
    for i in solid.wall_candidates(body):
        if solid.may_meet(body, i) and not is_closed(s, i):
            sinking = solid.approach_of(body, y, before, i)
            rising = solid.approach_of(body, new, after, i)
            gap = solid.gap_of(body, y, before, i)
            if touches_between(gap, sinking, rising, h):
                return True
    return False


@kernel
def touches_between(gap, sinking, rising, h):
    """Whether a point may have touched inside a step of h that sinks at its beginning and rises at its end [m/s].

    ``gap`` is that at the beginning [m]. Its least is that of the parabola of both velocities, less what it may
    differ by (``docs/space.md``, equation 23).
    """
    if not sinking < 0 < rising:
        return False
    lowest = gap - 0.5 * h * sinking**2 / (rising - sinking)
    return lowest - DEEPER * h * (rising - sinking) < -0.5 * limits.TOUCH
