"""Many tests at once: Holm within a family, Benjamini-Hochberg across all."""

import numpy as np
import numpy.typing as npt

from rockfrag.pedestal.cluster_means import Array


def holm(p: npt.ArrayLike) -> Array:
    """Adjust p values so that the chance of any false rejection is held (Holm 1979).

    NaN (a test that could not be made) stays NaN and does not count.
    """
    return _adjusted(p, "holm")


def benjamini_hochberg(p: npt.ArrayLike) -> Array:
    """Adjust p values so that the fraction of false rejections is held (Benjamini, Hochberg 1995).

    NaN stays NaN and does not count.
    """
    return _adjusted(p, "fdr_bh")


def _adjusted(p: npt.ArrayLike, method: str) -> Array:
    from statsmodels.stats.multitest import multipletests

    given = np.asarray(p, dtype=float)
    known = ~np.isnan(given)
    if np.any((given[known] < 0) | (given[known] > 1)):
        raise ValueError("a p value lies outside 0 to 1")
    result = np.full(given.shape, np.nan)
    if known.any():
        result[known] = multipletests(given[known], method=method)[1]
    return result
