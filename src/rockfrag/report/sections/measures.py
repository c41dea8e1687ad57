"""Which intensity measure predicts overturning best."""

import pandas as pd

from rockfrag.report.page import Column, table_html
from rockfrag.report.part import Part, Results, Section
from rockfrag.report.wording import listed

_COLUMNS = (
    Column("configuration", "Configuration"),
    Column("im", "Recommended"),
    Column("beta_amplitude", "β", 3),
    Column("auc", "AUC", 3),
    Column("chosen_share", "Best in share of bootstrap samples", 2),
    Column("words", "Reasons"),
)


def _section(results: Results) -> Section:
    choice = results.table("measure_choice")
    best = choice[choice["recommended"].astype(bool)]
    none = [
        name
        for name in dict.fromkeys(choice["configuration"])
        if name not in set(best["configuration"])
    ]
    words = [
        "Measures compared by how well they predict the first overturning amplitude of each "
        "motion, over all floors."
    ]
    if none:
        words.append(f"No measure can be recommended for {', '.join(none)}.")
    return Section(
        "measures",
        "Which intensity measure",
        _message(best),
        words,
        [table_html(best, _COLUMNS, "Recommended measure of each configuration, with reasons.")],
    )


def _message(best: pd.DataFrame) -> str:
    """Say which measure is recommended for which configurations."""
    if best.empty:
        return "No measure can be recommended."
    names = best.groupby("im", sort=False)["configuration"].agg(list)
    return listed([f"{measure} for {listed(own)}" for measure, own in names.items()]) + "."


MEASURES = Part(("measure_choice",), _section)
