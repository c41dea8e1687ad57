"""The functions of the module that shakes a body by many motions at many levels, as ``overturns`` does.

They are compiled to WebAssembly alone (``build``), around the lanes that everything else is counted with.
"""

import numpy as np

from rockfrag.engines.kernels.by_reference import referred
from rockfrag.engines.kernels.chatter import RESTORING
from rockfrag.engines.kernels.equations import BODY, STATE
from rockfrag.engines.kernels.jit import fma, kernel
from rockfrag.engines.kernels.lanes import block, stack_case, stack_one, stack_two
from rockfrag.engines.kernels.lanes.case import LANES, OUTCOME, Ensemble, Motions
from rockfrag.engines.kernels.lanes.scheduler import integrate_stacks
from rockfrag.engines.kernels.lanes.stack_constants import IMPACT, ONE, TWO
from rockfrag.engines.kernels.taylor import SERIES
from rockfrag.laws import momentum, position
from rockfrag.rocking.browser import entry
from rockfrag.system import geometry

_F, _I = np.float64, np.int64
_SLOTS = stack_case.SLOTS

SHAKEN = np.dtype(
    [
        # what describe reads: whether the ratios of impacts are told, those of the pedestal and of the statue, NaN
        # where momentum's count, and the factor on each
        ("statue", entry.BLOCK), ("pedestal", entry.BLOCK), ("stacked", _I),
        ("told", _I), ("below", _F), ("above", _F), ("livelier", _F),
        # what it leaves; the least acceleration at which a contact opens [g], and constants of the right and left
        # pivot of a lone block
        ("fault", _I), ("fastest", _F), ("slowest", _F), ("uplift", _F), ("largest", _F), ("centre", _F, 3),
        ("body", BODY, 1), ("pivots", block.PIVOT, 2),
        # what count reads
        ("counter", _I, 1), ("cases", _I),
        # what it works in
        ("lane", block.LANE), ("tallies", OUTCOME, block.LANES),
        ("one", stack_one.LANE), ("two", stack_two.LANE), ("slots", stack_case.CASE, _SLOTS),
        ("waiting", _I, (2, _SLOTS)), ("waits", _I, 2), ("busy", _I, 2),
        ("ones", ONE, (_SLOTS, 9)), ("twos", TWO, (_SLOTS, 9)), ("impacts", IMPACT, (_SLOTS, 9)),
        ("restoring", RESTORING, _SLOTS), ("series", SERIES, LANES), ("state", STATE),
    ],
    align=True,
)  # fmt: skip
"""What a page and the module hand to each other."""

# as parts of what is compiled here, and not as the entries that Python calls
_integrate_blocks = kernel(block.integrate_blocks.py_func)
_integrate_stacks = kernel(integrate_stacks.py_func)


@kernel
def multiply_add(call):
    """Put a multiply-add of numbers of a call into it, which tells whether it rounds once."""
    call.uplift = fma(call.above, call.livelier, call.uplift)


@kernel
def describe_shaken(call):
    """Describe a block, or one on a pedestal, to the lanes; gravity stands in its record already."""
    body, g = call.body[0], call.body[0].gravity
    upper, lower = entry.shape_of(call.statue), entry.shape_of(call.pedestal)
    told = call.told != 0
    body.measured = told
    call.fault = geometry.STANDS if geometry.can_stand(upper) else geometry.FALLS_ALONE
    call.uplift, call.largest = np.inf, np.inf
    if call.stacked == 0:
        geometry.fill_block(body, upper)
        call.centre[0], call.centre[1], call.centre[2] = upper.x, upper.y, upper.inertia
        entry.note_frequencies(call, upper, g)
        for pivot in (1, -1):
            after = geometry.momentum_restitution(upper, -pivot)
            if told:
                after = _ratio(call, upper, -pivot, call.above)
            constants = geometry.pivot_constants(upper, pivot, after, g)
            _fill_pivot(call.pivots[(1 - pivot) // 2], constants)
            _note_uplift(call, geometry.arm(upper, pivot))
            call.largest = min(call.largest, geometry.largest_restitution(upper, pivot))
        return
    pile = entry.stacked(call, body, lower, upper, 0.0)
    whole = geometry.joined(pile)
    call.centre[0], call.centre[1], call.centre[2] = whole.x, whole.y, whole.inertia
    _fill_laws(call, lower, pile.upper)
    for pivot in (1, -1):
        _note_uplift(call, geometry.common_arm(pile, pivot))
        _note_uplift(call, geometry.upper_arm(pile, pivot))
        call.largest = min(call.largest, geometry.largest_restitution(lower, pivot))
        call.largest = min(call.largest, geometry.largest_restitution(pile.upper, pivot))


@kernel
def _ratio(call, shape, pivot, measured):
    return geometry.scaled_restitution(shape, pivot, measured, call.livelier)


@kernel
def _fill_laws(call, lower, upper):
    body = call.body[0]
    if call.told == 0:
        for after in (body.after1r, body.after1l, body.after2r, body.after2l):
            after.law, after.value = momentum.NUMBER, 1.0
        return
    _fill_law(call, body.after1r, lower, 1, call.below)
    _fill_law(call, body.after1l, lower, -1, call.below)
    _fill_law(call, body.after2r, upper, 1, call.above)
    _fill_law(call, body.after2l, upper, -1, call.above)


@kernel
def _fill_law(call, after, shape, pivot, measured):
    after.law, after.value = position.tell(shape, _ratio(call, shape, pivot, measured), pivot)


@kernel
def _fill_pivot(pivot, constants):
    (
        pivot.alpha, pivot.tan, pivot.sine, pivot.cosine, pivot.swing, pivot.restitution,
        pivot.per_alpha, pivot.per_swing,
    ) = constants  # fmt: skip


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
        Ensemble(call.counter, call.cases, pivots, factors, rows, intervals, intervals, free)
    )
    worker = referred(block.Worker(call.lane, call.tallies))
    _integrate_blocks(ensemble, referred(_motions(samples, extremes, places)), worker, outcomes)


@kernel
def count_stacks(
    call, parts, factors, rows, intervals, free, samples, extremes, places, outcomes
):  # fmt: skip
    """Integrate a block on a pedestal likewise; see ``lanes.scheduler.integrate_stacks``."""
    for i in range(LANES):
        call.one.slot[i] = call.two.slot[i] = -1
        call.one.was_weight[i] = call.one.before_weight[i] = call.two.was_weight[i] = 1.0
    for slot in range(_SLOTS):
        case = call.slots[slot]
        case.number, case.body, case.slot = -1, -1, slot
    for kind in range(2):
        call.waits[kind] = call.busy[kind] = 0
    ensemble = referred(
        Ensemble(call.counter, call.cases, call.body, factors, rows, intervals, parts, free)
    )
    worker = referred(
        stack_case.Worker(
            call.one, call.two, call.slots, call.waiting, call.waits, call.busy,
            call.ones, call.twos, call.impacts, call.restoring, call.series, call.state,
        )
    )  # fmt: skip
    _integrate_stacks(ensemble, referred(_motions(samples, extremes, places)), worker, outcomes)


@kernel
def _motions(samples, extremes, places):
    return Motions(
        samples, samples[:0], extremes[0], extremes[1], extremes[2], extremes[3],
        samples[:0], samples[:0], places[0], places[1],
    )  # fmt: skip
