"""What is asked: an object, where it stands, and what shakes the place."""

import math
import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from rockfrag.assess.hazard.curve import HIGHEST, HazardCurve, curve_of_one_level
from rockfrag.assess.hazard.measure import PGA, PGV, Measure, read_measure
from rockfrag.assess.hazard.reading import read_hazard
from rockfrag.assess.objects import Objects, make_objects
from rockfrag.assess.place import Place, make_place
from rockfrag.errors import InputError
from rockfrag.schema import checked
from rockfrag.units import CENTIMETRES_PER_METRE, GRAVITY, quantity
from rockfrag.yaml_file import read_yaml

YEARS = 50.0
"""Time for which the probability is given unless another is asked for [year]."""


@dataclass(frozen=True)
class Level:
    """A level of shaking of the ground.

    Attributes
    ----------
    measure
        The intensity measure.
    value
        Its value, in its unit.
    """

    measure: Measure
    value: float

    @property
    def words(self) -> str:
        """Such as ``PGA 0.25 g``."""
        return f"{self.measure.name} {self.value:.3g} {self.measure.unit}"


@dataclass(frozen=True)
class Records:
    """Where the motions come from.

    Attributes
    ----------
    paths
        The user's own records; empty for the default set.
    on_floor
        Whether they were recorded on the floor of the object.
    unit, dt
        Unit and sampling interval [s] of files that do not state theirs.
    magnitude, distance_km
        Of the earthquakes that matter most to the site; NaN where not known.
    """

    paths: tuple[Path, ...] = ()
    on_floor: bool = False
    unit: str | None = None
    dt: float | None = None
    magnitude: float = math.nan
    distance_km: float = math.nan


@dataclass(frozen=True)
class Request:
    """An object at a place, ready to be assessed.

    Attributes
    ----------
    name
        What the object is called.
    objects
        The object, its pedestal, and what is not known of them.
    place
        The floor on which it stands.
    level
        The level of shaking asked about; None if none was given.
    hazard
        Hazard curves of the site, one a measure; empty if none was given.
    years
        Time for the probability [year].
    records
        Where the motions come from.
    """

    name: str
    objects: Objects
    place: Place
    level: Level | None = None
    hazard: tuple[HazardCurve, ...] = ()
    years: float = YEARS
    records: Records = field(default_factory=Records)


def read_request(path: str | os.PathLike[str]) -> Request:
    """Read a request from a YAML file such as ``statue.yaml``.

    Parameters
    ----------
    path
        The file; paths in it are relative to it.

    Raises
    ------
    InputError
        If the file cannot be read, or does not describe an object at a place.
    """
    return make_request(read_yaml(path), str(path), Path(path).parent)


def make_request(settings: Mapping[str, Any], source: str, folder: Path | None = None) -> Request:
    """Make a request of what a file or a command line says.

    Parameters
    ----------
    settings
        Keys as in ``statue.yaml``, see ``docs/assess.md``.
    source
        Where they come from, for messages.
    folder
        Folder from which paths are read; the present one if None.

    Raises
    ------
    InputError
        If a key or value is not understood, or what they say does not fit together.
    """
    known = checked(dict(settings), "statue", source)
    where = folder or Path()
    try:
        return Request(
            name=known.get("name", "the object"),
            objects=make_objects(known, where),
            place=make_place(known, where),
            level=_level(known),
            hazard=_hazard(known, where),
            years=float(known.get("years", YEARS)),
            records=_records(known, where),
        )
    except InputError as error:
        raise InputError(f"{source}: {error}") from None


def _level(settings: Mapping[str, Any]) -> Level | None:
    given = [key for key in ("pga", "pgv", "sa") if key in settings]
    if len(given) > 1:
        raise InputError(
            f"{given[0]} and {given[1]} are both given; one level of shaking is enough."
        )
    if not given:
        return None
    if given == ["pgv"]:
        return _sensible(
            "pgv", Level(PGV, quantity(settings["pgv"], "m_s", None) * CENTIMETRES_PER_METRE)
        )
    if given == ["pga"]:
        return _sensible("pga", Level(PGA, _in_g(settings["pga"])))
    period, value = settings["sa"]
    measure = read_measure(f"SA({quantity(period, 's', None):g})", "sa")
    return _sensible("sa", Level(measure, _in_g(value)))


def _in_g(text: str) -> float:
    return quantity(text, "m_s2", None) / GRAVITY


def _sensible(key: str, level: Level) -> Level:
    if not 0 < level.value <= HIGHEST[level.measure.kind]:
        raise InputError(
            f"{key}: {level.words} is no shaking of an earthquake; expected more than 0 and at most "
            f"{HIGHEST[level.measure.kind]:g} {level.measure.unit}."
        )
    return level


def _hazard(settings: Mapping[str, Any], folder: Path) -> tuple[HazardCurve, ...]:
    files = settings.get("hazard", [])
    level, years = _level(settings), settings.get("return_period_years")
    if files and years is not None:
        raise InputError("hazard and return_period_years are both given; leave one out.")
    if years is not None:
        if level is None:
            raise InputError("return_period_years: give the level it belongs to, such as pga.")
        return (curve_of_one_level(level.measure, level.value, float(years)),)
    return tuple(read_hazard([folder / file for file in files]))


def _records(settings: Mapping[str, Any], folder: Path) -> Records:
    given = settings.get("records", {})
    return Records(
        paths=tuple(folder / path for path in given.get("paths", [])),
        on_floor=given.get("recorded_on", "ground") == "floor",
        unit=given.get("unit"),
        dt=given.get("dt_s"),
        magnitude=float(settings.get("magnitude", math.nan)),
        distance_km=float(settings.get("distance_km", math.nan)),
    )
