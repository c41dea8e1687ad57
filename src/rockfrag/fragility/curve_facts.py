"""What a file with a curve must say about it."""

import math
from collections.abc import Hashable, Mapping
from numbers import Real
from typing import Any, NamedTuple

import pandas as pd

from rockfrag.fragility.model_error import CUT, MODEL_ERRORS
from rockfrag.words.sentences import Macros

REJECTED = 0.05  # a curve is said not to describe its data below this p value [-]
OF_THE_MODEL = MODEL_ERRORS[CUT]
"""Error of the model in curves of studies, whose bodies are cut blocks."""


def total_beta(beta: float, beta_statistical: float) -> float:
    """β of the motions with that of the median's estimate and of the model, added as squares [-].

    A statistical part that is not known (NaN) is left out.
    """
    known = beta_statistical if math.isfinite(beta_statistical) else 0.0
    return math.sqrt(beta**2 + known**2 + OF_THE_MODEL.blind**2)


_say = Macros(
    "rockfrag.fragility",
    "curve_facts.j2",
    **{
        "REJECTED": REJECTED,
        "OF_THE_MODEL": OF_THE_MODEL,
        "CUT": CUT,
        "total_beta": total_beta,
    },
    **{"INFINITE": math.inf, "NAN": math.nan},
)


def curve_facts(row: Mapping[Hashable, Any]) -> str:
    """Say of a row of a fragility table what it rests on, in sentences; empty where nothing is known."""
    known = {
        name for name, x in row.items() if isinstance(x, Real) and math.isfinite(x)
    }
    return " ".join(
        _say("facts", row, known, float(row.get("beta_statistical", math.nan)))
    )


class Compared(NamedTuple):
    """Curves that may be compared."""

    # rows of the table with ``theta`` and ``beta``, and their limits, all by the same estimator;
    # theta is missing where that estimator gives none
    rows: pd.DataFrame
    # whether the estimator is the monotone curve without an assumed form
    nonparametric: bool
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
        for name in ("theta", "beta")
        for end in ("", "_lower", "_upper")
        if f"{name}_isotonic{end}" in rows
    }
    return Compared(rows.assign(**values), True, rejected)
