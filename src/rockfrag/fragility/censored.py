"""Lognormal capacity from amplitudes known to an interval or only from below.

A step protocol brackets the overturning amplitude of a test between the last step survived and the first that
overturned; at the shaker's limit it is only known to be larger. The likelihood is concave in (-ln θ/β, 1/β)
(Burridge, 1981, J. R. Stat. Soc. B 43: 41-45), which Newton's method uses here.
"""

from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from scipy import special

from rockfrag.base.errors import InputError
from rockfrag.base.short_repr import short_repr
from rockfrag.fragility import intervals, lognormal
from rockfrag.fragility.intervals import MOST_BLOCKS, Interval
from rockfrag.fragility.observations import (
    Floats,
    Grouped,
    Over,
    labels,
    name_and_unit,
    numbers,
)

_LOG_ROOT_TWO_PI = 0.5 * np.log(2.0 * np.pi)


@dataclass(frozen=True)
class Brackets(Grouped):
    """Overturning amplitudes known to lie between two bounds, in ``unit``, each array of shape (n,).

    ``lower`` 0 means overturned at the first step, ``upper`` infinite never overturned (right-censored), equal
    bounds an amplitude known exactly.
    """

    lower: Floats
    upper: Floats
    motion: NDArray[np.object_]
    earthquake: NDArray[np.object_]
    name: str = "PGA"
    unit: str = "g"

    __repr__ = short_repr

    @property
    def n_overturned(self) -> int:
        """Number of tests that ended by overturning."""
        return int(np.isfinite(self.upper).sum())


def brackets_from_table(
    table: pd.DataFrame,
    *,
    lower: str = "lower_g",
    upper: str = "upper_g",
    motion: str | None = "motion",
    earthquake: str | None = None,
    measure: str = "pga_g",
) -> Brackets:
    """Read the bounds of the overturning amplitude out of a table of tests, one row per test.

    A missing upper bound means right-censored. ``measure`` is a column name that tells the measure and its unit.
    """
    if len(table) == 0:
        raise InputError("table: there is no row; give at least one test.")
    low = numbers(table, lower)
    if upper not in table:
        raise InputError(
            f"table: there is no column {upper!r}; correct the name of the column."
        )
    high = pd.to_numeric(table[upper], errors="coerce").to_numpy(dtype=np.float64)
    high = np.where(np.isnan(high), np.inf, high)
    bad = (low < 0) | (high <= 0) | (high < low) | ((low == 0) & np.isinf(high))
    for row in np.flatnonzero(bad):
        raise InputError(
            f"table, row {row + 1}, columns {lower!r} and {upper!r}: {low[row]:g} to {high[row]:g} is no "
            "bracket of an amplitude; give 0 ≤ lower ≤ upper and leave upper empty if it never overturned."
        )
    motions = labels(table, motion)
    earthquakes = motions if earthquake is None else labels(table, earthquake)
    return Brackets(low, high, motions, earthquakes, *name_and_unit(measure))


def fit_brackets(brackets: Brackets) -> lognormal.FragilityFit:
    """Fit θ and β to bracketed amplitudes by maximum likelihood.

    Where one amplitude lies inside every bracket the likelihood grows without end as β tends to zero; then θ is
    the middle of the common bracket and β its logarithmic width / √12, and the fit says so. There is no curve,
    only a bound, where no test overturned; nor is there one where all brackets are open and end at one amplitude.
    """
    low, high = _logs(brackets)
    curve, log_likelihood, case = lognormal.NO_CURVE, 0.0, ""
    if brackets.n_overturned == 0:
        method, case = "none: all tests survived", "survived"
    elif brackets.lower.max() == 0:
        method, case = "none: all tests overturned at once", "at once"
    else:
        found = _fit_weighted(low, high, np.ones((1, low.size)))
        coefficients, information, log_likelihood = (
            found[0][0],
            found[1][0],
            float(found[2][0]),
        )
        # where all brackets share an amplitude there is no information
        overlap = not np.isfinite(information).all()
        if not np.isfinite(coefficients).all():
            method, case = "none: one level of the measure", "one level"
        elif coefficients[1] < lognormal.LEAST_SLOPE:
            method, case = "none: no curve in the brackets", "flat"
        elif overlap:
            method, case = "interval estimate (brackets overlap)", "overlap"
            curve = lognormal.curve_parameters(coefficients, information)
        else:
            method = "lognormal, interval- and right-censored maximum likelihood"
            covariance = np.linalg.pinv(information, hermitian=True)
            curve = lognormal.curve_parameters(coefficients, covariance)
    counted = (low.size, brackets.n_overturned, brackets.n_motions)
    notes = tuple(lognormal.SAY("brackets", brackets, case))
    return lognormal.FragilityFit(
        *curve,
        log_likelihood,
        *counted,
        method,
        brackets.name,
        brackets.unit,
        "probit",
        notes,
    )


