"""China Strong Motion Networks Centre (CSMNC): sixteen lines of header, then samples in rows.

The lines say ``COMP. EW``, ``UNCORRECTED ACCELERATION  UNIT: CM/SEC/SEC`` and ``NO. OF POINTS:  8800
EQUALLY SPACED INTERVALS OF:  0.005  SEC``. The recorder's time may be that of the trigger or of the
first sample, and is kept as a fact but not taken for the start.
"""

import re
from collections.abc import Iterator

from rockfrag.records.parsing import format as form
from rockfrag.records.parsing.quantities import canonical_unit, quantity_of
from rockfrag.records.parsing.stated_peak import StatedPeak, with_checked_peak
from rockfrag.records.parsing.text_file import TextFile

_SIZE = re.compile(
    r"(?i)NO\.?\s*OF\s+POINTS\s*:?\s*(?P<count>\d+)\s+EQUALLY\s+SPACED\s+INTERVALS?\s+OF\s*:?\s*"
    r"(?P<dt>[\d.]+(?:E[+-]?\d+)?)\s*SEC"
)
_QUANTITY = re.compile(
    r"\b(?P<quantity>ACCELERATION|VELOCITY|DISPLACEMENT)\b.*?\bUNIT\s*:\s*(?P<unit>\S+)",
    re.I,
)
_STATION = r"^\s*STATION\s*:\s*(\S+)"
_FACTS = {
    "station": _STATION,
    "latitude": r"^\s*STATION\s*:\s*\S+\s+([\d.]+)N\s",
    "longitude": r"^\s*STATION\s*:\s*\S+\s+[\d.]+N\s+([\d.]+)E",
    "component": r"^\s*COMP\.?\s*:?\s*(\S+)",
    "magnitude": r"^\s*MAGNITUDE\s+([\d.]+)",
    "peak": r"^\s*PEAK\s+VALUE\s*:\s*([-+\d.]+)",
    "recorder_time": r"RECORDER\s+TIME\s*:\s*(.*)$",
}
_HEADER = 16
_MAX_HEADER = 30


def _parse(text: TextFile) -> Iterator[form.Channel]:
    """Channels of a file of this format, by its header as the head of the module says it."""
    header = text.lines(0, _MAX_HEADER)
    at_size = next((i for i, line in enumerate(header) if _SIZE.search(line)), 0)
    size, header = _SIZE.search(header[at_size]), header[:_HEADER]
    kind, facts = form.first_match(_QUANTITY, header), form.facts_in(header, _FACTS)
    if size is None or kind is None or not facts["station"]:
        text.fail("the header of 16 lines states no number of points, unit or station")
    unit, held = kind["unit"], kind["quantity"]
    if (
        held.upper() != "ACCELERATION"
        or quantity_of(canonical_unit(unit)) != "acceleration"
    ):
        text.refuse(f"this file holds {held.lower()} in {unit}, not acceleration")
    count, dt = int(size["count"]), text.interval(float(size["dt"]), at_size)
    found = form.Channel(count, dt, text.numbers(_HEADER, count=count), unit)
    peak = StatedPeak(facts.pop("peak"), unit)
    found = found.saying({"earthquake": " ".join(header[2].split()), **facts})
    yield with_checked_peak(found, peak, text.name, text.cut_short)


FORMAT = form.Format(
    "CSMNC",
    form.headed(None, _SIZE, _QUANTITY, re.compile(_STATION, re.I), within=_MAX_HEADER),
    _parse,
    encoding="gb18030",
)
