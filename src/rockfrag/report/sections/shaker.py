"""What the study's shaking table could do."""

from dataclasses import replace

from rockfrag.report.figures.shaker import shaker_limits
from rockfrag.report.page import Column, table_html
from rockfrag.report.part import FigureSpec, Part, Results, Section, section_of
from rockfrag.report.sections.words import sentences
from rockfrag.stages.shaker import LIMITED

_COLUMNS = (
    Column("motion", "Motion"),
    Column("travel_cm_per_g", "Peak to peak [cm/g]", 2),
    Column("excursion_cm_per_g", "From the start [cm/g]", 2),
    Column("limit_g", "Fits up to [g]", 3),
    Column("limited_by", "Limited by"),
)


def _section(results: Results) -> Section:
    limits, tests = results.table("shaker"), results.table("tests")
    limited = tests[tests["definition"] == LIMITED]
    ended = limited[limited["censored"] == "right"]
    free = results.tests[results.tests["censored"] == "right"]
    new = ended[~ended["test"].isin(free["test"])]
    names = [f"{row['test']} ({row['remark']})" for row in new.to_dict("records")]
    section = section_of(sentences().shaker(names, len(limited)), "shaker", [])
    figure = FigureSpec(
        "shaker_limits",
        section.message,
        "Peak up to which the shaking table can reproduce each motion (bars; behind each its limiting quantity: "
        "stroke, velocity, acceleration or force), and the peak that overturns each object.",
        lambda: shaker_limits(limits, results.tests),
    )
    caption = "What each motion requires of the shaking table, per g of its peak."
    return replace(section, parts=[figure, table_html(limits, _COLUMNS, caption, "shaker.csv")])


SHAKER = Part(("shaker", "tests"), _section, asked=lambda study: study.shaker is not None)
