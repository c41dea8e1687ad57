"""What happens to lanes of every kind between two passes."""

import numba
import numpy as np

WITHIN, QUIET = -1.0, 0.0
"""Flags of a lane that has not yet reached the end of its sample, or has; positive ones are events."""


@numba.njit(inline="always", error_model="numpy")
def next_samples(x, n, flag, factor, ground_end, k, last, lanes, samples):
    """Give the lanes that have reached the end of their sample the next one; the bits of those that must stop.

    A lane stops for an event, and at the end of its motion and after it.

    Parameters
    ----------
    x, n : rows of the lanes, of numbers and of integers
    flag, factor, ground_end : rows of x: flags, scale of the motion, ground acceleration at the sample's end
    k, last : rows of n: the sample that a lane has reached, and the last one of its motion
    lanes : number of lanes
    samples : all motions end to end
    """
    stops = 0
    for i in range(lanes):
        at = n[k + i] + (1 if x[flag + i] == QUIET else 0)
        n[k + i] = at
        stops |= (1 << i) if (x[flag + i] > QUIET) | (at >= n[last + i]) else 0
    for i in range(lanes):
        # unsigned, as an index that may be negative is looked at before it is used
        following = np.uint64(min(n[k + i] + 1, n[last + i]))
        x[ground_end + i] = x[factor + i] * samples[following]
    return stops
