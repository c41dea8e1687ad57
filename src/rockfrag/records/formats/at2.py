"""PEER strong-motion records (``.AT2``), in the header dialects of the database's generations.

PEER 1997 to NGA-West2: title, earthquake and station, quantity and unit, then a line with the number of
points and the interval (``NPTS=  4000, DT= .01000 SEC``, ``4000  .0100  NPTS, DT``, either order,
any case), then values in rows. The header may be longer and freer in files made from PEER's.
"""

import re
from collections.abc import Iterator
from typing import NamedTuple

from rockfrag.records.parsing.format import (
    QUANTITIES,
    Channel,
    Format,
    stated,
)
from rockfrag.records.parsing.number_fields import number_in
from rockfrag.records.parsing.quantities import canonical_unit, quantity_of
from rockfrag.records.parsing.stated_facts import factor_beside_unit
from rockfrag.records.parsing.text_file import TextFile, last_row
from rockfrag.records.parsing.writing import Written, text_writer

_NUMBER = r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[EeDd][+-]?\d+)?"
_COUNT = re.compile(rf"\bNPTS\s*[=:]\s*(?P<npts>{_NUMBER})", re.I)
_STEP = re.compile(
    rf"\bDT\s*[=:]\s*(?P<dt>{_NUMBER})\s*(?P<milliseconds>MS|MSEC\w*|MILLI\w*)?\b", re.I
)
_TRAILING = re.compile(
    rf"(?i)^\s*(?P<first>{_NUMBER})[\s,]+(?P<second>{_NUMBER})[\s,]+(?P<names>NPTS\W+DT|DT\W+NPTS)\b"
)
_LEADING = re.compile(
    rf"(?i)\b(?P<names>NPTS\s*[,;\s]\s*DT|DT\s*[,;\s]\s*NPTS)\W*?\s*[=:]?\s*"
    rf"(?P<first>{_NUMBER})[\s,;]+(?P<second>{_NUMBER})"
)
_WORDS_OF_UNIT = (
    r"(?P<unit>G(?:'?S)?(?![A-Z0-9/])|G\s*/\s*10\b|M?GALS?\b|"
    r"(?:[CM]?M|IN\w*)\s*/\s*\(?S\w*(?:\s*/\s*S\w*|\*\*2|\^2)?|[CM]?M\b|IN\b)"
)
_UNIT = re.compile(
    rf"\bUNITS?\s*(?:OF|ARE|IS)?\s*[:=]?\s*[(\[]?\s*{_WORDS_OF_UNIT}", re.I
)
_IN_UNIT = re.compile(
    rf"\b(?:ACC|VEL|DIS)\w*\.?\s*(?:\bIN\s+|[,(\[]\s*){_WORDS_OF_UNIT}", re.I
)
_QUANTITY = re.compile(r"\b(?P<quantity>ACCEL|VELOC|DISPL)\w*", re.I)
_HISTORY = rf"{_QUANTITY.pattern}\s+TIME\b"
_ENDINGS = {".VT2": "velocity", ".DT2": "displacement"}
_MAX_HEADER = 30
_WIDTH = 15
_COMPONENT = re.compile(
    r"(?i),\s*(?P<component>\d{1,3}|UP|DWN|DN|V|VERT\w*|[LTVH]\d|[NSEWLTXYZ]{1,2}|[NS]\d{1,2}[EW]|[BHELS][HNLG][ENZ123]\d?\d?"
    r"|FN|FP)\s*(?:\((?P<agency>[^)]*)\)\s*)?$"
)


class _Size(NamedTuple):
    """How a header states the size of its record."""

    line: int  # number of the line that does
    # words of the number of points, and of the interval
    points: str
    interval: str
    seconds: float  # in the unit of the interval


def _size(lines: list[str]) -> _Size | None:
    """Return where and how a header states its size; None if it does not."""
    for number, line in enumerate(lines[:_MAX_HEADER]):
        if pair := _TRAILING.match(line) or _LEADING.search(line):
            words = pair["first"], pair["second"]
            count, step = (
                words[::-1] if pair["names"].upper().startswith("DT") else words
            )
            return _Size(number, count, step, 1.0)
        points, interval = _COUNT.search(line), _STEP.search(line)
        if points and interval:
            seconds = 1e-3 if interval["milliseconds"] else 1.0
            return _Size(number, points["npts"], interval["dt"], seconds)
    return None


def _recognise(lines: list[str], name: str) -> bool:
    """Whether lines state their size as such files do, and are named PEER, a quantity, or by an ending."""
    size = _size(lines)
    header = lines[: size.line + 1] if size else []
    return size is not None and bool(
        re.search(r"\bPEER\b", "\n".join(header), re.I)
        or _quantity_and_unit(header) != ("", "")
        or name.upper().removesuffix(".GZ").endswith((".AT2", ".VT2", ".DT2"))
    )


