"""Fragility: curves of every configuration, the measure that predicts overturning best, exports."""

from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import pandas as pd

from rockfrag.motions.declared import declared
from rockfrag.outcomes.limit_states import OVERTURNS, LimitState, limit_states
from rockfrag.stages.floor_curves import export_curves, floor_curves, floor_measures
from rockfrag.stages.job import Job, Results
from rockfrag.stages.measure_choice import best_of, candidates, measure_choice
from rockfrag.stages.read_sweeps import rows_of, sweeps_of
from rockfrag.study.study import Study
from rockfrag.system.system import System

if TYPE_CHECKING:
    # every job reads this module for the list of stages; only curves need scipy
    from rockfrag.fragility.sweep_data import SweepData
    from rockfrag.stages.floor_curves import StateSweeps


def run(job: Job[Study]) -> Results:
    """Yield curves, survival windows and the comparison of measures; write curves for export."""
    from rockfrag.fragility.sweeps import record_set_hash, tables_of_sweeps

    settings, measures = job.study.fragility, job.table("measures")
    record_set = record_set_hash(job.motions("motions/records"))
    columns = list(settings.measures)
    data = _counted(job, measures) if job.study.is_large else _rows(job, measures)
    of_all = data.of_all
    found = tables_of_sweeps(
        (({"configuration": name}, of_all[name]) for name in sorted(of_all)),
        columns,
        record_set=record_set,
        level=settings.confidence,
    )
    several = len(set(measures["floor"])) > 1
    yield "fragility", _at_the_base(found.curves, several)
    yield "fragility_bands", _at_the_base(found.bands, several)
    yield "fragility_bins", _at_the_base(found.bins, several)
    yield "fragility_shares", _at_the_base(found.shares, several)
    yield "survival_windows", data.windows
    yield from _two_measures(job, measures)
    choice = measure_choice(of_all, measures, settings.confidence, job.study.seed)
    yield "measure_choice", choice
    by_floor, floor_shares = floor_curves(
        data.of_floors,
        measures,
        job.study.floors,
        {one.name: one for one in job.study.configurations},
        record_set,
        settings.confidence,
        rocks_at_once=not (job.study.slides or job.study.vertical),
    )
    yield "fragility_floors", by_floor
    yield "fragility_floors_shares", floor_shares
    exports = job.folder / "exports"
    exports.mkdir(parents=True, exist_ok=True)
    job.log.info(
        "exported %s", ", ".join(export_curves(by_floor, exports, floor_shares)) or "no curve"
    )
    best = ", ".join(best_of(choice, columns))
    job.log.info(
        "curves: %d; best of the measures asked for: %s",
        len(found.curves),
        best or "none stands out",
    )


def _two_measures(job: Job[Study], measures: pd.DataFrame) -> Results:
    """Fits in the pairs of measures that the study names; tables without rows where it names none."""
    from rockfrag.fragility.sweeps import with_measures
    from rockfrag.fragility.vector_tables import vector_tables

    pairs = job.study.fragility.pairs
    columns = list(dict.fromkeys(measure for pair in pairs for measure in pair))
    tests = {}
    for one in job.study.configurations if pairs else []:
        rows = rows_of(sweeps_of(job, one))
        tests[one.name] = with_measures(rows, measures, columns)
    settings = job.study.fragility
    found = vector_tables(tests, pairs, level=settings.confidence, seed=job.study.seed)
    yield "fragility_two_measures", found.fits
    yield "fragility_contours", found.contours
    yield "fragility_cells", found.cells


BY = ["configuration", "event", "floor", "motion"]


@dataclass(frozen=True)
class _Sweeps:
    """Sweeps by configuration, and by limit state, configuration and floor; survival windows of all."""

    of_all: dict[str, "SweepData"]
    of_floors: "StateSweeps"
    windows: pd.DataFrame


def _states(study: Study) -> dict[str, tuple[LimitState, ...]]:
    """Limit states that the sweep of each configuration counts."""
    return {
        one.name: tuple(state for state in limit_states() if state.counted(one))
        for one in study.configurations
    }


def _rows(job: Job[Study], measures: pd.DataFrame) -> _Sweeps:
    """Sweeps as tables, every verdict a row."""
    from rockfrag.fragility.empirical import survival_windows
    from rockfrag.fragility.sweep_data import TableSweep
    from rockfrag.fragility.sweeps import with_measures

    sweep = pd.concat(
        [pd.read_parquet(job.file(path)) for path in job.study.sweep_files], ignore_index=True
    )
    wanted = list(dict.fromkeys([*job.study.fragility.measures, *candidates()]))
    measured = with_measures(sweep, measures, wanted)
    of_all: dict[str, SweepData] = {
        str(name): TableSweep(part) for name, part in measured.groupby("configuration", sort=False)
    }
    states = _states(job.study)
    of_floors: StateSweeps = defaultdict(dict)
    for (name, floor), part in sweep.groupby(["configuration", "floor"], sort=False):
        columns = floor_measures(job.study.floors[str(floor)])
        here = with_measures(part, measures, columns)
        for state in states[str(name)]:
            reached = here[state.column].astype(bool)
            of_floors[state.name][str(name), str(floor)] = TableSweep(
                here.assign(overturned=reached)
            )
    return _Sweeps(of_all, of_floors, survival_windows(measured, by=BY))


def _counted(job: Job[Study], measures: pd.DataFrame) -> _Sweeps:
    """Sweeps as counts, read part by part."""
    from rockfrag.fragility.counted import CountedSweep

    wanted = list(dict.fromkeys([*job.study.fragility.measures, *candidates()]))
    floors = {name: floor_measures(level) for name, level in job.study.floors.items()}

    def counted(
        one: System, columns: Mapping[str, Sequence[str]], state: str = OVERTURNS
    ) -> CountedSweep:
        first, again = (sweeps_of(job, one, state=state) for _ in range(2))
        return CountedSweep(first, again, measures, columns)

    of_all: dict[str, SweepData] = {}
    of_floors: StateSweeps = defaultdict(dict)
    windows = []
    states = _states(job.study)
    for one in job.study.configurations:
        found = counted(one, {"": wanted, **floors})
        of_all[one.name] = found.of_floor("")
        windows.append(found.windows(""))
        for state in states[one.name]:
            of_state = found if state.name == OVERTURNS else counted(one, floors, state.name)
            for floor in floors:
                of_floors[state.name][one.name, floor] = of_state.of_floor(floor)
    table = pd.concat(windows, ignore_index=True).sort_values(BY, ignore_index=True)
    return _Sweeps(of_all, of_floors, table)


def _at_the_base(table: pd.DataFrame, several_floors: bool) -> pd.DataFrame:
    """Name peaks for what they are where motions of several floors share a curve: of the base."""
    if not several_floors:
        return table
    words = {one.label: f"peak base {one.demand.lower()}" for one in declared() if one.demand}
    return table.assign(im=table["im"].replace(words))
