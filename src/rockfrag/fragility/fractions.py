"""Non-parametric fragility function: the never-falling fraction closest to the data, with limits over groups.

In: outcomes, or logarithms of capacities, with labels of the groups. Out: :class:`Fractions`, with θ in the unit
of the measure, β [-] and pointwise limits. Theory: ``docs/fragility.md``, "Does the curve describe the data?".

Its limits at a value of the measure are those of Korn and Graubard (1998, Survey Methodology 24: 193-201) for
fractions of dependent tests: of a binomial fraction whose number of trials gives the variance that leaving out
whole motions or earthquakes shows, with Jeffreys's limits in the place of Clopper's.  Those of the median are
where they pass one half (Woodruff, 1952, J. Am. Stat. Assoc. 47: 635-646).  The dispersion is half the distance
from the 16 % to the 84 % point, smoothed as Harrell and Davis (1982, Biometrika 69: 635-640) do, and jackknifed
over the same groups.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike, NDArray
from scipy import special

from rockfrag.fragility import intervals
from rockfrag.fragility.observations import Floats, Observations, cells, counts

ENDS = (0.1587, 0.8413)
"""Fractions one standard deviation below and above the median of a lognormal curve [-]."""

# values and fractions that differ by less are one point of the curve [-]
ROUNDING = 1e-6
Limits = tuple[float, float]

UNKNOWN: Limits = (float("nan"), float("nan"))


@dataclass(frozen=True)
class Fractions:
    """Non-decreasing fraction of overturned tests, the non-parametric fragility function."""

    im: Floats  # values of the measure, rising, shape (n,)
    fraction: Floats  # fraction at each of them, never falling, shape (n,)
    # lower, upper: pointwise limits, shape (n,); NaN where there is but one group
    lower: Floats
    upper: Floats
    # theta, theta_limits: median, and its limits: 0 and infinite where the data set none; NaN where
    # the fraction does not pass one half
    theta: float
    theta_limits: Limits
    # beta, beta_limits: half the logarithmic distance from the 16 % to the 84 % point, and its
    # limits; NaN where the fraction does not reach them
    beta: float
    beta_limits: Limits

    def at(self, im: ArrayLike) -> tuple[Floats, Floats, Floats]:
        """Fraction and its limits at any values > 0, three arrays of shape (n,)."""
        x = np.atleast_1d(np.asarray(im, dtype=np.float64))
        knots, fraction = knots_of(self.im, self.fraction)
        value = np.interp(np.log(x), np.log(knots), fraction)
        # between two values the limits are the outer ones
        before = np.searchsorted(self.im, x, side="right")
        lower = np.concatenate([[0.0], self.lower])[before]
        upper = np.concatenate([self.upper, [1.0]])[
            np.searchsorted(self.im, x, side="left")
        ]
        if np.isnan(self.lower).any():
            lower, upper = np.full(x.shape, np.nan), np.full(x.shape, np.nan)
        return np.asarray(value), np.minimum(lower, value), np.maximum(upper, value)


def knots_of(im: Floats, fraction: Floats) -> tuple[Floats, Floats]:
    """Points between which the curve is straight in the logarithm: both rise, the fraction from 0.

    Values of equal fraction become one point in their middle, at 0 and 1 the one nearest to the others. Where
    the lowest value already has a fraction above 0, half that value is given none.

    Parameters
    ----------
    im, fraction : values of the measure, rising, and never-falling fractions [-], shape (n,)

    Returns
    -------
    Values and fractions of the points, shape (points,) each.
    """
    first = np.flatnonzero(np.diff(fraction, prepend=-1.0) > ROUNDING)
    last = np.append(first[1:], im.size) - 1
    at = np.sqrt(im[first] * im[last])
    fraction = fraction[first]
    at = np.where(fraction <= 0.0, im[last], np.where(fraction >= 1.0, im[first], at))
    if fraction[0] > 0:
        at, fraction = np.append(0.5 * im[0], at), np.append(0.0, fraction)
    # of points at one value, but for rounding, the last; the fraction of 0 is kept, a hair below
    at[0] *= 1.0 - 10.0 * ROUNDING
    apart = np.append(at[1:] > at[:-1] * (1.0 + ROUNDING), True)
    return at[apart], fraction[apart]


def fractions_of_outcomes(
    outcomes: Observations, groups: NDArray[np.object_], level: float
) -> Fractions:
    """Non-parametric fragility function of tests with outcomes.

    Parameters
    ----------
    outcomes, groups : n tests, and their labels of motion or earthquake, shape (n,), over which limits are
    level : two-sided confidence level [-]

    Returns
    -------
    The :class:`Fractions`.
    """
    codes = pd.factorize(pd.Series(groups))[0]
    column, values = cells(outcomes.log_im)
    fell = counts(codes, column, outcomes.overturned)
    total = counts(codes, column, outcomes.trials)
    middle = values.copy()
    middle[1:] -= 0.5 * np.diff(values)
    return _fractions(
        _Counted(values, middle, fell, total), motions=outcomes.n_motions, level=level
    )


def fractions_of_capacities(
    log_capacity: Floats, groups: NDArray[np.object_], level: float
) -> Fractions:
    """Non-parametric fragility function of capacities, one a motion.

    Parameters
    ----------
    log_capacity : logarithms, shape (n,); -∞ and ∞ where a capacity lies below or above all that was tried
    groups : labels of motion or earthquake, shape (n,), over which limits are
    level : two-sided confidence level [-]

    Returns
    -------
    The :class:`Fractions`.
    """
    codes, names = pd.factorize(pd.Series(groups))
    finite = np.isfinite(log_capacity)
    if not finite.any():
        nothing = np.empty(0)
        return Fractions(
            im=nothing,
            fraction=nothing,
            lower=nothing,
            upper=nothing,
            theta=np.nan,
            theta_limits=UNKNOWN,
            beta=np.nan,
            beta_limits=UNKNOWN,
        )
    # many neighbouring capacities are one
    cell, values = cells(log_capacity[finite])
    capacity = log_capacity.copy()
    capacity[finite] = values[cell]
    # up to just below a capacity the fraction is that of the one before
    values = np.unique(np.append(values, values - 1e-9))
    block = intervals.blocks_of(len(names))[codes]
    # an infinite capacity lies in the column after the last value
    columns = values.size + 1
    flat = block * columns + np.searchsorted(values, capacity)
    each = np.bincount(flat, minlength=(int(block.max()) + 1) * columns).reshape(
        -1, columns
    )
    fell = np.cumsum(each, axis=1)[:, :-1].astype(np.float64)
    total = np.repeat(np.bincount(block)[:, None], values.size, axis=1).astype(
        np.float64
    )
    return _fractions(
        _Counted(values, values, fell, total),
        motions=log_capacity.size,
        level=level,
        witnesses=len(names),
    )


class _Counted(NamedTuple):
    """Tests by group and value of the measure."""

    log_im: Floats  # ln IM of each value, rising, shape (values,)
    middle: (
        Floats  # where the capacities between two values lie [ln IM], shape (values,)
    )
    # numbers of tests that overturned, and of all, shape (groups, values)
    fell: Floats
    total: Floats


def _fractions(
    counted: _Counted, *, motions: int, level: float, witnesses: int | None = None
) -> Fractions:
    """Fit the never-falling fraction to counted tests, with θ, β and limits by leaving out a group at a time.

    ``motions`` is how many there are. ``witnesses`` are the groups that have shown a fraction of 0 or 1 wherever
    it is one; without it they are counted value by value.
    """
    log_im, middle, fell, total = counted
    groups = len(fell)
    im = np.exp(log_im)
    fraction = _rising(fell.sum(axis=0), total.sum(axis=0))
    theta = _median(im, fraction)
    beta = _dispersion(middle, fraction, motions)
    if groups < 2:
        nothing = np.full(fraction.shape, np.nan)
        return Fractions(im, fraction, nothing, nothing, theta, UNKNOWN, beta, UNKNOWN)
    weights = intervals.all_but_one(groups)
    replicates = zip(weights @ fell, weights @ total, strict=True)
    left_out = np.array([_rising(some, of) for some, of in replicates])
    seen = _witnesses(fraction, total) if witnesses is None else np.float64(witnesses)
    error = intervals.jackknife_error(left_out)
    lower, upper = _limits(fraction, error, seen, motions, level)
    theta_limits = UNKNOWN
    if np.isfinite(theta):
        # values between which the limits of the curve hold one half
        low = im[upper < 0.5].max(initial=0.0)
        high = im[lower > 0.5].min(initial=np.inf)
        theta_limits = min(float(low), theta), max(float(high), theta)
    beta_limits = UNKNOWN
    if np.isfinite(beta):
        motions_left = motions * weights.mean(axis=1)
        pairs = zip(left_out, motions_left, strict=True)
        betas = np.array([_dispersion(middle, some, count) for some, count in pairs])
        beta_limits = intervals.beta_limits(beta, betas, level)
    return Fractions(im, fraction, lower, upper, theta, theta_limits, beta, beta_limits)


def _median(im: Floats, fraction: Floats) -> float:
    """Value of the measure at which the never-falling fraction passes one half; NaN where it does not."""
    if not fraction[0] <= 0.5 <= fraction[-1]:
        return float("nan")
    at, value = knots_of(im, fraction)
    return float(np.exp(np.interp(0.5, value, np.log(at))))


def _rising(fell: Floats, total: Floats) -> Floats:
    """Never-falling fraction, shape (values,); where nothing was tried that of the value before, or 0.

    ``fell``, ``total``: numbers of tests that overturned, and of all, shape (values,).
    """
    tried = total > 0
    if not tried.any():
        return np.zeros(total.shape)
    # takes a fifth of a second to load
    from scipy import optimize

    fitted = optimize.isotonic_regression(
        fell[tried] / total[tried], weights=total[tried]
    ).x
    fraction = np.concatenate([[0.0], np.clip(fitted, 0.0, 1.0)])
    return np.asarray(fraction[np.cumsum(tried)])


def _witnesses(fraction: Floats, total: Floats) -> Floats:
    """Groups that bear witness to a fraction of 0 or 1, shape (values,).

    To 0 a group does that has a test there or at a larger value at which none fell; to 1 one that has a test there
    or at a smaller value at which all fell. ``total``: tests, shape (groups, values).
    """
    tried, none, every = total > 0, fraction <= 0.0, fraction >= 1.0
    above = np.logical_or.accumulate((tried & none)[:, ::-1], axis=1)[:, ::-1].sum(
        axis=0
    )
    below = np.logical_or.accumulate(tried & every, axis=1).sum(axis=0)
    return np.asarray(above * none + below * every, dtype=np.float64)


def _limits(
    fraction: Floats,
    error: Floats,
    witnesses: Floats | np.float64,
    motions: int,
    level: float,
) -> tuple[Floats, Floats]:
    """Pointwise limits of fractions (Korn and Graubard, as at the head of the module), shape (values,) each.

    Parameters
    ----------
    fraction, error : fractions and their standard errors over groups [-], shape (values,)
    witnesses : number of groups that bear witness to a fraction of 0 or 1, shape (values,) or one number
    motions : number of motions, the most that trials can count
    level : two-sided confidence level [-]
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        # of a binomial fraction with that variance
        trials = np.where(error > 0, fraction * (1.0 - fraction) / error**2, np.inf)
    certain = (fraction <= 0.0) | (fraction >= 1.0)
    trials = np.where(certain, witnesses, np.minimum(trials, motions))
    failed, tail = fraction * trials, 0.5 - 0.5 * level
    lower = special.betaincinv(failed + 0.5, trials - failed + 0.5, tail)
    upper = special.betaincinv(failed + 0.5, trials - failed + 0.5, 1.0 - tail)
    lower = np.where(fraction <= 0.0, 0.0, np.minimum(lower, fraction))
    upper = np.where(fraction >= 1.0, 1.0, np.maximum(upper, fraction))
    # limits of a curve that never falls do not fall, the cautious way round
    return np.minimum.accumulate(lower[::-1])[::-1], np.maximum.accumulate(upper)


def _dispersion(middle: Floats, fraction: Floats, motions: float) -> float:
    """Half the distance in ln IM between the 16 % and the 84 % point; NaN where the fraction does not reach them.

    A point is a mean of the values, weighted as Harrell and Davis (1982) do by the beta distribution of that order
    statistic of so many ``motions``.

    Parameters
    ----------
    middle : where the capacities between two values lie [ln IM], shape (values,)
    fraction : never-falling fractions [-], shape (values,)
    """
    if not (fraction[0] <= ENDS[0] and fraction[-1] >= ENDS[1]):
        return float("nan")
    points = []
    for end in ENDS:
        reached = special.betainc(
            (motions + 1) * end, (motions + 1) * (1.0 - end), fraction
        )
        # what lies beyond the last value counts there
        weight = np.diff(reached, prepend=0.0)
        weight[-1] += 1.0 - reached[-1]
        points.append(float(weight @ middle))
    return 0.5 * (points[1] - points[0])
