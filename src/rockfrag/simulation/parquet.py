"""Ensembles larger than memory: outcomes, peaks or whole histories straight into a Parquet file.

In: as for :func:`rockfrag.simulation.overturns`. Out: a file whose bytes do not depend on threads. Docs:
``docs/reliability.md``.
"""

from __future__ import annotations

import itertools
import math
import os
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from functools import partial
from typing import Unpack

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
from numpy.typing import ArrayLike

from rockfrag.base.errors import InputError
from rockfrag.base.files import whole_file
from rockfrag.base.keywords import named_keywords
from rockfrag.engines.built_in import SPATIAL
from rockfrag.engines.contract import Case, Cases, Engine
from rockfrag.engines.steps import step_count
from rockfrag.outcomes.outcomes import Table
from rockfrag.outcomes.outcomes import columns as columns_of
from rockfrag.outcomes.response import SPATIAL_COLUMNS
from rockfrag.simulation.ensemble import Options, prepared, shaken
from rockfrag.simulation.inputs import MotionLike, SystemsInput

ROWS = 262_144  # most cases that are in memory at a time, and most rows of a row group
PLACE = {"system": pa.int32(), "motion": pa.int32(), "scale": pa.float64()}
WITHIN: dict[Table, dict[str, pa.DataType]] = {
    "cases": {},
    "bodies": {"body": pa.int32(), "name": pa.string()},
    "contacts": {"contact": pa.int32(), "name": pa.string()},
    "constraints": {"constraint": pa.int32(), "name": pa.string()},
}
USUAL = ("overturned", "overturned_body")


