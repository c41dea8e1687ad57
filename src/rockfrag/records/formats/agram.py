"""USGS AGRAM: blocks of acceleration, velocity and displacement, seven lines of header above each.

The header ends with ``SAMPLES/SEC=200 … DATA TYPE=AC`` (``VL``, ``DP``) and ``NO OF POINTS=  5983,
UNITS=CM/SEC**2, CM/SEC, AND CM``; the units are those of the three types in this order. Samples stand in
rows of ten (F8.2), which need no blank between them.
"""

import re
from collections.abc import Iterator
from itertools import pairwise

from rockfrag.records.parsing.format import Channel, Format, section
from rockfrag.records.parsing.quantities import canonical_unit
from rockfrag.records.parsing.text_file import TextFile
from rockfrag.records.parsing.timestamps import time_at

_RATE = re.compile(
    r"^\s*SAMPLES/SEC\s*=\s*(?P<rate>[\d.]+).*\bDATA\s+TYPE\s*=\s*(?P<type>\w\w)", re.I
)
_RATE_LINE = re.compile(r"^\s*SAMPLES/SEC\s*=", re.I)
_SIZE = re.compile(
    r"^\s*NO\.?\s+OF\s+POINTS\s*=\s*(?P<count>\d+),?\s*UNITS\s*=\s*(?P<units>.*)$", re.I
)
_TIME = re.compile(
    r"(?i)YEAR\s*=\s*(\d+)\s+JULIAN\s+DAY\s*=\s*(\d+)\s+HOUR\s*=\s*(\d+)\s+MINUTE\s*=\s*(\d+)\s+"
    r"SECOND\s*=\s*([\d.]+)\s*(?:COMPONENT\s*=\s*(\S+))?"
)
_TYPES = {"AC": "acceleration", "VL": "velocity", "DP": "displacement"}
_ABOVE = 5
_WIDTH = 8


def _recognise(lines: list[str], name: str) -> bool:
    """Whether lines are those of such a file, by the words of its header."""
    return any(
        _RATE.match(line) and _SIZE.match(below) for line, below in pairwise(lines[:20])
    )


def _parse(text: TextFile) -> Iterator[Channel]:
    """Channels of a file of this format, by its header as the head of the module says it."""
    for line, following in text.parts(_RATE_LINE):
        # the header of the next block stands above its line of the rate
        stop = following if following == len(text) else following - _ABOVE
        channel = _section(text, line, stop)
        yield channel.saying(_facts(text.lines(max(0, line - _ABOVE), line)))


def _facts(words: list[str]) -> dict[str, object]:
    """What the lines of a header above that of the rate say: start, station, component and earthquake."""
    start, component = None, ""
    for match in filter(None, map(_TIME.search, words)):
        year, day, hour, minute = map(int, match.groups()[:4])
        start = time_at(
            float(match[5]), year=year, julday=day, hour=hour, minute=minute
        )
        component = match[6] or ""
        if component.isdigit():
            component = f"{int(component):03d}"
    named = (line.strip() for line in words if "EARTHQUAKE" in line.upper())
    return {
        "start_time": start,
        "station": words[0].strip() if words else "",
        "component": component,
        "earthquake": next(named, ""),
    }


def _section(text: TextFile, line: int, stop: int) -> Channel:
    """A channel of a file, from the line that states its rate."""
    rate, size = _RATE.match(text.line(line)), _SIZE.match(text.line(line + 1))
    if rate is None or size is None:
        text.fail("rate, type, number of points or units cannot be read here", line)
    if rate["type"].upper() not in _TYPES:
        text.fail(f"data type {rate['type']} is none of AC, VL and DP", line)
    words = re.split(r",\s*(?:AND\b)?|\bAND\b", size["units"], flags=re.I)
    units = [unit for unit in map(canonical_unit, words) if unit]
    if len(units) != len(_TYPES):
        held = "acceleration, velocity and displacement"
        text.fail(f"{len(units)} units are stated where {held} have one each", line + 1)
    kind = rate["type"].upper()
    unit, count = units[list(_TYPES).index(kind)], int(size["count"])
    dt = text.interval(1 / float(rate["rate"]) if float(rate["rate"]) else 0.0, line)
    return section(
        text,
        line + 1,
        stop,
        count=count,
        dt=dt,
        unit=unit,
        width=_WIDTH,
        quantity=_TYPES[kind],
    )


FORMAT = Format("AGRAM", _recognise, _parse)
