"""Steps that keep the strong part of a motion.

What is cut away had given the kept part a velocity; the kept part starts from rest and so
integrates to other velocities.  Baseline steps after the cut are the user's choice.
"""

import math

from rockfrag.errors import InputError
from rockfrag.input_checks import number_from_zero, positive_number, real_number
from rockfrag.motions.conditioning import starting_later
from rockfrag.motions.intensity import arias_times, bracketed_times
from rockfrag.records.motion import Motion
from rockfrag.units import GRAVITY


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
