"""Fragility curves for SimCenter tools (pelicun): damage-model CSV and its JSON of explanations."""

import json
import os
from collections.abc import Mapping

import numpy as np
import pandas as pd

from rockfrag.errors import InputError
from rockfrag.files import write_table, write_text
from rockfrag.fragility.curve_facts import StateCurve, curve_facts, curves_by_name
from rockfrag.fragility.observations import Floats
from rockfrag.motions.intensity import declared
from rockfrag.outcomes.limit_states import limit_state_named

_UNITS = {"g": {"g": "g", "m/s²": "mps2"}, "cm/s": {"cm/s": "cmps", "m/s": "mps"}}
"""What SimCenter calls the units of measures in these."""

BEYOND = 2.0
"""Where a non-parametric fragility function that ends below 1 reaches it, as a multiple of its last level."""


def _demands() -> dict[str, tuple[str, dict[str, str]]]:
    """Name and units of each demand, by what curves call the measure at the ground and on a floor."""
    known = [measure for measure in declared() if measure.demand]
    return {
        label: (f"Peak {place} {measure.demand}", _UNITS[measure.unit])
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
) -> None:
    """Write rows of a fragility table as a damage model.

    Parameters
    ----------
    table : as of :func:`rockfrag.fragility.nrml.write_nrml`
        PGA and PGV are demands of the ground, PFA and PFV of the floor on which the object stands.
    csv_path, json_path : files to write
    by : column that names the curve; the ID is ``ROCKFRAG.`` and its letters and digits
    fractions
        As of :func:`rockfrag.fragility.nrml.write_nrml`; a state that has such points is written with the family
        ``multilinear_CDF``.
    """
    rows = []
    notes: dict[str, object] = {
        "_GeneralInformation": {
            "ShortName": "rockfrag",
            "Description": "Overturning of free-standing blocks in earthquakes",
            "Version": "1.0",
        }
    }
    for name, states in curves_by_name("SimCenter", table, by, "_", fractions, "ROCKFRAG.").items():
        line, notes[name] = _component(name, states, by)
        rows.append(line)
    write_table(pd.DataFrame(rows).sort_values("ID", ignore_index=True), csv_path)
    write_text(json.dumps(notes, indent=2, ensure_ascii=False, sort_keys=True) + "\n", json_path)


def _component(
    identifier: str, states: Mapping[str, StateCurve], by: str
) -> tuple[dict[str, object], dict[str, object]]:
    demands: set[tuple[str, str]] = set()
    limit_states: dict[str, object] = {}
    line: dict[str, object] = {}
    said = []
    known = _demands()
    for number, (state, curve) in enumerate(states.items(), start=1):
        row, levels, fraction = curve.row, curve.levels, curve.fraction
        name, im, unit = str(row[by]), str(row["im"]), str(row["unit"])
        if im not in known or unit not in known[im][1]:
            raise InputError(
                f"SimCenter: {im} in {unit or 'no unit'} is no demand of this export; choose PGA or PFA "
                "in g, PGV or PFV in cm/s."
            )
        demand, units = known[im]
        demands.add((demand, units[unit]))
        parameters: tuple[object, ...] = "lognormal", curve.theta, curve.beta, ""
        if levels.size:
            parameters = "multilinear_CDF", _multilinear(levels, fraction), "", ""
        keys = ("Family", "Theta_0", "Theta_1", "DamageStateWeights")
        line |= {f"LS{number}-{key}": x for key, x in zip(keys, parameters, strict=True)}
        reached = limit_state_named(state)
        words = reached.damage or reached.label
        damage = {"Description": words, "RepairAction": reached.repair}
        limit_states[f"LS{number}"] = {f"DS{number}": damage}
        facts = curve_facts(row)
        if levels.size and fraction[-1] < 1.0:
            facts += f" Beyond {levels[-1]:.4g} {unit} nothing was tried: all is put at {BEYOND:g} times it."
        said.append(f"{words}: {facts}")
    if len(demands) > 1:
        raise InputError(
            f"SimCenter: the limit states of {identifier} have two demands; choose one."
        )
    demand, demand_unit = demands.pop()
    line = {
        "ID": identifier,
        "Incomplete": 0,
        "Demand-Type": demand,
        "Demand-Unit": demand_unit,
        "Demand-Offset": 0,
        # the curves are for one horizontal component; a block falls about either of its edges
        "Demand-Directional": 1,
        **line,
    }
    note: dict[str, object] = {
        "Description": f"Free-standing {name}",
        "Comments": " ".join(said),
        "SuggestedComponentBlockSize": "1 EA",
        "RoundUpToIntegerQuantity": "True",
        "LimitStates": limit_states,
    }
    return line, note


def _multilinear(levels: Floats, fraction: Floats) -> str:
    """Points of a distribution from 0 to 1, as pelicun's ``multilinear_CDF`` takes them."""
    if fraction[-1] < 1.0:
        levels, fraction = np.append(levels, BEYOND * levels[-1]), np.append(fraction, 1.0)
    texts = (",".join(repr(float(value)) for value in values) for values in (levels, fraction))
    return "|".join(texts)
