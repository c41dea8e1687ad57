"""Motions: records read, processed, felt by the floors of a building, and measured."""

from pathlib import Path

from rockfrag.records.motion import Motion
from rockfrag.stages.stage import Job, Results, Stage
from rockfrag.study.study import GROUND, RECORDS_FOLDER, Study

WRITTEN = "motions/written"
"""Folder of the motions of all floors in the format that a study asks for."""


def run(job: Job[Study]) -> Results:
    """Yield the motions as read, on the ground and on every floor, and their intensity measures."""
    from rockfrag.motions.directions import measure_records, motion_of_row
    from rockfrag.motions.measures import measure_motions
    from rockfrag.motions.processing import process

    study = job.study
    place = study.catalogue_file.parent, Path(RECORDS_FOLDER)
    rows = [
        {str(key): value for key, value in row.items()}
        for row in study.catalogue.to_dict("records")
    ]
    records = [motion_of_row(row, *place) for row in rows]
    yield "motions/records", records
    ground = [process(one, study.processing) for one in records]
    yield "motions/ground", ground
    floors = [floor for one in ground for floor in _floors(study, one)]
    yield "motions/floors", floors
    if study.write_motions is not None:
        from rockfrag.records.write import write_motions

        write_motions(floors, job.folder / WRITTEN, study.write_motions)
    table = measure_motions(floors)
    pairs = measure_records(rows, *place, study.processing)
    if len(pairs):
        # what no direction decides is known of the ground alone
        grounds = {
            one.metadata["ground_motion"]: one.name for one in floors if one.metadata["level"] == 0
        }
        pairs = pairs.assign(name=pairs["name"].map(grounds)).dropna(subset="name")
        table = table.merge(pairs, on="name", how="left")
    yield "measures", table
    job.log.info("%d records, %d motions of floors", len(records), len(floors))


def _floors(study: Study, ground: Motion) -> list[Motion]:
    if study.building is None:
        return [on_the_ground(ground)]
    from rockfrag.building.floors import floor_motions

    return floor_motions(study.building, ground)


def on_the_ground(motion: Motion) -> Motion:
    """Return a ground motion labelled as the floors of a building are: ``<name>_ground``."""
    from dataclasses import replace

    metadata = {**motion.metadata, "floor": GROUND, "level": 0, "ground_motion": motion.name}
    return replace(motion, name=f"{motion.name}_{GROUND}", metadata=metadata)


STAGE = Stage(
    name="motions",
    run=run,
    files=lambda study: [
        str(study.catalogue_file),
        *study.record_files(RECORDS_FOLDER),
        *([] if study.building_file is None else [str(study.building_file)]),
    ],
    outputs=lambda study: (
        "motions/records.parquet",
        "motions/ground.parquet",
        "motions/floors.parquet",
        "measures",
        *([] if study.write_motions is None else [f"{WRITTEN}/"]),
    ),
    settings=("motions", "building", "write_motions"),
)
