"""Steps that change the frequency content or the sampling: acausal Butterworth filters, resampling.

The filters are ObsPy's, run forwards and backwards: no phase shift, and a response that is the
square of the Butterworth response of the given order (at a corner -6 dB, not -3 dB).  They start
from rest at either end; put zero pads first where the displacement matters
(:func:`rockfrag.motions.pad`).  ObsPy and SciPy are loaded where they filter: naming a step needs neither.
"""

from fractions import Fraction

import numpy as np

from rockfrag.errors import InputError
from rockfrag.motions.checks import positive, whole
from rockfrag.records.motion import Motion


def highpass(motion: Motion, corner_hz: float, order: int = 4) -> Motion:
    """Acausal Butterworth high-pass filter.

    Parameters
    ----------
    motion
        Motion as it is.
    corner_hz
        Corner frequency [Hz], below Nyquist.
    order
        Order of the filter, 1 to 10; it acts twice.

    Raises
    ------
    InputError
        If the corner is not between zero and Nyquist or the order is not such a number.
    """
    corner_hz = _corner("highpass", "corner_hz", corner_hz, motion)
    order = whole("step highpass", "order", order, 1, 10)
    from obspy.signal import filter as obspy_filter

    filtered = obspy_filter.highpass(
        motion.acceleration, corner_hz, 1 / motion.dt, corners=order, zerophase=True
    )
    return motion.after("highpass", filtered, corner_hz=corner_hz, order=order)


def lowpass(motion: Motion, corner_hz: float, order: int = 4) -> Motion:
    """Acausal Butterworth low-pass filter.

    Parameters
    ----------
    motion
        Motion as it is.
    corner_hz
        Corner frequency [Hz], below Nyquist.
    order
        Order of the filter, 1 to 10; it acts twice.

    Raises
    ------
    InputError
        If the corner is not between zero and Nyquist or the order is not such a number.
    """
    corner_hz = _corner("lowpass", "corner_hz", corner_hz, motion)
    order = whole("step lowpass", "order", order, 1, 10)
    from obspy.signal import filter as obspy_filter

    filtered = obspy_filter.lowpass(
        motion.acceleration, corner_hz, 1 / motion.dt, corners=order, zerophase=True
    )
    return motion.after("lowpass", filtered, corner_hz=corner_hz, order=order)


def bandpass(motion: Motion, low_hz: float, high_hz: float, order: int = 4) -> Motion:
    """Acausal Butterworth band-pass filter between two corners below Nyquist [Hz].

    Parameters
    ----------
    motion
        Motion as it is.
    low_hz
        Lower corner [Hz].
    high_hz
        Upper corner [Hz], below Nyquist.
    order
        Order of the filter, 1 to 10; it acts twice.

    Raises
    ------
    InputError
        If a corner is not between zero and Nyquist, the band is empty, or the order is not from 1
        to 10.
    """
    low_hz = _corner("bandpass", "low_hz", low_hz, motion)
    high_hz = _corner("bandpass", "high_hz", high_hz, motion)
    order = whole("step bandpass", "order", order, 1, 10)
    if low_hz >= high_hz:
        raise InputError(
            f"step bandpass: the band from low_hz {low_hz} to high_hz {high_hz} is empty; "
            "low_hz must be the smaller."
        )
    from obspy.signal import filter as obspy_filter

    filtered = obspy_filter.bandpass(
        motion.acceleration, low_hz, high_hz, 1 / motion.dt, corners=order, zerophase=True
    )
    return motion.after("bandpass", filtered, low_hz=low_hz, high_hz=high_hz, order=order)


def resample(motion: Motion, dt_s: float) -> Motion:
    """Change the sampling interval of a band-limited signal (SciPy's polyphase filter).

    The filter takes out what the coarser of the two samplings cannot carry, so nothing is aliased.
    The values between samples become those of the band-limited signal, not of the straight lines:
    peaks change; :func:`interpolate` keeps the lines.

    Parameters
    ----------
    motion
        Motion as it is.
    dt_s
        New sampling interval [s]; old and new must have a ratio of whole numbers up to 1000.

    Raises
    ------
    InputError
        If the interval is not positive, has no such ratio, or is not shorter than the motion.
    """
    dt_s = positive("step resample", "dt_s", dt_s, "seconds")
    if dt_s >= motion.dt * motion.acceleration.size:
        raise InputError(f"step resample: dt_s {dt_s} is not shorter than motion {motion.name!r}.")
    ratio = Fraction(motion.dt / dt_s).limit_denominator(1000)
    if ratio.numerator > 1000 or abs(float(ratio) * dt_s / motion.dt - 1) > 1e-9:
        raise InputError(
            f"step resample: dt_s {dt_s} and the motion's dt {motion.dt} have no ratio of whole "
            "numbers up to 1000; choose a rounder dt_s."
        )
    from scipy.signal import resample_poly

    samples = resample_poly(motion.acceleration, ratio.numerator, ratio.denominator)
    return motion.after("resample", samples, dt=dt_s, dt_s=dt_s)


def interpolate(motion: Motion, dt_s: float) -> Motion:
    """Sample the straight lines between samples more finely; the motion itself stays the same.

    Parameters
    ----------
    motion
        Motion as it is.
    dt_s
        New sampling interval [s], a whole fraction of the old one.

    Raises
    ------
    InputError
        If it is not a whole fraction of the old interval.
    """
    dt_s = positive("step interpolate", "dt_s", dt_s, "seconds")
    parts = round(motion.dt / dt_s)
    if not 1 <= parts <= 1000 or abs(parts * dt_s / motion.dt - 1) > 1e-9:
        raise InputError(
            f"step interpolate: dt_s {dt_s} is not a whole fraction of the motion's dt "
            f"{motion.dt}; choose one that is, or use the step resample."
        )
    old = np.arange(motion.acceleration.size) * parts
    samples = np.interp(np.arange(old[-1] + 1), old, motion.acceleration)
    return motion.after("interpolate", samples, dt=dt_s, dt_s=dt_s)


def _corner(step: str, name: str, value: float, motion: Motion) -> float:
    corner = positive(f"step {step}", name, value, "hertz")
    nyquist = 0.5 / motion.dt
    # ObsPy takes what is within a millionth of Nyquist for Nyquist and changes the filter
    if corner >= nyquist * (1 - 2e-6):
        raise InputError(
            f"step {step}: {name} {corner} is not below the Nyquist frequency {nyquist:g} Hz of "
            f"motion {motion.name!r} (dt {motion.dt:g} s)."
        )
    return corner
