"""What the report of a study holds: what every study has, and what its guest adds.

The one place that knows of the thesis. A new part of the report is added in :mod:`rockfrag.report.sections`.
"""

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from rockfrag.stages.job import Job, Results
from rockfrag.study.study import Study

if TYPE_CHECKING:
    from rockfrag.report.part import Answer, Part
    from rockfrag.report.part import Results as ReportedResults


def report(job: Job[Study]) -> Results:
    """Draw the figures of a study and write its page."""
    from rockfrag.report.study_report import write_report

    study = job.study
    write_report(study, report_parts(study), report_answer(study), job.folder, job.threads)
    job.log.info("%s", job.folder / "report.html")
    yield from ()


def report_parts(study: Study) -> "Sequence[Part]":
    """Parts of the report of a study in their order."""
    from rockfrag.report.sections import PARTS

    if study.compare_with != "thesis":
        return PARTS
    from rockfrag.thesis.sections import with_thesis

    return with_thesis(PARTS)


def report_answer(study: Study) -> "Callable[[ReportedResults], Answer]":
    """Return what says what stands first in the report of a study."""
    if study.compare_with != "thesis":
        from rockfrag.report.answer import study_answer

        return study_answer
    from rockfrag.thesis.sections.first_page import thesis_answer

    return thesis_answer
