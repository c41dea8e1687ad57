"""The first findings of a study that is compared with the thesis."""

import pandas as pd

from rockfrag.report.part import Finding, Part, Results, Section
from rockfrag.report.sections.explanation import asks_explanation
from rockfrag.report.sections.pedestal import has_pairs
from rockfrag.thesis.first_page import first_page

WIDE = "wide"
"""Study of many more earthquakes, whose result is set beside where it has been run (config/wide.yaml)."""


def _findings(results: Results) -> list[Finding]:
    study = results.study
    explanation = results.table("explanation/effects") if asks_explanation(study) else None
    beside = results.folder.parent / WIDE / "pedestal" / "effects.parquet"
    wide = pd.read_parquet(beside) if study.name != WIDE and beside.is_file() else None
    return first_page(results.table("pedestal/effects"), results.table("claims"), explanation, wide)


def _no_section(_: Results) -> Section | None:
    return None


FIRST_PAGE = Part(("pedestal/effects", "claims"), _no_section, _findings, has_pairs)
