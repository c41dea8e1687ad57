"""The table of a campaign: one row a test, what the table was told to do and what the object did."""

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd

from rockfrag.errors import InputError
from rockfrag.fragility.tests_file import product_of, read_columns, read_titles
from rockfrag.short_repr import short_repr

MEASURED = "overturned"
"""Column of what the laboratory saw."""

NOTED = ("rocked", "slid")
"""Columns of what a laboratory may have noted besides."""


@dataclass(frozen=True)
class Campaign:
    """Tests of one object on a shake table."""

    # one row a test: ``test`` (its name), ``motion`` (key or file of the table's motion), ``group`` (tests of one
    # input motion share it), ``overturned`` (bool), ``amplitude_g`` (peak to which the motion is scaled, NaN for
    # as recorded) and a column per intensity measure
    tests: pd.DataFrame
    measures: tuple[str, ...]  # names of the columns with intensity measures
    # outcomes of other programs, a bool column each, a row per row of ``tests``
    codes: pd.DataFrame

    __repr__ = short_repr

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
    """Read a table of tests, one row a test, and, if there is one, a table of other programs' outcomes by test.

    ``columns`` are ``test`` and ``motion`` (without it the measures of a test name its motion); either
    ``overturned`` (yes or no) or ``lower_g`` and ``upper_g``, the largest peak survived and the one that
    overturned, which make two tests; ``group`` where tests of one input motion share a name, else the motion;
    ``amplitude_g`` where motions are scaled to a peak; ``rocked``, ``slid`` (yes or no) and ``which_way`` (text)
    where the laboratory noted them. ``measures`` has for each intensity measure the columns and numbers whose
    product it is.
    """
    source = Path(path).name
    factors = [part for recipe in measures.values() for part in recipe if isinstance(part, str)]
    keys = {
        "label": ("test", "motion", "group", "which_way"),
        "positive": ("amplitude_g", "lower_g", "upper_g"),
        "outcome": (MEASURED, *NOTED),
    }
    kinds = {columns[key]: kind for kind, some in keys.items() for key in some if key in columns}
    raw = read_columns(path, dict.fromkeys(factors, "positive") | kinds)
    tests = pd.DataFrame(
        {
            "test": raw[columns["test"]],
            "motion": raw[columns["motion"]] if "motion" in columns else "",
        }
    )
    tests["group"] = raw[columns["group"]] if "group" in columns else tests["motion"]
    doubled = tests["test"][tests["test"].duplicated()]
    if len(doubled):
        raise InputError(f"{source}: test {doubled.iloc[0]} stands twice; keep one row a test.")
    for name, recipe in measures.items():
        tests[name] = product_of(raw, recipe)
    if "motion" not in columns:
        tests["motion"] = settings_of(tests, list(measures))
        tests["group"] = raw[columns["group"]] if "group" in columns else tests["motion"]
    for key in NOTED:
        if key in columns:
            tests[key] = raw[columns[key]].astype(bool)
    if "which_way" in columns:
        tests["which_way"] = raw[columns["which_way"]]
    tests = _with_outcomes(tests, raw, columns, source)
    return Campaign(tests, tuple(measures), _codes(other_codes, columns["test"], tests["test"]))


def settings_of(tests: pd.DataFrame, measures: Sequence[str]) -> list[str]:
    """Name of each test's setting, its measures in words, which tests that repeat it share."""
    rows = tests[list(measures)].to_numpy().tolist()
    return [", ".join(f"{m} {v:g}" for m, v in zip(measures, row, strict=True)) for row in rows]


def _with_outcomes(
    tests: pd.DataFrame, raw: pd.DataFrame, columns: Mapping[str, str], source: str
) -> pd.DataFrame:
    """Add outcome and amplitude; an amplitude of overturning makes one test survived and one overturned."""
    if "overturned" in columns:
        tests[MEASURED] = raw[columns["overturned"]].astype(bool)
        tests["amplitude_g"] = raw[columns["amplitude_g"]] if "amplitude_g" in columns else np.nan
        return tests
    parts = []
    for key, fell in (("lower_g", False), ("upper_g", True)):
        amplitude = raw[columns[key]]
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
    """Outcomes by other programs in the order of the tests, as far as they are given: 1, 0, or NaN for none."""
    if path is None:
        return pd.DataFrame(index=range(len(tests)))
    source = Path(path).name
    names = [name for name in read_titles(path) if name != column]
    table = read_columns(path, {column: "label"} | dict.fromkeys(names, "outcome")).set_index(
        column
    )
    if not set(tests) & set(table.index):
        raise InputError(
            f"{source}: has none of the {len(tests)} tests; check that the column {column!r} has their names."
        )
    return table.astype(float).reindex(list(tests)).reset_index(drop=True)
