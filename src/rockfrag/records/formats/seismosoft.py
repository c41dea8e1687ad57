"""SeismoSoft accelerograms: four lines of description, ``Time[s] Accel[g]``, then two columns."""

import os
import re

from obspy import Stream

from rockfrag.files import write_text
from rockfrag.records.parsing.format import Channel, Format, one_trace, stated_unit
from rockfrag.records.parsing.quantities import canonical_unit, quantity_of
from rockfrag.records.parsing.text_file import TextFile
from rockfrag.records.parsing.timestamps import step_of_times

_COLUMNS = re.compile(
    r"^\s*time\s*[\[(]\s*(?:s|sec|seconds)\s*[\])][\s,;]+"
    r"(?P<quantity>accel\w*|veloc\w*|displ\w*)\.?\s*[\[(](?P<unit>[^\])]+)[\])]\s*$",
    re.IGNORECASE,
)
_BEFORE_COMPONENT = re.compile(r"^(?P<station>[^()]+)\((?P<component>[^()]+)\)\s*$")
_BEHIND_COMPONENT = re.compile(r"^(?P<component>\d{3})\s+(?P<station>\D.*)$")
_MAX_HEADER = 40


def _find_columns(lines: list[str]) -> int:
    return next((i for i, line in enumerate(lines[:_MAX_HEADER]) if _COLUMNS.match(line)), -1)


def _recognise(lines: list[str], name: str) -> bool:
    # the titles of the columns alone are a plain two-column file
    columns = _find_columns(lines)
    return columns > 0 and any(
        re.match(r"\s*(recording station|source|frequency range)\s*:", line, re.IGNORECASE)
        for line in lines[:columns]
    )


def _parse(text: TextFile) -> list[Channel]:
    columns = _find_columns(text.lines(0, _MAX_HEADER))
    titles = _COLUMNS.match(text.line(columns)) if columns >= 0 else None
    if titles is None:
        text.fail("no line 'Time[s] Accel[g]' above the data")
    unit = canonical_unit(titles["unit"])
    if quantity_of(unit) != "acceleration":
        text.refuse(
            f"the file holds {titles['quantity']}[{titles['unit']}], not acceleration", columns
        )
    header = {"earthquake": text.line(0)}
    for line in text.lines(0, columns):
        key, colon, value = line.partition(":")
        if colon:
            header[key.strip().lower()] = value.strip()
    table = text.table(columns + 1, 2)
    # TOLMEZZO(000) or 090 CDMG STATION 47381
    place = header.get("recording station", "")
    found = _BEFORE_COMPONENT.match(place) or _BEHIND_COMPONENT.match(place)
    station, component = (
        (found["station"].strip(), found["component"].strip()) if found else (place, "")
    )
    return [
        Channel(
            npts=table.shape[0],
            dt=step_of_times(table[:, 0], text, columns + 1),
            samples=lambda: table[:, 1].copy(),
            unit=unit,
            station=station,
            component=component,
            details={
                "earthquake": header["earthquake"].rstrip("."),
                "source": header.get("source", ""),
                "frequency_range": header.get("frequency range", ""),
                "recording_station": place,
            },
        )
    ]


FORMAT = Format("SEISMOSOFT", _recognise, _parse)


def write(stream: Stream, filename: str | os.PathLike[str], **_: object) -> None:
    """Write one trace as a SeismoSoft accelerogram that reads back to the same samples."""
    trace, samples = one_trace(stream, filename)
    unit, facts = stated_unit(trace, filename), trace.stats.rockfrag
    dt = float(f"{trace.stats.delta:.12g}")
    component = str(facts.get("component") or trace.stats.channel or "")
    station = " ".join(str(trace.stats.station or "unknown").split())
    lines = [
        " ".join(str(facts.get("earthquake") or "Unknown earthquake").split()),
        f"Source: {' '.join(str(facts.get('source') or 'rockfrag').split())}",
        f"Recording station: {station}" + (f"({component})" if component else ""),
        "Frequency range: not stated",
        f"Time[s]\tAccel[{unit}]",
        *(f"{i * dt:.12g}\t{value!r}" for i, value in enumerate(samples.tolist())),
    ]
    write_text("\n".join(lines) + "\n", filename)
