"""The thesis's statements with what was found of each, and where it contradicts itself."""

import pandas as pd

from rockfrag.report.page import Column, table_html
from rockfrag.report.part import Part, Results, Section
from rockfrag.report.sections.pedestal import has_pairs
from rockfrag.report.wording import listed, number
from rockfrag_thesis.ledger_html import ledger_html, verdicts_by_kind
from rockfrag_thesis.statements.statement import EXCLUDED

_CONTRADICTIONS = (
    Column("statements", "Statements"),
    Column("what", "What"),
    Column("why", "Why"),
    Column("in_these_tests", "In these tests"),
)


_KINDS = (
    Column("kind", "Kind of statement"),
    Column("statements", "Statements"),
    Column("verdicts", "Found"),
)


def _section(results: Results) -> Section:
    claims, contradictions = results.table("claims"), results.table("contradictions")
    return Section(
        "claims",
        "The thesis’s statements",
        verdicts_in_words(claims),
        [words_on_verdicts(claims)],
        [
            table_html(verdicts_by_kind(claims), _KINDS, "What was found, by kind of statement."),
            ledger_html(claims),
            table_html(contradictions, _CONTRADICTIONS, "Where the thesis contradicts itself."),
        ],
    )


def words_on_verdicts(claims: pd.DataFrame) -> str:
    """Say what the words mean, and how many may be wrong by chance."""
    inferred = int(claims["p"].notna().sum())
    return (
        "A simulation can reproduce what a laboratory reports or not; only measured tests can confirm or "
        "reject it. Statements about the model’s equations are confirmed or refuted, for the specimens or in "
        "general. Each rule of inference uses the printed 95 % interval and errs in at most 2.5 % of tables "
        f"each way, so up to {number(0.05 * inferred, 1)} of the {inferred} statements inferred here may be "
        "wrong by chance; the second p value of each is adjusted for all of them (Holm). Where the sign of a "
        "change is not shown but a change of 10 % or more is excluded, just that is said: 10 % is the smallest "
        "mean change that the thesis’s own tests could detect (80 % power)."
    )


def verdicts_in_words(claims: pd.DataFrame) -> str:
    """Say how many statements are tested, and how many have each outcome."""
    counts = claims["verdict"].value_counts()
    each = listed(
        [f"{count} {SHORT.get(str(verdict), verdict)}" for verdict, count in counts.items()]
    )
    return f"{claims['number'].nunique()} statements of the thesis are tested: {each}."


SHORT = {
    EXCLUDED: "undecided but below 10 %",
    "confirmed for the specimens, with exceptions elsewhere": "confirmed with exceptions",
}
"""Outcomes in a sentence that counts them."""


STATEMENTS = Part(("claims", "contradictions"), _section, asked=has_pairs)
