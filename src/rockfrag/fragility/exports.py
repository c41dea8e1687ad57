"""Exports of fragility curves: NRML 0.5 of OpenQuake, and SimCenter's damage model (pelicun).

In: rows of :func:`rockfrag.fragility.ida_curves.fragility_table`, one per configuration and limit state, and
points of the non-parametric fragility function. Out: files; units are those of the format (g, cm/s).

Docs: ``docs/fragility.md``, "The table and its exports".
"""

import hashlib
import json
import math
import os
import re
from collections import Counter
from collections.abc import Hashable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple
from xml.sax.saxutils import escape

import numpy as np
import pandas as pd
from scipy import constants, special

from rockfrag.base.errors import InputError
from rockfrag.base.files import write_table, write_text
from rockfrag.fragility.check_notes import REJECTION
from rockfrag.fragility.curve_facts import curve_facts, total_beta
from rockfrag.fragility.observations import Floats
from rockfrag.motions.intensity import declared, measure_labelled
from rockfrag.outcomes.limit_states import OVERTURNS, limit_state_named, limit_states

LONGEST = 75  # characters of an identifier that OpenQuake takes
# β with which an exact threshold, a step, is written [-]; the formats take no step
STEP = 0.01


def identifiers(names: Iterable[str], others: str = "") -> dict[str, str]:
    """Identifier for each name: ASCII letters, digits and ``others``; all else becomes ``_``.

    Where two would be equal, or one would be too long, a digest of the name follows.

    Parameters
    ----------
    names, others : the names, and further characters that are allowed

    Returns
    -------
    The identifiers by name.
    """
    plain = {
        name: "".join(
            c if c.isascii() and (c.isalnum() or c in others) else "_" for c in name
        )
        for name in dict.fromkeys(names)
    }
    count = Counter(plain.values())
    for name, text in plain.items():
        if count[text] > 1 or len(text) > LONGEST:
            digest = hashlib.sha256(name.encode()).hexdigest()[:8]
            plain[name] = f"{text[: LONGEST - 9]}_{digest}"
    return plain


@dataclass(frozen=True)
class StateCurve:
    """Curve of one limit state."""

    row: Mapping[Hashable, Any]  # its row of the fragility table
    theta: float
    beta: float  # that of a step is ``STEP``
    # points of the non-parametric fragility function; empty where the lognormal one stands
    levels: Floats
    fraction: Floats
    # σ of ln level that the curve holds beside the motions' scatter: of estimate and model [-]; 0 for the motions'
    added: float = 0.0

    @property
    def holds(self) -> str:
        """Sentence on what the written curve holds, empty where there is no doubt."""
        if not self.added:
            return ""
        return "The curve as written holds all three, around the median of the motions."


@dataclass(frozen=True)
class Naming:
    """Names of functions in a file of another program."""

    export: str  # the format, as messages call it
    others: str  # characters that a name may have beside letters and digits
    prefix: str = ""  # beginning of every name


def curves_by_name(
    table: pd.DataFrame,
    by: str,
    fractions: pd.DataFrame | None,
    naming: Naming,
    *,
    model_error: bool = False,
) -> dict[str, dict[str, StateCurve]]:
    """Curves of a fragility table by identifier and by limit state, the milder first.

    Parameters
    ----------
    table : a row a curve
    by : column whose texts become identifiers
    fractions : points of curves that are not lognormal, a row a point; None without any
    naming : of the export, with its rules for identifiers
    model_error : whether β of overturning gets the error of the model as well
    """
    export = naming.export
    if table.empty:
        raise InputError(
            f"{export}: there is no curve to write; give at least one row."
        )
    known = identifiers(map(str, table[by]), naming.others)
    curves: dict[str, dict[str, StateCurve]] = {}
    for row in table.to_dict("records"):
        name = naming.prefix + known[str(row[by])]
        states = curves.setdefault(name, {})
        state = limit_state_named(str(row.get("state", OVERTURNS))).name
        if state in states:
            raise InputError(
                f"{export}: {name!r} has two curves; choose one estimator and one measure for each."
            )
        theta, beta = float(str(row["theta"])), float(str(row["beta"]))
        if row.get("link", "probit") != "probit" or not (
            theta > 0 and 0 < beta < math.inf
        ):
            raise InputError(
                f"{export}: {str(row[by])!r} has no lognormal curve; leave the row out."
            )
        points = _points_of(fractions, by, str(row[by]), state)
        added = 0.0
        if model_error and state == OVERTURNS:
            # where rocking starts is statics, which the model does not err in
            added = total_beta(0.0, float(row.get("beta_statistical", math.nan)))
        levels, fraction = spread_points(points[:, 0], points[:, 1], added)
        beta = math.hypot(max(beta, STEP), added)
        states[state] = StateCurve(row, theta, beta, levels, fraction, added)
    order = [state.name for state in limit_states()]
    return {
        name: {state: states[state] for state in order if state in states}
        for name, states in curves.items()
    }


