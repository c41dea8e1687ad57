"""University of Southern California volume 1: pairs of time and acceleration digitised from film.

Each text line has its length in columns 73 and 74, which tells the format from its relatives.
"""

import re
from collections.abc import Iterator

from rockfrag.records.parsing.format import CHANNEL_END, Channel, Format, stated
from rockfrag.records.parsing.text_file import TextFile
from rockfrag.records.parsing.timestamps import read_pairs

_FIRST = re.compile(r"OF\s+UNCORRECTED\s+ACCELEROGRAM\s+DATA\s+OF\s+VOLUME\s+I\b", re.I)
_HEADER = 13
_STATION = re.compile(r"^STATION\s+(?:NO\.?|\w+\s*#)?\s*(\d+)", re.I)
_LENGTH = slice(72, 76)


def _recognise(lines: list[str], name: str) -> bool:
    """Whether the first line says so, and the lines of the header state how long they are."""
    return (
        len(lines) > _HEADER
        and bool(_FIRST.search(lines[0]))
        and all(line[_LENGTH].strip().isdigit() for line in lines[3:11])
    )


def _parse(text: TextFile) -> Iterator[Channel]:
    """Yield the channels of a file, one after the other."""
    for first, stop in text.parts(_FIRST):
        pairs = read_pairs(text, first, min(stop, text.until(CHANNEL_END, first)))
        yield place_of(text.lines(first, first + _HEADER), pairs)


def place_of(words: list[str], values: Channel) -> Channel:
    """Return a channel with the station, component and earthquake of the text header above it."""
    lines = [line[: _LENGTH.start].strip() for line in words]
    station = next(
        (i for i, line in enumerate(lines) if _STATION.match(line)), len(lines)
    )
    # the earthquake's name and date stand below the line that names the volume
    volume = next((i for i, line in enumerate(lines) if "OF VOLUME" in line.upper()), 0)
    facts = {
        "station": stated(_STATION.pattern, lines),
        "component": stated(r"^COMP\w*\s+(\S+)", lines),
        "station_name": next(iter(lines[station + 1 :]), ""),
        "earthquake": ", ".join(lines[volume + 1 : volume + 3]),
    }
    return values.saying(facts)


FORMAT = Format("USC", _recognise, _parse)
