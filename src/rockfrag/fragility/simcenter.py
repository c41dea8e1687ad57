"""Fragility curves for SimCenter tools (pelicun): damage-model CSV and its JSON of explanations."""

import json
import math
import os
from collections.abc import Hashable, Mapping
from typing import Any

import pandas as pd

from rockfrag.errors import InputError
from rockfrag.files import write_table, write_text

_DEMANDS = {"PGA": ("Peak Ground Acceleration", {"g": "g", "m/s²": "mps2"})}
_DEMANDS["PGV"] = ("Peak Ground Velocity", {"cm/s": "cmps", "m/s": "mps"})
_FLOOR_DEMANDS = {"PGA": "Peak Floor Acceleration", "PGV": "Peak Floor Velocity"}


def write_simcenter(
    table: pd.DataFrame,
    csv_path: str | os.PathLike[str],
    json_path: str | os.PathLike[str],
    *,
    by: str = "configuration",
) -> None:
    """Write rows of a fragility table as a damage model with one limit state, overturned.

    Parameters
    ----------
    table
        One row per configuration (one estimator and one measure each), as
        :func:`rockfrag.fragility.sweeps.fragility_table` gives them. Rows with a ``floor`` other
        than the ground floor are keyed to the peak acceleration or velocity of that floor.
    csv_path, json_path
        Files to write.
    by
        Column that names the curve; the ID is ``ROCKFRAG.`` and its letters and digits.

    Raises
    ------
    InputError
        If a row has no lognormal curve or a measure other than PGA and PGV, or IDs coincide.
    """
    if len(table) == 0:
        raise InputError("SimCenter: there is no curve to write; give at least one row.")
    rows = []
    notes: dict[str, object] = {
        "_GeneralInformation": {
            "ShortName": "rockfrag",
            "Description": "Overturning of free-standing blocks in earthquakes",
            "Version": "1.0",
        }
    }
    for row in table.to_dict("records"):
        line, note = _component(row, by)
        if line["ID"] in notes:
            raise InputError(
                f"SimCenter: {line['ID']} has two curves; choose one estimator and one measure "
                "for each."
            )
        rows.append(line)
        notes[str(line["ID"])] = note
    write_table(pd.DataFrame(rows).sort_values("ID", ignore_index=True), csv_path)
    write_text(json.dumps(notes, indent=2, ensure_ascii=False, sort_keys=True) + "\n", json_path)


def _component(row: Mapping[Hashable, Any], by: str) -> tuple[dict[str, object], dict[str, object]]:
    name, im, unit = str(row[by]), str(row["im"]), str(row["unit"])
    theta, beta = float(str(row["theta"])), float(str(row["beta"]))
    if row.get("link", "probit") != "probit" or not (theta > 0 and beta > 0 and beta < math.inf):
        raise InputError(f"SimCenter: {name!r} has no lognormal curve; leave the row out.")
    if im not in _DEMANDS or unit not in _DEMANDS[im][1]:
        raise InputError(
            f"SimCenter: {im} in {unit or 'no unit'} is no demand of this export; choose PGA in g "
            "or PGV in cm/s."
        )
    demand, units = _DEMANDS[im]
    on_floor = str(row.get("floor", "")) not in ("", "GF")
    line: dict[str, object] = {
        "ID": "ROCKFRAG." + "".join(c if c.isascii() and c.isalnum() else "_" for c in name),
        "Incomplete": 0,
        "Demand-Type": _FLOOR_DEMANDS[im] if on_floor else demand,
        "Demand-Unit": units[unit],
        "Demand-Offset": 0,
        # the curves are for one horizontal component; a block falls about either of its edges
        "Demand-Directional": 1,
        "LS1-Family": "lognormal",
        "LS1-Theta_0": theta,
        "LS1-Theta_1": beta,
        "LS1-DamageStateWeights": "",
    }
    state = {"Description": "Overturned", "RepairAction": "Restore or replace the object"}
    note: dict[str, object] = {
        "Description": f"Free-standing {name}",
        "Comments": _comment(row),
        "SuggestedComponentBlockSize": "1 EA",
        "RoundUpToIntegerQuantity": "True",
        "LimitStates": {"LS1": {"DS1": state}},
    }
    return line, note


def _comment(row: Mapping[Hashable, Any]) -> str:
    parts = []
    if "theta_lower" in row:
        parts.append(
            f"{float(str(row['level'])):.0%} limits: theta {row['theta_lower']:.4g} to "
            f"{row['theta_upper']:.4g}, beta {row['beta_lower']:.4g} to {row['beta_upper']:.4g}; "
            f"{row['n_motions']} motions."
        )
    if row.get("record_set_sha256"):
        parts.append(f"Record set {row['record_set_sha256']}.")
    if row.get("warnings"):
        parts.append(str(row["warnings"]))
    return " ".join(parts)
