"""All record formats that are read here; ObsPy reads the others."""

from rockfrag.records.formats import (
    at2,
    cosmos,
    csmip,
    cwa,
    esm,
    geonet,
    plain,
    renadic,
    seismosoft,
    smc,
    usc,
)
from rockfrag.records.parsing.format import Format
from rockfrag.records.parsing.text_file import Source

FORMATS: tuple[Format, ...] = tuple(
    module.FORMAT
    for module in (
        at2,
        cosmos,
        csmip,
        cwa,
        esm,
        geonet,
        plain,
        renadic,
        seismosoft,
        smc,
        usc,
    )
)


def identify(source: Source) -> Format | None:
    """Return the format that a file is of, or None if it is none of those read here."""
    for candidate in FORMATS:
        if candidate.is_format(source):
            return candidate
    return None
