"""The effect of the pedestal: ratios of amplitudes with and without it."""

from collections.abc import Hashable, Mapping
from typing import Any

import pandas as pd
from markupsafe import Markup

from rockfrag.report.figures.effects import forest_figure
from rockfrag.report.findings import pedestal_effect, ratio_of, ratio_text
from rockfrag.report.page import MOST_TABLE_ROWS, Column, table_html
from rockfrag.report.part import FigureSpec, Part, Results, Section, figure_of, section_of
from rockfrag.report.sections.words import sentences
from rockfrag.report.sides import WITH_PEDESTAL, Sides, sides_of
from rockfrag.report.wording import estimate, has_interval, number, probability, sentence
from rockfrag.shaketable.definitions import DEFINITION

MOST_ROWS = 45
"""More rows than this are not legible in one figure; the finest scopes are then left to the table."""

EFFECT_COLUMNS = (
    Column("scope", "Scope"),
    Column("level", "Of"),
    Column("pairs", "Pairs", 0),
    Column("at_bound", "of which bounds", 0),
    Column("ratio_text", "With/without pedestal [95 % interval]", numeric=True),
    Column("detectable_text", "Detectable ratio", numeric=True),
    Column("equivalent", "Within ±10 %"),
    Column("p_text", "p (Holm)", numeric=True),
)
"""What is shown of :func:`rockfrag.pedestal.study.effects_table` after :func:`shown_effects`."""

_METHODS = (
    Column("definition", "Definition"),
    Column("method", "Method"),
    Column("p_text", "p", numeric=True),
    Column("smallest_text", "Smallest possible p", numeric=True),
    Column("remark", "Remark"),
)


def shown_effects(effects: pd.DataFrame) -> pd.DataFrame:
    """Effects with texts to be shown: intervals and p values only where they say something."""
    rows = effects.to_dict("records")
    return effects.assign(
        scope=effects["scope"].replace(
            {"whole": "all pairs", "cell": "floor and object", "earthquake": "earthquake"}
        ),
        level=effects["level"].str.replace("/", ", "),
        ratio_text=[ratio_text(row) for row in rows],
        equivalent=["yes" if _width(row) and row["equivalent"] else "–" for row in rows],
        detectable_text=[
            number(row["detectable_ratio"], 2) if _width(row) else "–" for row in rows
        ],
        p_text=[probability(row["p_holm"]) if _width(row) else "–" for row in rows],
    )


def _width(row: Mapping[Hashable, Any]) -> bool:
    return has_interval(row["lower"], row["upper"], 3)


def _section(results: Results) -> Section:
    study = results.study
    effects, whole = results.table("pedestal/effects"), results.table("pedestal/whole")
    here = effects[effects["definition"] == DEFINITION]
    about = sides_of(study)
    found = pedestal_effect(effects, about)
    parts: list[Any] = []
    if len(here):
        methods = whole.assign(
            definition=whole["definition"].str.replace("_", " "),
            ratio_text=[
                estimate(row["estimate"], row["lower"], row["upper"], 3)
                for row in whole.to_dict("records")
            ],
            p_text=[probability(p) for p in whole["p"]],
            smallest_text=[probability(p) for p in whole["smallest_p"]],
        )
        parts = [
            _forest(here, about),
            _table(here, about),
            table_html(
                methods,
                [_METHODS[0], _METHODS[1], _ratio_column(about), *_METHODS[2:]],
                "All pairs, by other methods and other ways to read the amplitude.",
            ),
        ]
    notes = results.table("pedestal/notes")
    notes = notes[notes["definition"] == DEFINITION] if len(notes) else notes
    text = sentences().pedestal(found, about, study.counterparts, notes["note"])
    return section_of(text, "pedestal", parts)


def _ratio_column(about: Sides) -> Column:
    # a name that the user gave stays as it is
    title = sentence(about.ratio) if about is WITH_PEDESTAL else about.ratio
    return Column("ratio_text", f"{title} [95 % interval]", numeric=True)


def _table(effects: pd.DataFrame, about: Sides) -> Markup:
    caption = "Effect by scope, step protocol."
    if len(effects) > MOST_TABLE_ROWS:
        of_earthquakes = effects["scope"] == "earthquake"
        caption += f" Each of the {of_earthquakes.sum()} earthquakes is in pedestal/effects.csv."
        effects = effects[~of_earthquakes]
    columns = [
        _ratio_column(about) if column.name == "ratio_text" else column for column in EFFECT_COLUMNS
    ]
    return table_html(shown_effects(effects), columns, caption, "pedestal/effects.csv")


def _forest(effects: pd.DataFrame, about: Sides) -> FigureSpec:
    shown, left_out = effects, []
    for scope in ("cell", "earthquake"):
        if len(shown) > MOST_ROWS:
            shown = shown[shown["scope"] != scope]
            left_out.append({"cell": "floors by object", "earthquake": "earthquakes"}[scope])
    ratio = ratio_of(effects, about)("whole", "all")
    text = sentences().pedestal_effect_figure(about, left_out, ratio)
    return figure_of(text, "pedestal_effect", lambda: forest_figure(shown, about))


PEDESTAL = Part(
    ("pedestal/effects", "pedestal/whole", "pedestal/notes"),
    _section,
    asked=lambda study: study.has_pairs,
)
