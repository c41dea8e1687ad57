"""COSMOS strong-motion format 1.20 (COSMOS 2001): text, integer, real and comment header, values.

Each header block names its own number of values and Fortran format, and so does the line above the
samples (``7000 acceleration pts, approx 70 secs, units=cm/sec2(04),Format=(8F10.5)``). A file may
have several channels, and several quantities of one channel.
"""

import re
from collections.abc import Callable, Iterator
from typing import Any, TypeVar

from rockfrag.records.parsing import format as form
from rockfrag.records.parsing.quantities import canonical_unit
from rockfrag.records.parsing.stated_peak import StatedPeak, with_checked_peak
from rockfrag.records.parsing.text_file import TextFile
from rockfrag.records.parsing.timestamps import time_at

_FIRST = re.compile(
    r"^\s*(?:un)?(?:raw|processed|corrected)?\s*\w+.*\(\s*Format\s+v\s*0?1\.\d+", re.I
)
_BLOCK = r"^\s*(\d+)\s+{}-header values follow on\s+(\d+)\s+lines"
_INTEGERS = re.compile("integer-header values", re.I)
_COMMENTS = re.compile(r"^\s*(\d+)\s+Comment line", re.I)
_VALUES = re.compile(r"^\s*\d+\s+\w[\w. ]*?\s+p(?:oin)?ts\b", re.I)
_VALUES_LINE = re.compile(
    r"(?i)^\s*(?P<count>\d+)\s+(?:raw\s+)?(?P<quantity>\w+).*?units?\s*=\s*(?P<unit>[^,(]+)"
    r"(?:\(\s*(?P<code>\d+)\s*\))?"
)
_END = re.compile(rf"^\s*(?:/&|End-of-data)|\(Format\s+v|{_VALUES.pattern}", re.I)
Number = TypeVar("Number", int, float)
_HEAD = re.compile(r"\(\s*Format\s+v", re.I)

_PEAK = re.compile(
    r"(?<!uncor)\s+max\s*=\s*(?P<value>[-+]?[\d.]+)\s*(?P<unit>[a-z]+(?:/[a-z/^*\d]+)?)",
    re.I,
)

_UNITS_BY_CODE = {
    2: "g",
    4: "cm/s2",
    5: "cm/s",
    6: "cm",
    7: "in/s2",
    8: "in/s",
    9: "in",
}
_UNITS_BY_CODE |= {10: "cm/s2", 11: "mg", 12: "ug", 50: "counts", 51: "volts"}
"""Table of physical units of the format (its table 2), as far as motion is concerned."""

# places in the whole and the real numbers, counted from zero (tables 7 and 8 of the format)
_RECORD_TIME, _AZIMUTH = 39, 53
_SECOND, _RECORDER_STEP, _STEP_MS = 29, 33, 61
_PLACE = ("latitude", "longitude")
_NAMED_AZIMUTHS = {
    400: "UP",
    401: "DOWN",
    402: "VERT",
    500: "RADL",
    501: "TRAN",
    600: "LONG",
}
_NAMED_AZIMUTHS |= {601: "TRAN", 700: "H1", 701: "H2", 800: "OTHER"}

_FACTS = {
    "network": r"Code\s*:\s*(\w+)-\w+",
    "station": r"Code\s*:\s*\w+-(\w+)",
    "station_name": r"Code\s*:\s*\w+-\w+\s*(.*)$",
    "component": r"Sta\s+Cha\w*\s*:?\s*[\d?]+\s*:\s*(.*?)\s*(?:\(|Location|$)",
    "code": r"SCNL\W+\w+\.(\w+)\.\w+\.[\w-]+",
    "location": r"SCNL\W+\w+\.\w+\.\w+\.([\w-]+)",
}


def _parse(text: TextFile) -> Iterator[form.Channel]:
    """Channels of a file of this format, by its header as the head of the module says it."""
    if re.search(r"\bspectr", text.line(0), re.I):
        text.refuse(
            "this file holds response spectra, not acceleration; give the V2 file"
        )
    line = text.find(_HEAD)
    while 0 <= line < len(text):
        at_values, dt, facts = _header(text, line)
        while at_values >= 0:
            stop = text.until(_END, at_values + 1)
            found = _section(text, at_values, stop, dt).saying(facts)
            if found.quantity == "acceleration":
                peak = _peak(text.lines(line, at_values))
                found = with_checked_peak(found, peak, text.name, text.cut_short)
            yield found
            line = text.find(_HEAD, stop)
            at_values = text.find(_VALUES, stop, None if line < 0 else line)


def _peak(words: list[str]) -> StatedPeak:
    """Return the peak of the samples as they are, not that of the raw record."""
    match = form.first_match(_PEAK, words)
    return StatedPeak(match["value"], match["unit"]) if match else StatedPeak("", "")


