"""Whether a probability of toppling is much: a scale of our own, with one published number to hold it against.

ASCE/SEI 7-16 (21.2.1) aims new ordinary buildings at a probability of collapse of 1 % in 50 years.  No standard
known to us grades the toppling of objects; the steps, a factor of ten apart around that number, are ours.
"""

import math
from dataclasses import dataclass

from rockfrag.assess.risk import Estimate, probability_in

REFERENCE_YEARS = 50.0
"""Time for which the steps hold [year]."""


@dataclass(frozen=True)
class Step:
    """A step of the scale."""

    name: str  # What it is called
    below: float  # Probability in 50 years below which it holds [-]
    advice: str  # What to do, in a sentence


STEPS = (
    Step("low", 1e-3, "Nothing is urgent; keep it as it is."),
    Step("moderate", 1e-2, "Have it looked at when it is next moved, and plan what helps."),
    Step("high", 1e-1, "Have it measured, and secure it."),
    Step("very high", math.inf, "Secure it now."),
)
"""Steps of the scale, rising."""

SCALE_WORDS = (
    "low below 0.1 % in 50 years, moderate to 1 %, high to 10 %, then very high; ASCE 7 accepts 1 % for the "
    "collapse of a new building"
)
"""The scale in words."""


def step_of(probability: float, years: float) -> Step:
    """Step of a probability in some years, by the rate that it stands for."""
    rate = -math.log1p(-min(probability, 1 - 1e-15)) / years
    in_fifty = probability_in(rate, REFERENCE_YEARS)
    return next(step for step in STEPS if in_fifty < step.below)


def classes(probability: Estimate, years: float) -> Step:
    """Step of a probability, named with those that its interval reaches; the advice is that of the estimate."""
    worst = step_of(probability.upper, years)
    if probability.value == 0:
        return Step(f"at most {worst.name}", worst.below, worst.advice)
    middle, best = step_of(probability.value, years), step_of(probability.lower, years)
    if best == worst:
        return middle
    return Step(
        f"{middle.name} (the interval reaches from {best.name} to {worst.name})",
        middle.below,
        middle.advice,
    )
