"""The motions: how strong they are as recorded, and what their floors add."""

from rockfrag.motions.declared import intensity_measures
from rockfrag.report.figures.motion import MOST_PANELS, acceleration_histories
from rockfrag.report.page import Column, table_html
from rockfrag.report.part import Part, Results, Section, figure_of, section_of
from rockfrag.report.sections.words import sentences
from rockfrag.units import GRAVITY


def _columns() -> list[Column]:
    shown = [measure for measure in intensity_measures() if measure.decimals is not None]
    titles = (f"{measure.title or measure.label} [{measure.unit or '-'}]" for measure in shown)
    return [
        Column("name", "Motion"),
        *(
            Column(measure.column, title, measure.decimals)
            for measure, title in zip(shown, titles, strict=True)
        ),
    ]


def _section(results: Results) -> Section:
    measures, ground = results.table("measures"), results.ground
    caption = "Intensity of every motion as recorded."
    table = table_html(measures, _columns(), caption, "measures.csv")
    shown = min(len(ground), MOST_PANELS)
    peak = max(ground[:shown], key=lambda motion: motion.pga)
    records = len(results.records)
    text = sentences().accelerations_figure(shown, records, peak, peak.pga / GRAVITY)
    figure = figure_of(text, "accelerations", lambda: acceleration_histories(ground))
    floors = list(dict.fromkeys(measures["floor"]))
    text = sentences().motions(floors, results.study.building)
    return section_of(text, "motions", [table, figure])


MOTIONS = Part(("measures",), _section)
