"""What shook the ground of a place: by a ShakeMap, by the record of a station, or as typed.

Each way gives a :class:`GroundShaking`: PGA and PGV as the geometric mean of two components, with the standard
deviations of their logarithms, from which :func:`level_of` makes the level at which ``rockfrag assess`` asks.
Theory: ``docs/after.md``, "What shook the place".
"""

import math
import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from rockfrag.aftermath.shakemap import ShakeMap
from rockfrag.assess.hazard.curve import PGA, PGV
from rockfrag.assess.request import Level, LevelSpread
from rockfrag.base.errors import InputError
from rockfrag.motions.catalogued import motions_of_files
from rockfrag.records.motion import Motion
from rockfrag.words.findings import Value

CORRELATION = 0.73
"""Correlation of what ln PGA and ln PGV of an earthquake at a place differ by from a prediction [-] (Bradley 2012,
Earthq. Spectra 28: 17)."""

WITHIN_EARTHQUAKE = {"PGA": 0.495, "PGV": 0.552}
"""Standard deviation of ln between places in one earthquake, at magnitudes above 5.5 [-] (Boore and others 2014,
Earthq. Spectra 30: 1057)."""

RANGE_KM = {"PGA": 8.5, "PGV": 25.7}
"""Distance at which places in one earthquake no longer shake alike [km] (Jayaram and Baker 2009, Earthq. Eng.
Struct. Dyn. 38: 1687, ground that varies; of PGV that of Sa(1 s))."""


@dataclass(frozen=True)
class GroundShaking:
    """Shaking of the ground at a place in one earthquake.

    Attributes
    ----------
    pga, pgv : medians of the geometric mean of both components [g; cm/s]; NaN where not known
    pga_spread, pgv_spread : standard deviations of their logarithms [-]
    magnitude, distance_km : of the earthquake; NaN where not known
    source : where it is from, as it is said
    """

    pga: float
    pgv: float
    pga_spread: float = 0.0
    pgv_spread: float = 0.0
    magnitude: float = math.nan
    distance_km: float = math.nan
    source: Value = ""


def level_of(ground: GroundShaking) -> Level:
    """Level at which an object is assessed: PGA with the PGV that came with it, or the one that is known.

    Parameters
    ----------
    ground : what shook the ground

    Returns
    -------
    The level, with how well it is known.
    """
    if math.isnan(ground.pga):
        return Level(PGV, ground.pgv, spread=LevelSpread(ground.pgv_spread))
    if math.isnan(ground.pgv):
        return Level(PGA, ground.pga, spread=LevelSpread(ground.pga_spread))
    spread = LevelSpread(ground.pga_spread, ground.pgv_spread, CORRELATION)
    return Level(PGA, ground.pga, ground.pgv, spread=spread)


def mapped_ground(
    shakemap: ShakeMap, latitude: float, longitude: float
) -> GroundShaking | None:
    """Shaking of a place by a ShakeMap.

    Parameters
    ----------
    shakemap : the map
    latitude, longitude : of the place [degrees]

    Returns
    -------
    The shaking; None outside of the map.
    """
    found = shakemap.at(latitude, longitude)
    if found is None or not {"PGA", "PGV"} & set(found.values):
        return None
    return GroundShaking(
        found.values.get("PGA", math.nan),
        found.values.get("PGV", math.nan),
        found.spreads.get("PGA", 0.0),
        found.spreads.get("PGV", 0.0),
        magnitude=shakemap.magnitude,
        distance_km=distance_km(shakemap.epicentre, (latitude, longitude)),
        source=shakemap.title,
    )


def recorded_ground(
    records: Sequence[str | os.PathLike[str]],
    away_km: float = 0.0,
    *,
    unit: str | None = None,
    dt: float | None = None,
) -> tuple[GroundShaking, tuple[Motion, ...]]:
    """Shaking of a place by the record of a station.

    Parameters
    ----------
    records : files of the record, or of each of its components
    away_km : distance of the station from the place [km]
    unit, dt : unit and sampling interval [s] of files that do not state theirs

    Returns
    -------
    The shaking, and the horizontal components of the record [m/s²]: one or two.
    """
    motions: list[Motion] = []
    for path in records:
        motions += motions_of_files(Path(path), unit, dt)[0]
    if not 1 <= len(motions) <= 2:
        names = ", ".join(motion.name for motion in motions)[:200]
        raise InputError(
            f"{records[0]}: expected one or two horizontal components of one station, found {len(motions)} "
            f"({names})."
        )
    ground = GroundShaking(
        _middle([PGA.of_motion(each) for each in motions]),
        _middle([PGV.of_motion(each) for each in motions]),
        _away("PGA", away_km),
        _away("PGV", away_km),
        source=f"record {motions[0].name}",
    )
    return ground, tuple(motions)


def _middle(values: Sequence[float]) -> float:
    """Geometric mean."""
    return math.exp(sum(map(math.log, values)) / len(values))


def _away(measure: str, km: float) -> float:
    """Standard deviation of ln between a place and a station so far away."""
    alike = math.exp(-3.0 * km / RANGE_KM[measure])
    return WITHIN_EARTHQUAKE[measure] * math.sqrt(2.0 * (1.0 - alike))


EARTH_RADIUS_KM = 6371.0


def distance_km(place: tuple[float, float], other: tuple[float, float]) -> float:
    """Distance on the ground between two places by latitude and longitude [degrees].

    Parameters
    ----------
    place, other : the places

    Returns
    -------
    The distance [km]; NaN where a coordinate is not known.
    """
    north, north_of_other = math.radians(place[0]), math.radians(other[0])
    across = math.sin(math.radians(other[1] - place[1]) / 2) ** 2
    half = math.sin((north_of_other - north) / 2) ** 2
    half += math.cos(north) * math.cos(north_of_other) * across
    return 2 * EARTH_RADIUS_KM * math.asin(math.sqrt(min(half, 1.0)))
