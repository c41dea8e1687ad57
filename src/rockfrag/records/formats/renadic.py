"""RENADIC (University of Chile) volume 1: pairs of time and acceleration, three channels.

The header has no station; the files are named by the station and the record's number, which is the
second line.
"""

import re
from dataclasses import replace
from pathlib import PurePath

from rockfrag.records.parsing.format import Channel, Format
from rockfrag.records.parsing.fortran_sections import CHANNEL_END
from rockfrag.records.parsing.text_file import TextFile
from rockfrag.records.parsing.timestamps import american_time, read_pairs

_FIRST = re.compile(r"^\s*UNCORRECTED\s+ACCELEROGRAM\s+DATA\b", re.IGNORECASE)
_HEAD = re.compile(rb"^[ \t]*UNCORRECTED[ \t]+ACCELEROGRAM[ \t]+DATA\b", re.I | re.M)
_HEADER = 13


def _recognise(lines: list[str], name: str) -> bool:
    header = "\n".join(lines[:_HEADER]).upper()
    return bool(_FIRST.match(lines[0])) and "RENADIC" in header


def _parse(text: TextFile) -> list[Channel]:
    return [
        _channel(text, first, read_pairs(text, first, stop))
        for first, stop in text.parts(_HEAD, CHANNEL_END)
    ]


def _channel(text: TextFile, first: int, values: Channel) -> Channel:
    lines = text.lines(first, first + _HEADER)
    header = "\n".join(lines)
    component = re.search(r"^\s*CHAN\s*\d+\s*:\s*(\S+)", header, re.M | re.I)
    trigger = re.search(r"TRIGGER\s+TIME\s*:(.*)$", header, re.M | re.I)
    number = lines[1].strip()
    return replace(
        values,
        start_time=american_time(trigger[1]) if trigger else None,
        # the station that the file is named by, without the record's number
        station=PurePath(text.name).name.split(".")[0].replace(number, "").strip(" _-"),
        component=component[1] if component else "",
        details={
            "earthquake": re.split(r"\s*\(ORIGIN", " ".join(lines[2].split()))[0],
            "record": number,
            **values.details,
        },
    )


FORMAT = Format("RENADIC", _recognise, _parse)
