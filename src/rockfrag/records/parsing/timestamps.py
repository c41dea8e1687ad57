"""Clock times and dates, and pairs of time and value: the first sample and the sampling interval."""

import re

import numpy as np
from numpy.typing import NDArray
from obspy import UTCDateTime

from rockfrag.base.plausible import LONGEST_STEP
from rockfrag.records.parsing.format import Channel, cut_short_step, first_match
from rockfrag.records.parsing.number_fields import (
    NumberError,
    parse_columns,
    parse_separated,
)
from rockfrag.records.parsing.quantities import canonical_unit
from rockfrag.records.parsing.text_file import TextFile
from rockfrag.records.parsing.time_column import TimeColumn

# [s], to which unevenly digitised film is interpolated
_EVEN_STEPS = (0.005, 0.002, 0.001, 0.0005)
# largest ratio of that interval to the mean distance of the digitised points
_COARSEST = 1.25

_HOURS_BEHIND = {
    "UTC": 0,
    "UT": 0,
    "GMT": 0,
    "Z": 0,
    "EST": 5,
    "EDT": 4,
    "CST": 6,
    "CDT": 5,
}
_HOURS_BEHIND |= {
    "MST": 7,
    "MDT": 6,
    "PST": 8,
    "PDT": 7,
    "AKST": 9,
    "AKDT": 8,
    "AST": 9,
    "HST": 10,
}
"""Hours that the time zones of American networks are behind UTC (AST is Alaska's, as they use it)."""

_LAST_YEAR_OF_2000S = 30


def clock_time(
    year: str,
    month: str,
    day: str,
    hour: str,
    minute: str,
    *,
    second: str,
    zone: str = "UTC",
) -> UTCDateTime | None:
    """Return a date and time as UTC, or None if it is no time or its zone is not known.

    Parameters
    ----------
    year, month, day, hour, minute, second : words of numbers; a year of two digits is of the last hundred years or
        so
    zone : name of the time zone
    """
    behind = _HOURS_BEHIND.get(zone.strip().upper() or "UTC")
    if behind is None:
        return None
    full = int(year)
    if full < 100:
        full += 2000 if full <= _LAST_YEAR_OF_2000S else 1900
    seconds = float(second) + 3600.0 * behind
    return time_at(
        seconds,
        year=full,
        month=int(month),
        day=int(day),
        hour=int(hour),
        minute=int(minute),
    )


def time_at(seconds: float, **minute: int) -> UTCDateTime | None:
    """Return the time some seconds after a minute, by arguments of UTCDateTime, or None if it is no time."""
    try:
        return UTCDateTime(**minute) + seconds
    except (ValueError, OverflowError, TypeError):
        return None


_AMERICAN = re.compile(
    r"(?P<month>\d{1,2})\s*/\s*(?P<day>\d{1,2})\s*/\s*(?P<year>\d{2,4})\s*,?\s+"
    r"(?P<hour>\d{1,2}):(?P<minute>\d{1,2}):(?P<second>\d{1,2}(?:\.\d*)?)\s*(?P<zone>[A-Z]{1,4})?"
)


def american_time(words: str) -> UTCDateTime | None:
    """Return the time in words as ``05/02/83, 16:42:48.2 PDT``, or None."""
    match = _AMERICAN.search(words)
    return None if match is None else clock_time(**match.groupdict(default=""))


_MONTHS = (
    ("jan", "ene", "gen"),
    ("feb", "fev", "fév"),
    ("mar", "mär", "mrz"),
    ("apr", "abr", "avr"),
    ("may", "mai", "mag"),
    ("jun", "giu", "juin"),
    ("jul", "lug", "juil"),
    ("aug", "ago", "aou", "aoû"),
    ("sep", "set"),
    ("oct", "okt", "ott", "out"),
    ("nov",),
    ("dec", "dez", "dic", "déc"),
)
"""How the names of months begin in English, Spanish, Italian, Portuguese, French and German."""

_CLOCK = r"[ T_-]+(?P<h>\d{1,2}):(?P<min>\d{1,2})(?::(?P<s>\d{1,2}(?:\.\d*)?))?$"
_NOTATIONS = (
    r"^(?P<y>\d{4})(?P<m>\d\d)(?P<d>\d\d)[_ T](?P<h>\d\d)(?P<min>\d\d)(?P<s>\d\d(?:\.\d*)?)$",
    r"^(?P<d>\d{1,2})[/.-](?P<m>\d{1,2})[/.-](?P<y>\d{4})" + _CLOCK,
    r"^(?P<y>\d{4})[/.-](?P<m>\d{1,2})[/.-](?P<d>\d{1,2})" + _CLOCK,
    r"^(?P<d>\d{1,2})[/. -](?P<m>[^\W\d_]{3,12})\.?[/. ,-]+(?P<y>\d{4}|\d\d)" + _CLOCK,
)


