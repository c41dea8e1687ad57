"""What is asked: an object, where it stands, and what shakes the place.

In: settings as written by a user, with units. Out: a checked request, SI units. Docs: ``docs/assess.md``.
"""

import math
import os
import re
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from rockfrag.assess.hazard.curve import (
    HIGHEST,
    PGA,
    PGV,
    SA_1S,
    HazardCurve,
    curve_of_one_level,
    read_hazard,
    read_level,
    read_measure,
)
from rockfrag.assess.place import Place, make_place
from rockfrag.assess.standing import Standing, make_standing
from rockfrag.assess.texts import Text
from rockfrag.base.errors import InputError, errors_of
from rockfrag.base.units import quantity
from rockfrag.base.yaml_file import read_yaml
from rockfrag.config.schema import checked
from rockfrag.motions.intensity import IntensityMeasure
from rockfrag.system.kinds import kind_named
from rockfrag.words.findings import Finding, Value, finding, listed, three

LONGEST_PERIOD = 1e6  # Longest return period of a level [year]
# Time for which the probability is given unless another is asked for [year]
YEARS = 50.0

ACCEPTED_IN_FIFTY_YEARS = 0.01
"""Probability in 50 years that is accepted unless another is stated [-]: that of the collapse of a new building at
which ASCE/SEI 7-16 (21.2.1) aims."""

ACCEPTED_AT_A_LEVEL = 0.1
"""The same at a level without a hazard [-]: securing pays if it costs less than that part of what a fall costs."""

UNNAMED = "the object"  # Name of an object that was given none


@dataclass(frozen=True)
class LevelSpread:
    """How well a level of shaking is known: the logarithms of its value and of its PGV are normal."""

    value: float  # Standard deviation of ln value [-]
    pgv: float = 0.0  # That of ln PGV [-]
    correlation: float = 0.0  # Between the two [-]


@dataclass(frozen=True)
class Level:
    """A level of shaking of the ground."""

    measure: IntensityMeasure  # The intensity measure
    value: float  # Its value, in its unit; the median where it is not known exactly
    # Peak velocity with it [cm/s]; NaN if unknown, or the measure itself
    pgv: float = math.nan
    # Spectral acceleration at 1 s with it [g]; NaN if unknown, or the measure itself
    sa_1s: float = math.nan
    spread: LevelSpread | None = None  # How well they are known; None if exactly

    @property
    def amount(self) -> Finding:
        """Such as ``PGA 0.25 g``, with PGV or SA(1 s) where that is known too."""
        measure, unit, value = self.measure.imt, self.measure.unit, three(self.value)
        if math.isfinite(self.sa_1s) and math.isnan(self.pgv):
            about: dict[str, Value] = {"measure": measure, "value": value, "unit": unit}
            return finding(Text.AMOUNT_WITH_SA, sa=three(self.sa_1s), **about)
        if math.isnan(self.pgv):
            return finding(Text.AMOUNT, measure=measure, value=value, unit=unit)
        about = {"measure": measure, "unit": unit}
        return finding(Text.AMOUNT_WITH_PGV, value=value, pgv=three(self.pgv), **about)


@dataclass(frozen=True)
class Records:
    """Where the motions come from."""

    paths: tuple[Path, ...] = ()  # The user's own records; empty for the default set
    on_floor: bool = False  # Whether they were recorded on the floor of the object
    # Unit and sampling interval [s] of files that do not state theirs
    unit: str | None = None
    dt: float | None = None
    # Of the earthquakes that matter most to the site; NaN where not known
    magnitude: float = math.nan
    distance_km: float = math.nan
    vs30: float = (
        math.nan
    )  # Velocity of shear waves in the upper 30 m of the site [m/s]


@dataclass(frozen=True)
class Request:
    """An object at a place, ready to be assessed."""

    name: str  # What the object is called
    objects: Standing  # The object, its pedestal, and what is not known of them
    place: Place  # The floor on which it stands
    level: Level | None = None  # The level of shaking asked about
    hazard: tuple[HazardCurve, ...] = ()  # Hazard curves of the site, one a measure
    years: float = YEARS  # Time for the probability [year]
    records: Records = field(default_factory=Records)  # Where the motions come from
    value: float = math.nan  # What the object is worth, in any unit; NaN if not given
    # Probability of toppling that is accepted; None for the usual one
    accept: float | None = None
    # Latitude and longitude [degrees]; None where not given
    coordinates: tuple[float, float] | None = None
    # What ways to hold it cost, by their keys, in any unit
    costs: Mapping[str, float] = field(default_factory=dict)

    @property
    def accepted(self) -> float:
        """Probability of toppling that is accepted in the years, or at the level without a hazard [-]."""
        if self.accept is not None:
            return self.accept
        if not self.hazard:
            return ACCEPTED_AT_A_LEVEL
        rate = -math.log1p(-ACCEPTED_IN_FIFTY_YEARS) / YEARS
        return -math.expm1(-rate * self.years)

    @property
    def called(self) -> str | Finding:
        """What the object is called, in words where it has no name."""
        return finding("the_object") if self.name == UNNAMED else self.name

    @property
    def where(self) -> Finding:
        """Where it stands, and with what holds it there: ``on the ground with wax or putty``."""
        holders = [holder.short for holder in self.objects.under.holders]
        where = self.place.where
        if not holders:
            return where
        return finding(Text.WHERE_HELD, where=where, holders=listed(holders))


