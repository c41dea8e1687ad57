"""A catalogue from what there is: a folder, an archive or a download of PEER's database."""

import csv
import math
import os
import re
from collections.abc import Iterable, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from hashlib import sha256
from pathlib import Path, PurePosixPath
from typing import Any

import pandas as pd

from rockfrag.errors import InputError
from rockfrag.records.catalogue import COLUMNS, is_catalogue
from rockfrag.records.parsing.quantities import azimuth_of, is_vertical
from rockfrag.records.parsing.text_file import NotAcceleration
from rockfrag.records.quality_flags import quality_flags
from rockfrag.records.read import Record, motion_of, read_record
from rockfrag.records.sources.archive import files_of, is_archive, unpacked
from rockfrag.tabular import printable

_PERPENDICULAR = 5.0  # degrees by which two components may be off a right angle and still be a pair

_SUFFIXES = tuple(
    re.compile(pattern, re.I)
    for pattern in (
        # the number of a station of an array may stand before the azimuth: H-E10050
        r"^(?P<stem>.*[A-Z_.\- ]\d{0,2}?)(?P<name>[0-3]\d\d)(?P<rest>)$",
        r"^(?P<stem>.+?)[-_. ]?(?P<name>E-?W|W-?E|N-?S|S-?N|U-?D|[BEH][NLGH][ENZ123]|UP|DWN|DOWN|DN|VERT?|VRT"
        r"|FN|FP|LN|TR|LONG|TRAN)"
        r"(?P<rest>\d?)$",
        r"^(?P<stem>.+)[-_. ](?P<name>[NEZUVHXYLT])(?P<rest>)$",
        r"^(?P<stem>.+)(?P<name>[123])(?P<rest>)$",
    )
)
"""How names of files end that name the component: ``CLS000``, ``E10050``, ``ISE-WE``, ``_N``, ``120111``."""

_AMERICAN_DATE = re.compile(r"\b(?P<m>\d{1,2})/(?P<d>\d{1,2})/(?P<y>\d{4}|\d{2})\b")
_ISO_DATE = re.compile(r"\b(\d{4})[-/](\d{2})[-/](\d{2})(?!\d)")


