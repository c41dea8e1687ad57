"""What is not known, source by source: its words, where its size comes from, and what would make it smaller.

Only what is not known stands here and widens intervals. What differs from one earthquake to the next, such as the
velocity that comes with a given PGA, is in the motions and so in the fractions and probabilities themselves.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass

from scipy import special

from rockfrag.assess.risk import Estimate
from rockfrag.fragility.model_error import MODEL_ERRORS
from rockfrag.words.sentences import PART, Macros

SPACE = 0.13
"""Standard deviation of ln level of the second horizontal component, |ln(0.47 g / 0.54 g)|: the median level of
a box of 0.35 × 0.35 × 1.2 m in space under both components of 25 records of FEMA P-695 over that along one of
them."""


@dataclass(frozen=True)
class Source:
    """A source of uncertainty, as ``sources.j2`` words it."""

    words: str  # What it is, as a reader may know it
    basis: str  # Where its size comes from
    measurement: str = (
        # What a user could measure or find out that makes it smaller; empty for nothing
        ""
    )
    # What that leaves of the standard deviation [-]; an estimate of ours
    left: float = 1.0


_LEFT = {
    **{
        "width": 0.25,
        "contact": 1 / 3,
        "retreat": 0.2,
        "facing": 0.0,
        "cg_height": 0.2,
    },
    **{
        "restitution": 0.2,
        "mass": 0.1,
        "period": 1 / 6,
        "damping": 0.4,
        "conversion": 0.0,
    },
    "hazard": 0.5,
}
_SAYS = Macros("rockfrag.assess", "sources.j2", MODEL_ERRORS=MODEL_ERRORS, SPACE=SPACE)

SOURCES: Mapping[str, Source] = {
    name: Source(words, basis, "".join(measured), _LEFT.get(name, 1.0))
    for name, words, basis, *measured in (line.split(PART) for line in _SAYS("sources"))
}
"""Sources of uncertainty by name."""


def parts_of(sources: Mapping[str, float]) -> dict[str, float]:
    """Part of each source in the variance of an interval, the largest first [-]; empty where one has no bound."""
    total = sum(value**2 for value in sources.values())
    if not 0 < total < float("inf"):
        return {}
    ranked = sorted(sources, key=lambda name: -sources[name])
    return {name: sources[name] ** 2 / total for name in ranked}


LIKELY, UNLIKELY = 0.5, 0.01  # An interval of a fraction that holds both tells nothing
# Fraction of the variance that a measurement must take away to be worth naming
LEAST_GAIN = 0.15
MOST_NAMED = 2  # Measurements that are named together


MEASUREMENTS: Mapping[str, Source] = {
    name: source for name, source in SOURCES.items() if source.measurement
}
"""Sources of uncertainty that a measurement would narrow."""


def is_wide(estimate: Estimate) -> bool:
    """Whether an interval reaches from unlikely to likely."""
    return estimate.lower < UNLIKELY and estimate.upper > LIKELY


def narrowed(estimate: Estimate) -> tuple[list[str], Estimate] | None:
    """Return what narrows an interval most if it is measured, and the estimate then; None where nothing does."""
    variances = {name: value**2 for name, value in estimate.sources.items()}
    total = sum(variances.values())
    if not (0 < estimate.value < 1 and math.isfinite(total) and total > 0):
        return None
    if estimate.lower <= 0 and estimate.upper >= 1:
        # limits that are at the ends whatever is known
        return None
    gains = {
        name: variances.get(name, 0.0) * (1 - source.left**2) / total
        for name, source in MEASUREMENTS.items()
    }
    known = sorted(
        (n for n in gains if gains[n] >= LEAST_GAIN), key=lambda n: -gains[n]
    )
    known = known[:MOST_NAMED]
    if not known:
        return None
    left = {
        name: value * (SOURCES[name].left if name in known else 1.0)
        for name, value in estimate.sources.items()
    }
    ratio = math.sqrt(sum(value**2 for value in left.values()) / total)
    middle, low, high = special.logit([estimate.value, estimate.lower, estimate.upper])
    lower, upper = (
        float(special.expit(middle + ratio * (end - middle))) for end in (low, high)
    )
    return known, Estimate(estimate.value, lower, upper, left)
