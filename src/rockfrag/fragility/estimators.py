"""Fragility from the data that the field knows: clouds, stripes, IDA curves, step protocols.

In: tables of tests or of incremental dynamic analyses (IDA), a row a test. Out: :class:`Fragility`, a fitted curve
with its confidence limits and checks; of IDA curves one for each definition of overturning intensity.

Theory: ``docs/fragility.md``, "Estimators" and "Confidence limits".
"""

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
import pandas as pd
from scipy import special

from rockfrag.base.keywords import named_keywords
from rockfrag.base.short_repr import short_repr
from rockfrag.fragility import censored, observations
from rockfrag.fragility.checks import Checks, checks_of_brackets, checks_of_outcomes
from rockfrag.fragility.empirical import TableIda
from rockfrag.fragility.intervals import Interval, interval_over_motions
from rockfrag.fragility.lognormal import FragilityFit, fit_lognormal


@dataclass(frozen=True)
class Fragility:
    """A fitted curve with its confidence limits and checks.

    Attributes
    ----------
    fit, interval, checks : the curve, its limits, and goodness of fit and influence of single motions
    """

    fit: FragilityFit
    interval: Interval
    checks: Checks

    __repr__ = short_repr

    @property
    def warnings(self) -> tuple[str, ...]:
        """Sentences of the fit, of the limits and of the checks."""
        return (*self.fit.warnings, *self.interval.warnings, *self.checks.warnings)

    @property
    def beta_statistical(self) -> float:
        """Standard deviation of ln θ that the limits of θ stand for [-]; NaN without limits."""
        lower, upper = self.interval.theta
        if not 0 < lower < upper < np.inf:
            return float("nan")
        half = float(special.ndtri(0.5 + 0.5 * self.interval.level))
        return float(np.log(upper / lower) / (2.0 * half))


@dataclass(frozen=True)
class IncrementalFragility:
    """Three definitions of overturning intensity, of the same analyses; resurrections make them differ.

    Attributes
    ----------
    first, always : first overturning amplitude of each motion, and that above which each always overturns
    probability : mean P(overturn | amplitude) over the motions, structural resurrections included
    resurrections, fraction_with_resurrections
        Table of :func:`rockfrag.fragility.empirical.find_resurrections`; fraction of the motions that overturned
        and have at least one window.
    """

    first: Fragility
    always: Fragility
    probability: Fragility
    resurrections: pd.DataFrame
    fraction_with_resurrections: float

    __repr__ = short_repr


def fragility_of(
    outcomes: observations.Observations,
    *,
    level: float = 0.90,
    seed: int = 0,
    dependence: Literal["tests", "motions"] | None = None,
) -> Fragility:
    """Fit a curve to outcomes and give it limits over motions, or earthquakes where they are known.

    Parameters
    ----------
    outcomes, level : the tests, and the level of the limits [-]
    seed, dependence : of the simulated goodness of fit, see :func:`rockfrag.fragility.checks.goodness_of_fit`

    Returns
    -------
    The :class:`Fragility`.
    """
    fit = fit_lognormal(outcomes)
    limits = interval_over_motions(outcomes, level=level)
    return Fragility(
        fit, limits, checks_of_outcomes(outcomes, fit, limits, dependence, seed)
    )


@named_keywords
def fit_cloud(
    table: pd.DataFrame,
    im: str,
    *,
    overturned: str = "overturned",
    motion: str | None = "motion",
    earthquake: str | None = None,
    level: float = 0.90,
) -> Fragility:
    """Fit a curve to single tests at scattered values of the measure (cloud analysis).

    Parameters
    ----------
    table, im, overturned : one row a test; its columns of the intensity measure and of the outcome
    motion, earthquake : columns of their names; None where tests have none
    level : of the confidence limits [-], 0 to 1

    Returns
    -------
    The :class:`Fragility`.
    """
    outcomes = observations.observations_from_table(
        table, im, overturned=overturned, motion=motion, earthquake=earthquake
    )
    return fragility_of(outcomes, level=level)


