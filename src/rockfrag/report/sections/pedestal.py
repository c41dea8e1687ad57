"""The effect of the pedestal: ratios of amplitudes with and without it."""

from typing import Any

import pandas as pd
from markupsafe import Markup

from rockfrag.report.figures.effects import forest_figure
from rockfrag.report.findings import pedestal_effect, ratio_of
from rockfrag.report.page import (
    MOST_TABLE_ROWS,
    Column,
    Row,
    by_row,
    estimated,
    p_values,
    table_html,
)
from rockfrag.report.part import FigureSpec, Part, Results, Section, figure_of, section_of
from rockfrag.report.sections.words import says
from rockfrag.report.sides import WITH_PEDESTAL, Sides, sides_of
from rockfrag.report.wording import has_interval, number, probability, sentence
from rockfrag.shaketable.definitions import DEFINITION

MOST_ROWS = 45
"""More rows than this are not legible in one figure; the finest scopes are then left to the table."""

_SCOPES = {"whole": "all pairs", "cell": "floor and object"}


def _width(row: Row) -> bool:
    return has_interval(row["lower"], row["upper"], 3)


def effect_columns(ratio: str = "With/without pedestal") -> list[Column]:
    """What is shown of :func:`rockfrag.pedestal.study.effects_table` after :func:`shown_effects`.

    Intervals and p values are shown only where they say something.
    """
    return [
        Column("scope", "Scope"),
        Column("level", "Of"),
        Column("pairs", "Pairs", 0),
        Column("at_bound", "of which bounds", 0),
        estimated("ratio", f"{ratio} [95 % interval]", 3, limits=("lower", "upper")),
        Column("detectable_ratio", "Detectable ratio", by_row(_detectable)),
        Column("within", "Within ±10 %"),
        Column("p_holm", "p (Holm)", by_row(_p)),
    ]


def _detectable(row: Row) -> str:
    return number(row["detectable_ratio"], 2) if _width(row) else "–"


def _p(row: Row) -> str:
    return probability(row["p_holm"]) if _width(row) else "–"


def shown_effects(effects: pd.DataFrame) -> pd.DataFrame:
    """Effects with scopes and levels in words."""
    within = (
        "yes" if _width(row) and row["equivalent"] else "–" for row in effects.to_dict("records")
    )
    return effects.assign(
        scope=effects["scope"].replace(_SCOPES),
        level=effects["level"].str.replace("/", ", "),
        within=list(within),
    )


def _section(results: Results) -> Section:
    study = results.study
    effects, whole = results.table("pedestal/effects"), results.table("pedestal/whole")
    here = effects[effects["definition"] == DEFINITION]
    about = sides_of(study)
    found = pedestal_effect(effects, about)
    # a name that the user gave stays as it is
    ratio = sentence(about.ratio) if about is WITH_PEDESTAL else about.ratio
    parts: list[Any] = []
    if len(here):
        methods = whole.assign(definition=whole["definition"].str.replace("_", " "))
        columns = [
            Column("definition", "Definition"),
            Column("method", "Method"),
            estimated("estimate", f"{ratio} [95 % interval]", 3, limits=("lower", "upper")),
            p_values("p", "p"),
            p_values("smallest_p", "Smallest possible p"),
            Column("remark", "Remark"),
        ]
        caption = "All pairs, by other methods and other ways to read the amplitude."
        parts = [_forest(here, about), _table(here, ratio), table_html(methods, columns, caption)]
    notes = results.table("pedestal/notes")
    notes = notes[notes["definition"] == DEFINITION] if len(notes) else notes
    return section_of(
        says.pedestal(found, about, study.counterparts, notes["note"]), "pedestal", parts
    )


def _table(effects: pd.DataFrame, ratio: str) -> Markup:
    caption = "Effect by scope, step protocol."
    if len(effects) > MOST_TABLE_ROWS:
        of_earthquakes = effects["scope"] == "earthquake"
        caption += f" Each of the {of_earthquakes.sum()} earthquakes is in pedestal/effects.csv."
        effects = effects[~of_earthquakes]
    file = "pedestal/effects.csv"
    return table_html(shown_effects(effects), effect_columns(ratio), caption, file)


def _forest(effects: pd.DataFrame, about: Sides) -> FigureSpec:
    shown, left_out = effects, []
    for scope, words in (("cell", "floors by object"), ("earthquake", "earthquakes")):
        if len(shown) > MOST_ROWS:
            shown = shown[shown["scope"] != scope]
            left_out.append(words)
    ratio = ratio_of(effects, about)("whole", "all")
    text = says.pedestal_effect_figure(about, left_out, ratio)
    return figure_of(text, "pedestal_effect", lambda: forest_figure(shown, about))


PEDESTAL = Part(_section, asked=lambda study: study.has_pairs)
