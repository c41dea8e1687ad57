"""A record format as ObsPy wants it: a test for it, a reader, and what every writer checks."""

import os
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray
from obspy import Stream, Trace, UTCDateTime

from rockfrag.errors import InputError
from rockfrag.records.parsing import text_file
from rockfrag.records.parsing.channel import Channel, cut_short_step
from rockfrag.records.parsing.quantities import TO_SI

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
