"""What measurement would narrow an interval most, and to what."""

import math
from collections.abc import Mapping
from dataclasses import dataclass

from scipy import special

from rockfrag.assess.risk import Estimate
from rockfrag.assess.sources import SOURCES, Measurement

LIKELY, UNLIKELY = 0.5, 0.01
"""An interval of a fraction that holds both tells nothing."""

LEAST_GAIN = 0.15
"""Fraction of the variance that a measurement must take away to be worth naming."""

MOST_NAMED = 2
"""Measurements that are named together."""


MEASUREMENTS: Mapping[str, Measurement] = {
    name: source.measurement for name, source in SOURCES.items() if source.measurement is not None
}
"""Measurements by the source of uncertainty that they narrow."""


@dataclass(frozen=True)
class Narrowed:
    """An interval as it would be with more known."""

    known: tuple[str, ...]  # Sources that were measured, the most helpful first
    estimate: Estimate  # The same value with the narrower interval


def is_wide(estimate: Estimate) -> bool:
    """Whether an interval reaches from unlikely to likely."""
    return estimate.lower < UNLIKELY and estimate.upper > LIKELY


def narrowed(estimate: Estimate) -> Narrowed | None:
    """Return the interval with the measurements that narrow it most; None where none is worth it."""
    variances = {name: value**2 for name, value in estimate.sources.items()}
    total = sum(variances.values())
    if not (0 < estimate.value < 1 and math.isfinite(total) and total > 0):
        return None
    if estimate.lower <= 0 and estimate.upper >= 1:
        # limits that are at the ends whatever is known
        return None
    gains = {
        name: variances.get(name, 0.0) * (1 - measurement.left**2) / total
        for name, measurement in MEASUREMENTS.items()
    }
    known = sorted((n for n in gains if gains[n] >= LEAST_GAIN), key=lambda n: -gains[n])
    known = known[:MOST_NAMED]
    if not known:
        return None
    left = {
        name: value * (MEASUREMENTS[name].left if name in known else 1.0)
        for name, value in estimate.sources.items()
    }
    ratio = math.sqrt(sum(value**2 for value in left.values()) / total)
    middle, low, high = special.logit([estimate.value, estimate.lower, estimate.upper])
    lower, upper = (float(special.expit(middle + ratio * (end - middle))) for end in (low, high))
    return Narrowed(tuple(known), Estimate(estimate.value, lower, upper, left))
