"""Incremental dynamic analysis (IDA): every configuration under every motion at every amplitude.

In: the ground motions of a study, on every floor. Out: IDA curves, a Parquet file a configuration and part of
the motions, which all statistics start from, and the table ``as_recorded``; amplitudes are peaks [g]. Theory:
``docs/definitions.md``, ``docs/fragility.md``, "Estimators".
"""

import warnings
from collections.abc import Iterator, Sequence
from itertools import chain
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq
from numpy.typing import NDArray

from rockfrag.base.files import whole_file
from rockfrag.base.units import GRAVITY
from rockfrag.motions.processing import factors_to_pga
from rockfrag.outcomes.limit_states import (
    OVERTURNS,
    ROCKS,
    limit_state_named,
    limit_states,
)
from rockfrag.outcomes.outcomes import Outcomes
from rockfrag.records.motion import GroundMotion
from rockfrag.shaketable.definitions import Swept, fallen_names, labels_of, read_swept
from rockfrag.simulation.ensemble import LIGHT, LightBodies, overturns
from rockfrag.stages.job import Job, Results
from rockfrag.study.study import Study
from rockfrag.system.system import System

NEAR = 1 + 0.01 * np.arange(-10, 11)
"""Factors on a motion as recorded: itself, and up to a tenth weaker and stronger."""

RECORDED = (
    "overturning_time",
    "certain_time",
    "impacts",
    "unstable_distance",
    "peak_rotation",
)
"""Columns of outcomes in every IDA curve."""

# Columns of outcomes in IDA curves with friction
SLID = ("flights", "slip", "peak_slip")
HELD = ("hits", "largest_impulse", "largest_force", "breaking_time", "stroke")
ROWS_AT_ONCE = 131_072  # Histories in memory at a time, and of a row group of a file
FEWEST_AT_ONCE = 12  # Motions shaken at a time are no fewer, to keep every core busy


def run(job: Job[Study]) -> Results:
    """Write the IDA curves of all configurations; yield the outcomes under the motions as recorded."""
    yield from run_part(job)
    yield from run_as_recorded(job)


