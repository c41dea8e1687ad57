"""Amplitudes of an IDA curve: peaks of the input motion in equal ratios."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rockfrag.errors import InputError


@dataclass(frozen=True)
class Amplitudes:
    """Peaks of the input motion from the lowest to the highest in steps of equal ratio."""

    # First amplitude and the one not to be exceeded [g]
    lowest_g: float
    highest_g: float
    step_percent: float  # Step from one to the next [%]

    def __post_init__(self) -> None:
        if self.highest_g <= self.lowest_g:
            raise InputError(
                f"key amplitudes.highest_g: expected more than lowest_g = {self.lowest_g}, "
                f"found {self.highest_g}."
            )

    @property
    def values_g(self) -> NDArray[np.float64]:
        """Amplitudes [g], shape (n,), increasing."""
        ratio = 1 + self.step_percent / 100
        steps = math.floor(math.log(self.highest_g / self.lowest_g) / math.log(ratio) + 1e-9)
        return np.asarray(self.lowest_g * ratio ** np.arange(steps + 1))
