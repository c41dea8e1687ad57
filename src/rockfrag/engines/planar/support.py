"""An isolator: a plate under the lowest body that moves along the ground alone (``docs/holding.md``, 4).

The plate is body 0 and its contact with the ground is never open.  A dish of radius R adds the slope u/R to its
friction; a bilinear spring pulls at it, and its hysteretic part yields; a stop is a wall of the plate.

In: a record ``BODY`` and coordinates. Out: the slope of the dish [-], forces of the spring [N], the stroke [m].
"""

import math

from rockfrag.engines.compile.jit import inlined_kernel, kernel

GUIDED = (
    2  # what the contact of the plate is: shut whatever its force, and free to slide
)
JUST = 1e-13  # slack before a change is seen: of forces over the weight, of speeds over √(g b) [-]


@inlined_kernel
def displacement(p, q):
    """Displacement of the plate [m]."""
    return q[0] - p.standing[0]


@inlined_kernel
def slope(p, w, q, k):
    """Slope of the dish under contact k [-], 0 if it is none."""
    return displacement(p, q) / p.dish_radius if w.whole[k] == GUIDED else 0.0


@inlined_kernel
def rubbing(p, w, q, k, impact):
    """Force against the slip of contact k over its normal force [-]: of friction, and of the slope of a dish.

    In an ``impact`` of friction alone: a plate that keeps its height would else gain what its slope takes upwards.
    """
    found = w.slides[k] * p.kinetic[k]
    if w.whole[k] == GUIDED and w.slides[k] != 0 and not impact:
        found += slope(p, w, q, k)
    return found


@kernel
def hysteretic_force(p, w, q):
    """Force of the hysteretic part of a bilinear spring [N]: its strength once it yields, elastic before."""
    if w.yields != 0:
        return w.yields * p.spring_strength
    return p.spring_rise * (displacement(p, q) - w.plastic)


@kernel
def spring_force(p, w, q):
    """Force with which a bilinear spring pulls the plate back [N]."""
    return p.spring_stiffness * displacement(p, q) + hysteretic_force(p, w, q)


@kernel
def least_support_margin(p, w, q, v):
    """Margin [-] that is negative where the hysteretic part of a spring changes, which w.spring_fails then says.

    While it is elastic, strength that is left over the weight; once it yields, the plate's speed (v[0]) the way
    that it yields over √(g b). Infinite without a spring.
    """
    if p.is_sprung == 0:
        return math.inf
    if w.yields == 0:
        left = p.spring_strength - abs(hysteretic_force(p, w, q))
        margin = left / p.weight + JUST
    else:
        margin = w.yields * v[0] / p.speed + JUST
    w.spring_fails = 1 if margin < 0.0 else 0
    return margin


@kernel
def change_spring(p, w):
    """Let the hysteretic part of a spring change, if ``w.spring_fails`` says that it is due.

    It yields where it was elastic; where it yielded it unloads, and is elastic about a new rest.
    """
    if w.spring_fails == 0:
        return
    w.spring_fails = 0
    if w.yields == 0:
        w.yields = 1 if hysteretic_force(p, w, w.q) > 0.0 else -1
        return
    w.plastic = displacement(p, w.q) - w.yields * p.spring_strength / p.spring_rise
    w.yields = 0


@kernel
def note_stroke(p, w):
    """Keep the largest displacement of the plate [m]."""
    if p.is_supported == 1:
        at = p.support_number
        w.outcome.stroke[at] = max(w.outcome.stroke[at], abs(displacement(p, w.q)))
