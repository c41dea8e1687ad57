"""Checks of what users give, and the step sizes that follow from it."""

import math
import warnings
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rockfrag.errors import InputError
from rockfrag.rocking.bodies import Block, Body, Stack
from rockfrag.rocking.body_record import Restitution

STEP = 0.1
"""Largest p h of a step: frequency parameter of the faster block times step."""

STACK_STEP = 0.35
"""Share of that step that stacks of an ensemble take while both blocks rotate: they are chaotic, and keep the
memory of smaller errors."""

FREE_TIME = 60.0
"""Free rocking after the motion is followed for at most this long, in units of 1/p."""

MOST_SAMPLES = 20_000_000

WEAK_MOTION = 0.05
"""A peak acceleration [m/s²] below this was probably given in g."""


def checked_acceleration(
    acceleration: ArrayLike, dt: float, name: str = "acceleration"
) -> NDArray[np.float64]:
    """Return the samples as a float array [m/s²], or say in one sentence why they cannot be used.

    Raises
    ------
    InputError
        If there are fewer than two samples, one is not finite, or ``dt`` is not positive.
    """
    try:
        values = np.ascontiguousarray(acceleration, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise InputError(
            f"{name}: expected numbers [m/s²], got {type(acceleration).__name__}."
        ) from error
    if values.ndim != 1:
        raise InputError(f"{name}: expected shape (n,), got {values.shape}.")
    if values.size < 2:
        raise InputError(f"{name}: a motion needs at least two samples, got {values.size}.")
    if values.size > MOST_SAMPLES:
        raise InputError(f"{name}: {values.size} samples are more than the {MOST_SAMPLES} allowed.")
    if not np.isfinite(values).all():
        first = int(np.flatnonzero(~np.isfinite(values))[0])
        raise InputError(f"{name}: sample {first} is not a finite number.")
    if np.abs(values).max() > 1e4:
        raise InputError(
            f"{name}: a peak of {np.abs(values).max():.3g} m/s² is beyond any earthquake; check the unit."
        )
    if (
        isinstance(dt, bool)
        or not isinstance(dt, (int, float, np.number))
        or not (math.isfinite(dt) and dt > 0)
    ):
        raise InputError(f"dt: expected a positive number of seconds, got {dt!r}.")
    return values


def listed(
    bodies: Body | Sequence[Body],
    accelerations: ArrayLike | Sequence[ArrayLike],
    dt: float | Sequence[float],
    restitution: Sequence[Restitution] | None,
) -> tuple[list[Body], list[NDArray[np.float64]], NDArray[np.float64]]:
    """Return bodies, checked motions [m/s²] and the sampling interval of each motion [s].

    Raises
    ------
    InputError
        If a body is none, a motion cannot be used, or the lengths of the lists do not fit together.
    """
    body_list = [bodies] if isinstance(bodies, (Block, Stack)) else list(bodies)
    for i, body in enumerate(body_list):
        if not isinstance(body, (Block, Stack)):
            raise InputError(
                f"bodies[{i}]: expected a Block or a Stack, got {type(body).__name__}."
            )
    one = isinstance(accelerations, np.ndarray) and accelerations.ndim == 1
    motions: list[ArrayLike] = [accelerations] if one else list(accelerations)  # type: ignore[arg-type, list-item]
    intervals = np.asarray(dt, dtype=float)
    if intervals.ndim and intervals.shape != (len(motions),):
        raise InputError(f"dt: expected one number or {len(motions)}, got {intervals.size}.")
    if restitution is not None and len(restitution) != len(body_list):
        raise InputError(
            f"restitution: expected {len(body_list)} entries, one per body, got {len(restitution)}."
        )
    dts = np.broadcast_to(intervals, (len(motions),)).copy()
    values = [
        checked_acceleration(motion, float(interval), f"accelerations[{i}]")
        for i, (motion, interval) in enumerate(zip(motions, dts, strict=True))
    ]
    return body_list, values, dts


def checked_scales(scales: ArrayLike, n_motions: int) -> NDArray[np.float64]:
    """Return factors on the accelerations as an array of shape (motions, scales).

    Raises
    ------
    InputError
        If the shape does not fit the motions or a factor is not finite.
    """
    factors = np.asarray(scales, dtype=float)
    if factors.ndim == 1:
        factors = np.broadcast_to(factors, (n_motions, factors.size))
    if factors.ndim != 2 or factors.shape[0] != n_motions or not np.isfinite(factors).all():
        raise InputError(
            f"scales: expected finite numbers of shape (scales,) or ({n_motions}, scales), "
            f"got shape {np.shape(scales)}."
        )
    # a copy: kernels would be compiled anew for a view that cannot be written to
    return np.array(factors)


def warn_if_weak(values: NDArray[np.float64]) -> None:
    """Warn if the motion looks as if it were given in g."""
    peak = float(np.abs(values).max())
    if 0 < peak < WEAK_MOTION:
        warnings.warn(
            f"the peak acceleration is {peak:.3g} m/s²; if the motion is in g, multiply it by 9.81",
            UserWarning,
            stacklevel=3,
        )


def fastest_frequency(body: Body, g: float) -> float:
    """Largest frequency parameter p of the body's blocks [1/s]."""
    blocks = (body,) if isinstance(body, Block) else (body.pedestal, body.statue)
    return max(block.frequency(pole, g) for block in blocks for pole in (+1, -1))


def slowest_frequency(body: Body, g: float) -> float:
    """Smallest frequency parameter p of the ways in which the body rocks [1/s]."""
    blocks = (body,) if isinstance(body, Block) else (body.statue, body.glued())
    return min(block.frequency(pole, g) for block in blocks for pole in (+1, -1))


def free_samples(body: Body, dt: ArrayLike, g: float) -> NDArray[np.int64]:
    """Return the most samples of free rocking that are followed after a motion, for every interval."""
    return np.ceil(FREE_TIME / slowest_frequency(body, g) / np.asarray(dt)).astype(np.int64)


def step_count(body: Body, dt: ArrayLike, g: float, step: float) -> NDArray[np.int64]:
    """Return the steps per sample for which p h does not exceed ``step``, for every sampling interval.

    Raises
    ------
    InputError
        If ``step`` is not positive, or an interval is far too long for the body.
    """
    if not (math.isfinite(step) and step > 0):
        raise InputError(f"step: expected a positive number, got {step}.")
    frequency = fastest_frequency(body, g)
    steps = np.ceil(frequency * np.asarray(dt) / step - 1e-9)
    if steps.max(initial=0) > 10_000:
        raise InputError(f"dt: {np.max(dt)} s is too long for a block of p = {frequency:.3g} 1/s.")
    return np.maximum(1, steps).astype(np.int64)
