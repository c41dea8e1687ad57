"""Steps that process a motion, by name, as a configuration lists them.

Each takes a motion and returns the motion it becomes, with the step and its parameters in the
provenance.  Velocity and displacement are never stored: they always follow from the acceleration by
exact integration, so the three are consistent after any step: what is kept of a motion starts from rest.

The Butterworth filters are ObsPy's, run forwards and backwards: no phase shift, and a response that is the
square of the Butterworth response of the given order (at a corner -6 dB, not -3 dB).  They start
from rest at either end; put zero pads first where the displacement matters
(``pad``).  A causal filter (``causal: true``) runs forwards alone: the Butterworth
response itself (-3 dB at a corner), with its delay, and nothing before the motion begins (Boore and Akkar,
2003, Earthq. Eng. Struct. Dyn. 32: 1729-1740, compare the two).  The provenance has the peak before and after
and the first and last sample, which are not zero where pads were missing.  ObsPy and SciPy are loaded where they
filter: naming a step needs neither.
"""

import inspect
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.polynomial import Polynomial

from rockfrag.base.arrays import Floats
from rockfrag.base.errors import InputError
from rockfrag.base.input_checks import (
    number_from_zero,
    positive_number,
    real_number,
    whole_within,
)
from rockfrag.base.units import CENTIMETRES_PER_METRE, GRAVITY
from rockfrag.motions import intensity
from rockfrag.records.motion import MOST_SAMPLES, Motion, integrate


def demean(motion: Motion) -> Motion:
    """Subtract the mean of the acceleration."""
    mean = float(motion.acceleration.mean())
    return motion.after("demean", motion.acceleration - mean, removed_m_s2=mean)


def remove_median(motion: Motion) -> Motion:
    """Subtract the median of the acceleration: the zero line of an instrument, whatever the shaking."""
    median = float(np.median(motion.acceleration))
    return motion.after(
        "remove_median", motion.acceleration - median, removed_m_s2=median
    )


def despike(motion: Motion, times: float = 50.0) -> Motion:
    """Replace samples that stand out from their neighbours by the median of their neighbourhood.

    A spike differs from the running median of five samples by more than ``times`` the standard deviation of
    such differences, estimated by the size that 95 % of them do not exceed (Hampel's identifier, Davies and
    Gather, 1993, J. Am. Stat. Assoc. 88: 782-792).  Where most samples repeat each other nothing is replaced.
    """
    times = positive_number("step despike: times", times, "standard deviations")
    _enough_samples("despike", motion, 5)
    from scipy.ndimage import median_filter

    smooth = median_filter(motion.acceleration, size=5, mode="nearest")
    difference = np.abs(motion.acceleration - smooth)
    scale = float(np.quantile(difference, 0.95)) / 1.96
    spikes = (
        difference > times * scale
        if scale > 0
        else np.zeros(difference.size, dtype=bool)
    )
    cleaned = np.where(spikes, smooth, motion.acceleration)
    return motion.after("despike", cleaned, times=times, replaced=int(spikes.sum()))


def baseline(motion: Motion, order: int = 1) -> Motion:
    """Subtract the polynomial in time that fits the acceleration best (least squares)."""
    order = whole_within("step baseline", "order", order, 0, 10)
    _enough_samples("baseline", motion, order + 2)
    fit = Polynomial.fit(motion.time, motion.acceleration, order)
    return motion.after("baseline", motion.acceleration - fit(motion.time), order=order)


def displacement_baseline(motion: Motion, order: int = 6) -> Motion:
    """Subtract the second derivative of a polynomial fitted to the displacement.

    The polynomial has no constant and no linear term, so that displacement and velocity still start from zero;
    order 6 is the rule of the PEER ground motion database (Ancheta et al. 2013, PEER Report 2013/03).
    """
    order = whole_within("step displacement_baseline", "order", order, 2, 10)
    _enough_samples("displacement_baseline", motion, order + 2)
    _, displacement = integrate(motion.acceleration, motion.dt)
    # in units of the length of the record, so that high powers stay near one
    length = motion.time[-1]
    x = motion.time / length
    powers = np.arange(2, order + 1)
    coefficients = np.linalg.lstsq(x[:, None] ** powers, displacement, rcond=None)[0]
    trend = (
        x[:, None] ** (powers - 2) @ (coefficients * powers * (powers - 1)) / length**2
    )
    return motion.after(
        "displacement_baseline", motion.acceleration - trend, order=order
    )


