"""Lognormal capacity from amplitudes known to an interval or only from below.

A step protocol brackets the overturning amplitude of a test between the last step survived and the first that
overturned; at the shaker's limit it is only known to be larger. The likelihood is concave in (-ln θ/β, 1/β)
(Burridge, 1981, J. R. Stat. Soc. B 43: 41-45), which Newton's method uses here.

In: :class:`Brackets`, bounds in the unit of the measure. Out: a
:class:`rockfrag.fragility.lognormal.FragilityFit`, its limits, and log scores of brackets.
Theory: ``docs/fragility.md``, "Estimators" and "When the data do not allow a curve".
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from scipy import special

from rockfrag.base.errors import InputError
from rockfrag.base.short_repr import short_repr
from rockfrag.fragility import intervals, lognormal
from rockfrag.fragility.fit_notes import BracketCase, notes_of_brackets
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

    Parameters
    ----------
    table : n rows
    lower, upper : columns of the bounds, in the unit of ``measure``; a missing upper bound means right-censored
    motion, earthquake : columns of labels; None where each row is a motion (earthquake) of its own
    measure : column name that tells the measure and its unit

    Returns
    -------
    The :class:`Brackets`, of n tests.
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
    if bad.any():
        row = int(bad.argmax())
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

    Parameters
    ----------
    brackets : n amplitudes known to lie between two bounds

    Returns
    -------
    The :class:`rockfrag.fragility.lognormal.FragilityFit`, θ in the unit of the brackets.
    """
    low, high = _logs(brackets)
    curve, log_likelihood = lognormal.NO_CURVE, 0.0
    if brackets.n_overturned == 0:
        case = BracketCase.ALL_SURVIVED
    elif brackets.lower.max() == 0:
        case = BracketCase.ALL_AT_ONCE
    else:
        found = _fit_weighted(low, high, np.ones((1, low.size)))
        coefficients, information = found.coefficients[0], found.information[0]
        log_likelihood = float(found.log_likelihood[0])
        case = _case_of(coefficients, information)
        if case is BracketCase.OVERLAP:
            curve = lognormal.curve_parameters(coefficients, information)
        elif case is BracketCase.REGULAR:
            covariance = np.linalg.pinv(information, hermitian=True)
            curve = lognormal.curve_parameters(coefficients, covariance)
    return lognormal.FragilityFit(
        theta=curve.theta,
        beta=curve.beta,
        covariance=curve.covariance,
        log_likelihood=log_likelihood,
        n=low.size,
        n_overturned=brackets.n_overturned,
        n_motions=brackets.n_motions,
        method=case.value,
        im=brackets.name,
        unit=brackets.unit,
        warnings=notes_of_brackets(brackets, case),
    )


def _case_of(coefficients: Floats, information: Floats) -> BracketCase:
    """Case of brackets that were fitted: intercept and slope, (2,), and their information, (2, 2)."""
    if not np.isfinite(coefficients).all():
        return BracketCase.ONE_LEVEL
    if coefficients[1] < lognormal.LEAST_SLOPE:
        return BracketCase.FLAT
    # where all brackets share an amplitude there is no information
    if not np.isfinite(information).all():
        return BracketCase.OVERLAP
    return BracketCase.REGULAR


def bracket_interval(
    brackets: Brackets, *, over: Over | None = None, level: float = 0.90
) -> Interval:
    """Confidence limits of a curve fitted to brackets, by leaving out whole motions or earthquakes.

    Parameters
    ----------
    brackets : n amplitudes known to lie between two bounds
    over : the groups to leave out; None takes earthquakes where some have several motions
    level : two-sided confidence level [-]

    Returns
    -------
    The :class:`rockfrag.fragility.intervals.Interval`.
    """
    over, notes = intervals.choose_groups(brackets, over)
    codes, names = pd.factorize(pd.Series(brackets.groups(over)))
    low, high = _logs(brackets)
    groups = len(names)

    def refit(weights: Floats) -> Floats:
        """Intercept and slope for weights of the groups, shape (batch, groups)."""
        each = weights[:, codes]
        leaves_out = len(weights) > 1 and (each.max(), each.min()) == (1, 0)
        if leaves_out and groups > MOST_BLOCKS:
            # a hundredth of the brackets changes little: one step from the fit to all is enough
            return _without_a_block(low, high, each)
        return _fit_weighted(low, high, each).coefficients

    found = intervals.resampled_interval(
        refit, groups, over=over, notes=notes, level=level
    )
    if found.method == "none" and groups > 1 and brackets.n_overturned:
        # neighbouring steps touch, so the brackets may share no more than a point: all of them count
        lowest, highest = float(brackets.lower.min()), float(brackets.upper.max())
        return intervals.step_limits(found, lowest, highest)
    return found


