"""Ensembles of stacks, many cases side by side.

There are lanes for the cases of which one part rotates and lanes for those of which both blocks do
(``_one_rotation``, ``_two_rotations``), because the arithmetic of the second costs twice that of the first.
One pass advances all lanes of a kind; what is rare (events, rest, verdicts, the next case) is handled case by
case between passes (``_stack_cases``).  A case whose event changes its kind waits for a lane of the other: there
are as many cases in flight as lanes, so that one kind or the other can always fill its lanes.

A case's numbers depend on that case alone, so neither the number of lanes nor their neighbours nor the threads
change a bit of them.
"""

import numpy as np
from numba import from_dtype, types

from rockfrag.rocking import _one_rotation as one
from rockfrag.rocking import _two_rotations as two
from rockfrag.rocking._compile import entry_kernel, inlined_kernel
from rockfrag.rocking._intrinsics import lowest_bit
from rockfrag.rocking._mechanics import BODY
from rockfrag.rocking._passes import QUIET, WITHIN, next_samples
from rockfrag.rocking._stack_cases import (
    CASE,
    OUTCOME,
    SLOTS,
    carry_on,
    event_of_one,
    event_of_two,
    goes_on,
    kind_of,
    pass_event,
    place_one,
    place_two,
    store_one,
    store_two,
    strike_case,
)
from rockfrag.rocking._stack_impacts import meet
from rockfrag.rocking._stack_table import LANES, TABLE
from rockfrag.rocking._step import SCRATCH
from rockfrag.rocking._tally import SUMMARY

# Rows of the lanes' integers: slot of the case, -1 for none; sample it has reached; last sample of its motion.
SLOT, AT, LAST = (LANES * row for row in range(3))


def working_arrays():
    """Arrays that a thread works in: lanes of both kinds, cases, waiting slots, tables, scratch and summary."""
    integers = np.int64
    idle = np.zeros(3 * LANES, integers)
    idle[SLOT : SLOT + LANES] = -1
    cases = np.zeros(SLOTS, CASE)
    cases["number"] = cases["body"] = -1
    cases["table"] = TABLE * np.arange(SLOTS)
    return (
        np.zeros(one.ROWS * LANES), idle, np.zeros(two.ROWS * LANES), idle.copy(),
        cases, np.zeros(2 * SLOTS, integers), np.zeros(2, integers), np.zeros(2, integers),
        np.zeros(SLOTS * TABLE), np.zeros(SCRATCH), np.zeros(SUMMARY),
    )  # fmt: skip


@inlined_kernel
def _next_samples_of_one(x, lanes, samples):
    return next_samples(x, lanes, one.FLAG, one.FACTOR, one.GROUND_END, AT, LAST, LANES, samples)


@inlined_kernel
def _next_samples_of_two(x, lanes, samples):
    return next_samples(x, lanes, two.FLAG, two.FACTOR, two.GROUND_END, AT, LAST, LANES, samples)


_N, _I, _B = types.float64, types.int64, types.boolean
_NS, _IS, _TABLE, _IS_TABLE = _N[::1], _I[::1], _N[:, ::1], _I[:, ::1]
_BODY, _CASE, _OUTCOME = from_dtype(BODY), from_dtype(CASE), from_dtype(OUTCOME)


def compile_events():
    """Compile what takes cases through events, a half of the work."""
    strike_case.compile((_CASE, _NS, _BODY, _B, _B, _N, _NS, _NS))
    event = (_I, _CASE, _NS, _NS, _NS, _BODY[::1], _NS, _N, _N)
    event_of_two.compile(event)
    event_of_one.compile(event)


def compile_others():
    """Compile the other half, what the first also needs at once: it finds that in the cache."""
    meet.compile((_CASE, _NS, _B, _N, _N, _NS))
    one.go_back.compile((_NS, _I, _N))
    two.advance.compile((_NS, _N))
    one.advance.compile((_NS, _N))
    place_two.compile((_I, _CASE, _NS, _NS, _NS))
    place_one.compile((_I, _CASE, _NS, _NS, _NS))
    store_two.compile((_I, _CASE, _NS))
    store_one.compile((_I, _CASE, _NS))
    for kernel in (kind_of, goes_on, pass_event):
        kernel.compile((_CASE,))
    for kernel in (_next_samples_of_one, _next_samples_of_two):
        kernel.compile((_NS, _IS, _NS))
    carry_on.compile(
        (
            _CASE, _NS, _IS, _I, _BODY[::1], _TABLE, _TABLE, _IS_TABLE, _TABLE, _IS_TABLE, _IS, _IS, _NS,
            _NS, _NS, _OUTCOME[::1],
        )
    )  # fmt: skip