def taper(motion: Motion, duration_s: float) -> Motion:
    """Bring both ends to zero with half a cosine bell (Tukey window; SciPy)."""
    duration_s = positive_number("step taper: duration_s", duration_s, "seconds")
    length = motion.time[-1]
    if 2 * duration_s > length:
        raise InputError(
            f"step taper: duration_s of {duration_s} at each end does not fit into the {length:g} "
            f"s of motion {motion.name!r}; give at most half of it."
        )
    from scipy.signal.windows import tukey

    window = tukey(motion.acceleration.size, alpha=2 * duration_s / length)
    return motion.after("taper", motion.acceleration * window, duration_s=duration_s)


def pad(motion: Motion, before_s: float = 0.0, after_s: float = 0.0) -> Motion:
    """Put zeros before and after the acceleration.

    An acausal filter needs room for its transients: 1.5 × order / corner seconds in all (Converse &
    Brady 1992, USGS Open-File Report 92-296A), and displacements stay right only while that room is
    kept (Boore 2005, Bull. Seism. Soc. Am. 95(2), 745-750).

    Parameters
    ----------
    motion : acceleration of n samples
    before_s, after_s : lengths of the zeros [s]

    Returns
    -------
    The longer motion.
    """
    before_s = number_from_zero("step pad: before_s", before_s, "seconds")
    after_s = number_from_zero("step pad: after_s", after_s, "seconds")
    if before_s + after_s > MOST_SAMPLES * motion.dt:
        raise InputError(
            f"step pad: {before_s + after_s:g} s of zeros are more than {MOST_SAMPLES} samples of "
            f"dt {motion.dt:g} s; give less."
        )
    counts = [round(seconds / motion.dt) for seconds in (before_s, after_s)]
    padded = motion.after(
        "pad", np.pad(motion.acceleration, counts), before_s=before_s, after_s=after_s
    )
    return starting_later(padded, -counts[0] * motion.dt)


def starting_later(motion: Motion, seconds: float) -> Motion:
    """Move the ``start_time`` of the metadata, where there is one, with the first sample."""
    start = motion.metadata.get("start_time")
    if not start:
        return motion
    from obspy import UTCDateTime

    moved = str(UTCDateTime(start) + seconds)
    return replace(motion, metadata={**motion.metadata, "start_time": moved})


def _enough_samples(step: str, motion: Motion, least: int) -> None:
    """Refuse a motion that is too short for a step."""
    if motion.acceleration.size < least:
        raise InputError(
            f"step {step}: motion {motion.name!r} has {motion.acceleration.size} sample(s) and "
            f"{least} are needed; use a lower order or a longer motion."
        )


def strong_part(motion: Motion, lower: float = 0.05, upper: float = 0.95) -> Motion:
    """Keep the samples between two fractions of the Arias intensity."""
    lower = real_number("step strong_part: lower", lower)
    upper = real_number("step strong_part: upper", upper)
    if not 0 <= lower < upper <= 1:
        raise InputError(
            f"step strong_part: lower {lower} and upper {upper} must be fractions of the Arias "
            "intensity with 0 ≤ lower < upper ≤ 1."
        )
    start, end = intensity.arias_times(motion, lower, upper)
    if math.isnan(start):
        raise InputError(
            f"step strong_part: motion {motion.name!r} is zero throughout and has no strong part."
        )
    return _between(motion, "strong_part", start, end, lower=lower, upper=upper)


def bracketed_part(motion: Motion, threshold_g: float = 0.05) -> Motion:
    """Keep everything between the first and the last sample that reaches a threshold [g].

    Bolt (1973, 5th World Conference on Earthquake Engineering).
    """
    threshold_g = positive_number("step bracketed_part: threshold_g", threshold_g, "g")
    above = np.flatnonzero(np.abs(motion.acceleration) >= threshold_g * GRAVITY)
    if above.size == 0:
        raise InputError(
            f"step bracketed_part: motion {motion.name!r} never reaches {threshold_g} g "
            f"(its peak is {motion.pga / GRAVITY:.3g} g); lower threshold_g."
        )
    start, end = float(above[0] * motion.dt), float(above[-1] * motion.dt)
    return _between(motion, "bracketed_part", start, end, threshold_g=threshold_g)


