"""All record formats that are read here; ObsPy reads the others."""

from rockfrag.records import at2, seismosoft
from rockfrag.records.format import Format
from rockfrag.records.text import Source

FORMATS: tuple[Format, ...] = (at2.FORMAT, seismosoft.FORMAT)


def identify(source: Source) -> Format | None:
    """Return the format that a file is of, or None if it is none of those read here."""
    for candidate in FORMATS:
        if candidate.is_format(source):
            return candidate
    return None
