"""University of Southern California volume 2: corrected acceleration in cm/s², equally spaced.

A text header that repeats the one of volume 1, 100 integers, 100 reals, then sections below lines
such as ``1887 POINTS OF ACC DATA EQUALLY SPACED AT   .020 SEC.  IN UNITS CM/SEC/SEC`` (8F10.3). Where that
line states no unit, the line ``PEAK ACCELERATION = … CMS/SEC/SEC`` does.
"""

import re

from rockfrag.records.formats.usc import place_of
from rockfrag.records.parsing.channel import Channel
from rockfrag.records.parsing.format import Format
from rockfrag.records.parsing.fortran_sections import Section, positive_step, refuse_others
from rockfrag.records.parsing.quantities import canonical_unit
from rockfrag.records.parsing.text_file import TextFile

_FIRST = re.compile(r"^\s*CORRECTED\s+ACCELEROGRAM\b.*\bFILE\s+\d+", re.IGNORECASE)
_SECOND = re.compile(r"OF\s+UNCORRECTED\s+ACCELEROGRAM\s+DATA\s+OF\s+VOLUME", re.IGNORECASE)
_HEAD = re.compile(rb"^[ \t]*CORRECTED[ \t]+ACCELEROGRAM\b", re.I | re.M)
_VALUES = re.compile(
    rb"^[ \t]*\d+[ \t]+POINTS[ \t]+OF[ \t]+\w+[ \t]+DATA[ \t]+EQUALLY", re.I | re.M
)
_END = re.compile(_VALUES.pattern + rb"|^[ \t]*/&|" + _HEAD.pattern, re.I | re.M)
_VALUES_LINE = re.compile(
    r"^\s*(?P<count>\d+)\s+POINTS\s+OF\s+(?P<quantity>ACC|VEL|DIS)\w*\s+DATA\s+EQUALLY[\s-]+SPACED\s+"
    r"AT\s+(?P<dt>[\d.]+)\s*SEC\.?(?:\s*IN\s+UNITS?\s+(?:OF\s+)?(?P<unit>\S+))?",
    re.IGNORECASE,
)
_PEAK_UNIT = re.compile(r"PEAK\s+ACCELERATION\s*=\s*\S+\s+(?P<unit>[A-Z/]+)", re.IGNORECASE)
_QUANTITIES = {"ACC": "acceleration", "VEL": "velocity", "DIS": "displacement"}
_MAX_HEADER = 60
_WIDTH = 10


def _recognise(lines: list[str], name: str) -> bool:
    return len(lines) > 2 and bool(_FIRST.match(lines[0]) and _SECOND.search(lines[1]))


def _parse(text: TextFile) -> list[Channel]:
    channels, quantities = [], []
    first = text.find(_HEAD)
    while first >= 0:
        following = text.find(_HEAD, first + 1)
        stop = len(text) if following < 0 else following
        line = text.find(_VALUES, first, stop)
        if line < 0:
            text.fail("no line with the number of samples below; the file is cut short", first)
        words = text.lines(first, min(line, first + _MAX_HEADER))
        while line >= 0:
            section, dt, unit = _section(text, line, words)
            samples = section.samples(text)
            quantities.append(section.quantity)
            if section.quantity == "acceleration":
                plain = Channel(section.count, dt, samples.copy, unit)
                channels.append(place_of(words, plain))
            line = text.find(_VALUES, section.stop, stop)
        first = following
    refuse_others(text, quantities)
    return channels


def _section(text: TextFile, line: int, words: list[str]) -> tuple[Section, float, str]:
    match = _VALUES_LINE.match(text.line(line))
    if match is None:
        text.fail("number of samples, interval or quantity cannot be read here", line)
    peak = next((found for word in words if (found := _PEAK_UNIT.search(word))), None)
    unit = match["unit"] or (peak["unit"] if peak else "")
    section = Section(
        _QUANTITIES[match["quantity"].upper()],
        int(match["count"]),
        line + 1,
        text.until(_END, line + 1),
        _WIDTH,
    )
    dt = positive_step(text, float(match["dt"]), line)
    return section, dt, canonical_unit(unit.upper().replace("CMS", "CM"))


FORMAT = Format("USC2", _recognise, _parse)
is_format, read = FORMAT.is_format, FORMAT.read