def trim(motion: Motion, start_s: float, end_s: float) -> Motion:
    """Keep the samples from ``start_s`` to ``end_s`` [s], counted from the first sample."""
    start_s = number_from_zero("step trim: start_s", start_s, "seconds")
    end_s = positive_number("step trim: end_s", end_s, "seconds")
    length = float(motion.time[-1])
    if not start_s < end_s <= length + motion.dt / 2:
        raise InputError(
            f"step trim: the window from {start_s} to {end_s} s does not lie inside the {length:g} "
            f"s of motion {motion.name!r}."
        )
    return _between(motion, "trim", start_s, end_s)


def _between(
    motion: Motion, step: str, start: float, end: float, **parameters: float
) -> Motion:
    """Cut to whole samples; a time that is a sample but for rounding counts as that sample.

    ``step``: name of the step in the provenance, with ``parameters``; ``start``, ``end``: times [s].
    """
    first = math.floor(start / motion.dt + 1e-6)
    last = math.ceil(end / motion.dt - 1e-6)
    kept = motion.after(
        step,
        motion.acceleration[first : last + 1],
        **parameters,
        start_s=start,
        end_s=end,
    )
    return starting_later(kept, first * motion.dt)


def highpass(
    motion: Motion, corner_hz: float, order: int = 4, causal: bool = False
) -> Motion:
    """Butterworth high-pass filter, acausal unless a causal one is asked for.

    Parameters
    ----------
    motion, corner_hz : the motion, and the corner frequency [Hz]
    order, causal : of the filter, 1 to 10, and whether it runs forwards only

    Returns
    -------
    The filtered motion [m/s²].
    """
    return _filtered("highpass", motion, order, causal, corner_hz=corner_hz)


def lowpass(
    motion: Motion, corner_hz: float, order: int = 4, causal: bool = False
) -> Motion:
    """Butterworth low-pass filter, acausal unless a causal one is asked for.

    Parameters
    ----------
    motion, corner_hz : the motion, and the corner frequency [Hz]
    order, causal : of the filter, 1 to 10, and whether it runs forwards only

    Returns
    -------
    The filtered motion [m/s²].
    """
    return _filtered("lowpass", motion, order, causal, corner_hz=corner_hz)


def bandpass(
    motion: Motion, low_hz: float, high_hz: float, order: int = 4, causal: bool = False
) -> Motion:
    """Butterworth band-pass filter between two corners below Nyquist, acausal unless a causal one is asked for.

    Parameters
    ----------
    motion, low_hz, high_hz : the motion, and the corner frequencies [Hz]
    order, causal : of the filter, 1 to 10, and whether it runs forwards only

    Returns
    -------
    The filtered motion [m/s²].
    """
    return _filtered("bandpass", motion, order, causal, low_hz=low_hz, high_hz=high_hz)


def _filtered(
    kind: str, motion: Motion, order: int, causal: bool, **corners_hz: float
) -> Motion:
    """Filter a motion by ObsPy's Butterworth filter of a kind, with its corners in the provenance.

    ``kind``: ``highpass``, ``lowpass`` or ``bandpass``; ``corners_hz``: below Nyquist, by their name in messages.
    """
    corners, nyquist = {}, 0.5 / motion.dt
    for name, value in corners_hz.items():
        corner = positive_number(f"step {kind}: {name}", value, "hertz")
        corners[name] = corner
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
        motion.acceleration,
        *corners.values(),
        1 / motion.dt,
        corners=order,
        zerophase=not causal,
    )
    ends = [float(samples[0]), float(samples[-1])]
    settings = {**corners, "order": order, "causal": causal}
    return motion.after(
        kind, samples, **settings, **motion.peaks(samples), ends_m_s2=ends
    )


def resample(motion: Motion, dt_s: float) -> Motion:
    """Change the sampling interval of a band-limited signal (SciPy's polyphase filter); nothing is aliased.

    The values between samples become those of the band-limited signal, not of the straight lines:
    peaks change, as the provenance says; :func:`interpolate` keeps the lines. Of a motion that does not begin and
    end at zero the straight line between its ends is taken off first, so that it does not ring there.
    """
    dt_s = positive_number("step resample: dt_s", dt_s, "seconds")
    if dt_s >= motion.dt * motion.acceleration.size:
        raise InputError(
            f"step resample: dt_s {dt_s} is not shorter than motion {motion.name!r}."
        )
    ratio = Fraction(motion.dt / dt_s).limit_denominator(1000)
    if ratio.numerator > 1000 or abs(float(ratio) * dt_s / motion.dt - 1) > 1e-9:
        raise InputError(
            f"step resample: dt_s {dt_s} and the motion's dt {motion.dt} have no ratio of whole "
            "numbers up to 1000; choose a rounder dt_s."
        )
    from scipy.signal import resample_poly

    ends = "line" if motion.acceleration.size > 1 else "constant"
    samples = resample_poly(
        motion.acceleration, ratio.numerator, ratio.denominator, padtype=ends
    )
    count = int((motion.acceleration.size - 1) * motion.dt / dt_s * (1 + 1e-12)) + 1
    samples = samples[:count]
    return motion.after(
        "resample", samples, dt=dt_s, dt_s=dt_s, **motion.peaks(samples)
    )


