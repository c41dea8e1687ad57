"""Fragility: curves of every configuration and floor, the measure that predicts overturning best, exports.

In: IDA curves and measures of the motions. Out: tables of curves with θ in the unit of the measure and β [-], and
files for other programs. Theory: ``docs/fragility.md``.
"""

import math
import re
from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from itertools import product
from pathlib import Path

import numpy as np
import pandas as pd

from rockfrag.base.files import file_name
from rockfrag.fragility import write_nrml, write_simcenter
from rockfrag.fragility.counted import count_ida
from rockfrag.fragility.empirical import TableIda, resurrections_of
from rockfrag.fragility.estimators import fit_uplift, fragility_of
from rockfrag.fragility.ida_curves import (
    fraction_points,
    fragility_row,
    record_set_hash,
    tables_of_ida_curves,
    with_measures,
)
from rockfrag.fragility.measure_selection import recommend_ida_measure
from rockfrag.fragility.vector import vector_tables
from rockfrag.motions.intensity import declared, intensity_measures
from rockfrag.outcomes.limit_states import OVERTURNS, limit_states
from rockfrag.shaketable.definitions import Swept
from rockfrag.stages.ida import ida_curves_of
from rockfrag.stages.job import Job, Results
from rockfrag.study.holding import held_by
from rockfrag.study.study import Study
from rockfrag.system.system import uplift_ratios

StateIdaCurves = dict[str, dict[tuple[str, str], TableIda]]


def run(job: Job[Study]) -> Results:
    """Yield curves, structural resurrections and the comparison of measures; write curves for export."""
    settings, measures = job.study.fragility, job.table("measures")
    record_set = record_set_hash(job.motions("motions/records"))
    columns = list(settings.measures)
    of_all, of_floors, resurrections = _ida_curves(job, measures)
    found = tables_of_ida_curves(
        (({"configuration": name}, of_all[name]) for name in sorted(of_all)),
        columns,
        record_set=record_set,
        level=settings.confidence,
    )
    several = len(set(measures["floor"])) > 1
    yield "fragility", _at_the_base(found.curves, several)
    yield "fragility_bands", _at_the_base(found.bands, several)
    yield "fragility_bins", _at_the_base(found.bins, several)
    yield "fragility_fractions", _at_the_base(found.fractions, several)
    yield "resurrections", resurrections
    yield from _two_measures(job, measures)
    choice = measure_selection(of_all, measures, settings.confidence, job.study.seed)
    yield "measure_selection", choice
    by_floor, floor_fractions = floor_curves(of_floors, measures, job.study, record_set)
    yield "fragility_floors", by_floor
    yield "fragility_floors_fractions", floor_fractions
    exports = job.folder / "exports"
    exports.mkdir(parents=True, exist_ok=True)
    held = {system.name: held_by(system) for system in job.study.configurations}
    written = export_curves(
        by_floor.assign(held_by=by_floor["configuration"].map(held)),
        exports,
        floor_fractions,
        model_error=settings.model_error,
    )
    exported = ", ".join(written)
    job.log.info("exported %s", exported or "no curve")
    best = ", ".join(best_of(choice, columns)) or "none stands out"
    job.log.info(
        "curves: %d; best of the measures asked for: %s", len(found.curves), best
    )


def _two_measures(job: Job[Study], measures: pd.DataFrame) -> Results:
    """Fits in the pairs of measures that the study names; tables without rows where it names none."""
    pairs = job.study.fragility.pairs
    columns = list(dict.fromkeys(measure for pair in pairs for measure in pair))
    tests = {}
    for configuration in job.study.configurations if pairs else []:
        rows = rows_of(ida_curves_of(job, configuration), MOST_LEVELS)
        tests[configuration.name] = with_measures(rows, measures, columns)
    settings = job.study.fragility
    found = vector_tables(tests, pairs, level=settings.confidence, seed=job.study.seed)
    yield "fragility_two_measures", found.fits
    yield "fragility_contours", found.contours
    yield "fragility_cells", found.cells


def candidates() -> tuple[str, ...]:
    """Return the columns of the measures that are compared; all grow with the amplitude."""
    return tuple(measure.column for measure in intensity_measures() if measure.compared)


GIVEN = ("mean_period_s", "d5_95_s")
"""Properties of which a sufficient measure leaves nothing to tell."""


def best_of(choice: pd.DataFrame, asked: Sequence[str]) -> list[str]:
    """Names of the best measures of all configurations among those that a study asks for.

    Parameters
    ----------
    choice, asked : table of the intensity-measure selection, and columns of measures

    Returns
    -------
    The names as the field writes them.
    """
    known = choice[choice["measure"].isin(list(asked)) & choice["score"].notna()]
    return list(dict.fromkeys(known.drop_duplicates("configuration")["im"]))


