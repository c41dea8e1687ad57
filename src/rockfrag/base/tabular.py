"""Small tables that users wrote, read with errors that name the line, row and column."""

import csv
import math
import os
import re
from collections.abc import Iterable, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from rockfrag.base.errors import InputError
from rockfrag.base.text_files import read_text
from rockfrag.base.units import other_names, quantity, split_name

if TYPE_CHECKING:
    import pandas as pd

DELIMITERS = (",", ";", "\t")

MOST_BYTES = 64 * 2**20  # size of a table that is read at once


@dataclass(frozen=True)
class Row:
    """One row of a table: its cells by column, and where it stands."""

    # The file and the number of the line in it
    path: str
    line: int
    cells: dict[str, str]  # Texts by the usual name of their column
    # Names of the columns as the file has them, where they differ
    titles: dict[str, str] = field(default_factory=dict)

    def error(self, column: str, what: str) -> InputError:
        """Return an error about one cell, to be raised."""
        title = self.titles.get(column, column)
        return InputError(
            f"{self.path}, line {self.line}, column {title}: {what.rstrip('.')}."
        )

    def has(self, column: str) -> bool:
        """Whether a cell holds anything."""
        return bool(self.cells.get(column))

    def text(self, column: str) -> str:
        """Return a cell that must not be empty."""
        value = self.cells.get(column, "")
        if not value:
            raise self.error(column, "expected a name, found nothing")
        return value

    def number(self, column: str, above: float = -math.inf) -> float:
        """Return a cell that must be a finite number above another."""
        text = self.cells.get(column, "")
        value = math.nan
        with suppress(ValueError):
            value = float(text)
        if not math.isfinite(value):
            raise self.error(column, f"expected a number, found {text or 'nothing'}")
        if value <= above:
            raise self.error(column, f"expected a number above {above:g}, found {text}")
        return value

    def quantity(self, column: str, above: float = -math.inf) -> float:
        """Return a cell in the unit of the column's usual name, whatever unit it is given in, above a number."""
        usual = split_name(column)[1]
        text = self.cells.get(column, "")
        if not text:
            raise self.error(column, f"expected a number of {usual}, found nothing")
        unit = other_names(column)[self.titles.get(column, column)]
        try:
            value = quantity(text, usual, unit)
        except InputError as error:
            raise self.error(column, str(error)) from None
        if value <= above:
            raise self.error(column, f"expected more than {above:g}, found {text}")
        return value


@dataclass(frozen=True)
class TextTable:
    """Cells of a CSV file, none of which are lines of separators alone, as spreadsheets leave."""

    path: str
    titles: list[str]  # empty where there is no header line
    body: list[tuple[int, list[str]]]  # number and cells of each line below it

    def rows(self, names: Sequence[str], faults: list[str] | None = None) -> list[Row]:
        """Return the rows with their cells by the usual names of the columns.

        A row with too few or too many cells adds a sentence to ``faults`` and is left out; without that list the
        table is refused.
        """
        for name, title in zip(names, self.titles, strict=True):
            if names.count(name) > 1:
                raise InputError(f"{self.path}: column {title!r} is given twice.")
        pairs = zip(names, self.titles, strict=True)
        titles = {name: title for name, title in pairs if name != title}
        rows = []
        for line, cells in self.body:
            if len(cells) == len(names):
                rows.append(
                    Row(self.path, line, dict(zip(names, cells, strict=True)), titles)
                )
                continue
            fault = (
                f"{self.path}, line {line}: expected {len(names)} cells as in the header, found "
                f"{len(cells)}; a text that holds the separator needs double quotes."
            )
            if faults is None:
                raise InputError(fault)
            faults.append(fault)
        return rows


def read_rows(
    path: str | os.PathLike[str],
    required: Iterable[str],
    optional: Iterable[str] = (),
    *,
    quantities: Sequence[str] = (),
    least: int = 1,
    faults: list[str] | None = None,
) -> list[Row]:
    """Read a CSV file with a header line; lines that start with ``#`` are comments.

    Cells are separated by commas, semicolons or tabulators. Columns among ``quantities`` may be given in any
    unit: ``width_m`` stands for ``width_cm`` too, or for ``width`` with the unit in each cell. A row with too few
    or too many cells adds a sentence to ``faults`` and is left out; without that list the table is refused.

    Parameters
    ----------
    path : of the file
    required, optional : usual names of the columns that must, and that may, be there
    quantities : names among them that end in a unit
    least : number of rows that there must be
    faults : takes the sentences on rows that are left out

    Returns
    -------
    The rows, in the order of the file.
    """
    needed, known = list(required), [*required, *optional]
    table = read_table(path)
    if not table.titles or len(table.body) < least:
        raise InputError(
            f"{path}: expected a header line and {least} rows or more, found "
            f"{bool(table.titles) + len(table.body)} lines."
        )
    usual = {other: name for name in quantities for other in other_names(name)}
    names = [usual.get(title, title) for title in table.titles]
    for name, title in zip(names, table.titles, strict=True):
        if name not in known:
            raise InputError(
                f"{path}: column {title[:60]!r} is not known; expected {', '.join(known)}."
            )
    rows = table.rows(names, faults)
    for name in needed:
        if name not in names:
            raise InputError(
                f"{path}: column {name} is missing; expected {', '.join(needed)}."
            )
    return rows


_DECIMAL_COMMA = re.compile(r"\s*([-+]?\d+),(\d+(?:[eE][-+]?\d+)?\s*[^\d,]*\d?)\s*")


def _with_point(cell: str) -> str:
    """A cell of a table that needs no commas: where a number has one, it is that of the decimals."""
    found = _DECIMAL_COMMA.fullmatch(cell)
    return f"{found[1]}.{found[2].strip()}" if found else cell.strip()


def read_table(path: str | os.PathLike[str], text: str | None = None) -> TextTable:
    """Read the cells of a CSV file, or of its text; empty lines and comments are left out.

    Parameters
    ----------
    path : of the file, which messages name
    text : what the file holds, if that has been read; None: it is read

    Returns
    -------
    The :class:`TextTable`.
    """
    content = read_text(path, MOST_BYTES) if text is None else text
    numbered = [
        (number, line)
        for number, line in enumerate(content.splitlines(), start=1)
        if line.strip() and not line.startswith("#")
    ]
    delimiter = max(DELIMITERS, key=numbered[0][1].count) if numbered else ","
    # whoever separates cells by semicolons does so because numbers there have commas
    point = _with_point if delimiter == ";" else str.strip
    try:
        lines = [
            (
                number,
                [point(cell) for cell in next(csv.reader([line], delimiter=delimiter))],
            )
            for number, line in numbered
        ]
    except csv.Error as error:
        raise InputError(f"{path}: is not a readable CSV file ({error}).") from error
    (_, titles), *body = [(line, cells) for line, cells in lines if any(cells)] or [
        (0, [])
    ]
    return TextTable(str(path), titles, body)


def join_rows(tables: "Sequence[pd.DataFrame]") -> "pd.DataFrame":
    """Put the rows of tables with the same columns below each other, numbered anew.

    A table without rows has columns without types, which columns of numbers would take over; it counts only if
    none has any.

    Parameters
    ----------
    tables : with the same columns, at least one

    Returns
    -------
    The table with the rows of all, whose index is 0, 1, …
    """
    import pandas as pd

    return pd.concat(
        [table for table in tables if len(table)] or tables, ignore_index=True
    )
