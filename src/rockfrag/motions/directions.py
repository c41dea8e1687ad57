"""The motion that a row of a catalogue asks for: one component, or a direction of two.

In: a checked row. Out: its motion [m/s²], and behind it the vertical one. Theory: ``docs/motions.md``,
"Processing by named steps".
"""

import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import pandas as pd

from rockfrag.base.errors import InputError
from rockfrag.motions.processing import process
from rockfrag.motions.rotation import common_time, rotate_to_azimuth, stronger_direction
from rockfrag.records.catalogue import load_component, load_motion, scaled
from rockfrag.records.motion import Motion

_DIRECTION = re.compile(
    r"^(?:(?P<kind>fault-normal|fault-parallel|radial|transverse)\s+)?(?P<angle>-?\d+(?:\.\d*)?)$"
)
_TURNS = {"fault-normal": 90, "fault-parallel": 0, "radial": 180, "transverse": -90}
"""Azimuths [degrees] from the strike, or from the direction of the source."""


def motions_of_row(
    row: dict[str, Any], folder: Path, records: Path, vertical: bool = False
) -> list[Motion]:
    """Read the motion of one row of a catalogue in ``folder``, and behind it the vertical one if that is wanted.

    The column ``direction`` may have an azimuth (``45``), ``fault-normal`` or ``fault-parallel`` with
    the strike, ``radial`` or ``transverse`` with the azimuth from the station to the source, or
    ``stronger``: the direction of the largest acceleration. Where it is empty the motion is the
    component of ``file`` itself. A motion and its vertical one are over the time that they have in common.

    Parameters
    ----------
    row, folder, records : row of a catalogue, its folder, and that of fetched records
    vertical : whether the vertical component is wanted

    Returns
    -------
    The motion, and behind it the vertical one [m/s²].
    """
    if vertical and not row.get("vertical"):
        raise InputError(
            f"{row['name']}: the catalogue names no vertical component of it."
        )
    direction = str(row.get("direction") or "")
    wanted = {"vertical": vertical, "second": bool(direction)}
    others = (
        load_component(row, row[key], folder, records) for key in wanted if wanted[key]
    )
    motions = [
        load_motion(row, folder, records),
        *(scaled(other, row) for other in others),
    ]
    if vertical:
        motions = common_time(motions, verticals=(1,))
    if direction:
        second = motions.pop()
        motions[0] = turned(motions[0], second, direction)
    return [replace(motion, name=row["name"]) for motion in motions]


def turned(first: Motion, second: Motion, direction: str) -> Motion:
    """Return two components in a direction of a catalogue; see :func:`motions_of_row`."""
    if direction == "stronger":
        return stronger_direction(first, second)
    match = _DIRECTION.match(direction)
    if match is None:
        raise InputError(
            f"direction {direction!r} is none of an azimuth, 'fault-normal STRIKE', 'fault-parallel "
            "STRIKE', 'radial BACK-AZIMUTH', 'transverse BACK-AZIMUTH' and 'stronger'."
        )
    turn = _TURNS[match["kind"]] if match["kind"] else 0
    return rotate_to_azimuth(first, second, float(match["angle"]) + turn)


def pair_of_row(
    row: dict[str, Any], folder: Path, records: Path
) -> tuple[Motion, Motion]:
    """Read both horizontal components that a row names, with its factor, at common times.

    Parameters
    ----------
    row, folder, records : row of a catalogue, its folder, and that of fetched records

    Returns
    -------
    Both components [m/s²].
    """
    if not row.get("second"):
        raise InputError(
            f"{row['name']}: the catalogue names no second component of it."
        )
    files = row["file"], row["second"]
    motions = [load_component(row, file, folder, records) for file in files]
    first, second = common_time(motions, verticals=())
    return scaled(first, row), scaled(second, row)


def measure_records(
    rows: Sequence[dict[str, Any]],
    folder: Path,
    records: Path,
    processing: Sequence[Mapping[str, Any]],
) -> pd.DataFrame:
    """Measure the records of which both horizontal components are known, whatever their directions.

    Both are processed first. The columns are ``name`` of the row, then those of
    :func:`rockfrag.motions.measure_pair`; there is none where no row names a second component.

    Parameters
    ----------
    rows, folder, records : rows of a catalogue, its folder, and that of fetched records
    processing : steps, as of :func:`rockfrag.motions.processing.process`

    Returns
    -------
    pandas.DataFrame, a row a record.
    """
    # the measures are compiled, which the checks of a study need not wait for
    from rockfrag.motions.measures import measure_pair

    known: dict[frozenset[str], dict[str, float]] = {}
    table: list[dict[str, Any]] = []
    for row in rows:
        if not row.get("second"):
            continue
        pair = frozenset((row["file"], row["second"]))
        if pair not in known:
            first, second = pair_of_row(row, folder, records)
            known[pair] = measure_pair(
                process(first, processing), process(second, processing)
            )
        table.append({"name": row["name"], **known[pair]})
    return pd.DataFrame(table)
