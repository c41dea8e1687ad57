"""The table of tests, one schema for simulated and for measured ones.

One row is one test: a configuration under a motion, its amplitude raised until it overturns or the
limit is reached.

===============  ==================================================================================
test             name of the test
configuration    what was tested: the object, and the pedestal that it stood on, if any
object, pedestal  what is tested; ``P`` on its pedestal, ``NP`` without
earthquake, floor     earthquake; floor of the building, ``ground`` without one
motion           name of the input motion
lower_g          largest amplitude known to be survived [g], 0 if none
upper_g          amplitude at which it overturned [g]; NaN if it never did
amplitude_g      the figure reported for the test [g]; NaN if there is none
censored         ``none``, or ``right`` if it did not overturn up to ``lower_g``
overturned_body  ``statue``, ``pedestal``, or empty
repetition       1, 2, …
remark           anything else
definition       how the bounds were found (``step_protocol``, ``measured``, …)
===============  ==================================================================================
"""

import math
import os

import pandas as pd

from rockfrag.base.errors import InputError
from rockfrag.base.tabular import Row, read_rows, read_table
from rockfrag.base.units import GRAVITY

COLUMNS = (
    *("test", "configuration", "object", "pedestal", "earthquake", "floor", "motion"),
    *("lower_g", "upper_g", "amplitude_g", "censored", "overturned_body"),
    *("repetition", "remark", "definition"),
)

_CHOICES = {
    "censored": ("none", "right"),
    "overturned_body": ("", "statue", "pedestal"),
    "pedestal": ("P", "NP"),
}
_TEXT = (
    "test",
    "object",
    "pedestal",
    "earthquake",
    "floor",
    "censored",
    "overturned_body",
)
_IN_G = {"g": 1.0, "m_s2": 1 / GRAVITY}
_OPTIONAL = ("remark", "motion", "amplitude_g", "amplitude_m_s2")


def as_tests_table(rows: list[dict[str, object]]) -> pd.DataFrame:
    """Return rows as a table with the columns and types of the schema, also if there are none.

    Rows without a ``configuration`` are of the object alone, or of the object on its one pedestal.
    """
    named = [
        {
            "configuration": f"P&{row['object']}"
            if row["pedestal"] == "P"
            else row["object"],
            **row,
        }
        for row in rows
    ]
    types = dict.fromkeys(COLUMNS, "str") | {"repetition": "int64"}
    types |= dict.fromkeys(("lower_g", "upper_g", "amplitude_g"), "float64")
    return pd.DataFrame(named, columns=list(COLUMNS)).astype(types)


def read_measured(path: str | os.PathLike[str]) -> pd.DataFrame:
    """Read and check a measured table, a row a test of a laboratory (``config/experiment/tests-template.csv``).

    Parameters
    ----------
    path : of the CSV file

    Returns
    -------
    Table of tests, as this module describes it, in the order of the file.
    """
    header = set(read_table(path).titles)
    units = [unit for unit in _IN_G if {f"lower_{unit}", f"upper_{unit}"} & header]
    if len(units) != 1:
        raise InputError(
            f"{path}: holds no table of tests; its header needs either lower_g and upper_g or lower_m_s2 and "
            "upper_m_s2."
        )
    bounds = f"lower_{units[0]}", f"upper_{units[0]}"
    tests = []
    seen: dict[tuple[object, object], int] = {}
    for row in read_rows(path, (*_TEXT, "repetition", *bounds), _OPTIONAL, least=0):
        test = _test(row, bounds, _IN_G[units[0]])
        key = (test["test"], test["repetition"])
        if key in seen:
            raise row.error(
                "test",
                f"{key[0]!r}, repetition {key[1]}, is on line {seen[key]} already; give each repetition its own "
                "number",
            )
        seen[key] = row.line
        tests.append(test)
    return as_tests_table(tests)


def _test(row: Row, bounds: tuple[str, str], in_g: float) -> dict[str, object]:
    """A test of a row of a table, its amplitudes in g."""
    for column, known in _CHOICES.items():
        if row.cells[column] not in known:
            choice = ", ".join(name or "nothing" for name in known)
            raise row.error(
                column, f"must be one of {choice}, got {row.cells[column]!r}"
            )
    censored, body = row.cells["censored"] == "right", row.cells["overturned_body"]
    lower, upper = _bounds(row, *bounds, censored)
    if (body == "") != censored:
        raise row.error(
            "overturned_body",
            "names what overturned, and is empty only where nothing did",
        )
    if body == "pedestal" and row.cells["pedestal"] == "NP":
        raise row.error("overturned_body", "is pedestal in a test without one")
    repetition = row.number("repetition", above=0)
    if repetition != int(repetition):
        raise row.error(
            "repetition", f"must be a whole number from 1, got {repetition:g}"
        )
    texts = {name: row.text(name) for name in ("test", "object", "earthquake", "floor")}
    motion = row.cells.get("motion") or f"{texts['earthquake']}_{texts['floor']}"
    return {
        **{name: row.cells[name] for name in _TEXT},
        "motion": motion,
        "lower_g": lower * in_g,
        "upper_g": upper * in_g,
        "amplitude_g": _reported(row, lower * in_g, censored),
        "repetition": int(repetition),
        "remark": row.cells.get("remark", ""),
        "definition": "measured",
    }


def _bounds(row: Row, low: str, high: str, censored: bool) -> tuple[float, float]:
    """Bounds of the overturning amplitude [g], the upper one NaN where the test is ``censored``.

    ``low``, ``high``: their columns in the row.
    """
    lower = row.number(low)
    if lower < 0:
        raise row.error(low, f"must be zero or more, got {row.cells[low]}")
    if censored and row.has(high):
        raise row.error(high, "must be empty where the test is censored")
    upper = math.nan if censored else row.number(high, above=0)
    if upper < lower:
        raise row.error(high, f"must not be below {low} ({lower:g}), got {upper:g}")
    return lower, upper


def _reported(row: Row, lower_g: float, censored: bool) -> float:
    """Figure of the laboratory [g]: its own column, else the largest amplitude survived."""
    figures = [
        row.number(f"amplitude_{unit}", above=0) * in_g
        for unit, in_g in _IN_G.items()
        if row.has(f"amplitude_{unit}")
    ]
    if len(figures) > 1:
        raise row.error("amplitude_m_s2", "must be empty where amplitude_g is given")
    if censored:
        if figures:
            raise row.error("amplitude_g", "must be empty where the test is censored")
        return math.nan
    return figures[0] if figures else (lower_g if lower_g > 0 else math.nan)
