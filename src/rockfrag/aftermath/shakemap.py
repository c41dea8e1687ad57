"""ShakeMaps: the ground shaking that a network mapped after an earthquake, with how well it is known.

In goes ``grid.xml`` of the USGS or of a network that runs its program, and, where it is given, ``uncertainty.xml``
beside it; out comes :class:`ShakeMap`, which says the shaking at a place. A grid has a line a point, with the
columns that its ``grid_field`` elements name: longitude, latitude, PGA and PSA [% g], PGV [cm/s], and the standard
deviations of their logarithms, of which ``grid.xml`` has at most that of PGA (ShakeMap Manual, "XML Grid").

Values of a grid are the larger of two horizontal components, levels of this package the geometric mean of both,
or one of them: :data:`LARGER_OF_TWO`. Theory: ``docs/after.md``, "What shook the place".
"""

import io
import math
import os
import zipfile
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from xml.etree import ElementTree as ET

import numpy as np

from rockfrag.base.arrays import Floats
from rockfrag.base.errors import InputError
from rockfrag.base.units import GRAVITY

LARGER_OF_TWO = 1.1
"""Larger of two horizontal components over their geometric mean, of PGA and PGV [-] (Beyer and Bommer 2006, Bull.
Seismol. Soc. Am. 96: 1512)."""

MOST_BYTES = 512 * 2**20  # Of a grid as text
OF_ACCELERATION = {
    **dict.fromkeys(("pctg", "%g", "pct g", "percent g"), 0.01),
    "g": 1.0,
    **dict.fromkeys(("gal", "cm/s2", "cm/s^2", "cm/s²"), 0.01 / GRAVITY),
    **dict.fromkeys(("m/s2", "m/s^2", "m/s²"), 1.0 / GRAVITY),
}
OF_VELOCITY = {**dict.fromkeys(("cms", "cm/s", "cm/sec"), 1.0), "m/s": 100.0}
"""Factors to g and cm/s."""

RATIO = (0.0004, 0.15)
"""Least and largest PGA over PGV of a map, in the middle of its strongest tenth of points [g s/cm]; beyond, a unit
is not what it is said to be. Far from a large earthquake PGA is 0.0008 g for each cm/s, near a small one 0.03."""

MEASURES = ("PGA", "PGV", "PSA03", "PSA10", "PSA30")

UNKNOWN_SPREAD = {"PGA": 0.65, "PGV": 0.65}
"""Standard deviation of ln where a grid states none [-]: that of a prediction without stations (Boore and others
2014, Earthq. Spectra 30: 1057)."""


@dataclass(frozen=True)
class MappedShaking:
    """Shaking that a map gives at a place: medians, and standard deviations of their logarithms.

    Attributes
    ----------
    values : median of each measure that the map has [g; PGV cm/s], the geometric mean of two components
    spreads : standard deviation of its logarithm [-]
    stated : measures of which the map itself states the standard deviation
    """

    values: Mapping[str, float]
    spreads: Mapping[str, float]
    stated: frozenset[str]


