"""What a table's high-pass filter does to the amplitude at which a block overturns."""

from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from rockfrag.motions.conditioning import pad
from rockfrag.motions.filtering import highpass
from rockfrag.motions.scaling import factors_to_pga
from rockfrag.records.motion import Motion
from rockfrag.rocking import overturns
from rockfrag.shaketable.definitions import always_overturning, first_overturning
from rockfrag.shaketable.shaker import FILTER_ORDER
from rockfrag.system.blocks import Body


def filter_effect(
    bodies: Mapping[str, Body],
    motions: Sequence[Motion],
    corners_hz: Sequence[float],
    amplitudes_g: NDArray[np.float64],
    threads: int = 1,
) -> pd.DataFrame:
    """Overturning amplitudes under motions high-passed at several corners, zero-phase.

    An amplitude is the peak of the filtered motion, as a table would show it.

    Parameters
    ----------
    bodies
        What stands on the table, by configuration.
    motions
        Motions as wanted.
    corners_hz
        Corners of the filter [Hz]; 0 is no filter.
    amplitudes_g
        Amplitudes of the IDA curve [g], rising.
    threads
        Threads to use; the result does not depend on it.

    Returns
    -------
    One row per configuration, motion and corner: ``configuration``, ``motion``, ``earthquake``, ``floor``,
    ``corner_hz``, ``first_g`` and ``always_g`` (amplitude of the first overturning, and from which on
    it always overturns; NaN if beyond the IDA curve).
    """
    shaken = [
        (motion, corner, _filtered(motion, corner)) for motion in motions for corner in corners_hz
    ]
    result = overturns(
        list(bodies.values()),
        [filtered.acceleration for _, _, filtered in shaken],
        [filtered.dt for _, _, filtered in shaken],
        [factors_to_pga(filtered, amplitudes_g) for _, _, filtered in shaken],
        threads=threads,
    )
    rows = []
    for i, configuration in enumerate(bodies):
        for j, (motion, corner, _) in enumerate(shaken):
            outcomes = result.overturned[i, j]
            rows.append(
                {
                    "configuration": configuration,
                    "motion": motion.name,
                    "earthquake": motion.metadata.get("earthquake", ""),
                    "floor": motion.metadata.get("floor", ""),
                    "corner_hz": corner,
                    "first_g": first_overturning(amplitudes_g, outcomes).upper_g,
                    "always_g": always_overturning(amplitudes_g, outcomes).upper_g,
                }
            )
    return pd.DataFrame(rows)


def _filtered(motion: Motion, corner: float) -> Motion:
    if corner == 0:
        return motion
    room = 1.5 * FILTER_ORDER / corner
    return highpass(pad(motion, room, room), corner, FILTER_ORDER)
