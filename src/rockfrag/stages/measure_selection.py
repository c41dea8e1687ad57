"""Which intensity measure predicts the overturning of each configuration."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import pandas as pd

from rockfrag.motions.declared import intensity_measures

if TYPE_CHECKING:
    # every job reads this module for the list of stages; only curves need scipy
    from rockfrag.fragility.empirical import IdaData


def candidates() -> tuple[str, ...]:
    """Return the columns of the measures that are compared; all grow with the amplitude."""
    return tuple(measure.column for measure in intensity_measures() if measure.compared)


GIVEN = ("mean_period_s", "d5_95_s")
"""Properties of which a sufficient measure leaves nothing to tell."""


def best_of(choice: pd.DataFrame, asked: Sequence[str]) -> list[str]:
    """Names of the best measures of all configurations among those that a study asks for."""
    known = choice[choice["measure"].isin(list(asked)) & choice["score"].notna()]
    return list(dict.fromkeys(known.drop_duplicates("configuration")["im"]))


def measure_selection(
    ida_curves: Mapping[str, "IdaData"], measures: pd.DataFrame, level: float, seed: int
) -> pd.DataFrame:
    """Compare measures for every configuration.

    One row per configuration and measure, best first: the columns of
    :class:`rockfrag.fragility.measure_selection.MeasureSelection`, ``recommended`` (True for one row each) and
    ``words``, the recommendation with its reasons.
    """
    from rockfrag.fragility.measure_selection import recommend_ida_measure

    parts = []
    for name, ida in ida_curves.items():
        choice = recommend_ida_measure(
            ida, measures, candidates(), given=GIVEN, level=level, seed=seed
        )
        table = choice.table.copy()
        table.insert(0, "configuration", name)
        chosen = table["measure"] == choice.recommended
        parts.append(table.assign(recommended=chosen, words=choice.words))
    return pd.concat(parts, ignore_index=True)
