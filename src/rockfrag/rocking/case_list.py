"""Outcomes of cases that do not fill a grid of systems × motions × scales."""

from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from rockfrag.engines.contract import Cases, run_cases

Index = NDArray[np.int64]


def overturned_cases(
    cases: Cases, system: Index, motion: Index, scale: NDArray[np.float64]
) -> NDArray[np.bool_]:
    """Say for case i, system ``system[i]`` under ``scale[i]`` × motion ``motion[i]``, whether it overturns.

    Each system with all its cases is one grid, and systems share the threads.
    """
    overturned = np.zeros(len(system), dtype=bool)

    def run(number: int) -> None:
        mine = np.flatnonzero(system == number)
        used, row = np.unique(motion[mine], return_inverse=True)
        # the cases of a motion side by side; what is left over is a scale of zero, which costs nothing
        order = np.argsort(row, kind="stable")
        counts = np.bincount(row, minlength=used.size)
        column = np.empty(mine.size, dtype=np.int64)
        column[order] = np.arange(mine.size) - np.repeat(np.cumsum(counts) - counts, counts)
        scales = np.zeros((used.size, int(counts.max())))
        scales[row, column] = scale[mine]
        some = replace(
            cases,
            systems=(cases.systems[number],),
            motions=tuple(cases.motions[m] for m in used),
            scales=scales,
            threads=1,
        )
        overturned[mine] = run_cases(some).overturned[0, row, column]

    with ThreadPoolExecutor(cases.threads) as pool:
        list(pool.map(run, np.unique(system).tolist()))
    return overturned
