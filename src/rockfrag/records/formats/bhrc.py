"""Iran Strong Motion Network (BHRC), volume 1: three components L, V and T in g/10.

Each component has a text header that begins with ``* VOL1DS FILE`` and has its size and unit in
``NO. OF POINTS = … DURATION = …`` and ``UNITS ARE SECONDS AND G/10``, seven lines of integers, seven
of reals, then the samples in rows (E13.6), and ends with ``/&``. Header lines are cut after 70
columns, so that only what is left of those is read. The interval is one over the rate, the ninth
real number, and must agree with the duration.
"""

import re
from collections.abc import Iterator

from rockfrag.records.parsing import format as form
from rockfrag.records.parsing.format import leading_number, stated
from rockfrag.records.parsing.quantities import canonical_unit
from rockfrag.records.parsing.text_file import TextFile

_FIRST = re.compile(r"^\s*\*\s*VOL1DS\s+FILE", re.I)
_HEAD = re.compile(rb"^[ \t]*\*[ \t]*VOL1DS[ \t]+FILE", re.I | re.M)
_UNITS_LINE = re.compile(rb"^[ \t]*UNITS\b.*\bAND\b", re.I | re.M)
_UNIT = re.compile(r"\bUNITS\s+ARE\s+SEC\w*\s+AND\s+(?P<unit>\S+)", re.I)
_SIZE = re.compile(
    r"NO\.?\s+OF\s+POINTS\s*=\s*(?P<count>\d+)\s+DURATION\s*=\s*(?P<duration>[\d.]+)", re.I
)
_STATION = re.compile(
    r"^\s*(?P<name>.*?)\s+Station\s+(?P<north>[\d.]+)\s*N\s*(?P<east>[\d.]+)\s*E"
    r"(?:.*?Azimuth(?P<azimuths>.*))?$",
    re.I | re.M,
)
_INTEGER_LINES, _REAL_LINES, _WIDTH = 7, 7, 13
_MAX_HEADER = 30


def _parse(text: TextFile) -> Iterator[form.Channel]:
    for first, stop in text.parts(_HEAD, form.CHANNEL_END):
        at_units = text.find(_UNITS_LINE, first, min(stop, first + _MAX_HEADER))
        lines = text.lines(first, at_units + 1)
        words = "\n".join(lines)
        unit, size = _UNIT.search(words), _SIZE.search(words)
        if unit is None or size is None:
            text.fail("no number of points, duration or unit below this line", first)
        at_integers = at_units + 1
        while at_integers < stop and not text.line(at_integers).strip():
            at_integers += 1
        at_reals = at_integers + _INTEGER_LINES
        count, component = int(size["count"]), stated(r"^\s*COMP\.?\s+([A-Z]+)", lines).upper()
        station = _STATION.search(words)
        yield form.Channel(
            npts=count,
            dt=_step(text, at_reals, count, float(size["duration"])),
            samples=text.counted(at_reals + _REAL_LINES, stop, count, _WIDTH).copy,
            unit=canonical_unit(unit["unit"]),
            network="I1",
            component=component,
            station=station["name"].strip() if station else "",
            details=_details(lines, station, component),
        )


def _step(text: TextFile, at_reals: int, count: int, duration: float) -> float:
    """Return the interval [s] of the rate, checked against the duration."""
    fields = text.line(at_reals + 1)[:_WIDTH]
    try:
        rate = float(fields)
    except ValueError:
        text.fail(
            f"{fields.strip()[:20]!r} stands where the sampling rate is expected", at_reals + 1
        )
    dt = text.interval(1 / rate if rate > 0 else 0.0, at_reals + 1)
    if abs(count * dt - duration) > 2 * dt + 0.001:
        text.fail(
            f"the header gives {count} points at {rate:g} a second but a duration of "
            f"{duration:g} s; one of them is wrong",
            at_reals + 1,
        )
    return float(f"{dt:.9g}")


def _details(lines: list[str], station: re.Match[str] | None, component: str) -> dict[str, object]:
    azimuths = (station["azimuths"] or "") if station and component else ""
    azimuth = re.search(rf"\b{component}\s*(\d{{1,3}})\b", azimuths)
    return {
        "earthquake": " ".join(stated(r"Origin\s+Time\s*:\s*(.*)", lines).split()),
        "magnitude": leading_number(stated(r"\b(?-i:M[wsblL]?)\s*(\d\.\d)", lines)),
        "latitude": float(station["north"]) if station else None,
        "longitude": float(station["east"]) if station else None,
        "azimuth_deg": float(azimuth[1]) if azimuth else None,
    }


FORMAT = form.Format("BHRC", form.headed(_FIRST, _UNIT, within=_MAX_HEADER), _parse)
