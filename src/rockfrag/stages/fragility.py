"""Fragility: curves of every configuration, the measure that predicts overturning best, exports."""

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from rockfrag.motions.intensity import declared, intensity_measures
from rockfrag.outcomes.limit_states import OVERTURNS, LimitState, limit_states
from rockfrag.shaketable.swept import Swept
from rockfrag.stages.floor_curves import export_curves, floor_curves, floor_measures
from rockfrag.stages.ida import ida_curves_of
from rockfrag.stages.job import Job, Results
from rockfrag.study.study import Study
from rockfrag.system.system import System

if TYPE_CHECKING:
    # every job reads this module for the list of stages; only curves need scipy
    from rockfrag.fragility.empirical import IdaData
    from rockfrag.stages.floor_curves import StateIdaCurves


def run(job: Job[Study]) -> Results:
    """Yield curves, structural resurrections and the comparison of measures; write curves for export."""
    from rockfrag.fragility.ida_curves import record_set_hash, tables_of_ida_curves

    settings, measures = job.study.fragility, job.table("measures")
    record_set = record_set_hash(job.motions("motions/records"))
    columns = list(settings.measures)
    data = _counted(job, measures) if job.study.is_large else _rows(job, measures)
    of_all = data.of_all
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
    yield "resurrections", data.resurrections
    yield from _two_measures(job, measures)
    choice = measure_selection(of_all, measures, settings.confidence, job.study.seed)
    yield "measure_selection", choice
    systems = {system.name: system for system in job.study.configurations}
    at_once = not (job.study.slides or job.study.vertical)
    about = (job.study.floors, systems, record_set, settings.confidence, at_once)
    by_floor, floor_fractions = floor_curves(data.of_floors, measures, *about)
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
        rows = rows_of(ida_curves_of(job, configuration))
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
    ida_curves: Mapping[str, "IdaData"], measures: pd.DataFrame, level: float, seed: int
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


MOST_LEVELS = 200
"""Intensity levels of a motion that stand in a table of tests; of more every so many-th does."""


def rows_of(parts: Iterable[Swept]) -> pd.DataFrame:
    """Put outcomes of IDA curves of one configuration into a table with a row a test.

    Columns: ``earthquake``, ``floor``, ``motion``, ``amplitude_g`` and ``overturned`` (0 or 1).
    """
    about = ("earthquake", "floor", "motion")
    tables = [part.rows(about, -(-part.amplitude_g.size // MOST_LEVELS)) for part in parts]
    return pd.concat(tables, ignore_index=True).astype({"overturned": np.int64})


BY = ["configuration", "earthquake", "floor", "motion"]


@dataclass(frozen=True)
class _IdaCurves:
    """IDA curves by configuration, and by limit state, configuration and floor; resurrections of all."""

    of_all: dict[str, "IdaData"]
    of_floors: "StateIdaCurves"
    resurrections: pd.DataFrame


def _states(study: Study) -> dict[str, tuple[LimitState, ...]]:
    """Limit states that the IDA curve of each configuration counts."""
    return {
        configuration.name: tuple(state for state in limit_states() if state.counted(configuration))
        for configuration in study.configurations
    }


def _rows(job: Job[Study], measures: pd.DataFrame) -> _IdaCurves:
    """IDA curves as tables, every outcome a row."""
    from rockfrag.fragility.empirical import TableIda, find_resurrections
    from rockfrag.fragility.ida_curves import with_measures

    ida = pd.concat(
        [pd.read_parquet(job.file(path)) for path in job.study.ida_files], ignore_index=True
    )
    wanted = list(dict.fromkeys([*job.study.fragility.measures, *candidates()]))
    measured = with_measures(ida, measures, wanted)
    of_all: dict[str, IdaData] = {
        str(name): TableIda(part) for name, part in measured.groupby("configuration", sort=False)
    }
    states = _states(job.study)
    of_floors: StateIdaCurves = defaultdict(dict)
    for (name, floor), part in ida.groupby(["configuration", "floor"], sort=False):
        columns = floor_measures(job.study.floors[str(floor)])
        here = with_measures(part, measures, columns)
        for state in states[str(name)]:
            reached = here[state.column].astype(bool)
            of_floors[state.name][str(name), str(floor)] = TableIda(here.assign(overturned=reached))
    return _IdaCurves(of_all, of_floors, find_resurrections(measured, by=BY))


def _counted(job: Job[Study], measures: pd.DataFrame) -> _IdaCurves:
    """IDA curves as counts, read part by part."""
    from rockfrag.fragility.counted import CountedIda, count_ida

    wanted = list(dict.fromkeys([*job.study.fragility.measures, *candidates()]))
    floors = {name: floor_measures(level) for name, level in job.study.floors.items()}

    def counted(
        system: System, columns: Mapping[str, Sequence[str]], state: str = OVERTURNS
    ) -> dict[str, CountedIda]:
        first, again = (ida_curves_of(job, system, state=state) for _ in range(2))
        return count_ida(first, again, measures, columns)

    of_all: dict[str, IdaData] = {}
    of_floors: StateIdaCurves = defaultdict(dict)
    resurrections = []
    states = _states(job.study)
    for configuration in job.study.configurations:
        found = counted(configuration, {"": wanted, **floors})
        of_all[configuration.name] = found[""]
        resurrections.append(found[""].windows)
        for state in states[configuration.name]:
            of_state = found
            if state.name != OVERTURNS:
                of_state = counted(configuration, floors, state.name)
            for floor in floors:
                of_floors[state.name][configuration.name, floor] = of_state[floor]
    table = pd.concat(resurrections, ignore_index=True).sort_values(BY, ignore_index=True)
    return _IdaCurves(of_all, of_floors, table)


def _at_the_base(table: pd.DataFrame, several_floors: bool) -> pd.DataFrame:
    """Name peaks for what they are where motions of several floors share a curve: of the base."""
    if not several_floors:
        return table
    known = [measure for measure in declared() if measure.demand]
    words = {measure.label: f"peak base {measure.demand.lower()}" for measure in known}
    return table.assign(im=table["im"].replace(words))
