"""Steps of the integration, and how long free rocking is followed, as they follow from a system."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rockfrag.base.errors import InputError
from rockfrag.system import geometry
from rockfrag.system.blocks import Body, as_system
from rockfrag.system.system import System, rocking_shapes

STEP = 0.1  # largest p h of a step: frequency parameter of the fastest body times step
STACK_STEP = 0.35
"""Fraction of that step that two bodies of an ensemble take while both rotate: they are chaotic, and keep the
memory of smaller errors."""

# free rocking after the motion is followed for at most this long, in units of 1/p
FREE_TIME = 60.0
MOST_STEPS = 10_000  # of a sample
MOST_SAMPLES = 20_000_000
"""Samples of a history, the motion and the free rocking after it, that are admitted."""


def fastest_frequency(system: System | Body, g: float) -> float:
    """Largest frequency parameter p of the bodies [1/s].

    Parameters
    ----------
    system : planar
    g : acceleration of gravity [m/s²]

    Returns
    -------
    The largest p [1/s].
    """
    return max(
        geometry.frequency(shape, pivot, g)
        for shape in as_system(system).carried
        for pivot in (+1, -1)
    )


def free_samples(system: System | Body, dt: ArrayLike, g: float) -> NDArray[np.int64]:
    """Return the most samples of free rocking that are followed after a motion, for every interval.

    Parameters
    ----------
    system : planar
    dt : sampling intervals [s], shape (motions,) or a number
    g : acceleration of gravity [m/s²]

    Returns
    -------
    Numbers of samples, of the shape of ``dt``.
    """
    shapes = rocking_shapes(as_system(system))
    slowest = min(
        geometry.frequency(shape, pivot, g) for shape in shapes for pivot in (+1, -1)
    )
    if not slowest > 0:
        raise InputError(
            "body: its frequency parameter p is 0; check lengths, mass and inertia."
        )
    samples = np.ceil(FREE_TIME / slowest / np.asarray(dt))
    if samples.max(initial=0) > MOST_SAMPLES:
        raise InputError(
            f"dt: free rocking sampled every {np.min(dt):.3g} s would take {samples.max():.3g} samples, "
            f"more than the {MOST_SAMPLES} allowed; give a longer interval."
        )
    return np.asarray(samples).astype(np.int64)


def step_count(
    system: System | Body, dt: ArrayLike, g: float, step: float
) -> NDArray[np.int64]:
    """Return the steps per sample for which p h does not exceed ``step``, for every sampling interval.

    Parameters
    ----------
    system : planar
    dt : sampling intervals [s], shape (motions,) or a number
    g : acceleration of gravity [m/s²]
    step : largest p h of a step [-]

    Returns
    -------
    The steps, of the shape of ``dt``.
    """
    frequency = fastest_frequency(system, g)
    # a whole number of steps but for rounding stays that
    steps = np.ceil(frequency * np.asarray(dt) / step - 1e-9)
    if steps.max(initial=0) > MOST_STEPS:
        raise InputError(
            f"dt: {np.max(dt)} s is too long for a block of p = {frequency:.3g} 1/s."
        )
    return np.maximum(1, steps).astype(np.int64)
