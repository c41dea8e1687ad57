"""Bonds: contacts that are shut whatever their force until a pad or the shear breaks (``docs/holding.md``, 2).

The forces of the two ends of a contact at ± b are those of two pads at ± c: N/2 ± M/(2 c), M = (N_1 - N_0) b.

``p`` and ``w`` are records ``BODY`` and ``WORK`` (``records.py``). ``q`` and ``v`` have x, y [m] and the clockwise
rotation θ [rad] of body k, from place 3 k on, and their rates.

In: a record ``BODY``, with the forces of its ends in the working memory. Out: forces of the pads [N], margins over
the weight [-], and which bonds break.
"""

import math

from rockfrag.engines.compile.jit import kernel
from rockfrag.engines.planar.solve import end_of
from rockfrag.engines.planar.ties import BROKEN

WHOLE = 1  # a contact that is bonded
SLACK = 1e-12  # force over the weight, or impulse over its unit, by which a bond may be overloaded [-]


@kernel
def pad_forces(p, w, k):
    """Forces of the left and the right pad of bonded contact k, with the forces of its ends in ``w`` [N]."""
    x, y, tx, ty, _, _, _ = end_of(p, w, w.q, k, 0, w.kind[k, 0])
    far_x, far_y, _, _, _, _, _ = end_of(p, w, w.q, k, 1, w.kind[k, 1])
    half = 0.5 * ((far_x - x) * tx + (far_y - y) * ty)
    moment = (w.normal[k, 1] - w.normal[k, 0]) * half
    pressed = w.normal[k, 0] + w.normal[k, 1]
    more = 0.5 * moment / p.bond_spread[k]
    return 0.5 * pressed - more, 0.5 * pressed + more


@kernel
def pad_force(p, w, k):
    """Least force of the two pads of bonded contact k [N]."""
    left, right = pad_forces(p, w, k)
    return min(left, right)


@kernel
def bond_margin(p, w, k):
    """Least margin of the whole bond of contact k [-]: what its pads and its shear have left, over the weight.

    The forces are those in ``w``; friction under compression adds to the shear that it bears.
    """
    pressed = w.normal[k, 0] + w.normal[k, 1]
    pulled = (p.bond_tension[k] + pad_force(p, w, k)) / p.weight
    hold = p.bond_shear[k] + p.static[k] * pressed - abs(w.shear[k])
    return min(pulled, hold / (p.weight * max(p.static[k], 1.0))) + SLACK


@kernel
def fill_rest_margins(p, w, k, load):
    """Fill the margins at rest of bonded contact k: of its left and right pad, and of its shear to either side.

    ``load``: column of ``w.rest``, 0 for gravity alone, 1 and 2 with a unit of the ground's acceleration to the
    right and upwards; the forces in ``w`` are those under it.
    """
    left, right = pad_forces(p, w, k)
    hold = p.bond_shear[k] + p.static[k] * (left + right)
    unit = 1.0 / (p.weight * max(p.static[k], 1.0))
    w.rest[4 * k, load] = (p.bond_tension[k] + left) / p.weight
    w.rest[4 * k + 1, load] = (p.bond_tension[k] + right) / p.weight
    w.rest[4 * k + 2, load] = (hold - w.shear[k]) * unit
    w.rest[4 * k + 3, load] = (hold + w.shear[k]) * unit


@kernel
def note_rest_loads(p, w, now):
    """Keep the largest tensile capacity [N] that bonds needed so far at rest under the accelerations ``now``.

    It follows from the margins of rest, which are linear in both accelerations.
    """
    for k in range(p.count):
        if w.whole[k] == WHOLE:
            # of both pads (:func:`fill_rest_margins`)
            for row in range(4 * k, 4 * k + 2):
                # by gravity, and by accelerations to the right and upwards
                margin = w.rest[row, 0] + w.rest[row, 1] * now.ah
                margin += w.rest[row, 2] * now.av
                load = 2.0 * (p.bond_tension[k] - margin * p.weight)
                at = p.bond_number[k]
                w.outcome.largest_force[at] = max(w.outcome.largest_force[at], load)


@kernel
def note_loads(p, w):
    """Keep the largest tensile capacity [N] that bonds needed so far, twice the pull of a pad, by forces now."""
    for k in range(p.count):
        if w.whole[k] == WHOLE:
            at = p.bond_number[k]
            load = -2.0 * pad_force(p, w, k)
            w.outcome.largest_force[at] = max(w.outcome.largest_force[at], load)


@kernel
def break_pulled(p, w, unit):
    """Break the bonds that an impact whose impulses are in ``w`` would pull at; return whether there are any.

    A rigid bond cannot bound an impulse: that it breaks is the safe side. ``unit``: of impulses [N s].
    """
    found = False
    for k in range(p.count):
        if w.whole[k] != WHOLE:
            continue
        pressed = w.normal[k, 0] + w.normal[k, 1]
        sheared = abs(w.shear[k]) - p.static[k] * pressed
        if pad_force(p, w, k) < -1e-9 * unit or sheared > 1e-9 * unit:
            w.whole[k] = 0
            found = True
    return found


@kernel
def count_broken(p, w):
    """Number of bonds and ties that are broken."""
    broken = 0
    for k in range(p.count):
        broken += p.is_bonded[k] * (w.whole[k] == 0)
    for t in range(p.ties):
        broken += w.taut[t] == BROKEN
    return broken


@kernel
def note_breaking(p, w, time):
    """Note the time [s] at which bonds have broken."""
    for k in range(p.count):
        at = p.bond_number[k]
        broken = p.is_bonded[k] == 1 and w.whole[k] == 0
        if broken and math.isnan(w.outcome.breaking_time[at]):
            w.outcome.breaking_time[at] = time
