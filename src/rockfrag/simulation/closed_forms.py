"""What can be said about a rocking block without integrating its motion step by step.

Unless it says otherwise a formula belongs to the slender linearised equation (Housner, 1963),
θ'' = p² (θ - s θc) - p² a/g, in which only the frequency parameter p [1/s], the critical angle θc [rad]
and g [m/s²] appear.  Amplitudes of pulses are given as x = a / (θc g), dimensionless.

In: a slender block, or its p [1/s] and θc [rad], and a pulse. Out: thresholds, amplitudes and times.
Theory: ``docs/rocking.md``, "What the model is"; of jumps of the base ``docs/velocity-steps.md``, "Closed forms".
"""

import math

from rockfrag.base.input_checks import positive_number
from rockfrag.base.units import GRAVITY


def one_sine_pulse(omega: float, p: float) -> float:
    """Least amplitude x of one full sine that overturns without an impact [-].

    Zhang & Makris (2001): x p ∫ exp(-p (t - t0)) sin ωt dt = 1 from ω t0 = asin(1/x) to ω t = 2π; overturning
    after an impact may need less.
    """
    from scipy.optimize import brentq

    positive_number("omega", omega, "rad/s")
    positive_number("p", p, "1/s")
    phase = 2 * math.pi

    def part(angle: float) -> float:
        # antiderivative of exp(-p t) sin ωt where ωt is this angle, divided by exp(-p t)
        return -(p * math.sin(angle) + omega * math.cos(angle)) / (p**2 + omega**2)

    def excess(x: float) -> float:
        """Zero where an amplitude, over the one that lifts, just overturns; rises with it."""
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


def critical_double_impulse(width: float, height: float, g: float = GRAVITY) -> float:
    """Velocity of the critical double impulse that just overturns a uniform block, not linearised [m/s].

    The base jumps to the velocity V, and back to rest at the worst instant: as the block, thrown over one corner
    by the first jump, has just come down on both (Nabeshima, Taniguchi, Kojima and Takewaki, 2016, Front. Built
    Environ. 2:9). A jump gives the rate m h V / I_O; the impact leaves e = 1 - 1.5 sin²α of it; and the second
    jump adds the same again, so that (1 + e) m h V / I_O = p √(2 (1 - cos α)) just passes balance. The limit grows
    with the root of the size.

    Parameters
    ----------
    width, height : of the block [m]
    g : acceleration of gravity [m/s²]

    Returns
    -------
    The velocity V [m/s].
    """
    alone = critical_jump(width, height, g)
    left = 1 - 1.5 * math.sin(math.atan2(width, height)) ** 2
    return alone / (1 + left)


def critical_jump(width: float, height: float, g: float = GRAVITY) -> float:
    """Jump of the base's velocity that just overturns a uniform block at rest, not linearised [m/s].

    m h V / I_O = p √(2 (1 - cos α)); of a slender block this is Housner's θc g / p.

    Parameters
    ----------
    width, height : of the block [m]
    g : acceleration of gravity [m/s²]

    Returns
    -------
    The velocity V [m/s].
    """
    b = positive_number("width", width, "m") / 2
    h = positive_number("height", height, "m") / 2
    alpha, radius = math.atan2(b, h), math.hypot(b, h)
    # m h / I_O of a uniform block is 3 h / 4 R²
    return critical_rate(alpha, radius, g) * 4 * radius**2 / (3 * h)


def critical_rate(alpha: float, radius: float, g: float) -> float:
    """Angular velocity as it leaves rest that just takes a uniform block to balance, p √(2 (1 - cos α)) [rad/s].

    ``alpha`` [rad], ``radius`` [m]: slenderness and half the diagonal; ``g`` [m/s²].
    """
    p = math.sqrt(3 * g / (4 * radius))
    return p * math.sqrt(2 * (1 - math.cos(alpha)))


def kaneko_velocity(width: float, height: float) -> float:
    """Peak velocity of the floor that overturns half of all pieces of furniture (Kaneko and Hayashi) [m/s].

    V50 = 10 (B/√H) (1 + B/H)^2.5 in cm and s, above the boundary frequency (15.6/√H) (1 + B/H)^-1.5 Hz, as
    Japanese authorities use it. The form in velocity was read at second hand; that in acceleration, g (B/H) (1 +
    B/H) below that frequency, agrees with official tables, and the two meet at it.

    Parameters
    ----------
    width, height : side that rocks, and height of the piece [m]

    Returns
    -------
    The median [m/s].
    """
    width_cm = 100 * positive_number("width", width, "m")
    height_cm = 100 * positive_number("height", height, "m")
    ratio = width_cm / height_cm
    return float(0.1 * width_cm / math.sqrt(height_cm) * (1 + ratio) ** 2.5)


def kaneko_acceleration(width: float, height: float) -> float:
    """Peak acceleration of a slow floor that overturns half of all pieces, g (B/H) (1 + B/H) [m/s²].

    Parameters
    ----------
    width, height : side that rocks, and height of the piece [m]

    Returns
    -------
    The median [m/s²], below the boundary frequency of :func:`kaneko_velocity`.
    """
    ratio = positive_number("width", width, "m") / positive_number(
        "height", height, "m"
    )
    return GRAVITY * ratio * (1 + ratio)
