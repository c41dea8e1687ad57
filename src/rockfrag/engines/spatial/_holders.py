"""What holds a body, along an analysis: forces that are noted, ties that turn taut or slack or break.

In: states as an analysis passes them. Out: ``s.force``, ``s.breaks``, ``s.taut``. Theory: ``docs/holding.md``.

Names (``_body`` explains the state and the numbers of contacts):

- ``body``, ``s``: records ``BODY`` and ``CASE``; ``y``: the state, shape (15,)
- ``rows``: the world's axes as the body sees them, ``rows[2]`` the upward one
"""

import math

from rockfrag.engines.algebra import vectors as algebra
from rockfrag.engines.compile.jit import kernel
from rockfrag.engines.spatial import _body as solid
from rockfrag.engines.spatial import _case as case
from rockfrag.engines.spatial import _rest as rest
from rockfrag.engines.spatial import _ties as ties


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
            _, length, rate = ties.stretch_of(body, y, rows, i)
            s.taut[i] = ties.tie_margin(body, length, rate, i) > 0.0


@kernel
def note_bond(body, y, tau, s):
    """Keep the largest tension of a side of the bond, at ``tau`` [N/kg]: at most half of what the bond holds."""
    rows = algebra.rotation(y)
    pulled = rest.bond_tension(body, rows, case.effective_gravity_at(s.field, tau))
    s.force[solid.BOND] = max(s.force[solid.BOND], min(pulled, 0.5 * body.tension))


@kernel
def note_forces(body, y, s):
    """Keep the largest force of each wall and tie in the state y [N/kg]; jammed walls have none that is known."""
    rows = algebra.rotation(y)
    for i in range(body.constraints):
        if not body.ties[i]:
            if s.jammed:
                continue
            pressed = 0.0
            for k in range(s.count):
                at = s.closed[k]
                if at >= solid.WALLS and solid.wall_of(at) == i:
                    pressed += s.lam[k, 2]
            s.force[i] = max(s.force[i], pressed)
            continue
        if s.broken[i]:
            continue
        _, length, rate = ties.stretch_of(body, y, rows, i)
        s.force[i] = max(s.force[i], abs(ties.tie_force(body, length, rate, i)))


@kernel
def turn_ties(body, y, tau, breaks, s):
    """Let ties that have come to their other state be in it, or break those that bear all they can."""
    rows = algebra.rotation(y)
    for i in range(body.constraints):
        if not body.ties[i] or s.broken[i]:
            continue
        _, length, rate = ties.stretch_of(body, y, rows, i)
        value = ties.tie_margin(body, length, rate, i)
        if breaks:
            force = abs(ties.tie_force(body, length, rate, i))
            if force >= body.strength[i] * (1.0 - 1e-6):
                s.broken[i], s.breaks[i] = 1, s.began + tau
                s.force[i] = body.strength[i]
        elif s.taut[i] == 1 and value < 0.0:
            s.taut[i] = 0
        elif s.taut[i] == 0 and value > 0.0:
            s.taut[i] = 1
            s.hits[i] += 1.0
