"""A catalogue from what there is: a folder, an archive or a download of PEER's database."""

import csv
import hashlib
import os
import re
from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import dropwhile, takewhile
from pathlib import Path, PurePosixPath
from typing import Any

import numpy as np
import pandas as pd

from rockfrag.base.errors import InputError
from rockfrag.base.text_files import printable
from rockfrag.records.catalogue import (
    COLUMNS,
    listed_problems,
    passed_over,
    record_files,
)
from rockfrag.records.component_names import NUMBERS, numbered_records, parts_of
from rockfrag.records.motion import Motion
from rockfrag.records.parsing.directions import azimuth_of, is_vertical
from rockfrag.records.parsing.format import Channel
from rockfrag.records.parsing.text_file import NotAcceleration
from rockfrag.records.quality_flags import quality_flags
from rockfrag.records.read import motion_of, read_untold
from rockfrag.records.sources.archive import is_archive, is_no_record, unpacked
from rockfrag.runtime.progress import Progress

# degrees by which two components may be off a right angle and still be a pair
_PERPENDICULAR = 5.0

_THIRD = re.compile(r"^(?:[A-Z]{2})?3")
_OF_KNET = re.compile(r"\.(?:EW|NS|UD)\d?$")
_AMERICAN_DATE = re.compile(r"\b(?P<m>\d{1,2})/(?P<d>\d{1,2})/(?P<y>\d{4}|\d{2})\b")
_ISO_DATE = re.compile(r"\b(\d{4})[-/](\d{2})[-/](\d{2})(?!\d)")


SEARCH_RESULTS = "_SearchResults.csv"  # name of PEER's file in every download
_SECTION = re.compile(r"Summary of Metadata of Selected Records", re.I)
_NUMBER, _EARTHQUAKE = "record sequence number", "earthquake name"
_FILES = tuple(
    f"{which} acc. filename" for which in ("horizontal-1", "horizontal-2", "vertical")
)


@dataclass(frozen=True)
class PeerRecord:
    """One record of a download: its number there, its files, and what columns of a catalogue hold of it."""

    number: str  # record sequence number, such as ``753``
    # acceleration files of both horizontal components and the vertical one, empty where there is none
    files: tuple[str, ...]
    # moment magnitude, distance closest to the rupture, else Joyner-Boore's
    facts: dict[str, Any]


def read_search_results(path: str | os.PathLike[str]) -> list[PeerRecord]:
    """Read the records that PEER's ``_SearchResults.csv`` lists: what a download of its database says of them.

    The file is a report in sections; the one used begins with ``-- Summary of Metadata of Selected Records --``
    and a line of titles, a row a record, and ends with an empty line.
    """
    try:
        lines = (
            Path(path).read_text(encoding="utf-8-sig", errors="replace").splitlines()
        )
    except OSError as error:
        raise InputError(f"{path}: cannot be read ({error.strerror}).") from None
    start = next(
        (i for i, line in enumerate(lines, start=1) if _SECTION.search(line)), None
    )
    if start is None:
        raise InputError(
            f"{path}: no section 'Summary of Metadata of Selected Records'."
        )
    titles: list[str] = []
    records: list[PeerRecord] = []
    below = dropwhile(_is_empty, enumerate(lines[start:], start=start + 1))
    for number, line in takewhile(lambda each: not _is_empty(each), below):
        where = f"{path}, line {number}"
        try:
            cells = [cell.strip() for cell in next(csv.reader([line]))]
        except csv.Error as error:
            raise InputError(f"{where}: not a row of a table ({error}).") from None
        if titles:
            records.append(_peer_record(dict(zip(titles, cells, strict=False)), where))
            continue
        titles = [re.sub(r"\s*\(.*?\)", "", cell).lower() for cell in cells]
        needed = {"number": _NUMBER, "earthquake": _EARTHQUAKE, "first": _FILES[0]}
        missing = [what for what, title in needed.items() if title not in titles]
        if missing:
            raise InputError(f"{where}: no column of the record's {missing[0]}.")
    if not records:
        raise InputError(
            f"{path}: the section of records has no row; the file is cut short."
        )
    return records


def _is_empty(numbered: tuple[int, str]) -> bool:
    return not numbered[1].strip(" ,")


