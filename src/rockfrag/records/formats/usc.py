"""University of Southern California volume 1: pairs of time and acceleration digitised from film.

Each text line has its length in columns 73 and 74, which tells the format from its relatives.
"""

import re
from dataclasses import replace

from rockfrag.records.parsing.format import Channel, Format
from rockfrag.records.parsing.fortran_sections import CHANNEL_END
from rockfrag.records.parsing.text_file import TextFile
from rockfrag.records.parsing.timestamps import read_pairs

_FIRST = re.compile(r"OF\s+UNCORRECTED\s+ACCELEROGRAM\s+DATA\s+OF\s+VOLUME\s+I\b", re.IGNORECASE)
_HEAD = re.compile(
    rb"^.*OF[ \t]+UNCORRECTED[ \t]+ACCELEROGRAM[ \t]+DATA[ \t]+OF[ \t]+VOLUME", re.I | re.M
)
_HEADER = 13
_LENGTH = slice(72, 76)


def _recognise(lines: list[str], name: str) -> bool:
    return (
        len(lines) > _HEADER
        and bool(_FIRST.search(lines[0]))
        and all(line[_LENGTH].strip().isdigit() for line in lines[3:11])
    )


def _parse(text: TextFile) -> list[Channel]:
    channels = []
    for first, stop in text.parts(_HEAD):
        pairs = read_pairs(text, first, min(stop, text.until(CHANNEL_END, first)))
        channels.append(place_of(text.lines(first, first + _HEADER), pairs))
    return channels


def place_of(words: list[str], values: Channel) -> Channel:
    """Return a channel with the station, component and earthquake of the text header above it."""
    lines = [line[: _LENGTH.start].strip() for line in words]
    station = component = name = ""
    for number, line in enumerate(lines):
        found = re.match(r"STATION\s+(?:NO\.?|\w+\s*#)?\s*(\d+)", line, re.IGNORECASE)
        if found and not station:
            station, name = found[1], lines[number + 1] if lines[number + 1 :] else ""
        found = re.match(r"COMP\w*\s+(\S+)", line, re.IGNORECASE)
        component = found[1] if found and not component else component
    # the earthquake's name and date stand below the line that names the volume
    volume = next((i for i, line in enumerate(lines) if "OF VOLUME" in line.upper()), 0)
    earthquake = ", ".join(lines[volume + 1 : volume + 3])
    details = {"station_name": name, "earthquake": earthquake, **values.details}
    return replace(values, station=station, component=component, details=details)


FORMAT = Format("USC", _recognise, _parse)
