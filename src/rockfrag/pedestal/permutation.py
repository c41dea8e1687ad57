"""Exact tests that need no normal distribution: signed ranks, sign flips, leave one event out."""

import math
from dataclasses import dataclass
from functools import lru_cache
from itertools import product

import numpy as np
import numpy.typing as npt
import pandas as pd
from scipy import stats

from rockfrag.pedestal.cluster_means import Array, mean_effect, without_each_event

DRAWS = 9_999
"""Up to so many sign patterns (13 units) all are enumerated; of more, so many are drawn."""


MOST_EXACT = 500
"""Units beyond which signed ranks and flipped signs have the normal distribution."""

WITHOUT_COLUMNS = ["without", "ratio", "lower", "upper", "p", "largest_change"]
"""Columns of `leave_one_event_out`."""


@dataclass(frozen=True)
class SignedRanks:
    """Wilcoxon's signed-rank test with the Hodges-Lehmann estimate.

    Parameters
    ----------
    p
        Exact two-sided p value [-].
    smallest_p
        The smallest p value that so many units can give [-].
    estimate
        Hodges-Lehmann estimate, median of the means of all pairs of values [-].
    lower, upper
        Limits from the inverted test [-]; infinite where so few units cannot give the level.
    units
        Number of values.
    """

    p: float
    smallest_p: float
    estimate: float
    lower: float
    upper: float
    units: int


def _signed_rank_counts(ranks: npt.NDArray[np.int64]) -> Array:
    """Probability of each value of the sum of doubled ranks of positive sign, by convolution."""
    total = int(ranks.sum())
    distribution = np.zeros(total + 1)
    distribution[0] = 1.0
    for rank in ranks:
        shifted = np.zeros_like(distribution)
        shifted[rank:] = distribution[: total + 1 - rank]
        distribution = 0.5 * (distribution + shifted)
    return distribution


def wilcoxon_exact(values: npt.ArrayLike, confidence: float = 0.95) -> SignedRanks:
    """Exact signed-rank test of a centre at zero (Wilcoxon 1945; Hodges and Lehmann 1963).

    Zeros are dropped and ties get their mean rank; the distribution is that of the ranks at hand,
    so the p value is exact with ties too.

    Parameters
    ----------
    values
        One value per independent unit, here the mean of d of each motion, shape (n,).
    """
    x = np.asarray(values, dtype=float)
    if x.size > MOST_EXACT:
        return _wilcoxon_of_many(x, confidence)
    nonzero = x[x != 0]
    i, j = np.triu_indices(x.size)
    walsh = np.sort((x[i] + x[j]) / 2)
    estimate = float(np.median(walsh))
    if nonzero.size == 0:
        return SignedRanks(1.0, 1.0, estimate, estimate, estimate, x.size)
    doubled = np.rint(2 * stats.rankdata(np.abs(nonzero))).astype(np.int64)
    distribution = _signed_rank_counts(doubled)
    observed = int(doubled[nonzero > 0].sum())
    cumulative = np.cumsum(distribution)
    below = float(cumulative[observed])
    above = float(distribution[observed:].sum())
    # the limits invert the test without ties: W counts the Walsh averages above the centre
    plain = np.cumsum(_signed_rank_counts(2 * np.arange(1, x.size + 1, dtype=np.int64)))[::2]
    inside = np.flatnonzero(plain <= (1 - confidence) / 2)
    lower, upper = -math.inf, math.inf
    if inside.size:
        k = int(inside[-1])
        lower, upper = float(walsh[k]), float(walsh[walsh.size - 1 - k])
    return SignedRanks(
        p=min(1.0, 2 * min(below, above)),
        smallest_p=2.0 ** (1 - nonzero.size),
        estimate=estimate,
        lower=lower,
        upper=upper,
        units=x.size,
    )


def _wilcoxon_of_many(x: Array, confidence: float) -> SignedRanks:
    """Return the same by the normal distribution of the sum of ranks, in memory that grows as the values do."""
    nonzero = x[x != 0]
    n = x.size
    ranks = stats.rankdata(np.abs(nonzero))
    observed, middle = float(ranks[nonzero > 0].sum()), float(ranks.sum() / 2)
    spread = math.sqrt(float((ranks**2).sum()) / 4)
    p = 1.0
    if spread > 0:
        p = min(1.0, 2 * float(stats.norm.sf((abs(observed - middle) - 0.5) / spread)))
    pairs = n * (n + 1) // 2
    away = float(stats.norm.ppf(0.5 + confidence / 2)) * math.sqrt(pairs * (2 * n + 1) / 12)
    k = max(0, math.floor(pairs / 2 - away))
    ordered = np.sort(x)
    half = [_walsh_average(ordered, one) for one in ((pairs - 1) // 2, pairs // 2)]
    return SignedRanks(
        p=p,
        smallest_p=2.0 ** (1 - nonzero.size),
        estimate=sum(half) / 2,
        lower=_walsh_average(ordered, k),
        upper=_walsh_average(ordered, pairs - 1 - k),
        units=n,
    )


def _walsh_average(ordered: Array, rank: int) -> float:
    """Mean of that pair of rising values (each with itself too) which has so many pairs below it."""
    low, high = float(ordered[0]), float(ordered[-1])
    place = np.arange(ordered.size)
    for _ in range(60):
        middle = (low + high) / 2
        upto = np.searchsorted(ordered, 2 * middle - ordered, side="right")
        # each pair once: a partner no earlier than the value itself
        if int(np.maximum(upto - place, 0).sum()) > rank:
            high = middle
        else:
            low = middle
    return high


@dataclass(frozen=True)
class SignFlips:
    """Permutation test by flipping the signs of whole units.

    Parameters
    ----------
    p
        Two-sided p value [-].
    smallest_p
        The smallest p value that so many units can give, 2^(1-k) [-].
    units
        Number of units, k.
    exact
        Whether all 2^k patterns were enumerated; otherwise they were drawn from the seed, or are so many
        that their mean is normal.
    """

    p: float
    smallest_p: float
    units: int
    exact: bool


def sign_flip_test(values: npt.ArrayLike, seed: int = 0) -> SignFlips:
    """Test a mean of zero by flipping the signs of units (Fisher 1935).

    Valid when each unit's distribution is symmetric about zero under the hypothesis.

    Parameters
    ----------
    values
        One value per unit, here the mean of d of each event, shape (k,).
    seed
        Of the patterns drawn when there are more than `DRAWS` of them.
    """
    x = np.asarray(values, dtype=float)
    k = x.size
    if k == 1 or not x.any():
        return SignFlips(p=1.0, smallest_p=2.0 ** (1 - k), units=k, exact=True)
    smallest = 2.0 ** (1 - k)
    if k > MOST_EXACT:
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


def leave_one_event_out(table: pd.DataFrame) -> pd.DataFrame:
    """Effect without each event in turn.

    Returns
    -------
    pandas.DataFrame
        without, ratio, lower, upper [-], p, largest_change (True for the event that moves the
        estimate most).
    """
    everything = mean_effect(table)
    rows: list[dict[str, object]] = []
    shifts: list[float] = []
    for event, one in without_each_event(table).items():
        shifts.append(abs(one.mean - everything.mean))
        rows.append(
            {
                "without": event,
                "ratio": one.ratio,
                "lower": one.ratio_lower,
                "upper": one.ratio_upper,
                "p": one.p,
            }
        )
    result = pd.DataFrame(rows, columns=WITHOUT_COLUMNS[:-1])
    result["largest_change"] = [shift == max(shifts) for shift in shifts]
    return result