def _peer_record(row: dict[str, str], where: str) -> PeerRecord:
    """A row of PEER's search results: the record's files and what is known of it."""
    cells = defaultdict(str, row)
    files = tuple("" if set(cells[key]) <= {"-", " "} else cells[key] for key in _FILES)
    if not cells[_NUMBER].isdigit() or not files[0]:
        raise InputError(
            f"{where}: no record sequence number, or no file of the first component."
        )
    name, year = cells[_EARTHQUAKE].strip('"'), cells["year"]
    factor = _number(cells["scale factor"])
    facts = {
        "earthquake": f"{name} {year}".strip(),
        "date": year if re.fullmatch(r"\d{4}", year) else "",
        "station": cells["station name"].strip('"'),
        "magnitude": _number(cells["magnitude"]),
        "distance_km": _number(cells["rrup"]) or _number(cells["rjb"]),
        "scale_factor": factor if factor != 1 else None,
    }
    known = {key: value for key, value in facts.items() if value not in ("", None)}
    return PeerRecord(cells[_NUMBER], files, known)


def _number(words: str) -> float | None:
    value = float(pd.to_numeric(words, errors="coerce"))
    return value if 0 < value < 1e6 else None


@dataclass(frozen=True)
class Component:
    """One component found: where it is, what its file says, and what is doubtful in it."""

    file: str  # file, member of an archive and channel, as a catalogue names them
    # its row of a catalogue, but for the other components of its record
    row: dict[str, Any]
    stem: str  # name of the file without what names the component
    # component that ends the name of its file, as in ``A-TMZ000``; empty if none does
    suffix: str
    path: str
    packed: bool
    plain_name: str  # of its file, without folder and ending
    npts: int
    dt: float
    digest: str
    quality_flags: tuple[str, ...]
    azimuth: float | None
    is_vertical: bool
    # what the components of one record share: file, earthquake and station, name, or station and time; None where
    # it has none
    shared_by_a_record: tuple[tuple[object, ...] | None, ...]

    @property
    def shared_file(self) -> tuple[object, ...] | None:
        """The file that components of one record share, None of a file with one component."""
        return self.shared_by_a_record[0]


