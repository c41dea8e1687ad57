"""Writing files so that they appear whole or not at all, and tables so that they are reproducible."""

import hashlib
import os
import tempfile
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pandas as pd

from rockfrag.errors import InputError

LONGEST_NAME = 80
"""Characters of a name, and of the file name made of it."""


def file_name(name: str) -> str:
    """Make a name that users gave into one that files may bear on every system.

    ASCII letters, digits, ``-``, ``_`` and ``.`` stay, other characters become ``-``; a digest follows
    where letters of other scripts were lost, so that their names stay different.

    Raises
    ------
    InputError
        If the name is too long, cannot be printed, or holds no letter or digit.
    """
    if len(name) > LONGEST_NAME or not name.isprintable() or not any(c.isalnum() for c in name):
        raise InputError(
            f"expected a name with a letter or digit and of at most {LONGEST_NAME} characters, "
            f"found {name[:LONGEST_NAME]!r}."
        )
    plain = "".join(c if c.isascii() and (c.isalnum() or c in "-_.") else "-" for c in name)
    # neither hidden nor an option, and never a folder
    if plain[0] in ".-":
        plain = f"_{plain[1:]}"
    if name.isascii():
        return plain
    return f"{plain}-{hashlib.sha256(name.encode()).hexdigest()[:6]}"


def distinct_file_names(names: Iterable[str]) -> None:
    """Check that names can be made into files that stay apart, on systems that ignore case too.

    Raises
    ------
    InputError
        If a name is given twice, cannot be a file's, or two would share one.
    """
    found: dict[str, str] = {}
    for name in names:
        other = found.setdefault(file_name(name).casefold(), name)
        if other != name:
            raise InputError(f"{name} and {other} would share a file name; rename one.")


@contextmanager
def whole_file(path: str | os.PathLike[str]) -> Iterator[Path]:
    """Give a temporary path beside ``path`` that replaces it when the block ends without error."""
    target = Path(path)
    target.parent.mkdir(parents=True, exist_ok=True)
    handle, name = tempfile.mkstemp(dir=target.parent, prefix=f".{target.name}.", suffix=".part")
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
    """Write ``text`` as UTF-8 with Unix line ends, whole or not at all."""
    with whole_file(path) as part:
        part.write_bytes(text.encode("utf-8"))


def write_table(table: pd.DataFrame, *paths: str | os.PathLike[str]) -> None:
    """Write a table to each path, by its ending as ``.csv`` or ``.parquet``, without the index.

    Floats are written with their shortest exact text, so a CSV carries the same numbers as a Parquet
    file and two runs give the same bytes.
    """
    for path in paths:
        ending = Path(path).suffix
        with whole_file(path) as part:
            if ending == ".csv":
                table.to_csv(part, index=False, lineterminator="\n", encoding="utf-8")
            elif ending == ".parquet":
                table.to_parquet(part, index=False, engine="pyarrow")
            else:
                raise ValueError(f"{path}: a table is written as .csv or .parquet, not {ending!r}")
