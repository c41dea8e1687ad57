"""RENADIC (University of Chile) volume 1: pairs of time and acceleration, three channels.

The header has no station; the files are named by the station and the record's number, which is the second line.
"""

import re
from collections.abc import Iterator
from pathlib import PurePath

from rockfrag.records.parsing.format import CHANNEL_END, Channel, Format, headed, stated
from rockfrag.records.parsing.stated_peak import StatedPeak, with_checked_peak
from rockfrag.records.parsing.text_file import TextFile
from rockfrag.records.parsing.timestamps import american_time, read_pairs

_FIRST = re.compile(r"^\s*UNCORRECTED\s+ACCELEROGRAM\s+DATA\b", re.I)
_HEADER = 13


def _parse(text: TextFile) -> Iterator[Channel]:
    """Channels of a file of this format, by its header as the head of the module says it."""
    for first, stop in text.parts(_FIRST, CHANNEL_END):
        values = read_pairs(text, first, stop)
        header = text.lines(first, first + _HEADER)
        # line 2 has the number of the record, line 3 the earthquake
        number = header[1].strip()
        facts = {
            "start_time": american_time(stated(r"TRIGGER\s+TIME\s*:(.*)$", header)),
            # the station that the file is named by, without the record's number
            "station": PurePath(text.name)
            .name.split(".")[0]
            .replace(number, "")
            .strip(" _-"),
            "component": stated(r"^\s*CHAN\s*\d+\s*:\s*(\S+)", header),
            "earthquake": re.split(r"\s*\(ORIGIN", " ".join(header[2].split()))[0],
            "record": number,
        }
        peak = StatedPeak(stated(r"\bMAX\s*=\s*([-+\d.]+)\s*G\b", header), "g")
        found = values.saying(facts)
        yield with_checked_peak(found, peak, text.name, text.cut_short)


FORMAT = Format(
    "RENADIC", headed(_FIRST, re.compile("RENADIC", re.I), within=_HEADER), _parse
)