@dataclass
class CatalogueDraft:
    """A catalogue made: its table, and what a person should look at: files and what looks wrong in each."""

    unit: str | None  # of files that do not state theirs
    dt: float | None  # sampling interval [s] of files without one
    folder: Path  # files are named from here
    table: pd.DataFrame = field(default_factory=pd.DataFrame)
    notes: list[tuple[str, str]] = field(default_factory=list)
    errors: list[str] = field(default_factory=list)
    # files that are in order but no records of acceleration, and why
    left_out: list[tuple[str, str]] = field(default_factory=list)

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
        reasons: dict[str, list[str]] = {}
        for file, why in self.left_out:
            reasons.setdefault(why, []).append(file)
        lines += [
            f"left out, {why}: {', '.join(files)}" for why, files in reasons.items()
        ]
        return lines

    def note(self, file: str, what: str) -> None:
        """Note what looks wrong in a file."""
        self.notes.append((file, what))

    def look_through(
        self, path: Path, progress: Progress | None
    ) -> tuple[list[Component], list[PeerRecord]]:
        """Return the components below a path and what PEER says of them."""
        inside, files = path.is_dir(), record_files(path)
        self.left_out += [
            (self._named(file), why)
            for file, why in passed_over(path)
            if file.name != SEARCH_RESULTS
        ]
        components = []
        for number, file in enumerate(files, start=1):
            components += self._components(file)
            if progress is not None:
                progress(number, len(files))
        listed: list[PeerRecord] = []
        try:
            if path.name == SEARCH_RESULTS and not inside:
                raise InputError(
                    f"{path}: give the folder that this file lies in, with its records."
                )
            for file in sorted(path.rglob(SEARCH_RESULTS)) if inside else []:
                listed += read_search_results(file)
            for file in filter(is_archive, files):
                with unpacked(file) as members:
                    for member in members:
                        if PurePosixPath(member.name).name == SEARCH_RESULTS:
                            listed += read_search_results(member.path)
                        elif is_no_record(member.name):
                            name = f"{self._named(file)}#{member.name}"
                            self.left_out.append((name, "no record by its name"))
        except InputError as error:
            self.errors.append(str(error))
        return components, listed

    def _named(self, file: Path) -> str:
        return Path(os.path.relpath(file, self.folder)).as_posix()

    def _leave_out(self, name: str, path: str, error: InputError) -> None:
        """Note a file that is no record, by the name that a catalogue has for it, or what is wrong with it."""
        if isinstance(error, NotAcceleration):
            why = str(error).removeprefix(path).lstrip(":, ").rstrip(".")
            self.left_out.append((printable(name), why))
        else:
            self.errors.append(str(error))

    def _components(self, file: Path) -> list[Component]:
        """Read every component of a file; what is wrong with it goes into the errors."""
        try:
            record, dt_given = read_untold(file, self.dt)
        except InputError as error:
            self._leave_out(self._named(file), str(file), error)
            return []
        relative = self._named(file)
        for member, why in record.left_out:
            self._leave_out(f"{relative}#{member}", f"{file}#{member}", why)
        if not relative.isprintable():
            self.errors.append(
                f"{printable(relative)}: its name has characters that no table shows; rename the file"
            )
            return []
        found = []
        for number, channel in enumerate(record.channels, start=1):
            unit = None if channel.unit else self.unit
            try:
                motion = motion_of(record, channel, unit)
            except InputError as error:
                self.errors.append(str(error))
                continue
            own = [
                c.code or c.component
                for c in record.channels
                if c.member == channel.member
            ]
            label = channel.code or channel.component
            chosen = label if label and own.count(label) == 1 else str(number)
            parts = [relative, channel.member, chosen if len(own) > 1 else ""]
            own_row = {
                "file": "#".join(filter(None, parts)),
                "unit": unit or "",
                "dt": dt_given,
            }
            found.append(_component(file, channel, motion, own_row, len(own) > 1))
        return found

    def peer_rows(
        self, listed: PeerRecord, found: Sequence[Component], used: set[str]
    ) -> list[dict[str, Any]]:
        """Return the rows of one record of a download."""
        by_name = {
            Path(component.path).name.lower(): component
            for component in reversed(found)
        }
        # names may have the folder of PEER's disk before them
        own = [
            PurePosixPath(name.replace("\\", "/")).name.lower() for name in listed.files
        ]
        found_files = [by_name.get(name) for name in own]
        vertical = found_files[2]
        for name, side in zip(listed.files[:2], found_files[:2], strict=True):
            if name and side is None:
                self.note(
                    f"RSN{listed.number}", f"{name} is listed but not among the files"
                )
        there = [component for component in found_files[:2] if component is not None]
        used.update(
            component.file for component in (*there, vertical) if component is not None
        )
        return [
            self._row(component, there, vertical) | listed.facts for component in there
        ]

    def rows_of(self, group: Sequence[Component]) -> list[dict[str, Any]]:
        """Return the rows of the components of one record."""
        flat = _horizontal(group)
        upright = next(
            (component for component in group if component.is_vertical), None
        )
        if not flat and upright is not None:
            self.note(upright.file, "a vertical component of no record here; left out")
        if len(flat) == 1:
            self.note(flat[0].file, "its other horizontal component was not found")
        if upright is not None and _THIRD.search(str(upright.row["component"])):
            self.note(
                upright.file,
                f"{upright.row['component']} is taken for the vertical, as FDSN numbers components; if it is not, "
                "give it a row",
            )
        if {component.suffix for component in flat} == {"1", "2"}:
            self.note(
                flat[0].file,
                f"taken for a component of one record with {flat[1].file} by the numbers in their names alone; if "
                "they are two records, empty the column second",
            )
        return [self._row(component, flat, upright) for component in flat]

    def _row(
        self,
        component: Component,
        pair: Sequence[Component],
        vertical: Component | None,
    ) -> dict[str, Any]:
        """Return the row of one component of a pair, and note what looks wrong in it."""
        other = next((other for other in pair if other is not component), None)
        file, npts = component.file, component.npts
        self.notes += [(file, quality_flag) for quality_flag in component.quality_flags]
        if other and file < other.file and abs(npts - other.npts) > 0.1 * npts:
            self.note(
                file,
                f"{npts} samples, but {other.npts} in {other.file} of the same record",
            )
        earthquake = component.row["earthquake"] or component.stem
        if not component.row["earthquake"]:
            column = f"the column earthquake has {earthquake!r}"
            self.note(file, f"its earthquake is not stated; {column}")
        return component.row | {
            "earthquake": earthquake,
            "second": other.file if other else "",
            "vertical": vertical.file if vertical else "",
        }

    def without_copies(
        self, groups: Sequence[list[Component]], seen: dict[str, str]
    ) -> list[list[Component]]:
        """Leave out records that are there already, as in an archive and beside it.

        Of two the one with both horizontals is kept, of those the file and not the member of an archive.
        """

        def worth(number: int) -> tuple[int, bool, int]:
            """Order of copies: those with most horizontal components first, unpacked ones first."""
            group = groups[number]
            return (
                -len(_horizontal(group)),
                any(component.packed for component in group),
                number,
            )

        kept = []
        for number in sorted(range(len(groups)), key=worth):
            horizontal = _horizontal(groups[number]) or groups[number]
            if all(component.digest in seen for component in horizontal):
                for first in groups[number]:
                    other = seen.get(first.digest, "") or horizontal[0].file
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
                by_day.setdefault(row["date"], {}).setdefault(
                    row["earthquake"], row["file"]
                )
        for day, earthquakes in by_day.items():
            if len(earthquakes) > 1:
                first, other = list(earthquakes)[:2]
                self.note(
                    earthquakes[other],
                    f"its earthquake is {other!r}, that of {earthquakes[first]} on the same day ({day}) "
                    f"{first!r}; if they are one, give it one name in the column earthquake",
                )


