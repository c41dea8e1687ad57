"""Peak displacements of many oscillators under one motion, sixteen of them side by side.

Every oscillator takes the steps and finds the peaks between them as :func:`rockfrag.motions.response_spectrum`
does, to the last bit.  What is saved is the look between two steps: a peak there is worth it only if it can be
the largest so far.  So a stretch of steps is taken without a look first, and gone through again if it may hold
such a peak.  Where u turns, u'' is bounded by the ground's and the spring's share,
|u''| (1 - ch) ≤ PGA + k |u| with c = 2ζω, k = ω² and step h.  One end of the step is within h/2 of the turn, so
that the peak exceeds the larger of the two ends by q (PGA/k + |u|) at most, with q = k (h/2)²/2/(1 - ch).

The integration ends where nothing larger can come: the free vibration only decays, and the rest of the motion
moves the oscillator by (1 + r)/(1 - r) times its peak over k at most, with r = exp(-πζ/√(1 - ζ²)) the ratio of one
peak of free vibration to the one before.
"""

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from rockfrag.machine_code import cached_njit
from rockfrag.motions import spectra
from rockfrag.records.motion import Motion

Floats = NDArray[np.float64]

LANES = 16

# Rows of a group's table, each of LANES numbers, in one flat array so that the compiler sees that they do not
# overlap: the propagator over a step, the state before and after it, and the largest displacement so far; ζω,
# 1/ωd and the most that a ground acceleration of one can do, for the free vibration and what may still come; what
# a peak within a step can add, c = 2ζω and k = ω²; and the largest displacement of a stretch of steps
_UU, _UV, _UA, _US, _VU, _VV, _VA, _VS = range(0, 8 * LANES, LANES)
_U, _V, _U0, _V0, _LARGEST = range(8 * LANES, 13 * LANES, LANES)
_RATE, _PER_TURN, _GAIN = range(13 * LANES, 16 * LANES, LANES)
_KEPT, _ADDED, _C, _K = range(16 * LANES, 20 * LANES, LANES)
_HIGHEST = 20 * LANES
_ROWS = 21

LOOK_EVERY = 32  # samples of a stretch, after which is asked whether anything larger can still come


class _Group(NamedTuple):
    """Oscillators that take steps of one length."""

    which: NDArray[np.intp]
    parts: int
    step: float
    quiet: int
    table: Floats


def peak_displacements(motion: Motion, periods: Floats, damping: float = 0.05) -> Floats:
    """Sd of many oscillators [m], shape (k,), as :func:`rockfrag.motions.response_spectrum` gives it, bit by bit.

    The motion is linear between samples and zero after the last one; ``periods`` [s], shape (k,), are positive.
    """
    damping = spectra.checked_damping(damping)
    peaks = np.empty(periods.size)
    # largest |a| from each sample on
    to_come = np.maximum.accumulate(np.abs(motion.acceleration[::-1]))[::-1]
    for which, parts, step, quiet, table in _groups(periods.tobytes(), damping, motion.dt):
        x = table.copy()
        x[_ADDED : _ADDED + LANES] *= to_come[0]
        _integrate(motion.acceleration, to_come, quiet, step, parts, x)
        peaks[which] = x[_LARGEST : _LARGEST + which.size]
    return peaks


@lru_cache(maxsize=64)
def _groups(periods: bytes, damping: float, dt: float) -> tuple[_Group, ...]:
    """Oscillators grouped by their steps."""
    each = np.frombuffer(periods)
    parts = np.array([spectra.steps_within(dt, float(period), damping) for period in each])
    # undamped vibration does not get smaller, and so each such oscillator must end at its own time
    lanes = LANES if damping > 0 else 1
    groups = []
    for count in np.unique(parts):
        (which,) = np.nonzero(parts == count)
        for i in range(0, which.size, lanes):
            some = which[i : i + lanes]
            quiet = math.ceil(each[some].max() / dt) + 1
            table = np.zeros((_ROWS, LANES))
            for lane, period in enumerate(each[some]):
                table[:, lane] = _column(float(period), damping, dt / count)
            groups.append(_Group(some, int(count), float(dt / count), quiet, table.ravel()))
    return tuple(groups)


def _column(period: float, damping: float, step: float) -> Floats:
    """One lane of a table, at rest; the ground's part of what a peak can add is still without PGA/k."""
    omega = 2 * math.pi / period
    c, k = 2 * damping * omega, omega * omega
    # ratio of one peak of free vibration to the one before; zero from critical damping on
    r = math.exp(-math.pi * damping / math.sqrt(1 - damping**2)) if damping < 1 else 0.0
    ahead = [0.0, 0.0, math.inf]
    # without free vibration, or with one that does not decay, nothing is foreseen
    if 0 < r < 1:
        turn = omega * math.sqrt(1 - damping**2)
        ahead = [damping * omega, 1 / turn, (1 + r) / (1 - r) / k]
    q = k * (step / 2) ** 2 / 2 / (1 - c * step)
    matrix = spectra.oscillator_matrix(omega, damping, step).ravel()
    return np.array([*matrix, *[0.0] * 5, *ahead, 1 - q, q / k, c, k, 0.0])