def bracket_log_scores(brackets: Brackets, weights: Floats) -> Floats:
    """Log probability of each bracket under the fit to each row of weights; -∞ where there is no fit.

    Equal bounds, which have no probability, score by their density in the logarithm.

    Parameters
    ----------
    brackets, weights : n amplitudes, and weights of each, shape (batch, n)

    Returns
    -------
    The log scores [-], shape (batch, n).
    """
    low, high = _logs(brackets)
    with np.errstate(all="ignore"):
        fit = _fit_weighted(low, high, weights)
        scores = _terms(low, high, fit.coefficients).value
    return np.asarray(np.where(np.isnan(scores), -np.inf, scores))


def _logs(brackets: Brackets) -> tuple[Floats, Floats]:
    """Logarithms of both bounds, shape (n,) each; -∞ of a bound of zero."""
    with np.errstate(divide="ignore"):
        return np.log(brackets.lower), np.log(brackets.upper)


def _without_a_block(low: Floats, high: Floats, weights: Floats) -> Floats:
    """Fit (intercept, slope) without each of many blocks: a step of Newton's from the fit to all.

    What the step neglects is of second order in a block's fraction of all, a hundredth. Where some fit is no
    regular one each is searched for by itself.

    Parameters
    ----------
    low, high : logarithms of the brackets' bounds, shape (n,)
    weights : 0 for what is left out, else 1, a row a fit, shape (batch, n)

    Returns
    -------
    Coefficients, shape (batch, 2).
    """
    left, right = _shared(low, high, weights)
    if (left <= right).any():
        return _fit_weighted(low, high, weights).coefficients
    whole = _newton(low, high, np.ones((1, low.size)))
    is_curve = whole.coefficients[0, 1] >= lognormal.LEAST_SLOPE
    if not (np.isfinite(whole.log_likelihood).all() and is_curve):
        return _fit_weighted(low, high, weights).coefficients
    # sums of slope and curvature of the log-likelihood over what is left, and H⁻¹ times the slope
    terms = _terms(low, high, whole.coefficients)
    _, score0, score1, h00, h01, h11 = (weights @ np.concatenate(terms).T).T
    determinant = h00 * h11 - h01**2
    step = np.column_stack([h11 * score0 - h01 * score1, h00 * score1 - h01 * score0])
    return np.asarray(whole.coefficients - step / determinant[:, None])


def _shared(low: Floats, high: Floats, weights: Floats) -> tuple[Floats, Floats]:
    """Ends of the range of ln amplitude that all brackets with a weight share, shape (batch,) each.

    They are crossed, left above right, if there is none. ``low``, ``high``: shape (n,); ``weights``: shape (batch,
    n).
    """
    used = weights > 0
    left = np.where(used, low, -np.inf).max(axis=1)
    return left, np.where(used, high, np.inf).min(axis=1)


class _Fits(NamedTuple):
    """Fits to each row of weights."""

    coefficients: Floats  # intercept and slope, shape (batch, 2); NaN without a fit
    # observed information, shape (batch, 2, 2), and log-likelihood, shape (batch,); NaN without a maximum
    information: Floats
    log_likelihood: Floats


def _fit_weighted(low: Floats, high: Floats, weights: Floats) -> _Fits:
    """Fit (intercept, slope) to brackets of ln amplitude, shape (n,), for each row of weights, shape (batch, n).

    Where all brackets share a range the likelihood has no maximum, and its middle and width make a curve
    (:func:`fit_brackets`).
    """
    batch = len(weights)
    fits = _Fits(
        np.full((batch, 2), np.nan),
        np.full((batch, 2, 2), np.nan),
        np.full(batch, np.nan),
    )
    left, right = _shared(low, high, weights)
    overlap = left <= right
    if overlap.any():
        closed = np.asarray(
            ((weights[overlap] > 0) & np.isfinite(high - low)).any(axis=1)
        )
        fits.coefficients[overlap] = _common_bracket(
            left[overlap], right[overlap], closed
        )
    if not overlap.all():
        found = _newton(low, high, weights[~overlap])
        fits.coefficients[~overlap] = found.coefficients
        fits.information[~overlap] = found.information
        fits.log_likelihood[~overlap] = found.log_likelihood
    return fits


