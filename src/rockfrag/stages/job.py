"""A job: one rule of the workflow at work on one study.

In: a study, paths that the rule declares. Out: tables and motions read and written whole. Docs:
``docs/reliability.md``.
"""

import hashlib
import logging
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, Generic, TypeVar

import pandas as pd

from rockfrag.base.files import is_file, sha256_of, write_table

if TYPE_CHECKING:
    from rockfrag.records.motion import Motion

S = TypeVar("S")

Results = Iterator[tuple[str, "pd.DataFrame | list[Motion]"]]
"""What a stage yields: each of its results by name, as soon as it is there."""

# Memory of a process that has loaded and compiled all that a stage uses [MiB]
_LIBRARIES_MB = 1500

_BYTES_A_IDA = 20_000
"""Memory for what statistics know of a configuration under a motion, whatever the number of amplitudes."""


@dataclass(frozen=True)
class Job(Generic[S]):
    """One rule of the workflow at work on one study: what it may read, and where it writes.

    Results are named by their path in the study's folder without an ending: ``tests`` is a table
    (``tests.csv`` and ``tests.parquet``), ``motions/ground`` a set of motions (``motions/ground.parquet``).
    """

    study: S  # The study
    folder: Path  # Folder of the study's results
    threads: int  # Threads to use; no result depends on their number
    log: logging.Logger  # Log of the job; its last line says what was found
    # Number of the part of the motions that the job is for, where parts have jobs of their own
    part: int = 0
    # Paths that its rule declares, as the rule writes them; None where there is no rule
    inputs: frozenset[Path] | None = None
    outputs: frozenset[Path] | None = None

    def table(self, name: str) -> pd.DataFrame:
        """Read a table of another stage by its name."""
        return pd.read_parquet(self.file(f"{name}.parquet"))

    def motions(self, name: str, part: tuple[int, int] = (0, 1)) -> "list[Motion]":
        """Read a set of motions of another stage, such as ``motions/ground``, or part k of n of it."""
        from rockfrag.records.motion import read_motion_set

        return read_motion_set(self.file(f"{name}.parquet"), part)

    def file(self, path: str) -> Path:
        """Return the whole path of another stage's file, which the rule must declare as an input.

        Otherwise Snakemake would not know when to compute it again: a ValueError.
        """
        whole = self.folder / path
        if self.inputs is not None and whole not in self.inputs:
            raise ValueError(
                f"{path} is read, but its rule does not declare it as an input"
            )
        return whole

    def write(self, name: str, result: "pd.DataFrame | list[Motion]") -> None:
        """Write a result that the rule declares: a table as CSV and as Parquet, motions as Parquet."""
        paths = [self.folder / f"{name}.parquet"]
        if isinstance(result, pd.DataFrame):
            paths.insert(0, self.folder / f"{name}.csv")
        if self.outputs is not None and not self.outputs.issuperset(paths):
            raise ValueError(
                f"{name} is written, but its rule does not declare it as an output"
            )
        if isinstance(result, pd.DataFrame):
            write_table(result, *paths)
        else:
            from rockfrag.records.motion import write_motion_set

            write_motion_set(result, *paths)


def memory_mb(study: Any) -> int:
    """Memory that a cluster should lend to a job [MiB]: libraries, and what is known of every IDA curve."""
    return _LIBRARIES_MB + int(getattr(study, "ida_curves", 0) * _BYTES_A_IDA / 2**20)


PACKAGE = Path(__file__).resolve().parents[1]


@cache
def package_digest(*plugins: Path) -> str:
    """Digest of source and data of the whole package and of plugins: an edit computes again.

    Parameters
    ----------
    plugins : folders of plugins

    Returns
    -------
    16 hexadecimal digits.
    """
    digest = hashlib.sha256()
    for folder in (PACKAGE, *plugins):
        for path in sorted(folder.rglob("*")):
            # what Python and numba keep there of a run is no source
            if path.is_file() and path.parent.name != "__pycache__":
                digest.update(path.relative_to(folder).as_posix().encode())
                digest.update(b"\0")
                digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


def files_digest(paths: Iterable[str | Path | None]) -> str:
    """Digest of the bytes of a user's files, in their order, whatever their times; empty if no path is given.

    Snakemake looks at times, which a copy, an archive, a backup or a clock set anew may bring from anywhere.
    """
    files = [Path(path) for path in paths if path]
    if not files:
        return ""
    each = (sha256_of(file) if is_file(file) else "absent" for file in files)
    return hashlib.sha256(" ".join(each).encode()).hexdigest()[:16]
