"""A hazard curve: how often each level of shaking is exceeded at a site, and how files say so.

The kind of a file is recognised from its content; several files become one curve, the mean with its quantiles.

In: text of a file, or points. Out: a curve, levels in the unit of its measure and annual rates [1/a].
Docs: ``docs/assess.md``, "How likely, and what to do".
"""

import csv
import io
import json
import math
import os
import re
import xml.etree.ElementTree as ET
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from rockfrag.assess.core.estimates import rate_of
from rockfrag.assess.core.hazards import fill_level, fill_power_law
from rockfrag.base.arrays import Floats
from rockfrag.base.errors import InputError
from rockfrag.base.short_repr import short_repr
from rockfrag.base.tabular import Row, read_table
from rockfrag.base.text_files import read_text
from rockfrag.base.units import CENTIMETRES_PER_METRE, GRAVITY, quantity
from rockfrag.motions.intensity import IntensityMeasure, declared

# Beyond, a curve is in another unit: g, g, cm/s
HIGHEST = {"PGA": 10.0, "SA": 30.0, "PGV": 2000.0}

# Shaking that is exceeded more often a year is no earthquake hazard [1/year]
HIGHEST_RATE = 100.0

DAMAGING = {"PGA": 0.02, "SA": 0.02, "PGV": 1.0}
"""A curve that ends below this level says nothing about what topples: g, g and cm/s."""

# Exponent k of H ~ a^-k where one point is known (EN 1998-1:2004, note to 2.1(4))
EC8_SLOPE = 3.0

# Standard deviation of that exponent: 2 to 4 are seen in Europe and America
EC8_SLOPE_SD = 0.6

# Quantiles of a level continued with exponents a standard deviation away
FLANKS = (0.16, 0.84)


@dataclass(frozen=True, eq=False)
class HazardCurve:
    """Annual rates with which levels of a measure are exceeded; a power law between the points.

    Attributes
    ----------
    measure : the intensity measure
    levels : levels in the measure's unit, rising, shape (n,), n ≥ 2
    rates : annual rates of exceedance [1/year], falling, shape (n,)
    source : where it comes from, in a few words
    quantiles : curves of the same measure by their quantile, such as 0.16 and 0.84
    is_read : whether it was read; False where one level was continued with an assumed slope
    """

    measure: IntensityMeasure
    levels: Floats
    rates: Floats
    source: str
    quantiles: dict[float, "HazardCurve"] = field(default_factory=dict)
    is_read: bool = True

    __repr__ = short_repr

    def rate(self, level: ArrayLike) -> Floats:
        """Annual rate with which levels above 0 are exceeded [1/year]; the ends are continued as they slope."""
        given = np.asarray(level, dtype=np.float64)
        start = np.clip(
            np.searchsorted(self.levels, given) - 1, 0, self.levels.size - 2
        )
        away = np.log(given) - np.log(self.levels[start])
        return np.asarray(
            np.exp(np.log(self.rates[start]) + self._slopes[start] * away)
        )

    def level(self, rate: float) -> float:
        """Level that is exceeded with an annual rate [1/year], in the measure's unit."""
        found = np.zeros(1)
        fill_level(self.levels, self.rates, float(rate), found)
        return float(found[0])

    @property
    def _slopes(self) -> Floats:
        """Slope of ln rate over ln level between points, shape (n - 1,)."""
        return np.asarray(np.diff(np.log(self.rates)) / np.diff(np.log(self.levels)))


def rate_weights(curve: HazardCurve, levels: Floats) -> Floats:
    """Weights with which a function linear in ln level is integrated over a hazard curve.

    ∫ P(x) |dν(x)| from the first level on, where ν is a power law between levels and P stays as it is above the
    last one, is the sum of P at the levels times these weights.

    Parameters
    ----------
    curve : the hazard curve ν [1/year]
    levels : rising, shape (n,), n ≥ 2

    Returns
    -------
    The weights [1/year], shape (n,).
    """
    rate = curve.rate(levels)
    fall = -np.diff(np.log(rate))
    # mean of ν over a piece in ln x, (ν0 - ν1) / ln(ν0/ν1)
    mean = rate[:-1] * np.where(
        fall > 1e-12, -np.expm1(-fall) / np.maximum(fall, 1e-300), 1.0
    )
    weights = np.zeros(levels.size)
    weights[:-1] += rate[:-1] - mean
    weights[1:] += mean - rate[1:]
    weights[-1] += rate[-1]
    return weights


