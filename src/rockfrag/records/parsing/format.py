"""A record format as ObsPy wants it: a test for it, a reader of its channels, a writer, and what headers share."""

import re
from collections import defaultdict
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray
from obspy import Stream, Trace, UTCDateTime
from obspy.core import AttribDict

from rockfrag.base.errors import InputError
from rockfrag.base.plausible import LONGEST_STEP, SHORTEST_STEP
from rockfrag.base.text_files import printable
from rockfrag.records.parsing import text_file
from rockfrag.records.parsing.quantities import canonical_unit

_FIRST, _LAST = UTCDateTime(1900, 1, 1), UTCDateTime(2100, 1, 1)


def cut_short_step(promised: int, found: int) -> dict[str, Any]:
    """Return the step of the provenance of a file with fewer samples than its header promises."""
    counts = {"samples_promised": promised, "samples_read": found}
    return {"step": "read a file that is cut short", **counts}


_STATED = ("unit", "start_time", "network", "station", "location", "code", "component")
_NUMBERS = ("magnitude", "distance_km", "latitude", "longitude", "azimuth_deg")
_NUMBER = re.compile(r"\s*[+-]?(?:\d+\.?\d*|\.\d+)(?:E[+-]?\d+)?", re.I)


def _fact(key: str, value: Any) -> Any:
    """Return what a header says as text that can be shown, or as the number that its words begin with."""
    if not isinstance(value, str):
        return value
    number = _NUMBER.match(value)
    return (
        (float(number[0]) if number else None) if key in _NUMBERS else printable(value)
    )


@dataclass(frozen=True)
class Channel:
    """One acceleration history as a file stores it."""

    npts: int  # number of samples, as the header promises it
    dt: float  # sampling interval [s]
    samples: NDArray[np.float64]  # in the unit of the file, shape (npts,)
    # made canonical (``g``, ``cm/s2``, …); empty if the file does not state it
    unit: str = ""
    quantity: str = "acceleration"  # other quantities of a file are left out
    # time of the first sample, or None if the file does not state it; a time before 1900 or after
    # 2100 is a mistake of the header and counts as not stated
    start_time: UTCDateTime | None = None
    # network, station, location, code: the SEED names as far as the file has them; a station without
    # a code has its name here
    network: str = ""
    station: str = ""
    location: str = ""
    code: str = ""
    component: str = ""  # orientation as the file words it (``090``, ``N10E``, ``UP``)
    # name of the file within an archive of several records, else empty
    member: str = ""
    # what is wrong with this channel alone, where others of the file may be in order; empty if nothing is
    fault: str = ""
    # whether a recorder's, whose mean is the zero of the sensor and not motion
    raw: bool = False
    # whether whole numbers of a recorder that nothing turns into a unit
    counts: bool = False
    # more facts for the metadata: ``station_name``, ``earthquake``, ``title``, …; numbers may be words
    details: Mapping[str, Any] = field(default_factory=dict)
    # peaks that words state, number and unit, where the unit of the samples is the user's
    peaks: tuple[tuple[str, str], ...] = ()
    # what was done to the samples, for the provenance
    steps: tuple[Mapping[str, Any], ...] = ()

    def __post_init__(self) -> None:
        # what a file says goes to terminals and tables, and may hold anything
        for name in ("network", "station", "location", "code", "component", "member"):
            object.__setattr__(self, name, printable(getattr(self, name)))
        object.__setattr__(self, "unit", canonical_unit(self.unit))
        known = {key: _fact(key, value) for key, value in self.details.items()}
        details = {
            key: value for key, value in known.items() if value not in ("", None)
        }
        object.__setattr__(self, "details", details)
        if self.start_time is not None and not _FIRST < self.start_time < _LAST:
            object.__setattr__(self, "start_time", None)

    def check(self, name: str) -> None:
        """Check that number of samples and interval can be those of a record; ``name`` is its file's."""
        if self.npts < 1:
            raise InputError(f"{name}: the header promises {self.npts} samples.")
        if not SHORTEST_STEP <= self.dt <= LONGEST_STEP:
            raise InputError(
                f"{name}: a sampling interval of {self.dt:g} s is none of a strong-motion record (from "
                f"{SHORTEST_STEP:g} to {LONGEST_STEP:g} s); mend the header, or give the true one with dt=."
            )

    def saying(self, facts: Mapping[str, Any]) -> "Channel":
        """Return the channel with what its header says; what is no field of a channel is a detail."""
        own = {key: facts[key] for key in _STATED if key in facts}
        others = {key: value for key, value in facts.items() if key not in own}
        return replace(self, **own, details={**others, **self.details})

    @property
    def label(self) -> str:
        """Name to choose the channel by: its code, else its orientation, with its member if any."""
        return f"{self.member} {self.code or self.component}".strip()

    def trace(self, headonly: bool) -> Trace:
        """Return the channel as an ObsPy trace, what SEED names have no room for in ``stats.rockfrag``."""
        facts = {
            "unit": self.unit,
            "quantity": "acceleration",
            "component": self.component,
            "start_time_stated": self.start_time is not None,
            **self.details,
            **({"steps": self.steps} if self.steps else {}),
        }
        header = {
            **{
                key: getattr(self, key)
                for key in ("network", "station", "location", "npts")
            },
            "channel": self.label,
            "delta": self.dt,
            "rockfrag": AttribDict(facts),
            **({} if self.start_time is None else {"starttime": self.start_time}),
        }
        return Trace(header=header) if headonly else Trace(self.samples, header)