def _header(text: TextFile, first: int) -> tuple[int, float, dict[str, Any]]:
    """Read the header of a channel, whose line of words is ``first``.

    Returned are the line above the samples, the interval [s], and what the header says of the channel.
    """
    at_integers, whole = _block(text, first, "integer", text.integers, 8)
    at_reals, numbers = _block(text, at_integers, "real", text.reals, 15)
    at_samples = _above_samples(text, at_reals)
    words = text.lines(first, at_integers)
    comments = [
        line
        for line in text.lines(at_reals, at_samples)
        if line.lstrip().startswith("|")
    ]
    matches = (re.search(r"unknown/unspecified:\s*(-?[\d.]+)", line) for line in words)
    unknown = next((float(match[1]) for match in matches if match), -999.0)
    # headers that are shorter say nothing of the rest
    whole += [int(unknown)] * max(0, _AZIMUTH + 1 - len(whole))
    numbers += [unknown] * max(0, _STEP_MS + 1 - len(numbers))
    stated = numbers[_STEP_MS] != unknown
    dt = numbers[_STEP_MS] / 1000 if stated else numbers[_RECORDER_STEP]
    facts = _facts([*words, *comments], whole[_AZIMUTH])
    facts |= {
        name: None if numbers[i] == unknown else numbers[i]
        for i, name in enumerate(_PLACE)
    }
    # year, day of the year, month, day, hour, minute
    year, _, month, day, hour, minute = whole[_RECORD_TIME : _RECORD_TIME + 6]
    if unknown not in (year, month, day, hour, minute) and year > 0:
        second = 0.0 if numbers[_SECOND] == unknown else numbers[_SECOND]
        facts["start_time"] = time_at(
            second, year=year, month=month, day=day, hour=hour, minute=minute
        )
    return at_samples, text.interval(dt, at_reals), facts


def _above_samples(text: TextFile, at_reals: int) -> int:
    """Return the line above the samples; comments between may look like anything."""
    at_comments, line = text.find(_COMMENTS, at_reals), text.find(_VALUES, at_reals + 1)
    if 0 <= at_comments < line:
        count = int(text.raw(at_comments).split()[0])
        line = text.find(_VALUES, at_comments + 1 + count)
    if line < 0:
        text.fail(
            "no line with the number of samples below the header; the file is cut short"
        )
    return line


def _block(
    text: TextFile, first: int, kind: str, read: Callable[..., list[Number]], width: int
) -> tuple[int, list[Number]]:
    """Read a block of whole or real numbers, the first below line ``first``.

    Parameters
    ----------
    text, first : the file, and the line to look from
    kind : ``integer`` or ``real``
    read : reads the numbers of some lines
    width : of a field where the block does not state it [characters]

    Returns
    -------
    The line that states the block, and its values.
    """
    pattern = re.compile(_BLOCK.format(kind), re.I)
    line = text.find(pattern, first)
    match = pattern.match(text.raw(max(line, 0)))
    if line < 0 or match is None:
        text.fail(f"no {kind} header below this line; the file is cut short", first)
    count, lines = int(match[1]), int(match[2])
    if lines > len(text):
        text.fail(f"the header promises {lines} lines, the file has {len(text)}", line)
    width = form.field_width(text.line(line)) or width
    return line, read(line + 1, line + 1 + lines, width, count)


def _section(text: TextFile, line: int, stop: int, dt: float) -> form.Channel:
    """A channel of a file, from the line that states its unit up to the line ``stop``; ``dt``: interval [s]."""
    match = _VALUES_LINE.match(text.line(line))
    if match is None:
        text.fail("the line above the samples does not state their unit", line)
    quantity = form.QUANTITIES.get(
        match["quantity"].upper()[:3], match["quantity"].lower()
    )
    unit = canonical_unit(match["unit"])
    if match["code"] is not None:
        unit = _UNITS_BY_CODE.get(int(match["code"]), unit)
    if unit in {"counts", "volts"}:
        text.refuse(
            f"the samples are raw {unit}; give the V1 or V2 file, in units of motion",
            line,
        )
    width = form.field_width(text.line(line).split("ormat", 1)[-1])
    return form.section(
        text,
        line,
        stop,
        count=int(match["count"]),
        dt=dt,
        unit=unit,
        width=width,
        quantity=quantity,
    )


def _facts(words: list[str], azimuth: int) -> dict[str, Any]:
    """Return what the text header states of a channel."""
    facts = form.facts_in(words[::-1], _FACTS)
    component = re.sub(r"\s*deg\w*$", "", facts["component"], flags=re.I)
    if component.lower() in ("", "other", "unknown"):
        named = _NAMED_AZIMUTHS.get(azimuth, facts["code"])
        component = f"{azimuth:03d}" if 1 <= azimuth <= 360 else named
    earthquake = " ".join(words[1].split()) if len(words) > 1 else ""
    location = facts["location"].strip("-")
    return {
        **facts,
        "location": location,
        "component": component,
        "earthquake": earthquake,
    }


FORMAT = form.Format("COSMOS", form.headed(_FIRST, _INTEGERS, within=60), _parse)
