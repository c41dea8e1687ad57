"""The intensity measures that hazard comes in: PGA, PGV and Sa(T)."""

import math
import re
from dataclasses import dataclass

from rockfrag.errors import InputError
from rockfrag.motions.intensity import pga, pgv, spectral_acceleration
from rockfrag.records.motion import Motion
from rockfrag.units import CENTIMETRES_PER_METRE, GRAVITY

PERIODS = (0.01, 10.0)
"""Periods of Sa that hazard models cover [s]."""

VELOCITY_PER_G = GRAVITY * CENTIMETRES_PER_METRE
"""PGV over (a measure in g times PGV over it): cm/s for g and s."""

_SA = re.compile(r"(?:P?SA)\s*[(\[_]?\s*T?=?\s*(\d*[.P]?\d+)\s*S?\s*[)\]]?", re.IGNORECASE)


@dataclass(frozen=True)
class Measure:
    """An intensity measure of a ground motion.

    Attributes
    ----------
    kind
        ``PGA``, ``PGV`` or ``SA``.
    period
        Natural period of ``SA`` [s], 5 % damped; 0 for the others.
    """

    kind: str
    period: float = 0.0

    @property
    def name(self) -> str:
        """As the field writes it: ``PGA``, ``PGV``, ``SA(0.3)``."""
        return f"SA({self.period:g})" if self.kind == "SA" else self.kind

    @property
    def unit(self) -> str:
        """Unit of its levels: cm/s for PGV, g for the others."""
        return "cm/s" if self.kind == "PGV" else "g"

    @property
    def column(self) -> str:
        """Name of a column with its unit, as :mod:`rockfrag.fragility` reads it."""
        if self.kind == "SA":
            return f"sa_{f'{self.period:g}'.replace('.', '_')}s_g"
        return "pgv_cm_s" if self.kind == "PGV" else "pga_g"

    def of(self, motion: Motion) -> float:
        """Value of a motion, in :attr:`unit`.

        Parameters
        ----------
        motion
            What to measure.
        """
        if self.kind == "PGV":
            return pgv(motion) * CENTIMETRES_PER_METRE
        if self.kind == "PGA":
            return pga(motion) / GRAVITY
        return spectral_acceleration(motion, self.period) / GRAVITY


PGA = Measure("PGA")
PGV = Measure("PGV")


def read_measure(text: str, where: str) -> Measure:
    """Read the name of a measure as hazard models write it: ``PGA``, ``SA(0.3)``, ``SA0P2``, ``PSA-1.0s``.

    Parameters
    ----------
    text
        The name.
    where
        Where it stands, for the message.

    Raises
    ------
    InputError
        If it is none of them.
    """
    plain = re.sub(r"[\s\-]", "", text).upper()
    if plain in ("PGA", "PGV"):
        return Measure(plain)
    found = _SA.fullmatch(plain)
    period = float(found[1].replace("P", ".")) if found else math.nan
    if not PERIODS[0] <= period <= PERIODS[1]:
        raise InputError(
            f"{where}: the measure {text[:40]!r} is not known; expected PGA, PGV or SA(T) with a period of "
            f"{PERIODS[0]:g} to {PERIODS[1]:g} s."
        )
    return Measure("SA", period)
