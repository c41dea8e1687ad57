"""What is said beside every fitted curve: whether it describes the data, and which motion moves it most."""

import re
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from statsmodels.stats.diagnostic import lilliefors

from rockfrag.fragility.censored import Brackets
from rockfrag.fragility.curve_facts import REJECTED
from rockfrag.fragility.fractions import Fractions, fractions_of_capacities, fractions_of_outcomes
from rockfrag.fragility.goodness import GoodnessOfFit, goodness_of_fit
from rockfrag.fragility.intervals import Interval
from rockfrag.fragility.lognormal import FragilityFit
from rockfrag.fragility.observations import Observations
from rockfrag.sentences import sayer

TAILS = (
    "The limits of β assume lognormal capacities: under heavier tails (t, 3 degrees of freedom), which the "
    "goodness of fit seldom shows, nominal 90 % limits contained the truth in 82 %."
)
"""Said of every curve with limits of β, whether or not its fit is rejected; see the validation."""

REJECTION = re.compile(r"The lognormal curve is rejected \(p = .*?\.(?= [A-Z]|$)")
"""Finds the sentence about a rejected curve among its warnings."""

FEWEST_MOTIONS = 10  # below so many motions every table and export says how few they are

_say = sayer(
    "rockfrag.fragility",
    "checks.j2",
    {"REJECTED": REJECTED, "TAILS": TAILS, "FEWEST_MOTIONS": FEWEST_MOTIONS},
)


@dataclass(frozen=True)
class Checks:
    """Goodness of fit, influence and the medians that need no curve."""

    # p value of the hypothesis that the curve describes the data [-]; NaN where it cannot be tested
    p_fit: float
    test: str  # how that was tested
    # observed less fitted fraction of overturned tests in the bin where they differ most [-]
    largest_residual: float
    influential: str  # motion (earthquake) without which θ changes most; empty where there is none
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

    ``dependence`` and ``seed`` are those of :func:`rockfrag.fragility.goodness.goodness_of_fit`.
    """
    p_fit, residual, test = float("nan"), float("nan"), "none"
    found = None
    if np.isfinite(fit.theta):
        found = goodness_of_fit(outcomes, fit, dependence=dependence, seed=seed)
        p_fit, test = found.p_value, f"deviance, parametric bootstrap of {found.dependence}"
        apart = (found.calibration["observed"] - found.calibration["predicted"]).to_numpy()
        residual = float(apart[np.abs(apart).argmax()])
    groups = outcomes.groups(interval.over)
    fractions = fractions_of_outcomes(outcomes, groups, interval.level)
    checks = _checks(fit, interval, groups, (p_fit, test, residual), fractions)
    return replace(checks, goodness=found)


def checks_of_brackets(brackets: Brackets, fit: FragilityFit, interval: Interval) -> Checks:
    """Judge a lognormal capacity fitted to brackets, by Lilliefors' test of the middles of ln amplitude."""
    lower, upper = brackets.lower, brackets.upper
    closed = np.isfinite(upper) & (lower > 0)
    middle = 0.5 * np.log(lower[closed] * upper[closed])
    p_fit, residual, test = float("nan"), float("nan"), "none: too few, or open brackets"
    if closed.all() and middle.size > 3 and np.ptp(middle) > 0 and np.isfinite(fit.theta):
        p_fit = float(lilliefors(middle, dist="norm")[1])
        test = "Lilliefors, middles of the brackets"
        fraction = (np.arange(middle.size) + 0.5) / middle.size
        apart = fraction - fit.probability(np.exp(np.sort(middle)))
        residual = float(apart[np.abs(apart).argmax()])
    # a motion that never overturned counts above all others
    middles = np.where(np.isfinite(upper), 0.5 * np.log(np.maximum(lower, 1e-300) * upper), np.inf)
    capacity = np.where(lower > 0, middles, -np.inf)
    groups = brackets.groups(interval.over)
    fractions = fractions_of_capacities(capacity, groups, interval.level)
    return _checks(fit, interval, groups, (p_fit, test, residual), fractions)


def _checks(
    fit: FragilityFit,
    interval: Interval,
    groups: NDArray[np.object_],
    judged: tuple[float, str, float],
    fractions: Fractions,
) -> Checks:
    p_fit, test, residual = judged
    notes = tuple(_say("notes", fit, interval, p_fit, fractions))
    name, influence = _influence(interval, groups)
    return Checks(p_fit, test, residual, name, influence, fractions, notes)


def _influence(interval: Interval, groups: NDArray[np.object_]) -> tuple[str, float]:
    """Group without which θ changes most, from the jackknife's refits, and by what factor."""
    names = pd.factorize(pd.Series(groups))[1]
    refits = interval.replicates
    if interval.method != "jackknife" or not len(refits) == len(names) == interval.groups:
        return "", float("nan")
    slope = np.where(refits[:, 1] > 0, refits[:, 1], np.nan)
    change = -refits[:, 0] / slope + interval.estimate[0] / interval.estimate[1]
    if not np.isfinite(change).any():
        return "", float("nan")
    most = int(np.nanargmax(np.abs(change)))
    return str(names[most]), float(np.exp(change[most]))
