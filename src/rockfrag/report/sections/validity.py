"""What the model assumes, that nothing slides and nothing jumps, or what friction did where it is limited."""

import numpy as np
import pandas as pd

from rockfrag.report.findings import model_allowed, sliding_found
from rockfrag.report.page import Column, table_html
from rockfrag.report.part import Part, Results, Section, opened
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
        return _what_friction_did(results.table("sliding"))
    validity = results.table("validity")
    if validity.empty:
        return None
    found = model_allowed(validity)[0]
    rows = [
        _row(str(name), str(side), part)
        for (name, side), part in validity.groupby(["object", "pedestal"], sort=False)
    ]
    return Section(
        "validity",
        "What the model assumes",
        f"{found.headline}.",
        [
            *opened(found),
            f"Blocks neither slide nor jump in this model. The contact forces of {_which(validity)}, at its "
            "overturning amplitude, give the friction that this requires.",
        ],
        [
            table_html(
                pd.DataFrame(rows),
                _COLUMNS,
                "Friction coefficient needed, and tests with lift-off.",
            )
        ],
    )


def _which(validity: pd.DataFrame) -> str:
    tests = validity.groupby(["object", "pedestal"]).size().max()
    return "every test" if tests < MOST_TESTED else "each test of a sample spread evenly over all"


def _what_friction_did(sliding: pd.DataFrame) -> Section:
    found = sliding_found(sliding)
    shown = sliding.assign(largest_slip_cm=100 * sliding["largest_slip_m"])
    return Section(
        "validity",
        "What friction does",
        f"{found.headline}.",
        [
            *opened(found),
            "Bodies stick, slide, rock and fly with the friction of this study, at every amplitude of every "
            "motion. Each analysis is repeated without sliding. “Saved by sliding” overturns only without "
            "sliding, “overturned by it” only with sliding and flight.",
        ],
        [table_html(shown, _SLIDING, "Sliding and flight in all analyses.")],
    )


def _row(name: str, side: str, part: pd.DataFrame) -> dict[str, object]:
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


VALIDITY = Part(("validity",), _section)
