"""Formulas of a rocking block that tests hold the integrators against.

Unless it says otherwise a formula belongs to the slender linearised equation (Housner, 1963),
θ'' = p² (θ - s θc) - p² a/g.  Arguments are taken as they are.
"""

import math
from dataclasses import dataclass

from rockfrag.system.blocks import Block
from rockfrag.units import GRAVITY


def housner_half_sine(omega: float, p: float) -> float:
    """Housner's (1963) amplitude x for half a sine, √(1 + ω²/p²) [-].

    He let the block start with the pulse; it starts at ω t0 = asin(1/x), and ``half_sine_pulse`` is right and
    lower.
    """
    return math.hypot(1, omega / p)


def west_acceleration(block: Block, g: float = GRAVITY) -> float:
    """Least acceleration that starts rocking, and the one West's formula overturns at, (b/h) g [m/s²].

    Milne & Omori (1893), Kirkpatrick (1927).
    """
    return min(abs(block.arm(s).x) / block.arm(s).y for s in (1, -1)) * g


@dataclass(frozen=True)
class LowerBounds:
    """Least peak acceleration [m/s²] and velocity [m/s] of a motion that may overturn."""

    acceleration: float
    velocity: float


def ishiyama_bounds(block: Block, g: float = GRAVITY) -> LowerBounds:
    """Lower bounds of overturning, a ≥ (B/H) g and v ≥ 10 B/√H with lengths in cm (Ishiyama 1982).

    With B and H in metres the velocity is B/√H m/s, which holds for the Earth's gravity.
    """
    return LowerBounds(
        acceleration=block.width / block.height * g,
        velocity=block.width / math.sqrt(block.height),
    )
