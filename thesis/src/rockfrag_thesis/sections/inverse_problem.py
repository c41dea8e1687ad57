"""Which perturbed parameters, alone and in pairs, would give the effect that a study asks for."""

import math
from collections.abc import Hashable, Mapping
from typing import Any

from rockfrag.report.page import Column, table_html
from rockfrag.report.part import Part, Results, Section
from rockfrag.report.wording import sentence
from rockfrag.study.study import Study
from rockfrag_thesis.sections.sensitivity_analysis import FACTORS, asks_sensitivity_analysis
from rockfrag_thesis.sensitivity_analysis.inverse_problem import inverse_problem_words
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
    first, *rest = inverse_problem_words(readable, wanted)
    columns = [
        column
        for column in _COLUMNS
        if column.name not in ("ground", "above") or column.name in wanted
    ]
    caption = f"The closest of {len(table)} mechanisms (single perturbed parameters and pairs)."
    return Section(
        "inverse_problem",
        "What would produce the effect asked for",
        first,
        [
            *rest,
            "Between the values tried, ln(with/without pedestal) is interpolated linearly; nothing is said "
            "beyond them. The changes of two parameters are added; the closest pairs, and friction at both "
            "interfaces, were also simulated together. A mechanism is ruled out if no value of it lies within "
            "the scatter between earthquakes (Hotelling’s T² at 5 %, Bonferroni over all mechanisms). Few "
            "earthquakes rule out little.",
        ],
        [table_html(shown, columns, caption)],
    )


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
