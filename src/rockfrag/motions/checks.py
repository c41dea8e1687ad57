"""Checks of the numbers that users give to steps, pulses and measures."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rockfrag.errors import InputError
from rockfrag.input_checks import real_number
from rockfrag.records.motion import Motion

MOST_SAMPLES = 10_000_000  # more samples than this are taken for a mistake in a unit


def whole(owner: str, name: str, value: Any, least: int, most: int) -> int:
    """Return ``value`` as an int if it is a whole number from ``least`` to ``most``."""
    if real_number(f"{owner}: {name}", value) != int(value) or not least <= value <= most:
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
