"""Parts of a motion between the jumps of the base's velocity, which engines integrate one after the other.

In: a case whose motion has ``steps``. Out: a :class:`Piece` for each part, on even samples of its own, with the
jump that comes before it. Theory: ``docs/velocity-steps.md``.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from rockfrag.base.arrays import Floats
from rockfrag.engines.contract import Case
from rockfrag.engines.steps import free_samples
from rockfrag.records.motion import Motion

INSTANT = 1e-12  # part of a sampling interval below which none has passed


class Jump(NamedTuple):
    """A jump of the base's velocity [m/s]."""

    right: float
    up: float


@dataclass(frozen=True)
class Piece:
    """A part of the motion between two jumps, on even samples."""

    begin: float  # instant of its first sample [s]
    dt: float  # sampling interval [s]
    ground: Floats  # acceleration of the ground [m/s²], shape (n,)
    upward: Floats  # upwards [m/s²], shape (n,)
    jump: Jump | None  # what comes before it
    free: int  # samples of free rocking after it


def pieces_of(case: Case) -> Iterator[Piece]:
    """Yield the parts of a motion: from jump to jump, whole samples within them, and what is left of samples.

    Parameters
    ----------
    case : of which the motion has steps

    Returns
    -------
    The parts; the last one has the samples of free rocking.
    """
    motion = case.motion
    assert motion.steps is not None
    dt = motion.dt
    times, right, up = motion.steps.scaled(case.scale)
    jumps = [Jump(*pair) for pair in zip(right.tolist(), up.tolist(), strict=True)]
    ends = [*times.tolist(), max(float(times[-1]), motion.x.acceleration.size * dt)]
    now: float = 0.0
    jump: Jump | None = None
    for number, end in enumerate(ends):
        for begin, until in _between(now, end, dt):
            yield _piece(case, begin, until, jump)
            jump = None
        now = end
        if number < len(jumps):
            jump = jumps[number]
    free = int(free_samples(case.system, dt, case.request.g))
    yield _piece(case, now, now + dt, jump, free)


def _between(now: float, end: float, dt: float) -> Iterator[tuple[float, float]]:
    """Yield the parts of an interval, ends in seconds: up to the next sample, whole samples, and what is left.

    ``now``, ``end``: of the interval [s]; ``dt``: sampling interval [s].
    """
    first, last = math.ceil(now / dt - INSTANT), math.floor(end / dt + INSTANT)
    within = [] if first > last else [first * dt, last * dt]
    for begin, until in pairwise([now, *within, end]):
        if until - begin > INSTANT * dt:
            yield begin, until


def _piece(
    case: Case, begin: float, end: float, jump: Jump | None, free: int = 0
) -> Piece:
    """A part of the motion of a case; if it is longer than a sampling interval, it holds whole samples.

    Parameters
    ----------
    case : the case
    begin, end : of the part [s]
    jump : of the base's velocity at its beginning, if there is one
    free : samples without shaking that follow it
    """
    motion = case.motion
    count = max(1, round((end - begin) / motion.dt))
    at = np.linspace(begin, end, count + 1)
    ground = case.scale * _at(motion.x, at)
    upward = np.zeros_like(at)
    if motion.z is not None:
        upward = case.scale * _at(motion.z, at)
    return Piece(begin, (end - begin) / count, ground, upward, jump, free)


def _at(motion: Motion, times: Floats) -> Floats:
    """Acceleration [m/s²] of a motion at instants [s], of their shape; zero from one sample after the last on."""
    values = np.append(motion.acceleration, 0.0)
    return np.asarray(np.interp(times / motion.dt, np.arange(values.size), values))
