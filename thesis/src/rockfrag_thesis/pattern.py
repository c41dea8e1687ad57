"""Which perturbed parameters of the ideal model have the signs that the thesis reports on its floors."""

import pandas as pd

from rockfrag_thesis.hypotheses.floors import FLOORS, GROUND

_UPPER = [floor for floor in FLOORS if floor != GROUND]


def perturbations_by_floor(effects: pd.DataFrame) -> pd.DataFrame:
    """Perturbed parameters with the ratio P/NP on each floor, and whether it has the signs of the thesis.

    Returns the columns of :func:`rockfrag_thesis.sections.sensitivity_analysis.perturbations`, a column per floor
    of the thesis, ``signs`` (the mean is above one on the ground floor and below one on the others) and
    ``beyond_chance`` (so are the 95 % intervals).
    """
    # sections draw on this module
    from rockfrag_thesis.sections.sensitivity_analysis import perturbations

    keys = ["factor", "level"]

    def by_floor(value: str) -> pd.DataFrame:
        return effects.pivot_table(index=keys, columns="floor", values=value).reindex(
            columns=list(FLOORS)
        )

    ratio, lower, upper = (by_floor(name) for name in ("ratio", "ratio_lower", "ratio_upper"))
    found = ratio.assign(
        signs=(ratio[GROUND] > 1) & (ratio[_UPPER] < 1).all(axis=1),
        beyond_chance=(lower[GROUND] > 1) & (upper[_UPPER] < 1).all(axis=1),
    )
    return perturbations(effects).merge(found.reset_index(), on=keys, how="left")