def _quantity_and_unit(header: list[str]) -> tuple[str, str]:
    """Return the quantity and the canonical unit that the header states, each empty if it does not.

    The line nearest the numbers wins: titles above may quote the history of the file.
    """
    quantity = unit = ""
    for line in reversed(header):
        found = _UNIT.search(line) or _IN_UNIT.search(line)
        named = _QUANTITY.search(line)
        if found and not unit:
            unit = canonical_unit(found["unit"])
            if named:
                quantity = QUANTITIES[named["quantity"].upper()[:3]]
    if not quantity:
        history = stated(_HISTORY, header)
        quantity = QUANTITIES[history.upper()[:3]] if history else quantity_of(unit)
    return quantity, unit


def _parse(text: TextFile) -> Iterator[Channel]:
    """Channels of a file of this format, by its header as the head of the module says it."""
    header = text.lines(0, _MAX_HEADER)
    found = _size(header)
    if found is None:
        text.fail("no line with NPTS and DT above the data")
    again = _size(header[found.line + 1 : found.line + 2])
    if again is not None and again._replace(line=0) != found._replace(line=0):
        text.fail(
            "count and interval stand in this line and the one above, and differ",
            found.line + 1,
        )
    # number of the line below which the samples begin
    last = found.line + (again is not None)
    header = header[: last + 1]
    points, dt = number_in(found.points), number_in(found.interval)
    if points % 1 or not 1 <= points < 1e12:
        text.fail(f"NPTS must be a whole number of samples, not {found.points}", last)
    npts = int(points)
    dt = text.interval(dt * found.seconds if found.seconds != 1 else dt, last)
    quantity, unit = _quantity_and_unit(header)
    for number, line in enumerate(header):
        if problem := factor_beside_unit(line):
            text.fail(f"{problem}; apply it to the samples and take it out", number)
    quantity = quantity or _ENDINGS.get(text.name.upper().removesuffix(".GZ")[-4:], "")
    if quantity not in ("", "acceleration"):
        held = f"{quantity} history" + (f" in {unit}" if unit else "")
        text.refuse(f"this is a {held}, not acceleration; give the record's .AT2 file")
    start, stop = last + 1, last_row(text, last + 1)
    # PEER's columns, where neighbours may touch
    widths = (None, _WIDTH) if len(text.raw(start).rstrip()) == 5 * _WIDTH else ()
    values = text.numbers(start, stop, *widths, count=npts)
    yield Channel(npts, dt, values, unit).saying(_facts(header[:-1]))


def _facts(header: list[str]) -> dict[str, str]:
    """Take earthquake, station and component from PEER's line ``earthquake date, station, component``."""
    title = header[0].strip() if header else ""
    facts = {
        "title": title,
        "earthquake": "",
        "station": "",
        "component": "",
        "agency": "",
    }
    azimuth = stated(r"\bazimuth\s*=\s*(\d{1,3})", header)
    for line in header[1:]:
        found = _COMPONENT.search(line.strip())
        before = line.strip()[: found.start()] if found else ""
        parts = [part.strip() for part in before.split(",") if part.strip()]
        if found is None or len(parts) < 2:
            continue
        # the earthquake's date and hour may be parts of their own: "BORAH PEAK EQ, 10/28/83, 14:06, …"
        first = 1
        while first < len(parts) - 1 and re.fullmatch(r"[\d/:.\s]+", parts[first]):
            first += 1
        return facts | {
            "earthquake": ", ".join(parts[:first])
            .removeprefix("H1 for rotation:")
            .strip(),
            "station": ", ".join(parts[first:]),
            "component": azimuth or found["component"],
            "agency": (found["agency"] or "").strip(),
        }
    return facts | {"description": " ".join(header[1].split()) if header[1:] else ""}


FORMAT = Format("AT2", _recognise, _parse)


def _text(trace: Written) -> str:
    """A trace as a file of this format."""
    earthquake = trace.said("earthquake", otherwise="UNKNOWN EARTHQUAKE")
    station = trace.said("station", otherwise="UNKNOWN STATION")
    component = trace.said("component", "channel", otherwise="UNKNOWN")
    header = [
        "PEER STRONG MOTION DATABASE RECORD. WRITTEN BY ROCKFRAG.",
        f"{earthquake}, {station}, {component}",
        f"ACCELERATION TIME SERIES IN UNITS OF {trace.unit.upper()}",
        f"NPTS= {len(trace.samples):6d}, DT= {trace.dt:.12g} SEC",
    ]
    rows = ["".join(f"{value:24.16E}" for value in row) for row in trace.rows(5)]
    return "\n".join([*header, *rows, ""])


write = text_writer(_text)
"""Write one trace of acceleration as an AT2 file that reads back to the same samples."""