def make_curve(
    measure: IntensityMeasure, levels: ArrayLike, rates: ArrayLike, where: str
) -> HazardCurve:
    """Make a curve of levels and rates of a file, or say in one sentence what is wrong with it.

    Points that are never exceeded, and equal rates at either end, which are those of a probability that was
    rounded, are left out.

    Parameters
    ----------
    measure : of which the levels are
    levels, rates : in the unit of the measure, rising, and annual [1/year], shape (n,)
    where : of messages, and the source of the curve

    Returns
    -------
    The :class:`HazardCurve`.

    Raises
    ------
    InputError : where they are no hazard curve
    """
    x, y = np.asarray(levels, dtype=np.float64), np.asarray(rates, dtype=np.float64)
    if x.size != y.size:
        raise InputError(
            f"{where}: {x.size} levels have {y.size} rates; give one rate a level."
        )
    if not np.isfinite(x).all() or np.isnan(y).any():
        raise InputError(
            f"{where}: a level or a rate of the hazard curve is not a finite number."
        )
    if (y < 0).any() or (np.isfinite(y) & (y > HIGHEST_RATE)).any():
        raise InputError(
            f"{where}: rates of exceedance must lie from 0 to {HIGHEST_RATE:g} a year, found "
            f"{y[(y < 0) | (y > HIGHEST_RATE)][0]:g}; check the column and the investigation time."
        )
    if (x < 0).any() or (np.diff(x) <= 0).any():
        raise InputError(
            f"{where}: the levels of the hazard curve must rise from above 0."
        )
    if (np.diff(y[np.isfinite(y)]) > 0).any():
        raise InputError(
            f"{where}: the rate of exceedance rises with the level, which no hazard curve does; check the columns."
        )
    kept = (x > 0) & np.isfinite(y) & (y > 0)
    x, y = x[kept], y[kept]
    # of equal neighbours the highest level says most
    last = np.append(np.diff(y) < 0, True)[: y.size]
    x, y = x[last], y[last]
    if x.size < 2:
        raise InputError(
            f"{where}: the hazard curve has {x.size} usable point(s); at least two levels with different rates "
            "above 0 are needed."
        )
    least, most = DAMAGING[measure.openquake], HIGHEST[measure.openquake]
    if x[-1] > most or x[-1] < least:
        raise InputError(
            f"{where}: {measure.imt} up to {x[-1]:g} {measure.unit} is not the shaking that a hazard curve "
            f"reaches ({least:g} to {most:g} {measure.unit}); check the unit."
        )
    return HazardCurve(measure, x, y, where)


def rates_of(poes: Sequence[float], years: float, where: str) -> Floats:
    """Annual rates of probabilities of exceedance in some years, by Poisson's law; infinite for 1.

    Parameters
    ----------
    poes : probabilities [-], n of them
    years : investigation time
    where : of messages

    Returns
    -------
    The rates [1/year], shape (n,).
    """
    if not (math.isfinite(years) and years > 0):
        raise InputError(
            f"{where}: the investigation time must be above 0 years, found {years:g}."
        )
    p = np.asarray(poes, dtype=np.float64)
    if np.isnan(p).any() or (p < 0).any() or (p > 1).any():
        wrong = p[~((p >= 0) & (p <= 1))][0]
        raise InputError(
            f"{where}: {wrong:g} is no probability of exceedance from 0 to 1."
        )
    rates = [rate_of(each, float(years)) if each < 1 else math.inf for each in p]
    return np.asarray(rates, dtype=np.float64)


def curve_of_one_level(
    measure: IntensityMeasure, level: float, years: float
) -> HazardCurve:
    """Continue one level with its mean return period as a power law.

    Parameters
    ----------
    measure, level : the measure, and the level in its unit
    years : mean return period [years]

    Returns
    -------
    The curve, with quantiles by exponents a standard deviation away.
    """

    def curve(k: float, source: str) -> HazardCurve:
        """Curve with the exponent k."""
        levels, rates = np.zeros(3), np.zeros(3)
        fill_power_law(float(level), float(years), k, levels, rates)
        return HazardCurve(measure, levels, rates, source, is_read=False)

    source = (
        f"{measure.imt} of {level:.3g} {measure.unit} every {years:g} years, continued with the exponent "
        f"{EC8_SLOPE:g} of EN 1998-1"
    )
    flanks = {FLANKS[0]: EC8_SLOPE + EC8_SLOPE_SD, FLANKS[1]: EC8_SLOPE - EC8_SLOPE_SD}
    main = curve(EC8_SLOPE, source)
    main.quantiles.update({q: curve(k, source) for q, k in flanks.items()})
    return main