@named_keywords
def stream_overturns(
    bodies: SystemsInput,
    motions: MotionLike | Sequence[MotionLike],
    dt: float | Sequence[float] | None,
    scales: ArrayLike,
    path: str | os.PathLike[str],
    *,
    table: Table = "cases",
    columns: Sequence[str] | None = None,
    forces: bool = False,
    progress: Callable[[int, int], None] | None = None,
    **options: Unpack[Options],
) -> int:
    """Write the outcome of every body × motion × scale to a Parquet file, in memory that stays flat.

    The file is one of the four tables of :class:`rockfrag.outcomes.Outcomes`, as its ``table`` gives it, the
    scale running fastest, then bodies or contacts from below.  It appears whole or not at all, and its bytes do
    not depend on the number of threads.

    Parameters
    ----------
    bodies, motions, dt, scales : as in :func:`overturns`
    path, table : the file to write, of "cases", "bodies", "contacts" or "constraints"
    columns
        Columns beside those that say which case it is, named as the attributes of the outcomes; None takes
        ``overturned`` and ``overturned_body`` of cases, and all of bodies and contacts.
    forces, progress, **options
        As in :func:`overturns`; progress is called with the number of cases done and of all cases after every row
        group.

    Returns
    -------
    Number of cases.
    """
    known = {column.name: column for column in columns_of(table) if table in WITHIN}
    if columns is None:
        columns = USUAL if table == "cases" else tuple(known)
    for name in columns:
        if name not in known:
            raise InputError(
                f"columns: {name!r} is no column of {table!r}; choose among {', '.join(known)}."
            )
    cases = prepared(bodies, motions, dt, scales, forces=forces, **options)
    types = {
        column.title: pa.string()
        if column.dtype == object
        else pa.from_numpy_dtype(column.dtype)
        for name, column in known.items()
        if name in columns
    }
    schema = pa.schema(PLACE | WITHIN[table] | types)
    total = len(cases.systems) * cases.scales.size
    done = 0
    with (
        whole_file(path) as file,
        pq.ParquetWriter(file, schema, compression="zstd") as writer,
    ):
        parts = 1 if table == "cases" else max(system.count for system in cases.systems)
        for some, rows, cols in _groups(max(1, ROWS // parts), cases.shape):
            part = replace(
                cases,
                systems=cases.systems[some],
                motions=cases.motions[rows],
                scales=np.ascontiguousarray(cases.scales[rows, cols]),
            )
            found = shaken(part).table(table, columns)
            found["system"] += some.start
            found["motion"] += rows.start
            writer.write_table(pa.Table.from_pydict(dict(found), schema=schema))
            done += math.prod(part.shape)
            if progress is not None:
                progress(done, total)
    return total


def _groups(most: int, shape: tuple[int, int, int]) -> Iterator[tuple[slice, ...]]:
    """Cut cases of a shape (systems, motions, scales) into boxes of at most ``most`` cases, in their order.

    A box has all scales of a motion if these fit, then as many motions, then as many systems as fit.
    """
    _, n_motions, n_scales = shape
    sizes = (
        max(1, most // max(1, n_motions * n_scales)),
        max(1, min(n_motions, most // max(1, n_scales))),
        max(1, min(n_scales, most)),
    )
    sides = [
        [slice(i, i + size) for i in range(0, count, size)]
        for count, size in zip(shape, sizes, strict=True)
    ]
    return itertools.product(*sides)


# --------------------------------------------------------------------------- histories

AHEAD = 16  # histories that are in memory at a time

SAMPLE = PLACE | {"time_s": pa.float64(), "body": pa.int32()}
IN_PLANE = {"theta_rad": pa.float64(), "omega_rad_s": pa.float64(), "state": pa.int8()}
"""What a sample of a planar body tells."""


@named_keywords
def stream_histories(
    bodies: SystemsInput,
    motions: MotionLike | Sequence[MotionLike],
    dt: float | Sequence[float] | None,
    scales: ArrayLike,
    path: str | os.PathLike[str],
    *,
    progress: Callable[[int, int], None] | None = None,
    **options: Unpack[Options],
) -> int:
    """Write the history of every body × motion × scale to a Parquet file, in memory that stays flat.

    One row per case, sample and body, the bodies running fastest (from below, from 1), then the samples, then the
    scale: ``system``, ``motion`` (positions in the lists given), ``scale``, ``time_s``, ``body``; of planar bodies
    rotation ``theta_rad``, angular velocity ``omega_rad_s`` and contact ``state`` as in :class:`Response`; of
    bodies in space the columns of :class:`rockfrag.engines.spatial.SpatialResponse`.  Where a file holds both, a
    row tells nothing in the columns of the other kind.  At the default step the numbers are, bit for bit, those
    that :func:`simulate` gives for the scaled motion.  The file appears whole or not at all, and its bytes do not
    depend on the number of threads.

    Parameters
    ----------
    bodies, motions, dt, scales, path, progress, **options : as in :func:`stream_overturns`, but for ``forces``

    Returns
    -------
    Number of cases.
    """
    cases = prepared(bodies, motions, dt, scales, **options)
    request = replace(cases.request, history=True)
    cases = replace(cases, request=request)
    answering: list[Engine] = []
    if cases.motions:
        # refused here and not in the middle of the file: the longest interval needs most steps
        answering = cases.answering
        for system in cases.systems:
            step_count(
                system, [motion.dt for motion in cases.motions], request.g, request.step
            )
    total = len(cases.systems) * cases.scales.size
    places = iter(np.ndindex(*cases.shape))
    schema = _history_schema(answering)
    with (
        whole_file(path) as file,
        pq.ParquetWriter(file, schema, compression="zstd") as writer,
        ThreadPoolExecutor(cases.threads) as pool,
    ):
        written = 0
        while batch := list(itertools.islice(places, AHEAD)):
            tables = pool.map(partial(_history_table, cases, schema), batch)
            writer.write_table(pa.concat_tables(tables), row_group_size=ROWS)
            written += len(batch)
            if progress is not None:
                progress(written, total)
    return total


def _history_schema(answering: Sequence[Engine]) -> pa.Schema:
    """Columns of histories that these engines tell."""
    in_space = {engine is SPATIAL for engine in answering}
    fields = IN_PLANE if in_space != {True} else {}
    if True in in_space:
        fields = fields | dict.fromkeys(SPATIAL_COLUMNS, pa.float64())
    return pa.schema(SAMPLE | fields)


def _history_table(cases: Cases, schema: pa.Schema, place: tuple[int, ...]) -> pa.Table:
    """Make the rows of one history, a sample each.

    Parameters
    ----------
    cases : of the ensemble
    schema : columns of the table; of those that the history's engine does not give all rows are null
    place : numbers of its system, its motion and its scale
    """
    b, m, s = place
    case = Case(
        cases.systems[b], cases.motions[m], float(cases.scales[m, s]), cases.request
    )
    samples = cases.answering[b].history(case).samples()
    count = len(samples["time_s"])
    places = {"system": b, "motion": m, "scale": case.scale}
    values = {name: np.full(count, value) for name, value in places.items()} | samples
    nothing = pa.nulls(count)
    return pa.Table.from_arrays(
        [
            pa.array(values[each.name], each.type)
            if each.name in values
            else nothing.cast(each.type)
            for each in schema
        ],
        schema=schema,
    )
