"""Checks of single numbers and arrays that users give: what cannot be used is refused, never trimmed."""

import math
import numbers
from collections.abc import Callable, Mapping
from contextlib import suppress
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rockfrag.base.errors import InputError

_LONGEST_SHOWN = 60


def shown(value: object) -> str:
    """Return a value as a message quotes it: in one short line.

    Parameters
    ----------
    value : anything

    Returns
    -------
    At most 61 characters.
    """
    text = " ".join(repr(value).split())
    return text if len(text) <= _LONGEST_SHOWN else text[:_LONGEST_SHOWN] + "…"


def real_number(name: str, value: object, unit: str = "") -> float:
    """Return a finite number as it is, or say in one sentence why it is none.

    Parameters
    ----------
    name : of the argument or key, with which a message begins
    value : anything
    unit : in which it is given; empty where it has none

    Returns
    -------
    The number, in the unit in which it was given.
    """
    return _checked(name, value, f"a finite number{_of(unit)}", lambda _: True)


def positive_number(name: str, value: object, unit: str = "") -> float:
    """Return a finite number above 0, or say in one sentence why it is none.

    Parameters
    ----------
    name : of the argument or key, with which a message begins
    value : anything
    unit : in which it is given; empty where it has none

    Returns
    -------
    The number, in the unit in which it was given.
    """
    return _checked(name, value, f"a positive number{_of(unit)}", lambda x: x > 0)


def number_from_zero(name: str, value: object, unit: str = "") -> float:
    """Return a finite number that is 0 or more, or say in one sentence why it is none.

    Parameters
    ----------
    name : of the argument or key, with which a message begins
    value : anything
    unit : in which it is given; empty where it has none

    Returns
    -------
    The number, in the unit in which it was given.
    """
    wanted = f"a number{_of(unit)} that is not negative"
    return _checked(name, value, wanted, lambda x: x >= 0)


def positive_or_infinite(name: str, value: object, unit: str = "") -> float:
    """Return a number above 0 or infinity, or say in one sentence why it is neither.

    Parameters
    ----------
    name : of the argument or key, with which a message begins
    value : anything
    unit : in which it is given; empty where it has none

    Returns
    -------
    The number, in the unit in which it was given, or infinity.
    """
    return math.inf if value == math.inf else positive_number(name, value, unit)


def ratio_to_one(name: str, value: object) -> float:
    """Return a number from 0 to 1, or say in one sentence why it is none.

    Parameters
    ----------
    name : of the argument or key, with which a message begins
    value : anything

    Returns
    -------
    The ratio [-].
    """
    return _checked(name, value, "a ratio from 0 to 1", lambda x: 0 <= x <= 1)


def _checked(
    name: str, value: object, wanted: str, allowed: Callable[[float], bool]
) -> float:
    """A real number that is allowed, or an error that says what was wanted."""
    number = math.nan
    is_number = isinstance(value, numbers.Real) and not isinstance(
        value, (bool, np.bool_)
    )
    # a whole number may have more digits than a float takes
    with suppress(OverflowError):
        number = float(value) if is_number else number  # type: ignore[arg-type]
    if not (math.isfinite(number) and allowed(number)):
        raise InputError(f"{name}: expected {wanted}, got {shown(value)}.")
    return number


def whole_number(name: str, value: object) -> int:
    """Return a whole number, or say in one sentence why it is none; True and False are none.

    Parameters
    ----------
    name : of the argument or key, with which a message begins
    value : anything

    Returns
    -------
    The number.
    """
    if isinstance(value, bool) or not isinstance(value, (int, np.integer)):
        raise InputError(f"{name}: expected a whole number, got {shown(value)}.")
    return int(value)


def whole_within(owner: str, name: str, value: Any, least: int, most: int) -> int:
    """Return ``value`` as an int if it is a whole number from ``least`` to ``most``.

    Parameters
    ----------
    owner, name : of what the argument belongs to, and of the argument itself
    value : anything
    least, most : that are allowed, both included

    Returns
    -------
    The number.
    """
    if (
        real_number(f"{owner}: {name}", value) != int(value)
        or not least <= value <= most
    ):
        raise InputError(
            f"{owner}: {name} must be a whole number from {least} to {most}, got {value!r}."
        )
    return int(value)


def _of(unit: str) -> str:
    return f" of {unit}" if unit else ""


def real_array(name: str, data: object, unit: str = "") -> NDArray[np.float64]:
    """Return data as an array of floats, or say in one sentence why they cannot be used.

    Parameters
    ----------
    name : of the argument, with which a message begins
    data : anything that ``np.asarray`` takes, of any shape
    unit : in which the numbers are given; empty where they have none

    Returns
    -------
    The numbers, contiguous, of the shape of ``data``; NaN and infinity are kept.
    """
    wanted = f"{name}: expected numbers{f' [{unit}]' if unit else ''}"
    if isinstance(data, np.ma.MaskedArray):
        raise InputError(f"{wanted}, got a masked array; fill its gaps first.")
    if data is None or isinstance(data, (str, bytes, set, frozenset, Mapping)):
        raise InputError(f"{wanted}, got {shown(data)}.")
    try:
        values: NDArray[Any] = np.asarray(data)
    except (TypeError, ValueError) as error:
        raise InputError(f"{wanted}, got {shown(data)}.") from error
    if values.dtype.kind == "c":
        raise InputError(
            f"{wanted}, got complex ones; take their real part if that is meant."
        )
    if values.dtype.kind not in "iuf" and values.size:
        known = {"b": "booleans", "U": "text", "S": "text"}
        kind = (
            known.get(values.dtype.kind)
            or f"{type(values.ravel()[0]).__name__} objects"
        )
        raise InputError(f"{wanted}, got {kind}.")
    return np.ascontiguousarray(values, dtype=np.float64)
