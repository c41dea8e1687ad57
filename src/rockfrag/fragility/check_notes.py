"""Goodness of fit of a curve in sentences: whether it describes its data, and what to use where it does not.

In: the fitted curve, its interval, the p value of its goodness of fit and the non-parametric fragility function.
Out: sentences, which stand in ``Checks.warnings``, in the column ``warnings`` of the tables and in the exports.

Theory: ``docs/fragility.md``, "Does the curve describe the data?".
"""

import math
import re

from rockfrag.fragility.curve_facts import REJECTED
from rockfrag.fragility.fractions import Fractions, Limits
from rockfrag.fragility.intervals import Interval
from rockfrag.fragility.lognormal import FragilityFit

TAILS = (
    "The limits of β assume lognormal capacities: under heavier tails (t, 3 degrees of freedom), which the "
    "goodness of fit seldom shows, nominal 90 % limits contained the truth in 82 %."
)
"""Stands beside every curve with limits of β, whether or not its fit is rejected; see the validation."""

REJECTION = re.compile(r"The lognormal curve is rejected \(p = .*?\.(?= [A-Z]|$)")
"""Finds the sentence about a rejected curve among its warnings."""

# below so many motions every table and export says how few they are
FEWEST_MOTIONS = 10


def goodness_text(deviance: float, bins: int, p: float, dependence: str) -> str:
    """Sentence on a goodness of fit.

    Parameters
    ----------
    deviance, bins : binomial deviance of so many bins [-]
    p : p value of the parametric bootstrap [-]
    dependence : what was simulated, ``tests`` or ``motions``

    Returns
    -------
    The sentence.
    """
    result = "not rejected"
    if p < REJECTED:
        result = "rejected; use the nonparametric monotone curve"
    return (
        f"Deviance {deviance:.1f} in {bins} bins, p = {p:.3f} (parametric bootstrap of {dependence}): "
        f"the curve is {result}."
    )


def check_notes(
    fit: FragilityFit, interval: Interval, p_fit: float, fractions: Fractions
) -> tuple[str, ...]:
    """Warnings from the checks of a curve.

    Parameters
    ----------
    fit, interval : the curve and its limits
    p_fit : p value of the hypothesis that the curve describes the data [-]; NaN if not tested
    fractions : the non-parametric fragility function of the same data

    Returns
    -------
    The sentences, none if there is nothing to warn of.
    """
    notes = []
    if p_fit < REJECTED:
        notes.append(_rejection(fit.unit, interval.level, p_fit, fractions))
    lower, upper = interval.beta
    if interval.method == "jackknife" and math.isfinite(lower) and math.isfinite(upper):
        notes.append(TAILS)
    known = fit.n_motions if fit.of_motions else fit.n
    if known < FEWEST_MOTIONS and math.isfinite(fit.theta):
        noun = "motion" if fit.of_motions else "test"
        counted = f"1 {noun}" if known == 1 else f"{known} {noun}s"
        notes.append(f"The curve is based on only {counted} and describes little else.")
    return tuple(notes)


def _rejection(unit: str, level: float, p_fit: float, fractions: Fractions) -> str:
    """Sentence that the lognormal curve is rejected, with what to use instead.

    Parameters
    ----------
    unit : of the measure
    level : confidence level of the limits [-]
    p_fit : p value of the test that rejects it [-]
    fractions : the nonparametric curve
    """
    words = f"The lognormal curve is rejected (p = {p_fit:.3f}): use the nonparametric monotone curve"
    if math.isnan(fractions.theta):
        return f"{words}, which does not reach a half."
    limits = _limits_text(level, fractions.theta_limits)
    words += f", whose median is {fractions.theta:.3g} {unit}{limits}"
    if math.isnan(fractions.beta):
        return f"{words} and which does not go from 16 to 84 %."
    limits = _limits_text(level, fractions.beta_limits)
    return f"{words} and β {fractions.beta:.2f}{limits}."


def _limits_text(level: float, limits: Limits) -> str:
    """Limits in brackets, a blank before them; empty where they have no width."""
    low, high = limits
    if not low < high:
        return ""
    ends = []
    if low > 0:
        ends.append(f"from {low:.3g}")
    if math.isfinite(high):
        ends.append(f"to {high:.3g}")
    if not ends:
        return " (without limits)"
    return f" ({' '.join(ends)}, {100 * level:g} % limits)"
