"""Measured tables: tests of a laboratory, read into the same table as simulated ones.

A CSV file with a header, one row a test; lines that start with ``#`` are comments. Columns:

``test, object, pedestal, earthquake, floor, lower_g, upper_g, censored, overturned_body, repetition, remark``

``lower_m_s2, upper_m_s2`` may stand for ``lower_g, upper_g``. ``lower`` is the largest amplitude
survived, ``upper`` the one that overturned; a test that did not overturn has ``censored`` ``right`` and no
``upper``. A column ``amplitude_g`` or ``amplitude_m_s2`` may hold the figure the laboratory reports
where it is not ``lower``, and ``motion`` the input motion where it is not ``<earthquake>_<floor>``.
"""

import math
import os
from collections.abc import Callable, Mapping

import pandas as pd

from rockfrag.errors import InputError
from rockfrag.renamed_keys import check_names
from rockfrag.shaketable.tests_table import BODIES, CENSORED, PEDESTALS, as_tests_table
from rockfrag.tabular import read_cells
from rockfrag.units import GRAVITY

_TEXT = (
    *("test", "object", "pedestal", "earthquake", "floor"),
    *("censored", "overturned_body", "repetition"),
)
_BOUNDS = {"g": ("lower_g", "upper_g"), "m_s2": ("lower_m_s2", "upper_m_s2")}
_OPTIONAL = ("remark", "motion", "amplitude_g", "amplitude_m_s2")

DEFINITION = "measured"
"""What the column ``definition`` of the table of tests says of measured tests."""


def read_measured(path: str | os.PathLike[str]) -> pd.DataFrame:
    """Read and check a measured table.

    Parameters
    ----------
    path
        Path of the CSV file.

    Returns
    -------
    Table of tests, see :mod:`rockfrag.shaketable.tests_table`, in the order of the file.

    Raises
    ------
    InputError
        If the file cannot be read or a field makes no sense; the message names line and column.
    """
    lines = read_cells(path)
    if not lines:
        raise InputError(
            f"{path}: holds no table; the first line that is no comment is its header."
        )
    (_, header), rows = lines[0], lines[1:]
    unit = _unit(str(path), header)
    tests = []
    seen: dict[tuple[str, str], int] = {}
    for line, fields in rows:
        if len(fields) != len(header):
            raise InputError(
                f"{path}, line {line}: has {len(fields)} fields, but the header has {len(header)}; "
                "put a remark that holds commas in double quotes."
            )
        row = dict(zip(header, fields, strict=True))
        test = _test(_Row(f"{path}, line {line}", row), unit)
        key = (row["test"], row["repetition"])
        if key in seen:
            raise InputError(
                f"{path}, line {line}, column test: {key[0]!r}, repetition {key[1]}, is on line "
                f"{seen[key]} already; give each repetition its own number."
            )
        seen[key] = line
        tests.append(test)
    return as_tests_table(tests)


def _unit(path: str, header: list[str]) -> str:
    units = [unit for unit, bounds in _BOUNDS.items() if set(bounds) & set(header)]
    if len(units) != 1:
        raise InputError(
            f"{path}: the header needs either lower_g and upper_g or lower_m_s2 and upper_m_s2."
        )
    needed = (*_TEXT, *_BOUNDS[units[0]])
    check_names(path, header, needed)
    for name in needed:
        if name not in header:
            raise InputError(f"{path}: column {name!r} is missing; it needs {', '.join(needed)}.")
    for name in header:
        if name not in needed and name not in _OPTIONAL:
            raise InputError(
                f"{path}: column {name!r} is unknown; known are {', '.join((*needed, *_OPTIONAL))}."
            )
        if header.count(name) > 1:
            raise InputError(f"{path}: column {name!r} occurs twice.")
    return units[0]


