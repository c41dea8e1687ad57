"""The thesis's hypotheses with what was found of each, and where it contradicts itself."""

import pandas as pd

from rockfrag.report.page import Column, table_html
from rockfrag.report.part import Part, Results, Section
from rockfrag.report.wording import listed, number
from rockfrag_thesis.hypotheses.hypothesis import EXCLUDED
from rockfrag_thesis.hypotheses_html import hypotheses_html, outcomes_by_kind

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


def _section(results: Results) -> Section:
    hypotheses, contradictions = results.table("hypotheses"), results.table("contradictions")
    return Section(
        "hypotheses",
        "The thesis’s hypotheses",
        outcomes_in_words(hypotheses),
        [words_on_outcomes(hypotheses)],
        [
            table_html(
                outcomes_by_kind(hypotheses), _KINDS, "What was found, by kind of hypothesis."
            ),
            hypotheses_html(hypotheses),
            table_html(contradictions, _CONTRADICTIONS, "Where the thesis contradicts itself."),
        ],
    )


def words_on_outcomes(hypotheses: pd.DataFrame) -> str:
    """Say what the words mean, and how many may be wrong by chance."""
    inferred = int(hypotheses["p"].notna().sum())
    return (
        "A simulation can reproduce what a laboratory reports or not; only measured tests can confirm or "
        "reject it. Hypotheses about the model’s equations are confirmed or refuted, for the specimens or in "
        "general. Each rule of inference uses the printed 95 % interval and errs in at most 2.5 % of tables "
        f"each way, so up to {number(0.05 * inferred, 1)} of the {inferred} hypotheses inferred here may be "
        "wrong by chance; the second p value of each is adjusted for all of them (Holm). Where the sign of a "
        "change is not shown but a change of 10 % or more is excluded, just that is said: 10 % is the smallest "
        "mean change that the thesis’s own tests could detect (80 % power)."
    )


def outcomes_in_words(hypotheses: pd.DataFrame) -> str:
    """Say how many hypotheses are tested, and how many have each outcome."""
    counts = hypotheses["outcome"].value_counts()
    each = listed(
        [f"{count} {SHORT.get(str(outcome), outcome)}" for outcome, count in counts.items()]
    )
    return f"{hypotheses['number'].nunique()} hypotheses of the thesis are tested: {each}."


SHORT = {
    EXCLUDED: "undecided but below 10 %",
    "confirmed for the specimens, with exceptions elsewhere": "confirmed with exceptions",
}
"""Outcomes in a sentence that counts them."""


HYPOTHESES = Part(("hypotheses", "contradictions"), _section, asked=lambda study: study.has_pairs)
