"""The motions: how strong they are as recorded, and what their floors add."""

from rockfrag.report.figures.motion import MOST_PANELS, acceleration_histories
from rockfrag.report.page import Column, table_html
from rockfrag.report.part import FigureSpec, Part, Results, Section
from rockfrag.report.wording import counted, listed
from rockfrag.units import GRAVITY

_COLUMNS = (
    Column("name", "Motion"),
    Column("pga_g", "PGA [g]", 3),
    Column("pgv_cm_s", "PGV [cm/s]", 1),
    Column("pgd_cm", "PGD [cm]", 2),
    Column("pgv_over_pga_s", "PGV/PGA [s]", 3),
    Column("mean_period_s", "Mean period [s]", 2),
    Column("d5_95_s", "Significant duration, 5–95 % [s]", 1),
    Column("arias_m_s", "Arias intensity [m/s]", 2),
)


def _section(results: Results) -> Section:
    measures = results.table("measures")
    table = table_html(measures, _COLUMNS, "Intensity of every motion as recorded.", "measures.csv")
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