def _common_bracket(
    left: Floats, right: Floats, any_closed: NDArray[np.bool_]
) -> Floats:
    """Intercept and slope, shape (batch, 2), from the ranges of ln amplitude that all brackets share.

    The median is the middle and β the width / √12. There is no curve where all are open and end at one amplitude:
    some are below, some above, and any β will do.

    Parameters
    ----------
    left, right : ends of the ranges, shape (batch,)
    any_closed : whether some bracket is closed at both ends, shape (batch,)
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


_MOST_STEPS = 200
_MOST_HALVINGS = 40
_SETTLED = 1e-10  # change of the coefficients, over the largest of them, at which Newton's method ends
_FLAT = 0.1 * lognormal.LEAST_SLOPE
"""A slope that sinks below what counts as a curve would sink for ever."""


def _newton(low: Floats, high: Floats, weights: Floats) -> _Fits:
    """Maximise the likelihood of each row of weights by Newton's method with halved steps.

    A row is done when its coefficients settle, or its slope sinks below that of a curve; the others go on.

    Parameters
    ----------
    low, high : logarithms of the bounds, shape (n,)
    weights : shape (batch, n)
    """
    coefficients = _first_coefficients(low, high, weights)
    at = _likelihood(low, high, weights, coefficients)
    active = np.arange(len(weights))
    for _ in range(_MOST_STEPS):
        step = np.einsum(
            "bij,bj->bi", np.linalg.pinv(-at.hessian[active]), at.score[active]
        )
        # fraction of its step that each active row takes, and the rows whose step does not help yet
        size = np.ones(active.size)
        waiting = np.arange(active.size)
        for _ in range(_MOST_HALVINGS):
            trial = coefficients[active[waiting]] + size[waiting, None] * step[waiting]
            positive = trial[:, 1] > 0
            trial[:, 1] = np.where(positive, trial[:, 1], 1e-3)
            new = _likelihood(low, high, weights[active[waiting]], trial)
            better = positive & (new.value >= at.value[active[waiting]] - 1e-12)
            done = active[waiting[better]]
            coefficients[done] = trial[better]
            at.value[done] = new.value[better]
            at.score[done] = new.score[better]
            at.hessian[done] = new.hessian[better]
            waiting = waiting[~better]
            size[waiting] *= 0.5
            if waiting.size == 0:
                break
        largest = np.abs(coefficients[active]).max(axis=1)
        moved = np.abs(size[:, None] * step).max(axis=1) / largest
        flat = coefficients[active, 1] < _FLAT
        active = active[(moved > _SETTLED) & ~flat]
        if active.size == 0:
            break
    return _Fits(coefficients, -at.hessian, at.value)


def _first_coefficients(low: Floats, high: Floats, weights: Floats) -> Floats:
    """Coefficients from which Newton's method starts, -mean/spread and 1/spread, shape (batch, 2).

    Mean and spread are those of the middles of the intervals, or of the finite end of half-open ones.

    Parameters
    ----------
    low, high : ends of the intervals of ln capacity, infinite ones too, shape (tests,)
    weights : of each test in each sample of the bootstrap, shape (batch, tests)
    """
    finite_low, finite_high = np.isfinite(low), np.isfinite(high)
    middle = np.where(
        finite_low & finite_high, 0.5 * (low + high), np.where(finite_low, low, high)
    )
    total = weights.sum(axis=1)
    mean = weights @ middle / total
    spread = np.sqrt((weights * (middle - mean[:, None]) ** 2).sum(axis=1) / total)
    slope = 1.0 / np.maximum(spread, 0.05)
    return np.column_stack([-mean * slope, slope])


class _Likelihood(NamedTuple):
    """Log-likelihood, (batch,), its score, (batch, 2), and its Hessian, (batch, 2, 2)."""

    value: Floats
    score: Floats
    hessian: Floats


def _likelihood(
    low: Floats, high: Floats, weights: Floats, coefficients: Floats
) -> _Likelihood:
    """Log-likelihood of lognormal capacities with known bounds, and its derivatives, for each row of weights.

    Parameters
    ----------
    low, high : bounds of ln capacity, shape (n,)
    weights : of each capacity in each sample of the bootstrap, shape (batch, n)
    coefficients : intercept and slope of each sample, by which derivatives are taken, shape (batch, 2)
    """
    terms = _terms(low, high, coefficients)
    sums = _Terms._make((weights * term).sum(axis=1) for term in terms)
    hessian = np.stack([sums.h00, sums.h01, sums.h01, sums.h11], axis=1)
    return _Likelihood(
        sums.value,
        np.stack([sums.score0, sums.score1], axis=1),
        hessian.reshape(-1, 2, 2),
    )


class _Terms(NamedTuple):
    """Log-likelihood of each bracket and its derivatives in (intercept, slope), each of shape (batch, n)."""

    value: Floats
    # first derivatives in intercept and slope
    score0: Floats
    score1: Floats
    # second derivatives in (intercept, intercept), (intercept, slope) and (slope, slope)
    h00: Floats
    h01: Floats
    h11: Floats


def _terms(low: Floats, high: Floats, coefficients: Floats) -> _Terms:
    """Terms of the likelihood: of the density for equal bounds, else of the probability between them.

    ``low``, ``high``: logarithms of the bounds, shape (n,); ``coefficients``: shape (batch, 2).
    """
    exact = low == high
    of_density = _density_terms(low, coefficients)
    if exact.all():
        return of_density
    of_fraction = _fraction_terms(low, high, coefficients)
    both = zip(of_density, of_fraction, strict=True)
    return _Terms._make(
        np.where(exact, density, fraction) for density, fraction in both
    )


def _density_terms(low: Floats, coefficients: Floats) -> _Terms:
    """Terms of amplitudes known exactly, ln density at x = ln IM: ln c1 - (c0 + c1 x)²/2.

    It is of ln IM, so that narrow brackets rank models alike.
    """
    c0, c1 = coefficients[:, :1], coefficients[:, 1:]
    x = np.where(np.isfinite(low), low, 0.0)
    at = c0 + c1 * x
    ones = np.ones(at.shape)
    return _Terms(
        value=np.log(c1) - 0.5 * at**2 - _LOG_ROOT_TWO_PI,
        score0=-at,
        score1=-at * x + 1.0 / c1,
        h00=-ones,
        h01=-x * ones,
        h11=-(x**2) - 1.0 / c1**2,
    )


def _fraction_terms(low: Floats, high: Floats, coefficients: Floats) -> _Terms:
    """Terms of amplitudes between two bounds, ln(Φ(c0 + c1 x_high) - Φ(c0 + c1 x_low)); either may be infinite."""
    c0, c1 = coefficients[:, :1], coefficients[:, 1:]
    x_low = np.where(np.isfinite(low), low, 0.0)
    x_high = np.where(np.isfinite(high), high, 0.0)
    z_low = np.where(np.isneginf(low), -np.inf, c0 + c1 * x_low)
    z_high = np.where(np.isposinf(high), np.inf, c0 + c1 * x_high)
    log_fraction = _log_difference(z_low, z_high)
    # density at each bound over the probability, and that times the bound, whose derivatives these are
    ratio_low = np.exp(-0.5 * z_low**2 - _LOG_ROOT_TWO_PI - log_fraction)
    ratio_high = np.exp(-0.5 * z_high**2 - _LOG_ROOT_TWO_PI - log_fraction)
    bend_low = np.where(np.isinf(z_low), 0.0, z_low) * ratio_low
    bend_high = np.where(np.isinf(z_high), 0.0, z_high) * ratio_high
    score0 = ratio_high - ratio_low
    score1 = ratio_high * x_high - ratio_low * x_low
    return _Terms(
        value=log_fraction,
        score0=score0,
        score1=score1,
        h00=bend_low - bend_high - score0**2,
        h01=bend_low * x_low - bend_high * x_high - score0 * score1,
        h11=bend_low * x_low**2 - bend_high * x_high**2 - score1**2,
    )


def _log_difference(z_low: Floats, z_high: Floats) -> Floats:
    """Return ln(Φ(z_high) - Φ(z_low)) without loss of digits; 0 where the bounds are equal.

    ``z_low``, ``z_high``: bounds in standard deviations, of one shape, which is returned.
    """
    # above the middle in the other tail, where probabilities are small and keep their digits
    with np.errstate(invalid="ignore"):
        flip = z_low + z_high > 0
    lower, upper = np.where(flip, -z_high, z_low), np.where(flip, -z_low, z_high)
    log_upper, log_lower = special.log_ndtr(upper), special.log_ndtr(lower)
    same = lower == upper
    gap = np.where(
        same | np.isneginf(log_lower), -np.inf, log_lower - np.where(same, 0, log_upper)
    )
    return np.asarray(np.where(same, 0.0, log_upper + np.log1p(-np.exp(gap))))
