"""CSMIP/CDMG volumes 1 and 2 (California Strong Motion Instrumentation Program).

Each channel has a text header, 100 integers (16I5), 50 or 100 reals (8F10) and its values, and ends with a line
``/&``. Volume 2 has acceleration, velocity and displacement below lines such as ``1138 POINTS OF ACCEL DATA
EQUALLY SPACED AT  .020 SEC.  (UNITS: CM/SEC/SEC)``; volume 1 has one line such as ``13200 Accelerogram points at
200 pts/sec in units of g .  Format: (8f9.6)``, and before 1985 pairs of time and acceleration in g/10.
"""

import re
from collections.abc import Iterator

from rockfrag.records.parsing import format as form
from rockfrag.records.parsing.stated_peak import StatedPeak, with_checked_peak
from rockfrag.records.parsing.text_file import TextFile
from rockfrag.records.parsing.timestamps import (
    american_time,
    is_pairs_header,
    read_pairs,
)

_FIRST = re.compile(r"^\s*(?:un)?corrected\s+acc?elero(?:gram|graph)\b", re.I)
_SPECTRA = re.compile(r"^\s*(?:response|fourier)\b.*\bspectr", re.I)
_VOLUME_2 = re.compile(
    r"(?i)^\s*(?P<count>\d+)\s+points?\s+of\s+(?P<quantity>accel|veloc|displ)\w*\s+data\s+equally\s+"
    r"spaced\s+at\s+(?P<dt>[\d.]+(?:E[+-]?\d+)?)\s*sec(?P<rest>.*)$"
)
_VOLUME_1 = re.compile(
    r"(?i)^\s*(?P<count>\d+)\s+(?P<quantity>accel|veloc|displ)\w*\s+points?\s+at\s+"
    r"(?P<rate>[\d.]+)\s*(?:pts|points|samples)\s*/\s*sec(?P<rest>.*)$"
)
_VALUES = re.compile(
    r"(?i)^\s*\d+\s+(?:points?\s+of\s+(?:accel|veloc|displ)\w*\s+data\s+equally"
    r"|(?:accel|veloc|displ)\w*\s+points?\s+at\s)"
)
_END = re.compile(rf"{_VALUES.pattern}|^\s*/&|{_FIRST.pattern}", re.I)
_UNIT = re.compile(
    r"(?i)(?:units?\s*(?::|of|are|=)|\bin)\s*(?P<unit>[CM]*M\s*/\s*S\w*(?:\s*/\s*S\w*)?\d?|CM|G\s*/\s*10|"
    r"1/10\s*G|G)(?![A-Z])"
)
_STATION = re.compile(r"^\s*station\s+(?:no|id)\.?\s*(\w+)?(?=\s|$)", re.I)
_START = re.compile(r"(?:start|trigger)\s+time\s*:(.*)$", re.I)
_DEFAULT_UNITS = {"acceleration": "cm/s2", "velocity": "cm/s", "displacement": "cm"}
_PEAK_OF_VOLUME_2 = re.compile(
    r"PEAK\s+ACCELERATION\s*=\s*(?P<value>[-+]?[\d.]+)\s+(?P<unit>[A-Z]+(?:/[A-Z/*\d]+)?)",
    re.I,
)
_PEAK = re.compile(r"\bMAX\s*=\s*(?P<value>[-+]?[\d.]+)\s*(?P<unit>G)\b", re.I)
_MAX_HEADER = 60


_BEGINS = re.compile(f"{_FIRST.pattern}|{_SPECTRA.pattern}", re.I)
_PARTS = (
    re.compile(rf"^\s*{part}", re.I)
    for part in (r"station\s+(?:no|id)\b", r"chan\s*\d+\s*:")
)
_headed = form.headed(_BEGINS, *_PARTS, within=_MAX_HEADER)


def _recognise(lines: list[str], name: str) -> bool:
    others = any("RENADIC" in line.upper() for line in lines[:_MAX_HEADER])
    return _headed(lines, name) and not others


def _parse(text: TextFile) -> Iterator[form.Channel]:
    """Channels of a file of this format, by its header as the head of the module says it."""
    if _SPECTRA.match(text.line(0)):
        text.refuse(
            "this file holds response spectra (volume 3), not acceleration; give the V2 file"
        )
    for first, stop in text.parts(_FIRST, form.CHANNEL_END):
        words = text.lines(first, min(stop, first + _MAX_HEADER))
        sections = list(text.parts(_VALUES, _END, first, stop))
        for line, end in sections:
            found = _described(_section(text, line, end), words)
            peak = _peak(words, in_volume_2=bool(_VOLUME_2.match(text.line(line))))
            if found.quantity == "acceleration":
                found = with_checked_peak(found, peak, text.name, text.cut_short)
            yield found
        if not sections:
            if not is_pairs_header(text, first):
                text.fail(
                    "no line with the number of samples below; the file is cut short",
                    first,
                )
            found = _described(read_pairs(text, first, stop), words)
            peak = _peak(words, in_volume_2=False)
            yield with_checked_peak(found, peak, text.name, text.cut_short)


def _peak(words: list[str], in_volume_2: bool) -> StatedPeak:
    """Return the peak that the words above one channel state; volume 2 has that of volume 1 as well."""
    match = form.first_match(_PEAK_OF_VOLUME_2 if in_volume_2 else _PEAK, words)
    if match is None:
        return StatedPeak("", "")
    unit = match["unit"].upper().replace("CMS/", "CM/")
    return StatedPeak(match["value"], unit)


def _section(text: TextFile, line: int, stop: int) -> form.Channel:
    """A channel of a file, from the line that states its samples."""
    words = text.line(line)
    second = _VOLUME_2.match(words)
    match = second or _VOLUME_1.match(words)
    if match is None:
        text.fail("number of samples, interval or rate cannot be read here", line)
    quantity = form.QUANTITIES[match["quantity"].upper()[:3]]
    dt = float(match["dt"]) if second else 1 / float(match["rate"])
    width = form.field_width(match["rest"]) or (10 if second else 9)
    unit = _DEFAULT_UNITS[quantity] if second else ""
    if stated := _UNIT.search(match["rest"]):
        unit = stated["unit"]
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


def _described(values: form.Channel, lines: list[str]) -> form.Channel:
    """Add what the text header says: the line below the station's number has its name."""
    at_station = next(
        (i for i, line in enumerate(lines) if _STATION.match(line)), len(lines)
    )
    below = next(iter(lines[at_station + 1 :]), "")
    component = form.stated(
        r"^\s*chan\s*\d+\s*:\s*(.*?)\s*(?:\(|location|from\s*$|$)", lines
    )
    # the earthquake's name and the time of it or of the record stand in lines 2 to 4
    words = [
        re.split(r"\s{3,}|\(origin", line.strip(), flags=re.I)[0] for line in lines[1:4]
    ]
    words = [
        word for word in words if word and not word.upper().startswith("UNCORRECTED")
    ]
    starts = (american_time(match[1]) for match in map(_START.search, lines) if match)
    facts = {
        "start_time": next(filter(None, starts), None),
        "network": form.stated(r"^\s*\d+\.(\w\w)\.\w+\.[\w-]{2}\.", lines),
        "station": form.stated(_STATION.pattern, lines[at_station : at_station + 1]),
        "component": re.sub(r"\s*deg\w*\.?$", "", component, flags=re.I),
        "station_name": re.split(r"\s{3,}", below.strip())[0],
        "earthquake": ", ".join(words[:2]),
    }
    return values.saying(facts)


FORMAT = form.Format("CSMIP", _recognise, _parse)
