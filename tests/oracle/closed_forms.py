"""Formulas of a rocking block that tests hold the integrators against.

Unless it says otherwise a formula belongs to the slender linearised equation (Housner, 1963),
θ'' = p² (θ - s θc) - p² a/g.  Arguments are taken as they are.
"""

import math
from dataclasses import dataclass

from scipy.integrate import quad
from scipy.optimize import brentq

from rockfrag.system.blocks import Block
from rockfrag.units import GRAVITY


def housner_half_sine(omega: float, p: float) -> float:
    """Housner's (1963) amplitude x for half a sine, √(1 + ω²/p²) [-].

    He let the block start with the pulse; it starts at ω t0 = asin(1/x), and ``half_sine_pulse`` is right and
    lower.
    """
    return math.hypot(1, omega / p)


def half_sine_pulse(omega: float, p: float) -> float:
    """Least amplitude x of half a sine that overturns [-] (Shi et al. 1996).

    x p ∫ exp(-p (t - t0)) sin ωt dt = 1 from ω t0 = asin(1/x) to ω t = π.
    """

    def excess(x: float) -> float:
        start = math.asin(1 / x) / omega
        pulled = quad(
            lambda t: math.exp(-p * (t - start)) * math.sin(omega * t), start, math.pi / omega
        )
        return x * p * pulled[0] - 1

    return float(brentq(excess, 1.0, housner_half_sine(omega, p)))


def rectangular_pulse(duration: float, p: float) -> float:
    """Least amplitude x of a rectangular pulse that overturns [-]; p T = ln(x / (x - 1))."""
    return -1 / math.expm1(-p * duration)


def one_cosine_pulse(omega: float, p: float) -> float:
    """Least amplitude x of one full cosine that overturns without an impact [-].

    Zhang & Makris (2001): rocking starts at once, x (1 - exp(-2π p/ω)) = 1 + ω²/p².
    """
    return (1 + (omega / p) ** 2) / -math.expm1(-2 * math.pi * p / omega)


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
        acceleration=block.width / block.height * g, velocity=block.width / math.sqrt(block.height)
    )