def _component(
    file: Path, channel: Channel, motion: Motion, own_row: dict[str, Any], several: bool
) -> Component:
    """Return what a catalogue needs of one channel of a file.

    Parameters
    ----------
    file, channel, motion : the file, its channel and the motion of that
    own_row : keys of its row that are known: file, unit and interval
    several : whether the file has other channels
    """
    facts = motion.metadata
    path = channel.member or str(file)
    plain = PurePosixPath(path if channel.member else file.name).name.removesuffix(
        ".gz"
    )
    # K-NET's endings name the component
    name = plain if _OF_KNET.search(plain) else plain.rsplit(".", 1)[0] or plain
    stem, suffix = (name, "") if several else parts_of(name)
    orientation = str(facts.get("component") or ("" if suffix in NUMBERS else suffix))
    azimuth = facts.get("azimuth_deg")
    # the archive that the file lies in
    container = str(file) if channel.member else ""
    place = facts.get("network"), facts.get("station"), facts.get("location")
    # the channel of a MiniSEED file is its code; others state the component in words
    stated = bool(facts.get("component") and facts.get("earthquake")) and not several
    folder = container, str(Path(path).parent)
    row = {
        **own_row,
        "name": f"{name} {facts.get('channel', '')}".strip() if several else name,
        "earthquake": str(facts.get("earthquake") or ""),
        "date": _date(facts),
        "component": orientation,
        **{key: facts.get(key) for key in ("station", "magnitude", "distance_km")},
        "source": "folder",
        "sha256": motion.provenance[0]["sha256"],
    }
    samples = motion.acceleration.tobytes() + repr(motion.dt).encode()
    return Component(
        file=row["file"],
        row=row,
        stem=stem,
        suffix=suffix,
        path=path,
        packed=bool(container),
        plain_name=name,
        npts=motion.acceleration.size,
        dt=motion.dt,
        digest=hashlib.sha256(samples).hexdigest(),
        quality_flags=tuple(quality_flags(motion)),
        azimuth=azimuth_of(orientation) if azimuth is None else float(azimuth),
        is_vertical=is_vertical(orientation),
        shared_by_a_record=(
            (container, path) if several else None,
            (*folder, facts.get("earthquake"), *place) if stated and place[1] else None,
            (*folder, stem) if suffix else None,
            (*place, facts.get("start_time")) if place[1] and facts.get("start_time") else None,
        ),
    )  # fmt: skip


def make_catalogue(
    paths: Iterable[str | os.PathLike[str]],
    unit: str | None = None,
    dt: float | None = None,
    folder: str | os.PathLike[str] = ".",
    *,
    progress: Progress | None = None,
) -> CatalogueDraft:
    """Make a catalogue of the horizontal components in folders, archives and files.

    Components of one record are found by PEER's ``_SearchResults.csv`` where there is one, by being in one
    file, by station and time, and by names that differ in the component alone. Each horizontal
    component becomes a row that names the other one as ``second`` and the vertical one.

    Parameters
    ----------
    paths
        Of folders, archives and files.
    unit
        Of the samples of files that do not state theirs.
    dt
        Sampling interval of files that do not state theirs [s].
    folder
        From which the catalogue names its files.
    progress
        Called with the number of files read of a path, and of all in it.

    Returns
    -------
    CatalogueDraft
        The table, a row a horizontal component, and what a person should look at.
    """
    draft = CatalogueDraft(unit, dt, Path(folder))
    paths = list(paths)
    rows: list[dict[str, Any]] = []
    groups: list[list[Component]] = []
    seen: dict[str, str] = {}
    for path in map(Path, paths):
        found, listed = draft.look_through(path, progress)
        used: set[str] = set()
        for record in listed:
            rows += draft.peer_rows(record, found, used)
        seen |= {
            component.digest: component.file
            for component in found
            if component.file in used
        }
        groups += _records_of(
            [component for component in found if component.file not in used]
        )
    for group in draft.without_copies(groups, seen):
        rows += draft.rows_of(group)
    if not rows:
        found_instead = [f"{file}: {why}." for file, why in draft.left_out]
        reasons = [reason.rstrip(".") for reason in (*draft.errors, *found_instead)]
        more = f": {listed_problems(reasons)}" if reasons else ""
        where = ", ".join(map(str, paths))
        raise InputError(
            f"{where}: no horizontal component of acceleration was found{more}."
        )
    _name_uniquely(rows)
    draft.note_names_of_one_day(rows)
    table = pd.DataFrame(rows, columns=list(COLUMNS), dtype=object)
    # fillna of pandas before 3 would turn columns of numbers into such
    filled = np.where(table.isna(), "", table)
    draft.table = pd.DataFrame(filled, columns=table.columns, dtype=object)
    return draft


