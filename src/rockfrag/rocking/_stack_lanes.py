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
from rockfrag.rocking._compile import entry_kernel
from rockfrag.rocking._mechanics import BODY
from rockfrag.rocking._stack_cases import (
    END,
    FLOATS,
    INTEGERS,
    SLOTS,
    K,
    carry_on,
    event_of_one,
    event_of_two,
    goes_on,
    kind_of,
    place_one,
    place_two,
    store_one,
    store_two,
    strike_case,
)
from rockfrag.rocking._stack_table import LANES, QUIET, TABLE, WITHIN
from rockfrag.rocking._step import SCRATCH
from rockfrag.rocking._tally import SUMMARY

# Rows of the lanes' integers: slot of the case, -1 for none; sample it has reached; last sample of its motion.
SLOT, AT, LAST = (LANES * row for row in range(3))


def working_arrays():
    """Arrays that a thread works in: lanes of both kinds, slots, waiting slots, tables, scratch and summary."""
    integers = np.int64
    return (
        np.zeros(one.ROWS * LANES), np.full(3 * LANES, -1, integers),
        np.zeros(two.ROWS * LANES), np.full(3 * LANES, -1, integers),
        np.zeros(FLOATS), np.full(INTEGERS, -1, integers),
        np.zeros(2 * SLOTS, integers), np.zeros(2, integers), np.zeros(2, integers),
        np.zeros(SLOTS * TABLE), np.zeros(SCRATCH), np.zeros(SUMMARY),
    )  # fmt: skip


_N, _I, _B = types.float64, types.int64, types.boolean
_NS, _IS = types.float64[::1], types.int64[::1]
_BODY = from_dtype(BODY)
_BODIES, _TABLE, _IS_TABLE = _BODY[::1], types.float64[:, ::1], types.int64[:, ::1]


def compile_events():
    """Compile what takes cases through events, a half of the work."""
    event = (_I, _I, _NS, _NS, _IS, _NS, _NS, _BODIES, _NS, _N, _N, _NS)
    strike_case.compile(
        (_NS, _IS, _I, _NS, _BODY, _B, _B, _I, _I, _N, _N, _N, _N, _N, _N, _B, _I, _N, _NS, _NS)
    )
    event_of_two.compile(event)
    event_of_one.compile(event)


def compile_others():
    """Compile the other half."""
    one.go_back.compile((_NS, _I, _N))
    two.advance.compile((_NS, _N))
    one.advance.compile((_NS, _N))
    place = (_I, _I, _NS, _NS, _IS, _NS, _NS)
    place_two.compile(place)
    place_one.compile(place)
    store_two.compile((_I, _I, _NS, _NS))
    store_one.compile((_I, _I, _NS, _NS, _IS))
    carry_on.compile(
        (
            _I, _NS, _IS, _NS, _IS, _I, _BODIES, _TABLE, _TABLE, _IS_TABLE, _TABLE, _IS_TABLE, _IS, _IS, _NS, _NS,
            _NS, _TABLE,
        )
    )  # fmt: skip


@entry_kernel
def stack_cases(
    counter, count, parameters, intervals, parts, free, factors, rows, offsets, lasts, samples, highest, lowest,
    closing_speed, results,
    x1, lanes1, x2, lanes2, s, n, waiting, waits, busy, t, q, summary,
):  # fmt: skip
    """March cases of bodies × motions × scales, the scale running fastest, until none is left.

    Parameters
    ----------
    counter : (1,) the next case to take, shared by all threads
    count : number of cases
    parameters : (bodies,) of BODY
    intervals : (bodies, motions) sampling interval of the sampled motion [s]
    parts : (bodies, motions) largest part of it that a step of two rotations may take
    free : (bodies, motions) samples of free rocking
    factors : (motions, scales)
    rows : (bodies, motions) which of the sampled motions to use
    offsets : (sampled motions + 1,) where each begins; each ends with a sample of zero
    lasts : (sampled motions,) its last sample
    samples : all sampled motions end to end [m/s²]
    highest, lowest : extremes of each BLOCK of ``samples``
    results : (count, RESULTS)
    x1, ..., summary : ``working_arrays``

    Returns
    -------
    Numbers of steps that lanes of one rotation and of two were advanced by.
    """
    g = parameters[0].gravity
    for j in range(SLOTS):
        carry_on(
            j, s, n, t, counter, count, parameters, intervals, parts, free, factors, rows, offsets, lasts,
            samples, highest, lowest, results,
        )  # fmt: skip
        kind = kind_of(n, j)
        if kind >= 0:
            waiting[SLOTS * kind + waits[kind]] = j
            waits[kind] += 1
    steps1, steps2 = 0, 0
    while busy[0] + waits[0] + busy[1] + waits[1] > 0:
        if busy[0] + waits[0] >= min(LANES, busy[1] + waits[1]):
            kind, x, lanes, flag, factor, ground_end = (
                0, x1, lanes1, one.FLAG, one.FACTOR, one.GROUND_END,
            )  # fmt: skip
            steps1 += LANES
            one.advance(x, g)
        else:
            kind, x, lanes, flag, factor, ground_end = (
                1, x2, lanes2, two.FLAG, two.FACTOR, two.GROUND_END,
            )  # fmt: skip
            steps2 += LANES
            two.advance(x, g)
        for i in range(LANES):
            j = lanes[SLOT + i]
            if j >= 0:
                if x[flag + i] == WITHIN:
                    continue
                k = lanes[AT + i]
                if x[flag + i] == QUIET:
                    k += 1
                    lanes[AT + i] = k
                    if k < lanes[LAST + i]:
                        x[ground_end + i] = x[factor + i] * samples[k + 1]
                        continue
                n[K + j] = k
                if kind == 0:
                    if x[flag + i] == QUIET:
                        store_one(i, j, x, s, n)
                    else:
                        event_of_one(
                            i, j, x, s, n, t, q, parameters, samples, g, closing_speed, summary
                        )
                elif x[flag + i] == QUIET:
                    store_two(i, j, x, s)
                else:
                    event_of_two(
                        i, j, x, s, n, t, q, parameters, samples, g, closing_speed, summary
                    )
                if not goes_on(n, j):
                    carry_on(
                        j, s, n, t, counter, count, parameters, intervals, parts, free, factors, rows, offsets,
                        lasts, samples, highest, lowest, results,
                    )  # fmt: skip
                now = kind_of(n, j)
                if now != kind:
                    if now >= 0:
                        waiting[SLOTS * now + waits[now]] = j
                        waits[now] += 1
                    j = -1
                    busy[kind] -= 1
            if j < 0:
                if waits[kind] == 0:
                    # what the lane computes from here on, nobody looks at
                    lanes[SLOT + i] = -1
                    continue
                waits[kind] -= 1
                busy[kind] += 1
                j = waiting[SLOTS * kind + waits[kind]]
            lanes[SLOT + i], lanes[AT + i], lanes[LAST + i] = j, n[K + j], n[END + j]
            if kind == 0:
                place_one(i, j, x, s, n, t, samples)
            else:
                place_two(i, j, x, s, n, t, samples)
    return steps1, steps2
