"""Motions of a study: records read, processed, felt by the floors of a building, and measured.

In: the catalogue of a study and its records. Out: motions as read, on the ground and on every floor [m/s²], their
intensity measures, by how much they are scaled, and which were left out and why. Theory: ``docs/motions.md``,
``docs/building.md``.
"""

from collections import defaultdict
from dataclasses import replace
from pathlib import Path
from typing import Any, cast

import pandas as pd

from rockfrag.base.errors import InputError
from rockfrag.building.floors import floor_motions, vertical_motions
from rockfrag.motions.directions import measure_records, motions_of_row
from rockfrag.motions.measures import measure_motions
from rockfrag.motions.processing import process
from rockfrag.records.motion import Motion
from rockfrag.records.sources.wheel import NotFetched
from rockfrag.records.write import write_motions
from rockfrag.stages.job import Job, Results
from rockfrag.study.scaling import scaling_table, too_weak
from rockfrag.study.study import GROUND, RECORDS_FOLDER, Study

LEFT_OUT = "left_out"  # Table of the motions that a study has left out, and why
MOST_SAID = 3  # So many of them are named on the screen

WRITTEN = "motions/written"
"""Folder of the motions of all floors in the format that a study asks for."""


def run(job: Job[Study]) -> Results:
    """Yield the motions as read, on the ground and on every floor, and their intensity measures."""
    study = job.study
    rows, felt, left_out = _usable_motions(job)
    floors = felt["floors"]
    yield from ((f"motions/{name}", motions) for name, motions in felt.items())
    yield LEFT_OUT, pd.DataFrame(left_out, columns=["motion", "reason"], dtype=str)
    yield "scaling", scaling_table(study, felt["ground"], floors)
    if study.write_motions is not None:
        write_motions(floors, job.folder / WRITTEN, study.write_motions)
    table = measure_motions(floors, processes=job.threads)
    pairs = measure_records(
        rows, study.catalogue_file.parent, Path(RECORDS_FOLDER), study.processing
    )
    if len(pairs):
        # what no direction decides is known of the ground alone
        grounds = {
            floor.metadata["ground_motion"]: floor.name
            for floor in floors
            if floor.metadata["level"] == 0
        }
        pairs = pairs.assign(name=pairs["name"].map(grounds)).dropna(subset="name")
        table = table.merge(pairs, on="name", how="left")
    yield "measures", table
    missing = "".join(
        f", left out: {row['motion']}, {row['reason'].rstrip('.')}"
        for row in left_out[:MOST_SAID]
    )
    if len(left_out) > MOST_SAID:
        missing += f", and {len(left_out) - MOST_SAID} more"
    job.log.info(
        "records: %d%s, motions of floors: %d", len(rows), missing, len(floors)
    )


def _usable_motions(
    job: Job[Study],
) -> tuple[list[dict[str, Any]], dict[str, list[Motion]], list[dict[str, str]]]:
    """Rows of the catalogue that can be used, their motions by kind, and which were left out and why.

    Kinds are those of :func:`_motions_by_kind`.
    """
    study = job.study
    usable: dict[str, list[Motion]] = defaultdict(list)
    rows, left_out = [], []
    unfetched: dict[str, NotFetched] = {}
    for named in cast("list[dict[str, Any]]", study.catalogue.to_dict("records")):
        source = str(named["source"])
        try:
            if source in unfetched:
                # asked for once in a run, which takes a minute where there is no network
                raise unfetched[source]
            found = _motions_by_kind(study, named)
            if weak := too_weak(study, found["floors"]):
                left_out.append({"motion": str(named["name"]), "reason": f"{weak}."})
                job.log.warning("left out: %s: %s", named["name"], weak)
                continue
            for kind, motions in found.items():
                usable[kind] += motions
            rows.append(named)
        except InputError as error:
            if not study.keep_going:
                raise
            if isinstance(error, NotFetched):
                unfetched[source] = error
            left_out.append({"motion": str(named["name"]), "reason": str(error)})
            job.log.warning("left out: %s", error)
    if not rows:
        raise InputError(
            f"{study.catalogue_file}: no record can be used; {left_out[0]['reason']}"
        )
    return rows, usable, left_out


def _motions_by_kind(study: Study, row: dict[str, Any]) -> dict[str, list[Motion]]:
    """Motions of a row of the catalogue, by kind.

    ``records`` has the motion as read, ``ground`` as the study processes it, ``floors`` that of every floor, and
    with vertical motion ``vertical`` the vertical one of every floor.
    """
    folder, records = study.catalogue_file.parent, Path(RECORDS_FOLDER)
    record, *up = motions_of_row(row, folder, records, study.vertical)
    if record.pga == 0:
        raise InputError(f"{record.name}: the record is zero throughout; leave it out.")
    ground = process(record, study.processing)
    found = {
        "records": [record],
        "ground": [ground],
        "floors": _floors(study, ground),
    }
    if up:
        vertical = process(up[0], study.processing)
        found["vertical"] = _floors(study, vertical, vertical=True)
    return found


def _floors(study: Study, ground: Motion, vertical: bool = False) -> list[Motion]:
    """Motions of the ground and of the floors of a building, if the study has one."""
    if study.building is None:
        return [on_the_ground(ground)]
    return (vertical_motions if vertical else floor_motions)(study.building, ground)


def on_the_ground(motion: Motion) -> Motion:
    """Return a ground motion labelled as the floors of a building are: ``<name>_ground``."""
    metadata = {
        **motion.metadata,
        "floor": GROUND,
        "level": 0,
        "ground_motion": motion.name,
    }
    return replace(motion, name=f"{motion.name}_{GROUND}", metadata=metadata)
