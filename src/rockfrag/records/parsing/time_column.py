"""A column of times: what it says about the sampling interval, and how far off even times it may be.

Times are even where each is ``t0 + i dt`` within the rounding of its print. Clocks of phones and loggers, and
times kept in single precision, are not; such times count as even where each is off by less than
:data:`JITTER` of a step, or by less than :data:`DRIFT` of the length of the record where they wander slowly. An
interval that is stated beside the column must fit it in the same way, within :data:`STATED_JITTER`. A step of
more than :data:`GAP` of the usual ones is a gap, which nothing closes.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from rockfrag.records.motion import SAID
from rockfrag.records.parsing.text_file import TextFile

JITTER = 0.1
"""Fraction of a step by which times may be off even ones and are still read as even."""

STATED_JITTER = 0.25
"""The same where the interval is stated beside the times, by the user or by the header."""

DRIFT = 1e-3
"""Fraction of the length of a record by which its times may drift from even ones."""

GAP = 1.5
"""Ratio to the usual step above which a step is a gap."""

_FRACTION_OF_STEP = 1e-4  # of which a time may be off beyond the rounding of its print
_FINEST_DIGITS = 9
# digits of the last place of a step below which it may be a rounded one
_COARSE = 9.5

Notes = tuple[dict[str, Any], ...]


@dataclass(frozen=True)
class TimeColumn:
    """Times as they stand in a file."""

    times: NDArray[np.float64]  # in units of ``seconds``, shape (n,)
    text: TextFile
    line: int  # of the first time, from zero
    seconds: float = 1.0

    def interval(self) -> tuple[float, Notes]:
        """Return the sampling interval [s], and for the provenance how uneven the times are if they are."""
        self._check_count()
        self.check_rising()
        dt = _simplest(self._mean, self._least_error)
        if not self._is_even(dt):
            return self._uneven_interval()
        if self._is_rounded(dt):
            self._fail_rounded(dt)
        return self._in_seconds(dt), ()

    def interval_beside(self, stated: float | None, whose: str) -> tuple[float, Notes]:
        """Return the interval [s] that is stated, which the times must fit, else that of the times, and notes."""
        if stated is None:
            return self.interval()
        return stated, self.check(stated, whose)

    def even_interval(self) -> float | None:
        """Return the sampling interval [s] of times that are even as printed, None of others."""
        dt = _simplest(self._mean, self._least_error)
        known = self._is_even(dt) and dt > 0 and not self._is_rounded(dt)
        return self._in_seconds(dt) if known else None

    def check(self, dt: float, whose: str) -> Notes:
        """Check an interval [s] stated beside the times; return notes of what is off.

        ``whose`` words state it: ``dt= gives``, ``#SampleRate gives``.
        """
        self._check_count()
        stated = dt / self.seconds
        steps = np.diff(self.times)
        if self._is_even(stated):
            return ()
        if self._is_rounded_from(stated):
            step = float(steps.mean())
            said = f"its times step by {self._show(step)} s, a rounded {dt:g} s"
            replaced = {"dt_s": dt, "mean_step_in_file_s": self._in_seconds(step)}
            return ({"step": "replace time column", **replaced, SAID: said},)
        self.check_rising()
        self._check_no_gap()
        off = self._off(stated)
        if self._is_jitter(off, stated, STATED_JITTER):
            return self._notes(off, stated)
        self.text.fail(
            f"{whose} {dt:g} s, but times step by {self._show(self._mean)} s (from {self._show(steps.min())} to "
            f"{self._show(steps.max())} s); take out what is wrong of the two",
            self.line,
        )

    def check_rising(self) -> None:
        """Check that each time is later than the one before."""
        falls = np.flatnonzero(np.diff(self.times) <= 0)
        if falls.size:
            bad = int(falls[0])
            same = self.times[bad] == self.times[bad + 1]
            more = "; if they are printed too coarsely, give the interval with dt="
            self.text.fail(
                f"time falls or stands still from {self._show(self.times[bad])} s to "
                f"{self._show(self.times[bad + 1])} s{more if same else ''}",
                self.line + bad + 1,
            )

    @cached_property
    def _mean(self) -> float:
        return float((self.times[-1] - self.times[0]) / (self.times.size - 1))

    @cached_property
    def _resolution(self) -> float:
        return resolution_of(self.times)

    @cached_property
    def _printed(self) -> NDArray[np.float64]:
        """Decimal unit that each time is printed to, shape (n,); coarser for larger times of fixed digits."""
        decades = np.floor(np.log10(np.maximum(np.abs(self.times), 1.0)))
        resolution = np.empty_like(self.times)
        for decade in np.unique(decades):
            inside = decades == decade
            resolution[inside] = resolution_of(self.times[inside])
        return resolution

    @property
    def _least_error(self) -> float:
        """How far the mean step may be off for the rounding of the last time."""
        return max(
            float(self._printed[-1]) / (self.times.size - 1), 1e-12 * abs(self._mean)
        )

    def _check_count(self) -> None:
        """Refuse a single time."""
        if self.times.size < 2:
            self.text.fail(
                "one time alone says nothing about the sampling interval", self.line
            )

    def _is_even(self, dt: float) -> bool:
        """Tell whether the times are even ones of an interval within the rounding of their print."""
        off = np.abs(self.times - self.times[0] - np.arange(self.times.size) * dt)
        rounding = 0.5 * self._printed * (1 + 1e-9)
        return bool((off <= rounding + _FRACTION_OF_STEP * dt).all())

    def _is_rounded(self, dt: float) -> bool:
        """Tell whether a step of a few units of the last place looks like a rounded one."""
        rate = 1 / (dt * self.seconds) if dt > 0 else 0.0
        whole = any(abs(r - round(r)) <= 1e-6 * r for r in (rate, rate * self.seconds))
        return dt < _COARSE * self._resolution and not whole

    def _is_rounded_from(self, dt: float) -> bool:
        """Tell whether the steps, all of them equal, are what an interval becomes when it is printed."""
        steps = np.diff(self.times)
        step = float(steps.mean())
        alike = float(np.ptp(steps)) < 1e-6 * step
        near = abs(dt - step) <= 0.5 * self._resolution * (1 + 1e-9)
        return alike and near and self._is_rounded(step)

    def _fail_rounded(self, dt: float) -> NoReturn:
        """Refuse times so coarsely rounded that their interval is not known."""
        half = self._resolution / 2
        self.text.fail(
            f"the time column steps by {self._show(dt)} s, which is {1 / (dt * self.seconds):.2f} samples a "
            f"second and looks like a step rounded to {self._show(2 * half)} s (from anything between "
            f"{self._show(dt - half)} and {self._show(dt + half)} s); give the true interval with dt=",
            self.line,
        )

    def _uneven_interval(self) -> tuple[float, Notes]:
        """Interval of times that are even but for jitter, and the note that says so."""
        self._check_no_gap()
        count = np.arange(self.times.size)
        slope = float(np.polynomial.polynomial.polyfit(count, self.times, 1)[1])
        error = 2 * self._off(slope) / self.times.size
        dt = _simplest(slope, max(error, self._least_error))
        off = self._off(dt)
        if not self._is_jitter(off, dt, JITTER):
            self._fail_uneven(dt, off)
        return self._in_seconds(dt), self._notes(off, dt)

    def _off(self, dt: float) -> float:
        """Return by how much the times are off the even ones of an interval that fit them best."""
        return 0.5 * float(np.ptp(self.times - np.arange(self.times.size) * dt))

    def _is_jitter(self, off: float, dt: float, fraction: float) -> bool:
        """Tell whether times that are ``off`` even ones still tell each sample from its neighbours."""
        if 0.5 * float(self._printed.max()) > fraction * dt:
            return False  # printed too coarsely to see a sample that is missing
        worst = float(np.abs(np.diff(self.times) - dt).max())
        length = abs(float(self.times[-1] - self.times[0]))
        return worst <= 2 * fraction * dt and off <= max(fraction * dt, DRIFT * length)

    def _check_no_gap(self) -> None:
        """Refuse times with a step of more than ``GAP`` usual ones, naming the first."""
        steps = np.diff(self.times)
        usual = float(np.median(steps))
        gaps = np.flatnonzero(steps > GAP * usual)
        if usual <= 0 or not gaps.size:
            return
        first = int(gaps[0])
        lost = max(1, round(float(steps[first]) / usual) - 1)
        several = f", the first of {gaps.size} gaps" if gaps.size > 1 else ""
        self.text.fail(
            f"times are not equally spaced, a gap{several}: {self._show(steps[first])} s between "
            f"{self._show(self.times[first])} and {self._show(self.times[first + 1])} s, where samples are "
            f"{self._show(usual)} s apart, so that about {lost} are missing; dt= does not close it: keep the rows "
            "above or below it, or fill it in",
            self.line + first + 1,
        )

    def _fail_uneven(self, dt: float, off: float) -> NoReturn:
        """Refuse times that are ``off`` even ones at an interval, naming the line that is furthest off.

        That is one end of the step which differs most, the one further from the even times.
        """
        steps = np.diff(self.times)
        start = self.times - np.arange(self.times.size) * dt
        distance = np.abs(start - np.median(start))
        worst_step = int(np.abs(steps - dt).argmax())
        is_later = distance[worst_step + 1] >= distance[worst_step]
        bad = worst_step + int(is_later)
        way_out = "too much for dt=; interpolate the samples to even times"
        if self._is_jitter(off, dt, STATED_JITTER):
            way_out = (
                "if the samples are even and only their times are not, give "
                f"dt= ({self._in_seconds(dt):g} s)"
            )
        self.text.fail(
            f"times are not equally spaced: {self._show(self.times[bad])} s here, steps of "
            f"{self._show(steps.min())} to {self._show(steps.max())} s, and times up to {off / dt:.2g} of a step "
            f"off even ones (at most {JITTER:g} is taken); {way_out}",
            self.line + bad,
        )

    def _notes(self, off: float, dt: float) -> Notes:
        """Return the step of the provenance of times that are taken as even ones."""
        said = f"its times are up to {100 * off / dt:.2g} % of a step off even ones of {self._show(dt)} s"
        taken = {
            "dt_s": self._in_seconds(dt),
            "mean_step_in_file_s": self._in_seconds(self._mean),
            "largest_deviation_s": float(f"{off * self.seconds:.3g}"),
        }
        return ({"step": "take uneven times as even", **taken, SAID: said},)

    def _in_seconds(self, value: float) -> float:
        """Convert a number in the column's unit to seconds."""
        value = float(value)
        return value if self.seconds == 1 else float(f"{value * self.seconds:.12g}")

    def _show(self, value: float) -> str:
        """Write a time of the column [s] with as many digits as tell it from its neighbours."""
        return f"{float(value) * self.seconds:.10g}"


def resolution_of(times: NDArray[np.float64]) -> float:
    """Return the coarsest decimal unit [s] that all times are multiples of, from 1 to 1e-9."""
    for digits in range(_FINEST_DIGITS):
        scaled = times * 10.0**digits
        off = np.abs(scaled - np.round(scaled))
        if bool((off <= 1e-6 + 1e-12 * np.abs(scaled)).all()):
            return float(10.0**-digits)
    return float(10.0**-_FINEST_DIGITS)


def _simplest(mean: float, error: float) -> float:
    """Return the decimal of fewest digits within an error of a mean step, or the mean itself."""
    decimals = (float(f"{mean:.{digits}g}") for digits in range(1, 16))
    return next((each for each in decimals if abs(each - mean) <= error), mean)
