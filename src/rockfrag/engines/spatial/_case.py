"""What an analysis of a body in space works in: its record, and the mode, which points are closed and how.

In: numbers of contacts. Out: the record ``CASE``, and what it says of the mode. Theory: ``docs/space.md``.
"""

import numpy as np

from rockfrag.base.arrays import fields, whole
from rockfrag.engines.compile.jit import kernel
from rockfrag.engines.spatial import _body as solid

MOST = 4  # contacts that carry at once
MOST_NEAR = 16  # contacts that a step of time stepping looks at
STICKS, SLIDES = 0, 1
# kinds of a mode: nothing closed; one contact that sticks; two; any other; at rest; one contact that slides
FLIGHT, PIVOT, HINGE, GENERAL, REST, SLIDER = 0, 1, 2, 3, 4, 5
# place of the gravity on ground at rest [m/s²] in s.field, behind the effective one and its rate
GRAVITY = 6
STAGES = 7
# of the series of an angle in a step
HINGE_ORDER = 7
# numbers that are integrated of a body on one contact that sticks: attitude and angular velocity, on which rates
# depend; and what follows along the step, the place in the plan and the work
TURNING, ALONG = 7, 3

CASE = np.dtype(
    [
        # the mode: number of closed points; whether the body rests; whether what is closed sticks whatever its
        # cone says (jammed); whether the rates at the end of the last step are those at the beginning of the next
        *whole("count rests jammed goes_on"),
        # numbers of the closed points, and which of them slide ...
        *whole("closed slides", MOST),
        *fields("direction anchor", MOST, 2),  # ... and where to, or where they stick
        *fields(
            "lam", MOST, 3
        ),  # contact forces or impulses, along each contact and across it
        # effective gravity at the beginning of the interval [m/s²], its rate [m/s³], and at GRAVITY that of a
        # ground at rest
        *fields("field", 7),
        # a small system of contacts that touch: their numbers (which); whether a contact slides along a unit
        # vector (given, way); whether it slipped before an impact, and where to (slid, came)
        *whole("which given slid", MOST),
        *fields("way came", MOST, 2),
        # velocities (or accelerations) of contacts but for the body's rotation, in the body
        *fields("load", MOST, 3),
        # coefficients of friction of a contact: kinetic (friction), static (holds), the one it is tried with
        # (grip), and that of the best set; unit vectors along the surface from contact to contact (edge)
        *fields("friction holds grip best_grip", MOST),
        *fields("edge", MOST, MOST, 2),
        # W of equation 10; velocities without impulses b (free), impulses P, velocities after them W P + b
        # (after), all along and away from each contact; the rest is memory of what solves for them
        *fields("delassus matrix", 3 * MOST, 3 * MOST),
        *fields("free vector right unknown impulse after best trial kept", 3 * MOST),
        *whole("order", 3 * MOST),
        *whole("member", MOST),  # contacts of a set
        # a step: rates at its stages, the state at its end, slip at its beginning
        *fields("slopes", STAGES, solid.SIZE),
        *fields("new", solid.SIZE),
        # rates of a body that turns about one contact, at the beginning and at the end of a step
        *fields("turning", 2, TURNING + ALONG),
        # series of the angle of a body that rocks about an edge, and of its sine and cosine
        *fields("angle sine cosine", HINGE_ORDER + 1),
        *fields("slip", MOST, 2),
        *whole("armed", MOST),
        *whole("counters", 8),
        # largest horizontal and vertical acceleration of the ground soon [m/s²], and how long that is [s]
        *fields("soon", 3),
        # largest impulse of an impact along the ground beyond friction, for a unit of mass [m/s]
        *fields("beyond"),
        # how soft contacts are along their surface, over the softness of all, and of each unknown
        *fields("yields", MOST),
        *fields("softness", 3 * MOST),
        # velocity after an impact below which a point that touches stays closed [m/s]
        *fields("close"),
        # force and moment of the ties, in the body, for a unit of mass [N/kg, N m/kg]
        *fields("pulled twisted", 3),
        # whether a bond is whole; of each constraint whether it has broken, and whether a tie is taut; how often
        # it was hit, the largest impulse and force for a unit of mass, and when it broke [s]
        # time at the beginning of an interval [s]
        *whole("bonded"),
        *fields("began"),
        *whole("broken taut", solid.MOST_CONSTRAINTS),
        *fields("hits impact force breaks", solid.HOLDERS),
        # contacts near ground and walls in time stepping, their numbers (near); how fast each may close in the
        # step (closes) [m/s]; its coefficient of friction (rubs); displacement away from its surface by which it
        # was put in place, as an impulse (moved) [m]; what a unit impulse along each of its axes gives to its
        # velocity along the same axis (gives) [-]; its impulse for a unit of mass (shove) [m/s]
        *whole("near", MOST_NEAR),
        *fields("closes rubs moved", MOST_NEAR),
        *fields("gives shove", MOST_NEAR, 3),
    ],
    align=True,
)
"""What an analysis changes in place; its record goes through all kernels."""


@kernel
def picks_wall(n, s):
    """Whether one of the n contacts of the small system, s.which, is of a corner with a wall."""
    found = False
    for k in range(n):
        found = found or s.which[k] >= solid.WALLS
    return found


@kernel
def at_wall(s):
    """Whether a closed point is a corner at a wall."""
    found = False
    for k in range(s.count):
        found = found or s.closed[k] >= solid.WALLS
    return found


@kernel
def kind_of(s):
    """Kind of a mode: REST, FLIGHT, PIVOT, SLIDER, HINGE or GENERAL, which is all that touches a wall too."""
    n = s.count
    if s.rests:
        return REST
    if n == 0:
        return FLIGHT
    if at_wall(s):
        return GENERAL
    if n == 1:
        return PIVOT if s.slides[0] == STICKS else SLIDER
    if n == 2 and s.slides[0] == STICKS and s.slides[1] == STICKS:
        return HINGE
    return GENERAL


@kernel
def effective_gravity_at(field, tau):
    """Effective gravity in the world [m/s²] at the time tau in an interval [s]; ``field`` as in CASE."""
    return (
        field[0] + field[3] * tau,
        field[1] + field[4] * tau,
        field[2] + field[5] * tau,
    )


@kernel
def in_set(mask, i):
    """Whether (1 or 0) contact i belongs to a set, whose contacts are bits of the mask."""
    return (mask >> i) & 1
