"""Tables 3.1, 3.3 and 4.1 of the thesis: computed values with the printed ones below them.

In: the tables ``table_3_1``, ``table_3_3`` and ``table_4_1``. Out: a section of the report.
"""

from collections.abc import Mapping
from typing import Any

import pandas as pd
from markupsafe import Markup

from rockfrag.report.page import framed
from rockfrag.report.part import Results, Section
from rockfrag.words.sentences import listed, number

_CAPTIONS = {
    "table_3_1": "Table 3.1: critical angle, radius, frequency parameter and slenderness of the "
    "blocks.",
    "table_3_3": "Table 3.3: peaks of the ground motions, integrated exactly for an acceleration "
    "that is linear between samples.",
    "table_4_1": "Table 4.1: least acceleration that starts rocking, of both bodies as one "
    "(pattern 3) and of the object alone (pattern 4).",
}


def printed(results: Results) -> Section:
    """The printed tables beside what is computed."""
    comparison = pd.concat(
        [results.table(name) for name in _CAPTIONS], ignore_index=True
    )
    known = comparison[comparison["agrees"].notna()]
    wrong = known[~known["agrees"].astype(bool)]
    names = list(wrong["name"] + " " + wrong["quantity"])
    parts = [
        comparison_html(results.table(name), caption)
        for name, caption in _CAPTIONS.items()
    ]
    right, total = len(known) - len(wrong), len(known)
    message = "None of these values is printed in the thesis."
    if total:
        which = "All" if right == total else f"{right} of"
        message = (
            f"{which} {total} printed values of Tables 3.1, 3.3 and 4.1 are reproduced."
        )
    words = [f"Different: {listed(names)}."] if names else []
    words.append(
        "Computed values are rounded to the digits printed in the thesis, with g = 9.81 m/s². GF is the ground "
        "motion itself; F3 and F5 are floors of an assumed building, which the thesis does not describe. The "
        "printed value is below each computed one, with ✓ where they agree to its digits."
    )
    return Section("printed", "The thesis’s printed tables", message, words, parts)


def comparison_html(comparison: pd.DataFrame, caption: str) -> Markup:
    """Render computed values with the printed ones below them, a row per name."""
    # a lone block has no pattern 3: the order of the columns is that of the fullest row
    fullest = max((part for _, part in comparison.groupby("name")), key=len)
    titles = {
        row["quantity"]: row["quantity"]
        if row["unit"] == "-"
        else f"{row['quantity']} [{row['unit']}]"
        for row in fullest.to_dict("records")
    }
    rows: dict[tuple[str, str], Any] = {
        (r["name"], r["quantity"]): r for r in comparison.to_dict("records")
    }
    body = [
        [name, *(_compared(rows.get((name, quantity))) for quantity in titles)]
        for name in dict.fromkeys(comparison["name"])
    ]
    head = [("Name", ""), *((title, "number") for title in titles.values())]
    return framed(caption, head, body, 1 + len(titles))


def _compared(row: Mapping[str, Any] | None) -> Markup:
    if row is None:
        return Markup("–")
    if not row["printed"]:
        return Markup("{}").format(number(row["computed"], 4))
    sign = "✓" if row["agrees"] else "≠"
    return Markup("<span>{}<br><small>{} {}</small></span>").format(
        number(row["computed"], 4), row["printed"], sign
    )
