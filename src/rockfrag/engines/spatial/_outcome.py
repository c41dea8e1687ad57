"""Outcomes and history of an analysis: where its numbers stand, and how they are noted.

In: states as an analysis passes them. Out: ``out``, shape (OUTCOME,), whose places are named here, and a row of a
history, shape (COLUMNS,). Theory: ``docs/space.md``, "Steps".

Names (``_body`` explains the state and the numbers of contacts):

- ``body``, ``s``: records ``BODY`` and ``CASE``; ``y``: the state, shape (15,)
- ``rows``: the world's axes as the body sees them, ``rows[2]`` the upward one
"""

from rockfrag.base.elementary import atan2
from rockfrag.engines.algebra import vectors as algebra
from rockfrag.engines.compile.jit import kernel
from rockfrag.engines.spatial import _body as solid
from rockfrag.engines.spatial import _limits as limits

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
def note_peaks(body, y, rows, out):
    """Keep the largest tilt and speed."""
    up = rows[2]
    sine = algebra.norm(up[0], up[1])
    if sine > limits.FLAT:
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
def note_loss(loss, out):
    """Add energy lost at once [J/kg]; what is gained is a defect, of which the whole is kept."""
    out[LOST] += loss
    out[GAINED] += max(-loss, 0.0)


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
