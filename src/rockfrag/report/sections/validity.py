"""What the model assumes, that nothing slides and nothing jumps, or what friction did where it is limited."""

from typing import Any

import numpy as np
import pandas as pd

from rockfrag.report.findings import model_allowed, sliding_found
from rockfrag.report.page import Column, table_html
from rockfrag.report.part import Part, Results, Section, section_of
from rockfrag.report.sections.words import says
from rockfrag.stages.validity import MOST_TESTED

_COLUMNS = (
    Column("object", "Object"),
    Column("side", "Pedestal"),
    Column("tests", "Tests", 0),
    Column("median", "Friction needed, median", 2),
    Column("largest", "largest", 2),
    Column("beyond", "No friction is enough", 0),
    Column("lifted", "Lifts off", 0),
)


_SLIDING = (
    Column("configuration", "Configuration"),
    Column("cases", "Analyses", 0),
    Column("slid", "Slides", 0),
    Column("flew", "Flies", 0),
    Column("largest_slip_cm", "Largest slip [cm]", 1),
    Column("saved", "Saved by sliding", 0),
    Column("felled", "Overturned by it", 0),
)


def _section(results: Results) -> Section | None:
    if results.study.slides:
        sliding = results.table("sliding")
        shown = sliding.assign(largest_slip_cm=100 * sliding["largest_slip_m"])
        table = table_html(shown, _SLIDING, "Sliding and flight in all analyses.")
        return section_of(says.sliding(sliding_found(sliding)), "validity", [table])
    validity = results.table("validity")
    if validity.empty:
        return None
    rows = [
        _row(str(name), str(side), part)
        for (name, side), part in validity.groupby(["object", "pedestal"], sort=False)
    ]
    caption = "Friction coefficient needed, and tests with lift-off."
    all_tests = max(row["tests"] for row in rows) < MOST_TESTED
    text = says.validity(model_allowed(validity)[0], all_tests)
    return section_of(text, "validity", [table_html(pd.DataFrame(rows), _COLUMNS, caption)])


def _row(name: str, side: str, part: pd.DataFrame) -> dict[str, Any]:
    demand = part["friction_demand"].to_numpy(dtype=float)
    known = demand[np.isfinite(demand)]
    return {
        "object": name,
        "side": "with" if side == "P" else "without",
        "tests": len(part),
        "median": float(np.median(known)) if known.size else np.nan,
        "largest": float(known.max(initial=0.0)) if known.size else np.nan,
        "beyond": len(part) - known.size,
        "lifted": int((part["least_normal_force_n"] <= 0).sum()),
    }


VALIDITY = Part(_section)