def bracket_interval(
    brackets: Brackets, *, over: Over | None = None, level: float = 0.90
) -> Interval:
    """Confidence limits of a curve fitted to brackets, by leaving out whole motions or earthquakes."""
    over, notes = intervals.population(brackets, over)
    codes, names = pd.factorize(pd.Series(brackets.groups(over)))
    low, high = _logs(brackets)
    groups = len(names)

    def refit(weights: Floats) -> Floats:
        each = weights[:, codes]
        if (
            groups > MOST_BLOCKS
            and len(weights) > 1
            and (each.max(), each.min()) == (1, 0)
        ):
            return _without_a_block(low, high, each)
        return _fit_weighted(low, high, each)[0]

    found = intervals.resampled_interval(
        refit, groups, over=over, notes=notes, level=level
    )
    if found.method == "none" and groups > 1 and brackets.n_overturned:
        # neighbouring steps touch, so the brackets may share no more than a point: all of them count
        lowest, highest = float(brackets.lower.min()), float(brackets.upper.max())
        return intervals.step_limits(found, lowest, highest)
    return found


def bracket_log_scores(brackets: Brackets, weights: Floats) -> Floats:
    """Log probability of each bracket under the fit to each row of weights, (batch, n); -∞ where there is no fit.

    Equal bounds, which have no probability, score by their density in the logarithm.
    """
    low, high = _logs(brackets)
    with np.errstate(all="ignore"):
        scores = _pulls(low, high, _fit_weighted(low, high, weights)[0])[0]
    return np.asarray(np.where(np.isnan(scores), -np.inf, scores))


def _logs(brackets: Brackets) -> tuple[Floats, Floats]:
    with np.errstate(divide="ignore"):
        return np.log(brackets.lower), np.log(brackets.upper)


def _without_a_block(low: Floats, high: Floats, weights: Floats) -> Floats:
    """Fit (intercept, slope) without each of many blocks: a step of Newton's from the fit to all.

    What the step neglects is of second order in a block's fraction of all, a hundredth.
    """
    left, right = _shared(low, high, weights)
    if (left <= right).any():
        return _fit_weighted(low, high, weights)[0]
    coefficients, _, value = _newton(low, high, np.ones((1, low.size)))
    if not (np.isfinite(value).all() and coefficients[0, 1] >= lognormal.LEAST_SLOPE):
        return _fit_weighted(low, high, weights)[0]
    pulls = np.concatenate(_pulls(low, high, coefficients))
    _, score0, score1, h00, h01, h11 = (weights @ pulls.T).T
    step = np.column_stack([h11 * score0 - h01 * score1, h00 * score1 - h01 * score0])
    return np.asarray(coefficients - step / (h00 * h11 - h01**2)[:, None])


def _shared(low: Floats, high: Floats, weights: Floats) -> tuple[Floats, Floats]:
    """Ends of what all brackets with a weight share, for each row of weights; the wrong way round for nothing."""
    used = weights > 0
    return np.where(used, low, -np.inf).max(axis=1), np.where(used, high, np.inf).min(
        axis=1
    )


def _fit_weighted(
    low: Floats, high: Floats, weights: Floats
) -> tuple[Floats, Floats, Floats]:
    """Fit (intercept, slope) for each row of weights, shape (batch, n)."""
    coefficients, information, log_likelihood = (
        np.full((len(weights), *shape), np.nan) for shape in ((2,), (2, 2), ())
    )
    left, right = _shared(low, high, weights)
    overlap = left <= right
    if overlap.any():
        closed = np.asarray(
            ((weights[overlap] > 0) & np.isfinite(high - low)).any(axis=1)
        )
        coefficients[overlap] = _common_bracket(left[overlap], right[overlap], closed)
    if not overlap.all():
        found = _newton(low, high, weights[~overlap])
        coefficients[~overlap], information[~overlap], log_likelihood[~overlap] = found
    return coefficients, information, log_likelihood


def _common_bracket(
    left: Floats, right: Floats, any_closed: NDArray[np.bool_]
) -> Floats:
    """Return middle and width / √12 of the amplitudes that all brackets share, as intercept and slope.

    There is no curve where all are open and end at one amplitude: some are below, some above, and any β will do.
    """
    closed = np.isfinite(left) & np.isfinite(right)
    # equal amplitudes share a bracket of no width; 1e-6 keeps 1/β a number
    with np.errstate(invalid="ignore"):
        beta = np.maximum((right - left) / np.sqrt(12.0), 1e-6)
        result = np.column_stack([-0.5 * (left + right) / beta, 1.0 / beta])
        one_level = (right - left < lognormal.ROUNDING) & ~any_closed
    result[~closed | one_level] = np.nan
    result[np.isinf(right), 0] = -np.inf
    result[np.isinf(left), 0] = np.inf
    return np.asarray(result)


