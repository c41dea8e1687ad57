"""The functions of the module that shakes a body by many motions at many levels, as ``overturns`` does.

They are compiled to WebAssembly alone (``build``), around the lanes that everything else is counted with.
"""

import numpy as np

from rockfrag.engines.compile.by_reference import referred
from rockfrag.engines.compile.jit import fma, kernel
from rockfrag.engines.pure_rocking.kernels.equations import BODY
from rockfrag.engines.pure_rocking.kernels.lanes import block, stack_case
from rockfrag.engines.pure_rocking.kernels.lanes.case import Ensemble, Motions
from rockfrag.engines.pure_rocking.kernels.lanes.scheduler import integrate_stacks
from rockfrag.laws import momentum, position
from rockfrag.system import geometry
from rockfrag.web import entry

_F, _I = np.float64, np.int64

SHAKEN = np.dtype(
    [
        # what describe reads: whether the ratios of impacts are given, those of the pedestal and of the statue
        # (NaN where momentum's count), and the factor on each
        ("statue", entry.BLOCK), ("pedestal", entry.BLOCK), ("stacked", _I),
        ("has_ratios", _I), ("below", _F), ("above", _F), ("restitution_factor", _F),
        # what it leaves; the least acceleration at which a contact opens [g], and constants of the right and left
        # pivot of a lone block
        ("fault", _I), ("fastest", _F), ("slowest", _F), ("uplift", _F), ("largest", _F), ("centre", _F, 3),
        ("body", BODY, 1), ("pivots", block.PIVOT, 2),
        # what count reads
        ("counter", _I, 1), ("cases", _I),
        # what it works in
        ("blocks", block.MEMORY), ("stacks", stack_case.MEMORY),
    ],
    align=True,
)  # fmt: skip
"""What a page and the module hand to each other."""

# as parts of what is compiled here, and not as the entries that Python calls
_integrate_blocks = kernel(block.integrate_blocks.py_func)
_integrate_stacks = kernel(integrate_stacks.py_func)


@kernel
def multiply_add(call):
    """Put ``above`` × ``restitution_factor`` + ``uplift`` into ``uplift``, of any three numbers.

    The page sees by it whether its multiply-add rounds once, as that of the package does.
    """
    call.uplift = fma(call.above, call.restitution_factor, call.uplift)


@kernel
def describe_shaken(call):
    """Describe a block, or one on a pedestal, to the lanes; gravity stands in its record already.

    Filled in ``call`` are ``body``, ``fault``, the accelerations ``uplift`` from which on it rocks [m/s²], the
    ``largest`` restitution that gains no energy, the ``centre`` (x, y [m]) and inertia [kg m²], and ``pivots`` of
    a lone block.
    """
    upper = entry.shape_of(call.statue)
    call.body[0].measured = call.has_ratios != 0
    call.fault = geometry.STANDS if geometry.can_stand(upper) else geometry.FALLS_ALONE
    call.uplift, call.largest = np.inf, np.inf
    if call.stacked == 0:
        _describe_block(call, upper)
    else:
        _describe_stack(call, entry.shape_of(call.pedestal), upper)


@kernel
def _describe_block(call, shape):
    """Describe a lone block of a shape; its measured ratio of velocities is ``call.above``."""
    body, g = call.body[0], call.body[0].gravity
    geometry.fill_block(body, shape)
    call.centre[0], call.centre[1], call.centre[2] = shape.x, shape.y, shape.inertia
    entry.note_frequencies(call, shape, g)
    for pivot in (1, -1):
        # rocking on one pivot ends by an impact on the other one
        after = geometry.momentum_restitution(shape, -pivot)
        if call.has_ratios != 0:
            after = geometry.scaled_restitution(
                shape, -pivot, call.above, call.restitution_factor
            )
        here = call.pivots[(1 - pivot) // 2]
        (
            here.alpha, here.tan, here.sine, here.cosine, here.swing, here.restitution,
            here.per_alpha, here.per_swing,
        ) = geometry.pivot_constants(shape, pivot, after, g)  # fmt: skip
        _note_uplift(call, geometry.arm(shape, pivot))
        call.largest = min(call.largest, geometry.largest_restitution(shape, pivot))


@kernel
def _describe_stack(call, lower, upper):
    """Describe two shapes on each other; their measured ratios are ``call.below`` and ``call.above``."""
    body = call.body[0]
    pile = entry.stacked(call, body, lower, upper, 0.0)
    whole = geometry.joined(pile)
    call.centre[0], call.centre[1], call.centre[2] = whole.x, whole.y, whole.inertia
    _fill_law(call, body.after1r, lower, 1, call.below)
    _fill_law(call, body.after1l, lower, -1, call.below)
    _fill_law(call, body.after2r, pile.upper, 1, call.above)
    _fill_law(call, body.after2l, pile.upper, -1, call.above)
    for pivot in (1, -1):
        _note_uplift(call, geometry.common_arm(pile, pivot))
        _note_uplift(call, geometry.upper_arm(pile, pivot))
        call.largest = min(call.largest, geometry.largest_restitution(lower, pivot))
        call.largest = min(
            call.largest, geometry.largest_restitution(pile.upper, pivot)
        )


@kernel
def _fill_law(call, after, shape, pivot, measured):
    """Fill what follows impacts that end on a pivot: momentum, or a measured ratio scaled as the call says."""
    after.law, after.value = momentum.NUMBER, 1.0
    if call.has_ratios != 0:
        ratio = geometry.scaled_restitution(
            shape, pivot, measured, call.restitution_factor
        )
        after.law, after.value = position.tell(shape, ratio, pivot)


@kernel
def _note_uplift(call, arm):
    x, y = arm
    if y > 0:
        call.uplift = min(call.uplift, abs(x) / y)


@kernel
def count_blocks(
    call, pivots, factors, rows, intervals, free, samples, extremes, places, outcomes
):  # fmt: skip
    """Integrate a lone block through motions at scales; see ``lanes.block.integrate_blocks``.

    ``extremes`` are the four tables of ``Motions`` in rows, and ``places`` its offsets and last samples.
    """
    ensemble = referred(
        Ensemble(
            call.counter, call.cases, pivots, factors, rows, intervals, intervals, free
        )
    )
    motions = referred(_motions(samples, extremes, places))
    _integrate_blocks(ensemble, motions, call.blocks, outcomes)


@kernel
def count_stacks(
    call, parts, factors, rows, intervals, free, samples, extremes, places, outcomes
):  # fmt: skip
    """Integrate a block on a pedestal likewise; see ``lanes.scheduler.integrate_stacks``."""
    ensemble = referred(
        Ensemble(
            call.counter, call.cases, call.body, factors, rows, intervals, parts, free
        )
    )
    own = call.stacks
    worker = stack_case.Worker(
        own.one, own.two, own.cases, own.waiting, own.waits, own.busy,
        own.ones, own.twos, own.impacts, own.restoring, own.series, own.state,
    )  # fmt: skip
    motions = referred(_motions(samples, extremes, places))
    _integrate_stacks(ensemble, motions, referred(worker), outcomes)


@kernel
def _motions(samples, extremes, places):
    return Motions(
        samples, samples[:0], extremes[0], extremes[1], extremes[2], extremes[3],
        samples[:0], samples[:0], places[0], places[1],
    )  # fmt: skip
