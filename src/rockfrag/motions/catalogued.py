"""All horizontal motions of a folder, an archive, a record or a catalogue, with both components of each record.

In: a path. Out: motions [m/s²], and what was left out and why. Docs: ``docs/formats.md``.
"""

import os
import warnings
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from rockfrag.base.errors import InputError
from rockfrag.base.keywords import named_keywords
from rockfrag.motions.directions import motions_of_row
from rockfrag.records.catalogue import (
    is_catalogue,
    listed_problems,
    load_component,
    numbered_rows,
    scaled,
    with_numbers,
)
from rockfrag.records.motion import Motion


class LeftOut(UserWarning):
    """Files that are no records, and what looks wrong in those that are."""


@named_keywords
def read_motions(
    source: str | os.PathLike[str],
    unit: str | None = None,
    dt: float | None = None,
    records: str | os.PathLike[str] = "resources/records",
) -> list[Motion]:
    """Read all horizontal motions of a folder, an archive, a record or a catalogue.

    Of a folder every file is read, is named in a :class:`LeftOut` warning with the reason why it is no record, or
    is refused. A row of a catalogue gives its component in its direction; where it has none and names a
    ``second`` component that no other row has, that is a motion as well.

    Parameters
    ----------
    source : folder, archive, record, or catalogue (CSV with the columns name, earthquake and file)
    unit : unit of files that do not state theirs (``g``, ``m/s2``, …); a catalogue states it itself
    dt : sampling interval [s] of files without one; likewise
    records : folder below which records of a catalogue are kept that are fetched

    Returns
    -------
    list of Motion
        Accelerations in m/s², verticals left out. Their metadata have ``file``, ``second`` and ``vertical`` as a
        catalogue names them.
    """
    path = Path(source)
    if path.is_file() and is_catalogue(path):
        if unit is not None or dt is not None:
            raise InputError(
                f"{path}: a catalogue states units and intervals itself; leave unit= and dt= out."
            )
        return motions_of_catalogue(path, Path(records))
    motions, said = motions_of_files(path, unit, dt)
    if said:
        warnings.warn(f"{path}: {'; '.join(said)}", LeftOut, stacklevel=3)
    return motions


def motions_of_catalogue(path: Path, records: Path) -> list[Motion]:
    """Read the motions of a catalogue, see :func:`read_motions`; all that is wrong is refused at once.

    Parameters
    ----------
    path, records : the catalogue, and the folder of fetched records

    Returns
    -------
    The motions [m/s²], in the catalogue's order.
    """
    rows = numbered_rows(path)
    own = {(row["source"], row["file"]) for _, row in rows}
    motions: list[Motion] = []
    problems: list[str] = []
    for number, row in rows:
        try:
            motions += _motions_of_row(row, own, path.parent, records)
        except InputError as error:
            problems.append(f"line {number}: {str(error).rstrip('.')}")
    if problems:
        raise InputError(f"{path}, {listed_problems(problems)}.")
    return motions


def motions_of_files(
    path: Path, unit: str | None, dt: float | None
) -> tuple[list[Motion], list[str]]:
    """Read the motions of a folder, an archive or a record, with notes on them.

    Parameters
    ----------
    path, unit, dt : folder, archive or record; unit and interval [s] of files that do not state theirs

    Returns
    -------
    The motions [m/s²], and the notes.
    """
    # reading the headers of all formats loads ObsPy
    from rockfrag.records.make_catalogue import make_catalogue

    draft = make_catalogue([path], unit, dt, Path())
    if draft.errors:
        raise InputError(
            f"{path}: {listed_problems([e.rstrip('.') for e in draft.errors])}."
        )
    rows = with_numbers(draft.table).to_dict("records")
    named = [{str(key): value for key, value in row.items()} for row in rows]
    own = {(row["source"], row["file"]) for row in named}
    motions = [
        motion for row in named for motion in _motions_of_row(row, own, Path(), Path())
    ]
    return motions, draft.summary()


def _motions_of_row(
    row: dict[str, Any], own: set[tuple[Any, Any]], folder: Path, records: Path
) -> list[Motion]:
    """Return the motion of a row, and that of its second component where it has no row of its own."""
    found = motions_of_row(row, folder, records)
    other = str(row.get("second") or "")
    if not other or row.get("direction") or (row["source"], other) in own:
        return found
    motion = load_component(row, other, folder, records)
    facts = {**found[0].metadata, "file": other, "second": row["file"]}
    stated = {key: motion.metadata.get(key) for key in ("component", "channel")}
    named = replace(motion, name=f"{row['name']} second", metadata={**facts, **stated})
    return [*found, scaled(named, row)]


def pairs_of(motions: Sequence[Motion]) -> tuple[tuple[int, int], ...]:
    """Find the two horizontal components of each record among motions.

    A motion that names the file of its second component is paired with that file's motion.  Others are paired
    where they are the only two of their earthquake and station.  What was turned into a direction has no partner.

    Parameters
    ----------
    motions : components of records

    Returns
    -------
    Pairs of positions in ``motions``, rising.
    """
    place_of_file = {
        _fact(motion, "file"): i
        for i, motion in enumerate(motions)
        if _fact(motion, "file")
    }
    pairs = []
    unnamed: dict[tuple[str, str], list[int]] = {}
    for i, motion in enumerate(motions):
        if _fact(motion, "direction"):
            continue
        other = place_of_file.get(_fact(motion, "second"))
        if other is not None and other != i:
            # both name each other: the pair counts once
            if i < other:
                pairs.append((i, other))
            continue
        key = _fact(motion, "earthquake"), _fact(motion, "station")
        if all(key):
            unnamed.setdefault(key, []).append(i)
    pairs += [(both[0], both[1]) for both in unnamed.values() if len(both) == 2]
    return tuple(sorted(pairs))


def _fact(motion: Motion, key: str) -> str:
    """Entry of a motion's metadata as text, empty where there is none."""
    return str(motion.metadata.get(key) or "")
