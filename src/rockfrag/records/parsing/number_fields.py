"""Numbers and rows of numbers out of text: fast, independent of the locale, and strict.

The fast way is numpy's own parser of separated numbers, which rounds correctly. Anything it cannot
take is looked at line by line, so that the error names the line.
"""

import re
import warnings
from contextlib import suppress
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

_D_EXPONENT = bytes.maketrans(b"Dd", b"Ee")
_EXPONENT_WITHOUT_LETTER = re.compile(rb"^([+-]?(?:\d+\.?\d*|\.\d+))([+-]\d{1,3})$")
_NUMBER = re.compile(rb"^[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d{1,4})?$")
_SHOWN = 24
# digits of a number: float64 needs no more than 350 even written out in full
_LONGEST = 400


class NumberError(ValueError):
    """Text that is not a number; ``line`` counts from zero in the text that was given."""

    def __init__(self, line: int, what: str) -> None:
        super().__init__(what)
        self.line = line


def parse_separated(text: bytes) -> NDArray[np.float64]:
    """Parse numbers separated by white space, shape (n,).

    Fortran's ``D`` exponents and exponents without a letter (``1.5-101``) are understood.
    """
    body = text.strip()
    if not body:
        return np.empty(0)
    if b"D" in body or b"d" in body:
        body = body.translate(_D_EXPONENT)
    with warnings.catch_warnings(), suppress(ValueError, DeprecationWarning):
        # numpy before 2.4 warns where later ones raise
        warnings.simplefilter("error", DeprecationWarning)
        values = np.fromstring(body, dtype=np.float64, sep=" ")
        if np.isfinite(values).all():
            return values
    lines = enumerate(text.split(b"\n"))
    return np.array(
        [_number(token, number) for number, line in lines for token in line.split()]
    )


def parse_columns(lines: list[bytes], width: int) -> NDArray[np.float64]:
    """Parse fixed-width Fortran fields, which need no blank between them, shape (n,)."""
    spaced = []
    for number, line in enumerate(lines):
        fields = [line[i : i + width] for i in range(0, len(line.rstrip()), width)]
        if any(len(field.split()) != 1 for field in fields):
            raise NumberError(number, "a field is not one number")
        spaced.append(b" ".join(fields))
    return parse_separated(b"\n".join(spaced))


def _number(token: bytes, line: int) -> float:
    """A finite number of one field, in Fortran's notation too."""
    plain = _EXPONENT_WITHOUT_LETTER.sub(rb"\1E\2", token.translate(_D_EXPONENT))
    value = float(plain) if len(token) <= _LONGEST and _NUMBER.match(plain) else np.nan
    if np.isfinite(value):
        return value
    short = token[:_SHOWN].decode("ascii", errors="replace")
    shown = repr(short + "…" if len(token) > _SHOWN else short)
    wrong = "not a number" if np.isnan(value) else "too large for a number"
    wrong = wrong if len(token) <= _LONGEST else "too long for a number"
    raise NumberError(line, f"{shown} is {wrong}")


_NUMERAL = r"[+-]?(?:\d+[.,]?\d*|[.,]\d+)(?:[EeDd][+-]?\d+)?"
_NUMBERS = re.compile(rf"(?>{_NUMERAL} )*+")
_COMMENT = re.compile(r"\s*(?:#|%|!|//)")
_BLANK = re.compile(r"^[\s,;\"]*$")
_TOUCHING = re.compile(r"(?<=[\d.])([+-])(?=\d*\.)")
_WITH_DECIMAL_COMMA = re.compile(r"[+-]?\d*,\d+(?:[EeDd][+-]?\d+)?$")
_NEARLY_A_NUMBER = re.compile(
    r"[+-]?(?:nan|inf(?:inity)?)$|\*{3,}$|(?=\D*\d)[\d.+\-eEdDxXp_*]+$", re.I
)
_DATE = re.compile(r"\d{1,4}-\d{1,2}-\d{1,4}")
_PER_CENT = re.compile(r"\W*%\s?(?:of\s)?g\b", re.I)
_MANY_ROWS = 20  # of samples of which some are negative
_NUMBER_SIGN = re.compile(r"[\s#]*[\"']?#[\"']?([\t,;]|\s{2,})")
_MARKS = " \t#%!/\"'"
# rows of one width, one below the other, that are samples and not a header of numbers
_RUN = 4
LOOKED_AT = 300  # first lines of a file from which its layout is told


@dataclass(frozen=True)
class NumberTable:
    """Where the samples of a text file start and what stands above them."""

    start: int  # first row of samples, from zero
    columns: int  # numbers in it
    # number (from zero) and words of each line of words above, without the marks of comments
    words: tuple[tuple[int, str], ...]
    # number (from zero) and numbers of each row of numbers above that is not one of the samples
    numbers: tuple[tuple[int, tuple[str, ...]], ...]
    # whether a comma is the decimal sign although no semicolon separates
    decimal_comma: bool

    @property
    def title(self) -> str:
        """First line of words, or an empty string."""
        return self.words[0][1] if self.words else ""


