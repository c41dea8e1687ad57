"""Text with titled columns, of which some are acceleration: ``time, acc_NS(gal), acc_EW(gal)``.

The titles stand directly above the numbers, or have a line of units (``s, g, g``) between. Columns
of velocity, displacement and other quantities are left out beside titled accelerations. What a title
states neither by a word nor by a unit, but by an orientation (``NS``, ``HNE``, ``090``), is taken for
acceleration without a unit; so are all columns that do not say what they are where none says that it is
acceleration: the user who gives their unit knows. Each column has the time column left of it; without
one the interval is that of a line such as ``SAMPLING RATE= 100Hz`` above the titles, where a line such as
``UNIT  = gal(cm/s/s)`` may also state the unit of all columns (as the Japan Meteorological Agency does).
"""

import re
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rockfrag.records.headed_formats import HEADED
from rockfrag.records.parsing.channel import Channel
from rockfrag.records.parsing.format import Format
from rockfrag.records.parsing.fortran_sections import positive_step
from rockfrag.records.parsing.number_table import is_row, width_of
from rockfrag.records.parsing.quantities import TO_SI, canonical_unit, quantity_of
from rockfrag.records.parsing.text_file import TextFile
from rockfrag.records.parsing.timestamps import step_of_times

_TIME = re.compile(r"^(?:elapsed\s*)?(?:t|time|times|sec|seconds?)(?![a-z])", re.IGNORECASE)
_SPECTRA = re.compile(r"^(?:period|freq|omega)|\bspectr|\bps[av]\b", re.IGNORECASE)
_WORDS = {
    "acceleration": re.compile(r"(?<![a-z])a(?:cc(?:el\w*|n)?)?(?![a-z])|accel", re.IGNORECASE),
    "velocity": re.compile(r"(?<![a-z])(?:v|vel(?:oc\w*)?)(?![a-z])", re.IGNORECASE),
    "displacement": re.compile(r"(?<![a-z])(?:d|u|dis(?:pl?\w*)?)(?![a-z])", re.IGNORECASE),
}
_ORIENTATION = re.compile(
    r"^(?:[NSEWUD]-?[NSEWUD]|[NEZUVLTXYH]|UP|VERT\w*|H[12]|[BHE][NLGH][ENZ123]|[NS]\d{1,2}[EW]|\d{1,3}"
    r"|north\w*|east\w*|radial|transverse|longitudinal|ch(?:annel)?\W?\d+)$",
    re.IGNORECASE,
)
_BRACKETED = re.compile(r"[\[({](?P<unit>[^\[\](){}]*)[\])}]")
_RATE = re.compile(
    r"\bsampl\w*\s*(?:rate|freq\w*)?\s*(?:\(hz\))?\s*[=:]?\s*(?P<rate>\d+(?:\.\d+)?)\s*(?:hz|sps|\s*,*$)",
    re.IGNORECASE,
)
_STEP = re.compile(
    r"\bdt\s*(?:\(s\w*\))?\s*[=:]\s*(?P<dt>\d*\.?\d+)\s*(?:s|sec\w*)?\s*,*$", re.IGNORECASE
)
_ALL_UNITS = re.compile(r"\bunits?\s*[=:]\s*(?P<unit>[^\s(,]+)", re.IGNORECASE)
_MIN_ROWS = 3
_MAX_HEADER = 40


@dataclass(frozen=True)
class _Column:
    """What a title says of its column: quantity, unit and the name of the component."""

    title: str
    quantity: str
    unit: str
    component: str


def _recognise(lines: list[str], name: str) -> bool:
    found = _titles(lines)
    if found is None or any(headed.recognise(lines, name) for headed in HEADED):
        return False
    start, titles, _ = found
    rows = [line for line in lines[start:] if line.strip()]
    timed = any(_TIME.match(title) for title in titles)
    return (
        len(rows) >= _MIN_ROWS
        and all(is_row(line) for line in rows)
        # a last row that is cut short is told with its line
        and {width_of(line) for line in rows[:-1]} == {len(titles)}
        and len(titles) > (2 if timed else 1)
        and not (len(titles) == 2 and any(_SPECTRA.search(title) for title in titles))
    )


def _titles(lines: list[str]) -> tuple[int, list[str], list[str]] | None:
    """Return the first row of numbers, the titles above it and the units between, if any."""
    start = next((i for i, line in enumerate(lines[:_MAX_HEADER]) if is_row(line)), 0)
    width = width_of(lines[start]) if start else 0
    above = [i for i in range(start) if lines[i].strip()]
    if width < 2 or not above:
        return None
    cells = _cells(lines[above[-1]], lines[start], width)
    if cells and len(above) > 1 and all(_is_unit(cell) for cell in cells):
        titles = _cells(lines[above[-2]], lines[start], width)
        return (start, titles, cells) if titles else None
    return (start, cells, [""] * width) if cells else None


