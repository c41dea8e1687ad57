"""What the table did in each test: measured motions read and conditioned, and held against listed peaks."""

import os
import zipfile
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from rockfrag.errors import InputError
from rockfrag.files import is_file
from rockfrag.motions.filtering import highpass
from rockfrag.motions.intensity import pga, pgv
from rockfrag.motions.processing import process
from rockfrag.records.motion import Motion
from rockfrag.records.parsing.quantities import TO_SI, asked_unit
from rockfrag.records.read import read_motion
from rockfrag.units import GRAVITY

LARGEST_PEAK = 10 * GRAVITY
"""Largest acceleration that a shake table is believed to make [m/s²]; volts and counts look larger."""

KEY = "{motion}"
"""Stands for the test's motion in a pattern of file names."""

DRIFT_CORNER_HZ = 0.1
"""High-pass before a measured motion is integrated: its noise would drift."""

LARGEST_FACTOR = 1.5
"""Factor between the middle listed and measured peak beyond which they are not of one motion: of ours.  On a table
that followed its commands it is 1.00 in PGA and 1.12 in PGV (490 tests)."""

_CAUSES = {
    "pga_g": "check the unit of the motions (unit) and of the column",
    "pgv_cm_s": "check the time step of the motions (dt_s) and the unit of the column",
}


def table_motions(
    source: str | os.PathLike[str],
    names: Sequence[str],
    *,
    unit: str | None = None,
    dt: float | None = None,
    channel: str | None = None,
    conditioning: Sequence[Mapping[str, Any]] = (),
) -> list[Motion]:
    """Read and condition the measured motion of the table in each test, in the order of the tests [m/s²].

    ``source`` is an ``.npz`` archive with one array per motion, or a pattern of file names such as
    ``motions/Test{motion}.txt``; ``names`` are keys of the archive, or what to put for ``{motion}``. ``unit``,
    ``dt`` [s] and ``channel`` are for files that do not state them; ``conditioning`` has steps as in
    :func:`rockfrag.motions.process`.
    """
    found = []
    for motion in _read(str(source), list(names), unit, dt, channel):
        if motion.pga > LARGEST_PEAK:
            raise InputError(
                f"{source}: motion {motion.name} peaks at {motion.pga / GRAVITY:.3g} g, which no shake "
                "table reaches; it may be in volts or counts, or another column: check unit and channel."
            )
        found.append(process(motion, conditioning))
    return found


def missing_motions(source: str | os.PathLike[str], names: Sequence[str]) -> list[str]:
    """Return the names of which there is no motion."""
    if not _is_archive(str(source)):
        return [name for name in names if not is_file(Path(_path(str(source), name)))]
    with _archive(str(source)) as content:
        return [name for name in names if name not in content.files]


def _is_archive(source: str) -> bool:
    return source.endswith(".npz")


def _path(pattern: str, name: str) -> str:
    if KEY not in pattern:
        raise InputError(
            f"{pattern}: expected an .npz archive, or file names with {KEY} where the test's motion is named."
        )
    return pattern.replace(KEY, name)


def _archive(source: str) -> Any:
    if not is_file(Path(source)):
        raise InputError(f"{source}: there is no such file; correct the path.")
    try:
        # looked at first: numpy leaves a file open that turns out to be no archive
        zipfile.ZipFile(source).close()
        # arrays only: an archive with Python objects could run code
        return np.load(source, allow_pickle=False)
    except (OSError, ValueError, EOFError, zipfile.BadZipFile) as error:
        raise InputError(f"{source}: cannot be read as an .npz archive ({error}).") from error


def _read(
    source: str, names: list[str], unit: str | None, dt: float | None, channel: str | None
) -> Iterator[Motion]:
    absent = missing_motions(source, names)
    if absent:
        raise InputError(
            f"{source}: has no motion for {len(absent)} of {len(names)} tests, {', '.join(absent[:3])} first; "
            "add them, or set without_motion: leave_out."
        )
    if not _is_archive(source):
        for name in names:
            motion = read_motion(_path(source, name), unit, channel, dt)
            yield Motion(motion.acceleration, motion.dt, name, motion.metadata, motion.provenance)
        return
    if unit is None or dt is None:
        raise InputError(
            f"{source}: an .npz archive states neither unit nor interval; give unit and dt."
        )
    factor = TO_SI[asked_unit(unit)]
    with _archive(source) as content:
        for name in names:
            try:
                values = np.asarray(content[name], dtype=np.float64)
            except (ValueError, OSError, EOFError, zipfile.BadZipFile) as error:
                raise InputError(f"{source}: motion {name} cannot be read ({error}).") from error
            yield Motion(
                values * factor,
                dt,
                name,
                provenance=({"step": "read", "file": Path(source).name, "unit": unit},),
            )


def measured_peaks(motions: Sequence[Motion]) -> pd.DataFrame:
    """Peak acceleration and velocity of motions, ``pga_g`` and ``pgv_cm_s``."""
    return pd.DataFrame(
        {
            "pga_g": [pga(motion) / GRAVITY for motion in motions],
            "pgv_cm_s": [100 * pgv(highpass(motion, DRIFT_CORNER_HZ)) for motion in motions],
        }
    )


def check_peaks(tests: pd.DataFrame, motions: Sequence[Motion], source: str) -> None:
    """Refuse motions whose peaks are not those that the tests list, if they do; say the factor between."""
    listed = tests.filter(items=list(_CAUSES))
    if "pgv_cm_s" not in listed and {"pga_g", "pgv_over_pga_s"} <= set(tests):
        listed = listed.assign(pgv_cm_s=100 * GRAVITY * tests["pga_g"] * tests["pgv_over_pga_s"])
    if listed.empty:
        return
    found = measured_peaks(motions)
    for name in map(str, listed):
        factor = float(np.median(found[name].to_numpy() / listed[name].to_numpy()))
        if not 1 / LARGEST_FACTOR <= factor <= LARGEST_FACTOR:
            raise InputError(
                f"{source}: the peaks of its motions are {factor:.3g} times the {name} that the tests list "
                f"(median of {len(tests)} tests); {_CAUSES[name]}."
            )