PERIODS = (0.01, 10.0)  # Periods of Sa that hazard models cover [s]

VELOCITY_PER_G = GRAVITY * CENTIMETRES_PER_METRE
"""PGV over (a measure in g times PGV over it): cm/s for g and s."""

_SA = re.compile(
    r"(?:P?SA)\s*[(\[_]?\s*T?=?\s*(\d*[.P]?\d+)\s*S?\s*[)\]]?", re.IGNORECASE
)


_KNOWN = {measure.openquake: measure for measure in declared()}
PGA, PGV, SA = _KNOWN["PGA"], _KNOWN["PGV"], _KNOWN["SA"]


def read_measure(text: str, where: str) -> IntensityMeasure:
    """Read the name of a measure as hazard models write it.

    Parameters
    ----------
    text : ``PGA``, ``SA(0.3)``, ``SA0P2``, ``PSA-1.0s`` or alike
    where : what messages begin with

    Returns
    -------
    The measure.
    """
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


SA_1S = read_measure("SA(1)", "SA(1)")


def read_level(text: str, measure: IntensityMeasure) -> float:
    """Read a level with its unit.

    Parameters
    ----------
    text : such as ``0.25 g``
    measure : of which it is a level

    Returns
    -------
    The level in the unit of the measure.
    """
    if measure.openquake == "PGV":
        return quantity(text, "m_s", None) * CENTIMETRES_PER_METRE
    return quantity(text, "m_s2", None) / GRAVITY


LARGEST_FILE = 50_000_000  # Bytes of a hazard file; that of one site has some thousand


class Found(NamedTuple):
    """A curve that a file holds."""

    curve: HazardCurve
    statistic: str  # such as ``mean`` or ``quantile-0.16``; empty for the only one


def read_hazard(paths: Sequence[str | os.PathLike[str]]) -> list[HazardCurve]:
    """Read the hazard curves of one site.

    Parameters
    ----------
    paths : files: OpenQuake's CSV or NRML, EFEHR's or the USGS's answer, or tables of levels and rates; those of
        a mean and of quantiles of one measure belong together, and one curve given twice is an InputError

    Returns
    -------
    A curve for each measure, with its quantiles.
    """
    found: dict[str, dict[str, HazardCurve]] = {}
    for path in map(str, paths):
        text = read_text(path, LARGEST_FILE)
        for curve, kind in _reader(text)(text, path):
            named = found.setdefault(curve.measure.imt, {})
            statistic = _statistic(kind, path)
            if statistic in named:
                raise InputError(
                    f"{path}: {curve.measure.imt} ({statistic}) is given twice, in {named[statistic].source} "
                    "too; leave one out."
                )
            named[statistic] = curve
    return [_assembled(name, named) for name, named in found.items()]


def _reader(text: str) -> Callable[[str, str], Sequence[Found]]:
    """Return the function that reads the kind of file that a text is of, of its text and its path.

    What is no other kind may be a table, whose reader says what it lacks.
    """
    start = text.lstrip()
    if start.startswith("<"):
        return _read_nrml
    if start.startswith(("{", "[")):
        return _read_usgs
    if "poe-" in text[:20_000] and start.startswith(
        ("#", '"#', "lon", "custom_site_id")
    ):
        return lambda text, path: [read_openquake(text, path)]
    return _read_levels


def _statistic(kind: str, where: str) -> str:
    """A statistic as ``mean`` or ``quantile-0.16``, which may be ``quantile_curve-0.5``; branches are refused."""
    if kind in ("", "mean"):
        return "mean"
    quantile = re.fullmatch(r"quantile\D*?(0?\.\d+)", kind)
    if quantile:
        return f"quantile-{float(quantile[1]):g}"
    raise InputError(
        f"{where}: the curve is of the kind {kind[:40]!r}; give the mean and the quantiles of the hazard model, "
        "not single branches or deviations."
    )


