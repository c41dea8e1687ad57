"""Two horizontal components: rotation, and measures that do not depend on how the sensor stood."""

import math
from collections.abc import Callable

import numpy as np

from rockfrag.errors import InputError
from rockfrag.motions.checks import number
from rockfrag.records.motion import Motion

DIRECTIONS_DEG = range(180)
"""Directions that are looked in [degrees]; the other half of the circle sees the same."""


def rotate(first: Motion, second: Motion, angle_deg: float) -> Motion:
    """Component of a horizontal motion in the direction ``angle_deg`` from first towards second.

    Parameters
    ----------
    first, second
        Perpendicular components, sampled at the same times.
    angle_deg
        Direction [degrees]; 0 gives the first component, 90 the second.

    Returns
    -------
    Motion named after the first, its provenance followed by this step.

    Raises
    ------
    InputError
        If the sampling intervals or the lengths differ.
    """
    _check_pair(first, second)
    angle = math.radians(number("rotate", "angle_deg", angle_deg, "degrees"))
    turned = first.acceleration * math.cos(angle) + second.acceleration * math.sin(angle)
    return first.after("rotate", turned, second=second.name, angle_deg=float(angle_deg))


def rotd(
    first: Motion, second: Motion, measure: Callable[[Motion], float], percentile: float
) -> float:
    """Percentile over all directions of a measure: RotD50 (median), RotD100 (largest), RotD00.

    Boore (2010, Bull. Seism. Soc. Am. 100(4), 1830-1835), directions in steps of one degree.

    Parameters
    ----------
    first, second
        Perpendicular components, sampled at the same times.
    measure
        Any measure of one component, such as :func:`rockfrag.motions.pga` or
        ``lambda m: spectral_acceleration(m, 1.0)``.
    percentile
        From 0 to 100.

    Raises
    ------
    InputError
        If the components do not fit together or the percentile is not from 0 to 100.
    """
    percentile = number("rotd", "percentile", percentile)
    if not 0 <= percentile <= 100:
        raise InputError(f"rotd: percentile must lie between 0 and 100, got {percentile}.")
    values = [measure(rotate(first, second, angle)) for angle in DIRECTIONS_DEG]
    return float(np.percentile(values, percentile))


def rotd50(first: Motion, second: Motion, measure: Callable[[Motion], float]) -> float:
    """Median over all directions of a measure; see :func:`rotd`.

    Parameters
    ----------
    first
        First of two perpendicular components, sampled at the same times.
    second
        Second component.
    measure
        Any measure of one component.

    Raises
    ------
    InputError
        If the components do not fit together.
    """
    return rotd(first, second, measure, 50.0)


def rotd100(first: Motion, second: Motion, measure: Callable[[Motion], float]) -> float:
    """Largest value over all directions of a measure; see :func:`rotd`.

    Parameters
    ----------
    first
        First of two perpendicular components, sampled at the same times.
    second
        Second component.
    measure
        Any measure of one component.

    Raises
    ------
    InputError
        If the components do not fit together.
    """
    return rotd(first, second, measure, 100.0)


def _check_pair(first: Motion, second: Motion) -> None:
    sizes = first.acceleration.size, second.acceleration.size
    if first.dt != second.dt or sizes[0] != sizes[1]:
        raise InputError(
            f"components {first.name!r} and {second.name!r} have {sizes[0]} and {sizes[1]} samples "
            f"of {first.dt:g} and {second.dt:g} s; bring them to one sampling and length first."
        )
