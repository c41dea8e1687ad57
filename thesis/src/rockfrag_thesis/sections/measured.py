"""The thesis's statements tested on a laboratory's own tests."""

from rockfrag.report.part import Part, Results, Section
from rockfrag.report.sections.measured import has_measured_tests
from rockfrag_thesis.ledger_html import ledger_html
from rockfrag_thesis.sections.statements import verdicts_in_words, words_on_verdicts


def _section(results: Results) -> Section | None:
    claims = results.table("measured/claims")
    if claims.empty:
        return None
    return Section(
        "measured_claims",
        "The thesis’s statements on measured tests",
        verdicts_in_words(claims),
        [words_on_verdicts(claims)],
        [ledger_html(claims)],
    )


MEASURED_STATEMENTS = Part(("measured/claims",), _section, asked=has_measured_tests)
