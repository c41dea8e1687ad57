"""Which departures from the ideal model give the signs that the thesis reports on its floors."""

import pandas as pd

from rockfrag.report.page import Column, table_html
from rockfrag.report.part import Part, Results, Section
from rockfrag.report.sections.explanation import asks_explanation, departures
from rockfrag.report.wording import listed, of_all, sentence
from rockfrag.thesis.statements.floors import FLOORS

_GROUND, *_UPPER = FLOORS


def with_signs(effects: pd.DataFrame) -> pd.DataFrame:
    """Departures with the ratio P/NP on each floor, and whether it has the signs of the thesis.

    Parameters
    ----------
    effects
        As :func:`rockfrag.stages.explanation.explanation_tables` returns them.

    Returns
    -------
    pandas.DataFrame
        ``name``, a column per floor of the thesis, and ``signs``: above one on the ground floor and
        below one on the others.
    """
    keys = ["factor", "level"]
    floors = effects.pivot_table(index=keys, columns="floor", values="ratio").reindex(
        columns=list(FLOORS)
    )
    table = departures(effects)[[*keys, "name"]].merge(floors.reset_index(), on=keys, how="left")
    signs = (table[_GROUND] > 1) & (table[_UPPER] < 1).all(axis=1)
    return table.assign(signs=signs)


def _section(results: Results) -> Section:
    table = with_signs(results.table("explanation/effects"))
    named = list(table.loc[table["signs"], "name"])
    words = (
        f"{sentence(of_all(len(named), len(table), 'departure'))} give mean ratios with the signs that the "
        f"thesis reports, above one on the ground floor and below one on the others: {listed(named)}. "
        "The sign of a mean alone says nothing about its interval."
        if named
        else "No departure gives the signs that the thesis reports, above one on the ground floor and "
        "below one on the others."
    )
    shown = table.assign(signs=table["signs"].map({True: "yes", False: "no"}))
    columns = [Column("name", "Departure from the ideal model")]
    columns += [Column(floor, f"P/NP on {floor}", 3) for floor in FLOORS]
    columns += [Column("signs", "Signs of the thesis")]
    return Section(
        "signs",
        "What would give the thesis’s signs",
        [words],
        [table_html(shown, columns, "Mean ratio P/NP by floor.")],
    )


SIGNS = Part(("explanation/effects",), _section, asked=asks_explanation)
