"""Turkish national network (AFAD, formerly TR-NSMN): ``KEY : value`` lines, then three columns.

The first line is ``STRONG GROUND MOTION RECORDS OF TURKIYE``; ``NUMBER OF DATA`` and ``SAMPLING
INTERVAL`` give the size, ``RAW PGA VALUES (gal)`` the unit, and a line of orientations (``N-S  E-W
U-D``) stands above the samples. Files are in UTF-8 or in the Turkish ISO 8859-9.
"""

import re

from rockfrag.records.parsing import format as form
from rockfrag.records.parsing.stated_peak import StatedPeak, with_checked_peak
from rockfrag.records.parsing.text_file import TextFile
from rockfrag.records.parsing.timestamps import time_of

_FIRST = re.compile(r"^\s*STRONG\s+GROUND\s+MOTION\s+RECORDS?\s+OF\s+TURK", re.I)
_TITLES = re.compile(r"^\s*(?:[NSEWUD]\s*-?\s*[NSEWUD]\b\s*){1,3}$")
_UNIT = r"\bPGA\b[^()]*\(([^()]+)\)"
_PEAKS = r"\bPGA\b[^()]*\([^()]+\)\s*:\s*(.*)$"
_PEAK = re.compile(r"\(\s*([NSEWUD]\s*-?\s*[NSEWUD])\s*\)\s*([-+\d.]+)")
_PLACE = {
    "latitude": r"(-?\d+\.\d+)\s*N\s*-?\s*-?\d+\.\d+\s*E",
    "longitude": r"-?\d+\.\d+\s*N\s*-?\s*(-?\d+\.\d+)\s*E",
}
_MAX_HEADER = 40


def _parse(text: TextFile) -> list[form.Channel]:
    """Channels of a file of this format, by its header as the head of the module says it."""
    header = text.lines(0, _MAX_HEADER)
    # orientations (N-S E-W U-D) above the samples
    titles = [_TITLES.match(line) is not None for line in header].index(True)
    facts = form.header_keys(header[:titles])
    count = int(_number_of(text, facts, "number of data"))
    dt = text.interval(_number_of(text, facts, "sampling interval"), 0)
    components = re.findall(r"[NSEWUD]\s*-?\s*[NSEWUD]", header[titles])
    values = text.numbers(titles + 1, count=count * len(components))
    table = values[: values.size // len(components) * len(components)].reshape(
        -1, len(components)
    )
    time = facts["record time"]
    known = {
        "unit": form.stated(_UNIT, header),
        "network": "TK",
        "station": facts["station id"],
        "station_name": facts["place"],
        "earthquake": facts["earthquake date"],
        "magnitude": facts["earthquake magnitude"],
        "instrument": facts["recorder type"],
        **form.facts_in([facts["station coordinates"]], _PLACE),
    }
    # only times in GMT are known to be UTC
    in_utc = re.search(r"\((?:GMT|UTC)\)", time, re.I)
    start = time_of(time.split("(")[0]) if in_utc else None
    shared = form.Channel(count, dt, table, start_time=start).saying(known)
    names = [name.replace(" ", "") for name in components]
    stated = _PEAK.findall(form.stated(_PEAKS, header))
    numbers = {name.replace(" ", ""): number for name, number in stated}
    return [
        with_checked_peak(
            channel,
            StatedPeak(numbers.get(channel.component, ""), channel.unit),
            text.name,
            text.cut_short,
        )
        for channel in form.in_columns(shared, table, names)
    ]


def _number_of(text: TextFile, facts: dict[str, str], key: str) -> float:
    """Return the number of a header's key, a positive one."""
    words = facts[key]
    match = re.match(r"\d+(?:\.\d*)?(?:[Ee][+-]?\d{1,3})?|\.\d+", words)
    value = float(match[0]) if match else 0.0
    if not 0 < value < 1e12:
        found = f" but {words[:40]!r}" if words else ""
        text.fail(f"the header gives no number for {key!r}{found}")
    return value


FORMAT = form.Format(
    "AFAD",
    form.headed(_FIRST, _TITLES, within=_MAX_HEADER),
    _parse,
    encoding="iso8859-9",
)
