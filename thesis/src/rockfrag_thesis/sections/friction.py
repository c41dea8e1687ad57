"""What friction does to the effect of a pedestal."""

import math
from collections.abc import Mapping

import pandas as pd

from rockfrag.report.findings import ratio_text
from rockfrag.report.page import Column, Row, by_row, table_html
from rockfrag.report.part import Results, Section
from rockfrag_thesis.sections import says
from rockfrag_thesis.sections.inverse_problem import PLACES, goals
from rockfrag_thesis.settings import settings_of

ORDINARY = (0.3, 0.7)
"""Friction of dry wood, stone and mortar on each other, as handbooks of engineering give it [-]."""

Means = Mapping[tuple[float, float], Row]
"""Mean ratios with their intervals, by the coefficients at the ground and at the interface."""


def _coefficient(value: float) -> str:
    return "∞" if math.isinf(value) else f"{value:g}"


def _ratio(row: Row | None) -> str:
    return ratio_text(row) if row is not None and math.isfinite(row["ratio"]) else "–"


_COLUMNS = (
    Column(
        "ground",
        "Friction at the ground",
        by_row(lambda row: _coefficient(row["ground"])),
    ),
    Column(
        "interface",
        "between pedestal and object",
        by_row(lambda row: _coefficient(row["interface"])),
    ),
    Column(
        "here",
        "With/without pedestal on the ground [95 % interval]",
        by_row(lambda row: _ratio(row["here"])),
    ),
    Column("above", "above it", by_row(lambda row: _ratio(row["above"]))),
    Column("left_out", "Pairs without overturning", 0),
)


def friction(results: Results) -> Section | None:
    """What friction does to the ratio; None where the study does not ask it."""
    if not (settings_of(results.study).friction and results.study.has_pairs):
        return None
    effects = results.table("sensitivity_analysis/friction")
    tables = {place: _by_pair(effects, place) for place in PLACES}
    ground, above = tables.values()
    if not ground:
        return None
    rows = [
        {
            "ground": pair[0],
            "interface": pair[1],
            "here": ground[pair],
            "above": above.get(pair),
            "left_out": sum(
                table[pair]["left_out"] for table in tables.values() if pair in table
            ),
        }
        for pair in ground
    ]
    caption = "Ratio of overturning amplitudes with/without pedestal by friction."
    table = table_html(pd.DataFrame(rows), _COLUMNS, caption)
    words = _found(tables, settings_of(results.study).wanted_percent)
    return says.section("friction", [table], words)


def _by_pair(effects: pd.DataFrame, place: str) -> Means:
    rows = effects[(effects["object"] == "all") & (effects["place"] == place)].to_dict(
        "records"
    )
    return {(float(row["ground"]), float(row["interface"])): row for row in rows}


def _is_ordinary(pair: tuple[float, float]) -> bool:
    return all(ORDINARY[0] <= mu <= ORDINARY[1] for mu in pair)


def _found(tables: Mapping[str, Means], wanted: Mapping[str, float]) -> list[str]:
    """Say how far the mean ratio goes with ordinary friction, and with which it has the signs asked for."""
    ordinary = []
    for place, table in tables.items():
        inside = [row["ratio"] for pair, row in table.items() if _is_ordinary(pair)]
        inside = [ratio for ratio in inside if math.isfinite(ratio)]
        if inside:
            ordinary.append(f"{min(inside):.2f} to {max(inside):.2f} {PLACES[place]}")
    asked = [(tables[name], percent) for name, percent in wanted.items()]

    def has_signs(pair: tuple[float, float], rising: str, falling: str) -> bool:
        ends = [
            (table[pair][rising if goal > 0 else falling], goal)
            for table, goal in asked
        ]
        return all(
            math.isfinite(end) and goal * math.log(end) > 0 for end, goal in ends
        )

    known = tables["ground"] if asked and all(table for table, _ in asked) else {}
    signs = [pair for pair in known if has_signs(pair, "ratio", "ratio")]
    clear = [pair for pair in signs if has_signs(pair, "lower", "upper")]
    goal = " and ".join(goals(wanted)) if known else ""
    named = [
        f"{_coefficient(first)} and {_coefficient(other)}" for first, other in signs
    ]
    usual = sum(map(_is_ordinary, signs))
    about = (ordinary, *ORDINARY, goal, len(tables["ground"]), named, len(clear), usual)
    return says("friction_found", *about)
