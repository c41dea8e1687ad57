"""Ensembles of full histories: every sample of every case straight into a Parquet file."""

import itertools
import os
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor

import numpy as np
import pyarrow as pa
from numpy.typing import ArrayLike, NDArray

from rockfrag.rocking import _tally as tally
from rockfrag.rocking._march import march
from rockfrag.rocking.bodies import Body
from rockfrag.rocking.body_record import Restitution, body_parameters
from rockfrag.rocking.inputs import (
    CLOSING_SPEED,
    STEP,
    checked_scales,
    free_samples,
    listed,
    step_count,
)
from rockfrag.rocking.kernels.jit import compiling_alone
from rockfrag.rocking.parquet import CASE, ROWS, new_table
from rockfrag.units import STANDARD_GRAVITY

Case = tuple[int, int, int]
"""Positions of body, motion and scale."""

AHEAD = 2
"""Histories that are marched or wait to be written at a time, for each thread."""

COLUMNS = {
    "theta_pedestal_rad": 0,
    "omega_pedestal_rad_s": 1,
    "theta_statue_rad": 2,
    "omega_statue_rad_s": 3,
    "state_pedestal": 4,
    "state_statue": 5,
}
"""Columns of the file, and where the march keeps them in its history."""

SCHEMA = pa.schema(
    CASE
    | {"time_s": pa.float64()}
    | {name: pa.int8() if name.startswith("state") else pa.float64() for name in COLUMNS}
)


def stream_histories(
    bodies: Body | Sequence[Body],
    accelerations: ArrayLike | Sequence[ArrayLike],
    dt: float | Sequence[float],
    scales: ArrayLike,
    path: str | os.PathLike[str],
    *,
    restitution: Sequence[Restitution] | None = None,
    g: float = STANDARD_GRAVITY,
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
    bodies, accelerations, dt, scales
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
    body_list, motions, dts = listed(bodies, accelerations, dt, restitution)
    factors = checked_scales(scales, len(motions))
    per_body = restitution if restitution is not None else [None] * len(body_list)
    parameters = [body_parameters(b, e, g=g) for b, e in zip(body_list, per_body, strict=True)]
    for body in body_list:
        # refused here and not in the middle of the file: the longest interval needs most steps
        step_count(body, dts, g, step)
    total = len(body_list) * factors.size

    def history(case: Case) -> pa.Table:
        b, m, s = case
        body, values = body_list[b], motions[m]
        interval, scale = float(dts[m]), float(factors[m, s])
        free = int(free_samples(body, interval, g))
        rows = np.empty((values.size + free, tally.HISTORY))
        # the march of simulate() without its tables of events and energy, which take most of its time
        with compiling_alone(march):
            done = march(
                parameters[b], values, interval, scale, int(step_count(body, interval, g, step)), free,
                np.zeros(4), CLOSING_SPEED, rows, np.empty((0, tally.EVENT)), tally.scratch(),
                np.empty(tally.SUMMARY),
            )  # fmt: skip
        return _table(case, scale, interval, rows[:done])

    n_motions, n_scales = factors.shape
    cases = itertools.product(range(len(body_list)), range(n_motions), range(n_scales))
    workers = threads or os.cpu_count() or 1
    with new_table(path, SCHEMA) as writer, ThreadPoolExecutor(workers) as pool:
        written = 0
        for group in _groups(_in_order(pool, history, cases, AHEAD * workers)):
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


def _groups(tables: Iterable[pa.Table]) -> Iterator[list[pa.Table]]:
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


def _table(case: Case, scale: float, dt: float, rows: NDArray[np.float64]) -> pa.Table:
    body, motion, _ = case
    values = {
        "body": np.full(len(rows), body),
        "motion": np.full(len(rows), motion),
        "scale": np.full(len(rows), scale),
        "time_s": np.arange(len(rows)) * dt,
    } | {name: rows[:, column] for name, column in COLUMNS.items()}
    arrays = [pa.array(values[field.name].astype(field.type.to_pandas_dtype())) for field in SCHEMA]
    return pa.Table.from_arrays(arrays, schema=SCHEMA)
