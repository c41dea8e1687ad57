"""The largest acceleration that a header states, held against the samples."""

import math
import re
from dataclasses import dataclass, replace

import numpy as np

from rockfrag.base.errors import InputError
from rockfrag.records.motion import SAID
from rockfrag.records.parsing.format import Channel
from rockfrag.records.parsing.quantities import to_si

REFUSED = 0.25
"""Fraction of the stated peak by which that of the samples may differ: networks state it before a correction."""

MENTIONED = 0.02
"""Fraction above which a difference is said."""

_NUMBER = re.compile(
    r"[+-]?(?P<digits>\d+\.?(?P<decimals>\d*)|\.(?P<only>\d+))(?:[EeDd](?P<power>[+-]?\d+))?"
)
_NOT_KNOWN = 1e30  # above which a number stands for one that is not known


@dataclass(frozen=True)
class StatedPeak:
    """What a header says of the largest acceleration."""

    number: str  # in the words of the header, empty where it has none
    unit: str  # likewise


def with_checked_peak(
    channel: Channel, peak: StatedPeak, name: str, cut_short: bool = False
) -> Channel:
    """Return a channel whose samples have the peak that its header states, with a note of a small difference.

    The samples may be as they are or about their mean. A peak of zero, or one that is no number, is not stated;
    that of a file that is ``cut_short`` may stand in the part that is not there. ``name`` is the file's.
    """
    stated, last_place = _number(peak.number)
    factor, unit = to_si(peak.unit), peak.unit
    is_known = math.isfinite(factor) and math.isfinite(to_si(channel.unit))
    if not 0 < stated < _NOT_KNOWN or not is_known or not channel.samples.size:
        return channel
    held = np.array(peaks_of(channel)) / factor
    nearest = float(held[np.abs(held - stated).argmin()])
    # a peak of few digits is rounded
    off = max(0.0, abs(nearest - stated) - 0.5 * last_place)
    if off > REFUSED * stated and not (cut_short and nearest < stated):
        of = f" of {channel.component}" if channel.component else ""
        raise InputError(
            f"{name}: the header states a peak{of} of {stated:g} {unit}, but the samples have {nearest:.4g} "
            f"{unit}; one of them is wrong: mend the file."
        )
    if off <= MENTIONED * stated:
        return channel
    said = f"its peak is {nearest:.4g} {unit}, that of its header {stated:g} {unit}"
    step = {"step": "compare with the stated peak", SAID: said}
    return replace(channel, steps=(*channel.steps, step))


def peaks_of(channel: Channel) -> tuple[float, float]:
    """Return the largest size of the samples of a channel as they are and about their mean [m/s²]."""
    samples = channel.samples
    extremes = np.array([samples.min(), samples.max()])
    sizes = np.abs(np.array([extremes, extremes - samples.mean()])).max(axis=1)
    as_they_are, about_mean = sizes * to_si(channel.unit)
    return float(as_they_are), float(about_mean)


def _number(words: str) -> tuple[float, float]:
    """Return the size of the number that words begin with and the unit of its last place, zeros without one."""
    match = _NUMBER.match(words.strip())
    if match is None:
        return 0.0, 0.0
    power = 10.0 ** int(match["power"] or 0)
    places = len(match["decimals"] or match["only"] or "")
    return float(match["digits"]) * power, 10.0**-places * power
