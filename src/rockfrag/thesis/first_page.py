"""What a reader learns first: what the thesis reports, what the model gives, why, and what would.

Sentences are made of tables alone, so that every number in them can be looked up there.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from rockfrag.report.part import Finding
from rockfrag.report.sections.inversion import mechanism_name
from rockfrag.report.wording import counted, estimate, listed, of_all, sentence
from rockfrag.shaketable.readings import READING
from rockfrag.thesis.pattern import departures_by_floor
from rockfrag.thesis.statements.floors import FIFTH, FLOORS, GROUND, THIRD
from rockfrag.thesis.statements.statement import Finding as Evidence

REPORTED = (
    "It reports that its towers overturn later atop the pedestal than without it on the ground floor, "
    "significantly so, and slightly earlier on the 3rd and 5th floors; it prints no ratios."
)
"""Sections 4.3, 4.4 and 5 of the thesis."""

BEYOND_CHANCE = 0.05
"""Level of the false discovery rate at which a departure counts as changing the ratio [-]."""

MOST_NAMED = 3
"""So many departures are named with their ratios; the table has all."""

_HEADLINES = {
    Evidence.FOR: "The thesis reports a gain on the ground floor, and the model of pure rocking reproduces it",
    Evidence.AGAINST: "The thesis reports a gain on the ground floor that the model of pure rocking does "
    "not reproduce",
    Evidence.OPEN: "The thesis reports a gain on the ground floor; these simulations leave open whether the "
    "model of pure rocking gives one",
}


def first_page(
    effects: pd.DataFrame,
    claims: pd.DataFrame,
    explanation: pd.DataFrame | None = None,
    inversion: pd.DataFrame | None = None,
    wanted_percent: Mapping[str, float] | None = None,
) -> list[Finding]:
    """Say what the thesis reports, what the simulations of a study give, and what would give an effect.

    Parameters
    ----------
    effects
        Effects of the pedestal in the study's simulations, as
        :func:`rockfrag.stages.pedestal.pedestal_tables` returns them.
    claims
        The ledger of the study, columns of `rockfrag.thesis.statements.COLUMNS`.
    explanation
        Effects of departures from the ideal model, see `rockfrag.pedestal.explanation.explain`.
    inversion
        Departures that come closest to an effect that was asked for, see `rockfrag.pedestal.inversion.invert`.
    wanted_percent
        That effect, change of P/NP on the ``ground`` and ``above`` it [%].
    """
    here = effects[effects["reading"] == READING]
    found = [_reported(here, claims.set_index("number"))]
    if explanation is not None and len(explanation):
        found.append(_what_would(explanation))
        if inversion is not None and len(inversion) and wanted_percent:
            last = found[-1]
            found[-1] = Finding(
                last.headline, f"{last.text} {_inverted(inversion, wanted_percent)}"
            )
    return found


def _reported(effects: pd.DataFrame, claims: pd.DataFrame) -> Finding:
    """Say what the thesis reports beside what the model gives, and the ledger's words for it."""
    on_floors = {row["level"]: row for row in _rows(effects, "floor")}
    words = claims["verdict"].to_dict()
    if set(FLOORS) <= set(on_floors):
        ratios = listed([f"{floor} {_ratio(on_floors[floor])}" for floor in FLOORS])
        pairs = counted(sum(int(on_floors[floor]["pairs"]) for floor in FLOORS), "pair")
        given = f"have the ratios P/NP {ratios}, and over all {pairs} {_whole(effects)}"
        headline = _HEADLINES[Evidence(claims["finding"].to_dict()[35])]
    else:
        given = f"have the ratio P/NP {_whole(effects)}, without the thesis’s floors"
        headline = "The thesis reports an effect of the pedestal that depends on the floor"
    stated = {GROUND: words[35], THIRD: words[36], FIFTH: words[37]}
    verdicts = ", ".join(f"{floor} {word}" for floor, word in stated.items())
    return Finding(
        headline,
        f"{REPORTED} As rigid blocks that rock and do nothing else the same towers {given} (95 % intervals over "
        f"earthquakes): {verdicts}. Where the two differ, something acted in the laboratory that the model leaves "
        "out." + _why(claims),
    )


def _why(claims: pd.DataFrame) -> str:
    """Why the pedestal matters so little in the model, where the simulations show it (C12)."""
    if claims["estimate"].to_dict().get(12) != 1:
        return ""
    return " In the model a landing lifts the pedestal so briefly that it stands still before the next one."


def _what_would(explanation: pd.DataFrame) -> Finding:
    """Say which departures change the ratio beyond chance, and which have the thesis's pattern."""
    whole = departures_by_floor(explanation)
    changing = whole[whole["p_bh"] < BEYOND_CHANCE]
    patterned = list(whole.loc[whole["beyond_chance"], "name"])
    text = (
        f"Tried one at a time, {of_all(len(changing), len(whole), 'departure')} "
        f"{'changes' if 1 in (len(changing), len(whole)) else 'change'} P/NP over all floors beyond chance"
    )
    if len(changing):
        size = np.log(changing["ratio"]).abs()
        largest = changing.loc[size.nlargest(MOST_NAMED).index].to_dict("records")
        strong = [f"{row['name']} ({_ratio(row)})" for row in largest]
        text += f"{', most of all' if len(changing) > MOST_NAMED else ':'} {listed(strong)}"
    if patterned:
        headline = "Some departures from the ideal model have the thesis’s pattern"
        text += (
            f". With intervals above one on the ground floor and below one on both floors above: "
            f"{listed(patterned)}."
        )
    else:
        headline = "No departure from the ideal model tried has the thesis’s pattern"
        text += (
            ". None has intervals above one on the ground floor and below one on both floors above."
        )
    return Finding(headline, text)


def _inverted(inversion: pd.DataFrame, wanted_percent: Mapping[str, float]) -> str:
    """Say which departure, or which two, come closest to the effect asked for, and how close."""
    places = {"ground": "on the ground", "above": "above it"}
    goal = listed(
        [
            f"{percent:+g} % {places[name]}".replace("-", "−")
            for name, percent in wanted_percent.items()
        ]
    )
    everywhere = inversion[inversion["acts_on"] == "all floors"]
    pairs = everywhere["factor_2"] != ""
    local = inversion[inversion["acts_on"] != "all floors"]
    closest = [
        f"{_both(row, wanted_percent)} ({mechanism_name(row)}{_ACTING[row['acts_on']]})"
        for rows in (everywhere[~pairs], everywhere[pairs], local)
        for row in rows.head(1).to_dict("records")
    ]
    reached = int(inversion["reaches"].sum())
    who = sentence(of_all(reached, len(inversion), "mechanism"))
    return (
        f"{who}, one departure or two together, {'gives' if reached < 2 else 'give'} {goal}; the closest one, the "
        f"closest two, and the closest that acts at one place only give {listed(closest)}."
    )


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