def _assembled(name: str, named: Mapping[str, HazardCurve]) -> HazardCurve:
    """Put the quantiles of one measure to its mean; the median stands in for a mean that is not there."""
    quantiles = {
        float(statistic.removeprefix("quantile-")): curve
        for statistic, curve in named.items()
        if statistic != "mean"
    }
    main = named.get("mean", quantiles.get(0.5))
    if main is None:
        raise InputError(
            f"{next(iter(named.values())).source}: only {', '.join(sorted(named))} of {name} is given; give the "
            "mean or the median curve too."
        )
    return replace(
        main, quantiles={q: c for q, c in sorted(quantiles.items()) if q != 0.5}
    )


def read_openquake(text: str, path: str) -> Found:
    """Read OpenQuake's export as CSV: the one curve of a file with one site, and its kind.

    A comment with ``kind``, ``investigation_time`` and ``imt``, a header ``lon,lat,depth,poe-0.0050000,…``
    whose names hold the levels (g; cm/s for PGV), and a row of probabilities of exceedance for each site.

    Parameters
    ----------
    text : of the file
    path : which messages name

    Returns
    -------
    The curve and its kind, such as ``mean``.
    """
    try:
        rows = [
            row
            for row in csv.reader(io.StringIO(text))
            if any(cell.strip() for cell in row)
        ]
    except csv.Error as error:
        raise InputError(f"{path}: it is damaged as a table ({error}).") from None
    comment = ",".join(rows[0]) if rows[0][0].lstrip().startswith("#") else ""
    facts = dict(re.findall(r"(\w+)='?([^',\"]+)'?", comment))
    missing = [name for name in ("investigation_time", "imt") if name not in facts]
    if missing:
        raise InputError(
            f"{path}: the first line does not state {missing[0]}; give the file as OpenQuake exported it."
        )
    header, *sites = rows[1:] or [[]]
    columns = {
        i: found[1]
        for i, name in enumerate(header)
        if (found := re.fullmatch(r"poe-([0-9.eE+-]+)", name))
    }
    if len(sites) != 1 or not columns:
        raise InputError(
            f"{path}: found {len(sites)} sites with {len(columns)} levels; leave the row of one site."
        )
    if len(sites[0]) != len(header):
        raise InputError(
            f"{path}: the row has {len(sites[0])} cells, its header {len(header)}."
        )
    try:
        levels = [float(level) for level in columns.values()]
        poes = [float(sites[0][i]) for i in columns]
        years = float(facts["investigation_time"])
    except ValueError as error:
        raise InputError(
            f"{path}: a level, probability or time is no number ({error})."
        ) from None
    measure = read_measure(facts["imt"], path)
    curve = make_curve(measure, levels, rates_of(poes, years, path), path)
    return Found(curve, facts.get("kind", ""))


def _read_usgs(text: str, path: str) -> list[Found]:
    """Read the answer of the USGS's hazard web services (NSHM) as JSON: the curves of all measures.

    ``response.hazardCurves`` is a list with ``imt`` and ``data``, of which the component ``Total`` has ``values``
    with ``xs`` (levels [g]; PGV [cm/s]) and ``ys`` (annual rates of exceedance). Before 2021 ``response`` was a
    list with ``metadata`` (``imt``, ``xvalues``) and ``data`` (``yvalues``).
    """
    try:
        answer = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise InputError(
            f"{path}: is not whole JSON ({error}); ask the service again."
        ) from None
    try:
        response = answer["response"]
        is_old = isinstance(response, list)
        found = []
        for curve in response if is_old else response["hazardCurves"]:
            total = {part["component"]: part for part in curve["data"]}["Total"]
            about = curve["metadata"] if is_old else curve
            if is_old:
                levels, rates = about["xvalues"], total["yvalues"]
            else:
                levels, rates = total["values"]["xs"], total["values"]["ys"]
            measure = read_measure(str(about["imt"]["value"]), path)
            made = make_curve(measure, _numbers(levels), _numbers(rates), path)
            found.append(Found(made, ""))
    except (KeyError, TypeError, IndexError, OverflowError) as error:
        raise InputError(
            f"{path}: is not an answer of the USGS hazard service with hazard curves "
            f"({type(error).__name__}: {str(error)[:80]})."
        ) from None
    if not found:
        raise InputError(f"{path}: the answer holds no hazard curve.")
    return found


