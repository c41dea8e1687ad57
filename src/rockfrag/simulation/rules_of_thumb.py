"""Engineers' rules: the factor on a motion at which each expects a symmetric block that stands alone to topple.

In: a block and a motion. Out: a factor on the motion [-]. What they are worth: ``docs/rules-of-thumb.md``, and
beside shake tables ``docs/scores.md``.
"""

import math
from collections.abc import Callable

import numpy as np

from rockfrag.base.units import GRAVITY
from rockfrag.motions.intensity import pgv
from rockfrag.motions.response_spectra import peak_displacements
from rockfrag.records.motion import Motion
from rockfrag.simulation.closed_forms import housner_velocity, kaneko_velocity
from rockfrag.system.blocks import Block

HOUSNER_PERIODS = np.linspace(0.1, 2.5, 25)
"""Periods of the velocity spectrum over which Housner's rule takes a mean, those of his intensity [s]."""

ANGLES = np.linspace(0.02, 1.0, 40)
"""Rotations over the critical angle at which ASCE 43-05 compares capacity with demand."""

Rule = Callable[[Block, Motion], float]


def static(block: Block, motion: Motion) -> float:
    """Factor at which the peak acceleration reaches b/h: what starts rocking is taken to topple.

    Parameters
    ----------
    block, motion : the block alone, and what shakes it

    Returns
    -------
    The factor on the motion [-].
    """
    return float(GRAVITY * math.tan(block.alpha) / motion.pga)


def housner(block: Block, motion: Motion) -> float:
    """Factor at which half of all motions topple the block by their velocity spectrum (Housner, 1963).

    The critical angle is Sv √(m R² / (g R I_O)), that is Sv = g α / p. Sv is the mean of the undamped
    pseudo-velocity spectrum from 0.1 to 2.5 s.
    """
    peaks = peak_displacements(motion, HOUSNER_PERIODS, 0.0)
    spectrum = peaks * (2 * math.pi / HOUSNER_PERIODS)
    return float(housner_velocity(block.alpha, block.frequency()) / spectrum.mean())


def peak_velocity(block: Block, motion: Motion) -> float:
    """Factor at which the peak velocity reaches g α / p, Housner's velocity read as that of the floor.

    Parameters
    ----------
    block, motion : the block alone, and what shakes it

    Returns
    -------
    The factor on the motion [-].
    """
    return float(housner_velocity(block.alpha, block.frequency()) / pgv(motion))


def kaneko(block: Block, motion: Motion) -> float:
    """Factor at which the peak velocity reaches that of Kaneko's curve; the height is twice that of the centre.

    Parameters
    ----------
    block, motion : the block alone, and what shakes it

    Returns
    -------
    The factor on the motion [-].
    """
    return kaneko_velocity(block.width, 2 * block.h) / pgv(motion)


def asce_43(block: Block, motion: Motion) -> float:
    """Factor at which the spectrum exceeds the capacity at every rotation up to the critical one (ASCE 43-05, A).

    A rocking block is taken for an oscillator: at the rotation θ it has the effective frequency
    √(2 (f - 1) g / (C h)) / (2π θ) with f = cos θ + a sin θ, a = b/h, C = (4/3) (1 + a²), the damping
    γ / √(4π² + γ²) with γ = -2 ln(1 - 2a²/C), and bears the spectral acceleration 2 g (f - 1) / θ, here without
    vertical shaking. The block topples where no rotation bears the demand.

    Parameters
    ----------
    block, motion : the block alone, and what shakes it

    Returns
    -------
    The factor on the motion [-].
    """
    a = math.tan(block.alpha)
    inertia = 4 / 3 * (1 + a**2)
    decrement = -2 * math.log(max(1 - 2 * a**2 / inertia, 1e-6))
    damping = decrement / math.sqrt(4 * math.pi**2 + decrement**2)
    theta = ANGLES * block.alpha
    lifted = np.cos(theta) + a * np.sin(theta) - 1
    frequency = np.sqrt(2 * lifted * GRAVITY / (inertia * block.h)) / (
        2 * math.pi * theta
    )
    capacity = 2 * GRAVITY * lifted / theta
    period = 1 / frequency
    demand = peak_displacements(motion, period, damping) * (2 * math.pi / period) ** 2
    return float((capacity / demand).max())


RULES: dict[str, Rule] = {
    "static b/h": static,
    "Housner 1963": housner,
    "peak velocity": peak_velocity,
    "ASCE 43-05 A": asce_43,
}
"""Rules by name."""
