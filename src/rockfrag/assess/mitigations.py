"""What helps: the object changed, as a body, shaken by the same motions, as a factor on the probability."""

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from rockfrag.assess.outcomes import ObjectOutcomes
from rockfrag.assess.risk import LEVEL, Evidence, Target
from rockfrag.base.arrays import Floats
from rockfrag.words.findings import Finding


@dataclass(frozen=True)
class Mitigation:
    """What a change does."""

    change: Finding  # What is changed
    value: float  # The probability, fraction or amplitude with it
    # That over the one without it [-]; 0 where no motion topples the object any more
    factor: float
    # Limits of the factor, of the same motions with and without it; NaN where there are none
    lower: float
    upper: float
    # Whether the object is better off: the risk shrinks, or an amplitude grows
    helps: bool
    # Whether the motions show that it is, beyond what one earthquake decides
    shown: bool


def compare(
    target: Target,
    evidence: Evidence,
    now: ObjectOutcomes,
    changed: Mapping[Finding, ObjectOutcomes],
) -> list[Mitigation]:
    """Estimate again with each change of the object, with the same errors of all that is not known.

    Limits of the factor are over the earthquakes; a change is shown to help if they leave nothing else open.
    """
    before, by_weights = _compared(target, evidence, now)
    found = []
    for change, outcomes in changed.items():
        after, with_it = _compared(target, evidence, outcomes)
        factor, limits = math.nan, (math.nan, math.nan)
        if math.isfinite(before) and before > 0 and math.isfinite(after):
            factor = after / before
            both = np.isfinite(by_weights) & np.isfinite(with_it) & (by_weights > 0)
            ratios = with_it[both] / by_weights[both]
            ends = [(1 - LEVEL) / 2, (1 + LEVEL) / 2]
            if ratios.size:
                low, high = np.quantile(ratios, ends).tolist()
                limits = min(low, factor), max(high, factor)
        helps = after > before if target.is_level else after < before
        shown = limits[0] > 1 if target.is_level else limits[1] < 1
        found.append(Mitigation(change, after, factor, *limits, helps, shown))
    return found


def _compared(
    target: Target, evidence: Evidence, outcomes: ObjectOutcomes
) -> tuple[float, Floats]:
    """What is estimated, and by each set of weights of the earthquakes, shape (sets,)."""
    prediction = evidence.of(outcomes)
    values = target.shown(evidence.drawn(target, prediction))
    sets = values.reshape(len(prediction.draws.weights), -1)
    if target.is_level:
        return float(np.quantile(values, 0.5, method="lower")), np.median(sets, axis=1)
    return float(values.mean()), sets.mean(axis=1)
