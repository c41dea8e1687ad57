"""Which of the formats read here a file is of; ObsPy reads some others."""

from rockfrag.records.formats import plain
from rockfrag.records.headed_formats import HEADED
from rockfrag.records.parsing.format import Format
from rockfrag.records.parsing.text_file import Source

FORMATS: tuple[Format, ...] = (*HEADED, plain.FORMAT)


def identify(source: Source) -> Format | None:
    """Return the format that a file is of, or None if it is none of those read here."""
    for candidate in FORMATS:
        if candidate.is_format(source):
            return candidate
    return None
