"""Formulas of a rocking block that tests hold the integrators against.

Unless it says otherwise a formula belongs to the slender linearised equation (Housner, 1963),
θ'' = p² (θ - s θc) - p² a/g.  Arguments are taken as they are.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.integrate import quad

from rockfrag.system.blocks import Block
from rockfrag.units import GRAVITY


def free_rotation(time: ArrayLike, theta0: float, alpha: float, p: float) -> NDArray[np.float64]:
    """Rotation after release from rest until the first impact [rad] (Housner, 1963).

    Parameters
    ----------
    time
        Time since release [s], up to a quarter of the period.
    theta0, alpha
        Rotation at release and critical angle [rad].
    p
        Frequency parameter [1/s].
    """
    t = np.asarray(time, dtype=np.float64)
    return np.asarray(alpha - (alpha - theta0) * np.cosh(p * t), dtype=np.float64)


def free_period(theta0: float, alpha: float, p: float) -> float:
    """Period of free rocking without loss [s] (Housner, 1963).

    Parameters
    ----------
    theta0, alpha
        Amplitude and critical angle [rad].
    p
        Frequency parameter [1/s].
    """
    return 4 / p * math.acosh(1 / (1 - theta0 / alpha))


def quarter_period(theta0: float, alpha: float, p: float) -> float:
    """Time from rest at ``theta0`` to the first impact by the exact equation [s].

    The energy integral p t = ∫ dψ / √(2 (cos ψ0 - cos ψ)) over ψ = α - θ, an elliptic integral, with
    sin(ψ/2) = sin(ψ0/2) cosh u, which takes the singularity at the release away.
    """
    if theta0 == 0:
        return 0.0
    k = math.sin((alpha - theta0) / 2)
    end = math.acosh(math.sin(alpha / 2) / k)
    integral, _ = quad(
        lambda u: 1 / math.sqrt(1 - (k * math.cosh(u)) ** 2), 0.0, end, epsabs=0.0, epsrel=1e-12
    )
    return float(integral) / p


def next_amplitude(phi: float, restitution: float) -> float:
    """Amplitude of free rocking after one more impact, over the critical angle [-] (Housner 1963).

    Parameters
    ----------
    phi
        Amplitude before the impact over the critical angle, 0 to 1 [-].
    restitution
        Ratio of angular velocities after and before the impact [-].
    """
    return 1 - math.sqrt(1 - restitution**2 * (1 - (1 - phi) ** 2))


@dataclass(frozen=True)
class NoImpact:
    """The no-impact criterion for one motion.

    Parameters
    ----------
    start
        When rocking starts [s]; NaN if it never does.
    pivot
        Pivot it starts on, +1 or -1; 0 if it never does.
    value
        -s p ∫ exp(-p (t - t0)) a/(θc g) dt from the start to the motion's end [-]: above 1 a block that
        has not come down by then overturns.
    impact
        Whether the block comes down before the motion ends, so that the criterion says nothing.
    """

    start: float
    pivot: int
    value: float
    impact: bool

    @property
    def overturns(self) -> bool:
        """Whether the block overturns without an impact."""
        return self.pivot != 0 and not self.impact and self.value > 1


def no_impact(
    acceleration: ArrayLike, dt: float, alpha: float, p: float, g: float = GRAVITY
) -> NoImpact:
    """Judge overturning without an impact for any motion, linear between samples, exactly.

    With u = s θ/θc the growing part E = u + u'/p - 1 of the solution obeys E' = p E - p s a/(θc g) from
    E = -1, so the block overturns if and only if the weighted integral exceeds 1, unless it has come
    down first (which is looked for at the samples).  For sine pulses this is the condition of Shi,
    Anooshehpoor, Zeng & Brune (1996).

    Parameters
    ----------
    acceleration
        Acceleration of the ground at the samples [m/s²], shape (n,), n ≥ 2; zero afterwards.
    dt
        Time between samples [s].
    alpha, p, g
        Critical angle [rad], frequency parameter [1/s], gravity [m/s²].
    """
    motion = np.asarray(acceleration, dtype=np.float64)
    y = motion / (alpha * g)
    outside = np.flatnonzero(np.abs(y) > 1)
    if outside.size == 0:
        return NoImpact(math.nan, 0, 0.0, False)
    first = int(outside[0])
    level = math.copysign(1.0, y[first])
    # where the line from the sample before reaches the threshold
    lead = 0.0 if first == 0 else dt * float((y[first] - level) / (y[first] - y[first - 1]))
    after = level * y[first:]
    if first > 0:
        after = np.concatenate([[1.0], after])
    times = lead + dt * np.arange(motion.size - first)
    if first > 0:
        times = np.concatenate([[0.0], times])
    value, impact = _weigh(times.astype(np.float64), after.astype(np.float64), p)
    return NoImpact(first * dt - lead, -int(level), value, impact)


def _weigh(times: NDArray[np.float64], drive: NDArray[np.float64], p: float) -> tuple[float, bool]:
    """Integral of the criterion, and whether u = 1 + (E + D)/2 falls below zero at a sample.

    D = u - u'/p - 1 is the decaying part, D' = -p D - p v, with v the drive.
    """
    integral, decay, impact = 0.0, -1.0, False
    for k in range(times.size - 1):
        begin, reach = p * float(times[k]), p * float(times[k + 1])
        h = float(times[k + 1] - times[k])
        if h == 0 or reach > 500:  # exp(-500): nothing is left to weigh
            continue
        v, slope = float(drive[k]), float(drive[k + 1] - drive[k]) / h
        shrink, gone = math.exp(-p * h), -math.expm1(-p * h)
        integral += math.exp(-begin) * (v * gone + slope * (gone / p - h * shrink))
        decay = decay * shrink - v * gone - slope * (h - gone / p)
        growth = math.exp(reach) * (integral - 1)
        impact = impact or 1 + (growth + decay) / 2 < 0
    return integral, impact


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
