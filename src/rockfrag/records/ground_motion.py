"""What shakes a system: one to three components of acceleration on one time base."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rockfrag.errors import InputError
from rockfrag.records.motion import Motion

SAME_STEP = 1e-9  # relative difference of sampling intervals that is rounding of a file


@dataclass(frozen=True)
class GroundMotion:
    """Acceleration of the ground or floor: along x, and where it is known along y and upwards (z).

    Attributes
    ----------
    x
        Horizontal component along the x axis of the bodies, the plane of planar ones.
    y
        Horizontal component across that plane; None where it is not given.
    z
        Vertical component, upwards; None where it is not given.

    Raises
    ------
    InputError
        If the components are not sampled at the same times.
    """

    x: Motion
    y: Motion | None = None
    z: Motion | None = None

    def __post_init__(self) -> None:
        for name, other in (("y", self.y), ("z", self.z)):
            if other is None:
                continue
            if abs(other.dt - self.x.dt) > SAME_STEP * self.x.dt:
                raise InputError(
                    f"ground motion {self.name!r}: component {name} is sampled every {other.dt:g} s, component x "
                    f"every {self.x.dt:g} s; resample one of them."
                )
            if other.acceleration.size != self.x.acceleration.size:
                raise InputError(
                    f"ground motion {self.name!r}: component {name} has {other.acceleration.size} samples, "
                    f"component x {self.x.acceleration.size}; cut or pad one of them."
                )

    @property
    def dt(self) -> float:
        """Sampling interval [s]."""
        return self.x.dt

    @property
    def name(self) -> str:
        """Name of the component along x."""
        return self.x.name

    @property
    def components(self) -> str:
        """The components that are given: ``"x"``, ``"xz"``, ``"xy"`` or ``"xyz"``."""
        return "x" + ("y" if self.y is not None else "") + ("z" if self.z is not None else "")

    @property
    def accelerations(self) -> NDArray[np.float64]:
        """Accelerations along x, y and z [m/s²], shape (n, 3); zero where a component is not given."""
        found = np.zeros((self.x.acceleration.size, 3))
        for k, motion in enumerate((self.x, self.y, self.z)):
            if motion is not None:
                found[:, k] = motion.acceleration
        return found
