"""Which intensity measure predicts overturning best."""

from rockfrag.report.page import Column, table_html
from rockfrag.report.part import Part, Results, Section

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
        words,
        [table_html(best, _COLUMNS, "Recommended measure of each configuration, with reasons.")],
    )


MEASURES = Part(("measure_choice",), _section)
