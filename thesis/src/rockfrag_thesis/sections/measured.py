"""The thesis's hypotheses tested on a laboratory's own tests."""

from rockfrag.report.part import Part, Results, Section
from rockfrag_thesis.hypotheses_html import hypotheses_html
from rockfrag_thesis.sections.hypotheses import outcomes_section


def _section(results: Results) -> Section | None:
    hypotheses = results.table("measured/hypotheses")
    if hypotheses.empty:
        return None
    title, parts = "The thesis’s hypotheses on measured tests", [hypotheses_html(hypotheses)]
    return outcomes_section("measured_hypotheses", title, hypotheses, parts)


MEASURED_HYPOTHESES = Part(
    ("measured/hypotheses",), _section, asked=lambda study: study.measured_tests is not None
)
