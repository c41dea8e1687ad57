"""Ensembles larger than memory: verdicts, peaks or whole histories straight into a Parquet file."""

from __future__ import annotations

import itertools
import math
import os
import warnings
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager
from typing import Literal

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
from numpy.typing import ArrayLike, NDArray

from rockfrag.engines.kernels.record import EVENT, SAMPLE
from rockfrag.errors import InputError
from rockfrag.files import whole_file
from rockfrag.keywords import named_keywords
from rockfrag.rocking.body_record import body_record
from rockfrag.rocking.ensemble import EnsembleResult, overturns
from rockfrag.rocking.inputs import (
    STEP,
    MotionLike,
    UnitDoubt,
    checked_scales,
    checked_threads,
    listed,
    listed_motions,
    step_count,
    warn_of_unit,
)
from rockfrag.rocking.measured_restitution import Restitution
from rockfrag.rocking.simulation import initial_state, run_march, shaking_of
from rockfrag.system.blocks import Body
from rockfrag.units import GRAVITY

Array = NDArray[np.float64]

ROWS = 262_144
"""Most cases that are in memory at a time, and most rows of a row group."""

CASE = {"body": pa.int32(), "motion": pa.int32(), "scale": pa.float64()}
VERDICT = {"overturned": pa.bool_(), "overturned_body": pa.int8()}
PEAKS = {
    "overturning_time_s": pa.float64(),
    "peak_rotation": pa.float64(),
    "peak_rotation_pedestal": pa.float64(),
    "peak_velocity_rad_s": pa.float64(),
    "impacts": pa.int64(),
    "given_way": pa.int64(),
    "closest_approach": pa.float64(),
}


