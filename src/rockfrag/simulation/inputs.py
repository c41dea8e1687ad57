"""Checks of what users give, and the step sizes that follow from it.

In: anything. Out: lists of systems, :class:`GroundMotion` and scales, or one sentence on what is wrong. Docs:
``docs/rocking.md``, "What a response says about itself".
"""

import math
import numbers
import os
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rockfrag.base import plausible
from rockfrag.base.errors import InputError
from rockfrag.base.input_checks import positive_number, real_array, shown, whole_number
from rockfrag.engines.contract import Cases
from rockfrag.engines.steps import MOST_SAMPLES, STEP, step_count
from rockfrag.records.motion import GroundMotion, Motion
from rockfrag.records.velocity_steps import VelocitySteps
from rockfrag.system.blocks import SystemLike, as_system, is_system
from rockfrag.system.system import uplift_ratios

MOST_CASES = 50_000_000  # cases of an ensemble whose results are held in memory
STRONGEST = 1e4  # peak acceleration [m/s²] beyond any earthquake
MotionLike = Motion | GroundMotion | VelocitySteps | ArrayLike
"""A motion, jumps of the velocity, or the accelerations of the horizontal component [m/s²], shape (n,)."""

STEPPED = 0.005  # sampling interval of a base that moves by jumps alone [s]

SystemsInput = SystemLike | Sequence[SystemLike] | Mapping[str, SystemLike]
"""One body or system, a list of them, or a mapping of names, which stand in tables and figures, to them."""


def _checked_motion(motion: Any, dt: float | None, name: str) -> Motion:
    """Return a motion, or the one that accelerations [m/s²] at a sampling interval [s] are."""
    _refuse_file_name(name, motion)
    if is_system(motion):
        raise InputError(
            f"{name}: expected a motion, got a {type(motion).__name__}; the body stands before it."
        )
    if isinstance(motion, Motion):
        if dt is not None:
            raise InputError(
                f"dt: {name} is a Motion, which has its own sampling interval; leave dt out."
            )
        values = motion.acceleration
    else:
        if dt is None:
            raise InputError(
                f"dt: {name} is an array; give its sampling interval in seconds."
            )
        interval = positive_number("dt", dt, "seconds")
        values = real_array(name, motion, "m/s²")
    if values.ndim != 1:
        raise InputError(f"{name}: expected shape (n,), got {values.shape}.")
    if values.size < 2:
        raise InputError(
            f"{name}: a motion needs at least two samples, got {values.size}."
        )
    if values.size > MOST_SAMPLES:
        raise InputError(
            f"{name}: {values.size} samples are more than the {MOST_SAMPLES} allowed."
        )
    if not np.isfinite(values).all():
        first = int(np.flatnonzero(~np.isfinite(values))[0])
        raise InputError(f"{name}: sample {first} is not a finite number.")
    peak = float(np.abs(values).max())
    if peak > STRONGEST:
        raise InputError(
            f"{name}: a peak of {peak:.3g} m/s² is beyond any earthquake; check the unit."
        )
    return motion if isinstance(motion, Motion) else Motion(values, interval)


def _checked_vertical(vertical: MotionLike, horizontal: Motion, name: str) -> Motion:
    """Return the vertical component that belongs to a horizontal one."""
    interval = horizontal.dt
    if isinstance(vertical, Motion) and not math.isclose(
        vertical.dt, interval, rel_tol=1e-9
    ):
        raise InputError(
            f"{name}: sampled every {vertical.dt:g} s, the horizontal motion every {interval:g} s; "
            "resample one of them."
        )
    own = None if isinstance(vertical, Motion) else interval
    values = _checked_motion(vertical, own, name).acceleration
    samples = horizontal.acceleration.size
    if values.size != samples:
        raise InputError(
            f"{name}: {values.size} samples for {samples} horizontal ones; cut or pad one of them."
        )
    return Motion(values, interval)


