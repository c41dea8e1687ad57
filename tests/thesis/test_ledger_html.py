"""The ledger as the report shows it."""

from rockfrag_thesis.ledger_html import ledger_html, verdicts_by_kind
from rockfrag_thesis.sections.statements import words_on_verdicts
from rockfrag_thesis.statements import Evidence, ledger


def test_the_ledger_shows_kind_verdict_rule_and_error_rate(made):
    html = str(ledger_html(ledger(Evidence(made(noise=0.1), "simulated"))))
    assert html.count('<div class="statement') == 34
    assert html.count("Rule: ") == html.count("Error: ") == 34
    assert 'class="statement for"' in html and 'class="statement open"' in html
    assert "description of the thesis&#39;s plots; simulated" in html
    assert "nan" not in html


def test_verdicts_are_counted_by_kind(made):
    claims = ledger(Evidence(made(noise=0.1), "measured"))
    counts = verdicts_by_kind(claims)
    assert counts["statements"].sum() == len(claims)
    said = sum(int(part.split()[0]) for words in counts["verdicts"] for part in words.split(", "))
    assert said == len(claims)


def test_the_words_state_how_many_statements_are_inferred(made):
    claims = ledger(Evidence(made(noise=0.1), "measured"))
    inferred = claims["p"].notna().sum()
    assert f"of the {inferred} statements" in words_on_verdicts(claims)
