"""Formulas of a rocking block that tests hold the integrators against.

Unless it says otherwise a formula belongs to the slender linearised equation (Housner, 1963),
θ'' = p² (θ - s θc) - p² a/g.  Arguments are taken as they are.
"""

import math

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


def ishiyama_bounds(block: Block, g: float = GRAVITY) -> tuple[float, float]:
    """Least peak acceleration [m/s²] and velocity [m/s] of a motion that may overturn (Ishiyama 1982).

    a ≥ (B/H) g and v ≥ 10 B/√H with lengths in cm: with B and H in metres B/√H m/s, for the Earth's gravity.
    """
    return block.width / block.height * g, block.width / math.sqrt(block.height)
