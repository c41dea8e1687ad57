"""Modes of a building, its histories under a ground motion, and the elastic ones solved exactly.

In: a building, and a motion of the ground [m/s²]. Out: modes, and histories of floors [m/s²] and drifts [-].
Theory: ``docs/building.md``, "Elastic model".
"""

from dataclasses import dataclass

import numpy as np

from rockfrag.base.arrays import Floats
from rockfrag.base.short_repr import short_repr
from rockfrag.building.model import RayleighDamping, ShearBuilding
from rockfrag.records.motion import Motion


@dataclass(frozen=True)
class Modes:
    """Modes from the longest period to the shortest, each shape one at the top."""

    period: Floats  # natural periods [s], shape (storeys,)
    shape: Floats  # shapes [-], shape (floors, modes)
    # Γ [-], shape (modes,); times the shape they sum to one at every floor
    participation: Floats
    # effective modal mass over the total mass [-], shape (modes,)
    mass_fraction: Floats
    damping: Floats  # fraction of critical damping [-], shape (modes,)

    __repr__ = short_repr

    @property
    def frequency(self) -> Floats:
        """Circular frequencies ω [rad/s], shape (modes,)."""
        return 2 * np.pi / self.period


def find_modes(building: ShearBuilding) -> Modes:
    """Solve the undamped eigenproblem of the elastic building (Chopra, ch. 10).

    Parameters
    ----------
    building : the storeys, from below

    Returns
    -------
    The :class:`Modes`: frequencies [rad/s], shape (storeys,), and mode shapes, shape (storeys, storeys).
    """
    # compiled, which the checks of a building need not wait for
    from rockfrag.building.modes import fill_modes

    n = building.storeys
    mass, stiffness = np.array(building.masses), np.array(building.stiffnesses)
    memory, shape, fractions = np.zeros((2, n, n)), np.zeros((n, n)), np.zeros((n, n))
    frequencies, found = np.zeros((2, n)), np.zeros((2, n))
    fill_modes(mass, stiffness, *memory, frequencies, shape, fractions, found)
    frequency = frequencies[0]
    damping = building.damping
    ratios = np.full(building.storeys, damping.ratio)
    if isinstance(damping, RayleighDamping):
        # factors of mass [1/s] and stiffness [s] in C = α M + β K (Chopra, eq. 11.4.11)
        alpha, beta = 2 * damping.ratio * float(frequency[0]), 0.0
        if building.storeys > 1:
            lower, higher = damping.modes
            first, second = float(frequency[lower - 1]), float(frequency[higher - 1])
            beta = 2 * damping.ratio / (first + second)
            alpha = beta * first * second
        ratios = alpha / (2 * frequency) + beta * frequency / 2
    return Modes(
        period=2 * np.pi / frequency,
        shape=shape,
        participation=found[0],
        mass_fraction=found[1],
        damping=ratios,
    )


def damping_matrix(building: ShearBuilding, modes: Modes) -> Floats:
    """Damping matrix C [N s/m] with the modes' ratios, shape (storeys, storeys)."""
    mass = np.asarray(building.masses)
    modal_mass = modes.shape.T**2 @ mass
    weight = 2 * modes.damping * modes.frequency / modal_mass
    massed = mass[:, None] * modes.shape
    return np.asarray((massed * weight) @ massed.T, dtype=np.float64)


@dataclass(frozen=True)
class EnergyBalance:
    """Where the energy is, relative to the ground (Uang & Bertero 1990); each [J], shape (n,)."""

    input: Floats  # Work of the inertial forces -m a_g on the floors
    kinetic: Floats  # Of the floors' velocities relative to the ground
    strain: Floats  # What the storeys would give back on unloading
    damping: Floats  # Dissipated by viscous damping
    hysteretic: Floats  # Dissipated by the storeys

    __repr__ = short_repr

    @property
    def gap(self) -> float:
        """Largest gap of the energy balance over the largest input [-]."""
        spent = self.kinetic + self.strain + self.damping + self.hysteretic
        return float(np.abs(self.input - spent).max() / np.abs(self.input).max())


@dataclass(frozen=True)
class BuildingResponse:
    """Histories at the samples of the ground motion."""

    time: Floats  # [s], shape (n,)
    # Absolute, of ground and floors [m/s²], shape (storeys + 1, n)
    acceleration: Floats
    drift: Floats  # Of every storey over its height [-], shape (storeys, n)
    # Up to each sample, if the model keeps the balance
    energy: EnergyBalance | None = None

    __repr__ = short_repr

    @property
    def peak_drift(self) -> Floats:
        """Largest drift over height of every storey [-], shape (storeys,)."""
        return np.asarray(np.abs(self.drift).max(axis=1))


def respond_elastically(building: ShearBuilding, motion: Motion) -> BuildingResponse:
    """Superpose the modes, each exact for a ground acceleration linear between samples."""
    from rockfrag.building.modes import add_mode
    from rockfrag.motions.response_spectra import oscillator_matrix

    modes = find_modes(building)
    displacement = np.zeros((building.storeys, motion.acceleration.size))
    # the fractions of all modes sum to one at a floor, so the total accelerations superpose too
    acceleration = np.zeros_like(displacement)
    fractions = np.ascontiguousarray((modes.participation * modes.shape).T)
    for omega, damping, fraction in zip(
        modes.frequency.tolist(), modes.damping.tolist(), fractions, strict=True
    ):
        matrix = oscillator_matrix(omega, damping, motion.dt)
        add_mode(
            motion.acceleration,
            motion.dt,
            omega,
            damping,
            matrix,
            fraction,
            displacement,
            acceleration,
        )
    return BuildingResponse(
        time=motion.time,
        acceleration=np.vstack([motion.acceleration, acceleration]),
        drift=np.diff(displacement, axis=0, prepend=0.0)
        / np.array(building.heights)[:, None],
    )
