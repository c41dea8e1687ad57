"""The thesis's hypotheses on floors where the building is another."""

from dataclasses import replace
from functools import partial

from markupsafe import Markup

from rockfrag.report.page import Column, table_html
from rockfrag.report.part import FigureSpec, Part, Results, Section, figure_of, section_of
from rockfrag.shaketable.definitions import DEFINITION
from rockfrag_thesis.figures.building import AXIS_NAMES
from rockfrag_thesis.figures.floors import floor_hypotheses, floor_order
from rockfrag_thesis.sections.building import varies_building
from rockfrag_thesis.sections.words import sentences

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
    varied = rows[rows["axis"] != "reference"]
    span = varied.groupby(["axis", "hypothesis"], sort=False)["margin"].agg(["min", "max"])
    # adding zero turns a negative zero into a plain one
    shown = ((100 * span).round(1) + 0.0).reset_index()
    shown["axis"] = shown["axis"].map(AXIS_NAMES)
    ends = (100 * float(value) for value in (span["min"].min(), span["max"].max()))
    section = section_of(sentences().floor_order(holds, len(order), *ends), "sensitivity", [])
    parts: list[Markup | FigureSpec] = []
    if len(order):
        means = results.table("building_sensitivity/means")
        draw = partial(floor_order, means, margins, DEFINITION)
        text = sentences().order_figure(section.message)
        parts.append(figure_of(text, "sensitivity_order", draw))
    for axis in dict.fromkeys(varied["axis"]):
        draw = partial(floor_hypotheses, margins, axis, DEFINITION)
        text = sentences().margins_figure(AXIS_NAMES[axis])
        parts.append(figure_of(text, f"sensitivity_hypotheses_{axis}", draw))
    parts.append(table_html(shown, _COLUMNS, "Range of the margins of each hypothesis."))
    return replace(section, parts=parts)


FLOOR_ORDER = Part(
    ("building_sensitivity/margins", "building_sensitivity/means"), _section, asked=varies_building
)
