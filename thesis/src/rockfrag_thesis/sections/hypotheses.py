"""The thesis's hypotheses with what was found of each, and where it contradicts itself."""

from collections.abc import Sequence

import pandas as pd
from markupsafe import Markup

from rockfrag.report.page import Column, table_html
from rockfrag.report.part import Part, Results, Section, section_of
from rockfrag_thesis.hypotheses.hypothesis import EXCLUDED
from rockfrag_thesis.hypotheses_html import hypotheses_html, outcomes_by_kind
from rockfrag_thesis.sections.words import sentences

_CONTRADICTIONS = (
    Column("hypotheses", "Hypotheses"),
    Column("what", "What"),
    Column("why", "Why"),
    Column("in_these_tests", "In these tests"),
)


_KINDS = (
    Column("kind", "Kind of hypothesis"),
    Column("hypotheses", "Hypotheses"),
    Column("outcomes", "Found"),
)


SHORT = {
    EXCLUDED: "undecided but below 10 %",
    "confirmed for the specimens, with exceptions elsewhere": "confirmed with exceptions",
}
"""Outcomes in a sentence that counts them."""


def _section(results: Results) -> Section:
    hypotheses, contradictions = results.table("hypotheses"), results.table("contradictions")
    kinds = outcomes_by_kind(hypotheses)
    parts = [
        table_html(kinds, _KINDS, "What was found, by kind of hypothesis."),
        hypotheses_html(hypotheses),
        table_html(contradictions, _CONTRADICTIONS, "Where the thesis contradicts itself."),
    ]
    return outcomes_section("hypotheses", "The thesis’s hypotheses", hypotheses, parts)


def outcomes_section(
    anchor: str, title: str, hypotheses: pd.DataFrame, parts: Sequence[Markup]
) -> Section:
    """A chapter that says how many hypotheses have each outcome, and how many may be wrong by chance."""
    outcomes = hypotheses["outcome"].value_counts()
    counts = [f"{count} {SHORT.get(str(outcome), outcome)}" for outcome, count in outcomes.items()]
    inferred, tested = int(hypotheses["p"].notna().sum()), hypotheses["number"].nunique()
    return section_of(sentences().hypotheses(title, tested, counts, inferred), anchor, parts)


HYPOTHESES = Part(("hypotheses", "contradictions"), _section, asked=lambda study: study.has_pairs)
