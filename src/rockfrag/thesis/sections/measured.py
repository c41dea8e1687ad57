"""The thesis's statements tested on a laboratory's own tests."""

from rockfrag.report.part import Part, Results, Section
from rockfrag.report.sections.measured import has_measured_tests
from rockfrag.thesis.ledger_html import ledger_html


def _section(results: Results) -> Section | None:
    claims = results.table("measured/claims")
    if claims.empty:
        return None
    return Section(
        "measured_claims",
        "The thesis’s statements on measured tests",
        ["Each statement with its test and verdict on the measured tests."],
        [ledger_html(claims)],
    )


MEASURED_STATEMENTS = Part(("measured/claims",), _section, asked=has_measured_tests)
