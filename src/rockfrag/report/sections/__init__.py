"""Parts of the report of any study, in its order; a new part is written in a module here and an entry below."""

from rockfrag.report.part import Part
from rockfrag.report.sections import amplitudes, curves, pedestal, tested

PARTS: tuple[Part, ...] = (
    tested.left_out,
    amplitudes.as_recorded,
    amplitudes.amplitudes,
    amplitudes.comparisons,
    pedestal.pedestal,
    curves.fragility,
    curves.two_measures,
    curves.floor_curves,
    curves.measures,
    tested.validity,
    pedestal.measured,
    tested.shaker,
    tested.motions,
    tested.bodies,
)