def _newton(
    low: Floats, high: Floats, weights: Floats
) -> tuple[Floats, Floats, Floats]:
    finite_low, finite_high = np.isfinite(low), np.isfinite(high)
    middle = np.where(
        finite_low & finite_high, 0.5 * (low + high), np.where(finite_low, low, high)
    )
    total = weights.sum(axis=1)
    mean = weights @ middle / total
    spread = np.sqrt((weights * (middle - mean[:, None]) ** 2).sum(axis=1) / total)
    slope = 1.0 / np.maximum(spread, 0.05)
    coefficients = np.column_stack([-mean * slope, slope])
    value, score, hessian = _likelihood(low, high, weights, coefficients)
    active = np.arange(len(weights))
    for _ in range(200):
        step = np.einsum("bij,bj->bi", np.linalg.pinv(-hessian[active]), score[active])
        size = np.ones(active.size)
        waiting = np.arange(active.size)
        for _ in range(40):
            trial = coefficients[active[waiting]] + size[waiting, None] * step[waiting]
            positive = trial[:, 1] > 0
            trial[:, 1] = np.where(positive, trial[:, 1], 1e-3)
            new = _likelihood(low, high, weights[active[waiting]], trial)
            better = positive & (new[0] >= value[active[waiting]] - 1e-12)
            done = active[waiting[better]]
            coefficients[done] = trial[better]
            value[done], score[done], hessian[done] = (part[better] for part in new)
            waiting = waiting[~better]
            size[waiting] *= 0.5
            if waiting.size == 0:
                break
        moved = np.abs(size[:, None] * step).max(axis=1) / np.abs(
            coefficients[active]
        ).max(axis=1)
        # a slope that sinks below what counts as a curve would sink for ever
        flat = coefficients[active, 1] < 0.1 * lognormal.LEAST_SLOPE
        active = active[(moved > 1e-10) & ~flat]
        if active.size == 0:
            break
    return coefficients, -hessian, value


def _likelihood(
    low: Floats, high: Floats, weights: Floats, coefficients: Floats
) -> tuple[Floats, Floats, Floats]:
    """Return log-likelihood, score and Hessian in (intercept, slope), for each row of weights."""
    pulls = _pulls(low, high, coefficients)
    value, score0, score1, h00, h01, h11 = (
        (weights * pull).sum(axis=1) for pull in pulls
    )
    hessian = np.stack([h00, h01, h01, h11], axis=1).reshape(-1, 2, 2)
    return value, np.stack([score0, score1], axis=1), hessian


def _pulls(low: Floats, high: Floats, coefficients: Floats) -> tuple[Floats, ...]:
    """Log-likelihood of each bracket and its derivatives in (intercept, slope), each of shape (batch, n)."""
    c0, c1 = coefficients[:, :1], coefficients[:, 1:]
    x_low, x_high = (
        np.where(np.isfinite(low), low, 0.0),
        np.where(np.isfinite(high), high, 0.0),
    )
    exact = low == high
    # the density of ln IM, so that equal bounds and narrow brackets rank models alike
    at = c0 + c1 * x_low
    ones = np.ones(at.shape)
    value = np.log(c1) - 0.5 * at**2 - _LOG_ROOT_TWO_PI
    bends = (-ones, -x_low * ones, -(x_low**2) - 1.0 / c1**2)
    of_density = (value, -at, -at * x_low + 1.0 / c1, *bends)
    if exact.all():
        return of_density
    z_low = np.where(np.isneginf(low), -np.inf, c0 + c1 * x_low)
    z_high = np.where(np.isposinf(high), np.inf, c0 + c1 * x_high)
    log_fraction = _log_difference(z_low, z_high)
    ratio_low = np.exp(-0.5 * z_low**2 - _LOG_ROOT_TWO_PI - log_fraction)
    ratio_high = np.exp(-0.5 * z_high**2 - _LOG_ROOT_TWO_PI - log_fraction)
    bend_low = np.where(np.isinf(z_low), 0.0, z_low) * ratio_low
    bend_high = np.where(np.isinf(z_high), 0.0, z_high) * ratio_high
    g0 = ratio_high - ratio_low
    g1 = ratio_high * x_high - ratio_low * x_low
    bends = (
        bend_low - bend_high - g0**2,
        bend_low * x_low - bend_high * x_high - g0 * g1,
        bend_low * x_low**2 - bend_high * x_high**2 - g1**2,
    )
    of_fraction = (log_fraction, g0, g1, *bends)
    return tuple(
        np.where(exact, *pair) for pair in zip(of_density, of_fraction, strict=True)
    )


def _log_difference(z_low: Floats, z_high: Floats) -> Floats:
    """Return ln(Φ(z_high) - Φ(z_low)) without loss of digits; 0 where the bounds are equal."""
    with np.errstate(invalid="ignore"):
        flip = z_low + z_high > 0
    lower, upper = np.where(flip, -z_high, z_low), np.where(flip, -z_low, z_high)
    log_upper, log_lower = special.log_ndtr(upper), special.log_ndtr(lower)
    same = lower == upper
    gap = np.where(
        same | np.isneginf(log_lower), -np.inf, log_lower - np.where(same, 0, log_upper)
    )
    return np.asarray(np.where(same, 0.0, log_upper + np.log1p(-np.exp(gap))))
