"""The rules by which a test becomes a verdict, the same for all statements.

A direction ("higher", "decreases") is supported when its interval lies wholly on the claimed side at
5 %, adjusted within its family, and contradicted when it lies wholly on the other side or when any
relevant change is excluded by equivalence.  An extreme ("largest", "much greater than the others") is
supported when every comparison with the others holds at 5 % (an intersection-union test, which needs
no adjustment), contradicted when one of them holds the other way after adjustment or all differences
are nothing.  Everything else is undecided, with the power that would be needed.
"""

import math
from collections.abc import Mapping

from rockfrag.pedestal.cluster_means import Estimate
from rockfrag.pedestal.equivalence import MARGIN, equivalence
from rockfrag.pedestal.power import power_note

LEVEL = 0.05
NOTHING = 0.01
"""A "slight" change, or a difference of extremes, below ±1 % is no change at all [-]."""


def direction(
    estimate: Estimate, sign: int, *, p: float | None = None, slight: bool = False
) -> str:
    """Verdict on a claimed sign of a mean log ratio.

    Parameters
    ----------
    sign
        +1 for an increase, -1 for a decrease.
    p
        Adjusted two-sided p value; the estimate's own if there is no family.
    slight
        Whether the claim is of a slight change, which only equivalence within ±1 % (not ±10 %)
        excludes.
    """
    level = estimate.p if p is None else p
    if level < LEVEL:
        return "supported" if estimate.mean * sign > 0 else "contradicted"
    if equivalence(estimate, NOTHING if slight else MARGIN).shown(LEVEL):
        return "contradicted"
    return "undecided"


def extreme(differences: Mapping[str, Estimate]) -> tuple[str, str]:
    """Verdict on "this level exceeds all the others", and the name of the decisive comparison.

    Parameters
    ----------
    differences
        Estimates of this level minus each other, positive in favour of the claim.
    """
    for_it = {name: one.p_above(0.0) for name, one in differences.items()}
    against = {name: one.p_below(0.0) for name, one in differences.items()}
    if any(math.isnan(p) for p in for_it.values()):
        return "undecided", next(iter(differences))
    weakest = max(for_it, key=lambda name: for_it[name])
    strongest = min(against, key=lambda name: against[name])
    if for_it[weakest] < LEVEL:
        return "supported", weakest
    if against[strongest] * len(against) < LEVEL:
        return "contradicted", strongest
    if all(equivalence(one, NOTHING).shown(LEVEL) for one in differences.values()):
        return "contradicted", weakest
    return "undecided", weakest


def same(estimate: Estimate) -> str:
    """Verdict on "nearly equal" or "not correlated": equivalence within ±10 %."""
    if equivalence(estimate).shown(LEVEL):
        return "supported"
    return "contradicted" if estimate.p < LEVEL else "undecided"


def all_of(verdicts: list[str]) -> str:
    """Verdict on a conjunction: one contradiction suffices, support needs all."""
    if "contradicted" in verdicts:
        return "contradicted"
    return "supported" if all(one == "supported" for one in verdicts) else "undecided"


def remark(verdict: str, estimate: Estimate, unit: str = "event", more: str = "") -> str:
    """Remark of a row: the power needed when undecided, and what else there is to say."""
    parts = [more] if more else []
    if verdict == "undecided":
        parts.append(power_note(estimate, unit))
    return "; ".join(parts)