def _numbers(values: Any) -> list[float]:
    """A list of numbers, which nothing else is taken for."""
    if not isinstance(values, list) or any(
        isinstance(value, bool) or not isinstance(value, int | float)
        for value in values
    ):
        raise TypeError("levels and rates are lists of numbers")
    return [float(value) for value in values]


_VERSIONS = (
    (
        "hazardCurveField",
        "IML",
        "poE",
        "a hazardCurveField has no IML, the levels of the curve",
    ),
    ("hazardCurves", "IMLs", "poEs", "the hazardCurves have no IMLs, the levels"),
)
"""Elements of curves, of their levels and of probabilities, and what is said where levels are missing."""


def _read_nrml(text: str, path: str) -> list[Found]:
    """Read hazard curves in NRML: EFEHR's answers (version 0.3) and OpenQuake's export (0.4 and 0.5), of one site.

    In 0.3 a ``hazardCurveField`` has the levels (``IML``) and a node with ``poE``, the time and the period of
    SA stand at ``hazardProcessing``; later versions say it all at ``hazardCurves`` with ``IMLs`` and ``poEs``.
    Levels are in g.
    """
    if "<!DOCTYPE" in text or "<!ENTITY" in text:
        raise InputError(
            f"{path}: has a document type, which no hazard file needs; remove it."
        )
    try:
        root = ET.fromstring(text)
    except (ET.ParseError, ValueError) as error:
        raise InputError(f"{path}: is no well-formed XML ({error}).") from None
    above = next((part.attrib for part in _named(root, "hazardProcessing")), {})
    found = [
        _of_element(curves, above, version, path)
        for version in _VERSIONS
        for curves in _named(root, version[0])
    ]
    if not found:
        raise InputError(
            f"{path}: holds no hazardCurves or hazardCurveField; ask the service for hazard curves, not "
            f"maps or spectra."
        )
    return found


def _of_element(
    curves: ET.Element, above: Mapping[str, str], version: Sequence[str], path: str
) -> Found:
    """Read one element of hazard curves in NRML.

    Parameters
    ----------
    curves : the element
    above : attributes of the elements around it
    version : one of ``_VERSIONS``: names of the element, of its levels and of its probabilities, words without
        levels
    path : which messages name
    """
    _, level, poe, missing = version
    levels = next(_named(curves, level), None)
    if levels is None:
        raise InputError(f"{path}: {missing}.")
    poes = list(_named(curves, poe))
    if len(poes) != 1:
        raise InputError(
            f"{path}: found the curves of {len(poes)} sites; leave that of one."
        )
    about = {**above, **curves.attrib, **levels.attrib}
    years = about.get("investigationTimeSpan", about.get("investigationTime"))
    if years is None:
        raise InputError(
            f"{path}: the investigation time of the probabilities is not stated."
        )
    imt = about.get("IMT", "")
    # the period of SA stands elsewhere
    measure = read_measure(
        f"SA({about.get('saPeriod', '')})" if imt.upper() == "SA" else imt, path
    )
    values = _numbers_in(levels.text, path)
    fractions = _numbers_in(poes[0].text, path)
    times = _numbers_in(years, path)
    if len(times) != 1:
        raise InputError(
            f"{path}: the investigation time is {len(times)} numbers; give one."
        )
    rates = rates_of(fractions, times[0], path)
    return Found(make_curve(measure, values, rates, path), _statistic_of(curves))


def _numbers_in(text: str | None, path: str) -> list[float]:
    """Return the numbers of an element's text."""
    try:
        return [float(word) for word in (text or "").split()]
    except ValueError as error:
        raise InputError(
            f"{path}: a level or probability is no number ({error})."
        ) from None


def _statistic_of(curves: ET.Element) -> str:
    """Return which curve of several an element holds: mean, a quantile, a branch; empty if it is the only one."""
    statistic = curves.get("statistics", "")
    if statistic == "quantile":
        return f"quantile-{curves.get('quantileValue', '')}"
    if not statistic and curves.get("sourceModelTreePath"):
        return "branch of a logic tree"
    return statistic


