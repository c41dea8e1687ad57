"""Plain text and CSV of any layout: one series in a column or in rows, or columns side by side.

One reader decides for all of them where the samples begin, and what stands above them says: rows of
numbers (a count, an interval, or both, on one line or two), words (``DT=``, ``sampling frequency: 100
Hz``, ``units: cm/s^2``, ``components: E N Z``) and titles of columns (``Time (ms), Acc X (g)``). What
stands above is never a sample: a row of numbers there that states nothing known is an error. All that is
stated must agree, with the file and with what the user names; what is not stated is asked for.
"""

import re
from dataclasses import dataclass, field, replace
from itertools import combinations
from pathlib import PurePath
from typing import Any, NamedTuple, NoReturn

import numpy as np
from numpy.typing import NDArray

from rockfrag.base.errors import InputError
from rockfrag.base.plausible import SHORTEST_STEP
from rockfrag.records.formats import HEADED
from rockfrag.records.parsing import number_fields
from rockfrag.records.parsing.column_titles import (
    Column,
    are_titles_of_other_columns,
    column_titles,
    components_of,
)
from rockfrag.records.parsing.directions import is_direction
from rockfrag.records.parsing.encodings import encoding_of
from rockfrag.records.parsing.format import Channel, Format
from rockfrag.records.parsing.peak_in_words import with_checked_peaks
from rockfrag.records.parsing.plain_rows import PlainRows, plain_rows, with_plain_rows
from rockfrag.records.parsing.quantities import quantity_in_name, to_si
from rockfrag.records.parsing.stated_facts import StatedFacts, stated_facts
from rockfrag.records.parsing.text_file import TextFile, is_remark, last_row
from rockfrag.records.parsing.time_column import TimeColumn
from rockfrag.records.parsing.writing import Written, text_writer

_OF_OBSPY = re.compile(
    r"\s*(?:Origin Time|TIMESERIES |WID[12]\b|BEGIN (?:GSE|IMS)|XW01|DELTA\s*:)", re.I
)
"""First words of text formats that ObsPy reads, or that are refused by name."""

_MIN_ROWS = 3
# fraction of the rows in which a column without title must rise to be one of times
_RISING = 0.9
_FEW_ROWS = 20
# part of the mean step by which the steps of a column that may be times differ
_EVENLY = 0.2

# ratio of steps along columns to steps along rows below which columns are channels
_SMOOTHER = 0.6
# the same the other way round, from which more than three columns are one series row after row
_SMOOTHER_IN_ROWS = 0.9
# part of its peak by which the printed magnitude of components may be off the computed one
_MOST_COMPONENTS = 8  # columns among which components of a magnitude are looked for
_LIKE_MAGNITUDE = 1e-3
_SHOWN = 60
# significant digits of an interval that stands above samples of more digits
_LONGEST_ROUND = 3
# [s] that a number without words can be as an interval; a larger one may be a scale
_LONGEST_BARE_STEP = 0.1


