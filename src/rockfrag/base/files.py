"""Writing files so that they appear whole or not at all, and tables so that they are reproducible."""

import hashlib
import os
import tempfile
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

import pandas as pd

from rockfrag.base.errors import InputError

LONGEST_NAME = 80  # characters of a name, and of the file name made of it
# characters with which a spreadsheet takes a cell for a formula
FORMULA = ("=", "+", "-", "@")
_DEVICES = (f"{port}{n}" for port in ("com", "lpt") for n in range(10))
_RESERVED = {"con", "prn", "aux", "nul", *_DEVICES}  # devices, not files, on Windows


def is_file(path: Path) -> bool:
    """Whether there is such a file; there is none where the name is too long for one.

    Parameters
    ----------
    path : of any length

    Returns
    -------
    Whether a file stands there; False for a folder.
    """
    try:
        return path.is_file()
    except OSError:
        return False


def sha256_of(path: Path) -> str:
    """Return the SHA-256 of a file, 64 hexadecimal digits in lower case.

    Parameters
    ----------
    path : of a file that exists

    Returns
    -------
    The digest.
    """
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def check_name(name: str) -> None:
    """Check that a name which a user gave can stand in tables, figures and file names.

    Parameters
    ----------
    name : as the user gave it
    """
    if (
        len(name) > LONGEST_NAME
        or not name.isprintable()
        or not any(c.isalnum() for c in name)
    ):
        raise InputError(
            f"expected a name with a letter or digit and of at most {LONGEST_NAME} characters, "
            f"found {name[:LONGEST_NAME]!r}."
        )
    if name.startswith(FORMULA):
        raise InputError(
            f"the name {name!r} begins as a formula of spreadsheets; begin it with a letter or digit."
        )


def file_name(name: str) -> str:
    """Make any text into a name that files may bear on every system.

    ASCII letters, digits, ``-``, ``_`` and ``.`` stay, other characters become ``-``; a digest follows
    where letters of other scripts or what is too long were lost, so that such names stay different.

    Parameters
    ----------
    name : any text

    Returns
    -------
    A name without folder, of at most 88 characters.
    """
    plain = "".join(
        c if c.isascii() and (c.isalnum() or c in "-_.") else "-" for c in name
    )
    plain = plain[:LONGEST_NAME] or "unnamed"
    # neither hidden nor an option, and never a folder or a device
    if plain[0] in ".-":
        plain = f"_{plain[1:]}"
    if plain[-1] == ".":
        plain = f"{plain[:-1]}-"
    if plain.split(".")[0].casefold() in _RESERVED:
        plain = f"_{plain}"
    if name.isascii() and len(name) <= LONGEST_NAME:
        return plain
    digest = hashlib.sha256(name.encode("utf-8", "surrogatepass")).hexdigest()[:6]
    return f"{plain}-{digest}"


def distinct_file_names(
    names: Iterable[str], found: dict[str, str] | None = None
) -> None:
    """Check that names, and those ``found`` before, can be used and make files that stay apart in any case.

    Parameters
    ----------
    names : to be checked, in their order
    found : names met so far by their folded file names; those of ``names`` are added
    """
    found = {} if found is None else found
    for name in names:
        check_name(name)
        other = found.setdefault(file_name(name).casefold(), name)
        if other != name:
            raise InputError(f"{name} and {other} would share a file name; rename one.")


@contextmanager
def whole_file(path: str | os.PathLike[str]) -> Iterator[Path]:
    """Give a temporary path beside ``path`` that replaces it when the block ends without error.

    Parameters
    ----------
    path : of the file; its folder is made

    Returns
    -------
    A context that gives the temporary path to write to.
    """
    target = Path(path)
    target.parent.mkdir(parents=True, exist_ok=True)
    handle, name = tempfile.mkstemp(
        dir=target.parent, prefix=f".{target.name}.", suffix=".part"
    )
    os.close(handle)
    part = Path(name)
    try:
        yield part
        # mkstemp makes files private; results are for everybody that the umask allows
        umask = os.umask(0)
        os.umask(umask)
        part.chmod(0o666 & ~umask)
        part.replace(target)
    finally:
        part.unlink(missing_ok=True)


def write_text(text: str, path: str | os.PathLike[str]) -> None:
    """Write ``text`` as UTF-8 with Unix line ends, whole or not at all.

    Parameters
    ----------
    text : of the whole file
    path : of the file; its folder is made
    """
    with whole_file(path) as part:
        part.write_bytes(text.encode("utf-8"))


def csv_text(table: pd.DataFrame) -> str:
    """Text of a table as CSV with Unix line ends; what a spreadsheet would take for a formula becomes text.

    Parameters
    ----------
    table : with columns of numbers, texts or dates

    Returns
    -------
    The text, with a header line, without the index.
    """
    safe = table.copy(deep=False)
    for column in table.select_dtypes(exclude=["number", "bool", "datetime"]):
        if any(_as_text(value) is not value for value in table[column].unique()):
            safe[column] = table[column].map(_as_text)
    safe = safe.rename(columns=_as_text)
    return str(safe.to_csv(index=False, lineterminator="\n"))


def _as_text(value: Any) -> Any:
    """A cell that no spreadsheet takes for a formula: what looks like one gets an apostrophe before it."""
    if (
        not isinstance(value, str)
        or len(value) < 2
        or not value.startswith((*FORMULA, "\t", "\r"))
    ):
        return value
    with suppress(ValueError):
        float(value)
        return value
    return f"'{value}"


def write_table(table: pd.DataFrame, *paths: str | os.PathLike[str]) -> None:
    """Write a table to each path, by its ending as ``.csv`` or ``.parquet``, without the index.

    Parameters
    ----------
    table : with columns of numbers, texts or dates
    paths : of the files, that end in ``.csv`` or ``.parquet``; their folders are made
    """
    for path in paths:
        ending = Path(path).suffix
        with whole_file(path) as part:
            if ending == ".csv":
                part.write_bytes(csv_text(table).encode("utf-8"))
            elif ending == ".parquet":
                table.to_parquet(part, index=False, engine="pyarrow")
            else:
                raise ValueError(
                    f"{path}: a table is written as .csv or .parquet, not {ending!r}"
                )
