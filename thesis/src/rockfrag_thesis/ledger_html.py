"""The ledger of statements as HTML that reads well on a narrow screen."""

from collections import Counter
from collections.abc import Mapping
from typing import Any

import pandas as pd
from markupsafe import Markup

from rockfrag.report.wording import probability, spelled

_STATEMENT = Markup(
    '<div class="statement {finding}"><p><strong>C{number}</strong> {statement} '
    '<span class="meta">({source})</span></p>'
    '<p><span class="verdict">{verdict}</span> <span class="meta">({kind}; {basis})</span>: {figure}</p>'
    '<p class="meta">{rule}</p></div>'
)


def ledger_html(claims: pd.DataFrame) -> Markup:
    """Render the ledger, a box a statement, coloured by the finding.

    Parameters
    ----------
    claims
        Columns of `rockfrag_thesis.statements.COLUMNS`.
    """
    boxes = [
        _STATEMENT.format(
            **{
                key: row[key]
                for key in ("number", "statement", "source", "verdict", "kind", "basis")
            },
            figure=spelled(row["figure"]),
            finding=row["finding"].replace(" ", "-"),
            rule=spelled(". ".join(_rule(row)) + "."),
        )
        for row in claims.to_dict("records")
    ]
    return Markup('<div class="ledger">{}</div>').format(Markup("").join(boxes))


def _rule(row: Mapping[Any, Any]) -> list[str]:
    """How a row was tested, how often that errs, and what else there is to say."""
    parts = [f"Evidence: {row['evidence']}", f"Rule: {row['rule']}", f"Error: {row['error_rate']}"]
    if pd.notna(row["p"]):
        p, adjusted = probability(row["p"]), probability(row["p_holm"])
        what = f" of “{row['p_of']}”" if row["p_of"] else ""
        parts.append(f"p value{what}: {p}; adjusted for all statements (Holm): {adjusted}")
    if row["remark"]:
        parts.append(f"Remark: {row['remark']}")
    return parts


def verdicts_by_kind(claims: pd.DataFrame) -> pd.DataFrame:
    """How many statements of each kind have each outcome.

    Returns
    -------
    pandas.DataFrame
        kind, statements, verdicts (in words, such as "3 reproduced, 2 undecided").
    """
    rows = []
    for kind, part in claims.groupby("kind", sort=False):
        counts = Counter(part["verdict"]).most_common()
        words = ", ".join(f"{count} {verdict}" for verdict, count in counts)
        rows.append((kind, len(part), words))
    return pd.DataFrame(rows, columns=["kind", "statements", "verdicts"])
