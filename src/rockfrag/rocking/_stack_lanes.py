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

from rockfrag.rocking import _one_rotation as one
from rockfrag.rocking import _two_rotations as two
from rockfrag.rocking._compile import kernel
from rockfrag.rocking._mechanics import GRAVITY
from rockfrag.rocking._stack_cases import (
    BODY,
    CASE,
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
)
from rockfrag.rocking._stack_table import TABLE
from rockfrag.rocking._step import SCRATCH
from rockfrag.rocking._tally import SUMMARY

# Rows of the lanes' integers: slot of the case, -1 for none; sample it has reached; last sample of its motion.
SLOT1, K1, END1 = (one.LANES * row for row in range(3))
SLOT2, K2, END2 = (two.LANES * row for row in range(3))


def working_arrays():
    """Arrays that a thread works in: lanes and slots, waiting slots, tables, scratch and summary."""
    integers = np.int64
    return (
        np.zeros(one.ROWS * one.LANES), np.full(3 * one.LANES, -1, integers),
        np.zeros(two.ROWS * two.LANES), np.full(3 * two.LANES, -1, integers),
        np.zeros(FLOATS), np.full(INTEGERS, -1, integers),
        np.zeros(2 * SLOTS, integers), np.zeros(SLOTS * TABLE), np.zeros(SCRATCH), np.zeros(SUMMARY),
    )  # fmt: skip


@kernel
def stack_cases(
    counter, count, parameters, intervals, parts, free, factors, rows, offsets, lasts, samples, highest, lowest,
    closing_speed, results,
    x1, lanes1, x2, lanes2, s, n, waiting, t, q, summary,
):  # fmt: skip
    """March cases of bodies × motions × scales, the scale running fastest, until none is left.

    Parameters
    ----------
    counter : (1,) the next case to take, shared by all threads
    count : number of cases
    parameters : (bodies, PARAMETERS)
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
    g = parameters[0, GRAVITY]
    waiting1, waiting2, busy1, busy2 = 0, 0, 0, 0
    for j in range(SLOTS):
        carry_on(
            j, s, n, t, counter, count, parameters, intervals, parts, free, factors, rows, offsets, lasts,
            samples, highest, lowest, results,
        )  # fmt: skip
        if kind_of(n, j) == 0:
            waiting[waiting1] = j
            waiting1 += 1
        elif kind_of(n, j) == 1:
            waiting[SLOTS + waiting2] = j
            waiting2 += 1
    for i in range(one.LANES):
        _idle_one(i, x1)
    for i in range(two.LANES):
        _idle_two(i, x2)
    steps1, steps2 = 0, 0
    while busy1 + waiting1 + busy2 + waiting2 > 0:
        if busy1 + waiting1 >= min(one.LANES, busy2 + waiting2):
            if busy1 < one.LANES:
                for i in range(one.LANES):
                    if lanes1[SLOT1 + i] < 0 and waiting1 > 0:
                        waiting1 -= 1
                        busy1 += 1
                        j = waiting[waiting1]
                        lanes1[SLOT1 + i], lanes1[K1 + i], lanes1[END1 + i] = j, n[K + j], n[END + j]
                        place_one(i, j, x1, s, n, t, samples)
            one.advance(x1, g)
            steps1 += one.LANES
            for i in range(one.LANES):
                j = lanes1[SLOT1 + i]
                if j < 0:
                    continue
                if x1[one.FLAG + i] == one.QUIET:
                    k = lanes1[K1 + i] + 1
                    lanes1[K1 + i] = k
                    if k < lanes1[END1 + i]:
                        x1[one.GROUND_END + i] = x1[one.FACTOR + i] * samples[k + 1]
                        continue
                    n[K + j] = k
                    store_one(i, j, x1, s, n)
                else:
                    n[K + j] = lanes1[K1 + i]
                    event_of_one(
                        i, j, x1, s, n, t, q, parameters, samples, g, closing_speed, summary
                    )
                if not goes_on(n, j):
                    carry_on(
                        j, s, n, t, counter, count, parameters, intervals, parts, free, factors, rows, offsets,
                        lasts, samples, highest, lowest, results,
                    )  # fmt: skip
                kind = kind_of(n, j)
                if kind != 0:
                    if kind == 1:
                        waiting[SLOTS + waiting2] = j
                        waiting2 += 1
                    if waiting1 == 0:
                        lanes1[SLOT1 + i] = -1
                        busy1 -= 1
                        _idle_one(i, x1)
                        continue
                    waiting1 -= 1
                    j = waiting[waiting1]
                lanes1[SLOT1 + i], lanes1[K1 + i], lanes1[END1 + i] = j, n[K + j], n[END + j]
                place_one(i, j, x1, s, n, t, samples)
        else:
            if busy2 < two.LANES:
                for i in range(two.LANES):
                    if lanes2[SLOT2 + i] < 0 and waiting2 > 0:
                        waiting2 -= 1
                        busy2 += 1
                        j = waiting[SLOTS + waiting2]
                        lanes2[SLOT2 + i], lanes2[K2 + i], lanes2[END2 + i] = j, n[K + j], n[END + j]
                        place_two(i, j, x2, s, n, t, samples)
            two.advance(x2, g)
            steps2 += two.LANES
            for i in range(two.LANES):
                j = lanes2[SLOT2 + i]
                if j < 0 or x2[two.FLAG + i] == two.WITHIN:
                    continue
                if x2[two.FLAG + i] == two.QUIET:
                    k = lanes2[K2 + i] + 1
                    lanes2[K2 + i] = k
                    if k < lanes2[END2 + i]:
                        x2[two.GROUND_END + i] = x2[two.FACTOR + i] * samples[k + 1]
                        continue
                    n[K + j] = k
                    store_two(i, j, x2, s)
                else:
                    n[K + j] = lanes2[K2 + i]
                    event_of_two(
                        i, j, x2, s, n, t, q, parameters, samples, g, closing_speed, summary
                    )
                if not goes_on(n, j):
                    carry_on(
                        j, s, n, t, counter, count, parameters, intervals, parts, free, factors, rows, offsets,
                        lasts, samples, highest, lowest, results,
                    )  # fmt: skip
                kind = kind_of(n, j)
                if kind != 1:
                    if kind == 0:
                        waiting[waiting1] = j
                        waiting1 += 1
                    if waiting2 == 0:
                        lanes2[SLOT2 + i] = -1
                        busy2 -= 1
                        _idle_two(i, x2)
                        continue
                    waiting2 -= 1
                    j = waiting[SLOTS + waiting2]
                lanes2[SLOT2 + i], lanes2[K2 + i], lanes2[END2 + i] = j, n[K + j], n[END + j]
                place_two(i, j, x2, s, n, t, samples)
    return steps1, steps2


@kernel
def _idle_one(i, x):
    """Let a lane without a case stand still at a harmless place."""
    for m in range(one.ROWS):
        x[m * one.LANES + i] = 0.0
    x[one.LEFT + i] = 1.0


@kernel
def _idle_two(i, x):
    """Likewise one of two rotations."""
    for m in range(two.ROWS):
        x[m * two.LANES + i] = 0.0
    x[two.LEFT + i] = 1.0
    x[two.PART + i] = 1.0
    for inertia in two.INERTIAS:
        x[inertia + i] = 1.0
