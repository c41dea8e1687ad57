"""Somebody's own table of tests as a text file, read in pieces so that its length does not matter.

Commas, semicolons and tabs, decimal commas, comments above the header (lines that start with ``#``), UTF-8,
UTF-16 and Western European text are understood; what
is not is refused in one sentence that names file, row (the header is row 1) and column.
"""

import csv
import os
import warnings
from collections.abc import Callable, Generator, Mapping, Sequence
from contextlib import closing
from pathlib import Path

import numpy as np
import pandas as pd

from rockfrag.errors import InputError
from rockfrag.fragility import observations
from rockfrag.fragility.observations import Floats, name_and_unit
from rockfrag.tabular import table_encoding
from rockfrag.units import DIMENSIONS, LARGEST_PEAK, convert

ROWS = 100_000  # rows that are read at a time
Measures = Mapping[str, Sequence[str | float]] | Sequence[str]
"""Columns with measures, or for each new column the columns and numbers whose product it is."""

_YES = {
    *("1", "true", "yes", "y", "overturned", "toppled", "fell"),
    *("ja", "wahr", "oui", "vrai", "si", "sì", "vero", "sí", "verdadero"),
}
_NO = {*("0", "false", "no", "n", "survived", "stood"), *("nein", "falsch", "non", "faux", "falso")}
_DIMENSIONLESS = ("uplift_ratio", "velocity_ratio")


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

    The result has ``motion``, ``earthquake`` (text), ``overturned`` (0 or 1), the measures (above zero) and the
    numbers ``given``. Without columns of motion and earthquake every row is a motion of its own.
    """
    source = Path(path).name
    recipes: dict[str, Sequence[str | float]] = (
        dict(measures) if isinstance(measures, Mapping) else {name: [name] for name in measures}
    )
    if not recipes:
        raise InputError("measures: name at least one column with an intensity measure.")
    for name in recipes:
        if not name_and_unit(name)[1] and not name.startswith(_DIMENSIONLESS):
            raise InputError(
                f"measures, {name!r}: the name does not tell a unit; end it with one, such as pga_g, "
                f"pgv_cm_s or sa_0_3s_g (write {name}_g: [{name}] for a column of the file in g)."
            )
    factors = [
        factor for recipe in recipes.values() for factor in recipe if isinstance(factor, str)
    ]
    labels = [name for name in (motion, earthquake) if name is not None]
    needed = list(dict.fromkeys([overturned, *labels, *factors, *given]))

    def columns(read: _Numbers) -> dict[str, object]:
        return {
            "motion": read.labels(motion),
            "earthquake": read.labels(earthquake if earthquake is not None else motion),
            "overturned": read.outcomes(overturned),
            **{name: read.product(recipe) for name, recipe in recipes.items()},
            **{name: read.numbers(name) for name in given},
        }

    table = _read(path, needed, columns)
    for name in recipes:
        _warn_of_peaks(table, name, source)
    return table


def _warn_of_peaks(table: pd.DataFrame, name: str, source: str) -> None:
    """Warn if peaks of a motion look as if they were given in another unit than their title says."""
    measure, _, unit = name.partition("_")
    for dimension, measures, si, (least, most) in _PEAKS:
        if measure not in measures or unit not in DIMENSIONS[dimension]:
            continue
        peak = float(table[name].max())
        if not least <= convert(peak, unit, si) <= most:
            odd = (
                "more than any table or earthquake has shaken"
                if convert(peak, unit, si) > most
                else "too little to overturn any free-standing object"
            )
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
    path: str | os.PathLike[str],
    *,
    labels: Sequence[str] = (),
    positive: Sequence[str] = (),
    outcomes: Sequence[str] = (),
) -> pd.DataFrame:
    """Read columns of a table of tests: of text, of numbers above zero, and of outcomes (0 and 1)."""

    def columns(read: _Numbers) -> dict[str, object]:
        return {
            **{name: read.labels(name) for name in labels},
            **{name: read.product([name]) for name in positive},
            **{name: read.outcomes(name) for name in outcomes},
        }

    return _read(path, list(dict.fromkeys([*labels, *positive, *outcomes])), columns)


def _read(
    path: str | os.PathLike[str],
    needed: Sequence[str],
    columns: Callable[["_Numbers"], dict[str, object]],
) -> pd.DataFrame:
    """Read the needed columns piece by piece, each by its own reader."""
    source = Path(path).name
    parts, first = [], 2
    with closing(_pieces(path, source, needed)) as pieces:
        for piece, decimal_comma in pieces:
            parts.append(pd.DataFrame(columns(_Numbers(piece, source, first, decimal_comma))))
            first += len(piece)
    if not any(map(len, parts)):
        raise InputError(f"{source}: there is no row below the header; give at least one test.")
    return pd.concat(parts, ignore_index=True)


def read_titles(path: str | os.PathLike[str]) -> list[str]:
    """Return the titles of the columns of a table of tests."""
    source = Path(path).name
    encoding = table_encoding(path)
    head = _head(path, encoding)[1]
    titles = [title.strip() for title in next(csv.reader([head], delimiter=_separator(head)), [])]
    if not any(titles):
        raise InputError(f"{source}: not a readable CSV table (it has no header); mend the file.")
    return titles


def _head(path: str | os.PathLike[str], encoding: str) -> tuple[int, str]:
    """Return the number of comments, lines that start with ``#``, before the header, and the header."""
    comments = 0
    try:
        with open(path, encoding=encoding, newline="") as file:
            for line in file:
                if not line.startswith("#"):
                    return comments, line
                comments += 1
    except UnicodeError as error:
        raise InputError(
            f"{Path(path).name}: is not text in one encoding; save the table as CSV (UTF-8)."
        ) from error
    return comments, ""


