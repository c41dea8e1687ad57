"""A text file held in memory, within bounds, that can say where in it something is wrong."""

import gzip
import itertools
import os
import re
import zlib
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import IO, Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from rockfrag.base.errors import InputError
from rockfrag.base.plausible import LONGEST_STEP, SHORTEST_STEP
from rockfrag.records.parsing.number_fields import (
    NumberError,
    numbers_of,
    parse_columns,
    parse_separated,
)

HEAD_BYTES = 16_384  # how much of a file is looked at to recognise its format
MAX_BYTES = 256 * 2**20  # three components of a day at 200 Hz are a third of it
# bytes of a text file: three components of a day at 200 Hz have as many
MAX_TEXT = 96 * 2**20
# numbers of a table: more than memory should hold beside the text
MOST_NUMBERS = 20_000_000
MAX_LINE = 8_192  # no line of a known format is longer, comments and citations included
# no record has more: eight hours of samples at 200 Hz, one a line
MAX_LINES = 6_000_000
_BLOCK = 2**20
_PIECE = 4 * _BLOCK
_MOST_ZEROS = 4 * _BLOCK  # bytes after which a file that has only zeros is given up
_BY_SIGNS = -1  # width of fields that touch, and that signs tell apart
_TOUCHING = re.compile(rb"(?<=[\d.])([+-])(?=\d*\.)")
"""A sign that begins a number right behind another one, as in Fortran's ``-.12E-01-.13E-01``."""

_REMARK = re.compile(r"[ \t]*(?:\*\*|#)[^\d\nA-Za-z]*[A-Za-z][^\d\n]*$")


class NotAcceleration(InputError):
    """A file in order that holds something other than acceleration: spectra, counts, velocity."""


Source = str | os.PathLike[str] | IO[bytes]


def name_of(source: Source) -> str:
    """Return the name to use for a file in messages."""
    if isinstance(source, (str, os.PathLike)):
        return str(source)
    name = getattr(source, "name", None)
    return name if isinstance(name, str) else "<file object>"


def _opened(path: str | os.PathLike[str]) -> Any:
    return (gzip.open if str(path).lower().endswith(".gz") else open)(path, "rb")


def read_head(source: Source, size: int = HEAD_BYTES) -> bytes:
    """Return the first bytes of a file, or nothing if it cannot be read; leave a file object where it was."""
    try:
        if isinstance(source, (str, os.PathLike)):
            if not os.path.isfile(source):
                return b""
            with _opened(source) as file:
                return bytes(file.read(size))
        position = source.tell()
        try:
            head = source.read(size)
        finally:
            source.seek(position)
        return head if isinstance(head, bytes) else b""
    except (OSError, EOFError, ValueError, AttributeError, TypeError, zlib.error):
        return b""


