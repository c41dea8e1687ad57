"""Idealised input motions: sine, half-sine and rectangular pulses, Ricker wavelets, sine sweeps.

Each pulse starts and ends with a sample of zero.  The sampling interval is the largest one up to
``dt`` that divides the pulse's duration; pulses that jump are sampled at the middle of the
intervals, so that the jump is a line of one interval's length centred on it and the velocity left
behind is exact.
"""

import math
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from rockfrag.base.arrays import Floats
from rockfrag.base.errors import InputError
from rockfrag.base.input_checks import positive_number, real_number, whole_within
from rockfrag.records.motion import MOST_SAMPLES, Motion

DT = 0.005  # sampling interval that pulses have unless another is asked for [s]


def sine(amplitude: float, period: float, cycles: int, dt: float = DT) -> Motion:
    """Sinusoidal acceleration a sin(2πt/T) of whole cycles from rest.

    Parameters
    ----------
    amplitude : peak acceleration a [m/s²], of either sign
    period : period T [s]
    cycles : number of whole cycles, 1 to 1000
    dt : longest sampling interval [s]

    Returns
    -------
    The :class:`Motion` [m/s²].
    """
    cycles = whole_within("sine", "cycles", cycles, 1, 1000)
    length = cycles * _seconds("sine: period", period)
    given = {"amplitude": amplitude, "period": period, "cycles": cycles}
    source = "steady harmonic motion from rest"
    return _pulse(
        "sine",
        source,
        lambda t: np.sin(2 * np.pi * t / period),
        length=length,
        dt=dt,
        given=given,
    )


def one_sine(amplitude: float, period: float, dt: float = DT) -> Motion:
    """One-sine acceleration pulse a sin(2πt/T), 0 ≤ t ≤ T: a forward ground displacement (type A).

    Makris & Roussos (2000), Géotechnique 50(3), 243-262.

    Parameters
    ----------
    amplitude, period, dt : as of :func:`sine`

    Returns
    -------
    The :class:`Motion` [m/s²].
    """
    length = _seconds("one_sine: period", period)
    given = {"amplitude": amplitude, "period": period}
    source = "Makris & Roussos (2000)"
    return _pulse(
        "one_sine",
        source,
        lambda t: np.sin(2 * np.pi * t / period),
        length=length,
        dt=dt,
        given=given,
    )


def one_cosine(amplitude: float, period: float, dt: float = DT) -> Motion:
    """One-cosine acceleration pulse a cos(2πt/T), 0 ≤ t ≤ T: forward and back (type B).

    Makris & Roussos (2000), Géotechnique 50(3), 243-262.  The samples nearest its ends lie half an
    interval inside it, at cos(π dt/T) of the peak.

    Parameters
    ----------
    amplitude, period, dt : as of :func:`sine`

    Returns
    -------
    The :class:`Motion` [m/s²].
    """
    name, source = "one_cosine", "Makris & Roussos (2000)"
    length = _seconds(f"{name}: period", period)
    given = {"amplitude": amplitude, "period": period}
    return _pulse(
        name,
        source,
        lambda t: np.cos(2 * np.pi * t / period),
        length=length,
        dt=dt,
        given=given,
        jumps=True,
    )


def commanded_cosine(pga: float, pgv_over_pga: float, cycles: int = 1) -> Motion:
    """Whole cosines of acceleration, as commanded of a table by PGA and PGV/PGA.

    The displacement A - A cos 2πFt has the acceleration PGA cos 2πFt with F = PGA / (2π PGV) and A = PGA / (2πF)²:
    the table starts and ends at rest, and its acceleration jumps to PGA at the start and from it at the end.

    Parameters
    ----------
    pga, pgv_over_pga : peak acceleration [m/s²], and peak velocity over it [s]
    cycles : whole number of cosines

    Returns
    -------
    The motion [m/s²].
    """
    name = "commanded_cosine"
    positive_number(f"{name}: pga", pga, "m/s²")
    period = 2 * np.pi * _seconds(f"{name}: pgv_over_pga", pgv_over_pga)
    cycles = whole_within(name, "cycles", cycles, 1, 1000)
    source = "motion of a shake table commanded by PGA and PGV/PGA"
    length, step = cycles * period, min(DT, period / 400)
    given = {"amplitude": pga, "period": period, "cycles": cycles}
    return _pulse(
        name,
        source,
        lambda t: np.cos(2 * np.pi * t / period),
        length=length,
        dt=step,
        given=given,
        jumps=True,
    )