@entry_kernel
def stack_cases(
    counter, count, bodies, intervals, parts, free, factors, rows, offsets, lasts, samples, highest, lowest,
    closing_speed, outcomes,
    x1, lanes1, x2, lanes2, cases, waiting, waits, busy, t, q, summary,
):  # fmt: skip
    """March cases of bodies × motions × scales, the scale running fastest, until none is left.

    Parameters
    ----------
    counter : (1,) the next case to take, shared by all threads
    count : number of cases
    bodies : (bodies,) of BODY
    intervals : (bodies, motions) sampling interval of the sampled motion [s]
    parts : (bodies, motions) largest part of it that a step of two rotations may take
    free : (bodies, motions) samples of free rocking
    factors : (motions, scales)
    rows : (bodies, motions) which of the sampled motions to use
    offsets : (sampled motions + 1,) where each begins; each ends with a sample of zero
    lasts : (sampled motions,) its last sample
    samples : all sampled motions end to end [m/s²]
    highest, lowest : extremes of each BLOCK of ``samples``
    outcomes : (count,) of OUTCOME
    x1, ..., summary : ``working_arrays``

    Returns
    -------
    Numbers of steps that lanes of one rotation and of two were advanced by.
    """
    g = bodies[0].gravity
    for j in range(SLOTS):
        carry_on(
            cases[j], t, counter, count, bodies, intervals, parts, free, factors, rows, offsets, lasts,
            samples, highest, lowest, outcomes,
        )  # fmt: skip
        kind = kind_of(cases[j])
        if kind >= 0:
            waiting[SLOTS * kind + waits[kind]] = j
            waits[kind] += 1
    steps1, steps2 = 0, 0
    while busy[0] + waits[0] + busy[1] + waits[1] > 0:
        if busy[0] + waits[0] >= min(LANES, busy[1] + waits[1]):
            kind, x, lanes, flag = 0, x1, lanes1, one.FLAG
            steps1 += LANES
            one.advance(x1, g)
            stops = _next_samples_of_one(x1, lanes1, samples)
        else:
            kind, x, lanes, flag = 1, x2, lanes2, two.FLAG
            steps2 += LANES
            two.advance(x2, g)
            stops = _next_samples_of_two(x2, lanes2, samples)
        while stops != 0:
            i = lowest_bit(stops)
            stops &= stops - 1
            j = lanes[SLOT + i]
            if j >= 0:
                if x[flag + i] == WITHIN:
                    continue
                case = cases[j]
                case.k = lanes[AT + i]
                if x[flag + i] == QUIET:
                    if kind == 0:
                        store_one(i, case, x)
                    else:
                        store_two(i, case, x)
                else:
                    if kind == 0:
                        closes1, closes2 = event_of_one(
                            i, case, x, t, q, bodies, samples, g, closing_speed
                        )
                    else:
                        closes1, closes2 = event_of_two(
                            i, case, x, t, q, bodies, samples, g, closing_speed
                        )
                    if closes1 or closes2:
                        strike_case(
                            case, t, bodies[case.body], closes1, closes2, closing_speed, samples, summary
                        )  # fmt: skip
                    pass_event(case)
                if not goes_on(case):
                    carry_on(
                        case, t, counter, count, bodies, intervals, parts, free, factors, rows, offsets, lasts,
                        samples, highest, lowest, outcomes,
                    )  # fmt: skip
                now = kind_of(case)
                if now != kind:
                    if now >= 0:
                        waiting[SLOTS * now + waits[now]] = j
                        waits[now] += 1
                    j = -1
                    busy[kind] -= 1
            if j < 0:
                if waits[kind] == 0:
                    # what the lane computes from here on, nobody looks at; at its last sample, it stops each time
                    lanes[SLOT + i], lanes[AT + i], lanes[LAST + i] = -1, 0, 0
                    continue
                waits[kind] -= 1
                busy[kind] += 1
                j = waiting[SLOTS * kind + waits[kind]]
            case = cases[j]
            lanes[SLOT + i], lanes[AT + i], lanes[LAST + i] = j, case.k, case.last
            if kind == 0:
                place_one(i, case, x, t, samples)
            else:
                place_two(i, case, x, t, samples)
    return steps1, steps2
