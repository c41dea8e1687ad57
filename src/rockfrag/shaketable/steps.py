"""Series of levels of amplitudes: how a laboratory raises the motion from test to test."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rockfrag.errors import InputError
from rockfrag.input_checks import positive_number
from rockfrag.units import GRAVITY

Floats = NDArray[np.float64]

MOST_STEPS = 100_000
"""A series of levels with more steps than this is a slip: nobody shakes a block that often."""


@dataclass(frozen=True)
class LinearSteps:
    """Amplitudes that grow by the same amount."""

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
        return np.asarray(self.start_g * (1 + self.growth) ** (phase + np.arange(count)))


@dataclass(frozen=True)
class ForceSteps:
    """Amplitudes by the shaker's force on armature, table and specimen, which grows by the same amount."""

    start_n: float
    step_n: float
    moved_mass_kg: float

    def __post_init__(self) -> None:
        for name in ("start_n", "step_n", "moved_mass_kg"):
            positive_number(f"force steps: {name}", getattr(self, name))

    def amplitudes(self, limit_g: float, phase: float = 0.0) -> Floats:
        """Amplitudes up to ``limit_g`` [g], started later by the fraction ``phase`` of a step."""
        weight = self.moved_mass_kg * GRAVITY
        intensity_levels = LinearSteps(self.start_n / weight, self.step_n / weight)
        return intensity_levels.amplitudes(limit_g, phase)


Steps = LinearSteps | GeometricSteps | ForceSteps


def _count(levels: float) -> int:
    # the last level counts when it meets the limit within rounding
    count = math.floor(levels + 1e-9) + 1
    if count > MOST_STEPS:
        raise InputError(
            f"protocol: steps so small that {count} of them fit below the limit; enlarge them."
        )
    return max(count, 0)
