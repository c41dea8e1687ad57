"""What the table did in each test: measured motions read, and conditioned as the study says."""

import os
import zipfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from rockfrag.errors import InputError
from rockfrag.files import is_file
from rockfrag.motions.processing import process
from rockfrag.records.motion import Motion
from rockfrag.records.parsing.quantities import TO_SI, asked_unit
from rockfrag.records.read import read_motion
from rockfrag.units import GRAVITY

LARGEST_PEAK = 10 * GRAVITY
"""Largest acceleration that a shake table is believed to make [m/s²]; volts and counts look larger."""

KEY = "{motion}"
"""Stands for the test's motion in a pattern of file names."""


def table_motions(
    source: str | os.PathLike[str],
    names: Sequence[str],
    *,
    unit: str | None = None,
    dt: float | None = None,
    channel: str | None = None,
    conditioning: Sequence[Mapping[str, Any]] = (),
    done: Callable[[int], None] = lambda count: None,
) -> list[Motion]:
    """Read and condition the measured motion of the table in each test, in the order of the tests [m/s²].

    ``source`` is an ``.npz`` archive with one array per motion, or a pattern of file names such as
    ``motions/Test{motion}.txt``; ``names`` are keys of the archive, or what to put for ``{motion}``. ``unit``,
    ``dt`` [s] and ``channel`` are for files that do not state them; ``conditioning`` has steps as in
    :func:`rockfrag.motions.process`; ``done`` is called with the number of motions done after each.
    """
    found = []
    for count, motion in enumerate(_read(str(source), list(names), unit, dt, channel), start=1):
        if motion.pga > LARGEST_PEAK:
            raise InputError(
                f"{source}: motion {motion.name} peaks at {motion.pga / GRAVITY:.3g} g, which no shake "
                "table reaches; it may be in volts or counts, or another column: check unit and channel."
            )
        found.append(process(motion, conditioning))
        done(count)
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
