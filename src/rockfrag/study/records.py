"""Checking the user's records before the first job: can each be read, and does it look right?"""

import os
from pathlib import Path

from rockfrag.errors import InputError
from rockfrag.plausibility import peak_warning
from rockfrag.records.catalogue import repeated_motions
from rockfrag.study.study import RECORDS_FOLDER, Study

_FOUND: dict[tuple[object, ...], list[str]] = {}
"""What was found of the records as they are: a run is checked by itself and by Snakemake, in one process."""


def check_records(study: Study) -> list[str]:
    """Read every record that lies in a folder of the user's own, once in a process as long as none changes.

    Returns warnings: of accelerations that look as if in another unit, of records that will be left out.
    """
    rows = study.catalogue[study.catalogue["source"] == "folder"]
    files = [
        study.catalogue_file,
        *(
            study.catalogue_file.parent / name.partition("#")[0]
            for column in ("file", "second", "vertical")
            for name in rows[column]
        ),
    ]
    asked = (tuple(rows["name"]), study.keep_going, study.vertical, *map(_state, files))
    if asked not in _FOUND:
        _FOUND[asked] = _read_all(study)
    return [*_FOUND[asked]]


def _state(path: Path) -> tuple[str, int, int]:
    """Path, size and time of the last change of a file; what is not there has neither."""
    try:
        found = os.stat(path)
    except (OSError, ValueError):
        return str(path), 0, 0
    return str(path), found.st_size, found.st_mtime_ns


def _read_all(study: Study) -> list[str]:
    from rockfrag.motions.directions import motion_and_vertical, motion_of_row

    warnings = [f"{study.catalogue_file}: {line}" for line in repeated_motions(study.catalogue)]
    folder = study.catalogue_file.parent
    for row in study.catalogue[study.catalogue["source"] == "folder"].to_dict("records"):
        where = f"{study.catalogue_file}, motion {row['name']}"
        try:
            named = {str(k): v for k, v in row.items()}
            if study.vertical:
                motion, _ = motion_and_vertical(named, folder, Path(RECORDS_FOLDER))
            else:
                motion = motion_of_row(named, folder, Path(RECORDS_FOLDER))
            if motion.pga == 0:
                raise InputError("the record is zero throughout; leave it out.")
        except InputError as error:
            if not study.keep_going:
                raise InputError(f"{where}: {error}") from None
            warnings.append(f"{where} will be left out: {error}")
            continue
        if quality_flag := peak_warning(motion.pga):
            warnings.append(f"{where}: {quality_flag}.")
    return warnings
