"""The thesis's statements with their verdicts, and where it contradicts itself."""

import pandas as pd

from rockfrag.report.page import Column, table_html
from rockfrag.report.part import Part, Results, Section
from rockfrag.report.sections.pedestal import has_pairs
from rockfrag.report.wording import listed, number
from rockfrag.thesis.ledger_html import ledger_html, verdicts_by_kind

_CONTRADICTIONS = (
    Column("statements", "Statements"),
    Column("what", "What"),
    Column("why", "Why"),
    Column("in_these_tests", "In these tests"),
)


_KINDS = (
    Column("kind", "Kind of statement"),
    Column("statements", "Statements"),
    Column("verdicts", "Verdicts"),
)


def _section(results: Results) -> Section:
    claims, contradictions = results.table("claims"), results.table("contradictions")
    return Section(
        "claims",
        "The thesis’s statements",
        verdicts_in_words(claims),
        [words_on_verdicts(claims)],
        [
            table_html(verdicts_by_kind(claims), _KINDS, "Verdicts on the thesis’s statements."),
            ledger_html(claims),
            table_html(contradictions, _CONTRADICTIONS, "Where the thesis contradicts itself."),
        ],
    )


def words_on_verdicts(claims: pd.DataFrame) -> str:
    """Say what the verdicts mean, and how many may be wrong by chance."""
    inferred = int(claims["p"].notna().sum())
    return (
        "A simulation can reproduce what a laboratory reports or not; only measured tests can confirm or "
        "reject it. Statements about the model’s equations hold or do not, for the specimens or everywhere. "
        "Each rule of inference reads the 95 % interval that is printed and errs in at most 2.5 % of tables "
        f"each way, so that of the {inferred} statements inferred here up to {number(0.05 * inferred, 1)} may "
        "be wrong by chance; the second p value of each counts them all (Holm)."
    )


def verdicts_in_words(claims: pd.DataFrame) -> str:
    """Say how many statements are tested, and how many have each verdict."""
    counts = claims["verdict"].value_counts()
    each = listed([f"{count} {verdict}" for verdict, count in counts.items()])
    return f"{claims['number'].nunique()} statements of the thesis are tested: {each}."


STATEMENTS = Part(("claims", "contradictions"), _section, asked=has_pairs)
