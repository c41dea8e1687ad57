"""Checks of every fitted curve: whether it describes its data, and which motion moves it most.

In: the observations or brackets, the curve fitted to them, and its interval. Out: :class:`Checks`, with the p
value of the goodness of fit [-], the most influential group and the non-parametric fragility function.

Theory: ``docs/fragility.md``, "Does the curve describe the data?": the parametric bootstrap of the binomial
deviance in bins for outcomes, Lilliefors (1967, J. Am. Stat. Assoc. 62: 399-402) for brackets.
"""

from dataclasses import dataclass
from typing import Literal

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from scipy import special

from rockfrag.base.errors import InputError
from rockfrag.base.short_repr import short_repr
from rockfrag.fragility.batch_glm import Link, fit_batch
from rockfrag.fragility.censored import Brackets
from rockfrag.fragility.check_notes import check_notes, goodness_text
from rockfrag.fragility.curve_facts import REJECTED
from rockfrag.fragility.empirical import wilson_interval
from rockfrag.fragility.fractions import (
    Fractions,
    fractions_of_capacities,
    fractions_of_outcomes,
)
from rockfrag.fragility.intervals import Interval
from rockfrag.fragility.lognormal import FragilityFit
from rockfrag.fragility.observations import Floats, Observations, cells

# bins of about equal numbers of tests in which observed and fitted numbers are compared
BINS = 10
CELLS = 60
"""Cells of the measure in which simulated outcomes are refitted; finer ones move p values by one replicate."""


@dataclass(frozen=True)
class GoodnessOfFit:
    """How well a curve describes the outcomes it was fitted to."""

    deviance: float  # binomial deviance of bins of the measure against the curve
    # fraction of data sets simulated from the curve (and refitted) whose deviance is at least as large
    p_value: float
    dependence: str  # what was simulated, see :func:`goodness_of_fit`
    brier: float  # mean squared difference of outcome and fitted probability
    # one row per bin: ``im``, ``tests``, ``predicted`` (mean fitted probability), ``observed``,
    # ``observed_lower``, ``observed_upper`` (90 % binomial limits)
    calibration: pd.DataFrame
    words: str  # the finding, a sentence

    __repr__ = short_repr


def goodness_of_fit(
    outcomes: Observations,
    fit: FragilityFit,
    *,
    dependence: Literal["tests", "motions"] | None = None,
    replicates: int = 200,
    seed: int = 0,
) -> GoodnessOfFit:
    """Compare the deviance with that of data simulated from the curve (parametric bootstrap).

    Parameters
    ----------
    outcomes, fit : the tests, and the curve fitted to them
    dependence
        ``tests`` simulates each outcome by itself; ``motions`` gives each motion one capacity from the curve, so
        that its outcomes hang together as in an incremental dynamic analysis. None takes ``motions`` where motions
        have more than one row.
    replicates, seed : number of simulated data sets, and where their random numbers start

    Returns
    -------
    The :class:`GoodnessOfFit`.
    """
    if not np.isfinite(fit.theta):
        raise InputError(f"goodness of fit: there is no curve to judge ({fit.method}).")
    if dependence is None:
        dependence = "motions" if outcomes.is_swept else "tests"
    code = cells(outcomes.im, BINS, outcomes.trials)[0]
    probability = fit.probability(outcomes.im)

    def by_bin(values: Floats) -> Floats:
        """Sums of values of the tests by bin."""
        return np.asarray(np.bincount(code, values))

    trials = by_bin(outcomes.trials)
    expected = by_bin(outcomes.trials * probability)
    observed = by_bin(outcomes.overturned)
    deviance = float(binned_deviance(observed, expected, trials))
    cell, log_im, home = _cells_within(code, outcomes.log_im)
    drawn = _drawn_outcomes(
        outcomes,
        fit,
        cell,
        replicates=replicates,
        rng=np.random.default_rng(seed),
        dependence=dependence,
    )
    simulated = refitted_deviance(
        np.column_stack([np.ones(log_im.size), log_im]),
        drawn,
        np.asarray(np.bincount(cell, outcomes.trials), dtype=np.float64),
        home,
        link=fit.link,
        start=np.array(fit.coefficients),
    )
    p_value = float((1 + np.sum(simulated >= deviance - 1e-9)) / (1 + simulated.size))
    im = np.exp(by_bin(outcomes.trials * outcomes.log_im) / trials)
    calibration = _calibration(im, trials, expected, observed)
    brier = _brier_score(outcomes, probability)
    words = goodness_text(deviance, len(calibration), p_value, dependence)
    return GoodnessOfFit(deviance, p_value, dependence, brier, calibration, words)


