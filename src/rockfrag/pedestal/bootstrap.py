"""How often each level is the largest when motions or earthquakes are drawn again."""

import numpy as np
import numpy.typing as npt
import pandas as pd

from rockfrag.pedestal.cluster_means import Array

DRAWS = 9_999

DRAWN_AT_ONCE = 2_000_000
"""Numbers drawn at a time; the stream of random numbers does not depend on it."""


def rank_probabilities(
    table: pd.DataFrame, factor: str, cluster: str, seed: int, *, within: bool = False
) -> pd.DataFrame:
    """How often each level of a factor has the largest and the smallest mean of ``d`` in resampled data.

    All rows of a drawn ``cluster`` (earthquake or motion) come. ``within`` draws clusters separately inside each
    level (the motions of each earthquake); otherwise the same ones for all levels, which keeps what the levels
    share. Columns: level, mean, p_largest, p_smallest; ties share their draw.
    """
    rng = np.random.default_rng(seed)
    levels = sorted(table[factor].unique())
    if len(levels) == 1:
        drawn = np.zeros((1, 1))
    elif within:
        means = [rows.groupby(cluster)["d"].mean().to_numpy() for _, rows in table.groupby(factor)]
        drawn = np.column_stack([_resampled(of_level, rng) for of_level in means])
    else:
        cells = table.pivot_table(index=cluster, columns=factor, values="d", aggfunc="mean")
        grid = cells[levels].dropna().to_numpy()
        drawn = _resampled(grid, rng)
    return pd.DataFrame(
        {
            "level": levels,
            "mean": table.groupby(factor)["d"].mean()[levels].to_numpy(),
            "p_largest": _fraction_of(drawn == drawn.max(axis=1, keepdims=True)),
            "p_smallest": _fraction_of(drawn == drawn.min(axis=1, keepdims=True)),
        }
    )


def _resampled(means: Array, rng: np.random.Generator) -> Array:
    """Means of ``DRAWS`` samples of n out of n with replacement, some at a time so that memory stays small."""
    n = len(means)
    at_once = max(1, DRAWN_AT_ONCE // max(n, 1))
    sizes = (min(at_once, DRAWS - begin) for begin in range(0, DRAWS, at_once))
    return np.concatenate(
        [means[rng.integers(0, n, size=(size, n))].mean(axis=1) for size in sizes]
    )


def _fraction_of(extreme: npt.NDArray[np.bool_]) -> Array:
    return np.asarray((extreme / extreme.sum(axis=1, keepdims=True)).mean(axis=0), dtype=float)