def _cells(line: str, row: str, width: int) -> list[str]:
    """Split a line into as many titles as a row has columns; empty if it cannot be."""
    plain = line.strip().lstrip("#%!/ ")
    separators = [separator for separator in (";", ",", "\t") if separator in row]
    patterns = [re.escape(separator) for separator in separators] or [
        r"\s{2,}|\t",
        r"\s+(?![\[(])",
        r"\s+",
    ]
    for pattern in patterns:
        cells = [cell.strip(" \t\"'") for cell in re.split(pattern, plain.rstrip(" \t,;"))]
        if len(cells) == width and all(cells):
            return cells
    return []


def _is_unit(cell: str) -> bool:
    unit = canonical_unit(cell.strip("[](){}"))
    return unit in {"s", "ms", "-"} or quantity_of(unit) != ""


def _column(title: str, unit_below: str) -> _Column:
    bracketed = _BRACKETED.search(title)
    words = title if bracketed is None else title[: bracketed.start()] + title[bracketed.end() :]
    unit = (
        canonical_unit(bracketed["unit"])
        if bracketed
        else canonical_unit(unit_below.strip("[](){}"))
    )
    if not unit:
        # acc_g, NS_cm/s2, accel m/s^2
        head, _, last = re.sub(r"[_\s]+", " ", words.strip()).rpartition(" ")
        if head and quantity_of(canonical_unit(last)):
            words, unit = head, canonical_unit(last)
    quantity = quantity_of(unit) or next(
        (name for name, pattern in _WORDS.items() if pattern.search(words.replace("_", " "))), ""
    )
    bare = words.strip(" _-.:,")
    if not quantity and _ORIENTATION.match(bare):
        quantity = "acceleration"
    pattern = _WORDS.get(quantity)
    component = pattern.sub("", words.replace("_", " "), count=1) if pattern else words
    component = " ".join(component.replace("[]", "").split()).strip(" -.:,")
    return _Column(title, quantity, unit if unit in TO_SI else "", component)


def _parse(text: TextFile, dt: float | None = None) -> list[Channel]:
    found = _titles(text.lines(0, _MAX_HEADER + 1))
    if found is None:
        text.fail("no titles of columns above the rows of numbers", 0)
    start, titles, units = found
    if _SPECTRA.search(titles[0]):
        text.refuse(
            f"the first column is {titles[0]!r}: a spectrum, not acceleration in time", start - 1
        )
    above = text.lines(0, start - 1)
    unit_of_all = next((canonical_unit(m["unit"]) for m in map(_ALL_UNITS.search, above) if m), "")
    columns = [
        _column(title, unit or unit_of_all) for title, unit in zip(titles, units, strict=True)
    ]
    timed = [i for i, title in enumerate(titles) if _TIME.match(title)]
    chosen = [
        i
        for i, column in enumerate(columns)
        if column.quantity == "acceleration" and i not in timed
    ]
    if not chosen:
        chosen = [i for i, column in enumerate(columns) if not column.quantity and i not in timed]
    if not chosen:
        text.refuse(
            f"none of the columns {', '.join(titles)} is acceleration; if one is, write the word or "
            "the unit into its title",
            start - 1,
        )
    table = text.table(start, len(titles))
    stated = _stated_step(above)
    if not timed and None not in (dt, stated) and dt != stated:
        text.fail(f"the header states an interval of {stated:g} s, not {dt:g} s; leave dt out")
    names = [columns[i].component for i in chosen]
    return [
        Channel(
            npts=table.shape[0],
            dt=positive_step(
                text, _interval(text, start, table, timed, i, titles, units, stated, dt), start
            ),
            samples=table[:, i].copy,
            unit=columns[i].unit,
            component=names[n] if names.count(names[n]) == 1 else titles[i],
            details={"title": titles[i]},
        )
        for n, i in enumerate(chosen)
    ]


def _stated_step(above: list[str]) -> float | None:
    """Return the interval [s] that the lines above the titles state, or None."""
    for line in above:
        rate, step = _RATE.search(line), _STEP.search(line)
        if rate and float(rate["rate"]) > 0:
            return float(f"{1 / float(rate['rate']):.9g}")
        if step:
            return float(step["dt"])
    return None


def _interval(
    text: TextFile,
    start: int,
    table: NDArray[np.float64],
    timed: list[int],
    column: int,
    titles: list[str],
    units: list[str],
    stated: float | None,
    dt: float | None,
) -> float:
    """Return the interval [s] that the user names, else of the time column, else that of the header."""
    left = [i for i in timed if i < column] or timed[:1]
    if dt is not None:
        return dt
    if not left and stated is not None:
        return stated
    if not left:
        text.fail("no column is titled as time; give the sampling interval with dt= (in seconds)")
    step = step_of_times(table[:, left[-1]], text, start)
    milliseconds = re.search(
        r"\b(?:ms|msec|millis\w*)\b", f"{titles[left[-1]]} {units[left[-1]]}", re.IGNORECASE
    )
    return step * 1e-3 if milliseconds else step


FORMAT = Format("COLUMNS", _recognise, _parse, wants_dt=True, encoding="latin-1")
is_format, read = FORMAT.is_format, FORMAT.read
