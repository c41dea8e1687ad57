"""Plain text and CSV: one column of samples, or time and samples, with little or no header.

Understood are, above the numbers: nothing; comment lines (``#``, ``%``, ``!``, ``//``); a title;
titles of the columns (``Time [s], Acceleration [g]``); and a line with the number of samples and
the interval. A unit is known only where the titles state it.
"""

import os
import re
from dataclasses import dataclass
from itertools import chain
from typing import Any

import numpy as np
from numpy.typing import NDArray
from obspy import Stream

from rockfrag.errors import InputError
from rockfrag.files import write_text
from rockfrag.records.headed_formats import HEADED
from rockfrag.records.parsing.channel import Channel
from rockfrag.records.parsing.format import Format
from rockfrag.records.parsing.fortran_sections import positive_step
from rockfrag.records.parsing.number_table import (
    MAX_HEADER,
    NumberTable,
    are_numbers,
    number_in,
    number_table,
    numbers_of,
)
from rockfrag.records.parsing.quantities import TO_SI, canonical_unit, quantity_of
from rockfrag.records.parsing.text_file import TextFile
from rockfrag.records.parsing.timestamps import check_rising, step_of_times
from rockfrag.records.parsing.written_trace import one_trace

_UNIT = re.compile(r"[\[(_\s](?P<unit>[^\[\]()\s,;]+)[\])]?\s*$")
_OTHERS = re.compile(r"\b(?:veloc\w*|vel|displ\w*|disp)\b", re.IGNORECASE)
_SPECTRA = re.compile(r"\b(?:period\w*|freq\w*|spectr\w*|[ps]s?[av])\b", re.IGNORECASE)
_MIN_ROWS = 3
_MAX_WORDS = 2
"""Lines of free text that may stand above the numbers where no titles of columns follow them."""
_SPLIT = re.compile(r"\s*[,;\t]\s*|\s{2,}|\s+(?=[A-Za-z]*acc)", re.IGNORECASE)


@dataclass(frozen=True)
class _Layout:
    """The numbers of a file and the titles of its two columns, none where it has none."""

    table: NumberTable
    titles: list[str]


def _recognise(lines: list[str], name: str) -> bool:
    layout = _layout(lines)
    if layout is None or (layout.table.columns > 2 and layout.table.npts is None):
        return False
    rows = [numbers_of(line) for line in lines[layout.table.start :] if line.strip()]
    if not all(rows) or not are_numbers([*chain.from_iterable(rows)]):
        return False
    if any(headed.recognise(lines, name) for headed in HEADED):
        return False
    if layout.table.npts is not None:
        return True
    if len(rows) < _MIN_ROWS:
        return False
    widths = {len(row) for row in rows}
    if widths == {1}:
        return True
    if widths != {2}:
        return False
    times = np.array([number_in(row[0]) for row in rows])
    return bool((np.diff(times) > 0).mean() > 0.5)


def _layout(lines: list[str]) -> _Layout | None:
    """Find the numbers and the titles of two columns above them."""
    table = number_table(lines)
    if table is None:
        return None
    titles: list[str] = []
    for words in table.words:
        titles = _titles(words, titles)
    if table.free > _MAX_WORDS and not _titles(table.words[-1], []):
        return None
    return _Layout(table, titles)


def _titles(line: str, before: list[str]) -> list[str]:
    """Return titles of two columns if a line has them, else those found before."""
    words = [word.strip(' "') for word in _SPLIT.split(line.strip()) if word.strip(' "')]
    if len(words) == 2 and re.match(r"t(?:ime)?\b|t_|time_|period|freq", words[0], re.IGNORECASE):
        return words
    alone = len(words) == 1 and re.match(r"acc\w*\.?\s*[\[(]", words[0], re.IGNORECASE)
    return ["", words[0]] if alone else before


