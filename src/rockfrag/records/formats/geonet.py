"""GeoNet (New Zealand) V1A and V2A: three components, in mm/s², mm/s and mm.

Each component has 16 lines of text, 40 integers (10I8), 60 reals (10F8), then samples of
acceleration and, in V2A, velocity and displacement (10F8). The integers 31 to 36 count digitised,
prepended, appended, acceleration, velocity and displacement samples.
"""

import re

from rockfrag.records.parsing.format import Channel, Format
from rockfrag.records.parsing.fortran_sections import first_match, integers, positive_step, reals
from rockfrag.records.parsing.text_file import TextFile
from rockfrag.records.parsing.timestamps import clock_time

_FIRST = re.compile(r"^\s*(?:un)?corrected accelerogram\s+\S+", re.IGNORECASE)
_TEXT_LINES, _INTEGER_LINES, _REAL_LINES, _A_LINE, _WIDTH = 16, 4, 6, 10, 8

# places in the headers, counted from zero
_START = (8, 9, 18, 19, 38)
_START_MS = 39
_DIGITISED = 30
_COUNTS = (33, 34, 35)
_DIGITISED_STEP, _STEP = 24, 25
_MAGNITUDE, _LATITUDE, _LONGITUDE = 14, 10, 11
_MILLIMETRES = r"units of\s+([\d.]+)\s*mm/s/s"


def _recognise(lines: list[str], name: str) -> bool:
    return (
        len(lines) > _TEXT_LINES
        and bool(_FIRST.match(lines[0]))
        and bool(re.match(r"^\s*site\s+\S+", lines[1], re.IGNORECASE))
        and any(re.match(r"^\s*component\s+\S+", line, re.I) for line in lines[:_TEXT_LINES])
    )


def _parse(text: TextFile) -> list[Channel]:
    channels, line = [], 0
    while line < len(text):
        if text.line(line).strip():
            channel, line = _component(text, line)
            channels.append(channel)
        else:
            line += 1
    return channels


def _component(text: TextFile, first: int) -> tuple[Channel, int]:
    """Return the component whose header starts at a line, and the line after its last sample."""
    if not _FIRST.match(text.line(first)):
        text.fail("the header of a component is expected here", first)
    words = text.lines(first, first + _TEXT_LINES)
    at_integers = first + _TEXT_LINES
    at_reals = at_integers + _INTEGER_LINES
    start = at_reals + _REAL_LINES
    if start >= len(text):
        text.fail("the header has 26 lines; the file is cut short", len(text) - 1)
    whole = integers(text, at_integers, at_reals, _WIDTH, 40)
    numbers = reals(text, at_reals, start, _WIDTH, 60)
    counts = [whole[place] for place in _COUNTS]
    dt = numbers[_STEP]
    if counts[0] == 0:
        # V1A has the digitised samples only
        counts[0], dt = whole[_DIGITISED], dt or numbers[_DIGITISED_STEP]
    if min(counts) < 0 or counts[0] < 1:
        text.fail(f"the header promises {counts[0]} samples of acceleration", at_integers + 3)
    acceleration, line = None, start
    for count in counts:
        stop = line + -(-count // _A_LINE)
        samples = text.counted(line, stop, count, _WIDTH)
        acceleration = samples if acceleration is None else acceleration
        line = stop
    assert acceleration is not None
    values = acceleration * float(_word_after(_MILLIMETRES, words) or 1)
    year, month, day, hour, minute = (str(whole[place]) for place in _START)
    began = clock_time(year, month, day, hour, minute, "0") if whole[_START[0]] > 0 else None
    return (
        Channel(
            npts=counts[0],
            dt=positive_step(text, dt, at_reals + 2),
            samples=values.copy,
            unit="mm/s2",
            start_time=began and began + whole[_START_MS] / 1000,
            network="NZ",
            station=_word_after(r"site\s+(\S+)", words),
            component=_word_after(r"component\s+(\S+)", words),
            details={
                "station_name": words[2].strip(),
                "earthquake": ", ".join(" ".join(line.split()) for line in words[6:8]),
                "magnitude": numbers[_MAGNITUDE] or None,
                "latitude": -abs(numbers[_LATITUDE]),
                "longitude": numbers[_LONGITUDE],
            },
        ),
        line,
    )


def _word_after(pattern: str, words: list[str]) -> str:
    match = first_match(re.compile(rf"\b{pattern}", re.IGNORECASE), words)
    return match[1] if match else ""


FORMAT = Format("GEONET", _recognise, _parse)
