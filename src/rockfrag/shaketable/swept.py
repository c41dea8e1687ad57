"""Outcomes of incremental dynamic analyses as matrices, motion by amplitude, read in little memory.

A file of an IDA curve has a row per motion and amplitude, motion after motion, each raised through the same
amplitudes. What statistics need of it is a byte a history.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq
from numpy.typing import NDArray

from rockfrag.errors import InputError
from rockfrag.outcomes.limit_states import OVERTURNS, limit_state_named
from rockfrag.system.system import System

# columns that are the same for all amplitudes of a motion
ABOUT = ("configuration", "object", "pedestal", "earthquake", "floor", "motion")


@dataclass(frozen=True)
class Swept:
    """Outcomes of some motions, each at the same amplitudes."""

    about: pd.DataFrame  # one row a motion: the columns ``ABOUT``
    amplitude_g: NDArray[np.float64]  # amplitudes [g], rising, shape (n,)
    # whether the limit state that was asked for was reached, shape (motions, n)
    overturned: NDArray[np.bool_]
    fallen: NDArray[np.intp]  # place in ``bodies`` of what overturned, shape (motions, n)
    bodies: Sequence[str]  # names of what overturned in any of them, empty for nothing

    def rows(self, columns: Sequence[str], step: int = 1) -> pd.DataFrame:
        """Return a row for each motion and every so many-th amplitude.

        Columns: those asked for of ``about``, ``amplitude_g`` and ``overturned``.
        """
        amplitude, overturned = self.amplitude_g[::step], self.overturned[:, ::step].ravel()
        motions = np.repeat(np.arange(len(self.about)), amplitude.size)
        rows = self.about[list(columns)].iloc[motions].reset_index(drop=True)
        return rows.assign(amplitude_g=np.tile(amplitude, len(self.about)), overturned=overturned)


def labels_of(system: System) -> dict[str, str]:
    """Return what tables of a study call a system: its configuration, its object, with or without a pedestal."""
    side = "P" if system.count > 1 else "NP"
    return {"configuration": system.name, "object": system.names[-1], "pedestal": side}


def fallen_names(system: System) -> tuple[str, ...]:
    """Return what tables of a study call the body that fell, by its number in outcomes."""
    return ("", *(system.names if system.count > 2 else ("pedestal", "statue")[-system.count :]))


def read_swept(paths: Iterable[Path], *, state: str = OVERTURNS) -> Iterator[Swept]:
    """Yield the outcomes of IDA curves in a limit state, some motions at a time, so that memory holds one part."""
    reached = limit_state_named(state).column
    columns = [*ABOUT, "amplitude_g", reached, "overturned_body"]
    texts = [*ABOUT, "overturned_body"]
    for path in paths:
        with pq.ParquetFile(path, read_dictionary=texts) as file:
            for group in range(file.num_row_groups):
                yield _swept(file.read_row_group(group, columns=columns), reached, path)


def _swept(part: pa.Table, reached: str, path: Path) -> Swept:
    """Turn rows of a motion and an amplitude each into tables of motions by amplitudes; messages name ``path``."""
    amplitude = part["amplitude_g"].to_numpy()
    motion = part["motion"].combine_chunks()
    code = motion.indices.to_numpy()
    ends = np.flatnonzero(np.diff(code)) + 1
    each = int(ends[0]) if ends.size else code.size
    if code.size % each or not np.array_equal(ends, np.arange(each, code.size, each)):
        raise InputError(f"{path}: its motions have not equally many amplitudes; make it anew.")
    grid = amplitude.reshape(-1, each)
    if not (grid == grid[0]).all() or (np.diff(grid[0]) <= 0).any():
        raise InputError(f"{path}: its motions have not the same rising amplitudes; make it anew.")
    first = part.select(list(ABOUT)).take(pa.array(np.arange(0, code.size, each)))
    about = pd.DataFrame({name: first[name].to_pylist() for name in ABOUT}, dtype="str")
    body = part["overturned_body"].combine_chunks()
    fallen = body.indices.to_numpy().reshape(-1, each)
    found = part[reached].to_numpy().reshape(-1, each)
    return Swept(about, grid[0].copy(), found, fallen, body.dictionary.to_pylist())


def swept_of(ida: pd.DataFrame) -> Iterator[Swept]:
    """Yield the IDA curve of each configuration and motion, in the order in which they first appear."""
    number, bodies = pd.factorize(ida["overturned_body"])
    overturned = ida["overturned"].to_numpy(dtype=bool)
    amplitude = ida["amplitude_g"].to_numpy(dtype=np.float64)
    for rows in ida.groupby(["configuration", "motion"], sort=False).indices.values():
        ordered = rows[np.argsort(amplitude[rows], kind="stable")]
        head = ida[list(ABOUT)].iloc[rows[:1]].reset_index(drop=True)
        yield Swept(
            head, amplitude[ordered], overturned[None, ordered], number[None, ordered], list(bodies)
        )
