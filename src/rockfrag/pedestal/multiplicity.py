"""Many tests at once: Holm within a family, Benjamini-Hochberg across all."""

from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from rockfrag.pedestal.cluster_means import Array


def holm(p: npt.ArrayLike) -> Array:
    """Adjust p values so that the chance of any false rejection is held (Holm 1979).

    NaN (a test that could not be made) stays NaN and does not count.
    """

    def adjust(rising: Array) -> Array:
        return np.maximum.accumulate(rising * np.arange(rising.size, 0, -1))

    return _adjusted(p, adjust)


def benjamini_hochberg(p: npt.ArrayLike) -> Array:
    """Adjust p values so that the share of false rejections is held (Benjamini, Hochberg 1995).

    NaN stays NaN and does not count.
    """

    def adjust(rising: Array) -> Array:
        shares = np.arange(1, rising.size + 1) / rising.size
        return np.minimum.accumulate((rising / shares)[::-1])[::-1]

    return _adjusted(p, adjust)


def _adjusted(p: npt.ArrayLike, adjust: Callable[[Array], Array]) -> Array:
    given = np.asarray(p, dtype=float)
    known = np.flatnonzero(~np.isnan(given))
    if np.any((given[known] < 0) | (given[known] > 1)):
        raise ValueError("a p value lies outside 0 to 1")
    result = np.full(given.shape, np.nan)
    order = known[np.argsort(given[known])]
    result[order] = np.minimum(adjust(given[order]), 1.0)
    return result
