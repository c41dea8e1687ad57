"""Checks of the numbers that users give to steps, pulses and measures."""

import math
from collections.abc import Mapping
from numbers import Real
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rockfrag.errors import InputError
from rockfrag.records.motion import Motion

MOST_SAMPLES = 10_000_000  # more samples than this are taken for a mistake in a unit


def number(owner: str, name: str, value: Any, unit: str = "") -> float:
    """Return ``value`` as a float if it is a finite number."""
    if isinstance(value, bool) or not isinstance(value, Real):
        raise InputError(f"{owner}: {name} must be a finite number{_of(unit)}, got {value!r}.")
    try:
        as_float = float(value)
    except OverflowError:
        as_float = math.inf
    if not math.isfinite(as_float):
        raise InputError(f"{owner}: {name} must be a finite number{_of(unit)}, got {as_float}.")
    return as_float


def positive(owner: str, name: str, value: Any, unit: str = "") -> float:
    """Return ``value`` as a float if it is a positive finite number; InputError otherwise."""
    if number(owner, name, value, unit) <= 0:
        raise InputError(f"{owner}: {name} must be a positive number{_of(unit)}, got {value!r}.")
    return float(value)


def not_negative(owner: str, name: str, value: Any, unit: str = "") -> float:
    """Return ``value`` as a float if it is zero or positive and finite; InputError otherwise."""
    if number(owner, name, value, unit) < 0:
        raise InputError(f"{owner}: {name} must not be negative, got {value!r}{_of(unit)}.")
    return float(value)


def whole(owner: str, name: str, value: Any, least: int, most: int) -> int:
    """Return ``value`` as an int if it is a whole number from ``least`` to ``most``."""
    if number(owner, name, value) != int(value) or not least <= value <= most:
        raise InputError(
            f"{owner}: {name} must be a whole number from {least} to {most}, got {value!r}."
        )
    return int(value)


def plain(parameters: Mapping[str, Any]) -> dict[str, Any]:
    """Return parameters with numbers of NumPy's types as Python's own, which JSON can carry."""
    return {
        key: value.item() if isinstance(value, np.generic) else value
        for key, value in parameters.items()
    }


def peaks(motion: Motion, samples: NDArray[np.float64]) -> dict[str, float]:
    """Return the peaks [m/s²] before and after a step that changes samples, for its provenance."""
    after = float(np.abs(samples).max()) if samples.size else 0.0
    return {"peak_before_m_s2": motion.pga, "peak_after_m_s2": after}


def _of(unit: str) -> str:
    return f" of {unit}" if unit else ""