@dataclass
class _Layout:
    """All that a file says of its samples, and its rows of numbers."""

    text: TextFile
    table: number_fields.NumberTable
    facts: StatedFacts
    titles: list[Column]
    rows: PlainRows
    npts: int | None = None
    dt: float | None = None
    steps: list[dict[str, Any]] = field(default_factory=list)

    @property
    def line(self) -> int:
        """First row of samples, from zero."""
        return self.table.start

    @property
    def interval(self) -> float | None:
        """Interval that the file states, else the user's [s]."""
        return self.text.asked_dt if self.dt is None else self.dt

    def agree(self, npts: int | None, dt: float | None, line: int) -> None:
        """Take count and interval of numbers above the samples, which must agree with the words there."""
        for what, stated, own in (
            ("samples", self.npts, npts),
            ("s as interval", self.dt, dt),
        ):
            if (
                stated is not None
                and own is not None
                and abs(stated - own) > 1e-6 * own
            ):
                self.text.fail(
                    f"{own:g} {what} here, but {stated:g} in the words of the header; mend it",
                    line,
                )
        self.npts = self.npts if npts is None else npts
        self.dt = self.dt if dt is None else dt

    def _check_duration(self, length: float, step: float) -> None:
        """Refuse samples that are not as long [s] as the words of the header say, but for its rounding."""
        stated = self.facts.duration
        if stated is None or abs(length - stated) <= self.facts.rounding + 2 * step:
            return
        self.text.fail(
            f"the samples are {length:g} s long, but the header states a duration of {stated:g} s; mend what is "
            "wrong: the interval, the header or the end of the file"
        )

    def channel(
        self,
        samples: NDArray[np.float64],
        step: float,
        column: Column,
        component: str,
        title: str,
    ) -> Channel:
        """Return samples that are ``step`` seconds apart as a channel with what the file says of it."""
        self._check_duration(samples.size * step, step)
        stated = self.facts.unit
        if column.problem:
            self.text.fail(
                f"column {column.title!r}: {column.problem}; write the unit of the numbers into its title, such "
                "as (m/s2)",
                self.line - 1,
            )
        if self.facts.other_unit and not column.unit and not stated:
            self.text.fail(
                f"the header states the unit {self.facts.other_unit!r}, which no acceleration has; mend it"
            )
        if column.unit and stated and column.unit != stated:
            self.text.fail(
                f"column {column.title!r} is in {column.unit}, but the lines above it say {stated}; mend the "
                "header",
                self.line - 1,
            )
        return Channel(
            npts=self.npts or samples.size,
            dt=self.text.interval(step, self.line),
            samples=samples.copy(),
            unit=column.unit or stated,
            component=component,
            station=self.facts.details["station"],
            details={
                "title": title,
                "earthquake": self.facts.details["earthquake"],
                "recorder_time": self.rows.start,
            },
            steps=tuple(self.steps),
        )


def _recognise(lines: list[str], name: str) -> bool:
    """Whether a file is rows of numbers of one width, and no other format's."""
    plain = list(plain_rows(lines).lines)
    table = number_fields.number_table(plain)
    if table is None or _OF_OBSPY.match(lines[0]):
        return False
    rows = [line for line in plain[table.start :] if not number_fields.is_blank(line)]
    while rows and is_remark(rows[-1]):
        rows.pop()
    found = [number_fields.numbers_of(line, table.decimal_comma) for line in rows]
    return (
        len(rows) >= (_MIN_ROWS if not table.numbers else 1)
        and all(map(number_fields.are_numbers, found))
        and {len(row) for row in found[:-1]} <= {table.columns}
        and len(found[-1]) <= table.columns
        and not any(headed.recognise(lines, name) for headed in HEADED)
    )


def _parse(text: TextFile) -> list[Channel]:
    """Channels of rows of numbers, by what the words above them and the user say."""
    dt = text.asked_dt
    if dt is not None and not (np.isfinite(dt) and dt > 0):
        raise InputError(f"dt must be a positive number of seconds, got {dt}.")
    text, rows = with_plain_rows(_decoded(text))
    layout = _layout(text, rows)
    _refuse_by_name(layout)
    channels = _read_channels(layout)
    peaks = layout.facts.peaks
    if all(channel.unit for channel in channels):
        return with_checked_peaks(channels, peaks, text.name)
    # the unit is the user's; of several channels nobody knows whose peak one is
    if len(peaks) == len(channels):
        stated = tuple((peak.number, peak.unit) for peak in peaks)
        return [replace(channel, peaks=stated) for channel in channels]
    return channels


def _read_channels(layout: _Layout) -> list[Channel]:
    """Return the one series of a file, or its columns, as the samples and what is said of them tell."""
    text, columns = layout.text, layout.table.columns
    stop = last_row(text, layout.line)
    values, widths = text.rows(layout.line, stop, layout.table.decimal_comma)
    _check_no_counts(layout, values)
    # only the last row of a series is shorter
    text.check_widths(widths if columns == 1 else widths[:-1], columns, layout.line)
    if columns == 1:
        return [_series(layout, _without_leading(layout, values))]
    filled = widths[widths > 0]
    if (
        layout.titles
        or _is_timed(values, columns)
        or _are_channels(layout, values, filled)
    ):
        text.check_widths(widths, columns, layout.line)
        return _channels(layout, values.reshape(-1, columns))
    return [_series(layout, values)]


