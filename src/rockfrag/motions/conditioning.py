"""Steps that mend the ends and the zero line of a record, and that keep its strong part.

Each takes a motion and returns the motion it becomes, with the step and its parameters in the
provenance.  Velocity and displacement are never stored: they always follow from the acceleration by
exact integration, so the three are consistent after any step: what is kept of a motion starts from rest.
"""

import math
from dataclasses import replace

import numpy as np
from numpy.polynomial import Polynomial

from rockfrag.errors import InputError
from rockfrag.input_checks import number_from_zero, positive_number, real_number, whole_within
from rockfrag.motions.intensity import arias_times, bracketed_times
from rockfrag.records.motion import MOST_SAMPLES, Motion, integrate
from rockfrag.units import GRAVITY


def demean(motion: Motion) -> Motion:
    """Subtract the mean of the acceleration."""
    mean = float(motion.acceleration.mean())
    return motion.after("demean", motion.acceleration - mean, removed_m_s2=mean)


def remove_median(motion: Motion) -> Motion:
    """Subtract the median of the acceleration: the zero line of an instrument, whatever the shaking."""
    median = float(np.median(motion.acceleration))
    return motion.after("remove_median", motion.acceleration - median, removed_m_s2=median)


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
    spikes = difference > times * scale if scale > 0 else np.zeros(difference.size, dtype=bool)
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

    The polynomial has no constant and no linear term, so that displacement and velocity still start
    from zero; order 6 is the rule of the PEER ground motion database (Ancheta et al. 2013, PEER
    Report 2013/03).
    """
    order = whole_within("step displacement_baseline", "order", order, 2, 10)
    _enough_samples("displacement_baseline", motion, order + 2)
    _, displacement = integrate(motion.acceleration, motion.dt)
    # in units of the length of the record, so that high powers stay near one
    length = motion.time[-1]
    x = motion.time / length
    powers = np.arange(2, order + 1)
    coefficients = np.linalg.lstsq(x[:, None] ** powers, displacement, rcond=None)[0]
    trend = x[:, None] ** (powers - 2) @ (coefficients * powers * (powers - 1)) / length**2
    return motion.after("displacement_baseline", motion.acceleration - trend, order=order)


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
    start, end = arias_times(motion, lower, upper)
    if math.isnan(start):
        raise InputError(
            f"step strong_part: motion {motion.name!r} is zero throughout and has no strong part."
        )
    return _between(motion, "strong_part", start, end, lower=lower, upper=upper)


def bracketed_part(motion: Motion, threshold_g: float = 0.05) -> Motion:
    """Keep everything between the first and the last sample that reaches a threshold [g]."""
    threshold_g = positive_number("step bracketed_part: threshold_g", threshold_g, "g")
    start, end = bracketed_times(motion, threshold_g * GRAVITY)
    if math.isnan(start):
        raise InputError(
            f"step bracketed_part: motion {motion.name!r} never reaches {threshold_g} g "
            f"(its peak is {motion.pga / GRAVITY:.3g} g); lower threshold_g."
        )
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


def _between(motion: Motion, step: str, start: float, end: float, **parameters: float) -> Motion:
    """Cut to whole samples; a time that is a sample but for rounding counts as that sample."""
    first = math.floor(start / motion.dt + 1e-6)
    last = math.ceil(end / motion.dt - 1e-6)
    kept = motion.after(
        step, motion.acceleration[first : last + 1], **parameters, start_s=start, end_s=end
    )
    return starting_later(kept, first * motion.dt)