def listed_bodies(bodies: object) -> list[SystemLike]:
    """Return the bodies as a list; those of a mapping bear its names."""
    if is_system(bodies):
        return [bodies]
    if isinstance(bodies, (Motion, GroundMotion)):
        raise InputError(
            "bodies: expected bodies first, then motions, got a Motion; exchange them."
        )
    if isinstance(bodies, Mapping):
        return [
            replace(as_system(body), name=str(name)) for name, body in bodies.items()
        ]
    if not isinstance(bodies, (Sequence, np.ndarray)) or isinstance(
        bodies, (str, bytes)
    ):
        raise InputError(
            f"bodies: expected a Block, a Stack, a Column, a System or a list of them, got {shown(bodies)}."
        )
    for i, body in enumerate(bodies):
        if not is_system(body):
            raise InputError(
                f"bodies[{i}]: expected a Block, a Stack, a Column or a System, got {shown(body)}."
            )
    return list(bodies)


def listed_motions(
    motions: MotionLike | Sequence[MotionLike],
    dt: float | Sequence[float] | None,
    vertical: MotionLike | Sequence[MotionLike] | None = None,
) -> list[GroundMotion]:
    """Return checked motions."""
    each = _listed_motions(motions)
    intervals: list[float | None]
    if dt is None or isinstance(dt, (numbers.Real, str, complex)):
        intervals = [dt] * len(each)  # type: ignore[list-item]
    else:
        intervals = list(real_array("dt", dt, "s").ravel().tolist())
        if len(intervals) != len(each):
            raise InputError(
                f"dt: expected one number or {len(each)}, got {len(intervals)}."
            )
    ups: list[MotionLike | None] = [None] * len(each)
    if vertical is not None:
        ups = list(_listed_motions(vertical, "vertical"))
        if len(ups) != len(each):
            raise InputError(
                f"vertical: expected {len(each)} entries, one per motion, got {len(ups)}."
            )
    return [
        ground_motion(motion, interval, up, f"motions[{i}]", f"vertical[{i}]")
        for i, (motion, interval, up) in enumerate(
            zip(each, intervals, ups, strict=True)
        )
    ]


def ground_motion(
    motion: MotionLike,
    dt: float | None,
    vertical: MotionLike | None = None,
    name: str = "motion",
    vertical_name: str = "vertical",
) -> GroundMotion:
    """Return the checked ground motion of a horizontal and perhaps a vertical component.

    Parameters
    ----------
    motion, vertical : as a user gives them
    dt : sampling interval [s] of a motion that is an array
    name, vertical_name : of both in messages
    """
    if isinstance(motion, VelocitySteps):
        motion = GroundMotion(Motion(np.zeros(2), STEPPED), steps=motion)
    if isinstance(motion, GroundMotion):
        if vertical is not None or dt is not None:
            raise InputError(
                f"{name}: a GroundMotion has its own vertical component and sampling interval; leave vertical "
                "and dt out."
            )
        for component in motion.components:
            _checked_motion(getattr(motion, component), None, name)
        return motion
    x = _checked_motion(motion, dt, name)
    return GroundMotion(
        x, z=None if vertical is None else _checked_vertical(vertical, x, vertical_name)
    )


def _refuse_file_name(name: str, motion: object) -> None:
    """Refuse the name of a file in place of its numbers."""
    if isinstance(motion, (str, os.PathLike)):
        raise InputError(
            f"{name}: expected numbers [m/s²], got {shown(os.fspath(motion))}; of a file give what "
            "rockfrag.read_motion(file, unit=…) returns."
        )


def _listed_motions(motions: Any, name: str = "motions") -> list[MotionLike]:
    """Motions as a list; one alone is a list of one."""
    _refuse_file_name(name, motions)
    if is_system(motions):
        raise InputError(
            f"{name}: expected motions, got a {type(motions).__name__}; bodies stand before them."
        )
    if isinstance(motions, (Motion, GroundMotion, VelocitySteps)):
        return [motions]
    if (
        isinstance(motions, np.ndarray)
        and motions.ndim == 1
        and motions.dtype != object
    ):
        return [motions]
    if (
        motions is None
        or isinstance(motions, (str, bytes, Mapping))
        or not np.iterable(motions)
    ):
        raise InputError(
            f"{name}: expected a Motion, accelerations or a list of them, got {shown(motions)}."
        )
    if (
        isinstance(motions, np.ndarray)
        and motions.ndim == 2
        and 2 <= motions.shape[1] <= 3
    ):
        raise InputError(
            f"{name}: an array of shape {motions.shape} looks like {motions.shape[1]} components in columns, not "
            f"like {motions.shape[0]} motions; give each motion as an array of shape (n,), or a GroundMotion."
        )
    each = list(motions)
    if each and all(isinstance(value, numbers.Real) for value in each):
        # one motion given as a list of numbers
        return [motions]  # type: ignore[list-item]
    return each


