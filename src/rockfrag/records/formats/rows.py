"""Rows of several numbers with no header: a series in rows, or columns without titles.

Where the first column rises evenly it is the time, and the others are channels named by the number
of their column. Else the numbers are one series, row after row, as OpenSees reads them, and the
interval is the user's. The unit is always the user's.
"""

import re

import numpy as np

from rockfrag.records.formats import columns
from rockfrag.records.headed_formats import HEADED
from rockfrag.records.parsing.channel import Channel
from rockfrag.records.parsing.format import Format
from rockfrag.records.parsing.fortran_sections import positive_step
from rockfrag.records.parsing.number_table import (
    MAX_HEADER,
    is_row,
    number_in,
    number_table,
    numbers_of,
    width_of,
)
from rockfrag.records.parsing.text_file import TextFile, is_remark, last_row
from rockfrag.records.parsing.timestamps import step_of_times

_TITLES = re.compile(r"\b(?:acc|vel|disp|time)", re.IGNORECASE)
_LEAST, _MOST = 3, 40
_MIN_ROWS = 3
_MAX_WORDS = 2
_UNEVEN = 0.02


def _recognise(lines: list[str], name: str) -> bool:
    table = number_table(lines)
    if table is None or table.npts is not None or not _LEAST <= table.columns <= _MOST:
        return False
    rows = [line for line in lines[table.start :] if line.strip()]
    while rows and is_remark(rows[-1]):
        rows.pop()
    widths = [width_of(line) for line in rows]
    return (
        len(rows) >= _MIN_ROWS
        and table.free <= _MAX_WORDS
        and all(is_row(line) for line in rows)
        and set(widths[:-1]) == {table.columns}
        and widths[-1] <= table.columns
        and not any(headed.recognise(lines, name) for headed in HEADED)
        and not columns.FORMAT.recognise(lines, name)
    )


def _parse(text: TextFile, dt: float | None = None) -> list[Channel]:
    table = number_table(text.lines(0, MAX_HEADER + 1))
    if table is None:
        text.fail("no rows of numbers below a short header", 0)
    stop = last_row(text, table.start)
    if _is_timed([numbers_of(line) for line in text.lines(table.start, table.start + 50)]):
        if any(_TITLES.search(words) for words in table.words):
            text.fail(
                f"{table.words[-1][:80]!r} cannot be told apart into {table.columns} titles of columns; "
                "separate them as the numbers are",
                table.start - 1,
            )
        values = text.table(table.start, table.columns, stop)
        step = step_of_times(values[:, 0], text, table.start) if dt is None else dt
        return [
            Channel(
                npts=values.shape[0],
                dt=positive_step(text, step, table.start),
                samples=values[:, column].copy,
                component=f"column {column + 1}",
            )
            for column in range(1, table.columns)
        ]
    step = dt if dt is not None else table.dt or 0.0
    if not step:
        text.fail("rows of numbers without sampling interval; give it with dt= (in seconds)")
    series = text.numbers(table.start, stop)
    return [
        Channel(
            npts=series.size,
            dt=positive_step(text, step, table.start),
            samples=series.copy,
            details={"title": table.title},
        )
    ]


def _is_timed(rows: list[list[str]]) -> bool:
    """Tell whether the first numbers of the rows rise by equal steps."""
    try:
        times = np.array([number_in(row[0]) for row in rows if row])
    except ValueError:
        return False
    steps = np.diff(times)
    return bool(steps.size > 1 and steps.min() > 0 and np.ptp(steps) <= _UNEVEN * steps.mean())


FORMAT = Format("ROWS", _recognise, _parse, wants_dt=True)
is_format, read = FORMAT.is_format, FORMAT.read
