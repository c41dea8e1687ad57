"""Fragility curves for OpenQuake: NRML 0.5 with lognormal functions."""

import math
import os
import re
from collections.abc import Hashable, Mapping, Sequence
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pandas as pd
from scipy import constants, special

from rockfrag.errors import InputError
from rockfrag.files import write_text
from rockfrag.fragility.checks import REJECTION
from rockfrag.fragility.curve_facts import curve_facts
from rockfrag.fragility.identifiers import curves_by_name, lognormal_of
from rockfrag.fragility.observations import Floats
from rockfrag.motions.declared import declared, measure_labelled
from rockfrag.outcomes.limit_states import limit_states

NAMESPACE = "http://openquake.org/xmlns/nrml/0.5"

STEP = 0.01  # β with which an exact threshold, a step, is written [-]; the formats take no step
CROSSING = 1e-9
"""Levels are written where a state would be more probable than the state before it by more than rounding [-]."""

_STEPS = np.linspace(-4.0, 4.0, 33)
"""Levels of a discrete function around each median, in standard deviations."""

_FACTORS = {"g": {"g": 1.0, "m/s²": 1.0 / constants.g}, "cm/s": {"cm/s": 1.0, "m/s": 100.0}}
"""Factors from units to that of OpenQuake."""


def intensity_measure_type(name: str, unit: str) -> tuple[str, float]:
    """OpenQuake's name of a measure and the factor to its unit (g, cm/s)."""
    measure = measure_labelled(name)
    if measure is None or not measure.openquake or name == measure.floor_label:
        known = ", ".join(
            dict.fromkeys(
                each_measure.openquake for each_measure in declared() if each_measure.openquake
            )
        )
        raise InputError(
            f"NRML: {name} is no intensity measure of ground motion in OpenQuake; export curves in one of {known}."
        )
    factors = _FACTORS.get(measure.unit, {measure.unit: 1.0})
    if unit not in factors:
        raise InputError(
            f"NRML: {name} in {unit or 'no unit'} cannot be converted; use {' or '.join(factors)}."
        )
    return measure.imt, factors[unit]


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
    fractions: pd.DataFrame | None = None,
) -> None:
    """Write rows of a fragility table as an NRML 0.5 fragility model.

    NRML has no place for confidence limits and numbers of motions, so a comment before each function gives them.
    The description has what is to be warned of, each sentence once.

    Parameters
    ----------
    table
        One row per configuration and limit state (one estimator and one measure each), as
        :func:`rockfrag.fragility.ida_curves.fragility_table` gives them; a column ``state`` names the limit
        state (``rockfrag.outcomes.limit_states``), without it all are ``overturns``. A column ``floor`` must be
        empty: only motions of the ground are known to OpenQuake.
    path
        File to write.
    identifier
        Name of the model.
    by
        Column whose value names the function (OpenQuake's taxonomy); what OpenQuake
        does not take in a name becomes ``_``.
    fractions
        Points of the non-parametric fragility function (:func:`rockfrag.fragility.drawn_curves.fraction_points`),
        with columns ``by`` and ``state``. A function of which a state has such points is written as discrete
        levels; so is one whose lognormal curves would make a state more probable than the one that comes before
        it.

    Raises
    ------
    InputError
        If a row has no lognormal curve, a measure that OpenQuake does not know, or a floor above
        ground; if a name comes twice, or lacks a limit state that another has.
    """
    # OpenQuake takes letters, digits, "_", "-" and ":" in a name
    rows = curves_by_name("NRML", table, by, "_:-")
    used = {state for states in rows.values() for state in states}
    known = [state.name for state in limit_states() if state.name in used]
    functions: list[Any] = []
    warned: list[str] = []
    for name in sorted(rows):
        lacking = [state for state in known if state not in rows[name]]
        if lacking:
            raise InputError(
                f"NRML: {name!r} has no curve for the limit state {lacking[0]}, which others have; leave "
                "it or that state out."
            )
        said = " ".join(
            f"{state}: {curve_facts({**rows[name][state], 'warnings': ''})}" for state in known
        )
        # two hyphens would end the comment
        functions.append(ElementTree.Comment(f" {name}: {said} ".replace("--", "- -")))
        warned += [str(rows[name][state].get("warnings") or "") for state in known]
        functions.append(_function(name, rows[name], by, fractions))
    description = [
        "Free-standing bodies in earthquakes. The comment before each function gives its limits, its "
        "goodness of fit and the number of its motions.",
        *said_once(warned),
    ]
    write_text(model_text(" ".join(description), known, functions, identifier), path)


def model_text(
    description: str, states: Sequence[str], functions: Sequence[Any], identifier: str = "rockfrag"
) -> str:
    """NRML 0.5 of a fragility model with some limit states and functions."""
    root = ElementTree.Element("nrml", {"xmlns": NAMESPACE})
    about = {"id": identifier, "assetCategory": "contents", "lossCategory": "contents"}
    model = ElementTree.SubElement(root, "fragilityModel", about)
    ElementTree.SubElement(model, "description").text = description
    ElementTree.SubElement(model, "limitStates").text = " ".join(states)
    model.extend(functions)
    ElementTree.indent(root, space="  ")
    text = ElementTree.tostring(root, encoding="unicode")
    return f'<?xml version="1.0" encoding="UTF-8"?>\n{text}\n'


