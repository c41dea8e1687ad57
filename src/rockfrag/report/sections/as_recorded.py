"""The motions as recorded: what each of them overturns at its own strength."""

import pandas as pd

from rockfrag.report.figures.as_recorded import MOST_ROWS, recorded_map
from rockfrag.report.findings import recorded_found
from rockfrag.report.page import Column, table_html
from rockfrag.report.part import Part, Results, Section, figure_of, section_of
from rockfrag.report.sections.words import sentences


def _section(results: Results) -> Section:
    recorded = results.table("as_recorded")
    names = list(dict.fromkeys(recorded["configuration"]))
    columns = [
        *(Column("earthquake", "Earthquake"), Column("floor", "Floor"), Column("motion", "Motion")),
        Column("pga_g", "Peak [g]", 3),
        *(Column(name, name) for name in names),
    ]
    found = recorded_found(recorded)
    text = sentences().as_recorded_figure(found, recorded["motion"].nunique(), MOST_ROWS)
    figure = figure_of(text, "as_recorded", lambda: recorded_map(recorded))
    caption = "Outcome under each motion as recorded."
    table = table_html(_wide(recorded), columns, caption, "as_recorded.csv")
    return section_of(sentences().as_recorded(found), "as_recorded", [figure, table])


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
