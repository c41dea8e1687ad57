"""Restitution of a real block from its measured free rocking.

A block that rocks freely loses energy at impacts only.  With x the square of the angular velocity just
after an impact, e² x is that after the next (Housner, 1963), and x gives both the peak between them and
the time between them.  So peaks, impact times and whole histories all speak about e.

In: peaks [rad], times [s] or a history of free rocking. Out: e with its interval [-]. Theory:
``docs/restitution.md``.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import OptimizeResult, brentq, least_squares
from scipy.stats import t as student

from rockfrag.base.arrays import Floats
from rockfrag.base.errors import InputError
from rockfrag.base.input_checks import real_array
from rockfrag.simulation.history import simulate
from rockfrag.system.blocks import Block

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(48)


@dataclass(frozen=True)
class RestitutionFit:
    """Coefficient of restitution that explains a free-rocking history best."""

    # e, ratio of the angular velocities after and before an impact [-]
    restitution: float
    # lower, upper: limits of its confidence interval; NaN where the data leave no degree of freedom
    lower: float
    upper: float
    impacts: int  # impacts that speak about e
    # standard deviation of the data about the fit, in their own unit (rad or s); NaN likewise
    scatter: float
    # what conservation of momentum gives for this block, 1 - 1.5 sin²α if it is uniform [-]
    computed: float


def peak_after(block: Block, speed: float, pivot: int = 1) -> float:
    """Peak rotation [rad] of a block that leaves its base with ``speed`` [rad/s]; NaN if it would go over."""
    alpha, x = block.critical_angle(pivot), speed**2 / block.frequency(pivot) ** 2
    sine, cosine = math.sin(alpha), math.cos(alpha)
    gain = x * cosine + x**2 / 4  # sin²α - sin²(α - θ)
    if cosine + x / 2 >= 1 or gain >= sine**2:
        return math.nan
    # written so that small speeds keep their digits
    return math.asin(x * sine / 2 + cosine * gain / (sine + math.sqrt(sine**2 - gain)))


def speed_before(block: Block, peak: float, pivot: int = 1) -> float:
    """Angular velocity [rad/s] with which a block comes down from rest at a rotation [rad]."""
    alpha, p = block.critical_angle(pivot), block.frequency(pivot)
    # cos(α - θ) - cos α as a product, which keeps its digits for small rotations
    return p * math.sqrt(4 * math.sin(alpha - peak / 2) * math.sin(peak / 2))


def quarter_period(
    block: Block, peak: float, pivot: int = 1, *, linear: bool = False
) -> float:
    """Time from rest at a rotation ``peak`` [rad] to the impact [s] (Housner, 1963, if linear).

    The nonlinear one is the integral of dθ/θ' with the energy of eq. 2.4, by Gauss-Legendre after
    θ = θ0 (1 - u²), which takes the singularity away.

    Parameters
    ----------
    block, peak, pivot : the block, its rotation at rest [rad], and 1 for the right pivot, -1 for the left
    linear : whether by the linearised equation

    Returns
    -------
    The time [s].
    """
    alpha, p = block.critical_angle(pivot), block.frequency(pivot)
    if linear:
        phi = peak / alpha
        return math.atanh(math.sqrt(phi * (2 - phi))) / p
    u = (_NODES + 1) / 2
    fall = peak * u**2
    speed = p * np.sqrt(4 * np.sin(alpha - peak + fall / 2) * np.sin(fall / 2))
    return float(np.sum(_WEIGHTS / 2 * 2 * peak * u / speed))


def restitution_from_peaks(
    block: Block, peaks: ArrayLike, *, confidence: float = 0.95
) -> RestitutionFit:
    """Fit e to successive peak rotations, by least squares on the rotations.

    Parameters
    ----------
    block, peaks
        Peak rotations of the block in their order [rad], shape (n,), n ≥ 2; alternating in sign, or magnitudes.
        They alternate between the corners; the first is on that of the first peak's sign.
    confidence : level of the interval

    Returns
    -------
    The :class:`RestitutionFit`: ``restitution`` with ``lower`` and ``upper``, ``impacts``, ``scatter``,
    ``computed``.
    """
    values, pivots = _checked_peaks(block, peaks)

    def model(parameters: Floats) -> Floats:
        """Peaks [rad] that follow from the first one and e."""
        first, e = parameters
        speed = speed_before(block, first, pivots[0])
        found = [first]
        for pivot in pivots[1:]:
            speed *= e
            found.append(peak_after(block, speed, pivot))
        return np.array(found)

    # the ratio of the first and the last speed is already an estimate
    speeds = [
        speed_before(block, peak, pivot)
        for peak, pivot in zip(values, pivots, strict=True)
    ]
    start = (speeds[-1] / speeds[0]) ** (1 / (len(values) - 1))
    ceiling = min(block.critical_angle(pivot) for pivot in pivots)
    bounds = [(1e-9 * ceiling, ceiling * (1 - 1e-9))]
    fit = _least_squares(model, values, [values[0], start], bounds)
    return _summary(block, fit, len(values) - 1, confidence)


def restitution_from_impacts(
    block: Block, times: ArrayLike, *, first_pivot: int = 1, confidence: float = 0.95
) -> RestitutionFit:
    """Fit e to the times of successive impacts, by least squares on the times.

    Parameters
    ----------
    block, times : times of successive impacts of the block [s], shape (n,), n ≥ 3, rising; none may be left out
    first_pivot : corner the block rocks on between the first two
    confidence : level of the interval

    Returns
    -------
    The :class:`RestitutionFit`.
    """
    values = _numbers("impact times", times, 3)
    intervals = np.diff(values)
    if (intervals <= 0).any():
        bad = int(np.flatnonzero(intervals <= 0)[0]) + 1
        raise InputError(
            f"impact times: entry {bad} is not later than the one before it; sort them."
        )
    pivots = [first_pivot * (-1) ** k for k in range(len(intervals))]

    def model(parameters: Floats) -> Floats:
        """Times of the impacts, of the first one, the speed after it and e."""
        begin, speed, e = parameters
        found = [begin]
        for pivot in pivots:
            found.append(found[-1] + _time_between_impacts(block, speed, pivot))
            speed *= e
        return np.array(found)

    over = min(
        speed_before(block, block.critical_angle(pivot), pivot) for pivot in (+1, -1)
    )
    largest = over * (1 - 1e-12)
    speeds = [
        _speed_of_interval(block, interval, pivot, largest)
        for interval, pivot in zip(intervals.tolist(), pivots, strict=True)
    ]
    start = min(max((speeds[-1] / speeds[0]) ** (1 / (len(speeds) - 1)), 0.01), 0.9999)
    bounds = [(-np.inf, np.inf), (1e-9 * largest, largest)]
    fit = _least_squares(model, values, [values[0], speeds[0], start], bounds)
    return _summary(block, fit, len(intervals) - 1, confidence)


def _time_between_impacts(block: Block, speed: float, pivot: int) -> float:
    """Time that a block is on a pivot after leaving at a speed [s]; NaN where it does not come back."""
    peak = peak_after(block, speed, pivot)
    if math.isnan(peak):
        return math.nan
    return 2 * quarter_period(block, peak, pivot)


def _speed_of_interval(
    block: Block, interval: float, pivot: int, largest: float
) -> float:
    """Speed after which a block is on a pivot for an interval [s], from a billionth of ``largest`` up to that."""
    least = 1e-9 * largest
    if _time_between_impacts(block, largest, pivot) <= interval:
        return largest
    if _time_between_impacts(block, least, pivot) >= interval:
        return least

    def too_long(speed: float) -> float:
        return _time_between_impacts(block, speed, pivot) - interval

    return float(brentq(too_long, least, largest, xtol=1e-14))


def restitution_from_history(
    block: Block, time: ArrayLike, theta: ArrayLike, *, confidence: float = 0.95
) -> RestitutionFit:
    """Fit e to a sampled history of free rocking, by least squares on the rotations.

    Rotation and angular velocity at the first sample are fitted too, so the release need not be at rest. The noise
    of the samples is taken as independent; low-frequency noise makes the interval too narrow.

    Parameters
    ----------
    block, time, theta
        Times of the samples [s], evenly spaced, none before the release, and clockwise rotations of the block
        [rad], shape (n,).
    confidence : level of the interval

    Returns
    -------
    The :class:`RestitutionFit`; a history with fewer than two impacts is refused.
    """
    t, values = _numbers("time", time, 8), _numbers("theta", theta, 8)
    if t.shape != values.shape:
        raise InputError(
            f"theta: {values.size} rotations for {t.size} times; give one per time."
        )
    dt = float((t[-1] - t[0]) / (t.size - 1))
    if dt <= 0 or np.abs(np.diff(t) - dt).max() > 1e-3 * dt:
        raise InputError(
            "time: samples must be evenly spaced and rising; resample the history."
        )
    peaks = _peaks_of(values)
    if len(peaks) < 3:
        raise InputError(
            f"theta: the history rises {len(peaks)} time(s) above its noise; restitution needs at "
            "least two impacts between three peaks."
        )
    guess = restitution_from_peaks(block, peaks).restitution
    quiet = np.zeros(t.size)

    def model(parameters: Floats) -> Floats:
        """Rotations [rad] that follow from rotation and velocity at the beginning and e."""
        theta0, omega0, e = parameters
        response = simulate(
            block, quiet, dt, theta0=theta0, omega0=omega0, restitution=float(e)
        )
        return response.theta[: t.size, 0]

    slope = float(np.polyfit(t[:5] - t[0], values[:5], 1)[0])
    top = block.critical_angle(1 if peaks[0] > 0 else -1)
    # a first sample near the base must not start on the wrong side of it
    begin = float(np.clip(values[0], -0.999 * top, 0.999 * top))
    scale = [top, top * block.frequency(), 1.0]
    bounds = [(-top, top), (-np.inf, np.inf)]
    fit = _least_squares(
        model, values, [begin, slope, min(guess, 0.999)], bounds, scale
    )
    return _summary(block, fit, len(peaks) - 1, confidence)


def _numbers(name: str, data: ArrayLike, least: int) -> Floats:
    """At least so many finite numbers, shape (n,); ``name``: of the data, in messages."""
    values = real_array(name, data, "s" if "time" in name else "rad")
    if values.ndim != 1 or values.size < least:
        raise InputError(
            f"{name}: expected at least {least} numbers in a row, got {values.shape}."
        )
    if not np.isfinite(values).all():
        bad = int(np.flatnonzero(~np.isfinite(values))[0])
        raise InputError(f"{name}: entry {bad} is not a finite number; leave it out.")
    return values


def _checked_peaks(block: Block, peaks: ArrayLike) -> tuple[Floats, list[int]]:
    """Sizes of peaks that alternate [rad], shape (n,), and the pivot of each, +1 right or -1 left."""
    values = _numbers("peaks", peaks, 2)
    first = 1 if values[0] > 0 else -1
    pivots = [first * (-1) ** k for k in range(values.size)]
    alternate = np.sign(values) == pivots
    if not (alternate.all() or (values > 0).all()):
        raise InputError(
            "peaks: they must alternate in sign or all be positive; one is missing or doubled."
        )
    values = np.abs(values)
    for k, (value, pivot) in enumerate(zip(values, pivots, strict=True)):
        if not 0 < value < block.critical_angle(pivot):
            raise InputError(
                f"peaks: entry {k} of {value:.4g} rad is not below the critical angle of "
                f"{block.critical_angle(pivot):.4g} rad; give radians."
            )
    return values, pivots


def _peaks_of(theta: Floats) -> list[float]:
    """Signed peaks [rad] of sampled rotations between changes of sign, as long as they stand out of the noise.

    A peak that is larger than the one before by half ends the free rocking.
    """
    # second differences of a smooth history are small: what they hold is noise
    noise = 1.4826 * float(np.median(np.abs(np.diff(theta, 2)))) / math.sqrt(6)
    floor = max(8 * noise, 1e-3 * float(np.abs(theta).max()))
    peaks: list[float] = []
    for value in theta:
        if abs(value) < floor:
            continue
        if peaks and value * peaks[-1] > 0:
            peaks[-1] = max(peaks[-1], value) if value > 0 else min(peaks[-1], value)
        elif peaks and abs(value) > 1.5 * abs(peaks[-1]):
            break
        else:
            peaks.append(float(value))
    return peaks


def _least_squares(
    model: Callable[[Floats], Floats],
    values: Floats,
    start: list[float],
    bounds: list[tuple[float, float]],
    scale: list[float] | str = "jac",
) -> OptimizeResult:
    """Fit a model's parameters, of which e is the last, by least squares.

    Parameters
    ----------
    model : gives what ``values`` should be, of the parameters; NaN where the block would go over
    values : observed, shape (n,)
    start : parameters to start from
    bounds : lower and upper ones of all but e
    scale : sizes of the parameters, or ``jac`` by the slopes
    """
    low, high = np.transpose([*bounds, (1e-3, 1.0)])
    inside = np.clip(start, np.nextafter(low, high), np.nextafter(high, low))

    def finite(q: Floats) -> Floats:
        # parameters with which the block would go over explain nothing
        return np.nan_to_num(model(q) - values, nan=1e3)

    tolerances = dict.fromkeys(("xtol", "ftol", "gtol"), 1e-13)
    return least_squares(
        finite, inside, bounds=(low, high), jac="3-point", x_scale=scale, **tolerances
    )


def _summary(
    block: Block, fit: OptimizeResult, impacts: int, confidence: float
) -> RestitutionFit:
    """Interval of e by Student's t and the curvature of the sum of squares.

    Parameters
    ----------
    block : whose restitution it is
    fit : with e as the last parameter
    impacts : number of those it rests on
    confidence : level of the interval [-]
    """
    if not 0 < confidence < 1:
        raise InputError(
            f"confidence: expected a level between 0 and 1, got {confidence}."
        )
    n, k = fit.jac.shape
    e = float(fit.x[-1])
    computed = block.momentum_restitution()
    if n <= k:
        return RestitutionFit(e, math.nan, math.nan, impacts, math.nan, computed)
    variance = 2 * fit.cost / (n - k)
    covariance = variance * np.linalg.pinv(fit.jac.T @ fit.jac)
    half = float(student.ppf((1 + confidence) / 2, n - k)) * math.sqrt(
        covariance[-1, -1]
    )
    return RestitutionFit(
        e,
        max(e - half, 0.0),
        min(e + half, 1.0),
        impacts,
        math.sqrt(variance),
        computed,
    )
