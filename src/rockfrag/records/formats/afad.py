"""Turkish national network (AFAD, formerly TR-NSMN): ``KEY : value`` lines, then three columns.

The first line is ``STRONG GROUND MOTION RECORDS OF TURKIYE``; ``NUMBER OF DATA`` and ``SAMPLING
INTERVAL`` give the size, ``RAW PGA VALUES (gal)`` the unit, and a line of orientations (``N-S  E-W
U-D``) stands above the samples. Files are in UTF-8 or in the Turkish ISO 8859-9.
"""

import re

from rockfrag.records.formats.esm import time_of
from rockfrag.records.parsing.format import Channel, Format
from rockfrag.records.parsing.fortran_sections import header_keys, number_of, positive_step
from rockfrag.records.parsing.quantities import canonical_unit
from rockfrag.records.parsing.text_file import TextFile

_FIRST = re.compile(r"^\s*STRONG\s+GROUND\s+MOTION\s+RECORDS?\s+OF\s+TURK", re.IGNORECASE)
_TITLES = re.compile(r"^\s*(?:[NSEWUD]\s*-?\s*[NSEWUD]\b\s*){1,3}$")
_UNIT = re.compile(r"\bPGA\b[^()]*\((?P<unit>[^()]+)\)", re.IGNORECASE)
_DISTANT = re.compile(r"(?P<north>-?\d+\.\d+)\s*N\s*-?\s*(?P<east>-?\d+\.\d+)\s*E", re.IGNORECASE)
_MAX_HEADER = 40


def _recognise(lines: list[str], name: str) -> bool:
    return bool(_FIRST.match(lines[0])) and any(_TITLES.match(line) for line in lines[1:40])


def _parse(text: TextFile) -> list[Channel]:
    header = text.lines(0, _MAX_HEADER)
    titles = next((i for i, line in enumerate(header) if _TITLES.match(line)), -1)
    if titles < 0:
        text.fail("no line of orientations (N-S E-W U-D) above the samples")
    facts = header_keys(header[:titles])
    unit = next((canonical_unit(m["unit"]) for m in map(_UNIT.search, header) if m), "")
    count = int(number_of(text, facts, "number of data"))
    dt = positive_step(text, number_of(text, facts, "sampling interval"), 0)
    components = re.findall(r"[NSEWUD]\s*-?\s*[NSEWUD]", header[titles])
    values = text.counted(titles + 1, None, count * len(components))
    table = values[: values.size // len(components) * len(components)].reshape(-1, len(components))
    time = facts.get("record time", "")
    # only times in GMT are known to be UTC
    known = re.search(r"\((?:GMT|UTC)\)", time, re.IGNORECASE)
    place = _DISTANT.search(facts.get("station coordinates", ""))
    magnitude = re.match(r"\s*(\d+(?:\.\d+)?)", facts.get("earthquake magnitude", ""))
    return [
        Channel(
            npts=count,
            dt=dt,
            samples=table[:, column].copy,
            unit=unit,
            start_time=time_of(time.split("(")[0].strip()) if known else None,
            network="TK",
            station=facts.get("station id", ""),
            component=component.replace(" ", ""),
            details={
                "station_name": facts.get("place", ""),
                "earthquake": facts.get("earthquake date", ""),
                "magnitude": float(magnitude[1]) if magnitude else None,
                "latitude": float(place["north"]) if place else None,
                "longitude": float(place["east"]) if place else None,
                "instrument": facts.get("recorder type", ""),
            },
        )
        for column, component in enumerate(components)
    ]


FORMAT = Format("AFAD", _recognise, _parse, encoding="iso8859-9")