@named_keywords
def fit_stripes(
    table: pd.DataFrame,
    im: str,
    *,
    overturned: str = "overturned",
    trials: str | None = None,
    motion: str | None = "motion",
    earthquake: str | None = None,
    level: float = 0.90,
) -> Fragility:
    """Fit a curve to counts at a few levels of the measure (multiple stripe analysis).

    The curve maximises the product of the binomial likelihoods of the stripes (Baker, 2015, Earthquake Spectra 31:
    579-599, eq. 11); single tests are pooled by level for it, and the limits resample motions.

    Parameters
    ----------
    table, im, overturned, trials, motion, earthquake, level
        As of :func:`fit_cloud`; column with the number of tests in a row, None where a row is one test.

    Returns
    -------
    The :class:`Fragility`.
    """
    outcomes = observations.observations_from_table(
        table,
        im,
        overturned=overturned,
        trials=trials,
        motion=motion,
        earthquake=earthquake,
    )
    whole = fragility_of(outcomes, level=level)
    if trials is not None:
        return whole
    values, stripe = np.unique(outcomes.im, return_inverse=True)
    fit = fit_lognormal(outcomes.pooled(stripe, values))
    # levels are pooled, not motions
    fit = replace(fit, n_motions=outcomes.n_motions, of_motions=outcomes.of_motions)
    return replace(whole, fit=fit)


@named_keywords
def fit_incremental(
    ida: pd.DataFrame | TableIda,
    *,
    amplitude: str = "amplitude_g",
    motion: str = "motion",
    earthquake: str | None = None,
    level: float = 0.90,
) -> IncrementalFragility:
    """Fit first overturning, always overturning, and mean probability to incremental dynamic analyses.

    Parameters
    ----------
    ida : one row per motion and amplitude, with ``overturned``; or the IDA curves in another form. One body.
    amplitude, motion, earthquake, level : names of the columns, and the level of the confidence limits [-], 0 to 1

    Returns
    -------
    The :class:`IncrementalFragility`.
    """
    data = TableIda(ida, earthquake, motion) if isinstance(ida, pd.DataFrame) else ida
    resurrections = data.resurrections(amplitude)
    first = fragility_of_brackets(
        data.brackets(resurrections, "first", amplitude), level
    )
    always = fragility_of_brackets(
        data.brackets(resurrections, "always", amplitude), level
    )
    fell = resurrections["first_upper"].notna()
    fraction = float("nan")
    if fell.any():
        fraction = float((resurrections.loc[fell, "resurrections"] > 0).mean())
    probability = fragility_of(data.outcomes(amplitude), level=level)
    return IncrementalFragility(first, always, probability, resurrections, fraction)


def fit_step_tests(
    tests: pd.DataFrame,
    *,
    lower: str = "lower_g",
    upper: str = "upper_g",
    motion: str | None = "motion",
    earthquake: str | None = "earthquake",
    level: float = 0.90,
) -> Fragility:
    """Fit a curve to tests of a step protocol, one row per test, interval- or right-censored.

    Parameters
    ----------
    tests, lower, upper
        One row a test; its columns of the largest amplitude survived and of the one that overturned.
    motion, earthquake, level : as of :func:`fit_cloud`

    Returns
    -------
    The :class:`Fragility`.
    """
    brackets = censored.brackets_from_table(
        tests, lower=lower, upper=upper, motion=motion, earthquake=earthquake
    )
    return fragility_of_brackets(brackets, level)


def fragility_of_brackets(brackets: censored.Brackets, level: float) -> Fragility:
    """Fit a curve to bracketed amplitudes and give it limits over motions, or earthquakes where known.

    Parameters
    ----------
    brackets, level : bounds of n amplitudes, and the level of the limits [-]

    Returns
    -------
    The :class:`Fragility`.
    """
    fit = censored.fit_brackets(brackets)
    interval = censored.bracket_interval(brackets, level=level)
    return Fragility(fit, interval, checks_of_brackets(brackets, fit, interval))


def fit_uplift(motions: pd.DataFrame, im: str, *, level: float = 0.90) -> Fragility:
    """Curve of P(rock | IM) from motions scaled to the peak acceleration at which rocking starts.

    That peak is exact, so each motion gives its measure at uplift exactly; in the peak acceleration itself the
    curve is a step, given as a β of next to nothing.

    Parameters
    ----------
    motions : a row a motion, with ``motion``, ``earthquake`` and the measure at that scale
    im, level : column of the measure, and the level of the limits [-]

    Returns
    -------
    The :class:`Fragility`, θ in the unit of the measure.
    """
    at = motions.assign(upper=motions[im])
    brackets = censored.brackets_from_table(
        at, lower=im, upper="upper", earthquake="earthquake", measure=im
    )
    return fragility_of_brackets(brackets, level)
