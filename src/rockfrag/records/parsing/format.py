"""A record format as ObsPy wants it: a test for it, a reader of its channels, and what every writer checks."""

import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray
from obspy import Stream, Trace, UTCDateTime
from obspy.core import AttribDict

from rockfrag.errors import InputError
from rockfrag.records.parsing import text_file
from rockfrag.records.parsing.quantities import TO_SI
from rockfrag.tabular import printable
from rockfrag.units import LONGEST_STEP, SHORTEST_STEP

_FIRST, _LAST = UTCDateTime(1900, 1, 1), UTCDateTime(2100, 1, 1)


def cut_short_step(promised: int, found: int) -> dict[str, Any]:
    """Return the step of the provenance of a file with fewer samples than its header promises."""
    return {
        "step": "read a file that is cut short",
        "samples_promised": promised,
        "samples_read": found,
    }


@dataclass(frozen=True)
class Channel:
    """One acceleration history as a file stores it."""

    npts: int  # number of samples
    dt: float  # sampling interval [s]
    # gives the samples in the unit of the file, shape (npts,)
    samples: Callable[[], NDArray[np.float64]]
    unit: str = ""  # canonical unit (``g``, ``cm/s2``, …); empty if the file does not state it
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
    member: str = ""  # name of the file within an archive of several records, else empty
    # whether this is a raw recording, whose mean is the zero of the sensor and not motion
    raw: bool = False
    # more facts for the metadata: ``station_name``, ``earthquake``, ``title``, …
    details: Mapping[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        # what a file says goes to terminals and tables, and may hold anything
        for name in ("network", "station", "location", "code", "component", "member"):
            object.__setattr__(self, name, printable(getattr(self, name)))
        shown = {k: printable(v) if isinstance(v, str) else v for k, v in self.details.items()}
        object.__setattr__(self, "details", shown)
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
            **{key: value for key, value in self.details.items() if value not in ("", None)},
        }
        header = {
            "network": self.network,
            "station": self.station,
            "location": self.location,
            "channel": self.label,
            "delta": self.dt,
            "npts": self.npts,
            "rockfrag": AttribDict(facts),
        }
        if self.start_time is not None:
            header["starttime"] = self.start_time
        if headonly:
            return Trace(header=header)
        return Trace(data=self.samples(), header=header)


_LONGEST = 1_000  # characters of a line that are looked at to recognise a format


@dataclass(frozen=True)
class Format:
    """One record format."""

    name: str  # name of the ObsPy plugin
    # tells from the first lines of a file (and its name) whether it is of this format
    recognise: Callable[[list[str], str], bool]
    # gives the channels of a file of this format; with ``wants_dt`` also told the sampling interval
    # that the user named
    parse: Callable[..., list[Channel]]
    wants_dt: bool = False
    # encoding of text that is not UTF-8, where the format's network writes in one
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
        text = text_file.read_text(source, self.encoding)
        try:
            channels = self._parsed(text, dt)
            if cut_short:
                for channel in channels:
                    # samples are read on demand, and may be too few
                    channel.samples()
            return channels
        except text_file.NotAcceleration:
            raise
        except InputError:
            if not cut_short:
                raise
        return [_shortened(channel) for channel in self._parsed(text.up_to_last_line_end(), dt)]

    def _parsed(self, text: text_file.TextFile, dt: float | None) -> list[Channel]:
        try:
            channels = self.parse(text, dt) if self.wants_dt else self.parse(text)
            if not text.cut_short:
                for channel in channels:
                    channel.check(text.name)
        except (ValueError, IndexError, KeyError, ArithmeticError) as error:
            if isinstance(error, InputError):
                raise
            raise InputError(f"{text.name}: not a readable {self.name} file ({error}).") from error
        if not channels:
            raise InputError(f"{text.name}: no acceleration in this {self.name} file.")
        return channels

    def read(
        self,
        source: text_file.Source,
        headonly: bool = False,
        starttime: UTCDateTime | None = None,
        endtime: UTCDateTime | None = None,
        nearest_sample: bool = True,
        dt: float | None = None,
        **_: Any,
    ) -> Stream:
        """Return the acceleration channels of a file as an ObsPy stream, in the unit of the file."""
        stream = Stream([channel.trace(headonly) for channel in self.channels(source, dt)])
        if not headonly and (starttime is not None or endtime is not None):
            stream.trim(starttime, endtime, nearest_sample=nearest_sample)
        return stream


def _shortened(channel: Channel) -> Channel:
    """Return a channel with as many samples as there are, and a note where more were promised."""
    samples = channel.samples()
    if samples.size == channel.npts:
        return channel
    step = cut_short_step(channel.npts, int(samples.size))
    details = {**channel.details, "steps": (*channel.details.get("steps", ()), step)}
    return replace(channel, npts=int(samples.size), samples=samples.copy, details=details)


def head_lines(source: text_file.Source) -> list[str]:
    """Return the first whole lines of a text file; none for a binary file or one it cannot read."""
    if isinstance(source, (str, os.PathLike)):
        try:
            state = os.stat(source)
        except (OSError, ValueError):
            return []
        return list(_lines_of_path(str(source), state.st_mtime_ns, state.st_size))
    return list(_lines_of(text_file.read_head(source)))


@lru_cache(maxsize=4)
def _lines_of_path(path: str, changed: int, size: int) -> tuple[str, ...]:
    """Return the lines of a file's head; every format looks at them, one after the other."""
    return _lines_of(text_file.read_head(path))


def _lines_of(head: bytes) -> tuple[str, ...]:
    if not head or b"\x00" in head:
        return ()
    text = head.decode("utf-8", errors="replace").removeprefix("\ufeff")
    lines = text.replace("\r\n", "\n").replace("\r", "\n").split("\n")
    if len(head) >= text_file.HEAD_BYTES:
        # the last line of a head is cut anywhere
        lines = lines[:-1]
    return tuple(line[:_LONGEST].rstrip() for line in lines)


def one_trace(
    stream: Stream, filename: str | os.PathLike[str]
) -> tuple[Trace, NDArray[np.float64]]:
    """Return the only trace of a stream and its samples, shape (n,)."""
    if len(stream) != 1:
        raise InputError(f"{filename}: a file holds one trace, not {len(stream)}; choose one.")
    samples = np.asarray(stream[0].data, dtype=np.float64)
    if samples.size == 0 or not np.isfinite(samples).all():
        raise InputError(f"{filename}: a record needs at least one sample, and all of them finite.")
    return stream[0], samples


def stated_unit(trace: Trace, filename: str | os.PathLike[str]) -> str:
    """Return the unit of acceleration that ``stats.rockfrag.unit`` states."""
    unit = str(trace.stats.get("rockfrag", {}).get("unit") or "")
    if unit not in TO_SI:
        raise InputError(
            f"{filename}: the trace does not state a unit of acceleration; set stats.rockfrag = "
            "{'unit': 'g'} (or 'cm/s2', 'm/s2', …) once it is known."
        )
    return unit
