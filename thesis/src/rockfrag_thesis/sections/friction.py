"""Effect of friction on the effect of a pedestal.

In: the table ``sensitivity_analysis/friction``, ratios with over without pedestal [-] by coefficients of
friction [-]. Out: a section of the report. Theory: ``docs/contact.md``, "Which friction would give an effect of
the pedestal".
"""

import math
from collections.abc import Mapping, Sequence

import pandas as pd

from rockfrag.report.findings import ratio_text
from rockfrag.report.page import Column, Row, by_row, table_html
from rockfrag.report.part import Results, Section
from rockfrag.words.sentences import listed
from rockfrag_thesis.sections.inverse_problem import PLACES, goals
from rockfrag_thesis.settings import settings_of

ORDINARY = (0.3, 0.7)
"""Friction of dry wood, stone and mortar on each other, as handbooks of engineering give it [-]."""

MOST_PAIRS = 6  # so many pairs of coefficients are named

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
    found = _found(tables, settings_of(results.study).wanted_percent)
    reading = (
        "Bodies slide, rock and fly on surfaces with these friction coefficients, with the amplitudes of the "
        "protocol. Without pedestal an object stands on the ground. A pair has no ratio where nothing overturns "
        "with or without the pedestal: a body slides and never rocks if the friction coefficient is below its "
        "width over its height."
    )
    return Section(
        "friction",
        "What friction does to the effect of the pedestal",
        found[0] if found else "The ratio is known for these friction coefficients.",
        [*found[1:], reading],
        [table],
    )


def _by_pair(effects: pd.DataFrame, place: str) -> Means:
    rows = effects[(effects["object"] == "all") & (effects["place"] == place)].to_dict(
        "records"
    )
    return {(float(row["ground"]), float(row["interface"])): row for row in rows}


def _is_ordinary(pair: tuple[float, float]) -> bool:
    return all(ORDINARY[0] <= mu <= ORDINARY[1] for mu in pair)


def _found(tables: Mapping[str, Means], wanted: Mapping[str, float]) -> list[str]:
    """Mean ratios with ordinary friction, and coefficients that give the signs asked for, in sentences."""
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
    words = []
    if ordinary:
        words.append(
            f"Friction of ordinary surfaces ({ORDINARY[0]} to {ORDINARY[1]}) changes the mean ratio to "
            f"{listed(ordinary)}."
        )
    if known:
        words.append(
            _signs_sentence(" and ".join(goals(wanted)), len(known), signs, clear)
        )
    return words


Pair = tuple[float, float]
"""Coefficients of friction at the ground and at the interface [-]."""


def _signs_sentence(
    goal: str, pairs: int, signs: Sequence[Pair], clear: Sequence[Pair]
) -> str:
    """Pairs of coefficients with the signs asked for, and those whose intervals have them too."""
    if not signs:
        return f"No pair of friction coefficients gives the signs asked for ({goal})."
    named = [
        f"{_coefficient(first)} and {_coefficient(other)}" for first, other in signs
    ]
    among = " among them" if len(named) > MOST_PAIRS else ""
    return (
        f"{len(signs)} of {pairs} pairs of friction coefficients (ground, interface) give the signs asked for "
        f"({goal}): {listed(named[:MOST_PAIRS])}{among}. The intervals have these signs too in {len(clear)}; "
        f"{sum(map(_is_ordinary, signs))} are of ordinary surfaces."
    )
