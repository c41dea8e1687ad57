"""PEER's ``_SearchResults.csv``: what a download of its database says of the records in it.

The file is a report in sections; the one used begins with ``-- Summary of Metadata of Selected
Records --`` and a line of titles, a row a record, and ends with an empty line.
"""

import csv
import math
import os
import re
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from rockfrag.errors import InputError

FILE_NAME = "_SearchResults.csv"  # name of the file in every download
_SECTION = re.compile(r"Summary of Metadata of Selected Records", re.I)
_TITLES = {
    "record sequence number": "number",
    "scale factor": "scale_factor",
    "earthquake name": "earthquake",
    "year": "year",
    "station name": "station",
    "magnitude": "magnitude",
    "rjb": "rjb",
    "rrup": "rrup",
    "horizontal-1 acc. filename": "first",
    "horizontal-2 acc. filename": "second",
    "vertical acc. filename": "vertical",
}
_NEEDED = ("number", "earthquake", "first")


@dataclass(frozen=True)
class PeerRecord:
    """One record of a download; files are empty where the download has none, numbers None."""

    number: str  # record sequence number, such as ``753``
    # earthquake, year, station: as the database names them
    earthquake: str
    year: str
    station: str
    magnitude: float | None  # moment magnitude
    # closest distance to the rupture [km], else the Joyner-Boore distance
    distance_km: float | None
    scale_factor: float | None  # factor of the search's target spectrum
    # first, second, vertical: names of the acceleration files
    first: str
    second: str
    vertical: str


def read_search_results(path: str | os.PathLike[str]) -> list[PeerRecord]:
    """Read the records that a ``_SearchResults.csv`` lists."""
    try:
        lines = Path(path).read_text(encoding="utf-8-sig", errors="replace").splitlines()
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror}).") from None
    start = next((i for i, line in enumerate(lines) if _SECTION.search(line)), None)
    if start is None:
        raise InputError(f"{path}: no section 'Summary of Metadata of Selected Records'.")
    titles: list[str] = []
    records: list[PeerRecord] = []
    for number, line in enumerate(lines[start + 1 :], start=start + 2):
        if not line.strip(" ,"):
            if titles:
                break
            continue
        try:
            cells = [cell.strip() for cell in next(csv.reader([line]))]
        except csv.Error as error:
            raise InputError(f"{path}, line {number}: not a row of a table ({error}).") from None
        if not titles:
            titles = [_TITLES.get(re.sub(r"\s*\(.*?\)", "", cell).lower(), "") for cell in cells]
            missing = [title for title in _NEEDED if title not in titles]
            if missing:
                raise InputError(f"{path}, line {number}: no column of the record's {missing[0]}.")
            continue
        records.append(_record(dict(zip(titles, cells, strict=False)), f"{path}, line {number}"))
    if not records:
        raise InputError(f"{path}: the section of records has no row; the file is cut short.")
    return records


def _record(cells: dict[str, str], where: str) -> PeerRecord:
    files = {key: cells.get(key, "") for key in ("first", "second", "vertical")}
    files = {key: "" if set(name) <= {"-", " "} else name for key, name in files.items()}
    if not cells.get("number", "").isdigit() or not files["first"]:
        raise InputError(f"{where}: no record sequence number, or no file of the first component.")
    return PeerRecord(
        number=cells["number"],
        earthquake=cells.get("earthquake", "").strip('"'),
        year=cells.get("year", ""),
        station=cells.get("station", "").strip('"'),
        magnitude=_number(cells.get("magnitude", "")),
        distance_km=_number(cells.get("rrup", "")) or _number(cells.get("rjb", "")),
        scale_factor=_number(cells.get("scale_factor", "")),
        **files,
    )


def _number(words: str) -> float | None:
    value = math.nan
    with suppress(ValueError):
        value = float(words)
    return value if 0 < value < 1e6 else None