@dataclass(frozen=True)
class TextFile:
    r"""The bytes of a text file with Unix line ends, read through numbered lines."""

    name: str  # name for messages
    data: bytes  # all bytes, ``\n`` line ends
    encoding: str = ""  # of lines that are not UTF-8; empty if the format has no other
    # whether fewer samples than the header promises are read, not refused
    cut_short: bool = False
    # the user's interval [s], for text that does not state its own
    asked_dt: float | None = None

    @cached_property
    def _lines(self) -> list[str]:
        """The lines, a character a byte."""
        lines = self.data.decode("latin-1").split("\n")
        return lines[:-1] if self.data.endswith(b"\n") else lines

    def __len__(self) -> int:
        """Return the number of lines."""
        return len(self._lines)

    def raw(self, line: int) -> str:
        """Return one line (from zero), a character a byte; empty past the end."""
        return self._lines[line] if line < len(self) else ""

    def body(self, start: int, stop: int | None = None) -> bytes:
        """Return the bytes of lines ``start`` up to ``stop`` (from zero)."""
        return "\n".join(self._lines[start:stop]).encode("latin-1")

    def line(self, line: int) -> str:
        """Return one line (from zero) without blanks at its end; empty past the end."""
        raw = self.raw(line).encode("latin-1")
        try:
            return raw.decode("utf-8").rstrip()
        except UnicodeDecodeError as error:
            if self.encoding:
                return raw.decode(self.encoding, errors="replace").rstrip()
            self.fail(
                f"byte {error.object[error.start]:#04x} is not UTF-8 text; save the file as UTF-8",
                line,
            )

    def lines(self, start: int, stop: int) -> list[str]:
        """Return lines ``start`` up to ``stop`` (from zero), as many as there are."""
        return [self.line(i) for i in range(start, min(stop, len(self)))]

    def find(
        self, pattern: re.Pattern[str], start: int = 0, stop: int | None = None
    ) -> int:
        """Return the first line from ``start`` (before ``stop``) that has the pattern, or -1."""
        last = len(self) if stop is None else min(stop, len(self))
        return next(
            (i for i in range(start, last) if pattern.search(self._lines[i])), -1
        )

    def until(self, pattern: re.Pattern[str], start: int) -> int:
        """Return the first line from ``start`` that has the pattern, or the number of lines."""
        found = self.find(pattern, start)
        return len(self) if found < 0 else found

    def parts(
        self,
        head: re.Pattern[str],
        end: re.Pattern[str] | None = None,
        start: int = 0,
        stop: int | None = None,
    ) -> Iterator[tuple[int, int]]:
        """Yield first line and end of each part that a ``head`` begins: up to its ``end`` or the next one."""
        last = len(self) if stop is None else stop
        first = self.find(head, start, last)
        while first >= 0:
            after = min(last, self.until(end or head, first + 1))
            yield first, after
            first = self.find(head, after, last)

    def fail(
        self, what: str, line: int | None = None, problem: type[InputError] = InputError
    ) -> NoReturn:
        """Raise an :class:`InputError` about a line (from zero) or the whole file."""
        where = self.name if line is None else f"{self.name}, line {line + 1}"
        raise problem(f"{where}: {what.rstrip('.')}.")

    def check_count(
        self, promised: int, found: int, line: int, noun: str = "samples", each: int = 1
    ) -> None:
        """Check that as many numbers were found as the header promises; fewer pass where a short file is wanted.

        Parameters
        ----------
        promised, found : samples, and numbers
        line : for messages
        noun : what is counted
        each : numbers of one sample
        """
        if found != promised * each and not (
            self.cut_short and 0 < found < promised * each
        ):
            self.fail(
                f"the header promises {promised} {noun} but {found / each:g} follow; "
                "the file is cut short, or its header is wrong",
                line,
            )

    def refuse(self, what: str, line: int | None = None) -> NoReturn:
        """Raise :class:`NotAcceleration`: the file is in order, but holds something else."""
        self.fail(what, line, NotAcceleration)

    def numbers(
        self,
        start: int,
        stop: int | None = None,
        *widths: int | None,
        count: int | None = None,
    ) -> NDArray[np.float64]:
        """Parse lines ``start`` up to ``stop`` as numbers, shape (n,), of ``count`` if one is promised.

        ``widths`` are of Fortran fields, None of separated numbers; the first that the lines (blanks may be edited
        away) and the count fit is taken. Separated numbers are tried at last, then those that signs tell apart.
        """
        body = self.body(start, stop)
        found: list[NDArray[np.float64]] = []
        wrong: list[NumberError] = []
        for width in (*dict.fromkeys((*widths, None)), _BY_SIGNS):
            try:
                if width == _BY_SIGNS:
                    values = parse_separated(_TOUCHING.sub(rb" \1", body))
                elif width:
                    values = parse_columns(body.split(b"\n"), width)
                else:
                    values = parse_separated(body)
            except NumberError as error:
                wrong.append(error)
                continue
            if count in (None, values.size):
                return values
            found.append(values)
        if not found:
            # of the layouts the one that most lines fit
            last = max(wrong, key=lambda each: each.line)
            self.fail(str(last), start + last.line)
        row = len(numbers_of(self.raw(start)))
        for values in found:
            if self.is_filled_up(values, count or 0, row):
                return values[:count]
        self.check_count(count or 0, found[0].size, start)
        return found[0]

    def is_filled_up(
        self, values: NDArray[np.float64], count: int, columns: int
    ) -> bool:
        """Tell whether behind ``count`` values in rows of ``columns`` only zeros fill up the last row."""
        surplus = values.size - count
        whole = 0 < surplus < columns and values.size % columns == 0
        return count > 0 and whole and not values[count:].any()

    def reals(
        self, start: int, stop: int, width: int, count: int, kind: str = "numbers"
    ) -> list[float]:
        """Return the numbers of header lines ``start`` up to ``stop`` (columns of ``width``)."""
        values = self.numbers(start, stop, width)
        if values.size < count:
            self.fail(
                f"{count} {kind} are expected in this header, not {values.size}", start
            )
        return [*map(float, values)]

    def integers(self, start: int, stop: int, width: int, count: int) -> list[int]:
        """Return the whole numbers of header lines ``start`` up to ``stop`` (columns of ``width``)."""
        values = self.reals(start, stop, width, count, "whole numbers")
        if any(value % 1 for value in values):
            self.fail(
                "the header has a fraction where whole numbers are expected", start
            )
        return [int(value) for value in values]

    def in_rows(
        self, values: NDArray[np.float64], columns: int, start: int
    ) -> NDArray[np.float64]:
        """Return the values from line ``start`` on as whole rows, shape (rows, columns)."""
        if values.size == 0 or values.size % columns:
            self.fail(
                f"{values.size} values do not fill rows of {columns}; the file is cut short",
                start,
            )
        return values.reshape(-1, columns)

    def number(self, words: str, problem: str, line: int | None = None) -> float:
        """Return the number that words of the header are; there is a problem if they are none."""
        try:
            return float(words)
        except ValueError:
            self.fail(problem, line)

    def interval(self, dt: float, line: int) -> float:
        """Return the sampling interval [s] that the header gives, if it can be one."""
        if not (np.isfinite(dt) and SHORTEST_STEP <= dt <= LONGEST_STEP):
            self.fail(
                f"the header gives {dt:g} s as sampling interval; records have from "
                f"{SHORTEST_STEP:g} to {LONGEST_STEP:g} s",
                line,
            )
        return dt

    def check_widths(self, widths: NDArray[np.int64], columns: int, start: int) -> None:
        """Check that rows from line ``start`` on which are not blank have as many numbers as the first."""
        wrong = np.flatnonzero((widths != columns) & (widths > 0))
        if wrong.size:
            first = int(wrong[0])
            self.fail(
                f"{widths[first]} columns here, {columns} in the rows above; the file is cut short or damaged",
                start + first,
            )

    def rows(
        self, start: int, stop: int | None = None, decimal_comma: bool = False
    ) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
        """Parse lines as rows of numbers: all of them, shape (n,), and how many each line has.

        Numbers are separated by blanks, tabs, commas or semicolons, or touch where a sign tells them
        apart; a comma beside semicolons, or with ``decimal_comma``, is a decimal comma. Lines at the end
        that have only separators, as spreadsheets leave, do not count.
        """
        body = self.body(start, stop).rstrip(b" \t\r\n,;")
        if not body:
            self.fail("no data below the header; the file is cut short", start)
        separator = b";" if b";" in body or decimal_comma else b","
        values: list[NDArray[np.float64]] = []
        widths: list[NDArray[np.int64]] = []
        begin = line = count = 0
        # in pieces, of which each is held several times over
        while begin < len(body):
            end = body.find(b"\n", begin + _PIECE) + 1 or len(body)
            piece = body[begin:end].replace(separator, b" ").replace(b",", b".")
            piece = _TOUCHING.sub(rb" \1", piece.replace(b"\t", b" "))
            widths.append(_tokens_by_line(piece))
            try:
                values.append(parse_separated(piece))
            except NumberError as error:
                self.fail(str(error), start + line + error.line)
            count += values[-1].size
            if count > MOST_NUMBERS:
                self.fail(
                    f"more than {MOST_NUMBERS:,} numbers are no record; cut it to the earthquake"
                )
            begin, line = end, line + widths[-1].size
        return np.concatenate(values), np.concatenate(widths)


