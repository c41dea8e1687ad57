"""China Strong Motion Networks Centre (CSMNC): sixteen lines of header, then samples in rows.

The lines say ``COMP. EW``, ``UNCORRECTED ACCELERATION  UNIT: CM/SEC/SEC`` and ``NO. OF POINTS:  8800
EQUALLY SPACED INTERVALS OF:  0.005  SEC``. The recorder's time may be that of the trigger or of the
first sample, and is kept as a fact but not taken for the start.
"""

import re
from collections.abc import Iterator

from rockfrag.records.parsing.format import Channel, Format, headed, leading_number, stated
from rockfrag.records.parsing.quantities import canonical_unit, quantity_of
from rockfrag.records.parsing.text_file import TextFile

_SIZE = re.compile(
    r"NO\.?\s*OF\s+POINTS\s*:?\s*(?P<count>\d+)\s+EQUALLY\s+SPACED\s+INTERVALS?\s+OF\s*:?\s*"
    r"(?P<dt>[\d.]+(?:E[+-]?\d+)?)\s*SEC",
    re.I,
)
_QUANTITY = re.compile(
    r"\b(?P<quantity>ACCELERATION|VELOCITY|DISPLACEMENT)\b.*?\bUNIT\s*:\s*(?P<unit>\S+)", re.I
)
_STATION = re.compile(
    r"^\s*STATION\s*:\s*(?P<code>\S+)(?:\s+(?P<north>[\d.]+)N\s+(?P<east>[\d.]+)E)?", re.I | re.M
)
_HEADER = 16
_MAX_HEADER = 30


def _parse(text: TextFile) -> Iterator[Channel]:
    header = text.lines(0, _MAX_HEADER)
    at_size = next((i for i, line in enumerate(header) if _SIZE.search(line)), 0)
    size, header = _SIZE.search(header[at_size]), header[:_HEADER]
    words = "\n".join(header)
    kind, station = _QUANTITY.search(words), _STATION.search(words)
    if size is None or kind is None or station is None:
        text.fail("the header of 16 lines states no number of points, unit or station")
    unit = canonical_unit(kind["unit"])
    if kind["quantity"].upper() != "ACCELERATION" or quantity_of(unit) != "acceleration":
        text.refuse(
            f"this file holds {kind['quantity'].lower()} in {kind['unit']}, not acceleration"
        )
    count = int(size["count"])
    yield Channel(
        npts=count,
        dt=text.interval(float(size["dt"]), at_size),
        samples=lambda: text.counted(_HEADER, None, count),
        unit=unit,
        station=station["code"],
        component=stated(r"^\s*COMP\.?\s*:?\s*(\S+)", header),
        details={
            "earthquake": " ".join(header[2].split()),
            "magnitude": leading_number(stated(r"^\s*MAGNITUDE\s+([\d.]+)", header)),
            "latitude": leading_number(station["north"] or ""),
            "longitude": leading_number(station["east"] or ""),
            "recorder_time": " ".join(stated(r"RECORDER\s+TIME\s*:\s*(.*)$", header).split()),
        },
    )


FORMAT = Format(
    "CSMNC",
    headed(None, _SIZE, _QUANTITY, _STATION, within=_MAX_HEADER),
    _parse,
    encoding="gb18030",
)
