"""Findings: what was found, as the id of a text with the values that stand in it."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from enum import StrEnum
from typing import Any


class Form(StrEnum):
    """How a number is written."""

    PERCENT = "percent"  # A probability or fraction [-] in per cent, to two digits
    LIMIT = "limit"  # A limit of one in per cent, without its sign
    TWO = "two"  # To two digits
    THREE = "three"  # To three digits
    FOUR = "four"  # To four digits
    WHOLE = "whole"  # To the next whole number
    ORDINAL = "ordinal"  # As first, second, 11th


@dataclass(frozen=True)
class Number:
    """A number with the form in which it is written."""

    value: float
    form: Form


@dataclass(frozen=True)
class Listed:
    """Values that are said one after the other: ``a, b and c``."""

    values: tuple["Value", ...]


@dataclass(frozen=True)
class Finding:
    """Something found: equal findings are said alike."""

    id: str  # Id of its text in every catalogue
    # What stands in the places of the text, by their names
    values: tuple[tuple[str, "Value"], ...] = ()
    # The estimate behind it, for programs; None where it rests on no single one
    estimate: Any = field(default=None, compare=False)

    def __getitem__(self, place: str) -> "Value":
        """Return the value that stands in a place of the text."""
        return dict(self.values)[place]


Value = str | int | Number | Listed | Finding
"""What may stand in a place: a name as it is, a count, a number, a list, or another finding."""


def finding(id: str, /, estimate: Any = None, **values: Value) -> Finding:
    """Return a finding with values in the places of its text.

    Parameters
    ----------
    id : id of the text
    estimate : the estimate behind it, for programs
    **values : what stands in the places, by their names

    Returns
    -------
    The :class:`Finding`.
    """
    return Finding(str(id), tuple(values.items()), estimate)


def percent(value: float) -> Number:
    """A probability or fraction [-], said in per cent.

    Parameters
    ----------
    value : probability or fraction [-]

    Returns
    -------
    The number with its form.
    """
    return Number(float(value), Form.PERCENT)


def limit(value: float) -> Number:
    """A limit of a probability or fraction [-], said in per cent without its sign.

    Parameters
    ----------
    value : limit of a probability or fraction [-]

    Returns
    -------
    The number with its form.
    """
    return Number(float(value), Form.LIMIT)


def two(value: float) -> Number:
    """A number to two digits.

    Parameters
    ----------
    value : number, in any unit

    Returns
    -------
    The number with its form.
    """
    return Number(float(value), Form.TWO)


def three(value: float) -> Number:
    """A number to three digits.

    Parameters
    ----------
    value : number, in any unit

    Returns
    -------
    The number with its form.
    """
    return Number(float(value), Form.THREE)


def whole(value: float) -> Number:
    """A number to the next whole one.

    Parameters
    ----------
    value : number, in any unit

    Returns
    -------
    The number with its form.
    """
    return Number(float(value), Form.WHOLE)


def listed(values: Sequence[Value]) -> Listed:
    """Values that are said one after the other.

    Parameters
    ----------
    values : in their order

    Returns
    -------
    The list.
    """
    return Listed(tuple(values))


def as_data(value: Value) -> Any:
    """Return a finding or value as the page and JSON have it: mappings, lists, texts and numbers.

    Parameters
    ----------
    value : a finding, or what stands in one

    Returns
    -------
    What ``json.dumps`` takes.
    """
    if isinstance(value, Finding):
        values = {place: as_data(inner) for place, inner in value.values}
        return {"id": value.id, "values": values}
    if isinstance(value, Number):
        return {"number": value.value, "form": str(value.form)}
    if isinstance(value, Listed):
        return {"listed": [as_data(inner) for inner in value.values]}
    return value
