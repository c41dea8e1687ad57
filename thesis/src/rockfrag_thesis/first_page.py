"""What a reader learns first: what the thesis reports, what the model gives, why, and what would give it.

Sentences are made of tables alone, so that every number in them can be looked up there.
"""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd

from rockfrag.report.part import Finding, finding_of
from rockfrag.report.wording import estimate, listed, one_line
from rockfrag.shaketable.definitions import DEFINITION
from rockfrag_thesis.hypotheses.floors import FIFTH, FLOORS, GROUND, THIRD
from rockfrag_thesis.hypotheses.hypothesis import Finding as Evidence
from rockfrag_thesis.pattern import perturbations_by_floor
from rockfrag_thesis.sections.inverse_problem import mechanism_name
from rockfrag_thesis.sections.words import sentences

DISCOVERY_RATE = 0.05
"""Level of the false discovery rate at which a perturbation counts as changing the ratio [-]."""

MOST_NAMED = 3
"""So many perturbations are named with their ratios; the table has all."""

_ON_FLOOR = {
    Evidence.FOR: "reproduced",
    Evidence.AGAINST: "not reproduced",
    Evidence.OPEN: "undecided",
    Evidence.BOUNDED: "{} of 10 % or more is excluded, a smaller one is not",
}


def first_page(
    effects: pd.DataFrame,
    hypotheses: pd.DataFrame,
    sensitivity_analysis: pd.DataFrame | None = None,
    inverse_problem: pd.DataFrame | None = None,
    wanted_percent: Mapping[str, float] | None = None,
) -> list[Finding]:
    """Say what the thesis reports, what the simulations of a study give, and what would give an effect.

    ``effects`` are of the study's simulations, ``hypotheses`` the table of all, ``sensitivity_analysis`` the
    effects of perturbed parameters, ``inverse_problem`` those that come closest to ``wanted_percent``, the change
    of P/NP on the ``ground`` and ``above`` it [%].
    """
    here = effects[effects["definition"] == DEFINITION]
    found = [_reported(here, hypotheses.set_index("number"))]
    if sensitivity_analysis is not None and len(sensitivity_analysis):
        found.append(_what_would(sensitivity_analysis))
        if inverse_problem is not None and len(inverse_problem) and wanted_percent:
            last = found[-1]
            found[-1] = replace(
                last, numbers=f"{last.numbers} {_inverted(inverse_problem, wanted_percent)}"
            )
    return found


def _reported(effects: pd.DataFrame, hypotheses: pd.DataFrame) -> Finding:
    """Say what the thesis reports beside what the model gives, and the table of hypotheses's words for it."""
    on_floors = {row["level"]: row for row in _rows(effects, "floor")}
    found = {number: Evidence(value) for number, value in hypotheses["finding"].items()}
    whole = _whole(effects)
    if not set(FLOORS) <= set(on_floors):
        return finding_of(sentences().other_floors(whole))
    ratios = [f"{floor} {_ratio(on_floors[floor])}" for floor in FLOORS]
    pairs = sum(int(on_floors[floor]["pairs"]) for floor in FLOORS)
    stated = {GROUND: (35, "a gain"), THIRD: (36, "a decrease"), FIFTH: (37, "a decrease")}
    outcomes = [
        f"{floor}: {_ON_FLOOR[found[number]].format(change)}"
        for floor, (number, change) in stated.items()
    ]
    # the pedestal matters so little where C12 is true of all landings
    lifts_briefly = hypotheses["estimate"].to_dict().get(12) == 1
    about = (found[35].name, ratios, whole, pairs, outcomes, lifts_briefly)
    return finding_of(sentences().reported(*about))


def _what_would(sensitivity_analysis: pd.DataFrame) -> Finding:
    """Say which perturbations change the ratio, and which have the thesis's pattern."""
    table = perturbations_by_floor(sensitivity_analysis)
    simulated, computed = table[~table["arithmetic"]], table[table["arithmetic"]]
    patterned = list(table.loc[table["beyond_chance"], "name"])
    changing = simulated[simulated["p_adjusted"] < DISCOVERY_RATE]
    size = np.log(simulated["ratio"]).abs()
    largest = simulated.loc[size.nlargest(MOST_NAMED).index].to_dict("records")
    strong = [f"{row['name']} ({_ratio(row)})" for row in largest]
    counts = (len(table), len(changing), len(simulated))
    return finding_of(
        sentences().what_would(patterned, *counts, DISCOVERY_RATE, strong, computed["ratio"])
    )


def _inverted(inverse_problem: pd.DataFrame, wanted_percent: Mapping[str, float]) -> str:
    """Say which perturbation, or which two, come closest to the effect asked for, and how close."""
    places = {"ground": "on the ground", "above": "above it"}
    goal = [
        f"{percent:+g} % {places[name]}".replace("-", "−")
        for name, percent in wanted_percent.items()
    ]
    everywhere = inverse_problem[inverse_problem["acts_on"] == "all floors"]
    pairs = everywhere["factor_2"] != ""
    local = inverse_problem[inverse_problem["acts_on"] != "all floors"]
    nearest = [
        f"the closest {what} gives {_both(row, wanted_percent)} ({mechanism_name(row)}{_ACTING[row['acts_on']]})"
        for what, rows in (
            ("single one", everywhere[~pairs]),
            ("pair", everywhere[pairs]),
            ("one acting at one place only", local),
        )
        for row in rows.head(1).to_dict("records")
    ]
    reached = int(inverse_problem["reaches"].sum())
    return one_line(sentences().inverted(reached, len(inverse_problem), goal, nearest))


_ACTING = {"all floors": "", "ground": " on the ground alone", "above": " above the ground alone"}


def _both(row: Mapping[Any, Any], wanted: Mapping[str, float]) -> str:
    return listed([f"{row[name]:.3f}" for name in wanted])


def _rows(effects: pd.DataFrame, scope: str) -> list[dict[Any, Any]]:
    return effects[effects["scope"] == scope].to_dict("records")


def _whole(effects: pd.DataFrame) -> str:
    rows = _rows(effects, "whole")
    return _ratio(rows[0]) if rows else "no pair with both amplitudes known"


def _ratio(row: Mapping[Any, Any]) -> str:
    return estimate(row["ratio"], row["lower"], row["upper"], 3)
