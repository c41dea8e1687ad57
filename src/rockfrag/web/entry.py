"""The two functions of the module that a page calls, and the record through which it does.

They are compiled to WebAssembly alone (``build``), from the kernels that everything else is computed with.
"""

import math

import numpy as np

from rockfrag.base.arrays import fields, whole
from rockfrag.engines.compile.jit import kernel
from rockfrag.engines.pure_rocking.kernels.equations import BODY, STATE
from rockfrag.engines.pure_rocking.kernels.record import SUMMARY
from rockfrag.engines.pure_rocking.kernels.single import SCRATCH, Shaking, integrate
from rockfrag.laws import position, ratio
from rockfrag.system import geometry

BLOCK = np.dtype(fields("width height mass inertia cg_height cg_offset lean"))
"""A block as it is given (``bodies.Block``), with NaN for an inertia or a cg_height that is not."""

CALL = np.dtype(
    [
        # what describe reads
        *fields("statue pedestal", of=BLOCK),
        *fields("offset"),
        *whole("stacked"),
        # measured restitution, NaN where momentum is conserved
        *fields("ground interface"),
        # what it leaves: whether the body stands (``geometry``), and the frequency parameters that steps and the
        # length of free rocking follow from [1/s]
        *whole("fault"),
        *fields("fastest slowest"),
        # what integrate reads, the body among it, and leaves
        *fields("body", of=BODY),
        *fields("initial", of=STATE),
        *fields("scale dt"),
        *fields("right up"),  # jump of the base's velocity [m/s]
        *whole("substeps free_samples"),
        *fields("summary", of=SUMMARY),
        *whole("done"),
        *fields("work", of=SCRATCH),
    ],
    align=True,
)
"""What a page and the module hand to each other."""


GAINS_ENERGY = 6
"""Fault of a measured restitution, beside those of ``geometry``."""

# as a part of what is compiled here, and not as the entry that Python calls
_integrate = kernel(integrate.py_func)


@kernel
def describe(call):
    """Describe a body to the kernels: fill its record, in which its gravity stands already."""
    body, given = call.body, call.statue
    statue = shape_of(given)
    body.measured = not (math.isnan(call.ground) and math.isnan(call.interface))
    call.fault = geometry.STANDS if geometry.can_stand(statue) else geometry.FALLS_ALONE
    if call.stacked == 0:
        geometry.fill_block(body, statue)
        if body.measured:
            # of a lone block all laws are the same
            body.after2r.law, body.after2r.value = ratio.NUMBER, call.interface
            body.after2l.law, body.after2l.value = ratio.NUMBER, call.interface
            _check_restitution(call, statue, call.interface)
        note_frequencies(call, statue, body.gravity)
        return
    pile = stacked(call, body, shape_of(call.pedestal), statue, call.offset)
    _measure(call, pile.lower, call.ground, body.after1r, body.after1l)
    _measure(call, pile.upper, call.interface, body.after2r, body.after2l)


@kernel
def shape_of(given):
    """A block that is given, as it stands."""
    return geometry.shape_of(
        given.width, given.height, given.mass, given.inertia, given.cg_height, given.cg_offset, given.lean
    )  # fmt: skip


@kernel
def note_frequencies(call, shape, g):
    """Note the largest and the least frequency parameter of a lone block."""
    right, left = geometry.frequency(shape, 1, g), geometry.frequency(shape, -1, g)
    call.fastest, call.slowest = max(right, left), min(right, left)


@kernel
def stacked(call, body, lower, upper, offset):
    """Describe a block on a pedestal: whether it stands, its record, its frequencies; return it as a pile."""
    pedestal = call.pedestal
    face = geometry.Face(lower.b, pedestal.height, pedestal.lean, 0.0, offset)
    pile = geometry.pile_of(lower, upper, face)
    if not geometry.can_stand(lower):
        call.fault = geometry.FALLS_ALONE
    if call.fault == geometry.STANDS:
        call.fault = geometry.failed_stability_check(pile)
    geometry.fill_pile(body, pile)
    whole, g = geometry.joined(pile), body.gravity
    call.fastest, call.slowest = 0.0, np.inf
    for pivot in (1, -1):
        above = geometry.frequency(pile.upper, pivot, g)
        call.fastest = max(
            call.fastest, max(geometry.frequency(lower, pivot, g), above)
        )
        call.slowest = min(
            call.slowest, min(above, geometry.frequency(whole, pivot, g))
        )
    return pile


@kernel
def _measure(call, block, restitution, right, left):
    """Fill how a contact comes off its impacts, where that was measured."""
    if math.isnan(restitution):
        return
    right.law, right.value = position.tell(block, restitution, 1)
    left.law, left.value = position.tell(block, restitution, -1)
    _check_restitution(call, block, restitution)


@kernel
def _check_restitution(call, block, restitution):
    """Note a restitution with which energy could grow."""
    largest = min(
        geometry.largest_restitution(block, 1), geometry.largest_restitution(block, -1)
    )
    if call.fault == geometry.STANDS and not 0.0 <= restitution <= largest:
        call.fault = GAINS_ENERGY


@kernel
def jump_call(call):
    """Let the velocity of the base jump under the lone block that was described last (``geometry.jumped``).

    The jump, ``call.right`` and ``call.up`` [m/s], changes the angular velocity ``omega2`` [rad/s] and the pivot
    ``c2`` of ``call.initial``, where a lone block is body 2; its angle stays.  A block that stood flat and was not
    turned by the jump keeps standing, without a pivot.
    """
    state = call.initial
    jump = call.right, call.up
    pivot, rate = geometry.jumped(
        shape_of(call.statue), state.theta2, state.omega2, jump
    )
    state.omega2 = rate
    state.c2 = pivot if rate != 0.0 or state.theta2 != 0.0 else 0


@kernel
def integrate_call(call, samples, vertical, history, contact_events):
    """Integrate the body of a call; see ``single.integrate``."""
    shaking = Shaking(
        samples, vertical, call.scale, call.dt, call.substeps, call.free_samples
    )
    call.done = _integrate(
        call.body,
        shaking,
        call.initial,
        history,
        contact_events,
        call.summary,
        call.work,
    )
