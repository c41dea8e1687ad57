"""A table of levels and rates, as people write it by hand.

Two columns: levels, as ``pga_g``, ``pgv_cm_s`` or ``sa_0_3s_g``, and how often they are exceeded: ``annual_rate``,
``return_period_years`` or such as ``poe_50_years``.
"""

import re

from rockfrag.assess.hazard.curve import HazardCurve, make_curve, rates_of, read_measure
from rockfrag.errors import InputError
from rockfrag.motions.intensity import IntensityMeasure
from rockfrag.tabular import cells_of
from rockfrag.units import GRAVITY

_EXPECTED = (
    "a column of levels (pga_g, pgv_cm_s or such as sa_0_3s_g) and one of annual_rate, return_period_years or "
    "such as poe_50_years"
)
_POE = re.compile(r"poe_(\d+(?:\.\d+)?)_?y(?:ears)?")
_RETURN_PERIOD = re.compile(r"(?:tr|return_period)(?:_(?:years?|yrs?|a|anni))?")
_UNITS = {
    "pgv": {"cm_s": 1.0, "m_s": 100.0},
    "others": {"g": 1.0, "m_s2": 1 / GRAVITY, "cm_s2": 0.01 / GRAVITY},
}
_LEVEL = re.compile(r"(pga|pgv|sa_(\d+(?:_\d+)?)s)_(g|cm_s|m_s|m_s2|cm_s2)")


def read_table(text: str, path: str) -> HazardCurve:
    """Return the curve of a table."""
    lines = cells_of(text, path)
    if len(lines) < 3:
        raise InputError(f"{path}: expected a header and two rows or more, with {_EXPECTED}.")
    (_, header), body = lines[0], lines[1:]
    titles = [_plain(title) for title in header]
    places = [i for i, title in enumerate(titles) if level_column(title)]
    others = [i for i, title in enumerate(titles) if i not in places]
    if len(places) != 1 or len(others) != 1:
        raise InputError(f"{path}: expected {_EXPECTED}; found {', '.join(titles)[:120]}.")
    rows = []
    for line, cells in body:
        if len(cells) != 2:
            raise InputError(f"{path}, line {line}: expected 2 cells, found {len(cells)}.")
        try:
            rows.append((float(cells[places[0]]), float(cells[others[0]])))
        except ValueError as error:
            raise InputError(f"{path}, line {line}: {error}.") from None
    measure, factor = measure_of(titles[places[0]], path)
    rows.sort()
    levels = [level * factor for level, _ in rows]
    rates = annual_rates(titles[others[0]], [value for _, value in rows], path)
    return make_curve(measure, levels, rates, path)


def _plain(title: str) -> str:
    """A title as this table calls it: ``PGA (g)`` is ``pga_g``, ``Tr (anni)`` is ``return_period_years``."""
    words = re.sub(r"[\s()\[\]/]+", "_", title.strip().lower().replace("²", "2")).strip("_")
    return "return_period_years" if _RETURN_PERIOD.fullmatch(words) else words


def level_column(title: str) -> bool:
    """Tell whether a title is of levels of a measure, such as ``pga_g``."""
    return _LEVEL.fullmatch(title) is not None


def measure_of(title: str, path: str) -> tuple[IntensityMeasure, float]:
    """Return measure and factor to its unit of a title such as ``pga_cm_s2``."""
    found = _LEVEL.fullmatch(title)
    assert found is not None
    name, period, unit = found.groups()
    units = _UNITS["pgv" if name == "pgv" else "others"]
    if unit not in units:
        raise InputError(f"{path}: {title} is no unit of {name.upper()}; use g or cm_s.")
    return read_measure(f"SA({period.replace('_', '.')})" if period else name, path), units[unit]


def annual_rates(title: str, values: list[float], path: str) -> list[float]:
    """Annual rates of a column whose title says how often levels are exceeded [1/year]."""
    if title == "annual_rate":
        return values
    if title == "return_period_years":
        if min(values) <= 0:
            raise InputError(f"{path}: a return period must be above 0 years.")
        return [1 / value for value in values]
    poe = _POE.fullmatch(title)
    if poe:
        return list(rates_of(values, float(poe[1]), path))
    raise InputError(f"{path}: column {title[:60]!r} is not known; expected {_EXPECTED}.")
