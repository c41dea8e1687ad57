"""What can be said about a rocking block without integrating its motion step by step.

Unless it says otherwise a formula belongs to the slender linearised equation (Housner, 1963),
θ'' = p² (θ - s θc) - p² a/g, in which only the frequency parameter p [1/s], the critical angle θc [rad]
and g [m/s²] appear.  Amplitudes of pulses are given as x = a / (θc g), dimensionless.
"""

import math
from collections.abc import Callable

from scipy.optimize import brentq

from rockfrag.errors import InputError
from rockfrag.units import GRAVITY


def _positive(**values: float) -> None:
    for name, value in values.items():
        if not (math.isfinite(value) and value > 0):
            raise InputError(f"{name}: must be a positive number, got {value}.")


def rectangular_pulse(duration: float, p: float) -> float:
    """Least amplitude x of a rectangular pulse that overturns [-]; p T = ln(x / (x - 1)).

    The same as Housner's (1963) cosh p T = 1 + 1 / (2 x (x - 1)).
    """
    _positive(duration=duration, p=p)
    return -1 / math.expm1(-p * duration)


def half_sine_pulse(omega: float, p: float) -> float:
    """Least amplitude x of half a sine, x θc g sin ωt, that overturns [-] (Shi et al. 1996).

    Parameters
    ----------
    omega
        Circular frequency of the pulse [rad/s].
    p
        Frequency parameter [1/s].
    """
    return _sine(omega, p, math.pi)


def one_sine_pulse(omega: float, p: float) -> float:
    """Least amplitude x of one full sine that overturns without an impact [-].

    Zhang & Makris (2001); overturning after an impact may need less.
    """
    return _sine(omega, p, 2 * math.pi)


def _sine(omega: float, p: float, phase: float) -> float:
    """Solve x p ∫ exp(-p (t - t0)) sin ωt dt = 1 from ω t0 = asin(1/x) to ω t = ``phase``."""
    _positive(omega=omega, p=p)

    def part(angle: float) -> float:
        # antiderivative of exp(-p t) sin ωt where ωt is this angle, divided by exp(-p t)
        return -(p * math.sin(angle) + omega * math.cos(angle)) / (p**2 + omega**2)

    def excess(x: float) -> float:
        begin = math.asin(1 / x)
        return x * p * (math.exp(-p * (phase - begin) / omega) * part(phase) - part(begin)) - 1

    return _root(excess)


def one_cosine_pulse(omega: float, p: float) -> float:
    """Least amplitude x of one full cosine that overturns without an impact [-].

    Zhang & Makris (2001): rocking starts at once, x (1 - exp(-2π p/ω)) = 1 + ω²/p².
    """
    _positive(omega=omega, p=p)
    return (1 + (omega / p) ** 2) / -math.expm1(-2 * math.pi * p / omega)


def _root(function: Callable[[float], float]) -> float:
    upper = 2.0
    while function(upper) < 0:
        upper *= 2
    return float(brentq(function, 1.0, upper, xtol=1e-14, rtol=1e-14))


def housner_velocity(alpha: float, p: float) -> float:
    """Ground velocity of a sudden step that just overturns a slender block, θc g / p [m/s].

    Housner (1963): θc = v √(m R / (g I_O)), by equating energies; with v the velocity spectrum's
    ordinate he gave it as the earthquake that overturns half of such blocks.
    """
    _positive(alpha=alpha, p=p)
    return alpha * GRAVITY / p
