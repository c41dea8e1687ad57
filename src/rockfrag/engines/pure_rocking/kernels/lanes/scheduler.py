"""Ensembles of stacks, many cases side by side, in lanes of two kinds (``docs/kernels.md``, "Two schedulers").

One pass advances all lanes of a kind; contact events, rest, outcomes and the next case are handled case by case
between passes.  A case whose contact event changes its kind waits for a lane of the other.
"""

from rockfrag.engines.compile.jit import entry_kernel, inlined_kernel, lowest_bit
from rockfrag.engines.pure_rocking.kernels.lanes import stack_case, stack_one, stack_two
from rockfrag.engines.pure_rocking.kernels.lanes.case import (
    LANES,
    QUIET,
    WITHIN,
    next_samples,
)


@entry_kernel
def integrate_stacks(ensemble, motions, worker, outcomes):
    """Integrate the cases of an ensemble of stacks, a worker a thread; steps of one rotation and of two.

    Parameters
    ----------
    ensemble : an :class:`Ensemble` of bodies, scales and steps
    motions : a :class:`Motions`, accelerations over g
    worker : named tuple of records, the memory of one thread
    outcomes : records ``OUTCOME`` of all cases, changed in place
    """
    g = ensemble.bodies[0].gravity
    upward = motions.vertical.size > 0
    stack_case.begin(worker)
    for slot in range(stack_case.SLOTS):
        case = worker.cases[slot]
        stack_case.next_case(case, ensemble, motions, worker, outcomes)
        _wait(case, worker)
    steps1, steps2 = 0, 0
    waits, busy = worker.waits, worker.busy
    while busy[0] + waits[0] + busy[1] + waits[1] > 0:
        ones = busy[0] + waits[0] >= min(LANES, busy[1] + waits[1])
        kind = stack_case.ONE_ROTATES if ones else stack_case.BOTH_ROTATE
        if ones:
            steps1 += LANES
            stack_one.advance(worker.one, g, upward)
            stops = next_samples(worker.one, worker.one.factor, LANES, motions)
        else:
            steps2 += LANES
            stack_two.advance(worker.two, g, upward)
            stops = next_samples(worker.two, worker.two.factor, LANES, motions)
            stack_case.find_contact_events_of_two(stops, worker)
        while stops != 0:
            i = lowest_bit(stops)
            stops &= stops - 1
            slot = worker.one.slot[i] if ones else worker.two.slot[i]
            flag = worker.one.flag[i] if ones else worker.two.flag[i]
            if slot >= 0:
                if flag == WITHIN:
                    continue
                case = worker.cases[slot]
                case.k = worker.one.k[i] if ones else worker.two.k[i]
                if flag == QUIET:
                    if ones:
                        stack_case.store_one(i, case, worker.one)
                    else:
                        stack_case.store_two(i, case, worker.two)
                else:
                    if ones:
                        closes = stack_case.contact_event_of_one(
                            i, case, worker, ensemble, motions, g
                        )
                    else:
                        closes = stack_case.contact_event_of_two(
                            i, case, worker, ensemble, motions, g
                        )
                    if closes[0] or closes[1]:
                        stack_case.general_impact(
                            case, worker, ensemble.bodies[case.body], closes, motions
                        )
                    stack_case.after_contact_event(case)
                if not stack_case.rocks_on(case):
                    stack_case.next_case(case, ensemble, motions, worker, outcomes)
                if stack_case.lane_of(case) != kind:
                    _wait(case, worker)
                    slot = -1
                    busy[kind] -= 1
            if slot < 0 and waits[kind] > 0:
                waits[kind] -= 1
                busy[kind] += 1
                slot = worker.waiting[kind, waits[kind]]
            if ones:
                if _hold(worker.one, i, slot, worker.cases):
                    stack_case.place_one(i, worker.cases[slot], worker, motions)
            elif _hold(worker.two, i, slot, worker.cases):
                stack_case.place_two(i, worker.cases[slot], worker, motions)
    return steps1, steps2


@inlined_kernel
def _wait(case, worker):
    """Let a case wait for a lane of the kind that it needs."""
    kind = stack_case.lane_of(case)
    if kind != stack_case.NO_CASE:
        worker.waiting[kind, worker.waits[kind]] = case.slot
        worker.waits[kind] += 1


@inlined_kernel
def _hold(lane, i, slot, cases):
    """Let lane i hold the case of a slot; whether there is one."""
    if slot < 0:
        # what the lane computes from here on, nobody looks at; at its last sample, it stops each time
        lane.slot[i], lane.k[i], lane.last[i] = -1, 0, 0
        return False
    lane.slot[i], lane.k[i], lane.last[i] = slot, cases[slot].k, cases[slot].last
    return True