def number_table(lines: list[str]) -> NumberTable | None:
    """Find the first row of samples and what stands above it; None if there is no such row."""
    comma = has_decimal_commas(lines)
    rows = {
        number: numbers
        for number, line in enumerate(lines)
        if (numbers := numbers_of(line, comma)) and are_numbers(numbers)
    }
    start = _first_run(lines, rows)
    if start is None:
        return None
    words = tuple(
        (number, _without_marks(line))
        for number, line in enumerate(lines[:start])
        if number not in rows and line.strip(_MARKS)
    )
    above = tuple(
        (number, tuple(found)) for number, found in rows.items() if number < start
    )
    return NumberTable(start, len(rows[start]), words, above, comma)


def _without_marks(line: str) -> str:
    """Return words without the marks of a comment; ``#`` alone is the title of a column of numbers."""
    # of per cent of g the sign is no mark
    words = line.rstrip(" \t\"'#!")
    words = words.lstrip(_MARKS if not _PER_CENT.match(line) else " \t\"'#!")
    numbered = _NUMBER_SIGN.match(line)
    if not (numbered and words):
        return words
    return f"#{numbered[1]}{words.lstrip(' ,;' + chr(9))}"


def _first_run(lines: list[str], rows: dict[int, list[str]]) -> int | None:
    """Return the line at which ``_RUN`` rows of as many numbers follow each other; None if there are none.

    Fewer rows count where they go on to the last row, which may be shorter.

    Parameters
    ----------
    lines : of the file; blank ones between rows do not count
    rows : numbers of each row by the number of its line, from 0
    """
    last = max(rows, default=-1)
    run: list[int] = []
    for number in range(last + 1):
        if is_blank(lines[number]):
            continue
        if run and number in rows and len(rows[run[0]]) != len(rows[number]):
            if number == last and len(run) > 1:
                break
            run = []
        run = [*run, number] if number in rows else []
        if len(run) == _RUN:
            break
    return run[0] if run else None


def first_odd_row(lines: list[str]) -> int | None:
    """Return the number of the first row, from zero, that keeps a file of samples from being read.

    A row is odd if it has more or fewer numbers than the first row of samples, or words. Returned is None where
    there are no samples, no odd row, or as many odd rows as others, so that the file is of another kind.
    """
    table = number_table(lines)
    if table is None:
        return None
    filled = [i for i in range(table.start, len(lines)) if not is_blank(lines[i])]
    rows = {i: numbers_of(lines[i]) for i in filled}
    odd = [
        i for i in filled if len(rows[i]) != table.columns or not are_numbers(rows[i])
    ]
    return odd[0] if odd and 2 * len(odd) < len(filled) else None


def is_blank(line: str) -> bool:
    """Tell whether a line has nothing but blanks and separators, as spreadsheets leave."""
    return bool(_BLANK.match(line))


def is_damaged_row(line: str) -> bool:
    """Tell whether a line is a row of numbers of which some are none: ``0.02 nan``, ``*****``."""
    others = [word for word in numbers_of(line) if not are_numbers([word])]
    nearly = (
        _NEARLY_A_NUMBER.match(word) and not _DATE.search(word) for word in others
    )
    return bool(others) and not _COMMENT.match(line) and all(nearly)


def are_numbers(words: list[str]) -> bool:
    """Tell whether words, one or more, are all numbers."""
    return bool(words) and _NUMBERS.fullmatch(" ".join([*words, ""])) is not None


def numbers_of(line: str, decimal_comma: bool = False) -> list[str]:
    """Split a line at blanks and semicolons, or at blanks and commas where it has no semicolon.

    Fortran's fields that touch, as in ``-.12E-01-.13E-01``, are told apart by their signs.
    """
    separator = ";" if ";" in line or decimal_comma else ","
    return _TOUCHING.sub(r" \1", line.replace(separator, " ")).split()


def has_decimal_commas(lines: list[str]) -> bool:
    """Tell whether the commas of rows without semicolons can only be decimal signs.

    Every word with a comma must be one number with a decimal comma, and no word may have a point or a semicolon.
    Then the commas can only be decimal signs if one of these holds:

    - blanks separate the numbers of every row already, as in ``1 2,5``;
    - rows are so many (``_MANY_ROWS``) that of samples some would have a sign, and none stands behind a comma;
    - what stands behind a comma begins with a zero (``0,012``), or has an exponent and no decimals (``1,25E-3``).

    Parameters
    ----------
    lines : of a text file; those that are no rows of numbers, or have no comma, do not count

    Returns
    -------
    Whether they are; False where a comma may separate, or there is none.
    """
    rows = [
        line.split() for line in lines if "," in line and are_numbers(numbers_of(line))
    ]
    if not rows or any("." in word or ";" in word for row in rows for word in row):
        return False
    with_comma = [word for row in rows for word in row if "," in word]
    if not all(_WITH_DECIMAL_COMMA.match(word) for word in with_comma):
        return False
    separated_by_blanks = all(len(row) > 1 for row in rows)
    return (
        separated_by_blanks
        or len(rows) >= _MANY_ROWS
        or any(re.search(r",0\d|,\d+[EeDd]", word) for word in with_comma)
    )


def number_in(word: str) -> float:
    """Return a number whose decimal sign may be a comma and whose exponent a D."""
    try:
        return float(word)
    except ValueError:
        return float(word.replace(",", ".").upper().replace("D", "E"))