def time_of(words: str) -> UTCDateTime | None:
    """Return the time in words as ``20190728_160905.700``, ``14/11/2010 23:09:19.3``, ``10/DIC/94 15:2:18``."""
    match = next(
        filter(None, (re.match(pattern, words.strip()) for pattern in _NOTATIONS)), None
    )
    if match is None:
        return None
    year, month, day, hour, minute = match.group("y", "m", "d", "h", "min")
    if not month.isdigit():
        month = _number_of_month(month)
    second = match["s"] or "0"
    return clock_time(year, month, day, hour, minute, second=second) if month else None


def _number_of_month(name: str) -> str:
    """Return the number of the month that a name begins like, or an empty string."""
    beginnings = enumerate(_MONTHS, start=1)
    known = (number for number, words in beginnings if name.lower().startswith(words))
    return str(next(known, ""))


_POINTS = re.compile(r"\bno\.?\s+of\s+points\s*=?\s*(?P<count>\d+)", re.I)
_UNITS = re.compile(r"\bunits\b.*?\bsec\w*\s+and\s+(?P<unit>[^\s.,]+)", re.I)
_NUMBERS_ONLY = re.compile(r"^[\s\d.+\-]+$")
_FIELD = 7
_MAX_HEADER = 30


def is_pairs_header(text: TextFile, first: int) -> bool:
    """Tell whether a header states pairs of time and acceleration."""
    return any(_UNITS.search(line) for line in text.lines(first, first + _MAX_HEADER))


def read_pairs(text: TextFile, first: int, stop: int) -> Channel:
    """Read the channel whose header starts at line ``first`` and which ends before ``stop``.

    Volume 1 of the Caltech tradition: text header, 100 integers, 50 reals, five pairs a line. Film records were
    digitised at uneven intervals; they are interpolated linearly to even ones.
    """
    header = text.lines(first, first + _MAX_HEADER)
    points, units = first_match(_POINTS, header), first_match(_UNITS, header)
    numbers = (
        i
        for i, x in enumerate(header)
        if i > 8 and x.strip() and _NUMBERS_ONLY.match(x)
    )
    at_numbers = first + next(numbers, -first)
    if points is None or units is None or not at_numbers:
        text.fail("no number of points, unit or numeric header below this line", first)
    count, unit = int(points["count"]), canonical_unit(units["unit"])
    # 100 integers (16I5) and 50 reals (8F10) are seven lines each
    text.reals(at_numbers + 7, at_numbers + 14, 10, 50)
    values = _flat(text, at_numbers + 14, stop, 2 * count)
    return channel_of_pairs(values, unit, text, at_numbers + 14, count)


def channel_of_pairs(
    values: NDArray[np.float64], unit: str, text: TextFile, line: int, promised: int
) -> Channel:
    """Return times and accelerations that alternate as even samples.

    Times that are not even are points between which the acceleration is linear.

    Parameters
    ----------
    values : time [s], acceleration, time and so on, shape (2 n,)
    unit : of the acceleration
    text, line : the file, and its line for messages
    promised : number of pairs that the header states
    """
    if text.cut_short:
        values = values[: 2 * (values.size // 2)]
    times, accelerations = values[0::2], values[1::2]
    if times.size < 2 or times.size != accelerations.size:
        text.fail("a record needs at least two pairs of time and acceleration", line)
    column = TimeColumn(times, text, line)
    if (np.diff(times) < 0).any():
        # rounding may make neighbours equal, never reverse them
        column.check_rising()
    steps = [cut_short_step(promised, times.size)] if promised > times.size else []
    dt = column.even_interval()
    if dt is None:
        mean = float(times[-1] - times[0]) / (times.size - 1)
        if mean > LONGEST_STEP:
            text.fail(
                f"times lie {mean:.3g} s apart on average, those of a record at most {LONGEST_STEP:g} s",
                line,
            )
        # about as many samples as points
        dt = next(
            (step for step in _EVEN_STEPS if step <= _COARSEST * mean), _EVEN_STEPS[-1]
        )
        count = int(np.floor((times[-1] - times[0]) / dt * (1 + 1e-12))) + 1
        accelerations = np.interp(
            times[0] + np.arange(count) * dt, times, accelerations
        )
        found = {"dt_s": dt, "digitised_points": int(times.size)}
        steps.append({"step": "interpolate linearly to even intervals", **found})
    return Channel(
        accelerations.size, dt, accelerations.copy(), unit, steps=tuple(steps)
    )


def _flat(text: TextFile, start: int, stop: int, count: int) -> NDArray[np.float64]:
    """Return the numbers between two lines, in fields that may touch: 10F7.3, the first one wider by a blank.

    ``count``: of the numbers, two a point.
    """
    body = text.body(start, stop)
    try:
        values = parse_separated(body)
    except NumberError:
        values = np.empty(0)
    if values.size != count:
        lines = [line.rstrip() for line in body.split(b"\n")]
        shift = max(map(len, lines)) % _FIELD
        try:
            values = parse_columns([line[shift:] for line in lines], _FIELD)
        except NumberError as error:
            text.fail(str(error), start + error.line)
    text.check_count(count // 2, values.size, start, "points", each=2)
    return values
