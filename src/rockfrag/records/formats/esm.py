"""ESM/ITACA ASCII (header format DYNA): lines ``KEY: value``, then one sample a line.

The Turkish networks write the same header with other notations of date and time, and AFAD's TADAS a
line without a key above it.
"""

import re
from collections.abc import Iterator
from contextlib import suppress

from obspy import UTCDateTime

from rockfrag.records.parsing.format import Channel, Format
from rockfrag.records.parsing.quantities import canonical_unit, quantity_of
from rockfrag.records.parsing.text_file import TextFile
from rockfrag.records.parsing.timestamps import clock_time

_KEY = re.compile(r"^(?P<key>[A-Z][A-Z0-9_/^ ]*?)\s*:(?P<value>.*)$")
_NEEDED = ("SAMPLING_INTERVAL_S", "NDATA", "UNITS")
_MAX_HEADER = 120
_SAMPLE_TIME = "DATE_TIME_FIRST_SAMPLE_YYYYMMDD_HHMMSS"
_CLOCK = r"[ T_]+(?P<h>\d{1,2}):(?P<min>\d\d):(?P<s>\d\d(?:\.\d*)?)$"
_DATES = (
    r"^(?P<d>\d{1,2})[/.-](?P<m>\d{1,2})[/.-](?P<y>\d{4})",
    r"^(?P<y>\d{4})[/.-](?P<m>\d{1,2})[/.-](?P<d>\d{1,2})",
)
_DIGITS = r"^(?P<y>\d{4})(?P<m>\d\d)(?P<d>\d\d)[_ T](?P<h>\d\d)(?P<min>\d\d)(?P<s>\d\d(?:\.\d*)?)$"


def _header(lines: list[str]) -> tuple[dict[str, str], int]:
    """Return the keys and the number of lines above the samples."""
    facts: dict[str, str] = {}
    for number, line in enumerate(lines):
        match = _KEY.match(line)
        if match:
            facts[match["key"]] = match["value"].strip()
        elif facts or not re.match(r"\s*[A-Za-z]|\s*$", line):
            return facts, number
    return facts, len(lines)


def _recognise(lines: list[str], name: str) -> bool:
    facts, _ = _header(lines[:_MAX_HEADER])
    return all(key in facts for key in _NEEDED) and "STATION_CODE" in facts


def _parse(text: TextFile) -> Iterator[Channel]:
    facts, start = _header(text.lines(0, _MAX_HEADER))
    for key in _NEEDED:
        if not facts.get(key):
            text.fail(f"the header gives no {key}")
    unit = canonical_unit(facts["UNITS"])
    kind = facts.get("DATA_TYPE", "").lower() or quantity_of(unit)
    if re.search("vel|dis|spectr", kind) or quantity_of(unit) != "acceleration":
        text.refuse(
            f"this file holds {kind or 'no acceleration'} in {facts['UNITS']}, not acceleration"
        )
    try:
        count, dt = int(facts["NDATA"]), float(facts["SAMPLING_INTERVAL_S"])
    except ValueError:
        text.fail("NDATA or SAMPLING_INTERVAL_S is not a number")
    if count < 1:
        text.fail(f"the header promises {count} samples")
    location = facts.get("LOCATION", "")
    yield Channel(
        npts=count,
        dt=text.interval(dt, 0),
        samples=lambda: text.counted(start, None, count),
        unit=unit,
        start_time=time_of(facts.get(_SAMPLE_TIME, "")),
        network=facts.get("NETWORK", ""),
        station=facts.get("STATION_CODE", ""),
        # the Turkish variant has the name of a place here
        location=location if len(location) <= 2 else "",
        code=facts.get("STREAM", ""),
        component=facts.get("STREAM") or facts.get("COMPONENT", ""),
        details=_details(facts),
    )


def time_of(words: str) -> UTCDateTime | None:
    """Return the time in words such as ``20190728_160905.700`` or ``14/11/2010 23:09:19.3``."""
    patterns = (_DIGITS, *(date + _CLOCK for date in _DATES))
    match = next(filter(None, (re.match(pattern, words) for pattern in patterns)), None)
    return clock_time(*match.group("y", "m", "d", "h", "min", "s")) if match else None


def _details(facts: dict[str, str]) -> dict[str, object]:
    named = ("EVENT_NAME", "EVENT_DATE_YYYYMMDD", "EVENT_TIME_HHMMSS")
    numbers = {
        "magnitude": facts.get("MAGNITUDE_W") or facts.get("MAGNITUDE_L"),
        "distance_km": facts.get("EPICENTRAL_DISTANCE_KM"),
        "latitude": facts.get("STATION_LATITUDE_DEGREE"),
        "longitude": facts.get("STATION_LONGITUDE_DEGREE"),
    }
    details: dict[str, object] = {
        "earthquake": " ".join(facts[key] for key in named if facts.get(key)),
        "station_name": facts.get("STATION_NAME", ""),
        "processing": facts.get("PROCESSING", ""),
        "licence": facts.get("DATA_LICENSE", ""),
    }
    for key, words in numbers.items():
        with suppress(ValueError):
            details[key] = float(words) if words else None
    return details


FORMAT = Format("ESM", _recognise, _parse)
