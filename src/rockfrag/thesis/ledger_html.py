"""The ledger of statements as HTML that reads well on a narrow screen."""

import pandas as pd
from markupsafe import Markup

_STATEMENT = Markup(
    '<div class="statement {verdict}"><p><strong>C{number}</strong> {statement} '
    '<span class="meta">({source})</span></p>'
    '<p><span class="verdict">{verdict}</span>, {basis}: {figure}</p>'
    '<p class="meta">Test: {test}</p>{remark}</div>'
)
_REMARK = Markup('<p class="meta">Remark: {}</p>')


def ledger_html(claims: pd.DataFrame) -> Markup:
    """Render the ledger, a box a statement, coloured by the verdict."""
    boxes = [
        _STATEMENT.format(
            **{key: row[key] for key in ("verdict", "number", "statement", "source", "basis")},
            figure=row["figure"],
            test=row["test"],
            remark=_REMARK.format(row["remark"]) if row["remark"] else "",
        )
        for row in claims.fillna({"remark": ""}).to_dict("records")
    ]
    return Markup('<div class="ledger">{}</div>').format(Markup("").join(boxes))
