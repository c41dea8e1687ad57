"""Plain text and CSV: one column of samples, or time and samples, with little or no header.

Understood are, above the numbers: nothing; comment lines (``#``, ``%``, ``!``, ``//``); a title;
titles of the columns (``Time [s], Acceleration [g]``); and a line with the number of samples and
the interval. A unit is known only where the titles state it.
"""

import os
import re
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from obspy import Stream

from rockfrag.errors import InputError
from rockfrag.files import write_text
from rockfrag.records.formats import (
    at2,
    cosmos,
    csmip,
    cwa,
    esm,
    geonet,
    renadic,
    seismosoft,
    smc,
    usc,
)
from rockfrag.records.parsing.channel import Channel
from rockfrag.records.parsing.format import Format
from rockfrag.records.parsing.fortran_sections import positive_step
from rockfrag.records.parsing.quantities import TO_SI, canonical_unit, quantity_of
from rockfrag.records.parsing.text_file import TextFile
from rockfrag.records.parsing.timestamps import check_rising, step_of_times

_NUMBER = r"[+-]?(?:\d+[.,]?\d*|[.,]\d+)(?:[EeDd][+-]?\d+)?"
_TOKEN = re.compile(_NUMBER)
_COUNT_AND_STEP = re.compile(rf"^\s*(?P<npts>\d+)[\s,;]+(?P<dt>{_NUMBER})\s*$")
_COMMENT = re.compile(r"^\s*(?:#|%|!|//|\"?\s*$)")
_UNIT = re.compile(r"[\[(_\s](?P<unit>[^\[\]()\s,;]+)[\])]?\s*$")
_OTHERS = re.compile(r"\b(veloc\w*|vel|displ\w*|disp)\b", re.IGNORECASE)
_MAX_HEADER = 20
_STRICTER = (at2, cosmos, csmip, cwa, esm, geonet, renadic, seismosoft, smc, usc)
"""Formats with a header that says what they are; what they know is not plain text."""

_MIN_ROWS = 3
_MAX_WORDS = 2
"""Lines of free text that may stand above the numbers where no titles of columns follow them."""
_STEP = re.compile(rf"\bdt\s*[=:]\s*(?P<dt>{_NUMBER})", re.IGNORECASE)
_SPLIT = re.compile(r"\s*[,;\t]\s*|\s{2,}|\s+(?=[A-Za-z]*acc)", re.IGNORECASE)


@dataclass(frozen=True)
class _Layout:
    """Where the numbers start and what stands above them."""

    start: int
    columns: int
    npts: int | None
    dt: float | None
    titles: list[str]
    name: str


def _recognise(lines: list[str], name: str) -> bool:
    layout = _layout(lines)
    if layout is None:
        return False
    rows = [line for line in lines[layout.start :] if line.strip()]
    if not rows or not all(_is_row(line) for line in rows):
        return False
    if any(module.FORMAT.recognise(lines, name) for module in _STRICTER):
        return False
    if layout.npts is not None:
        return True
    if len(rows) < _MIN_ROWS:
        return False
    widths = {_width(line) for line in rows}
    if widths == {1}:
        return True
    if widths != {2}:
        return False
    times = np.array([_first_number(line) for line in rows])
    return bool((np.diff(times) > 0).mean() > 0.5)


def first_odd_row(lines: list[str]) -> int | None:
    """Return the first line (from zero) that keeps mostly numeric text from being plain text."""
    layout = _layout(lines)
    if layout is None:
        return None
    rows = [i for i in range(layout.start, len(lines)) if lines[i].strip()]
    odd = [i for i in rows if not _is_row(lines[i]) or _width(lines[i]) != layout.columns]
    return odd[0] if odd and 2 * len(odd) < len(rows) else None


def _layout(lines: list[str]) -> _Layout | None:
    """Find the first row of numbers and read the header above it."""
    titles: list[str] = []
    words: list[str] = []
    step = None
    for number, line in enumerate(lines[:_MAX_HEADER]):
        if _COMMENT.match(line) or not _is_row(line):
            titles = _titles(line.strip(" \t#%!/"), titles)
            stated = _STEP.search(line)
            step = _number(stated["dt"]) if stated else step
            if not _COMMENT.match(line):
                words.append(line.strip())
            continue
        if len(words) > _MAX_WORDS and not _titles(words[-1], []):
            return None
        name = words[0] if words else ""
        counted = _COUNT_AND_STEP.match(line)
        below = next((text for text in lines[number + 1 :] if text.strip()), "")
        if counted and _is_count_line(counted, below):
            dt = _number(counted["dt"])
            return _Layout(number + 1, _width(below), int(counted["npts"]), dt, titles, name)
        return _Layout(number, _width(line), None, step, titles, name)
    return None


def _is_count_line(match: re.Match[str], below: str) -> bool:
    """Tell ``npts dt`` from the first row of two columns: the next row is no time 0 + dt."""
    npts, dt = int(match["npts"]), _number(match["dt"])
    if npts < 2 or not 0 < dt <= 1 or not _is_row(below):
        return False
    return _width(below) != 2 or _first_number(below) < npts


