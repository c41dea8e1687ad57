"""Volume 1 of the Caltech tradition: pairs of time and acceleration below a header in columns.

Text header, 100 integers, 50 reals, then five pairs a line. The 28th integer and the line ``NO. OF
POINTS`` have the number of pairs; ``UNITS … SEC AND G/10`` the unit. Film records were digitised at
uneven intervals; they are interpolated linearly to even ones.
"""

import re

import numpy as np
from numpy.typing import NDArray

from rockfrag.errors import InputError
from rockfrag.plausibility import LONGEST_STEP
from rockfrag.records.parsing.channel import Channel, cut_short_step
from rockfrag.records.parsing.fortran_sections import reals
from rockfrag.records.parsing.number_fields import NumberError, parse_columns, parse_separated
from rockfrag.records.parsing.quantities import canonical_unit
from rockfrag.records.parsing.text_file import TextFile
from rockfrag.records.parsing.timestamps import check_rising, even_step, step_of_times

_POINTS = re.compile(r"\bno\.?\s+of\s+points\s*=?\s*(?P<count>\d+)", re.IGNORECASE)
_UNITS = re.compile(r"\bunits\b.*?\bsec\w*\s+and\s+(?P<unit>[^\s.,]+)", re.IGNORECASE)
_NUMBERS_ONLY = re.compile(r"^[\s\d.+\-]+$")
_FIELD = 7
_MAX_HEADER = 30


def is_pairs_header(text: TextFile, first: int) -> bool:
    """Tell whether a header states pairs of time and acceleration."""
    return any(_UNITS.search(line) for line in text.lines(first, first + _MAX_HEADER))


def read_pairs(text: TextFile, first: int, stop: int) -> Channel:
    """Read the channel whose header starts at line ``first`` and which ends before ``stop``."""
    header = text.lines(first, first + _MAX_HEADER)
    count = unit = None
    at_numbers = 0
    for number, line in enumerate(header):
        points, units = _POINTS.search(line), _UNITS.search(line)
        count = int(points["count"]) if points and count is None else count
        unit = canonical_unit(units["unit"]) if units and unit is None else unit
        if number > 8 and line.strip() and _NUMBERS_ONLY.match(line):
            at_numbers = first + number
            break
    if count is None or unit is None or not at_numbers:
        text.fail("no number of points, unit or numeric header below this line", first)
    # 100 integers (16I5) and 50 reals (8F10) are seven lines each
    reals(text, at_numbers + 7, at_numbers + 14, 10, 50)
    values = _flat(text, at_numbers + 14, stop, 2 * count)
    return pairs_of(values, unit, text, at_numbers + 14, count)


def pairs_of(
    values: NDArray[np.float64], unit: str, text: TextFile, line: int, promised: int
) -> Channel:
    """Return times [s] and accelerations that alternate as even samples; ``promised`` is the number stated."""
    if text.cut_short:
        values = values[: 2 * (values.size // 2)]
    times, accelerations = values[0::2], values[1::2]
    if times.size < 2 or times.size != accelerations.size:
        text.fail("a record needs at least two pairs of time and acceleration", line)
    if (np.diff(times) < 0).any():
        # rounding may make neighbours equal, never reverse them
        check_rising(times, text, line)
    steps = [cut_short_step(promised, times.size)] if promised > times.size else []
    try:
        dt = step_of_times(times, text, line)
    except InputError:
        mean = float(times[-1] - times[0]) / (times.size - 1)
        if mean > LONGEST_STEP:
            text.fail(
                f"times lie {mean:.3g} s apart on average, those of a record at most {LONGEST_STEP:g} s",
                line,
            )
        dt = even_step(times)
        count = int(np.floor((times[-1] - times[0]) / dt * (1 + 1e-12))) + 1
        accelerations = np.interp(times[0] + np.arange(count) * dt, times, accelerations)
        found = {"dt_s": dt, "digitised_points": int(times.size)}
        steps.append({"step": "interpolate linearly to even intervals", **found})
    details = {"steps": tuple(steps)}
    return Channel(accelerations.size, dt, accelerations.copy, unit, details=details)


def _flat(text: TextFile, start: int, stop: int, count: int) -> NDArray[np.float64]:
    """Return ``count`` numbers of fields that may touch: 10F7.3, the first one wider by a blank."""
    body = text.data[text.offset(start) : text.offset(stop)]
    try:
        values = parse_separated(body)
    except NumberError:
        values = np.empty(0)
    if values.size != count:
        lines = [line.rstrip() for line in body.split(b"\n")]
        longest = max((len(line) for line in lines), default=0)
        shift = longest % _FIELD
        try:
            values = parse_columns([line[shift:] for line in lines], _FIELD)
        except NumberError as error:
            text.fail(str(error), start + error.line)
    text.check_count(count // 2, values.size, start, "points", each=2)
    return values
