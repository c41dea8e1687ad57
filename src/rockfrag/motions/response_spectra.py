"""Response and Fourier spectra of a motion.

Of the peak displacements of many oscillators sixteen are found side by side, with the steps and the peaks
between them of :func:`response_spectrum`, to the last bit.  What is saved is the look between two steps: a peak
there is worth it only if it can be the largest of all.  So all steps are taken without a look first, and those
stretches of them alone are gone through again that may hold such a peak.  Where u turns, u'' is bounded by the
ground's and the spring's share, |u''| (1 - ch) ≤ PGA + k |u| with c = 2ζω, k = ω² and step h.  One end of the
step is within h/2 of the turn, so that the peak exceeds the larger of the two ends by q (PGA/k + |u|) at most,
with q = k (h/2)²/2/(1 - ch).

The integration ends where nothing larger can come: the free vibration only decays, and the rest of the motion
moves the oscillator by (1 + r)/(1 - r) times its peak over k at most, with r = exp(-πζ/√(1 - ζ²)) the ratio of one
peak of free vibration to the one before.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rockfrag.base.arrays import Floats
from rockfrag.base.errors import InputError
from rockfrag.base.keywords import named_keywords
from rockfrag.base.short_repr import short_repr
from rockfrag.motions.oscillator import fill_propagator
from rockfrag.records.motion import Motion
from rockfrag.runtime.machine_code import cached_njit

STEPS_PER_PERIOD = 12
"""Least number of steps in one natural period; twice the damping times as many above half critical.