def _titles(line: str, before: list[str]) -> list[str]:
    """Return titles of two columns if a line has them, else those found before."""
    words = [word.strip(' "') for word in _SPLIT.split(line.strip()) if word.strip(' "')]
    if len(words) == 2 and re.match(r"t(?:ime)?\b|t_|time_", words[0], re.IGNORECASE):
        return words
    alone = len(words) == 1 and re.match(r"acc\w*\.?\s*[\[(]", words[0], re.IGNORECASE)
    return ["", words[0]] if alone else before


def _is_row(line: str) -> bool:
    """Tell whether a line is numbers and nothing else."""
    numbers = _numbers(line)
    return bool(numbers) and all(_TOKEN.fullmatch(word) for word in numbers)


def _width(line: str) -> int:
    return len(_numbers(line))


def _numbers(line: str) -> list[str]:
    separators = r"[;\s]+" if ";" in line else r"[,\s]+"
    return [word for word in re.split(separators, line.strip()) if word]


def _first_number(line: str) -> float:
    return _number(_numbers(line)[0])


def _number(word: str) -> float:
    return float(word.replace(",", ".").upper().replace("D", "E"))


def _parse(text: TextFile, dt: float | None = None) -> list[Channel]:
    layout = _layout(text.lines(0, _MAX_HEADER + 1))
    if layout is None:
        text.fail("no rows of numbers below a short header", 0)
    if dt is not None and not (np.isfinite(dt) and dt > 0):
        raise InputError(f"dt must be a positive number of seconds, got {dt}.")
    _refuse_other_titles(text, layout)
    steps: tuple[dict[str, Any], ...] = ()
    if layout.npts is not None:
        values, interval = _counted(text, layout)
    elif layout.columns == 2:
        table = text.table(layout.start, 2)
        values = table[:, 1].copy()
        interval, steps = _interval(text, layout, table[:, 0], dt)
    else:
        values = text.table(layout.start, 1)[:, 0].copy()
        if layout.dt is None and dt is None:
            text.fail("one column without sampling interval; give it with dt= (in seconds)")
        interval = layout.dt or dt or 0.0
    return [
        Channel(
            npts=values.size,
            dt=positive_step(text, interval, 0),
            samples=values.copy,
            unit=_unit(layout.titles),
            details={"title": layout.name, "steps": steps},
        )
    ]


def _counted(text: TextFile, layout: _Layout) -> tuple[NDArray[np.float64], float]:
    """Return samples and interval [s] of a file with a line ``npts dt``."""
    npts, dt = layout.npts, layout.dt
    assert npts is not None and dt is not None
    if layout.columns == 2:
        table = text.table(layout.start, 2)
        if table.shape[0] == npts:
            check_rising(table[:, 0], text, layout.start)
            measured = step_of_times(table[:, 0], text, layout.start)
            if abs(measured - dt) > 1e-6 * dt:
                text.fail(f"the header gives dt = {dt:g} s, but times step by {measured:g} s")
            return table[:, 1].copy(), dt
    return text.counted(layout.start, None, npts), dt


def _interval(
    text: TextFile, layout: _Layout, times: NDArray[np.float64], dt: float | None
) -> tuple[float, tuple[dict[str, Any], ...]]:
    """Return the interval [s] of a time column, or the user's in its place and a note of that."""
    if dt is None:
        return step_of_times(times, text, layout.start), ()
    check_rising(times, text, layout.start)
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
    if held or quantity_of(unit) in ("velocity", "displacement"):
        text.fail(f"the second column is {layout.titles[1]!r}, not acceleration", layout.start - 1)


FORMAT = Format("PLAINTEXT", _recognise, _parse, wants_dt=True)
is_format, read = FORMAT.is_format, FORMAT.read


def write(stream: Stream, filename: str | os.PathLike[str], **_: Any) -> None:
    """Write one trace as two columns, time and acceleration, that read back to the same samples.

    The titles state the unit where ``stats.rockfrag.unit`` has it.

    Raises
    ------
    InputError
        If the stream has more or fewer than one trace, or a sample is not finite.
    """
    if len(stream) != 1:
        raise InputError(f"{filename}: two columns hold one trace, not {len(stream)}; choose one.")
    trace = stream[0]
    unit = trace.stats.get("rockfrag", {}).get("unit", "")
    samples = np.asarray(trace.data, dtype=np.float64)
    if samples.size == 0 or not np.isfinite(samples).all():
        raise InputError(f"{filename}: a record needs at least one sample, and all of them finite.")
    dt = float(f"{trace.stats.delta:.12g}")
    rows = [f"Time [s]\tAcceleration [{unit}]" if unit else "Time [s]\tAcceleration"]
    rows += [f"{i * dt:.12g}\t{value!r}" for i, value in enumerate(samples.tolist())]
    write_text("\n".join(rows) + "\n", filename)