def measure_selection(
    ida_curves: Mapping[str, TableIda], measures: pd.DataFrame, level: float, seed: int
) -> pd.DataFrame:
    """Compare measures for every configuration.

    Parameters
    ----------
    ida_curves : outcomes on all floors together, by configuration
    measures : a row a motion and floor, a column a measure in its unit
    level : of confidence intervals [-]
    seed : of resampled earthquakes

    Returns
    -------
    One row per configuration and measure, best first: the columns of
        :class:`rockfrag.fragility.measure_selection.MeasureSelection`, ``recommended`` (True for one row each) and
        ``words``, the recommendation with its reasons.
    """
    parts = []
    for name, ida in ida_curves.items():
        choice = recommend_ida_measure(
            ida, measures, candidates(), given=GIVEN, level=level, seed=seed
        )
        table = choice.table.copy()
        table.insert(0, "configuration", name)
        chosen = table["measure"] == choice.recommended
        parts.append(table.assign(recommended=chosen, words=choice.words))
    return pd.concat(parts, ignore_index=True)


MOST_LEVELS = 200  # intensity levels of a motion in fits of two measures


def rows_of(parts: Iterable[Swept], most_levels: int | None = None) -> pd.DataFrame:
    """Put outcomes of IDA curves of one configuration into a table with a row a test.

    Parameters
    ----------
    parts : swept motions
    most_levels : intensity levels of a motion that are kept, thinned evenly to at most so many; None for all

    Returns
    -------
    Columns ``earthquake``, ``floor``, ``motion``, ``amplitude_g`` [g] and ``overturned`` (0 or 1).
    """
    tables = []
    for part in parts:
        step = 1
        if most_levels is not None:
            step = math.ceil(part.amplitude_g.size / most_levels)
        tables.append(part.rows(("earthquake", "floor", "motion"), step))
    return pd.concat(tables, ignore_index=True).astype({"overturned": np.int64})


def _ida_curves(
    job: Job[Study], measures: pd.DataFrame
) -> tuple[dict[str, TableIda], StateIdaCurves, pd.DataFrame]:
    """IDA curves by configuration, and by limit state, configuration and floor; resurrections of all.

    Those by configuration alone are of overturning on all floors together, whose name is empty. Large studies
    count outcomes, others keep a row an outcome.
    """
    study = job.study
    floors = {name: floor_measures(level) for name, level in study.floors.items()}
    wanted = {
        "": tuple(dict.fromkeys([*study.fragility.measures, *candidates()])),
        **floors,
    }
    of_all: dict[str, TableIda] = {}
    of_floors: StateIdaCurves = defaultdict(dict)
    resurrections = []
    for system in study.configurations:
        windows = resurrections_of(ida_curves_of(job, system))
        resurrections.append(windows)
        for state in (state for state in limit_states() if state.counted(system)):
            parts = ida_curves_of(job, system, state=state.name)
            columns = wanted if state.name == OVERTURNS else floors
            found: Mapping[str, TableIda] = (
                count_ida(windows, parts, measures, columns)
                if study.is_large
                else _rows(parts, measures, columns)
            )
            if "" in found:
                of_all[system.name] = found[""]
            for floor in floors:
                of_floors[state.name][system.name, floor] = found[floor]
    by = ["configuration", "earthquake", "floor", "motion"]
    table = pd.concat(resurrections, ignore_index=True).sort_values(
        by, ignore_index=True
    )
    return of_all, of_floors, table


def _rows(
    parts: Iterable[Swept], measures: pd.DataFrame, columns: Mapping[str, Sequence[str]]
) -> dict[str, TableIda]:
    """IDA curves with a row an outcome, by floor, those under the empty name of all floors."""
    ida = rows_of(parts)
    return {
        floor: TableIda(
            with_measures(ida[ida["floor"] == floor] if floor else ida, measures, some)
        )
        for floor, some in columns.items()
    }


def _at_the_base(table: pd.DataFrame, several_floors: bool) -> pd.DataFrame:
    """Name peaks for what they are where motions of several floors share a curve: of the base."""
    if not several_floors:
        return table
    known = [measure for measure in declared() if measure.demand]
    words = {measure.label: f"peak base {measure.demand.lower()}" for measure in known}
    return table.assign(im=table["im"].replace(words))


