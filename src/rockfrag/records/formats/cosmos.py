"""COSMOS strong-motion format 1.20 (COSMOS 2001): text, integer, real and comment header, values.

Each header block names its own number of values and Fortran format, and so does the line above the
samples (``7000 acceleration pts, approx 70 secs, units=cm/sec2(04),Format=(8F10.5)``). A file may
have several channels, and several quantities of one channel.
"""

import re
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

from obspy import UTCDateTime

from rockfrag.records.parsing import fortran_sections
from rockfrag.records.parsing.format import Channel, Format
from rockfrag.records.parsing.quantities import canonical_unit
from rockfrag.records.parsing.text_file import TextFile
from rockfrag.records.parsing.timestamps import time_at

_FIRST = re.compile(
    r"^\s*(?:un)?(?:raw|processed|corrected)?\s*\w+.*\(\s*Format\s+v\s*0?1\.\d+", re.IGNORECASE
)
_INTEGERS = re.compile(
    rb"^[ \t]*(\d+)[ \t]+Integer-header values follow on[ \t]+(\d+)[ \t]+lines", re.I | re.M
)
_REALS = re.compile(
    rb"^[ \t]*(\d+)[ \t]+Real-header values follow on[ \t]+(\d+)[ \t]+lines", re.I | re.M
)
_COMMENTS = re.compile(rb"^[ \t]*(\d+)[ \t]+Comment line", re.I | re.M)
_VALUES = re.compile(rb"^[ \t]*\d+[ \t]+\w[\w. ]*?[ \t]+p(?:oin)?ts\b", re.I | re.M)
_VALUES_LINE = re.compile(
    r"^\s*(?P<count>\d+)\s+(?:raw\s+)?(?P<quantity>\w+).*?units?\s*=\s*(?P<unit>[^,(]+)"
    r"(?:\(\s*(?P<code>\d+)\s*\))?",
    re.IGNORECASE,
)
_END = re.compile(
    rb"^[ \t]*(?:/&|End-of-data)|\(Format[ \t]+v|^[ \t]*\d+[ \t]+\w[\w. ]*?[ \t]+p(?:oin)?ts\b",
    re.I | re.M,
)
_HEAD = re.compile(rb"\(\s*Format[ \t]+v", re.I)

_UNITS_BY_CODE = {2: "g", 4: "cm/s2", 5: "cm/s", 6: "cm", 7: "in/s2", 8: "in/s", 9: "in"}
_UNITS_BY_CODE |= {10: "cm/s2", 11: "mg", 12: "ug", 50: "counts", 51: "volts"}
"""Table of physical units of the format (its table 2), as far as motion is concerned."""

# places in the headers, counted from zero (tables 7 and 8 of the format)
_RECORD_TIME = 39
_AZIMUTH = 53
_SECOND = 29
_STEP_MS = 61
_RECORDER_STEP = 33
_PLACE = (0, 1)
_NAMED_AZIMUTHS = {400: "UP", 401: "DOWN", 402: "VERT", 500: "RADL", 501: "TRAN", 600: "LONG"}
_NAMED_AZIMUTHS |= {601: "TRAN", 700: "H1", 701: "H2", 800: "OTHER"}


def _recognise(lines: list[str], name: str) -> bool:
    return bool(_FIRST.match(lines[0])) and any(
        "integer-header values" in line.lower() for line in lines[1:60]
    )


@fortran_sections.accelerations
def _parse(text: TextFile) -> Iterator[tuple[str, Channel]]:
    if re.search(r"\bspectr", text.line(0), re.IGNORECASE):
        text.refuse("this file holds response spectra, not acceleration; give the V2 file")
    line = text.find(_HEAD)
    while 0 <= line < len(text):
        at_values, dt, facts = _header(text, line)
        while at_values >= 0:
            section = _section(text, at_values, dt)
            yield section.quantity, replace(section.channel(text), **facts)
            line = text.find(_HEAD, section.stop)
            at_values = text.find(_VALUES, section.stop, None if line < 0 else line)