@dataclass(frozen=True, eq=False)
class ShakeMap:
    """A grid of shaking.

    Attributes
    ----------
    name : what the earthquake is called
    identifier : of the earthquake
    version : number of the map
    magnitude : of the earthquake; NaN where not stated
    epicentre : latitude and longitude [degrees]
    is_scenario : whether it maps an earthquake that did not happen
    longitudes, latitudes : of the points, rising, shape (columns,) and (rows,) [degrees]
    layers : logarithm of each measure [ln g; PGV ln cm/s], and each standard deviation by the name ``STD…``,
        shape (rows, columns)
    usual_spreads : standard deviation of each measure over the whole map, where it is stated
    """

    name: str
    identifier: str
    version: str
    magnitude: float
    epicentre: tuple[float, float]
    is_scenario: bool
    longitudes: Floats
    latitudes: Floats
    layers: Mapping[str, Floats]
    usual_spreads: Mapping[str, float] = field(default_factory=dict)

    @property
    def title(self) -> str:
        """What the map is called: its earthquake, its version, and whether that happened."""
        kind = "ShakeMap scenario" if self.is_scenario else "ShakeMap"
        version = f", version {self.version}" if self.version else ""
        return f"{kind} {self.name} ({self.identifier}{version})"

    def at(self, latitude: float, longitude: float) -> MappedShaking | None:
        """Shaking at a place, between points of the grid linear in its logarithm; None outside of the grid.

        Parameters
        ----------
        latitude, longitude : of the place [degrees]
        """
        # a map across 180° may count beyond it
        middle = float(self.longitudes.mean())
        longitude += 360.0 * round((middle - longitude) / 360.0)
        row = _between(self.latitudes, latitude)
        column = _between(self.longitudes, longitude)
        if row is None or column is None:
            return None
        found = {
            name: _bilinear(layer, row, column) for name, layer in self.layers.items()
        }
        known = [name for name in MEASURES if math.isfinite(found.get(name, math.nan))]
        if not known:
            return None
        values = {name: math.exp(found[name]) / LARGER_OF_TWO for name in known}
        stated = {
            name: spread
            for name in known
            if (spread := found.get(f"STD{name}", math.nan)) > 0
        }
        spreads = {name: stated.get(name, self._spread(name)) for name in known}
        return MappedShaking(values, spreads, frozenset(stated))

    def _spread(self, name: str) -> float:
        """Standard deviation of ln where no point states one."""
        of_map = self.usual_spreads.get(name, 0.0)
        return of_map if of_map > 0 else UNKNOWN_SPREAD.get(name, 0.7)


def read_shakemap(
    path: str | os.PathLike[str], uncertainty: str | os.PathLike[str] | None = None
) -> ShakeMap:
    """Read a ShakeMap.

    Parameters
    ----------
    path : ``grid.xml``, or a zip file with it
    uncertainty : ``uncertainty.xml`` of the same map, or a zip file with it; None where there is none

    Returns
    -------
    The map.

    Raises
    ------
    InputError
        If a file is no grid, is cut off, or the two are not of one map.
    """
    root, layers, longitudes, latitudes = _read_grid(str(path))
    if not {"PGA", "PGV"} & set(layers):
        raise InputError(
            f"{path}: the grid has neither PGA nor PGV; give grid.xml of the ShakeMap."
        )
    _check_units(layers, path)
    source = next(_named(root, "event"), ET.Element("event"))
    if uncertainty is not None:
        other_root, others, *place = _read_grid(str(uncertainty))
        same = [mine.shape == its.shape and np.allclose(mine, its, atol=1e-3)
                for mine, its in zip((longitudes, latitudes), place, strict=True)]  # fmt: skip
        if not all(same) or root.get("event_id") != other_root.get("event_id"):
            raise InputError(
                f"{uncertainty}: is not of the map of {path}; give both files of one version of one ShakeMap."
            )
        layers |= {name: layer for name, layer in others.items() if name[:3] == "STD"}
    return ShakeMap(
        name=source.get("event_description", "").strip() or root.get("event_id", ""),
        identifier=root.get("event_id", ""),
        version=root.get("shakemap_version", ""),
        magnitude=_number(source, "magnitude"),
        epicentre=(_number(source, "lat"), _number(source, "lon")),
        is_scenario=root.get("shakemap_event_type", "").upper() == "SCENARIO",
        longitudes=longitudes,
        latitudes=latitudes,
        layers=layers,
        usual_spreads={
            each.get("name", "").upper(): _number(each, "value")
            for each in _named(root, "event_specific_uncertainty")
        },
    )


