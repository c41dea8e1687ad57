"""Volume 2 of Caltech (EERL) and of the University of Southern California: corrected acceleration in cm/s².

A text header that repeats the one of volume 1, 100 integers, 100 reals, then sections below lines
such as ``1887 POINTS OF ACC DATA EQUALLY SPACED AT   .020 SEC.  IN UNITS CM/SEC/SEC`` (8F10.3). Where that
line states no unit, the line ``PEAK ACCELERATION = … CMS/SEC/SEC`` does; where there is no such line, the
words above state count and interval. The largest value must be the peak that the header states.
"""

import re
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from rockfrag.records.formats.usc import place_of
from rockfrag.records.parsing import format as form
from rockfrag.records.parsing.quantities import canonical_unit
from rockfrag.records.parsing.text_file import TextFile

_FIRST = re.compile(r"^\s*CORRECTED\s+ACCELEROGRAM\b(?P<code>\s+II[A-Z]+\d+)?", re.I)
_SECOND = re.compile(r"OF\s+UNCORRECTED\s+ACCELEROGRAM\s+DATA\s+OF\s+VOLUME", re.I)
_VALUES = re.compile(r"^\s*\d+\s+POINTS\s+OF\s+\w+\s+DATA\s+EQUALLY", re.I)
_END = re.compile(rf"{_VALUES.pattern}|^\s*/&|{_FIRST.pattern}", re.I)
_VALUES_LINE = re.compile(
    r"(?i)^\s*(?P<count>\d+)\s+POINTS\s+OF\s+(?P<quantity>ACC|VEL|DIS)\w*\s+DATA\s+EQUALLY[\s-]+SPACED\s+"
    r"AT\s+(?P<dt>[\d.]+)\s*SEC\.?(?:\s*(?:\(|IN\s+)?\s*(?:UNITS?\b\s*(?:OF|:)?\s*)?(?P<unit>[A-Z]+/[A-Z/*\d]+))?"
)
_PEAK = re.compile(
    r"PEAK\s+ACCELERATION\s*=\s*(?P<value>[-+]?[\d.]+)\s+(?P<unit>[A-Z]+/[A-Z/*\d]+)",
    re.I,
)
_COUNT_IN_WORDS = re.compile(
    r"(?P<count>\d+)\s+INSTRUMENT\s+AND\s+BASELINE\s+CORRECTED", re.I
)
_STEP_IN_WORDS = re.compile(r"SPACED\s+INTERVALS?\s+OF\s+(?P<dt>[\d.]+)\s*SEC", re.I)
_WHOLE_NUMBERS = re.compile(r"^\s*(?:-?\d+\s+){9,}-?\d+\s*$")
_AS_STATED = 0.01  # fraction by which the largest value may be off the stated peak
# lines of 100 integers (16I5) and of 100 reals (8F10) above the samples
_NUMBER_LINES = 7 + 13
_MAX_HEADER = 60
_SECOND_LINES = 6
_WIDTH = 10


def _recognise(lines: list[str], name: str) -> bool:
    """Whether lines are those of such a file, by the words of its header."""
    first = _FIRST.match(lines[0])
    return first is not None and bool(
        first["code"] or any(_SECOND.search(line) for line in lines[1:_SECOND_LINES])
    )


def _parse(text: TextFile) -> Iterator[form.Channel]:
    """Channels of a file of this format, by its header as the head of the module says it."""
    for first, stop in text.parts(_FIRST):
        sections = list(text.parts(_VALUES, _END, first, stop))
        if not sections:
            yield _in_words(text, first, stop)
        for line, end in sections:
            words = text.lines(first, min(sections[0][0], first + _MAX_HEADER))
            channel = _section(text, line, end, words)
            if channel.quantity == "acceleration":
                _check_peak(text, words, channel.samples, line)
            yield place_of(words, channel)


def _in_words(text: TextFile, first: int, stop: int) -> form.Channel:
    """Return the acceleration of a file whose words alone state count and interval."""
    start = text.find(_WHOLE_NUMBERS, first, stop)
    words = text.lines(first, start if start >= 0 else first + _MAX_HEADER)
    count = form.first_match(_COUNT_IN_WORDS, words)
    step = form.first_match(_STEP_IN_WORDS, words)
    peak = form.first_match(_PEAK, words)
    if start < 0 or count is None or step is None or peak is None:
        text.fail(
            "no number of samples, interval or peak is stated below; the file is cut short",
            first,
        )
    promised, line = int(count["count"]), start + _NUMBER_LINES
    values = text.numbers(line, stop, _WIDTH)
    if values.size == 3 * promised:
        # velocity and displacement follow
        values = values[:promised]
    text.check_count(promised, values.size, line)
    _check_peak(text, words, values, line)
    dt = text.interval(float(step["dt"]), first)
    return place_of(words, form.Channel(promised, dt, values, _unit(peak["unit"])))


def _unit(words: str) -> str:
    return canonical_unit(words.upper().replace("CMS", "CM"))


def _check_peak(
    text: TextFile, words: list[str], samples: NDArray[np.float64], line: int
) -> None:
    """Check the largest of samples against the peak that the header states, in the same unit.

    ``words``: the header; ``line``: of the file, that a message names.
    """
    peak = form.first_match(_PEAK, words)
    stated = abs(float(peak["value"])) if peak else 0.0
    found = float(np.abs(samples).max())
    if stated and not text.cut_short and abs(found - stated) > _AS_STATED * stated:
        text.fail(
            f"the largest value is {found:g}, but the header states a peak of {stated:g}; mend the header or "
            "the values",
            line,
        )


def _section(text: TextFile, line: int, stop: int, words: list[str]) -> form.Channel:
    """A channel of a file, from the line that states its samples to the line ``stop``; ``words``: the header."""
    match = _VALUES_LINE.match(text.line(line))
    if match is None:
        text.fail("number of samples, interval or quantity cannot be read here", line)
    peak = form.first_match(_PEAK, words)
    unit = _unit(match["unit"] or (peak["unit"] if peak else ""))
    quantity = form.QUANTITIES[match["quantity"].upper()]
    count, dt = int(match["count"]), float(match["dt"])
    return form.section(
        text, line, stop, count=count, dt=dt, unit=unit, width=_WIDTH, quantity=quantity
    )


FORMAT = form.Format("USC2", _recognise, _parse)