def last_row(text: TextFile, start: int) -> int:
    """Return the line after the last that is no remark, such as ``*** End Data ***``."""
    for stop in range(len(text), start, -1):
        line = text.raw(stop - 1)
        if line.strip() and not is_remark(line):
            return stop
    return start


def is_remark(line: str) -> bool:
    """Tell whether a line is a remark in words below the samples: ``** End``, ``# end of data``."""
    return bool(_REMARK.match(line))


def _tokens_by_line(body: bytes) -> NDArray[np.int64]:
    """Return the number of blank-separated tokens of each line, shape (lines,)."""
    characters = np.frombuffer(body, dtype=np.uint8)
    starts = np.diff((characters > ord(" ")).view(np.int8), prepend=0) == 1
    begins = np.append(0, np.flatnonzero(characters[:-1] == ord("\n")) + 1)
    widths: NDArray[np.int64] = np.add.reduceat(starts, begins, dtype=np.int64)
    return widths


def read_text(source: Source, encoding: str = "") -> TextFile:
    """Read a text file within the bounds of size and line length; lines that are not UTF-8 are of ``encoding``."""
    name = name_of(source)
    if isinstance(source, (str, os.PathLike)):
        check_file(source)
        try:
            with _opened(source) as file:
                data = _read_blocks(file, name)
        except (OSError, EOFError, zlib.error) as error:
            raise InputError(f"{name}: cannot be read ({error}).") from None
    else:
        data = _read_blocks(source, name)
    if b"\n" not in data[:HEAD_BYTES] and b"\r" in data[:HEAD_BYTES]:
        data = data.replace(b"\r", b"\n")
    elif b"\r" in data:
        data = data.replace(b"\r\n", b"\n").replace(b"\r", b" ")
    if data.startswith(b"\xef\xbb\xbf"):
        data = data[3:]
    text = TextFile(name, data.rstrip(b"\x1a\x00"), encoding)
    if not text.data.strip():
        raise InputError(f"{name}: the file is empty.")
    return text


