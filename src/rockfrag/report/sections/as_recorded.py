"""The motions as recorded: what each of them overturns at its own strength."""

import pandas as pd

from rockfrag.report.figures.as_recorded import MOST_ROWS, recorded_map
from rockfrag.report.findings import recorded_found
from rockfrag.report.page import Column, table_html
from rockfrag.report.part import FigureSpec, Part, Results, Section, opened


def _section(results: Results) -> Section:
    recorded = results.table("as_recorded")
    names = list(dict.fromkeys(recorded["configuration"]))
    columns = [
        *(Column("earthquake", "Earthquake"), Column("floor", "Floor"), Column("motion", "Motion")),
        Column("pga_g", "Peak [g]", 3),
        *(Column(name, name) for name in names),
    ]
    found = recorded_found(recorded)
    motions = recorded["motion"].nunique()
    caption = (
        "Largest rotation divided by the critical angle, under each motion as recorded. "
        "A dot marks an outcome that flips if the motion is scaled within ±10 %."
    )
    if motions > MOST_ROWS:
        caption += f" Shown are the {MOST_ROWS} strongest of {motions} motions; the table has all."
    figure = FigureSpec(
        "as_recorded", f"{found.headline}. {found.text}", caption, lambda: recorded_map(recorded)
    )
    return Section(
        "as_recorded",
        "Motions as recorded",
        f"{found.headline}.",
        [
            *opened(found),
            "Each motion shakes the objects as strongly as it was recorded, or as the building passes it on to "
            "the floor. “Sensitive” marks an outcome that flips if the motion is scaled within ±10 %.",
        ],
        [
            figure,
            table_html(
                _wide(recorded),
                columns,
                "Outcome under each motion as recorded.",
                "as_recorded.csv",
            ),
        ],
    )


def _wide(recorded: pd.DataFrame) -> pd.DataFrame:
    """A row per motion and a column per configuration, outcomes as words."""
    rows: dict[str, dict[str, object]] = {}
    for row in recorded.to_dict("records"):
        words = (
            "overturns"
            if row["overturned"]
            else "rocks"
            if row["rocked"]
            else "slides"
            if row.get("peak_slip_m", 0.0) > 0
            else "stays"
        )
        if 0 < row["fraction_near"] < 1:
            words += " (sensitive)"
        about = {key: row[key] for key in ("earthquake", "floor", "motion", "pga_g")}
        rows.setdefault(row["motion"], about)[row["configuration"]] = words
    return pd.DataFrame(list(rows.values()))


AS_RECORDED = Part(("as_recorded",), _section)
