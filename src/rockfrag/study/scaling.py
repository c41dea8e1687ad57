"""By how much a study scales its motions, and what looks wrong in them: whether its tests are of earthquakes.

In: motions as processed [m/s²] and the amplitudes of a study [g]. Out: the table ``scaling``, a row a motion of a
floor, and the reason why a motion that is far too weak is left out. Theory: ``docs/motions.md``, "How far a motion
is scaled".
"""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import pandas as pd

from rockfrag.base.units import GRAVITY
from rockfrag.records.motion import Motion
from rockfrag.records.quality_flags import quality_flags

if TYPE_CHECKING:
    from rockfrag.study.study import Study

LARGEST_FACTOR = 10.0
"""Factor beyond which a scaled motion no longer stands for an earthquake, as in an assessment of one object."""


def too_weak(study: "Study", felt: Sequence[Motion]) -> str:
    """Say why a record is too weak for a study, as even its lowest amplitude scales it too far.

    Parameters
    ----------
    study : with its amplitudes [g] and its largest factor [-]
    felt : the record as it shakes each floor

    Returns
    -------
    The reason, empty where the record is strong enough.
    """
    peak_g = max(motion.pga for motion in felt) / GRAVITY
    lowest_g, limit = study.amplitudes.lowest_g, study.largest_factor
    if lowest_g <= limit * peak_g:
        return ""
    return (
        f"its peak is {peak_g:.2g} g, so that even the lowest amplitude, {lowest_g:g} g, is "
        f"{lowest_g / peak_g:.3g} times the motion, more than {limit:g}; give a stronger record, or another "
        "limit with the key motions.largest_factor"
    )


def scaling_table(
    study: "Study", ground: Sequence[Motion], floors: Sequence[Motion]
) -> pd.DataFrame:
    """Tabulate by how much each motion is scaled, and what looks wrong in its record.

    Parameters
    ----------
    study : with its amplitudes [g]
    ground : records as processed
    floors : the motions of all floors, whose metadata name their ``ground_motion``

    Returns
    -------
    pandas.DataFrame
        A row a motion of a floor: ``motion``, ``earthquake``, ``floor``, ``pga_g`` as recorded or felt,
        ``factor_lowest`` and ``factor_highest`` at the lowest and the highest amplitude [-], ``quality_flags`` of
        the record as processed, in words, such as a drift.
    """
    flags = {motion.name: "; ".join(quality_flags(motion)) for motion in ground}
    amplitudes = study.amplitudes.values_g
    rows = [
        {
            "motion": motion.name,
            "earthquake": motion.metadata.get("earthquake") or motion.name,
            "floor": motion.metadata["floor"],
            "pga_g": motion.pga / GRAVITY,
            "factor_lowest": amplitudes[0] * GRAVITY / motion.pga,
            "factor_highest": amplitudes[-1] * GRAVITY / motion.pga,
            "quality_flags": flags[motion.metadata["ground_motion"]],
        }
        for motion in floors
    ]
    return pd.DataFrame(rows)
