"""Branches of a hazard model: a logic tree's end branches, each with its weight and a hazard curve a measure.

Two ways to give them: OpenQuake's exports (``realizations_….csv`` and a file of hazard curves for each
realization, ``hazard_curve-rlz-000-PGA_….csv``), or plain tables with the columns ``branch``, ``weight``, a
level (``pga_g``, ``pgv_cm_s``, ``sa_0_3s_g``) and how often it is exceeded (``annual_rate``,
``return_period_years`` or such as ``poe_50_years``), a row a level; a second table may give another measure of
the same branches.
"""

import math
import os
import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from rockfrag.assess.hazard.curve import HazardCurve
from rockfrag.assess.hazard.reading import LARGEST_FILE, read_levels, read_openquake
from rockfrag.errors import InputError
from rockfrag.motions.intensity import IntensityMeasure
from rockfrag.tabular import Row, read_table, read_text

MOST_BRANCHES = 10_000  # Branches of one site

WEIGHT_ERROR = 1e-3
"""By how much the sum of weights may differ from 1, which rounding to four digits explains."""


@dataclass(frozen=True)
class Branch:
    """One end branch of a logic tree at a site: its weight, of sum 1, and its hazard curves by measure."""

    name: str
    weight: float
    curves: dict[IntensityMeasure, HazardCurve] = field(default_factory=dict)


def read_branches(
    paths: Sequence[str | os.PathLike[str]], realizations: str | os.PathLike[str] | None = None
) -> list[Branch]:
    """Read the branches of a site in the order of the file, with weights of sum 1 to the last digit.

    ``paths`` are tables of branches, one a measure; or, with OpenQuake's file of ``realizations``, its files of
    hazard curves.
    """
    if not paths:
        raise InputError("hazard: name at least one file with hazard curves of branches.")
    found = _of_openquake(paths, realizations) if realizations else _of_tables(paths)
    where = str(realizations or paths[0])
    if len(found) > MOST_BRANCHES:
        raise InputError(
            f"{where}: {len(found)} branches are more than the {MOST_BRANCHES} allowed."
        )
    _check(found, where)
    total = sum(branch.weight for branch in found)
    return [Branch(b.name, b.weight / total, b.curves) for b in found]


def _check(branches: Sequence[Branch], where: str) -> None:
    for branch in branches:
        if not (math.isfinite(branch.weight) and branch.weight > 0):
            raise InputError(
                f"{where}: branch {branch.name[:60]} has the weight {branch.weight:g}; a weight is above 0."
            )
    total = sum(branch.weight for branch in branches)
    if abs(total - 1.0) > WEIGHT_ERROR:
        raise InputError(
            f"{where}: the weights of the {len(branches)} branches sum to {total:.6g} and not to 1; give every "
            "end branch once."
        )
    for branch in branches[1:]:
        if set(branch.curves) != set(branches[0].curves):
            raise InputError(
                f"{where}: branch {branch.name[:60]} has curves of {_names(branch)}, branch "
                f"{branches[0].name[:60]} of {_names(branches[0])}; give the same measures for all."
            )


def _names(branch: Branch) -> str:
    return " and ".join(sorted(measure.imt for measure in branch.curves)) or "nothing"


def _of_tables(paths: Sequence[str | os.PathLike[str]]) -> list[Branch]:
    """Branches of plain tables."""
    found: dict[str, Branch] = {}
    for path in paths:
        for name, (weight, curve) in _table(path).items():
            branch = found.setdefault(name, Branch(name, weight))
            if branch.weight != weight:
                raise InputError(
                    f"{path}: branch {name[:60]} has the weight {weight:g}, and {branch.weight:g} elsewhere."
                )
            _add(curve, branch, f"branch {name[:60]}", path)
    return list(found.values())


def _add(curve: HazardCurve, branch: Branch, name: str, path: str | os.PathLike[str]) -> None:
    if curve.measure in branch.curves:
        raise InputError(f"{path}: {curve.measure.imt} of {name} is given twice.")
    branch.curves[curve.measure] = curve


def _table(path: str | os.PathLike[str]) -> dict[str, tuple[float, HazardCurve]]:
    """Weight and curve of every branch of one table."""
    every, curve = read_levels(path, labels=("branch", "weight"))
    rows: dict[str, list[Row]] = {}
    for row in every:
        rows.setdefault(row.text("branch"), []).append(row)
    found = {}
    for name, mine in rows.items():
        weight = mine[0].number("weight")
        for row in mine:
            if row.number("weight") != weight:
                raise row.error(
                    "weight", f"branch {name} has the weight {weight:g} in an earlier row"
                )
        found[name] = (weight, curve(mine, f"{path}, branch {name[:60]}"))
    return found


def _of_openquake(
    paths: Sequence[str | os.PathLike[str]], realizations: str | os.PathLike[str]
) -> list[Branch]:
    """Branches of OpenQuake's exports."""
    found = _realizations(realizations)
    for path in paths:
        number = _realization_of(path)
        if number not in found:
            raise InputError(f"{path}: realization {number} is not in {realizations}.")
        curve, _ = read_openquake(read_text(path, LARGEST_FILE), str(path))
        _add(curve, found[number], f"realization {number}", path)
    return list(found.values())


def _realizations(path: str | os.PathLike[str]) -> dict[int, Branch]:
    """Branches without curves, by the number of the realization."""
    table = read_table(path)
    if not {"rlz_id", "weight"} <= set(table.titles):
        raise InputError(
            f"{path}: expected OpenQuake's realizations with the columns rlz_id, branch_path and weight; found "
            f"{', '.join(table.titles)[:120] or 'nothing'}."
        )
    found: dict[int, Branch] = {}
    for row in table.rows(table.titles):
        try:
            number = int(row.cells["rlz_id"])
        except ValueError:
            raise row.error("rlz_id", "expected a whole number") from None
        if number in found:
            raise InputError(f"{path}: realization {number} is given twice.")
        name = f"rlz-{number:03d} {row.cells.get('branch_path', '')}".strip()
        found[number] = Branch(name, row.number("weight"))
    return found


_RLZ = re.compile(r"rlz-(\d+)")


def _realization_of(path: str | os.PathLike[str]) -> int:
    """Which realization a file of hazard curves is of: its first line says so, or its name."""
    head = read_text(path, LARGEST_FILE).partition("\n")[0]
    found = _RLZ.search(head) or _RLZ.search(Path(path).name)
    if found is None:
        raise InputError(
            f"{path}: neither its first line nor its name says which realization it is of (such as rlz-003); "
            "export with individual_rlzs = true."
        )
    return int(found[1])
