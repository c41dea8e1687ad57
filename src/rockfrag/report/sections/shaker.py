"""What the study's shaking table could do."""

from rockfrag.report.figures.shaker import shaker_limits
from rockfrag.report.page import Column, table_html
from rockfrag.report.part import FigureSpec, Part, Results, Section
from rockfrag.report.wording import listed, of_all, sentence
from rockfrag.stages.shaker import LIMITED
from rockfrag.study.study import Study

_COLUMNS = (
    Column("motion", "Motion"),
    Column("travel_cm_per_g", "Peak to peak [cm/g]", 2),
    Column("excursion_cm_per_g", "From the start [cm/g]", 2),
    Column("limit_g", "Fits up to [g]", 3),
    Column("limited_by", "Limited by"),
)


def _asked(study: Study) -> bool:
    return study.more.shaker is not None


def _section(results: Results) -> Section:
    limits, tests = results.table("shaker"), results.table("tests")
    limited = tests[tests["reading"] == LIMITED]
    ended = limited[limited["censored"] == "right"]
    free = results.tests[results.tests["censored"] == "right"]
    new = ended[~ended["test"].isin(free["test"])]
    names = [f"{row['test']} ({row['remark']})" for row in new.to_dict("records")]
    words = (
        f"With the shaker’s limits {of_all(len(new), len(limited), 'test')} "
        f"{'ends' if len(new) == 1 else 'end'} before the object overturns: {listed(names)}."
        if len(new)
        else "The shaker’s limits end no test before the object overturns."
    )
    figure = FigureSpec(
        "shaker_limits",
        sentence(words),
        "Peak up to which each motion fits the shaker (bars), and the peak up to which objects "
        "stand without a limit.",
        lambda: shaker_limits(limits, results.tests),
    )
    return Section(
        "shaker",
        "What the shaking table could do",
        words,
        [
            "The reading “step protocol shaker” carries this through the statistics of the pedestal; the "
            "other readings are free of it, since where the table starts is an assumption.",
        ],
        [
            figure,
            table_html(
                limits,
                _COLUMNS,
                "What each motion asks of the shaker per g of its peak.",
                "shaker.csv",
            ),
        ],
    )


SHAKER = Part(("shaker", "tests"), _section, asked=_asked)