def half_sine(amplitude: float, duration: float, dt: float = DT) -> Motion:
    """Half-sine acceleration pulse a sin(πt/d), 0 ≤ t ≤ d.

    Housner (1963), Bull. Seism. Soc. Am. 53(2), 403-417.

    Parameters
    ----------
    amplitude, duration, dt : as of :func:`sine`; it lasts d [s]

    Returns
    -------
    The :class:`Motion` [m/s²].
    """
    length = _seconds("half_sine: duration", duration)
    given = {"amplitude": amplitude, "duration": duration}
    return _pulse(
        "half_sine",
        "Housner (1963)",
        lambda t: np.sin(np.pi * t / duration),
        length=length,
        dt=dt,
        given=given,
    )


def rectangular(amplitude: float, duration: float, dt: float = DT) -> Motion:
    """Rectangular acceleration pulse of constant a for a duration d; it leaves the velocity a d.

    Housner (1963), Bull. Seism. Soc. Am. 53(2), 403-417.

    Parameters
    ----------
    amplitude, duration, dt : as of :func:`sine`; it lasts d [s]

    Returns
    -------
    The :class:`Motion` [m/s²].
    """
    length = _seconds("rectangular: duration", duration)
    given = {"amplitude": amplitude, "duration": duration}
    return _pulse(
        "rectangular",
        "Housner (1963)",
        np.ones_like,
        length=length,
        dt=dt,
        given=given,
        jumps=True,
    )


def ricker_symmetric(amplitude: float, period: float, dt: float = DT) -> Motion:
    """Return a symmetric Ricker wavelet, a (1 - x²) exp(-x²/2) with x = √2 π t/T.

    The second derivative of a Gaussian; T is the period of the largest Fourier amplitude.  Ricker
    (1943), Bull. Seism. Soc. Am. 33(3), 197-228; Vassiliou & Makris (2011), Bull. Seism. Soc. Am.
    101(2), 596-618; cut off where less than 1e-9 of the peak is left.

    Parameters
    ----------
    amplitude, period, dt : as of :func:`sine`

    Returns
    -------
    The :class:`Motion` [m/s²].
    """
    centre = 7.1 * _seconds("ricker_symmetric: period", period) / (math.sqrt(2) * np.pi)

    def shape(t: Floats) -> Floats:
        x2 = 2 * (np.pi * (t - centre) / period) ** 2
        return (1 - x2) * np.exp(-x2 / 2)

    given = {"amplitude": amplitude, "period": period}
    return _pulse(
        "ricker_symmetric",
        "Ricker (1943)",
        shape,
        length=2 * centre,
        dt=dt,
        given=given,
    )


def ricker_antisymmetric(amplitude: float, period: float, dt: float = DT) -> Motion:
    """Return an antisymmetric Ricker wavelet, a x (x² - 3) exp(-x²/2) / c with x = 2πt/(√3 T).

    The third derivative of a Gaussian; c = 1.3801 makes its peak a, and T is the period of the
    largest Fourier amplitude.  Vassiliou & Makris (2011), Bull. Seism. Soc. Am. 101(2), 596-618;
    cut off where less than 1e-9 of the peak is left.

    Parameters
    ----------
    amplitude, period, dt : as of :func:`sine`

    Returns
    -------
    The :class:`Motion` [m/s²].
    """
    unit = math.sqrt(3) * _seconds("ricker_antisymmetric: period", period) / (2 * np.pi)
    centre = 7.5 * unit
    # the derivative of the shape vanishes at x² = 3 ± √6; the smaller one is the peak
    peak = math.sqrt(3 - math.sqrt(6))
    largest = peak * math.sqrt(6) * math.exp(-(peak**2) / 2)

    def shape(t: Floats) -> Floats:
        x = (t - centre) / unit
        return x * (x**2 - 3) * np.exp(-(x**2) / 2) / largest

    given = {"amplitude": amplitude, "period": period}
    return _pulse(
        "ricker_antisymmetric",
        "Vassiliou & Makris (2011)",
        shape,
        length=2 * centre,
        dt=dt,
        given=given,
    )


def mavroeidis_papageorgiou(
    velocity: float,
    period: float,
    cycles: float = 1.5,
    phase_deg: float = 0.0,
    dt: float = DT,
) -> Motion:
    """Near-fault velocity pulse v(t) = (A/2) [1 + cos(2πt/(γT))] cos(2πt/T + ν), |t| ≤ γT/2.

    Mavroeidis & Papageorgiou (2003), Bull. Seism. Soc. Am. 93(3), 1099-1131; the acceleration is
    its derivative.  The residual velocity is zero.

    Parameters
    ----------
    velocity : amplitude A of the velocity [m/s], of either sign
    period : prevailing period T [s]
    cycles : oscillatory character γ [-], one or more: nearly the number of half waves in the pulse
    phase_deg : phase ν [degrees]; 0 is a symmetric velocity pulse, 90 an antisymmetric one
    dt : as of :func:`sine`

    Returns
    -------
    The :class:`Motion` [m/s²].
    """
    who = "mavroeidis_papageorgiou"
    if real_number(f"{who}: cycles", cycles) < 1:
        raise InputError(f"{who}: cycles must be one or more, got {cycles!r}.")
    length = cycles * _seconds(f"{who}: period", period)
    phase = math.radians(real_number(f"{who}: phase_deg", phase_deg, "degrees"))
    omega = 2 * np.pi / period

    def shape(t: Floats) -> Floats:
        """Acceleration for A = 1: the derivative of envelope × wave, each with its own frequency."""
        s = t - length / 2
        slow, fast = omega * s / cycles, omega * s + phase
        of_envelope = np.sin(slow) * np.cos(fast) / cycles
        of_wave = (1 + np.cos(slow)) * np.sin(fast)
        return np.asarray(-omega / 2 * (of_envelope + of_wave))

    given = {
        "amplitude": velocity,
        "period": period,
        "cycles": cycles,
        "phase_deg": phase_deg,
    }
    return _pulse(
        who,
        "Mavroeidis & Papageorgiou (2003)",
        shape,
        length=length,
        dt=dt,
        given=given,
    )


