"""Pieces that formats share: headers of lines ``KEY : value`` or in columns, and sections of values."""

import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rockfrag.records.parsing.format import Channel
from rockfrag.records.parsing.text_file import TextFile
from rockfrag.units import LONGEST_STEP, SHORTEST_STEP

_LINE = re.compile(r"^\s*(?P<key>[^:]*?)\s*:\s*(?P<value>.*?)\s*$")
_NOTE = re.compile(r"\s*[(\[][^)\]]*[)\]]")


def header_keys(lines: Iterable[str]) -> dict[str, str]:
    """Return the values of a header by their keys.

    Keys are in lower case, without notes in brackets, with single blanks: ``SAMPLING INTERVAL
    (sec)`` becomes ``sampling interval``. The first of two equal keys counts; a line with a colon
    but no key goes on with the value above it.
    """
    facts: dict[str, str] = {}
    key = ""
    for line in lines:
        match = _LINE.match(line)
        if match is None:
            continue
        named = " ".join(_NOTE.sub("", match["key"]).lower().split())
        if named:
            key = "" if named in facts else named
            if key:
                facts[key] = match["value"]
        elif key and match["value"]:
            facts[key] = f"{facts[key]} {match['value']}"
    return facts


def first_match(pattern: re.Pattern[str], lines: Iterable[str]) -> re.Match[str] | None:
    """Return the match in the first line that has a pattern."""
    return next(filter(None, map(pattern.search, lines)), None)


def number_of(text: TextFile, facts: Mapping[str, str], key: str) -> float:
    """Return the number of a header's key, a positive one."""
    words = facts.get(key, "")
    match = re.match(r"\d+(?:\.\d*)?(?:[Ee][+-]?\d{1,3})?|\.\d+", words)
    value = float(match[0]) if match else 0.0
    if not 0 < value < 1e12:
        text.fail(
            f"the header gives no number for {key!r}" + (f" but {words[:40]!r}" if words else "")
        )
    return value


CHANNEL_END = re.compile(rb"^[ \t]*/&", re.M)
QUANTITIES = {"ACCEL": "acceleration", "VELOC": "velocity", "DISPL": "displacement"}
"""First letters of a quantity's name in a header, and the quantity."""

_FORTRAN = re.compile(
    r"\(\s*\d*\s*\(?\s*(?:\d+P\s*,?\s*\d*)?\s*[FEGID]S?\s*(?P<width>\d+)", re.IGNORECASE
)


@dataclass(frozen=True)
class Section:
    """One run of values in a file: ``count`` samples of a quantity in lines ``start`` up to ``stop``."""

    quantity: str
    count: int
    start: int
    stop: int
    width: int | None
    dt: float  # [s]
    unit: str

    def channel(self, text: TextFile) -> Channel:
        """Return the values, checked against the count of the header."""
        samples = text.counted(self.start, self.stop, self.count, self.width)
        return Channel(self.count, self.dt, samples.copy, self.unit)


def integers(text: TextFile, start: int, stop: int, width: int, count: int) -> list[int]:
    """Return the whole numbers of header lines ``start`` up to ``stop`` (columns of ``width``)."""
    values = reals(text, start, stop, width, count, "whole numbers")
    if any(value % 1 for value in values):
        text.fail("the header has a fraction where whole numbers are expected", start)
    return [int(value) for value in values]


def reals(
    text: TextFile, start: int, stop: int, width: int, count: int, kind: str = "numbers"
) -> list[float]:
    """Return the numbers of header lines ``start`` up to ``stop`` (columns of ``width``)."""
    values = text.numbers(start, stop, width)
    if values.size < count:
        text.fail(f"{count} {kind} are expected in this header, not {values.size}", start)
    return [float(value) for value in values]


def in_rows(
    text: TextFile, values: NDArray[np.float64], columns: int, start: int
) -> NDArray[np.float64]:
    """Return the values from line ``start`` on as whole rows, shape (rows, columns)."""
    if values.size == 0 or values.size % columns:
        text.fail(
            f"{values.size} values do not fill rows of {columns}; the file is cut short", start
        )
    return values.reshape(-1, columns)


def field_width(words: str) -> int | None:
    """Return the field width that a Fortran format such as ``(8F10.5)`` gives, or None."""
    match = _FORTRAN.search(words)
    return int(match["width"]) if match and 1 <= int(match["width"]) <= 40 else None


def accelerations(
    channels: Callable[[TextFile], Iterable[tuple[str, Channel]]],
) -> Callable[[TextFile], list[Channel]]:
    """Keep of the quantities and channels of a file those of acceleration; refuse a file without (a decorator)."""

    def parse(text: TextFile) -> list[Channel]:
        found = list(channels(text))
        kept = [channel for quantity, channel in found if quantity == "acceleration"]
        if found and not kept:
            held = sorted({quantity for quantity, _ in found})
            text.refuse(f"this file holds {' and '.join(held)}, not acceleration")
        return kept

    return parse


def positive_step(text: TextFile, dt: float, line: int) -> float:
    """Return a sampling interval [s] that can be one."""
    if not (np.isfinite(dt) and SHORTEST_STEP <= dt <= LONGEST_STEP):
        text.fail(
            f"the header gives {dt:g} s as sampling interval; records have from "
            f"{SHORTEST_STEP:g} to {LONGEST_STEP:g} s",
            line,
        )
    return dt
