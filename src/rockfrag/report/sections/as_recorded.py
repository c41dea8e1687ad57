"""A repeat of the records: what each motion overturns as strong as it was."""

import pandas as pd

from rockfrag.report.figures.as_recorded import MOST_ROWS, recorded_map
from rockfrag.report.findings import recorded_found
from rockfrag.report.page import Column, table_html
from rockfrag.report.part import FigureSpec, Part, Results, Section


def _section(results: Results) -> Section:
    recorded = results.table("as_recorded")
    names = list(dict.fromkeys(recorded["configuration"]))
    columns = [
        *(Column("event", "Event"), Column("floor", "Floor"), Column("motion", "Motion")),
        Column("pga_g", "Peak [g]", 3),
        *(Column(name, name) for name in names),
    ]
    found = recorded_found(recorded)
    motions = recorded["motion"].nunique()
    caption = (
        "Motions as recorded: filled where the object overturns, as high as it rocked (share of its critical "
        "angle) where not; a ring where a tenth more or less may decide."
    )
    if motions > MOST_ROWS:
        caption += f" The {MOST_ROWS} strongest of {motions} motions."
    figure = FigureSpec(
        "as_recorded", f"{found.headline}. {found.text}", caption, lambda: recorded_map(recorded)
    )
    return Section(
        "as_recorded",
        "In a repeat of the records",
        found.said,
        [
            "Each motion shakes the objects once more as strongly as it was recorded, or as the building passes "
            "it on to its floor. “Near” marks a verdict that is another for some motions a tenth weaker or "
            "stronger: there luck decides."
        ],
        [
            figure,
            table_html(
                _wide(recorded),
                columns,
                "Verdict under each motion as recorded.",
                "as_recorded.csv",
            ),
        ],
    )


def _wide(recorded: pd.DataFrame) -> pd.DataFrame:
    """A row per motion and a column per configuration, verdicts as words."""
    rows: dict[str, dict[str, object]] = {}
    for row in recorded.to_dict("records"):
        words = (
            "overturns"
            if row["overturned"]
            else "rocks"
            if row["peak_rotation"] > 0
            else "slides"
            if row.get("peak_slip_m", 0.0) > 0
            else "stays"
        )
        if 0 < row["share_near"] < 1:
            words += ", near"
        about = {key: row[key] for key in ("event", "floor", "motion", "pga_g")}
        rows.setdefault(row["motion"], about)[row["configuration"]] = words
    return pd.DataFrame(list(rows.values()))


AS_RECORDED = Part(("as_recorded",), _section)
