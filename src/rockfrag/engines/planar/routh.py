"""An impact of one contact and no other, in which slip may stop and turn round (``docs/contact.md``).

Slip and approach change with the normal impulse at constant rates until the slip stops (E. J. Routh, Dynamics of a
System of Rigid Bodies, 1905; J. B. Keller, Journal of Applied Mechanics 53, 1986, 1-4).

``p`` and ``w`` are records ``BODY`` and ``WORK`` (``records.py``). ``q`` and ``v`` have x, y [m] and the clockwise
rotation θ [rad] of body k, from place 3 k on, and their rates.
A row has the motion at a contact per coordinate of the body below (places 0 to 2) and above (3 to 5).

In: a record ``BODY`` and its working memory with the velocities before [m/s, rad/s]. Out: in that memory the
velocities after, and how the contact slides. Theory there: "Static above kinetic friction in an impact".
"""

import math

from rockfrag.engines.compile.jit import kernel
from rockfrag.engines.planar.solve import copy, end_of, fill_row, rate


@kernel
def contact_alone(p, w):
    """Interface and end of the only closed end of the mode in ``w``; -1 and -1 if there are none or more."""
    at = -1
    for k in range(p.contacts):
        for end in range(2):
            if w.closed[k, end] == 1:
                if at >= 0:
                    return -1, -1
                at, last = k, end
    return (at, last) if at >= 0 else (-1, -1)


@kernel
def _felt(p, k, pushed, felt):
    """Velocity at contact k along the row ``felt`` for a unit impulse along the row ``pushed`` [1/kg].

    Place d of a row is coordinate ``base`` + d; the body below does not count if it is the ground.
    """
    total, base = 0.0, 3 * p.upper[k] - 3
    for d in range(3 if p.lower[k] < 0 else 0, 6):
        total += pushed[d] * p.inverse[base + d] * felt[d]
    return total


@kernel
def strike_alone(p, w, k, end):
    """Fill ``w.out`` with the velocities after an impact of end ``end`` of interface k alone, by Routh's method.

    Friction is kinetic while it slides; once the slip has stopped, static friction holds it or it slides as the
    impulse drives it. How it slides then goes into ``w.slides``, impulses [N s] into ``w.normal`` and ``w.shear``.
    """
    x, y, tx, ty, _, _, _ = end_of(p, w, w.q, k, end, w.kind[k, end])
    across, along = w.row[0], w.row[1]
    fill_row(p, w.q, k, x, y, -ty, tx, across)
    fill_row(p, w.q, k, x, y, tx, ty, along)
    # W_nn, W_nt and W_tt [1/kg]: what a unit impulse brings about, across and along
    own = _felt(p, k, across, across)
    both = _felt(p, k, across, along)
    shear = _felt(p, k, along, along)
    approach = rate(p, w.q, w.v, k, x, y, -ty, tx)
    slip = w.slid[k] * abs(rate(p, w.q, w.v, k, x, y, tx, ty))
    normal = tangential = 0.0
    way = w.slid[k]
    if way != 0:
        # until the slip stops, or the approach does
        gain, drive = own - way * p.kinetic[k] * both, both - way * p.kinetic[k] * shear
        to_end = -approach / gain if gain > 0.0 else math.inf
        to_stop = -slip / drive if way * drive < 0.0 else math.inf
        normal = min(to_end, to_stop)
        tangential = -way * p.kinetic[k] * normal
        approach += gain * normal
        way = way if to_end <= to_stop else 0
    if way == 0:
        hold = both / shear
        if abs(hold) > p.static[k]:
            way = 1 if both > 0.0 else -1
            hold = way * p.kinetic[k]
        more = -approach / (own - hold * both)
        normal += more
        tangential -= hold * more
    w.slides[k] = way
    w.normal[k, end], w.shear[k] = normal, tangential
    copy(p, w.v, w.out)
    base = 3 * p.upper[k] - 3
    for d in range(3 if p.lower[k] < 0 else 0, 6):
        push = across[d] * normal + along[d] * tangential
        w.out[base + d] += p.inverse[base + d] * push