def _check_no_counts(layout: _Layout, values: NDArray[np.float64]) -> None:
    """Refuse whole numbers below words that say what one digit of a recorder is worth."""
    if layout.facts.digit and not (values % 1).any():
        layout.text.fail(
            f"{layout.facts.digit.strip()[:_SHOWN]!r} is a factor that is not applied here: the numbers are "
            "counts; apply it and take the line out"
        )


def _refuse_by_name(layout: _Layout) -> None:
    """Refuse a file whose name says velocity or displacement, and in which nothing says acceleration."""
    said = [layout.facts.quantity, *(column.quantity for column in layout.titles)]
    path = PurePath(layout.text.name)
    named = quantity_in_name(path.name)
    whose = "its name" if named else "the name of its folder"
    quantity = named or quantity_in_name(path.parent.name)
    if quantity not in ("", "acceleration") and "acceleration" not in said:
        layout.text.refuse(
            f"{whose} says {quantity}, and nothing in it says acceleration; if it holds that, write the word "
            "above the numbers"
        )


def _decoded(text: TextFile) -> TextFile:
    """Return a text whose words are understood, if they are not UTF-8."""
    head = text.body(0, number_fields.LOOKED_AT)
    try:
        head.decode("utf-8")
    except UnicodeDecodeError:
        return replace(text, encoding=encoding_of(head))
    return text


def _layout(text: TextFile, rows: PlainRows) -> _Layout:
    """Return what the lines above the samples say of them."""
    lines = text.lines(0, number_fields.LOOKED_AT)
    table = number_fields.number_table(lines)
    if table is None:
        text.fail("no rows of numbers below a header of words", 0)
    filled = [n for n in range(table.start) if not number_fields.is_blank(lines[n])]
    for number in filled[-1:]:
        if number_fields.is_damaged_row(lines[number]):
            text.fail(
                f"{lines[number].strip()[:_SHOWN]!r} is no row of numbers", number
            )
    titles, titled = column_titles(table, lines[table.start])
    # titles of several columns speak of each of them alone
    words = [words for _, words in table.words]
    facts = stated_facts(words[: len(words) - titled] if len(titles) > 1 else words)
    if facts.contradiction:
        text.fail(f"{facts.contradiction}; mend the header")
    if facts.factor:
        text.fail(
            f"{facts.factor[:_SHOWN]!r} is a factor that is not applied here; apply it and take the line out"
        )
    if rows.clock_column is not None and titles:
        clock = titles[rows.clock_column]
        titles[rows.clock_column] = Column(clock.title, "time", "", "")
    layout = _Layout(text, table, facts, titles, rows, facts.npts, facts.dt)
    _take_numbers_above(layout, lines)
    dt = text.asked_dt
    if dt is not None and layout.dt is not None and abs(dt - layout.dt) > 1e-6 * dt:
        text.fail(
            f"the file states an interval of {layout.dt:g} s, not {dt:g} s; leave dt= out"
        )
    return layout


def _take_numbers_above(layout: _Layout, lines: list[str]) -> None:
    """Take the count and the interval that rows of numbers above the samples state into the layout.

    They are the first two numbers there, or the only one. A first row of samples that cannot be one, as it begins
    with a count and its time does not come before the next, is such a row too. ``lines``: of the file.
    """
    table = layout.table
    # numbers above the samples, each with that of its line
    above = [(number, word) for number, row in table.numbers for word in row]
    if not above and table.columns > 1:
        row = number_fields.numbers_of(lines[table.start], table.decimal_comma)
        below = next(
            (x for x in lines[table.start + 1 :] if not number_fields.is_blank(x)), ""
        )
        if _is_count_row(
            row, number_fields.numbers_of(below, table.decimal_comma), table.columns
        ):
            above = [(table.start, word) for word in row]
            layout.table = replace(table, start=table.start + 1)
    if not above and table.columns > 1:
        _check_first_row(
            layout, row, number_fields.numbers_of(below, table.decimal_comma)
        )
    if not above:
        return
    # a row that begins with anything else than a count may have one number of columns before it
    numbers = [word for _, word in above]
    if len(numbers) == 3 and numbers[0] == "1":
        numbers = numbers[1:]
    npts, dt = _count_and_step(numbers[:2])
    rows_of_two = len({number for number, _ in above}) > 1 and len(numbers) > 2
    if (npts is None and dt is None) or rows_of_two:
        layout.text.fail(
            f"{' '.join(word for _, word in above)[:_SHOWN]!r} above the samples is neither their number nor "
            "their interval; take the line out, or write # before it",
            above[0][0],
        )
    layout.agree(npts, dt, above[0][0])


