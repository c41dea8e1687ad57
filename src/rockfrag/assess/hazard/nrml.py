"""Hazard curves in NRML: EFEHR's answers (version 0.3) and OpenQuake's export (0.4 and 0.5).

In 0.3 a ``hazardCurveField`` has the levels (``IML``) and a node with ``poE``, the time and the period of
SA stand at ``hazardProcessing``; later versions say it all at ``hazardCurves`` with ``IMLs`` and ``poEs``.
Levels are in g.
"""

import xml.etree.ElementTree as ET
from collections.abc import Iterator, Mapping

from rockfrag.assess.hazard.curve import (
    Found,
    make_curve,
    rates_of,
    read_measure,
    read_numbers,
    read_statistic,
)
from rockfrag.errors import InputError

_VERSIONS = (
    ("hazardCurveField", "IML", "poE", "a hazardCurveField has no IML, the levels of the curve"),
    ("hazardCurves", "IMLs", "poEs", "the hazardCurves have no IMLs, the levels"),
)
"""Elements of curves, of their levels and of probabilities, and what is said where levels are missing."""


def recognise(text: str) -> bool:
    """Tell whether a text is XML."""
    return text.lstrip().startswith("<")


def read(text: str, path: str) -> list[Found]:
    """Return all curves of a file with one site."""
    if "<!DOCTYPE" in text or "<!ENTITY" in text:
        raise InputError(f"{path}: has a document type, which no hazard file needs; remove it.")
    try:
        root = ET.fromstring(text)
    except (ET.ParseError, ValueError) as error:
        raise InputError(f"{path}: is no well-formed XML ({error}).") from None
    above = next((part.attrib for part in _named(root, "hazardProcessing")), {})
    found = [
        _found(curves, above, level, poe, missing, path)
        for name, level, poe, missing in _VERSIONS
        for curves in _named(root, name)
    ]
    if not found:
        raise InputError(
            f"{path}: holds no hazardCurves or hazardCurveField; ask the service for hazard curves, not "
            f"maps or spectra."
        )
    return found


def _found(
    curves: ET.Element, above: Mapping[str, str], level: str, poe: str, missing: str, path: str
) -> Found:
    levels = next(_named(curves, level), None)
    if levels is None:
        raise InputError(f"{path}: {missing}.")
    poes = list(_named(curves, poe))
    if len(poes) != 1:
        raise InputError(f"{path}: found the curves of {len(poes)} sites; leave that of one.")
    about = {**above, **curves.attrib, **levels.attrib}
    years = about.get("investigationTimeSpan", about.get("investigationTime"))
    if years is None:
        raise InputError(f"{path}: the investigation time of the probabilities is not stated.")
    imt = about.get("IMT", "")
    # the period of SA stands elsewhere
    measure = read_measure(f"SA({about.get('saPeriod', '')})" if imt.upper() == "SA" else imt, path)
    values, fractions = (read_numbers(part.text or "", path) for part in (levels, poes[0]))
    times = read_numbers(years, path)
    if len(times) != 1:
        raise InputError(f"{path}: the investigation time is {len(times)} numbers; give one.")
    rates = rates_of(fractions, times[0], path)
    kind = curves.get("statistics", "")
    if kind == "quantile":
        kind = f"quantile-{curves.get('quantileValue', '')}"
    elif not kind and curves.get("sourceModelTreePath"):
        kind = "branch of a logic tree"
    return Found(make_curve(measure, values, list(rates), path), read_statistic(kind, path))


def _named(root: ET.Element, name: str) -> Iterator[ET.Element]:
    """Elements of a name in any namespace."""
    return (element for element in root.iter() if element.tag.rpartition("}")[2] == name)
