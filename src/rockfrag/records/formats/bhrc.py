"""Iran Strong Motion Network (BHRC), volume 1: three components L, V and T in g/10.

Each component has a text header that begins with ``* VOL1DS FILE`` and has its size and unit in ``NO. OF POINTS =
… DURATION = …`` and ``UNITS ARE SECONDS AND G/10``, seven lines of integers, seven of reals, then the samples in
rows (E13.6), and ends with ``/&``. Header lines are cut after 70 columns, so that only what is left of those is
read. The interval is one over the rate, the ninth real number, and must agree with the duration.
"""

import re
from collections.abc import Iterator

from rockfrag.records.parsing import format as form
from rockfrag.records.parsing.text_file import TextFile

_FIRST = re.compile(r"^\s*\*\s*VOL1DS\s+FILE", re.I)
_UNITS_LINE = re.compile(r"^\s*UNITS\b.*\bAND\b", re.I)
_UNIT = r"\bUNITS\s+ARE\s+SEC\w*\s+AND\s+(\S+)"
_POINTS = r"NO\.?\s+OF\s+POINTS\s*="
_FACTS = {
    "unit": _UNIT,
    "count": rf"{_POINTS}\s*(\d+)\s+DURATION\s*=\s*[\d.]",
    "duration": rf"{_POINTS}\s*\d+\s+DURATION\s*=\s*([\d.]+)",
    "component": r"^\s*COMP\.?\s+([A-Z]+)",
    "station": r"^\s*(.*?)\s+Station\s+[\d.]+\s*N",
    "latitude": r"\sStation\s+([\d.]+)\s*N",
    "longitude": r"\sStation\s+[\d.]+\s*N\s*([\d.]+)\s*E",
    "azimuths": r"\sStation\s+[\d.]+\s*N.*?Azimuth(.*)",
    "earthquake": r"Origin\s+Time\s*:\s*(.*)",
    "magnitude": r"\b(?-i:M[wsblL]?)\s*(\d\.\d)",
}
_INTEGER_LINES, _REAL_LINES, _WIDTH = 7, 7, 13
_MAX_HEADER = 30


def _parse(text: TextFile) -> Iterator[form.Channel]:
    """Channels of a file of this format, by its header as the head of the module says it."""
    for first, stop in text.parts(_FIRST, form.CHANNEL_END):
        at_units = text.find(_UNITS_LINE, first, min(stop, first + _MAX_HEADER))
        facts = form.facts_in(text.lines(first, at_units + 1), _FACTS)
        if not (facts["unit"] and facts["count"]):
            text.fail("no number of points, duration or unit below this line", first)
        at_integers = at_units + 1
        while at_integers < stop and not text.line(at_integers).strip():
            at_integers += 1
        at_reals = at_integers + _INTEGER_LINES
        count, component = int(facts.pop("count")), facts["component"].upper()
        dt = _step(text, at_reals, count, float(facts.pop("duration")))
        samples = text.numbers(at_reals + _REAL_LINES, stop, _WIDTH, count=count)
        azimuth = re.search(
            rf"\b{component or 'none'}\s*(\d{{1,3}})\b", facts.pop("azimuths")
        )
        facts |= {"network": "I1", "component": component}
        facts |= {"azimuth_deg": azimuth[1]} if azimuth else {}
        yield form.Channel(count, dt, samples).saying(facts)


def _step(text: TextFile, at_reals: int, count: int, duration: float) -> float:
    """Return the interval [s] of the rate that the header states, checked against its duration [s].

    ``at_reals``: line of the real numbers; ``count``: of samples.
    """
    fields = text.line(at_reals + 1)[:_WIDTH]
    problem = f"{fields.strip()[:20]!r} stands where the sampling rate is expected"
    rate = text.number(fields, problem, at_reals + 1)
    dt = text.interval(1 / rate if rate > 0 else 0.0, at_reals + 1)
    if abs(count * dt - duration) > 2 * dt + 0.001:
        text.fail(
            f"the header gives {count} points at {rate:g} a second but a duration of "
            f"{duration:g} s; one of them is wrong",
            at_reals + 1,
        )
    return float(f"{dt:.9g}")


FORMAT = form.Format(
    "BHRC", form.headed(_FIRST, re.compile(_UNIT, re.I), within=_MAX_HEADER), _parse
)
