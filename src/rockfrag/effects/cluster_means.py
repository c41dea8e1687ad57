"""Tests on the means of the units that were sampled: Student's t, which keeps its level, and sign flips, exact.

In: pairs with d = ln a_P - ln a_NP [-] and its resolution. Out: :class:`Estimate`, the mean with interval and p
value. Theory: ``docs/pedestal.md``, "Which test, and about what"; ``docs/validation-pedestal.md``.

Pairs of one motion and earthquake are dependent, so the mean of d over one earthquake is one observation. Where
pairs agree to the step of the series of levels a shift may hide in all of them: the resolution of a mean is that
of the pairs that have the most frequent value, times their fraction.
"""

import math
from collections.abc import Hashable
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
import pandas as pd
from scipy import special, stats

Array = npt.NDArray[np.float64]

CONFIDENCE = 0.95
# largest change of the overturning amplitude that counts as none, ±10 % [-]
MARGIN = 0.10
ROUNDING = 1e-12  # differences of logarithms below this are rounding, not scatter [-]
POWER, LEVEL = 0.80, 0.05
DRAWS = 9_999
"""Up to so many sign patterns (13 units) all are enumerated; of more, so many are drawn."""
# units beyond which the mean under flipped signs has the normal distribution
MOST_DRAWN = 500
# earthquakes up to which each is left out in turn; of more, none says much
MOST_LEFT_OUT = 100
WITHOUT_COLUMNS = ["without", "ratio", "lower", "upper", "p", "largest_change"]
"""Columns of `leave_one_earthquake_out`."""


class TooFewUnitsError(ValueError):
    """There is nothing to estimate from: no unit, or a figure that its data do not define."""


@dataclass(frozen=True)
class Estimate:
    """A mean over sampled units with its t interval, in logarithms of ratios [-].

    Of one unit ``se``, the limits and ``p`` are NaN.
    """

    mean: float
    se: float
    units: int
    lower: float
    upper: float
    p: float  # two-sided p value of a mean of zero; 1 within the resolution
    # half-width below which the data cannot tell the mean from another value
    resolution: float = 0.0

    @property
    def ratio(self) -> float:
        """exp(mean) [-]."""
        return math.exp(self.mean)

    @property
    def ratio_lower(self) -> float:
        """exp(lower) [-]."""
        return math.exp(self.lower)

    @property
    def ratio_upper(self) -> float:
        """exp(upper) [-]."""
        return math.exp(self.upper)

    @property
    def sd(self) -> float:
        """Standard deviation between units [-]."""
        return self.se * math.sqrt(self.units)

    def times(self, factor: float) -> "Estimate":
        """Estimate of ``factor`` times the mean."""
        lower, upper = sorted((self.lower * factor, self.upper * factor))
        resolution = self.resolution * abs(factor)
        return Estimate(
            self.mean * factor,
            self.se * abs(factor),
            self.units,
            lower,
            upper,
            self.p,
            resolution,
        )

    def p_above(self, bound: float) -> float:
        """One-sided p value of the hypothesis that the mean is at most ``bound``."""
        if not self.se > 0:
            return math.nan
        if self.mean - bound <= self.resolution:
            return 1.0
        return float(special.stdtr(self.units - 1, -(self.mean - bound) / self.se))

    def p_below(self, bound: float) -> float:
        """One-sided p value of the hypothesis that the mean is at least ``bound``."""
        return self.times(-1.0).p_above(-bound)

    def text(self) -> str:
        """Ratio and interval in words for a table."""
        if self.units == 1:
            return f"{self.ratio:.3f} (one unit, no interval)"
        if not self.se > 0:
            return f"{self.ratio:.3f} (all units agree and their steps are not known, no interval)"
        return f"{self.ratio:.3f} [{self.ratio_lower:.3f}, {self.ratio_upper:.3f}]"


def t_estimate(
    values: npt.ArrayLike, confidence: float = CONFIDENCE, resolution: float = 0.0
) -> Estimate:
    """Mean of independent units, shape (k,), with its t interval and test.

    The half-width is that of t, and at least the resolution (see `tied_resolution`); the standard error is at
    least that of the mean of k values uniform within ± the resolution, resolution/√(3 k). Units that all
    agree, with no resolution known, have neither interval nor p value (NaN).

    Parameters
    ----------
    values, confidence : of k units [-], shape (k,), and level of the interval [-]
    resolution : half-width to which the mean is known [-]

    Returns
    -------
    The :class:`Estimate`.
    """
    x = np.asarray(values, dtype=float)
    if x.size == 0 or not np.all(np.isfinite(x)):
        raise TooFewUnitsError("a mean needs at least one unit and finite values")
    mean, scatter = float(x.mean()), 0.0
    if x.size == 1:
        return Estimate(mean, math.nan, 1, math.nan, math.nan, math.nan, resolution)
    if np.ptp(x) >= ROUNDING:
        scatter = float(x.std(ddof=1) / math.sqrt(x.size))
    elif abs(mean) < ROUNDING:
        mean = 0.0
    se = max(scatter, resolution / math.sqrt(3 * x.size))
    if se == 0:
        return Estimate(mean, 0.0, x.size, math.nan, math.nan, math.nan)
    half = max(
        float(special.stdtrit(x.size - 1, 0.5 + confidence / 2)) * se, resolution
    )
    p = 1.0
    if abs(mean) > resolution:
        p = float(2 * special.stdtr(x.size - 1, -abs(mean) / se))
    return Estimate(mean, se, x.size, mean - half, mean + half, p, resolution)