Between two steps the cubic through both values and both slopes says *when* a response turns, and a step of
Newton's from there says it better; the value is then exact, and so what a wrong instant costs is of second order.
"""


@dataclass(frozen=True)
class ResponseSpectrum:
    """Peaks of linear oscillators of one damping, over the motion and one period of free vibration.

    Attributes
    ----------
    period : natural periods [s], shape (k,)
    damping : fraction of critical damping [-]
    displacement : Sd, peak relative displacement [m], shape (k,)
    velocity : Sv, peak relative velocity [m/s], shape (k,)
    acceleration : Sa, peak absolute (total) acceleration [m/s²], shape (k,)
    """

    period: Floats
    damping: float
    displacement: Floats
    velocity: Floats
    acceleration: Floats

    __repr__ = short_repr

    @property
    def pseudo_velocity(self) -> Floats:
        """PSV = ω Sd [m/s], shape (k,)."""
        return self.displacement * (2 * math.pi / self.period)

    @property
    def pseudo_acceleration(self) -> Floats:
        """PSA = ω² Sd [m/s²], shape (k,)."""
        return self.displacement * (2 * math.pi / self.period) ** 2


def oscillator_matrix(omega: float, damping: float, step: float) -> Floats:
    """Exact propagator of an oscillator over one step of linearly varying ground acceleration.

    The state is (u, u', a, s): relative displacement and velocity, ground acceleration and its slope; u'' + 2 ζ ω
    u' + ω² u = -a, a' = s.  Nigam & Jennings (1969, Bull. Seism. Soc. Am. 59(2), 909-922), for any damping, at and
    above critical too.  The matrix, of shape (2, 4), maps (u, u', a, s) to (u, u') one step [s] later.

    Parameters
    ----------
    omega, damping, step : circular frequency [rad/s], fraction of critical damping [-] and step [s]

    Returns
    -------
    The propagator, shape (2, 4).
    """
    matrix = np.zeros((2, 4))
    fill_propagator(omega, damping, step, matrix)
    return matrix


@cached_njit()
def _histories(
    acceleration: Floats, step: float, matrix: Floats
) -> tuple[Floats, Floats]:
    """Relative displacement [m] and velocity [m/s] at the samples, from rest, shape (n,) each.

    ``acceleration``: of the ground [m/s²], shape (n,); ``step``: between samples [s]; ``matrix``:
    :func:`oscillator_matrix`.
    """
    n = acceleration.size
    u, v = np.zeros(n), np.zeros(n)
    for i in range(n - 1):
        a = acceleration[i]
        s = (acceleration[i + 1] - a) / step
        u[i + 1] = (
            matrix[0, 0] * u[i]
            + matrix[0, 1] * v[i]
            + matrix[0, 2] * a
            + matrix[0, 3] * s
        )
        v[i + 1] = (
            matrix[1, 0] * u[i]
            + matrix[1, 1] * v[i]
            + matrix[1, 2] * a
            + matrix[1, 3] * s
        )
    return u, v


@cached_njit()
def turning_time(x0: float, m0: float, x1: float, m1: float, h: float) -> float:
    """Time in (0, h) at which a cubic over an interval turns, where its slopes at both ends have unlike signs.

    Parameters
    ----------
    x0, x1 : values at both ends
    m0, m1 : slopes there [1/s times the unit of the values]
    h : length of the interval [s]

    Returns
    -------
    The time [s].
    """
    rise = x1 - x0
    a = 3 * (h * (m0 + m1) - 2 * rise)
    b = 2 * (3 * rise - h * (2 * m0 + m1))
    c = h * m0
    # with ξ = t/h the slope of Hermite's cubic times h is a ξ² + b ξ + c; it has exactly one root in (0, 1),
    # because it changes sign once: q/a or c/q, so that nothing cancels
    q = -0.5 * (b + math.copysign(math.sqrt(max(b * b - 4 * a * c, 0.0)), b))
    if a != 0.0 and 0.0 < q / a < 1.0:
        return h * q / a
    return h * min(max(c / q, 0.0), 1.0) if q != 0.0 else 0.0


@cached_njit()
def state_after(
    u: float, v: float, a: float, s: float, c: float, k: float, t: float
) -> tuple[float, float]:
    """Displacement and velocity a short time t later, by the Taylor series of u'' = -a - c u' - k u.

    Parameters
    ----------
    u, v : relative displacement [m] and velocity [m/s] now
    a, s : acceleration of the ground now [m/s²] and its slope [m/s³]
    c, k : 2 ζ ω [1/s] and ω² [1/s²]
    t : time [s]

    Returns
    -------
    Displacement [m] and velocity [m/s] then.
    """
    low, high = v, -a - c * v - k * u
    u1, v1 = u + v * t, v
    power, ground = t, s
    for order in range(2, 14):
        # low and high are the derivatives of u of order - 1 and order; power is t^(order-1)/(order-1)!
        v1 += high * power
        power *= t / order
        u1 += high * power
        low, high = high, -ground - c * high - k * low
        ground = 0.0
    return u1, v1


@cached_njit()
def _response(
    order: int, start: tuple[float, float, float, float], c: float, k: float, t: float
) -> tuple[float, float, float]:
    """Value, slope and curvature of a response a short time t later.

    Parameters
    ----------
    order : of the response: 0 for u, 1 for u', 2 for the total acceleration
    start : u, u', the ground's acceleration and its slope now
    c, k, t : as of :func:`state_after`
    """
    u, v, a, s = start
    u, v = state_after(u, v, a, s, c, k, t)
    total = -(c * v + k * u)
    relative = total - (a + t * s)
    if order == 0:
        return u, v, relative
    jerk = -(c * relative + k * v)
    if order == 1:
        return v, relative, jerk - s
    return total, jerk, -(c * (jerk - s) + k * relative)


@cached_njit()
def _peak_near(
    order: int,
    start: tuple[float, float, float, float],
    c: float,
    k: float,
    t: float,
    h: float,
) -> float:
    """Largest size of a response within a step of length h [s], of which it turns about t [s] after its beginning.

    One step of Newton's on its slope mends t; other parameters as of :func:`_response`.
    """
    _, slope, curvature = _response(order, start, c, k, t)
    if curvature != 0.0:
        t = min(max(t - slope / curvature, 0.0), h)
    return float(abs(_response(order, start, c, k, t)[0]))


@cached_njit()
def peak_within(
    order: int,
    first: tuple[float, float, float],
    last: tuple[float, float, float],
    start: tuple[float, float, float, float],
    c: float,
    k: float,
    h: float,
) -> float:
    """Largest size of a response where it turns within a step, once or twice; 0 if it does not.

    Parameters
    ----------
    order : of the response, as of :func:`_response`
    first, last : its value, slope and curvature at both ends of the step
    start : u, u', the ground's acceleration and its slope at the beginning
    c, k, h : 2 ζ ω [1/s], ω² [1/s²] and length of the step [s]
    """
    (x0, m0, n0), (x1, m1, n1) = first, last
    if m0 * m1 < 0:
        return float(_peak_near(order, start, c, k, turning_time(x0, m0, x1, m1, h), h))
    if n0 * n1 >= 0:
        return 0.0
    # between two turns lies one of the slope
    middle = turning_time(m0, n0, m1, n1, h)
    x, m, _ = _response(order, start, c, k, middle)
    if m * m0 >= 0:
        return 0.0
    early = turning_time(x0, m0, x, m, middle)
    late = middle + turning_time(x, m, x1, m1, h - middle)
    return float(
        max(
            _peak_near(order, start, c, k, early, h),
            _peak_near(order, start, c, k, late, h),
        )
    )


@cached_njit()
def _end_of_step(
    matrix: Floats, start: tuple[float, float, float, float]
) -> tuple[float, float]:
    """Move u [m] and u' [m/s] on by a step; ``start``: both before, and the ground's acceleration and slope."""
    u, v, a, s = start
    return (
        matrix[0, 0] * u + matrix[0, 1] * v + matrix[0, 2] * a + matrix[0, 3] * s,
        matrix[1, 0] * u + matrix[1, 1] * v + matrix[1, 2] * a + matrix[1, 3] * s,
    )


@cached_njit()
def _accelerations(
    u: float, v: float, ground: float, c: float, k: float
) -> tuple[float, float, float]:
    """Total and relative acceleration [m/s²], and slope of the total one [m/s³]; ``ground``: its own [m/s²]."""
    total = -(c * v + k * u)
    relative = total - ground
    return total, relative, -(c * relative + k * v)


@cached_njit()
def _responses(
    at: tuple[float, float],
    known: tuple[float, float, float],
    s: float,
    c: float,
    k: float,
) -> tuple[tuple[float, float, float], ...]:
    """Value, slope and curvature of u, of u' and of the total acceleration, at one end of a step.

    ``at``: u and u' there; ``known``: :func:`_accelerations` there; ``s``: slope of the ground's acceleration in
    the step [m/s³].
    """
    (u, v), (total, relative, jerk) = at, known
    third = jerk - s
    fourth = -c * third - k * relative
    return (u, v, relative), (v, relative, third), (total, jerk, fourth)


@cached_njit()
def _peaks(
    acceleration: Floats,
    step: float,
    parts: int,
    matrix: Floats,
    omega: float,
    damping: float,
) -> Floats:
    """Integrate an oscillator step by step, and keep its peaks: at the steps, and where it turns between them.

    Parameters
    ----------
    acceleration : of the ground [m/s²], shape (n,)
    step, parts : length of a step [s], and steps a sample
    matrix : :func:`oscillator_matrix` of a step
    omega, damping : of the oscillator [rad/s], [-]

    Returns
    -------
    Peaks of relative displacement [m] and velocity [m/s] and of the total acceleration [m/s²], shape (3,).
    """
    c, k = 2 * damping * omega, omega * omega
    u = v = 0.0
    known = _accelerations(u, v, acceleration[0], c, k)
    peaks = np.zeros(3)
    for i in range(acceleration.size - 1):
        begin = acceleration[i]
        s = (acceleration[i + 1] - begin) / (parts * step)
        for j in range(parts):
            a = begin + j * step * s
            start = (u, v, a, s)
            u1, v1 = _end_of_step(matrix, start)
            known1 = _accelerations(u1, v1, a + step * s, c, k)
            first = _responses((u, v), known, s, c, k)
            last = _responses((u1, v1), known1, s, c, k)
            for order in range(3):
                between = peak_within(
                    order, first[order], last[order], start, c, k, step
                )
                peaks[order] = max(peaks[order], abs(last[order][0]), between)
            u, v, known = u1, v1, known1
    return peaks


def oscillator_response(
    motion: Motion, period: float, damping: float = 0.05
) -> tuple[Floats, Floats, Floats]:
    """Response history of a linear oscillator at rest at first; exact at the samples.

    Parameters
    ----------
    motion : acceleration of n samples [m/s²]
    period, damping : of the oscillator [s], and fraction of critical damping [-]

    Returns
    -------
    Relative displacement [m], relative velocity [m/s] and absolute acceleration [m/s²], shape (n,) each.
    """
    (period,) = _checked_periods([period])
    damping = checked_damping(damping)
    omega = 2 * math.pi / period
    matrix = oscillator_matrix(omega, damping, motion.dt)
    u, v = _histories(motion.acceleration, motion.dt, matrix)
    return u, v, -(2 * damping * omega * v + omega**2 * u)


@named_keywords
def response_spectrum(
    motion: Motion, periods: ArrayLike | Sequence[float], damping: float = 0.05
) -> ResponseSpectrum:
    """Response spectrum of a motion: peaks between samples and in the free vibration after it too.

    Parameters
    ----------
    motion : ground acceleration, linear between samples and zero after the last one
    periods : natural periods [s], shape (k,), each positive
    damping : fraction of critical damping [-], zero or more

    Returns
    -------
    The :class:`ResponseSpectrum`, whose arrays have the shape (k,), as the periods.

    Examples
    --------
    >>> import numpy as np
    >>> from rockfrag import Motion, response_spectrum
    >>> time = np.arange(0, 10, 0.01)
    >>> motion = Motion(np.sin(2 * np.pi * time), dt=0.01)
    >>> response_spectrum(motion, [0.5, 1.0, 2.0]).acceleration.argmax()
    np.int64(1)
    """
    checked = _checked_periods(periods)
    damping = checked_damping(damping)
    peaks = np.empty((checked.size, 3))
    for i, period in enumerate(checked.tolist()):
        omega = 2 * math.pi / period
        parts = steps_within(motion.dt, period, damping)
        step = motion.dt / parts
        # one period of free vibration holds the first peak of either sign, and later ones are smaller
        acceleration = np.pad(
            motion.acceleration, (0, math.ceil(period / motion.dt) + 1)
        )
        matrix = oscillator_matrix(omega, damping, step)
        peaks[i] = _peaks(acceleration, step, parts, matrix, omega, damping)
    return ResponseSpectrum(checked, damping, *peaks.T)


def steps_within(dt: float, period: float, damping: float) -> int:
    """Return the number of steps into which a sampling interval [s] is divided for an oscillator."""
    return max(1, math.ceil(STEPS_PER_PERIOD * max(1.0, 2 * damping) * dt / period))


def fourier_amplitude(motion: Motion, least_length: int = 0) -> tuple[Floats, Floats]:
    """Fourier amplitude spectrum |∫ a e^(-iωt) dt| as dt times the discrete transform.

    Parameters
    ----------
    motion, least_length : acceleration of n samples [m/s²], and length to which zeros extend it

    Returns
    -------
    Frequencies [Hz] and amplitudes [m/s], shape (frequencies,) each.
    """
    length = max(motion.acceleration.size, least_length)
    amplitude = motion.dt * np.abs(np.fft.rfft(motion.acceleration, length))
    return np.asarray(np.fft.rfftfreq(length, motion.dt), dtype=np.float64), amplitude


def _checked_periods(periods: ArrayLike | Sequence[float]) -> Floats:
    """Positive periods [s], shape (n,)."""
    checked = np.atleast_1d(np.asarray(periods, dtype=np.float64))
    if checked.ndim != 1 or checked.size == 0:
        raise InputError(
            "response spectrum: at least one period [s] is needed, in one dimension."
        )
    bad = checked[~(np.isfinite(checked) & (checked > 0))]
    if bad.size:
        raise InputError(
            f"response spectrum: periods must be positive numbers of seconds, got {bad[0]}."
        )
    return checked


# fraction of critical damping beyond which a number is one of percent
MOST_DAMPED = 3.0


def checked_damping(damping: float) -> float:
    """Return a damping that is a fraction of critical, zero or more; InputError otherwise."""
    if not (math.isfinite(damping) and damping >= 0):
        raise InputError(
            f"response spectrum: damping is a fraction of critical, zero or more, not {damping}."
        )
    if damping > MOST_DAMPED:
        raise InputError(
            f"response spectrum: a damping of {damping:g} is {100 * damping:g} % of critical; give the fraction, "
            f"such as {damping / 100:g} for {damping:g} %."
        )
    return float(damping)


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

_Group = tuple[NDArray[np.intp], int, float, int, Floats]
"""Which oscillators take steps of one length, steps a sample, step [s], samples of quiet at the end, and table."""

# samples of a stretch, after which is asked whether anything larger can still come
LOOK_EVERY = 32


def peak_displacements(
    motion: Motion, periods: Floats, damping: float = 0.05
) -> Floats:
    """Sd of many oscillators, as :func:`response_spectrum` gives it, bit by bit.

    Parameters
    ----------
    motion : ground acceleration, linear between samples and zero after the last one
    periods : natural periods [s], shape (k,), each positive
    damping : fraction of critical damping [-], zero or more

    Returns
    -------
    Peak relative displacements [m], shape (k,).
    """
    damping = checked_damping(damping)
    peaks = np.empty(periods.size)
    # largest |a| from each sample on
    to_come = np.maximum.accumulate(np.abs(motion.acceleration[::-1]))[::-1]
    for which, parts, step, quiet, table in _groups(
        periods.tobytes(), damping, motion.dt
    ):
        x = table.copy()
        # what the ground may add to a peak grows with its PGA
        x[_ADDED : _ADDED + LANES] *= to_come[0]
        _integrate(motion.acceleration, to_come, quiet, step, parts, x)
        peaks[which] = x[_LARGEST : _LARGEST + which.size]
    return peaks


@lru_cache(maxsize=64)
def _groups(periods: bytes, damping: float, dt: float) -> tuple[_Group, ...]:
    """Oscillators in groups of one step length, which are integrated side by side.

    ``periods`` are those of the oscillators [s], as bytes of float64, since a cache needs keys; ``dt`` is the
    interval of the samples [s].
    """
    each = np.frombuffer(periods)
    parts = np.array([steps_within(dt, float(period), damping) for period in each])
    # undamped vibration does not get smaller, and so each such oscillator must end at its own time
    lanes = LANES if damping > 0 else 1
    groups = []
    for count in np.unique(parts):
        (which,) = np.nonzero(parts == count)
        for i in range(0, which.size, lanes):
            some = which[i : i + lanes]
            # samples of a whole longest period, after which each oscillator has shown a peak
            quiet = math.ceil(each[some].max() / dt) + 1
            table = np.zeros((_ROWS, LANES))
            for lane, period in enumerate(each[some]):
                table[:, lane] = _column(float(period), damping, dt / count)
            groups.append((some, int(count), float(dt / count), quiet, table.ravel()))
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
    matrix = oscillator_matrix(omega, damping, step).ravel()
    return np.array([*matrix, *[0.0] * 5, *ahead, 1 - q, q / k, c, k, 0.0])


@cached_njit(error_model="numpy", inline="always")
def _sample(acceleration: Floats, i: int) -> float:
    return acceleration[i] if i < acceleration.size else 0.0


@cached_njit(error_model="numpy")
def _integrate(
    acceleration: Floats,
    to_come: Floats,
    quiet: int,
    step: float,
    parts: int,
    x: Floats,
) -> None:
    """Take all lanes through a motion and the quiet time after it, and leave their peaks in their table.

    A first pass notes the largest displacement at the ends of steps, by stretches of ``LOOK_EVERY`` samples. A
    second one goes again through the stretches that may hold the peak, and looks for it between the ends too.

    Parameters
    ----------
    acceleration, to_come : of the ground, and its largest magnitude from each sample on [m/s²], shape (n,)
    quiet : samples after the motion
    step, parts : length of a step [s], and how many a sample has
    x : table of the oscillators (:func:`_column`), shape (rows × LANES,)
    """
    end = acceleration.size - 1 + quiet
    ground = np.empty((2, LOOK_EVERY * parts))
    # of each stretch the state at its beginning and its largest displacement
    stretches = np.empty((-(-end // LOOK_EVERY), 3 * LANES))
    count = 0
    for first in range(0, end, LOOK_EVERY):
        if _settled(x, _sample(to_come, first)):
            break
        steps = _fill_ground(
            acceleration, first, min(first + LOOK_EVERY, end), step, parts, ground
        )
        stretches[count, : 2 * LANES] = x[_U : _U + 2 * LANES]
        for i in range(LANES):
            x[_HIGHEST + i] = abs(x[_U + i])
        for j in range(steps):
            _advance(x, ground[0, j], ground[1, j])
        for i in range(LANES):
            stretches[count, 2 * LANES + i] = x[_HIGHEST + i]
            x[_LARGEST + i] = max(x[_LARGEST + i], x[_HIGHEST + i])
        count += 1
    for number in range(count):
        if not _may_hold_the_peak(x, stretches[number]):
            continue
        x[_U : _U + 2 * LANES] = stretches[number, : 2 * LANES]
        first = number * LOOK_EVERY
        steps = _fill_ground(
            acceleration, first, min(first + LOOK_EVERY, end), step, parts, ground
        )
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
    """Write the ground's acceleration [m/s²] and slope [m/s³] at the beginning of each step into ``ground``.

    Parameters
    ----------
    acceleration : samples [m/s²], shape (n,); beyond them the ground stands still
    first, last : samples between which, each divided into ``parts`` steps of ``step`` seconds
    ground : filled, shape (2, at least the number of steps)

    Returns
    -------
    The number of steps.
    """
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
def _may_hold_the_peak(x: Floats, stretch: Floats) -> bool:
    """Whether a peak between two steps of a stretch can be the largest displacement of a lane."""
    may = False
    for i in range(LANES):
        may |= stretch[2 * LANES + i] + x[_ADDED + i] > x[_KEPT + i] * x[_LARGEST + i]
    return may


@cached_njit(error_model="numpy")
def _advance(x: Floats, a: float, s: float) -> None:
    """Take all lanes a step on, with the ground's acceleration at its beginning and its slope."""
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
    """Let the peaks of lane i within its last step count, if they can be the largest.

    ``a`` and ``s`` are the ground's acceleration at the beginning of the step and its slope there.
    """
    displacement, velocity = x[_U0 + i], x[_V0 + i]
    end_displacement, end_velocity = x[_U + i], x[_V + i]
    c, k = x[_C + i], x[_K + i]
    at_ends = max(abs(displacement), abs(end_displacement))
    if at_ends + x[_ADDED + i] > x[_KEPT + i] * x[_LARGEST + i]:
        # relative to the ground, ü = -c u̇ - k u - a
        begins = -(c * velocity + k * displacement) - a
        ends = -(c * end_velocity + k * end_displacement) - (a + step * s)
        first = displacement, velocity, begins
        last = end_displacement, end_velocity, ends
        start = displacement, velocity, a, s
        # order 0 is the displacement
        peak = peak_within(0, first, last, start, c, k, step)
        x[_LARGEST + i] = max(x[_LARGEST + i], peak)
