"""ESM/ITACA ASCII (header format DYNA): lines ``KEY: value``, then one sample a line.

The Turkish networks write the same header with other notations of date and time, and AFAD's TADAS a
line without a key above it.
"""

import re
from collections.abc import Iterator

from rockfrag.records.parsing.format import Channel, Format
from rockfrag.records.parsing.quantities import canonical_unit, quantity_of
from rockfrag.records.parsing.stated_peak import StatedPeak, with_checked_peak
from rockfrag.records.parsing.text_file import TextFile
from rockfrag.records.parsing.timestamps import time_of

_KEY = re.compile(r"^(?P<key>[A-Z][A-Z0-9_/^ ]*?)\s*:(?P<value>.*)$")
_NEEDED = ("SAMPLING_INTERVAL_S", "NDATA", "UNITS")
_MAX_HEADER = 120
_FACTS = {
    "network": "NETWORK",
    "station": "STATION_CODE",
    "location": "LOCATION",
    "code": "STREAM",
    "distance_km": "EPICENTRAL_DISTANCE_KM",
    "latitude": "STATION_LATITUDE_DEGREE",
    "longitude": "STATION_LONGITUDE_DEGREE",
    "station_name": "STATION_NAME",
    "processing": "PROCESSING",
    "licence": "DATA_LICENSE",
}
_EARTHQUAKE = ("EVENT_NAME", "EVENT_DATE_YYYYMMDD", "EVENT_TIME_HHMMSS")
_SAMPLE_TIME = "DATE_TIME_FIRST_SAMPLE_YYYYMMDD_HHMMSS"


def _header(lines: list[str]) -> tuple[dict[str, str], int]:
    """Return what the keys of the header state, and the number of lines above the samples."""
    keys = [
        (number, match)
        for number, line in enumerate(lines)
        if (match := _KEY.match(line))
    ]
    facts = {match["key"]: match["value"].strip() for _, match in keys}
    return facts, keys[-1][0] + 1 if keys else 0


def _recognise(lines: list[str], name: str) -> bool:
    facts, _ = _header(lines[:_MAX_HEADER])
    return all(key in facts for key in _NEEDED) and "STATION_CODE" in facts


def _parse(text: TextFile) -> Iterator[Channel]:
    """Channels of a file of this format, by its header as the head of the module says it."""
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
    dt = text.interval(dt, 0)
    samples = text.numbers(start, count=count)
    known = {name: facts.get(key, "") for name, key in _FACTS.items()}
    # the Turkish variant has the name of a place here
    known["location"] = known["location"] if len(known["location"]) <= 2 else ""
    known["component"] = known["code"] or facts.get("COMPONENT", "")
    known["magnitude"] = facts.get("MAGNITUDE_W") or facts.get("MAGNITUDE_L", "")
    known["earthquake"] = " ".join(facts[key] for key in _EARTHQUAKE if facts.get(key))
    start_time = time_of(facts.get(_SAMPLE_TIME, ""))
    channel = Channel(count, dt, samples, unit, start_time=start_time).saying(known)
    peak = StatedPeak(facts.get("PGA_CM/S^2", ""), "cm/s2")
    yield with_checked_peak(channel, peak, text.name, text.cut_short)


FORMAT = Format("ESM", _recognise, _parse)