def _read_grid(path: str) -> tuple[ET.Element, dict[str, Floats], Floats, Floats]:
    """Read a grid; return its root, its layers by name, and longitudes and latitudes of its points, both rising.

    Layers are ln of measures and standard deviations of these, shape (latitudes, longitudes).
    """
    text = _text_of(path)
    head = text[:4096]
    if "<!DOCTYPE" in head or "<!ENTITY" in text[:65536]:
        raise InputError(
            f"{path}: has a document type, which no grid needs; remove it."
        )
    try:
        root = ET.fromstring(text)
    except (ET.ParseError, ValueError) as error:
        raise InputError(
            f"{path}: is no well-formed XML ({error}); was it downloaded whole?"
        ) from None
    if root.tag.rpartition("}")[2] != "shakemap_grid":
        raise InputError(
            f"{path}: is no grid of a ShakeMap; give grid.xml from its downloads."
        )
    columns, rows = _points(root, path)
    names = set(columns)
    if not {"LON", "LAT"} <= names:
        raise InputError(f"{path}: the grid has no columns LON and LAT.")
    rows, lattice = _in_order(root, rows, (columns["LON"][0], columns["LAT"][0]), path)
    placed = {name: rows[:, at].reshape(lattice) for name, (at, _) in columns.items()}
    longitudes = placed.pop("LON").mean(axis=0)
    latitudes = placed.pop("LAT").mean(axis=1)
    layers = {}
    units = _units(columns)
    for name, layer in placed.items():
        measure = name.removeprefix("STD")
        if measure not in MEASURES:
            continue
        if name == measure:
            with np.errstate(divide="ignore", invalid="ignore"):
                layer = np.log(layer * _factor(name, units[name], path))
        elif "log10" in columns[name][1].lower():
            layer = layer * math.log(10.0)
        layers[name] = layer
    return root, layers, longitudes, latitudes


def _check_units(layers: Mapping[str, Floats], path: str | os.PathLike[str]) -> None:
    """Hold accelerations against velocities: a map in g that says % g is not believed."""
    if not {"PGA", "PGV"} <= set(layers):
        return
    ratios = layers["PGA"] - layers["PGV"]
    known = np.isfinite(ratios)
    if not known.any():
        return
    strong = layers["PGV"] >= np.quantile(layers["PGV"][known], 0.9)
    middle = math.exp(np.median(ratios[known & strong]))
    if not RATIO[0] <= middle <= RATIO[1]:
        raise InputError(
            f"{path}: PGA is {middle:.2g} g for each cm/s of PGV, which no earthquake has; the unit of one "
            "is not what the grid says."
        )


def _text_of(path: str) -> str:
    """Text of a grid, out of a zip file where it is in one."""
    try:
        data = Path(path).read_bytes()
        if data[:2] == b"PK":
            data = _unzipped(data, path)
    except OSError as error:
        raise InputError(
            f"{path}: cannot be read ({error.strerror}); check the path."
        ) from error
    if len(data) > MOST_BYTES:
        raise InputError(f"{path}: is larger than {MOST_BYTES // 2**20} MiB.")
    return data.decode("utf-8", errors="replace").lstrip("\ufeff \r\n\t")


def _unzipped(data: bytes, path: str) -> bytes:
    """The one .xml in a zip file."""
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            inside = [
                each for each in archive.infolist() if each.filename.endswith(".xml")
            ]
            if len(inside) != 1 or inside[0].file_size > MOST_BYTES:
                raise InputError(
                    f"{path}: expected a zip file with one .xml, found {len(inside)} of them."
                )
            return archive.read(inside[0])
    except (zipfile.BadZipFile, RuntimeError, EOFError) as error:
        raise InputError(f"{path}: is no whole zip file ({error}).") from None


def _points(root: ET.Element, path: str) -> tuple[dict[str, tuple[int, str]], Floats]:
    """Column and unit of each field of a grid by its name, and all points, shape (points, fields)."""
    try:
        fields = {
            each.get("name", "").strip().upper(): (
                int(each.get("index", "")) - 1,
                each.get("units", "").strip(),
            )
            for each in _named(root, "grid_field")
        }
    except ValueError:
        raise InputError(
            f"{path}: a grid_field has no whole number as index."
        ) from None
    data = next(_named(root, "grid_data"), None)
    words = ((data.text if data is not None else "") or "").split()
    if not fields or not words or len(words) % len(fields):
        raise InputError(
            f"{path}: {len(words)} numbers do not fill lines of {len(fields)} fields; was it downloaded whole?"
        )
    if sorted(at for at, _ in fields.values()) != list(range(len(fields))):
        raise InputError(f"{path}: the fields are not numbered from 1 on, each once.")
    try:
        numbers = np.array(words, dtype=np.float64)
    except ValueError as error:
        raise InputError(
            f"{path}: the grid holds what is no number ({error})."
        ) from None
    return fields, numbers.reshape(-1, len(fields))


