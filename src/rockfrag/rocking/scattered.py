"""Verdicts of cases that do not fill a grid of bodies × motions × scales."""

import os
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rockfrag.errors import InputError
from rockfrag.rocking.bodies import Block, Body, Stack
from rockfrag.rocking.ensemble import overturns
from rockfrag.rocking.inputs import STEP, checked_acceleration
from rockfrag.rocking.parameters import Restitution
from rockfrag.units import STANDARD_GRAVITY

Array = NDArray[np.float64]
Index = NDArray[np.int64]


def scattered_overturns(
    bodies: Sequence[Body],
    accelerations: Sequence[ArrayLike],
    dts: Array,
    body: Index,
    motion: Index,
    scale: Array,
    *,
    restitution: Sequence[Restitution] | None = None,
    g: float = STANDARD_GRAVITY,
    step: float = STEP,
    threads: int | None = None,
) -> NDArray[np.bool_]:
    """Say for case i, body ``body[i]`` under ``scale[i]`` × motion ``motion[i]``, whether it overturns.

    Each body with all its cases is one call of :func:`overturns`, and bodies share the threads.

    Parameters
    ----------
    dts
        Sampling interval of each motion [s], shape (motions,).
    body, motion, scale
        The cases, each of shape (cases,).

    Returns
    -------
    Array of shape (cases,).
    """
    verdicts = np.zeros(len(body), dtype=bool)

    def run(number: int) -> None:
        mine = np.flatnonzero(body == number)
        used, row = np.unique(motion[mine], return_inverse=True)
        # the cases of a motion side by side; what is left over is a scale of zero, which costs nothing
        order = np.argsort(row, kind="stable")
        counts = np.bincount(row, minlength=used.size)
        column = np.empty(mine.size, dtype=np.int64)
        column[order] = np.arange(mine.size) - np.repeat(np.cumsum(counts) - counts, counts)
        scales = np.zeros((used.size, int(counts.max())))
        scales[row, column] = scale[mine]
        result = overturns(
            [bodies[number]],
            [accelerations[m] for m in used],
            dts[used].tolist(),
            scales,
            restitution=None if restitution is None else [restitution[number]],
            g=g,
            step=step,
            threads=1,
        )
        verdicts[mine] = result.overturned[0, row, column]

    with ThreadPoolExecutor(threads or os.cpu_count() or 1) as pool:
        list(pool.map(run, np.unique(body).tolist()))
    return verdicts


def listed(
    bodies: Body | Sequence[Body],
    accelerations: ArrayLike | Sequence[ArrayLike],
    dt: float | Sequence[float],
    restitution: Sequence[Restitution] | None,
) -> tuple[list[Body], list[Array], Array]:
    """Return bodies, checked motions [m/s²] and the sampling interval of each motion [s].

    Raises
    ------
    InputError
        If a motion cannot be used, or the lengths of the lists do not fit together.
    """
    body_list = [bodies] if isinstance(bodies, (Block, Stack)) else list(bodies)
    one = isinstance(accelerations, np.ndarray) and accelerations.ndim == 1
    motions: list[ArrayLike] = [accelerations] if one else list(accelerations)  # type: ignore[arg-type, list-item]
    intervals = np.asarray(dt, dtype=float)
    if intervals.ndim and intervals.shape != (len(motions),):
        raise InputError(f"dt: expected one number or {len(motions)}, got {intervals.size}.")
    if restitution is not None and len(restitution) != len(body_list):
        raise InputError(
            f"restitution: expected {len(body_list)} entries, one per body, got {len(restitution)}."
        )
    dts = np.broadcast_to(intervals, (len(motions),)).copy()
    values = [
        checked_acceleration(motion, float(interval), f"accelerations[{i}]")
        for i, (motion, interval) in enumerate(zip(motions, dts, strict=True))
    ]
    return body_list, values, dts
