"""Fragility on each floor in measures of that floor's own motion, and its files for other programs."""

import math
from collections.abc import Mapping
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from rockfrag.files import file_name
from rockfrag.motions.intensity import intensity_measures
from rockfrag.outcomes.limit_states import OVERTURNS, limit_states
from rockfrag.system.system import System, uplift_ratios

if TYPE_CHECKING:
    # every job reads this module for the list of stages; only curves need scipy
    from rockfrag.fragility.empirical import TableIda

    StateIdaCurves = dict[str, dict[tuple[str, str], TableIda]]


def floor_measures(level: int) -> tuple[str, ...]:
    """Columns of the measures of the curves on a floor, by its level; 0 moves as the ground does.

    They are those that other programs read: of the ground OpenQuake's, of a floor demands.
    """
    known = intensity_measures()
    return tuple(
        measure.column for measure in known if (measure.demand if level else measure.openquake)
    )


def floor_curves(
    ida_curves: "StateIdaCurves",
    measures: pd.DataFrame,
    floors: Mapping[str, int],
    systems: Mapping[str, System],
    record_set: str,
    level: float,
    rocks_at_once: bool = True,
) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Fragility of every configuration on every floor; motions of different floors are never mixed.

    For each limit state ``ida_curves`` has those of each configuration on each floor, ``measures`` are of the
    motions as recorded, ``floors`` the level of each by its label (0 moves as the ground does). ``rocks_at_once``
    tells that bodies rock as soon as the peak of a motion exceeds their threshold, as they do where nothing slides
    and nothing moves vertically; the state ``rocks`` is left out where they may not. Rocking starts at an exact
    peak acceleration, whose value in another measure varies from motion to motion.

    Returns curves and fractions. Curves have one row per configuration, floor, measure and limit state:
    ``configuration``, ``floor``, ``floor_level``, ``measure`` (column of ``measures``), ``state`` and the columns
    of :func:`rockfrag.fragility.ida_curves.fragility_table`; fractions are points of those that are rejected, see
    :func:`rockfrag.fragility.ida_curves.fraction_points`.
    """
    from rockfrag.fragility.estimators import fit_uplift, fragility_of
    from rockfrag.fragility.ida_curves import fraction_points, fragility_row, with_measures

    floor_labels = {measure.label: measure.floor_label for measure in intensity_measures()}
    fractions = []
    rows = []
    for (name, floor), ida in ida_curves[OVERTURNS].items():
        height = floors[floor]
        columns = floor_measures(height)
        motions = ida.motions()
        threshold = min(uplift_ratios(systems[name]))
        at_uplift = with_measures(motions.assign(amplitude_g=threshold), measures, [*columns])
        for column, state in product(columns, limit_states()):
            about = {"configuration": name, "floor": floor, "floor_level": height}
            about |= {"measure": column, "state": state.name}
            own = ida_curves.get(state.name, {}).get((name, floor))
            if own is not None:
                found = fragility_of(own.outcomes(column), level=level)
            elif state.exact and rocks_at_once:
                found = fit_uplift(at_uplift, column, level=level)
            else:
                continue
            estimator = "exact_threshold" if state.exact else "mean_probability"
            row = fragility_row(found, about, estimator, record_set)
            points = fraction_points({**about, "estimator": estimator}, found)
            if height > 0:
                row["im"] = floor_labels[str(row["im"])]
                points["im"] = row["im"]
            rows.append(row)
            fractions.append(points)
    return pd.DataFrame(rows), pd.concat(fractions, ignore_index=True)


def export_curves(
    curves: pd.DataFrame, folder: Path, fractions: pd.DataFrame | None = None
) -> list[str]:
    """Write the curves for OpenQuake and SimCenter; return the names of the files.

    One file per measure and floor, as both formats take one curve per object. OpenQuake knows motions of
    the ground only. Configurations without a curve are left out, and a measure without any has no file. Of
    rejected curves the points of the non-parametric function are written, as far as ``fractions`` has them.
    """
    from rockfrag.fragility import write_nrml, write_simcenter

    written = []
    for (floor, height, column), rows in curves.groupby(
        ["floor", "floor_level", "measure"], sort=False
    ):
        usable = _usable(rows)
        if usable.empty:
            continue
        points = None
        if fractions is not None:
            points = fractions[(fractions["floor"] == floor) & (fractions["measure"] == column)]
        stem = f"fragility_{_stem(str(usable['im'].iloc[0]))}"
        if height != 0:
            stem += f"_{file_name(str(floor))}"
        if height == 0:
            # the formats know the ground by an empty floor, whatever its user calls it
            write_nrml(
                usable.assign(floor=""), folder / f"{stem}.xml", identifier=stem, fractions=points
            )
            written.append(f"{stem}.xml")
        if column in floor_measures(1):
            write_simcenter(
                usable, folder / f"{stem}.csv", folder / f"{stem}.json", fractions=points
            )
            written += [f"{stem}.csv", f"{stem}.json"]
    return written


def _stem(name: str) -> str:
    """File name of a measure: ``SA(0.3s)`` becomes ``sa_0_3s``."""
    return "".join(c if c.isalnum() else "_" for c in name.lower()).strip("_")


def _usable(rows: pd.DataFrame) -> pd.DataFrame:
    """Rows of the configurations that have a curve for every state."""
    found = rows[["theta", "beta"]].to_numpy(dtype=float)
    whole = (np.isfinite(found) & (found > 0) & (found < math.inf)).all(axis=1)
    bad = set(rows.loc[~whole, "configuration"])
    return rows[~rows["configuration"].isin(bad)]