def interpolate(motion: Motion, dt_s: float) -> Motion:
    """Sample the straight lines between samples more finely; the motion itself stays the same.

    Parameters
    ----------
    motion : the motion [m/s²]
    dt_s : its new interval, a whole fraction of its own [s]

    Returns
    -------
    The motion with more samples [m/s²].
    """
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


def scale(motion: Motion, factor: float) -> Motion:
    """Multiply the acceleration by ``factor``, a positive number.

    Parameters
    ----------
    motion : motion as it is
    factor : factor on the acceleration [-], positive

    Returns
    -------
    The :class:`Motion` so changed, with the step in its provenance.
    """
    factor = positive_number("step scale: factor", factor)
    return motion.after("scale", motion.acceleration * factor, factor=factor)


def factors_to_pga(motion: Motion, pga_g: Floats) -> Floats:
    """Factors [-] that scale a motion to peak accelerations [g], in the shape in which these come.

    Parameters
    ----------
    motion, pga_g : the motion, and peak accelerations [g], any shape

    Returns
    -------
    The factors [-], same shape.
    """
    _check_not_zero("factors_to_pga", motion, motion.pga)
    return pga_g * GRAVITY / motion.pga


def scale_to_pga(motion: Motion, pga_g: float) -> Motion:
    """Scale to a peak acceleration [g].

    Parameters
    ----------
    motion : as of :func:`scale`, not zero throughout
    pga_g : wanted peak acceleration [g], positive

    Returns
    -------
    The :class:`Motion` so changed, with the step in its provenance.
    """
    target = positive_number("step scale_to_pga: pga_g", pga_g, "g")
    return _scaled(
        "scale_to_pga", motion, target * GRAVITY, intensity.pga(motion), pga_g=target
    )


def scale_to_pgv(motion: Motion, pgv_cm_s: float) -> Motion:
    """Scale to a peak velocity [cm/s], between samples too.

    Parameters
    ----------
    motion : as of :func:`scale`, not zero throughout
    pgv_cm_s : wanted peak velocity [cm/s], positive

    Returns
    -------
    The :class:`Motion` so changed, with the step in its provenance.
    """
    target = positive_number("step scale_to_pgv: pgv_cm_s", pgv_cm_s, "cm/s")
    wanted = target / CENTIMETRES_PER_METRE
    return _scaled(
        "scale_to_pgv", motion, wanted, intensity.pgv(motion), pgv_cm_s=target
    )


def scale_to_sa(
    motion: Motion, sa_g: float, period_s: float, damping: float = 0.05
) -> Motion:
    """Scale to a pseudo-spectral acceleration.

    Parameters
    ----------
    motion : to be scaled
    sa_g : the acceleration [g]
    period_s, damping : of the oscillator [s], and fraction of critical damping [-]
    """
    target = positive_number("step scale_to_sa: sa_g", sa_g, "g")
    period_s = positive_number("step scale_to_sa: period_s", period_s, "seconds")
    damping = number_from_zero("step scale_to_sa: damping", damping)
    actual = intensity.spectral_acceleration(motion, period_s, damping)
    settings = {"sa_g": target, "period_s": period_s, "damping": damping}
    return _scaled("scale_to_sa", motion, target * GRAVITY, actual, **settings)


def scale_to_arias(motion: Motion, arias_m_s: float) -> Motion:
    """Scale to an Arias intensity [m/s]."""
    target = positive_number("step scale_to_arias: arias_m_s", arias_m_s, "m/s")
    return _scaled(
        "scale_to_arias", motion, target, intensity.arias(motion), 0.5, arias_m_s=target
    )


