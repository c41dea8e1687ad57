"""Hypotheses of the thesis with the finding on each, and its contradictions.

In: the tables ``hypotheses`` and ``contradictions``. Out: sections of the report. Theory:
``docs/hypotheses.md``, "How a test decides" and "How often it errs".
"""

import math
from collections import Counter
from collections.abc import Sequence

import pandas as pd
from markupsafe import Markup

from rockfrag.report.page import Column, Row, table_html
from rockfrag.report.part import Results, Section
from rockfrag.words.sentences import listed, number, probability
from rockfrag_thesis.hypotheses.hypothesis import EXCLUDED

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

ERROR_RATE = 0.05  # of a rule of inference, both ways together [-]

SHORT = {
    EXCLUDED: "undecided but below 10 %",
    "confirmed for the specimens, with exceptions elsewhere": "confirmed with exceptions",
}
"""Outcomes in a sentence that counts them."""

_HYPOTHESIS = Markup(
    '<div class="hypothesis {finding}"><p><strong>C{row[number]}</strong> {row[hypothesis]} '
    '<span class="meta">({row[source]})</span></p><p><span class="outcome">{row[outcome]}</span> '
    '<span class="meta">({row[kind]}; {row[basis]})</span>: {figure}</p><p class="meta">{rule}</p></div>'
)


def hypotheses_found(results: Results) -> Section | None:
    """What was found of each hypothesis, and where the thesis contradicts itself."""
    if not results.study.has_pairs:
        return None
    hypotheses = results.table("hypotheses")
    contradictions = results.table("contradictions")
    parts = [
        table_html(
            outcomes_by_kind(hypotheses),
            _KINDS,
            "What was found, by kind of hypothesis.",
        ),
        hypotheses_html(hypotheses),
        table_html(
            contradictions, _CONTRADICTIONS, "Where the thesis contradicts itself."
        ),
    ]
    return outcomes_section("hypotheses", "The thesis’s hypotheses", hypotheses, parts)


def measured_hypotheses(results: Results) -> Section | None:
    """What measured tests say of the hypotheses."""
    if results.study.measured_tests is None:
        return None
    hypotheses = results.table("measured/hypotheses")
    if hypotheses.empty:
        return None
    title = "The thesis’s hypotheses on measured tests"
    parts = [hypotheses_html(hypotheses)]
    return outcomes_section("measured_hypotheses", title, hypotheses, parts)


def outcomes_section(
    anchor: str, title: str, hypotheses: pd.DataFrame, parts: Sequence[Markup]
) -> Section:
    """A chapter that says how many hypotheses have each outcome, and how many may be wrong by chance."""
    outcomes = hypotheses["outcome"].value_counts()
    counts = [
        f"{count} {SHORT.get(str(outcome), outcome)}"
        for outcome, count in outcomes.items()
    ]
    inferred = int(hypotheses["p"].notna().sum())
    tested = hypotheses["number"].nunique()
    reading = (
        "A simulation can reproduce what a laboratory reports or not; only measured tests can confirm or reject "
        "it. Hypotheses about the model’s equations are confirmed or refuted, for the specimens or in general. "
        "Each rule of inference uses the printed 95 % interval and errs in at most 2.5 % of tables each way, so "
        f"up to {number(ERROR_RATE * inferred, 1)} of the {inferred} hypotheses inferred here may be wrong by "
        "chance; the second p value of each is adjusted for all of them (Holm). Where the sign of a change is "
        "not shown but a change of 10 % or more is excluded, just that is said: 10 % is the smallest mean "
        "change that the thesis’s own tests could detect (80 % power)."
    )
    message = f"{tested} hypotheses of the thesis are tested: {listed(counts)}."
    return Section(anchor, title, message, [reading], parts)


def spelled(words: str) -> str:
    """The words with P/NP and NP/P, the names of ratios in tables, written out for a reader."""
    return words.replace("NP/P", "without/with pedestal").replace(
        "P/NP", "with/without pedestal"
    )


def hypotheses_html(hypotheses: pd.DataFrame) -> Markup:
    """Render the table of hypotheses, a box a hypothesis, coloured by the finding."""
    boxes = [
        _HYPOTHESIS.format(
            row=row,
            figure=spelled(row["figure"]),
            finding=row["finding"].replace(" ", "-"),
            rule=spelled(". ".join(_rule(row)) + "."),
        )
        for row in hypotheses.to_dict("records")
    ]
    return Markup('<div class="table of hypotheses">{}</div>').format(
        Markup("").join(boxes)
    )


def _rule(row: Row) -> list[str]:
    """How a row was tested, how often that errs, and what else there is to say."""
    parts = [
        f"Evidence: {row['evidence']}",
        f"Rule: {row['rule']}",
        f"Error: {row['error_rate']}",
    ]
    if not math.isnan(row["p"]):
        p, adjusted = probability(row["p"]), probability(row["p_holm"])
        what = f" of “{row['p_of']}”" if row["p_of"] else ""
        parts.append(
            f"p value{what}: {p}; adjusted for all hypotheses (Holm): {adjusted}"
        )
    return [*parts, f"Remark: {row['remark']}"] if row["remark"] else parts


def outcomes_by_kind(hypotheses: pd.DataFrame) -> pd.DataFrame:
    """How many hypotheses of each kind have each outcome: kind, hypotheses, outcomes (in words)."""
    by_kind = hypotheses.groupby("kind", sort=False)["outcome"]
    rows = [
        (
            kind,
            len(part),
            ", ".join(f"{n} {word}" for word, n in Counter(part).most_common()),
        )
        for kind, part in by_kind
    ]
    return pd.DataFrame(rows, columns=["kind", "hypotheses", "outcomes"])
