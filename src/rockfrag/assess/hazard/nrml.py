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
    processing = next(_named(root, "hazardProcessing"), None)
    found = [_old(field, processing, path) for field in _named(root, "hazardCurveField")]
    found += [_new(curves, path) for curves in _named(root, "hazardCurves")]
    if not found:
        raise InputError(
            f"{path}: holds no hazardCurves or hazardCurveField; ask the service for hazard curves, not "
            f"maps or spectra."
        )
    return found


def _old(field: ET.Element, processing: ET.Element | None, path: str) -> Found:
    about = {} if processing is None else processing.attrib
    levels = next(_named(field, "IML"), None)
    if levels is None:
        raise InputError(f"{path}: a hazardCurveField has no IML, the levels of the curve.")
    poes = list(_named(field, "poE"))
    imt, years = _imt(levels, about), about.get("investigationTimeSpan")
    return _found(levels.text, poes, imt, years, _kind(field), path)


def _new(curves: ET.Element, path: str) -> Found:
    kind = _kind(curves)
    if not kind and curves.get("sourceModelTreePath"):
        kind = "branch of a logic tree"
    levels = next(_named(curves, "IMLs"), None)
    if levels is None:
        raise InputError(f"{path}: the hazardCurves have no IMLs, the levels.")
    years = curves.get("investigationTime")
    poes, imt = list(_named(curves, "poEs")), _imt(curves, curves.attrib)
    return _found(levels.text, poes, imt, years, kind, path)


def _imt(stated: ET.Element, about: Mapping[str, str]) -> str:
    """Return the measure that an element states, with the period of SA, which may stand elsewhere."""
    imt = stated.get("IMT", "")
    return f"SA({about.get('saPeriod', '')})" if imt.upper() == "SA" else imt


def _kind(curves: ET.Element) -> str:
    """Return which statistic of the hazard model the curves are, with the value of a quantile."""
    kind = curves.get("statistics", "")
    return f"quantile-{curves.get('quantileValue', '')}" if kind == "quantile" else kind


def _found(
    levels: str | None, poes: list[ET.Element], imt: str, years: str | None, kind: str, path: str
) -> Found:
    if len(poes) != 1:
        raise InputError(f"{path}: found the curves of {len(poes)} sites; leave that of one.")
    if years is None:
        raise InputError(f"{path}: the investigation time of the probabilities is not stated.")
    measure = read_measure(imt, path)
    values, fractions = (read_numbers(words or "", path) for words in (levels, poes[0].text))
    times = read_numbers(years, path)
    if len(times) != 1:
        raise InputError(f"{path}: the investigation time is {len(times)} numbers; give one.")
    (time,) = times
    rates = rates_of(fractions, time, path)
    return Found(make_curve(measure, values, list(rates), path), read_statistic(kind, path))


def _named(root: ET.Element, name: str) -> Iterator[ET.Element]:
    """Elements of a name in any namespace."""
    return (element for element in root.iter() if element.tag.rpartition("}")[2] == name)