def _separator(head: str) -> str:
    return max(",;\t", key=head.count)


def _pieces(
    path: str | os.PathLike[str], source: str, needed: Sequence[str]
) -> Generator[tuple[pd.DataFrame, bool], None, None]:
    """Yield the needed columns as text, piece by piece, and whether a comma may be a decimal point."""
    encoding = table_encoding(path)
    titles = read_titles(path)
    comments, head = _head(path, encoding)
    separator = _separator(head)
    places = []
    for name in needed:
        if name not in titles:
            raise InputError(
                f"{source}: there is no column {name!r}; the file has {', '.join(titles)}."
            )
        if titles.count(name) > 1:
            raise InputError(
                f"{source}: the title {name!r} stands over {titles.count(name)} columns; rename the one "
                "that is not meant."
            )
        places.append(titles.index(name))
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error", pd.errors.ParserWarning)
            reader = pd.read_csv(
                path,
                header=None,
                names=range(len(titles)),
                skiprows=comments + 1,
                dtype=str,
                index_col=False,
                sep=separator,
                encoding=encoding,
                skipinitialspace=True,
                chunksize=ROWS,
            )
            with reader:
                for piece in reader:
                    yield piece[places].set_axis(list(needed), axis=1), separator != ","
    except pd.errors.EmptyDataError:
        return
    except (pd.errors.ParserError, pd.errors.ParserWarning, UnicodeError) as error:
        reason = str(error).splitlines()[0]
        raise InputError(
            f"{source}: not a readable CSV table ({reason}); if its numbers have decimal commas, separate "
            "the columns by semicolons."
        ) from error


class _Numbers:
    """One piece of the table, and how to read its columns; ``first`` is the number of its first row."""

    def __init__(self, piece: pd.DataFrame, source: str, first: int, decimal_comma: bool) -> None:
        self.piece, self.where = piece, (source, first)
        self.decimal_comma = decimal_comma

    def labels(self, column: str | None) -> list[str]:
        """Text of a column; the row's own label where there is no column."""
        found = observations.labels(self.piece, column, *self.where)
        return [str(value).strip() for value in found]

    def _numeric(self, column: str) -> pd.DataFrame:
        """A column as text of numbers that have points."""
        text: pd.DataFrame = self.piece[[column]].apply(lambda values: values.str.strip())
        return text.replace(",", ".", regex=True) if self.decimal_comma else text

    def numbers(self, column: str) -> Floats:
        """Column as finite numbers, shape (rows,)."""
        return observations.numbers(self._numeric(column), column, *self.where)

    def product(self, recipe: Sequence[str | float]) -> Floats:
        """Product of columns and numbers, above zero because it enters by its logarithm, (rows,)."""
        result = np.ones(len(self.piece))
        for factor in recipe:
            if isinstance(factor, str):
                numeric = self._numeric(factor)
                result = result * observations.positive(numeric, factor, *self.where)
            else:
                result = result * float(factor)
        return result

    def outcomes(self, column: str) -> Floats:
        """Outcomes as 0 and 1, shape (rows,)."""
        text = self.piece[column].fillna("").str.strip().str.lower()
        text = text.str.replace(r"^([01])[.,]0*$", r"\1", regex=True)
        known = text.isin(_YES | _NO).to_numpy()
        if not known.all():
            row = int(np.flatnonzero(~known)[0])
            source, first = self.where
            raise InputError(
                f"{source}, row {first + row}, column {column!r}: {self.piece[column].iloc[row]!r} is no outcome; "
                "write 1 or yes for overturned, 0 or no for survived."
            )
        return np.asarray(text.isin(_YES), dtype=np.float64)
