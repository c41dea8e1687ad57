"""Which perturbed parameters give the signs that the thesis reports on its floors."""

import pandas as pd

from rockfrag.report.page import Column, table_html
from rockfrag.report.part import Results, Section
from rockfrag.words.sentences import sentence
from rockfrag_thesis.hypotheses.floors import FLOORS, GROUND
from rockfrag_thesis.sections import says
from rockfrag_thesis.sections.sensitivity_analysis import (
    asks_sensitivity_analysis,
    perturbations,
)

_UPPER = [floor for floor in FLOORS if floor != GROUND]
_COLUMNS = (
    Column("name", "Perturbed parameter"),
    *(Column(floor, f"With/without pedestal on {floor}", 3) for floor in FLOORS),
    Column("signs", "Means have the signs"),
    Column("beyond_chance", "Intervals have them"),
)


def perturbations_by_floor(effects: pd.DataFrame) -> pd.DataFrame:
    """Perturbed parameters with the ratio P/NP on each floor, and whether it has the signs of the thesis.

    Returns the columns of :func:`rockfrag_thesis.sections.sensitivity_analysis.perturbations`, a column per floor
    of the thesis, ``signs`` (the mean is above one on the ground floor and below one on the others) and
    ``beyond_chance`` (so are the 95 % intervals).
    """
    keys = ["factor", "level"]
    ratio, lower, upper = (
        effects.pivot_table(index=keys, columns="floor", values=name).reindex(
            columns=list(FLOORS)
        )
        for name in ("ratio", "ratio_lower", "ratio_upper")
    )
    found = ratio.assign(
        signs=(ratio[GROUND] > 1) & (ratio[_UPPER] < 1).all(axis=1),
        beyond_chance=(lower[GROUND] > 1) & (upper[_UPPER] < 1).all(axis=1),
    )
    return perturbations(effects).merge(found.reset_index(), on=keys, how="left")


def signs(results: Results) -> Section | None:
    """Which perturbed parameters have the signs that the thesis reports; None where the study perturbs none."""
    if not asks_sensitivity_analysis(results.study):
        return None
    table = perturbations_by_floor(results.table("sensitivity_analysis/effects"))
    kinds = ("signs", "beyond_chance")
    named, clear = (list(table.loc[table[kind], "name"]) for kind in kinds)
    shown = table.assign(
        name=table["name"].map(sentence),
        **{kind: table[kind].map({True: "yes", False: "no"}) for kind in kinds},
    )
    caption = "Mean ratio of amplitudes with/without pedestal by floor."
    return says.section(
        "signs", [table_html(shown, _COLUMNS, caption)], named, clear, len(table)
    )
