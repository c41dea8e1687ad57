"""Response and Fourier spectra of a motion."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numba import njit
from numpy.typing import ArrayLike, NDArray

from rockfrag.errors import InputError
from rockfrag.records.motion import Motion

Floats = NDArray[np.float64]

STEPS_PER_PERIOD = 50
"""Least number of steps in one natural period.

Between two steps a response is taken as the cubic through both values and both slopes; its error is
at most (2π/50)⁴/384 = 6.5e-7 of the amplitude, so peaks are right to six digits.
"""


@dataclass(frozen=True)
class ResponseSpectrum:
    """Peaks of linear oscillators of one damping, over the motion and one period of free vibration.

    Attributes
    ----------
    period
        Natural periods [s], shape (k,).
    damping
        Fraction of critical damping [-].
    displacement
        Sd, peak relative displacement [m], shape (k,).
    velocity
        Sv, peak relative velocity [m/s], shape (k,).
    acceleration
        Sa, peak absolute (total) acceleration [m/s²], shape (k,).
    """

    period: Floats
    damping: float
    displacement: Floats
    velocity: Floats
    acceleration: Floats

    @property
    def pseudo_velocity(self) -> Floats:
        """PSV = ω Sd [m/s], shape (k,)."""
        return self.displacement * (2 * math.pi / self.period)

    @property
    def pseudo_acceleration(self) -> Floats:
        """PSA = ω² Sd [m/s²], shape (k,)."""
        return self.displacement * (2 * math.pi / self.period) ** 2


def oscillator_matrix(omega: float, damping: float, step: float) -> Floats:
    """Exact propagator of an oscillator over one step of linearly varying ground acceleration.

    The state is (u, u', a, s): relative displacement and velocity, ground acceleration and its
    slope; u'' + 2 ζ ω u' + ω² u = -a, a' = s.  Nigam & Jennings (1969, Bull. Seism. Soc. Am. 59(2),
    909-922), for any damping, at and above critical too.

    Returns
    -------
    Array of shape (2, 4) that maps (u, u', a, s) to (u, u') one step [s] later.
    """
    rate = damping * omega
    turn = omega * math.sqrt(abs(1 - damping**2))
    if damping < 1:
        decay = math.exp(-rate * step)
        cosine, sine = decay * math.cos(turn * step), decay * math.sin(turn * step) / turn
    elif damping > 1:
        slow, fast = math.exp((turn - rate) * step), math.exp(-(turn + rate) * step)
        cosine, sine = (slow + fast) / 2, (slow - fast) / (2 * turn)
    else:
        cosine, sine = math.exp(-rate * step), step * math.exp(-rate * step)
    free = np.array([[cosine + rate * sine, sine], [-(omega**2) * sine, cosine - rate * sine]])
    # the steady answer to a and to s at the beginning of the step, and one step later
    before = np.array([[-1.0, 2 * damping / omega], [0.0, -1.0]]) / omega**2
    after = before + np.array([[0.0, -step], [0.0, 0.0]]) / omega**2
    return np.hstack([free, after - free @ before])


@njit(cache=True)
def _histories(acceleration: Floats, step: float, matrix: Floats) -> tuple[Floats, Floats]:
    """Relative displacement and velocity at the samples, from rest."""
    n = acceleration.size
    u, v = np.zeros(n), np.zeros(n)
    for i in range(n - 1):
        a = acceleration[i]
        s = (acceleration[i + 1] - a) / step
        u[i + 1] = matrix[0, 0] * u[i] + matrix[0, 1] * v[i] + matrix[0, 2] * a + matrix[0, 3] * s
        v[i + 1] = matrix[1, 0] * u[i] + matrix[1, 1] * v[i] + matrix[1, 2] * a + matrix[1, 3] * s
    return u, v


@njit(cache=True)
def _cubic_peak(x0: float, m0: float, x1: float, m1: float, h: float) -> float:
    """Peak absolute value of the cubic with values x0, x1 and slopes m0, m1 at the ends of h."""
    peak = max(abs(x0), abs(x1))
    if m0 * m1 >= 0:
        return peak
    rise = x1 - x0
    a = 3 * (h * (m0 + m1) - 2 * rise)
    b = 2 * (3 * rise - h * (2 * m0 + m1))
    c = h * m0
    # a ξ² + b ξ + c = 0 has exactly one root in (0, 1), because the slope changes sign once
    root = math.sqrt(max(b * b - 4 * a * c, 0.0))
    q = -0.5 * (b + math.copysign(root, b))
    for numerator, denominator in ((q, a), (c, q)):
        if denominator != 0.0:
            xi = numerator / denominator
            if 0.0 < xi < 1.0:
                value = x0 + xi * (c + xi * (b / 2 + xi * a / 3))
                peak = max(peak, abs(value))
    return peak


@njit(cache=True)
def _peaks(
    acceleration: Floats, step: float, parts: int, matrix: Floats, omega: float, damping: float
) -> tuple[float, float, float]:
    """Peaks of relative displacement and velocity and total acceleration, between steps too."""
    u = v = sd = sv = sa = 0.0
    c, k = 2 * damping * omega, omega * omega
    for i in range(acceleration.size - 1):
        start = acceleration[i]
        s = (acceleration[i + 1] - start) / (parts * step)
        for j in range(parts):
            a = start + j * step * s
            b = a + step * s
            u1 = matrix[0, 0] * u + matrix[0, 1] * v + matrix[0, 2] * a + matrix[0, 3] * s
            v1 = matrix[1, 0] * u + matrix[1, 1] * v + matrix[1, 2] * a + matrix[1, 3] * s
            total0, total1 = -(c * v + k * u), -(c * v1 + k * u1)
            relative0, relative1 = total0 - a, total1 - b
            sd = max(sd, _cubic_peak(u, v, u1, v1, step))
            sv = max(sv, _cubic_peak(v, relative0, v1, relative1, step))
            jerk0, jerk1 = -(c * relative0 + k * v), -(c * relative1 + k * v1)
            sa = max(sa, _cubic_peak(total0, jerk0, total1, jerk1, step))
            u, v = u1, v1
    return sd, sv, sa


def oscillator_response(
    motion: Motion, period: float, damping: float = 0.05
) -> tuple[Floats, Floats, Floats]:
    """Response history of a linear oscillator at rest at first; exact at the samples.

    Parameters
    ----------
    motion
        Ground acceleration, linear between samples, n of them.
    period
        Natural period [s].
    damping
        Fraction of critical damping [-], zero or more.

    Returns
    -------
    displacement, velocity, acceleration
        Relative displacement [m], relative velocity [m/s] and absolute acceleration [m/s²], each of
        shape (n,).

    Raises
    ------
    InputError
        If the period is not positive or the damping negative.
    """
    (period,) = _checked_periods([period])
    damping = _checked_damping(damping)
    omega = 2 * math.pi / period
    matrix = oscillator_matrix(omega, damping, motion.dt)
    u, v = _histories(motion.acceleration, motion.dt, matrix)
    return u, v, -(2 * damping * omega * v + omega**2 * u)


def response_spectrum(
    motion: Motion, periods: ArrayLike | Sequence[float], damping: float = 0.05
) -> ResponseSpectrum:
    """Response spectrum of a motion: peaks between samples and in the free vibration after it too.

    Parameters
    ----------
    motion
        Ground acceleration, linear between samples and zero after the last one.
    periods
        Natural periods [s], shape (k,), each positive.
    damping
        Fraction of critical damping [-], zero or more.

    Raises
    ------
    InputError
        If there is no period, a period is not positive, or the damping is negative.
    """
    checked = _checked_periods(periods)
    damping = _checked_damping(damping)
    peaks = np.array([_oscillator_peaks(motion, float(period), damping) for period in checked])
    return ResponseSpectrum(checked, damping, peaks[:, 0], peaks[:, 1], peaks[:, 2])


def _oscillator_peaks(motion: Motion, period: float, damping: float) -> tuple[float, float, float]:
    omega = 2 * math.pi / period
    parts = max(1, math.ceil(STEPS_PER_PERIOD * motion.dt / period))
    step = motion.dt / parts
    # one period of free vibration holds the first peak of either sign, and later ones are smaller
    quiet = np.zeros(math.ceil(period / motion.dt) + 1)
    acceleration = np.concatenate([motion.acceleration, quiet])
    matrix = oscillator_matrix(omega, damping, step)
    sd, sv, sa = _peaks(acceleration, step, parts, matrix, omega, damping)
    return sd, sv, sa


def fourier_amplitude(motion: Motion, least_length: int = 0) -> tuple[Floats, Floats]:
    """Fourier amplitude spectrum |∫ a e^(-iωt) dt| as dt times the discrete transform.

    Parameters
    ----------
    motion
        Motion of n samples.
    least_length
        Zeros are added behind the motion until it has this many samples, for a finer frequency
        step.

    Returns
    -------
    frequency, amplitude
        Frequency [Hz] from zero to Nyquist and amplitude [m/s], each of shape (m // 2 + 1,) for
        m = max(n, least_length).
    """
    length = max(motion.acceleration.size, least_length)
    amplitude = motion.dt * np.abs(np.fft.rfft(motion.acceleration, length))
    return np.asarray(np.fft.rfftfreq(length, motion.dt), dtype=np.float64), amplitude


def _checked_periods(periods: ArrayLike | Sequence[float]) -> Floats:
    checked = np.atleast_1d(np.asarray(periods, dtype=np.float64))
    if checked.ndim != 1 or checked.size == 0:
        raise InputError("response spectrum: at least one period [s] is needed, in one dimension.")
    bad = checked[~(np.isfinite(checked) & (checked > 0))]
    if bad.size:
        raise InputError(
            f"response spectrum: periods must be positive numbers of seconds, got {bad[0]}."
        )
    return checked


def _checked_damping(damping: float) -> float:
    if not (math.isfinite(damping) and damping >= 0):
        raise InputError(
            f"response spectrum: damping is a fraction of critical, zero or more, not {damping}."
        )
    return float(damping)
