"""Confidence intervals by resampling whole motions or earthquakes, never amplitudes of a motion.

In: observations, or a function that refits reweighted groups. Out: :class:`Interval`, limits of θ, β and the
curve. Theory: ``docs/fragility.md``, "Confidence limits".

The method is the delete-one-group jackknife with Student's t (Tukey, 1958, Ann. Math. Stat. 29: 614).
``docs/validation-fragility.md`` shows how often it covers the truth for few and many groups, and that a
bootstrap covers less often.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike, NDArray
from scipy import special

from rockfrag.base.errors import InputError
from rockfrag.base.short_repr import short_repr
from rockfrag.fragility.batch_glm import fit_batch, separated
from rockfrag.fragility.lognormal import LEAST_SLOPE, ROUNDING
from rockfrag.fragility.observations import (
    Floats,
    Grouped,
    Observations,
    Over,
    cells,
    counts,
)

FEWEST_GROUPS = 4  # fewest groups for which the jackknife's coverage was validated
MOST_BLOCKS = 100
"""More groups than this are left out in random blocks, which costs little and changes little."""

BETA_POWER = -0.1
"""Power of β that is jackknifed. With ln β limits held in 86 % where earthquakes dominate, see the validation."""

WeightedFit = Callable[[Floats], Floats]
"""Turns weights of the groups, shape (batch, groups), into (intercept, slope), shape (batch, 2)."""


@dataclass(frozen=True)
class Interval:
    """Confidence limits of θ, β and the whole curve.

    Attributes
    ----------
    theta, beta : lower and upper limit; infinite where the data set none, NaN where there is no interval
    level : two-sided confidence level, for example 0.90
    method : ``jackknife``; ``common step`` where all capacities lie in one step (:func:`step_limits`); or ``none``
    groups, over : number of independent groups that were resampled, and what one is: ``motion`` or ``earthquake``
    estimate, replicates
        Intercept and slope of the fit that the interval belongs to, and without each group (or block of groups),
        shape (replicates, 2).
    warnings : sentences about the limits
    """

    theta: tuple[float, float]
    beta: tuple[float, float]
    level: float
    method: str
    groups: int
    over: Over
    estimate: tuple[float, float]
    replicates: Floats
    warnings: tuple[str, ...] = ()

    __repr__ = short_repr

    def band(self, im: ArrayLike) -> tuple[Floats, Floats]:
        """Pointwise limits of P(overturn | IM) at each ``im`` > 0, two arrays of shape (n,)."""
        x = np.log(np.atleast_1d(np.asarray(im, dtype=np.float64)))
        if not len(self.replicates):
            return np.full(x.shape, np.nan), np.full(x.shape, np.nan)
        predictors = self.replicates[:, :1] + self.replicates[:, 1:] * x
        centre = self.estimate[0] + self.estimate[1] * x
        half = half_width(predictors, self.level)
        return special.ndtr(centre - half), special.ndtr(centre + half)


def choose_groups(tests: Grouped, over: Over | None) -> tuple[Over, tuple[str, ...]]:
    """Choose whether motions or earthquakes are left out, one at a time, to see how far estimates vary.

    Parameters
    ----------
    tests : with their motions and earthquakes
    over : what the user asks for; None: earthquakes, where some have several motions

    Returns
    -------
    ``motion`` or ``earthquake``, and warnings: that motions which share an earthquake vary too little.
    """
    motions, earthquakes = tests.n_motions, tests.n_earthquakes
    if over is None:
        over = "earthquake" if earthquakes < motions else "motion"
    if over == "motion" and earthquakes < motions:
        return over, (
            f"The {motions} motions come from {earthquakes} earthquakes: limits over motions hold for other "
            "motions of these earthquakes only, and were too narrow for other earthquakes in the validation.",
        )
    return over, ()


def outcome_fitter(outcomes: Observations, over: Over) -> tuple[WeightedFit, int]:
    """Make the function that refits a curve to reweighted groups of tests.

    Tests at the same or nearly the same value are pooled. Separated replicates are fitted with the penalised
    likelihood, as the estimator itself would; those in which all tests agree give an intercept of -∞ (all survive)
    or +∞ (all overturn) and a slope of NaN.
    """
    codes = pd.factorize(pd.Series(outcomes.groups(over)))[0]
    column, values = cells(outcomes.log_im)
    fell = counts(codes, column, outcomes.overturned)
    total = counts(codes, column, outcomes.trials)
    design = np.column_stack([np.ones(values.size), values])
    one_level = np.ptp(values) < ROUNDING

    whole = fit_batch(
        design, fell.sum(axis=0)[None], total.sum(axis=0)[None], penalised=True
    )
    start = whole.coefficients[0] if np.isfinite(whole.coefficients).all() else None

    def fit(weights: Floats) -> Floats:
        """Coefficients for weights of the groups, shape (batch, groups); penalised where outcomes separate."""
        weights = outcomes.group_weights(weights)
        y, m = weights @ fell, weights @ total
        apart = separated(values, y, m)
        result = np.empty((len(weights), 2))
        for chosen, penalised in ((apart, True), (~apart, False)):
            if chosen.any():
                batch = fit_batch(
                    design, y[chosen], m[chosen], penalised=penalised, start=start
                )
                result[chosen] = batch.coefficients
        if one_level:
            result[:] = np.nan  # no curve
        result[y.sum(axis=1) == 0, 0] = -np.inf
        result[y.sum(axis=1) == m.sum(axis=1), 0] = np.inf
        return result

    return fit, outcomes.n_motions if over == "motion" else outcomes.n_earthquakes


def interval_over_motions(
    outcomes: Observations, *, over: Over | None = None, level: float = 0.90
) -> Interval:
    """Confidence limits of a curve fitted to outcomes, by leaving out whole motions or earthquakes.

    Parameters
    ----------
    outcomes, over, level : the tests, and the level of the limits [-]
        Over ``motion`` they answer for other motions of the same earthquakes, over ``earthquake`` for other
        earthquakes; None takes earthquakes where they are known and some have several motions.

    Returns
    -------
    The :class:`Interval`, with limits of median and dispersion.
    """
    over, notes = choose_groups(outcomes, over)
    fit, groups = outcome_fitter(outcomes, over)
    found = resampled_interval(fit, groups, over=over, notes=notes, level=level)
    apart = separated(
        outcomes.log_im, outcomes.overturned[None], outcomes.trials[None]
    )[0]
    if not apart:
        return found
    if found.method == "none" and groups > 1 and 0 < outcomes.n_overturned < outcomes.n:
        survived = outcomes.im[outcomes.overturned < outcomes.trials].max()
        fell = outcomes.im[outcomes.overturned > 0].min()
        return step_limits(found, float(survived), float(fell))
    # separated tests allow any small β, whatever the penalised refits say
    return (
        replace(found, beta=(0.0, found.beta[1])) if found.method != "none" else found
    )


def step_limits(nothing: Interval, lower: float, upper: float) -> Interval:
    """Limits where the capacities of all groups lie in one step or two that touch: no scatter is seen.

    The median of k capacities lies between two finite ends of steps unless all are on one side of it, whose
    probability is 2^(1-k). β is at most that at which k capacities still fall between them as rarely as the level
    allows.

    Parameters
    ----------
    nothing : interval without limits of the same tests
    lower, upper : ends of the steps in the unit of the measure

    Returns
    -------
    The interval with these limits, or as it was where the ends are not finite or there is no curve.
    """
    if not 0 < lower < upper < np.inf or nothing.estimate[1] < LEAST_SLOPE:
        return nothing
    # probability of one capacity between the ends, centred about the median, with which all k are there as rarely
    fraction = (1.0 - nothing.level) ** (1.0 / nothing.groups)
    beta = np.log(upper / lower) / (2.0 * float(special.ndtri(0.5 + 0.5 * fraction)))
    beta = max(beta, 1.0 / nothing.estimate[1])
    sure = 1.0 - 2.0 ** (1 - nothing.groups)
    note = (
        f"All {nothing.groups} {nothing.over}s overturn in one step of the amplitude or in two that touch: "
        f"θ lies within them (with {100 * sure:.0f} % confidence), and β below {beta:.3f} is not resolved."
    )
    return replace(
        nothing,
        theta=(lower, upper),
        beta=(0.0, float(beta)),
        method="common step",
        warnings=(*nothing.warnings[:-1], note),
    )


def resampled_interval(
    fit: WeightedFit,
    groups: int,
    *,
    over: Over = "motion",
    notes: tuple[str, ...] = (),
    level: float = 0.90,
) -> Interval:
    """Confidence limits of θ and β from a function that refits reweighted groups.

    Parameters
    ----------
    fit, groups : the function, see :func:`outcome_fitter`, and the number of groups
    over, notes, level : kind of a group, warnings to begin with, and the two-sided level [-]

    Returns
    -------
    The :class:`Interval`.
    """
    if not 0.0 < level < 1.0:
        raise InputError(
            f"level: a confidence level lies between 0 and 1, got {level:g}."
        )
    estimate = fit(np.ones((1, groups)))[0]
    centre = (float(estimate[0]), float(estimate[1]))

    def without_limits(reason: str) -> Interval:
        """An interval without limits, and why."""
        nan = (float("nan"), float("nan"))
        said = (*notes, reason)
        return Interval(
            nan, nan, level, "none", groups, over, centre, np.empty((0, 2)), said
        )

    if groups < 2:
        return without_limits(f"One {over} gives no interval for other {over}s.")
    if not np.isfinite(centre).all() or centre[1] < LEAST_SLOPE:
        return without_limits("There is no curve, so there is no interval.")
    if groups < FEWEST_GROUPS:
        few = (
            f"With {groups} {over}s the coverage of the interval was not validated "
            f"({FEWEST_GROUPS} are the fewest that were)."
        )
        notes = (*notes, few)
    deleted = fit(all_but_one(groups))
    if np.ptp(deleted, axis=0).max() < 1e-9:
        return without_limits(
            f"All {over}s agree within the steps of the amplitude, which gives no limits."
        )
    with np.errstate(divide="ignore", invalid="ignore"):
        betas = 1.0 / deleted[:, 1]
        # a curve that does not rise has no median, and then nothing limits that of all
        log_thetas = np.where(betas > 0, -deleted[:, 0] / deleted[:, 1], np.nan)
    log_theta, half = -centre[0] / centre[1], half_width(log_thetas, level)
    theta = float(np.exp(log_theta - half)), float(np.exp(log_theta + half))
    own = 1.0 / centre[1]
    low, high = beta_limits(own, betas, level, unbiased=True)
    # stretched to hold the estimate, to more digits than two ways of fitting agree to
    beta = min(low, own * (1 - 1e-9)), max(high, own * (1 + 1e-9))
    return Interval(
        theta, beta, level, "jackknife", groups, over, centre, deleted, notes
    )


def all_but_one(groups: int) -> Floats:
    """Weights that leave one group out in turn, or one of ``MOST_BLOCKS`` blocks of many groups.

    Parameters
    ----------
    groups : number of groups

    Returns
    -------
    Weights of 0 and 1, shape (replicates, groups).
    """
    block = blocks_of(groups)
    return np.asarray(
        block != np.arange(min(groups, MOST_BLOCKS))[:, None], dtype=np.float64
    )


def blocks_of(groups: int) -> NDArray[np.intp]:
    """Block of each group, shape (groups,): itself, or one of ``MOST_BLOCKS`` of many groups."""
    if groups <= MOST_BLOCKS:
        return np.arange(groups)
    return np.asarray(np.random.default_rng(0).permutation(groups) % MOST_BLOCKS)


def jackknife_error(left_out: Floats) -> Floats:
    """Standard error from delete-one-group values along the first axis (Tukey 1958).

    Parameters
    ----------
    left_out : values without each group, shape (groups, …)

    Returns
    -------
    The standard error in the unit of the values, shape (…).
    """
    groups = len(left_out)
    # an infinite value makes the error NaN, which the caller turns into limits without an end
    with np.errstate(invalid="ignore"):
        offset = left_out - left_out.mean(axis=0)
    return np.asarray(np.sqrt((groups - 1) / groups * np.sum(offset**2, axis=0)))


def half_width(left_out: Floats, level: float) -> Floats:
    """Half the interval of Student's t from delete-one-group values; infinite without end.

    Parameters
    ----------
    left_out, level : values without each group, shape (groups, …), and the two-sided level [-]

    Returns
    -------
    Half the width, in the unit of the values, shape (…).
    """
    half = special.stdtrit(len(left_out) - 1, 0.5 + 0.5 * level) * jackknife_error(
        left_out
    )
    return np.where(np.isfinite(half), half, np.inf)


def beta_limits(
    beta: float, left_out: Floats, level: float, *, unbiased: bool = False
) -> tuple[float, float]:
    """Limits of a dispersion from its values without each group, in a power of it.

    β of few groups has a long lower tail, also in its logarithm; this power of it has less of one.

    Parameters
    ----------
    beta, left_out : dispersion of all groups and without each, shape (groups,) [-]
    level : two-sided confidence level [-]
    unbiased : whether the first-order bias of β is taken out, which few groups make too small

    Returns
    -------
    Lower and upper limit; 0 and infinite where the groups set none.
    """
    groups = len(left_out)
    with np.errstate(divide="ignore", invalid="ignore"):
        powers = left_out**BETA_POWER
    # of two groups each alone has no scatter, so two say nothing about β; nor do those without which
    # there is no curve
    if groups < 3 or not (
        beta > 0 and np.isfinite(powers).all() and (powers > 0).all()
    ):
        return 0.0, np.inf
    half, centre = float(half_width(powers, level)), float(beta**BETA_POWER)
    if unbiased:
        centre = groups * centre - (groups - 1) * float(powers.mean())
    if not centre + half > 0:
        return 0.0, np.inf
    # the power is negative: its upper end is the lower limit
    upper = (centre - half) ** (1 / BETA_POWER) if centre > half else np.inf
    return float((centre + half) ** (1 / BETA_POWER)), float(upper)
