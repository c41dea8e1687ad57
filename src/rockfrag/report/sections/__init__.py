"""Parts of the report of any study, in its order; a new part is a module here and an entry below."""

from rockfrag.report.part import Part
from rockfrag.report.sections.amplitudes import AMPLITUDES
from rockfrag.report.sections.as_recorded import AS_RECORDED
from rockfrag.report.sections.bodies import BODIES
from rockfrag.report.sections.comparisons import COMPARISONS
from rockfrag.report.sections.floor_curves import FLOOR_CURVES
from rockfrag.report.sections.fragility import FRAGILITY
from rockfrag.report.sections.left_out import LEFT_OUT
from rockfrag.report.sections.measured import MEASURED
from rockfrag.report.sections.measures import MEASURES
from rockfrag.report.sections.motions import MOTIONS
from rockfrag.report.sections.pedestal import PEDESTAL
from rockfrag.report.sections.shaker import SHAKER
from rockfrag.report.sections.two_measures import TWO_MEASURES
from rockfrag.report.sections.validity import VALIDITY

PARTS: tuple[Part, ...] = (
    LEFT_OUT,
    AS_RECORDED,
    AMPLITUDES,
    COMPARISONS,
    PEDESTAL,
    FRAGILITY,
    TWO_MEASURES,
    FLOOR_CURVES,
    MEASURES,
    VALIDITY,
    MEASURED,
    SHAKER,
    MOTIONS,
    BODIES,
)