@cached_njit(error_model="numpy", inline="always")
def _sample(acceleration: Floats, i: int) -> float:
    return acceleration[i] if i < acceleration.size else 0.0


@cached_njit(error_model="numpy")
def _integrate(
    acceleration: Floats, to_come: Floats, quiet: int, step: float, parts: int, x: Floats
) -> None:
    """Take all lanes through a motion and ``quiet`` samples after it; the peaks are in the table then."""
    end = acceleration.size - 1 + quiet
    ground, begin = np.empty((2, LOOK_EVERY * parts)), np.empty(2 * LANES)
    for first in range(0, end, LOOK_EVERY):
        if _settled(x, _sample(to_come, first)):
            break
        steps = _fill_ground(acceleration, first, min(first + LOOK_EVERY, end), step, parts, ground)
        begin[:] = x[_U : _U + 2 * LANES]
        for i in range(LANES):
            x[_HIGHEST + i] = abs(x[_U + i])
        for j in range(steps):
            _advance(x, ground[0, j], ground[1, j])
        if not _may_hold_the_peak(x):
            continue
        x[_U : _U + 2 * LANES] = begin
        for j in range(steps):
            for i in range(LANES):
                x[_U0 + i], x[_V0 + i] = x[_U + i], x[_V + i]
            _advance(x, ground[0, j], ground[1, j])
            if _turns_high(x, ground[0, j], ground[1, j], step):
                for lane in range(LANES):
                    _look_between(x, lane, ground[0, j], ground[1, j], step)


@cached_njit(error_model="numpy")
def _fill_ground(
    acceleration: Floats, first: int, last: int, step: float, parts: int, ground: Floats
) -> int:
    """Write the ground's acceleration and slope at the beginning of each step; return how many these are."""
    count = 0
    for k in range(first, last):
        start = _sample(acceleration, k)
        s = (_sample(acceleration, k + 1) - start) / (parts * step)
        for j in range(parts):
            ground[0, count], ground[1, count] = start + j * step * s, s
            count += 1
    return count


@cached_njit(error_model="numpy")
def _settled(x: Floats, to_come: float) -> bool:
    """Whether no lane can exceed its largest displacement any more."""
    for i in range(LANES):
        u = x[_U + i]
        speed = (x[_V + i] + x[_RATE + i] * u) * x[_PER_TURN + i]
        most = math.sqrt(u * u + speed * speed) + to_come * x[_GAIN + i]
        if not most * (1 + 1e-9) <= x[_LARGEST + i]:
            return False
    return True


@cached_njit(error_model="numpy")
def _may_hold_the_peak(x: Floats) -> bool:
    """Count the largest displacements of a stretch in; whether a peak between its steps can be larger."""
    may = False
    for i in range(LANES):
        x[_LARGEST + i] = max(x[_LARGEST + i], x[_HIGHEST + i])
        may |= x[_HIGHEST + i] + x[_ADDED + i] > x[_KEPT + i] * x[_LARGEST + i]
    return may


@cached_njit(error_model="numpy")
def _advance(x: Floats, a: float, s: float) -> None:
    """One step of all lanes."""
    for i in range(LANES):
        u0, v0 = x[_U + i], x[_V + i]
        u = x[_UU + i] * u0 + x[_UV + i] * v0 + x[_UA + i] * a + x[_US + i] * s
        v = x[_VU + i] * u0 + x[_VV + i] * v0 + x[_VA + i] * a + x[_VS + i] * s
        # the zero keeps the compiler from storing under a condition, for which the next load would wait
        x[_HIGHEST + i] = max(x[_HIGHEST + i], abs(u)) + 0.0
        x[_U + i], x[_V + i] = u, v


@cached_njit(error_model="numpy")
def _turns_high(x: Floats, a: float, s: float, step: float) -> bool:
    """Whether a lane has a peak between the last two steps that can be its largest."""
    does = False
    for i in range(LANES):
        highest = max(abs(x[_U0 + i]), abs(x[_U + i])) + x[_ADDED + i]
        before = a + x[_C + i] * x[_V0 + i] + x[_K + i] * x[_U0 + i]
        after = a + step * s + x[_C + i] * x[_V + i] + x[_K + i] * x[_U + i]
        turns = (x[_V0 + i] * x[_V + i] < 0) | (before * after < 0)
        does |= turns & (highest > x[_KEPT + i] * x[_LARGEST + i])
    return does


@cached_njit(error_model="numpy")
def _look_between(x: Floats, i: int, a: float, s: float, step: float) -> None:
    """Let the peaks of lane i between the last two steps count, if they can be the largest."""
    u, v, u1, v1, c, k = x[_U0 + i], x[_V0 + i], x[_U + i], x[_V + i], x[_C + i], x[_K + i]
    if max(abs(u), abs(u1)) + x[_ADDED + i] > x[_KEPT + i] * x[_LARGEST + i]:
        first = u, v, -(c * v + k * u) - a
        last = u1, v1, -(c * v1 + k * u1) - (a + step * s)
        peak = spectra.peak_within(0, first, last, (u, v, a, s), c, k, step)
        x[_LARGEST + i] = max(x[_LARGEST + i], peak)
