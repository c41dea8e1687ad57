"""What a study that keeps going went on without."""

from rockfrag.report.page import Column, table_html
from rockfrag.report.part import Part, Results, Section
from rockfrag.report.wording import counted, listed

_COLUMNS = (Column("motion", "Record"), Column("reason", "Why it could not be used"))
_MOST_NAMED = 5


def _section(results: Results) -> Section | None:
    table = results.table("left_out")
    if table.empty:
        return None
    names = list(table["motion"])
    named = listed(names) if len(names) <= _MOST_NAMED else f"{names[0]}, {names[1]} and others"
    message = (
        f"{len(names)} of {counted(len(results.study.catalogue), 'record')} could not be used: {named}. "
        "This page describes the others."
    )
    shown = table_html(table, _COLUMNS, "Records that could not be used.", "left_out.csv")
    return Section("left-out", "Left out", message, [], [shown])


LEFT_OUT = Part(("left_out",), _section, asked=lambda study: study.keep_going)
