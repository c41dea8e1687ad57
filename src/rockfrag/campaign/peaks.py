"""Peaks that a table of tests lists, held against those of its motions: a wrong unit or time step shows there."""

from collections.abc import Sequence

import numpy as np
import pandas as pd

from rockfrag.errors import InputError
from rockfrag.motions.filtering import highpass
from rockfrag.motions.intensity import pga, pgv
from rockfrag.records.motion import Motion
from rockfrag.units import GRAVITY

DRIFT_CORNER_HZ = 0.1
"""High-pass before a measured motion is integrated: its noise would drift."""

LARGEST_FACTOR = 1.5
"""Factor between the middle listed and measured peak beyond which they are not of one motion: of ours.  On a table
that followed its commands it is 1.00 in PGA and 1.12 in PGV (490 tests)."""

_CAUSES = {
    "pga_g": "check the unit of the motions (unit) and of the column",
    "pgv_cm_s": "check the time step of the motions (dt_s) and the unit of the column",
}


def measured_peaks(motions: Sequence[Motion]) -> pd.DataFrame:
    """Peak acceleration and velocity of motions, ``pga_g`` and ``pgv_cm_s``."""
    return pd.DataFrame(
        {
            "pga_g": [pga(motion) / GRAVITY for motion in motions],
            "pgv_cm_s": [100 * pgv(highpass(motion, DRIFT_CORNER_HZ)) for motion in motions],
        }
    )


def check_peaks(tests: pd.DataFrame, motions: Sequence[Motion], source: str) -> None:
    """Refuse motions whose peaks are not those that the table of tests lists, and say the factor between them.

    The table has ``pga_g`` and ``pgv_cm_s`` or ``pgv_over_pga_s`` as far as they are listed.
    """
    listed = tests.filter(items=list(_CAUSES))
    if "pgv_cm_s" not in listed and {"pga_g", "pgv_over_pga_s"} <= set(tests):
        listed = listed.assign(pgv_cm_s=100 * GRAVITY * tests["pga_g"] * tests["pgv_over_pga_s"])
    if listed.empty:
        return
    found = measured_peaks(motions)
    for name in map(str, listed):
        factor = float(np.median(found[name].to_numpy() / listed[name].to_numpy()))
        if not 1 / LARGEST_FACTOR <= factor <= LARGEST_FACTOR:
            raise InputError(
                f"{source}: the peaks of its motions are {factor:.3g} times the {name} that the tests list "
                f"(median of {len(tests)} tests); {_CAUSES[name]}."
            )