def _header(text: TextFile, first: int) -> tuple[int, float, dict[str, Any]]:
    """Return the line above the samples, the interval [s], and what the header says of the channel."""
    at_integers = text.find(_INTEGERS, first)
    if at_integers < 0:
        text.fail("no integer header below this line; the file is cut short", first)
    whole = fortran_sections.integers(text, *_block(text, at_integers, _INTEGERS, width=8))
    at_reals = text.find(_REALS, at_integers)
    if at_reals < 0:
        text.fail("no real header below this line; the file is cut short", at_integers)
    numbers = fortran_sections.reals(text, *_block(text, at_reals, _REALS, width=15))
    at_samples = _above_samples(text, at_reals)
    words = text.lines(first, at_integers)
    comments = [line for line in text.lines(at_reals, at_samples) if line.lstrip().startswith("|")]
    matches = (re.search(r"unknown/unspecified:\s*(-?[\d.]+)", line) for line in words)
    unknown = next((float(match[1]) for match in matches if match), -999.0)
    whole += [int(unknown)] * max(0, _AZIMUTH + 1 - len(whole))
    numbers += [unknown] * max(0, _STEP_MS + 1 - len(numbers))
    stated = numbers[_STEP_MS] != unknown
    dt = numbers[_STEP_MS] / 1000 if stated else numbers[_RECORDER_STEP]
    facts = _facts([*words, *comments], whole[_AZIMUTH])
    latitude, longitude = (None if numbers[i] == unknown else numbers[i] for i in _PLACE)
    facts["details"] |= {"latitude": latitude, "longitude": longitude}
    facts["start_time"] = _start(whole, numbers, unknown)
    return at_samples, fortran_sections.positive_step(text, dt, at_reals), facts


def _above_samples(text: TextFile, at_reals: int) -> int:
    """Return the line above the samples; comments between may look like anything."""
    at_comments, line = text.find(_COMMENTS, at_reals), text.find(_VALUES, at_reals + 1)
    if 0 <= at_comments < line:
        match = _COMMENTS.match(text.raw(at_comments))
        assert match is not None
        line = text.find(_VALUES, at_comments + 1 + int(match[1]))
    if line < 0:
        text.fail("no line with the number of samples below the header; the file is cut short")
    return line


def _block(
    text: TextFile, line: int, pattern: re.Pattern[bytes], width: int
) -> tuple[int, int, int, int]:
    """Return first line, end, field width and number of values of a header block."""
    match = pattern.match(text.raw(line))
    assert match is not None
    count, lines = int(match[1]), int(match[2])
    if lines > len(text):
        text.fail(f"the header promises {lines} lines, the file has {len(text)}", line)
    return line + 1, line + 1 + lines, fortran_sections.field_width(text.line(line)) or width, count


def _section(text: TextFile, line: int, dt: float) -> fortran_sections.Section:
    match = _VALUES_LINE.match(text.line(line))
    if match is None:
        text.fail("the line above the samples does not state their unit", line)
    quantity = fortran_sections.QUANTITIES.get(
        match["quantity"].upper()[:5], match["quantity"].lower()
    )
    unit = canonical_unit(match["unit"])
    if match["code"] is not None:
        unit = _UNITS_BY_CODE.get(int(match["code"]), unit)
    if unit in {"counts", "volts"}:
        text.refuse(f"the samples are raw {unit}; give the V1 or V2 file, in units of motion", line)
    stop = text.until(_END, line + 1)
    width = fortran_sections.field_width(text.line(line).split("ormat", 1)[-1])
    return fortran_sections.Section(quantity, int(match["count"]), line + 1, stop, width, dt, unit)


def _start(whole: list[int], numbers: list[float], unknown: float) -> UTCDateTime | None:
    year, _, month, day, hour, minute = whole[_RECORD_TIME : _RECORD_TIME + 6]
    if unknown in (year, month, day, hour, minute) or year <= 0:
        return None
    second = 0.0 if numbers[_SECOND] == unknown else numbers[_SECOND]
    return time_at(second, year=year, month=month, day=day, hour=hour, minute=minute)


def _facts(words: list[str], azimuth: int) -> dict[str, Any]:
    """Return the fields of a channel that the text header states."""
    network = station = location = code = name = component = ""
    for line in words:
        found = re.search(r"Code\s*:\s*(\w+)-(\w+)\s*(.*)$", line)
        if found:
            network, station, name = found[1], found[2], found[3].strip()
        found = re.search(r"Sta\s+Cha\w*\s*:?\s*[\d?]+\s*:\s*(.*?)\s*(?:\(|Location|$)", line)
        if found:
            component = re.sub(r"\s*deg\w*$", "", found[1], flags=re.IGNORECASE)
        found = re.search(r"SCNL\W+(\w+)\.(\w+)\.(\w+)\.([\w-]+)", line)
        if found:
            code, location = found[2], found[4].strip("-")
    if component.lower() in ("", "other", "unknown"):
        component = f"{azimuth:03d}" if 1 <= azimuth <= 360 else _NAMED_AZIMUTHS.get(azimuth, code)
    earthquake = " ".join(words[1].split()) if len(words) > 1 else ""
    seed = {"network": network, "station": station, "location": location, "code": code}
    details = {"station_name": name, "earthquake": earthquake}
    return {**seed, "component": component, "details": details}


FORMAT = Format("COSMOS", _recognise, _parse)
