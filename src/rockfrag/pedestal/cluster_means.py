"""The test that holds its level: t on the means of the units that were sampled.

The 36 pairs are no 36 independent facts: pairs under one motion share it, motions of one
earthquake share the earthquake.  With objects and floors fixed and earthquakes sampled, the mean of
d over one earthquake is one observation, independent of the others whatever the variances of event,
motion and pair are.  A t test on the k event means, with k - 1 degrees of freedom, is therefore
exact for normal data (balanced, as the thesis's design is).  Any contrast, a difference of floors
or a slope on slenderness, is computed inside each event first and then tested in the same way.
"""

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import pandas as pd
from scipy import stats

Array = npt.NDArray[np.float64]

CONFIDENCE = 0.95
ROUNDING = 1e-12
"""Differences of logarithms below this are rounding, not scatter [-]."""


class TooFewUnitsError(ValueError):
    """There is nothing to estimate from: no unit, or a figure that its data do not define."""


@dataclass(frozen=True)
class Estimate:
    """A mean over sampled units with its t interval, in logarithms.

    Parameters
    ----------
    mean
        Mean over the units, ln of a ratio [-].
    se
        Its standard error [-]; NaN for one unit.
    units
        Number of sampled units.
    lower, upper
        Limits of the interval [-]; NaN for one unit.
    p
        Two-sided p value of a mean of zero; NaN for one unit.
    """

    mean: float
    se: float
    units: int
    lower: float
    upper: float
    p: float

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
        return Estimate(self.mean * factor, self.se * abs(factor), self.units, lower, upper, self.p)

    def p_above(self, bound: float) -> float:
        """One-sided p value of the hypothesis that the mean is at most ``bound``."""
        if not math.isfinite(self.se):
            return math.nan
        if self.se == 0:
            return 0.0 if self.mean > bound else 1.0
        return float(stats.t.sf((self.mean - bound) / self.se, self.units - 1))

    def p_below(self, bound: float) -> float:
        """One-sided p value of the hypothesis that the mean is at least ``bound``."""
        if not math.isfinite(self.se):
            return math.nan
        if self.se == 0:
            return 0.0 if self.mean < bound else 1.0
        return float(stats.t.cdf((self.mean - bound) / self.se, self.units - 1))

    def text(self) -> str:
        """Ratio and interval in words for a table."""
        if math.isnan(self.se):
            return f"{self.ratio:.3f} (one unit, no interval)"
        return f"{self.ratio:.3f} [{self.ratio_lower:.3f}, {self.ratio_upper:.3f}]"


def t_estimate(values: npt.ArrayLike, confidence: float = CONFIDENCE) -> Estimate:
    """Mean of independent units with its t interval and test.

    Parameters
    ----------
    values
        One value per sampled unit, shape (k,).
    confidence
        Level of the two-sided interval.

    Returns
    -------
    Estimate
        Units that agree to the last digit (a pedestal that never moves gives d = 0 throughout) have
        an interval of zero width and p = 1 at zero, 0 elsewhere.

    Raises
    ------
    TooFewUnitsError
        If there are no values or one is not finite.
    """
    x = np.asarray(values, dtype=float)
    if x.size == 0 or not np.all(np.isfinite(x)):
        raise TooFewUnitsError("a mean needs at least one unit and finite values")
    mean = float(x.mean())
    if x.size == 1:
        return Estimate(mean, math.nan, 1, math.nan, math.nan, math.nan)
    if np.ptp(x) < ROUNDING:
        value = 0.0 if abs(mean) < ROUNDING else mean
        return Estimate(value, 0.0, x.size, value, value, 1.0 if value == 0 else 0.0)
    se = float(x.std(ddof=1) / math.sqrt(x.size))
    half = float(stats.t.ppf(0.5 + confidence / 2, x.size - 1)) * se
    p = float(2 * stats.t.sf(abs(mean) / se, x.size - 1))
    return Estimate(mean, se, x.size, mean - half, mean + half, p)


def unit_means(table: pd.DataFrame, unit: str, value: str = "d") -> pd.Series:
    """Means of ``value`` by sampled unit: over the pairs of a motion, then over motions.

    Parameters
    ----------
    table
        Pairs with the columns ``unit``, motion and ``value``.
    unit
        ``event`` or ``motion``.

    Returns
    -------
    pandas.Series
        One value per unit, indexed and sorted by its name.
    """
    by = ["motion"] if unit == "motion" else [unit, "motion"]
    means = table.groupby(by)[value].mean()
    return means if unit == "motion" else means.groupby(level=unit).mean()


def sampled_unit(table: pd.DataFrame) -> str:
    """Say what was sampled: events, or the motions of the single event in the table."""
    return "event" if len(set(table["event"])) > 1 else "motion"


def mean_effect(table: pd.DataFrame, confidence: float = CONFIDENCE) -> Estimate:
    """Mean of d with interval and p value that hold in the crossed design.

    The units are the events; within a single event they are its motions.
    """
    return t_estimate(unit_means(table, sampled_unit(table)), confidence)


def slope_effect(
    table: pd.DataFrame, x: str = "s_c", value: str = "d", confidence: float = CONFIDENCE
) -> Estimate:
    """Slope of ``value`` on ``x``: least squares inside each event, then t over the events.

    Only differences between the objects of one motion (and one side, if there is a column side) enter.
    """
    by_motion = [table[name] for name in ("event", "motion", "side") if name in table.columns]
    across = table[x] - table[x].groupby(by_motion).transform("mean")
    sums = pd.DataFrame({"xy": across * table[value], "xx": across**2})
    by_event = sums.groupby(table["event"]).sum()
    by_event = by_event[by_event["xx"] > 0]
    return t_estimate(by_event["xy"] / by_event["xx"], confidence)


def contrast(
    table: pd.DataFrame,
    factor: str,
    one: str,
    other: str,
    block: str = "event",
    value: str = "d",
    confidence: float = CONFIDENCE,
) -> Estimate:
    """Difference of the mean of ``value`` between two levels of a factor, block by block.

    Like is compared with like: both levels must be there for the same object, event, floor (and side).

    Parameters
    ----------
    factor, one, other
        Column and its two levels; the estimate is ``one`` minus ``other``.
    block
        Column within which the levels are compared: the events for floors and objects, the floors
        for a comparison of two events.
    """
    design = ("event", "floor", "object", "side")
    matched = [name for name in design if name in table.columns and name != factor]
    cells = table.pivot_table(index=matched, columns=factor, values=value, aggfunc="mean")
    difference = (cells[one] - cells[other]).dropna()
    return t_estimate(difference.groupby(level=block).mean(), confidence)
