"""Checks of what users give, and the step sizes that follow from it."""

import math
import numbers
import os
import warnings
from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rockfrag.errors import InputError
from rockfrag.input_checks import positive_number, real_array, shown, whole_number
from rockfrag.plausibility import peak_warning
from rockfrag.records.motion import Motion
from rockfrag.rocking.measured_restitution import Restitution
from rockfrag.system.blocks import Block, Body, Stack

STEP = 0.1
"""Largest p h of a step: frequency parameter of the faster block times step."""

STACK_STEP = 0.35
"""Share of that step that stacks of an ensemble take while both blocks rotate: they are chaotic, and keep the
memory of smaller errors."""

FREE_TIME = 60.0
"""Free rocking after the motion is followed for at most this long, in units of 1/p."""

MOST_SAMPLES = 20_000_000
"""Samples of a history, the motion and the free rocking after it, that are admitted."""

MOST_CASES = 50_000_000
"""Cases of an ensemble whose results are held in memory."""

STRONGEST = 1e4
"""Peak acceleration [m/s²] beyond any earthquake."""

MotionLike = Motion | ArrayLike
"""A motion, or its accelerations [m/s²], shape (n,)."""


def checked_motion(
    motion: MotionLike, dt: float | None, name: str = "motion"
) -> tuple[NDArray[np.float64], float]:
    """Return the accelerations of a motion [m/s²] and its sampling interval [s].

    Raises
    ------
    InputError
        If there are fewer than two samples, one is not a finite number or beyond any earthquake, or if the
        interval is missing, given twice or not positive.
    """
    _refuse_file_name(name, motion)
    if isinstance(motion, Motion):
        if dt is not None:
            raise InputError(
                f"dt: {name} is a Motion, which has its own sampling interval; leave dt out."
            )
        data, interval = motion.acceleration, motion.dt
    else:
        if dt is None:
            raise InputError(f"dt: {name} is an array; give its sampling interval in seconds.")
        data, interval = motion, positive_number("dt", dt, "seconds")  # type: ignore[assignment]
    values = real_array(name, data, "m/s²")
    if values.ndim != 1:
        raise InputError(f"{name}: expected shape (n,), got {values.shape}.")
    if values.size < 2:
        raise InputError(f"{name}: a motion needs at least two samples, got {values.size}.")
    if values.size > MOST_SAMPLES:
        raise InputError(f"{name}: {values.size} samples are more than the {MOST_SAMPLES} allowed.")
    if not np.isfinite(values).all():
        first = int(np.flatnonzero(~np.isfinite(values))[0])
        raise InputError(f"{name}: sample {first} is not a finite number.")
    peak = float(np.abs(values).max())
    if peak > STRONGEST:
        raise InputError(
            f"{name}: a peak of {peak:.3g} m/s² is beyond any earthquake; check the unit."
        )
    return values, interval


def checked_vertical(
    vertical: MotionLike | None,
    horizontal: NDArray[np.float64],
    interval: float,
    name: str = "vertical",
) -> NDArray[np.float64]:
    """Return the vertical accelerations that belong to horizontal ones [m/s²]; none for None.

    Raises
    ------
    InputError
        If they cannot be used, or are not sampled at the same times.
    """
    if vertical is None:
        return np.zeros(0)
    if isinstance(vertical, Motion) and not math.isclose(vertical.dt, interval, rel_tol=1e-9):
        raise InputError(
            f"{name}: sampled every {vertical.dt:g} s, the horizontal motion every {interval:g} s; "
            "resample one of them."
        )
    own = None if isinstance(vertical, Motion) else interval
    values, _ = checked_motion(vertical, own, name)
    if values.size != horizontal.size:
        raise InputError(
            f"{name}: {values.size} samples for {horizontal.size} horizontal ones; cut or pad one of them."
        )
    return values


def checked_start(body: Body, value: object, name: str) -> tuple[float, ...]:
    """Return rotations or angular velocities at the start, one for each block; zeros for None.

    Raises
    ------
    InputError
        If there is not one finite number for each block, or a block lies on its side already.
    """
    blocks = 1 if isinstance(body, Block) else 2
    if value is None:
        return (0.0,) * blocks
    values = np.atleast_1d(real_array(name, value))
    if values.shape != (blocks,) or not np.isfinite(values).all():
        raise InputError(f"{name}: expected {blocks} finite number(s), got {shown(value)}.")
    if name == "theta0" and (np.abs(values) >= math.pi / 2).any():
        raise InputError("theta0: a block turned by π/2 or more lies on its side already.")
    return tuple(values.tolist())


def listed_bodies(bodies: object) -> list[Body]:
    """Return the bodies as a list.

    Raises
    ------
    InputError
        If there is none, or one is neither a Block nor a Stack.
    """
    if isinstance(bodies, (Block, Stack)):
        return [bodies]
    if not isinstance(bodies, (Sequence, np.ndarray)) or isinstance(bodies, (str, bytes)):
        raise InputError(
            f"bodies: expected a Block, a Stack or a list of them, got {shown(bodies)}."
        )
    for i, body in enumerate(bodies):
        if not isinstance(body, (Block, Stack)):
            raise InputError(f"bodies[{i}]: expected a Block or a Stack, got {shown(body)}.")
    return list(bodies)


