"""What was tested: the bodies, and the acceleration at which each starts to rock."""

from rockfrag.report.page import Column, table_html
from rockfrag.report.part import Part, Results, Section, section_of
from rockfrag.report.sections.words import sentences
from rockfrag.report.wording import number
from rockfrag.units import CENTIMETRES_PER_METRE, GRAVITY

_COLUMNS = (
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


def _section(results: Results) -> Section:
    bodies = results.table("bodies")
    shown = bodies.assign(
        stands_on=bodies["stands_on"].replace("", "the floor"),
        width_cm=bodies["width_m"] * CENTIMETRES_PER_METRE,
        height_cm=bodies["height_m"] * CENTIMETRES_PER_METRE,
        uplift_g=bodies["uplift_m_s2"] / GRAVITY,
    )
    ends = (number(value, 2) for value in (shown["uplift_g"].min(), shown["uplift_g"].max()))
    may_differ = results.study.slides or results.study.vertical
    text = sentences().bodies(len(shown), *ends, may_differ)
    table = table_html(shown, _COLUMNS, "The objects, alone and on their pedestals.")
    return section_of(text, "bodies", [table])


BODIES = Part(("bodies",), _section)