def _named(root: ET.Element, name: str) -> Iterator[ET.Element]:
    """Elements of a name in any namespace."""
    return (
        element for element in root.iter() if element.tag.rpartition("}")[2] == name
    )


_EXPECTED = (
    "a column of levels (pga_g, pgv_cm_s or such as sa_0_3s_g) and one of annual_rate, return_period_years or "
    "such as poe_50_years"
)
_POE = re.compile(r"poe_(\d+(?:\.\d+)?)_?y(?:ears)?")
_RETURN_PERIOD = re.compile(r"(?:tr|return_period)(?:_(?:years?|yrs?|a|anni))?")
_LEVEL = re.compile(r"(pga|pgv|sa_(\d+(?:_\d+)?)s)_(g|cm_s|m_s|m_s2|cm_s2)")


def _read_levels(text: str, path: str) -> list[Found]:
    """Read a table of levels and rates, whose rows make one curve."""
    rows, curve = read_levels(path, text)
    return [Found(curve(rows, path), "")]


def read_levels(
    path: str | os.PathLike[str], text: str | None = None, labels: Sequence[str] = ()
) -> tuple[list[Row], Callable[[Sequence[Row], str], HazardCurve]]:
    """Read a table of levels and rates, as people write it by hand.

    Beside the columns ``labels`` it has levels, as ``pga_g``, ``pgv_cm_s`` or ``sa_0_3s_g``, and how often they
    are exceeded: ``annual_rate``, ``return_period_years`` or such as ``poe_50_years``.

    Parameters
    ----------
    path : of the table, which messages name
    text : of it, where it was read already
    labels : columns that it has beside

    Returns
    -------
    The rows, and what makes the curve of some of them, whose messages say where it stands.
    """
    table = read_table(path, text)
    titles = [_plain(title) for title in table.titles]
    levels = [title for title in titles if _LEVEL.fullmatch(title)]
    others = [title for title in titles if title not in (*levels, *labels)]
    if len(levels) != 1 or len(others) != 1 or not set(labels) <= set(titles):
        raise InputError(
            f"{path}: expected {', '.join([*labels, _EXPECTED])}; its header has "
            f"{', '.join(titles)[:120] or 'nothing'}."
        )
    (level,), (often,) = levels, others
    measure, factor = _measure_of(level, str(path))

    def curve(rows: Sequence[Row], where: str) -> HazardCurve:
        """Curve of some rows of the table."""
        points = sorted((row.number(level) * factor, row.number(often)) for row in rows)
        rates = _annual_rates(often, [value for _, value in points], where)
        return make_curve(measure, [intensity for intensity, _ in points], rates, where)

    return table.rows(titles), curve


def _plain(title: str) -> str:
    """A title as this table calls it: ``PGA (g)`` is ``pga_g``, ``Tr (anni)`` is ``return_period_years``."""
    words = re.sub(r"[\s()\[\]/]+", "_", title.strip().lower().replace("²", "2")).strip(
        "_"
    )
    return "return_period_years" if _RETURN_PERIOD.fullmatch(words) else words


def _measure_of(title: str, path: str) -> tuple[IntensityMeasure, float]:
    """Return the measure of a title such as ``pga_cm_s2``, and the factor from its unit to that of the measure."""
    found = _LEVEL.fullmatch(title)
    assert found is not None
    name, period, unit = found.groups()
    measure = read_measure(f"SA({period.replace('_', '.')})" if period else name, path)
    try:
        return measure, read_level(f"1 {unit}", measure)
    except InputError:
        raise InputError(
            f"{path}: {title} is no unit of {name.upper()}; use g or cm_s."
        ) from None


def _annual_rates(title: str, values: list[float], path: str) -> list[float]:
    """Annual rates [1/year] of the values of a column whose title says how often levels are exceeded."""
    if title == "annual_rate":
        return values
    if title == "return_period_years":
        if min(values, default=1) <= 0:
            raise InputError(f"{path}: a return period must be above 0 years.")
        return [1 / value for value in values]
    poe = _POE.fullmatch(title)
    if poe:
        return list(rates_of(values, float(poe[1]), path))
    raise InputError(
        f"{path}: column {title[:60]!r} is not known; expected {_EXPECTED}."
    )
