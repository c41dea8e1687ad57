"""What the report of a study with the keys of the thesis holds beyond that of any study."""

from collections.abc import Sequence

from rockfrag.report.part import Part
from rockfrag.report.sections.amplitudes import comparisons
from rockfrag.report.sections.tested import motions, validity
from rockfrag_thesis.sections.building import building
from rockfrag_thesis.sections.counterparts import counterparts
from rockfrag_thesis.sections.floor_order import floor_order_found
from rockfrag_thesis.sections.friction import friction
from rockfrag_thesis.sections.hypotheses import hypotheses_found, measured_hypotheses
from rockfrag_thesis.sections.inverse_problem import inverse_problem
from rockfrag_thesis.sections.printed import printed
from rockfrag_thesis.sections.sensitivity_analysis import sensitivity_analysis
from rockfrag_thesis.sections.signs import signs

_BEHIND: dict[Part, tuple[Part, ...]] = {
    validity: (sensitivity_analysis, inverse_problem, friction)
}
_BEFORE: dict[Part, tuple[Part, ...]] = {motions: (building,)}
_COMPARED = (signs, floor_order_found, printed, hypotheses_found, measured_hypotheses)


def with_thesis(parts: Sequence[Part], compares: bool) -> list[Part]:
    """Return the parts of any study's report with those of the thesis.

    Where the study is compared with the thesis, the counterparts of its figures take the place of the figures
    that compare amplitudes, of which they are a finer version; what is compared follows at the end.
    """
    ours = [
        p
        for part in parts
        for p in (*_BEFORE.get(part, ()), part, *_BEHIND.get(part, ()))
    ]
    if not compares:
        return ours
    return [
        *(counterparts if part is comparisons else part for part in ours),
        *_COMPARED,
    ]
