"""What pure rocking assumes of its contacts: friction that suffices, and forces that push.

F2 = m2 (x2'', g + y2'') on the statue, F1 = F2 + m1 (x1'', g + y1'') on the pedestal; N and T are their components
across and along the face that carries, and impulses follow from velocities likewise.

In: a record BODY and a STATE, or velocities before and after an impact. Out: forces [N] and impulses [N s] along
the faces. Theory: ``docs/kernels.md``, "What a response asks of its contacts".
"""

import math

import numpy as np

from rockfrag.base.arrays import fields
from rockfrag.base.elementary import sin_cos
from rockfrag.engines.compile.jit import inlined_kernel, kernel
from rockfrag.engines.pure_rocking.kernels.equations import arm1, arm2, pivot, reach

DEMAND = np.dtype(fields("friction1 friction2 normal1 normal2"), align=True)
"""What a response has asked of ground and interface: largest |T|/N, infinite where N ≤ 0, and least N [N]."""


@kernel
def no_demand(demand):
    """Forget what a response has asked."""
    demand.friction1, demand.friction2 = 0.0, 0.0
    demand.normal1, demand.normal2 = math.inf, math.inf


@kernel
def add_demand(demand, other):
    """Add to one demand what another asks."""
    demand.friction1 = max(demand.friction1, other.friction1)
    demand.friction2 = max(demand.friction2, other.friction2)
    demand.normal1 = min(demand.normal1, other.normal1)
    demand.normal2 = min(demand.normal2, other.normal2)


@inlined_kernel
def _turned(arm, turn):
    """Vector ``arm`` turned clockwise by θ; ``turn``: sine and cosine of θ."""
    s, c = turn
    return arm[0] * c + arm[1] * s, arm[1] * c - arm[0] * s


@inlined_kernel
def _swung(arm, omega, alpha):
    """Acceleration [m/s²] of the tip of a vector [m] that turns clockwise about its foot at ω and α, x and y."""
    x, y = arm
    return alpha * y - omega * omega * x, -alpha * x - omega * omega * y


@inlined_kernel
def _fraction(normal, shear):
    """Coefficient of friction that a force asks for, |shear| over normal [-]; infinite where it pulls."""
    return abs(shear) / normal if normal > 0.0 else math.inf


@inlined_kernel
def _components(body, turn1, force):
    """Normal and shear force of the ground, then of the interface, in the unit of ``force``.

    ``turn1``: sine and cosine of θ1; ``force``: x and y of the force on the statue, and of that on both blocks.
    """
    (x2, y2), (x1, y1) = force
    tx, ty = _turned((body.ex, body.ey), turn1)
    return y1, x1, -ty * x2 + tx * y2, tx * x2 + ty * y2


@kernel
def forces(body, state, alpha1, alpha2):
    """Normal and shear force of the ground, then of the interface [N], in a state with θ1'' and θ2'' [rad/s²].

    They follow from the accelerations of the centres of gravity by the equations at the head of the module.
    """
    turn1, turn2 = sin_cos(state.theta1), sin_cos(state.theta2)
    s1, s2 = pivot(state.c1), pivot(state.c2)
    # accelerations relative to the ground: centre of the pedestal, pivot of the statue, and its centre about that
    first = _swung(_turned(arm1(body, s1), turn1), state.omega1, alpha1)
    foot = _swung(_turned(reach(body, s1, s2), turn1), state.omega1, alpha1)
    two = _swung(_turned(arm2(body, s2), turn2), state.omega2, alpha2)
    x2 = body.m2 * (state.ground + foot[0] + two[0])
    y2 = body.m2 * (state.gravity + foot[1] + two[1])
    x1 = x2 + body.m1 * (state.ground + first[0])
    y1 = y2 + body.m1 * (state.gravity + first[1])
    return _components(body, turn1, ((x2, y2), (x1, y1)))


@inlined_kernel
def _velocities(body, state, turn1, turn2):
    """Velocities of both centres of gravity [m/s]: x and y of the pedestal's, x and y of the statue's.

    ``turn1``, ``turn2``: sine and cosine of θ1 and θ2.
    """
    s1, s2 = pivot(state.c1), pivot(state.c2)
    x1, y1 = _turned(arm1(body, s1), turn1)
    xd, yd = _turned(reach(body, s1, s2), turn1)
    x2, y2 = _turned(arm2(body, s2), turn2)
    w1, w2 = state.omega1, state.omega2
    return w1 * y1, -w1 * x1, w1 * yd + w2 * y2, -w1 * xd - w2 * x2


@kernel
def ask_forces(body, state, alpha1, alpha2, demand):
    """Add to a record DEMAND what the forces of a state ask; ``alpha1``, ``alpha2``: θ1'' and θ2'' [rad/s²].

    Returned is the least normal force over both interfaces [N].
    """
    n1, t1, n2, t2 = forces(body, state, alpha1, alpha2)
    demand.friction2 = max(demand.friction2, _fraction(n2, t2))
    demand.normal2 = min(demand.normal2, n2)
    if body.fixed:
        return n2
    demand.friction1 = max(demand.friction1, _fraction(n1, t1))
    demand.normal1 = min(demand.normal1, n1)
    return min(n1, n2)


@kernel
def ask_impulses(body, before, after, demand):
    """Add to a record DEMAND the friction that an impact asks; ``before``, ``after``: records STATE.

    The impulse of a contact is what the momentum of all above it has grown by.
    """
    turn1, turn2 = sin_cos(after.theta1), sin_cos(after.theta2)
    u1x, u1y, u2x, u2y = _velocities(body, before, turn1, turn2)
    v1x, v1y, v2x, v2y = _velocities(body, after, turn1, turn2)
    # impulses of the interface and of the ground [N s]
    x2, y2 = body.m2 * (v2x - u2x), body.m2 * (v2y - u2y)
    x1, y1 = x2 + body.m1 * (v1x - u1x), y2 + body.m1 * (v1y - u1y)
    n1, t1, n2, t2 = _components(body, turn1, ((x2, y2), (x1, y1)))
    # what rounding leaves of the velocities asks nothing
    speed = abs(u1x) + abs(u1y) + abs(u2x) + abs(u2y)
    if abs(n2) + abs(t2) > 1e-9 * body.m2 * speed:
        demand.friction2 = max(demand.friction2, _fraction(n2, t2))
    if not body.fixed and abs(n1) + abs(t1) > 1e-9 * (body.m1 + body.m2) * speed:
        demand.friction1 = max(demand.friction1, _fraction(n1, t1))
