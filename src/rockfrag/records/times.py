"""Time columns and dates: what they say about the sampling interval and the first sample."""

from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from rockfrag.records.text import TextFile

_PRINTED = 1e-4
"""Share of a step by which a printed time may be off before digits are taken into account."""


def step_of_times(times: NDArray[np.float64], text: TextFile, first_line: int) -> float:
    """Return the sampling interval [s] of a column of equally spaced times.

    The times may be rounded to the digits they are printed with: each must be within half a unit
    of its last digit (and a ten-thousandth of a step) of ``t0 + i dt``.

    Raises
    ------
    InputError
        If there are fewer than two times, they do not rise, or they are not equally spaced.
    """
    if times.size < 2:
        text.fail("one time alone says nothing about the sampling interval", first_line)
    steps = np.diff(times)
    if (steps <= 0).any():
        bad = int(np.flatnonzero(steps <= 0)[0])
        text.fail(
            f"time falls or stands still from {times[bad]:g} s to {times[bad + 1]:g} s",
            first_line + bad + 1,
        )
    mean = float((times[-1] - times[0]) / (times.size - 1))
    dt = _plain_number_near(mean, resolution_of(times) / (times.size - 1))
    expected = times[0] + np.arange(times.size) * dt
    allowed = 0.5 * resolution_of(times) + _PRINTED * dt
    off = np.abs(times - expected) > allowed
    if off.any():
        bad = int(np.flatnonzero(off)[0])
        typical = float(np.median(steps))
        text.fail(
            f"times are not equally spaced: {times[bad]:g} s here, {expected[bad]:g} s expected "
            f"(steps of {steps.min():g} to {steps.max():g} s, most often {typical:g} s)",
            first_line + bad,
        )
    return dt


def resolution_of(times: NDArray[np.float64]) -> float:
    """Return the coarsest decimal unit [s] that all times are multiples of, from 1 to 1e-9."""
    for digits in range(10):
        scaled = times * 10.0**digits
        if np.allclose(
            scaled, np.round(scaled), rtol=0, atol=1e-6 * max(1.0, abs(scaled).max() * 1e-6)
        ):
            return float(10.0**-digits)
    return 1e-9


def _plain_number_near(value: float, tolerance: float) -> float:
    """Return the shortest decimal (or fraction of a second) within the tolerance of a value."""
    for digits in range(1, 13):
        rounded = float(f"{value:.{digits}g}")
        if abs(rounded - value) <= max(tolerance, 1e-12 * value):
            return rounded
    rate = Fraction(1 / value).limit_denominator(100)
    return float(1 / rate) if abs(float(1 / rate) - value) <= tolerance else value