class _Row:
    """One row, whose complaints name the line and the column."""

    def __init__(self, where: str, fields: Mapping[str, str]) -> None:
        self.where = where
        self.fields = fields

    def complaint(self, column: str, what: str) -> InputError:
        return InputError(f"{self.where}, column {column}: {what}.")

    def text(self, column: str) -> str:
        if not self.fields[column]:
            raise self.complaint(column, "is empty")
        return self.fields[column]

    def one_of(self, column: str, known: tuple[str, ...]) -> str:
        value = self.fields[column]
        if value not in known:
            choice = ", ".join(name or "nothing" for name in known)
            raise self.complaint(column, f"must be one of {choice}, got {value!r}")
        return value

    def number(self, column: str, allowed: Callable[[float], bool], what: str) -> float:
        """Return the number in a column, NaN if it is empty."""
        value = self.fields.get(column, "")
        if not value:
            return math.nan
        try:
            number = float(value)
        except ValueError:
            raise self.complaint(column, f"must be a number, got {value!r}") from None
        if not (math.isfinite(number) and allowed(number)):
            raise self.complaint(column, f"must be {what}, got {value}")
        return number


def _test(row: _Row, unit: str) -> dict[str, object]:
    censored = row.one_of("censored", CENSORED)
    lower, upper = _bounds(row, unit, censored)
    body = row.one_of("overturned_body", BODIES)
    if (body == "") != (censored == "right"):
        raise row.complaint(
            "overturned_body", "names what overturned, and is empty only where nothing did"
        )
    earthquake, floor = row.text("earthquake"), row.text("floor")
    repetition = row.number("repetition", lambda n: n >= 1 and n == int(n), "a whole number from 1")
    if math.isnan(repetition):
        raise row.complaint("repetition", "is empty; number the repetitions from 1")
    pedestal = row.one_of("pedestal", PEDESTALS)
    if body == "pedestal" and pedestal == "NP":
        raise row.complaint("overturned_body", "is pedestal in a test without one")
    return {
        "test": row.text("test"),
        "object": row.text("object"),
        "pedestal": pedestal,
        "earthquake": earthquake,
        "floor": floor,
        "motion": row.fields.get("motion") or f"{earthquake}_{floor}",
        "lower_g": lower,
        "upper_g": upper,
        "amplitude_g": _reported(row, lower, censored),
        "censored": censored,
        "overturned_body": body,
        "repetition": int(repetition),
        "remark": row.fields.get("remark", ""),
        "definition": DEFINITION,
    }


def _bounds(row: _Row, unit: str, censored: str) -> tuple[float, float]:
    in_g = 1.0 if unit == "g" else 1 / GRAVITY
    low, high = _BOUNDS[unit]
    lower = row.number(low, lambda x: x >= 0, "zero or more")
    upper = row.number(high, lambda x: x > 0, "greater than zero")
    if math.isnan(lower):
        raise row.complaint(low, "is empty; give the largest amplitude survived, 0 if none was")
    if censored == "right" and not math.isnan(upper):
        raise row.complaint(high, "must be empty where the test is censored")
    if censored == "none" and math.isnan(upper):
        raise row.complaint(
            high, "is empty; give the amplitude that overturned, or censor the test"
        )
    if upper < lower:
        raise row.complaint(high, f"must not be below {low} ({lower:g}), got {upper:g}")
    return lower * in_g, upper * in_g


def _reported(row: _Row, lower_g: float, censored: str) -> float:
    """Figure of the laboratory [g]: its own column, else the largest amplitude survived."""
    figures = [
        row.number(column, lambda x: x > 0, "greater than zero") / one_g
        for column, one_g in (("amplitude_g", 1.0), ("amplitude_m_s2", GRAVITY))
        if row.fields.get(column)
    ]
    if len(figures) > 1:
        raise row.complaint("amplitude_m_s2", "must be empty where amplitude_g is given")
    if censored == "right":
        if figures:
            raise row.complaint("amplitude_g", "must be empty where the test is censored")
        return math.nan
    return figures[0] if figures else (lower_g if lower_g > 0 else math.nan)