def tied_resolution(values: npt.ArrayLike, resolution: npt.ArrayLike) -> Array:
    """Resolution of the values that equal the most frequent one (to 9 decimals), 0 for the others, (n,) [-].

    Parameters
    ----------
    values, resolution : logarithms of ratios [-] and the half-width of each [-], shape (n,)

    Returns
    -------
    The resolutions [-], shape (n,).
    """
    rounded = np.round(np.asarray(values, dtype=float), 9) + 0.0
    different, place, count = np.unique(
        rounded, return_inverse=True, return_counts=True
    )
    tied = place == int(count.argmax()) if different.size else np.zeros(0, dtype=bool)
    return np.asarray(np.where(tied, np.asarray(resolution, dtype=float), 0.0))


def resolution_of(table: pd.DataFrame) -> Array:
    """Half-width to which each row's value is known; 0 where the table does not tell.

    Parameters
    ----------
    table : pairs, n of them

    Returns
    -------
    The half-widths [-], shape (n,).
    """
    return np.asarray(table.get("resolution", np.zeros(len(table))), dtype=float)


def earthquake_means(table: pd.DataFrame) -> pd.Series:
    """Means of d by earthquake: over the pairs of a motion, then over motions.

    Parameters
    ----------
    table : pairs with ``earthquake``, ``motion`` and ``d`` [-]

    Returns
    -------
    The means [-] by earthquake.
    """
    return (
        table.groupby(["earthquake", "motion"])["d"]
        .mean()
        .groupby(level="earthquake")
        .mean()
    )


def mean_effect(table: pd.DataFrame) -> Estimate:
    """Mean of d with interval and p value that hold in the crossed design.

    The units are the earthquakes; within a single earthquake they are its motions. A column ``resolution``,
    the half-width to which each d is known, widens the interval where pairs agree.

    Parameters
    ----------
    table : pairs with ``earthquake``, ``motion``, ``d`` [-] and, if known, ``resolution`` [-]

    Returns
    -------
    The :class:`Estimate` in logarithms [-].
    """
    return next(iter(mean_effects(table.assign(whole=""), "whole").values()))


def mean_effects(table: pd.DataFrame, by: str) -> dict[Hashable, Estimate]:
    """`mean_effect` of every group of rows with the same value of a column, all at once.

    Parameters
    ----------
    table, by : pairs, and the column of the groups

    Returns
    -------
    The :class:`Estimate` of each group.
    """
    units = sampled_units(table, by)
    return {name: some.effect() for name, some in units.items()}


class Units(NamedTuple):
    """Sampled units: the earthquakes of some pairs, or the motions of their single earthquake."""

    d: Array  # mean of d over the pairs of each [-], shape (k,)
    hidden: Array  # half-width that the steps of these pairs leave open [-], shape (k,)

    def effect(self) -> Estimate:
        """Mean with interval and p value."""
        return t_estimate(self.d, resolution=float(self.hidden.mean()))


def sampled_units(table: pd.DataFrame, by: str) -> dict[Hashable, Units]:
    """Units of every group of rows with the same value of a column."""
    d, known = table["d"].to_numpy(dtype=float), resolution_of(table)
    hidden = np.zeros(len(table))
    groups = table.groupby(by, sort=True).indices
    for rows in groups.values():
        hidden[rows] = tied_resolution(d[rows], known[rows])
    work = table[[by, "earthquake", "motion", "d"]].assign(hidden=hidden)
    motions = work.groupby([by, "earthquake", "motion"])[["d", "hidden"]].mean()
    earthquakes = motions.groupby(level=[by, "earthquake"]).mean().reset_index()
    # the units of a single earthquake are its motions
    several = earthquakes[earthquakes.duplicated(by, keep=False)]
    motions = motions.reset_index()
    units = pd.concat([several, motions[~motions[by].isin(several[by])]])
    d, hidden = units["d"].to_numpy(), units["hidden"].to_numpy()
    return {
        name: Units(d[rows], hidden[rows])
        for name, rows in units.groupby(by).indices.items()
    }


def equivalence(effect: Estimate, margin: float = MARGIN) -> float:
    """Test that a mean log ratio lies within ±ln(1 + margin), by two one-sided tests (Schuirmann 1987).

    It is never shown where the estimate's resolution reaches beyond a bound: a series of 5 % cannot
    show equivalence to ±1 %. Returned is the larger of the two one-sided p values [-], NaN for a single unit.

    Parameters
    ----------
    effect, margin : a mean log ratio, and the relative change that counts as none [-]

    Returns
    -------
    The p value [-].
    """
    bound = math.log1p(margin)
    return max(effect.p_above(-bound), effect.p_below(bound))


