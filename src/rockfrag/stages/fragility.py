"""Fragility: curves of every configuration, the measure that predicts overturning best, exports."""

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from rockfrag.motions.intensity import declared, intensity_measures
from rockfrag.outcomes.limit_states import OVERTURNS, limit_states
from rockfrag.shaketable.definitions import Swept
from rockfrag.stages.floor_curves import export_curves, floor_curves, floor_measures
from rockfrag.stages.ida import ida_curves_of
from rockfrag.stages.job import Job, Results
from rockfrag.study.study import Study

if TYPE_CHECKING:
    # every job reads this module for the list of stages; only curves need scipy
    from rockfrag.fragility.empirical import TableIda
    from rockfrag.stages.floor_curves import StateIdaCurves


def run(job: Job[Study]) -> Results:
    """Yield curves, structural resurrections and the comparison of measures; write curves for export."""
    from rockfrag.fragility.ida_curves import record_set_hash, tables_of_ida_curves

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
    systems = {system.name: system for system in job.study.configurations}
    at_once = not (job.study.slides or job.study.vertical)
    about = (job.study.floors, systems, record_set, settings.confidence, at_once)
    by_floor, floor_fractions = floor_curves(of_floors, measures, *about)
    yield "fragility_floors", by_floor
    yield "fragility_floors_fractions", floor_fractions
    exports = job.folder / "exports"
    exports.mkdir(parents=True, exist_ok=True)
    exported = ", ".join(export_curves(by_floor, exports, floor_fractions))
    job.log.info("exported %s", exported or "no curve")
    best = ", ".join(best_of(choice, columns)) or "none stands out"
    job.log.info("curves: %d; best of the measures asked for: %s", len(found.curves), best)


def _two_measures(job: Job[Study], measures: pd.DataFrame) -> Results:
    """Fits in the pairs of measures that the study names; tables without rows where it names none."""
    from rockfrag.fragility.ida_curves import with_measures
    from rockfrag.fragility.vector_tables import vector_tables

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
    """Names of the best measures of all configurations among those that a study asks for."""
    known = choice[choice["measure"].isin(list(asked)) & choice["score"].notna()]
    return list(dict.fromkeys(known.drop_duplicates("configuration")["im"]))


def measure_selection(
    ida_curves: Mapping[str, "TableIda"], measures: pd.DataFrame, level: float, seed: int
) -> pd.DataFrame:
    """Compare measures for every configuration.

    One row per configuration and measure, best first: the columns of
    :class:`rockfrag.fragility.measure_selection.MeasureSelection`, ``recommended`` (True for one row each) and
    ``words``, the recommendation with its reasons.
    """
    from rockfrag.fragility.measure_selection import recommend_ida_measure

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

    Columns: ``earthquake``, ``floor``, ``motion``, ``amplitude_g`` and ``overturned`` (0 or 1). ``most_levels`` of
    a motion are taken.
    """
    tables = []
    for part in parts:
        step = 1 if most_levels is None else -(-part.amplitude_g.size // most_levels)
        tables.append(part.rows(("earthquake", "floor", "motion"), step))
    return pd.concat(tables, ignore_index=True).astype({"overturned": np.int64})


def _ida_curves(
    job: Job[Study], measures: pd.DataFrame
) -> tuple[dict[str, "TableIda"], "StateIdaCurves", pd.DataFrame]:
    """IDA curves by configuration, and by limit state, configuration and floor; resurrections of all."""
    from rockfrag.fragility.empirical import resurrections_of

    study = job.study
    if study.is_large:
        # compiled, which other studies need not wait for
        from rockfrag.fragility.counted import count_ida
    floors = {name: floor_measures(level) for name, level in study.floors.items()}
    wanted = {"": tuple(dict.fromkeys([*study.fragility.measures, *candidates()])), **floors}
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
    table = pd.concat(resurrections, ignore_index=True).sort_values(by, ignore_index=True)
    return of_all, of_floors, table


def _rows(
    parts: Iterable[Swept], measures: pd.DataFrame, columns: Mapping[str, Sequence[str]]
) -> dict[str, "TableIda"]:
    """IDA curves with a row an outcome, by floor, those under the empty name of all floors."""
    from rockfrag.fragility.empirical import TableIda
    from rockfrag.fragility.ida_curves import with_measures

    ida = rows_of(parts)
    return {
        floor: TableIda(with_measures(ida[ida["floor"] == floor] if floor else ida, measures, some))
        for floor, some in columns.items()
    }


def _at_the_base(table: pd.DataFrame, several_floors: bool) -> pd.DataFrame:
    """Name peaks for what they are where motions of several floors share a curve: of the base."""
    if not several_floors:
        return table
    known = [measure for measure in declared() if measure.demand]
    words = {measure.label: f"peak base {measure.demand.lower()}" for measure in known}
    return table.assign(im=table["im"].replace(words))
