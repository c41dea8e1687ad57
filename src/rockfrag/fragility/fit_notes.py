"""Warnings that travel with a fitted curve: what its data do and do not allow, a sentence each.

In: the outcomes (:class:`rockfrag.fragility.observations.Observations`) or the brackets
(:class:`rockfrag.fragility.censored.Brackets`) that a curve is fitted to. Out: sentences, which stand in
``FragilityFit.warnings``, in the column ``warnings`` of the tables and in the exports.

Theory: ``docs/fragility.md``, "When the data do not allow a curve".
"""

from __future__ import annotations

from enum import Enum
from typing import TYPE_CHECKING

from rockfrag.fragility.observations import Observations

if TYPE_CHECKING:
    from rockfrag.fragility.censored import Brackets

_RISK = 0.1  # one minus the confidence of a bound where all tests agree [-]

NOT_FINITE = "The maximum of the likelihood is not finite; the fit is penalised."


class BracketCase(Enum):
    """Ways in which brackets of amplitudes bound or determine a curve; the value is the method, in words."""

    ALL_SURVIVED = "none: all tests survived"
    ALL_AT_ONCE = "none: all tests overturned at once"
    ONE_LEVEL = "none: one level of the measure"
    FLAT = "none: no curve in the brackets"
    OVERLAP = "interval estimate (brackets overlap)"
    REGULAR = "lognormal, interval- and right-censored maximum likelihood"


def notes_of_outcomes(tests: Observations) -> list[str]:
    """Warnings about single motions and repeated rows, before any fit.

    Parameters
    ----------
    tests : the outcomes with their measure

    Returns
    -------
    The sentences, none if there is nothing to warn of.
    """
    notes = []
    if tests.n_motions == 1:
        notes.append(
            "All tests share one motion: the curve describes this motion and gives no interval for others."
        )
    if repeated := tests.n_repeated:
        notes.append(
            f"{repeated} of {tests.im.size} rows repeat the motion, value and outcome of another row; "
            "they count as repetitions of the test."
        )
    return notes


def note_of_separation(tests: Observations) -> str:
    """Warning that one value of the measure separates survival from overturning."""
    survived = tests.im[tests.trials > tests.overturned].max()
    fell = tests.im[tests.overturned > 0].min()
    return (
        f"No test below {fell:g} {tests.unit} overturned and none above {survived:g} {tests.unit} survived: "
        "the data only place θ between these values and β may be any small number; θ and β are penalised "
        "estimates."
    )


def note_of_falling(tests: Observations) -> str:
    """Warning that the probability of overturning does not rise with the measure."""
    return (
        f"The probability of overturning does not rise with {tests.name}; there is no fragility curve in "
        "this measure."
    )


def note_of_one_level(
    tests: Observations | Brackets, count: int, noun: str, level: float
) -> str:
    """Warning that all ``count`` tests are at one ``level`` of the measure, in its unit."""
    return (
        f"All {count} tests are at one {noun}, {level:g} {tests.unit}, where {tests.n_overturned} overturned: "
        "a fragility curve needs at least two levels."
    )


def agreement_bound(motions: int) -> float:
    """Exact binomial bound on a probability if all of so many independent motions agree [-].

    The 90 % limit of Clopper and Pearson (1934, Biometrika 26: 404-413) for 0 of ``motions``.
    """
    return float(1.0 - _RISK ** (1.0 / motions))


def note_of_agreement(tests: Observations) -> str:
    """Warning that all tests survived or all overturned, with the bound on the probability that follows."""
    bound = agreement_bound(tests.n_motions)
    if tests.n_overturned == 0:
        return (
            f"None of {tests.n} tests overturned up to {tests.name} {tests.im.max():g} {tests.unit}: with "
            f"{tests.n_motions} independent motions P(overturn) there is below {bound:.3f} at 90 % confidence "
            "if all reached it; θ is above and not estimated."
        )
    return (
        f"All {tests.n} tests overturned down to {tests.name} {tests.im.min():g} {tests.unit}: with "
        f"{tests.n_motions} independent motions P(overturn) there is above {1.0 - bound:.3f} at 90 % "
        "confidence if all were tried there; θ is below and not estimated."
    )


def notes_of_brackets(tests: Brackets, case: BracketCase) -> tuple[str, ...]:
    """Warnings about a curve, or a bound, from brackets of the overturning amplitude.

    Parameters
    ----------
    tests : the brackets, n tests
    case : how they determine the curve

    Returns
    -------
    The sentences, none if there is nothing to warn of.
    """
    notes = []
    if tests.n_motions == 1:
        notes.append(
            "All tests share one motion: the curve describes this motion only."
        )
    count, unit = tests.lower.size, tests.unit
    lowest, highest = tests.lower.min(), tests.lower.max()
    first = tests.upper.min()
    if case is BracketCase.ALL_SURVIVED:
        notes.append(
            f"None of {count} tests overturned; every one survived {lowest:g} {unit}: θ is above and not "
            "estimated."
        )
    elif case is BracketCase.ALL_AT_ONCE:
        notes.append(
            f"All {count} tests overturned at their first step, of {first:g} {unit} or more: θ is below and "
            "not estimated."
        )
    elif case is BracketCase.ONE_LEVEL:
        notes.append(note_of_one_level(tests, count, "level", highest))
    elif case is BracketCase.OVERLAP:
        notes.append(
            f"All brackets share the amplitudes from {highest:g} to {first:g} {unit}: β is not resolved by the "
            "steps; θ is the middle of that range and β its width / √12."
        )
    elif case is BracketCase.FLAT:
        notes.append("The brackets are too few or too wide to give a curve.")
    return tuple(notes)
