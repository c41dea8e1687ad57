"""The text formats whose header says what they are; plain text is what none of them knows."""

from rockfrag.records.formats import (
    afad,
    agram,
    at2,
    bhrc,
    cosmos,
    csmip,
    csmnc,
    cwa,
    esm,
    geonet,
    opensees,
    renadic,
    seismosoft,
    smc,
    unam,
    usc,
    usc_volume_2,
)
from rockfrag.records.parsing.format import Format

HEADED: tuple[Format, ...] = tuple(
    module.FORMAT
    for module in (
        afad,
        agram,
        at2,
        bhrc,
        cosmos,
        csmip,
        csmnc,
        cwa,
        esm,
        geonet,
        opensees,
        renadic,
        seismosoft,
        smc,
        unam,
        usc,
        usc_volume_2,
    )
)
