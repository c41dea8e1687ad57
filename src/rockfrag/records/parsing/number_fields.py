"""Numbers out of text: fast, independent of the locale, and strict.

The fast way is numpy's own parser of separated numbers, which rounds correctly. Anything it cannot
take is looked at line by line, so that the error names the line.
"""

import re
import warnings
from contextlib import suppress

import numpy as np
from numpy.typing import NDArray

_D_EXPONENT = bytes.maketrans(b"Dd", b"Ee")
_EXPONENT_WITHOUT_LETTER = re.compile(rb"^([+-]?(?:\d+\.?\d*|\.\d+))([+-]\d{1,3})$")
_NUMBER = re.compile(rb"^[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d{1,4})?$")
_SHOWN = 24
_LONGEST = 400
"""Digits that a number may have: float64 needs no more than 350 even written out in full."""


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
    return np.array([_number(token, number) for number, line in lines for token in line.split()])


def parse_columns(lines: list[bytes], width: int) -> NDArray[np.float64]:
    """Parse fixed-width Fortran fields, which need no blank between them, shape (n,)."""
    padded = []
    for line in lines:
        stripped = line.rstrip()
        padded.append(stripped.ljust(-(-len(stripped) // width) * width))
    joined = b"".join(padded)
    if not joined:
        return np.empty(0)
    fields = np.frombuffer(joined, dtype=np.uint8).reshape(-1, width)
    # a blank after every field turns columns into separated numbers
    separated = np.full((fields.shape[0], width + 1), ord(" "), dtype=np.uint8)
    separated[:, :width] = fields
    filled = separated > ord(" ")
    starts = filled[:, :-1].astype(np.int8)
    tokens = (np.diff(starts, axis=1) == 1).sum(axis=1) + starts[:, 0]
    if (tokens != 1).any():
        ends = np.cumsum([len(line) // width for line in padded])
        number = int(np.searchsorted(ends, np.flatnonzero(tokens != 1)[0], side="right"))
        raise NumberError(number, "a field is not one number")
    try:
        return parse_separated(separated.tobytes())
    except NumberError as error:
        raise NumberError(_line_of_bad_field(padded, width), str(error)) from None


def _number(token: bytes, line: int) -> float:
    if len(token) > _LONGEST:
        raise NumberError(line, f"{_shown(token)} is too long for a number")
    plain = token.translate(_D_EXPONENT)
    match = _EXPONENT_WITHOUT_LETTER.match(plain)
    if match:
        plain = match.group(1) + b"E" + match.group(2)
    if not _NUMBER.match(plain):
        raise NumberError(line, f"{_shown(token)} is not a number")
    value = float(plain)
    if not np.isfinite(value):
        raise NumberError(line, f"{_shown(token)} is too large for a number")
    return value


def _shown(token: bytes) -> str:
    short = token[:_SHOWN].decode("ascii", errors="replace")
    return repr(short + "…" if len(token) > _SHOWN else short)


def _line_of_bad_field(padded: list[bytes], width: int) -> int:
    for number, line in enumerate(padded):
        for start in range(0, len(line), width):
            try:
                parse_separated(line[start : start + width])
            except NumberError:
                return number
    return 0