def listed(
    bodies: Body | Sequence[Body],
    motions: MotionLike | Sequence[MotionLike],
    dt: float | Sequence[float] | None,
    restitution: Sequence[Restitution] | None,
) -> tuple[list[Body], list[NDArray[np.float64]], NDArray[np.float64]]:
    """Return bodies, checked accelerations [m/s²] and the sampling interval of each motion [s].

    Raises
    ------
    InputError
        If a body is none, a motion cannot be used, or the lengths of the lists do not fit together.
    """
    body_list = listed_bodies(bodies)
    each = listed_motions(motions)
    intervals: list[float | None]
    if dt is None or isinstance(dt, (numbers.Real, str, complex)):
        intervals = [dt] * len(each)  # type: ignore[list-item]
    else:
        intervals = list(real_array("dt", dt, "s").ravel().tolist())
        if len(intervals) != len(each):
            raise InputError(f"dt: expected one number or {len(each)}, got {len(intervals)}.")
    check_one_per_body("restitution", restitution, len(body_list))
    checked = [
        checked_motion(motion, interval, f"motions[{i}]")
        for i, (motion, interval) in enumerate(zip(each, intervals, strict=True))
    ]
    return body_list, [values for values, _ in checked], np.array([h for _, h in checked])


def _refuse_file_name(name: str, motion: object) -> None:
    if isinstance(motion, (str, os.PathLike)):
        raise InputError(
            f"{name}: expected numbers [m/s²], got {shown(os.fspath(motion))}; of a file give what "
            "rockfrag.read_motion(file, unit=…) returns."
        )


def listed_motions(
    motions: MotionLike | Sequence[MotionLike], name: str = "motions"
) -> list[MotionLike]:
    """Return motions as a list of them.

    Raises
    ------
    InputError
        If there are none.
    """
    _refuse_file_name(name, motions)
    if isinstance(motions, Motion):
        return [motions]
    if isinstance(motions, np.ndarray) and motions.ndim == 1 and motions.dtype != object:
        return [motions]
    if motions is None or isinstance(motions, (str, bytes, Mapping)) or not np.iterable(motions):
        raise InputError(
            f"{name}: expected a Motion, accelerations or a list of them, got {shown(motions)}."
        )
    each = list(motions)
    if each and all(isinstance(value, numbers.Real) for value in each):
        # one motion given as a list of numbers
        return [motions]  # type: ignore[list-item]
    return each


def listed_vertical(
    vertical: MotionLike | Sequence[MotionLike] | None,
    horizontal: Sequence[NDArray[np.float64]],
    intervals: NDArray[np.float64],
) -> list[NDArray[np.float64]]:
    """Return the vertical accelerations of each motion [m/s²]; of None none.

    Raises
    ------
    InputError
        If there is not one for each motion, or one cannot be used.
    """
    if vertical is None:
        return []
    each = listed_motions(vertical, "vertical")
    if len(each) != len(horizontal):
        raise InputError(
            f"vertical: expected {len(horizontal)} entries, one per motion, got {len(each)}."
        )
    return [
        checked_vertical(up, values, float(interval), f"vertical[{i}]")
        for i, (up, values, interval) in enumerate(zip(each, horizontal, intervals, strict=True))
    ]


def check_one_per_body(name: str, given: object, count: int) -> None:
    """Say in one sentence if what is given per body is not a list with an entry for each.

    Raises
    ------
    InputError
        If its length is not the number of bodies.
    """
    if given is None:
        return
    if not isinstance(given, (list, tuple, np.ndarray)):
        raise InputError(f"{name}: expected a list with one entry per body, got {shown(given)}.")
    if len(given) != count:
        raise InputError(f"{name}: expected {count} entries, one per body, got {len(given)}.")


def checked_scales(
    scales: ArrayLike, motions: Sequence[NDArray[np.float64]]
) -> NDArray[np.float64]:
    """Return factors on the accelerations as an array of shape (motions, scales).

    Raises
    ------
    InputError
        If the shape does not fit the motions, a factor is not finite, or a scaled motion is beyond any earthquake.
    """
    if isinstance(scales, np.ndarray):
        # before anything is asked of so many numbers
        check_case_count(scales.size)
    factors = real_array("scales", scales)
    count = len(motions)
    if factors.ndim == 0:
        factors = factors.reshape(1)
    if factors.ndim == 1:
        factors = np.broadcast_to(factors, (count, factors.size))
    if factors.ndim != 2 or factors.shape[0] != count or not np.isfinite(factors).all():
        raise InputError(
            f"scales: expected finite numbers of shape (scales,) or ({count}, scales), "
            f"got {shown(scales)}."
        )
    check_case_count(factors.size)
    for i, values in enumerate(motions):
        strongest = float(np.abs(factors[i]).max(initial=0.0)) * float(np.abs(values).max())
        if strongest > STRONGEST:
            raise InputError(
                f"scales: motions[{i}] is scaled to {strongest:.3g} m/s², which is beyond any earthquake."
            )
    # a copy: kernels would be compiled anew for a view that cannot be written to
    return np.array(factors, order="C")


