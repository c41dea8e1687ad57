"""Rows of numbers below a short header of words, as plain text files have them."""

import re
from dataclasses import dataclass

_NUMBER = r"[+-]?(?:\d+[.,]?\d*|[.,]\d+)(?:[EeDd][+-]?\d+)?"
_NUMBERS = re.compile(rf"(?>{_NUMBER} )*+")
_COUNT_AND_STEP = re.compile(rf"^\s*(?P<npts>\d+)[\s,;]+(?P<dt>{_NUMBER})\s*$")
_STEP = re.compile(
    rf"\bdt\s*[=:]\s*(?P<dt>{_NUMBER})(?:\s*(?:s|sec|seconds?)\b|\s*$|\s*[,;])", re.IGNORECASE
)
_COMMENT = re.compile(r"^\s*(?:#|%|!|//|\"?\s*$)")
_MARKS = " \t#%!/"

MAX_HEADER = 20
"""Lines that may stand above the numbers."""


@dataclass(frozen=True)
class NumberTable:
    """Where the numbers of a text file start and what stands above them.

    Attributes
    ----------
    start
        First row of numbers, from zero.
    columns
        Numbers in it.
    npts, dt
        Number of samples and interval [s] that the header states, None where it does not.
    words
        Lines of words above the numbers, without the marks of comments, the uppermost first.
    free
        How many of these are not marked as comments.
    """

    start: int
    columns: int
    npts: int | None
    dt: float | None
    words: tuple[str, ...]
    free: int

    @property
    def title(self) -> str:
        """First line of words, or an empty string."""
        return self.words[0] if self.words else ""


def number_table(lines: list[str]) -> NumberTable | None:
    """Find the first row of numbers and read the header above it; None if there is no such row."""
    words: list[str] = []
    free = 0
    step = None
    for number, line in enumerate(lines[:MAX_HEADER]):
        if _COMMENT.match(line) or not is_row(line):
            plain = line.strip(_MARKS)
            stated = _STEP.search(line)
            step = number_in(stated["dt"]) if stated else step
            words += [plain] if plain else []
            free += bool(plain) and not _COMMENT.match(line)
            continue
        counted = _COUNT_AND_STEP.match(line)
        below = next((text for text in lines[number + 1 :] if text.strip()), "")
        if counted and _is_count_line(counted, below):
            npts, dt = int(counted["npts"]), number_in(counted["dt"])
            return NumberTable(number + 1, width_of(below), npts, dt, tuple(words), free)
        return NumberTable(number, width_of(line), None, step, tuple(words), free)
    return None


def _is_count_line(match: re.Match[str], below: str) -> bool:
    """Tell ``npts dt`` from the first row of two columns: the next row is no time 0 + dt."""
    npts, dt = int(match["npts"]), number_in(match["dt"])
    if npts < 2 or not 0 < dt <= 1 or not is_row(below):
        return False
    return width_of(below) != 2 or number_in(numbers_of(below)[0]) < npts


def first_odd_row(lines: list[str]) -> int | None:
    """Return the first line (from zero) that keeps mostly numeric text from being plain text."""
    table = number_table(lines)
    if table is None:
        return None
    filled = [i for i in range(table.start, len(lines)) if lines[i].strip()]
    odd = [i for i in filled if not is_row(lines[i]) or width_of(lines[i]) != table.columns]
    return odd[0] if odd and 2 * len(odd) < len(filled) else None


def is_row(line: str) -> bool:
    """Tell whether a line is numbers and nothing else."""
    return are_numbers(numbers_of(line))


def are_numbers(words: list[str]) -> bool:
    """Tell whether words, one or more, are all numbers."""
    return bool(words) and _NUMBERS.fullmatch(" ".join([*words, ""])) is not None


def width_of(line: str) -> int:
    """Return how many words, numbers as a rule, a line has."""
    return len(numbers_of(line))


def numbers_of(line: str) -> list[str]:
    """Split a line at blanks and semicolons, or at blanks and commas where it has no semicolon."""
    return line.replace(";" if ";" in line else ",", " ").split()


def number_in(word: str) -> float:
    """Return a number whose decimal sign may be a comma and whose exponent a D."""
    try:
        return float(word)
    except ValueError:
        return float(word.replace(",", ".").upper().replace("D", "E"))