_LONGEST = 1_000  # characters of a line that are looked at to recognise a format


@dataclass(frozen=True)
class Format:
    """One record format."""

    name: str  # name of the ObsPy plugin
    # tells from the first lines of a file (and its name) whether it is of this format
    recognise: Callable[[list[str], str], bool]
    # gives channels of any quantity
    parse: Callable[[text_file.TextFile], Iterable[Channel]]
    # of text that is not UTF-8, where the format's network writes in one
    encoding: str = ""

    def is_format(self, source: text_file.Source) -> bool:
        """Tell whether a file is of this format, from a bounded piece of its head; never raises."""
        lines = head_lines(source)
        if not lines:
            return False
        try:
            return self.recognise(lines, text_file.name_of(source))
        except (ValueError, IndexError, KeyError, ArithmeticError):
            return False

    def channels(
        self, source: text_file.Source, dt: float | None = None, cut_short: bool = False
    ) -> list[Channel]:
        """Return the acceleration channels of a file.

        ``dt`` [s] is for plain text that does not state its own. With ``cut_short`` a file with fewer samples than
        its header promises is read all the same, and a step of the channel says so.
        """
        text = replace(text_file.read_text(source, self.encoding), asked_dt=dt)
        try:
            return self._parsed(text)
        except InputError as error:
            if not cut_short or isinstance(error, text_file.NotAcceleration):
                raise
        # without a last line that does not end
        whole = text.data[: text.data.rfind(b"\n") + 1]
        return [
            *map(_shortened, self._parsed(replace(text, data=whole, cut_short=True)))
        ]

    def _parsed(self, text: text_file.TextFile) -> list[Channel]:
        """Channels of acceleration of a file; an error where it has others alone."""
        try:
            found = list(self.parse(text))
            channels = [
                channel for channel in found if channel.quantity == "acceleration"
            ]
            if found and not channels:
                held = sorted({channel.quantity for channel in found})
                text.refuse(f"this file holds {' and '.join(held)}, not acceleration")
            for channel in () if text.cut_short else channels:
                channel.check(text.name)
        except InputError:
            raise
        except (ValueError, IndexError, KeyError, ArithmeticError) as error:
            raise InputError(
                f"{text.name}: not a readable {self.name} file ({error})."
            ) from error
        if not channels:
            raise InputError(f"{text.name}: no acceleration in this {self.name} file.")
        return channels

    def read(
        self,
        source: text_file.Source,
        headonly: bool = False,
        dt: float | None = None,
        **_: Any,
    ) -> Stream:
        """Return the acceleration channels of a file as an ObsPy stream, in the unit of the file."""
        return Stream(
            [channel.trace(headonly) for channel in self.channels(source, dt)]
        )