def _in_order(
    root: ET.Element, rows: Floats, at: tuple[int, int], path: str
) -> tuple[Floats, tuple[int, int]]:
    """Points from south to north and in each row from west to east, with the numbers of rows and columns.

    They may stand in any order, and a map across 180° may count from -180° on again; they must fill a lattice.
    ``rows``: points, shape (points, fields); ``at``: columns of longitude and latitude.
    """
    about = next(_named(root, "grid_specification"), ET.Element("none"))
    places = rows[:, list(at)]
    if not (np.isfinite(places).all() and (abs(places) <= (360, 90)).all()):
        raise InputError(
            f"{path}: LON and LAT are no degrees; give a grid in longitude and latitude."
        )
    if np.ptp(places[:, 0]) > 180:
        rows = rows.copy()
        rows[:, at[0]] %= 360.0
    # how finely points are written, far below the distance between two of them
    longitudes, latitudes = rows[:, list(at)].round(4).T
    shape = np.unique(latitudes).size, np.unique(longitudes).size
    stated = _number(about, "nlat"), _number(about, "nlon")
    if (
        shape[0] * shape[1] != len(rows)
        or min(shape) < 2
        or (math.isfinite(sum(stated)) and stated != shape)
    ):
        raise InputError(
            f"{path}: expected {stated[1]:g} × {stated[0]:g} points, found {len(rows)} that make {shape[1]} × "
            f"{shape[0]}; was it downloaded whole?"
        )
    order = np.lexsort((longitudes, latitudes))
    along = (longitudes[order].reshape(shape), latitudes[order].reshape(shape).T)
    if any(np.ptp(places, axis=0).max() > 0 for places in along):
        raise InputError(
            f"{path}: the points of the grid do not fill rows and columns."
        )
    return rows[order], shape


def _units(columns: Mapping[str, tuple[int, str]]) -> dict[str, str]:
    """Unit of each measure of a grid.

    The library that cuts maps for other programs of the USGS states none at all; they are those of every map then,
    which PGA and PGV are held against (:func:`_check_units`).
    """
    units = {name: columns[name][1] for name in MEASURES if name in columns}
    if {"PGA", "PGV"} <= set(units) and not any(units.values()):
        return {name: "cms" if name == "PGV" else "pctg" for name in units}
    return units


def _factor(measure: str, unit: str, path: str) -> float:
    """Factor from a map's unit of a measure to g or cm/s."""
    units = OF_VELOCITY if measure == "PGV" else OF_ACCELERATION
    if unit.lower() not in units:
        raise InputError(
            f"{path}: {measure} is in {unit or 'no unit'}; expected one of {', '.join(units)}."
        )
    return units[unit.lower()]


def _named(root: ET.Element, name: str) -> Iterator[ET.Element]:
    """Children of an element that have a name, in any namespace."""
    return (each for each in root if each.tag.rpartition("}")[2] == name)


def _number(element: ET.Element, name: str) -> float:
    """A number among the attributes of an element, NaN where it is none."""
    try:
        return float(element.get(name, ""))
    except ValueError:
        return math.nan


def _between(points: Floats, value: float) -> tuple[int, float] | None:
    """Number of the point before a value, and the part of the way to the next [-]; None outside of all of them.

    ``points``: rising, shape (n,).
    """
    if not points[0] <= value <= points[-1]:
        return None
    at = min(int(points.searchsorted(value, side="right")) - 1, points.size - 2)
    return at, float((value - points[at]) / (points[at + 1] - points[at]))


def _bilinear(
    layer: Floats, row: tuple[int, float], column: tuple[int, float]
) -> float:
    """Value between four points, of which those without one do not count."""
    (i, along), (j, across) = row, column
    corners = layer[i : i + 2, j : j + 2]
    weights = np.outer((1 - along, along), (1 - across, across))
    counts = np.isfinite(corners) & (weights > 0)
    if not counts.any():
        return math.nan
    return float((weights[counts] * corners[counts]).sum() / weights[counts].sum())