def _calibration(
    im: Floats, trials: Floats, expected: Floats, observed: Floats
) -> pd.DataFrame:
    """Table of ``GoodnessOfFit.calibration``: predicted and observed fraction of each bin, with limits.

    ``im``: mean of the measure; ``trials``: tests; ``expected``, ``observed``: numbers that overturn; shape
    (bins,) each.
    """
    lower, upper = wilson_interval(observed, trials)
    return pd.DataFrame(
        {
            "im": im,
            "tests": trials.astype(np.int64),
            "predicted": expected / trials,
            "observed": observed / trials,
            "observed_lower": lower,
            "observed_upper": upper,
        }
    ).sort_values("im", ignore_index=True)


def _brier_score(outcomes: Observations, probability: Floats) -> float:
    """Mean over tests of the squared difference between outcome, 0 or 1, and probability, shape (rows,)."""
    miss = outcomes.overturned * (1 - probability) ** 2
    miss += (outcomes.trials - outcomes.overturned) * probability**2
    return float(miss.sum() / outcomes.n)


_BETWEEN_BINS = 1e3
"""Distance of bins in ln IM that keeps their values apart."""


def _cells_within(
    code: NDArray[np.intp], log_im: Floats
) -> tuple[NDArray[np.intp], Floats, NDArray[np.intp]]:
    """Cells that tests are simulated and refitted by, however many there are; none reaches over the end of a bin.

    Parameters
    ----------
    code, log_im : bin and ln IM of each test, shape (tests,)

    Returns
    -------
    Cell of each test, shape (tests,); ln IM and bin of each cell, shape (cells,).
    """
    shifted = log_im + code * _BETWEEN_BINS
    cell, values = cells(shifted, CELLS)
    apart = np.unique(code * values.size + cell, return_inverse=True)[1]
    if apart.max() >= values.size:
        # a cell reached over the end of a bin
        cell, values = apart, np.bincount(apart, shifted) / np.bincount(apart)
    home = np.asarray(np.rint(values / _BETWEEN_BINS), dtype=np.intp)
    return cell, values - _BETWEEN_BINS * home, home


def _drawn_outcomes(
    outcomes: Observations,
    fit: FragilityFit,
    cell: NDArray[np.intp],
    *,
    replicates: int,
    rng: np.random.Generator,
    dependence: str,
) -> Floats:
    """Numbers that overturn in each cell when the fit is true, shape (replicates, cells).

    Parameters
    ----------
    outcomes, fit : tests and their curve
    cell : number of each test's cell, shape (rows,)
    replicates, rng : number of simulated data sets, and where random numbers come from
    dependence : as in :func:`goodness_of_fit`
    """
    if dependence == "motions":
        law = rng.normal if fit.link == "probit" else rng.logistic
        draw = law(size=(replicates, outcomes.n_motions))
        return outcomes.drawn(np.log(fit.theta) + fit.beta * draw, cell)
    tests = np.asarray(np.bincount(cell, outcomes.trials), dtype=np.float64)
    expected = outcomes.trials * fit.probability(outcomes.im)
    fraction = np.bincount(cell, expected) / tests
    drawn = rng.binomial(
        tests.astype(np.int64),
        np.minimum(fraction, 1.0),
        size=(replicates, fraction.size),
    )
    return drawn.astype(np.float64)


def binned_deviance(observed: Floats, expected: Floats, trials: Floats) -> Floats:
    """Binomial deviance of numbers of overturned tests in bins against expected ones.

    Parameters
    ----------
    observed, expected : numbers of overturned tests, observed and by the curve, shape (…, bins)
    trials : numbers of tests, shape (bins,)

    Returns
    -------
    The deviance [-], shape (…).
    """
    survived = trials - observed
    # a bin that the curve calls impossible may not lie there by rounding alone
    expected = np.clip(expected, 1e-12 * trials, (1 - 1e-12) * trials)
    terms = special.xlogy(observed, observed / expected)
    terms = terms + special.xlogy(survived, survived / (trials - expected))
    return np.asarray(2.0 * terms.sum(axis=-1))


def refitted_deviance(
    design: Floats,
    drawn: Floats,
    trials: Floats,
    bins: NDArray[np.intp],
    *,
    link: Link = "probit",
    start: Floats | None = None,
) -> Floats:
    """Deviance in bins of simulated numbers of overturned tests, from curves fitted to them anew.

    Parameters
    ----------
    design : predictors with ones, shape (rows, k)
    drawn : numbers of overturned tests, shape (replicates, rows)
    trials, bins : number of tests and bin of each row, shape (rows,)
    link, start : of the regression, and coefficients to start from, shape (k,)

    Returns
    -------
    The deviance of each replicate that has a curve [-], shape (replicates,) or shorter.
    """
    # the penalty keeps separated data sets finite and hardly moves the others
    batch = fit_batch(
        design,
        drawn,
        np.broadcast_to(trials, drawn.shape),
        link=link,
        penalised=True,
        tolerance=1e-4,
        start=start,
    )
    usable = np.isfinite(batch.coefficients).all(axis=1)
    eta = batch.coefficients[usable] @ design.T
    probability = special.ndtr(eta) if link == "probit" else special.expit(eta)
    member = (bins[:, None] == np.arange(bins.max() + 1)).astype(np.float64)
    return binned_deviance(
        drawn[usable] @ member, (trials * probability) @ member, trials @ member
    )


