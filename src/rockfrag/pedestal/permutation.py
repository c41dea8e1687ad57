"""The exact test that needs no normal distribution, sign flips; and the effect without each earthquake."""

import math
from dataclasses import dataclass
from functools import lru_cache
from itertools import product

import numpy as np
import numpy.typing as npt
import pandas as pd
from scipy import stats

from rockfrag.pedestal.cluster_means import Array, mean_effect

DRAWS = 9_999
"""Up to so many sign patterns (13 units) all are enumerated; of more, so many are drawn."""


MOST_DRAWN = 500  # units beyond which the mean under flipped signs has the normal distribution
MOST_LEFT_OUT = 100  # earthquakes up to which each is left out in turn; of more, none says much
WITHOUT_COLUMNS = ["without", "ratio", "lower", "upper", "p", "largest_change"]
"""Columns of `leave_one_earthquake_out`."""


@dataclass(frozen=True)
class SignFlips:
    """Permutation test by flipping the signs of whole units."""

    p: float  # two-sided p value [-]
    smallest_p: float  # the smallest p value that so many units can give, 2^(1-k) [-]
    units: int  # number of units, k
    # whether all 2^k patterns were enumerated; otherwise they were drawn from the seed, or are so
    # many that their mean is normal
    exact: bool


def sign_flip_test(values: npt.ArrayLike, seed: int = 0) -> SignFlips:
    """Test a mean of zero by flipping the signs of k units, here the means of d of earthquakes (Fisher 1935).

    Valid when each unit's distribution is symmetric about zero under the hypothesis. ``seed`` is of the patterns
    drawn when there are more than `DRAWS` of them.
    """
    x = np.asarray(values, dtype=float)
    k = x.size
    if k == 1 or not x.any():
        return SignFlips(p=1.0, smallest_p=2.0 ** (1 - k), units=k, exact=True)
    smallest = 2.0 ** (1 - k)
    if k > MOST_DRAWN:
        p = 2 * float(stats.norm.sf(abs(x.sum()) / math.sqrt(float((x**2).sum()))))
        return SignFlips(p=p, smallest_p=smallest, units=k, exact=False)
    # sums that agree to rounding are equal, so the values are taken on a grid of integers
    grid = np.rint(x / np.abs(x).max() * 1e12)
    if 2**k <= DRAWS:
        sums = np.abs(_sign_patterns(k) @ grid)
        return SignFlips(float((sums >= abs(grid.sum())).mean()), smallest, k, exact=True)
    found = stats.permutation_test(
        (grid,),
        lambda flipped, axis: np.abs(flipped.sum(axis=axis)),
        permutation_type="samples",
        vectorized=True,
        n_resamples=DRAWS,
        alternative="greater",
        rng=np.random.default_rng(seed),
    )
    return SignFlips(p=float(found.pvalue), smallest_p=smallest, units=k, exact=False)


@lru_cache
def _sign_patterns(units: int) -> Array:
    """All patterns of signs, shape (2^units, units)."""
    return np.array(list(product((1.0, -1.0), repeat=units)))


def leave_one_earthquake_out(table: pd.DataFrame) -> pd.DataFrame:
    """Effect without each earthquake in turn; no row for a single one and for more than `MOST_LEFT_OUT`.

    The columns are without, ratio, lower, upper [-], p, largest_change (True for the earthquake that moves the
    estimate most).
    """
    earthquakes = sorted(table["earthquake"].unique())
    if not 1 < len(earthquakes) <= MOST_LEFT_OUT:
        return pd.DataFrame(columns=WITHOUT_COLUMNS)
    rest = {name: mean_effect(table[table["earthquake"] != name]) for name in earthquakes}
    result = pd.DataFrame(
        [
            {
                "without": earthquake,
                "ratio": effect.ratio,
                "lower": effect.ratio_lower,
                "upper": effect.ratio_upper,
                "p": effect.p,
            }
            for earthquake, effect in rest.items()
        ]
    )
    everything = mean_effect(table).mean
    shift = np.array([abs(effect.mean - everything) for effect in rest.values()])
    return result.assign(largest_change=shift == shift.max())