SEARCH_RESULTS = "_SearchResults.csv"  # name of PEER's file in every download
_SECTION = re.compile(r"Summary of Metadata of Selected Records", re.I)
_PEER_TITLES = {
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
_PEER_NEEDED = ("number", "earthquake", "first")


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
    """Read the records that PEER's ``_SearchResults.csv`` lists: what a download of its database says of them.

    The file is a report in sections; the one used begins with ``-- Summary of Metadata of Selected Records --``
    and a line of titles, a row a record, and ends with an empty line.
    """
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
            titles = [
                _PEER_TITLES.get(re.sub(r"\s*\(.*?\)", "", cell).lower(), "") for cell in cells
            ]
            missing = [title for title in _PEER_NEEDED if title not in titles]
            if missing:
                raise InputError(f"{path}, line {number}: no column of the record's {missing[0]}.")
            continue
        records.append(
            _peer_record(dict(zip(titles, cells, strict=False)), f"{path}, line {number}")
        )
    if not records:
        raise InputError(f"{path}: the section of records has no row; the file is cut short.")
    return records


def _peer_record(cells: dict[str, str], where: str) -> PeerRecord:
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


@dataclass(frozen=True)
class Component:
    """One component found: where it is, what its file says, and what is doubtful in it."""

    file: str
    name: str
    stem: str  # name of the file without what names the component
    suffix: str  # component that ends the name of its file, as in ``A-TMZ000``; empty if none does
    path: str
    facts: dict[str, Any]
    npts: int
    dt: float
    sha256: str
    several: bool
    unit: str
    dt_given: float | None
    container: str
    digest: str
    quality_flags: tuple[str, ...]

    @property
    def azimuth(self) -> float | None:
        """Azimuth [degrees], None where it is not known."""
        stated = self.facts.get("azimuth_deg")
        return float(stated) if stated is not None else azimuth_of(self.orientation)

    @property
    def orientation(self) -> str:
        """Name of the component, by its file where the header does not say."""
        named = str(self.facts.get("component") or "")
        return named or ("" if self.suffix in {"1", "2", "3"} else self.suffix)

    @property
    def is_vertical(self) -> bool:
        """Whether it is named as a vertical one."""
        return is_vertical(self.orientation)

    @property
    def shared_by_a_record(self) -> tuple[tuple[object, ...] | None, ...]:
        """What the components of one record share: file, name, or station and time; None where it has none."""
        time = self.facts.get("network"), self.facts.get("station"), self.facts.get("start_time")
        folder = str(Path(self.path).parent)
        return (
            (self.container, self.path, self.sha256) if self.several else None,
            (self.container, folder, self.stem) if self.suffix else None,
            time if all(time[1:]) else None,
        )


@dataclass
class CatalogueDraft:
    """A catalogue made: its table, and what a person should look at: files and what looks wrong in each."""

    unit: str | None  # of files that do not state theirs
    dt: float | None  # sampling interval [s] of files without one
    folder: Path  # files are named from here
    table: pd.DataFrame = field(default_factory=pd.DataFrame)
    notes: list[tuple[str, str]] = field(default_factory=list)
    errors: list[str] = field(default_factory=list)

    @property
    def warnings(self) -> list[str]:
        """What looks wrong, a line each."""
        return [f"{file}: {what}" for file, what in self.notes]

    def summary(self, shown: int = 3) -> list[str]:
        """Return the warnings, those of one kind as one line with an example where they are many."""
        kinds: dict[str, list[tuple[str, str]]] = {}
        for file, what in self.notes:
            # the same for all files in which the same looks wrong: without numbers and names
            kind = re.sub(r"\d[\d.]*|'[^']*'|\S+\.\w+(?:#\S*)?", "…", what)
            kinds.setdefault(kind, []).append((file, what))
        lines: list[str] = []
        for kind, notes in kinds.items():
            if len(notes) <= shown:
                lines += [f"{file}: {what}" for file, what in notes]
            else:
                lines.append(f"{len(notes)} times: {kind}; the first is {notes[0][0]}")
        return lines

    def note(self, file: str, what: str) -> None:
        """Note what looks wrong in a file."""
        self.notes.append((file, what))

    def look_through(self, path: Path) -> tuple[list[Component], list[PeerRecord]]:
        """Return the components below a path and what PEER says of them."""
        inside = path.is_dir()
        files = [file for file in files_of(path) if not is_catalogue(file)] if inside else [path]
        components = [component for file in files for component in self._components(file)]
        listed: list[PeerRecord] = []
        try:
            if inside:
                for file in sorted(path.rglob(SEARCH_RESULTS)):
                    listed += read_search_results(file)
            elif path.name == SEARCH_RESULTS:
                raise InputError(
                    f"{path}: give the folder that this file lies in, with its records."
                )
            for file in filter(is_archive, files):
                with unpacked(file) as members:
                    for member in members:
                        if PurePosixPath(member.name).name == SEARCH_RESULTS:
                            listed += read_search_results(member.path)
        except InputError as error:
            self.errors.append(str(error))
        return components, listed

    def _components(self, file: Path) -> list[Component]:
        """Read every component of a file; what is wrong with it goes into the errors."""
        try:
            record, dt_given = _read(file, self.dt)
        except NotAcceleration:
            return []
        except InputError as error:
            self.errors.append(str(error))
            return []
        self.errors += [str(e) for _, e in record.left_out if not isinstance(e, NotAcceleration)]
        relative = Path(os.path.relpath(file, self.folder)).as_posix()
        if not relative.isprintable():
            self.errors.append(
                f"{printable(relative)}: its name has characters that no table shows; rename the file"
            )
            return []
        found = []
        for number, channel in enumerate(record.channels, start=1):
            own = [c for c in record.channels if c.member == channel.member]
            label = channel.code or channel.component
            unique = label and [c.code or c.component for c in own].count(label) == 1
            chosen = (label if unique else str(number)) if len(own) > 1 else ""
            unit = None if channel.unit else self.unit
            try:
                motion = motion_of(record, channel, unit)
            except InputError as error:
                self.errors.append(str(error))
                continue
            samples = motion.acceleration.tobytes() + repr(motion.dt).encode()
            name = _stem(PurePosixPath(channel.member or file.name).name)
            stem, suffix = _parts(name) if len(own) == 1 else (name, "")
            component = Component(
                file="#".join(filter(None, (relative, channel.member, chosen))),
                name=name,
                stem=stem,
                suffix=suffix,
                path=channel.member or str(file),
                facts=dict(motion.metadata),
                npts=channel.npts,
                dt=channel.dt,
                sha256=record.sha256,
                several=len(own) > 1,
                unit=unit or "",
                dt_given=dt_given,
                container=str(file) if channel.member else "",
                digest=sha256(samples).hexdigest(),
                quality_flags=tuple(quality_flags(motion)),
            )
            found.append(component)
        return found

    def peer_rows(
        self, listed: PeerRecord, found: Sequence[Component], used: set[str]
    ) -> list[dict[str, Any]]:
        """Return the rows of one record of a download."""

        def component(name: str) -> Component | None:
            """Find the component of a file; names may have the folder of PEER's disk before them."""
            own = PurePosixPath(name.replace("\\", "/")).name.lower()
            named = (c for c in found if Path(c.path).name.lower() == own)
            return next(named, None) if own else None

        horizontal = [component(listed.first), component(listed.second)]
        vertical = component(listed.vertical)
        for name, side in zip((listed.first, listed.second), horizontal, strict=True):
            if name and side is None:
                self.note(f"RSN{listed.number}", f"{name} is listed but not among the files")
        facts = {
            "earthquake": f"{listed.earthquake} {listed.year}".strip(),
            "date": listed.year if re.fullmatch(r"\d{4}", listed.year) else "",
            "station": listed.station,
            "magnitude": listed.magnitude,
            "distance_km": listed.distance_km,
            "scale_factor": listed.scale_factor if listed.scale_factor != 1 else None,
        }
        known = {key: value for key, value in facts.items() if value not in ("", None)}
        there = [component for component in horizontal if component is not None]
        used.update(component.file for component in (*there, *([vertical] if vertical else [])))
        return [self._row(component, there, vertical) | known for component in there]

    def rows_of(self, group: Sequence[Component]) -> list[dict[str, Any]]:
        """Return the rows of the components of one record."""
        flat = _horizontal(group)
        upright = next((component for component in group if component.is_vertical), None)
        if not flat and upright is not None:
            self.note(upright.file, "a vertical component of no record here; left out")
        if len(flat) == 1:
            self.note(flat[0].file, "its other horizontal component was not found")
        return [self._row(component, flat, upright) for component in flat]

    def _row(
        self, component: Component, pair: Sequence[Component], vertical: Component | None
    ) -> dict[str, Any]:
        """Return the row of one component of a pair, and note what looks wrong in it."""
        other = next((other for other in pair if other is not component), None)
        file, facts = component.file, component.facts
        self.notes += [(file, quality_flag) for quality_flag in component.quality_flags]
        npts = component.npts
        if other and file < other.file and abs(npts - other.npts) > 0.1 * npts:
            unlike = f"{npts} samples, but {other.npts} in {other.file} of the same record"
            self.note(file, unlike)
        earthquake = str(facts.get("earthquake") or "")
        if not earthquake:
            earthquake = component.stem
            column = f"the column earthquake has {earthquake!r}"
            self.note(file, f"its earthquake is not stated; {column}")
        channel = facts.get("channel", "") if component.several else ""
        return {
            "name": f"{component.name} {channel}".strip() if component.several else component.name,
            "earthquake": earthquake,
            "date": _date(facts),
            "station": facts.get("station", ""),
            "component": component.orientation,
            "magnitude": facts.get("magnitude"),
            "distance_km": facts.get("distance_km"),
            "source": "folder",
            "file": file,
            "second": other.file if other else "",
            "vertical": vertical.file if vertical else "",
            "sha256": component.sha256,
            "unit": component.unit,
            "dt": component.dt_given,
        }

    def without_copies(
        self, groups: Sequence[list[Component]], seen: dict[str, str]
    ) -> list[list[Component]]:
        """Leave out records that are there already, as in an archive and beside it.

        Of two the one with both horizontals is kept, of those the file and not the member of an archive.
        """

        def worth(number: int) -> tuple[int, bool, int]:
            group = groups[number]
            return -len(_horizontal(group)), any(component.container for component in group), number

        kept = []
        for number in sorted(range(len(groups)), key=worth):
            told = _horizontal(groups[number]) or groups[number]
            if all(component.digest in seen for component in told):
                for first in groups[number]:
                    other = seen.get(first.digest, "") or told[0].file
                    self.note(first.file, f"the same record as {other}; left out")
                continue
            kept.append(number)
            for first in groups[number]:
                seen.setdefault(first.digest, first.file)
        return [groups[number] for number in sorted(kept)]

    def note_names_of_one_day(self, rows: Sequence[dict[str, Any]]) -> None:
        """Note days of which several earthquakes are named: they may be one under two names."""
        by_day: dict[str, dict[str, str]] = {}
        for row in rows:
            if len(row["date"]) == len("1976-05-06"):
                by_day.setdefault(row["date"], {}).setdefault(row["earthquake"], row["file"])
        for day, earthquakes in by_day.items():
            if len(earthquakes) > 1:
                first, other = list(earthquakes)[:2]
                self.note(
                    earthquakes[other],
                    f"its earthquake is {other!r}, that of {earthquakes[first]} on the same day ({day}) "
                    f"{first!r}; if they are one, give it one name in the column earthquake",
                )


def make_catalogue(
    paths: Iterable[str | os.PathLike[str]],
    unit: str | None = None,
    dt: float | None = None,
    folder: str | os.PathLike[str] = ".",
) -> CatalogueDraft:
    """Make a catalogue of the horizontal components in folders, archives and files.

    Components of one record are found by PEER's ``_SearchResults.csv`` where there is one, by being in one
    file, by station and time, and by names that differ in the component alone. Each horizontal
    component becomes a row that names the other one as ``second`` and the vertical one.
    """
    draft = CatalogueDraft(unit, dt, Path(folder))
    paths = list(paths)
    rows: list[dict[str, Any]] = []
    groups: list[list[Component]] = []
    seen: dict[str, str] = {}
    for path in map(Path, paths):
        found, listed = draft.look_through(path)
        used: set[str] = set()
        for record in listed:
            rows += draft.peer_rows(record, found, used)
        seen |= {component.digest: component.file for component in found if component.file in used}
        groups += _records_of([component for component in found if component.file not in used])
    for group in draft.without_copies(groups, seen):
        rows += draft.rows_of(group)
    if not rows:
        more = f": {draft.errors[0]}" if draft.errors else "."
        where = ", ".join(map(str, paths))
        raise InputError(f"{where}: no horizontal component of acceleration was found{more}")
    _name_uniquely(rows)
    draft.note_names_of_one_day(rows)
    draft.table = pd.DataFrame(rows, columns=list(COLUMNS)).fillna("")
    return draft


def _horizontal(group: Sequence[Component]) -> list[Component]:
    return [component for component in group if not component.is_vertical]


def _read(file: Path, dt: float | None) -> tuple[Record, float | None]:
    """Read a file, with the user's interval where it does not state its own."""
    try:
        return read_record(file), None
    except InputError as error:
        if dt is None or isinstance(error, NotAcceleration):
            raise
    return read_record(file, dt), dt


def _stem(name: str) -> str:
    """Return the name of a file without its ending; K-NET's endings name the component."""
    plain = name.removesuffix(".gz")
    if re.search(r"\.(?:EW|NS|UD)\d?$", plain):
        return plain
    return plain.rsplit(".", 1)[0] or plain


def _parts(name: str) -> tuple[str, str]:
    """Return the name of a file without the component that ends it, and that component."""
    found = next(filter(None, (pattern.match(name) for pattern in _SUFFIXES)), None)
    return (found["stem"] + found["rest"], found["name"]) if found else (name, "")


def _records_of(components: Sequence[Component]) -> list[list[Component]]:
    """Group components of one record: in one file, of like names, of one station and time."""
    groups: list[list[Component]] = []
    left = list(components)
    for way in range(3):
        by_key: dict[object, list[Component]] = {}
        for component in left:
            key = component.shared_by_a_record[way]
            if key is not None:
                by_key.setdefault(key, []).append(component)
        for several in by_key.values():
            # of copies the first
            unlike = {component.digest: component for component in reversed(several)}
            group = list(unlike.values())[::-1]
            if _is_record(group):
                groups.append(group)
                left = [component for component in left if component not in group]
    groups += [[component] for component in left]
    order = {component.file: number for number, component in enumerate(components)}
    return sorted(groups, key=lambda group: order[group[0].file])


def _is_record(group: Sequence[Component]) -> bool:
    """Tell whether components are two horizontals at a right angle and at most one vertical."""
    flat = _horizontal(group)
    if len(flat) == 3 and sorted(component.suffix for component in flat) == ["1", "2", "3"]:
        return False
    if len(flat) != 2 or len(group) > 3 or abs(flat[0].dt - flat[1].dt) > 1e-9:
        return False
    first, second = flat[0].azimuth, flat[1].azimuth
    if first is None or second is None or {flat[0].suffix, flat[1].suffix} == {"1", "2"}:
        return True
    apart = abs((first - second + 90) % 180 - 90)
    return abs(apart - 90) <= _PERPENDICULAR


def _date(facts: dict[str, Any]) -> str:
    """Return the day of the start of the record, else of the earthquake, else nothing."""
    for words in (str(facts.get("start_time") or ""), str(facts.get("earthquake") or "")):
        iso = _ISO_DATE.search(words)
        if iso:
            return "-".join(iso.groups())
        american = _AMERICAN_DATE.search(words)
        if american:
            year = american["y"] if len(american["y"]) == 4 else f"19{american['y']}"
            return f"{year}-{int(american['m']):02d}-{int(american['d']):02d}"
    return ""


def _name_uniquely(rows: list[dict[str, Any]]) -> None:
    """Give each row a name of its own, with safe characters."""
    seen: set[str] = set()
    for row in rows:
        base = re.sub(r"[^\w .+-]", "_", str(row["name"])).strip(" .")[:80] or "record"
        name, number = base, 2
        while name in seen:
            name, number = f"{base} {number}", number + 1
        seen.add(name)
        row["name"] = name
