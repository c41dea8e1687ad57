"""A main shock and what follows it: one motion with quiet time between both, and the probability of either fall.

An aftershock finds an object where the main shock left it, moved and turned: the response to both motions with
quiet time between them is that of a sequence, whatever the engine. Probabilities of falling in either are joined
draw by draw of what is not known of the object, so that what survived the first is stronger than the usual object.
"""

import math
from collections.abc import Sequence
from fractions import Fraction

import numpy as np

from rockfrag.base.arrays import Floats
from rockfrag.base.errors import InputError
from rockfrag.records.motion import Motion

QUIET = 30.0  # Time between both, in which rocking dies out [s]
FINEST = 20  # Most samples of the joined motion to one of its parts


def one_after_the_other(
    first: Sequence[Motion], then: Sequence[Motion], quiet: float = QUIET
) -> tuple[Motion, ...]:
    """Join the components of two records, with quiet time between them.

    Parameters
    ----------
    first, then : components of the main shock and of what follows, in the same order and number [m/s²]
    quiet : time between them [s]

    Returns
    -------
    The joined components [m/s²].

    Raises
    ------
    InputError
        If one has more components than the other.
    """
    if len(first) != len(then):
        raise InputError(
            f"the records of a sequence have {len(first)} and {len(then)} horizontal components; give as many of "
            "both."
        )
    dt = _common_interval([motion.dt for motion in (*first, *then)])
    mains = _of_one_length([_sampled(motion, dt) for motion in first])
    others = _of_one_length([_sampled(motion, dt) for motion in then])
    rest = np.zeros(round(quiet / dt))
    joined = []
    for at, (before, after) in enumerate(zip(first, then, strict=True)):
        samples = np.concatenate([mains[at], rest, others[at]])
        name = f"{before.name}, then {after.name}"
        joined.append(Motion(samples, dt, name, before.metadata))
    return tuple(joined)


def _of_one_length(components: Sequence[Floats]) -> list[Floats]:
    """Components with zeros at the end of shorter ones, so that what follows begins in all at once."""
    longest = max(samples.size for samples in components)
    return [np.pad(samples, (0, longest - samples.size)) for samples in components]


def _common_interval(intervals: Sequence[float]) -> float:
    """Longest interval of which all are multiples [s], but not far shorter than the shortest."""
    parts = [Fraction(dt).limit_denominator(1_000_000) for dt in intervals]
    below = math.lcm(*(part.denominator for part in parts))
    above = math.gcd(*(int(part * below) for part in parts))
    return max(above / below, min(intervals) / FINEST)


def _sampled(motion: Motion, dt: float) -> Floats:
    """Samples of the straight lines between those of a motion, shape (n,) [m/s²]."""
    if motion.dt == dt:
        return motion.acceleration
    end = motion.dt * (motion.acceleration.size - 1)
    times = dt * np.arange(math.floor(end / dt * (1 + 1e-12)) + 1)
    old = motion.dt * np.arange(motion.acceleration.size)
    return np.asarray(np.interp(times, old, motion.acceleration))


def in_either(first: Floats, then: Floats) -> Floats:
    """Probability of a fall in one shock or the other, in each draw of what is not known.

    Parameters
    ----------
    first, then : probabilities in each, shape (draws,) [-]

    Returns
    -------
    Probabilities, shape (draws,).
    """
    return np.asarray(1.0 - (1.0 - first) * (1.0 - then))
