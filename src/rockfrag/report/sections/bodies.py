"""What was tested: the bodies, and the acceleration at which each starts to rock."""

import pandas as pd

from rockfrag.report.page import Column, table_html
from rockfrag.report.part import Part, Results, Section
from rockfrag.report.wording import counted, number, sentence
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
    return Section(
        "bodies",
        "Bodies",
        _message(shown, results.study.slides or results.study.vertical),
        [
            "Rigid blocks that rock on two edges in the plane of the motion. The critical angle is the angle "
            "between the diagonal and the vertical. A block starts to rock when the acceleration of its base "
            "exceeds the one given, and overturns if it rotates too far beyond the critical angle."
        ],
        [table_html(shown, _COLUMNS, "The objects, alone and on their pedestals.")],
    )


def _message(bodies: pd.DataFrame, may_differ: bool) -> str:
    low, high = (number(value, 2) for value in (bodies["uplift_g"].min(), bodies["uplift_g"].max()))
    span = f"at {low} g" if low == high else f"between {low} and {high} g"
    where = " if the surfaces neither slip nor move vertically" if may_differ else ""
    return f"{sentence(counted(len(bodies), 'configuration'))}; rocking starts {span} at the base{where}."


BODIES = Part(("bodies",), _section)
