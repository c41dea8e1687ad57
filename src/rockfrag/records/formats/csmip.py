"""CSMIP/CDMG volumes 1 and 2 (California Strong Motion Instrumentation Program).

Each channel has a text header, 100 integers (16I5), 50 or 100 reals (8F10) and its values, and ends
with a line ``/&``. Volume 2 has acceleration, velocity and displacement below lines such as ``1138
POINTS OF ACCEL DATA EQUALLY SPACED AT  .020 SEC.  (UNITS: CM/SEC/SEC)``; volume 1 has one line such
as ``13200 Accelerogram points at 200 pts/sec in units of g .  Format: (8f9.6)``, and before 1985
pairs of time and acceleration in g/10.
"""

import re
from collections.abc import Iterator
from dataclasses import replace

from rockfrag.records.parsing import fortran_sections
from rockfrag.records.parsing.format import Channel, Format
from rockfrag.records.parsing.quantities import canonical_unit
from rockfrag.records.parsing.text_file import TextFile
from rockfrag.records.parsing.timestamps import american_time, is_pairs_header, read_pairs

_FIRST = re.compile(r"^\s*(?:un)?corrected\s+acc?elero(?:gram|graph)\b", re.IGNORECASE)
_SPECTRA = re.compile(r"^\s*(?:response|fourier)\b.*\bspectr", re.IGNORECASE)
_HEAD = re.compile(rb"^[ \t]*(?:UN)?CORRECTED[ \t]+ACC?ELERO(?:GRAM|GRAPH)\b", re.I | re.M)
_VOLUME_2 = re.compile(
    r"^\s*(?P<count>\d+)\s+points?\s+of\s+(?P<quantity>accel|veloc|displ)\w*\s+data\s+equally\s+"
    r"spaced\s+at\s+(?P<dt>[\d.]+(?:E[+-]?\d+)?)\s*sec(?P<rest>.*)$",
    re.IGNORECASE,
)
_VOLUME_1 = re.compile(
    r"^\s*(?P<count>\d+)\s+(?P<quantity>accel|veloc|displ)\w*\s+points?\s+at\s+"
    r"(?P<rate>[\d.]+)\s*(?:pts|points|samples)\s*/\s*sec(?P<rest>.*)$",
    re.IGNORECASE,
)
_VALUES = re.compile(
    rb"^[ \t]*\d+[ \t]+(?:points?[ \t]+of[ \t]+(?:accel|veloc|displ)\w*[ \t]+data[ \t]+equally"
    rb"|(?:accel|veloc|displ)\w*[ \t]+points?[ \t]+at\s)",
    re.I | re.M,
)
_END = re.compile(_VALUES.pattern + rb"|^[ \t]*/&|" + _HEAD.pattern, re.I | re.M)
_UNIT = re.compile(
    r"(?:units?\s*(?::|of|are|=)|\bin)\s*(?P<unit>[CM]*M\s*/\s*S\w*(?:\s*/\s*S\w*)?\d?|CM|G\s*/\s*10|"
    r"1/10\s*G|G)(?![A-Z])",
    re.IGNORECASE,
)
_DEFAULT_UNITS = {"acceleration": "cm/s2", "velocity": "cm/s", "displacement": "cm"}
_MAX_HEADER = 60


def _recognise(lines: list[str], name: str) -> bool:
    header = lines[:_MAX_HEADER]
    return (
        bool(_FIRST.match(lines[0]) or _SPECTRA.match(lines[0]))
        and any(re.match(r"\s*station\s+(?:no|id)\b", line, re.IGNORECASE) for line in header)
        and any(re.match(r"\s*chan\s*\d+\s*:", line, re.IGNORECASE) for line in header)
        and not any("RENADIC" in line.upper() for line in header)
    )


@fortran_sections.accelerations
def _parse(text: TextFile) -> Iterator[tuple[str, Channel]]:
    if _SPECTRA.match(text.line(0)):
        text.refuse(
            "this file holds response spectra (volume 3), not acceleration; give the V2 file"
        )
    for first, stop in text.parts(_HEAD, fortran_sections.CHANNEL_END):
        words = text.lines(first, min(stop, first + _MAX_HEADER))
        line = text.find(_VALUES, first, stop)
        if line < 0:
            if not is_pairs_header(text, first):
                text.fail("no line with the number of samples below; the file is cut short", first)
            yield "acceleration", _described(read_pairs(text, first, stop), words)
        while line >= 0:
            section = _section(text, line, stop)
            yield section.quantity, _described(section.channel(text), words)
            line = text.find(_VALUES, section.stop, stop)


def _section(text: TextFile, line: int, stop: int) -> fortran_sections.Section:
    words = text.line(line)
    match = _VOLUME_2.match(words) or _VOLUME_1.match(words)
    if match is None:
        text.fail("number of samples, interval or rate cannot be read here", line)
    stated = match.groupdict()
    quantity = fortran_sections.QUANTITIES[match["quantity"].upper()]
    dt = float(stated["dt"]) if stated.get("dt") else 1 / float(stated["rate"])
    unit = _UNIT.search(match["rest"])
    width = fortran_sections.field_width(match["rest"]) or (10 if _VOLUME_2.match(words) else 9)
    stated_unit = _DEFAULT_UNITS[quantity] if _VOLUME_2.match(words) else ""
    if unit:
        stated_unit = canonical_unit(unit["unit"]).replace("1/10g", "g/10")
    dt = fortran_sections.positive_step(text, dt, line)
    end = min(stop, text.until(_END, line + 1))
    return fortran_sections.Section(
        quantity, int(match["count"]), line + 1, end, width, dt, stated_unit
    )


def _described(values: Channel, lines: list[str]) -> Channel:
    """Add what the text header says: the line below the station's number has its name."""
    network = station = name = component = ""
    start = None
    for number, line in enumerate(lines):
        found = re.match(r"\s*station\s+(?:no|id)\.?\s*(\w+)?(?=\s|$)", line, re.IGNORECASE)
        if found and not station and not name:
            station = found[1] or ""
            name = re.split(r"\s{3,}", lines[number + 1].strip())[0] if lines[number + 1 :] else ""
        found = re.match(
            r"\s*chan\s*\d+\s*:\s*(.*?)\s*(?:\(|location|from\s*$|$)", line, re.IGNORECASE
        )
        if found and not component:
            component = re.sub(r"\s*deg\w*\.?$", "", found[1], flags=re.IGNORECASE)
        found = re.match(r"\s*\d+\.(\w\w)\.\w+\.[\w-]{2}\.", line)
        if found and not network:
            network = found[1]
        found = re.search(r"(?:start|trigger)\s+time\s*:(.*)$", line, re.IGNORECASE)
        if found and start is None:
            start = american_time(found[1])
    # the earthquake's name and the time of it or of the record stand in lines 2 to 4
    words = [re.split(r"\s{3,}|\(origin", line.strip(), flags=re.I)[0] for line in lines[1:4]]
    words = [word for word in words if word and not word.upper().startswith("UNCORRECTED")]
    return replace(
        values,
        start_time=start,
        network=network,
        station=station,
        component=component,
        details={"station_name": name, "earthquake": ", ".join(words[:2]), **values.details},
    )


FORMAT = Format("CSMIP", _recognise, _parse)
