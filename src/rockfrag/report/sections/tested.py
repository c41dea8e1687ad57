"""What was tested: the bodies, the motions and the shaking table, and what a study went on without."""

from dataclasses import replace

from rockfrag.motions.declared import intensity_measures
from rockfrag.report.figures.motion import MOST_PANELS, acceleration_histories
from rockfrag.report.figures.shaker import shaker_limits
from rockfrag.report.page import Column, table_html
from rockfrag.report.part import FigureSpec, Part, Results, Section, figure_of, section_of
from rockfrag.report.sections.words import says
from rockfrag.report.wording import number
from rockfrag.stages.tests import LIMITED
from rockfrag.units import CENTIMETRES_PER_METRE, GRAVITY

_LEFT_OUT = (Column("motion", "Record"), Column("reason", "Why it could not be used"))
_SHAKER = (
    Column("motion", "Motion"),
    Column("travel_cm_per_g", "Peak to peak [cm/g]", 2),
    Column("excursion_cm_per_g", "From the start [cm/g]", 2),
    Column("limit_g", "Fits up to [g]", 3),
    Column("limited_by", "Limited by"),
)
_BODIES = (
    Column("configuration", "Configuration"),
    Column("stands_on", "Stands on"),
    Column("width_cm", "Width [cm]", 1),
    Column("height_cm", "Height [cm]", 1),
    Column("mass_kg", "Mass [kg]", 3),
    Column("slenderness", "Height / width", 2),
    Column("critical_angle_rad", "Critical angle [rad]", 3),
    Column("frequency_1_s", "Frequency parameter p [1/s]", 2),
    Column("uplift_g", "Starts to rock at [g]", 3),
)


def _left_out(results: Results) -> Section | None:
    table = results.table("left_out")
    if table.empty:
        return None
    shown = table_html(table, _LEFT_OUT, "Records that could not be used.", "left_out.csv")
    text = says.left_out(list(table["motion"]), len(results.study.catalogue))
    return section_of(text, "left-out", [shown])


def _shaker(results: Results) -> Section:
    limits, tests = results.table("shaker"), results.table("tests")
    limited = tests[tests["definition"] == LIMITED]
    ended = limited[limited["censored"] == "right"]
    free = results.tests[results.tests["censored"] == "right"]
    new = ended[~ended["test"].isin(free["test"])]
    names = [f"{row['test']} ({row['remark']})" for row in new.to_dict("records")]
    section = section_of(says.shaker(names, len(limited)), "shaker", [])
    figure = FigureSpec(
        "shaker_limits",
        section.message,
        "Peak up to which the shaking table can reproduce each motion (bars; behind each its limiting quantity: "
        "stroke, velocity, acceleration or force), and the peak that overturns each object.",
        lambda: shaker_limits(limits, results.tests),
    )
    caption = "What each motion requires of the shaking table, per g of its peak."
    return replace(section, parts=[figure, table_html(limits, _SHAKER, caption, "shaker.csv")])


def _motions(results: Results) -> Section:
    measures, ground = results.table("measures"), results.ground
    columns = [Column("name", "Motion")] + [
        Column(each.column, f"{each.title or each.label} [{each.unit or '-'}]", each.decimals)
        for each in intensity_measures()
        if each.decimals is not None
    ]
    caption = "Intensity of every motion as recorded."
    table = table_html(measures, columns, caption, "measures.csv")
    shown = min(len(ground), MOST_PANELS)
    peak = max(ground[:shown], key=lambda motion: motion.pga)
    text = says.accelerations_figure(shown, len(results.records), peak, peak.pga / GRAVITY)
    figure = figure_of(text, "accelerations", lambda: acceleration_histories(ground))
    text = says.motions(list(dict.fromkeys(measures["floor"])), results.study.building)
    return section_of(text, "motions", [table, figure])


def _bodies(results: Results) -> Section:
    bodies = results.table("bodies")
    shown = bodies.assign(
        stands_on=bodies["stands_on"].replace("", "the floor"),
        width_cm=bodies["width_m"] * CENTIMETRES_PER_METRE,
        height_cm=bodies["height_m"] * CENTIMETRES_PER_METRE,
        uplift_g=bodies["uplift_m_s2"] / GRAVITY,
    )
    ends = (number(value, 2) for value in (shown["uplift_g"].min(), shown["uplift_g"].max()))
    may_differ = results.study.slides or results.study.vertical
    table = table_html(shown, _BODIES, "The objects, alone and on their pedestals.")
    return section_of(says.bodies(len(shown), *ends, may_differ), "bodies", [table])


LEFT_OUT = Part(_left_out, asked=lambda study: study.keep_going)
SHAKER = Part(_shaker, asked=lambda study: study.shaker is not None)
MOTIONS = Part(_motions)
BODIES = Part(_bodies)