def _points_of(
    fractions: pd.DataFrame | None, by: str, name: str, state: str
) -> Floats:
    """Levels and observed fractions of one object and limit state, shape (n, 2); no rows without fractions.

    ``by``: column of the object's name.
    """
    if fractions is None:
        return np.empty((0, 2))
    own = (fractions[by].astype(str) == name) & (fractions["state"] == state)
    return fractions.loc[own, ["x", "fraction"]].to_numpy(dtype=np.float64)


_NODES, _WEIGHTS = np.polynomial.hermite_e.hermegauss(41)


def spread_points(
    levels: Floats, fraction: Floats, added: float
) -> tuple[Floats, Floats]:
    """Points of a non-parametric fragility function whose levels are not known to a factor.

    The probability at x is the mean of that at x exp(σ Z), Z standard normal. Below the first level nothing
    overturns from that over :data:`BEYOND` on, and beyond the last everything does at :data:`BEYOND` times it.

    Parameters
    ----------
    levels, fraction : points, rising, shape (n,), in the unit of the measure and [-]
    added : σ of ln level [-]

    Returns
    -------
    Points likewise, more of them; the same where there are none or σ is 0.
    """
    if not levels.size or added == 0.0:
        return levels, fraction
    ends = np.log([levels[0] / BEYOND, levels[-1] * BEYOND])
    at = np.concatenate([ends[:1], np.log(levels), ends[1:]])
    known = np.concatenate([[0.0], fraction, [1.0]])
    x = np.linspace(ends[0] - 4 * added, ends[1] + 4 * added, 61)
    each = np.interp(x[:, np.newaxis] + added * _NODES, at, known)
    mean = each @ (_WEIGHTS / _WEIGHTS.sum())
    return np.exp(x), np.clip(np.maximum.accumulate(mean), 0.0, 1.0)


CROSSING = 1e-9
"""Levels are written where a state would be more probable than the state before it by more than rounding [-]."""

_STEPS = np.linspace(-4.0, 4.0, 33)
"""Levels of a discrete function around each median, in standard deviations."""

_FACTORS = {
    "g": {"g": 1.0, "m/s²": 1.0 / constants.g},
    "cm/s": {"cm/s": 1.0, "m/s": 100.0},
}
"""Factors from units to that of OpenQuake."""


