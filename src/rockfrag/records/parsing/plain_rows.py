r"""Rows as other programs write them: cells in quotation marks, lists in braces, clock times.

They are made rows of plain numbers, a row for a row, so that messages keep their lines.
"""

import re
from dataclasses import dataclass, replace

from rockfrag.records.parsing.number_fields import LOOKED_AT, are_numbers, numbers_of
from rockfrag.records.parsing.text_file import TextFile

_QUOTED = re.compile(r"\"\s*([^\"]*?)\s*\"|'\s*([^']*?)\s*'")
_DECIMAL_COMMA = re.compile(r"[+-]?\d*,\d+(?:[EeDd][+-]?\d+)?")
_AROUND = re.compile(r"^\s*[\[{(]+|(?:\\|\.\.\.|[\])}]+;?|;)\s*$")
_ENDING = re.compile(r"\s*[\])}]+\s*;?\s*")  # the last line of a list
_DAY = r"\d{4}[-/.]\d{1,2}[-/.]\d{1,2}|\d{1,2}[-/.]\d{1,2}[-/.]\d{2,4}"
_CLOCK = re.compile(
    rf"(?:(?<=^)|(?<=[\s,;\"']))(?:(?P<day>{_DAY})(?P<between>[T ]|\s*[,;\t]\s*|\s+))?"
    r"(?P<hour>[01]?\d|2[0-3]):(?P<minute>[0-5]\d)(?::(?P<second>[0-5]?\d(?:\.\d+|,\d+(?=[;\t ]))?))?"
    r"(?P<zone>Z|\s?UTC|\s?GMT|[+-]\d\d:?\d\d)?(?=$|[\s,;\"'])"
)
_SECONDS_A_DAY = 86_400


@dataclass(frozen=True)
class PlainRows:
    """Lines in which rows are plain numbers, and what clock times said."""

    lines: tuple[str, ...]
    clock_column: int | None = None  # column of clock times, from zero
    start: str = ""  # first clock time, in the words of the file


def plain_rows(lines: list[str]) -> PlainRows:
    """Return lines with plain numbers for rows of other programs.

    Parameters
    ----------
    lines
        Of a text file, or the first of them.

    Returns
    -------
    PlainRows
        As many lines; those that do not become rows of numbers are left as they are. Clock times become seconds
        since the midnight before the first.
    """
    # of clock times: their column, the first one, midnights passed since then, and the match of the last one
    found, column, start, days, last = [], None, "", 0, None
    for line in lines:
        clock = _CLOCK.search(line) if ":" in line else None
        row, place, new_day = line, 0, False
        if clock is not None:
            new_day = last is not None and _is_of_a_later_day(clock, last)
            row, place = _with_seconds(line, clock, days + new_day)
        row = _without_marks(row)
        if row == line or (row and not are_numbers(numbers_of(row))):
            found.append(line)
            continue
        found.append(row)
        if clock is not None:
            column, start = (
                (place, clock[0].strip()) if last is None else (column, start)
            )
            days, last = days + new_day, clock
    return PlainRows(tuple(found), column, start)


def _is_of_a_later_day(clock: re.Match[str], last: re.Match[str]) -> bool:
    """Tell whether a day has begun since the last clock time: another date, or an earlier hour without dates."""
    if clock["day"] and last["day"]:
        return bool(clock["day"] != last["day"])
    return _seconds_of_day(clock) < _seconds_of_day(last) - _SECONDS_A_DAY / 2


def _without_marks(line: str) -> str:
    """Return a row without quotation marks, braces and the mark that it goes on."""
    if _ENDING.fullmatch(line):
        return ""
    plain = _AROUND.sub(" ", line.rstrip())
    if '"' not in plain and "'" not in plain:
        return plain if plain.strip() != line.strip() else line

    def cell(quoted: re.Match[str]) -> str:
        inside = quoted[1] if quoted[1] is not None else quoted[2]
        return inside.replace(",", ".") if _DECIMAL_COMMA.fullmatch(inside) else inside

    return _QUOTED.sub(cell, plain)


def _seconds_of_day(clock: re.Match[str]) -> float:
    seconds = float((clock["second"] or "0").replace(",", "."))
    return 3600 * int(clock["hour"]) + 60 * int(clock["minute"]) + seconds


def _with_seconds(line: str, clock: re.Match[str], days: int) -> tuple[str, int]:
    """Return a row with seconds for its clock time, and how many numbers stand before them."""
    fraction = re.split("[.,]", clock["second"] or "")[1:]
    seconds = _seconds_of_day(clock) + days * _SECONDS_A_DAY
    day = f"{days}{clock['between']}" if _has_day_of_its_own(line, clock) else ""
    before = line[: clock.start()] + day
    written = f"{seconds:.{len(fraction[0]) if fraction else 0}f}"
    if "," in (clock["second"] or ""):
        written = written.replace(".", ",")
    place = len(numbers_of(re.sub("[\"'{(]|\\[", " ", before)))
    return before + written + line[clock.end() :], place


def _has_day_of_its_own(line: str, clock: re.Match[str]) -> bool:
    """Tell whether the day before a clock time is a cell, as it is where blanks separate cells."""
    between = clock["between"] or ""
    if re.search("[,;\t]", between):
        return True
    behind = line[max(clock.end("minute"), clock.end("second")) :]
    if between == " " and re.match(r"\s{2}", behind):
        return False
    return between.isspace() and not re.search("[,;\t]", line.replace(clock[0], ""))


def with_plain_rows(text: TextFile) -> tuple[TextFile, PlainRows]:
    """Return a text with plain numbers for rows of other programs, and what its clock times said."""
    head = text.lines(0, LOOKED_AT)
    found = plain_rows(head)
    if found.lines == tuple(head):
        return text, found
    # every line a character a byte, as the rows are numbers
    whole = plain_rows([text.raw(i) for i in range(len(text))])
    end = "\n" if text.data.endswith(b"\n") else ""
    data = ("\n".join(whole.lines) + end).encode("latin-1")
    return replace(text, data=data), whole