def _check_first_row(layout: _Layout, row: list[str], below: list[str]) -> None:
    """Refuse azimuths that stand above columns as their titles: whole numbers above samples that are none."""
    whole = [_is_whole(word) and number_fields.number_in(word) != 0 for word in row]
    if all(whole) and not any(map(_is_whole, below)):
        layout.text.fail(
            f"{' '.join(row)[:_SHOWN]!r} above the samples looks like titles; write them with a letter, such as "
            "N90E, or as the samples are written",
            layout.line,
        )


def _is_count_row(row: list[str], below: list[str], columns: int) -> bool:
    """Tell a count and an interval from the first row of samples of several ``columns``.

    ``row``: its words; ``below``: those of the next row.
    """
    npts, dt = _count_and_step(row[:2])
    if (
        npts is None
        or dt is None
        or not number_fields.are_numbers(below)
        or len(below) != columns
    ):
        return False
    if columns == 2:
        # as a time, the first number would not come before the next
        return number_fields.number_in(below[0]) <= number_fields.number_in(row[0])
    return not any(_is_whole(word) for word in below)


def _count_and_step(words: list[str]) -> tuple[int | None, float | None]:
    """Return the count and the interval [s] that one or two numbers are, in either order."""
    npts = next(
        (int(number_fields.number_in(word)) for word in words if _is_count(word)), None
    )
    dt = next(
        (number_fields.number_in(word) for word in words if not _is_whole(word)), None
    )
    if dt is not None and not SHORTEST_STEP <= dt <= _LONGEST_BARE_STEP:
        return None, None
    if len(words) == 2 and (npts is None or dt is None):
        return None, None
    return npts, dt


def _is_count(word: str) -> bool:
    """Whether a word is a whole number of two or more, which may be written with decimals."""
    value = number_fields.number_in(word)
    return value >= 2 and value == int(value) and (_is_whole(word) or value < 1e9)


def _is_whole(word: str) -> bool:
    """Whether a word is written as a whole number."""
    return re.fullmatch(r"[+-]?\d+\.?", word) is not None


def _is_timed(values: NDArray[np.float64], columns: int) -> bool:
    """Tell whether the first numbers of the rows rise, as times do; evenly where the rows are few."""
    steps = np.diff(values[::columns])
    even = steps.size >= _FEW_ROWS or (steps.size > 1 and np.ptp(steps) <= steps.mean())
    return bool(even and (steps > 0).mean() > _RISING)


def _are_channels(
    layout: _Layout, values: NDArray[np.float64], widths: NDArray[np.int64]
) -> bool:
    """Whether columns are channels side by side, and not one series that goes on row after row.

    A stated count of samples decides it, then as many named components as there are columns, or a last row that
    is shorter. Else the samples do (:func:`_smoother_directions`), and the steps of the layout say so.

    Parameters
    ----------
    layout, values : of the table, and all its numbers row after row
    widths : how many numbers each row has
    """
    columns = layout.table.columns
    if layout.npts in (widths.size, values.size):
        return layout.npts == widths.size
    if len(layout.facts.components) == columns or widths[-1] != columns:
        return len(layout.facts.components) == columns
    side_by_side, in_rows = _smoother_directions(values.reshape(-1, columns))
    if (side_by_side and columns > 3) or not (side_by_side or in_rows):
        layout.text.fail(
            f"{columns} numbers a row may be {columns} columns side by side or one series row after row; "
            "write titles above them, or one number a row",
            layout.line,
        )
    layout.steps.append(
        {"step": "take numbers as " + ("columns" if side_by_side else "rows")}
    )
    return side_by_side


