"""Which intensity measure predicts overturning best."""

from collections.abc import Sequence

import pandas as pd

from rockfrag.report.page import Column, table_html
from rockfrag.report.part import Part, Results, Section
from rockfrag.report.wording import listed
from rockfrag.stages.measure_selection import best_of

_COLUMNS = (
    Column("configuration", "Configuration"),
    Column("im", "Recommended"),
    Column("beta_amplitude", "β", 3),
    Column("auc", "AUC", 3),
    Column("chosen_fraction", "Fraction of bootstrap samples in which it is best", 2),
    Column("words", "Reasons"),
)


def _section(results: Results) -> Section:
    choice = results.table("measure_selection")
    asked = results.study.fragility.measures
    best = choice[choice["recommended"].astype(bool)]
    named = set(best["configuration"])
    none = [name for name in dict.fromkeys(choice["configuration"]) if name not in named]
    words = [
        "Measures are compared by how well they predict the first overturning amplitude of each motion, over "
        f"all floors. The table recommends one of all {choice['measure'].nunique()} that were compared, whether "
        "or not the study gives curves in it."
    ]
    if none:
        words.append(f"No measure can be recommended for {', '.join(none)}.")
    return Section(
        "measures",
        "Recommended intensity measure",
        _message(choice, asked),
        words,
        [table_html(best, _COLUMNS, "Recommended measure of each configuration, with reasons.")],
    )


def _message(choice: pd.DataFrame, asked: Sequence[str]) -> str:
    """Say which of the measures that a study asks for is the best, and whether another one is better."""
    named = best_of(choice, asked)
    if not named:
        return "No measure can be recommended."
    others = choice.loc[
        choice["recommended"].astype(bool) & ~choice["measure"].isin(list(asked)), "im"
    ]
    is_best = "is" if len(named) == 1 else "are"
    words = f"{listed(named)} {is_best} the best of the measures asked for."
    if len(others):
        better = list(dict.fromkeys(others))
        verb = "predicts" if len(better) == 1 else "predict"
        words += f" Of all compared, {listed(better)} {verb} better."
    return words


MEASURES = Part(("measure_selection",), _section)
