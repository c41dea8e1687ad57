"""What a study that keeps going went on without."""

from rockfrag.report.page import Column, table_html
from rockfrag.report.part import Part, Results, Section, section_of
from rockfrag.report.sections.words import sentences

_COLUMNS = (Column("motion", "Record"), Column("reason", "Why it could not be used"))
_MOST_NAMED = 5


def _section(results: Results) -> Section | None:
    table = results.table("left_out")
    if table.empty:
        return None
    shown = table_html(table, _COLUMNS, "Records that could not be used.", "left_out.csv")
    names, records = list(table["motion"]), len(results.study.catalogue)
    return section_of(sentences().left_out(names, records, _MOST_NAMED), "left-out", [shown])


LEFT_OUT = Part(("left_out",), _section, asked=lambda study: study.keep_going)
