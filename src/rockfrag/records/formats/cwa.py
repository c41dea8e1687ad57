"""Central Weather Administration of Taiwan (CWA, formerly CWB): ``#Key: value`` lines, four columns.

Files of 1999 begin with ``#StationCode``, later ones with ``#Earthquake Information``.
The columns are time and, in the order of ``#DataSequence``, up, north and east in gal; times are
local (UTC+8) where the key says ``GMT+08``.
"""

import re

from rockfrag.records.parsing import format as form
from rockfrag.records.parsing.stated_peak import StatedPeak, with_checked_peak
from rockfrag.records.parsing.text_file import TextFile
from rockfrag.records.parsing.time_column import Notes, TimeColumn
from rockfrag.records.parsing.timestamps import time_of

_FIRST = re.compile(r"^\s*#\s*(?:Earthquake Information|StationCode)", re.I)
_NEEDED = [
    re.compile(rf"^\s*#\s*{key}\s*[:(]", re.I) for key in ("stationcode", "samplerate")
]
_PEAKS = re.compile(r"^\s*#\s*amplitude\s*max\w*\b", re.I)
_EXTREMES = re.compile(r"\b([UNEZ])\s*(?:\([^)]*\))?\s*[:=]([^:=A-Z]*)")
_MAX_HEADER = 60
_ORDER = ("U", "N", "E")


def _parse(text: TextFile) -> list[form.Channel]:
    """Channels of a file of this format, by its header as the head of the module says it."""
    header = text.lines(0, _MAX_HEADER)
    below = (
        i for i, x in enumerate(header) if x.strip() and not x.lstrip().startswith("#")
    )
    start = next(below, len(header))
    facts = form.header_keys(line.lstrip(" \t#") for line in header[:start])
    order = re.findall(r"\b([UNEZ])\s*\(", facts["datasequence"]) or list(_ORDER)
    values = text.numbers(start, None, form.field_width(f"({facts['data']})") or 10)
    table = text.in_rows(values, len(order) + 1, start)
    rate = text.number(facts["samplerate"], "#SampleRate is not a number")
    dt = text.interval(1 / rate if rate > 0 else 0.0, 0)
    notes: Notes = ()
    if table.shape[0] > 1:
        notes = TimeColumn(table[:, 0], text, start).check(dt, "#SampleRate gives")
    _check_length(text, facts["recordlength"], table.shape[0] * dt, start)
    began = time_of(facts["starttime"])
    zone = form.stated(
        r"^\s*#\s*starttime\s*\(.*(?:GMT|UTC)\s*([+-]\d+)[^)]*\)\s*:", header
    )
    known = {
        "unit": facts["amplitudeunit"].split(".")[0],
        "start_time": began and began - 3600.0 * int(zone or 0),
        "network": "TW",
        "station": facts["stationcode"],
        "station_name": facts["stationname"],
        "earthquake": f"{facts['origin time']} M {facts['magnitude']}".strip(" M"),
        "instrument": facts["instrumentkind"],
    }
    shared = form.Channel(table.shape[0], dt, table, steps=notes).saying(known)
    numbers = _peaks(header[:start])
    return [
        with_checked_peak(
            channel,
            StatedPeak(numbers.get(channel.component, ""), channel.unit),
            text.name,
            text.cut_short,
        )
        for channel in form.in_columns(shared, table[:, 1:], order)
    ]


def _peaks(header: list[str]) -> dict[str, str]:
    """Return the larger of the extremes of each component, ``#AmplitudeMAX. U: 16.2~-11.5``, without sign."""
    found = {}
    for line in header:
        if _PEAKS.match(line):
            for axis, extremes in _EXTREMES.findall(line):
                numbers = re.findall(r"\d+\.?\d*", extremes)
                found[axis] = max(numbers, key=float, default="")
    return found


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


FORMAT = form.Format("CWA", form.headed(_FIRST, *_NEEDED, within=_MAX_HEADER), _parse)