@dataclass(frozen=True)
class Checks:
    """Goodness of fit, influence and the medians that need no curve."""

    # p value of the hypothesis that the curve describes the data [-]; NaN where it cannot be tested
    p_fit: float
    test: str  # how that was tested
    # observed less fitted fraction of overturned tests in the bin where they differ most [-]
    largest_residual: float
    # motion (earthquake) without which θ changes most; empty where there is none
    influential: str
    influence: float  # θ without it over θ [-]
    # the non-parametric fragility function, to use where the fitted one is rejected
    fractions: Fractions
    warnings: tuple[str, ...]  # sentences
    # the test of a curve fitted to outcomes in full; None without such a curve
    goodness: GoodnessOfFit | None = None

    @property
    def rejected(self) -> bool:
        """Whether the fitted curve does not describe its data."""
        return self.p_fit < REJECTED


def checks_of_outcomes(
    outcomes: Observations,
    fit: FragilityFit,
    interval: Interval,
    dependence: Literal["tests", "motions"] | None = None,
    seed: int = 0,
) -> Checks:
    """Judge a curve fitted to outcomes.

    Parameters
    ----------
    outcomes, fit, interval : the tests, the curve fitted to them, and its limits
    dependence, seed : of :func:`goodness_of_fit`

    Returns
    -------
    The :class:`Checks`.
    """
    p_fit, residual = float("nan"), float("nan")
    test, goodness = "none", None
    if np.isfinite(fit.theta):
        goodness = goodness_of_fit(outcomes, fit, dependence=dependence, seed=seed)
        p_fit = goodness.p_value
        test = f"deviance, parametric bootstrap of {goodness.dependence}"
        bins = goodness.calibration
        residual = _largest((bins["observed"] - bins["predicted"]).to_numpy())
    groups = outcomes.groups(interval.over)
    fractions = fractions_of_outcomes(outcomes, groups, interval.level)
    notes = check_notes(fit, interval, p_fit, fractions)
    name, factor = most_influential(interval, groups)
    return Checks(p_fit, test, residual, name, factor, fractions, notes, goodness)


def checks_of_brackets(
    brackets: Brackets, fit: FragilityFit, interval: Interval
) -> Checks:
    """Judge a lognormal capacity fitted to brackets, by Lilliefors' test of the middles of ln amplitude.

    Parameters
    ----------
    brackets, fit, interval : bounds of n amplitudes, the curve fitted to them, and its limits

    Returns
    -------
    The :class:`Checks`; without a test where brackets are open or too few.
    """
    lower, upper = brackets.lower, brackets.upper
    closed = np.isfinite(upper) & (lower > 0)
    middle = 0.5 * np.log(lower[closed] * upper[closed])
    p_fit, residual = float("nan"), float("nan")
    test = "none: too few, or open brackets"
    testable = closed.all() and middle.size > 3 and np.ptp(middle) > 0
    if testable and np.isfinite(fit.theta):
        from statsmodels.stats.diagnostic import lilliefors

        p_fit = float(lilliefors(middle, dist="norm")[1])
        test = "Lilliefors, middles of the brackets"
        fraction = (np.arange(middle.size) + 0.5) / middle.size
        residual = _largest(fraction - fit.probability(np.exp(np.sort(middle))))
    # a motion that never overturned counts above all others, one that did at once below
    capacity = np.where(np.isfinite(upper), -np.inf, np.inf)
    capacity[closed] = middle
    groups = brackets.groups(interval.over)
    fractions = fractions_of_capacities(capacity, groups, interval.level)
    notes = check_notes(fit, interval, p_fit, fractions)
    name, factor = most_influential(interval, groups)
    return Checks(p_fit, test, residual, name, factor, fractions, notes)


def _largest(residuals: Floats) -> float:
    """Residual of the largest size, with its sign."""
    return float(residuals[np.abs(residuals).argmax()])


def most_influential(
    interval: Interval, groups: NDArray[np.object_]
) -> tuple[str, float]:
    """Name of the group without which θ changes most, and θ without it over θ; empty and NaN without a jackknife.

    Parameters
    ----------
    interval : of the curve, with its coefficients without each group
    groups : label of each test's group, shape (tests,)
    """
    names = pd.factorize(pd.Series(groups))[1]
    refits = interval.replicates
    if (
        interval.method != "jackknife"
        or not len(refits) == len(names) == interval.groups
    ):
        return "", float("nan")
    slope = np.where(refits[:, 1] > 0, refits[:, 1], np.nan)
    change = -refits[:, 0] / slope + interval.estimate[0] / interval.estimate[1]
    if not np.isfinite(change).any():
        return "", float("nan")
    most = int(np.nanargmax(np.abs(change)))
    return str(names[most]), float(np.exp(change[most]))
