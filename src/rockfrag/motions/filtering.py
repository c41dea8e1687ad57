"""Steps that change the frequency content or the sampling: Butterworth filters, resampling.

The filters are ObsPy's, run forwards and backwards: no phase shift, and a response that is the
square of the Butterworth response of the given order (at a corner -6 dB, not -3 dB).  They start
from rest at either end; put zero pads first where the displacement matters
(``pad``).  A causal filter (``causal: true``) runs forwards alone: the Butterworth
response itself (-3 dB at a corner), with its delay, and nothing before the motion begins (Boore and Akkar,
2003, Earthq. Eng. Struct. Dyn. 32: 1729-1740, compare the two).  The provenance has the peak before and after
and the first and last sample, which are not zero where pads were missing.  ObsPy and SciPy are loaded where they
filter: naming a step needs neither.
"""

from fractions import Fraction

import numpy as np

from rockfrag.errors import InputError
from rockfrag.input_checks import positive_number, whole_within
from rockfrag.records.motion import Motion


def highpass(motion: Motion, corner_hz: float, order: int = 4, causal: bool = False) -> Motion:
    """Butterworth high-pass filter of an order from 1 to 10, acausal unless a causal one is asked for."""
    return _filtered("highpass", motion, order, causal, corner_hz=corner_hz)


def lowpass(motion: Motion, corner_hz: float, order: int = 4, causal: bool = False) -> Motion:
    """Butterworth low-pass filter of an order from 1 to 10, acausal unless a causal one is asked for."""
    return _filtered("lowpass", motion, order, causal, corner_hz=corner_hz)


def bandpass(
    motion: Motion, low_hz: float, high_hz: float, order: int = 4, causal: bool = False
) -> Motion:
    """Butterworth band-pass filter between two corners below Nyquist [Hz], acausal unless asked for."""
    return _filtered("bandpass", motion, order, causal, low_hz=low_hz, high_hz=high_hz)


def _filtered(kind: str, motion: Motion, order: int, causal: bool, **corners_hz: float) -> Motion:
    corners, nyquist = {}, 0.5 / motion.dt
    for name, value in corners_hz.items():
        corner = corners[name] = positive_number(f"step {kind}: {name}", value, "hertz")
        # ObsPy takes what is within a millionth of Nyquist for Nyquist and changes the filter
        if corner >= nyquist * (1 - 2e-6):
            raise InputError(
                f"step {kind}: {name} {corner} is not below the Nyquist frequency {nyquist:g} Hz of "
                f"motion {motion.name!r} (dt {motion.dt:g} s)."
            )
    order = whole_within(f"step {kind}", "order", order, 1, 10)
    if not isinstance(causal, bool):
        raise InputError(f"step {kind}: causal must be true or false, got {causal!r}.")
    if kind == "bandpass" and corners["low_hz"] >= corners["high_hz"]:
        raise InputError(
            f"step bandpass: the band from low_hz {corners['low_hz']} to high_hz {corners['high_hz']} is empty; "
            "low_hz must be the smaller."
        )
    from obspy.signal import filter as obspy_filter

    samples = getattr(obspy_filter, kind)(
        motion.acceleration, *corners.values(), 1 / motion.dt, corners=order, zerophase=not causal
    )
    ends = [float(samples[0]), float(samples[-1])]
    settings = {**corners, "order": order, "causal": causal}
    return motion.after(kind, samples, **settings, **motion.peaks(samples), ends_m_s2=ends)


def resample(motion: Motion, dt_s: float) -> Motion:
    """Change the sampling interval of a band-limited signal (SciPy's polyphase filter); nothing is aliased.

    The values between samples become those of the band-limited signal, not of the straight lines:
    peaks change, as the provenance says; :func:`interpolate` keeps the lines. A motion that does not begin and
    end at zero is taken off the straight line between its ends first, so that it does not ring there.
    """
    dt_s = positive_number("step resample: dt_s", dt_s, "seconds")
    if dt_s >= motion.dt * motion.acceleration.size:
        raise InputError(f"step resample: dt_s {dt_s} is not shorter than motion {motion.name!r}.")
    ratio = Fraction(motion.dt / dt_s).limit_denominator(1000)
    if ratio.numerator > 1000 or abs(float(ratio) * dt_s / motion.dt - 1) > 1e-9:
        raise InputError(
            f"step resample: dt_s {dt_s} and the motion's dt {motion.dt} have no ratio of whole "
            "numbers up to 1000; choose a rounder dt_s."
        )
    from scipy.signal import resample_poly

    ends = "line" if motion.acceleration.size > 1 else "constant"
    samples = resample_poly(motion.acceleration, ratio.numerator, ratio.denominator, padtype=ends)
    count = int((motion.acceleration.size - 1) * motion.dt / dt_s * (1 + 1e-12)) + 1
    samples = samples[:count]
    return motion.after("resample", samples, dt=dt_s, dt_s=dt_s, **motion.peaks(samples))


def interpolate(motion: Motion, dt_s: float) -> Motion:
    """Sample the straight lines between samples more finely; the motion itself stays the same."""
    dt_s = positive_number("step interpolate: dt_s", dt_s, "seconds")
    parts = round(motion.dt / dt_s)
    if not 1 <= parts <= 1000 or abs(parts * dt_s / motion.dt - 1) > 1e-9:
        raise InputError(
            f"step interpolate: dt_s {dt_s} is not a whole fraction of the motion's dt "
            f"{motion.dt}; choose one that is, or use the step resample."
        )
    old = np.arange(motion.acceleration.size) * parts
    samples = np.interp(np.arange(old[-1] + 1), old, motion.acceleration)
    return motion.after("interpolate", samples, dt=dt_s, dt_s=dt_s)
