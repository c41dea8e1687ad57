"""What looks wrong in a motion: a unit mistaken, a sensor at its end, a record begun too late."""

import numpy as np
from numpy.typing import NDArray

from rockfrag.records.motion import Motion
from rockfrag.units import GRAVITY

STRONGEST_G = 3.0  # peak [g] that hardly any record of an earthquake exceeds
_COARSEST = 0.025  # sampling interval [s] above which 20 Hz, which rocking bodies feel, are lost
_DRIFT = 0.5  # fraction of the peak velocity that is left at the end of a record with a drift
_CLIPPED_RUN = 4
"""Samples in a row at the largest value of a record that is cut off at its sensor's range."""

_LATE = 0.2
"""Fraction of the peak that a record has in its first tenth of a second if it began too late."""

_SPIKE = 0.5  # fraction of the peak by which a lone sample leaves its neighbours
_SPIKE_RATIO = 20.0  # ratio of a spike to what nine tenths of the samples leave their neighbours by
_DOUBLED = 0.9  # fraction of the samples that repeat the one before in a record of doubled samples


def quality_flags(motion: Motion) -> list[str]:
    """Return what looks wrong in a motion, one phrase each; none for a record in order."""
    a, peak = motion.acceleration, motion.pga
    if peak == 0:
        return ["all samples are zero"]
    found = []
    if peak > STRONGEST_G * GRAVITY:
        found.append(
            f"a peak of {peak / GRAVITY:.3g} g, above {STRONGEST_G:g} g (is the unit right?)"
        )
    if motion.dt > _COARSEST:
        found.append(f"a sampling interval of {motion.dt:g} s, too long for short impacts")
    if a.size < 10:
        return [*found, f"only {a.size} samples"]
    velocity = np.cumsum(0.5 * (a[1:] + a[:-1]))
    left, fastest = abs(float(velocity[-1])), float(np.abs(velocity).max())
    left = left / fastest if fastest else 0.0
    if left > _DRIFT:
        found.append(f"a drift: {100 * left:.0f} % of the peak velocity is left at the end")
    edges = np.flatnonzero(np.diff(np.abs(a) >= peak * (1 - 1e-9), prepend=False, append=False))
    if (edges[1::2] - edges[::2]).max() >= _CLIPPED_RUN:
        found.append("its peak is flat, as if clipped")
    first = a[: max(2, round(0.1 / motion.dt))]
    if first.size < a.size / 4 and np.abs(first).max() > _LATE * peak:
        found.append("strong from its first samples, as if triggered late")
    off = np.abs(a[1:-1] - 0.5 * (a[:-2] + a[2:]))
    if off.max() > max(_SPIKE * peak, _SPIKE_RATIO * float(np.quantile(off, 0.9))):
        found.append("a lone spike")
    if _is_doubled(a):
        found.append("every second sample repeats the one before it")
    return found


def _is_doubled(a: NDArray[np.float64]) -> bool:
    moving = a[: a.size // 2 * 2].reshape(-1, 2)
    moving = moving[np.abs(moving).max(axis=1) > 0]
    if moving.shape[0] < 10 or np.unique(a).size < 10:
        return False
    shifted = a[1 : (a.size - 1) // 2 * 2 + 1].reshape(-1, 2)
    same = [float(np.mean(pairs[:, 0] == pairs[:, 1])) for pairs in (moving, shifted)]
    # a coarse record repeats samples everywhere, a doubled one at every second
    return max(same) > _DOUBLED and min(same) < 0.5