def _smoother_directions(rows: NDArray[np.float64]) -> tuple[bool, bool]:
    """Whether samples change clearly less from row to row than along a row, and the other way round.

    Those of one channel differ less from one to the next than those of two channels do. ``rows``: shape (n,
    columns).
    """
    down = float(np.median(np.abs(np.diff(rows, axis=0))))
    along = float(np.median(np.abs(np.diff(rows, axis=1))))
    most = _SMOOTHER if rows.shape[1] <= 3 else _SMOOTHER_IN_ROWS
    return down < _SMOOTHER * along, along < most * down


def _series(layout: _Layout, values: NDArray[np.float64]) -> Channel:
    """Return the one series of a file, in a column or in rows."""
    stated = next(iter(layout.titles), Column("", "", "", ""))
    _refuse_other(layout, stated.quantity or layout.facts.quantity)
    if layout.npts is not None:
        filled = layout.table.columns
        if layout.text.is_filled_up(values, layout.npts, filled):
            surplus = values.size - layout.npts
            note = {"step": "leave out zeros that fill the last row", "values": surplus}
            layout.steps.append(note)
            values = values[: layout.npts]
        layout.text.check_count(layout.npts, values.size, layout.line)
    if layout.interval is None:
        what = "one column" if layout.table.columns == 1 else "rows of numbers"
        layout.text.fail(
            f"{what} without sampling interval; give it with dt= (in seconds)"
        )
    names = layout.facts.components if len(layout.facts.components) == 1 else ()
    return layout.channel(
        values, layout.interval, stated, "".join(names), layout.table.title
    )


