"""The contact states of a body, and what leads from one to the next (tables in ``docs/kernels.md``).

A full contact pushes and never pulls.  States are tried from all contacts closed to all open, and the first
consistent one is taken, so that every transition that the mechanics allows occurs.

In: a record BODY and a STATE. Out: the contact state (c1, c2) that follows.
"""

import math

from rockfrag.engines.compile.jit import kernel
from rockfrag.engines.pure_rocking.kernels import equations as model
from rockfrag.engines.pure_rocking.kernels.equations import GROUND, INTERFACE

HALF_TURN = 0.5 * math.pi  # a block that has turned so far lies down [rad]


@kernel
def side_of(value):
    """Return +1, -1 or 0: the pivot on which a contact with this opening rocks."""
    return (1 if value > 0.0 else 0) - (1 if value < 0.0 else 0)


@kernel
def first_contacts(state):
    """Contact states (c1, c2) at the start: contacts with an angle, or a rate, are open to that side."""
    c1 = side_of(state.theta1) or side_of(state.omega1)
    return c1, side_of(state.theta2 - state.theta1) or side_of(
        state.omega2 - state.omega1
    )


@kernel
def at_rest(state, ground, gravity):
    """Put a STATE at rest under an acceleration of the ground and a gravity [m/s²]."""
    state.c1, state.c2, state.ground, state.gravity = 0, 0, ground, gravity
    state.theta1, state.omega1, state.theta2, state.omega2 = 0.0, 0.0, 0.0, 0.0


@kernel
def rest_interval(body, scratch):
    """Lowest and highest acceleration of the ground under which a body rests [m/s²] (Psycharis, 1990).

    Both are in proportion to gravity; ``scratch`` is a STATE.
    """
    low = -math.inf
    high = math.inf
    for contact in (GROUND, INTERFACE):
        if contact == GROUND and body.fixed:
            continue
        for c in (1, -1):
            still = _rest_moment(body, contact, c, 0.0, scratch)
            pushed = _rest_moment(body, contact, c, 1.0, scratch)
            # the moment is linear in the ground's acceleration, and the contact opens where it vanishes
            limit = still / (still - pushed)
            if still > pushed:
                high = min(high, limit)
            else:
                low = max(low, limit)
    return low, high


@kernel
def _rest_moment(body, contact, c, ground, scratch):
    """Contact moment s τ(s) [N m] of GROUND or INTERFACE at its corner s = ``c``, ±1, the body being at rest.

    ``ground``: acceleration of the ground [m/s²]; ``scratch``: a STATE to work in.
    """
    at_rest(scratch, ground, body.gravity)
    c1, c2 = (c, 1) if contact == GROUND else (1, c)
    _, _, _, f1, f2 = model.equations(body, model.pivot(c1), model.pivot(c2), scratch)
    return c * (f1 + f2) if contact == GROUND else c * f2


@kernel
def settle(body, state):
    """Return the contact state (c1, c2) into which forces take a state: closed contacts stay, or open to a side.

    States with the closed contacts unchanged, then one of them open, then both, are tried in turn; the first in
    which contacts that open separate and those that stay are pressed at both corners is taken. Open contacts stay
    open.
    """
    c1, c2 = state.c1, state.c2
    if c1 != 0 and c2 != 0:
        return c1, c2
    for opened in range(3):
        for n1 in (0, 1, -1):
            if n1 != 0 and (c1 != 0 or body.fixed):
                continue
            for n2 in (0, 1, -1):
                if (n2 != 0 and c2 != 0) or abs(n1) + abs(n2) != opened:
                    continue
                t1 = c1 if c1 != 0 else n1
                t2 = c2 if c2 != 0 else n2
                if _is_consistent(body, state, t1, t2):
                    return t1, t2
    # within rounding of a threshold: open what its own criterion opens
    alpha = model.accelerations(body, c1, c2, state)
    n1, n2 = c1, c2
    for contact in (GROUND, INTERFACE):
        hold, corner = model.hold(body, contact, (c1, c2), state, alpha)
        if contact == GROUND and c1 == 0 and hold < 0.0 and not body.fixed:
            n1 = corner
        if contact == INTERFACE and c2 == 0 and hold < 0.0:
            n2 = corner
    return n1, n2


@kernel
def _is_consistent(body, state, t1, t2):
    """Whether closed contacts of a state may become (t1, t2) with the accelerations that follow from these.

    Contacts that open have to separate, those that stay closed to be pressed at both corners.
    """
    alpha1, alpha2 = model.accelerations(body, t1, t2, state)
    if state.c1 == 0 and t1 != 0 and not t1 * alpha1 > 0.0:
        return False
    if state.c2 == 0 and t2 != 0 and not t2 * (alpha2 - alpha1) > 0.0:
        return False
    for contact in (GROUND, INTERFACE):
        stays = t1 == 0 if contact == GROUND else t2 == 0
        if stays:
            there, alpha = (t1, t2), (alpha1, alpha2)
            hold, _ = model.hold(body, contact, there, state, alpha)
            if not hold >= 0.0:
                return False
    return True


@kernel
def release(body, state, fails, stuck):
    """Return the contact state (c1, c2) after a closed contact would have to be pulled.

    ``fails``: that contact, GROUND or INTERFACE; ``stuck``: whether no time has passed since the last event, so
    that it has to open whatever rounding says.
    """
    c1, c2 = settle(body, state)
    if stuck and c1 == state.c1 and c2 == state.c2:
        # rounding at a threshold: open the contact that fails
        alpha = model.accelerations(body, c1, c2, state)
        _, corner = model.hold(body, fails, (c1, c2), state, alpha)
        return (corner, c2) if fails == GROUND else (c1, corner)
    return c1, c2


@kernel
def uplift(body, state):
    """Return the contact state (c1, c2) that a body at rest takes under a ground acceleration that lifts it."""
    c1, c2 = settle(body, state)
    if c1 == 0 and c2 == 0:
        # rounding at the threshold: open the contact with the least hold
        hold1, corner1 = model.hold(body, GROUND, (0, 0), state, (0.0, 0.0))
        hold2, corner2 = model.hold(body, INTERFACE, (0, 0), state, (0.0, 0.0))
        if hold1 <= hold2:
            return corner1, 0
        return 0, corner2
    return c1, c2
