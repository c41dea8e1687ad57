"""LabVIEW measurement files (``.lvm``): a general header, one of the channels, titles, rows.

The header of the channels has a cell a channel: ``Samples``, ``Y_Unit_Label``, ``Delta_X``. The last title,
``Comment``, has no column of numbers. National Instruments, "Specification for the LabVIEW Measurement File
(.lvm)".
"""

import re
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rockfrag.records.parsing.column_titles import column_of
from rockfrag.records.parsing.format import Channel, Format, headed
from rockfrag.records.parsing.number_fields import NumberError, parse_separated
from rockfrag.records.parsing.text_file import TextFile
from rockfrag.records.parsing.time_column import TimeColumn

_FIRST = re.compile(r"\s*LabVIEW Measurement\b")
_END = re.compile(r"^\s*\*\*\*End_of_Header\*\*\*")
_SEPARATORS = {"tab": "\t", "comma": ",", "semicolon": ";"}
# columns of times left of the channels
_TIMES = {"": 1, "one": 1, "no": 0}


@dataclass(frozen=True)
class _Measurement:
    """One measurement of a file."""

    text: TextFile
    start: int  # first row of numbers, from zero
    header: dict[str, list[str]]  # cells of each channel, by their key
    titles: list[str]
    rows: NDArray[np.float64]  # shape (n, times + channels)
    times: int  # columns of times, none or one
    clock: str  # date and time, in the words of the file

    def cell(self, key: str, channel: int) -> str:
        """Return what a line of the header says of a channel, or nothing."""
        cells = self.header.get(key, [])
        return cells[channel] if channel < len(cells) else ""

    def channel(self, number: int) -> Channel:
        """Return one channel, from zero."""
        title = self.titles[self.times + number]
        column = column_of(title, self.cell("Y_Unit_Label", number))
        if column.problem:
            self.text.fail(
                f"channel {title!r}: {column.problem}; mend its Y_Unit_Label",
                self.start - 1,
            )
        if promised := self.cell("Samples", number):
            self.text.check_count(int(promised), len(self.rows), self.start)
        words = self.cell("Delta_X", number).replace(",", ".")
        step = self.text.number(words, "no Delta_X in its header", self.start - 2)
        dt = self.text.interval(step, self.start - 2)
        times = TimeColumn(self.rows[:, 0], self.text, self.start)
        return Channel(
            len(self.rows),
            dt,
            self.rows[:, self.times + number].copy(),
            column.unit,
            column.quantity or "acceleration",
            component=column.component,
            details={"title": title, "recorder_time": self.clock},
            steps=times.check(dt, "Delta_X gives") if self.times else (),
        )


def _parse(text: TextFile) -> list[Channel]:
    """Channels of a file of this format, by its header as the head of the module says it."""
    ends = [first for first, _ in text.parts(_END)]
    if len(ends) != 2:
        text.fail(
            f"{len(ends)} headers end in this file, where one measurement has two; save each in a file of its own"
        )
    general = _cells(text, 0, ends[0], "\t")
    mark = _SEPARATORS.get(_first(general, "Separator").lower(), "\t")
    header = _cells(text, ends[0] + 1, ends[1], mark)
    times = _TIMES.get(_first(general, "X_Columns").lower())
    count = _first(header, "Channels")
    if times is None or not count.isdigit() or int(count) < 1:
        text.fail(
            "its header needs the number of Channels, and X_Columns of One or No; save it so from LabVIEW",
            ends[0],
        )
    start = ends[1] + 2
    titles = [title.strip() for title in text.line(start - 1).split(mark)]
    width = times + int(count)
    if len(titles) < width:
        text.fail(f"{len(titles)} titles of {width} columns", start - 1)
    clock = f"{_first(general, 'Date')} {_first(general, 'Time')}".strip()
    rows = _rows(text, start, mark, width)
    measurement = _Measurement(
        text=text,
        start=start,
        header=header,
        titles=titles,
        rows=rows,
        times=times,
        clock=clock,
    )
    return [measurement.channel(number) for number in range(int(count))]


def _cells(text: TextFile, start: int, stop: int, mark: str) -> dict[str, list[str]]:
    """Return the cells behind each key of the lines from ``start`` to ``stop``, parted by a ``mark``."""
    lines = (line.split(mark) for line in text.lines(start, stop))
    return {key.strip(): [cell.strip() for cell in cells] for key, *cells in lines}


def _first(header: dict[str, list[str]], key: str) -> str:
    """Return the first cell of a line of a header, or nothing."""
    return next(iter(header.get(key, [])), "")


def _rows(text: TextFile, start: int, mark: str, width: int) -> NDArray[np.float64]:
    """Return the numbers below the titles, shape (n, width), without the comments behind them.

    ``start``: first line of numbers; ``mark``: between cells.
    """
    lines = [text.raw(number).split(mark) for number in range(start, len(text))]
    while lines and not any(cell.strip() for cell in lines[-1]):
        lines.pop()
    joined = "\n".join(" ".join(cells[:width]) for cells in lines)
    plain = joined if mark == "," else joined.replace(",", ".")
    try:
        values = parse_separated(plain.encode("latin-1"))
    except NumberError as error:
        text.fail(str(error), start + error.line)
    return text.in_rows(values, width, start)


FORMAT = Format("LABVIEW", headed(_FIRST, within=1), _parse, encoding="latin-1")