def _without_leading(
    layout: _Layout, values: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Take count and interval, a line each, from the top of one column of numbers.

    They are told by the count, which is that of the numbers below, and by a notation that no sample has.
    What looks like one and does not fit is an error, not a sample.
    """
    text, dt = layout.text, layout.text.asked_dt
    if layout.table.numbers:
        return values
    words = [
        word
        for line in text.lines(layout.line, layout.line + number_fields.LOOKED_AT)
        for word in number_fields.numbers_of(line, layout.table.decimal_comma)
    ]
    lines, count, step = _leading(layout, values, words)
    if not lines:
        return values
    layout.agree(count, step, layout.line)
    if dt is not None and step is not None and abs(dt - step) > 1e-6 * dt:
        text.fail(
            f"states an interval of {step:g} s, not {dt:g} s; leave dt= out",
            layout.line,
        )
    layout.steps.append(
        {"step": "take first lines as header", "lines": " ".join(words[:lines])}
    )
    return values[lines:]


class _Leading(NamedTuple):
    """Lines above the samples of one column that hold a count and an interval [s], each if it is there."""

    lines: int
    samples: int | None = None
    step: float | None = None


def _leading(
    layout: _Layout, values: NDArray[np.float64], words: list[str]
) -> _Leading:
    """Find out what the first two numbers of a column are, by their size and notation.

    A count is that of the numbers below it; an interval is one that recorders have, rounder than samples; and
    either is written otherwise than all samples.

    Parameters
    ----------
    layout : of the file
    values : all numbers of the column, shape (n,)
    words : the same as they are written, the first of them
    """
    text, dt = layout.text, layout.text.asked_dt
    first, body = words[:2], words[2:]
    are_two = len(first) == 2
    whole = [_is_whole(word) for word in first]
    notations = {_notation(sample) for sample in body}
    odd = [_notation(word) not in notations for word in first]
    # numbers of as many digits as each needs have every notation, so that no one is odd
    unlike = odd[0] and len(notations) == 1
    is_round = _is_interval(words[0], unlike, body)
    count, step = _count_and_step(first) if are_two else (None, None)
    # a count of what follows, with an interval or alone
    if count == values.size - 2 and step is not None:
        return _Leading(2, count, step)
    if _is_count(words[0]) and values[0] == values.size - 1:
        return _Leading(1, int(values[0]))
    # a count of something else, by its notation
    if whole[0] and odd[0] and values[0] >= 1:
        count = int(values[0]) if values[0] > 1 else None
        if are_two and _is_interval(first[1], odd[1], body):
            return _Leading(2, count, float(values[1]))
        if values[0] == 1:
            _fail_no_sample(layout, words[0])
        return _Leading(1, count)
    if len(notations) == 1 and not unlike and values[0] == dt and is_round:
        text.fail(
            f"{words[0]!r} above the samples may be the interval or a sample; take it out if it is the "
            f"interval, else write 'dt = {dt:g} s' above it and leave dt= out",
            layout.line,
        )
    # an interval, alone or before a count
    if is_round and (unlike or values[0] == dt):
        if are_two and whole[1] and odd[1] and values[1] > 1:
            return _Leading(2, int(values[1]), float(values[0]))
        return _Leading(1, None, float(values[0]))
    if unlike and values[0] != 0:
        _fail_no_sample(layout, words[0])
    return _Leading(0)


def _fail_no_sample(layout: _Layout, word: str) -> NoReturn:
    """Refuse a word above the samples that is no sample."""
    layout.text.fail(
        f"{word!r} above the samples looks like no sample; take the line out, or write it as they are",
        layout.line,
    )


def _is_interval(word: str, odd: bool, body: list[str]) -> bool:
    """Tell whether a number is an interval that recorders have, rounder than the samples below it.

    ``word``: the number; ``odd``: whether it is written otherwise than all of the ``body`` below.
    """
    value = number_fields.number_in(word)
    if _is_whole(word) or not SHORTEST_STEP <= value <= _LONGEST_BARE_STEP:
        return False
    digits = [_digits(sample) for sample in body]
    is_round = _digits(word) <= _LONGEST_ROUND
    if odd:
        # of a whole rate the interval may have many digits
        rate = 1 / float(f"{1 / round(1 / value):.{_digits(word)}g}")
        return is_round or abs(1 / rate - value) <= 1e-9 * value
    return is_round and _digits(word) < float(np.median(digits or [0]))


def _digits(word: str) -> int:
    """Return the number of significant digits of a number as it is written, but for zeros at its end."""
    mantissa = re.split("[EeDd]", word)[0]
    return len(re.sub(r"\D", "", mantissa).strip("0"))


def _notation(word: str) -> tuple[bool, int]:
    """Return whether a number has an exponent, and its decimals, -1 for whole numbers."""
    mantissa = re.split("[EeDd]", word)[0]
    decimals = re.split("[.,]", mantissa)
    return mantissa != word, len(decimals[1]) if len(decimals) > 1 else -1


def _refuse_other(layout: _Layout, quantity: str) -> None:
    """Refuse samples that are stated to be of another quantity than acceleration."""
    if quantity not in ("", "acceleration"):
        layout.text.refuse(
            f"the lines above the samples say that they are {quantity}, not acceleration",
            0,
        )


def _channels(layout: _Layout, table: NDArray[np.float64]) -> list[Channel]:
    """Return the columns of acceleration of a file, each with the times left of it."""
    text = layout.text
    columns = layout.titles or _untitled(layout, table)
    titles = ", ".join(column.title for column in columns)
    kinds = [column.quantity for column in columns]
    if kinds[0] == "spectrum" or (len(columns) == 2 and "spectrum" in kinds):
        text.refuse(
            f"the columns {titles} are a spectrum, not acceleration in time",
            layout.line - 1,
        )
    chosen = [i for i, kind in enumerate(kinds) if kind == "acceleration"]
    if not chosen:
        _refuse_other(layout, layout.facts.quantity)
        # beside a depth what has no name is no acceleration in time
        in_time = not any(kinds) or "time" in kinds or "index" in kinds
        # beside an acceleration in a unit of another quantity neither
        in_time = in_time and not any(column.is_said_acceleration for column in columns)
        chosen = [i for i, kind in enumerate(kinds) if not kind and in_time]
    if not chosen:
        text.refuse(
            f"none of the columns {titles} is acceleration; if one "
            "is, write the word or the unit into its title",
            layout.line - 1,
        )
    if layout.npts is not None:
        text.check_count(layout.npts, table.shape[0], layout.line)
    chosen = _without_magnitude(layout, columns, table, chosen)
    names = components_of([columns[i] for i in chosen])
    channels = []
    for component, i in zip(names, chosen, strict=True):
        step, notes = _interval(layout, columns, table, i)
        title = columns[i].title if layout.titles else layout.table.title
        noted = replace(layout, steps=[*layout.steps, *notes])
        channels.append(noted.channel(table[:, i], step, columns[i], component, title))
    return channels


def _without_magnitude(
    layout: _Layout,
    columns: list[Column],
    table: NDArray[np.float64],
    chosen: list[int],
) -> list[int]:
    """Return the columns that are components: the length of their vector, never negative, is none.

    Parameters
    ----------
    layout, columns : of the file, and what titles say of its columns
    table : the numbers, shape (n, columns)
    chosen : columns of acceleration, by their numbers
    """
    positive = [i for i in chosen if table[:, i].min() >= 0 and table[:, i].max() > 0]
    sizes = [i for i in chosen if columns[i].is_named_magnitude]
    named = [i for i in sizes if i in positive]
    directed = [i for i in chosen if is_direction(columns[i].component)]
    if len(directed) > 2 and not named:
        # beside three components a length from which gravity has been taken
        named = [i for i in sizes if i not in directed]
    if named == chosen:
        layout.text.refuse(
            f"column {columns[named[0]].title!r} is the magnitude of components, which has no direction",
            layout.line - 1,
        )
    if positive and not named:
        every = [i for i, c in enumerate(columns) if c.quantity in ("", "acceleration")]
        with np.errstate(over="ignore"):
            in_si = table * [to_si(column.unit or "m/s2") for column in columns]
        off = {
            i: _off_magnitude(in_si, i, [k for k in every if k != i]) for i in positive
        }
        like = [i for i in positive if off[i] < _LIKE_MAGNITUDE]
        named = [i for i in like if off[i] == min(off.values())][-1:]
    return [i for i in chosen if i not in named]


def _off_magnitude(table: NDArray[np.float64], column: int, others: list[int]) -> float:
    """Return by what part of its peak a column is off the length of the vector of two or three others [-].

    ``table``: of one unit, shape (n, columns); ``others``: numbers of the columns to try.
    """
    peak = table[:, column].max()
    few = others if len(others) <= _MOST_COMPONENTS else []
    vectors = [pair for k in (2, 3) for pair in combinations(few, k)]
    lengths = (np.sqrt((table[:, list(v)] ** 2).sum(axis=1)) for v in vectors)
    off = (float(np.abs(length - table[:, column]).max() / peak) for length in lengths)
    return min(off, default=1.0)


def _untitled(layout: _Layout, table: NDArray[np.float64]) -> list[Column]:
    """Return columns without titles: times that rise, and channels by their number or stated name."""
    count = table.shape[1]
    timed = _is_timed(table.ravel(), count)
    number, words = layout.table.words[-1] if layout.table.words else (0, "")
    if are_titles_of_other_columns(words) or (
        timed
        and count > 2
        and len(re.findall(r"\b(?:acc|vel|disp|time)", words, re.I)) > 1
    ):
        layout.text.fail(
            f"{words[:_SHOWN]!r} cannot be told apart into {layout.table.columns} titles of columns; "
            "separate them as the numbers are",
            number,
        )
    named = layout.facts.components
    if len(named) != count - timed or not named:
        numbered = [f"column {i + 1}" for i in range(timed, count)]
        named = ("",) if count - timed == 1 else tuple(numbered)
    channels = [Column(name, "acceleration", "", name) for name in named]
    return [*([Column("", "time", "", "")] if timed else []), *channels]


def _interval(
    layout: _Layout, columns: list[Column], table: NDArray[np.float64], column: int
) -> tuple[float, tuple[dict[str, Any], ...]]:
    """Return the interval [s] of a column, and notes: that of the times left of it, which what is stated must fit.

    ``columns``: what titles say; ``table``: the numbers, shape (n, columns); ``column``: its number.
    """
    text = layout.text
    timed = [i for i, column in enumerate(columns) if column.quantity == "time"]
    left = [i for i in timed if i < column] or timed[:1]
    if not left:
        return _interval_without_times(layout, columns, table), ()
    title, times = columns[left[-1]], table[:, left[-1]]
    seconds = title.seconds
    if seconds is None:
        text.fail(
            f"{title.unit!r} of column {title.title!r} is no unit of time known here; write s or ms",
            layout.line - 1,
        )
    if not title.title and (np.diff(times) == 1).all():
        if layout.interval is not None:
            return layout.interval, ()
        text.fail(
            "the first column counts by ones, as numbers of samples do; give the sampling interval with dt= "
            "(in seconds)",
            layout.line,
        )
    whose = "the header gives dt =" if layout.dt is not None else "dt= gives"
    stated_times = TimeColumn(times, text, layout.line, seconds)
    return stated_times.interval_beside(layout.interval, whose)


def _interval_without_times(
    layout: _Layout, columns: list[Column], table: NDArray[np.float64]
) -> float:
    """Return the interval [s] of columns without titled times; a column that may be times must fit it."""
    text, dt = layout.text, layout.interval
    for i, column in enumerate(columns):
        if column.quantity == "index":
            _check_counted(layout, column.title, table[:, i])
    title, first = columns[0].title, table[:, 0]
    steps = np.diff(first)
    rises = columns[0].quantity == "" and steps.size > 1 and steps.min() > 0
    even = bool(rises and np.ptp(steps) <= _EVENLY * steps.mean())
    if dt is None:
        more = (
            f" column {title!r} rises evenly: if it is time, call it 'time (s)';"
            if even
            else ""
        )
        text.fail(
            f"no column is titled as time;{more} give the sampling interval with dt= (in seconds)"
        )
    step = float(steps.mean()) if even else 1.0
    # samples that are counted, seconds or milliseconds
    if not any(abs(step - known) <= 1e-3 * known for known in (1.0, dt, 1e3 * dt)):
        text.fail(
            f"column {title!r} rises evenly by {step:.6g}, which is not {dt:g} s; if it is time, call it 'time "
            "(s)', else 'number'",
            layout.line - 1,
        )
    return dt


def _check_counted(layout: _Layout, title: str, numbers: NDArray[np.float64]) -> None:
    """Check that numbers of samples go on evenly: where one is missing a sample is; counters may begin anew."""
    steps = np.diff(numbers)
    usual = float(np.median(steps)) if steps.size else 0.0
    if usual <= 0:
        return  # the number of a record or of a test
    begins_anew = (numbers[1:] == numbers.min()) & (numbers[:-1] == numbers.max())
    odd = np.flatnonzero((steps != usual) & ~begins_anew)
    if odd.size:
        first = int(odd[0])
        layout.text.fail(
            f"column {title!r} goes from {numbers[first]:.10g} to {numbers[first + 1]:.10g} here, elsewhere by "
            f"{usual:.6g}: samples are missing, a gap, or there twice; dt= does not close it",
            layout.line + first + 1,
        )


FORMAT = Format("PLAINTEXT", _recognise, _parse, encoding="latin-1")


def _csv(trace: Written) -> str:
    """Text of a CSV file with time [s] and acceleration, a row a sample."""
    unit = f" [{trace.unit}]" if trace.unit else ""
    rows = [f"{time},{value}" for time, value in trace.timed()]
    return "\n".join([f"Time [s],Acceleration{unit}", *rows, ""])


write = text_writer(_csv, with_unit=False)
"""Write one trace as CSV, time and acceleration, that read back to the same samples."""
