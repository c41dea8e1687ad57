"""Parts of the report of any study, in its order; a new part is written in a module here and an entry below."""

from rockfrag.report.part import Part
from rockfrag.report.sections import amplitudes, curves, measured, pedestal, tested, validity

PARTS: tuple[Part, ...] = (
    tested.LEFT_OUT,
    amplitudes.AS_RECORDED,
    amplitudes.AMPLITUDES,
    amplitudes.COMPARISONS,
    pedestal.PEDESTAL,
    curves.FRAGILITY,
    curves.TWO_MEASURES,
    curves.FLOOR_CURVES,
    curves.MEASURES,
    validity.VALIDITY,
    measured.MEASURED,
    tested.SHAKER,
    tested.MOTIONS,
    tested.BODIES,
)
