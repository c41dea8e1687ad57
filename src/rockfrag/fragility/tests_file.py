"""Somebody's own table of tests as a text file.

In: a CSV file, a row a test, and the columns that are wanted. Out: a table with ``motion``, ``earthquake``,
``overturned`` (0 or 1) and the measures in the units of their names. Docs: ``docs/fragility.md``, "A user's
table".

Commas, semicolons and tabs, decimal commas, comments above the header (lines that start with ``#``), UTF-8,
UTF-16 and Western European text are understood; messages name file, row (the header is row 1) and column.
"""

import csv
import os
import warnings
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from rockfrag.base.errors import InputError
from rockfrag.base.plausible import LARGEST_PEAK
from rockfrag.base.text_files import table_encoding
from rockfrag.base.units import DIMENSIONS, convert
from rockfrag.fragility import observations
from rockfrag.fragility.observations import Floats, name_and_unit

Measures = Mapping[str, Sequence[str | float]] | Sequence[str]
"""Columns with measures, or for each new column the columns and numbers whose product it is."""

_YES = {
    *("1", "true", "yes", "y", "overturned", "toppled", "fell"),
    *("ja", "wahr", "oui", "vrai", "si", "sì", "vero", "sí", "verdadero"),
}
_NO = {
    *("0", "false", "no", "n", "survived", "stood"),
    *("nein", "falsch", "non", "faux", "falso"),
}


def read_tests(
    path: str | os.PathLike[str],
    measures: Measures,
    *,
    overturned: str = "overturned",
    motion: str | None = None,
    earthquake: str | None = None,
    given: Sequence[str] = (),
) -> pd.DataFrame:
    """Read a table of tests, one row per test.

    Parameters
    ----------
    path, measures : text file, and its columns of measures, or recipes of them
    overturned, motion, earthquake
        Columns of outcome and labels; without motion and earthquake every row is a motion of its own.
    given : further columns of numbers

    Returns
    -------
    A table with ``motion``, ``earthquake`` (text), ``overturned`` (0 or 1), the measures (above zero) and the
    numbers ``given``.
    """
    recipes = _recipes_of(measures)
    labels = [name for name in (motion, earthquake) if name is not None]
    kinds = dict.fromkeys(labels, "label") | {overturned: "outcome"}
    for recipe in recipes.values():
        kinds |= {part: "positive" for part in recipe if isinstance(part, str)}
    kinds |= {name: "number" for name in given if name not in kinds}
    raw = read_columns(path, kinds)
    motions = (
        raw[motion] if motion is not None else [f"row {row + 2}" for row in raw.index]
    )
    columns: dict[str, object] = {
        "motion": motions,
        "earthquake": motions if earthquake is None else raw[earthquake],
        "overturned": raw[overturned],
    }
    columns |= {name: product_of(raw, recipe) for name, recipe in recipes.items()}
    columns |= {name: raw[name] for name in given}
    table = pd.DataFrame(columns)
    for name in recipes:
        _warn_of_peaks(table, name, Path(path).name)
    return table


def _recipes_of(measures: Measures) -> dict[str, Sequence[str | float]]:
    """Columns and numbers whose product is each measure; names without a unit are refused."""
    recipes: dict[str, Sequence[str | float]] = (
        dict(measures)
        if isinstance(measures, Mapping)
        else {name: [name] for name in measures}
    )
    if not recipes:
        raise InputError(
            "measures: name at least one column with an intensity measure."
        )
    for name in recipes:
        if not name_and_unit(name)[1] and not name.startswith(
            ("uplift_ratio", "velocity_ratio")
        ):
            raise InputError(
                f"measures, {name!r}: the name does not tell a unit; end it with one, such as pga_g, "
                f"pgv_cm_s or sa_0_3s_g (write {name}_g: [{name}] for a column of the file in g)."
            )
    return recipes


def _warn_of_peaks(table: pd.DataFrame, name: str, source: str) -> None:
    """Warn if peaks of a motion look as if they were given in another unit than their title says."""
    measure, _, unit = name.partition("_")
    for dimension, measures, si, (least, most) in _PEAKS:
        if measure not in measures or unit not in DIMENSIONS[dimension]:
            continue
        peak, odd = float(table[name].max()), ""
        if convert(peak, unit, si) > most:
            odd = "more than any table or earthquake has shaken"
        elif convert(peak, unit, si) < least:
            odd = "too little to overturn any free-standing object"
        if odd:
            warnings.warn(
                f"{source}, column {name!r}: the largest is {peak:.4g}, {odd}; mend the unit in the title.",
                stacklevel=3,
            )


_PEAKS = (
    ("acceleration", ("pga", "pfa"), "m_s2", (0.2, LARGEST_PEAK)),
    ("velocity", ("pgv", "pfv"), "m_s", (0.005, 10.0)),
)
"""Plausible largest peaks of a table of tests: below 0.02 g only bodies more slender than 50 rock, and 5 mm/s
overturn nothing taller than a centimetre."""


