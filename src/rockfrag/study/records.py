"""Checking the user's records before the first job: can each be read, and does it look right?"""

from rockfrag.errors import InputError
from rockfrag.plausibility import peak_warning
from rockfrag.study.study import RECORDS_FOLDER, Study


def check_records(study: Study) -> list[str]:
    """Read every record that lies in a folder of the user's own.

    Returns
    -------
    Warnings about accelerations that look as if they were in another unit, and about records that a
    study which keeps going will leave out.

    Raises
    ------
    InputError
        If a file cannot be read as a record, or is not the one of its SHA-256.
    """
    from pathlib import Path

    from rockfrag.motions.directions import motion_and_vertical, motion_of_row

    warnings = []
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
        if doubt := peak_warning(motion.pga):
            warnings.append(f"{where}: {doubt}.")
    return warnings