def copy_within(source: Any, target: Path, most: int, problem: str) -> int:
    """Copy a stream into a file and return its size; more than ``most`` bytes are refused as a problem."""
    size = 0
    with target.open("wb") as out:
        while block := source.read(_BLOCK):
            size += len(block)
            if size > most:
                raise InputError(problem)
            out.write(block)
    return size


def check_file(path: str | os.PathLike[str]) -> None:
    """Check that a path leads to a file of a size that a record can have."""
    file = Path(path)
    try:
        if file.is_symlink() and not file.exists():
            raise InputError(f"{path}: the symbolic link leads to nothing.")
        if file.is_dir():
            raise InputError(f"{path}: this is a folder, not a record.")
        if not file.is_file():
            raise InputError(f"{path}: there is no such file.")
        size = file.stat().st_size
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror}).") from None
    if size == 0:
        raise InputError(f"{path}: the file is empty.")
    if size > MAX_BYTES:
        raise InputError(
            f"{path}: {size / 2**20:.0f} MiB are too many for a record (at most {MAX_BYTES // 2**20})."
        )


def _read_blocks(file: Any, name: str) -> bytes:
    """Read all bytes of a text file, refusing early what is too large or has too long a line."""
    blocks: list[bytes] = []
    open_line, total, lines, newlines = b"", 0, 0, 0
    zeros = True
    while block := file.read(_BLOCK):
        if not isinstance(block, bytes):
            raise InputError(f"{name}: open the file in binary mode.")
        total += len(block)
        if total > MAX_TEXT:
            raise InputError(
                f"{name}: more than {MAX_TEXT // 2**20} MiB of text are no record; cut it to the earthquake."
            )
        zeros = zeros and not block.translate(None, b"0 .,;\t\r\n+-\x00")
        if zeros and total >= _MOST_ZEROS:
            raise InputError(f"{name}: nothing but zeros.")
        joined = open_line + block
        parts = joined.replace(b"\r", b"\n").split(b"\n")
        if max(map(len, parts)) > MAX_LINE:
            whole = itertools.takewhile(lambda part: len(part) <= MAX_LINE, parts)
            start = sum(len(part) + 1 for part in whole)
            number = newlines + joined.count(b"\n", 0, start) + 1
            raise InputError(
                f"{name}, line {number}: the line is longer than "
                f"{MAX_LINE} characters, which no record format has."
            )
        newlines, lines = newlines + block.count(b"\n"), lines + len(parts) - 1
        open_line = parts[-1]
        if lines > MAX_LINES:
            raise InputError(f"{name}: more than {MAX_LINES:,} lines are no record.")
        blocks.append(block)
    return b"".join(blocks)
