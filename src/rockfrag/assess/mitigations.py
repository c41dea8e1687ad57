"""What helps: the object changed, as a body, shaken by the same motions, as a factor on the probability."""

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from rockfrag.assess.outcomes import ObjectOutcomes
from rockfrag.assess.risk import LEVEL, Target, earthquake_weights
from rockfrag.base.arrays import Floats
from rockfrag.fragility.intervals import half_width
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
    target: Target, now: ObjectOutcomes, changed: Mapping[Finding, ObjectOutcomes]
) -> list[Mitigation]:
    """Estimate again with each change of the object."""
    weights = earthquake_weights(now.earthquakes)
    before = target.value(now)
    # without each earthquake
    left_out = np.array([target.value(now, w) for w in weights])
    found = []
    for change, outcomes in changed.items():
        after, factor, limits = target.value(outcomes), math.nan, (math.nan, math.nan)
        if math.isfinite(before) and before > 0 and math.isfinite(after):
            factor = after / before
            limits = _limits(factor, left_out, target, outcomes)
        grows = math.isinf(target.certain)
        helps = after > before if grows else after < before
        shown = limits[0] > 1 if grows else limits[1] < 1
        if factor == 0:
            # no motion is left; more than one earthquake must have had one
            shown = len(weights) > 1 and bool((left_out > 0).all())
        found.append(Mitigation(change, after, factor, *limits, helps, helps and shown))
    return found


def _limits(
    factor: float, left_out: Floats, target: Target, outcomes: ObjectOutcomes
) -> tuple[float, float]:
    """Limits of a factor by a jackknife over earthquakes; NaN where one of them decides alone."""
    weights = earthquake_weights(outcomes.earthquakes)
    after = np.array([target.value(outcomes, w) for w in weights])
    pairs = np.array([after, left_out])
    if len(weights) < 2 or not np.isfinite(pairs).all() or not (pairs > 0).all():
        return math.nan, math.nan
    half = float(half_width(np.log(after / left_out), LEVEL))
    return factor * math.exp(-half), factor * math.exp(half)