def checked_threads(threads: object) -> int:
    """Return the number of threads; that of the cores if None.

    Raises
    ------
    InputError
        If it is not a positive whole number.
    """
    if threads is None:
        return os.cpu_count() or 1
    count = whole_number("threads", threads)
    if not 1 <= count <= 4096:
        raise InputError(f"threads: expected a whole number from 1 to 4096, got {count}.")
    return count


def checked_switch(name: str, value: object) -> bool:
    """Return True or False as they are.

    Raises
    ------
    InputError
        If it is anything else.
    """
    if not isinstance(value, (bool, np.bool_)):
        raise InputError(f"{name}: expected True or False, got {shown(value)}.")
    return bool(value)


def check_case_count(count: int) -> None:
    """Refuse an ensemble whose results would not fit into memory.

    Raises
    ------
    InputError
        If there are more than ``MOST_CASES``.
    """
    if count > MOST_CASES:
        raise InputError(
            f"bodies × motions × scales: {count} cases are more than the {MOST_CASES} whose results "
            "are held in memory; write them to a file with stream_overturns."
        )


class UnitDoubt(UserWarning):
    """A motion looks as if it were given in another unit than m/s²."""


def warn_of_unit(
    bodies: Sequence[Body],
    given: Sequence[MotionLike],
    peaks: NDArray[np.float64],
    g: float,
    stacklevel: int = 4,
) -> None:
    """Warn if the strongest motion looks as if it were given in another unit than m/s².

    Parameters
    ----------
    bodies
        What is shaken.
    given
        Motions as the user gave them. Only of an array, which has no unit of its own, is it a reason for doubt
        that it lifts nothing and would lift something if it were in g.
    peaks
        Peak acceleration of each motion at its largest scale [m/s²], shape (motions,).
    g
        Acceleration of gravity [m/s²].
    stacklevel
        Callers between this function and the user's line.
    """
    plain = any(not isinstance(motion, Motion) for motion in given)
    gravity = positive_number("g", g, "m/s²")
    least = min((least_uplift(body, gravity) for body in bodies), default=None) if plain else None
    if doubt := peak_warning(float(peaks.max(initial=0.0)), least):
        warnings.warn(doubt, UnitDoubt, stacklevel=stacklevel)


def least_uplift(body: Body, g: float) -> float:
    """Return the least horizontal acceleration that opens a contact of a body at rest, g b/h [m/s²]."""
    arms = (body.arm,) if isinstance(body, Block) else (body.common_arm, body.statue_arm)
    each = [arm(pole) for arm in arms for pole in (+1, -1)]
    return min(abs(arm.x) / arm.y for arm in each) * g


def fastest_frequency(body: Body, g: float) -> float:
    """Largest frequency parameter p of the body's blocks [1/s]."""
    blocks = (body,) if isinstance(body, Block) else (body.pedestal, body.contact_statue)
    return max(block.frequency(pole, g) for block in blocks for pole in (+1, -1))


def slowest_frequency(body: Body, g: float) -> float:
    """Smallest frequency parameter p of the ways in which the body rocks [1/s].

    Raises
    ------
    InputError
        If it is too small for a number.
    """
    blocks = (body,) if isinstance(body, Block) else (body.contact_statue, body.rigidly_joined())
    slowest = min(block.frequency(pole, g) for block in blocks for pole in (+1, -1))
    if not slowest > 0:
        raise InputError("body: its frequency parameter p is 0; check lengths, mass and inertia.")
    return slowest


def free_samples(body: Body, dt: ArrayLike, g: float) -> NDArray[np.int64]:
    """Return the most samples of free rocking that are followed after a motion, for every interval.

    Raises
    ------
    InputError
        If they would not fit into memory.
    """
    samples = np.ceil(FREE_TIME / slowest_frequency(body, g) / np.asarray(dt))
    if samples.max(initial=0) > MOST_SAMPLES:
        raise InputError(
            f"dt: free rocking sampled every {np.min(dt):.3g} s would take {samples.max():.3g} samples, "
            f"more than the {MOST_SAMPLES} allowed; give a longer interval."
        )
    return np.asarray(samples).astype(np.int64)


def step_count(body: Body, dt: ArrayLike, g: float, step: float) -> NDArray[np.int64]:
    """Return the steps per sample for which p h does not exceed ``step``, for every sampling interval.

    Raises
    ------
    InputError
        If ``step`` is not positive, or an interval is far too long for the body.
    """
    positive_number("step", step)
    frequency = fastest_frequency(body, g)
    steps = np.ceil(frequency * np.asarray(dt) / step - 1e-9)
    if steps.max(initial=0) > 10_000:
        raise InputError(f"dt: {np.max(dt)} s is too long for a block of p = {frequency:.3g} 1/s.")
    return np.maximum(1, steps).astype(np.int64)
