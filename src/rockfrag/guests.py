"""The stages of a study: those that every study has, and those of the guest it is compared with.

The one place that knows of the thesis. A new stage is added to the list here.
"""

from typing import Any

from rockfrag.report.stages import MEASURED_TABLE, REPORT
from rockfrag.stages import (
    explanation,
    fragility,
    measured_tests,
    motions,
    pedestal,
    sensitivity,
    sweep,
    tests,
)
from rockfrag.stages.stage import Stage
from rockfrag.study.measured_table import MeasuredTable
from rockfrag.study.study import Study
from rockfrag.thesis import stages as thesis

_GENERAL: tuple[Stage[Study], ...] = (
    motions.STAGE,
    sweep.STAGE,
    tests.STAGE,
    fragility.STAGE,
    pedestal.STAGE,
    explanation.STAGE,
    sensitivity.STAGE,
    measured_tests.STAGE,
)


def study_stages(study: Study | MeasuredTable) -> list[Stage[Any]]:
    """Stages of a study in the order in which data flow."""
    if isinstance(study, MeasuredTable):
        return [MEASURED_TABLE]
    guests = [thesis.STAGE] if study.compare_with == "thesis" else []
    return [one for one in (*_GENERAL, *guests, REPORT) if one.wanted(study)]
