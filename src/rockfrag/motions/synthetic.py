"""Seeded stochastic motions: an evolutionary process, and motions made to fit a response spectrum.

The same seed and parameters give the same motion.  The metadata say that a motion is synthetic, by
which model and with which seed.

In: parameters and a seed, or a spectrum [m/s²]. Out: motions [m/s²]. Theory: ``docs/motions.md``, "Synthetic
motions".
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import brentq
from scipy.signal.windows import tukey
from scipy.stats import gamma

from rockfrag.base.arrays import Floats
from rockfrag.base.errors import InputError
from rockfrag.base.input_checks import positive_number, real_number, whole_within
from rockfrag.base.units import GRAVITY
from rockfrag.motions.pulses import plain
from rockfrag.motions.response_spectra import oscillator_response, response_spectrum
from rockfrag.records.motion import Motion, integrate

LOWEST_FREQUENCY = 0.3
"""The filter frequency of the evolutionary process never falls below this [Hz] (Rezaeian & Der
Kiureghian 2010)."""

# corrections of the Fourier amplitudes on the way to a spectrum-compatible motion
ITERATIONS = 50


def evolutionary(
    seed: int,
    *,
    arias_m_s: float,
    d5_95_s: float,
    mid_s: float,
    mid_hz: float,
    slope_hz_s: float,
    filter_damping: float,
    corner_hz: float = 0.1,
    dt: float = 0.01,
) -> Motion:
    """Return filtered white noise whose intensity and frequency content both evolve in time.

    Rezaeian & Der Kiureghian (2008, Earthquake Eng. Struct. Dyn. 37, 1565-1584; 2010, 39,
    1155-1180): white noise passes a linear filter with a frequency that changes linearly in time,
    is normalised to unit variance at each instant, modulated by q(t) = α₁ t^(α₂-1) exp(-α₃ t), and
    high-passed by a critically damped oscillator so that velocity and displacement come to rest.

    Parameters
    ----------
    seed : seed of the white noise, a whole number from zero
    arias_m_s : Arias intensity expected before the high-pass [m/s]; one motion scatters about it
    d5_95_s, mid_s
        Expected significant duration, less than 4.9 × ``mid_s``, and time of 45 % of the Arias intensity [s].
    mid_hz, slope_hz_s : filter frequency at that time [Hz] and its rate of change [Hz/s], mostly negative
    filter_damping : damping of the filter [-], between 0.02 and 1: its bandwidth
    corner_hz : frequency of the high-pass oscillator [Hz]
    dt : sampling interval [s]

    Returns
    -------
    The :class:`Motion` [m/s²].
    """
    who = "evolutionary"
    seed = whole_within(who, "seed", seed, 0, 2**63 - 1)
    for name, value in (
        ("arias_m_s", arias_m_s),
        ("mid_hz", mid_hz),
        ("corner_hz", corner_hz),
    ):
        positive_number(f"{who}: {name}", value)
    positive_number(f"{who}: dt", dt, "seconds")
    real_number(f"{who}: slope_hz_s", slope_hz_s)
    if not 0.02 <= real_number(f"{who}: filter_damping", filter_damping) < 1:
        raise InputError(
            f"{who}: filter_damping must lie in 0.02 … 1, got {filter_damping}."
        )
    shape, spread = _envelope(who, d5_95_s, mid_s)
    end = float(gamma.ppf(1 - 1e-4, shape, scale=spread))
    count = whole_within(who, "number of samples", math.ceil(end / dt) + 1, 10, 200_000)
    time = np.arange(count) * dt
    frequency = np.maximum(mid_hz + slope_hz_s * (time - mid_s), LOWEST_FREQUENCY)
    if frequency.max() > 0.25 / dt:
        raise InputError(
            f"{who}: the filter frequency reaches {frequency.max():.3g} Hz, more than a quarter of "
            f"the sampling frequency ({0.25 / dt:g} Hz); give a smaller dt."
        )
    noise = np.random.default_rng(seed).standard_normal(count)
    intensity = arias_m_s * 2 * GRAVITY / math.pi
    modulation = np.sqrt(intensity * gamma.pdf(time, shape, scale=spread))
    strong = modulation * _unit_process(noise, frequency, filter_damping, dt)
    # two periods of the oscillator let the motion come to rest
    padded = Motion(np.pad(strong, (0, math.ceil(2 / (corner_hz * dt)))), dt)
    drift = oscillator_response(padded, 1 / corner_hz, damping=1.0)[2]
    given = {
        "arias_m_s": arias_m_s,
        "d5_95_s": d5_95_s,
        "mid_s": mid_s,
        "mid_hz": mid_hz,
        "slope_hz_s": slope_hz_s,
        "filter_damping": filter_damping,
        "corner_hz": corner_hz,
    }
    source = "Rezaeian & Der Kiureghian (2008, 2010)"
    return _synthetic(
        padded.acceleration - drift, dt, who, source, seed=seed, given=given
    )


def spectrum_compatible(
    seed: int,
    periods: ArrayLike,
    target_g: ArrayLike,
    *,
    damping: float = 0.05,
    d5_95_s: float = 12.0,
    mid_s: float = 6.0,
    dt: float = 0.01,
) -> Motion:
    """Noise whose Fourier amplitudes are corrected until its response spectrum meets a target.

    The phases of modulated white noise are kept and the amplitude at each frequency is multiplied by target over
    actual pseudo-acceleration at that period, again and again (SIMQKE's rule: Gasparini & Vanmarcke 1976, MIT
    report R76-4; Preumont 1984, Nucl. Eng. Des. 78, 431-444).  The best of 50 corrections is returned; what misfit
    remains is in the metadata.  Between the given periods the target is a straight line in logarithms; nothing is
    asked of the motion outside of them, and content below half the lowest frequency is taken out.

    Parameters
    ----------
    seed : seed of the noise, a whole number from zero
    periods : periods of the target [s], shape (k,), k ≥ 2, increasing, the shortest at least 4 ``dt``
    target_g : pseudo-spectral accelerations wanted [g], shape (k,), positive
    damping : damping of the target spectrum [-]
    d5_95_s, mid_s : significant duration and time of 45 % of the Arias intensity of the noise [s]
    dt : sampling interval [s]

    Returns
    -------
    Motion with the metadata ``misfit_rms`` (of ln actual/target) and ``misfit_max`` over 60 periods
    a decade.
    """
    who = "spectrum_compatible"
    seed = whole_within(who, "seed", seed, 0, 2**63 - 1)
    positive_number(f"{who}: dt", dt, "seconds")
    given, wanted = _target(who, periods, target_g, dt)
    shape, spread = _envelope(who, d5_95_s, mid_s)
    decades = math.log10(given[-1] / given[0])
    control = np.geomspace(given[0], given[-1], math.ceil(60 * decades) + 1)
    target = np.exp(np.interp(np.log(control), np.log(given), np.log(wanted)))

    # the motion begins and ends with one longest period of quiet
    quiet = float(given[-1])
    strong = float(gamma.ppf(1 - 1e-3, shape, scale=spread))
    samples = math.ceil((strong + 2 * quiet) / dt) + 1
    count = whole_within(who, "number of samples", samples, 10, 1_000_000)
    noise = np.random.default_rng(seed).standard_normal(count)
    time = np.arange(count) * dt - quiet
    acceleration = noise * np.sqrt(gamma.pdf(time, shape, scale=spread))

    best, best_rms, best_max = acceleration, math.inf, math.inf
    for _ in range(ITERATIONS + 1):
        spectrum = response_spectrum(Motion(acceleration, dt), control, damping)
        error = np.log(spectrum.pseudo_acceleration / target)
        rms = float(np.sqrt(np.mean(error**2)))
        if rms < best_rms:
            best, best_rms, best_max = acceleration, rms, float(np.abs(error).max())
        acceleration = _corrected(acceleration, dt, control, error)
    parameters = {
        "periods_s": given.tolist(),
        "target_g": (wanted / GRAVITY).tolist(),
        "damping": damping,
        "d5_95_s": d5_95_s,
        "mid_s": mid_s,
    }
    return _synthetic(
        best,
        dt,
        who,
        "Gasparini & Vanmarcke (1976)",
        seed=seed,
        given=parameters,
        misfit_rms=best_rms,
        misfit_max=best_max,
    )


def _corrected(
    acceleration: Floats, dt: float, periods: Floats, error: Floats
) -> Floats:
    """Acceleration whose amplitude at each period is divided by actual over target, at rest at its end.

    ``error`` is the logarithm of that ratio at ``periods``, increasing [s]. What is slower than twice the longest
    period is taken out, and one longest period at both ends is tapered.
    """
    longest, count = float(periods[-1]), acceleration.size
    frequency = np.asarray(np.fft.rfftfreq(count, dt), dtype=np.float64)
    # periods run upwards and frequencies downwards; beyond the ends the last correction holds
    gain = np.exp(-np.interp(frequency, 1 / periods[::-1], error[::-1]))
    # one above the lowest frequency, zero below half of it, half a cosine between them
    part = np.clip(2 * frequency / (1 / longest) - 1, 0.0, 1.0)
    low_cut = (1 - np.cos(np.pi * part)) / 2
    corrected = np.fft.irfft(np.fft.rfft(acceleration) * gain * low_cut, count)
    window = tukey(count, alpha=2 * longest / (count * dt))
    return _at_rest(corrected * window, window, dt)


def _envelope(who: str, d5_95_s: float, mid_s: float) -> tuple[float, float]:
    """Shape [-] and scale [s] of the gamma density that q² follows, from two properties of its integral.

    Parameters
    ----------
    who : the model, for messages
    d5_95_s, mid_s : time from 5 to 95 % of the integral, and time of 45 % [s]
    """
    duration = positive_number(f"{who}: d5_95_s", d5_95_s, "seconds")
    middle = positive_number(f"{who}: mid_s", mid_s, "seconds")

    def ratio(shape: float) -> float:
        """Time from 5 to 95 % over that of 45 %, which does not depend on the scale."""
        low, mid, high = gamma.ppf([0.05, 0.45, 0.95], shape)
        return float((high - low) / mid)

    least, most = 1.001, 1000.0
    if not ratio(most) < duration / middle < ratio(least):
        raise InputError(
            f"{who}: d5_95_s of {duration:g} must lie between {ratio(most):.2f} and "
            f"{ratio(least):.2f} times mid_s of {middle:g}."
        )
    shape = float(brentq(lambda k: ratio(k) - duration / middle, least, most))
    return shape, middle / float(gamma.ppf(0.45, shape))


def _unit_process(
    noise: Floats, frequency: Floats, damping: float, dt: float
) -> Floats:
    """White noise through a filter that changes with the time of each impulse, at unit variance.

    Parameters
    ----------
    noise, frequency : standard normal impulses, and frequency of the filter then [Hz], shape (n,)
    damping, dt : of the filter [-], and sampling interval [s]

    Returns
    -------
    The process [-], shape (n,).
    """
    count = noise.size
    lag = np.arange(count) * dt
    total, variance = np.zeros(count), np.zeros(count)
    for i in range(count - 1):
        omega = 2 * np.pi * frequency[i]
        # what is left after this time is below 1e-8 of the impulse response
        reach = min(count - i, math.ceil(18.5 / (damping * omega * dt)))
        s = lag[1:reach]
        answer = (
            omega
            / math.sqrt(1 - damping**2)
            * np.exp(-damping * omega * s)
            * np.sin(omega * math.sqrt(1 - damping**2) * s)
        )
        total[i + 1 : i + reach] += noise[i] * answer
        variance[i + 1 : i + reach] += answer**2
    return np.divide(total, np.sqrt(variance), out=np.zeros(count), where=variance > 0)


def _target(
    who: str, periods: ArrayLike, target_g: ArrayLike, dt: float
) -> tuple[Floats, Floats]:
    """Checked periods [s] and spectral accelerations [m/s²] of a target, shape (k,) each.

    ``who``: the model, for messages; ``target_g`` [g]; ``dt``: sampling interval [s].
    """
    given = np.asarray(periods, dtype=np.float64)
    wanted = np.asarray(target_g, dtype=np.float64)
    if given.ndim != 1 or given.shape != wanted.shape or given.size < 2:
        raise InputError(
            f"{who}: periods and target_g need one common length of two or more, "
            f"got shapes {given.shape} and {wanted.shape}."
        )
    if not (
        np.isfinite(given).all() and (np.diff(given) > 0).all() and given[0] >= 4 * dt
    ):
        raise InputError(
            f"{who}: periods must increase from at least 4 dt = {4 * dt:g} s, got {given.tolist()}."
        )
    if not (np.isfinite(wanted).all() and (wanted > 0).all()):
        raise InputError(
            f"{who}: target_g must be positive numbers, got {wanted.tolist()}."
        )
    return given, wanted * GRAVITY


def _at_rest(acceleration: Floats, window: Floats, dt: float) -> Floats:
    """Bring velocity and displacement to rest at the end by taking off a windowed straight line.

    ``acceleration`` [m/s²] and ``window`` [-] have the shape (n,), ``dt`` is in seconds; two factors of the line
    follow from two conditions.
    """
    lines = [window, window * np.linspace(0.0, 1.0, window.size)]
    ends = np.array(
        [[history[-1] for history in integrate(line, dt)] for line in lines]
    )
    drift = np.array([history[-1] for history in integrate(acceleration, dt)])
    first, second = np.linalg.solve(ends.T, drift)
    return np.asarray(acceleration - first * lines[0] - second * lines[1])


def _synthetic(
    acceleration: Floats,
    dt: float,
    model: str,
    source: str,
    *,
    seed: int,
    given: Mapping[str, Any],
    **found: float,
) -> Motion:
    """A motion made by a model, with the model, its source, seed and parameters in the provenance.

    Parameters
    ----------
    acceleration, dt : samples [m/s²], shape (n,), and their interval [s]
    model, source : name of the model, and who published it
    seed : of its noise
    given : its parameters
    **found : what of the motion is worth knowing, for its metadata
    """
    facts = {"synthetic": True, "kind": model, "source": source, "seed": seed, **found}
    step = {"step": model, "seed": seed, **plain(given), "dt": float(dt)}
    return Motion(acceleration, dt, f"{model}_{seed}", facts, (step,))
