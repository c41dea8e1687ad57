"""Jumps of the base's velocity: a bump, a stop, the landing of a drop, as an input of simulations.

In: instants [s] and jumps of the velocity [m/s]. Out: :class:`VelocitySteps`, which stands alone or in a
:class:`rockfrag.records.motion.GroundMotion`. Theory: ``docs/velocity-steps.md``.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from rockfrag.base.arrays import Floats
from rockfrag.base.errors import InputError
from rockfrag.base.input_checks import positive_number, real_array
from rockfrag.base.short_repr import short_repr
from rockfrag.base.units import GRAVITY

LEAST_GAP = 1e-9  # time between jumps [s] below which they are one
FASTEST = 100.0  # jump [m/s] beyond any impact that an object outlives


@dataclass(frozen=True)
class VelocitySteps:
    """Instants at which the velocity of the base jumps.

    Attributes
    ----------
    times : instants [s] from the first sample of a motion, rising, shape (n,)
    horizontal : jumps of the base's velocity to the right [m/s], shape (n,)
    vertical : jumps upwards [m/s], shape (n,); zeros if None
    """

    times: Floats
    horizontal: Floats
    vertical: Floats

    __repr__ = short_repr

    def __init__(
        self,
        times: ArrayLike | Sequence[float],
        horizontal: ArrayLike | Sequence[float],
        vertical: ArrayLike | Sequence[float] | None = None,
    ) -> None:
        given = {"times": times, "horizontal": horizontal}
        given["vertical"] = np.zeros(np.shape(times)) if vertical is None else vertical
        for name, values in given.items():
            found = np.atleast_1d(real_array(name, values)).astype(np.float64)
            if found.ndim != 1 or found.size == 0 or not np.isfinite(found).all():
                raise InputError(
                    f"velocity steps: {name} needs finite numbers of shape (n,) with n ≥ 1."
                )
            object.__setattr__(self, name, found)
        sizes = {self.times.size, self.horizontal.size, self.vertical.size}
        if len(sizes) > 1:
            raise InputError(
                "velocity steps: times, horizontal and vertical differ in number; give one jump an instant."
            )
        if self.times[0] < 0 or (np.diff(self.times) < LEAST_GAP).any():
            raise InputError(
                "velocity steps: times must rise from 0 on; sort them, and add jumps of one instant."
            )
        largest = float(np.abs([self.horizontal, self.vertical]).max())
        if largest > FASTEST:
            raise InputError(
                f"velocity steps: a jump of {largest:.3g} m/s is faster than anything outlives; check the unit."
            )

    def scaled(self, factor: float) -> tuple[Floats, Floats, Floats]:
        """Times [s], and the horizontal and vertical jumps [m/s] times a factor, shape (n,) each."""
        return self.times, factor * self.horizontal, factor * self.vertical


def bump_and_stop(velocity: float, distance: float) -> VelocitySteps:
    """A base that is hit, runs a distance freely and is stopped at once.

    Parameters
    ----------
    velocity : of the base between both jumps [m/s], to the left if negative
    distance : that it runs [m]

    Returns
    -------
    Jumps to the velocity at once, and back after distance/velocity.
    """
    positive_number("distance", distance, "m")
    speed = positive_number("velocity", abs(velocity), "m/s")
    return VelocitySteps([0.0, distance / speed], [velocity, -velocity])


def landing(height: float) -> VelocitySteps:
    """A base that has fallen with all that stands on it, and lands at once.

    Parameters
    ----------
    height : of the fall [m]

    Returns
    -------
    One jump upwards, √(2 g height), at once.
    """
    fall = positive_number("height", height, "m")
    return VelocitySteps([0.0], [0.0], [float(np.sqrt(2 * GRAVITY * fall))])
