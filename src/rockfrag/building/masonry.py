"""What an unreinforced masonry storey can carry, and how far it can drift.

The envelope has four corners, the same on both sides: cracking, where the elastic stiffness ends;
yield, where the storey carries its shear strength; the shear limit, up to which it keeps that
strength; and the rocking limit, from which on only a residue is left. The drift limits are those of
EN 1998-3 for walls governed by shear (0.4 %) and by rocking (0.8 %); the yield drift is 0.1 %.
"""

import math
from dataclasses import dataclass, fields

from rockfrag.errors import InputError


@dataclass(frozen=True)
class MasonryLaw:
    """Degrading, pinching law of a masonry storey, calibrated by drift limits.

    Attributes
    ----------
    base_shear
        Shear strength of the ground storey over the weight of the building [-].
    cracking
        Shear at which the elastic stiffness ends, over the shear strength [-].
    yield_drift, shear_drift, rocking_drift
        Drift over storey height at yield, at the shear limit and at the rocking limit [-].
    residual
        Shear left beyond the rocking limit, over the shear strength [-].
    pinch_force
        Force at the point through which a storey reloads, over the force it aims for [-].
    pinch_drift
        Displacement of that point: its fraction of the way from zero force to the line of unloading
        through the aim [-].  Both fractions 1 is no pinching.
    damage_ductility, damage_energy
        Growth of the drift aimed for at each reversal, per unit of ductility beyond cracking and of
        energy over the area under both sides of the envelope [-]; repeated cycles lose force by it.
    unloading
        Exponent by which the unloading stiffness falls with ductility [-].
    """

    base_shear: float = 0.12
    cracking: float = 0.5
    yield_drift: float = 0.001
    shear_drift: float = 0.004
    rocking_drift: float = 0.008
    residual: float = 0.4
    pinch_force: float = 0.4
    pinch_drift: float = 0.8
    damage_ductility: float = 0.0
    damage_energy: float = 0.02
    unloading: float = 0.3

    def __post_init__(self) -> None:
        for field in fields(self):
            value = float(getattr(self, field.name))
            if not (math.isfinite(value) and value >= 0):
                raise InputError(f"masonry: {field.name} must be zero or more, got {value}.")
            object.__setattr__(self, field.name, value)
        for fraction in ("cracking", "residual", "pinch_force", "pinch_drift", "unloading"):
            if getattr(self, fraction) > 1:
                raise InputError(
                    f"masonry: {fraction} is a fraction and at most 1, got {getattr(self, fraction)}."
                )
        if not (self.base_shear > 0 and self.cracking > 0):
            raise InputError("masonry: base_shear and cracking must be greater than zero.")
        if not 0 < self.yield_drift < self.shear_drift < self.rocking_drift:
            raise InputError(
                "masonry: drifts must rise from yield_drift over shear_drift to rocking_drift, got "
                f"{self.yield_drift}, {self.shear_drift}, {self.rocking_drift}."
            )
