"""Test protocols: amplitudes raised level by level to the first overturning or the limit, shown by instruments.

In: first level, step and limit [g]. Out: levels, bounds and what an instrument shows of them [g]. Theory:
``docs/shaketable.md``.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from rockfrag.base.arrays import Floats
from rockfrag.base.errors import InputError
from rockfrag.base.input_checks import positive_number

MOST_STEPS = 100_000  # more than this are a slip: nobody shakes a block that often


@dataclass(frozen=True)
class LinearSteps:
    """Amplitudes that grow by the same amount: also those of a force [N], over the moved weight [N]."""

    start_g: float
    step_g: float

    def __post_init__(self) -> None:
        positive_number("linear steps: start_g", self.start_g)
        positive_number("linear steps: step_g", self.step_g)

    def amplitudes(self, limit_g: float, phase: float = 0.0) -> Floats:
        """Amplitudes up to ``limit_g`` [g], started later by the fraction ``phase`` of a step."""
        count = _count((limit_g - self.start_g) / self.step_g - phase)
        return np.asarray(self.start_g + self.step_g * (phase + np.arange(count)))


@dataclass(frozen=True)
class GeometricSteps:
    """Amplitudes that grow by the same factor: a ``growth`` of 0.05 raises each by 5 %."""

    start_g: float
    growth: float

    def __post_init__(self) -> None:
        positive_number("geometric steps: start_g", self.start_g)
        positive_number("geometric steps: growth", self.growth)

    def amplitudes(self, limit_g: float, phase: float = 0.0) -> Floats:
        """Amplitudes up to ``limit_g`` [g], started later by the fraction ``phase`` of a step."""
        ratio = limit_g / self.start_g
        levels = math.log(ratio) / math.log1p(self.growth) if ratio > 0 else -1.0
        count = _count(levels - phase)
        return np.asarray(
            self.start_g * (1 + self.growth) ** (phase + np.arange(count))
        )


Steps = LinearSteps | GeometricSteps


def _count(levels: float) -> int:
    """Number of levels up to a limit."""
    # the last level counts when it meets the limit within rounding
    count = math.floor(levels + 1e-9) + 1
    if count > MOST_STEPS:
        raise InputError(
            f"protocol: steps so small that {count} of them fit below the limit; enlarge them."
        )
    return max(count, 0)


@dataclass(frozen=True)
class Outcome:
    """Bounds of the overturning amplitude of one test."""

    # largest amplitude survived on the way [g]; 0 if the first one overturned
    lower_g: float
    upper_g: float  # amplitude that overturned [g]; NaN if none did
    remark: str = ""  # what a reader of the figure has to know

    @property
    def censored(self) -> bool:
        """Whether it is only known that the amplitude is above ``lower_g``."""
        return math.isnan(self.upper_g)


@dataclass(frozen=True)
class ForceOverMass:
    """Amplitude computed as the shaker's force over the mass it is believed to move [kg], by configuration.

    The force moves the unaccounted mass too (negative if too much is counted), so the figure is too large by the
    ratio of the masses, and by more for a light specimen.
    """

    believed_mass: Mapping[str, float]
    unaccounted_mass: float = 0.0

    def __post_init__(self) -> None:
        for configuration, mass in self.believed_mass.items():
            if not (
                math.isfinite(mass) and mass > 0 and mass + self.unaccounted_mass > 0
            ):
                raise InputError(
                    f"force over mass: configuration {configuration!r} moves {mass} kg and "
                    f"{self.unaccounted_mass} kg unaccounted for, which must be positive masses."
                )

    def show(self, outcome: Outcome, configuration: str) -> Outcome:
        """Outcome as the laboratory computes it."""
        if configuration not in self.believed_mass:
            raise InputError(
                f"force over mass: no mass is given for configuration {configuration!r}; known are "
                f"{', '.join(self.believed_mass)}."
            )
        factor = 1 + self.unaccounted_mass / self.believed_mass[configuration]
        return replace(
            outcome, lower_g=outcome.lower_g * factor, upper_g=outcome.upper_g * factor
        )


@dataclass(frozen=True)
class Accelerometer:
    """Amplitude read from an accelerometer that shows no more than its range, ``clip_g`` [g]."""

    clip_g: float

    def __post_init__(self) -> None:
        positive_number("accelerometer: clip_g", self.clip_g, "g")

    def show(self, outcome: Outcome, configuration: str) -> Outcome:
        """Outcome as it is shown: beyond the range a lower bound only."""
        true = outcome.lower_g if outcome.censored else outcome.upper_g
        if true <= self.clip_g:
            return outcome
        return Outcome(
            min(outcome.lower_g, self.clip_g), math.nan, "accelerometer clipped"
        )


Measurement = ForceOverMass | Accelerometer


@dataclass(frozen=True)
class Protocol:
    """What the laboratory does with one specimen and one motion, and what it writes down.

    Each amplitude is a test of its own: the specimen stands at rest and feels the whole motion.

    Attributes
    ----------
    steps : series of levels of amplitudes
    limit_g : amplitude at which the tests stop unless the shaker's limit comes first [g]
    repetitions : number of times the series of levels is climbed
        Repetition r starts r/repetitions of a step later, as the gain of a force-guided shaker is not set to the
        digit, so repetitions sample what the coarseness of the steps does to the figure.
    definition : the amplitude reported is the largest ``before`` overturning, or the one ``at`` overturning
    measurement : how the amplitude becomes a figure; None shows it as it is
    """

    steps: Steps
    limit_g: float = 2.0
    repetitions: int = 1
    definition: Literal["before", "at"] = "before"
    measurement: Measurement | None = None

    def __post_init__(self) -> None:
        positive_number("protocol: limit_g", self.limit_g, "g")
        if not (type(self.repetitions) is int and self.repetitions >= 1):
            raise InputError(
                f"protocol: repetitions must be a whole number from 1, got {self.repetitions}."
            )
        if self.definition not in ("before", "at"):
            raise InputError(
                f"protocol: definition must be 'before' or 'at', got {self.definition!r}."
            )

    def amplitudes(self, limit_g: float | None = None, repetition: int = 1) -> Floats:
        """Rising amplitudes up to the protocol's and the shaker's limit [g]; repetitions count from 1."""
        limit = self.limit_g if limit_g is None else min(limit_g, self.limit_g)
        return self.steps.amplitudes(limit, (repetition - 1) / self.repetitions)

    def report(self, outcome: Outcome) -> float:
        """Return the figure reported [g]; NaN if censored or nothing was survived."""
        if outcome.censored:
            return math.nan
        if self.definition == "at":
            return outcome.upper_g
        return outcome.lower_g if outcome.lower_g > 0 else math.nan