def compress_time(motion: Motion, factor: float) -> Motion:
    """Divide all times by a similitude factor, with the acceleration unchanged.

    A model at length scale 1 : λ under the same gravity needs the factor √λ; velocities are divided
    by √λ and displacements by λ (similitude of Froude; Harris & Sabnis 1999, Structural Modeling
    and Experimental Techniques, 2nd ed.).  A factor below one stretches time.
    """
    factor = positive_number("step compress_time: factor", factor)
    return motion.after(
        "compress_time", motion.acceleration, dt=motion.dt / factor, factor=factor
    )


def _scaled(
    step: str,
    motion: Motion,
    target: float,
    actual: float,
    power: float = 1.0,
    **settings: float,
) -> Motion:
    """Scale a motion from the actual value of a measure to a target, by a power of their ratio."""
    _check_not_zero(step, motion, actual)
    factor = (target / actual) ** power
    return motion.after(step, motion.acceleration * factor, **settings, factor=factor)


def _check_not_zero(step: str, motion: Motion, actual: float) -> None:
    """Refuse to scale a motion whose peak is zero."""
    if actual <= 0:
        raise InputError(
            f"step {step}: motion {motion.name!r} is zero throughout and cannot be scaled; leave it out."
        )


STEPS: Mapping[str, Callable[..., Motion]] = MappingProxyType(
    {
        step.__name__: step
        for step in (
            *(
                demean,
                remove_median,
                despike,
                baseline,
                displacement_baseline,
                taper,
                pad,
            ),
            *(
                highpass,
                lowpass,
                bandpass,
                resample,
                interpolate,
                strong_part,
                bracketed_part,
            ),
            *(
                trim,
                scale,
                scale_to_pga,
                scale_to_pgv,
                scale_to_sa,
                scale_to_arias,
                compress_time,
            ),
        )
    }
)
"""Every step that :func:`process` knows, by its name."""

_FOUND = frozenset(
    {"removed_m_s2", "replaced", "peak_before_m_s2", "peak_after_m_s2", "ends_m_s2"}
)
"""What steps write into the provenance of what they found: no parameters, when they are taken again."""


def process(motion: Motion, steps: Sequence[Mapping[str, Any]] = ()) -> Motion:
    """Take a motion through steps in the order given; no steps leave it as it is.

    Parameters
    ----------
    motion : what to process
    steps
        Each a mapping with the ``step``'s name and its parameters, such as
        ``{"step": "highpass", "corner_hz": 0.1, "order": 4}``.

    Returns
    -------
    The processed motion; each step and its parameters are appended to its provenance.
    """
    # a misspelt last step is reported before the first one has cost anything
    for function, parameters in check_steps(steps):
        motion = function(motion, **parameters)
    return motion


def check_steps(
    steps: Sequence[Mapping[str, Any]],
) -> list[tuple[Callable[..., Motion], dict[str, Any]]]:
    """Functions and parameters of processing steps; InputError for an unknown one.

    Parameters
    ----------
    steps : each with ``step`` and its parameters

    Returns
    -------
    A function and its parameters for each step.
    """
    if isinstance(steps, str | Mapping) or not isinstance(steps, Sequence):
        raise InputError(f"processing: a list of steps is needed, got {steps!r}.")
    return [_checked(number, entry) for number, entry in enumerate(steps, start=1)]


def _checked(
    number: int, entry: Mapping[str, Any]
) -> tuple[Callable[..., Motion], dict[str, Any]]:
    """Return the function of the ``number``-th entry of a list of steps, and the parameters that it names."""
    if not isinstance(entry, Mapping) or "step" not in entry:
        raise InputError(
            f"processing, entry {number}: {entry!r} is not a mapping with a key 'step'."
        )
    name = entry["step"]
    if not isinstance(name, str) or name not in STEPS:
        raise InputError(
            f"processing, entry {number}: there is no step {name!r}; known are {', '.join(STEPS)}."
        )
    parameters = {
        key: value
        for key, value in entry.items()
        if key != "step" and key not in _FOUND
    }
    # the first parameter is the motion itself
    known = dict(list(inspect.signature(STEPS[name]).parameters.items())[1:])
    unknown = [key for key in parameters if key not in known]
    if unknown:
        raise InputError(
            f"processing, entry {number}: step {name} has no parameter {unknown[0]!r}; "
            f"known are {', '.join(known) or 'none'}."
        )
    missing = [
        key
        for key, p in known.items()
        if p.default is p.empty and key not in parameters
    ]
    if missing:
        raise InputError(
            f"processing, entry {number}: step {name} needs {', '.join(missing)}."
        )
    return STEPS[name], parameters
