"""What the study's shaking table could do."""

from rockfrag.report.figures.shaker import shaker_limits
from rockfrag.report.page import Column, table_html
from rockfrag.report.part import FigureSpec, Part, Results, Section
from rockfrag.report.wording import listed, of_all
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
    words = (
        f"The shaking table’s limits end {of_all(len(new), len(limited), 'test')} before the object overturns."
        if len(new)
        else "The shaking table’s limits end no test before the object overturns."
    )
    figure = FigureSpec(
        "shaker_limits",
        words,
        "Peak up to which the shaking table can reproduce each motion (bars; behind each its limiting quantity: "
        "stroke, velocity, acceleration or force), and the peak that overturns each object.",
        lambda: shaker_limits(limits, results.tests),
    )
    return Section(
        "shaker",
        "What the shaking table could do",
        words,
        [
            *([f"These are {listed(names)}."] if names else []),
            "The definition “step protocol shaker” of the pedestal’s effect includes these limits. The other "
            "definitions do not, because the position at which the table starts is an assumption.",
        ],
        [
            figure,
            table_html(
                limits,
                _COLUMNS,
                "What each motion requires of the shaking table, per g of its peak.",
                "shaker.csv",
            ),
        ],
    )


SHAKER = Part(("shaker", "tests"), _section, asked=lambda study: study.shaker is not None)
