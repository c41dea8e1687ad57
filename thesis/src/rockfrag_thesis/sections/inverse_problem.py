"""Which perturbed parameters, alone and in pairs, would give the effect that a study asks for."""

import math
from collections.abc import Mapping

import pandas as pd

from rockfrag.report.page import Column, Row, by_row, table_html
from rockfrag.report.part import Results, Section
from rockfrag.study.study import Study
from rockfrag.words.sentences import sentence
from rockfrag_thesis.sections import says
from rockfrag_thesis.sections.sensitivity_analysis import (
    FACTORS,
    asks_sensitivity_analysis,
)
from rockfrag_thesis.settings import settings_of

SHOWN = 12
"""Rows of the table, the closest first; the others are in ``sensitivity_analysis/inverse_problem.csv``."""


def _together(row: Row) -> str:
    values = [row.get("simulated_ground"), row.get("simulated_above")]
    known = [
        float(value)
        for value in values
        if isinstance(value, float) and math.isfinite(value)
    ]
    return ", ".join(f"{number:.3f}" for number in known) or "–"


_COLUMNS = (
    Column("name", "Perturbed parameters, at the values that come closest"),
    Column("acts_on", "Acts on"),
    Column("ground", "With/without pedestal on the ground", 3),
    Column("above", "above it", 3),
    Column("together", "Both simulated together: ground, above", by_row(_together)),
    Column("excluded", "Ruled out"),
)


def asks_inverse_problem(study: Study) -> bool:
    """Whether a study asks what would give an effect, and has pairs that could show it."""
    return asks_sensitivity_analysis(study) and bool(settings_of(study).wanted_percent)


def inverse_problem(results: Results) -> Section | None:
    """What would give the effect asked for; None where the study asks for none."""
    if not asks_inverse_problem(results.study):
        return None
    table = results.table("sensitivity_analysis/inverse_problem")
    if table.empty:
        return None
    percents = settings_of(results.study).wanted_percent
    wanted = {name: 1 + percent / 100 for name, percent in percents.items()}
    titles = {"": ""} | {name: factor.title for name, factor in FACTORS.items()}
    readable = table.assign(
        **{name: table[name].map(titles) for name in ("factor_1", "factor_2")}
    )
    shown = table.head(SHOWN)
    shown = shown.assign(
        name=[sentence(mechanism_name(row)) for row in shown.to_dict("records")],
        excluded=shown["plausible"].map({True: "no", False: "yes"}),
    )
    left_out = {"ground", "above"} - set(wanted)
    columns = [column for column in _COLUMNS if column.name not in left_out]
    caption = f"The closest of {len(table)} mechanisms (single perturbed parameters and pairs)."
    words = inverse_problem_words(readable, wanted)
    return says.section("inverse_problem", [table_html(shown, columns, caption)], words)


PLACES = {"ground": "on the ground", "above": "above it"}


def goals(wanted_percent: Mapping[str, float]) -> list[str]:
    """The changes of P/NP that are asked for [%], in words."""
    return [
        f"{percent:+g} % {PLACES[name]}".replace("-", "−")
        for name, percent in wanted_percent.items()
    ]


def inverse_problem_words(
    table: pd.DataFrame, wanted: Mapping[str, float]
) -> list[str]:
    """Say what would and what would not produce the wanted effect, the most important sentence first.

    Mechanisms are those of `rockfrag_thesis.sensitivity_analysis.inverse_problem.invert`, with readable names.
    """
    asked = " and ".join(
        goals({name: round(100 * (wanted[name] - 1)) for name in wanted})
    )
    can = table[table["reaches"]].to_dict("records")
    everywhere = [row for row in can if row["acts_on"] == "all floors"]
    alone = [row["factor_1"] for row in everywhere if not row["factor_2"]]
    pairs = [
        f"{row['factor_1']} with {row['factor_2']}"
        for row in everywhere
        if row["factor_2"]
    ]
    local = [
        f"{row['factor_1']} {PLACES[row['acts_on']]} alone"
        for row in can
        if row not in everywhere
    ]
    excluded, several = int((~table["plausible"]).sum()), len(wanted) > 1
    return says("mechanisms", asked, alone, pairs, several, local, excluded, len(table))


def mechanism_name(row: Row) -> str:
    """Name of one perturbed parameter or of two, with their values, of a row of the inverse problem."""
    return " together with ".join(
        FACTORS[row[f"factor_{number}"]].at(f"{row[f'level_{number}']:.3g}")
        for number in (1, 2)
        if row[f"factor_{number}"]
    )
