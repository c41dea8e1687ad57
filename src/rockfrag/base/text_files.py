"""Text that users wrote, in the encodings in which programs save it."""

import codecs
import os
import re
from pathlib import Path

from rockfrag.base.errors import InputError

_WORKBOOKS = (b"PK\x03\x04", b"\xd0\xcf\x11\xe0")
_UTF16 = (b"\xff\xfe", b"\xfe\xff")
_START = 65_536  # bytes from which the encoding of a table is told
_UNFIT = re.compile(
    "[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\u2028\u2029\u202a-\u202e\u2066-\u2069\ud800-\udfff\ufffe\uffff]"
)


def unfit_character(text: str) -> str:
    """First character that no line of a page or a table can show, or an empty text.

    Parameters
    ----------
    text : of any length

    Returns
    -------
    The character.
    """
    found = _UNFIT.search(text)
    return found[0] if found else ""


def printable(text: str) -> str:
    """Text with a replacement character for each that no line of a terminal or a table can show.

    Parameters
    ----------
    text : of any length

    Returns
    -------
    The text, of the same length.
    """
    return (
        text
        if text.isprintable()
        else "".join(c if c.isprintable() else "\ufffd" for c in text)
    )


def read_text(path: str | os.PathLike[str], most_bytes: int) -> str:
    """Read a file of text in UTF-8, or in UTF-16 with a byte order mark.

    Parameters
    ----------
    path : of the file
    most_bytes : size above which it is refused

    Returns
    -------
    The text, without a byte order mark.
    """
    file = Path(path)
    try:
        if file.exists() and not file.is_file():
            raise InputError(
                f"{path}: cannot be read (a folder or a device); name a file."
            )
        with file.open("rb") as stream:
            data = stream.read(most_bytes + 1)
    except OSError as error:
        raise InputError(
            f"{path}: cannot be read ({error.strerror}); check the path."
        ) from error
    except ValueError as error:
        raise InputError(f"{path}: is no path ({error}).") from error
    if len(data) > most_bytes:
        raise InputError(f"{path}: is larger than {most_bytes // 1024} KiB; divide it.")
    refuse_workbook(data, str(path))
    encoding = "utf-16" if data.startswith(_UTF16) else "utf-8-sig"
    try:
        text = data.decode(encoding)
    except UnicodeDecodeError as error:
        raise InputError(
            f"{path}: is not UTF-8 text (byte {error.start}); save it as text in UTF-8."
        ) from error
    if found := _UNFIT.search(text):
        line = text.count("\n", 0, found.start()) + 1
        raise InputError(
            f"{path}, line {line}: holds the character {found[0]!r}, which no text shows; remove it."
        )
    return text


def refuse_workbook(start: bytes, where: str) -> None:
    """Raise InputError if a file's first bytes are those of a spreadsheet or an archive."""
    if start.startswith(_WORKBOOKS):
        raise InputError(
            f"{where}: this is a spreadsheet or archive, not text; save the sheet as CSV (UTF-8) and name "
            "that file."
        )


def table_encoding(path: str | os.PathLike[str]) -> str:
    """Tell the encoding of a long table from its first bytes: UTF-8, UTF-16 or Western European.

    Parameters
    ----------
    path : of the file, of any size

    Returns
    -------
    The name of the encoding, as ``open`` takes it.
    """
    source = Path(path).name
    try:
        with open(path, "rb") as file:
            start = file.read(_START)
    except FileNotFoundError as error:
        raise InputError(f"{path}: there is no such file; correct the path.") from error
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror}).") from error
    refuse_workbook(start, source)
    if start.startswith(_UTF16):
        return "utf-16"
    if b"\x00" in start:
        raise InputError(
            f"{source}: this is not a text file; save the table as CSV (UTF-8)."
        )
    try:
        # a character may be cut at the end of what was read
        codecs.getincrementaldecoder("utf-8")().decode(start, final=len(start) < _START)
    except UnicodeDecodeError:
        return "cp1252"
    return "utf-8-sig"
