"""Histories of a building under a ground motion, and the elastic ones solved exactly."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rockfrag.building.model import ShearBuilding
from rockfrag.building.modes import find_modes
from rockfrag.motions.spectra import oscillator_response
from rockfrag.records.motion import Motion
from rockfrag.short_repr import short_repr

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class EnergyBalance:
    """Where the energy is, relative to the ground (Uang & Bertero 1990); each [J], shape (n,).

    Attributes
    ----------
    input
        Work of the inertial forces -m a_g on the floors.
    kinetic
        Kinetic energy of the floors' velocities relative to the ground.
    strain
        Energy that the storeys would give back on unloading.
    damping
        Energy dissipated by viscous damping.
    hysteretic
        Energy dissipated by the storeys.
    """

    input: Floats
    kinetic: Floats
    strain: Floats
    damping: Floats
    hysteretic: Floats

    __repr__ = short_repr

    @property
    def gap(self) -> float:
        """Largest gap of the energy balance over the largest input [-]."""
        spent = self.kinetic + self.strain + self.damping + self.hysteretic
        return float(np.abs(self.input - spent).max() / np.abs(self.input).max())


@dataclass(frozen=True)
class BuildingResponse:
    """Histories at the samples of the ground motion.

    Attributes
    ----------
    time
        Time [s], shape (n,).
    acceleration
        Absolute acceleration of the ground and of every floor [m/s²], shape (storeys + 1, n).
    drift
        Drift of every storey over its height [-], shape (storeys, n).
    energy
        Energy up to each sample, if the model keeps the balance.
    """

    time: Floats
    acceleration: Floats
    drift: Floats
    energy: EnergyBalance | None = None

    __repr__ = short_repr

    @property
    def peak_drift(self) -> Floats:
        """Largest drift over height of every storey [-], shape (storeys,)."""
        return np.asarray(np.abs(self.drift).max(axis=1))


def respond_elastically(building: ShearBuilding, motion: Motion) -> BuildingResponse:
    """Superpose the modes, each exact for a ground acceleration linear between samples."""
    modes = find_modes(building)
    displacement = np.zeros((building.storeys, motion.acceleration.size))
    acceleration = np.zeros_like(displacement)
    for period, damping, fraction in zip(
        modes.period, modes.damping, (modes.participation * modes.shape).T, strict=True
    ):
        u, _, total = oscillator_response(motion, float(period), float(damping))
        displacement += np.outer(fraction, u)
        # the fractions of all modes sum to one at a floor, so the total accelerations superpose too
        acceleration += np.outer(fraction, total)
    return BuildingResponse(
        time=motion.time,
        acceleration=np.vstack([motion.acceleration, acceleration]),
        drift=np.diff(displacement, axis=0, prepend=0.0) / np.array(building.heights)[:, None],
    )
