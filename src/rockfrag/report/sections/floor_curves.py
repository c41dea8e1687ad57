"""Fragility on each floor in the peak of that floor's own motion, for each limit state."""

import pandas as pd

from rockfrag.outcomes.limit_states import OVERTURNS, limit_states
from rockfrag.report.answer import has_one_record
from rockfrag.report.page import Column, table_html
from rockfrag.report.part import Part, Results, Section
from rockfrag.report.wording import estimates, listed

_COLUMNS = (
    Column("configuration", "Configuration"),
    Column("floor", "Floor"),
    Column("state_text", "Limit state"),
    Column("im", "Measure"),
    Column("theta_text", "Median θ [g]", numeric=True),
    Column("beta_text", "Dispersion β", numeric=True),
)


def _section(results: Results) -> Section | None:
    if has_one_record(results):
        return None
    curves = results.table("fragility_floors")
    shown = curves[(curves["measure"] == "pga_g") & curves["theta"].notna()]
    # hidden files are the workflow's own marks
    names = (path.name for path in (results.folder / "exports").iterdir() if path.is_file())
    files = sorted(name for name in names if not name.startswith("."))
    if shown.empty:
        return None
    labels = {state.name: state.label for state in limit_states()}
    shown = shown.assign(
        state_text=shown["state"].map(labels),
        theta_text=estimates(shown, "theta"),
        beta_text=estimates(shown, "beta"),
    )
    words = [
        "Each floor by itself, as a function of the peak acceleration of that floor. Curves in other measures "
        "are in the table fragility_floors."
    ]
    if files:
        words.append(f"Files for other programs are in the folder exports: {listed(files)}.")
    level = f"{100 * results.study.fragility.confidence:g} %"
    caption = f"Curves by floor, with {level} intervals where there are any."
    message = _message(shown[shown["state"] == OVERTURNS])
    return Section(
        "floor_curves", "Fragility by floor", message, words, [table_html(shown, _COLUMNS, caption)]
    )


def _message(fallen: pd.DataFrame) -> str:
    """Say which configuration overturns earliest, and where."""
    if fallen.empty:
        return "No floor has a curve of overturning: too few objects overturned on a single one."
    weakest = min(fallen.to_dict("records"), key=lambda row: float(row["theta"]))
    return (
        f"{weakest['configuration']} on {weakest['floor']} is the most fragile: the median of its lognormal "
        f"curve is {weakest['theta_text']} g."
    )


FLOOR_CURVES = Part(("fragility_floors",), _section)
