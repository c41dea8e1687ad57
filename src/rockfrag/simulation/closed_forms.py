"""What can be said about a rocking block without integrating its motion step by step.

Unless it says otherwise a formula belongs to the slender linearised equation (Housner, 1963),
θ'' = p² (θ - s θc) - p² a/g, in which only the frequency parameter p [1/s], the critical angle θc [rad]
and g [m/s²] appear.  Amplitudes of pulses are given as x = a / (θc g), dimensionless.
"""

import math

from scipy.optimize import brentq

from rockfrag.base.input_checks import positive_number
from rockfrag.base.units import GRAVITY


def one_sine_pulse(omega: float, p: float) -> float:
    """Least amplitude x of one full sine that overturns without an impact [-].

    Zhang & Makris (2001): x p ∫ exp(-p (t - t0)) sin ωt dt = 1 from ω t0 = asin(1/x) to ω t = 2π; overturning
    after an impact may need less.
    """
    positive_number("omega", omega, "rad/s")
    positive_number("p", p, "1/s")
    phase = 2 * math.pi

    def part(angle: float) -> float:
        # antiderivative of exp(-p t) sin ωt where ωt is this angle, divided by exp(-p t)
        return -(p * math.sin(angle) + omega * math.cos(angle)) / (p**2 + omega**2)

    def excess(x: float) -> float:
        begin = math.asin(1 / x)
        return (
            x * p * (math.exp(-p * (phase - begin) / omega) * part(phase) - part(begin))
            - 1
        )

    upper = 2.0
    while excess(upper) < 0:
        upper *= 2
    return float(brentq(excess, 1.0, upper, xtol=1e-14, rtol=1e-14))


def housner_velocity(alpha: float, p: float) -> float:
    """Ground velocity of a sudden step that just overturns a slender block, θc g / p [m/s].

    Housner (1963): θc = v √(m R / (g I_O)), by equating energies; with v the velocity spectrum's
    ordinate he gave it as the earthquake that overturns half of such blocks.

    Parameters
    ----------
    alpha, p : critical angle [rad] and frequency parameter [1/s]

    Returns
    -------
    The velocity [m/s].
    """
    positive_number("alpha", alpha, "radians")
    positive_number("p", p, "1/s")
    return alpha * GRAVITY / p
