"""Facilities of USGS ShakeCast, each an object with its fragility, as its inventories are imported.

Version 4 takes an XML of ``FacilityRow`` elements with a ``FRAGILITY`` of colours, each with ``METRIC``, ``ALPHA``
(median) and ``BETA``; version 3 two CSV files, one of facilities and one of probabilistic fragility, with columns
such as ``METRIC:PGV:ALPHA:RED`` (ShakeCast V3 Operator's Guide, appendix A). Red is toppling, yellow rocking:
look at its feet. Levels are those of ShakeMaps, % g or cm/s of the larger of two components.
"""

from collections.abc import Sequence
from xml.etree import ElementTree as ET

import pandas as pd

from rockfrag.aftermath.object_fragility import LognormalState, ObjectFragility
from rockfrag.aftermath.shakemap import LARGER_OF_TWO
from rockfrag.base.errors import InputError
from rockfrag.fragility.exports import identifiers
from rockfrag.outcomes.limit_states import OVERTURNS, ROCKS

COLOURS = {ROCKS: "YELLOW", OVERTURNS: "RED"}
TO_METRIC = {"PGA": 100.0, "PGV": 1.0}  # From g to % g; PGV in cm/s
CLASS = "CONTENTS"
COMPONENT = "SYSTEM"  # The component by which ShakeCast alerts
LONGEST = {"id": 32, "kind": 10, "name": 128, "short": 10, "description": 255}
"""Characters that its fields hold."""


def _facts(fragilities: Sequence[ObjectFragility], kind: str) -> list[dict[str, str]]:
    """What both versions say of each facility."""
    if not 1 <= len(kind) <= LONGEST["kind"]:
        raise InputError(
            f"ShakeCast: the facility type {kind!r} has not 1 to {LONGEST['kind']} letters; give a shorter one."
        )
    names = identifiers((each.request.name for each in fragilities), "-_")
    rows, taken = [], set[str]()
    for number, each in enumerate(fragilities, start=1):
        name = each.request.name
        short = names[name][: LONGEST["id"]]
        if short in taken:
            short = f"{short[: LONGEST['id'] - 7]}-{number:06d}"
        taken.add(short)
        if each.request.coordinates is None:
            raise InputError(
                f"ShakeCast: {name!r} has no place; give columns latitude and longitude, or --at for all."
            )
        stands = f"with {each.held_by}" if each.held_by else "free-standing"
        description = f"{name}, {each.size}, {stands}; {each.motions} motions"
        rows.append(
            {
                "id": short,
                "kind": kind,
                "name": name[: LONGEST["name"]],
                "short": name[: LONGEST["short"]],
                "description": description[: LONGEST["description"]],
                "latitude": f"{each.request.coordinates[0]:.6f}",
                "longitude": f"{each.request.coordinates[1]:.6f}",
            }
        )
    return rows


def _levels(each: ObjectFragility, state: LognormalState) -> tuple[str, str]:
    """Median, in a ShakeMap's unit, and β [-] of a limit state as texts."""
    metric = TO_METRIC[each.measure.imt] * LARGER_OF_TWO * state.median
    return f"{metric:.4g}", f"{state.beta:.3f}"


def shakecast_xml(
    fragilities: Sequence[ObjectFragility], kind: str = "STRUCTURE"
) -> str:
    """Facilities as ShakeCast 4 imports them.

    Parameters
    ----------
    fragilities : of the objects, in a measure of the ground
    kind : facility type

    Returns
    -------
    XML.

    Raises
    ------
    InputError
        If an object has no coordinates.
    """
    root = ET.Element("FacilityTable")
    for each, facts in zip(fragilities, _facts(fragilities, kind), strict=True):
        row = ET.SubElement(root, "FacilityRow")
        for tag, text in (
            ("EXTERNAL_FACILITY_ID", facts["id"]),
            ("FACILITY_TYPE", facts["kind"]),
            ("COMPONENT_CLASS", CLASS),
            ("COMPONENT", COMPONENT),
            ("FACILITY_NAME", facts["name"]),
            ("DESCRIPTION", facts["description"]),
            ("SHORT_NAME", facts["short"]),
        ):
            ET.SubElement(row, tag).text = text
        feature = ET.SubElement(row, "FEATURE")
        ET.SubElement(feature, "GEOM_TYPE").text = "POINT"
        place = f"{facts['longitude']},{facts['latitude']},0"
        ET.SubElement(feature, "GEOM").text = place
        ET.SubElement(row, "FACILITY_MODEL").text = "GENERIC"
        fragility = ET.SubElement(row, "FRAGILITY")
        for state, curve in each.states.items():
            colour = ET.SubElement(fragility, COLOURS[state])
            alpha, beta = _levels(each, curve)
            ET.SubElement(colour, "METRIC").text = each.measure.imt
            ET.SubElement(colour, "ALPHA").text = alpha
            ET.SubElement(colour, "BETA").text = beta
    ET.indent(root)
    text = ET.tostring(root, encoding="unicode")
    return f'<?xml version="1.0" encoding="UTF-8" standalone="yes"?>\n{text}\n'


def shakecast_tables(
    fragilities: Sequence[ObjectFragility], kind: str = "STRUCTURE"
) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Facilities and their probabilistic fragility as ShakeCast 3 imports them.

    Parameters
    ----------
    fragilities : of the objects, in a measure of the ground
    kind : facility type

    Returns
    -------
    Table of the facilities, whose simple levels are the medians, and table of the curves.

    Raises
    ------
    InputError
        If an object has no coordinates.
    """
    facilities, curves = [], []
    for each, facts in zip(fragilities, _facts(fragilities, kind), strict=True):
        key = {"EXTERNAL_FACILITY_ID": facts["id"], "FACILITY_TYPE": facts["kind"]}
        facility = {
            **key,
            "FACILITY_NAME": facts["name"],
            "SHORT_NAME": facts["short"],
            "DESCRIPTION": facts["description"],
            "LAT": facts["latitude"],
            "LON": facts["longitude"],
        }
        curve = {**key, "CLASS": CLASS, "COMPONENT": COMPONENT}
        for state, lognormal in each.states.items():
            metric, colour = each.measure.imt, COLOURS[state]
            alpha, beta = _levels(each, lognormal)
            facility[f"METRIC:{metric}:{colour}"] = alpha
            curve[f"METRIC:{metric}:ALPHA:{colour}"] = alpha
            curve[f"METRIC:{metric}:BETA:{colour}"] = beta
        facilities.append(facility)
        curves.append(curve)
    return pd.DataFrame(facilities), pd.DataFrame(curves)