def _parse(text: TextFile, dt: float | None = None) -> list[Channel]:
    layout = _layout(text.lines(0, MAX_HEADER + 1))
    if layout is None:
        text.fail("no rows of numbers below a short header", 0)
    if dt is not None and not (np.isfinite(dt) and dt > 0):
        raise InputError(f"dt must be a positive number of seconds, got {dt}.")
    _refuse_other_titles(text, layout)
    steps: tuple[dict[str, Any], ...] = ()
    if layout.table.npts is not None:
        values, interval = _counted(text, layout)
    elif layout.table.columns == 2:
        table = text.table(layout.table.start, 2)
        values = table[:, 1].copy()
        interval, steps = _interval(text, layout, table[:, 0], dt)
    else:
        values = text.table(layout.table.start, 1)[:, 0].copy()
        if layout.table.dt is None and dt is None:
            text.fail("one column without sampling interval; give it with dt= (in seconds)")
        interval = layout.table.dt or dt or 0.0
    return [
        Channel(
            npts=layout.table.npts or values.size,
            dt=positive_step(text, interval, 0),
            samples=values.copy,
            unit=_unit(layout.titles),
            details={"title": layout.table.title, "steps": steps},
        )
    ]


def _counted(text: TextFile, layout: _Layout) -> tuple[NDArray[np.float64], float]:
    """Return samples and interval [s] of a file with a line ``npts dt``."""
    npts, dt = layout.table.npts, layout.table.dt
    assert npts is not None and dt is not None
    if layout.table.columns == 2:
        table = text.table(layout.table.start, 2)
        if table.shape[0] == npts:
            check_rising(table[:, 0], text, layout.table.start)
            measured = step_of_times(table[:, 0], text, layout.table.start)
            if abs(measured - dt) > 1e-6 * dt:
                text.fail(f"the header gives dt = {dt:g} s, but times step by {measured:g} s")
            return table[:, 1].copy(), dt
    return text.counted(layout.table.start, None, npts), dt


def _interval(
    text: TextFile, layout: _Layout, times: NDArray[np.float64], dt: float | None
) -> tuple[float, tuple[dict[str, Any], ...]]:
    """Return the interval [s] of a time column, or the user's in its place and a note of that."""
    if dt is None:
        return step_of_times(times, text, layout.table.start), ()
    check_rising(times, text, layout.table.start)
    mean = float((times[-1] - times[0]) / max(times.size - 1, 1))
    if abs(mean - dt) <= 1e-6 * dt:
        return dt, ()
    return dt, ({"step": "replace time column", "dt_s": dt, "mean_step_in_file_s": mean},)


def _unit(titles: list[str]) -> str:
    """Return the unit that the title of the samples states, or an empty string."""
    match = _UNIT.search(titles[1]) if len(titles) == 2 else None
    unit = canonical_unit(match["unit"].replace("_", "/")) if match else ""
    unit = "cm/s2" if unit in {"cm/s/s2"} else unit
    return unit if unit in TO_SI else ""


def _refuse_other_titles(text: TextFile, layout: _Layout) -> None:
    if len(layout.titles) != 2:
        return
    match = _UNIT.search(layout.titles[1])
    unit = canonical_unit(match["unit"]) if match else ""
    held = _OTHERS.search(layout.titles[1])
    if any(_SPECTRA.search(title) for title in layout.titles):
        titles = " and ".join(layout.titles)
        text.refuse(f"the columns {titles!r} are a spectrum, not acceleration in time")
    if held or quantity_of(unit) in ("velocity", "displacement"):
        text.refuse(
            f"the second column is {layout.titles[1]!r}, not acceleration", layout.table.start - 1
        )


FORMAT = Format("PLAINTEXT", _recognise, _parse, wants_dt=True)
is_format, read = FORMAT.is_format, FORMAT.read


def write(stream: Stream, filename: str | os.PathLike[str], **_: Any) -> None:
    """Write one trace as CSV, time and acceleration, that read back to the same samples.

    The titles state the unit where ``stats.rockfrag.unit`` has it.

    Raises
    ------
    InputError
        If the stream has more or fewer than one trace, or a sample is not finite.
    """
    trace, samples = one_trace(stream, filename)
    unit = trace.stats.get("rockfrag", {}).get("unit", "")
    dt = float(f"{trace.stats.delta:.12g}")
    rows = [f"Time [s],Acceleration [{unit}]" if unit else "Time [s],Acceleration"]
    rows += [f"{i * dt:.12g},{value!r}" for i, value in enumerate(samples.tolist())]
    write_text("\n".join(rows) + "\n", filename)
