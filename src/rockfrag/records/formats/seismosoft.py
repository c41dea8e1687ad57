"""SeismoSoft accelerograms: four lines of description, ``Time[s] Accel[g]``, then two columns."""

import re
from collections.abc import Iterator

from rockfrag.records.parsing.format import Channel, Format, header_keys
from rockfrag.records.parsing.quantities import canonical_unit, quantity_of
from rockfrag.records.parsing.text_file import TextFile
from rockfrag.records.parsing.time_column import TimeColumn
from rockfrag.records.parsing.writing import Written, text_writer

_COLUMNS = re.compile(
    r"(?i)^\s*time\s*[\[(]\s*(?:s|sec|seconds)\s*[\])][\s,;]+"
    r"(?P<quantity>accel\w*|veloc\w*|displ\w*)\.?\s*[\[(](?P<unit>[^\])]+)[\])]\s*$"
)
_BEFORE_COMPONENT = re.compile(r"^(?P<station>[^()]+)\((?P<component>[^()]+)\)\s*$")
_BEHIND_COMPONENT = re.compile(r"^(?P<component>\d{3})\s+(?P<station>\D.*)$")
_KEYS = re.compile(r"\s*(?:recording station|source|frequency range)\s*:", re.I)
_MAX_HEADER = 40


def _titles(lines: list[str]) -> list[tuple[int, re.Match[str]]]:
    matches = enumerate(map(_COLUMNS.match, lines[:_MAX_HEADER]))
    return [(number, match) for number, match in matches if match]


def _recognise(lines: list[str], name: str) -> bool:
    """Whether lines are those of such a file, by the words of its header."""
    # the titles of the columns alone are a plain two-column file
    return any(
        _KEYS.match(line) for number, _ in _titles(lines)[:1] for line in lines[:number]
    )


def _parse(text: TextFile) -> Iterator[Channel]:
    """Channels of a file of this format, by its header as the head of the module says it."""
    columns, titles = _titles(text.lines(0, _MAX_HEADER))[0]
    unit = canonical_unit(titles["unit"])
    if quantity_of(unit) != "acceleration":
        text.refuse(
            f"the file holds {titles['quantity']}[{titles['unit']}], not acceleration",
            columns,
        )
    header = header_keys(text.lines(0, columns))
    values, widths = text.rows(columns + 1)
    text.check_widths(widths, 2, columns + 1)
    table = values.reshape(-1, 2)
    place = header["recording station"]
    # TOLMEZZO(000) or 090 CDMG STATION 47381
    found = _BEFORE_COMPONENT.match(place) or _BEHIND_COMPONENT.match(place)
    station, component = found.group("station", "component") if found else (place, "")
    facts = {
        "unit": unit,
        "station": station.strip(),
        "component": component.strip(),
        "earthquake": text.line(0).rstrip("."),
        "source": header["source"],
        "frequency_range": header["frequency range"],
        "recording_station": place,
    }
    dt, steps = TimeColumn(table[:, 0], text, columns + 1).interval_beside(
        text.asked_dt, "dt= gives"
    )
    samples = table[:, 1].copy()
    yield Channel(table.shape[0], dt, samples, steps=steps).saying(facts)


FORMAT = Format("SEISMOSOFT", _recognise, _parse)


def _text(trace: Written) -> str:
    """A trace as a file of this format."""
    component = trace.facts.get("component") or trace.facts.get("channel")
    header = [
        trace.said("earthquake", otherwise="Unknown earthquake"),
        f"Source: {trace.said('source', otherwise='rockfrag')}",
        f"Recording station: {trace.said('station', otherwise='unknown')}"
        + (f"({component})" if component else ""),
        "Frequency range: not stated",
        f"Time[s]\tAccel[{trace.unit}]",
    ]
    rows = [f"{time}\t{value}" for time, value in trace.timed()]
    return "\n".join([*header, *rows, ""])


write = text_writer(_text)
"""Write one trace as a SeismoSoft accelerogram that reads back to the same samples."""
