"""How an amplitude becomes a figure in a table, and what distorts it on the way."""

import math
from collections.abc import Mapping
from dataclasses import dataclass

from rockfrag.errors import InputError


@dataclass(frozen=True)
class Exact:
    """The amplitude is known as it is."""

    def measure(self, amplitude_g: float, configuration: str) -> float:
        """Return the measured amplitude [g]."""
        return amplitude_g


@dataclass(frozen=True)
class ForceOverMass:
    """Amplitude computed as the shaker's force over the mass it is believed to move [kg], by configuration.

    The force moves the unaccounted mass too, so the figure is too large by the ratio of the masses, and by more
    for a light specimen: a bias that differs with and without the pedestal. Too much counted is negative.
    """

    believed_mass: Mapping[str, float]
    unaccounted_mass: float = 0.0

    def __post_init__(self) -> None:
        for configuration, mass in self.believed_mass.items():
            if not (math.isfinite(mass) and mass > 0 and mass + self.unaccounted_mass > 0):
                raise InputError(
                    f"force over mass: configuration {configuration!r} moves {mass} kg and "
                    f"{self.unaccounted_mass} kg unaccounted for, which must be positive masses."
                )

    def measure(self, amplitude_g: float, configuration: str) -> float:
        """Return the measured amplitude [g]."""
        if configuration not in self.believed_mass:
            raise InputError(
                f"force over mass: no mass is given for configuration {configuration!r}; known are "
                f"{', '.join(self.believed_mass)}."
            )
        return amplitude_g * (1 + self.unaccounted_mass / self.believed_mass[configuration])


@dataclass(frozen=True)
class Accelerometer:
    """Amplitude read from an accelerometer that shows no more than its range, ``clip_g`` [g]."""

    clip_g: float

    def __post_init__(self) -> None:
        if not self.clip_g > 0:
            raise InputError(
                f"accelerometer: clip_g must be a positive number of g, got {self.clip_g}."
            )

    def measure(self, amplitude_g: float, configuration: str) -> float:
        """Return the measured amplitude [g]."""
        return min(amplitude_g, self.clip_g)


Measurement = Exact | ForceOverMass | Accelerometer
