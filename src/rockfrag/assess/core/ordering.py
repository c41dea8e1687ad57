"""Sorting without memory of its own, and what is read off sorted numbers; compiled.

In: arrays of numbers. Out: the same sorted, quantiles and places in them. It is arithmetic, which no page derives;
how it is compiled says ``docs/kernels.md``.
"""

import math

from rockfrag.assess.core.compiled import kernel


@kernel
def sort(values):
    """Sort numbers in place by a heap (Williams 1964)."""
    size = values.size
    for start in range(size // 2 - 1, -1, -1):
        _sift(values, start, size)
    for end in range(size - 1, 0, -1):
        values[0], values[end] = values[end], values[0]
        _sift(values, 0, end)


@kernel
def _sift(values, root, end):
    """Let the number at ``root`` sink to its place in a heap of the first ``end`` values."""
    here = values[root]
    while True:
        child = 2 * root + 1
        if child >= end:
            break
        if child + 1 < end and values[child] < values[child + 1]:
            child += 1
        if not here < values[child]:
            break
        values[root] = values[child]
        root = child
    values[root] = here


@kernel
def quantile(ordered, count, part):
    """Quantile at a ``part`` [-] of the first ``count`` numbers of a rising array, linear between them."""
    at = part * (count - 1)
    low = math.floor(at)
    if low + 1 >= count:
        return ordered[count - 1]
    return ordered[low] + (at - low) * (ordered[low + 1] - ordered[low])


@kernel
def mean(values):
    """Mean of numbers, added in their order."""
    total = 0.0
    for i in range(values.size):
        total += values[i]
    return total / values.size


@kernel
def variance(values):
    """Variance of numbers, with their count in its denominator."""
    middle = mean(values)
    total = 0.0
    for i in range(values.size):
        total += (values[i] - middle) * (values[i] - middle)
    return total / values.size
