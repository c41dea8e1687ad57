"""USGS SMC files (National Strong-Motion Program): one component, corrected or uncorrected.

Eleven lines of text, 48 integers (8I10), 50 reals (5E15.7), as many lines of comment as the 16th
integer says (each begins with ``|``), then as many samples as the 17th integer says, in cm/s². The
fields are 8(1PE10.4E1), which need no blank between them, or 5E14.7 where the 47th integer is 8.
Where the header has no sampling rate, the values are pairs of time [s] and acceleration.
"""

import math
import re
from collections.abc import Iterator
from dataclasses import replace
from itertools import accumulate, takewhile
from typing import Any

import numpy as np
from numpy.typing import NDArray
from obspy import UTCDateTime

from rockfrag.records.parsing.format import Channel, Format, stated
from rockfrag.records.parsing.stated_peak import StatedPeak, with_checked_peak
from rockfrag.records.parsing.text_file import TextFile
from rockfrag.records.parsing.timestamps import channel_of_pairs, time_at

_TEXT_LINES, _INTEGER_LINES, _REAL_LINES = 11, 6, 10
_FIRST_DATA = _TEXT_LINES + _INTEGER_LINES + _REAL_LINES
_KINDS = re.compile(
    r"(?i)^\s*(?:[0-5]\s+)?(?P<kind>UNKNOWN|UNCORRECTED ACCELEROGRAM|CORRECTED ACCELEROGRAM|VELOCITY|"
    r"DISPLACEMENT|RESPONSE SPECTRA|FOURIER)\b|^\s*\*"
)
_FIRST_FIELD = re.compile(r"^\s*[+-]?\d*\.\d*(?:[EeDd][+-]?\d+)?")
_PEAK = r"\bpk\s*(?:acc)?\s*=\s*([-+\d.]+(?:E[+-]?\d+)?)"
_HIGH_PRECISION = 8
_PER_LINE, _SURPLUS_LINES = 8, 2

# places in the headers, counted from zero
_MISSING, _YEAR, _VERTICAL, _HORIZONTAL = 0, 1, 12, 13
_COMMENTS, _COUNT, _STATION, _PRECISION = 15, 16, 29, 46
_MISSING_REAL, _RATE, _LATITUDE, _LONGITUDE = 0, 1, 10, 11


def _recognise(lines: list[str], name: str) -> bool:
    """Whether lines are those of such a file, by the words of its first lines."""
    if len(lines) < _FIRST_DATA or not _KINDS.match(lines[0]):
        return False
    whole = lines[_TEXT_LINES : _TEXT_LINES + _INTEGER_LINES]
    fields = [line[i : i + 10] for line in whole for i in range(0, 80, 10)]
    return all(re.fullmatch(r"\s*-?\d+\s*", field) for field in fields)


