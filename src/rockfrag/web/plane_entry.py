"""The functions of the module that shakes bodies in a plane that something holds, or that may roll and slide.

They are compiled to WebAssembly alone (``build``), around the contact kernels that the engine in the plane runs.

In: one block or two, and what holds them, as a page hands them over. Out: outcomes by factors on a motion.
Docs: ``docs/holding.md``.
"""

import math

import numpy as np

from rockfrag.engines.compile.jit import compile_for_kernels, kernel
from rockfrag.engines.planar import _describe
from rockfrag.engines.planar.engine import CLOSING
from rockfrag.engines.planar.holding import PLATE, THIN
from rockfrag.engines.planar.integrate import Kept, integrate
from rockfrag.engines.planar.records import BODY, MOST, WORK
from rockfrag.engines.pure_rocking.kernels.single import Shaking
from rockfrag.engines.steps import FREE_TIME, STEP
from rockfrag.laws import momentum, position, ratio
from rockfrag.simulation.options import NEVER_SLIDES
from rockfrag.system import geometry
from rockfrag.system.contact import ROUGHEST
from rockfrag.web import entry

_F, _I = np.float64, np.int64

HELD = np.dtype(
    [
        # what describe reads: blocks and ratios of impacts as ``ensemble_entry.SHAKEN`` has them
        ("statue", entry.BLOCK), ("pedestal", entry.BLOCK), ("stacked", _I),
        ("has_ratios", _I), ("below", _F), ("above", _F), ("restitution_factor", _F), ("gravity", _F),
        # of the ground's contact, NaN: no body slides
        ("friction", _F),
        # a bond under the statue, of which NaN is none: both pads hold so much together, and at ± spread
        ("bond_tension", _F), ("bond_shear", _F), ("bond_spread", _F),
        # how many ties from a height on the statue to as high an anchor beyond its edge: to the right, to the left
        ("ties", _I), ("is_bracket", _I), ("tie_height", _F), ("tie_reach", _F),
        ("tie_stiffness", _F), ("tie_damping", _F), ("tie_strength", _F),
        # distance of a wall to the right of the lowest base, NaN: none
        ("wall", _F),
        # an isolator under all: mass of its plate (NaN: none), radius and friction of its dish, where its stops
        # are; of a bilinear one (NaN: it is a dish) stiffness, strength and displacement at yield of its springs
        ("plate", _F), ("dish_radius", _F), ("dish_friction", _F), ("stroke", _F),
        ("spring_stiffness", _F), ("spring_strength", _F), ("spring_yield", _F),
        # what it leaves: whether the body stands (``geometry``), and its frequency parameters [1/s]
        ("fault", _I), ("fastest", _F), ("slowest", _F),
        # what shake reads and works in
        ("body", BODY), ("start", _F, (2, 3 * MOST)), ("still", _F, MOST), ("dt", _F), ("work", WORK),
    ],
    align=True,
)  # fmt: skip
"""What a page and the module hand to each other."""

FELL, ROCKED, LEANS, LOOSE, FORCE, STROKE = range(6)
"""Columns of outcomes: whether it fell, rocked, leans at the end, and slid or left the ground; then the largest
force [N] and stroke [m]."""

compile_for_kernels(_describe)
_integrate = kernel(integrate.py_func)


