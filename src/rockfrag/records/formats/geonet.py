"""GeoNet (New Zealand) V1A and V2A: three components, in mm/s², mm/s and mm.

Each component has 16 lines of text, 40 integers (10I8), 60 reals (10F8), then samples of
acceleration and, in V2A, velocity and displacement (10F8). The integers 31 to 36 count digitised,
prepended, appended, acceleration, velocity and displacement samples.
"""

import re
from collections.abc import Generator, Iterator

from rockfrag.records.parsing.format import Channel, Format, headed, stated
from rockfrag.records.parsing.stated_peak import StatedPeak, with_checked_peak
from rockfrag.records.parsing.text_file import TextFile
from rockfrag.records.parsing.timestamps import time_at

_FIRST = re.compile(r"^\s*(?:un)?corrected accelerogram\s+\S+", re.I)
_PEAK = r"^\s*acceleration\s*:\s*peak\s+([-+\d.]+)\s*mm/s/s"
_TEXT_LINES, _INTEGER_LINES, _REAL_LINES, _A_LINE, _WIDTH = 16, 4, 6, 10, 8


def _parse(text: TextFile) -> Iterator[Channel]:
    """Yield the components of a file, one after the other; blank lines may part them."""
    line = 0
    while line < len(text):
        if text.line(line).strip():
            line = yield from _component(text, line)
        else:
            line += 1


def _component(text: TextFile, first: int) -> Generator[Channel, None, int]:
    """Give the component whose header starts at a line; return the line after its last sample."""
    if not _FIRST.match(text.line(first)):
        text.fail("the header of a component is expected here", first)
    words = text.lines(first, first + _TEXT_LINES)
    at_integers = first + _TEXT_LINES
    at_reals = at_integers + _INTEGER_LINES
    start = at_reals + _REAL_LINES
    line = start
    if start >= len(text):
        text.fail("the header has 26 lines; the file is cut short", len(text) - 1)
    whole = text.integers(at_integers, at_reals, _WIDTH, 40)
    numbers = text.reals(at_reals, start, _WIDTH, 60)
    # places in the headers, counted from zero: numbers of samples of acceleration, velocity and displacement
    counts = whole[33:36]
    digitised_dt, dt = numbers[24:26]
    if counts[0] == 0:
        # V1A has the digitised samples only
        counts[0], dt = whole[30], dt or digitised_dt
    if min(counts) < 0 or counts[0] < 1:
        text.fail(
            f"the header promises {counts[0]} samples of acceleration", at_integers + 3
        )
    found = []
    for count in counts:
        after = line - (-count // _A_LINE)
        found.append(text.numbers(line, after, _WIDTH, count=count))
        line = after
    values = found[0] * float(stated(r"\bunits of\s+([\d.]+)\s*mm/s/s", words) or 1)
    dt = text.interval(dt, at_reals + 2)
    channel = Channel(counts[0], dt, values, "mm/s2").saying(
        _facts(words, whole, numbers)
    )
    peak = StatedPeak(stated(_PEAK, words), "mm/s2")
    yield with_checked_peak(channel, peak, text.name, text.cut_short)
    return line


def _facts(
    words: list[str], whole: list[int], numbers: list[float]
) -> dict[str, object]:
    """What a header says beside the samples.

    Parameters
    ----------
    words : its lines of text
    whole, numbers : its integers and its reals, shape (40,) and (60,)
    """
    # their places, counted from zero, are those of the format
    year, month = whole[8:10]
    day, hour = whole[18:20]
    minute, milliseconds = whole[38:40]
    latitude, longitude, magnitude = numbers[10], numbers[11], numbers[14]
    seconds, clock = milliseconds / 1000, {"day": day, "hour": hour, "minute": minute}
    return {
        "start_time": time_at(seconds, year=year, month=month, **clock)
        if year > 0
        else None,
        "network": "NZ",
        "station": stated(r"\bsite\s+(\S+)", words),
        "component": stated(r"\bcomponent\s+(\S+)", words),
        "station_name": words[2].strip(),
        "earthquake": ", ".join(" ".join(line.split()) for line in words[6:8]),
        "magnitude": magnitude or None,
        # degrees south
        "latitude": -abs(latitude),
        "longitude": longitude,
    }


_PARTS = (re.compile(rf"^\s*{part}\s+\S+", re.I) for part in ("site", "component"))
FORMAT = Format("GEONET", headed(_FIRST, *_PARTS, within=_TEXT_LINES), _parse)
