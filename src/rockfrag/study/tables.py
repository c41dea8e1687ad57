"""Reading small CSV tables of a study with errors that name the row and the column."""

import csv
import math
import os
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from rockfrag.errors import InputError


@dataclass(frozen=True)
class Row:
    """One row of a table: its cells by column, and where it stands."""

    path: str
    line: int
    cells: dict[str, str]

    def error(self, column: str, what: str) -> InputError:
        """Return an error about one cell, to be raised."""
        return InputError(f"{self.path}, line {self.line}, column {column}: {what}.")

    def text(self, column: str) -> str:
        """Return a cell that must not be empty."""
        value = self.cells.get(column, "")
        if not value:
            raise self.error(column, "expected a name, found nothing")
        return value

    def positive(self, column: str) -> float:
        """Return a cell that must be a finite number above zero."""
        value = self.number(column)
        if value <= 0:
            raise self.error(column, f"expected a number above 0, found {self.cells[column]}")
        return value

    def number(self, column: str) -> float:
        """Return a cell that must be a finite number."""
        text = self.cells.get(column, "")
        try:
            value = float(text)
        except ValueError:
            value = math.nan
        if not math.isfinite(value):
            raise self.error(column, f"expected a number, found {text or 'nothing'}")
        return value


def read_rows(
    path: str | os.PathLike[str], required: Iterable[str], optional: Iterable[str] = ()
) -> list[Row]:
    """Read a CSV file with a header line; lines that start with ``#`` are comments.

    Raises
    ------
    InputError
        If the file cannot be read, has no rows, lacks a required column, has one that is not known,
        or a row has more or fewer cells than the header.
    """
    needed, known = list(required), [*required, *optional]
    try:
        text = Path(path).read_text(encoding="utf-8")
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror}).") from error
    except UnicodeDecodeError as error:
        raise InputError(f"{path}: is not UTF-8 text (byte {error.start}).") from error
    lines = [
        (number, line)
        for number, line in enumerate(text.lstrip("\ufeff").splitlines(), start=1)
        if line.strip() and not line.startswith("#")
    ]
    try:
        parsed = [next(csv.reader([line], strict=True)) for _, line in lines]
    except csv.Error as error:
        raise InputError(f"{path}: is not a readable CSV file ({error}).") from error
    if len(parsed) < 2:
        raise InputError(f"{path}: expected a header line and at least one row, found none.")
    header = [cell.strip() for cell in parsed[0]]
    for column in header:
        if column not in known:
            raise InputError(
                f"{path}: column {column!r} is not known; expected {', '.join(known)}."
            )
        if header.count(column) > 1:
            raise InputError(f"{path}: column {column!r} is given twice.")
    for column in needed:
        if column not in header:
            raise InputError(f"{path}: column {column} is missing; expected {', '.join(needed)}.")
    rows = []
    for (line, _), cells in zip(lines[1:], parsed[1:], strict=True):
        if len(cells) != len(header):
            raise InputError(
                f"{path}, line {line}: expected {len(header)} cells as in the header, "
                f"found {len(cells)}."
            )
        named = dict(zip(header, (cell.strip() for cell in cells), strict=True))
        rows.append(Row(str(path), line, named))
    return rows
