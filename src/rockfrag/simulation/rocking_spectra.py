"""Rocking spectra: peak rotation and velocity of geometrically similar blocks (Makris and Konstantinidis, 2003).

As a response spectrum shows oscillators of one damping over their period, a rocking spectrum shows blocks
of one slenderness over 2π/p (Makris and Konstantinidis 2003, Earthquake Eng. Struct. Dyn. 32, 265-289).

In: a motion, periods 2π/p [s] and angles [rad]. Out: rotations over the critical angle and velocities over p.
Docs: ``docs/rocking.md``, "Rocking spectra".
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rockfrag.base.arrays import Floats
from rockfrag.base.elementary import sin_cos
from rockfrag.base.errors import InputError
from rockfrag.base.input_checks import real_array
from rockfrag.base.keywords import named_keywords
from rockfrag.base.short_repr import short_repr
from rockfrag.base.units import GRAVITY
from rockfrag.engines.steps import fastest_frequency
from rockfrag.records.motion import Motion
from rockfrag.simulation.ensemble import overturns
from rockfrag.simulation.inputs import MotionLike
from rockfrag.simulation.options import FrictionInput, Restitution
from rockfrag.system.blocks import Block

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True)
class RockingSpectrum:
    """Peak rotations and velocities of uniform blocks."""

    period: Floats  # 2π/p of the blocks [s], shape (k,)
    alpha: Floats  # critical angles of the blocks, their slenderness [rad], shape (j,)
    # max |θ| / α [-], shape (j, k); infinite where the block overturns, zero where it never rocks
    rotation: Floats
    # max |θ'| / p [rad], shape (j, k); infinite where the block overturns
    velocity: Floats

    __repr__ = short_repr

    @property
    def overturned(self) -> NDArray[np.bool_]:
        """Whether the block overturns, shape (j, k)."""
        return np.isinf(self.rotation)

    def plot(self, title: str = "") -> Figure:
        """Draw peak rotations and angular velocities over 2π/p, a line an angle, and where blocks overturn.

        Parameters
        ----------
        title : heading of the figure

        Returns
        -------
        matplotlib.figure.Figure
            Rotation over the critical angle [-] above, angular velocity over p [rad] below; a cross at the upper
            edge marks a block that overturns.
        """
        # matplotlib is loaded only by those who draw
        from rockfrag.simulation.figures import spectrum_figure

        return spectrum_figure(self, title)


def uniform_block(alpha: float, period: float, g: float = GRAVITY) -> Block:
    """Uniform block of critical angle α and period 2π/p, p = √(3g/4R) (Housner, 1963).

    Parameters
    ----------
    alpha, period, g : critical angle [rad], period [s] and gravity [m/s²]

    Returns
    -------
    The block.
    """
    if not 0 < alpha < math.pi / 2:
        raise InputError(
            f"alpha: a critical angle lies between 0 and π/2 rad, got {alpha}."
        )
    if not (math.isfinite(period) and period > 0):
        raise InputError(
            f"period: 2π/p must be a positive number of seconds, got {period}."
        )
    radius = 3 * g * period * period / (16 * math.pi * math.pi)
    sine, cosine = sin_cos(alpha)
    width, height = 2 * radius * sine, 2 * radius * cosine
    return Block(width, height, 1000 * width * height)


@named_keywords
def rocking_spectrum(
    motion: Motion,
    periods: ArrayLike,
    alpha: ArrayLike | Sequence[float],
    *,
    restitution: Restitution = None,
    friction: FrictionInput | None = None,
    vertical: MotionLike | None = None,
) -> RockingSpectrum:
    """Rocking spectrum of a motion, for free-standing uniform blocks.

    Parameters
    ----------
    motion : ground acceleration, linear between samples; the free rocking after it counts too
    periods : 2π/p [s], shape (k,)
    alpha : critical angles [rad], one or several, shape (j,)
    restitution, friction : the same for all, as in :func:`rockfrag.simulation.simulate`
    vertical : vertical acceleration, upwards [m/s²], sampled as the motion

    Returns
    -------
    The :class:`RockingSpectrum`: peak ``rotation`` over the critical angle and ``velocity`` over p, infinite where
    the block overturns, and ``overturned``, of shape (j, k), angles × periods.

    Examples
    --------
    Of blocks of one slenderness the larger ones stand longer:

    >>> from rockfrag import rocking_spectrum
    >>> from rockfrag.motions import one_sine
    >>> rocking_spectrum(one_sine(4.0, period=1.0), periods=[2.0, 4.0, 6.0], alpha=0.25).overturned
    array([[ True, False, False]])
    """
    period = np.atleast_1d(real_array("periods", periods, "s"))
    angle = np.atleast_1d(real_array("alpha", alpha, "rad"))
    if period.ndim != 1 or angle.ndim != 1 or period.size == 0 or angle.size == 0:
        raise InputError(
            "rocking spectrum: give at least one period and one angle, in a row each."
        )
    blocks = [uniform_block(float(a), float(T)) for a in angle for T in period]
    found = overturns(
        blocks,
        motion,
        restitution=[restitution] * len(blocks),
        friction=None if friction is None else [friction] * len(blocks),
        vertical=vertical,
    )
    shape = (angle.size, period.size)
    rotation = found.of_top("peak_rotation").reshape(shape)
    p = np.array([fastest_frequency(block, GRAVITY) for block in blocks]).reshape(shape)
    fastest = found.of_top("peak_velocity").reshape(shape)
    velocity = np.where(np.isinf(rotation), np.inf, fastest / p)
    return RockingSpectrum(period, angle, rotation, velocity)