def run_part(job: Job[Study]) -> Results:
    """Write the IDA curve of every configuration under the job's part of the motions, a few motions at a time."""
    study, number = job.study, job.part
    part, amplitudes = (number, study.ida_jobs), study.amplitudes.values_g
    motions = ground_motions_of(job, part)
    batch = max(FEWEST_AT_ONCE, ROWS_AT_ONCE // len(amplitudes))
    histories = 0

    def table(configuration: System, start: int) -> pa.Table:
        here = motions[start : start + batch]
        return ida_table(configuration, here, amplitudes, job.threads)

    for configuration in study.configurations:
        with whole_file(job.folder / study.ida_file(configuration, number)) as path:
            starts = range(0, len(motions), batch)
            histories += _write((table(configuration, start) for start in starts), path)
        if study.vertical and not configuration.loose:
            _say_how_light(job, configuration, number)
        job.log.info("%s: %d histories so far", configuration.name, histories)
    job.log.info("response histories: %d", histories)
    yield from ()


def run_as_recorded(job: Job[Study]) -> Results:
    """Yield the outcomes under the motions as recorded."""
    motions = ground_motions_of(job)
    each = [
        as_recorded(system, motions, job.threads) for system in job.study.configurations
    ]
    yield "as_recorded", pd.concat(each, ignore_index=True)


def ground_motions_of(
    job: Job[Study], part: tuple[int, int] = (0, 1)
) -> list[GroundMotion]:
    """Motions of every floor, with the vertical component beside the horizontal one where the study has it.

    Parameters
    ----------
    job : the stage's job
    part : number of the part of the motions, from 0, and number of parts

    Returns
    -------
    The motions, in the study's order.
    """
    horizontal = job.motions("motions/floors", part)
    if not job.study.vertical:
        return [GroundMotion(x) for x in horizontal]
    upward = job.motions("motions/vertical", part)
    return [GroundMotion(x, z=z) for x, z in zip(horizontal, upward, strict=True)]


def ida_curves_of(
    job: Job[Study], configuration: System, *, state: str = OVERTURNS
) -> Iterator[Swept]:
    """Yield the outcomes of a configuration, see :func:`rockfrag.shaketable.definitions.read_swept`."""
    parts = range(job.study.ida_jobs)
    files = (job.file(job.study.ida_file(configuration, part)) for part in parts)
    yield from read_swept(files, state=state)


def _say_how_light(job: Job[Study], configuration: System, number: int) -> None:
    """Log in how many histories the ground takes more than half of all weight."""
    path = job.folder / job.study.ida_file(configuration, number)
    ratio = pq.read_table(path, columns=["minimum_gravity_ratio"])[
        "minimum_gravity_ratio"
    ]
    light = int((ratio.to_numpy() < LIGHT).sum())
    words = "%s: the ground takes more than half of all weight in %d of %d histories"
    job.log.info(words, configuration.name, light, len(ratio))


def _write(tables: Iterator[pa.Table], path: Path) -> int:
    """Write tables to one Parquet file, a row group each, and return the number of rows."""
    first = next(tables)
    rows = 0
    # texts are read as texts, however compactly they are handed on here
    with pq.ParquetWriter(
        path, first.schema, compression="zstd", store_schema=False
    ) as writer:
        for table in chain([first], tables):
            writer.write_table(table)
            rows += table.num_rows
    return rows


def ida_table(
    configuration: System,
    motions: Sequence[GroundMotion],
    amplitudes_g: NDArray[np.float64],
    threads: int = 1,
) -> pa.Table:
    """Shake one configuration by every motion, scaled to every peak.

    Parameters
    ----------
    configuration, motions : what is shaken, and by what; the peaks are of the horizontal component
    amplitudes_g : peaks [g], rising, shape (n,)
    threads : threads to use; outcomes do not depend on it

    Returns
    -------
    pyarrow.Table
        One row per motion and amplitude: ``configuration``, ``object``, ``pedestal`` (``P`` or ``NP``),
        ``motion``, ``earthquake``, ``floor``, ``amplitude_g``, a column for each limit state that is counted
        (``overturned``, with friction ``slides``), ``overturned_body``, ``overturning_time_s`` and
        ``certain_time_s`` (instant of the fall, and from which it was certain), ``impacts``,
        ``unstable_distance`` (small where the outcome nearly flipped), ``peak_rotation_body_1`` and on (|θ| of
        each body from below over its critical angle); with vertical motion and without friction also
        ``minimum_gravity_ratio``; with friction also ``peak_slip_m`` (of any contact), ``slip_contact_1_m`` and
        on (at the end), ``peak_slip_contact_1_m`` and on, ``flights`` and ``overturned_without_sliding``, the
        outcome if nothing could slide or fly.
    """
    scales = np.array([factors_to_pga(motion.x, amplitudes_g) for motion in motions])
    result = _shaken(configuration, motions, scales, threads)
    each = len(amplitudes_g)

    which = np.repeat(np.arange(len(motions)), each)
    about = _about(configuration, motions)
    made = {
        **{name: _texts(texts, which) for name, texts in about.items()},
        "amplitude_g": np.tile(amplitudes_g, len(motions)),
        **{
            state.column: state.reached(result)[0].ravel()
            for state in limit_states()
            if state.counted(configuration)
        },
        "overturned_body": _texts(
            fallen_names(configuration), result.overturned_body[0].ravel()
        ),
        **result.wide(0, RECORDED),
    }
    if configuration.holding:
        made |= result.wide(0, HELD)
    if configuration.loose:
        rough = result.without_sliding
        if rough is None:
            # no engine of pure rocking has columns of three bodies, nor what is held: the contacts, too rough to
            # slide, are integrated once more, so that two integrations are made of a case here too
            rough = _shaken(configuration.held(), motions, scales, threads).overturned
        made["peak_slip_m"] = result.of_any("peak_slip")[0].ravel()
        made |= result.wide(0, SLID)
        made["overturned_without_sliding"] = rough[0].ravel()
    elif motions[0].z is not None:
        made |= result.wide(0, ("minimum_gravity_ratio",))
    return pa.table(made)


def _about(
    configuration: System, motions: Sequence[GroundMotion]
) -> dict[str, list[str]]:
    """Labels of a configuration and of each motion in tables."""
    labels = {
        key: [text] * len(motions) for key, text in labels_of(configuration).items()
    }
    return labels | {
        "motion": [motion.name for motion in motions],
        "earthquake": [
            motion.x.metadata.get("earthquake") or motion.name for motion in motions
        ],
        "floor": [motion.x.metadata["floor"] for motion in motions],
    }


def _texts(texts: Sequence[str], which: NDArray[np.integer[Any]]) -> pa.DictionaryArray:
    """The text of each number, of which a file holds the different ones once."""
    return pa.array(texts, pa.string()).dictionary_encode().take(pa.array(which))


def _shaken(
    configuration: System,
    motions: Sequence[GroundMotion],
    scales: NDArray[np.float64],
    threads: int,
) -> Outcomes:
    """Outcomes of one configuration under every motion at every scale; ``scales``: shape (motions, scales)."""
    with warnings.catch_warnings():
        # told of in the column minimum_gravity_ratio and in the report
        warnings.simplefilter("ignore", LightBodies)
        return overturns(configuration, motions, scales=scales, threads=threads)


def as_recorded(
    configuration: System, motions: Sequence[GroundMotion], threads: int = 1
) -> pd.DataFrame:
    """Shake one configuration by every motion as it was recorded.

    Parameters
    ----------
    configuration, motions, threads : as of :func:`ida_table`

    Returns
    -------
    pandas.DataFrame
        One row per motion: ``configuration``, ``object``, ``pedestal`` (``P`` or ``NP``), ``motion``,
        ``earthquake``, ``floor``, ``pga_g``, ``rocked`` (any body), ``overturned``, ``overturned_body``,
        ``peak_rotation`` (of the object on what it stands on, |θ| over the critical angle), ``fraction_near``
        (fraction that overturns of the motions up to a tenth weaker or stronger); with friction also
        ``peak_slip_m``.
    """
    scales = np.tile(NEAR, (len(motions), 1))
    result = _shaken(configuration, motions, scales, threads)
    itself = len(NEAR) // 2
    table = pd.DataFrame(
        {
            **_about(configuration, motions),
            "pga_g": [motion.x.pga / GRAVITY for motion in motions],
            "rocked": limit_state_named(ROCKS).reached(result)[0, :, itself],
            "overturned": result.overturned[0, :, itself],
            "overturned_body": np.take(
                fallen_names(configuration), result.overturned_body[0, :, itself]
            ),
            "peak_rotation": result.peak_rotation[0, :, itself, -1],
            "fraction_near": result.overturned[0].mean(axis=1),
        }
    )
    if not configuration.loose:
        return table
    return table.assign(peak_slip_m=result.of_any("peak_slip")[0, :, itself])
