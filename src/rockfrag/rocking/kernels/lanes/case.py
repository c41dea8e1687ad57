"""Cases: a body × motion × scale each, what they are taken from, and what remains of them."""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rockfrag.rocking.kernels.jit import inlined_kernel, kernel

LANES = 16
"""Lanes of each kind that stacks march in."""

WITHIN, QUIET, CLOSES, NEARS, RELEASE = -1.0, 0.0, 1.0, 2.0, 3.0
"""Flags of a lane after a pass: it has not yet reached the end of its sample, or has; positive ones are
events: a contact closes, may have closed, or lets go."""

BLOCK = 16
"""Samples under one entry of the tables of extremes that rest is skipped with."""

OUTCOME = np.dtype(
    [
        # what fell (0 none, 1 the pedestal, 2 the statue or lone block), and the samples after which that was
        # certain
        ("fallen", np.int64), ("certain", np.int64),
        # extremes: of θ/θcritical of pedestal and statue, |θ'| of the statue per sample, distance from balance
        ("peak1", np.float64), ("peak2", np.float64), ("fast", np.float64), ("closest", np.float64),
        ("impacts", np.int64),
    ],
    align=True,
)  # fmt: skip
"""What remains of a case; time is counted in samples."""


class Motions(NamedTuple):
    """All motions end to end, sampled as densely as the bodies need.

    Attributes
    ----------
    samples : accelerations of the ground [m/s²]; each motion ends with a sample of zero
    highest, lowest : extremes of each BLOCK of ``samples``
    ahead_high, ahead_low : likewise from the beginning of each BLOCK to the end of its motion
    offsets : (sampled motions + 1,) where each begins
    lasts : (sampled motions,) its last sample
    """

    samples: NDArray[np.float64]
    highest: NDArray[np.float64]
    lowest: NDArray[np.float64]
    ahead_high: NDArray[np.float64]
    ahead_low: NDArray[np.float64]
    offsets: NDArray[np.int64]
    lasts: NDArray[np.int64]


class Ensemble(NamedTuple):
    """Bodies × motions × scales, the scale running fastest.

    Attributes
    ----------
    counter : (1,) the next case to take, shared by all threads
    count : number of cases
    bodies : (bodies,) of BODY, or (bodies, motions, 2) of ``block.POLE`` for lone blocks
    factors : (motions, scales) on the samples
    rows : (bodies, motions) which of the sampled motions to use
    intervals : (bodies, motions) sampling interval of that [s]
    parts : (bodies, motions) largest part of it that a step of two rotations may take
    free : (bodies, motions) samples of free rocking after it, at most
    """

    counter: NDArray[np.int64]
    count: int
    bodies: NDArray[Any]
    factors: NDArray[np.float64]
    rows: NDArray[np.int64]
    intervals: NDArray[np.float64]
    parts: NDArray[np.float64]
    free: NDArray[np.int64]


@inlined_kernel
def place_of(number, ensemble):
    """Body, motion and scale of the case of a number."""
    motions, scales = ensemble.factors.shape
    return number // (scales * motions), (number // scales) % motions, number % scales


@kernel
def next_uplift(motions, k, tau, last, factor, interval):
    """Sample and time within it at which a body at rest rises, and the acceleration then; -1 if it stays.

    Parameters
    ----------
    k, tau : the time: ``tau`` after sample k
    last : last sample of the motion
    factor : on its samples
    interval : (low, high), which holds 0, that the acceleration has to leave (thesis eq. 2.1)
    """
    samples = motions.samples
    low, high = interval
    a0 = factor * samples[k]
    a1 = factor * samples[k + 1]
    now = a0 + tau * (a1 - a0)
    if low <= now <= high and low <= a1 <= high:
        least = low / factor
        most = high / factor
        if factor < 0.0:
            least, most = most, least
        m = _first_outside(motions, k + 1, last, least, most)
        if m < 0:
            return -1, 0.0, 0.0
        k = m - 1
        tau = 0.0
        a0 = factor * samples[k]
        a1 = factor * samples[m]
        now = a0
    if low <= now <= high:
        limit = high if a1 > a0 else low
        tau = min(max(tau, (limit - a0) / (a1 - a0)), 1.0 - 1e-9)
        now = limit
    return k, tau, now


@kernel
def _first_outside(motions, k, last, low, high):
    """First sample after k, up to ``last``, outside [low, high]; -1 if there is none."""
    samples, highest, lowest = motions.samples, motions.highest, motions.lowest
    m = k + 1
    while m <= last:
        if m % BLOCK == 0:
            j = m // BLOCK
            while m + BLOCK <= last + 1 and highest[j] <= high and lowest[j] >= low:
                j += 1
                m += BLOCK
            if m > last:
                break
        if samples[m] > high or samples[m] < low:
            return m
        m += 1
    return -1


@inlined_kernel
def next_samples(lane, factor, lanes, samples):
    """Give the lanes that have reached the end of their sample the next one; the bits of those that must stop.

    A lane stops for an event, and at the end of its motion and after it.

    Parameters
    ----------
    lane : the lanes, of any kind
    factor : the row of factors on the samples
    lanes : number of lanes
    """
    stops = 0
    for i in range(lanes):
        at = lane.k[i] + (1 if lane.flag[i] == QUIET else 0)
        lane.k[i] = at
        stops |= (1 << i) if (lane.flag[i] > QUIET) | (at >= lane.last[i]) else 0
    for i in range(lanes):
        # unsigned, as an index that may be negative is looked at before it is used
        following = np.uint64(min(lane.k[i] + 1, lane.last[i]))
        lane.ground_end[i] = factor[i] * samples[following]
    return stops