def _horizontal(group: Sequence[Component]) -> list[Component]:
    return [component for component in group if not component.is_vertical]


def _with_third_upright(components: Sequence[Component]) -> list[Component]:
    """Return components of which, in a file that numbers them 1, 2 and 3, the third is the vertical.

    So FDSN numbers components; the numbers then say nothing of azimuths.
    """
    names: dict[object, set[str]] = {}
    for component in components:
        file = component.shared_file
        if file is not None:
            names.setdefault(file, set()).add(str(component.row["component"]))
    numbered = {file for file, found in names.items() if found == {"1", "2", "3"}}
    return [
        replace(each, azimuth=None, is_vertical=each.row["component"] == "3")
        if each.shared_file in numbered
        else each
        for each in components
    ]


def _records_of(components: Sequence[Component]) -> list[list[Component]]:
    """Group components into records: by file, by headers, by names, and by station and time, in this order."""
    groups: list[list[Component]] = []
    components = _with_third_upright(components)
    left = list(components)
    numbered = _numbered(components)
    for way, shared in enumerate(_GROUPED_BY):
        by_key: dict[object, list[Component]] = {}
        for component in left:
            key = component.shared_by_a_record[way]
            counts_records = shared == "names" and component.file in numbered
            if key is not None and not counts_records:
                by_key.setdefault(key, []).append(component)
        for several in by_key.values():
            # of copies the first
            unlike: dict[str, Component] = {}
            for component in several:
                unlike.setdefault(component.digest, component)
            group = list(unlike.values())
            if _is_record(group):
                groups.append(group)
                left = [component for component in left if component not in group]
    for component in left:
        record = _record_without_vertical(component, groups)
        if record is None:
            groups.append([component])
        else:
            record.append(component)
    order = {component.file: number for number, component in enumerate(components)}
    return sorted(groups, key=lambda group: order[group[0].file])


_GROUPED_BY = ("file", "headers", "names", "station and time")
"""How components of one record are found, in this order."""


def _numbered(components: Sequence[Component]) -> set[str]:
    """Return the files of components whose names count records, and not the components of one.

    So do the files r01 and r02 of a folder or an archive; A1 and A2 may be two components (``numbered_records``).
    """
    folders: dict[object, dict[str, str]] = {}
    for component in components:
        # files beside an archive are none of its members
        folder = component.packed, str(Path(component.path).parent)
        folders.setdefault(folder, {})[component.plain_name] = component.file
    counted = {
        files[name] for files in folders.values() for name in numbered_records(files)
    }
    # a suffix such as 090 or NS names a component whatever the number before it counts
    return {c.file for c in components if c.suffix in NUMBERS and c.file in counted}


def _record_without_vertical(
    component: Component, groups: Sequence[list[Component]]
) -> list[Component] | None:
    """Return the record that a lone vertical component is of, if there is one that has none."""
    keys = {key for key in component.shared_by_a_record if key is not None}
    for group in groups if component.is_vertical else ():
        complete = len(group) != 2 or any(each.is_vertical for each in group)
        if not complete and keys & {k for c in group for k in c.shared_by_a_record}:
            return group
    return None


def _is_record(group: Sequence[Component]) -> bool:
    """Tell whether components are two horizontals at a right angle and at most one vertical."""
    flat = _horizontal(group)
    if len(flat) != 2 or len(group) > 3 or abs(flat[0].dt - flat[1].dt) > 1e-9:
        return False
    first, second = flat[0].azimuth, flat[1].azimuth
    if (
        first is None
        or second is None
        or {flat[0].suffix, flat[1].suffix} == {"1", "2"}
    ):
        return True
    # angle between both lines, from 0 to 90 degrees
    apart = abs((first - second + 90) % 180 - 90)
    return abs(apart - 90) <= _PERPENDICULAR


def _date(facts: Mapping[str, Any]) -> str:
    """Return the day of the start of the record, else of the earthquake, else nothing."""
    for words in (
        str(facts.get("start_time") or ""),
        str(facts.get("earthquake") or ""),
    ):
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
