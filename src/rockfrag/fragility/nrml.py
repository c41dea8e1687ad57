"""Fragility curves for OpenQuake: NRML 0.5 with lognormal functions."""

import itertools
import math
import os
import re
from collections.abc import Hashable, Mapping
from typing import Any
from xml.etree import ElementTree

import pandas as pd

from rockfrag.errors import InputError
from rockfrag.files import write_text

NAMESPACE = "http://openquake.org/xmlns/nrml/0.5"
GROUND_FLOORS = ("", "GF")
_SPECTRAL = re.compile(r"^SA\((?P<period>[\d.]+)s\)$")


def intensity_measure_type(name: str, unit: str) -> tuple[str, float]:
    """OpenQuake's name of a measure and the factor to its unit (g, cm/s).

    Raises
    ------
    InputError
        If OpenQuake has no such ground measure; only PGA, PGV and SA are written.
    """
    spectral = _SPECTRAL.match(name)
    if name == "PGA" or spectral:
        factors = {"g": 1.0, "m/s²": 1.0 / 9.80665}
    elif name == "PGV":
        factors = {"cm/s": 1.0, "m/s": 100.0}
    else:
        raise InputError(
            f"NRML: {name} is no intensity measure of ground motion in OpenQuake; export curves "
            "in PGA, PGV or SA."
        )
    if unit not in factors:
        raise InputError(
            f"NRML: {name} in {unit or 'no unit'} cannot be converted; use {' or '.join(factors)}."
        )
    imt = f"SA({float(spectral['period']):g})" if spectral else name
    return imt, factors[unit]


def lognormal_moments(theta: float, beta: float) -> tuple[float, float]:
    """Return mean and standard deviation, linear as NRML wants them, from median θ and β."""
    mean = theta * math.exp(0.5 * beta**2)
    return mean, mean * math.sqrt(math.expm1(beta**2))


def write_nrml(
    table: pd.DataFrame,
    path: str | os.PathLike[str],
    *,
    identifier: str = "rockfrag",
    by: str = "configuration",
) -> None:
    """Write rows of a fragility table as an NRML 0.5 fragility model.

    Parameters
    ----------
    table
        One row per configuration (one estimator and one measure each), as
        :func:`rockfrag.fragility.sweeps.fragility_table` gives them.
    path
        File to write.
    identifier
        Name of the model.
    by
        Column whose value names the function (OpenQuake's taxonomy); what OpenQuake
        does not take in a name becomes ``_``.

    Raises
    ------
    InputError
        If a row has no lognormal curve, a measure that OpenQuake does not know, or a floor above
        ground; or if a name comes twice.
    """
    functions = sorted(
        (_function(row, by) for row in table.to_dict("records")), key=lambda pair: pair[0]
    )
    names = [name for name, _ in functions]
    for first, second in itertools.pairwise(names):
        if first == second:
            raise InputError(
                f"NRML: {first!r} has two curves; choose one estimator and one measure for each."
            )
    if not names:
        raise InputError("NRML: there is no curve to write; give at least one row.")
    root = ElementTree.Element("nrml", {"xmlns": NAMESPACE})
    model = ElementTree.SubElement(
        root,
        "fragilityModel",
        {"id": identifier, "assetCategory": "contents", "lossCategory": "contents"},
    )
    ElementTree.SubElement(model, "description").text = _description(table)
    ElementTree.SubElement(model, "limitStates").text = "overturned"
    model.extend([element for _, element in functions])
    ElementTree.indent(root, space="  ")
    text = ElementTree.tostring(root, encoding="unicode")
    write_text('<?xml version="1.0" encoding="UTF-8"?>\n' + text + "\n", path)


def _function(row: Mapping[Hashable, Any], by: str) -> tuple[str, ElementTree.Element]:
    name = str(row[by])
    # OpenQuake takes letters, digits, "_", "-" and ":" in a name, 75 at most
    taxonomy = re.sub(r"[^A-Za-z0-9_:-]", "_", name)[:75]
    theta, beta = float(str(row["theta"])), float(str(row["beta"]))
    if row.get("link", "probit") != "probit" or not (theta > 0 and beta > 0 and beta < math.inf):
        raise InputError(f"NRML: {name!r} has no lognormal curve; leave the row out.")
    floor = str(row.get("floor", ""))
    if floor not in GROUND_FLOORS:
        raise InputError(
            f"NRML: {name!r} is keyed to the motion of floor {floor}, which OpenQuake does not "
            "compute; export curves in a measure of the ground motion."
        )
    imt, factor = intensity_measure_type(str(row["im"]), str(row["unit"]))
    mean, deviation = lognormal_moments(theta * factor, beta)
    function = ElementTree.Element(
        "fragilityFunction", {"id": taxonomy, "format": "continuous", "shape": "logncdf"}
    )
    # the range in which OpenQuake may evaluate it: from a chance of 3e-5 to one of 1 - 3e-5
    reach = math.exp(4.0 * beta)
    limits = {"minIML": repr(theta * factor / reach), "maxIML": repr(theta * factor * reach)}
    ElementTree.SubElement(function, "imls", {"imt": imt, **limits})
    parameters = {"ls": "overturned", "mean": repr(mean), "stddev": repr(deviation)}
    ElementTree.SubElement(function, "params", parameters)
    return taxonomy, function


def _description(table: pd.DataFrame) -> str:
    hashes = sorted(set(table.get("record_set_sha256", pd.Series(dtype=str)).astype(str)) - {""})
    source = f"; record set {', '.join(hashes)}" if hashes else ""
    return f"Overturning of free-standing blocks, lognormal in the intensity measure{source}"
