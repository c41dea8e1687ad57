"""The table of a campaign: one row a test, what the table was told to do and what the object did."""

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import pandas as pd

from rockfrag.errors import InputError
from rockfrag.fragility.user_table import read_tests, read_text_table, verdict_column

MEASURED = "overturned"
"""Column of what the laboratory saw."""


@dataclass(frozen=True)
class Campaign:
    """Tests of one object on a shake table.

    Attributes
    ----------
    tests
        One row a test: ``test`` (its name), ``motion`` (key or file of the table's motion), ``group``
        (tests of one input motion share it), ``overturned`` (bool) and a column per intensity measure.
    measures
        Names of the columns with intensity measures.
    codes
        Verdicts of other programs, a bool column each, a row per row of ``tests``.
    """

    tests: pd.DataFrame
    measures: tuple[str, ...]
    codes: pd.DataFrame


def read_campaign(
    path: str | os.PathLike[str],
    columns: Mapping[str, str],
    measures: Mapping[str, Sequence[str | float]],
    other_codes: str | os.PathLike[str] | None = None,
) -> Campaign:
    """Read a table of tests and, if there is one, a table of other programs' verdicts.

    Parameters
    ----------
    path
        CSV with one row a test.
    columns
        Its columns: ``test``, ``overturned``, ``motion`` and ``group``.
    measures
        For each intensity measure the columns and numbers whose product it is.
    other_codes
        CSV with the column of test names and one column of verdicts per program.

    Raises
    ------
    InputError
        If a file cannot be read, a column or a value is missing or cannot be used, or a test stands twice.
    """
    source = Path(path).name
    read = read_tests(
        path,
        measures,
        overturned=columns["overturned"],
        motion=columns["motion"],
        event=columns["group"],
        keep=(columns["test"],),
    )
    tests = pd.DataFrame(
        {
            "test": read[columns["test"]],
            "motion": read["motion"],
            "group": read["event"],
            MEASURED: read["overturned"].astype(bool),
            **{name: read[name] for name in measures},
        }
    )
    doubled = tests["test"][tests["test"].duplicated()]
    if len(doubled):
        raise InputError(f"{source}: test {doubled.iloc[0]} stands twice; keep one row a test.")
    return Campaign(tests, tuple(measures), _codes(other_codes, columns["test"], tests["test"]))


def _codes(
    path: str | os.PathLike[str] | None, column: str, tests: "pd.Series[str]"
) -> pd.DataFrame:
    """Verdicts of other programs in the order of the tests."""
    if path is None:
        return pd.DataFrame(index=range(len(tests)))
    table = read_text_table(path)
    source = Path(path).name
    if column not in table:
        raise InputError(f"{source}: there is no column {column!r} with the names of the tests.")
    table = table.set_index(table[column].str.strip()).drop(columns=column)
    absent = [name for name in tests if name not in table.index]
    if absent:
        raise InputError(f"{source}: has no verdict for test {absent[0]} and {len(absent) - 1} others.")
    return pd.DataFrame(
        {name: verdict_column(table, name, source).astype(bool) for name in table}, index=table.index
    ).loc[list(tests)].reset_index(drop=True)