@kernel
def describe_held(call):
    """Describe one block or two, and what holds them, to the contact kernels."""
    p, g = call.body, call.gravity
    upper, lower = entry.shape_of(call.statue), entry.shape_of(call.pedestal)
    call.fault = geometry.STANDS if geometry.can_stand(upper) else geometry.FALLS_ALONE
    carries = geometry.Face(lower.b, call.pedestal.height, 0.0, 0.0, 0.0)
    pile = geometry.pile_of(lower, upper, carries)
    shapes, whole = (upper, upper), upper
    if call.stacked != 0:
        if not geometry.can_stand(lower):
            call.fault = geometry.FALLS_ALONE
        if call.fault == geometry.STANDS:
            call.fault = geometry.failed_stability_check(pile)
        shapes, whole = (lower, pile.upper), geometry.joined(pile)
    _note_frequencies(call, shapes, whole, g)
    p.g, p.tilt_cos[:] = g, 1.0
    count, first = 1 + call.stacked, 0 if math.isnan(call.plate) else 1
    p.count = count + first
    mass = lower.mass + upper.mass if call.stacked != 0 else upper.mass
    foot = _describe.Foot(0.0, 0.0, 0.0)
    under, face = upper, carries
    if first == 1:
        under = geometry.Shape(PLATE / 2, call.plate, call.plate, 0.0, 0.0)
        face = geometry.Face(PLATE / 2, THIN, 0.0, 0.0, 0.0)
        foot = _describe.place_lowest(p, under)
        _fill_laws(p, 0, under, False, math.nan, 1.0, True)
        mass = call.plate + lower.mass + upper.mass
        if call.stacked == 0:
            mass = call.plate + upper.mass
    p.weight = g * mass
    ratios, alone = call.has_ratios != 0, call.stacked == 0
    if call.stacked != 0:
        foot = _place(p, first, lower, under, face, foot)
        _fill_laws(p, first, lower, ratios, call.below, call.restitution_factor, False)
        under, face = lower, carries
    top = first + count - 1
    _place(p, top, upper, under, face, foot)
    _fill_laws(p, top, shapes[1], ratios, call.above, call.restitution_factor, alone)
    _describe.fill_contacts(p)
    _fill_holding(call, first, top, lower, upper)
    _fill_friction(call, first)
    call.start[:] = 0.0
    _describe.fill_start(p, call.still, call.still, call.start)


@kernel
def _place(p, k, shape, under, face, below):
    """Place body k, on the ground or on the face of what is under it, which stands at ``below``.

    Returned is where it stands itself.
    """
    if k == 0:
        return _describe.place_lowest(p, shape)
    return _describe.place_above(p, k, (under, shape), face, below)


@kernel
def _note_frequencies(call, shapes, whole, g):
    """Note the largest and the least frequency parameter of what rocks."""
    call.fastest, call.slowest = 0.0, np.inf
    for pivot in (1, -1):
        for shape in shapes:
            call.fastest = max(call.fastest, geometry.frequency(shape, pivot, g))
        for shape in (whole, shapes[1]):
            call.slowest = min(call.slowest, geometry.frequency(shape, pivot, g))


@kernel
def _fill_laws(p, k, shape, has_ratios, measured, factor, alone):
    """Fill how a contact comes off its impacts on either end; of a body alone all laws are its ratio."""
    for end in range(2):
        pivot = 2 * end - 1
        p.law[k, end], p.number[k, end] = momentum.NUMBER, 1.0
        if has_ratios:
            after = geometry.scaled_restitution(shape, pivot, measured, factor)
            p.law[k, end], p.number[k, end] = ratio.NUMBER, after
            if not alone:
                p.law[k, end], p.number[k, end] = position.tell(shape, after, pivot)


@kernel
def _fill_friction(call, first):
    """Fill coefficients of contacts: as rough as can be, finite where bodies on each other are held."""
    p = call.body
    rough = ROUGHEST
    if p.is_held == 1 and p.count > 1:
        rough = NEVER_SLIDES.static
    for k in range(p.count):
        p.static[k], p.kinetic[k] = rough, rough
    if not math.isnan(call.friction):
        p.static[first], p.kinetic[first] = call.friction, call.friction
    if first == 1:
        p.static[0], p.kinetic[0] = call.dish_friction, call.dish_friction


