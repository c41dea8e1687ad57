"""The thesis's hypotheses on floors where the building is another."""

from functools import partial

import pandas as pd

from rockfrag.report.page import Column, table_html
from rockfrag.report.part import FigureSpec, Part, Results, Section
from rockfrag.report.wording import number
from rockfrag.shaketable.definitions import DEFINITION
from rockfrag_thesis.figures.building import AXIS_NAMES
from rockfrag_thesis.figures.floors import floor_hypotheses, floor_order
from rockfrag_thesis.sections.building import varies_building

_COLUMNS = (
    Column("axis", "Assumption"),
    Column("hypothesis", "Hypothesis"),
    Column("min", "Least margin [%]", 1),
    Column("max", "Largest margin [%]", 1),
)


def _section(results: Results) -> Section:
    margins = results.table("building_sensitivity/margins")
    rows = margins[margins["definition"] == DEFINITION]
    order = rows[(rows["axis"] == "first_period_s") & (rows["hypothesis"] == "order")]
    holds = [f"{value:g} s" for value in order.loc[order["margin"] > 0.02, "value"]]
    words = "The thesis’s order of the floors, ground highest and 3rd lowest, "
    words += (
        f"appears by more than 2 % at {len(holds)} of {len(order)} first periods tried ({', '.join(holds)})."
        if holds
        else f"does not appear by more than 2 % at any of {len(order)} first periods tried."
    )
    varied = rows[rows["axis"] != "reference"]
    span = varied.groupby(["axis", "hypothesis"], sort=False)["margin"].agg(["min", "max"])
    # adding zero turns a negative zero into a plain one
    shown = ((100 * span).round(1) + 0.0).reset_index()
    shown["axis"] = shown["axis"].map(AXIS_NAMES)
    axes = list(dict.fromkeys(varied["axis"]))
    return Section(
        "sensitivity",
        "The thesis’s floors in other buildings",
        words if len(order) else _span_words(span),
        [],
        [
            *([_order(results, words)] if len(order) else []),
            *(_hypotheses(results, axis) for axis in axes),
            table_html(shown, _COLUMNS, "Range of the margins of each hypothesis."),
        ],
    )


def _span_words(span: pd.DataFrame) -> str:
    low, high = (100 * float(value) for value in (span["min"].min(), span["max"].max()))
    return f"Margins of the hypotheses lie between {number(low, 1)} and {number(high, 1)} %."


def _order(results: Results, words: str) -> FigureSpec:
    means = results.table("building_sensitivity/means")
    margins = results.table("building_sensitivity/margins")
    return FigureSpec(
        "sensitivity_order",
        words,
        "Mean overturning amplitude of lone objects on each floor over the first period of the "
        "building; shaded where the order is the thesis’s.",
        lambda: floor_order(means, margins, DEFINITION),
    )


def _hypotheses(results: Results, axis: str) -> FigureSpec:
    margins = results.table("building_sensitivity/margins")
    return FigureSpec(
        f"sensitivity_hypotheses_{axis}",
        f"Margins of the thesis’s hypotheses on floors over {AXIS_NAMES[axis]}.",
        "Margin by which each hypothesis on floors is true (positive) or false; dots: true by more than 2 %. "
        f"{AXIS_NAMES[axis]}.",
        partial(floor_hypotheses, margins, axis, DEFINITION),
    )


FLOOR_ORDER = Part(
    ("building_sensitivity/margins", "building_sensitivity/means"),
    _section,
    asked=varies_building,
)
