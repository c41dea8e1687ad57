"""Peaks of acceleration that words above the samples of plain text state: ``PGA = 0.35 g``.

In go lines of words, out come numbers with their units, which samples in a known unit are held against. A peak
without a unit beside it, of a sensor's range or of a target is none of the samples'.
"""

import math
import re
from collections.abc import Sequence

import numpy as np

from rockfrag.base.errors import InputError
from rockfrag.records.parsing.format import Channel
from rockfrag.records.parsing.quantities import read_unit, to_si
from rockfrag.records.parsing.stated_peak import (
    REFUSED,
    StatedPeak,
    peaks_of,
    with_checked_peak,
)
from rockfrag.records.parsing.vocabulary import folded, words_for

# peaks of something else than the samples
_OF_OTHERS = re.compile(
    r"\b(?:range|scale[dr]?|full|trigger\w*|threshold|target|design|limit|capacity|sensor|table|catalog\w*|resolution"
    r"|clip\w*|spectr\w*|psa|sa|normali[sz]\w*|before|raw|original|rango|umbral|soglia|schwell\w*|messbereich)\b"
)
_VALUE = re.compile(
    r"(?<![\w.,])(?P<number>[+-]?(?:\d+[.,]?\d*|[.,]\d+)(?:e[+-]?\d+)?)\s*[(\[]?(?P<unit>%?\s?[^\W\d_][^\s,;()\[\]]*)?"
)
_BRACKETED = re.compile(r"[(\[](?P<unit>[^)\]]+)[)\]]")


def peaks_in_words(lines: Sequence[str]) -> tuple[StatedPeak, ...]:
    """Return the peaks of acceleration that lines of words state.

    Parameters
    ----------
    lines
        As they stand above the samples, without titles of columns.

    Returns
    -------
    tuple
        Numbers with their units, in the words of the file; a line states at most one.
    """
    found = (_peak_in(folded(line)) for line in lines)
    return tuple(peak for peak in found if peak is not None)


def _peak_in(line: str) -> StatedPeak | None:
    """The peak that a line states with its unit, None if it states none."""
    named = words_for("peak").search(line)
    if named is None or _OF_OTHERS.search(line):
        return None
    behind = line[named.end() :]
    values = list(_VALUE.finditer(behind))
    for value in values:
        unit = (value["unit"] or "").strip(" .:")
        if read_unit(unit).quantity == "acceleration":
            return _peak(value["number"], unit)
    bracket = _BRACKETED.search(line)
    if bracket and values and read_unit(bracket["unit"]).quantity == "acceleration":
        return _peak(values[0]["number"], bracket["unit"])
    return None


def _peak(number: str, unit: str) -> StatedPeak:
    return StatedPeak(number.replace(",", ".").lstrip("+-"), unit)


def with_checked_peaks(
    channels: list[Channel], peaks: Sequence[StatedPeak], name: str
) -> list[Channel]:
    """Return channels whose samples have the peaks that words above them state.

    Parameters
    ----------
    channels
        All of a file, in units of acceleration; others are not compared.
    peaks
        Of all channels, in any order, or of some of them.
    name
        Of the file, for messages.

    Returns
    -------
    list
        The channels, a single one with a note of a small difference.
    """
    if not peaks or not all(math.isfinite(to_si(c.unit)) for c in channels):
        return channels
    if len(channels) == 1 and len(peaks) == 1:
        return [with_checked_peak(channels[0], peaks[0], name)]
    held = [peaks_of(channel) for channel in channels]
    stated = [float(p.number) * read_unit(p.unit).to_si for p in peaks]
    if len(stated) == len(held):
        pairs = list(zip(sorted(stated), sorted(held, key=max), strict=True))
        fits = all(_is_near(peak, own) for peak, own in pairs)
    else:
        fits = any(_is_near(peak, own) for peak in stated for own in held)
    if not fits:
        said = ", ".join(f"{p.number} {p.unit}" for p in peaks)
        largest = ", ".join(f"{max(own):.4g}" for own in held)
        raise InputError(
            f"{name}: the header states peaks of {said}, but the samples have {largest} m/s2; one of them is "
            "wrong: mend the file."
        )
    return channels


def _is_near(peak: float, own: tuple[float, float]) -> bool:
    return bool(np.min(np.abs(np.array(own) - peak)) <= REFUSED * peak)