def detectable_ratio(effect: Estimate) -> float:
    """Smallest ratio above one that as many units, with their scatter, show with 80 % power [-].

    The test is t over the units, and a difference within the estimate's resolution is none; so what
    can be seen exceeds the resolution by what normal scatter takes away with this power. Infinite for
    one unit; NaN where neither scatter nor resolution are known.

    Parameters
    ----------
    effect : a mean with its scatter

    Returns
    -------
    The ratio [-].
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
        TTestPower().solve_power(
            nobs=units, alpha=LEVEL / 2, power=POWER, alternative="larger"
        )
    )


def holm(p: npt.ArrayLike) -> Array:
    """Adjust p values so that the chance of any false rejection is held (Holm 1979).

    NaN stays NaN and does not count. Holm's adjustment in statsmodels collects all garbage, 0.1 to 1 s a call.

    Parameters
    ----------
    p : p values [-], shape (n,)

    Returns
    -------
    The adjusted p values [-], shape (n,).
    """
    result, known = _p_values(p)
    order = np.flatnonzero(known)[np.argsort(result[known])]
    adjusted = np.maximum.accumulate(result[order] * np.arange(order.size, 0, -1))
    result[order] = np.minimum(adjusted, 1.0)
    return result


def benjamini_hochberg(p: npt.ArrayLike) -> Array:
    """Adjust p values so that the fraction of false rejections is held (Benjamini, Hochberg 1995).

    Parameters
    ----------
    p : p values [-], shape (n,); NaN stays NaN and does not count

    Returns
    -------
    The adjusted p values [-], shape (n,).
    """
    from statsmodels.stats.multitest import fdrcorrection

    result, known = _p_values(p)
    if known.any():
        result[known] = fdrcorrection(result[known])[1]
    return result


def _p_values(p: npt.ArrayLike) -> tuple[Array, npt.NDArray[np.bool_]]:
    """Return a copy of p values, and which of them are known."""
    given = np.array(p, dtype=float)
    if np.any((given < 0) | (given > 1)):
        raise ValueError("a p value lies outside 0 to 1")
    return given, ~np.isnan(given)


@dataclass(frozen=True)
class SignFlips:
    """Permutation test by flipping the signs of whole units."""

    p: float  # two-sided p value [-]
    units: int  # number of units, k
    # whether all 2^k patterns were enumerated; otherwise they were drawn from the seed, or are so
    # many that their mean is normal
    exact: bool

    @property
    def smallest_p(self) -> float:
        """The smallest p value that so many units can give, 2^(1-k) [-]."""
        return 2.0 ** (1 - self.units)


def sign_flip_test(values: npt.ArrayLike, seed: int = 0) -> SignFlips:
    """Test a mean of zero by flipping the signs of k units, here the means of d of earthquakes (Fisher 1935).

    Valid when each unit's distribution is symmetric about zero under the hypothesis. ``seed`` is of the patterns
    drawn when there are more than `DRAWS` of them.

    Parameters
    ----------
    values, seed : means of d of k units [-], shape (k,), and the seed

    Returns
    -------
    The :class:`SignFlips`.
    """
    x = np.asarray(values, dtype=float)
    k = x.size
    if k == 1 or not x.any():
        return SignFlips(p=1.0, units=k, exact=True)
    if k > MOST_DRAWN:
        p = 2 * float(stats.norm.sf(abs(x.sum()) / math.sqrt(float((x**2).sum()))))
        return SignFlips(p, units=k, exact=False)
    # sums that agree to rounding are equal, so the values are taken on a grid of integers
    grid = np.rint(x / np.abs(x).max() * 1e12)
    found = stats.permutation_test(
        (grid,),
        lambda flipped, axis: np.abs(flipped.sum(axis=axis)),
        permutation_type="samples",
        vectorized=True,
        n_resamples=DRAWS,
        alternative="greater",
        rng=np.random.default_rng(seed),
    )
    return SignFlips(float(found.pvalue), units=k, exact=2**k <= DRAWS)


def leave_one_earthquake_out(table: pd.DataFrame) -> pd.DataFrame:
    """Effect without each earthquake in turn; no row for a single one and for more than `MOST_LEFT_OUT`.

    The columns are without, ratio, lower, upper [-], p, largest_change (True for the earthquake that moves the
    estimate most).
    """
    earthquakes = sorted(table["earthquake"].unique())
    if not 1 < len(earthquakes) <= MOST_LEFT_OUT:
        return pd.DataFrame(columns=WITHOUT_COLUMNS)
    whole, rows = mean_effect(table).mean, []
    for name in earthquakes:
        effect = mean_effect(table[table["earthquake"] != name])
        rows.append(
            {
                "without": name,
                "ratio": effect.ratio,
                "lower": effect.ratio_lower,
                "upper": effect.ratio_upper,
                "p": effect.p,
                "largest_change": abs(effect.mean - whole),
            }
        )
    result = pd.DataFrame(rows, columns=WITHOUT_COLUMNS)
    shift = result["largest_change"]
    return result.assign(largest_change=shift == shift.max())