def headed(
    first: re.Pattern[str] | None, *others: re.Pattern[str], within: int
) -> Callable[[list[str], str], bool]:
    """Return what recognises a format by how a file begins and by what some of its first lines hold."""

    def recognise(lines: list[str], name: str) -> bool:
        begins = first is None or first.match(lines[0]) is not None
        return begins and all(any(map(each.search, lines[:within])) for each in others)

    return recognise


def _shortened(channel: Channel) -> Channel:
    """Return a channel with as many samples as there are, and a note where more were promised."""
    found = channel.samples.size
    if found == channel.npts:
        return channel
    steps = (*channel.steps, cut_short_step(channel.npts, found))
    return replace(channel, npts=found, steps=steps)


def head_lines(source: text_file.Source) -> list[str]:
    """Return the first whole lines of a text file; none for a binary file or one it cannot read."""
    return list(_lines_of(text_file.read_head(source)))


@lru_cache(maxsize=4)
def _lines_of(head: bytes) -> tuple[str, ...]:
    """Return the lines of a file's head; every format looks at them, one after the other."""
    if not head or b"\x00" in head:
        return ()
    text = head.decode("utf-8", errors="replace").removeprefix("\ufeff")
    lines = text.replace("\r\n", "\n").replace("\r", "\n").split("\n")
    if len(head) >= text_file.HEAD_BYTES:
        # the last line of a head is cut anywhere
        lines = lines[:-1]
    return tuple(line[:_LONGEST].rstrip() for line in lines)


CHANNEL_END = re.compile(r"^\s*/&")
QUANTITIES = {"ACC": "acceleration", "VEL": "velocity", "DIS": "displacement"}
"""First letters of a quantity's name in a header, and the quantity."""

_LINE = re.compile(r"^\s*(?P<key>[^:]*?)\s*:\s*(?P<value>.*?)\s*$")
_NOTE = re.compile(r"\s*[(\[][^)\]]*[)\]]")


def header_keys(lines: Iterable[str]) -> dict[str, str]:
    """Return the values of a header by their keys; of one that it has not, nothing.

    Keys are in lower case, without notes in brackets, with single blanks: ``SAMPLING INTERVAL
    (sec)`` becomes ``sampling interval``. The first of two equal keys counts; a line with a colon
    but no key goes on with the value above it.
    """
    facts: dict[str, str] = defaultdict(str)
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


def stated(pattern: str, lines: Iterable[str]) -> str:
    """Return what a pattern's first group holds in the first line in which it holds anything, or nothing."""
    found = (
        (match[1] or "").strip()
        for match in map(re.compile(pattern, re.I).search, lines)
        if match
    )
    return next(filter(None, found), "")


def facts_in(lines: Iterable[str], patterns: Mapping[str, str]) -> dict[str, str]:
    """Return what lines state of each pattern, by its name, see :func:`stated`, with single blanks."""
    return {
        name: " ".join(stated(pattern, lines).split())
        for name, pattern in patterns.items()
    }


def section(
    text: text_file.TextFile,
    line: int,
    stop: int,
    *,
    count: int,
    dt: float,
    unit: str,
    width: int | None,
    quantity: str,
) -> Channel:
    """Return the channel of the values in the lines below the one that states them.

    Parameters
    ----------
    text : the file
    line, stop : the line that states them, and the one behind their last
    count, dt : number of values, and interval [s]
    unit, quantity : of the values
    width : of a field [characters]; None where blanks part them
    """
    dt = text.interval(dt, line)
    samples = text.numbers(line + 1, stop, width, count=count)
    return Channel(count, dt, samples, unit, quantity)


def in_columns(
    channel: Channel, table: NDArray[np.float64], components: Iterable[str]
) -> list[Channel]:
    """Return a channel of each column of a table, with what they share from ``channel``."""
    return [
        replace(channel, samples=column.copy(), component=name)
        for name, column in zip(components, table.T, strict=True)
    ]


_FORTRAN = re.compile(
    r"\(\s*\d*\s*\(?\s*(?:\d+P\s*,?\s*\d*)?\s*[FEGID]S?\s*(?P<width>\d+)", re.I
)


def field_width(words: str) -> int | None:
    """Return the field width that a Fortran format such as ``(8F10.5)`` gives, or None."""
    match = _FORTRAN.search(words)
    return int(match["width"]) if match and 1 <= int(match["width"]) <= 40 else None