def _parse(text: TextFile) -> Iterator[Channel]:
    """Channels of a file of this format, by its header as the head of the module says it."""
    words = text.lines(0, _TEXT_LINES)
    kind = _KINDS.match(words[0])
    if kind is None or len(text) <= _FIRST_DATA:
        text.fail("the SMC header has 27 lines; the file is cut short")
    held = (kind["kind"] or "").upper()
    if held and "ACCELEROGRAM" not in held and held != "UNKNOWN":
        text.refuse(f"this file holds {held.lower()}, not acceleration", 0)
    at_reals = _TEXT_LINES + _INTEGER_LINES
    whole = text.integers(_TEXT_LINES, at_reals, 10, 48)
    numbers = text.reals(at_reals, _FIRST_DATA, 15, 50)
    count, comments = whole[_COUNT], whole[_COMMENTS]
    if count < 1 or not 0 <= comments < len(text):
        text.fail(
            f"the header promises {count} samples and {comments} comments",
            _TEXT_LINES + 1,
        )
    start = _FIRST_DATA + comments
    rate = numbers[_RATE]
    samples, left_out = _without_surplus_lines(
        text, start, count, _width(text, start, whole)
    )
    if rate == numbers[_MISSING_REAL]:
        # without a rate the values are pairs of time and acceleration
        channel = channel_of_pairs(samples, "cm/s2", text, start, count // 2)
    else:
        dt = float(f"{1 / rate:.9g}") if rate > 0 else 0.0
        channel = Channel(count, text.interval(dt, at_reals), samples, "cm/s2")
    if left_out:
        step = {
            "step": "leave out values beyond the count of the header",
            "values": left_out,
        }
        channel = replace(channel, steps=(step, *channel.steps))
    peak = StatedPeak(stated(_PEAK, words), "cm/s2")
    facts = _facts(words, whole, numbers) | {"corrected": held.startswith("CORRECTED")}
    yield with_checked_peak(channel.saying(facts), peak, text.name, text.cut_short)


def _facts(words: list[str], whole: list[int], numbers: list[float]) -> dict[str, Any]:
    """What the lines of text, the whole numbers and the real numbers of the header say beside the samples."""
    place = {"latitude": numbers[_LATITUDE], "longitude": numbers[_LONGITUDE]}
    # a fifth character of the code names the channel
    number = "" if whole[_STATION] == whole[_MISSING] else str(whole[_STATION])
    station = re.search(r"station\s*=\s*(.*?)\s*component\s*=\s*(.*)$", words[5], re.I)
    # line 3 begins with the code of the station, line 4 is of the earthquake, line 6 of the station
    return {
        "start_time": _start(whole),
        "station": words[2][:4].strip().strip("\x00*") or number,
        "component": _component(whole, station[2].strip() if station else ""),
        "station_name": station[1] if station else "",
        "earthquake": " ".join(words[3].split()),
        **{
            key: value
            for key, value in place.items()
            if value != numbers[_MISSING_REAL]
        },
    }


def _without_surplus_lines(
    text: TextFile, start: int, count: int, width: int
) -> tuple[NDArray[np.float64], int]:
    """Return the values that the header counts, and how many stand below the last of them.

    Old digitised records have a line or two of scattered points at the end that their header does not count; a
    count that ends within a line is a wrong one, which the reading of so many numbers refuses.

    Parameters
    ----------
    text, start : the file, and its first line of values
    count : of values by the header
    width : of a field [characters]
    """
    values = text.numbers(start, None, width)
    surplus = values.size - count
    lengths = (len(text.raw(line).rstrip()) for line in range(start, len(text)))
    # numbers of values up to the end of each line
    values_to_line_end = accumulate(math.ceil(length / width) for length in lengths)
    ends_with_a_line = count in takewhile(lambda n: n <= count, values_to_line_end)
    if 0 < surplus <= _SURPLUS_LINES * _PER_LINE and ends_with_a_line:
        return values[:count], surplus
    return text.numbers(start, None, width, count=count), 0


def _width(text: TextFile, start: int, whole: list[int]) -> int:
    """Return the field width: the first number ends where the first field does."""
    first = _FIRST_FIELD.match(text.raw(start))
    stated = 14 if whole[_PRECISION] == _HIGH_PRECISION else 10
    return first.end() if first and first.end() > stated else stated


def _start(whole: list[int]) -> UTCDateTime | None:
    """Time of the first sample by the header's integers, None if it is not known."""
    year, day, hour, minute, second, millisecond = whole[_YEAR : _YEAR + 6]
    missing = whole[_MISSING]
    if missing in (year, day, hour, minute) or year <= 0:
        return None
    seconds = 0.0 if second == missing else float(second)
    if millisecond != missing:
        seconds += millisecond / 1000
    return time_at(seconds, year=year, julday=day, hour=hour, minute=minute)


def _component(whole: list[int], words: str) -> str:
    """Return the azimuth of the header, ``UP`` or ``DOWN`` of a vertical one, else its words."""
    missing = whole[_MISSING]
    vertical, horizontal = whole[_VERTICAL], whole[_HORIZONTAL]
    if vertical in (0, 180) and vertical != missing:
        return "UP" if vertical == 0 else "DOWN"
    if horizontal != missing and 0 <= horizontal <= 360:
        return f"{horizontal:03d}"
    return words


FORMAT = Format("SMC", _recognise, _parse)
