"""Annual rate of overturning: a fragility curve combined with a seismic hazard curve."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy import special

from rockfrag.errors import InputError
from rockfrag.fragility.lognormal import FragilityFit
from rockfrag.fragility.observations import Floats


@dataclass(frozen=True)
class OverturningRate:
    """How often a body overturns at a site.

    Attributes
    ----------
    annual_rate
        Mean rate of overturning [1/year].
    probability
        Probability of at least one overturning in ``years`` (Poisson).
    years
        Time for ``probability`` [year].
    fraction_below, fraction_above
        Fractions of the rate from shaking below the first and above the last point of the hazard
        curve, where the curve was continued.
    warnings
        Set where such a fraction exceeds 1 %.
    """

    annual_rate: float
    probability: float
    years: float
    fraction_below: float
    fraction_above: float
    warnings: tuple[str, ...] = ()


def overturning_rate(
    fit: FragilityFit, im: ArrayLike, exceedance_rate: ArrayLike, *, years: float = 50.0
) -> OverturningRate:
    """Integrate a lognormal fragility over a hazard curve.

    The hazard curve is a power law between its points (straight in log-log scale), for which the
    integral is exact; the first and last segments are continued beyond the ends.

    Parameters
    ----------
    fit
        Curve with the probit link.
    im
        Values of the same measure and unit, rising, shape (n,), n ≥ 2.
    exceedance_rate
        Annual rate with which each is exceeded [1/year], falling, shape (n,).
    years
        Time for the probability [year].

    Returns
    -------
    The :class:`OverturningRate`.

    Raises
    ------
    InputError
        If there is no lognormal curve, or the hazard curve does not rise in IM and fall in rate.
    """
    x = np.asarray(im, dtype=np.float64)
    rate = np.asarray(exceedance_rate, dtype=np.float64)
    if fit.link != "probit" or not np.isfinite(fit.theta):
        raise InputError(f"fragility: a lognormal curve is needed, not {fit.method!r}.")
    if x.ndim != 1 or x.shape != rate.shape or x.size < 2:
        raise InputError(
            f"hazard curve: give equally many values and rates, at least two, not {x.shape} and "
            f"{rate.shape}."
        )
    usable = np.isfinite(x).all() and np.isfinite(rate).all() and x[0] > 0 and rate[-1] > 0
    if not usable or (np.diff(x) <= 0).any() or (np.diff(rate) >= 0).any():
        raise InputError(
            "hazard curve: the values must be above zero and rise and the rates above zero and "
            "fall; sort the curve and leave equal points out."
        )
    if not years > 0:
        raise InputError(f"years: must be above zero, got {years:g}.")
    parts = _power_law_parts(fit, x, rate)
    total = float(parts.sum())
    below, above = float(parts[0] / total), float(parts[-1] / total)
    notes = tuple(
        f"{fraction:.0%} of the rate comes from shaking {side} the hazard curve; extend the curve."
        for fraction, side in ((below, "below"), (above, "above"))
        if fraction > 0.01
    )
    return OverturningRate(total, float(-np.expm1(-years * total)), years, below, above, notes)


def _power_law_parts(fit: FragilityFit, x: Floats, rate: Floats) -> Floats:
    """Return ∫ H(im) dF(im) by segment, the open ends included, shape (n + 1,).

    With H = rate0 (im/im0)^-m and ln IM normal (ln θ, β²) the integral over a segment is
    rate0 (im0/θ)^m exp(m²β²/2) [Φ(u2) - Φ(u1)] with u = (ln(im/θ) + mβ²)/β, the closed form of the
    risk integral (Cornell and others, 2002, J. Struct. Eng. 128: 526-533) applied piece by piece.
    """
    log_x, log_rate = np.log(x), np.log(rate)
    slope = -np.diff(log_rate) / np.diff(log_x)
    slope = np.concatenate([slope[:1], slope, slope[-1:]])
    start = np.concatenate([[0], np.arange(x.size - 1), [x.size - 1]])
    edges = np.concatenate([[-np.inf], log_x, [np.inf]])
    mean, beta = np.log(fit.theta), fit.beta
    upper = (edges[1:] - mean + slope * beta**2) / beta
    lower = (edges[:-1] - mean + slope * beta**2) / beta
    flip = lower > 0
    fraction = np.where(
        flip, special.ndtr(-lower) - special.ndtr(-upper), special.ndtr(upper) - special.ndtr(lower)
    )
    power = log_rate[start] + slope * (log_x[start] - mean) + 0.5 * (slope * beta) ** 2
    return np.asarray(np.exp(power) * fraction)
