"""The recommendation of an intensity measure in sentences, with its reasons.

In: scores and p values of the measures that were compared (:mod:`rockfrag.fragility.measure_selection`). Out:
sentences, which stand in ``MeasureSelection.words``.

Theory: ``docs/fragility.md``, "Which intensity measure?".
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

DIFFERENCE_P = 0.05  # two measures differ below this p value of their held-out scores
FEWEST_GROUPS_TO_CHOOSE = 10
"""Below so many motions or earthquakes the words say that the choice is weak."""
SUFFICIENT_P = 0.05  # a residual's dependence on a column is named below this p value

_COLUMNS = {"mean_period_s": "mean period", "d5_95_s": "significant duration"}

Row = Mapping[Any, Any]  # a row of ``MeasureSelection.table``

CANNOT_COMPARE = (
    "The measures cannot be compared: this needs two motions or earthquakes, and brackets of the overturning "
    "amplitude that do not all overlap."
)
NONE_RISES = (
    "The tests show no measure with which the probability of overturning rises."
)


@dataclass(frozen=True)
class Choice:
    """A recommended measure and those that it was compared with."""

    best: Row
    several: bool  # whether it was compared with others
    equal: Sequence[Row]  # measures that the scores do not tell from it
    worse: Sequence[Row]  # measures with a worse score, the best of them first
    groups: int  # number of motions or earthquakes that were held out
    given: Sequence[str]  # columns against which sufficiency was tested


def choice_text(choice: Choice) -> str:
    """Recommendation of a measure, with what was compared and how sure it is, in sentences."""
    best, groups = choice.best, choice.groups
    words = [
        f"Use {best['im']}: β = {best['beta']:.2f}, AUC {best['auc']:.3f}, mean log score of held-out tests "
        f"{best['score']:.3f}."
    ]
    if choice.equal:
        words.append(_equals_text(choice))
    if choice.worse:
        next_best = choice.worse[0]
        words.append(
            f"{next_best['im']} is worse: {next_best['score']:.3f} ({_p_text(next_best['p_worse'])}, t-test over "
            f"{groups} groups of dependent tests)."
        )
    if choice.several:
        words.append(
            f"It scores best in {100 * best['chosen_fraction']:.0f} % of bootstrap samples of these groups."
        )
    if groups < FEWEST_GROUPS_TO_CHOOSE:
        words.append(
            f"{groups} groups are few: other earthquakes may change the choice."
        )
    words += [_sufficiency_text(column, best[f"p_{column}"]) for column in choice.given]
    return " ".join(words)


def _equals_text(choice: Choice) -> str:
    """Sentence on the measures that the scores do not tell from the best."""
    each = [
        f"{row['im']} ({row['score']:.3f}, β = {row['beta']:.2f})"
        for row in choice.equal
    ]
    advice = "the tests are too few to rule these out"
    if choice.groups >= FEWEST_GROUPS_TO_CHOOSE:
        advice = "any of them will do"
    return f"It is not distinguishable from {', '.join(each)}: {advice}. It is preferred for its smaller β."


def _sufficiency_text(column: str, p: float) -> str:
    """Sentence on whether the best measure is sufficient for a property."""
    name = _COLUMNS.get(column, column)
    if math.isnan(p):
        return f"These motions cannot test its sufficiency with respect to {name}."
    if p < SUFFICIENT_P:
        return f"It is not sufficient: its residuals depend on {name} ({_p_text(p)})."
    return f"No dependence of its residuals on {name} is shown (p = {p:.2f})."


def pair_text(name: str, p: float, gain: float) -> str:
    """Sentence on a second measure.

    Parameters
    ----------
    name : the second measure, as the field writes it
    p, gain : p value of what it adds to the held-out scores, and the gain of score per test [-]

    Returns
    -------
    The sentence.
    """
    if gain > 0 and p < DIFFERENCE_P:
        return f"Adding {name} improves the prediction of held-out tests ({_p_text(p)}): use the surface in both."
    if not math.isfinite(p):
        return f"One group of motions cannot show whether {name} adds to it."
    return f"Adding {name} does not improve the prediction of held-out tests: one measure is enough."


def _p_text(p: float) -> str:
    return f"p = {p:.3f}" if p >= 0.001 else "p < 0.001"
