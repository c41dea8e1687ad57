"""The table of hypotheses as the report shows it."""

from rockfrag_thesis.hypotheses import Evidence, hypothesis_table
from rockfrag_thesis.sections.hypotheses import hypotheses_html, outcomes_by_kind, outcomes_section


def test_the_hypothesis_table_shows_kind_outcome_rule_and_error_rate(made):
    html = str(hypotheses_html(hypothesis_table(Evidence(made(noise=0.1), "simulated"))))
    assert html.count('<div class="hypothesis') == 34
    assert html.count("Rule: ") == html.count("Error: ") == 34
    assert 'class="hypothesis for"' in html and 'class="hypothesis open"' in html
    assert "description of the thesis&#39;s plots; simulated" in html
    assert "nan" not in html


def test_outcomes_are_counted_by_kind(made):
    hypotheses = hypothesis_table(Evidence(made(noise=0.1), "measured"))
    counts = outcomes_by_kind(hypotheses)
    assert counts["hypotheses"].sum() == len(hypotheses)
    said = sum(int(part.split()[0]) for words in counts["outcomes"] for part in words.split(", "))
    assert said == len(hypotheses)


def test_the_words_state_how_many_statements_are_inferred(made):
    hypotheses = hypothesis_table(Evidence(made(noise=0.1), "measured"))
    inferred = hypotheses["p"].notna().sum()
    section = outcomes_section("anchor", "Title", hypotheses, [])
    assert f"of the {inferred} hypotheses" in section.paragraphs[0]
