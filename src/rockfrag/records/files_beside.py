"""Files that a record is read with: the StationXML beside counts, the values beside a script of OpenSees.

In: paths of records. Out: paths of all files on which their motions depend. Docs: ``docs/formats.md``.
"""

import re
from collections.abc import Iterable
from pathlib import Path

from rockfrag.records.parsing.text_file import read_head

# The "time series" of a PEER header is none
_SCRIPT = re.compile(rb"timeSeries|Series\s+-", re.I)


def with_files_beside(records: Iterable[Path]) -> list[Path]:
    """Return records, and the files that their readers may take too.

    Parameters
    ----------
    records : paths, whether or not there are such files

    Returns
    -------
    Paths, each once.
    """
    found: dict[Path, None] = {}
    for record in records:
        found |= dict.fromkeys((record, *_beside(record)))
    return list(found)


def _beside(record: Path) -> list[Path]:
    """Files beside a record that its reader may take."""
    head = read_head(record)
    if b"\x00" in head:
        # counts of a recorder, whose channels a StationXML describes
        return sorted(record.parent.glob("*.xml"))
    if not _SCRIPT.search(head):
        return []
    # it loads ObsPy, which few studies need before their first job
    from rockfrag.records.formats.opensees import files_named

    return files_named(record)