def read_request(path: str | os.PathLike[str] | Mapping[str, Any]) -> Request:
    """Read a request from a YAML file, or take one from a mapping with the same keys.

    Parameters
    ----------
    path : file such as ``statue.yaml``, to which paths in it are relative; or its keys and values

    Returns
    -------
    What is asked, for :func:`rockfrag.assess.assess`.
    """
    if isinstance(path, Mapping):
        return make_request(path, "read_request")
    return make_request(read_yaml(path), str(path), Path(path).parent)


def make_request(
    settings: Mapping[str, Any], source: str, folder: Path | None = None
) -> Request:
    """Make a request of keys as in ``statue.yaml``, see ``docs/assess.md``.

    Parameters
    ----------
    settings : the keys
    source : where they come from, which messages name
    folder : from which paths in them are read; the present one if None

    Returns
    -------
    What is asked, for :func:`rockfrag.assess.assess`.
    """
    known = checked(settings, "statue", source)
    if kind := known.pop("kind", None):
        known = kind_named(kind).settings(known)
    where = folder or Path()
    with errors_of(source):
        return Request(
            name=known.get("name", UNNAMED),
            objects=make_standing(known, where),
            place=make_place(known, where),
            level=_level(known),
            hazard=_hazard(known, where),
            years=float(known.get("years", YEARS)),
            accept=known.get("accept"),
            costs=known.get("costs", {}),
            records=_records(known, where),
        )


def _level(settings: Mapping[str, Any]) -> Level | None:
    """The level asked about; PGV beside another measure, and SA(1 s) beside PGA, say more of it."""
    given = [key for key in ("pga", "sa", "pgv") if key in settings]
    if not given:
        return None
    levels = {key: _level_of(key, settings[key]) for key in given}
    found = levels[given[0]]
    if "pgv" in levels and found.measure != PGV:
        found = replace(found, pgv=levels["pgv"].value)
    if found.measure == PGA and "sa" in levels:
        if levels["sa"].measure != SA_1S:
            raise InputError(
                "key sa: beside a PGA it says how strong long waves are, and needs a period of 1 s; give that, or "
                "leave the PGA out."
            )
        found = replace(found, sa_1s=levels["sa"].value)
    return found


def _level_of(key: str, given: Any) -> Level:
    """The level of shaking that a key gives: PGA, PGV, or a period and its acceleration."""
    measure = {"pga": PGA, "pgv": PGV}.get(key)
    if measure is None:
        period, given = given
        with errors_of("key sa"):
            seconds = quantity(period, "s", None)
        measure = read_measure(f"SA({seconds:g})", "key sa")
    with errors_of(f"key {key}"):
        level = Level(measure, read_level(given, measure))
        if not 0 < level.value <= HIGHEST[measure.openquake]:
            raise InputError(
                f"{measure.imt} {level.value:.3g} {measure.unit} is no shaking of an earthquake; "
                f"expected more than 0 and at most {HIGHEST[measure.openquake]:g} {measure.unit}."
            )
    return level


_PERIOD = re.compile(
    r"\s*((?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*(?:years?|yrs?|a|anni)?\s*"
)


def _return_period(settings: Mapping[str, Any]) -> float | None:
    """The return period in years, under the key that states the unit or beside it."""
    if "return_period" not in settings:
        years = settings.get("return_period_years")
        return None if years is None else float(years)
    given = settings["return_period"]
    found = _PERIOD.fullmatch(str(given))
    years = float(found[1]) if found else math.nan
    if not 0 < years <= LONGEST_PERIOD:
        raise InputError(
            f"key return_period: expected more than 0 and at most {LONGEST_PERIOD:g} years such as 475 years, "
            f"found {given!r:.40}."
        )
    return years


def _hazard(settings: Mapping[str, Any], folder: Path) -> tuple[HazardCurve, ...]:
    """Hazard curves of files, or one through a level and its return period."""
    level, years = _level(settings), _return_period(settings)
    if years is None:
        return tuple(
            read_hazard([folder / file for file in settings.get("hazard", [])])
        )
    if level is None:
        raise InputError(
            "key return_period: give the level it belongs to, such as pga 0.25 g."
        )
    curves = [curve_of_one_level(level.measure, level.value, years)]
    if math.isfinite(level.pgv):
        curves.append(curve_of_one_level(PGV, level.pgv, years))
    return tuple(curves)


def _records(settings: Mapping[str, Any], folder: Path) -> Records:
    """The records that a request names, or magnitude and distance by which they are chosen."""
    given = settings.get("records", {})
    return Records(
        paths=tuple(folder / path for path in given.get("paths", [])),
        on_floor=given.get("recorded_on", "ground") == "floor",
        unit=given.get("unit"),
        dt=given.get("dt_s"),
        magnitude=float(settings.get("magnitude", math.nan)),
        distance_km=float(settings.get("distance_km", math.nan)),
        vs30=float(settings.get("vs30_m_s", math.nan)),
    )
