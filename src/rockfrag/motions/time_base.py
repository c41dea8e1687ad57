"""Components of one record brought to the same times, so that they can be turned and added."""

import math
from collections.abc import Collection, Sequence
from dataclasses import replace

import numpy as np
from obspy import UTCDateTime

from rockfrag.errors import InputError
from rockfrag.motions.checks import peaks
from rockfrag.records.motion import Motion
from rockfrag.records.parsing.orientation import is_vertical

_WHOLE = 1e-3  # fraction of a sampling interval within which a shift counts as one of whole samples


def common_time(
    motions: Sequence[Motion], verticals: Collection[int] | None = None
) -> list[Motion]:
    """Return motions at the same times: those that all of them have, at samples of a horizontal one.

    Where all state the time of their first sample they are shifted by it, else they are taken to begin
    together. The times are those of the horizontal component of the shortest interval, which is not moved
    for a vertical. Samples between those of a motion are on the straight line between its neighbours.
    """
    # of the first samples after the earliest [s]
    starts = [0.0] * len(motions)
    stated = [motion.metadata.get("start_time") for motion in motions]
    if all(stated):
        times = [UTCDateTime(str(time)) for time in stated]
        starts = [float(time - min(times)) for time in times]
    if verticals is None:
        named = (str(motion.metadata.get("component") or "") for motion in motions)
        verticals = [place for place, name in enumerate(named) if is_vertical(name)]
    # whose samples the others follow
    lying = [i for i in range(len(motions)) if i not in verticals] or range(len(motions))
    lead = min(lying, key=lambda i: motions[i].dt)
    dt = motions[lead].dt
    after = (max(starts) - starts[lead]) / dt
    first = starts[lead] + math.ceil(after - _WHOLE) * dt
    last = min(s + (m.acceleration.size - 1) * m.dt for s, m in zip(starts, motions, strict=True))
    count = int(np.floor((last - first) / dt + _WHOLE)) + 1
    names = ", ".join(repr(motion.name) for motion in motions)
    if count < 2:
        raise InputError(
            f"{names}: these components have no time in common; are they of one record?"
        )
    return [
        _at(motion, first - start, dt, count) for start, motion in zip(starts, motions, strict=True)
    ]


def _at(motion: Motion, begin: float, dt: float, count: int) -> Motion:
    """Return ``count`` samples from ``begin`` seconds after the first, ``dt`` seconds apart."""
    shift = begin / motion.dt
    same = abs(dt - motion.dt) <= 1e-9 * dt and abs(shift - round(shift)) < _WHOLE
    if same:
        samples = motion.acceleration[round(shift) : round(shift) + count]
    else:
        samples = np.interp(begin + np.arange(count) * dt, motion.time, motion.acceleration)
    if same and round(shift) == 0 and samples.size == motion.acceleration.size:
        return motion
    start = motion.metadata.get("start_time")
    if start and begin > 0:
        # who brings it to a common time once more would leave out its beginning twice
        later = {**motion.metadata, "start_time": str(UTCDateTime(str(start)) + begin)}
        motion = replace(motion, metadata=later)
    end = (motion.acceleration.size - 1) * motion.dt - begin - (count - 1) * dt
    return motion.after(
        "common time",
        samples,
        dt,
        left_out_at_beginning_s=begin,
        left_out_at_end_s=float(f"{max(end, 0.0):.9g}"),
        interpolated=not same,
        **peaks(motion, samples),
    )