def checked_scales(
    scales: ArrayLike, motions: Sequence[GroundMotion]
) -> NDArray[np.float64]:
    """Return factors on the accelerations as an array of shape (motions, scales)."""
    if isinstance(scales, np.ndarray):
        # before anything is asked of so many numbers
        check_case_count(scales.size)
    factors, count = np.atleast_1d(real_array("scales", scales)), len(motions)
    if factors.ndim == 1:
        factors = np.broadcast_to(factors, (count, factors.size))
    if factors.ndim != 2 or factors.shape[0] != count or not np.isfinite(factors).all():
        raise InputError(
            f"scales: expected finite numbers of shape (scales,) or ({count}, scales), got {shown(scales)}."
        )
    check_case_count(factors.size)
    for i, motion in enumerate(motions):
        peak = max(getattr(motion, component).pga for component in motion.components)
        strongest = float(np.abs(factors[i]).max(initial=0.0)) * peak
        if strongest > STRONGEST:
            raise InputError(
                f"scales: motions[{i}] is scaled to {strongest:.3g} m/s², which is beyond any earthquake."
            )
    # a copy: kernels would be compiled anew for a view that cannot be written to
    return np.array(factors, order="C")


def checked_threads(threads: object) -> int:
    """Number of threads; that of the cores if None.

    Parameters
    ----------
    threads : number that a user gave, or None

    Returns
    -------
    The number.
    """
    if threads is None:
        return os.cpu_count() or 1
    count = whole_number("threads", threads)
    if not 1 <= count <= 4096:
        raise InputError(
            f"threads: expected a whole number from 1 to 4096, got {count}."
        )
    return count


def checked_switch(name: str, value: object) -> bool:
    """Return True or False as they are."""
    if not isinstance(value, (bool, np.bool_)):
        raise InputError(f"{name}: expected True or False, got {shown(value)}.")
    return bool(value)


def check_case_count(count: int) -> None:
    """Refuse an ensemble whose results would not fit into memory."""
    if count > MOST_CASES:
        raise InputError(
            f"bodies × motions × scales: {count} cases are more than the {MOST_CASES} whose results "
            "are held in memory; write them to a file with stream_overturns."
        )


class UnitWarning(UserWarning):
    """A number looks as if it were given in another unit."""


def warn_of_units(cases: Cases, given: object, stacklevel: int = 5) -> None:
    """Warn of what looks like a mistake of unit: of accelerations, of times, of gravity.

    Of motions as ``given`` only an array, which has no unit of its own, is a reason for doubt where it lifts
    nothing and would lift something if it were in g. There are ``stacklevel`` callers up to the user's line.
    """
    if not cases.systems or not cases.motions:
        return
    g = cases.request.g
    largest = np.abs(cases.scales).max(axis=1, initial=0.0)
    peaks = [
        motion.x.pga * float(scale)
        for motion, scale in zip(cases.motions, largest, strict=True)
    ]
    peak = max(peaks)
    own = (Motion, GroundMotion, VelocitySteps)
    plain = any(not isinstance(motion, own) for motion in _listed_motions(given))
    # a stronger motion is hardly one in g, and needs no look at the bodies
    doubtful = plain and 0 < peak <= plausible.LARGEST_IN_G
    least = (
        g * min(min(uplift_ratios(system)) for system in cases.systems)
        if doubtful
        else None
    )
    longest = max(motion.dt for motion in cases.motions)
    flags = [plausible.peak_warning(peak, least)]
    if (cases.scales < 0).any():
        flags.append(
            "scales: a negative factor turns the motion round; give 0 and above"
        )
    if g > plausible.LARGEST_GRAVITY:
        planet = f"an acceleration of gravity of {g:g} m/s² is that of no planet"
        flags.append(f"{planet}; if it is in cm/s², divide it by 100")
    if longest > plausible.LONGEST_STEP:
        # what is far too long is refused before it is doubted
        for system in cases.systems:
            step_count(system, longest, g, STEP)
        flags.append(
            f"a sampling interval of {longest:g} s is too long for strong motion; check its unit"
        )
    for flag in filter(None, flags):
        warnings.warn(flag, UnitWarning, stacklevel=stacklevel)