def sine_sweep(
    amplitude: float,
    start_hz: float,
    end_hz: float,
    octaves_per_minute: float,
    dt: float = DT,
) -> Motion:
    """Logarithmic sine sweep of constant acceleration amplitude.

    The frequency f(t) = f₀ 2^(rt/60) passes r octaves in a minute, upwards or downwards: the sweep
    of IEC 60068-2-6 as shake-table laboratories run it.

    Parameters
    ----------
    amplitude : peak acceleration [m/s²]
    start_hz, end_hz : first and last frequency [Hz], different, below a quarter of the sampling frequency
    octaves_per_minute : rate r [1/min], positive
    dt : as of :func:`sine`

    Returns
    -------
    The :class:`Motion` [m/s²].
    """
    who = "sine_sweep"
    start = positive_number(f"{who}: start_hz", start_hz, "hertz")
    end = positive_number(f"{who}: end_hz", end_hz, "hertz")
    step = _seconds(f"{who}: dt", dt)
    rate = positive_number(f"{who}: octaves_per_minute", octaves_per_minute) / 60
    octaves = math.log2(end / start)
    if octaves == 0:
        raise InputError(
            f"{who}: start_hz and end_hz are both {start_hz} and nothing is swept."
        )
    if max(start, end) > 0.25 / step:
        raise InputError(
            f"{who}: {max(start, end):g} Hz is above a quarter of the sampling frequency, "
            f"{0.25 / step:g} Hz; give a smaller dt."
        )
    growth = math.copysign(rate, octaves) * math.log(2)

    def shape(t: Floats) -> Floats:
        return np.asarray(np.sin(2 * np.pi * start * np.expm1(growth * t) / growth))

    given = {"amplitude": amplitude, "start_hz": start_hz, "end_hz": end_hz}
    given["octaves_per_minute"] = octaves_per_minute
    return _pulse(
        who,
        "IEC 60068-2-6, logarithmic sweep",
        shape,
        length=abs(octaves) / rate,
        dt=dt,
        given=given,
    )


def _seconds(name: str, value: float) -> float:
    return positive_number(name, value, "seconds")


def _pulse(
    name: str,
    source: str,
    shape: Callable[[Floats], Floats],
    *,
    length: float,
    dt: float,
    given: Mapping[str, float],
    jumps: bool = False,
) -> Motion:
    """Sample the amplitude × ``shape`` between zeros; see the module's first lines.

    Parameters
    ----------
    name, source : of the pulse, and who defined it
    shape : function of the time [s] from the beginning of the pulse, by which the amplitude is multiplied
    length : of the pulse [s]
    dt : sampling interval [s] that is asked for; whole intervals make the length
    given : parameters of the pulse, with its ``amplitude`` [m/s²]
    jumps : whether the shape is not zero at its ends, so that samples lie half an interval inside
    """
    real_number(f"{name}: amplitude", given["amplitude"])
    samples = length / _seconds(f"{name}: dt", dt)
    if not 1 < samples <= MOST_SAMPLES:
        raise InputError(
            f"{name}: {length:g} s make {samples:.3g} samples of dt {dt:g} s, which is not between "
            f"2 and {MOST_SAMPLES}; choose another dt."
        )
    count = math.ceil(samples - 1e-9)
    step = length / count
    instants: Floats = np.arange(0.5 if jumps else 1.0, count) * step
    acceleration = np.pad(given["amplitude"] * np.asarray(shape(instants)), 1)
    facts = {"synthetic": True, "kind": name, "source": source}
    return Motion(acceleration, step, name, facts, ({"step": name, **plain(given)},))


def plain(parameters: Mapping[str, Any]) -> dict[str, Any]:
    """Return parameters with numbers of NumPy's types as Python's own, which JSON can carry."""
    return {
        k: v.item() if isinstance(v, np.generic) else v for k, v in parameters.items()
    }