def read_columns(
    path: str | os.PathLike[str], kinds: Mapping[str, str]
) -> pd.DataFrame:
    """Read columns of a table of tests.

    Parameters
    ----------
    path, kinds : text file, and the kind of each column: ``label``, ``number``, ``positive`` or ``outcome``

    Returns
    -------
    The columns, outcomes as 0 and 1, shape (tests, columns).
    """
    source = Path(path).name
    encoding, comments, separator, titles = _head(path)
    _check_titles(source, titles, kinds)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error", pd.errors.ParserWarning)
            cells = pd.read_csv(
                path,
                header=None,
                names=range(len(titles)),
                skiprows=comments + 1,
                dtype=str,
                index_col=False,
                sep=separator,
                encoding=encoding,
                skipinitialspace=True,
            )
    except (pd.errors.ParserError, pd.errors.ParserWarning, UnicodeError) as error:
        reason = str(error).splitlines()[0]
        raise InputError(
            f"{source}: not a readable CSV table ({reason}); if its numbers have decimal commas, separate "
            "the columns by semicolons."
        ) from error
    if cells.empty:
        raise InputError(
            f"{source}: there is no row below the header; give at least one test."
        )
    found = {}
    for name, kind in kinds.items():
        column = cells[[titles.index(name)]].set_axis([name], axis=1)
        if kind in ("number", "positive"):
            column[name] = column[name].str.strip()
            if separator != ",":
                column[name] = column[name].str.replace(",", ".")
        values = _READERS[kind](column, name, source, 2)
        found[name] = (
            [str(value).strip() for value in values] if kind == "label" else values
        )
    return pd.DataFrame(found)


def _check_titles(source: str, titles: Sequence[str], wanted: Iterable[str]) -> None:
    """Refuse wanted columns that the file does not have, or has several times."""
    for name in wanted:
        if name not in titles:
            raise InputError(
                f"{source}: there is no column {name!r}; the file has {', '.join(titles)}."
            )
        if titles.count(name) > 1:
            raise InputError(
                f"{source}: the title {name!r} stands over {titles.count(name)} columns; rename the one "
                "that is not meant."
            )


def product_of(raw: pd.DataFrame, recipe: Sequence[str | float]) -> Floats:
    """Product of columns and numbers.

    Parameters
    ----------
    raw, recipe : a table, and its columns and the numbers to multiply

    Returns
    -------
    The products, shape (rows,).
    """
    result = np.ones(len(raw))
    for factor in recipe:
        result = result * (
            raw[factor].to_numpy() if isinstance(factor, str) else float(factor)
        )
    return result


def _outcomes(piece: pd.DataFrame, column: str, source: str, first: int) -> Floats:
    """Outcomes of a column, 1 for yes and 0 for no, shape (rows,); other words are refused.

    Parameters
    ----------
    piece : rows of the table, as text
    column : of the outcomes
    source : file that messages name
    first : number of the first of the rows in it
    """
    text = piece[column].fillna("").str.strip().str.lower()
    text = text.str.replace(r"^([01])[.,]0*$", r"\1", regex=True)
    wrong = ~text.isin(_YES | _NO).to_numpy()
    if wrong.any():
        row = int(wrong.argmax())
        raise InputError(
            f"{source}, row {first + row}, column {column!r}: {piece[column].iloc[row]!r} is no outcome; "
            "write 1 or yes for overturned, 0 or no for survived."
        )
    return np.asarray(text.isin(_YES), dtype=np.float64)


_READERS: Mapping[str, Callable[[pd.DataFrame, str, str, int], NDArray[Any]]] = {
    "label": observations.labels,
    "outcome": _outcomes,
    "number": observations.numbers,
    "positive": observations.positive,
}
"""How a column of a piece of the table is read; messages name the file and count rows from that of the piece."""


def read_titles(path: str | os.PathLike[str]) -> list[str]:
    """Titles of the columns of a table of tests.

    Parameters
    ----------
    path : text file

    Returns
    -------
    The titles, in order.
    """
    return _head(path)[-1]


def _head(path: str | os.PathLike[str]) -> tuple[str, int, str, list[str]]:
    """Return encoding, number of comments above the header, separator and titles of a table."""
    source, encoding = Path(path).name, table_encoding(path)
    comments = 0
    try:
        with open(path, encoding=encoding, newline="") as file:
            while (head := next(file, "")).startswith("#"):
                comments += 1
    except UnicodeError as error:
        raise InputError(
            f"{source}: is not text in one encoding; save the table as CSV (UTF-8)."
        ) from error
    separator = max(",;\t", key=head.count)
    titles = [
        title.strip() for title in next(csv.reader([head], delimiter=separator), [])
    ]
    if not any(titles):
        raise InputError(
            f"{source}: not a readable CSV table (it has no header); mend the file."
        )
    return encoding, comments, separator, titles
