"""China Strong Motion Networks Centre (CSMNC): sixteen lines of header, then samples in rows.

The lines say ``COMP. EW``, ``UNCORRECTED ACCELERATION  UNIT: CM/SEC/SEC`` and ``NO. OF POINTS:  8800
EQUALLY SPACED INTERVALS OF:  0.005  SEC``. The recorder's time may be that of the trigger or of the
first sample, and is kept as a fact but not taken for the start.
"""

import re

from rockfrag.records.parsing.format import Channel, Format
from rockfrag.records.parsing.fortran_sections import positive_step
from rockfrag.records.parsing.quantities import canonical_unit, quantity_of
from rockfrag.records.parsing.text_file import TextFile

_SIZE = re.compile(
    r"NO\.?\s*OF\s+POINTS\s*:?\s*(?P<count>\d+)\s+EQUALLY\s+SPACED\s+INTERVALS?\s+OF\s*:?\s*"
    r"(?P<dt>[\d.]+(?:E[+-]?\d+)?)\s*SEC",
    re.IGNORECASE,
)
_QUANTITY = re.compile(
    r"\b(?P<quantity>ACCELERATION|VELOCITY|DISPLACEMENT)\b.*?\bUNIT\s*:\s*(?P<unit>\S+)",
    re.IGNORECASE,
)
_COMPONENT = re.compile(r"^\s*COMP\.?\s*:?\s*(?P<name>\S+)", re.IGNORECASE | re.MULTILINE)
_STATION = re.compile(
    r"^\s*STATION\s*:\s*(?P<code>\S+)(?:\s+(?P<north>[\d.]+)N\s+(?P<east>[\d.]+)E)?",
    re.IGNORECASE | re.MULTILINE,
)
_HEADER = 16
_MAX_HEADER = 30


def _recognise(lines: list[str], name: str) -> bool:
    header = lines[:_MAX_HEADER]
    return (
        any(_SIZE.search(line) for line in header)
        and any(_QUANTITY.search(line) for line in header)
        and bool(_STATION.search("\n".join(header)))
    )


def _parse(text: TextFile) -> list[Channel]:
    header = text.lines(0, _MAX_HEADER)
    at_size = next((i for i, line in enumerate(header) if _SIZE.search(line)), 0)
    size = _SIZE.search(header[at_size])
    words = "\n".join(header[:_HEADER])
    kind, station = _QUANTITY.search(words), _STATION.search(words)
    if size is None or kind is None or station is None:
        text.fail("the header of 16 lines states no number of points, unit or station")
    unit = canonical_unit(kind["unit"])
    if kind["quantity"].upper() != "ACCELERATION" or quantity_of(unit) != "acceleration":
        text.refuse(
            f"this file holds {kind['quantity'].lower()} in {kind['unit']}, not acceleration"
        )
    count, dt = int(size["count"]), positive_step(text, float(size["dt"]), at_size)
    component = _COMPONENT.search(words)
    magnitude = re.search(r"^\s*MAGNITUDE\s+([\d.]+)", words, re.IGNORECASE | re.MULTILINE)
    recorder = re.search(r"RECORDER\s+TIME\s*:\s*(.*)$", words, re.IGNORECASE | re.MULTILINE)
    return [
        Channel(
            npts=count,
            dt=dt,
            samples=lambda: text.counted(_HEADER, None, count),
            unit=unit,
            station=station["code"],
            component=component["name"] if component else "",
            details={
                "earthquake": " ".join(header[2].split()),
                "magnitude": float(magnitude[1]) if magnitude else None,
                "latitude": float(station["north"]) if station["north"] else None,
                "longitude": float(station["east"]) if station["east"] else None,
                "recorder_time": " ".join(recorder[1].split()) if recorder else "",
            },
        )
    ]


FORMAT = Format("CSMNC", _recognise, _parse, encoding="gb18030")
