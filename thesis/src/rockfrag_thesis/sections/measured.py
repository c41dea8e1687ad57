"""The thesis's hypotheses tested on a laboratory's own tests."""

from rockfrag.report.part import Part, Results, Section
from rockfrag_thesis.hypotheses_html import hypotheses_html
from rockfrag_thesis.sections.hypotheses import outcomes_in_words, words_on_outcomes


def _section(results: Results) -> Section | None:
    hypotheses = results.table("measured/hypotheses")
    if hypotheses.empty:
        return None
    return Section(
        "measured_hypotheses",
        "The thesis’s hypotheses on measured tests",
        outcomes_in_words(hypotheses),
        [words_on_outcomes(hypotheses)],
        [hypotheses_html(hypotheses)],
    )


MEASURED_HYPOTHESES = Part(
    ("measured/hypotheses",), _section, asked=lambda study: study.measured_tests is not None
)