def floor_measures(level: int) -> tuple[str, ...]:
    """Columns of the measures of the curves on a floor, by its level; 0 moves as the ground does.

    They are those that other programs read: of the ground OpenQuake's, of a floor demands.
    """
    known = intensity_measures()
    return tuple(
        measure.column
        for measure in known
        if (measure.demand if level else measure.openquake)
    )


def floor_curves(
    ida_curves: StateIdaCurves, measures: pd.DataFrame, study: Study, record_set: str
) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Fragility of every configuration on every floor; motions of different floors are never mixed.

    For each limit state ``ida_curves`` has those of each configuration on each floor, ``measures`` are of the
    motions as recorded. Bodies rock as soon as the peak of a motion exceeds their threshold where nothing slides
    and nothing moves vertically; the state ``rocks`` is left out where they may not. Rocking starts at an exact
    peak acceleration, whose value in another measure varies from motion to motion.

    Returns curves and fractions. Curves have one row per configuration, floor, measure and limit state:
    ``configuration``, ``floor``, ``floor_level``, ``measure`` (column of ``measures``), ``state`` and the columns
    of :func:`rockfrag.fragility.ida_curves.fragility_table`; fractions are points of those that are rejected, see
    :func:`rockfrag.fragility.ida_curves.fraction_points`.
    """
    floor_labels = {
        measure.label: measure.floor_label for measure in intensity_measures()
    }
    systems = {system.name: system for system in study.configurations}
    rocks_at_once = not (study.slides or study.vertical)
    level = study.fragility.confidence
    fractions = []
    rows = []
    for (name, floor), ida in ida_curves[OVERTURNS].items():
        height = study.floors[floor]
        columns = floor_measures(height)
        motions = ida.motions()
        threshold = min(uplift_ratios(systems[name]))
        at_uplift = with_measures(
            motions.assign(amplitude_g=threshold), measures, [*columns]
        )
        for column, state in product(columns, limit_states()):
            about = {"configuration": name, "floor": floor, "floor_level": height}
            about |= {"measure": column, "state": state.name}
            own = ida_curves.get(state.name, {}).get((name, floor))
            if own is not None:
                found = fragility_of(own.outcomes(column), level=level)
            elif state.exact and rocks_at_once and not systems[name].holding:
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
    curves: pd.DataFrame,
    folder: Path,
    fractions: pd.DataFrame,
    *,
    model_error: bool = True,
) -> list[str]:
    """Write the curves for OpenQuake and SimCenter; return the names of the files.

    One file per measure and floor, as both formats take one curve per object. OpenQuake knows motions of
    the ground only. Configurations without a curve are left out, and a measure without any has no file. Of
    rejected curves the points of the non-parametric function are written, as far as ``fractions`` has them.
    A limit state that not all configurations can reach, such as leaning at a wall, is left out, as OpenQuake
    takes the same states of all. Curves of overturning hold the errors of estimate and model unless
    ``model_error`` is False.
    """
    written = []
    for (floor, height, column), rows in curves.groupby(
        ["floor", "floor_level", "measure"], sort=False
    ):
        rows = _of_common_states(rows)
        # rows of the configurations that have a curve for every state
        found = rows[["theta", "beta"]].to_numpy(dtype=float)
        whole = (np.isfinite(found) & (found > 0)).all(axis=1)
        usable = rows[~rows["configuration"].isin(rows.loc[~whole, "configuration"])]
        if usable.empty:
            continue
        points = fractions[
            (fractions["floor"] == floor) & (fractions["measure"] == column)
        ]
        # SA(0.3s) becomes sa_0_3s
        name = re.sub(r"[\W_]", "_", str(usable["im"].iloc[0]).lower()).strip("_")
        stem = f"fragility_{name}" + (
            f"_{file_name(str(floor))}" if height != 0 else ""
        )
        xml = folder / f"{stem}.xml"
        csv = folder / f"{stem}.csv"
        json = folder / f"{stem}.json"
        if height == 0:
            # the formats know the ground by an empty floor, whatever its user calls it
            write_nrml(
                usable.assign(floor=""),
                xml,
                identifier=stem,
                fractions=points,
                model_error=model_error,
            )
            written.append(xml.name)
        if column in floor_measures(1):
            write_simcenter(
                usable, csv, json, fractions=points, model_error=model_error
            )
            written += [csv.name, json.name]
    return written


def _of_common_states(curves: pd.DataFrame) -> pd.DataFrame:
    """Rows of the limit states that all configurations of a table have."""
    having = curves.groupby("state")["configuration"].nunique()
    common = having.index[having == curves["configuration"].nunique()]
    return curves[curves["state"].isin(common)]