@kernel
def _fill_holding(call, first, top, lower, upper):
    """Fill wall, ties, bond and isolator, in the order of what holds a system."""
    p, number = call.body, 0
    raised = call.pedestal.height if call.stacked != 0 else 0.0
    if not math.isnan(call.wall):
        _fill_walls(call, first, lower, upper, raised)
        number += 1
    x, height = call.statue.cg_offset, call.tie_height
    for t in range(call.ties):
        way = 1.0 - 2.0 * t
        p.tie_body[t], p.tie_number[t] = top, number
        p.is_bracket[t] = call.is_bracket
        p.tie_point[t, 0] = x - upper.x
        p.tie_point[t, 1] = (raised + height) - (raised + upper.y)
        p.tie_anchor[t, 0] = x + way * call.tie_reach
        p.tie_anchor[t, 1] = raised + height
        length = abs(p.tie_anchor[t, 0] - x)
        p.tie_long[t] = p.tie_short[t] = length
        p.tie_stiffness[t], p.tie_damping[t] = call.tie_stiffness, call.tie_damping
        p.tie_strength[t] = call.tie_strength
        number += 1
    p.ties = call.ties
    if not math.isnan(call.bond_tension):
        p.is_bonded[top], p.bond_number[top] = 1, number
        p.bond_spread[top], p.bond_shear[top] = call.bond_spread, call.bond_shear
        p.bond_tension[top] = call.bond_tension / 2
        number += 1
    if first == 1:
        p.is_supported, p.support_number = 1, number
        p.dish_radius = call.dish_radius
        if not math.isnan(call.spring_stiffness):
            p.dish_radius = np.inf
            p.is_sprung, p.spring_stiffness = 1, call.spring_stiffness
            p.spring_strength = call.spring_strength
            p.spring_rise = call.spring_strength / call.spring_yield
        if call.stroke < np.inf:
            for side in (-1, 1):
                k = _new_contact(p, 0, number)
                p.side[k], p.is_stop[k], p.wall_top[k] = side, 1, np.inf
                p.wall_x[k] = p.standing[0] + side * call.stroke
        number += 1
    p.is_held = 1 if number > 0 else 0


@kernel
def _new_contact(p, body, number):
    """Append a contact of a body with a wall; its number."""
    k = p.contacts
    p.contacts = k + 1
    p.upper[k], p.lower[k], p.wall[k] = body, -1, number
    return k


@kernel
def _fill_walls(call, first, lower, upper, raised):
    """Fill a smooth wall to the right of all bodies, each of which may meet it."""
    p = call.body
    base = call.pedestal.width if call.stacked != 0 else call.statue.width
    for k in range(p.count - first):
        shape, own, origin = upper, call.statue, raised
        if call.stacked != 0 and k == 0:
            shape, own, origin = lower, call.pedestal, 0.0
        contact = _new_contact(p, k + first, 0)
        p.wall_top[contact] = np.inf
        x, y = own.width / 2 - shape.x, origin + shape.y
        low, high = (x, origin - y), (x, (origin + own.height) - y)
        side = _describe.Side(1, low, high)
        _describe.fill_wall(p, contact, base / 2 + call.wall, side)


@kernel
def shake_held(call, samples, scales, found, history, contact_events):
    """Shake the body that was described last by a motion at some factors.

    Parameters
    ----------
    call : record HELD
    samples : of the ground [m/s²], shape (n,)
    scales : factors, shape (scales,)
    found : outcomes, shape (scales, 6)
    history, contact_events : what is kept of each, which is nothing, shape (0,)
    """
    substeps = max(1, math.ceil(call.fastest * call.dt / STEP - 1e-9))
    free = math.ceil(FREE_TIME / call.slowest / call.dt)
    nothing = Kept(history, contact_events)
    for i in range(scales.size):
        shaking = Shaking(samples, samples[:0], scales[i], call.dt, substeps, free)
        _integrate(call.body, shaking, call.start, CLOSING, nothing, call.work)
        _note_outcome(call, found[i])


@kernel
def _note_outcome(call, found):
    """Note what became of a case, as the engine tells it."""
    p, out = call.body, call.work.outcome
    first = p.is_supported
    found[:] = 0.0
    found[FELL] = 1.0 if out.overturned_body > 0 else 0.0
    found[LEANS] = float(out.leaning)
    loose = out.paradoxes > 0
    for k in range(first, p.count):
        turned = out.overturned_body == k + 1 or out.peak_rotation[k] > 0
        found[ROCKED] = 1.0 if turned else found[ROCKED]
        loose = loose or out.slid[k] > 0 or out.flights[k] > 0
    found[LOOSE] = 1.0 if loose else 0.0
    for i in range(out.largest_force.size):
        found[FORCE] = max(found[FORCE], out.largest_force[i])
        found[STROKE] = max(found[STROKE], out.stroke[i])
