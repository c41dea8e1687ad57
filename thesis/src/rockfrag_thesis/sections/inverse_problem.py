"""Which perturbed parameters, alone and in pairs, would give the effect that a study asks for."""

import math
from collections.abc import Hashable, Mapping
from typing import Any

import pandas as pd

from rockfrag.report.page import Column, table_html
from rockfrag.report.part import Part, Results, Section, section_of
from rockfrag.report.wording import said, sentence
from rockfrag.study.study import Study
from rockfrag_thesis.sections.sensitivity_analysis import FACTORS, asks_sensitivity_analysis
from rockfrag_thesis.sections.words import sentences
from rockfrag_thesis.settings import settings_of

SHOWN = 12
"""Rows of the table, the closest first; the others are in ``sensitivity_analysis/inverse_problem.csv``."""

_COLUMNS = (
    Column("name", "Perturbed parameters, at the values that come closest"),
    Column("acts_on", "Acts on"),
    Column("ground", "With/without pedestal on the ground", 3),
    Column("above", "above it", 3),
    Column("together", "Both simulated together: ground, above", numeric=True),
    Column("excluded", "Ruled out"),
)


def asks_inverse_problem(study: Study) -> bool:
    """Whether a study asks what would give an effect, and has pairs that could show it."""
    settings = settings_of(study).sensitivity_analysis
    return (
        asks_sensitivity_analysis(study) and settings is not None and bool(settings.wanted_percent)
    )


def _section(results: Results) -> Section | None:
    table = results.table("sensitivity_analysis/inverse_problem")
    settings = settings_of(results.study).sensitivity_analysis
    if table.empty or settings is None:
        return None
    wanted = {name: 1 + percent / 100 for name, percent in settings.wanted_percent.items()}
    readable = table.assign(
        factor_1=table["factor_1"].map(_title), factor_2=table["factor_2"].map(_title)
    )
    rows = table.head(SHOWN).to_dict("records")
    shown = table.head(SHOWN).assign(
        name=[sentence(mechanism_name(row)) for row in rows],
        together=[_together(row) for row in rows],
        excluded=["no" if row["plausible"] else "yes" for row in rows],
    )
    columns = [
        column
        for column in _COLUMNS
        if column.name not in ("ground", "above") or column.name in wanted
    ]
    caption = f"The closest of {len(table)} mechanisms (single perturbed parameters and pairs)."
    text = sentences().inverse_problem(inverse_problem_words(readable, wanted))
    return section_of(text, "inverse_problem", [table_html(shown, columns, caption)])


def inverse_problem_words(table: pd.DataFrame, wanted: Mapping[str, float]) -> list[str]:
    """Say what would and what would not produce the wanted effect, the most important sentence first.

    Mechanisms are those of `rockfrag_thesis.sensitivity_analysis.inverse_problem.invert`, with readable names.
    """
    places = {"ground": "on the ground", "above": "above it"}
    asked = " and ".join(
        f"{100 * (value - 1):+.0f} % {places[name]}".replace("-", "−")
        for name, value in wanted.items()
    )
    can = table[table["reaches"]].to_dict("records")
    everywhere = [row for row in can if row["acts_on"] == "all floors"]
    alone = [row["factor_1"] for row in everywhere if not row["factor_2"]]
    pairs = [f"{row['factor_1']} with {row['factor_2']}" for row in everywhere if row["factor_2"]]
    local = [
        f"{row['factor_1']} {places[row['acts_on']]} alone" for row in can if row not in everywhere
    ]
    excluded, several = int((~table["plausible"]).sum()), len(wanted) > 1
    about = (asked, alone, pairs, several, local, excluded, len(table))
    return said(sentences().mechanisms(*about))


def _title(factor: str) -> str:
    return FACTORS[factor].title if factor else ""


def mechanism_name(row: Mapping[Hashable, Any]) -> str:
    """Name of one perturbed parameter or of two, with their values, of a row of the inverse problem."""
    return " together with ".join(
        _perturbation(row, number) for number in (1, 2) if row[f"factor_{number}"]
    )


def _perturbation(row: Mapping[Hashable, Any], number: int) -> str:
    return FACTORS[str(row[f"factor_{number}"])].at(f"{row[f'level_{number}']:.3g}")


def _together(row: Mapping[Hashable, Any]) -> str:
    values = [row.get("simulated_ground"), row.get("simulated_above")]
    known = [float(value) for value in values if isinstance(value, float) and math.isfinite(value)]
    return ", ".join(f"{number:.3f}" for number in known) if known else "–"


INVERSE_PROBLEM = Part(
    ("sensitivity_analysis/inverse_problem",), _section, asked=asks_inverse_problem
)
