"""Many tests at once: Holm within a family, Benjamini-Hochberg across all."""

import numpy as np
import numpy.typing as npt

from rockfrag.pedestal.cluster_means import Array


def holm(p: npt.ArrayLike) -> Array:
    """Adjust p values so that the chance of any false rejection is held (Holm 1979).

    NaN (a test that could not be made) stays NaN and does not count.
    """
    given, order = _ordered(p)
    n = len(order)
    stepped = np.maximum.accumulate(given[order] * (n - np.arange(n)))
    return _placed(given, order, stepped)


def benjamini_hochberg(p: npt.ArrayLike) -> Array:
    """Adjust p values so that the share of false rejections is held (Benjamini, Hochberg 1995).

    NaN stays NaN and does not count.
    """
    given, order = _ordered(p)
    n = len(order)
    scaled = given[order] * n / (np.arange(n) + 1)
    return _placed(given, order, np.minimum.accumulate(scaled[::-1])[::-1])


def _ordered(p: npt.ArrayLike) -> tuple[Array, npt.NDArray[np.intp]]:
    """Return the p values and the places of the known ones from smallest to largest."""
    given = np.asarray(p, dtype=float)
    known = np.flatnonzero(~np.isnan(given))
    if np.any((given[known] < 0) | (given[known] > 1)):
        raise ValueError("a p value lies outside 0 to 1")
    return given, known[np.argsort(given[known], kind="stable")]


def _placed(given: Array, order: npt.NDArray[np.intp], adjusted: Array) -> Array:
    result = np.full(given.shape, np.nan)
    result[order] = np.minimum(1.0, adjusted)
    return result
