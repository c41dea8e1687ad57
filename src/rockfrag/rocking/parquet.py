"""Ensembles larger than memory: verdicts straight into a Parquet file."""

import math
import os
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Literal

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
from numpy.typing import ArrayLike, NDArray

from rockfrag.errors import InputError
from rockfrag.files import whole_file
from rockfrag.rocking.bodies import Body
from rockfrag.rocking.body_record import Restitution
from rockfrag.rocking.ensemble import EnsembleResult, overturns
from rockfrag.rocking.inputs import STEP, checked_scales, listed
from rockfrag.units import STANDARD_GRAVITY

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
    "closest_approach": pa.float64(),
}


def stream_overturns(
    bodies: Body | Sequence[Body],
    accelerations: ArrayLike | Sequence[ArrayLike],
    dt: float | Sequence[float],
    scales: ArrayLike,
    path: str | os.PathLike[str],
    *,
    columns: Literal["verdict", "peaks"] = "verdict",
    restitution: Sequence[Restitution] | None = None,
    g: float = STANDARD_GRAVITY,
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
    bodies, accelerations, dt, scales
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
    body_list, motions, dts = listed(bodies, accelerations, dt, restitution)
    factors = checked_scales(scales, len(motions))
    total = len(body_list) * factors.size
    schema = pa.schema(CASE | VERDICT | (PEAKS if columns == "peaks" else {}))
    done = 0
    with new_table(path, schema) as writer:
        for some, rows, cols in _groups(len(body_list), *factors.shape):
            result = overturns(
                body_list[some],
                motions[rows],
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
        "closest_approach": result.closest_approach,
    }
    arrays = [
        pa.array(np.broadcast_to(values[name], shape).ravel(), type=schema.field(name).type)
        for name in schema.names
    ]
    assert math.prod(shape) == len(arrays[0])
    return pa.Table.from_arrays(arrays, schema=schema)
