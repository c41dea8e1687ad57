"""The resultant of several components, which programs write beside them and which is no component of motion."""

import re
from collections.abc import Sequence
from itertools import combinations

import numpy as np

from rockfrag.records.parsing.format import Channel

_WORDS = re.compile(
    r"(?i)\b(?:abs(?:olut\w*)?|total|resultant\w*|magnitude|norm|modul\w*|vector\s*sum|sum|combined|srss|rss|betrag"
    r"|gesamt\w*|result\w*)(?![a-z])|\|a\|"
)
# fraction of the largest sample by which a resultant may be off for the digits of the print
_OFF = 2e-3
_MOST = 12  # channels of a file among which resultants are looked for


def without_resultants(channels: Sequence[Channel]) -> list[Channel]:
    """Leave out channels that are the length of two or three others, or say so and are never negative."""
    return [channel for channel in channels if not _is_resultant(channel, channels)]


def _is_resultant(channel: Channel, channels: Sequence[Channel]) -> bool:
    if (
        not channel.samples.size
        or channel.samples.min() < 0
        or not channel.samples.any()
    ):
        return False
    title = str(channel.details.get("title") or channel.component).replace("_", " ")
    if _WORDS.search(title):
        return True
    others = [other for other in channels[:_MOST] if other is not channel]
    return any(
        _is_length_of(channel, several)
        for count in (2, 3)
        for several in combinations(others, count)
    )


def _is_length_of(channel: Channel, others: Sequence[Channel]) -> bool:
    if {other.samples.size for other in others} != {channel.samples.size}:
        return False
    length = np.sqrt(sum(other.samples**2 for other in others))
    return bool(np.abs(channel.samples - length).max() <= _OFF * length.max())