def said_once(notes: Sequence[str]) -> list[str]:
    """Sentences of several warnings, each once, without what is said of a single rejected curve."""
    sentences = [
        sentence
        for note in notes
        for sentence in re.split(r"(?<=\.)\s+(?=[A-Z])", REJECTION.sub("", note).strip())
    ]
    return [sentence for sentence in dict.fromkeys(sentences) if sentence]


def _function(
    taxonomy: str,
    states: Mapping[str, Mapping[Hashable, Any]],
    by: str,
    fractions: pd.DataFrame | None,
) -> ElementTree.Element:
    curves: dict[str, tuple[float, float]] = {}
    free: dict[str, tuple[Floats, Floats]] = {}
    measures: set[str] = set()
    for state, row in states.items():
        name = str(row[by])
        theta, beta = lognormal_of("NRML", row, by)
        floor = str(row.get("floor", ""))
        if floor:
            raise InputError(
                f"NRML: {name!r} is keyed to the motion of floor {floor}, which OpenQuake does not "
                "compute; export curves in a measure of the ground motion."
            )
        imt, factor = intensity_measure_type(str(row["im"]), str(row["unit"]))
        measures.add(imt)
        curves[state] = theta * factor, max(beta, STEP)
        levels, fraction = points_of(fractions, by, name, state)
        if levels.size:
            free[state] = levels * factor, fraction
    if len(measures) > 1:
        raise InputError(
            f"NRML: the limit states of {taxonomy!r} are in {' and '.join(sorted(measures))}; one "
            "function has one measure."
        )
    levels, chances, lowered = _nested(curves, free)
    if free or lowered > CROSSING:
        return discrete_function(taxonomy, measures.pop(), levels, chances)
    function = ElementTree.Element(
        "fragilityFunction", {"id": taxonomy, "format": "continuous", "shape": "logncdf"}
    )
    # the range in which OpenQuake may evaluate it: from a chance of 3e-5 to one of 1 - 3e-5
    limits = {
        "minIML": repr(min(theta * math.exp(-4.0 * beta) for theta, beta in curves.values())),
        "maxIML": repr(max(theta * math.exp(4.0 * beta) for theta, beta in curves.values())),
    }
    ElementTree.SubElement(function, "imls", {"imt": measures.pop(), **limits})
    for state, (theta, beta) in curves.items():
        mean, deviation = lognormal_moments(theta, beta)
        parameters = {"ls": state, "mean": repr(mean), "stddev": repr(deviation)}
        ElementTree.SubElement(function, "params", parameters)
    return function


def points_of(
    fractions: pd.DataFrame | None, by: str, name: str, state: str
) -> tuple[Floats, Floats]:
    """Levels and fractions of the non-parametric fragility function; empty where the lognormal one stands."""
    if fractions is None:
        return np.empty(0), np.empty(0)
    own = fractions[(fractions[by].astype(str) == name) & (fractions["state"] == state)]
    return own["x"].to_numpy(dtype=np.float64), own["fraction"].to_numpy(dtype=np.float64)


def _nested(
    curves: Mapping[str, tuple[float, float]], free: Mapping[str, tuple[Floats, Floats]]
) -> tuple[Floats, dict[str, Floats], float]:
    """Levels, the chance of each state there, never above that of the state before, and by how much it was."""
    parts = [theta * np.exp(beta * _STEPS) for theta, beta in curves.values()]
    levels = np.unique(np.concatenate([*parts, *(x for x, _ in free.values())]))
    found: dict[str, Floats] = {}
    before, lowered = np.ones(levels.size), 0.0
    for state, (theta, beta) in curves.items():
        chance = special.ndtr(np.log(levels / theta) / beta)
        if state in free:
            x, fraction = free[state]
            chance = np.interp(np.log(levels), np.log(x), fraction)
        lowered = max(lowered, float((chance - before).max()))
        before = np.minimum(chance, before)
        found[state] = before
    return levels, found, lowered


def discrete_function(
    taxonomy: str, imt: str, levels: Floats, chances: Mapping[str, Floats]
) -> ElementTree.Element:
    """Function of levels and probabilities."""
    function = ElementTree.Element("fragilityFunction", {"id": taxonomy, "format": "discrete"})
    attributes = {"imt": imt, "noDamageLimit": repr(float(levels[0]))}
    text = " ".join(repr(float(level)) for level in levels)
    ElementTree.SubElement(function, "imls", attributes).text = text
    for state, chance in chances.items():
        poes = ElementTree.SubElement(function, "poes", {"ls": state})
        poes.text = " ".join(repr(float(value)) for value in chance)
    return function
