"""A hazard curve: how often each level of shaking is exceeded at a site."""

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from rockfrag.arrays import Floats
from rockfrag.errors import InputError
from rockfrag.motions.intensity import IntensityMeasure, declared
from rockfrag.short_repr import short_repr
from rockfrag.units import CENTIMETRES_PER_METRE, GRAVITY, quantity

HIGHEST = {"PGA": 10.0, "SA": 30.0, "PGV": 2000.0}
"""Levels beyond which a curve is in another unit: g, g and cm/s."""

HIGHEST_RATE = 100.0  # Shaking that is exceeded more often a year is no earthquake hazard [1/year]

DAMAGING = {"PGA": 0.02, "SA": 0.02, "PGV": 1.0}
"""A curve that ends below this level says nothing about what topples: g, g and cm/s."""

EC8_SLOPE = 3.0
"""Exponent of a hazard curve H ~ a^-k of which one point is known (EN 1998-1:2004, note to 2.1(4))."""

EC8_SLOPE_SD = 0.6  # Standard deviation of that exponent: 2 to 4 are seen in Europe and America

FLANKS = (0.16, 0.84)
"""Quantiles that a level continued with the exponents one standard deviation away stands for."""


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
        start = np.clip(np.searchsorted(self.levels, given) - 1, 0, self.levels.size - 2)
        away = np.log(given) - np.log(self.levels[start])
        return np.asarray(np.exp(np.log(self.rates[start]) + self._slopes[start] * away))

    def level(self, rate: float) -> float:
        """Level that is exceeded with an annual rate [1/year], in the measure's unit."""
        logs, x = np.log(self.rates), np.log(self.levels)
        start = int(np.clip(np.searchsorted(-logs, -math.log(rate)) - 1, 0, x.size - 2))
        return float(np.exp(x[start] + (math.log(rate) - logs[start]) / self._slopes[start]))

    @property
    def _slopes(self) -> Floats:
        return np.asarray(np.diff(np.log(self.rates)) / np.diff(np.log(self.levels)))


def rate_weights(curve: HazardCurve, levels: Floats) -> Floats:
    """Weights with which a function linear in ln level is integrated over a hazard curve [1/year], shape (n,).

    ∫ P(x) |dν(x)| from the first of n ≥ 2 rising levels on, where ν is a power law between levels and P stays as
    it is above the last one, is the sum of P at the levels times these weights.
    """
    rate = curve.rate(levels)
    fall = -np.diff(np.log(rate))
    # mean of ν over a piece in ln x, (ν0 - ν1) / ln(ν0/ν1)
    mean = rate[:-1] * np.where(fall > 1e-12, -np.expm1(-fall) / np.maximum(fall, 1e-300), 1.0)
    weights = np.zeros(levels.size)
    weights[:-1] += rate[:-1] - mean
    weights[1:] += mean - rate[1:]
    weights[-1] += rate[-1]
    return weights


def make_curve(
    measure: IntensityMeasure, levels: ArrayLike, rates: ArrayLike, where: str
) -> HazardCurve:
    """Make a curve of levels and rates [1/year] of a file, or say in one sentence what is wrong with it.

    Points that are never exceeded, and equal rates at either end, which are those of a probability that was
    rounded, are left out. ``where`` goes into messages, and is the source.
    """
    x, y = np.asarray(levels, dtype=np.float64), np.asarray(rates, dtype=np.float64)
    if x.size != y.size:
        raise InputError(f"{where}: {x.size} levels have {y.size} rates; give one rate a level.")
    if not np.isfinite(x).all() or np.isnan(y).any():
        raise InputError(f"{where}: a level or a rate of the hazard curve is not a finite number.")
    if (y < 0).any() or (np.isfinite(y) & (y > HIGHEST_RATE)).any():
        raise InputError(
            f"{where}: rates of exceedance must lie from 0 to {HIGHEST_RATE:g} a year, found "
            f"{y[(y < 0) | (y > HIGHEST_RATE)][0]:g}; check the column and the investigation time."
        )
    if (x < 0).any() or (np.diff(x) <= 0).any():
        raise InputError(f"{where}: the levels of the hazard curve must rise from above 0.")
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
    """Annual rates of probabilities of exceedance in some years, by Poisson's law [1/year]; infinite for 1."""
    if not (math.isfinite(years) and years > 0):
        raise InputError(f"{where}: the investigation time must be above 0 years, found {years:g}.")
    p = np.asarray(poes, dtype=np.float64)
    if np.isnan(p).any() or (p < 0).any() or (p > 1).any():
        wrong = p[~((p >= 0) & (p <= 1))][0]
        raise InputError(f"{where}: {wrong:g} is no probability of exceedance from 0 to 1.")
    with np.errstate(divide="ignore"):
        return np.asarray(-np.log1p(-p) / years)


def curve_of_one_level(measure: IntensityMeasure, level: float, years: float) -> HazardCurve:
    """Continue one level with its mean return period [year] as a power law."""

    def curve(k: float, source: str) -> HazardCurve:
        factors = np.array([0.1, 1.0, 10.0])
        rates = factors**-k / years
        return HazardCurve(measure, level * factors, rates, source, is_read=False)

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


def read_level(text: str, measure: IntensityMeasure) -> float:
    """Read a level with its unit, such as ``0.25 g``; return it in the unit of the measure."""
    if measure.openquake == "PGV":
        return quantity(text, "m_s", None) * CENTIMETRES_PER_METRE
    return quantity(text, "m_s2", None) / GRAVITY
