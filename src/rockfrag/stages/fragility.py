"""Fragility: curves of every configuration, the measure that foretells overturning best, exports."""

import pandas as pd

from rockfrag.stages.measure_choice import export_curves, ground_curves, measure_choice
from rockfrag.stages.stage import Job, Results, Stage
from rockfrag.study.study import Study


def run(job: Job[Study]) -> Results:
    """Yield curves, survival windows and the comparison of measures; write curves for export."""
    from rockfrag.fragility.empirical import survival_windows
    from rockfrag.fragility.sweeps import fragility_tables, record_set_hash, with_measures

    settings, measures = job.study.fragility, job.table("measures")
    sweep = pd.concat([job.table(name) for name in job.study.sweep_tables], ignore_index=True)
    motions = job.motions("motions/floors")
    record_set = record_set_hash(motions)
    columns = list(settings.measures)
    measured = with_measures(sweep, measures, columns)
    found = fragility_tables(measured, columns, record_set=record_set, level=settings.confidence)
    yield "fragility", found.curves
    yield "fragility_bands", found.bands
    yield "fragility_bins", found.bins
    by = ["configuration", "event", "floor", "motion"]
    yield "survival_windows", survival_windows(measured, by=by)
    choice = measure_choice(sweep, measures, settings.confidence, job.study.seed)
    yield "measure_choice", choice
    ground = ground_floor(job.study)
    if ground is not None:
        on_ground = ground_curves(sweep, measures, record_set, settings.confidence, ground)
        yield "fragility_ground", on_ground
        exports = job.folder / "exports"
        exports.mkdir(parents=True, exist_ok=True)
        job.log.info("exported %s", ", ".join(export_curves(on_ground, exports)) or "no curve")
    best = choice.loc[choice["recommended"], "im"]
    job.log.info("%d curves; best measures: %s", len(found.curves), ", ".join(dict.fromkeys(best)))


def ground_floor(study: Study) -> str | None:
    """Label of the floor that moves as the ground does, or None: other programs know no other."""
    return next((label for label, level in study.floors.items() if level == 0), None)


STAGE = Stage(
    name="fragility",
    run=run,
    inputs=lambda study: ("measures", "motions/floors.parquet", *study.sweep_tables),
    outputs=lambda study: (
        "fragility",
        "fragility_bands",
        "fragility_bins",
        "survival_windows",
        "measure_choice",
        *([] if ground_floor(study) is None else ["fragility_ground", "exports/"]),
    ),
    settings=("fragility", "seed"),
)
