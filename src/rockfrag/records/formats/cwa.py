"""Central Weather Administration of Taiwan (CWA, formerly CWB): ``#Key: value`` lines, four columns.

Files of 1999 begin with ``#StationCode``, later ones with ``#Earthquake Information``.
The columns are time and, in the order of ``#DataSequence``, up, north and east in gal; times are
local (UTC+8) where the key says ``GMT+08``.
"""

import re

from rockfrag.records.parsing.format import Channel, Format, field_width, in_columns
from rockfrag.records.parsing.quantities import canonical_unit
from rockfrag.records.parsing.text_file import TextFile
from rockfrag.records.parsing.timestamps import clock_time, step_of_times

_KEY = re.compile(r"^\s*#\s*(?P<key>[^:(]+?)\s*(?:\((?P<note>[^)]*)\))?\s*:\s*(?P<value>.*)$")
_TIME = re.compile(
    r"(?P<y>\d{4})/(?P<m>\d\d?)/(?P<d>\d\d?)[- T]+(?P<h>\d\d?):(?P<min>\d\d):(?P<s>\d\d(?:\.\d*)?)"
)
_MAX_HEADER = 60
_ORDER = ("U", "N", "E")


def _header(lines: list[str]) -> tuple[dict[str, tuple[str, str]], int]:
    """Return value and note of each key, and the number of lines above the samples."""
    facts: dict[str, tuple[str, str]] = {}
    for number, line in enumerate(lines[:_MAX_HEADER]):
        if line.strip() and not line.lstrip().startswith("#"):
            return facts, number
        match = _KEY.match(line)
        if match:
            facts.setdefault(match["key"].lower(), (match["value"].strip(), match["note"] or ""))
    return facts, min(len(lines), _MAX_HEADER)


def _recognise(lines: list[str], name: str) -> bool:
    if not re.match(r"^\s*#\s*(?:Earthquake Information|StationCode)", lines[0], re.I):
        return False
    facts, _ = _header(lines)
    return "stationcode" in facts and "samplerate" in facts


def _parse(text: TextFile) -> list[Channel]:
    facts, start = _header(text.lines(0, _MAX_HEADER))

    def value(key: str) -> str:
        return facts.get(key, ("", ""))[0]

    order = re.findall(r"\b([UNEZ])\s*\(", value("datasequence")) or list(_ORDER)
    values = text.numbers(start, None, field_width(f"({value('data')})") or 10)
    table = text.in_rows(values, len(order) + 1, start)
    try:
        rate = float(value("samplerate"))
    except ValueError:
        text.fail("#SampleRate is not a number")
    dt = text.interval(1 / rate if rate > 0 else 0.0, 0)
    if table.shape[0] > 1:
        measured = step_of_times(table[:, 0], text, start)
        if abs(measured - dt) > 1e-6:
            text.fail(f"times step by {measured:g} s, but #SampleRate gives {dt:g} s", start)
    _check_length(text, value("recordlength"), table.shape[0] * dt, start)
    moment, note = facts.get("starttime", ("", ""))
    match, zone = _TIME.search(moment), re.search(r"(?:GMT|UTC)\s*([+-]\d+)", note)
    began = clock_time(*match.groups()) if match else None
    shared = Channel(
        npts=table.shape[0],
        dt=dt,
        samples=table.copy,
        unit=canonical_unit(value("amplitudeunit").split(".")[0]),
        start_time=began and began - 3600.0 * (int(zone[1]) if zone else 0),
        network="TW",
        station=value("stationcode"),
        details={
            "station_name": value("stationname"),
            "earthquake": f"{value('origin time')} M {value('magnitude')}".strip(" M"),
            "instrument": value("instrumentkind"),
        },
    )
    return in_columns(shared, table[:, 1:], order)


def _check_length(text: TextFile, stated: str, length: float, line: int) -> None:
    """Check the length [s] of the record against the one stated, within its last printed digit."""
    try:
        promised = float(stated)
    except ValueError:
        return
    unit = 10.0 ** -len(stated.partition(".")[2])
    if abs(length - promised) > unit and not (text.cut_short and length < promised):
        text.fail(
            f"the header promises {stated} s of record but {length:g} s follow; "
            "the file is cut short, or its header is wrong",
            line,
        )


FORMAT = Format("CWA", _recognise, _parse)