def intensity_measure_type(name: str, unit: str) -> tuple[str, float]:
    """OpenQuake's name of a measure and the factor to its unit (g, cm/s).

    Parameters
    ----------
    name, unit : of the measure, as the field writes it
    """
    measure = measure_labelled(name)
    if measure is None or not measure.openquake:
        known = ", ".join(
            dict.fromkeys(each.openquake for each in declared() if each.openquake)
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


def write_nrml(
    table: pd.DataFrame,
    path: str | os.PathLike[str],
    *,
    identifier: str = "rockfrag",
    by: str = "configuration",
    fractions: pd.DataFrame | None = None,
    model_error: bool = True,
) -> None:
    """Write rows of a fragility table as an NRML 0.5 fragility model, with its facts and warnings in words.

    Parameters
    ----------
    table
        One row per configuration and limit state (one estimator and one measure each), as
        :func:`rockfrag.fragility.ida_curves.fragility_table` gives them; a column ``state`` names the limit
        state (``rockfrag.outcomes.limit_states``), without it all are ``overturns``. A column ``floor`` must be
        empty: only motions of the ground are known to OpenQuake. No function may lack a state that another has.
    path, identifier : file to write, and name of the model
    by : column that names the function (OpenQuake's taxonomy), but for letters that OpenQuake does not take
    fractions
        Points of the non-parametric fragility function (:func:`rockfrag.fragility.ida_curves.fraction_points`),
        with columns ``by`` and ``state``. A function that has such points is written as discrete levels; so is
        one whose lognormal curves would make a state more probable than the one that comes before it.
    model_error
        Whether curves of overturning hold the errors of estimate and model beside the scatter of the motions,
        added as squares: what a program that samples nothing else of them needs.
    """
    # OpenQuake takes letters, digits, "_", "-" and ":" in a name
    naming = Naming("NRML", "_:-")
    curves = curves_by_name(table, by, fractions, naming, model_error=model_error)
    used = {state for states in curves.values() for state in states}
    known = [state.name for state in limit_states() if state.name in used]
    functions: list[dict[str, object]] = []
    sentences: list[str] = []
    for name in sorted(curves):
        for state in known:
            if state not in curves[name]:
                raise InputError(
                    f"NRML: {name!r} has no curve for the limit state {state}, which others have; leave "
                    "it or that state out."
                )
        said = []
        for state, curve in curves[name].items():
            facts = curve_facts({**curve.row, "warnings": ""})
            said.append(f"{state}: {facts} {curve.holds}".rstrip())
            # without what is said of a single rejected curve
            note = REJECTION.sub("", str(curve.row.get("warnings") or "")).strip()
            sentences += re.split(r"(?<=\.)\s+(?=[A-Z])", note)
        # two hyphens would end the comment
        comment = f"{name}: {' '.join(said)}".replace("--", "- -")
        functions.append(
            {"id": name, "comment": comment, **_function(name, curves[name], by)}
        )
    description = [
        "Bodies that rock in earthquakes. The comment before each function gives its limits, its "
        "goodness of fit and the number of its motions.",
        *dict.fromkeys(filter(None, sentences)),
    ]
    write_text(model_text(" ".join(description), known, functions, identifier), path)


def model_text(
    description: str,
    states: Sequence[str],
    functions: Sequence[Mapping[str, object]],
    identifier: str = "rockfrag",
) -> str:
    """NRML 0.5 of a fragility model.

    Parameters
    ----------
    description, states : words about the model, and names of its limit states, the milder first
    functions
        Each has an ``id``, its ``imt`` and, by state, ``chances`` [-] at its ``levels``, or the ``moments`` of
        lognormal curves, mean and standard deviation, with the range of levels from ``low`` to ``high`` [g or
        cm/s].
    identifier : name of the model

    Returns
    -------
    The text of the file.
    """
    # imported when a file is written, which most commands never do
    from jinja2 import Environment, PackageLoader, StrictUndefined

    templates = Environment(
        loader=PackageLoader("rockfrag.fragility", ""),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    text = templates.get_template("nrml.j2").render(
        functions=functions,
        description=escape(description),
        states=states,
        identifier=identifier,
    )
    return f"{text}\n"


def _function(
    taxonomy: str, states: Mapping[str, StateCurve], by: str
) -> dict[str, object]:
    """Measure and curves of a function, in OpenQuake's units: lognormal ones, or levels."""
    factors: dict[str, float] = {}
    for curve in states.values():
        if floor := str(curve.row.get("floor", "")):
            raise InputError(
                f"NRML: {str(curve.row[by])!r} is keyed to the motion of floor {floor}, which OpenQuake does not "
                "compute; export curves in a measure of the ground motion."
            )
        imt, factor = intensity_measure_type(
            str(curve.row["im"]), str(curve.row["unit"])
        )
        factors[imt] = factor
    if len(factors) > 1:
        raise InputError(
            f"NRML: the limit states of {taxonomy!r} are in {' and '.join(sorted(factors))}; one "
            "function has one measure."
        )
    levels, chances, lowered = _nested(states, factor)
    if lowered > CROSSING or any(curve.levels.size for curve in states.values()):
        by_state = {state: chance.tolist() for state, chance in chances.items()}
        return {"imt": imt, "levels": levels.tolist(), "chances": by_state}
    moments, ends = {}, []
    for state, curve in states.items():
        theta, beta = curve.theta * factor, curve.beta
        # mean and standard deviation, linear as NRML wants them, from median θ and β
        mean = theta * math.exp(0.5 * beta**2)
        moments[state] = mean, mean * math.sqrt(math.expm1(beta**2))
        # the range in which OpenQuake may evaluate it: from a chance of 3e-5 to one of 1 - 3e-5
        ends += [theta * math.exp(sign * 4.0 * beta) for sign in (-1, 1)]
    return {"imt": imt, "low": min(ends), "high": max(ends), "moments": moments}


def _nested(
    states: Mapping[str, StateCurve], factor: float
) -> tuple[Floats, dict[str, Floats], float]:
    """Chances of limit states at common levels, each never above that of the milder state before.

    ``factor``: from the unit of the curves to that of the file. Returned are the levels, shape (n,), the chances
    by state, shape (n,), and by how much a chance had to be lowered at most [-].
    """
    parts = [
        curve.theta * factor * np.exp(curve.beta * _STEPS) for curve in states.values()
    ]
    levels = np.unique(
        np.concatenate([*parts, *(curve.levels * factor for curve in states.values())])
    )
    found: dict[str, Floats] = {}
    before, lowered = np.ones(levels.size), 0.0
    for state, curve in states.items():
        chance = special.ndtr(np.log(levels / (curve.theta * factor)) / curve.beta)
        if curve.levels.size:
            chance = np.interp(
                np.log(levels), np.log(curve.levels * factor), curve.fraction
            )
        lowered = max(lowered, float((chance - before).max()))
        before = np.minimum(chance, before)
        found[state] = before
    return levels, found, lowered


_DEMAND_UNITS = {
    "g": {"g": "g", "m/s²": "mps2"},
    "cm/s": {"cm/s": "cmps", "m/s": "mps"},
}
"""What SimCenter calls the units of measures in these."""

BEYOND = 2.0
"""Where a non-parametric fragility function that ends below 1 reaches it, as a multiple of its last level."""


class _Demand(NamedTuple):
    """A measure as SimCenter knows it."""

    name: str  # such as ``Peak Ground Acceleration``
    units: Mapping[str, str]  # its names of the units that curves may have


def _demands() -> dict[str, _Demand]:
    """Demands by what curves call the measure, at the ground and on a floor."""
    known = [measure for measure in declared() if measure.demand]
    return {
        label: _Demand(f"Peak {place} {measure.demand}", _DEMAND_UNITS[measure.unit])
        for measure in known
        for label, place in ((measure.label, "Ground"), (measure.floor_label, "Floor"))
        if label
    }


def write_simcenter(
    table: pd.DataFrame,
    csv_path: str | os.PathLike[str],
    json_path: str | os.PathLike[str],
    *,
    by: str = "configuration",
    fractions: pd.DataFrame | None = None,
    model_error: bool = True,
) -> None:
    """Write rows of a fragility table as a damage model.

    Parameters
    ----------
    table : as of :func:`write_nrml`
        PGA and PGV are demands of the ground, PFA and PFV of the floor on which the object stands. What holds an
        object may stand in a column ``held_by``, empty of what stands free.
    csv_path, json_path : files to write
    by : column that names the curve; the ID is ``ROCKFRAG.`` and its letters and digits
    fractions
        As of :func:`write_nrml`; a state that has such points is written with the family
        ``multilinear_CDF``.
    model_error : as of :func:`write_nrml`
    """
    about = {
        "ShortName": "rockfrag",
        "Description": "Overturning of objects in earthquakes",
        "Version": "1.0",
    }
    notes: dict[str, object] = {"_GeneralInformation": about}
    rows = []
    naming = Naming("SimCenter", "_", prefix="ROCKFRAG.")
    curves = curves_by_name(table, by, fractions, naming, model_error=model_error)
    for name, states in curves.items():
        line, notes[name] = _component(name, states, by)
        rows.append(line)
    write_table(pd.DataFrame(rows).sort_values("ID", ignore_index=True), csv_path)
    write_text(
        json.dumps(notes, indent=2, ensure_ascii=False, sort_keys=True) + "\n",
        json_path,
    )


def _component(
    identifier: str, states: Mapping[str, StateCurve], by: str
) -> tuple[dict[str, object], dict[str, object]]:
    """Row of the table and entry of the notes of what has curves of some limit states.

    Parameters
    ----------
    identifier : of the component
    states : its curves by limit state, the milder first
    by : column of a curve's row that names it
    """
    about: dict[str, object] = {"ID": identifier, "Incomplete": 0}
    demand, unit = _demand_of(identifier, states)
    about |= {"Demand-Type": demand, "Demand-Unit": unit}
    # the curves are for one horizontal component; a block falls about either of its edges
    about |= {"Demand-Offset": 0, "Demand-Directional": 1}
    limit_states, said = {}, []
    for number, (state, curve) in enumerate(states.items(), start=1):
        about |= {f"LS{number}-{key}": value for key, value in _family(curve).items()}
        reached = limit_state_named(state)
        words = reached.damage or reached.label
        damage = {"Description": words, "RepairAction": reached.repair}
        limit_states[f"LS{number}"] = {f"DS{number}": damage}
        said.append(f"{words}: {_facts(curve)} {curve.holds}".rstrip())
    last = list(states.values())[-1]
    named, held = str(last.row[by]), last.row.get("held_by")
    # of a table whose other rows alone say it, an empty cell is no text
    is_held = isinstance(held, str) and bool(held)
    note: dict[str, object] = {
        "Description": f"{named}, with {held}" if is_held else f"Free-standing {named}",
        "Comments": " ".join(said),
        "SuggestedComponentBlockSize": "1 EA",
        "RoundUpToIntegerQuantity": "True",
        "LimitStates": limit_states,
    }
    return about, note


def _demand_of(identifier: str, states: Mapping[str, StateCurve]) -> tuple[str, str]:
    """Name and unit, as SimCenter has them, of the one demand that all limit states have."""
    known, demands = _demands(), set()
    for curve in states.values():
        im, unit = str(curve.row["im"]), str(curve.row["unit"])
        if im not in known or unit not in known[im].units:
            raise InputError(
                f"SimCenter: {im} in {unit or 'no unit'} is no demand of this export; choose PGA or PFA "
                "in g, PGV or PFV in cm/s."
            )
        demands.add((known[im].name, known[im].units[unit]))
    if len(demands) > 1:
        raise InputError(
            f"SimCenter: the limit states of {identifier} have two demands; choose one."
        )
    ((demand, demand_unit),) = demands
    return demand, demand_unit


def _facts(curve: StateCurve) -> str:
    """Facts of a curve in words, and where its points end below 1 what stands beyond them."""
    facts = curve_facts(curve.row)
    if curve.levels.size and curve.fraction[-1] < 1.0:
        unit = str(curve.row["unit"])
        facts += f" Beyond {curve.levels[-1]:.4g} {unit} nothing was tried: all is put at {BEYOND:g} times it."
    return facts


def _family(curve: StateCurve) -> dict[str, object]:
    """Distribution of a curve as SimCenter's tables have it: by its points if it has any, else lognormal."""
    if curve.levels.size:
        points = _multilinear(curve.levels, curve.fraction)
        parameters: tuple[object, ...] = "multilinear_CDF", points, ""
    else:
        parameters = "lognormal", curve.theta, curve.beta
    keys = ("Family", "Theta_0", "Theta_1")
    return dict(zip(keys, parameters, strict=True)) | {"DamageStateWeights": ""}


def _multilinear(levels: Floats, fraction: Floats) -> str:
    """Points of a distribution from 0 to 1, as pelicun's ``multilinear_CDF`` takes them."""
    if fraction[-1] < 1.0:
        levels = np.append(levels, BEYOND * levels[-1])
        fraction = np.append(fraction, 1.0)

    def listed(values: Floats) -> str:
        return ",".join(repr(float(value)) for value in values)

    return f"{listed(levels)}|{listed(fraction)}"
