"""What the report of a study that is compared with the thesis holds beyond that of any study."""

from collections.abc import Sequence

from rockfrag.report.part import Part
from rockfrag.report.sections.comparisons import COMPARISONS
from rockfrag.thesis.sections.counterparts import COUNTERPARTS
from rockfrag.thesis.sections.floor_order import FLOOR_ORDER
from rockfrag.thesis.sections.measured import MEASURED_STATEMENTS
from rockfrag.thesis.sections.printed import PRINTED
from rockfrag.thesis.sections.signs import SIGNS
from rockfrag.thesis.sections.statements import STATEMENTS


def with_thesis(parts: Sequence[Part]) -> list[Part]:
    """Return the parts of any study's report with those of the thesis.

    The counterparts of its figures take the place of the figures that compare amplitudes, of which they are a
    finer version; the others follow at the end.
    """
    replaced = [COUNTERPARTS if part is COMPARISONS else part for part in parts]
    return [*replaced, SIGNS, FLOOR_ORDER, PRINTED, STATEMENTS, MEASURED_STATEMENTS]
