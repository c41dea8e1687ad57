"""Medians of several configurations by one estimator, so that a comparison is of bodies and not of estimators."""

from typing import NamedTuple

import pandas as pd

from rockfrag.fragility.curve_facts import REJECTED

ESTIMATES = ("theta", "beta")


class Compared(NamedTuple):
    """Curves that may be compared."""

    # rows of the table with ``theta`` and ``beta``, and their limits, all by the same estimator;
    # theta is missing where that estimator gives none
    rows: pd.DataFrame
    nonparametric: bool  # whether the estimator is the monotone curve without an assumed form
    rejected: list[str]  # configurations whose lognormal curve is rejected


def compared_curves(rows: pd.DataFrame, nonparametric: bool | None = None) -> Compared:
    """Choose one estimator for all curves of a comparison, which are of one measure and one definition.

    Lognormal curves are compared where none of them is rejected by its goodness of fit (p < 0.05). Where one is,
    all are replaced by nonparametric monotone curves: an estimator that is chosen body by body would show
    differences between bodies that are differences between estimators. Where the rows are a part of a larger
    comparison, that decides (``nonparametric``).
    """
    below = rows["p_fit"] < REJECTED
    rejected = list(dict.fromkeys(rows.loc[below, "configuration"]))
    if not (bool(rejected) if nonparametric is None else nonparametric):
        return Compared(rows, False, rejected)
    values = {
        f"{name}{end}": rows[f"{name}_isotonic{end}"]
        for name in ESTIMATES
        for end in ("", "_lower", "_upper")
        if f"{name}_isotonic{end}" in rows
    }
    return Compared(rows.assign(**values), True, rejected)
