"""Ensembles of stacks, many cases side by side, in lanes of two kinds (``docs/kernels.md``, "Two schedulers").

One pass advances all lanes of a kind; contact events, rest, outcomes and the next case are handled case by case
between passes.  A case whose contact event changes its kind waits for a lane of the other.

In: an ensemble, and motions. Out: records OUTCOME of all cases.
"""

from rockfrag.engines.compile.jit import entry_kernel, inlined_kernel, lowest_bit
from rockfrag.engines.pure_rocking.kernels.lanes import stack_case, stack_one, stack_two
from rockfrag.engines.pure_rocking.kernels.lanes.case import (
    LANES,
    QUIET,
    WITHIN,
    next_samples,
)
from rockfrag.engines.pure_rocking.kernels.lanes.stack_case import (
    BOTH_ROTATE,
    ONE_ROTATES,
)

EMPTY = -1  # slot of a lane that holds no case


@entry_kernel
def integrate_stacks(ensemble, motions, worker, outcomes):
    """Integrate an ensemble of stacks: this thread takes case after case until none is left.

    Parameters
    ----------
    ensemble : an :class:`Ensemble` whose bodies are ``equations.BODY``, with scales as factors
    motions : a :class:`Motions`: horizontal [m/s²], vertical over g [-]
    worker : a ``stack_case.Worker``, the memory of this thread
    outcomes : records ``OUTCOME`` of all cases, changed in place

    Returns
    -------
    Steps that lanes of one and of two rotations made, to see how busy they were.
    """
    stack_case.begin(worker)
    for slot in range(stack_case.SLOTS):
        case = worker.cases[slot]
        stack_case.next_case(case, ensemble, motions, worker, outcomes)
        _wait(case, worker)
    steps_of_one, steps_of_two = 0, 0
    while _left(worker, ONE_ROTATES) + _left(worker, BOTH_ROTATE) > 0:
        kind = _fuller_kind(worker)
        if kind == ONE_ROTATES:
            steps_of_one += LANES
        else:
            steps_of_two += LANES
        stops = _advance(kind, worker, ensemble, motions)
        while stops != 0:
            i = lowest_bit(stops)
            stops &= stops - 1
            _serve_lane(i, kind, worker, ensemble, motions, outcomes)
    return steps_of_one, steps_of_two


@inlined_kernel
def _left(worker, kind):
    """Number of cases of a kind, ONE_ROTATES or BOTH_ROTATE, that are in lanes or wait for one."""
    return worker.busy[kind] + worker.waits[kind]


@inlined_kernel
def _fuller_kind(worker):
    """Kind of lanes to advance: the one that fills its lanes, of one rotation first; else that with more cases."""
    if _left(worker, ONE_ROTATES) >= min(LANES, _left(worker, BOTH_ROTATE)):
        return ONE_ROTATES
    return BOTH_ROTATE


@inlined_kernel
def _advance(kind, worker, ensemble, motions):
    """Advance all lanes of a kind by one step, and find their contact events; bits of the lanes to be served."""
    g = ensemble.bodies[0].gravity
    upward = motions.vertical.size > 0
    if kind == ONE_ROTATES:
        stack_one.advance(worker.one, g, upward)
        return next_samples(worker.one, worker.one.factor, LANES, motions)
    stack_two.advance(worker.two, g, upward)
    stops = next_samples(worker.two, worker.two.factor, LANES, motions)
    stack_case.find_contact_events_of_two(stops, worker)
    return stops


@inlined_kernel
def _serve_lane(i, kind, worker, ensemble, motions, outcomes):
    """Take the case of lane i through its contact event or its end, and fill the lane anew.

    A case that now needs a lane of the other kind, or has ended with no case after it, leaves; a waiting case of
    this kind takes its place.
    """
    ones = kind == ONE_ROTATES
    slot = worker.one.slot[i] if ones else worker.two.slot[i]
    flag = worker.one.flag[i] if ones else worker.two.flag[i]
    if slot != EMPTY and flag == WITHIN:
        return
    # numbers of cases by kind: in lanes, and waiting for one
    waits, busy = worker.waits, worker.busy
    if slot != EMPTY:
        case = worker.cases[slot]
        case.k = worker.one.k[i] if ones else worker.two.k[i]
        _leave_lane(i, case, flag, ones, worker, ensemble, motions)
        if not stack_case.rocks_on(case):
            stack_case.next_case(case, ensemble, motions, worker, outcomes)
        if stack_case.lane_of(case) != kind:
            _wait(case, worker)
            slot = EMPTY
            busy[kind] -= 1
    if slot == EMPTY and waits[kind] > 0:
        waits[kind] -= 1
        busy[kind] += 1
        slot = worker.waiting[kind, waits[kind]]
    if ones:
        if _take_slot(worker.one, i, slot, worker.cases):
            stack_case.place_one(i, worker.cases[slot], worker, motions)
    elif _take_slot(worker.two, i, slot, worker.cases):
        stack_case.place_two(i, worker.cases[slot], worker, motions)


@inlined_kernel
def _leave_lane(i, case, flag, ones, worker, ensemble, motions):
    """Take the state of lane i into its case; where a contact event stopped it, go through the event.

    ``flag`` is the lane's (``case.QUIET`` and its like), ``ones`` whether it is one of one rotation.
    """
    if flag == QUIET:
        if ones:
            stack_case.store_one(i, case, worker.one)
        else:
            stack_case.store_two(i, case, worker.two)
        return
    g = ensemble.bodies[0].gravity
    if ones:
        closes = stack_case.contact_event_of_one(i, case, worker, ensemble, motions, g)
    else:
        closes = stack_case.contact_event_of_two(i, case, worker, ensemble, motions, g)
    if closes[0] or closes[1]:
        body = ensemble.bodies[case.body]
        stack_case.general_impact(case, worker, body, closes, motions)
    stack_case.after_contact_event(case)


@inlined_kernel
def _wait(case, worker):
    """Let a case wait for a lane of the kind that it needs."""
    kind = stack_case.lane_of(case)
    if kind != stack_case.NO_CASE:
        worker.waiting[kind, worker.waits[kind]] = case.slot
        worker.waits[kind] += 1


@inlined_kernel
def _take_slot(lane, i, slot, cases):
    """Give lane i the case of a slot, or none if that is EMPTY; return whether there is one."""
    if slot == EMPTY:
        # what the lane computes from here on, nobody looks at; at its last sample, it stops each time
        lane.slot[i], lane.k[i], lane.last[i] = -1, 0, 0
        return False
    lane.slot[i], lane.k[i], lane.last[i] = slot, cases[slot].k, cases[slot].last
    return True
