"""A main shock and what follows it: one motion with quiet time between both, and the probability of either fall.

An aftershock finds an object where the main shock left it, moved and turned: the response to both motions with
quiet time between them is that of a sequence, whatever the engine. Probabilities of falling in either are joined
draw by draw of what is not known of the object, so that what survived the first is stronger than the usual object.
"""

from collections.abc import Sequence

import numpy as np

from rockfrag.base.arrays import Floats
from rockfrag.base.errors import InputError
from rockfrag.motions.processing import interpolate
from rockfrag.records.motion import Motion

QUIET = 30.0  # Time between both, in which rocking dies out [s]


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
    dt = min(motion.dt for motion in (*first, *then))
    joined = []
    for before, after in zip(first, then, strict=True):
        parts = [
            motion if motion.dt == dt else interpolate(motion, dt)
            for motion in (before, after)
        ]
        rest = np.zeros(round(quiet / dt))
        samples = np.concatenate([parts[0].acceleration, rest, parts[1].acceleration])
        name = f"{before.name}, then {after.name}"
        joined.append(Motion(samples, dt, name, before.metadata))
    return tuple(joined)


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
