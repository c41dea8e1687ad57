"""Fragility: curves of every configuration, the measure that foretells overturning best, exports."""

import pandas as pd

from rockfrag.stages.floor_curves import export_curves, floor_curves
from rockfrag.stages.measure_choice import measure_choice
from rockfrag.stages.stage import Job, Results, Stage
from rockfrag.study.study import Study


def run(job: Job[Study]) -> Results:
    """Yield curves, survival windows and the comparison of measures; write curves for export."""
    from rockfrag.fragility.empirical import survival_windows
    from rockfrag.fragility.sweeps import fragility_tables, record_set_hash, with_measures

    settings, measures = job.study.fragility, job.table("measures")
    sweep = pd.concat([job.table(name) for name in job.study.sweep_tables], ignore_index=True)
    record_set = record_set_hash(job.motions("motions/records"))
    columns = list(settings.measures)
    measured = with_measures(sweep, measures, columns)
    found = fragility_tables(measured, columns, record_set=record_set, level=settings.confidence)
    several = len(set(measured["floor"])) > 1
    yield "fragility", _at_the_base(found.curves, several)
    yield "fragility_bands", _at_the_base(found.bands, several)
    yield "fragility_bins", _at_the_base(found.bins, several)
    yield "fragility_shares", _at_the_base(found.shares, several)
    by = ["configuration", "event", "floor", "motion"]
    yield "survival_windows", survival_windows(measured, by=by)
    choice = measure_choice(sweep, measures, settings.confidence, job.study.seed)
    yield "measure_choice", choice
    bodies = {one.name: one.body for one in job.study.configurations}
    floors = job.study.floors
    by_floor, floor_shares = floor_curves(
        sweep,
        measures,
        floors,
        bodies,
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
    best = choice.loc[choice["recommended"], "im"]
    job.log.info("curves: %d; best measures: %s", len(found.curves), ", ".join(dict.fromkeys(best)))


def _at_the_base(table: pd.DataFrame, several_floors: bool) -> pd.DataFrame:
    """Name peaks for what they are where motions of several floors share a curve: of the base."""
    if not several_floors:
        return table
    return table.assign(
        im=table["im"].replace({"PGA": "peak base acceleration", "PGV": "peak base velocity"})
    )


STAGE = Stage(
    name="fragility",
    run=run,
    inputs=lambda study: ("measures", "motions/records.parquet", *study.sweep_tables),
    outputs=(
        "fragility",
        "fragility_bands",
        "fragility_bins",
        "fragility_shares",
        "survival_windows",
        "measure_choice",
        "fragility_floors",
        "fragility_floors_shares",
        "exports/",
    ),
    settings=("fragility", "seed", "bodies", "building", "friction", "vertical"),
)