@named_keywords
def stream_overturns(
    bodies: Body | Sequence[Body],
    motions: MotionLike | Sequence[MotionLike],
    dt: float | Sequence[float] | None,
    scales: ArrayLike,
    path: str | os.PathLike[str],
    *,
    columns: Literal["verdict", "peaks"] = "verdict",
    restitution: Sequence[Restitution] | None = None,
    g: float = GRAVITY,
    step: float = STEP,
    threads: int | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> int:
    """Write the verdict of every body × motion × scale to a Parquet file, in memory that stays flat.

    One row per case, the scale running fastest: ``body``, ``motion`` (positions in the lists given),
    ``scale``, ``overturned``, ``overturned_body`` and, with ``columns="peaks"``, the peak responses of
    :class:`EnsembleResult`.  The file appears whole or not at all, and its bytes do not depend on the
    number of threads.

    Parameters
    ----------
    bodies, motions, dt, scales
        As in :func:`overturns`.
    path
        The file to write.
    columns
        "verdict" or "peaks".
    restitution, g, step, threads
        As in :func:`overturns`.
    progress
        Called with the number of cases done and of all cases after every row group.

    Returns
    -------
    Number of cases.

    Raises
    ------
    InputError
        If an argument cannot be used; the message says which and why.
    """
    if columns not in ("verdict", "peaks"):
        raise InputError(f'columns: expected "verdict" or "peaks", got {columns!r}.')
    body_list, values, dts = listed(bodies, motions, dt, restitution)
    factors = checked_scales(scales, values)
    peaks = np.array([np.abs(one).max() for one in values]) * np.abs(factors).max(axis=1, initial=0)
    warn_of_unit(body_list, listed_motions(motions), peaks, g)
    total = len(body_list) * factors.size
    schema = pa.schema(CASE | VERDICT | (PEAKS if columns == "peaks" else {}))
    done = 0
    with new_table(path, schema) as writer, warnings.catch_warnings():
        # the strongest case has been looked at; a group may hold weak ones alone
        warnings.simplefilter("ignore", UnitDoubt)
        for some, rows, cols in _groups(len(body_list), *factors.shape):
            result = overturns(
                body_list[some],
                values[rows],
                dts[rows].tolist(),
                factors[rows, cols],
                restitution=None if restitution is None else restitution[some],
                g=g,
                step=step,
                threads=threads,
            )
            writer.write_table(_table(result, some, rows, factors[rows, cols], schema))
            done += result.overturned.size
            if progress is not None:
                progress(done, total)
    return total


@contextmanager
def new_table(path: str | os.PathLike[str], schema: pa.Schema) -> Iterator[pq.ParquetWriter]:
    """Give a writer of a Parquet file that appears, whole, when the block ends without error."""
    with whole_file(path) as part, pq.ParquetWriter(part, schema, compression="zstd") as writer:
        yield writer


def _groups(n_bodies: int, n_motions: int, n_scales: int) -> Iterator[tuple[slice, slice, slice]]:
    """Cut bodies × motions × scales, in this order, into boxes of at most ROWS cases."""
    if n_motions * n_scales == 0:
        return
    scales = min(n_scales, ROWS)
    motions = min(n_motions, max(1, ROWS // n_scales))
    bodies = max(1, ROWS // (n_motions * n_scales))
    for i in range(0, n_bodies, bodies):
        for j in range(0, n_motions, motions):
            for k in range(0, n_scales, scales):
                yield (
                    slice(i, min(i + bodies, n_bodies)),
                    slice(j, min(j + motions, n_motions)),
                    slice(k, min(k + scales, n_scales)),
                )


def _table(
    result: EnsembleResult, bodies: slice, motions: slice, scales: Array, schema: pa.Schema
) -> pa.Table:
    shape = result.overturned.shape
    body = np.arange(bodies.start, bodies.stop, dtype=np.int32)[:, np.newaxis, np.newaxis]
    motion = np.arange(motions.start, motions.stop, dtype=np.int32)[:, np.newaxis]
    values = {
        "body": body,
        "motion": motion,
        "scale": scales,
        "overturned": result.overturned,
        "overturned_body": result.overturned_body,
        "overturning_time_s": result.overturning_time,
        "peak_rotation": result.peak_rotation,
        "peak_rotation_pedestal": result.peak_rotation_pedestal,
        "peak_velocity_rad_s": result.peak_velocity,
        "impacts": result.impacts,
        "given_way": result.given_way,
        "closest_approach": result.closest_approach,
    }
    arrays = [
        pa.array(np.broadcast_to(values[name], shape).ravel(), type=schema.field(name).type)
        for name in schema.names
    ]
    assert math.prod(shape) == len(arrays[0])
    return pa.Table.from_arrays(arrays, schema=schema)


# --------------------------------------------------------------------------- histories

Case = tuple[int, int, int]
"""Positions of body, motion and scale."""

AHEAD = 2
"""Histories that are marched or wait to be written at a time, for each thread."""

COLUMNS = {
    "theta_pedestal_rad": "theta1",
    "omega_pedestal_rad_s": "omega1",
    "theta_statue_rad": "theta2",
    "omega_statue_rad_s": "omega2",
    "state_pedestal": "c1",
    "state_statue": "c2",
}
"""Columns of the file, and what the march calls them in its history."""

SCHEMA = pa.schema(
    CASE
    | {"time_s": pa.float64()}
    | {name: pa.int8() if name.startswith("state") else pa.float64() for name in COLUMNS}
)


@named_keywords
def stream_histories(
    bodies: Body | Sequence[Body],
    motions: MotionLike | Sequence[MotionLike],
    dt: float | Sequence[float] | None,
    scales: ArrayLike,
    path: str | os.PathLike[str],
    *,
    restitution: Sequence[Restitution] | None = None,
    g: float = GRAVITY,
    step: float = STEP,
    threads: int | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> int:
    """Write the history of every body × motion × scale to a Parquet file, in memory that stays flat.

    One row per case and sample, the samples running fastest, then the scale: ``body``, ``motion``
    (positions in the lists given), ``scale``, ``time_s``, rotation and angular velocity
    ``theta_pedestal_rad``, ``omega_pedestal_rad_s``, ``theta_statue_rad``, ``omega_statue_rad_s`` and contact
    ``state_pedestal``, ``state_statue``, as in :class:`Response`.  A lone block counts as a statue on a
    pedestal that stays at 0.  At the default step the numbers are, bit for bit, those that
    :func:`simulate` gives for the scaled motion.  The file appears whole or not at all, and its bytes do not
    depend on the number of threads.

    Parameters
    ----------
    bodies, motions, dt, scales
        As in :func:`overturns`.
    path
        The file to write.
    restitution, g, step, threads
        As in :func:`overturns`.
    progress
        Called with the number of cases done and of all cases after every row group.

    Returns
    -------
    Number of cases.

    Raises
    ------
    InputError
        If an argument cannot be used; the message says which and why.
    """
    body_list, values, dts = listed(bodies, motions, dt, restitution)
    factors = checked_scales(scales, values)
    per_body = restitution if restitution is not None else [None] * len(body_list)
    records = [body_record(b, e, g=g) for b, e in zip(body_list, per_body, strict=True)]
    for body in body_list:
        # refused here and not in the middle of the file: the longest interval needs most steps
        step_count(body, dts, g, step)
    total = len(body_list) * factors.size

    def history(case: Case) -> pa.Table:
        b, m, s = case
        interval, scale = float(dts[m]), float(factors[m, s])
        shaking = shaking_of(body_list[b], (values[m], np.zeros(0)), interval, scale, g, step)
        rows = np.empty(values[m].size + shaking.free_samples, SAMPLE)
        # the march of simulate() without its tables of events and energy, which take most of its time
        start = initial_state(body_list[b])
        done, _ = run_march(records[b], shaking, start, rows, np.empty(0, EVENT))
        return _history_table(case, scale, interval, rows[:done])

    n_motions, n_scales = factors.shape
    cases = itertools.product(range(len(body_list)), range(n_motions), range(n_scales))
    workers = checked_threads(threads)
    with new_table(path, SCHEMA) as writer, ThreadPoolExecutor(workers) as pool:
        written = 0
        for group in _row_groups(_in_order(pool, history, cases, AHEAD * workers)):
            writer.write_table(pa.concat_tables(group), row_group_size=ROWS)
            written += len(group)
            if progress is not None:
                progress(written, total)
    return total


def _in_order(
    pool: ThreadPoolExecutor,
    work: Callable[[Case], pa.Table],
    cases: Iterable[Case],
    most: int,
) -> Iterator[pa.Table]:
    """Yield ``work(case)`` in the order of the cases, ``most`` of them at a time under work or done."""
    waiting: deque[Future[pa.Table]] = deque()
    for case in cases:
        if len(waiting) == most:
            yield waiting.popleft().result()
        waiting.append(pool.submit(work, case))
    while waiting:
        yield waiting.popleft().result()


def _row_groups(tables: Iterable[pa.Table]) -> Iterator[list[pa.Table]]:
    """Gather tables of at most ROWS rows together; a longer one stays alone."""
    group: list[pa.Table] = []
    rows = 0
    for table in tables:
        if group and rows + len(table) > ROWS:
            yield group
            group, rows = [], 0
        group.append(table)
        rows += len(table)
    if group:
        yield group


def _history_table(case: Case, scale: float, dt: float, rows: NDArray[np.void]) -> pa.Table:
    body, motion, _ = case
    values = {
        "body": np.full(len(rows), body),
        "motion": np.full(len(rows), motion),
        "scale": np.full(len(rows), scale),
        "time_s": np.arange(len(rows)) * dt,
    } | {name: rows[field] for name, field in COLUMNS.items()}
    arrays = [pa.array(values[field.name].astype(field.type.to_pandas_dtype())) for field in SCHEMA]
    return pa.Table.from_arrays(arrays, schema=SCHEMA)
