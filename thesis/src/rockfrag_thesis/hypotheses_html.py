"""The table of hypotheses of hypotheses as HTML that reads well on a narrow screen."""

from collections import Counter
from collections.abc import Mapping
from typing import Any

import pandas as pd
from markupsafe import Markup

from rockfrag.report.wording import probability, spelled

_HYPOTHESIS = Markup(
    '<div class="hypothesis {finding}"><p><strong>C{number}</strong> {hypothesis} '
    '<span class="meta">({source})</span></p>'
    '<p><span class="outcome">{outcome}</span> <span class="meta">({kind}; {basis})</span>: {figure}</p>'
    '<p class="meta">{rule}</p></div>'
)


def hypotheses_html(hypotheses: pd.DataFrame) -> Markup:
    """Render the table of hypotheses, a box a hypothesis, coloured by the finding."""
    boxes = [
        _HYPOTHESIS.format(
            **{
                key: row[key]
                for key in ("number", "hypothesis", "source", "outcome", "kind", "basis")
            },
            figure=spelled(row["figure"]),
            finding=row["finding"].replace(" ", "-"),
            rule=spelled(". ".join(_rule(row)) + "."),
        )
        for row in hypotheses.to_dict("records")
    ]
    return Markup('<div class="table of hypotheses">{}</div>').format(Markup("").join(boxes))


def _rule(row: Mapping[Any, Any]) -> list[str]:
    """How a row was tested, how often that errs, and what else there is to say."""
    parts = [f"Evidence: {row['evidence']}", f"Rule: {row['rule']}", f"Error: {row['error_rate']}"]
    if pd.notna(row["p"]):
        p, adjusted = probability(row["p"]), probability(row["p_holm"])
        what = f" of “{row['p_of']}”" if row["p_of"] else ""
        parts.append(f"p value{what}: {p}; adjusted for all hypotheses (Holm): {adjusted}")
    if row["remark"]:
        parts.append(f"Remark: {row['remark']}")
    return parts


def outcomes_by_kind(hypotheses: pd.DataFrame) -> pd.DataFrame:
    """How many hypotheses of each kind have each outcome: kind, hypotheses, outcomes (in words)."""
    rows = []
    for kind, part in hypotheses.groupby("kind", sort=False):
        counts = Counter(part["outcome"]).most_common()
        words = ", ".join(f"{count} {outcome}" for outcome, count in counts)
        rows.append((kind, len(part), words))
    return pd.DataFrame(rows, columns=["kind", "hypotheses", "outcomes"])
