"""What a design could have seen, and the adjustment of many tests at once."""

import math
from collections.abc import Callable
from functools import lru_cache

import numpy as np
import numpy.typing as npt
from scipy import special

from rockfrag.pedestal.cluster_means import Array, Estimate

POWER = 0.80
LEVEL = 0.05


def detectable_ratio(effect: Estimate) -> float:
    """Smallest ratio above one that as many units, with their scatter, show with 80 % power [-].

    The test is t over the units, and a difference within the estimate's resolution is none; so what
    can be seen exceeds the resolution by what normal scatter takes away with this power. Infinite for
    one unit; NaN where neither scatter nor resolution are known.
    """
    if effect.units < 2:
        return math.inf
    if not effect.se > 0:
        return math.nan
    beyond = effect.resolution + float(special.ndtri(POWER)) * effect.se
    size = _detectable_size(effect.units)
    return math.exp(max(size * effect.sd, beyond if effect.resolution > 0 else 0.0))


@lru_cache
def _detectable_size(units: int) -> float:
    """Effect over the standard deviation of a unit that so many units show with 80 % power [-]."""
    from statsmodels.stats.power import TTestPower

    return float(
        TTestPower().solve_power(nobs=units, alpha=LEVEL / 2, power=POWER, alternative="larger")
    )


def holm(p: npt.ArrayLike) -> Array:
    """Adjust p values so that the chance of any false rejection is held (Holm 1979).

    NaN (a test that could not be made) stays NaN and does not count. Written out, because Holm's
    adjustment in statsmodels collects all garbage at each call: 0.1 to 1 s in a large process.
    """
    return _adjusted(p, _holm)


def _holm(p: Array) -> Array:
    order = np.argsort(p)
    adjusted = np.maximum.accumulate(p[order] * np.arange(p.size, 0, -1))
    result = np.empty_like(p)
    result[order] = np.minimum(adjusted, 1.0)
    return result


def benjamini_hochberg(p: npt.ArrayLike) -> Array:
    """Adjust p values so that the fraction of false rejections is held (Benjamini, Hochberg 1995).

    NaN stays NaN and does not count.
    """
    from statsmodels.stats.multitest import fdrcorrection

    return _adjusted(p, lambda known: fdrcorrection(known)[1])


def _adjusted(p: npt.ArrayLike, adjust: Callable[[Array], Array]) -> Array:
    given = np.asarray(p, dtype=float)
    known = ~np.isnan(given)
    if np.any((given[known] < 0) | (given[known] > 1)):
        raise ValueError("a p value lies outside 0 to 1")
    result = np.full(given.shape, np.nan)
    if known.any():
        result[known] = adjust(given[known])
    return result
