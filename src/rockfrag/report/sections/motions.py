"""The motions: how strong they are as recorded, and what their floors add."""

from rockfrag.motions.declared import intensity_measures
from rockfrag.report.figures.motion import MOST_PANELS, acceleration_histories
from rockfrag.report.page import Column, table_html
from rockfrag.report.part import FigureSpec, Part, Results, Section
from rockfrag.report.wording import counted, listed
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
    measures = results.table("measures")
    table = table_html(
        measures, _columns(), "Intensity of every motion as recorded.", "measures.csv"
    )
    return Section("motions", "Motions", _floors(results), [], [table, _accelerations(results)])


def _floors(results: Results) -> str:
    study = results.study
    floors = list(dict.fromkeys(results.table("measures")["floor"]))
    if study.building is None:
        return "The records shake the objects directly, without a building."
    return (
        f"The motions of {counted(len(floors), 'floor')} ({listed(floors)}) are computed with a building model "
        f"({study.building.name})."
    )


def _accelerations(results: Results) -> FigureSpec:
    ground = results.ground
    shown = min(len(ground), MOST_PANELS)
    peak = max(ground[:shown], key=lambda motion: motion.pga)
    caption = "Ground accelerations over time; the dot marks the peak."
    if shown < len(results.records):
        caption += f" The first {shown} of {len(results.records)}; all are in the table."
    alt = (
        f"Ground accelerations of {counted(shown, 'record')}; the strongest, {peak.name}, peaks at "
        f"{peak.pga / GRAVITY:.2f} g."
    )
    return FigureSpec("accelerations", alt, caption, lambda: acceleration_histories(ground))


MOTIONS = Part(("measures",), _section)
