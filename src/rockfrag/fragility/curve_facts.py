"""What a file with a curve must say about it, and its names and curves as other programs take them."""

import hashlib
import math
from collections import Counter
from collections.abc import Hashable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
import pandas as pd

from rockfrag.errors import InputError
from rockfrag.fragility.model_error import CUT, MODEL_ERRORS
from rockfrag.fragility.observations import Floats
from rockfrag.outcomes.limit_states import OVERTURNS, limit_state_named, limit_states
from rockfrag.sentences import Macros

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
    **{"REJECTED": REJECTED, "OF_THE_MODEL": OF_THE_MODEL, "CUT": CUT, "total_beta": total_beta},
    **{"INFINITE": math.inf, "NAN": math.nan},
)

NUMBERS = (
    *("n_motions", "n_earthquakes", "theta_lower", "beta_lower", "beta", "p_fit"),
    "theta_isotonic",
)


def curve_facts(row: Mapping[Hashable, Any]) -> str:
    """Say of a row of a fragility table what it rests on, in sentences; empty where nothing is known."""
    values = {name: row.get(name) for name in NUMBERS}
    known = {name for name, x in values.items() if x is not None and math.isfinite(float(x))}
    return " ".join(_say("facts", row, known, float(row.get("beta_statistical", math.nan))))


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
        for name in ("theta", "beta")
        for end in ("", "_lower", "_upper")
        if f"{name}_isotonic{end}" in rows
    }
    return Compared(rows.assign(**values), True, rejected)


LONGEST = 75  # characters of an identifier that OpenQuake takes
STEP = 0.01  # β with which an exact threshold, a step, is written [-]; the formats take no step


def identifiers(names: Iterable[str], others: str = "") -> dict[str, str]:
    """Return an identifier for each name: ASCII letters, digits and ``others``; all else becomes ``_``.

    Where two would be equal, or one would be too long, a digest of the name follows.
    """
    plain = {
        name: "".join(c if c.isascii() and (c.isalnum() or c in others) else "_" for c in name)
        for name in dict.fromkeys(names)
    }
    count = Counter(plain.values())
    for name, text in plain.items():
        if count[text] > 1 or len(text) > LONGEST:
            digest = hashlib.sha256(name.encode()).hexdigest()[:8]
            plain[name] = f"{text[: LONGEST - 9]}_{digest}"
    return plain


@dataclass(frozen=True)
class StateCurve:
    """Curve of one limit state."""

    row: Mapping[Hashable, Any]  # its row of the fragility table
    theta: float
    beta: float  # that of a step is ``STEP``
    # points of the non-parametric fragility function; empty where the lognormal one stands
    levels: Floats
    fraction: Floats


def curves_by_name(
    export: str,
    table: pd.DataFrame,
    by: str,
    others: str,
    fractions: pd.DataFrame | None,
    prefix: str = "",
) -> dict[str, dict[str, StateCurve]]:
    """Return the curves of a fragility table by the identifier of ``by`` and by limit state, the milder first."""
    if table.empty:
        raise InputError(f"{export}: there is no curve to write; give at least one row.")
    known = identifiers(map(str, table[by]), others)
    curves: dict[str, dict[str, StateCurve]] = {}
    for row in table.to_dict("records"):
        name = prefix + known[str(row[by])]
        states = curves.setdefault(name, {})
        state = limit_state_named(str(row.get("state", OVERTURNS))).name
        if state in states:
            raise InputError(
                f"{export}: {name!r} has two curves; choose one estimator and one measure for each."
            )
        theta, beta = float(str(row["theta"])), float(str(row["beta"]))
        if row.get("link", "probit") != "probit" or not (theta > 0 and 0 < beta < math.inf):
            raise InputError(
                f"{export}: {str(row[by])!r} has no lognormal curve; leave the row out."
            )
        points = np.empty((0, 2))
        if fractions is not None:
            own = (fractions[by].astype(str) == str(row[by])) & (fractions["state"] == state)
            points = fractions.loc[own, ["x", "fraction"]].to_numpy(dtype=np.float64)
        states[state] = StateCurve(row, theta, max(beta, STEP), points[:, 0], points[:, 1])
    order = [state.name for state in limit_states()]
    return {
        name: {state: states[state] for state in order if state in states}
        for name, states in curves.items()
    }
