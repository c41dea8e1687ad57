"""Cases: a body × motion × scale each, what they are taken from, and what remains of them.

In: bodies, motions over g and scales. Out: records OUTCOME. Docs: ``docs/kernels.md``, "The life of a case".
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rockfrag.base.arrays import fields, whole
from rockfrag.engines.compile.by_reference import by_reference
from rockfrag.engines.compile.jit import inlined_kernel, kernel

LANES = 16  # lanes of each kind that stacks integrate in
WITHIN, QUIET, CLOSES, NEARS, RELEASE = -1.0, 0.0, 1.0, 2.0, 3.0
"""Flags of a lane after a pass: it has not yet reached the end of its sample, or has; positive ones are
contact events: a contact closes, may have closed, or lets go."""

# samples under one entry of the tables of extremes that rest is skipped with
BLOCK = 16

OUTCOME = np.dtype(
    [
        # what fell (0 none, 1 the pedestal, 2 the statue or lone block), and the samples after which that was
        # certain
        *whole("fallen certain"),
        # extremes: of θ/θcritical of pedestal and statue, |θ'| of the statue per sample, distance from balance
        *fields("peak1 peak2 fast unstable_distance"),
        # given_way: impacts in which the law of a measured restitution had to give way
        *whole("impacts given_way"),
    ],
    align=True,
)
"""What remains of a case; time is counted in samples."""


@by_reference
class Motions(NamedTuple):
    """All motions end to end, sampled as densely as the bodies need."""

    # accelerations of the ground [m/s²]; each motion ends with a sample of zero
    samples: NDArray[np.float64]
    # likewise upwards, such that factors make of it parts of gravity; none if the ground does not
    # move so
    vertical: NDArray[np.float64]
    # highest, lowest: extremes of each BLOCK of ``samples``
    highest: NDArray[np.float64]
    lowest: NDArray[np.float64]
    # ahead_high, ahead_low: likewise from the beginning of each BLOCK to the end of its motion
    ahead_high: NDArray[np.float64]
    ahead_low: NDArray[np.float64]
    # upward_high, upward_low: likewise of ``vertical``
    upward_high: NDArray[np.float64]
    upward_low: NDArray[np.float64]
    offsets: NDArray[np.int64]  # (sampled motions + 1,) where each begins
    lasts: NDArray[np.int64]  # (sampled motions,) its last sample


@by_reference
class Ensemble(NamedTuple):
    """Bodies × motions × scales, the scale running fastest."""

    counter: NDArray[np.int64]  # (1,) the next case to take, shared by all threads
    count: int  # number of cases
    # (bodies,) of BODY, or (bodies, motions, 2) of ``block.PIVOT`` for lone blocks
    bodies: NDArray[Any]
    factors: NDArray[np.float64]  # (motions, scales) on the samples
    rows: NDArray[np.int64]  # (bodies, motions) which of the sampled motions to use
    intervals: NDArray[np.float64]  # (bodies, motions) sampling interval of that [s]
    # (bodies, motions) largest part of it that a step of two rotations may take
    parts: NDArray[np.float64]
    # (bodies, motions) samples of free rocking after it, at most
    free: NDArray[np.int64]


@inlined_kernel
def place_of(number, ensemble):
    """Numbers of body, motion and scale of the case of a ``number``, the scale running fastest."""
    motions, scales = ensemble.factors.shape
    return number // (scales * motions), (number // scales) % motions, number % scales


@inlined_kernel
def weight_of(motions, k, factor):
    """Gravity at sample k over that of a ground that does not move vertically [-]; ``factor``: on the motion."""
    return 1.0 + factor * motions.vertical[k] if motions.vertical.size > 0 else 1.0


@inlined_kernel
def weights_ahead(motions, k, factor):
    """Least and largest gravity from the BLOCK of sample k on, over that of a level ground [-]."""
    if motions.vertical.size == 0:
        return 1.0, 1.0
    first = factor * motions.upward_high[k // BLOCK]
    other = factor * motions.upward_low[k // BLOCK]
    return 1.0 + min(first, other), 1.0 + max(first, other)


@kernel
def next_uplift(motions, k, tau, last, factor, interval):
    """Find when a body at rest is lifted: the acceleration over the weight leaves an interval (Kirkpatrick, 1927).

    Samples that cannot be outside are skipped a BLOCK at a time. Within an interval between samples the
    acceleration and the limits, in proportion to the weight, are linear, so the instant follows exactly.

    Parameters
    ----------
    motions : a :class:`Motions`
    k, tau : sample from which to look, and part of the interval after it that has passed [-]
    last : last sample of the motion
    factor : on the motion
    interval : (low, high), which holds 0, in the unit of the samples times the factor

    Returns
    -------
    Sample, part of the interval after it [-], acceleration times the factor, and weight [-]; the sample is -1 if
    the body stays.
    """
    samples = motions.samples
    low, high = interval
    a0, a1 = factor * samples[k], factor * samples[k + 1]
    w0, w1 = weight_of(motions, k, factor), weight_of(motions, k + 1, factor)
    now, weight = a0 + tau * (a1 - a0), w0 + tau * (w1 - w0)
    rests = low * weight <= now <= high * weight
    if rests and low * w1 <= a1 <= high * w1:
        m = k + 1
        while True:
            # no limit of any later sample is nearer to zero than this
            least_weight, _ = weights_ahead(motions, m, factor)
            least = low * least_weight / factor
            most = high * least_weight / factor
            if factor < 0.0:
                least, most = most, least
            m = _first_outside(motions, m, last, least, most)
            if m < 0:
                return -1, 0.0, 0.0, 1.0
            a1, w1 = factor * samples[m], weight_of(motions, m, factor)
            if not low * w1 <= a1 <= high * w1:
                break
        k, tau = m - 1, 0.0
        a0, w0 = factor * samples[k], weight_of(motions, k, factor)
    if rests:
        limit = high if a1 > high * w1 else low
        reached = (limit * w0 - a0) / ((a1 - a0) - limit * (w1 - w0))
        tau = min(max(tau, reached), 1.0 - 1e-9)
        weight = w0 + tau * (w1 - w0)
        now = limit * weight
    return k, tau, now, weight


@kernel
def _first_outside(motions, k, last, low, high):
    """Number of the first sample after k, up to ``last``, outside [low, high]; -1 if there is none.

    A BLOCK of samples whose extremes lie inside is passed at once.
    """
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
def next_samples(lane, factor, lanes, motions):
    """Give lanes that have reached the end of a sample the next one.

    Parameters
    ----------
    lane : record of lanes, with rows ``k``, ``flag`` and ``last``
    factor : of each lane, on the samples, shape (lanes,)
    lanes : number of lanes
    motions : a :class:`Motions`

    Returns
    -------
    A bit for each lane that stops, for a contact event or the end of its motion.
    """
    samples, vertical = motions.samples, motions.vertical
    stops = 0
    for i in range(lanes):
        last = lane.last[i]
        at = lane.k[i] + (1 if lane.flag[i] == QUIET else 0)
        lane.k[i] = at
        lane.following[i] = min(at + 1, last)
        stops |= (1 << i) if (lane.flag[i] > QUIET) | (at >= last) else 0
    for i in range(lanes):
        # unsigned, as an index that may be negative is looked at before it is used
        lane.ground_end[i] = factor[i] * samples[np.uint64(lane.following[i])]
    if vertical.size > 0:
        for i in range(lanes):
            lane.weight_end[i] = (
                1.0 + lane.factor[i] * vertical[np.uint64(lane.following[i])]
            )
    return stops
