"""Writing files so that they appear whole or not at all, and tables so that they are reproducible."""

import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pandas as pd


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
