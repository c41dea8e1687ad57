"""What the report of a study with the keys of the thesis holds beyond that of any study."""

from collections.abc import Sequence

from rockfrag.report.part import Part
from rockfrag.report.sections.amplitudes import COMPARISONS
from rockfrag.report.sections.tested import MOTIONS
from rockfrag.report.sections.validity import VALIDITY
from rockfrag_thesis.sections.building import BUILDING
from rockfrag_thesis.sections.counterparts import COUNTERPARTS
from rockfrag_thesis.sections.floor_order import FLOOR_ORDER
from rockfrag_thesis.sections.friction import FRICTION
from rockfrag_thesis.sections.hypotheses import HYPOTHESES, MEASURED_HYPOTHESES
from rockfrag_thesis.sections.inverse_problem import INVERSE_PROBLEM
from rockfrag_thesis.sections.printed import PRINTED
from rockfrag_thesis.sections.sensitivity_analysis import SENSITIVITY_ANALYSIS
from rockfrag_thesis.sections.signs import SIGNS

_BEHIND = {VALIDITY: (SENSITIVITY_ANALYSIS, INVERSE_PROBLEM, FRICTION)}
_BEFORE = {MOTIONS: (BUILDING,)}
_COMPARED = (SIGNS, FLOOR_ORDER, PRINTED, HYPOTHESES, MEASURED_HYPOTHESES)


def with_thesis(parts: Sequence[Part], compares: bool) -> list[Part]:
    """Return the parts of any study's report with those of the thesis.

    Where the study is compared with the thesis, the counterparts of its figures take the place of the figures
    that compare amplitudes, of which they are a finer version; what is compared follows at the end.
    """
    ours = [p for part in parts for p in (*_BEFORE.get(part, ()), part, *_BEHIND.get(part, ()))]
    if not compares:
        return ours
    return [*(COUNTERPARTS if part is COMPARISONS else part for part in ours), *_COMPARED]
