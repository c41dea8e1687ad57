"""A building as a chain of floor masses and storey springs, and what it assumes.

In: masses [kg], stiffnesses [N/m] or a first period [s], damping. Out: a checked :class:`ShearBuilding`.
Theory: ``docs/building.md``, "Elastic model".
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields
from typing import Literal

import numpy as np

from rockfrag.base.arrays import Floats
from rockfrag.base.errors import InputError


@dataclass(frozen=True)
class MasonryLaw:
    """Degrading, pinching law of a masonry storey, calibrated by drift limits.

    The limits are those of EN 1998-3 for walls governed by shear (0.4 %) and by rocking (0.8 %), beyond which a
    residue is left; the storey carries its shear strength from the yield drift to the shear limit.
    """

    # Shear strength of the ground storey over the whole weight [-]
    base_shear: float = 0.12
    # Shear at which the elastic stiffness ends, over the shear strength [-]
    cracking: float = 0.5
    # Drift over storey height at yield and at the two limits [-]
    yield_drift: float = 0.001
    shear_drift: float = 0.004
    rocking_drift: float = 0.008
    # Shear left beyond the rocking limit, over the shear strength [-]
    residual: float = 0.4
    # Force at the point through which a storey reloads, over the force it aims for, and where that point lies on
    # the way from zero force to the line of unloading through the aim [-]; both 1 is no pinching
    pinch_force: float = 0.4
    pinch_drift: float = 0.8
    # Growth of the drift aimed for at each reversal, per unit of ductility beyond cracking, and of energy over the
    # area under both sides of the envelope [-]
    damage_ductility: float = 0.0
    damage_energy: float = 0.02
    # Exponent by which the unloading stiffness falls with ductility [-]
    unloading: float = 0.3

    def __post_init__(self) -> None:
        for known in fields(self):
            value = float(getattr(self, known.name))
            if not (math.isfinite(value) and value >= 0):
                raise InputError(
                    f"masonry: {known.name} must be zero or more, got {value}."
                )
            object.__setattr__(self, known.name, value)
        for fraction in (
            "cracking",
            "residual",
            "pinch_force",
            "pinch_drift",
            "unloading",
        ):
            if getattr(self, fraction) > 1:
                raise InputError(
                    f"masonry: {fraction} is a fraction and at most 1, got {getattr(self, fraction)}."
                )
        if not (self.base_shear > 0 and self.cracking > 0):
            raise InputError(
                "masonry: base_shear and cracking must be greater than zero."
            )
        if not 0 < self.yield_drift < self.shear_drift < self.rocking_drift:
            raise InputError(
                "masonry: drifts must rise from yield_drift over shear_drift to rocking_drift, got "
                f"{self.yield_drift}, {self.shear_drift}, {self.rocking_drift}."
            )


# more storeys than this are a slip of the keyboard and not a masonry building
MOST_STOREYS = 100
_LEAST, _MOST = 1e-9, 1e21


@dataclass(frozen=True)
class ModalDamping:
    """The same fraction of critical damping in every mode.

    Attributes
    ----------
    ratio : fraction of critical damping, below 1 [-]
    """

    ratio: float = 0.05

    def __post_init__(self) -> None:
        if not (math.isfinite(self.ratio) and 0 <= self.ratio < 1):
            raise InputError(
                f"damping: ratio must be a fraction of critical from 0 up to 1, got {self.ratio}."
            )


@dataclass(frozen=True)
class RayleighDamping(ModalDamping):
    """Damping proportional to mass and stiffness, with the ratio in two of the modes."""

    # Numbers of the two, from 1; the only one of one storey, with damping proportional to the mass
    modes: tuple[int, int] = (1, 2)

    def __post_init__(self) -> None:
        super().__post_init__()
        first, second = self.modes
        if not 1 <= first < second:
            raise InputError(
                f"Rayleigh damping: modes must be two rising numbers from 1, got {self.modes}."
            )


@dataclass(frozen=True)
class ShearBuilding:
    """Floors that only shift sideways, from the first above ground to the top.

    Attributes
    ----------
    masses : of each floor [kg]
    heights : of each storey [m]
    stiffnesses : lateral, of each storey [N/m]
    damping : modal or Rayleigh, by the elastic modes
    floors : label of each floor of interest and its level, 0 for the ground, ``storeys`` for the top
    model : ``elastic`` or ``hysteretic``
    masonry : law of the storeys: what the hysteretic model does, and by what the elastic one is judged
    name : for messages and provenance
    vertical_factors : factor on the vertical motion of the ground by label of floor [-], 1 if not named
    """

    masses: tuple[float, ...]
    heights: tuple[float, ...]
    stiffnesses: tuple[float, ...]
    damping: ModalDamping = ModalDamping()
    floors: Mapping[str, int] = field(default_factory=lambda: {"ground": 0})
    model: Literal["elastic", "hysteretic"] = "elastic"
    masonry: MasonryLaw = field(default_factory=MasonryLaw)
    name: str = "building"
    vertical_factors: Mapping[str, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        for what, unit in (("masses", "kg"), ("heights", "m"), ("stiffnesses", "N/m")):
            values = tuple(float(value) for value in getattr(self, what))
            check_positive(self.name, what, unit, values)
            object.__setattr__(self, what, values)
        if not len(self.masses) == len(self.heights) == len(self.stiffnesses):
            raise InputError(
                f"{self.name}: masses ({len(self.masses)}), heights ({len(self.heights)}) and "
                f"stiffnesses ({len(self.stiffnesses)}) must be equally many, one of each a storey."
            )
        if self.model not in ("elastic", "hysteretic"):
            raise InputError(
                f"{self.name}: model must be elastic or hysteretic, got {self.model!r}."
            )
        for label in (*self.floors, *self.vertical_factors):
            self.level(label)
        if isinstance(self.damping, RayleighDamping) and self.damping.modes[1] > max(
            self.storeys, 2
        ):
            raise InputError(
                f"{self.name}: Rayleigh damping names mode {self.damping.modes[1]}, but "
                f"{self.storeys} storeys have only {self.storeys} modes."
            )

    @property
    def storeys(self) -> int:
        """Number of storeys."""
        return len(self.masses)

    @property
    def mass(self) -> float:
        """Total mass above ground [kg]."""
        return sum(self.masses)

    def level(self, floor: str) -> int:
        """Level of a labelled floor, 0 for the ground; InputError if there is none."""
        if floor not in self.floors:
            known = ", ".join(self.floors)
            raise InputError(
                f"{self.name}: floor {floor!r} is not defined; known are {known}."
            )
        level = self.floors[floor]
        if (
            isinstance(level, bool)
            or not isinstance(level, int)
            or not 0 <= level <= self.storeys
        ):
            raise InputError(
                f"{self.name}: floor {floor!r} is level {level!r}, but levels run from 0, the "
                f"ground, to {self.storeys}, the top."
            )
        return level

    def stiffness_matrix(self) -> Floats:
        """Elastic stiffness matrix [N/m], shape (storeys, storeys)."""
        return chain_matrix(self.stiffnesses)


def chain_matrix(stiffnesses: Sequence[float]) -> Floats:
    """Stiffness matrix of springs in a row from the ground up [N/m], shape (storeys, storeys)."""
    k = np.asarray(stiffnesses, dtype=np.float64)
    above = np.append(k[1:], 0.0)
    return np.diag(k + above) - np.diag(k[1:], 1) - np.diag(k[1:], -1)


def stiffnesses_for_period(
    masses: Sequence[float], heights: Sequence[float], first_period: float
) -> tuple[float, ...]:
    """Storey stiffnesses proportional to 1/height that give the first period.

    Walls of the same section in every storey have the stiffness G A / h.

    Parameters
    ----------
    masses : of each floor [kg]
    heights : of each storey [m]
    first_period : wanted period of the first mode [s]

    Returns
    -------
    Stiffness of each storey [N/m].
    """
    check_positive("building", "first_period", "s", [first_period])
    check_positive("building", "masses", "kg", masses)
    check_positive("building", "heights", "m", heights)
    # compiled, which other checks need not wait for
    from rockfrag.building.modes import fill_stiffnesses

    loads = np.array(masses, dtype=np.float64)
    tall = np.array(heights, dtype=np.float64)
    found, memory = np.zeros(loads.size), np.zeros((2, loads.size, loads.size))
    fill_stiffnesses(loads, tall, float(first_period), *memory, found)
    return tuple(found.tolist())


def check_positive(owner: str, what: str, unit: str, values: Sequence[float]) -> None:
    """Raise an InputError unless there are one to ``MOST_STOREYS`` values, each positive."""
    if not 1 <= len(values) <= MOST_STOREYS:
        raise InputError(
            f"{owner}: {what} has {len(values)} entries, but a building has 1 to {MOST_STOREYS} storeys."
        )
    for number, value in enumerate(values, start=1):
        if not _LEAST <= value <= _MOST:
            raise InputError(
                f"{owner}: {what} must be positive numbers of {unit} (from {_LEAST:g} to {_MOST:g}), "
                f"entry {number} is {value}."
            )
