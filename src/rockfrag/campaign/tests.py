"""The table of a campaign: one row a test, what the table was told to do and what the object did."""

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd

from rockfrag.errors import InputError
from rockfrag.fragility.user_table import (
    label_column,
    number_column,
    read_text_table,
    verdict_column,
)

MEASURED = "overturned"
"""Column of what the laboratory saw."""


@dataclass(frozen=True)
class Campaign:
    """Tests of one object on a shake table.

    Attributes
    ----------
    tests
        One row a test: ``test`` (its name), ``motion`` (key or file of the table's motion), ``group``
        (tests of one input motion share it), ``overturned`` (bool), ``amplitude_g`` (peak to which the motion
        is scaled, NaN for as recorded) and a column per intensity measure.
    measures
        Names of the columns with intensity measures.
    codes
        Verdicts of other programs, a bool column each, a row per row of ``tests``.
    """

    tests: pd.DataFrame
    measures: tuple[str, ...]
    codes: pd.DataFrame

    def only(self, keep: "pd.Series[bool]") -> "Campaign":
        """Return the campaign with some of its tests."""
        chosen = keep.to_numpy()
        return Campaign(
            self.tests[chosen].reset_index(drop=True),
            self.measures,
            self.codes[chosen].reset_index(drop=True),
        )


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
        Its columns: ``test`` and ``motion``; either ``overturned`` (yes or no) or ``lower_g`` and ``upper_g``, the
        largest peak survived and the one that overturned, which make two tests; ``group`` where tests of one
        input motion share a name, else the motion; ``amplitude_g`` where motions are scaled to a peak.
    measures
        For each intensity measure the columns and numbers whose product it is.
    other_codes
        CSV with the column of test names and one column of verdicts per program.

    Raises
    ------
    InputError
        If a file cannot be read, a column or a value is missing or cannot be used, or a test stands twice.
    """
    raw, source = read_text_table(path), Path(path).name
    motion = label_column(raw, columns["motion"], source)
    tests = pd.DataFrame(
        {
            "test": label_column(raw, columns["test"], source),
            "motion": motion,
            "group": label_column(raw, columns["group"], source) if "group" in columns else motion,
        }
    )
    doubled = tests["test"][tests["test"].duplicated()]
    if len(doubled):
        raise InputError(f"{source}: test {doubled.iloc[0]} stands twice; keep one row a test.")
    for name, factors in measures.items():
        values = [
            number_column(raw, one, source, above_zero=True) if isinstance(one, str) else float(one)
            for one in factors
        ]
        tests[name] = np.prod(np.broadcast_arrays(*values, np.ones(len(raw))), axis=0)
    tests = _with_verdicts(tests, raw, columns, source)
    return Campaign(tests, tuple(measures), _codes(other_codes, columns["test"], tests["test"]))


def _with_verdicts(
    tests: pd.DataFrame, raw: pd.DataFrame, columns: Mapping[str, str], source: str
) -> pd.DataFrame:
    """Add verdict and amplitude; an amplitude of overturning makes one test survived and one overturned."""
    if "overturned" in columns:
        tests[MEASURED] = verdict_column(raw, columns["overturned"], source).astype(bool)
        tests["amplitude_g"] = np.nan
        if "amplitude_g" in columns:
            tests["amplitude_g"] = number_column(
                raw, columns["amplitude_g"], source, above_zero=True
            )
        return tests
    parts = []
    for key, fell in (("lower_g", False), ("upper_g", True)):
        amplitude = number_column(raw, columns[key], source, above_zero=True)
        names = [f"{test} at {a:g} g" for test, a in zip(tests["test"], amplitude, strict=True)]
        part = tests.assign(test=names, amplitude_g=amplitude)
        part[MEASURED] = fell
        parts.append(part)
    wrong = np.flatnonzero(parts[0]["amplitude_g"] >= parts[1]["amplitude_g"])
    if wrong.size:
        raise InputError(
            f"{source}, row {wrong[0] + 2}: lower_g is not below upper_g; the object overturned between them."
        )
    return pd.concat(parts, ignore_index=True)


def _codes(
    path: str | os.PathLike[str] | None, column: str, tests: "pd.Series[str]"
) -> pd.DataFrame:
    """Verdicts of other programs in the order of the tests."""
    if path is None:
        return pd.DataFrame(index=range(len(tests)))
    table, source = read_text_table(path), Path(path).name
    names = label_column(table, column, source)
    absent = sorted(set(tests) - set(names))
    if absent:
        raise InputError(
            f"{source}: has no verdict for {len(absent)} of {len(tests)} tests, {absent[0]} first."
        )
    verdicts = {
        name: verdict_column(table, name, source).astype(bool)
        for name in map(str, table.columns)
        if name != column
    }
    return pd.DataFrame(verdicts, index=names).loc[list(tests)].reset_index(drop=True)
