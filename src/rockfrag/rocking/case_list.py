"""Verdicts of cases that do not fill a grid of bodies × motions × scales."""

import warnings
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor

import numpy as np
from numpy.typing import NDArray

from rockfrag.rocking.ensemble import overturns
from rockfrag.rocking.inputs import STEP, UnitDoubt, checked_threads
from rockfrag.rocking.measured_restitution import Restitution
from rockfrag.system.blocks import Body
from rockfrag.units import GRAVITY

Array = NDArray[np.float64]
Index = NDArray[np.int64]


def overturns_of_cases(
    bodies: Sequence[Body],
    motions: Sequence[Array],
    dts: Array,
    body: Index,
    motion: Index,
    scale: Array,
    *,
    restitution: Sequence[Restitution] | None = None,
    g: float = GRAVITY,
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
            [motions[m] for m in used],
            dts[used].tolist(),
            scales,
            restitution=None if restitution is None else [restitution[number]],
            g=g,
            step=step,
            threads=1,
        )
        verdicts[mine] = result.overturned[0, row, column]

    with warnings.catch_warnings(), ThreadPoolExecutor(checked_threads(threads)) as pool:
        # what single cases look like says nothing about the unit of the whole
        warnings.simplefilter("ignore", UnitDoubt)
        list(pool.map(run, np.unique(body).tolist()))
    return verdicts
