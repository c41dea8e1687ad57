"""Inverse problem: perturbed parameters, alone and in pairs, that would give the effect that a study asks for.

In: the table ``sensitivity_analysis/inverse_problem``, ratios with over without pedestal [-]. Out: a section of
the report. Theory: ``docs/pedestal.md``, "What could produce an effect".
"""

import math
from collections.abc import Mapping

import pandas as pd

from rockfrag.report.page import Column, Row, by_row, table_html
from rockfrag.report.part import Results, Section
from rockfrag.study.study import Study
from rockfrag.words.sentences import sentence
from rockfrag_thesis.sections.sensitivity_analysis import (
    FACTORS,
    asks_sensitivity_analysis,
)
from rockfrag_thesis.settings import settings_of

SHOWN = 12
"""Rows of the table, the closest first; the others are in ``sensitivity_analysis/inverse_problem.csv``."""


MOST_NAMED = 3  # so many mechanisms of a kind are named


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
    found, *others = inverse_problem_words(readable, wanted)
    reading = (
        "Between the values tried, ln(with/without pedestal) is interpolated linearly; nothing is said beyond "
        "them. The changes of two parameters are added; the closest pairs, and friction at both interfaces, "
        "were also simulated together. A mechanism is ruled out if no value of it lies within the scatter between "
        "earthquakes (Hotelling’s T² at 5 %, Bonferroni over all mechanisms). Few earthquakes rule out little."
    )
    return Section(
        "inverse_problem",
        "What would produce the effect asked for",
        found,
        [*others, reading],
        [table_html(shown, columns, caption)],
    )


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
    """Mechanisms that would and that would not produce the wanted effect, the most important sentence first.

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
    words = []
    if alone or pairs:
        subject = "No single perturbed parameter"
        if alone:
            subject = sentence(f"{', '.join(alone)} alone")
        words.append(f"{subject} can produce {asked} within the values tried.")
        can_pairs = f"Pairs that can: {'; '.join(pairs[:MOST_NAMED])}."
        words.append(can_pairs if pairs else "No pair can.")
    else:
        words.append(
            f"No perturbed parameter, alone or with a second one, produces {asked} within the values tried."
        )
    if len(wanted) > 1 and local:
        named = ", ".join(local[:MOST_NAMED])
        words.append(f"Mechanisms that act at one place only and can: {named}.")
    elif len(wanted) > 1:
        words.append(
            "No mechanism that acts on the ground alone, or above it alone, can."
        )
    excluded = int((~table["plausible"]).sum())
    words.append(
        f"The scatter between earthquakes rules out {excluded or 'none'} of the {len(table)} mechanisms tried."
    )
    return words


def mechanism_name(row: Row) -> str:
    """Name of one perturbed parameter or of two, with their values, of a row of the inverse problem."""
    return " together with ".join(
        FACTORS[row[f"factor_{number}"]].at(f"{row[f'level_{number}']:.3g}")
        for number in (1, 2)
        if row[f"factor_{number}"]
    )
