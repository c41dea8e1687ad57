"""What a reader learns first: what the thesis reports, what the model gives, why, and what would give it.

Sentences are made of tables alone, so that every number in them can be looked up there.
"""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd

from rockfrag.report.part import Finding
from rockfrag.report.wording import agree, counted, estimate, listed, of_all, sentence
from rockfrag.shaketable.definitions import DEFINITION
from rockfrag_thesis.hypotheses.floors import FIFTH, FLOORS, GROUND, THIRD
from rockfrag_thesis.hypotheses.hypothesis import Finding as Evidence
from rockfrag_thesis.pattern import perturbations_by_floor
from rockfrag_thesis.sections.inverse_problem import mechanism_name

REPORTED = (
    "The thesis reports that its towers overturn later with the pedestal than without it on the ground floor, "
    "significantly so, and slightly earlier on the 3rd and 5th floors; it prints no ratios."
)
"""Sections 4.3, 4.4 and 5 of the thesis."""

DISCOVERY_RATE = 0.05
"""Level of the false discovery rate at which a perturbation counts as changing the ratio [-]."""

MOST_NAMED = 3
"""So many perturbations are named with their ratios; the table has all."""

_REPORTS = "The thesis reports a gain on the ground floor"
_HEADLINES = {
    Evidence.FOR: f"{_REPORTS}; pure rocking reproduces it",
    Evidence.AGAINST: f"{_REPORTS}; pure rocking gives the opposite",
    Evidence.OPEN: f"{_REPORTS}; for pure rocking it is undecided",
    Evidence.BOUNDED: f"{_REPORTS}; for pure rocking a gain of 10 % or more is excluded, a smaller one is not",
}
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
    if not set(FLOORS) <= set(on_floors):
        return Finding(
            "The thesis reports an effect of the pedestal that depends on the floor",
            "",
            f"{REPORTED} For rigid blocks that only rock, the amplitude with pedestal divided by that without is "
            f"{_whole(effects)} (95 % interval over earthquakes); this study does not have the thesis’s floors.",
        )
    ratios = listed([f"{floor} {_ratio(on_floors[floor])}" for floor in FLOORS])
    pairs = counted(sum(int(on_floors[floor]["pairs"]) for floor in FLOORS), "pair")
    stated = {GROUND: (35, "a gain"), THIRD: (36, "a decrease"), FIFTH: (37, "a decrease")}
    outcomes = "; ".join(
        f"{floor}: {_ON_FLOOR[found[number]].format(change)}"
        for floor, (number, change) in stated.items()
    )
    return Finding(
        _HEADLINES[found[35]],
        "",
        f"{REPORTED} For rigid blocks that only rock, the amplitude with pedestal divided by that without is "
        f"{ratios}, and {_whole(effects)} over all {pairs} (95 % intervals over earthquakes). {outcomes}. A "
        f"difference between thesis and model implies an effect that the model omits.{_why(hypotheses)}",
    )


def _why(hypotheses: pd.DataFrame) -> str:
    """Why the pedestal matters so little in the model, where the simulations show it (C12)."""
    if hypotheses["estimate"].to_dict().get(12) != 1:
        return ""
    return (
        " In the model a landing of the statue lifts the pedestal so briefly that it stands still before "
        "the next one."
    )


def _what_would(sensitivity_analysis: pd.DataFrame) -> Finding:
    """Say which perturbations change the ratio, and which have the thesis's pattern."""
    table = perturbations_by_floor(sensitivity_analysis)
    simulated, computed = table[~table["arithmetic"]], table[table["arithmetic"]]
    patterned = list(table.loc[table["beyond_chance"], "name"])
    who = of_all(len(patterned), len(table), "perturbation")
    verb = agree(len(patterned), len(table), "produces", "produce")
    headline = f"{sentence(who)} of the model {verb} its pattern"
    words = []
    if patterned:
        words.append(
            "Ratios above 1 on the ground floor and below 1 on both floors above, intervals included: "
            f"{listed(patterned)}."
        )
    else:
        words.append(
            "No perturbation has intervals above 1 on the ground floor and below 1 on both floors above."
        )
    if len(simulated):
        words.append(_simulated_words(simulated))
    if len(computed):
        words.append(
            f"{sentence(counted(len(computed), 'other'))} {'is' if len(computed) == 1 else 'are'} arithmetic, not "
            f"simulation: a mass that is moved but not counted gives "
            f"{computed['ratio'].min():.3f} to {computed['ratio'].max():.3f} on all floors alike."
        )
    return Finding(headline, "", " ".join(words))


def _simulated_words(simulated: pd.DataFrame) -> str:
    """Which simulated perturbations change the ratio, by a rule that counts all of them."""
    changing = simulated[simulated["p_adjusted"] < DISCOVERY_RATE]
    rule = (
        f"Benjamini–Hochberg at {100 * DISCOVERY_RATE:g} % over {counted(len(simulated), 'test')}"
    )
    who = sentence(of_all(len(changing), len(simulated), "simulated perturbation"))
    verb = agree(len(changing), len(simulated), "changes", "change")
    words = f"{who} {verb} the ratio over all floors ({rule})"
    size = np.log(simulated["ratio"]).abs()
    largest = simulated.loc[size.nlargest(MOST_NAMED).index].to_dict("records")
    strong = [f"{row['name']} ({_ratio(row)})" for row in largest]
    return f"{words}; the largest {'is' if len(strong) == 1 else 'are'} {listed(strong)}."


def _inverted(inverse_problem: pd.DataFrame, wanted_percent: Mapping[str, float]) -> str:
    """Say which perturbation, or which two, come closest to the effect asked for, and how close."""
    places = {"ground": "on the ground", "above": "above it"}
    goal = listed(
        [
            f"{percent:+g} % {places[name]}".replace("-", "−")
            for name, percent in wanted_percent.items()
        ]
    )
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
    who = sentence(of_all(reached, len(inverse_problem), "mechanism"))
    verb = agree(reached, len(inverse_problem), "produces", "produce")
    return f"{who} (one perturbation, or two together) {verb} {goal}; {listed(nearest)}."


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
