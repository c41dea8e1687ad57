"""Hypotheses about orders: differences that must all be positive, judged by their intervals.

A hypothesis such as "the mean increases on the ground floor" or "the 3rd floor is lowest" is a function from
tests to named differences, entered with `order_hypothesis`; `rockfrag_thesis.hypotheses.outcomes` has the rule.

In: tests. Out: differences [-] with intervals. Theory: ``docs/hypotheses.md``.
"""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from enum import Enum

from rockfrag.effects.cluster_means import Estimate
from rockfrag_thesis.hypotheses.contrasts import power_note
from rockfrag_thesis.hypotheses.evidence import Evidence
from rockfrag_thesis.hypotheses.hypothesis import Finding, Result, hypothesis
from rockfrag_thesis.hypotheses.outcomes import LEVEL, SEEN, finding_of, known, ratios


class Size(Enum):
    """How large a claimed change is meant to be."""

    SLIGHT = "slight"
    """Slight, or of unstated size: only the opposite sign excludes it."""
    NOTICEABLE = "noticeable"
    """Noticeable, significant, much greater: a change of `SEEN` or more."""


@dataclass(frozen=True)
class Part:
    """One difference that a hypothesis says is positive."""

    estimate: Estimate  # The difference, in logarithms of ratios [-]
    size: Size = Size.SLIGHT  # How large it is meant to be

    def p_for(self) -> float:
        """One-sided p value of the hypothesis that the difference is not positive; 1 if unknown."""
        return known(self.estimate.p_above(0.0))

    def p_against(self) -> float:
        """One-sided p value of the hypothesis that the difference is positive, however small."""
        return known(self.estimate.p_below(0.0))

    def p_bounded(self) -> float:
        """One-sided p value of the hypothesis that the difference is `SEEN` or more."""
        return known(self.estimate.p_below(math.log1p(SEEN)))


Parts = Mapping[str, Part]
"""What a hypothesis about orders says: differences by name, all positive if it is true."""


NO_CHANGE, LARGE_CHANGE = "no change", "a change of 10 % or more"


def order(parts: Parts, *, unit: str = "earthquake", more: str = "") -> Result:
    """Judge differences, by name and at least one, of which a hypothesis says that all are positive.

    ``unit`` is what was sampled, for the note on power; ``more`` what else there is to say. The estimate is the
    decisive difference as a ratio: the one furthest from being shown, or the one that speaks most against the
    hypothesis.
    """
    for_it = {name: part.p_for() for name, part in parts.items()}
    against = {name: part.p_against() for name, part in parts.items()}
    weakest = max(parts, key=for_it.__getitem__)
    strongest = min(parts, key=against.__getitem__)
    p_for, p_against = for_it[weakest], min(1.0, against[strongest] * len(parts))
    finding = finding_of(p_for, p_against)
    p, p_of = min(1.0, 2 * min(p_for, p_against)), NO_CHANGE
    if finding is Finding.OPEN and (p_bounded := _p_bounded(parts)) < LEVEL:
        finding, p, p_of = Finding.BOUNDED, min(1.0, 2 * p_bounded), LARGE_CHANGE
    decisive = strongest if finding is Finding.AGAINST else weakest
    estimate = parts[decisive].estimate
    notes = [more] if more else []
    if finding is Finding.OPEN:
        notes.append(power_note(estimate, unit))
    elif finding is Finding.BOUNDED:
        notes.append("a smaller change, or none, is not excluded")
    return Result(
        finding,
        _listed(parts, decisive),
        *ratios(estimate),
        p=p,
        p_of=p_of,
        remark="; ".join(notes),
    )


def _p_bounded(parts: Parts) -> float:
    """P value of changes of `SEEN` or more: of one that is claimed to be noticeable, or else of all of them.

    Where a hypothesis claims noticeable changes it is enough that one of them is excluded, with Bonferroni's
    adjustment; where it names no size every one has to be (an intersection-union test, which needs none).
    """
    noticeable = [
        part.p_bounded() for part in parts.values() if part.size is Size.NOTICEABLE
    ]
    if noticeable:
        return min(1.0, min(noticeable) * len(noticeable))
    return max(part.p_bounded() for part in parts.values())


def _listed(parts: Parts, decisive: str) -> str:
    """All ratios of a short list, or the decisive one of a long one; and what the means say."""
    positive = sum(part.estimate.mean > 0 for part in parts.values())
    names = list(parts) if len(parts) <= 4 else [decisive]
    ratios = ", ".join(f"{name} {parts[name].estimate.text()}" for name in names)
    if len(parts) == 1:
        return (
            f"{ratios}; the mean is {'' if positive else 'not '}in the stated direction"
        )
    return f"{ratios}; {positive} of {len(parts)} means are in the stated direction"


def margin(parts: Parts) -> float:
    """Least of the differences [-]: positive where the means are as stated; no inference."""
    return min(part.estimate.mean for part in parts.values())


Differences = Callable[[Evidence], Parts]

ORDERS: dict[int, Differences] = {}
"""What the hypotheses about orders say of a table of tests, by number."""


def order_hypothesis(
    number: int,
    *,
    unit: str = "earthquake",
    more: Callable[[Evidence], str] = lambda _: "",
) -> Callable[[Differences], Differences]:
    """Enter the decorated function, from tests to differences, as a hypothesis about their order, see `order`.

    ``more`` is computed from the tests.
    """

    def enter(differences: Differences) -> Differences:
        ORDERS[number] = differences
        hypothesis(number)(
            lambda tests: order(differences(tests), unit=unit, more=more(tests))
        )
        return differences

    return enter


def effect_hypothesis(number: int, what: str, sign: int = 1, **levels: str) -> None:
    """Enter a hypothesis about the sign of the effect at some levels, see `Evidence.effect`."""
    enter = order_hypothesis(number)
    enter(lambda tests: {what: Part(tests.effect(**levels).times(sign))})
