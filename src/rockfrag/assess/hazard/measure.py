"""The intensity measures that hazard comes in: PGA, PGV and Sa(T)."""

import math
import re

from rockfrag.errors import InputError
from rockfrag.motions.declared import IntensityMeasure, declared
from rockfrag.units import CENTIMETRES_PER_METRE, GRAVITY

PERIODS = (0.01, 10.0)
"""Periods of Sa that hazard models cover [s]."""

VELOCITY_PER_G = GRAVITY * CENTIMETRES_PER_METRE
"""PGV over (a measure in g times PGV over it): cm/s for g and s."""

_SA = re.compile(r"(?:P?SA)\s*[(\[_]?\s*T?=?\s*(\d*[.P]?\d+)\s*S?\s*[)\]]?", re.IGNORECASE)


_KNOWN = {measure.openquake: measure for measure in declared()}
PGA, PGV, SA = (_KNOWN[kind] for kind in ("PGA", "PGV", "SA"))


def read_measure(text: str, where: str) -> IntensityMeasure:
    """Read the name of a measure as hazard models write it: ``PGA``, ``SA(0.3)``, ``SA0P2``, ``PSA-1.0s``."""
    plain = re.sub(r"[\s\-]", "", text).upper()
    if plain in ("PGA", "PGV"):
        return _KNOWN[plain]
    found = _SA.fullmatch(plain)
    period = float(found[1].replace("P", ".")) if found else math.nan
    if not PERIODS[0] <= period <= PERIODS[1]:
        raise InputError(
            f"{where}: the measure {text[:40]!r} is not known; expected PGA, PGV or SA(T) with a period of "
            f"{PERIODS[0]:g} to {PERIODS[1]:g} s."
        )
    return SA.at(period)
