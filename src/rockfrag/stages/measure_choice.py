"""Which intensity measure foretells the overturning of each configuration, and curves for export."""

from pathlib import Path

import numpy as np
import pandas as pd

CANDIDATES = ("pga_g", "pgv_cm_s", "pgd_cm", "sa_0_3s_g", "sa_1_0s_g", "housner_cm", "arias_m_s")
"""Measures that are compared; all grow with the amplitude."""

GIVEN = ("mean_period_s", "d5_95_s")
"""Properties of which a sufficient measure leaves nothing to tell."""

NRML_MEASURES = ("pga_g", "pgv_cm_s", "sa_0_3s_g", "sa_1_0s_g")
SIMCENTER_MEASURES = ("pga_g", "pgv_cm_s")


def measure_choice(
    sweep: pd.DataFrame, measures: pd.DataFrame, level: float, seed: int
) -> pd.DataFrame:
    """Compare measures for every configuration.

    Parameters
    ----------
    sweep
        Sweeps of all configurations.
    measures
        Intensity measures of the motions as recorded.
    level, seed
        Of the limits and of the bootstrap.

    Returns
    -------
    One row per configuration and measure, best first: the columns of
    :class:`rockfrag.fragility.measure_choice.MeasureChoice`, ``recommended`` (True for one row each) and
    ``words``, the recommendation with its reasons.
    """
    from rockfrag.fragility import recommend_sweep_measure

    parts = []
    for name, rows in sweep.groupby("configuration", sort=False):
        choice = recommend_sweep_measure(
            rows, measures, CANDIDATES, given=GIVEN, level=level, seed=seed
        )
        table = choice.table.copy()
        table.insert(0, "configuration", name)
        chosen = table["measure"] == choice.recommended
        parts.append(table.assign(recommended=chosen, words=choice.words))
    return pd.concat(parts, ignore_index=True)


def ground_curves(
    sweep: pd.DataFrame, measures: pd.DataFrame, record_set: str, level: float, ground: str
) -> pd.DataFrame:
    """Fragility of every configuration on the ground floor, in measures of the ground motion.

    Parameters
    ----------
    sweep, measures, level
        As of :func:`measure_choice`.
    record_set
        Digest of the motions, which goes into the table.
    ground
        Label of the floor that moves as the ground does.

    Returns
    -------
    Table of :func:`rockfrag.fragility.sweeps.fragility_table` with the columns ``floor`` and
    ``measure``; all verdicts count (``mean_probability``).
    """
    from rockfrag.fragility import fragility_table, with_measures

    on_ground = sweep[sweep["floor"] == ground]
    parts = []
    for column in NRML_MEASURES:
        rows = with_measures(on_ground, measures, [column])
        table = fragility_table(rows, [column], record_set=record_set, level=level)
        table = table[table["estimator"] == "mean_probability"]
        parts.append(table.assign(floor=ground, measure=column))
    return pd.concat(parts, ignore_index=True)


def export_curves(curves: pd.DataFrame, folder: Path) -> list[str]:
    """Write the curves for OpenQuake and SimCenter; return the names of the files.

    One file per measure, as both formats take one curve per object. Configurations without a curve
    are left out, and a measure without any has no file.
    """
    from rockfrag.fragility import write_nrml, write_simcenter

    written = []
    for column in NRML_MEASURES:
        # the formats know the ground by an empty floor, whatever its user calls it
        usable = _usable(curves, column).assign(floor="")
        stem = f"fragility_{column.rpartition('_')[0] if column != 'pgv_cm_s' else 'pgv'}"
        if len(usable):
            write_nrml(usable, folder / f"{stem}.xml", identifier=stem)
            written.append(f"{stem}.xml")
        if len(usable) and column in SIMCENTER_MEASURES:
            write_simcenter(usable, folder / f"{stem}.csv", folder / f"{stem}.json")
            written += [f"{stem}.csv", f"{stem}.json"]
    return written


def _usable(curves: pd.DataFrame, column: str) -> pd.DataFrame:
    rows = curves[curves["measure"] == column]
    found = rows[["theta", "beta"]].to_numpy(dtype=float)
    usable: pd.DataFrame = rows.loc[(np.isfinite(found) & (found > 0)).all(axis=1)]
    return usable
