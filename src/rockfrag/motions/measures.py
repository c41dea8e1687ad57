"""Tables of intensity measures, a row per motion, with the unit in the name of each column.

In: motions [m/s²]. Out: a table, a column a measure in its unit. Theory: ``docs/motions.md``, "Intensity
measures".
"""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd

from rockfrag.base.errors import InputError
from rockfrag.base.keywords import named_keywords
from rockfrag.motions import intensity
from rockfrag.motions.intensity import SPECTRAL_PERIODS, intensity_measures
from rockfrag.motions.pulse_extraction import strongest_pulse
from rockfrag.motions.rotation import DIRECTIONS_DEG, rotate
from rockfrag.records.motion import Motion
from rockfrag.runtime.processes import in_processes


@named_keywords
def measure_motion(
    motion: Motion, periods: Sequence[float] = SPECTRAL_PERIODS, damping: float = 0.05
) -> dict[str, Any]:
    """Give all intensity measures of one motion.

    Parameters
    ----------
    motion : what to measure
    periods : periods of the spectral measures [s]
    damping : damping of the spectral measures and of the Housner intensity [-]

    Returns
    -------
    ``name``, ``earthquake`` and ``floor`` (from the metadata, empty where not known), then ``pga_g``,
    ``pgv_cm_s``, ``pgd_cm``, ``pgv_over_pga_s``, ``arias_m_s``, ``cav_m_s``, ``d5_75_s``,
    ``d5_95_s``, ``mean_period_s``, ``predominant_period_s``; for each period such as 0.3 s
    ``sa_0_3s_g`` (pseudo), ``sv_0_3s_cm_s`` and ``sd_0_3s_cm``; ``avgsa_g``, ``housner_cm``, ``pulse_period_s``,
    ``pulse_velocity_cm_s`` and ``pulse_explained``.  A measure that does not exist for the motion,
    such as the duration of a motion of zeros, is NaN.
    """
    values: dict[str, Any] = {
        "name": motion.name,
        "earthquake": str(motion.metadata.get("earthquake", "")),
        "floor": str(motion.metadata.get("floor", "")),
    }
    shared: dict[Any, Any] = {None: motion}
    for measure in intensity_measures(periods):
        if measure.shared not in shared:
            shared[measure.shared] = measure.shared(motion, damping)  # type: ignore[misc]
        values[measure.column] = measure.of(shared[measure.shared])
    return values


def measure_motions(
    motions: Iterable[Motion],
    periods: Sequence[float] = SPECTRAL_PERIODS,
    damping: float = 0.05,
    processes: int = 1,
) -> pd.DataFrame:
    """Table of :func:`measure_motion`, a row per motion in the order given.

    Parameters
    ----------
    motions : what to measure, one after the other; an iterator is used up
    periods, damping : as of :func:`measure_motion`
    processes : how many processes may measure at once; the table does not depend on it

    Returns
    -------
    A table with a row per motion, a column per measure, the unit in its name.
    """
    rows = in_processes(
        lambda motion: measure_motion(motion, periods, damping), motions, processes
    )
    table = pd.DataFrame(rows)
    if rows and table["name"].duplicated().any():
        twice = table.loc[table["name"].duplicated(), "name"].iloc[0]
        raise InputError(
            f"measures: two motions are called {twice!r}; give each its own name."
        )
    return table


def measure_rocking(
    motions: Iterable[Motion], blocks: Mapping[str, tuple[float, float]]
) -> pd.DataFrame:
    """Table of the measures that compare a motion with a block, a row per motion and block.

    Parameters
    ----------
    motions : what to measure
    blocks : critical angle [rad] and frequency parameter p [1/s] of each block by its name

    Returns
    -------
    Table with the columns ``name``, ``block`` and, all [-], ``uplift_ratio`` a/(g tan α), ``velocity_ratio``
    p PGV/(g tan α) and ``frequency_ratio`` ωp/p with ωp that of the strongest pulse.
    """
    rows = []
    for motion in motions:
        period = strongest_pulse(motion).period
        for block, (alpha, p) in blocks.items():
            uplift = intensity.uplift_ratio(motion, alpha)
            velocity = intensity.velocity_ratio(motion, alpha, p)
            rows.append(
                (
                    motion.name,
                    block,
                    uplift,
                    velocity,
                    intensity.frequency_ratio(period, p),
                )
            )
    columns = ["name", "block", "uplift_ratio", "velocity_ratio", "frequency_ratio"]
    return pd.DataFrame(rows, columns=columns)


def measure_pair(
    first: Motion,
    second: Motion,
    periods: Sequence[float] = SPECTRAL_PERIODS,
    damping: float = 0.05,
) -> dict[str, float]:
    """Give measures of two perpendicular components that do not depend on their directions.

    Parameters
    ----------
    first, second : perpendicular components, sampled at the same times
    periods, damping : as of :func:`measure_motion`

    Returns
    -------
    ``rotd50_pga_g``, ``rotd100_pga_g``, ``rotd50_pgv_cm_s``, ``rotd100_pgv_cm_s`` and for each
    period such as 0.3 s ``rotd50_sa_0_3s_g``, ``rotd100_sa_0_3s_g``; Boore (2010).
    """
    measured = [
        measure
        for measure in intensity_measures(periods)
        if measure.name in ("pga", "pgv") or measure.name.startswith("sa_")
    ]
    turned = (rotate(first, second, angle) for angle in DIRECTIONS_DEG)
    directions = pd.DataFrame(
        {measure.column: measure.of_motion(motion, damping) for measure in measured}
        for motion in turned
    )
    return {
        f"rotd{percentile}_{name}": float(np.percentile(directions[name], percentile))
        for name in directions
        for percentile in (50, 100)
    }
