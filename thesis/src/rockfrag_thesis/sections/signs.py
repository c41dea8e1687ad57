"""Perturbed parameters that give the signs that the thesis reports on its floors.

In: the table ``sensitivity_analysis/effects``, ratios with over without pedestal [-]. Out: a section of the
report.
"""

import pandas as pd

from rockfrag.report.page import Column, table_html
from rockfrag.report.part import Results, Section
from rockfrag.words.sentences import agree, listed, of_all, sentence
from rockfrag_thesis.hypotheses.floors import FLOORS, GROUND
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

    def by_floor(name: str) -> pd.DataFrame:
        wide = effects.pivot_table(index=keys, columns="floor", values=name)
        return wide.reindex(columns=list(FLOORS))

    ratio = by_floor("ratio")
    lower, upper = by_floor("ratio_lower"), by_floor("ratio_upper")
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
    named = list(table.loc[table["signs"], "name"])
    clear = list(table.loc[table["beyond_chance"], "name"])
    shown = table.assign(
        name=table["name"].map(sentence),
        **{kind: table[kind].map({True: "yes", False: "no"}) for kind in kinds},
    )
    caption = "Mean ratio of amplitudes with/without pedestal by floor."
    counts = of_all(len(named), len(table), "perturbation")
    verb = agree(len(named), len(table), "gives", "give")
    words = [
        "The thesis reports a ratio above 1 on the ground floor and below 1 on the other two. The perturbations "
        "share the same pairs of tests, and many leave the ratio at exactly 1, so no chance level is given for "
        "them."
    ]
    if named:
        words.append(f"The mean ratios have these signs for {listed(named)}.")
    if clear:
        words.append(f"The intervals have them for {listed(clear)}.")

    else:
        words.append("No perturbation has its intervals on these sides.")
    return Section(
        "signs",
        "What would give the thesis’s signs",
        f"{sentence(counts)} {verb} mean ratios with the signs of the thesis.",
        words,
        [table_html(shown, _COLUMNS, caption)],
    )
