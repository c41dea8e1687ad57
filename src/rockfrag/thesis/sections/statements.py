"""The thesis's statements with their verdicts, and where it contradicts itself."""

from rockfrag.report.page import Column, table_html
from rockfrag.report.part import Finding, Part, Results, Section
from rockfrag.report.sections.pedestal import has_pairs
from rockfrag.thesis.ledger_html import ledger_html

_CONTRADICTIONS = (
    Column("statements", "Statements"),
    Column("what", "What"),
    Column("why", "Why"),
    Column("in_these_tests", "In these tests"),
)


def _section(results: Results) -> Section:
    contradictions = results.table("contradictions")
    return Section(
        "claims",
        "The thesis’s statements",
        [
            "Each statement with its test and verdict. A verdict on simulated tests says what the "
            "model does, not what the laboratory saw."
        ],
        [
            ledger_html(results.table("claims")),
            table_html(contradictions, _CONTRADICTIONS, "Where the thesis contradicts itself."),
        ],
    )


def _findings(results: Results) -> list[Finding]:
    claims = results.table("claims")
    counts = claims["verdict"].value_counts()
    parts = [f"{count} {verdict}" for verdict, count in counts.items()]
    return [
        Finding(
            f"{claims['number'].nunique()} statements of the thesis are tested",
            f"By simulation: {', '.join(parts)}. A statement about the laboratory's measurements is "
            "tested on the simulated counterparts; each verdict says on what it rests.",
        )
    ]


STATEMENTS = Part(("claims", "contradictions"), _section, _findings, has_pairs)
