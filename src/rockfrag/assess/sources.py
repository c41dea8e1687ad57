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

SPACE = 0.13
"""Standard deviation of ln level of the second horizontal component, |ln(0.47 g / 0.54 g)|: the median level of
a box of 0.35 × 0.35 × 1.2 m in space under both components of 25 records of FEMA P-695 over that along one of
them."""


@dataclass(frozen=True)
class Measurement:
    """Something that a user could measure or find out."""

    words: str  # What it is
    # What it leaves of the standard deviation [-]: an estimate of ours, of a measurement made with care
    left: float


@dataclass(frozen=True)
class Source:
    """A source of uncertainty."""

    words: str  # What it is, as a reader may know it
    basis: str  # Where its size comes from
    measurement: Measurement | None = None  # What would make it smaller; None where no user can


SOURCES: Mapping[str, Source] = {
    "motions": Source(
        "how much earthquakes differ",
        "Jackknife that leaves out an earthquake at a time (Efron and Stein 1981)",
    ),
    "width": Source(
        "the width on which it stands",
        "± 2 %, of ours: rounded and chipped edges carry some millimetres further in",
        Measurement("the width on which it stands to 0.5 %", 0.25),
    ),
    "contact": Source(
        "which points of the scan carry",
        "Contact tolerance about twice the accuracy of the scan, ± 50 %; ± 30 % where the accuracy and "
        "± 20 % where the tolerance is given, of ours; for a granite rock on a shaking table 0.5 "
        "to 1.9 mm were plausible",
        Measurement("the points on which it stands, traced at its foot", 1 / 3),
    ),
    "retreat": Source(
        "how round its edges are",
        "Edges carry 0 to 10 mm further in, all alike, of ours: natural and worn edges are round",
        Measurement("the radius of its edges at the foot to 1 mm", 0.2),
    ),
    "facing": Source(
        "the direction in which it faces the shaking",
        "Any direction is as probable as any other; in space half the difference of two at a right angle",
        Measurement("the direction from which its shaking comes", 0.0),
    ),
    "cg_height": Source(
        "the height of its centre of gravity",
        "± 5 %, of ours: half the height is a guess, a drawing is better",
        Measurement("the height of its centre of gravity to 1 %", 0.2),
    ),
    "restitution": Source(
        "the energy that impacts take",
        "± 5 % of what momentum leaves (Housner 1963), of ours; 0.7 to 1 times it where a scan stands "
        "on few points",
        Measurement("its restitution to 1 %", 0.2),
    ),
    "mass": Source(
        "its mass",
        "± 20 %, of ours: stones differ in density, and statues fill a part of their box",
        Measurement("its mass to 2 %", 0.1),
    ),
    "period": Source(
        "the building's first period",
        "± 30 % of the rule of EN 1998-1, ± 10 % of one that is given, of ours",
        Measurement("the building's first period to 5 %", 1 / 6),
    ),
    "damping": Source(
        "the building's damping",
        "± 40 %, of ours",
        Measurement("the building's damping to 15 %", 0.4),
    ),
    "model": Source(
        "the error of the planar rocking model",
        "Simulated against measured medians, "
        + "; ".join(
            f"{kind}: {error.beyond:g} of ln level, {error.words}"
            for kind, error in MODEL_ERRORS.items()
        )
        + "; no campaign of a round base or of a body in space is at hand, and that of cut blocks stands for them",
    ),
    "space": Source(
        "both horizontal components at once",
        f"{SPACE:g} of ln level: a square box in space has 0.88 of the median of one component; not counted for "
        "round bases",
    ),
    "conversion": Source(
        "the ground velocity, which the given measure does not fix",
        "How far the mean PGV of a site's motions may be from that of the set, by magnitude, distance, ground "
        "and site",
        Measurement("the ground velocity (PGV) of the site", 0.0),
    ),
    "together": Source(
        "how peak acceleration and velocity occur together",
        "± 25 % of the spread of ln PGV at a given level, of ours; two hazard curves do not say it, and about "
        "magnitude, distance and ground it is that of the set",
    ),
    "hazard": Source(
        "the hazard curve",
        "Its quantiles; exponents of 2.4 to 3.6 where one level was given (EN 1998-1)",
        Measurement("a hazard curve of the site", 0.5),
    ),
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
LEAST_GAIN = 0.15  # Fraction of the variance that a measurement must take away to be worth naming
MOST_NAMED = 2  # Measurements that are named together


MEASUREMENTS: Mapping[str, Measurement] = {
    name: source.measurement for name, source in SOURCES.items() if source.measurement is not None
}
"""Measurements by the source of uncertainty that they narrow."""


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
    return known, Estimate(estimate.value, lower, upper, left)
